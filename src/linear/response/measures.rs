//! What is read from a response: final value, overshoot, times of rise and settling.

use super::step::Step;

/// The band in which a response has settled, as a share of its final value, or of its peak where
/// that is 0.
pub const SETTLED: f64 = 0.02;
/// Between these shares of the final value it rises.
const RISE: [f64; 2] = [0.1, 0.9];
/// A step is looked at in so many parts, in each of which a level is crossed once at most.
const PARTS: usize = 4;
/// Halvings of a part for a crossing.
const HALVINGS: usize = 50;

/// What is read from a response in time. Times are in the unit of the delay.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measures {
    /// The value at which it settles; none where it does not.
    pub final_value: Option<f64>,
    /// The largest value in the direction of the final value; of a response without one, or with
    /// 0, the one of the largest size.
    pub peak: f64,
    /// When the peak is reached first.
    pub peak_time: f64,
    /// By how much the peak is above the final value, over that value; none where that is 0.
    pub overshoot: Option<f64>,
    /// The time from 10 % to 90 % of the final value; none where it is not reached.
    pub rise_time: Option<f64>,
    /// From when on it stays in the band until the end; none where it does not.
    pub settling_time: Option<f64>,
    reached: [Option<f64>; 2],
    outside: Option<f64>,
}

impl Measures {
    pub(super) fn of_final(final_value: Option<f64>) -> Self {
        Self {
            final_value,
            peak: 0.0,
            peak_time: 0.0,
            overshoot: None,
            rise_time: None,
            settling_time: None,
            reached: [None; 2],
            outside: None,
        }
    }

    /// The final value in the direction of which a peak is one; none for 0.
    fn aim(&self) -> Option<f64> {
        self.final_value.filter(|aim| *aim != 0.0)
    }

    /// How far a value is, in the direction of the final value.
    fn height(&self, value: f64) -> f64 {
        match self.aim() {
            Some(aim) => value * aim.signum(),
            None => value.abs(),
        }
    }

    /// Half of the width of the band.
    pub(super) fn band(&self) -> f64 {
        SETTLED * self.aim().unwrap_or(self.peak).abs()
    }

    /// Looks for a peak, and for the levels of the rise.
    pub(super) fn look(&mut self, step: &Step) {
        let risen = self.aim().is_none() || self.reached[1].is_some();
        if risen && step.farthest_from(0.0) < self.height(self.peak) {
            return;
        }
        for_each_part(step, |from, until| {
            let top = (step.slope(from) * step.slope(until) < 0.0)
                .then(|| crossing([from, until], |share| step.slope(share)));
            for share in [Some(from), top, Some(until)].into_iter().flatten() {
                let value = step.value(share);
                if self.height(value) > self.height(self.peak) {
                    (self.peak, self.peak_time) = (value, step.time(share));
                }
            }
            let Some(aim) = self.aim() else {
                return;
            };
            for (level, reached) in RISE.into_iter().zip(&mut self.reached) {
                let above = |share: f64| step.value(share) / aim - level;
                if reached.is_none() && (above(from) >= 0.0 || above(until) >= 0.0) {
                    let share = if above(from) >= 0.0 {
                        from
                    } else {
                        crossing([from, until], above)
                    };
                    *reached = Some(step.time(share));
                }
            }
        });
    }

    /// Looks when the response leaves or enters the band of this half width.
    pub(super) fn look_at_band(&mut self, step: &Step, band: f64) {
        let aim = self.final_value.unwrap_or(0.0);
        if step.farthest_from(aim) < band {
            return;
        }
        for_each_part(step, |from, until| {
            let beyond = |share: f64| (step.value(share) - aim).abs() - band;
            if beyond(until) > 0.0 {
                self.outside = Some(step.time(until));
            } else if beyond(from) > 0.0 {
                self.outside = Some(step.time(crossing([from, until], beyond)));
            }
        });
    }

    /// Sums up what was seen until the end.
    pub(super) fn end(&mut self, until: f64) {
        let aim = self.aim();
        self.overshoot = aim.map(|aim| (self.peak / aim - 1.0).max(0.0));
        let [from, to] = self.reached;
        self.rise_time = from.zip(to).map(|(from, to)| to - from);
        let outside = self.outside.unwrap_or(0.0);
        let settled = self.final_value.is_some() && outside < until;
        self.settling_time = settled.then_some(outside);
    }
}

/// Each part of a step, from a share to a share.
fn for_each_part(step: &Step, mut look: impl FnMut(f64, f64)) {
    let whole = ((step.until - step.from) / step.length).min(1.0);
    let share = |part: usize| whole * part as f64 / PARTS as f64;
    for part in 0..PARTS {
        look(share(part), share(part + 1));
    }
}

/// Where a function changes its sign.
fn crossing([mut from, mut until]: [f64; 2], of: impl Fn(f64) -> f64) -> f64 {
    let is_above = of(from) > 0.0;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (from + until);
        match (of(middle) > 0.0) == is_above {
            true => from = middle,
            false => until = middle,
        }
    }
    0.5 * (from + until)
}
