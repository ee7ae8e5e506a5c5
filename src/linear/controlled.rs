//! The controlled oscillator as an [`Equation`].

use num_complex::Complex64;

use super::branches::{LetterPair, quadratic_zeros, slow_starts};
use super::certificate::{UnstableCount, roots_right_of};
use super::characteristic::{Jet, root_bound};
use super::collocation::eigenvalues;
use super::equation::Equation;
use crate::model::Groups;

impl Equation for Groups {
    type Unstable = UnstableCount;

    const KEEPS_MARGINS: bool = false;

    fn pair(self) -> impl Fn(Complex64) -> [Complex64; 4] {
        let pair = LetterPair::new(self);
        move |lambda| pair.at(lambda)
    }

    #[inline]
    fn uncontrolled(self) -> bool {
        Groups::uncontrolled(&self)
    }

    #[inline]
    fn jet(self, tau: f64, lambda: Complex64) -> Jet {
        Jet::at(self, tau, lambda)
    }

    #[inline]
    fn rounding(self, jet: &Jet, tau: f64, lambda: Complex64) -> f64 {
        jet.rounding(self, tau, lambda)
    }

    fn third(self, jet: &Jet, tau: f64, _lambda: Complex64) -> Complex64 {
        tau * tau * jet.delayed * (3.0 * self.a_v - tau * jet.feedback)
    }

    #[inline]
    fn right_of(self, tau: f64, line: f64) -> Option<u64> {
        roots_right_of(self, tau, line)
    }

    fn unstable(self) -> UnstableCount {
        UnstableCount::new(self)
    }

    #[inline]
    fn unstable_at(unstable: &UnstableCount, tau: f64) -> Option<u64> {
        unstable.at(tau)
    }

    fn root_bound(self, tau: f64, line: f64) -> f64 {
        root_bound(self, tau, line)
    }

    fn essential_abscissa(self, _tau: f64) -> f64 {
        f64::NEG_INFINITY
    }

    fn without_delay(self, _tau: f64, starts: &mut Vec<Complex64>) -> u64 {
        starts.extend(quadratic_zeros(self.b, 1.0));
        2
    }

    fn zeros(self, starts: &mut Vec<Complex64>) {
        starts.extend(LetterPair::new(self).zeros(self.b));
    }

    fn further_starts(self, tau: f64, _line: f64, starts: &mut Vec<Complex64>) {
        starts.extend(slow_starts(self, tau));
    }

    fn eigenvalues(self, tau: f64, nodes: usize) -> Option<Vec<Complex64>> {
        let (p, q) = LetterPair::new(self).coefficients();
        eigenvalues(&p, &q, tau, nodes)
    }
}
