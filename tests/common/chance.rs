//! Numbers by chance from a seed, and how much of a test is asked for.

#![allow(dead_code, reason = "no test uses all of it")]

use slipmap::sweep::pieces::mixed;

/// SplitMix64.
pub struct Chance(pub u64);

impl Chance {
    /// The next number, less than `n`.
    pub fn below(&mut self, n: u64) -> u64 {
        let number = mixed(self.0);
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        number % n
    }
}

/// A number from the environment.
pub fn asked(name: &str, otherwise: u64) -> u64 {
    let number = std::env::var(name).ok().and_then(|n| n.parse().ok());
    number.unwrap_or(otherwise)
}
