//! Problems of critical velocities by chance, for tests and benches alike.

use slipmap::critical::Problem;
use slipmap::model::FrictionLaw;

/// Numbers by chance (SplitMix64).
pub struct Chance(pub u64);

impl Chance {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        low + (high - low) * (z >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Weakening or Coulomb friction under load, velocity or mixed control.
    pub fn problem(&mut self) -> Problem {
        let (mu0, v_s) = (self.between(0.3, 0.7), self.between(0.2, 1.5));
        let law = if self.between(0.0, 1.0) < 0.2 {
            FrictionLaw::coulomb(mu0, 1.0)
        } else {
            FrictionLaw::weakening(mu0, v_s, 1.0)
        };
        let (alpha_v, alpha_n) = (self.between(-1.0, 0.1), self.between(-5.0, 0.5));
        let tau = self.between(0.05, 5.0);
        let (alpha_v, alpha_n) = match self.between(0.0, 3.0) {
            0.0..1.0 => (0.0, alpha_n),
            1.0..2.0 => (alpha_v, 0.0),
            _ => (0.5 * alpha_v, alpha_n),
        };
        Problem {
            law: law.unwrap(),
            velocity_unit: 1.0,
            alpha_v,
            alpha_n,
            tau,
        }
    }
}
