//! Return maps of one number with closed forms, in the place of the oscillator's, for tests: a
//! graze, a saddle-node, period doubling and a crisis, each at a known v0. And problems of the
//! letter.

use super::event_functions::{Event, MOST_SLIPS};
use super::options::ContinuationOptions;
use super::problem::Problem;
use super::regime::{Followed, Observation, Regime, Response};
use super::return_map::{Cycle, NoReturn, Period, ReturnMap, Stop};
use crate::model::{Feedback, FrictionLaw};
use crate::slip::motion::{Accuracy, Stretch};
use crate::slip::outcome::{Outcome, Summary};

/// A problem with M = κ = N0 = μ_S = 1.
pub(super) fn problem(law: FrictionLaw, alpha_v: f64, alpha_n: f64, tau: f64) -> Problem {
    Problem::new(law, Feedback::new(alpha_v, alpha_n, tau))
}

/// A problem with M = κ = N0 = μ_S = 1 and the friction law of the letter's Fig. 3.
pub(super) fn letters(alpha_v: f64, alpha_n: f64, tau: f64) -> Problem {
    let law = FrictionLaw::weakening(0.5, 0.5, 1.0).unwrap();
    problem(law, alpha_v, alpha_n, tau)
}

/// A family of maps x ↦ f(x; v0).
#[derive(Debug, Clone, Copy)]
pub(super) enum Family {
    /// x ↦ x/2, and the event function of this event is 1 − v0²: it vanishes at v0 = 1.
    Vanishing(Event),
    /// Nordmark's map: depth h = 1 − v0 + x of the stop, x ↦ x/2 − s √h. The orbit has
    /// √h = √(s² + 1 − v0) − s, grazes at v0 = 1, and its period doubles at v0 = 1 − 7 s²/9.
    Nordmark(f64),
    /// x ↦ x + 1 − v0 − x²: the orbit x = √(1 − v0) meets an unstable one at v0 = 1.
    SaddleNode,
    /// x ↦ v0 x (1 − x): the period doubles at v0 = 3; orbits of two slips have
    /// x = (v0 + 1 ± √((v0 − 3)(v0 + 1)))/(2 v0). The attractor is lost in a crisis at v0 = 4. The
    /// depth of a stop is this number less x.
    Logistic(f64),
    /// x ↦ (x + v0)/2, with the depth 1 − v0² of a stop: it grazes at v0 = 1. The orbit x = v0
    /// attracts from as far as this share of 1 − v0 alone.
    Narrow(f64),
}

/// The logistic map without a graze.
pub(super) const LOGISTIC: Family = Family::Logistic(2.0);

/// The larger x of the logistic map's orbit of two slips.
pub(super) fn logistic_pair(v0: f64) -> f64 {
    (v0 + 1.0 + ((v0 - 3.0) * (v0 + 1.0)).sqrt()) / (2.0 * v0)
}

/// The state of a map of a [`Family`].
#[derive(Debug, Clone)]
pub(super) struct Synthetic {
    pub family: Family,
    pub v0: f64,
    pub x: f64,
    pub tau: f64,
    /// The accuracy that was asked for last.
    pub tolerance: f64,
}

impl Synthetic {
    /// The map at the state `x`.
    pub(super) fn new(family: Family, v0: f64, x: f64) -> Self {
        let (tau, tolerance) = (1.0, 1e-6);
        Self {
            family,
            v0,
            x,
            tau,
            tolerance,
        }
    }

    /// One cycle at the present state.
    fn here(&self) -> Cycle {
        let (v0, x) = (self.v0, self.x);
        let after = self.next().unwrap_or(x);
        let mut cycle = Cycle {
            depth: 1.0,
            to_minimum: 0.1,
            slip: 3.0,
            stick: 0.5 + after,
            n_min: 1.0,
            reversals: 0,
            missing_force: 1.0,
            dip: 1.0,
        };
        match self.family {
            Family::Vanishing(event) => {
                let value = 1.0 - v0 * v0;
                match event {
                    Event::Graze(_) => cycle.depth = value,
                    Event::LiftOff => cycle.n_min = value,
                    Event::StickVanishes => cycle.stick = value,
                    Event::Reversal => cycle.missing_force = value,
                    Event::NewStop => cycle.dip = value,
                }
            }
            Family::Nordmark(_) => cycle.depth = 1.0 - v0 + x,
            Family::SaddleNode => {}
            Family::Logistic(graze) => cycle.depth = graze - x,
            Family::Narrow(_) => cycle.depth = 1.0 - v0 * v0,
        }
        cycle
    }

    /// The next x; none where the stop is missed.
    fn next(&self) -> Option<f64> {
        let (v0, x) = (self.v0, self.x);
        let next = match self.family {
            Family::Vanishing(_) if v0 > 1.0 => None,
            Family::Vanishing(_) => Some(0.5 * x),
            Family::Nordmark(s) => {
                let depth = 1.0 - v0 + x;
                (depth >= 0.0).then(|| 0.5 * x - s * depth.sqrt())
            }
            Family::SaddleNode => Some(x + 1.0 - v0 - x * x),
            Family::Logistic(graze) if x > graze => None,
            Family::Logistic(_) => Some(v0 * x * (1.0 - x)),
            Family::Narrow(share) => {
                ((x - v0).abs() <= share * (1.0 - v0)).then_some(0.5 * (x + v0))
            }
        };
        next.filter(|x| x.abs() < 2.0)
    }
}

impl ReturnMap for Synthetic {
    fn v0(&self) -> f64 {
        self.v0
    }

    fn set_v0(&mut self, v0: f64) {
        self.v0 = v0;
    }

    fn delay(&self) -> f64 {
        self.tau
    }

    fn set_delay(&mut self, tau: f64) {
        self.tau = tau;
    }

    fn copy_from(&mut self, other: &Self) {
        self.clone_from(other);
    }

    fn refine(&mut self, accuracy: Accuracy) {
        self.tolerance = accuracy.tolerance;
    }

    fn extrapolate(
        &mut self,
        (last, before): (&mut Self, &mut Self),
        share: f64,
        (v0, tau): (f64, f64),
        stretches: &[Stretch],
    ) -> bool {
        assert!(stretches.len() <= 2 * MOST_SLIPS);
        (self.v0, self.tau) = (v0, tau);
        self.x = last.x + share * (last.x - before.x);
        true
    }

    fn cycle(&mut self, _: Option<Stop>, _: &ContinuationOptions) -> Result<Cycle, NoReturn> {
        let cycle = self.here();
        self.x = self.next().ok_or(match self.family {
            Family::Vanishing(Event::LiftOff) => NoReturn::LiftOff,
            _ => NoReturn::StopMissed,
        })?;
        Ok(cycle)
    }
}

/// The most iterations until an orbit has come to rest or is lost.
const ITERATIONS: usize = 20_000;

impl Followed for Synthetic {
    fn v0(&self) -> f64 {
        self.v0
    }

    fn unit(&self) -> f64 {
        1.0
    }

    fn copy_from(&mut self, other: &Self) {
        self.clone_from(other);
    }

    fn response_at(&mut self, v0: f64, how: &Observation) -> Response {
        self.v0 = v0;
        let step = |map: &mut Self| map.next().map(|x| map.x = x).is_some();
        let steps = (0..ITERATIONS).take_while(|_| step(self)).count();
        let returns = |slips: &usize| {
            let mut map = self.clone();
            let whole = (0..*slips).all(|_| step(&mut map));
            whole && (map.x - self.x).abs() < how.repeated
        };
        let slips = (1..=MOST_SLIPS).find(returns);
        let regime = match (steps < ITERATIONS, slips) {
            (true, _) => Regime::Slips,
            (false, None) => Regime::Irregular,
            (false, Some(_)) => Regime::Periodic,
        };
        let mut cycles = [Cycle::NONE; MOST_SLIPS];
        for cycle in &mut cycles[..slips.unwrap_or(1)] {
            *cycle = self.here();
            step(self);
        }
        let period = Period::new(slips.unwrap_or(1), cycles);
        let depth = period.cycles().iter().map(|cycle| cycle.depth);
        Response {
            v0,
            regime,
            summary: Summary {
                slips: slips.unwrap_or(0) as u32,
                steps: steps as u64,
                period: period.slip_time() + period.stick_time(),
                slip_time: period.slip_time(),
                stick_time: period.stick_time(),
                n_min: period.n_min(),
                ..Summary::without(Outcome::StickSlip)
            },
            to_minimum: 0.1,
            depth: depth.fold(f64::INFINITY, f64::min),
        }
    }

    fn next_phase(&mut self, _: u32) -> bool {
        self.next().map(|x| self.x = x).is_some()
    }
}
