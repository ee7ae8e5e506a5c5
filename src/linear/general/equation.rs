//! A general system as an [`Equation`], for what finds and follows roots.

use std::f64::consts::PI;

use num_complex::Complex64;

use super::polynomial::Polynomial;
use super::right_of::RootCounter;
use super::system::System;
use super::turning::Turning;
use super::zeros::Zeros;
use crate::linear::characteristic::Jet;
use crate::linear::equation::{Equation, Exact};

impl Equation for &RootCounter {
    type Unstable = Option<Turning>;

    const KEEPS_MARGINS: bool = true;

    fn pair(self) -> impl Fn(Complex64) -> [Complex64; 4] {
        |lambda| self.system().pair(lambda)
    }

    fn uncontrolled(self) -> bool {
        self.system().uncontrolled()
    }

    fn jet(self, tau: f64, lambda: Complex64) -> Jet {
        self.system().jet(tau, lambda)
    }

    fn rounding(self, jet: &Jet, tau: f64, lambda: Complex64) -> f64 {
        self.system().rounding(jet, tau, lambda)
    }

    fn exact(self, tau: f64, lambda: Complex64) -> Option<Exact> {
        self.system().exact(tau, lambda)
    }

    fn third(self, jet: &Jet, tau: f64, lambda: Complex64) -> Complex64 {
        self.system().third(jet, tau, lambda)
    }

    fn begin(self) {
        RootCounter::begin(self);
    }

    fn memory_span(self, tau: f64) -> f64 {
        tau + self.system().latency()
    }

    fn right_of(self, tau: f64, line: f64) -> Option<u64> {
        RootCounter::right_of(self, tau, line).finite()
    }

    fn unstable(self) -> Option<Turning> {
        RootCounter::unstable(self)
    }

    fn unstable_at(unstable: &Option<Turning>, tau: f64) -> Option<u64> {
        unstable.as_ref()?.at(tau)
    }

    fn root_bound(self, tau: f64, line: f64) -> f64 {
        self.system().root_bound(tau, line)
    }

    fn equal_sizes(self, tau: f64, line: f64) -> Option<Vec<f64>> {
        // With latency they are not the zeros of a polynomial.
        let polynomial = self.system().latency() == 0.0;
        let frequencies = || self.frequencies(tau, line).into_iter();
        polynomial.then(|| frequencies().map(|(omega, _)| omega).collect())
    }

    fn essential_abscissa(self, tau: f64) -> f64 {
        self.system().essential_abscissa(tau)
    }

    fn without_delay(self, tau: f64, starts: &mut Vec<Complex64>) -> u64 {
        let sum = if tau == 0.0 {
            self.system().without_delay()
        } else {
            self.system().p
        };
        add_zeros(&sum, starts);
        sum.degree() as u64
    }

    fn zeros(self, starts: &mut Vec<Complex64>) {
        starts.extend(self.zeros_of_p().iter().filter(|z| z.im >= 0.0));
        add_zeros(&self.system().without_delay(), starts);
    }

    fn further_starts(self, tau: f64, line: f64, starts: &mut Vec<Complex64>) {
        if let Some(slow) = self.system().slow(tau) {
            add_zeros(&slow, starts);
        }
        grid(self.system(), tau, line, starts);
    }

    fn eigenvalues(self, tau: f64, nodes: usize) -> Option<Vec<Complex64>> {
        self.system().eigenvalues(tau, nodes)
    }
}

/// Most starts of a grid.
const MOST_IN_GRID: f64 = 8192.0;
/// Columns of a grid.
const COLUMNS: u32 = 8;

/// Appends the points of a grid over the part of the plane where roots right of `line` can be, with
/// two rows to a turn of e^(−λτ).
fn grid(system: &System, tau: f64, line: f64, starts: &mut Vec<Complex64>) {
    let radius = system.root_bound(tau, line);
    let width = radius - line;
    if !(width.is_finite() && width > 0.0) {
        return;
    }
    let span = tau + system.latency();
    let rows = (radius * span / PI * 2.0)
        .ceil()
        .min(MOST_IN_GRID / f64::from(COLUMNS));
    for row in 0..=rows as u32 {
        for column in 0..COLUMNS {
            // Denser near the line, where most roots are.
            let part = f64::from(column) / f64::from(COLUMNS);
            let re = line + width * part * part * part;
            let im = 0.5 * PI / span * f64::from(row);
            starts.push(Complex64::new(re, im));
        }
    }
}

/// Appends the zeros of `of` in the upper half-plane and on the real axis.
fn add_zeros(of: &Polynomial, starts: &mut Vec<Complex64>) {
    let settled = of.without_open_leading();
    let zeros = Zeros::of(&settled);
    let centres = zeros.discs().iter().map(|d| d.centre);
    starts.extend(centres.filter(|z| z.im >= 0.0));
}
