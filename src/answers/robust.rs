//! The best setting that stands joint errors of gain, delay and μ′, in physical units.

use super::best::{BestSettings, Ranges, Scales, acting, letter};
use super::margins::beyond_letter;
use super::search_plane::SearchPlane;
use crate::linear::best::{self, Best, Place, Rig, Robust, Search, SearchedGain};
use crate::linear::margins::Changes;
use crate::model::stop::Stop;
use crate::setting::best_plane::parameter_of;
use crate::setting::no_answer::NoAnswer;
use crate::setting::values::Setting;

/// What a sample time has to be where robust settings are searched.
const NOT_ROBUST: &str = "0 where a robust setting is searched (robust): leave one of them out";

/// The best setting under joint errors of gain, delay and μ′.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RobustSetting {
    /// The largest relative errors of gain, delay and μ′.
    pub spread: Changes,
    /// The setting, with its slowest decay under these errors; in the units of the parameters.
    pub robust: Robust,
    /// The slowest decay around the setting of fastest decay, under the same errors, and whether it
    /// is proved.
    pub worst_of_best: (f64, bool),
}

/// A plane of gain and delay whose best settings are found, in which robust ones are searched.
pub(super) struct RobustSearch {
    scales: Scales,
    search: Search<Rig>,
    found: Best,
    ranges: Ranges,
}

impl RobustSearch {
    /// Finds the best settings within `ranges`. Once `stop` is set, it comes soon but is
    /// meaningless.
    ///
    /// # Errors
    /// As [`robust_setting`].
    pub(super) fn of(
        setting: &Setting,
        gain: SearchedGain,
        ranges: &Ranges,
        stop: &Stop,
    ) -> Result<Self, NoAnswer> {
        let plane = SearchPlane::with_delay(parameter_of(gain));
        let acting = acting(setting, &plane.p);
        acting.check_continuous(NOT_ROBUST)?;
        let scales = Scales::of(setting, &plane)?;
        setting.check_of_letter(&[], "")?;
        let letter = letter(setting, gain)?;
        let found = scales.best(Some(letter), setting, &plane, ranges, stop)?;
        let rig = Rig {
            letter,
            // Also where the gains of `setting` are 0: they are searched.
            beyond: beyond_letter(&acting, &setting.oscillator()?),
        };
        Ok(Self {
            search: scales.search(rig, ranges),
            scales,
            found,
            ranges: *ranges,
        })
    }

    /// The best settings.
    pub(super) fn best(&self) -> BestSettings {
        self.scales.settings(&self.found, &self.ranges)
    }

    /// The most robust setting under relative errors of gain, delay and μ′ of up to `spread`; none
    /// where no setting stays stable.
    pub(super) fn standing(&self, spread: Changes, stop: &Stop) -> Option<RobustSetting> {
        let (search, found) = (&self.search, &self.found);
        let robust = best::robust(search, found, spread, stop)?;
        Some(self.scales.robust(search, found, &robust, spread, stop))
    }
}

/// The best settings within `ranges`, as from [`best_settings`](super::best::best_settings), and
/// the most robust one under relative errors of gain, delay and μ′ of up to `spread`, those of gain
/// and delay less than 1. None for the latter where no setting stays stable. Once `stop` is set,
/// the answer comes soon but is meaningless.
///
/// # Errors
/// As [`best_settings`](super::best::best_settings), and under friction with a state, of which the
/// slope μ′ does not say all.
pub fn robust_setting(
    setting: &Setting,
    gain: SearchedGain,
    ranges: &Ranges,
    spread: Changes,
    stop: &Stop,
) -> Result<(BestSettings, Option<RobustSetting>), NoAnswer> {
    let search = RobustSearch::of(setting, gain, ranges, stop)?;
    Ok((search.best(), search.standing(spread, stop)))
}

impl Scales {
    /// A robust setting beside the best one.
    fn robust(
        &self,
        search: &Search<Rig>,
        found: &Best,
        robust: &Robust,
        spread: Changes,
        stop: &Stop,
    ) -> RobustSetting {
        let best = Place {
            p: found.overall.p,
            q: found.overall.q,
        };
        let (worst, proved) = best::worst_around(search, best, spread, stop);
        RobustSetting {
            spread,
            robust: Robust {
                gain: robust.gain * self.p,
                tau: robust.tau * self.q,
                abscissa: robust.abscissa / self.time,
                worst_abscissa: robust.worst_abscissa / self.time,
                ..*robust
            },
            worst_of_best: (worst / self.time, proved),
        }
    }
}
