//! How near ẋ comes to zero in slip: its minima inside a step, and the minimum that a stop cut off.

use super::step::Step;
use crate::model::series::{derivative, first_zero, shifted, value};

/// Steps of Newton's method on the way to a minimum.
const NEWTON_STEPS: usize = 8;

impl Step {
    /// The first minimum of ẋ inside the step: the time since its start, and the value. None where
    /// there is none.
    #[must_use]
    pub(crate) fn speed_minimum(&self) -> Option<(f64, f64)> {
        let slope = derivative(Self::range(&self.u, self.order), 1.0);
        let slope = &slope[..self.order];
        // A step is taken to have at most one minimum; the slopes at its ends show whether it does.
        if slope[0] > 0.0 || value(slope, self.length) < 0.0 {
            return None;
        }
        let falling = derivative(Self::range(&self.u, self.order), -1.0);
        let s = first_zero(&falling[..self.order], self.length)?;
        Some((s, value(Self::range(&self.u, self.order), s)))
    }

    /// The time from the stop at the end of this step to the minimum of ẋ that the stop cut off,
    /// and the value there, which is at most 0. The slip is continued with the friction for ẋ > 0.
    /// For a slip backwards the value is minus the maximum. It is a smooth function of the
    /// parameters and is zero where the stop is a graze.
    #[must_use]
    pub(crate) fn minimum_beyond_stop(&self) -> (f64, f64) {
        let mut about = shifted(Self::range(&self.u, self.order), self.length);
        if about[1] > 0.0 {
            for c in &mut about {
                *c = -*c;
            }
        }
        let (fall, bend) = (-about[1], 2.0 * about[2]);
        if bend <= 0.0 {
            // It falls faster and faster: nowhere near a graze.
            return (f64::INFINITY, -fall.abs());
        }
        let parabola = fall / bend;
        let slope = derivative(&about[..=self.order], 1.0);
        let slope = &slope[..self.order];
        let bends = derivative(slope, 1.0);
        let bends = &bends[..self.order - 1];
        let mut s = parabola;
        for _ in 0..NEWTON_STEPS {
            let bend = value(bends, s);
            if bend <= 0.0 || s > self.radius {
                return (parabola, -0.5 * fall * parabola);
            }
            let correction = value(slope, s) / bend;
            s -= correction;
            if correction.abs() <= 1e-9 * s {
                break;
            }
        }
        if (0.0..=self.radius).contains(&s) {
            let c = &about[1..=self.order];
            (s, s * value(c, s))
        } else {
            (parabola, -0.5 * fall * parabola)
        }
    }
}
