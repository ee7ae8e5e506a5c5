//! The dimensionless groups on which linear stability depends, beside the delay.

/// Dimensionless groups of the controlled oscillator; the time unit is √(M/κ).
///
/// With E = e^(−λτ) the letter's Eq. (3) reads
///
/// ```text
/// D(λ) = λ² + [b − a_v (1 − E)] λ + 1 − [b a_v + a_n] (1 − E)
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Groups {
    /// b = μ_K′(v0) N0 / √(κM): damping by the slope of the friction law; negative where friction
    /// weakens.
    pub b: f64,
    /// a_v = α_v √(M/κ): gain of velocity control.
    pub a_v: f64,
    /// a_n = μ_K(v0) α_N / κ: gain of load control.
    pub a_n: f64,
}

impl Groups {
    /// Groups with the given values; for M = κ = N0 = μ_K = 1 they equal μ_K′, α_v and α_N.
    #[must_use]
    pub const fn new(b: f64, a_v: f64, a_n: f64) -> Self {
        Self { b, a_v, a_n }
    }

    /// True when no control acts: a_v = a_n = 0.
    #[must_use]
    pub fn uncontrolled(&self) -> bool {
        self.a_v == 0.0 && self.a_n == 0.0
    }
}
