//! A characteristic equation, with all that is needed to find and follow its roots.

use num_complex::Complex64;

use super::characteristic::Jet;

/// D and D′ with a bound on the rounding of D, evaluated with twice the digits.
#[derive(Debug, Clone, Copy)]
pub struct Exact {
    /// D.
    pub value: Complex64,
    /// D′.
    pub slope: Complex64,
    /// A bound on the error of D, that of the coefficients included.
    pub rounding: f64,
}

/// A characteristic function D(λ) = P(λ) + Q(λ) e^(−λτ) at every delay τ ≥ 0.
///
/// Dimensionless: delays in any unit, λ in its inverse.
pub trait Equation: Copy {
    /// The number of roots right of the imaginary axis at any delay.
    type Unstable;

    /// Whether counts right of a line cost much more than evaluations. A certificate then begins
    /// with the margin of the cell before.
    const KEEPS_MARGINS: bool;

    /// P, P′, Q and Q′ at λ.
    fn pair(self) -> impl Fn(Complex64) -> [Complex64; 4];

    /// Whether there is no feedback: the delay then does not matter.
    fn uncontrolled(self) -> bool;

    /// D and its derivatives.
    fn jet(self, tau: f64, lambda: Complex64) -> Jet;

    /// D with twice the digits; none where that is not known.
    fn exact(self, _tau: f64, _lambda: Complex64) -> Option<Exact> {
        None
    }

    /// A bound on the rounding of `jet.value`.
    fn rounding(self, jet: &Jet, tau: f64, lambda: Complex64) -> f64;

    /// A rough value of D‴, where `jet` is D.
    fn third(self, jet: &Jet, tau: f64, lambda: Complex64) -> Complex64;

    /// The number of roots right of `line`; none where it is undecided or infinite.
    fn right_of(self, tau: f64, line: f64) -> Option<u64>;

    /// Counts right of the axis.
    fn unstable(self) -> Self::Unstable;

    /// The number of unstable roots at `tau`, from `unstable`; none where it is undecided.
    fn unstable_at(unstable: &Self::Unstable, tau: f64) -> Option<u64>;

    /// Begins another cell, for equations whose work for a cell is bounded.
    fn begin(self) {}

    /// How far back in time the equation reaches at the delay `tau`.
    fn memory_span(self, tau: f64) -> f64 {
        tau
    }

    /// The radius within which every root with Re λ ≥ `line` lies.
    fn root_bound(self, tau: f64, line: f64) -> f64;

    /// The frequencies at which |P| = |Q e^(−λτ)| on `line`, in no order; none where that takes
    /// longer than to look for them.
    fn equal_sizes(self, _tau: f64, _line: f64) -> Option<Vec<f64>> {
        None
    }

    /// The real part at which roots accumulate; nothing is searched left of it.
    fn essential_abscissa(self, tau: f64) -> f64;

    /// Appends the zeros of D at τ = 0, or at any delay where it does not matter, in the upper
    /// half-plane and on the real axis. Returns how many there are in all.
    fn without_delay(self, tau: f64, starts: &mut Vec<Complex64>) -> u64;

    /// Appends the zeros of P, and of P + Q: weak feedback and short delays leave roots there.
    fn zeros(self, starts: &mut Vec<Complex64>);

    /// Appends starts for roots right of `line` where the branches were not enough: the zeros of D
    /// where e^(−λτ) is a parabola, and for some equations more.
    fn further_starts(self, tau: f64, line: f64, starts: &mut Vec<Complex64>);

    /// Approximate roots by collocation with so many nodes; none where that fails.
    fn eigenvalues(self, tau: f64, nodes: usize) -> Option<Vec<Complex64>>;
}
