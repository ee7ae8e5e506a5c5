//! A digital loop over a plane of one of its gains and the multiples of its sample time.
//!
//! At every multiple the stable gains are known ([`GainLine::stable`]), so no lobe is missed where
//! all multiples are looked at. Stable gains of neighbouring multiples that overlap are one region.
//! In each region the abscissa is sampled over the stable gains, and the best places are refined
//! over the gain by golden sections and over the multiple by single steps.

use std::f64::consts::PI;

use super::found::{Best, Kind, MOST_REGIONS, Optimum, Region};
use crate::linear::line::Roots;
use crate::linear::newton::Root;
use crate::linear::sampled::{GainLine, SampledRoots};
use crate::model::stop::Stop;

/// Multiples that are looked at; of more, every so many.
const MOST_MULTIPLES: u64 = 512;
/// Gains at which the abscissa is sampled on a stretch of stable ones, or over a range without.
const SAMPLES: usize = 17;
/// Places of a region that are refined.
const STARTS: usize = 4;
/// Golden sections until gains are told apart by rounding alone.
const SECTIONS: usize = 64;
/// Real parts so near, relative, are equal.
const EQUAL: f64 = 1e-6;
/// Roots of a pair of real ones so near are one double root.
const DOUBLE: f64 = 1e-4;
/// What follows, in the golden section, is this part of what was.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// A search for the settings of fastest decay of a digital loop.
#[derive(Debug, Clone, Copy)]
pub struct SampledPlane {
    /// The loops along the searched gain.
    pub loops: GainLine,
    /// The gains to search, from ≤ to.
    pub gains: (f64, f64),
    /// The delays to search in sample times, 1 ≤ from ≤ to.
    pub multiples: (u64, u64),
}

/// Stable gains at a multiple, or any range of gains.
#[derive(Debug, Clone, Copy)]
struct Piece {
    multiple: u64,
    gains: (f64, f64),
}

/// A place with the abscissa there, and a length of gains around it.
#[derive(Debug, Clone, Copy)]
struct Sample {
    multiple: u64,
    gain: f64,
    abscissa: f64,
    width: f64,
}

impl SampledPlane {
    /// The settings of fastest decay. Once `stop` is set, the answer comes soon but is meaningless.
    #[must_use]
    pub fn best(&self, stop: &Stop) -> Best {
        let mut left_out = 0;
        let pieces = self.pieces(stop, &mut left_out);
        let groups = connected(&pieces);
        left_out += groups.len().saturating_sub(MOST_REGIONS);
        let regions: Vec<Region> = groups
            .iter()
            .take(MOST_REGIONS)
            .map(|group| self.region(group, stop))
            .collect();
        let by_abscissa = |p: &&Optimum, q: &&Optimum| p.abscissa.total_cmp(&q.abscissa);
        let best = regions.iter().map(|region| &region.best);
        let best = best.min_by(by_abscissa).cloned();
        let (regions, within_rounding): (Vec<_>, Vec<_>) =
            regions.into_iter().partition(|region| region.best.decays());
        Best {
            overall: best.unwrap_or_else(|| self.least_unstable(stop)),
            regions,
            regions_left_out: left_out + within_rounding.len(),
        }
    }

    /// The multiples that are looked at, and how far apart they are.
    fn multiples(&self) -> (impl Iterator<Item = u64> + use<>, u64) {
        let (from, to) = self.multiples;
        let stride = (to - from + 1).div_ceil(MOST_MULTIPLES);
        let multiples = (from..=to).step_by(usize::try_from(stride).unwrap_or(usize::MAX));
        (multiples, stride)
    }

    /// The stable gains of every multiple, by growing multiple; `unknown` counts those of which
    /// they are not known.
    fn pieces(&self, stop: &Stop, unknown: &mut usize) -> Vec<Piece> {
        let mut found = Vec::new();
        for multiple in self.multiples().0 {
            if stop.is_set() {
                break;
            }
            match self.loops.stable(multiple, self.gains) {
                Some(stable) => {
                    found.extend(stable.into_iter().map(|gains| Piece { multiple, gains }));
                }
                None => *unknown += 1,
            }
        }
        found
    }

    /// The largest Re λ h of a place, infinite where it is not known.
    fn abscissa(&self, multiple: u64, gain: f64) -> f64 {
        let of = self.loops.at(gain);
        of.largest_growth(multiple).unwrap_or(f64::INFINITY)
    }

    /// The abscissa at gains evenly over a piece.
    fn samples(&self, piece: &Piece) -> impl Iterator<Item = Sample> {
        let (Piece { multiple, gains }, last) = (*piece, (SAMPLES - 1) as f64);
        let width = (gains.1 - gains.0) / last;
        (0..SAMPLES).map(move |i| {
            let gain = gains.0 + (gains.1 - gains.0) * (i as f64 / last);
            Sample {
                multiple,
                gain,
                abscissa: self.abscissa(multiple, gain),
                width,
            }
        })
    }

    /// The region of connected pieces.
    fn region(&self, pieces: &[Piece], stop: &Stop) -> Region {
        let best = self.optimum(pieces, stop);
        let h = self.sample_time();
        let ends = pieces.iter().map(|piece| piece.gains);
        let gains = ends.fold((best.p, best.p), |all, piece| {
            (all.0.min(piece.0), all.1.max(piece.1))
        });
        let delays = pieces.iter().map(|piece| piece.multiple as f64 * h);
        let delays = delays.fold((best.q, best.q), |all, tau| {
            (all.0.min(tau), all.1.max(tau))
        });
        Region::without_stretches(gains, delays, best)
    }

    /// The setting of slowest growth.
    fn least_unstable(&self, stop: &Stop) -> Optimum {
        let of_multiple = |multiple| Piece {
            multiple,
            gains: self.gains,
        };
        let pieces: Vec<_> = self.multiples().0.map(of_multiple).collect();
        self.optimum(&pieces, stop)
    }

    fn sample_time(&self) -> f64 {
        self.loops.at(0.0).sample_time
    }

    /// The best place of these pieces and around them.
    fn optimum(&self, pieces: &[Piece], stop: &Stop) -> Optimum {
        let mut starts: Vec<Sample> = Vec::new();
        for piece in pieces {
            if stop.is_set() {
                break;
            }
            let of_piece = self.samples(piece);
            starts.extend(of_piece.min_by(|p, q| p.abscissa.total_cmp(&q.abscissa)));
        }
        starts.sort_by(|p, q| p.abscissa.total_cmp(&q.abscissa));
        starts.truncate(STARTS);
        let refined = starts.into_iter().map(|start| self.refined(start, stop));
        let best = refined.min_by(|p, q| p.abscissa.total_cmp(&q.abscissa));
        let nowhere = Sample {
            multiple: self.multiples.0,
            gain: self.gains.0,
            abscissa: f64::INFINITY,
            width: 0.0,
        };
        self.told(&best.unwrap_or(nowhere))
    }

    /// The best place to which steps over the gain and the multiple lead.
    fn refined(&self, start: Sample, stop: &Stop) -> Sample {
        let mut best = self.along_gain(start);
        let mut stride = self.multiples().1;
        while !stop.is_set() {
            let (from, to) = self.multiples;
            let steps = [
                best.multiple.checked_sub(stride),
                Some(best.multiple + stride),
            ];
            let inside = steps
                .into_iter()
                .flatten()
                .filter(|m| (from..=to).contains(m));
            let found = inside
                .map(|multiple| self.along_gain(Sample { multiple, ..best }))
                .min_by(|p, q| p.abscissa.total_cmp(&q.abscissa));
            match found.filter(|found| found.abscissa < best.abscissa) {
                Some(better) => best = better,
                None if stride > 1 => stride = stride.div_ceil(2),
                None => break,
            }
        }
        best
    }

    /// The best gain near that of `start`, at its multiple: by golden sections of what is around
    /// it.
    fn along_gain(&self, start: Sample) -> Sample {
        let inside = |gain: f64| gain.clamp(self.gains.0, self.gains.1);
        let (mut low, mut high) = (
            inside(start.gain - start.width),
            inside(start.gain + start.width),
        );
        let at = |gain: f64| (self.abscissa(start.multiple, gain), gain);
        let mut inner = [
            at(high - GOLDEN * (high - low)),
            at(low + GOLDEN * (high - low)),
        ];
        for _ in 0..SECTIONS {
            if inner[0].0 <= inner[1].0 {
                high = inner[1].1;
                inner = [at(high - GOLDEN * (high - low)), inner[0]];
            } else {
                low = inner[0].1;
                inner = [inner[1], at(low + GOLDEN * (high - low))];
            }
        }
        let of_start = at(start.gain);
        let ends = [low, high].map(at);
        let candidates = inner.into_iter().chain(ends).chain([of_start]);
        let best = candidates.min_by(|p, q| p.0.total_cmp(&q.0));
        let (abscissa, gain) = best.unwrap_or(of_start);
        Sample {
            gain,
            abscissa,
            ..start
        }
    }

    /// What is told of a place.
    fn told(&self, best: &Sample) -> Optimum {
        let tau = best.multiple as f64 * self.sample_time();
        let roots = SampledRoots::new(self.loops.at(best.gain));
        let spectrum = roots.spectrum(tau, 3);
        let unit = 1.0 + spectrum.abscissa.abs();
        let equal = |root: &&Root| spectrum.abscissa - root.lambda.re <= EQUAL * unit;
        let sharing: Vec<Root> = spectrum.roots.iter().filter(equal).copied().collect();
        let (kind, frequencies) = self.kind(best, &sharing);
        let errors = sharing.iter().map(|root| root.error);
        Optimum {
            p: best.gain,
            q: tau,
            abscissa: spectrum.abscissa,
            frequencies,
            kind,
            certified: spectrum.certified,
            margin: errors.fold(spectrum.margin * unit, f64::max),
        }
    }

    /// What makes a place an optimum, and the frequencies of the roots that share its abscissa.
    fn kind(&self, best: &Sample, sharing: &[Root]) -> (Kind, Vec<f64>) {
        let half_turn = PI / self.sample_time();
        let is_real = |root: &&Root| root.lambda.im == 0.0 || root.lambda.im >= half_turn;
        let real: Vec<&Root> = sharing.iter().filter(is_real).collect();
        let mut frequencies: Vec<f64> = sharing.iter().map(|root| root.lambda.im).collect();
        frequencies.sort_by(f64::total_cmp);
        frequencies.dedup();
        let near_edge = |edge: f64| (best.gain - edge).abs() <= EQUAL * best.width;
        let ends = [self.gains.0, self.gains.1];
        let kind = match (real.len(), sharing.len() - real.len()) {
            _ if ends.into_iter().any(near_edge) => Kind::Edge,
            _ if best.multiple == self.multiples.1 || self.begins_at(best.multiple) => Kind::Edge,
            (2, 0) if (real[0].lambda - real[1].lambda).norm_sqr() < DOUBLE * DOUBLE => {
                Kind::DoubleReal
            }
            (1, 1) => Kind::RealAndPair,
            (1, 2) => Kind::RealAndTwoPairs,
            (0, 2) => Kind::TwoPairs,
            (0, 3) => Kind::ThreePairs,
            (1, 0) | (0, 1) => Kind::OneRoot,
            _ => Kind::Descent,
        };
        (kind, frequencies)
    }

    /// Whether the range of delays begins at this multiple, which is not the shortest there is.
    fn begins_at(&self, multiple: u64) -> bool {
        multiple == self.multiples.0 && multiple > 1
    }
}

/// Pieces, given by growing multiple, in groups: those of one multiple and of the next one looked
/// at that overlap are in one group. In the order of their first pieces.
fn connected(pieces: &[Piece]) -> Vec<Vec<Piece>> {
    let mut groups: Vec<Vec<Piece>> = Vec::new();
    let mut of = vec![0; pieces.len()];
    let mut multiples: Vec<u64> = pieces.iter().map(|piece| piece.multiple).collect();
    multiples.dedup();
    for (i, piece) in pieces.iter().enumerate() {
        let number = multiples.partition_point(|m| *m < piece.multiple);
        let before = number.checked_sub(1).map(|k| multiples[k]);
        let touches = |other: &Piece| {
            Some(other.multiple) == before
                && piece.gains.0.max(other.gains.0) <= piece.gains.1.min(other.gains.1)
        };
        let mut touched: Vec<usize> = (0..i)
            .rev()
            .take_while(|&k| Some(pieces[k].multiple) >= before)
            .filter(|&k| touches(&pieces[k]))
            .map(|k| of[k])
            .collect();
        touched.sort_unstable();
        touched.dedup();
        let group = touched.first().copied().unwrap_or(groups.len());
        if group == groups.len() {
            groups.push(Vec::new());
        }
        for &other in touched.iter().skip(1) {
            let moved = std::mem::take(&mut groups[other]);
            groups[group].extend(moved);
            of.iter_mut()
                .filter(|o| **o == other)
                .for_each(|o| *o = group);
        }
        groups[group].push(*piece);
        of[i] = group;
    }
    groups.retain(|group| !group.is_empty());
    groups
}
