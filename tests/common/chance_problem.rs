//! Problems of critical velocities by chance, for tests and benches alike.

use slipmap::critical::Problem;
use slipmap::model::{FrictionLaw, Table};

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
        self.controlled(law.unwrap())
    }

    /// The same with Stribeck's law or a table, which may rise again at high speeds.
    #[allow(dead_code)]
    pub fn problem_of_other_laws(&mut self) -> Problem {
        let (mu0, v_s) = (self.between(0.3, 0.7), self.between(0.1, 1.0));
        let law = if self.between(0.0, 1.0) < 0.5 {
            FrictionLaw::stribeck(mu0, v_s, 1.0)
        } else {
            let end = self.between(0.2, 1.0);
            let speeds = vec![0.0, 0.3 * v_s, v_s, 2.0 * v_s, 6.0 * v_s];
            let rises = 0.5 * (0.95 - mu0);
            let mu_k = vec![0.95, mu0 + rises, mu0, mu0 + 0.02 * end, mu0 + rises * end];
            FrictionLaw::table(Table::new(speeds, mu_k).unwrap(), 1.0)
        };
        self.controlled(law.unwrap())
    }

    fn controlled(&mut self, law: FrictionLaw) -> Problem {
        let (alpha_v, alpha_n) = (self.between(-1.0, 0.1), self.between(-5.0, 0.5));
        let tau = self.between(0.05, 5.0);
        let (alpha_v, alpha_n) = match self.between(0.0, 3.0) {
            0.0..1.0 => (0.0, alpha_n),
            1.0..2.0 => (alpha_v, 0.0),
            _ => (0.5 * alpha_v, alpha_n),
        };
        Problem {
            law,
            velocity_unit: 1.0,
            alpha_v,
            alpha_n,
            tau,
        }
    }
}
