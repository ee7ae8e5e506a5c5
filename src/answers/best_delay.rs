//! The delay at which the best setting over two parameters of a system is best.

use super::best::{BestSettings, Ranges, Scales, best_settings};
use super::search_plane::SearchPlane;
use crate::linear::best::{Kind, Place, near};
use crate::linear::roots::golden_section;
use crate::model::stop::Stop;
use crate::setting::no_answer::NoAnswer;
use crate::setting::parameter::Parameter;
use crate::setting::values::Setting;

/// Delays, evenly over the range, at which all of the plane is searched.
const DELAYS: usize = 13;
/// Of these, local minima that are followed.
const MOST_FOLLOWED: usize = 3;
/// Golden sections by which they are followed, and the part of the range to which that finds a
/// delay.
const SECTIONS: u32 = 30;
const PRECISION: f64 = 1e-7;

/// The delay between the ends of `delays` at which the best setting within `ranges` decays fastest,
/// with all that [`best_settings`] tells at that delay. In between the delays that are searched,
/// the best setting is followed from the nearest of them; where it begins or ends there, it may be
/// missed. At an end of `delays` its kind is [`Kind::Edge`]. Once `stop` is set, the answer comes
/// soon but is meaningless.
///
/// # Errors
/// As [`best_settings`].
pub fn best_over_delays(
    setting: &Setting,
    plane: &SearchPlane,
    ranges: &Ranges,
    delays: (f64, f64),
    stop: &Stop,
) -> Result<(f64, BestSettings), NoAnswer> {
    let (from, to) = delays;
    let last = if from < to { DELAYS - 1 } else { 0 };
    let at = |i: usize| from + (to - from) * (i as f64 / last.max(1) as f64);
    let mut searched = Vec::new();
    for i in 0..=last {
        let found = best_settings(&with_delay(setting, at(i)), plane, ranges, stop)?;
        searched.push((at(i), found));
    }
    let value = |i: usize| searched[i].1.overall.abscissa;
    let is_lowest = |&i: &usize| {
        let around = [i.saturating_sub(1), (i + 1).min(last)];
        around.into_iter().all(|j| value(i) <= value(j))
    };
    let mut lowest: Vec<usize> = (0..=last).filter(is_lowest).collect();
    lowest.sort_by(|i, j| value(*i).total_cmp(&value(*j)));
    let first = lowest.first().copied().unwrap_or(0);
    let mut best = (searched[first].0, value(first));
    for i in lowest.into_iter().take(MOST_FOLLOWED) {
        let around = (at(i.saturating_sub(1)), at((i + 1).min(last)));
        let start = &searched[i].1.overall;
        let start = Place {
            p: start.p,
            q: start.q,
        };
        let of = |tau: f64| followed(setting, plane, ranges, (tau, start), stop);
        let there = golden_section(around, SECTIONS, |tau| of(tau).unwrap_or(f64::INFINITY));
        if there.1 < best.1 {
            best = there;
        }
    }
    let (tau, _) = best;
    let known = searched.into_iter().find(|(at, _)| *at == tau);
    let mut found = match known {
        Some((_, found)) => found,
        None => best_settings(&with_delay(setting, tau), plane, ranges, stop)?,
    };
    let near = PRECISION * (to - from);
    if from < to && (tau - from <= near || to - tau <= near) {
        found.overall.kind = Kind::Edge;
    }
    Ok((tau, found))
}

fn with_delay(setting: &Setting, tau: f64) -> Setting {
    let mut setting = setting.clone();
    setting.set(Parameter::Tau, tau);
    setting
}

/// The smallest abscissa near a place, physical, at a delay.
fn followed(
    setting: &Setting,
    plane: &SearchPlane,
    ranges: &Ranges,
    (tau, start): (f64, Place),
    stop: &Stop,
) -> Result<f64, NoAnswer> {
    let setting = with_delay(setting, tau);
    let scales = Scales::of(&setting, plane)?;
    let start = Place {
        p: start.p / scales.p,
        q: start.q / scales.q,
    };
    let found = scales.in_any(&setting, plane, ranges, |search| near(search, start, stop))?;
    Ok(found.abscissa / scales.time)
}
