//! Numbers by chance from a seed, and how much of a test is asked for.

#![allow(dead_code, reason = "no test uses all of it")]

use slipmap::sweep::plan::pieces::mixed;

/// SplitMix64.
pub(crate) struct Chance(pub u64);

impl Chance {
    /// The next number.
    pub(crate) fn next(&mut self) -> u64 {
        let number = mixed(self.0);
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        number
    }

    /// A number less than `n`.
    pub(crate) fn below(&mut self, n: u64) -> u64 {
        self.next() % n
    }

    /// A number in [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A number in [`from`, `to`).
    pub(crate) fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.unit()
    }

    /// A number whose logarithm lies anywhere between theirs.
    pub(crate) fn log(&mut self, from: f64, to: f64) -> f64 {
        self.between(from.ln(), to.ln()).exp()
    }

    /// A number of the standard normal distribution, by the method of Box and Muller.
    pub(crate) fn normal(&mut self) -> f64 {
        let (radius, angle) = (1.0 - self.unit(), std::f64::consts::TAU * self.unit());
        (-2.0 * radius.ln()).sqrt() * angle.cos()
    }

    /// An index into `n` things.
    pub(crate) fn of(&mut self, n: usize) -> usize {
        (self.unit() * n as f64) as usize
    }
}

/// A number from the environment.
pub(crate) fn asked(name: &str, otherwise: u64) -> u64 {
    let number = std::env::var(name).ok().and_then(|n| n.parse().ok());
    number.unwrap_or(otherwise)
}
