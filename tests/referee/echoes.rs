//! Kinks of the elongation that are felt one delay later, and then once more as echoes of
//! themselves; with memory and latency at all sums of latencies and delays.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::setting::Setting;

/// Each echo in the elongation is at least one derivative smoother; later ones are below the order
/// of a step.
const MOST: u32 = 5;
/// Through the memory it is no smoother, and smaller by R every time; echoes smaller than this
/// share are below the error of a step.
const SMALLEST: f64 = 1e-9;
/// Times nearer than this, relative, are one.
const SAME_TIME: f64 = 1e-13;

/// A kink to come.
#[derive(Debug, Clone, Copy)]
struct Echo {
    t: f64,
    /// How smooth it is, in derivatives.
    number: u32,
    /// How large, over the first one.
    share: f64,
    /// It is one of what is fed back now, rather than of what will be a latency later.
    acts: bool,
}

impl PartialEq for Echo {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Echo {}

impl PartialOrd for Echo {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Echo {
    /// The earliest is the greatest.
    fn cmp(&self, other: &Self) -> Ordering {
        other.t.total_cmp(&self.t)
    }
}

/// The kinks to come.
#[derive(Debug, Clone, Default)]
pub(crate) struct Echoes(BinaryHeap<Echo>);

impl Echoes {
    /// The elongation has a kink at time `t`, as smooth as an echo of this number.
    pub(crate) fn of_kink(&mut self, t: f64, number: u32, setting: &Setting) {
        self.of_elongation(t, number, 1.0, setting);
    }

    fn of_elongation(&mut self, t: f64, number: u32, share: f64, s: &Setting) {
        let echo = |t: f64, acts: bool| Echo {
            t,
            number,
            share,
            acts,
        };
        self.0.push(echo(t + s.tau, false));
        if s.latency > 0.0 {
            self.0.push(echo(t + s.latency, true));
        }
    }

    /// When the next one is felt.
    pub(crate) fn next(&self) -> f64 {
        self.0.peek().map_or(f64::INFINITY, |echo| echo.t)
    }

    /// Those that are felt now have echoes; in the elongation where control acts.
    pub(crate) fn pass(&mut self, now: f64, setting: &Setting, controlled: bool) {
        let reached = now + SAME_TIME * now.abs().max(setting.time());
        while let Some(echo) = self.0.peek().copied().filter(|echo| echo.t <= reached) {
            self.0.pop();
            let Echo {
                t, number, share, ..
            } = echo;
            if !echo.acts {
                let smaller = share * setting.memory.abs();
                if smaller > SMALLEST {
                    self.0.push(Echo {
                        t: t + setting.tau,
                        share: smaller,
                        ..echo
                    });
                }
                if setting.latency > 0.0 {
                    self.0.push(Echo {
                        t: t + setting.latency,
                        acts: true,
                        ..echo
                    });
                    continue;
                }
            }
            if controlled && number < MOST {
                self.of_elongation(t, number + 1, share, setting);
            }
        }
    }
}
