//! Settings of fastest decay: the two parameters p and q, such as a gain and the delay, with the
//! smallest spectral abscissa, for every stable region.
//!
//! Three stages. **Regions**: the stable regions of a box are found from the closed form of the
//! stable delays; only p is sampled. **Descent**: from the best places of a lattice in each
//! region a direct search goes down; the abscissa has kinks where roots trade places and cusps
//! where they meet, so no gradient is used. **Polish**: near an optimum, what makes it one is a
//! pair of smooth equations ([`Kind`]), solved by Newton's method; the result is accepted where the
//! argument principle confirms that no root lies farther right, and where no place around it is
//! better.
//!
//! A region is a connected set of stable settings *inside the box*, at the resolution of the p
//! sampled: 193 evenly over the box, and ever more densely towards those at which the crossings
//! change their number. A lobe between two neighbouring samples is missed; lobes that end in a
//! point at such a p are not, however small, down to 1e-16 of the box.
//!
//! - `condition`: what holds at an optimum: multiple roots, ties, vanishing gradients
//! - `descend`: direct search on a function with kinks and cusps
//! - `found`: what the search finds: optima, regions
//! - `general`: any system with one delay over a plane of one of its parameters and the delay, or
//!   of two of its parameters
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
pub use general::{Across, General};
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
    regions.sort_by(|p: &Region, q: &Region| p.smallest().total_cmp(&q.smallest()));
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
    let p = hull(&|i| (stretches[i].p, stretches[i].p));
    let q = hull(&|i| (stretches[i].from, stretches[i].to));
    let starts = lattice(&stretches, p, |place| evaluator.abscissa(search, place));
    let best = lowest(evaluator, search, starts);
    let with = |(from, to): (f64, f64), place: f64| (from.min(place), to.max(place));
    Region {
        p: with(p, best.p),
        q: with(q, best.q),
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

/// A value on a lattice of the region: over its p as [`chosen_lines`] has them, evenly over the
/// stable q of each.
fn lattice(stretches: &Stretches, p: (f64, f64), mut of: impl FnMut(Place) -> f64) -> Vec<Start> {
    let chosen = chosen_lines(stretches, p);
    let middle = |p: f64| {
        let there = stretches.iter().find(|s| s.p == p);
        there.map_or(f64::NAN, |s| s.at(0.5).q)
    };
    let mut starts = Vec::new();
    for (i, &(p, _)) in chosen.iter().enumerate() {
        let (before, after) = (
            chosen[i.saturating_sub(1)].0,
            chosen[(i + 1).min(chosen.len() - 1)].0,
        );
        let step = (p - before).max(after - p);
        let slope = (middle(after) - middle(before)) / (after - before);
        for stretch in stretches.iter().filter(|s| s.p == p) {
            for (part, apart) in parts(stretch) {
                let frame = Frame {
                    p: positive(step, p),
                    slope: if slope.is_finite() { slope } else { 0.0 },
                    q: positive(apart * (stretch.to - stretch.from), stretch.to),
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

/// The p of a region, rising: about [`LATTICE_LINES`] evenly over it, and as many evenly among
/// those that were sampled, which are denser towards its ends. With the number of each among the
/// sampled ones.
fn chosen_lines(stretches: &Stretches, (low, high): (f64, f64)) -> Vec<(f64, usize)> {
    let mut sampled: Vec<f64> = stretches.iter().map(|s| s.p).collect();
    sampled.dedup();
    let spacing = (high - low) / LATTICE_LINES as f64;
    let stride = sampled.len().div_ceil(LATTICE_LINES);
    let mut chosen: Vec<(f64, usize)> = Vec::new();
    for (number, p) in sampled.into_iter().enumerate() {
        let wanted =
            |&(last, at): &(f64, usize)| p - last >= 0.7 * spacing || number - at >= stride;
        if chosen.last().is_none_or(wanted) {
            chosen.push((p, number));
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
            (place.p - start.place.p).abs() < 2.5 * frame.p
                && (place.q - start.place.q).abs() < 2.5 * frame.q
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

/// Steps of a descent from a place near an optimum, over the width of the box.
const NEARBY: f64 = 0.02;

/// The optimum to which a descent from `start` leads, a place near it. Once `stop` is set, it comes
/// soon but is meaningless.
#[must_use]
pub fn near(search: &Search<impl Family>, start: Place, stop: &Stop) -> Optimum {
    let mut evaluator = Evaluator::heeding(stop);
    let length = |(from, to): (f64, f64), value: f64| positive(NEARBY * (to - from), value);
    let frame = Frame {
        p: length(search.p, start.p),
        slope: 0.0,
        q: length(search.q, start.q),
    };
    optimum_near(&mut evaluator, search, search.clamp(start), &frame)
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
            let edge = search.nearest_edge(fine.0, (frame.p, frame.q));
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
        p: found.p,
        q: found.q,
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
        let (p, q) = (radius * frame.p, radius * frame.q);
        [(p, 0.0), (-p, 0.0), (0.0, q), (0.0, -q)]
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
        p: positive((search.p.1 - search.p.0) / GRID as f64, search.p.0),
        slope: 0.0,
        q: positive((search.q.1 - search.q.0) / GRID as f64, search.q.0),
    };
    let mut starts = Vec::new();
    for i in 0..=GRID {
        for j in 0..=GRID {
            let place = Place {
                p: spread(search.p, i),
                q: spread(search.q, j),
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
