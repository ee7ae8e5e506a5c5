//! Settings of fastest decay in physical units, for a point of parameter space and for the planes
//! of a sweep: over the delay and a gain of the block, or a parameter of a system from a file, or
//! over two such parameters at one delay.

use std::cell::RefCell;
use std::f64::consts::TAU;

pub use super::robust::{RobustSetting, robust_setting};
use super::search_plane::SearchPlane;
use crate::linear::best::{
    self, Across, Best, General, Letter, Optimum, Region, Search, SearchedGain,
};
use crate::linear::lobes::minimal_negative_load_gain;
use crate::model::ModelError;
use crate::model::stop::Stop;
use crate::setting::best_plane::searched_gain;
use crate::setting::no_answer::NoAnswer;
use crate::setting::parameter::Parameter;
use crate::setting::quantity::Quantity;
use crate::setting::system::{Evaluation, SystemModel};
use crate::setting::values::Setting;

/// Largest |b| for which best settings are searched.
const STEEPEST: f64 = 1e4;

/// Range of delays by default, in periods: 2π√(M/κ) of the free oscillator, or those of the slowest
/// swing without delay of a system from a file.
const PERIODS: f64 = 4.0;
/// Range of the gain of velocity control by default, in units of the larger of 1 and |b|. Without
/// dashpots the best settings lie far inside, at −0.16 to −0.32 for −0.73 < b < 0. With one beside
/// the spring there are others at short delays and large gains, which have to be asked for.
const FARTHEST_VELOCITY: f64 = 2.0;
/// Range of the load gain by default, beyond 0 and beyond the weakest negative gain that
/// stabilises, in units of 1 + |b|. The triple real root lies at half of that or less.
const BEYOND_FOLD: f64 = 4.0;
/// Range by default of a parameter without bounds of a system from a file: so far on either side of
/// 0, over the size of its default or 1.
const FARTHEST: f64 = 4.0;
/// Where gains of 0 would drop a part of a controller, so far beside 0 is searched, over the range.
const BESIDE_ZERO: f64 = 1e-9;
/// Range of the memory by default: how near to ±1.
const MOST_MEMORY: f64 = 0.95;

/// The ranges of a search by [`best_settings`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ranges {
    /// Values of the first parameter that is searched, such as a gain, from ≤ to.
    pub p: (f64, f64),
    /// Values of the second one, from ≤ to; delays from 0 on.
    pub q: (f64, f64),
}

/// A stable region of the plane that is searched, with its own best setting.
#[derive(Debug, Clone, PartialEq)]
pub struct BestRegion {
    /// Its extent, at the resolution of [`crate::linear::best`].
    pub ranges: Ranges,
    /// The setting of fastest decay in it.
    pub best: Optimum,
}

/// The best settings of a plane; everything in the units of the parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct BestSettings {
    /// The setting of fastest decay or, where none is stable, of slowest growth.
    pub overall: Optimum,
    /// Every stable region, ordered by its smallest value of the second parameter.
    pub regions: Vec<BestRegion>,
    /// Number of further regions, which were not searched or decay within rounding.
    pub regions_left_out: usize,
}

/// Converts dimensionless numbers to physical ones. Systems from files are as they are.
pub(super) struct Scales {
    /// Of the first parameter.
    pub(super) p: f64,
    /// Of the second one.
    pub(super) q: f64,
    pub(super) time: f64,
}

impl Scales {
    pub(super) fn of(setting: &Setting, plane: &SearchPlane) -> Result<Self, ModelError> {
        let oscillator = setting.oscillator()?;
        let time = oscillator.time_unit();
        Ok(Self {
            p: match gain_of(&plane.p) {
                Some(SearchedGain::Velocity) => 1.0 / time,
                Some(SearchedGain::Load) => oscillator.stiffness() / setting.sliding_point()?.mu_k,
                None => 1.0,
            },
            q: if plane.has_delay() { time } else { 1.0 },
            time,
        })
    }

    /// Converts an optimum. It is kept inside `ranges`, which rounding could leave.
    fn optimum(&self, found: &Optimum, ranges: &Ranges) -> Optimum {
        let (p, q) = (ranges.p, ranges.q);
        Optimum {
            p: (found.p * self.p).clamp(p.0, p.1),
            q: (found.q * self.q).clamp(q.0, q.1),
            abscissa: found.abscissa / self.time,
            margin: found.margin / self.time,
            frequencies: found.frequencies.iter().map(|f| f / self.time).collect(),
            ..found.clone()
        }
    }
}

pub(super) fn scaled((from, to): (f64, f64), by: f64) -> (f64, f64) {
    (from * by, to * by)
}

/// The gain of the block that is searched.
fn gain_of(searched: &Quantity) -> Option<SearchedGain> {
    searched.known().and_then(searched_gain)
}

/// The default ranges of a search at `setting`.
///
/// Of the block. Delays: up to four periods of the free oscillator. Dimensionless gains for
/// velocity control: ±2 max(1, |b|). For load control they reach from 4(1 + |b|) below the weakest
/// negative gain that stabilises, −(b²/2 + |b|), to 4(1 + |b|).
///
/// Of a system from a file. Delays: up to four periods of the slowest swing that it has without
/// delay, or up to 8π where nothing swings. The parameter: its own range, where that has ends; else
/// up to 4 max(1, |default|) on either side of 0, as far as the range goes.
///
/// # Errors
/// When a parameter of `setting` is outside the model's range.
pub fn default_ranges(setting: &Setting, plane: &SearchPlane) -> Result<Ranges, ModelError> {
    let Some(gain) = gain_of(&plane.p) else {
        return Ok(ranges_of_system(setting, plane));
    };
    let scales = Scales::of(setting, plane)?;
    let slope = letter(setting, gain)?.fixed.b.abs();
    let gains = match gain {
        SearchedGain::Velocity => {
            let farthest = FARTHEST_VELOCITY * slope.max(1.0);
            (-farthest, farthest)
        }
        SearchedGain::Load => {
            let beyond = BEYOND_FOLD * (1.0 + slope);
            (minimal_negative_load_gain(slope) - beyond, beyond)
        }
    };
    Ok(Ranges {
        p: scaled(gains, scales.p),
        q: (0.0, PERIODS * TAU * scales.time),
    })
}

/// The default ranges of a search of a system from a file.
fn ranges_of_system(setting: &Setting, plane: &SearchPlane) -> Ranges {
    let longest = longest_delay(setting);
    let range = |of: &Quantity| range_of(of, longest);
    Ranges {
        p: range(&plane.p),
        q: range(&plane.q),
    }
}

/// The longest delay of a search of a system from a file by default.
#[must_use]
pub fn longest_delay(setting: &Setting) -> f64 {
    let mut without_delay = setting.clone();
    without_delay.set(Parameter::Tau, 0.0);
    let linear = without_delay.linear().ok();
    let system = linear.and_then(|(model, _)| model.system());
    let frequencies = system.map(|system| system.frequencies_without_delay());
    let slowest = frequencies.into_iter().flatten().min_by(f64::total_cmp);
    PERIODS * TAU / slowest.unwrap_or(1.0)
}

/// The default range of a search of a system from a file over one of its parameters, or over the
/// delay up to `longest`.
fn range_of(searched: &Quantity, longest: f64) -> (f64, f64) {
    match searched {
        Quantity::Own(own) => {
            let far = FARTHEST * own.default.abs().max(1.0);
            match own.ends() {
                (Some(low), Some(high)) => (low, high),
                (Some(low), None) => (low, far.max(low + far)),
                (None, Some(high)) => ((-far).min(high - far), high),
                (None, None) => (-far, far),
            }
        }
        Quantity::Known(Parameter::Memory) => (-MOST_MEMORY, MOST_MEMORY),
        Quantity::Known(_) => (0.0, longest),
    }
}

/// The family of `setting` with the letter's own feedback. It is an error if |b| is so large that
/// no search resolves the delays of the optima.
pub(super) fn letter(setting: &Setting, gain: SearchedGain) -> Result<Letter, ModelError> {
    let (oscillator, sliding) = (setting.oscillator()?, setting.sliding_point()?);
    let family = Letter::of(&oscillator, sliding, setting.control(), gain);
    let dashpots = family.dashpots.sum();
    ModelError::check(
        "mu_prime",
        sliding.mu_prime,
        "such that |mu_prime| N0/sqrt(kappa M) is at most 1e4 where best settings are searched",
        family.slope().abs() <= STEEPEST,
    )?;
    let [one, other] = Parameter::DASHPOTS;
    let larger = match setting.get(one) >= setting.get(other) {
        true => one,
        false => other,
    };
    ModelError::check(
        larger.name(),
        setting.get(larger),
        "such that (damping + viscous)/sqrt(kappa M) is at most 1e4 where best settings are \
            searched",
        dashpots <= STEEPEST,
    )?;
    Ok(family)
}

/// A copy of `setting` in which what is searched acts.
pub(super) fn acting(setting: &Setting, searched: &Quantity) -> Setting {
    let mut acting = setting.clone();
    acting.vary(searched, 1.0);
    acting
}

/// The settings of fastest decay for every stable region within `ranges`. All parameters but those
/// of `plane` are those of `setting`. Once `stop` is set, the answer comes soon but is meaningless.
///
/// ```
/// use slipmap::answers::best::{best_settings, default_ranges};
/// use slipmap::answers::search_plane::SearchPlane;
/// use slipmap::model::stop::Stop;
/// use slipmap::setting::{Parameter, Setting};
///
/// let numbers = [("mu_prime", -0.3), ("tau", 1.0), ("alpha_v", -0.3)];
/// let setting = Setting::checked(numbers, None, &[])?;
/// let plane = SearchPlane::with_delay(Parameter::AlphaV);
/// let ranges = default_ranges(&setting, &plane)?;
/// let found = best_settings(&setting, &plane, &ranges, &Stop::default())?;
/// assert!(found.overall.abscissa < 0.0, "some setting is stable");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When a parameter of `setting` is outside the model's range, or nothing is known of the model in
/// the middle of the ranges.
pub fn best_settings(
    setting: &Setting,
    plane: &SearchPlane,
    ranges: &Ranges,
    stop: &Stop,
) -> Result<BestSettings, NoAnswer> {
    let scales = Scales::of(setting, plane)?;
    if let Some(gain) = gain_of(&plane.p)
        && acting(setting, &plane.p).feedback().is_sampled()
    {
        let found = scales.best_of_samples(setting, gain, ranges, stop)?;
        return Ok(scales.settings(&found, ranges));
    }
    let letter = gain_of(&plane.p).map(|gain| letter(setting, gain));
    let found = scales.best(letter.transpose()?, setting, plane, ranges, stop)?;
    Ok(scales.settings(&found, ranges))
}

impl Scales {
    pub(super) fn search<F>(&self, family: F, ranges: &Ranges) -> Search<F> {
        Search {
            family,
            p: scaled(ranges.p, 1.0 / self.p),
            q: scaled(ranges.q, 1.0 / self.q),
        }
    }

    /// The best settings, of the letter's own feedback or of any linear model.
    pub(super) fn best(
        &self,
        letter: Option<Letter>,
        setting: &Setting,
        plane: &SearchPlane,
        ranges: &Ranges,
        stop: &Stop,
    ) -> Result<Best, NoAnswer> {
        match letter {
            Some(family) if acting(setting, &plane.p).is_of_letter() => {
                Ok(best::best(&self.search(family, ranges), stop))
            }
            _ => self.in_any(setting, plane, ranges, |search| best::best(search, stop)),
        }
    }

    /// What `of` finds in the plane of any linear model.
    pub(super) fn in_any<T>(
        &self,
        setting: &Setting,
        plane: &SearchPlane,
        ranges: &Ranges,
        of: impl FnOnce(&Search<General>) -> T,
    ) -> Result<T, NoAnswer> {
        let moved = RefCell::new((setting.clone(), Evaluation::default()));
        // Where a part of a controller vanishes the plane has a point or a line of its own.
        let drops_parts = setting.system().is_some_and(SystemModel::drops_parts);
        let beside = |value: f64, (from, to): (f64, f64)| match value == 0.0 && drops_parts {
            true if to > 0.0 => BESIDE_ZERO * (to - from),
            true => BESIDE_ZERO * (from - to),
            false => value,
        };
        let set = |setting: &mut Setting, p: f64, q: f64| {
            setting.vary(&plane.p, beside(p * self.p, ranges.p));
            match plane.has_delay() {
                true => setting.set(Parameter::Tau, q * self.q),
                false => setting.vary(&plane.q, beside(q, ranges.q)),
            }
        };
        let system_at = |p: f64, q: f64| {
            let (setting, scratch) = &mut *moved.borrow_mut();
            set(setting, p, q);
            let (model, _) = setting.linear_in(scratch).ok()?;
            model.system()
        };
        let (p, q) = (
            scaled(ranges.p, 1.0 / self.p),
            scaled(ranges.q, 1.0 / self.q),
        );
        let family = General {
            system_at: &system_at,
            across: match plane.has_delay() {
                true => Across::Delay {
                    lines: setting.has_lines(),
                },
                false => Across::Parameter {
                    tau: setting.get(Parameter::Tau) / self.time,
                    width: q.1 - q.0,
                },
            },
            width: p.1 - p.0,
        };
        let middle = |(from, to): (f64, f64)| 0.5 * (from + to);
        let mut in_the_middle = setting.clone();
        set(&mut in_the_middle, middle(p), middle(q));
        in_the_middle.searched()?;
        // Where a gain in the middle is 0 any matrices are P and Q.
        let mut at_the_end = setting.clone();
        set(&mut at_the_end, p.1, q.1);
        if let Some(of) = at_the_end.without_curves() {
            return Err(NoAnswer::Unsearched(of));
        }
        Ok(of(&Search { family, p, q }))
    }

    pub(super) fn settings(&self, found: &Best, ranges: &Ranges) -> BestSettings {
        let region = |region: &Region| BestRegion {
            ranges: Ranges {
                p: scaled(region.p, self.p),
                q: scaled(region.q, self.q),
            },
            best: self.optimum(&region.best, ranges),
        };
        BestSettings {
            overall: self.optimum(&found.overall, ranges),
            regions: found.regions.iter().map(region).collect(),
            regions_left_out: found.regions_left_out,
        }
    }
}
