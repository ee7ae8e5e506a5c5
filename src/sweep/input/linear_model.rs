//! The linear model of a setting: the letter's own, or a more general one.
//!
//! ```text
//! D = B(1 − R E) − A e^(−λδ)(1 − E),   E = e^(−λτ)                                           (1)
//! B = B₀ L_a L_v L_s,   A = a_n N₀ L_v + a_v V₀ L_a,   L = 1 + Tλ                            (2)
//! B₀ = λ² + bλ + 1,   N₀ = 1,   V₀ = b + λ                                                   (3)
//! B₀ = (1 + Tλ)(λ² + 1) + fλ,   N₀ = 1 + (1 − c)Tλ,   V₀ = f + λ(1 + Tλ),   f = α − β + αTλ  (4)
//! ```
//!
//! The load follows its command with the lag T_a, the pulling velocity with T_v, and the sensor
//! follows the elongation with T_s. Each lag divides the signal by 1 + Tλ. (3) is the letter's
//! friction, with b, a_v and a_n of [`crate::model::Groups`]. (4) is friction with a state, with α,
//! β, T and c of [`crate::model::StateGroups`]. Times are in units of √(M/κ).

use num_complex::Complex64;

use super::parameter::Parameter;
use super::setting::Setting;
use super::system::Evaluation;
use crate::linear::characteristic::one_minus_exp;
use crate::linear::general::{Polynomial, Source, System};
use crate::model::{Groups, ModelError, StateGroups};

/// The linear model of a setting, dimensionless.
#[derive(Debug, Clone)]
pub enum LinearModel {
    /// The letter's own: without memory, latency and lags.
    Letter(Groups),
    /// Any other.
    General(Box<System>),
}

impl LinearModel {
    /// The system; the letter's own in feedback form.
    #[must_use]
    pub fn system(&self) -> System {
        match self {
            Self::Letter(Groups { b, a_v, a_n }) => FeedbackLoop {
                a_n: *a_n,
                a_v: *a_v,
                ..FeedbackLoop::new(Friction::of_slope(*b), [0.0; 3])
            }
            .system(),
            Self::General(system) => **system,
        }
    }
}

/// The block on its spring with friction: (3) for the letter's law, (4) for one with a state.
#[derive(Debug, Clone, Copy)]
struct Friction {
    /// B₀, and its derivative with respect to b.
    open: [Polynomial; 2],
    /// N₀: the effect of a change of the load on the block.
    load: Polynomial,
    /// V₀: the effect of a change of the pulling velocity, and its derivative.
    velocity: [Polynomial; 2],
    /// b of the letter's friction.
    slope: Option<f64>,
}

/// A feedback loop, (2).
#[derive(Debug, Clone, Copy)]
pub struct FeedbackLoop {
    /// B, and its derivative with respect to b.
    open: [Polynomial; 2],
    /// N₀ L_v.
    load: Polynomial,
    /// V₀ L_a, and its derivative.
    velocity: [Polynomial; 2],
    /// b of the letter's friction.
    slope: Option<f64>,
    /// T_a, T_v and T_s.
    lags: [f64; 3],
    a_n: f64,
    a_v: f64,
    memory: f64,
    latency: f64,
}

/// Derivatives of D with respect to the dimensionless groups.
#[derive(Debug, Clone, Copy)]
pub struct PerGroup {
    /// ∂D/∂b.
    pub b: Complex64,
    /// ∂D/∂a_v.
    pub a_v: Complex64,
    /// ∂D/∂a_n.
    pub a_n: Complex64,
}

/// Degrees here are at most 6.
const LOW: &str = "a low degree";

fn polynomial(coefficients: &[f64]) -> Polynomial {
    Polynomial::new(coefficients).expect(LOW)
}

fn times(one: &Polynomial, other: &Polynomial) -> Polynomial {
    one.times(other).expect(LOW)
}

impl Friction {
    /// Friction with a state, (4).
    fn of_state(groups: StateGroups) -> Self {
        let StateGroups {
            direct,
            evolution,
            state_time,
            load_memory,
        } = groups;
        let number = |value: f64| Polynomial::constant(value, 0.0);
        let state = times(&number(state_time), &Polynomial::variable());
        // α − β + αTλ.
        let effect = number(direct).plus(&number(evolution), -1.0);
        let effect = effect.plus(&times(&number(direct), &state), 1.0);
        let moving = times(&Polynomial::variable(), &number(1.0).plus(&state, 1.0));
        let oscillator = times(
            &polynomial(&[1.0, 0.0, 1.0]),
            &number(1.0).plus(&state, 1.0),
        );
        let kept = number(1.0).plus(&number(load_memory), -1.0);
        Self {
            open: [
                oscillator.plus(&times(&effect, &Polynomial::variable()), 1.0),
                Polynomial::ZERO,
            ],
            load: number(1.0).plus(&times(&kept, &state), 1.0),
            velocity: [effect.plus(&moving, 1.0), Polynomial::ZERO],
            slope: None,
        }
    }

    /// The letter's friction, (3).
    fn of_slope(b: f64) -> Self {
        Self {
            open: [polynomial(&[1.0, b, 1.0]), polynomial(&[0.0, 1.0])],
            load: polynomial(&[1.0]),
            velocity: [polynomial(&[b, 1.0]), polynomial(&[1.0])],
            slope: Some(b),
        }
    }
}

impl FeedbackLoop {
    /// A loop with lags T_a, T_v and T_s; gains, memory and latency are still 0.
    fn new(friction: Friction, lags: [f64; 3]) -> Self {
        let [of_load, of_velocity, of_sensor] = lags.map(|time| polynomial(&[1.0, time]));
        let all = times(&times(&of_load, &of_velocity), &of_sensor);
        Self {
            open: friction.open.map(|open| times(&open, &all)),
            load: times(&friction.load, &of_velocity),
            velocity: friction.velocity.map(|velocity| times(&velocity, &of_load)),
            slope: friction.slope,
            lags,
            a_n: 0.0,
            a_v: 0.0,
            memory: 0.0,
            latency: 0.0,
        }
    }

    /// The loop of a setting.
    ///
    /// # Errors
    /// When a parameter is outside the model's range.
    pub fn of(setting: &Setting) -> Result<Self, ModelError> {
        let oscillator = setting.oscillator()?;
        let Groups { b, a_v, a_n } = oscillator.groups(setting.sliding_point()?, setting.control());
        let friction = match setting.rate_and_state() {
            Some(law) => Friction::of_state(law.groups(&oscillator, setting.get(Parameter::V0))),
            None => Friction::of_slope(b),
        };
        let time = |parameter| setting.get(parameter) / oscillator.time_unit();
        Ok(Self {
            a_n,
            a_v,
            memory: setting.get(Parameter::Memory),
            latency: time(Parameter::Latency),
            ..Self::new(friction, Parameter::LAGS.map(time))
        })
    }

    /// The system of the loop.
    #[must_use]
    pub fn system(&self) -> System {
        let load = Polynomial::ZERO.plus(&self.load, self.a_n);
        let gain = load.plus(&self.velocity[0], self.a_v);
        let system = System::feedback(self.open[0], gain, self.memory, self.latency);
        match self.slope {
            Some(b) => system.known_by(Source {
                groups: Groups::new(b, self.a_v, self.a_n),
                lags: self.lags,
            }),
            None => system,
        }
    }

    /// Derivatives of D at λ; `difference` is 1 − E.
    #[must_use]
    pub fn per_group(&self, lambda: Complex64, difference: Complex64) -> PerGroup {
        let at = |polynomial: &Polynomial| polynomial.value(lambda);
        let remembered = 1.0 - self.memory * (1.0 - difference);
        let acting = match self.latency {
            0.0 => difference,
            latency => difference * (1.0 - one_minus_exp(-latency * lambda)),
        };
        PerGroup {
            b: at(&self.open[1]) * remembered - self.a_v * at(&self.velocity[1]) * acting,
            a_v: -at(&self.velocity[0]) * acting,
            a_n: -at(&self.load) * acting,
        }
    }
}

impl Setting {
    /// The linear model and the unit of time √(M/κ).
    ///
    /// # Errors
    /// When a parameter is outside the model's range.
    pub fn linear(&self) -> Result<(LinearModel, f64), ModelError> {
        if let Some(system) = self.own_system(&mut Evaluation::default()) {
            return Ok((LinearModel::General(Box::new(system?)), 1.0));
        }
        if !self.has_state() && self.beyond_letter(&Parameter::BEYOND_LETTER).is_none() {
            let oscillator = self.oscillator()?;
            let groups = oscillator.groups(self.sliding_point()?, self.control());
            return Ok((LinearModel::Letter(groups), oscillator.time_unit()));
        }
        let system = FeedbackLoop::of(self)?.system();
        let time_unit = self.oscillator()?.time_unit();
        Ok((LinearModel::General(Box::new(system)), time_unit))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::sensitivity::Sensitivity;

    fn setting(given: &[(Parameter, f64)]) -> Setting {
        let mut setting = Setting::new(None);
        for (parameter, value) in given {
            setting.set(*parameter, *value);
        }
        setting
    }

    /// For a setting of the letter, both forms are the same equation.
    #[test]
    fn the_loop_of_the_letter_is_the_letters_equation() {
        let given = [
            (Parameter::MuPrime, -0.3),
            (Parameter::AlphaV, 0.4),
            (Parameter::AlphaN, -1.1),
            (Parameter::MuK, 0.6),
            (Parameter::Mass, 2.0),
            (Parameter::Stiffness, 3.0),
            (Parameter::NormalLoad, 1.5),
        ];
        let setting = setting(&given);
        let (LinearModel::Letter(groups), unit) = setting.linear().unwrap() else {
            panic!("the letter's own")
        };
        let of_loop = FeedbackLoop::of(&setting).unwrap();
        let tau = 1.7 / unit;
        for lambda in [Complex64::new(0.3, 1.2), Complex64::new(-0.7, 0.4)] {
            let jet = of_loop.system().jet(tau, lambda);
            let letter = crate::linear::characteristic::Jet::at(groups, tau, lambda);
            assert!((jet.value - letter.value).norm() < 1e-13);
            assert!((jet.first - letter.first).norm() < 1e-13);
            let per = of_loop.per_group(lambda, jet.difference);
            let of_letter = Sensitivity::of(groups, tau, lambda);
            for (general, letter) in [
                (per.b, of_letter.b),
                (per.a_v, of_letter.a_v),
                (per.a_n, of_letter.a_n),
            ] {
                assert!((-general / jet.first - letter).norm() < 1e-13);
            }
        }
    }

    /// Checks D against its formula, and its derivatives against difference quotients.
    #[test]
    fn lags_and_memory_are_where_they_belong() {
        let at = |changed: Parameter, by: f64| {
            let mut setting = setting(&[
                (Parameter::MuPrime, -0.3),
                (Parameter::AlphaV, 0.4),
                (Parameter::AlphaN, -1.1),
                (Parameter::Memory, -0.35),
                (Parameter::LoadLag, 0.2),
                (Parameter::VelocityLag, 0.7),
                (Parameter::SensorLag, 0.05),
            ]);
            setting.set(changed, setting.get(changed) + by);
            FeedbackLoop::of(&setting).unwrap()
        };
        let (tau, lambda) = (1.7, Complex64::new(0.3, 1.2));
        let of_loop = at(Parameter::MuPrime, 0.0);
        let jet = of_loop.system().jet(tau, lambda);
        let delayed = (-lambda * tau).exp();
        let [of_load, of_velocity, of_sensor] = [0.2, 0.7, 0.05].map(|t| 1.0 + t * lambda);
        let open = (lambda * lambda - 0.3 * lambda + 1.0) * of_load * of_velocity * of_sensor;
        let gain = -1.1 * of_velocity + 0.4 * (lambda - 0.3) * of_load;
        let value = open * (1.0 + 0.35 * delayed) - gain * (1.0 - delayed);
        assert!((jet.value - value).norm() < 1e-13);
        let per = of_loop.per_group(lambda, jet.difference);
        for (parameter, derivative) in [
            (Parameter::MuPrime, per.b),
            (Parameter::AlphaV, per.a_v),
            (Parameter::AlphaN, per.a_n),
        ] {
            let value = |by: f64| at(parameter, by).system().jet(tau, lambda).value;
            let numeric = (value(1e-6) - value(-1e-6)) / 2e-6;
            assert!((numeric - derivative).norm() < 1e-8, "{parameter:?}");
        }
    }

    #[test]
    fn without_gains_there_is_nothing_to_remember() {
        let idle = [(Parameter::MuPrime, -0.3), (Parameter::Memory, 0.5)];
        let (model, _) = setting(&idle).linear().unwrap();
        assert!(matches!(model, LinearModel::Letter(_)));
        let lagging = [(Parameter::MuPrime, -0.3), (Parameter::SensorLag, 0.5)];
        let (model, _) = setting(&lagging).linear().unwrap();
        assert!(matches!(model, LinearModel::General(system) if system.uncontrolled()));
    }
}
