//! Linear stability of a linear model at a delay and over all others, with its roots.
//!
//! A margin or an end that does not exist is infinite here, and a number that is not known is NaN;
//! JSON has null for both.

use serde::Serialize;

use super::margin_kind::{MarginKind, sign};
use super::stable_line::{Latencies, ends};
use crate::linear::Direction;
use crate::linear::crossing::Crossing;
use crate::linear::general::reason::Reason;
use crate::linear::general::{self as linear, RightOf, System};
use crate::linear::line::{Linear, Roots};
use crate::linear::newton::Root;
use crate::model::stop::Stop;

/// Stability of a linear model at a delay.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct Stability {
    /// The number of characteristic roots with positive real part; null where there are infinitely
    /// many or it is not known, see `reason`.
    #[cfg_attr(feature = "serve", schema(required))]
    pub n_unstable: Option<u64>,
    /// Whether sliding is stable.
    pub stable: bool,
    /// Whether that is within rounding of a boundary, or the rightmost roots say otherwise than the
    /// count.
    pub marginal: bool,
    /// Why the point is special: `root-at-origin`, `root-on-axis`, `infinite`, `neutral-limit`,
    /// `no-rightmost-root`, `degree-unknown` or `refused`; null where it is not.
    #[cfg_attr(feature = "serve", schema(required))]
    pub reason: Option<&'static str>,
    /// All intervals of delays in which sliding is stable, by shortest delay; the end of the last
    /// one is null where it has none. Empty where it is stable at none, null where they are not
    /// known. Of a digital loop both ends are stable multiples of the sample time.
    #[cfg_attr(feature = "serve", schema(value_type = Option<Vec<[Option<f64>; 2]>>, required))]
    pub stable_delays: Option<Vec<[f64; 2]>>,
    /// Some are left out.
    pub stable_delays_truncated: bool,
    /// The distance in τ to the nearest change of stability, positive where stable; null where it
    /// never changes, and where it is not known. Of a digital loop to the nearest multiple of the
    /// sample time at which stability is another one.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub delay_margin: f64,
    /// What that distance is: `finite`, `infinite` or `unknown`.
    pub delay_margin_kind: MarginKind,
    /// The sign of that distance, also of an infinite one: 1 where stable, −1 where unstable, 0 on
    /// a boundary and where it is not known.
    pub delay_margin_sign: i8,
    /// The number of unstable roots as the delay goes to 0; null where there are infinitely many or
    /// it is not known.
    #[cfg_attr(feature = "serve", schema(required))]
    pub n_at_zero_delay: Option<u64>,
    /// The shortest delay at which roots cross the imaginary axis; null where they do at none.
    #[cfg_attr(feature = "serve", schema(required))]
    pub first_crossing: Option<f64>,
    /// By how much the number of unstable roots grows there; null where there is no such delay.
    #[cfg_attr(feature = "serve", schema(required))]
    pub first_change: Option<i8>,
    /// Where roots cross the imaginary axis as the delay grows; null where that is not known.
    #[cfg_attr(feature = "serve", schema(required))]
    pub crossings: Option<Vec<PointCrossing>>,
    /// The latencies at the point's delay.
    #[serde(flatten)]
    pub latencies: Latencies,
    /// The real part at which infinitely many roots accumulate; null where they do nowhere.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub essential_abscissa: f64,
    /// The sample time; none where the feedback is not read from time to time.
    #[serde(skip)]
    pub sample_time: Option<f64>,
    /// The rightmost roots.
    #[serde(flatten)]
    pub spectrum: Spectrum,
    /// Re λ of the line to the right of which roots are counted; null where none was requested.
    #[cfg_attr(feature = "serve", schema(required))]
    pub line: Option<f64>,
    /// The number of roots right of that line; null where none was asked for, where a root lies
    /// within rounding of it, and where there are infinitely many: it is less than
    /// `essential_abscissa`.
    #[cfg_attr(feature = "serve", schema(required))]
    pub n_right_of_line: Option<u64>,
}

/// A crossing frequency, with its delays `first_delay` + 2πk/ω.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct PointCrossing {
    /// ω.
    pub omega: f64,
    /// The shortest delay.
    pub first_delay: f64,
    /// Where the pair goes as the delay grows: `left`, `right` or `touch`.
    pub direction: &'static str,
}

/// The rightmost roots in physical units; none where nothing converged.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct Spectrum {
    /// The spectral abscissa; null where no root converged.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub abscissa: f64,
    /// |Im λ| of the rightmost root; null where no root converged, and where there is none.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub frequency: f64,
    /// Re λ and Im λ ≥ 0, by falling real part.
    pub roots: Vec<[f64; 2]>,
    /// Whether the argument principle confirms that none is missing.
    pub certified: bool,
    /// No root is farther right than abscissa + this times max(1/√(M/κ), |abscissa|); null where no
    /// root converged.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub certificate_margin: f64,
    /// Re λ of a vertical line, right of the rightmost root, that the argument principle finds no
    /// root right of; null where it does not tell.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub certified_line: f64,
    /// Why there are fewer roots than asked for.
    #[serde(skip)]
    pub fewer: Option<String>,
    /// Some were not found that are there.
    #[serde(skip)]
    pub incomplete: bool,
}

/// A question about a linear model.
#[derive(Debug, Clone, Copy)]
pub struct Wanted {
    /// The number of rightmost roots, 1 to 64.
    pub roots: u8,
    /// Re λ of a line to the right of which roots are counted.
    pub line: Option<f64>,
}

impl Stability {
    /// The stability of a linear model with the unit of time `time_unit`, at the delay `tau`. Once
    /// `stop` is set, the answer comes soon but is meaningless.
    #[must_use]
    pub fn of(model: &Linear, (time_unit, tau): (f64, f64), wanted: Wanted, stop: &Stop) -> Self {
        let mut stability = Self::with_roots(&*model.roots(stop), (time_unit, tau), wanted);
        if !stop.is_set() {
            let latencies = |system: &System| Latencies::of(system, (tau / time_unit, time_unit));
            let found = model.system().as_ref().map(latencies);
            stability.latencies = found.unwrap_or_default();
        }
        if let Linear::Sampled(of) = model {
            stability.sample_time = Some(of.sample_time * time_unit);
        }
        if stability.disputed(time_unit) {
            (stability.marginal, stability.stable) = (true, false);
        }
        stability
    }

    /// Whether the rightmost roots say otherwise than the count: one is unstable though none is
    /// counted, or none is though some are counted.
    fn disputed(&self, time_unit: f64) -> bool {
        let Spectrum {
            abscissa,
            certificate_margin,
            certified_line,
            ..
        } = self.spectrum;
        let Some(n) = self.n_unstable.filter(|_| abscissa.is_finite()) else {
            return false;
        };
        let none_right = match self.reason == Some(Reason::NoRightmostRoot.name()) {
            true => abscissa < 0.0,
            false => certified_line <= 0.0,
        };
        let unit = abscissa.abs().max(1.0 / time_unit);
        let some_right = abscissa > certificate_margin * unit;
        if n == 0 { some_right } else { none_right }
    }

    fn with_roots(roots: &dyn Roots, (time_unit, tau): (f64, f64), wanted: Wanted) -> Self {
        let at = tau / time_unit;
        let found = roots.spectrum(at, wanted.roots.into());
        let line = &*roots.line(time_unit);
        let count = roots.count(tau, time_unit);
        let (stable, truncated) = ends(&mut *line.stable_intervals());
        let delays_known = line.delays_known() && !(stable.is_empty() && truncated);
        let delay_margin = line.delay_margin(tau);
        let first = line.changes().next();
        let stable_here = count.is_some_and(|count| count.stable());
        let count_right = |line: f64| roots.right_of(at, line * time_unit).finite();
        Self {
            n_unstable: count.map(|count| count.n_unstable),
            // At ρ = 1 roots accumulate at the imaginary axis: never exponentially stable.
            stable: stable_here && found.reason != Some(Reason::NeutralLimit),
            marginal: count.is_some_and(|count| count.marginal)
                || found.reason == Some(Reason::RootAtOrigin),
            reason: found.reason.map(Reason::name),
            stable_delays: delays_known.then_some(stable),
            stable_delays_truncated: delays_known && truncated,
            delay_margin,
            delay_margin_kind: MarginKind::of(delay_margin),
            delay_margin_sign: sign(delay_margin),
            n_at_zero_delay: line.n_at_zero_delay(),
            sample_time: None,
            first_crossing: first.map(|change| change.tau),
            first_change: first.map(|change| change.by),
            crossings: line
                .crossings_known()
                .then(|| line.crossings().map(PointCrossing::of).collect()),
            latencies: Latencies::default(),
            essential_abscissa: found.essential_abscissa / time_unit,
            line: wanted.line,
            n_right_of_line: wanted.line.and_then(count_right),
            spectrum: Spectrum::of(roots, &found, (at, time_unit), wanted.roots),
        }
    }
}

impl PointCrossing {
    fn of(crossing: &Crossing) -> Self {
        Self {
            omega: crossing.omega,
            first_delay: crossing.delay(crossing.first_branch),
            direction: match crossing.direction {
                Direction::Left => "left",
                Direction::Right => "right",
                Direction::Touch => "touch",
            },
        }
    }
}

impl Spectrum {
    /// What was found at the dimensionless delay `tau`, in physical units.
    fn of(
        roots: &dyn Roots,
        found: &linear::Spectrum,
        (tau, time_unit): (f64, f64),
        wanted: u8,
    ) -> Self {
        let line = found.roots.first().map(|root| {
            let re = root.lambda.re;
            re + found.margin * re.abs().max(1.0)
        });
        let nothing_right = |line: &f64| roots.right_of(tau, *line) == RightOf::Roots(0);
        let physical = |root: &Root| [root.lambda.re / time_unit, root.lambda.im / time_unit];
        let listed: Vec<[f64; 2]> = found.roots.iter().map(physical).collect();
        let why = || match found.missing.as_ref() {
            Some(missing) => missing.to_string(),
            None => no_more(found.reason, tau == 0.0, roots.uncontrolled()).to_owned(),
        };
        Self {
            abscissa: found.abscissa / time_unit,
            frequency: listed.first().map_or(f64::NAN, |root| root[1]),
            fewer: (listed.len() < wanted.into()).then(why),
            roots: listed,
            certified: found.certified,
            certificate_margin: found.margin,
            certified_line: line
                .filter(nothing_right)
                .map_or(f64::NAN, |line| line / time_unit),
            incomplete: found.missing.is_some(),
        }
    }
}

/// Why there are fewer roots than requested although none is missing.
fn no_more(reason: Option<Reason>, without_delay: bool, uncontrolled: bool) -> &'static str {
    match (reason, without_delay, uncontrolled) {
        (Some(Reason::NoRightmostRoot), ..) => {
            "there is no rightmost one: roots accumulate at the abscissa from the left"
        }
        (Some(Reason::Infinite), ..) => "infinitely many roots lie right of the imaginary axis",
        (Some(Reason::DegreeUnknown), ..) => "the highest coefficient is within rounding of 0",
        (Some(Reason::Refused), ..) => "systems of this kind are not answered",
        (_, true, _) => "there are no others: the delay is 0",
        (_, _, true) => "there are no others without control",
        _ => "no others can be told from -infinity",
    }
}
