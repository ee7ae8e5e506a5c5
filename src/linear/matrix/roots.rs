//! What is told of the roots of a system of matrices, in its own unit of time.

use std::cell::OnceCell;

use super::MatrixSystem;
use super::rightmost::BESIDE;
use crate::linear::count::{Count, MarginalTolerance};
use crate::linear::general::{DelayLine, Reason, RightOf, Spectrum};
use crate::linear::line::{Line, Roots};
use crate::linear::newton::Root;
use crate::linear::spectrum::Incomplete;

/// The margins that a certificate tries, relative, the least first.
const MARGINS: [f64; 5] = [1e-12, 1e-10, 1e-9, 1e-8, 1e-6];

/// The roots of a system of matrices.
pub struct MatrixRoots {
    /// The system in its own unit of time.
    of: MatrixSystem,
    /// That unit.
    unit: f64,
    /// All delays, in the unit of the system as it was given.
    line: OnceCell<DelayLine>,
}

impl MatrixRoots {
    /// The roots of `of`.
    #[must_use]
    pub fn new(of: MatrixSystem) -> Self {
        let unit = of.time_unit();
        Self {
            of: of.in_unit(unit),
            unit,
            line: OnceCell::new(),
        }
    }

    /// All delays.
    #[must_use]
    pub fn delays(&self) -> DelayLine {
        self.known().clone()
    }

    /// All delays, found when they are first asked for.
    fn known(&self) -> &DelayLine {
        self.line
            .get_or_init(|| self.of.line().in_physical_time(self.unit))
    }

    /// The rightmost roots at the delay `tau`, of which the unstable ones are counted by `line`.
    #[must_use]
    pub fn on_line(&self, line: &DelayLine, tau: f64, wanted: usize) -> Spectrum {
        let mut spectrum = Spectrum {
            count: Line::count(line, tau, MarginalTolerance::default()),
            roots: Vec::new(),
            abscissa: f64::NAN,
            essential_abscissa: f64::NEG_INFINITY,
            margin: f64::NAN,
            certified: false,
            reason: line.reason_at(tau),
            missing: None,
        };
        self.find(tau / self.unit, wanted.max(1), &mut spectrum);
        spectrum.scale(1.0 / self.unit);
        spectrum
    }

    /// Finds the roots at the delay `tau`, in the unit of the system.
    fn find(&self, tau: f64, wanted: usize, spectrum: &mut Spectrum) {
        spectrum.essential_abscissa = self.of.essential_abscissa(tau);
        if spectrum.count.is_none() {
            return;
        }
        let essential = spectrum.essential_abscissa;
        if essential.is_finite() {
            let beside = essential + BESIDE * essential.abs().max(1.0 / tau);
            if self.of.number_right_of(tau, beside) == Some(0) {
                spectrum.abscissa = essential;
                spectrum.margin = beside - essential;
                spectrum.certified = spectrum.count.is_some_and(|count| count.stable());
                spectrum.reason = spectrum.reason.or(Some(Reason::NoRightmostRoot));
                return;
            }
        }
        let (roots, complete) = self.of.rightmost(tau, wanted);
        spectrum.roots = roots;
        if !complete {
            let last = spectrum.roots.last();
            let line = last.map_or(f64::NEG_INFINITY, |root| root.lambda.re);
            spectrum.missing = Some(Incomplete { line });
        }
        self.certify(tau, spectrum);
    }

    /// Counts on both sides of the rightmost root.
    fn certify(&self, tau: f64, spectrum: &mut Spectrum) {
        let Some(first) = spectrum.roots.first() else {
            return;
        };
        let abscissa = first.lambda.re;
        spectrum.abscissa = abscissa;
        let unit = abscissa.abs().max(1.0);
        let right_of = |line: f64| self.of.number_right_of(tau, line);
        let clear = MARGINS.into_iter().find(|margin| {
            right_of(abscissa + margin * unit) == Some(0)
                && right_of(abscissa - margin * unit).is_some_and(|number| number > 0)
        });
        if let (Some(margin), Some(count)) = (clear, spectrum.count) {
            spectrum.margin = margin;
            let apart = abscissa.abs() > margin * unit;
            let found = spectrum.roots.iter().filter(|root| root.lambda.re > 0.0);
            let seen: u64 = found.map(Root::count).sum();
            let agrees = (count.n_unstable > 0) == (abscissa > 0.0) && seen <= count.n_unstable;
            let beyond = self.of.walked(tau, abscissa + margin * unit);
            spectrum.certified = agrees && apart && !count.marginal && beyond == RightOf::Roots(0);
        }
    }
}

impl Roots for MatrixRoots {
    fn line(&self, time_unit: f64) -> Box<dyn Line> {
        Box::new(self.delays().in_physical_time(time_unit))
    }

    fn count(&self, tau: f64, time_unit: f64) -> Option<Count> {
        Line::count(self.known(), tau / time_unit, MarginalTolerance::default())
    }

    fn spectrum(&self, tau: f64, wanted: usize) -> Spectrum {
        self.on_line(self.known(), tau, wanted)
    }

    fn essential_abscissa(&self, tau: f64) -> f64 {
        self.of.essential_abscissa(tau / self.unit) / self.unit
    }

    /// By the argument of det M, which shares nothing with the crossings.
    fn right_of(&self, tau: f64, line: f64) -> RightOf {
        if self.known().reason == Some(Reason::Infinite) && tau > 0.0 {
            return RightOf::Infinite;
        }
        self.of.walked(tau / self.unit, line * self.unit)
    }

    fn uncontrolled(&self) -> bool {
        self.of.signals() == 0
    }
}
