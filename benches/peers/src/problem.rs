//! The three problems, as slipmap's `benches/motion.rs` has them, and the equations in the form the
//! crate wants.

use differential_equations::prelude::DDE;
use nalgebra::Vector2;

/// Elongation a and velocity ẋ.
pub type State = Vector2<f64>;

pub const END: f64 = 200.0;

/// μ_K(0⁺) and the velocity of weakening; μ_S = 1.
const MU0: f64 = 0.5;
const V_S: f64 = 0.5;

/// The block slides from a = μ_K(v0), ẋ = v0 + 0.05, under control from the start.
pub const SMOOTH: Parameters = Parameters {
    v0: 0.35,
    alpha_v: -0.33,
    alpha_n: 0.0,
    tau: 4.15,
    switch_on: 0.0,
};

/// Fig. 3 (a) and (b) of the letter, from rest at a = 0.
pub const HYBRID: [(&str, Parameters); 2] = [
    (
        "hybrid-3a",
        Parameters {
            switch_on: 70.0,
            ..SMOOTH
        },
    ),
    (
        "hybrid-3b",
        Parameters {
            v0: 0.1,
            alpha_v: 0.0,
            alpha_n: -10.0,
            tau: 0.5,
            switch_on: 70.0,
        },
    ),
];

#[derive(Debug, Clone, Copy)]
pub struct Parameters {
    pub v0: f64,
    pub alpha_v: f64,
    pub alpha_n: f64,
    pub tau: f64,
    pub switch_on: f64,
}

impl Parameters {
    /// The start of [`SMOOTH`].
    pub fn sliding(&self) -> State {
        State::new(friction(self.v0), self.v0 + 0.05)
    }
}

fn friction(speed: f64) -> f64 {
    MU0 / (1.0 + speed / V_S)
}

/// What the block does: direction +1, −1 in slip, 0 in stick.
#[derive(Debug, Clone, Copy)]
pub struct Regime {
    pub parameters: Parameters,
    pub controlled: bool,
    pub direction: f64,
}

impl Regime {
    pub fn load(&self, a: f64, delayed: f64) -> f64 {
        if self.controlled {
            1.0 + self.parameters.alpha_n * (a - delayed)
        } else {
            1.0
        }
    }

    pub fn slips(&self) -> bool {
        self.direction != 0.0
    }
}

impl DDE<1, f64, State> for Regime {
    fn diff(&self, _t: f64, now: &State, past: &[State; 1], slope: &mut State) {
        let (a, u, delayed) = (now[0], now[1], past[0][0]);
        let p = &self.parameters;
        let pull = if self.controlled {
            p.v0 + p.alpha_v * (a - delayed)
        } else {
            p.v0
        };
        *slope = if self.slips() {
            let drag = self.direction * friction(self.direction * u);
            State::new(pull - u, a - drag * self.load(a, delayed))
        } else {
            State::new(pull, 0.0)
        };
    }

    fn lags(&self, _t: f64, _now: &State, lags: &mut [f64; 1]) {
        lags[0] = self.parameters.tau;
    }
}
