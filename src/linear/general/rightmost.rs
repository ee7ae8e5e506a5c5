//! The spectral abscissa of a general system: that of its rightmost roots, or where roots
//! accumulate.

use super::line::DelayLine;
use super::reason::Reason;
use super::right_of::RootCounter;
use super::system::System;
use super::turning::RightOf;
use crate::linear::count::{Count, MarginalTolerance};
use crate::linear::newton::Root;
use crate::linear::rightmost::Rightmost;
use crate::linear::spectrum::Incomplete;

/// How near to the line at which roots accumulate a root is told from it, in units of 1/τ.
const BESIDE: f64 = 1e-9;

/// Lines between the axis and the one at which roots accumulate, as parts of the way.
const FARTHER: [f64; 4] = [0.0, 0.5, 0.9, 0.99];

/// What is known of the roots at one delay.
#[derive(Debug, Clone)]
pub struct Spectrum {
    /// The number of unstable roots; none where it is infinite or not known.
    pub count: Option<Count>,
    /// The rightmost roots by falling real part, pairs counted once.
    pub roots: Vec<Root>,
    /// The largest real part, or its supremum; NaN where it is not known.
    pub abscissa: f64,
    /// Where roots accumulate: ln ρ/τ, −∞ in retarded equations.
    pub essential_abscissa: f64,
    /// The margin within which the abscissa is known: no root lies right of the abscissa +
    /// margin·max(1, |abscissa|); NaN where nothing is known.
    pub margin: f64,
    /// Whether the argument principle confirms the abscissa within the margin, and the number of
    /// unstable roots.
    pub certified: bool,
    /// What is special about the setting.
    pub reason: Option<Reason>,
    /// What was not found, if anything.
    pub missing: Option<Incomplete>,
}

/// A line right of the one at which the roots of `system` accumulate at the delay `tau`, as near as
/// roots are told from it; none where they accumulate nowhere.
#[must_use]
pub(crate) fn beside_accumulation(system: &System, tau: f64) -> Option<f64> {
    let essential = system.essential_abscissa(tau);
    let beside = essential + BESIDE * essential.abs().max(1.0 / tau);
    beside.is_finite().then_some(beside)
}

/// The line of [`beside_accumulation`], where no root lies right of it; none where one does, or
/// where that is not known.
#[must_use]
pub(crate) fn nothing_beyond_accumulation(counter: &RootCounter, tau: f64) -> Option<f64> {
    let beside = beside_accumulation(counter.system(), tau)?;
    counter.begin();
    if counter.system().latency() > 0.0 {
        // So near to that line a count takes long, and one root farther right is enough.
        let essential = counter.system().essential_abscissa(tau);
        let farther = FARTHER.map(|part| part * essential).into_iter();
        let root = |line| matches!(counter.right_of(tau, line), RightOf::Roots(1..));
        if farther.filter(|line| *line > beside).any(root) {
            return None;
        }
    }
    (counter.right_of(tau, beside) == RightOf::Roots(0)).then_some(beside)
}

/// The margin of an abscissa in units in which it is `by` times as large: relative to the larger of
/// 1 and of its size.
#[must_use]
pub(crate) fn scaled_margin(margin: f64, abscissa: f64, by: f64) -> f64 {
    if by == 1.0 {
        return margin;
    }
    let distance = margin * abscissa.abs().max(1.0);
    distance * by / (abscissa * by).abs().max(1.0)
}

impl Spectrum {
    /// The `wanted` rightmost roots, at least one, at the delay `tau` ≥ 0 of the line `line` of the
    /// system of `counter`.
    #[must_use]
    pub fn at(counter: &RootCounter, line: &DelayLine, tau: f64, wanted: usize) -> Self {
        let unit = counter.system().time_unit();
        if unit == 1.0 {
            return Self::in_unit(counter, line, (tau, unit), wanted);
        }
        let counter = counter.in_unit(unit);
        let mut spectrum = Self::in_unit(&counter, line, (tau / unit, unit), wanted);
        spectrum.scale(1.0 / unit);
        spectrum
    }

    /// These roots times `by`.
    pub(in crate::linear) fn scale(&mut self, by: f64) {
        self.margin = scaled_margin(self.margin, self.abscissa, by);
        self.abscissa *= by;
        self.essential_abscissa *= by;
        for root in &mut self.roots {
            root.lambda *= by;
            root.error *= by;
        }
        if let Some(missing) = &mut self.missing {
            missing.line *= by;
        }
    }

    /// The roots at the delay `tau` in units of `unit`; the times of `line` are not in that unit.
    fn in_unit(
        counter: &RootCounter,
        line: &DelayLine,
        (tau, unit): (f64, f64),
        wanted: usize,
    ) -> Self {
        let essential_abscissa = counter.system().essential_abscissa(tau);
        let mut spectrum = Self {
            count: None,
            roots: Vec::new(),
            abscissa: f64::NAN,
            essential_abscissa,
            margin: f64::NAN,
            certified: false,
            reason: line.reason_at(tau * unit),
            missing: None,
        };
        if line.uncounted && tau > 0.0 {
            return spectrum;
        }
        let count = line.count(tau * unit, MarginalTolerance::default());
        spectrum.count = Some(count);
        if let Some(beside) = nothing_beyond_accumulation(counter, tau) {
            spectrum.abscissa = essential_abscissa;
            spectrum.margin = beside - essential_abscissa;
            spectrum.certified = count.n_unstable == 0 && !count.marginal;
            spectrum.reason = spectrum.reason.or(Some(Reason::NoRightmostRoot));
            return spectrum;
        }
        let mut found = Rightmost::at(counter, tau, wanted, count);
        // Fewer than are wanted may lie right of where they accumulate.
        let mut fewer = wanted;
        let accumulate = essential_abscissa.is_finite();
        while found.roots.is_empty() && fewer > 1 && accumulate && !counter.is_spent() {
            fewer -= 1;
            found = Rightmost::at(counter, tau, fewer, count);
        }
        spectrum.abscissa = found.roots.first().map_or(f64::NAN, |r| r.lambda.re);
        spectrum.margin = found.margin;
        spectrum.certified = found.certified;
        // With control and delay there are infinitely many roots.
        let none = found.roots.is_empty() && tau > 0.0 && !counter.system().uncontrolled();
        let line = f64::NEG_INFINITY;
        spectrum.missing = found.missing.or(none.then_some(Incomplete { line }));
        spectrum.roots = found.roots;
        spectrum
    }
}
