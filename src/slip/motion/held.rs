//! Where a signal is beside the values at which actuators reach their limits.

use crate::model::series::{MOST_ORDER, first_zero};

/// Where S is, beside the values at which an actuator reaches its limits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Side {
    #[default]
    Between,
    Below,
    Above,
}

/// Where S is beside the limits of v and beside those of N.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Held {
    pub(super) velocity: Side,
    pub(super) load: Side,
}

impl Held {
    /// Whether v or N is at a limit.
    pub(super) fn at_limit(self) -> bool {
        self != Self::default()
    }
}

/// The values of S at which an actuator reaches its limits, the smaller one first, and those
/// limits.
#[derive(Debug, Clone, Copy)]
pub(super) struct Span {
    signals: [f64; 2],
    limits: [f64; 2],
}

impl Span {
    /// The span of the command `rest` + `gain` S. Without a gain no S reaches a limit.
    pub(super) fn of(rest: f64, gain: f64, [least, most]: [f64; 2]) -> Self {
        let reached = |limit: f64| (limit - rest) / gain;
        if gain == 0.0 {
            return Self {
                signals: [f64::NEG_INFINITY, f64::INFINITY],
                limits: [least, most],
            };
        }
        let limits = if gain > 0.0 {
            [least, most]
        } else {
            [most, least]
        };
        Self {
            signals: limits.map(reached),
            limits,
        }
    }

    /// Where `signal` is, which was `before`; within `slack` of a limit it has not moved.
    pub(super) fn side(&self, signal: f64, before: Side, slack: f64) -> Side {
        let [below, above] = self.signals;
        match before {
            Side::Above if signal > above - slack => Side::Above,
            Side::Below if signal < below + slack => Side::Below,
            _ if signal > above + slack => Side::Above,
            _ if signal < below - slack => Side::Below,
            _ => Side::Between,
        }
    }

    /// The limit at which an actuator is held; none where it is free.
    pub(super) fn held_at(&self, side: Side) -> Option<f64> {
        match side {
            Side::Between => None,
            Side::Below => Some(self.limits[0]),
            Side::Above => Some(self.limits[1]),
        }
    }

    /// Where S first leaves its `side` by `slack`, within `length`.
    pub(super) fn left(&self, side: Side, signal: &[f64], slack: f64, length: f64) -> Option<f64> {
        let [below, above] = self.signals;
        let zero = |limit: f64, sign: f64| {
            let mut room = [0.0; MOST_ORDER + 1];
            for (room, c) in room.iter_mut().zip(signal) {
                *room = sign * c;
            }
            room[0] = sign * (signal[0] - limit) + slack;
            let room = &room[..signal.len()];
            limit.is_finite().then(|| first_zero(room, length))?
        };
        match side {
            Side::Above => zero(above, 1.0),
            Side::Below => zero(below, -1.0),
            Side::Between => match (zero(below, 1.0), zero(above, -1.0)) {
                (Some(one), Some(other)) => Some(one.min(other)),
                (one, other) => one.or(other),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_is_a_value_of_the_signal() {
        let span = Span::of(1.0, -2.0, [0.5, 3.0]);
        assert_eq!((span.signals, span.limits), ([-1.0, 0.25], [3.0, 0.5]));
        let side = |signal, before| span.side(signal, before, 1e-3);
        assert_eq!(side(0.2505, Side::Between), Side::Between);
        assert_eq!(side(0.2505, Side::Above), Side::Above);
        assert_eq!(side(0.26, Side::Between), Side::Above);
        assert_eq!(side(0.2, Side::Above), Side::Between);
        assert_eq!(side(-2.0, Side::Above), Side::Below);
        assert_eq!(span.held_at(Side::Above), Some(0.5));
        let endless = Span::of(1.0, 0.0, [0.5, 3.0]);
        assert_eq!(endless.side(1e300, Side::Between, 0.0), Side::Between);
    }

    #[test]
    fn a_signal_leaves_its_side_past_the_noise() {
        let span = Span::of(0.0, 1.0, [-1.0, 2.0]);
        let rising = [0.0, 1.0];
        assert_eq!(span.left(Side::Between, &rising, 0.5, 9.0), Some(2.5));
        assert_eq!(span.left(Side::Between, &rising, 0.5, 2.0), None);
        assert_eq!(span.left(Side::Below, &[-1.0, 1.0], 0.25, 9.0), Some(0.25));
        let falling = [3.0, -1.0];
        assert_eq!(span.left(Side::Above, &falling, 0.25, 9.0), Some(1.25));
    }
}
