//! Numbers by chance from a seed, by a linear congruence.

/// The state.
pub(crate) struct Chance(pub(crate) u64);

impl Chance {
    /// A number in [0, 1).
    pub(crate) fn next(&mut self) -> f64 {
        let (a, c) = (6_364_136_223_846_793_005, 1_442_695_040_888_963_407);
        self.0 = self.0.wrapping_mul(a).wrapping_add(c);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A number in [`from`, `to`).
    pub(crate) fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.next()
    }
}
