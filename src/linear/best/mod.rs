//! Settings of fastest decay: the gain and the delay with the smallest spectral abscissa, for every
//! stable region.
//!
//! Three stages. **Regions**: the stable regions of a box are found from the closed form of the
//! stable delays; only the gain is sampled. **Descent**: from the best places of a lattice in each
//! region a direct search goes down; the abscissa has kinks where roots trade places and cusps
//! where they meet, so no gradient is used. **Polish**: near an optimum, what makes it one is a
//! pair of smooth equations ([`Kind`]), solved by Newton's method; the result is accepted where the
//! argument principle confirms that no root lies farther right, and where no place around it is
//! better.
//!
//! A region is a connected set of stable settings *inside the box*, at the resolution of the gains
//! sampled: 193 evenly over the box, and ever more densely towards gains at which the crossings
//! change their number. A lobe between two neighbouring samples is missed; lobes that end in a
//! point at such a gain are not, however small, down to 1e-16 of the box.
//!
//! - `condition`: what holds at an optimum: multiple roots, ties, vanishing gradients
//! - `descend`: direct search on a function with kinks and cusps
//! - `found`: what the search finds: optima, regions
//! - `general`: any system with one delay over a plane of one of its parameters and the delay
//! - `letter`: the controlled oscillator over a plane of one of its gains and the delay
//! - `polish`: Newton's method on those conditions, and the certificate
//! - `regions`: the stable regions of a box: lobes
//! - `rig`: a block on its spring whose gains, delay and slope of friction may be off
//! - `robust`: the setting whose slowest decay over a box of changes is fastest
//! - `sampled`: a digital loop over one of its gains and the multiples of its sample time
//! - `search`: what is searched, and the abscissa at a place of it

mod condition;
mod descend;
mod found;
mod general;
mod letter;
mod polish;
mod regions;
mod rig;
mod robust;
mod sampled;
mod search;

pub use found::{Best, Kind, MOST_REGIONS, Optimum, Region};
pub use general::General;
pub use letter::{Letter, SearchedGain};
pub use regions::{Bound, Stretch};
pub use rig::Rig;
pub(crate) use rig::abscissa_at;
pub(crate) use robust::UNPROVED;
pub use robust::{Robust, robust, worst_around};
pub use sampled::SampledPlane;
pub use search::{ByParameters, Family, Place, Search};

use condition::along_double_roots;
use descend::{Frame, descend, follow_valley};
use polish::{polished, unpolished};
use regions::{Stretches, stable_regions};
use search::Evaluator;

use crate::model::elementary::power;
use crate::model::stop::Stop;

/// Regions whose optimum is looked for.
const MOST_SEARCHED: usize = 4 * MOST_REGIONS;
/// Lines of a region's lattice, and places on each of its stretches.
const LATTICE_LINES: usize = 24;
const LATTICE_PLACES: usize = 10;
/// Places more on stretches that begin at a short delay and go on to long ones, each nearer to the
/// short end by `CLOSER`.
const SHORT_PLACES: i32 = 8;
const CLOSER: f64 = 0.4;
/// The longest delay of such stretches is this many times the shortest.
const LONG: f64 = 10.0;
/// Places of the lattice from which the search goes down.
const STARTS: usize = 3;
/// Cells each way of the grid over a box without stable regions.
const GRID: usize = 48;
/// Radii around a polished optimum at which nothing may be better, in units of the frame, and
/// directions.
const CHECK_RADII: [f64; 4] = [0.3, 0.03, 3e-3, 3e-4];
const CHECK_DIRECTIONS: u32 = 16;
/// Radii, in units of the frame, to which the descent goes before what it found is polished, and
/// where that fails.
const COARSE: f64 = 1e-4;
const FINE: f64 = 1e-9;
/// How often the search goes on from a better place found by that check.
const MOST_RESTARTS: u32 = 4;

/// The settings of fastest decay in the box of `search`. Once `stop` is set, the answer comes soon
/// but is meaningless.
///
/// The box must be finite, its ranges ordered and the delays not negative.
#[must_use]
pub fn best(search: &Search<impl Family>, stop: &Stop) -> Best {
    let mut evaluator = Evaluator::heeding(stop);
    let found = stable_regions(search, stop);
    let (mut regions, mut within_rounding, mut regions_left_out) = (Vec::new(), Vec::new(), 0);
    for (searched, stretches) in found.into_iter().enumerate() {
        if regions.len() == MOST_REGIONS || searched >= MOST_SEARCHED || evaluator.ended() {
            regions_left_out += 1;
            continue;
        }
        let region = region(&mut evaluator, search, stretches);
        match region.best.decays() {
            true => add(&mut regions, region),
            false if evaluator.ended() => regions_left_out += 1,
            false => add(&mut within_rounding, region),
        }
    }
    let told = |of: &Region| regions.iter().any(|known| known.holds(&of.best));
    regions_left_out += within_rounding.iter().filter(|of| !told(of)).count();
    regions.sort_by(|p: &Region, q: &Region| p.shortest().total_cmp(&q.shortest()));
    let overall = regions
        .iter()
        .map(|region| &region.best)
        .min_by(|p, q| p.abscissa.total_cmp(&q.abscissa))
        .cloned()
        .unwrap_or_else(|| {
            let mut least = least_unstable(&mut evaluator, search);
            // Rounding is no decay.
            if (-least.margin..0.0).contains(&least.abscissa) {
                least.abscissa = 0.0;
            }
            least
        });
    Best {
        overall,
        regions,
        regions_left_out,
    }
}

/// A place from which to go down.
#[derive(Debug, Clone, Copy)]
struct Start {
    /// The abscissa there, or another value to go down.
    value: f64,
    place: Place,
    /// The length scales around it.
    frame: Frame,
}

fn region(evaluator: &mut Evaluator, search: &Search<impl Family>, stretches: Stretches) -> Region {
    let hull = |values: &dyn Fn(usize) -> (f64, f64)| {
        (0..stretches.len()).map(values).fold(
            (f64::INFINITY, f64::NEG_INFINITY),
            |(low, high), (from, to)| (low.min(from), high.max(to)),
        )
    };
    let gains = hull(&|i| (stretches[i].gain, stretches[i].gain));
    let delays = hull(&|i| (stretches[i].from, stretches[i].to));
    let starts = lattice(&stretches, gains, |place| evaluator.abscissa(search, place));
    let best = lowest(evaluator, search, starts);
    let with = |(from, to): (f64, f64), place: f64| (from.min(place), to.max(place));
    Region {
        gains: with(gains, best.gain),
        delays: with(delays, best.tau),
        best,
        stretches,
    }
}

/// Adds a region. One whose best setting lies in another region is part of that: rounding has cut
/// it off, where gains are so weak that it tells little.
fn add(regions: &mut Vec<Region>, mut region: Region) {
    let part = |p: &Region, of: &Region| !p.holds(&p.best) && of.holds(&p.best);
    let same = |known: &Region, region: &Region| part(known, region) || part(region, known);
    while let Some(i) = regions.iter().position(|known| same(known, &region)) {
        region = regions.remove(i).joined(region);
    }
    regions.push(region);
}

/// A value on a lattice of the region: over its gains as [`chosen_gains`] has them, evenly over the
/// stable delays of each.
fn lattice(
    stretches: &Stretches,
    gains: (f64, f64),
    mut of: impl FnMut(Place) -> f64,
) -> Vec<Start> {
    let chosen = chosen_gains(stretches, gains);
    let middle = |gain: f64| {
        let there = stretches.iter().find(|s| s.gain == gain);
        there.map_or(f64::NAN, |s| s.at(0.5).tau)
    };
    let mut starts = Vec::new();
    for (i, &(gain, _)) in chosen.iter().enumerate() {
        let (before, after) = (
            chosen[i.saturating_sub(1)].0,
            chosen[(i + 1).min(chosen.len() - 1)].0,
        );
        let step = (gain - before).max(after - gain);
        let slope = (middle(after) - middle(before)) / (after - before);
        for stretch in stretches.iter().filter(|s| s.gain == gain) {
            for (part, apart) in parts(stretch) {
                let frame = Frame {
                    gain: positive(step, gain),
                    slope: if slope.is_finite() { slope } else { 0.0 },
                    tau: positive(apart * (stretch.to - stretch.from), stretch.to),
                };
                let place = stretch.at(part);
                starts.push(Start {
                    value: of(place),
                    place,
                    frame,
                });
            }
        }
    }
    starts
}

/// How far along a stretch its places of the lattice are, from 0 to 1, and how far apart there.
fn parts(stretch: &Stretch) -> impl Iterator<Item = (f64, f64)> {
    let apart = 1.0 / LATTICE_PLACES as f64;
    let evenly = (0..=LATTICE_PLACES).map(move |j| (j as f64 / LATTICE_PLACES as f64, apart));
    let long = stretch.to > LONG * stretch.from;
    let short = (1..=SHORT_PLACES).filter(move |_| long).map(move |j| {
        let part = apart * power(CLOSER, j);
        (part, part)
    });
    evenly.chain(short)
}

/// Gains of a region, rising: about [`LATTICE_LINES`] evenly over it, and as many evenly among
/// those that were sampled, which are denser towards its ends. With the number of each among the
/// sampled ones.
fn chosen_gains(stretches: &Stretches, (low, high): (f64, f64)) -> Vec<(f64, usize)> {
    let mut sampled: Vec<f64> = stretches.iter().map(|s| s.gain).collect();
    sampled.dedup();
    let spacing = (high - low) / LATTICE_LINES as f64;
    let stride = sampled.len().div_ceil(LATTICE_LINES);
    let mut chosen: Vec<(f64, usize)> = Vec::new();
    for (number, gain) in sampled.into_iter().enumerate() {
        let wanted =
            |&(last, at): &(f64, usize)| gain - last >= 0.7 * spacing || number - at >= stride;
        if chosen.last().is_none_or(wanted) {
            chosen.push((gain, number));
        }
    }
    chosen
}

/// `length`, or something small on the scale of `value` where it vanishes.
fn positive(length: f64, value: f64) -> f64 {
    if length > 0.0 {
        length
    } else {
        1e-6 * value.abs().max(1e-6)
    }
}

/// The best of these starts that are not close to one another.
fn far_apart(mut starts: Vec<Start>) -> Vec<Start> {
    starts.sort_by(|p, q| p.value.total_cmp(&q.value));
    let mut chosen: Vec<Start> = Vec::new();
    for start in starts {
        let near = |Start { place, frame, .. }: &Start| {
            (place.gain - start.place.gain).abs() < 2.5 * frame.gain
                && (place.tau - start.place.tau).abs() < 2.5 * frame.tau
        };
        if !chosen.iter().any(near) {
            chosen.push(start);
        }
        if chosen.len() == STARTS {
            break;
        }
    }
    chosen
}

/// The lowest place to which descents from the best of `starts` lead.
fn lowest(evaluator: &mut Evaluator, search: &Search<impl Family>, starts: Vec<Start>) -> Optimum {
    let mut best: Option<Optimum> = None;
    for start in far_apart(starts) {
        let mut found = optimum_near(evaluator, search, start.place, &start.frame);
        if found.abscissa > start.value {
            // Beside accumulating roots the abscissa may be known here, and not around it.
            found = unpolished(evaluator, search, (start.place, start.value));
        }
        if best.as_ref().is_none_or(|b| found.abscissa < b.abscissa) {
            best = Some(found);
        }
    }
    best.expect("a region or a grid has at least one place")
}

/// The optimum to which the descent from `start` leads: polished, and with nothing better around
/// it.
fn optimum_near(
    evaluator: &mut Evaluator,
    search: &Search<impl Family>,
    mut start: Place,
    frame: &Frame,
) -> Optimum {
    let mut restarts = 0;
    loop {
        let of = |place, _| evaluator.abscissa(search, place);
        let coarse = descend(of, search, start, frame, (1.0, COARSE));
        let found = polished(evaluator, search, coarse, frame).unwrap_or_else(|| {
            let along = follow_valley(evaluator, search, coarse.0, frame);
            let near = if along.1 < coarse.1 {
                along.0
            } else {
                coarse.0
            };
            let of = |place, _| evaluator.abscissa(search, place);
            let fine = descend(of, search, near, frame, (10.0 * COARSE, FINE));
            let edge = search.nearest_edge(fine.0, (frame.gain, frame.tau));
            polished(evaluator, search, fine, frame)
                .or_else(|| polished(evaluator, search, (edge, fine.1), frame))
                .unwrap_or_else(|| unpolished(evaluator, search, fine))
        });
        match better_nearby(evaluator, search, &found, frame) {
            Some(place) if restarts < MOST_RESTARTS => {
                start = place;
                restarts += 1;
            }
            _ => return found,
        }
    }
}

fn better_nearby(
    evaluator: &mut Evaluator,
    search: &Search<impl Family>,
    found: &Optimum,
    frame: &Frame,
) -> Option<Place> {
    let centre = Place {
        gain: found.gain,
        tau: found.tau,
    };
    let better = found.abscissa - found.margin - 1e-9 * (1.0 + found.abscissa.abs());
    let around = |radius: f64| {
        (0..CHECK_DIRECTIONS)
            .map(|i| f64::from(i) * std::f64::consts::TAU / f64::from(CHECK_DIRECTIONS))
            .map(move |angle| search.clamp(frame.around(centre, radius, angle)))
    };
    // A valley of double real roots has walls that rise like a square root; no direction but its
    // own is a way down.
    let valley = |radius: f64| {
        let (gain, tau) = (radius * frame.gain, radius * frame.tau);
        [(gain, 0.0), (-gain, 0.0), (0.0, tau), (0.0, -tau)]
            .into_iter()
            .filter(|_| found.frequencies.contains(&0.0))
            .filter_map(|step| along_double_roots(search, (centre, found.abscissa), step))
            .filter(|&place| {
                search.clamp(place) == place && frame.apart(centre, place) <= 4.0 * radius
            })
            .collect::<Vec<_>>()
    };
    CHECK_RADII.into_iter().find_map(|radius| {
        valley(radius)
            .into_iter()
            .chain(around(radius))
            .find(|&place| evaluator.abscissa(search, place) < better)
    })
}

/// The setting of slowest growth in a box without stable ones.
fn least_unstable(evaluator: &mut Evaluator, search: &Search<impl Family>) -> Optimum {
    let spread = |(from, to): (f64, f64), i: usize| from + (to - from) * (i as f64 / GRID as f64);
    let frame = Frame {
        gain: positive(
            (search.gains.1 - search.gains.0) / GRID as f64,
            search.gains.0,
        ),
        slope: 0.0,
        tau: positive(
            (search.delays.1 - search.delays.0) / GRID as f64,
            search.delays.0,
        ),
    };
    let mut starts = Vec::new();
    for i in 0..=GRID {
        for j in 0..=GRID {
            let place = Place {
                gain: spread(search.gains, i),
                tau: spread(search.delays, j),
            };
            starts.push(Start {
                value: evaluator.abscissa(search, place),
                place,
                frame,
            });
        }
    }
    lowest(evaluator, search, starts)
}

#[cfg(test)]
mod tests;
