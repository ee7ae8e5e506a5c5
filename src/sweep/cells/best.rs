//! Settings of fastest decay in physical units, for a point of parameter space and for the planes
//! of a sweep.

use std::cell::RefCell;

use super::boundaries::plane_spanned;
use crate::linear::best::{
    self, Best, General, Letter, Optimum, Region, Robust, Search, SearchedGain,
};
use crate::linear::lobes::minimal_negative_load_gain;
use crate::model::stop::Stop;
use crate::model::{Groups, ModelError};
use crate::sweep::input::best_plane::{parameter_of, searched_gain};
use crate::sweep::input::parameter::Parameter;
use crate::sweep::input::setting::Setting;
use crate::sweep::plan::Plan;

/// Largest |b| for which best settings are searched.
const STEEPEST: f64 = 1e4;

/// Range of delays by default, in periods 2π√(M/κ) of the free oscillator.
const PERIODS: f64 = 4.0;
/// Range of the gain of velocity control by default, in units of the larger of 1 and |b|. The best
/// settings lie far inside, at −0.16 to −0.32 for −0.73 < b < 0.
const FARTHEST_VELOCITY: f64 = 2.0;
/// Range of the load gain by default, beyond 0 and beyond the weakest negative gain that
/// stabilises, in units of 1 + |b|. The triple real root lies at half of that or less.
const BEYOND_FOLD: f64 = 4.0;

/// The ranges of a search by [`best_settings`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ranges {
    /// Gains, from ≤ to.
    pub gain: (f64, f64),
    /// Delays, 0 ≤ from ≤ to.
    pub tau: (f64, f64),
}

/// A stable region of the plane of gain and delay, with its own best setting.
#[derive(Debug, Clone, PartialEq)]
pub struct BestRegion {
    /// Its extent, at the resolution of [`crate::linear::best`].
    pub ranges: Ranges,
    /// The setting of fastest decay in it.
    pub best: Optimum,
}

/// The best settings of a plane (gain, delay); everything in the units of the parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct BestSettings {
    /// The setting of fastest decay or, where none is stable, of slowest growth.
    pub overall: Optimum,
    /// Every stable region, ordered by its shortest delay.
    pub regions: Vec<BestRegion>,
    /// Number of further regions, which were not searched or decay within rounding.
    pub regions_left_out: usize,
}

/// Converts dimensionless gains and delays to physical ones.
struct Scales {
    gain: f64,
    time: f64,
}

impl Scales {
    fn of(setting: &Setting, gain: SearchedGain) -> Result<Self, ModelError> {
        let oscillator = setting.oscillator()?;
        let time = oscillator.time_unit();
        Ok(Self {
            gain: match gain {
                SearchedGain::Velocity => 1.0 / time,
                SearchedGain::Load => oscillator.stiffness() / setting.sliding_point()?.mu_k,
            },
            time,
        })
    }

    /// Converts an optimum. It is kept inside `ranges`, which rounding could leave.
    fn optimum(&self, found: &Optimum, ranges: &Ranges) -> Optimum {
        let (gain, tau) = (ranges.gain, ranges.tau);
        Optimum {
            gain: (found.gain * self.gain).clamp(gain.0, gain.1),
            tau: (found.tau * self.time).clamp(tau.0, tau.1),
            abscissa: found.abscissa / self.time,
            margin: found.margin / self.time,
            frequencies: found.frequencies.iter().map(|f| f / self.time).collect(),
            ..found.clone()
        }
    }
}

fn scaled((from, to): (f64, f64), by: f64) -> (f64, f64) {
    (from * by, to * by)
}

/// The default ranges of a search at `setting`. Delays: up to four periods of the free oscillator.
/// Dimensionless gains for velocity control: ±2 max(1, |b|). For load control they reach from 4(1 +
/// |b|) below the weakest negative gain that stabilises, −(b²/2 + |b|), to 4(1 + |b|).
///
/// # Errors
/// When a parameter of `setting` is outside the model's range.
pub fn default_ranges(setting: &Setting, gain: SearchedGain) -> Result<Ranges, ModelError> {
    let scales = Scales::of(setting, gain)?;
    let slope = moderate_slope(setting)?.b.abs();
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
        gain: scaled(gains, scales.gain),
        tau: (0.0, PERIODS * std::f64::consts::TAU * scales.time),
    })
}

/// The groups of `setting`. It is an error if |b| is so large that no search resolves the delays of
/// the optima.
fn moderate_slope(setting: &Setting) -> Result<Groups, ModelError> {
    let sliding = setting.sliding_point()?;
    let groups = setting.oscillator()?.groups(sliding, setting.control());
    let mu_prime = sliding.mu_prime;
    ModelError::check(
        "mu_prime",
        mu_prime,
        "such that |mu_prime| N0/sqrt(kappa M) is at most 1e4 where best settings are searched",
        groups.b.abs() <= STEEPEST,
    )?;
    Ok(groups)
}

/// The settings of fastest decay for every stable region within `ranges`. All parameters but `gain`
/// and the delay are those of `setting`. Once `stop` is set, the answer comes soon but is
/// meaningless.
///
/// # Errors
/// When a parameter of `setting` is outside the model's range.
pub fn best_settings(
    setting: &Setting,
    gain: SearchedGain,
    ranges: &Ranges,
    stop: &Stop,
) -> Result<BestSettings, ModelError> {
    let scales = Scales::of(setting, gain)?;
    let search = scales.search(setting, gain, ranges)?;
    let of_letter = !setting.has_state() && beyond_letter(setting).is_none();
    let found = if of_letter {
        best::best(&search, stop)
    } else {
        scales.beyond_letter(setting, &search, stop)?
    };
    Ok(scales.settings(&found, ranges))
}

/// The first parameter by which the feedback is beyond the letter's own, whatever the gains are.
fn beyond_letter(setting: &Setting) -> Option<Parameter> {
    let mut all = Parameter::BEYOND_LETTER.into_iter();
    all.find(|&parameter| setting.get(parameter) != 0.0)
}

/// The best setting under joint errors of gain, delay and μ′.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RobustSetting {
    /// The largest relative error of each.
    pub spread: f64,
    /// The setting, with its slowest decay under these errors; in the units of the parameters.
    pub robust: Robust,
    /// The slowest decay around the setting of fastest decay, under the same errors, and whether it
    /// is proved.
    pub worst_of_best: (f64, bool),
}

/// The best settings within `ranges`, as from [`best_settings`], and the most robust one under
/// relative errors of up to `spread`, 0 < `spread` < 1, of gain, delay and μ′. None for the latter
/// where no setting stays stable.
///
/// # Errors
/// When a parameter of `setting` is outside the model's range, or beyond the letter: there W is not
/// proved.
pub fn robust_setting(
    setting: &Setting,
    gain: SearchedGain,
    ranges: &Ranges,
    spread: f64,
) -> Result<(BestSettings, Option<RobustSetting>), ModelError> {
    let scales = Scales::of(setting, gain)?;
    let allowed = "0 where a robust setting is searched for";
    setting.check_of_letter(&[], allowed)?;
    // Also where the gains of `setting` are 0: they are searched.
    if let Some(parameter) = beyond_letter(setting) {
        return Err(ModelError {
            parameter: parameter.name(),
            value: setting.get(parameter),
            allowed,
        });
    }
    let search = scales.search(setting, gain, ranges)?;
    let found = best::best(&search, &Stop::default());
    let robust = best::robust(&search, &found, spread).map(|robust| {
        let best = &found.overall;
        let (worst, proved) = best::worst_around(&search, best.gain, best.tau, spread);
        RobustSetting {
            spread,
            robust: Robust {
                gain: robust.gain * scales.gain,
                tau: robust.tau * scales.time,
                abscissa: robust.abscissa / scales.time,
                worst_abscissa: robust.worst_abscissa / scales.time,
                ..robust
            },
            worst_of_best: (worst / scales.time, proved),
        }
    });
    Ok((scales.settings(&found, ranges), robust))
}

impl Scales {
    fn search(
        &self,
        setting: &Setting,
        gain: SearchedGain,
        ranges: &Ranges,
    ) -> Result<Search<Letter>, ModelError> {
        Ok(Search {
            family: Letter {
                fixed: moderate_slope(setting)?,
                gain,
            },
            gains: scaled(ranges.gain, 1.0 / self.gain),
            delays: scaled(ranges.tau, 1.0 / self.time),
        })
    }

    /// The search with all that `setting` has beyond the letter.
    fn beyond_letter(
        &self,
        setting: &Setting,
        search: &Search<Letter>,
        stop: &Stop,
    ) -> Result<Best, ModelError> {
        let gain = parameter_of(search.family.gain);
        // What is wrong with the setting is wrong at every gain.
        setting.linear()?;
        let moved = RefCell::new(setting.clone());
        let system_at = |value: f64, _tau: f64| {
            let mut moved = moved.borrow_mut();
            moved.set(gain, value * self.gain);
            let (model, _) = moved.linear().ok()?;
            Some(model.system())
        };
        let search = Search {
            family: General {
                system_at: &system_at,
                lines: true,
                width: search.gains.1 - search.gains.0,
            },
            gains: search.gains,
            delays: search.delays,
        };
        Ok(best::best(&search, stop))
    }

    fn settings(&self, found: &Best, ranges: &Ranges) -> BestSettings {
        let region = |region: &Region| BestRegion {
            ranges: Ranges {
                gain: scaled(region.gains, self.gain),
                tau: scaled(region.delays, self.time),
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

/// The place of the `number`-th plane of best settings, as indices along every axis.
#[must_use]
pub fn best_plane(plan: &Plan, number: u64) -> Vec<usize> {
    plane_spanned(plan, plan.best_plane(), number)
}

/// The best settings of a plan in the plane at `index`; none where a parameter is outside the
/// model's range. Once `stop` is set, the answer comes soon but is meaningless.
#[must_use]
pub fn best_of_plane(plan: &Plan, index: &[usize], stop: &Stop) -> Option<BestSettings> {
    let (p, tau) = plan.best_plane()?;
    let axes = &plan.spec.axes;
    let ranges = Ranges {
        gain: axes[p].range(),
        tau: axes[tau].range(),
    };
    let gain = searched_gain(axes[p].parameter.known()?)?;
    best_settings(&plan.setting(index), gain, &ranges, stop).ok()
}
