//! The elongation over the last delay, as the polynomials of the steps that made it.
//!
//! - `extrapolated`: a past extrapolated from two others

mod extrapolated;

use std::collections::VecDeque;

use crate::model::elementary::rough_root;
use crate::model::series::{Coefficients, MOST_ORDER, shift, value};

/// One step's elongation.
#[derive(Debug, Clone)]
struct Piece {
    from: f64,
    to: f64,
    /// How far from `from` the polynomial holds to the tolerance, in both directions, up to the
    /// next kink.
    radius: f64,
    order: usize,
    a: Coefficients,
    /// Order of the lowest derivative of a that jumps at `from`.
    kink: u32,
}

/// How far a polynomial of the past may be used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Reach {
    /// The time until which it may be used.
    pub until: f64,
    /// The order of the lowest derivative that jumps there; [`SMOOTH`] where no jump matters.
    pub kink: u32,
}

/// The order of a kink that no step needs to end on.
pub(super) const SMOOTH: u32 = u32::MAX;

/// The part of a polynomial's radius within which it may replace its neighbours.
const SHARE: f64 = 0.75;

/// How far it may then differ from them, in units of the tolerance.
const NEIGHBOURS_APART: f64 = 4.0;

/// A stretch of time in an extrapolated past, and the corresponding stretches of the two pasts that
/// it is extrapolated from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// Its length, and those in the last past and in the one before.
    pub lengths: [f64; 3],
}

/// The most steps that a history keeps, for two delays: 14 MB. A search for a critical velocity has
/// up to ten histories.
pub const MOST_KEPT: usize = 1 << 16;
/// The memory that a step takes in a history.
pub const BYTES_OF_A_STEP: usize = size_of::<Piece>();

/// The elongation over a window of time that moves along, of bounded length.
#[derive(Debug, Clone, Default)]
pub(super) struct History {
    pieces: VecDeque<Piece>,
    /// The piece that was read last.
    at: usize,
    /// Kinks of this order and higher are ignored.
    felt: u32,
    /// The part of its radius up to which the last polynomial is used beyond its end.
    ahead: f64,
    /// How far a polynomial may differ from a neighbour that it replaces, relative to the
    /// elongation or to 1, whichever is larger.
    apart: f64,
}

impl History {
    /// Sets a = `a` for all times before `now`. Kinks of the order `felt` and higher are ignored.
    pub(super) fn restart(&mut self, a: f64, now: f64, felt: u32) {
        let mut coefficients = [0.0; MOST_ORDER + 1];
        coefficients[0] = a;
        self.felt = felt;
        self.pieces.clear();
        self.at = 0;
        self.pieces.push_back(Piece {
            from: f64::NEG_INFINITY,
            to: now,
            radius: f64::INFINITY,
            order: 0,
            a: coefficients,
            kink: SMOOTH,
        });
    }

    /// A past of at least two delays in which a has grown at the rate `rate`, to `a` at time 0.
    pub(super) fn restart_rising(&mut self, a: f64, rate: f64, tau: f64) {
        self.restart(a, 0.0, self.felt);
        let past = 3.0 * tau;
        let piece = &mut self.pieces[0];
        (piece.from, piece.radius, piece.order) = (-past, f64::INFINITY, 1);
        piece.a[0] = a - rate * past;
        piece.a[1] = rate;
    }

    /// Sets how far polynomials are used beyond their steps. The last one is used as far as its
    /// error, times a `gain`, stays within the tolerance. The error is its last term, of this
    /// `order`, which reaches the tolerance at the end of its radius. A polynomial replaces its
    /// neighbours where it agrees with them to some times the `tolerance`: its last terms do not
    /// show errors of the middle ones.
    pub(super) fn look_ahead(&mut self, gain: f64, order: usize, tolerance: f64) {
        self.apart = NEIGHBOURS_APART * tolerance;
        self.ahead = SHARE.min(1.0 / rough_root(gain, order));
    }

    /// The part of its radius up to which the last polynomial is used beyond its end.
    pub(super) fn ahead(&self) -> f64 {
        self.ahead
    }

    /// Ignores kinks of the order `felt` and higher from now on.
    pub(super) fn feel(&mut self, felt: u32) {
        self.felt = felt;
    }

    /// Becomes a copy of `other` in the memory that it has.
    pub(super) fn copy_from(&mut self, other: &Self) {
        self.pieces.clear();
        self.pieces.extend(other.pieces.iter().cloned());
        (self.at, self.felt) = (other.at, other.felt);
        (self.ahead, self.apart) = (other.ahead, other.apart);
    }

    /// Shifts all times by `time`.
    pub(super) fn shift(&mut self, time: f64) {
        for piece in &mut self.pieces {
            piece.from += time;
            piece.to += time;
        }
    }

    /// Adds the step from the end of the last one to `to`. Its polynomial holds on the step, and
    /// within `radius` of its start on both sides. False where there is no room for it.
    #[must_use]
    pub(super) fn push(&mut self, to: f64, radius: f64, a: &[f64], kink: u32) -> bool {
        let from = self.pieces.back().map_or(to, |p| p.to);
        let mut coefficients = [0.0; MOST_ORDER + 1];
        coefficients[..a.len()].copy_from_slice(a);
        self.add(Piece {
            from,
            to,
            radius,
            order: a.len() - 1,
            a: coefficients,
            kink,
        })
    }

    /// Whether there is no room for another step.
    pub(super) fn is_full(&self) -> bool {
        self.pieces.len() >= MOST_KEPT
    }

    fn add(&mut self, piece: Piece) -> bool {
        let room = !self.is_full();
        if room {
            self.pieces.push_back(piece);
        }
        room
    }

    /// Forgets steps that ended before `time`.
    pub(super) fn forget_before(&mut self, time: f64) {
        while self.pieces.len() > 1 && self.pieces[0].to < time {
            self.pieces.pop_front();
            self.at = self.at.saturating_sub(1);
        }
    }

    /// Writes the polynomial of a from `time` on to `out`, in powers of the time since `time`;
    /// coefficients beyond its order are zero. `latest` is the order of the kink at the end of the
    /// last step.
    pub(super) fn read(&mut self, time: f64, latest: u32, out: &mut Coefficients) -> Reach {
        // `time` has the rounding of the present, which is one delay later. Without this margin a
        // step could be too short to move on.
        let now = self.pieces.back().map_or(0.0, |p| p.to.abs());
        let close = 8.0 * f64::EPSILON * time.abs().max(now).max(1.0);
        while self.at + 1 < self.pieces.len() && time >= self.pieces[self.at].to - close {
            self.at += 1;
        }
        while self.at > 0 && time < self.pieces[self.at].from - close {
            self.at -= 1;
        }
        let (index, reach) = self.farthest(time, latest);
        let piece = &self.pieces[index];
        let since = time - piece.from;
        let by = match since.is_finite() && since.abs() > close {
            true => since,
            false => 0.0,
        };
        shift(&piece.a[..=piece.order], by, out);
        reach
    }

    /// The first kink after the time that was read last, or else the end of the known past.
    /// `latest` is the order of the kink at the end of the last step.
    pub(super) fn until_kink(&self, latest: u32) -> Reach {
        let next = self.pieces.iter().skip(self.at + 1);
        let kink = next.clone().find(|piece| piece.kink < self.felt);
        match (kink, self.pieces.back()) {
            (Some(piece), _) => Reach {
                until: piece.from,
                kink: piece.kink,
            },
            (None, last) => Reach {
                until: last.map_or(f64::INFINITY, |last| last.to),
                kink: if latest < self.felt { latest } else { SMOOTH },
            },
        }
    }

    /// The value at a time not beyond the last step.
    pub(super) fn at(&self, time: f64) -> f64 {
        let next = self.pieces.partition_point(|piece| piece.to < time);
        let piece = self.pieces.get(next).or(self.pieces.back());
        piece.map_or(f64::NAN, |piece| {
            let since = match piece.from.is_finite() {
                true => time - piece.from,
                false => 0.0,
            };
            value(&piece.a[..=piece.order], since)
        })
    }

    /// Whether the polynomial of the piece `index` agrees with the present piece at `from`, and
    /// with the piece at `until` there.
    fn stands_in(&self, index: usize, from: f64, until: f64) -> bool {
        let at = |piece: &Piece, time: f64| value(&piece.a[..=piece.order], time - piece.from);
        let agree = |one: &Piece, other: &Piece, time: f64| {
            let (p, q) = (at(one, time), at(other, time));
            let off = (p - q).abs();
            // NaN ends the motion elsewhere.
            off.is_nan() || off <= self.apart * q.abs().max(1.0)
        };
        let (piece, here) = (&self.pieces[index], &self.pieces[self.at]);
        let there = self.pieces.iter().skip(self.at).find(|p| p.to >= until);
        (index == self.at || agree(piece, here, from))
            && there.is_none_or(|there| agree(piece, there, until))
    }

    /// The value of the last polynomial at `time`, beyond its end.
    pub(super) fn foreseen(&self, time: f64) -> f64 {
        self.pieces.back().map_or(f64::NAN, |last| {
            value(&last.a[..=last.order], time - last.from)
        })
    }

    /// The piece that may be used longest from `time` on, and its reach. Across a boundary without
    /// a kink a polynomial may be used as far as it holds, forwards and backwards.
    fn farthest(&self, time: f64, latest: u32) -> (usize, Reach) {
        let mut best = (self.at, self.pieces[self.at].to);
        let mut kink = if latest < self.felt { latest } else { SMOOTH };
        // Without a kink at the end of the last step its polynomial continues the motion.
        let smooth_end = kink == SMOOTH && self.felt > 0;
        let mut end = f64::INFINITY;
        for (index, piece) in self.pieces.iter().enumerate().skip(self.at) {
            if index > self.at {
                if piece.kink < self.felt {
                    (kink, end) = (piece.kink, piece.from);
                    break;
                }
                if piece.from - time > SHARE * piece.radius {
                    kink = SMOOTH;
                    break;
                }
            }
            let until = piece.to.max(piece.from + SHARE * piece.radius);
            if until > best.1 {
                best = (index, until);
            }
            end = piece.to;
        }
        let own = self.pieces[self.at].to;
        let mut until = if smooth_end && best.0 + 1 == self.pieces.len() {
            let last = &self.pieces[best.0];
            last.to.max(last.from + self.ahead * last.radius)
        } else {
            // Nothing is known beyond a kink.
            best.1.min(end.max(own))
        };
        if until > own && !self.stands_in(best.0, time, until) {
            best = (self.at, own);
            until = own;
        }
        let kink = if until == end { kink } else { SMOOTH };
        (best.0, Reach { until, kink })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boundaries_are_kept_where_they_are_felt() {
        let mut history = History::default();
        history.restart(2.0, 0.0, 10);
        assert!(history.push(1.0, 4.0, &[2.0, 1.0], 1));
        assert!(history.push(2.0, 1.0, &[3.0, 1.0], SMOOTH));
        assert!(history.push(2.5, 0.5, &[4.0, -1.0], 2));
        let mut a = [0.0; MOST_ORDER + 1];
        assert_eq!(
            history.read(-1.0, 3, &mut a),
            Reach {
                until: 0.0,
                kink: 1
            }
        );
        assert_eq!(a[0], 2.0);
        assert_eq!(
            history.read(0.5, 3, &mut a),
            Reach {
                until: 2.0,
                kink: 2
            }
        );
        assert_eq!((a[0], a[1]), (2.5, 1.0));
        // The end of the last step is a kink as well, unless nothing happens there.
        let reach = |kink| Reach { until: 2.5, kink };
        assert_eq!(history.read(2.0, 3, &mut a), reach(3));
        assert_eq!(history.read(2.0, SMOOTH, &mut a), reach(SMOOTH));
        history.forget_before(1.5);
        assert_eq!(history.pieces.len(), 2);
    }

    /// Two pasts of a slope and a rest each, whose stretches differ. The extrapolated past
    /// continues their lengths and values evenly, with a kink where the stretches meet.
    #[test]
    fn pasts_are_extrapolated_with_their_stretches_aligned() {
        let past = |slip: f64, stick: f64, start: f64| {
            let mut history = History::default();
            history.restart(start, start, 10);
            assert!(history.push(start + slip, slip, &[start, 0.5], 2));
            assert!(history.push(start + slip + stick, stick, &[start + 0.5 * slip, 2.0], 2));
            history
        };
        let (mut before, mut last) = (past(1.0, 2.0, 5.0), past(1.2, 1.5, 7.0));
        let lengths = |last: f64, before: f64| Stretch {
            lengths: [last + 0.5 * (last - before), last, before],
        };
        let stretches = [lengths(1.5, 2.0), lengths(1.2, 1.0)];
        let mut third = History::default();
        third.extrapolate((&mut last, &mut before), 0.5, 2.0, &stretches);
        // It sticks for 1.25: half of the way on from 2 and 1.5.
        let ends = |history: &mut History, time: f64| {
            let mut a = [0.0; MOST_ORDER + 1];
            history.read(time, SMOOTH, &mut a);
            (a[0], a[1])
        };
        for part in [0.01, 0.3, 0.9] {
            let at = [5.0 + 3.0, 7.0 + 2.7, 0.0];
            let sticks = [2.0, 1.5, 1.25];
            let value = |history: &mut History, i: usize| ends(history, at[i] - part * sticks[i]).0;
            let (one, two) = (value(&mut before, 0), value(&mut last, 1));
            let expected = two + 0.5 * (two - one);
            let found = value(&mut third, 2);
            assert!(
                (found - expected).abs() < 1e-12,
                "{part}: {found} {expected}"
            );
        }
        let kinks = third.pieces.iter().filter(|p| p.kink == 2);
        let at: Vec<f64> = kinks.map(|p| p.from).collect();
        assert!(at.iter().any(|t| (t + 1.25).abs() < 1e-12), "{at:?}");
    }

    #[test]
    fn boundaries_nearer_than_the_present_is_rounded_are_passed() {
        let mut history = History::default();
        history.restart(2.0, 0.0, 10);
        assert!(history.push(0.3, 0.3, &[2.0, 1.0], 1));
        assert!(history.push(1000.0, 1000.0, &[3.0], 2));
        let mut a = [0.0; MOST_ORDER + 1];
        let reach = history.read(0.3 - 1e-14, SMOOTH, &mut a);
        assert!(1000.0 + (reach.until - 0.3) > 1000.0, "{reach:?}");
        assert_eq!(a[0], 3.0);
    }
}
