//! What finding and following roots needs of a characteristic equation.

use num_complex::Complex64;

use super::characteristic::Jet;

/// P and Q of an equation.
pub trait Pair {
    /// P, P′, Q and Q′ at λ.
    fn at(&self, lambda: Complex64) -> [Complex64; 4];
}

/// A characteristic function D(λ) = P(λ) + Q(λ) e^(−λτ) at every delay τ ≥ 0.
///
/// Dimensionless: delays in any unit, λ in its inverse.
pub trait Equation: Copy {
    /// The number of roots right of the imaginary axis at any delay.
    type Unstable;

    /// Counts right of a line cost much more than evaluations: a certificate begins with the margin
    /// of the cell before.
    const KEEPS_MARGINS: bool;

    /// P and Q.
    fn pair(self) -> impl Pair;

    /// No feedback: the delay does not matter.
    fn uncontrolled(self) -> bool;

    /// D and its derivatives.
    fn jet(self, tau: f64, lambda: Complex64) -> Jet;

    /// A bound on the rounding of `jet.value`.
    fn rounding(self, jet: &Jet, tau: f64, lambda: Complex64) -> f64;

    /// D‴, roughly, where `jet` is D.
    fn third(self, jet: &Jet, tau: f64, lambda: Complex64) -> Complex64;

    /// How many roots lie right of `line`; none where that is open, or infinite.
    fn right_of(self, tau: f64, line: f64) -> Option<u64>;

    /// Counts right of the axis.
    fn unstable(self) -> Self::Unstable;

    /// The number that `unstable` tells at `tau`.
    fn unstable_at(unstable: &Self::Unstable, tau: f64) -> Option<u64>;

    /// How far back in time the equation reaches at the delay `tau`.
    fn memory_span(self, tau: f64) -> f64 {
        tau
    }

    /// The radius within which every root with Re λ ≥ `line` lies.
    fn root_bound(self, tau: f64, line: f64) -> f64;

    /// The part of the plane left of which there is nothing to find: roots accumulate there.
    fn essential_abscissa(self, tau: f64) -> f64;

    /// Appends the zeros of D at τ = 0, or everywhere where the delay does not matter, in the upper
    /// half-plane and on the real axis; returns how many there are in all.
    fn without_delay(self, tau: f64, starts: &mut Vec<Complex64>) -> u64;

    /// Appends the zeros of P, and of P + Q: weak feedback and short delays leave roots there.
    fn zeros(self, starts: &mut Vec<Complex64>);

    /// Appends starts for roots right of `line` where the branches were not enough: the zeros of D
    /// where e^(−λτ) is a parabola, and for some equations more.
    fn further_starts(self, tau: f64, line: f64, starts: &mut Vec<Complex64>);

    /// Approximate roots by collocation with so many nodes; none where that fails.
    fn eigenvalues(self, tau: f64, nodes: usize) -> Option<Vec<Complex64>>;
}
