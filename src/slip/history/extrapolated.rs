//! A past extrapolated from two others.

use super::{History, Piece, SMOOTH, Stretch};
use crate::model::series::{MOST_ORDER, shifted};

/// How well two pasts are aligned, relative to their whole span.
const SLIVER: f64 = 1e-7;

/// Two pasts, the last one first, and how the next one is extrapolated.
struct Pasts<'a> {
    of: [&'a mut History; 2],
    /// How far beyond the last one, in units of the difference between the two.
    share: f64,
    /// The highest order of their polynomials.
    order: usize,
    /// Pieces shorter than this are rounding.
    shortest: f64,
}

/// A stretch of time in the extrapolated past, and the same stretch in the two others.
#[derive(Clone, Copy)]
struct Within {
    /// The end of the stretch: in the extrapolated past, and in the two others.
    end: [f64; 3],
    /// How fast time passes in the two others.
    rates: [f64; 2],
}

impl Pasts<'_> {
    /// The piece from `from` on, with a kink of the order `kink` there; and the kink at its end.
    fn piece(&mut self, from: f64, kink: u32, within: Within) -> (Piece, u32) {
        let Within { end, rates } = within;
        // A little later: the starts of corresponding stretches agree only to rounding.
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
    /// Becomes last + share · (last − before) over `span` until time 0, with all pasts counted back
    /// from their ends. False where there is no room for it.
    ///
    /// The pasts are aligned by stretches of time that correspond to one another. `stretches`, the
    /// last one first, are repeated backwards over the whole span.
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
            // A stretch begins with an event.
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
