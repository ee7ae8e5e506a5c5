//! The stable regions of a box in a plane of two parameters p and q: lobes, where q is the delay.
//!
//! The stable q of a p are known, in closed form where they can be, so only p is sampled: evenly,
//! and ever more densely towards each p at which the crossings change their number, where
//! lobes end in a point. Stretches of neighbouring p belong to the same
//! region where they overlap or lie between the same two crossing curves.

use super::search::{Family, Place, Search};
use crate::model::elementary::power;
use crate::model::stop::Stop;

/// Gains sampled evenly over the box.
const EVEN_LINES: usize = 192;
/// Gains on either side of a breakpoint, each nearer to it than the one before by `CLOSER`.
const LINES_AT_BREAKPOINT: i32 = 72;
const CLOSER: f64 = 0.6;
/// The width of the narrowest stretch, relative: rounding is below it.
const NARROWEST: f64 = 1e-12;
/// Gains so near to one another, relative to the box, are hardly told apart.
const BLURRED: f64 = 1e-14;
/// Stable intervals looked at on one line.
pub(super) const MOST_STRETCHES: usize = 1024;

/// Stable q of one sampled p, cut at the edges of the box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// p.
    pub p: f64,
    /// The smallest q.
    pub from: f64,
    /// The largest q.
    pub to: f64,
    /// The crossings that bound the interval; none where it is open, or where that is not known.
    pub bounds: (Option<Bound>, Option<Bound>),
}

/// A crossing of a line by the number of its frequency and of its passage.
pub type Bound = (usize, u64);

impl Stretch {
    /// The stretch between two q, cut at the edges of a range; none where the box only
    /// touches it, but for a box that is a line itself.
    pub(super) fn cut(
        p: f64,
        (from, to): (f64, f64),
        (least, most): (f64, f64),
        bounds: (Option<Bound>, Option<Bound>),
    ) -> Option<Self> {
        let stretch = Self {
            p,
            from: from.max(least),
            to: to.min(most),
            bounds,
        };
        let wide = stretch.to - stretch.from > NARROWEST * (1.0 + stretch.to.abs());
        (least == most || wide).then_some(stretch)
    }

    fn touches(&self, other: &Self) -> bool {
        let (from, to) = (self.from.max(other.from), self.to.min(other.to));
        // Regions of gains of both signs meet at their ends where control is weak.
        let overlap = to - from > NARROWEST * (1.0 + to.abs());
        // Of a box that is a line a stretch is a point.
        let points = (self.from, self.to) == (other.from, other.to) && self.from == self.to;
        overlap || points || (self.bounds == other.bounds && self.bounds.0.is_some())
    }

    /// The place at the fraction `s` of the stretch.
    pub(super) fn at(&self, s: f64) -> Place {
        Place {
            p: self.p,
            q: self.from + s * (self.to - self.from),
        }
    }
}

/// The stretches of one region, by rising p and q. Never empty.
pub(super) type Stretches = Vec<Stretch>;

/// The regions of the box that a sampled p crosses, by their smallest q; only some of them once
/// `stop` is set.
pub(super) fn stable_regions(search: &Search<impl Family>, stop: &Stop) -> Vec<Stretches> {
    let values = sampled_values(search, stop);
    let lines: Vec<Stretches> = values
        .iter()
        .map(|&p| match stop.is_set() {
            true => Stretches::new(),
            false => search.family.stretches(p, search.q),
        })
        .collect();
    let offsets: Vec<usize> = lines
        .iter()
        .scan(0, |next, line| {
            Some(std::mem::replace(next, *next + line.len()))
        })
        .collect();
    let mut groups = Sets::new(lines.iter().map(Vec::len).sum());
    let pairs = neighbours(&values, search.p.1 - search.p.0);
    for (i, j) in pairs.take_while(|_| !stop.is_set()) {
        for (p, here) in lines[i].iter().enumerate() {
            for (q, there) in lines[j].iter().enumerate() {
                if here.touches(there) {
                    groups.join(offsets[i] + p, offsets[j] + q);
                }
            }
        }
    }
    let all: Vec<Stretch> = lines.into_iter().flatten().collect();
    let mut regions: Vec<(usize, Stretches)> = Vec::new();
    for (i, &stretch) in all.iter().enumerate() {
        let name = groups.name(i);
        match regions.iter_mut().find(|(n, _)| *n == name) {
            Some((_, region)) => region.push(stretch),
            None => regions.push((name, vec![stretch])),
        }
    }
    let mut regions: Vec<Stretches> = regions.into_iter().map(|(_, r)| r).collect();
    let smallest = |r: &Stretches| r.iter().map(|s| s.from).fold(f64::INFINITY, f64::min);
    regions.sort_by(|p, q| smallest(p).total_cmp(&smallest(q)));
    regions
}

/// Pairs of rising `values`, by number: each with the next one, and with all that are as near to it
/// as rounding. Where a lobe ends in a point, one of these may show it and its neighbour not.
fn neighbours(values: &[f64], width: f64) -> impl Iterator<Item = (usize, usize)> {
    let near = move |i: usize, j: usize| j == i + 1 || values[j] - values[i] <= BLURRED * width;
    (0..values.len()).flat_map(move |i| {
        let next = (i + 1..values.len()).take_while(move |&j| near(i, j));
        next.map(move |j| (i, j))
    })
}

/// The p at which stable q are asked for, rising.
fn sampled_values(search: &Search<impl Family>, stop: &Stop) -> Vec<f64> {
    let (from, to) = search.p;
    let width = to - from;
    if width == 0.0 {
        return vec![from];
    }
    let mut values: Vec<f64> = (0..=EVEN_LINES)
        .map(|i| from + width * (i as f64 / EVEN_LINES as f64))
        .collect();
    for breakpoint in search.family.breakpoints(&values, stop) {
        for step in 1..=LINES_AT_BREAKPOINT {
            let by = width * power(CLOSER, step);
            values.extend([breakpoint - by, breakpoint + by]);
        }
    }
    values.retain(|p| (from..=to).contains(p));
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}

/// Sets that are joined one by one.
struct Sets {
    parent: Vec<usize>,
}

impl Sets {
    fn new(len: usize) -> Self {
        Self {
            parent: (0..len).collect(),
        }
    }

    fn name(&mut self, mut i: usize) -> usize {
        while self.parent[i] != i {
            self.parent[i] = self.parent[self.parent[i]];
            i = self.parent[i];
        }
        i
    }

    fn join(&mut self, i: usize, j: usize) {
        let (i, j) = (self.name(i), self.name(j));
        self.parent[i.max(j)] = i.min(j);
    }
}
