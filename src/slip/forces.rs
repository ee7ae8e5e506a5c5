//! The forces on the block in a state of a motion, as sensors at the rig measure them.

use super::case::Case;
use super::motion::Mode;

/// The forces on the block, in the units of its case.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Forces {
    /// κ a + c ȧ, of the spring and the dashpot beside it: what a sensor between drive and block
    /// measures. Positive where it pulls forwards.
    pub pulling: f64,
    /// Friction without the dashpot to the ground, positive where it acts backwards: μ_K N against
    /// the motion in slip, what balances the pull in stick.
    pub friction: f64,
}

/// A state of the block, in the units of its case.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// What the block does.
    pub mode: Mode,
    /// Its velocity.
    pub x_dot: f64,
    /// Elongation of the spring.
    pub a: f64,
    /// Pulling velocity.
    pub v: f64,
    /// Normal load.
    pub n: f64,
}

impl Case {
    /// The forces on the block in a state. In slip they obey
    /// m ẍ = `pulling` − `friction` − c_g ẋ, with the dashpot c_g to the ground.
    #[must_use]
    pub fn forces(&self, state: State) -> Forces {
        let State {
            mode,
            x_dot,
            a,
            v,
            n,
        } = state;
        let damping = self.oscillator.dashpots().damping;
        let pulling = self.oscillator.stiffness() * a + damping * (v - x_dot);
        let kinetic = || self.law.mu_k(x_dot.abs()) * n;
        let friction = match mode {
            Mode::Stick => pulling,
            Mode::Forwards => kinetic(),
            Mode::Backwards => -kinetic(),
        };
        Forces { pulling, friction }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    use crate::model::{Dashpots, Feedback, FrictionLaw, Oscillator, Table};
    use crate::slip::case::Start;
    use crate::slip::motion::Accuracy;
    use crate::slip::programme::Programme;

    fn case(law: FrictionLaw) -> Case {
        let dashpots = Dashpots {
            damping: 0.5,
            viscous: 0.25,
        };
        Case {
            oscillator: Oscillator::new(2.0, 8.0, 3.0)
                .and_then(|of| of.damped(dashpots))
                .unwrap(),
            law,
            feedback: Feedback::new(0.0, 0.0, 1.0),
            v0: 1.0,
            programme: Programme::default(),
            switch_on: f64::INFINITY,
            start: Start::State {
                x_dot0: 0.0,
                a0: 0.0,
            },
            horizon: 10.0,
            steps: 1000,
            accuracy: Accuracy::default(),
        }
    }

    #[test]
    fn forces_by_hand() {
        let coulomb = case(FrictionLaw::coulomb(0.5, 1.0).unwrap());
        let forces = |mode, x_dot| {
            let state = State {
                mode,
                x_dot,
                a: 0.25,
                v: 1.5,
                n: 3.0,
            };
            let Forces { pulling, friction } = coulomb.forces(state);
            (pulling, friction)
        };
        // 8 × 0.25 + 0.5 (1.5 − ẋ); 0.5 × 3.
        assert_eq!(forces(Mode::Forwards, 0.5), (2.5, 1.5));
        assert_eq!(forces(Mode::Backwards, -0.5), (3.0, -1.5));
        assert_eq!(forces(Mode::Stick, 0.0), (2.75, 2.75));
        let lifted = State {
            mode: Mode::Forwards,
            x_dot: 0.5,
            a: 0.25,
            v: 1.5,
            n: 0.0,
        };
        assert_eq!(coulomb.forces(lifted).friction, 0.0);
    }

    /// A damaged file may hold any velocity.
    #[test]
    fn any_velocity_has_some_force() {
        let table = Table::new(vec![0.0, 0.25, 1.5], vec![0.8, 0.4, 0.5]).unwrap();
        for law in [
            FrictionLaw::table(table, 1.0),
            FrictionLaw::coulomb(0.4, 1.0),
            FrictionLaw::weakening(0.5, 0.7, 1.0),
            FrictionLaw::stribeck(0.3, 0.2, 0.9),
            FrictionLaw::hyperbolic(0.3, 0.4, 0.9, 0.01),
        ] {
            let case = case(law.unwrap());
            for x_dot in [f64::NAN, f64::INFINITY, -f64::INFINITY, 1e300, 0.0] {
                let state = State {
                    mode: Mode::Forwards,
                    x_dot,
                    a: f64::NAN,
                    v: f64::NAN,
                    n: 1.0,
                };
                assert!(case.forces(state).pulling.is_nan());
            }
        }
    }
}
