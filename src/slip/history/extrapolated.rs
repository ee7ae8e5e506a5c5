//! A past told from two others, by which it is expected to go on.

use super::{History, Piece, SMOOTH, Stretch};
use crate::slip::series::{MOST_ORDER, shifted};

/// Pasts correspond to one another to this, compared with all of their span.
const SLIVER: f64 = 1e-7;

/// Two pasts, the last one first, and how one beyond them follows.
struct Pasts<'a> {
    of: [&'a mut History; 2],
    /// How far beyond the last one, in units of the way to it from the one before.
    share: f64,
    /// The highest order of their polynomials.
    order: usize,
    /// Shorter pieces than this mean nothing.
    shortest: f64,
}

/// Where in a stretch of time a past is told.
#[derive(Clone, Copy)]
struct Within {
    /// The end of the stretch: in the past that is told, and in the two others.
    end: [f64; 3],
    /// How fast time passes in the two others.
    rates: [f64; 2],
}

impl Pasts<'_> {
    /// The piece from `from` on, with a kink of the order `kink` there; and the kink at its end.
    fn piece(&mut self, from: f64, kink: u32, within: Within) -> (Piece, u32) {
        let Within { end, rates } = within;
        // A little later: where a stretch begins, what is alike does so to rounding only.
        let ahead = (from + self.shortest).min(end[0]);
        let mut c = [[0.0; MOST_ORDER + 1]; 2];
        let mut until = [0.0; 2];
        let mut next = [SMOOTH; 2];
        for (i, past) in self.of.iter_mut().enumerate() {
            let time = |t: f64| end[i + 1] - (end[0] - t) * rates[i];
            let reach = past.read(time(ahead), SMOOTH, &mut c[i]);
            c[i] = shifted(&c[i][..=self.order], (from - ahead) * rates[i]);
            until[i] = ahead + (reach.until - time(ahead)) / rates[i];
            next[i] = reach.kink;
        }
        let sooner = usize::from(until[1] < until[0]);
        let to = match until[sooner].max(ahead) {
            to if to > end[0] - self.shortest => end[0],
            to => to,
        };
        let mut powers = [1.0; 2];
        let mut a = [0.0; MOST_ORDER + 1];
        for (k, a) in a.iter_mut().enumerate().take(self.order + 1) {
            let [one, other] = [0, 1].map(|i| c[i][k] * powers[i]);
            *a = one + self.share * (one - other);
            powers = [0, 1].map(|i| powers[i] * rates[i]);
        }
        let piece = Piece {
            from,
            to,
            radius: to - from,
            order: self.order,
            a,
            kink,
        };
        (piece, next[sooner])
    }
}

impl History {
    /// Becomes, over `span` until time 0, `last` and `share` of the way from `before` to it beyond
    /// it, both as of their ends; false where that has no room.
    ///
    /// What is alike in the two pasts stands at the same place of stretches of time that follow one
    /// another, back and back again through `stretches`, the last one first.
    pub(in crate::slip) fn extrapolate(
        &mut self,
        (last, before): (&mut Self, &mut Self),
        share: f64,
        span: f64,
        stretches: &[Stretch],
    ) -> bool {
        (self.at, self.felt) = (0, last.felt);
        (self.ahead, self.apart) = (last.ahead, last.apart);
        self.pieces.clear();
        let orders = |h: &Self| h.pieces.iter().map(|p| p.order).max().unwrap_or(0);
        let order = orders(last).max(orders(before));
        // The ends of the present stretch.
        let ends = [&*last, &*before].map(|h| h.pieces.back().map_or(0.0, |p| p.to));
        let mut end = [0.0, ends[0], ends[1]];
        let mut back = 0;
        let stretch = |back: usize| &stretches[back % stretches.len()].lengths;
        while end[0] - stretch(back)[0] > -span {
            end = std::array::from_fn(|i| end[i] - stretch(back)[i]);
            back += 1;
        }
        let mut pasts = Pasts {
            of: [last, before],
            share,
            order,
            shortest: SLIVER * span,
        };
        let mut from = -span;
        loop {
            let lengths = stretch(back);
            let rates = [1, 2].map(|i| lengths[i] / lengths[0]);
            // A stretch begins where something happened.
            let mut kink = 2;
            while from < end[0] {
                let (piece, next) = pasts.piece(from, kink, Within { end, rates });
                (from, kink) = (piece.to, next);
                if !self.add(piece) {
                    return false;
                }
            }
            if back == 0 {
                return true;
            }
            back -= 1;
            end = std::array::from_fn(|i| end[i] + stretch(back)[i]);
        }
    }
}
