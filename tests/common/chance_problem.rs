//! Problems of critical velocities by chance, for tests and benches alike.

use slipmap::critical::Problem;
use slipmap::model::{Feedback, FrictionLaw, Table};

use super::chance::Chance;

impl Chance {
    /// Weakening or Coulomb friction under load, velocity or mixed control.
    pub(crate) fn problem(&mut self) -> Problem {
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
    pub(crate) fn problem_of_other_laws(&mut self) -> Problem {
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
        Problem::new(law, Feedback::new(alpha_v, alpha_n, tau))
    }
}
