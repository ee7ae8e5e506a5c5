//! The laws that are fitted: their parameters, and where a search for them starts.

use crate::model::elementary::{pow, power};
use crate::model::table::NEAREST;
use crate::model::{FrictionLaw, Table};
use crate::setting::fit_errors::FittedNumber;
use crate::setting::law_kind::LawKind;
use crate::setting::{Parameter, Setting};

/// The name of a monotone cubic through points whose number is chosen, for `--law`.
const SPLINE: &str = "spline";

/// The names of the laws that are fitted, for `--law`.
pub const LAWS: [&str; 4] = ["stribeck", "weakening", "hyperbolic", SPLINE];

/// Numbers of points of a spline, and how many measured velocities there are at least to each.
const POINTS: std::ops::RangeInclusive<usize> = 4..=9;
const TO_EACH: usize = 3;
/// Exponents from which a search starts, and those that it may come to.
const EXPONENTS: [f64; 2] = [1.0, 2.0];
const ALL_EXPONENTS: std::ops::RangeInclusive<f64> = 0.25..=8.0;
/// How many scales of the velocity a search starts from.
const SCALES: i32 = 6;
/// Static friction where a law has no value of it: above any curve.
const NO_LIMIT: f64 = 1e12;

/// A law with numbers that are to be fitted.
#[derive(Debug, Clone)]
pub(super) struct Candidate {
    /// Its name of [`LAWS`].
    pub law: &'static str,
    form: Form,
}

#[derive(Debug, Clone)]
enum Form {
    /// A law by parameters: those that are fitted, and those that are held at a value.
    Named {
        free: Vec<Parameter>,
        held: Box<Setting>,
    },
    /// A monotone cubic through points at these velocities.
    Spline(Vec<f64>),
}

/// Points by velocity, as a search sees them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen<'p> {
    pub speeds: &'p [f64],
    pub mu_k: &'p [f64],
}

/// A curve of a candidate: a law, and what is added to it in proportion to the velocity.
pub(super) struct Curve {
    law: FrictionLaw,
    viscous: f64,
}

impl Curve {
    pub(super) fn value(&self, speed: f64) -> f64 {
        self.law.mu_k(speed) + self.viscous * speed
    }

    pub(super) fn slope(&self, speed: f64) -> f64 {
        self.law.mu_prime(speed) + self.viscous
    }
}

/// The forms of a law of `LAWS`, those with the most parameters first: of these the first one
/// counts that the points determine. μ_S is held where it is given.
pub(super) fn forms(
    law: &'static str,
    mu_s: Option<f64>,
    (seen, velocities): (Seen, usize),
) -> Vec<Vec<Candidate>> {
    if law == SPLINE {
        let spline = |count| Candidate {
            law,
            form: Form::Spline(knots(seen.speeds, count)),
        };
        let enough = |count: &usize| TO_EACH * count <= velocities || count == POINTS.start();
        let counts = POINTS.filter(enough);
        return counts.map(|count| vec![spline(count)]).collect();
    }
    let kind = LawKind::named(law).ok();
    let all: Vec<Parameter> = kind.iter().flat_map(of_curve).collect();
    let (viscous, exponent) = (Parameter::ViscousCoefficient, Parameter::Exponent);
    let mut held = Setting::new(kind);
    held.set(Parameter::MuS, mu_s.unwrap_or(NO_LIMIT));
    let form = |holds: &[Parameter]| {
        let free = |p: &Parameter| !holds.contains(p) && (*p != Parameter::MuS || mu_s.is_none());
        Candidate {
            law,
            form: Form::Named {
                free: all.iter().copied().filter(free).collect(),
                held: Box::new(held.clone()),
            },
        }
    };
    let mut chain = vec![form(&[])];
    for holds in [&[viscous][..], &[viscous, exponent]] {
        if holds.iter().all(|p| all.contains(p)) {
            chain.push(form(holds));
        }
    }
    vec![chain]
}

/// The parameters on which the curve of a law depends.
fn of_curve(law: &LawKind) -> Vec<Parameter> {
    let falls_from_mu_s = law.has(Parameter::ViscousCoefficient);
    let mut all = law.parameters().to_vec();
    all.retain(|p| *p != Parameter::MuPrimeRest);
    let optional = law.optional().iter().copied();
    all.extend(optional.filter(|p| *p != Parameter::MuS || falls_from_mu_s));
    all
}

/// Velocities of the points of a spline: so that as many measured ones lie between them.
fn knots(speeds: &[f64], count: usize) -> Vec<f64> {
    let last = (speeds.len() - 1) as f64;
    let at = |i: usize| speeds[(last * i as f64 / (count - 1) as f64).round() as usize];
    let mut knots: Vec<f64> = (0..count).map(at).collect();
    knots.dedup_by(|next, last| *next - *last <= NEAREST * *next);
    knots
}

impl Candidate {
    /// The fitted numbers.
    pub(super) fn numbers(&self) -> Vec<FittedNumber> {
        match &self.form {
            Form::Named { free, .. } => free.iter().copied().map(FittedNumber::Parameter).collect(),
            Form::Spline(knots) => (0..knots.len()).map(FittedNumber::Point).collect(),
        }
    }

    /// Whether the law has a shape of its own, which a spline has not.
    pub(super) fn has_shape(&self) -> bool {
        matches!(self.form, Form::Named { .. })
    }

    /// Whether a number is σ, which a search may take below 0 although no law has it so.
    pub(super) fn is_viscous(number: FittedNumber) -> bool {
        number == FittedNumber::Parameter(Parameter::ViscousCoefficient)
    }

    /// The curve of values of the fitted numbers; none where they make no law.
    pub(super) fn curve(&self, values: &[f64]) -> Option<Curve> {
        let (free, mut setting) = match &self.form {
            Form::Spline(knots) => {
                let table = Table::new(knots.clone(), values.to_vec()).ok()?;
                let law = FrictionLaw::table(table, NO_LIMIT).ok()?;
                return Some(Curve { law, viscous: 0.0 });
            }
            Form::Named { free, held } => (free, Setting::clone(held)),
        };
        let mut viscous = 0.0;
        for (parameter, &value) in free.iter().zip(values) {
            match parameter {
                Parameter::ViscousCoefficient => viscous = value,
                Parameter::Exponent if !ALL_EXPONENTS.contains(&value) => return None,
                _ => setting.set(*parameter, parameter.check(value).ok()?),
            }
        }
        let law = setting.friction_law().ok()??;
        Some(Curve { law, viscous })
    }

    /// Values of the fitted numbers from which the search starts.
    pub(super) fn starts(&self, seen: Seen) -> Vec<Vec<f64>> {
        match &self.form {
            Form::Spline(knots) => vec![knots.iter().map(|&v| near(seen, v)).collect()],
            Form::Named { free, held } => {
                let exponents = match free.contains(&Parameter::Exponent) {
                    true => &EXPONENTS[..],
                    false => &EXPONENTS[..1],
                };
                let scales = scales(seen.speeds);
                let each = scales
                    .iter()
                    .flat_map(|&scale| exponents.iter().map(move |&e| (scale, e)));
                each.map(|(scale, exponent)| {
                    let start = |p: &Parameter| start(*p, held, seen, (scale, exponent));
                    free.iter().map(start).collect()
                })
                .collect()
            }
        }
    }

    /// A setting with the law of these values. `mu_s` is for laws whose curve does not depend on
    /// it.
    pub(super) fn setting(&self, values: &[f64], mu_s: Option<f64>, mut to: Setting) -> Setting {
        match &self.form {
            Form::Spline(knots) => {
                let table = Table::new(knots.clone(), values.to_vec()).ok();
                to.take_law(table.map(LawKind::Table));
            }
            Form::Named { free, held } => {
                to.take_law(held.law().cloned());
                for (parameter, &value) in free.iter().zip(values) {
                    to.set(*parameter, value);
                }
            }
        }
        if let Some(mu_s) = mu_s {
            to.set(Parameter::MuS, mu_s);
        }
        to
    }
}

/// The start of a parameter.
fn start(parameter: Parameter, held: &Setting, seen: Seen, (scale, exponent): (f64, f64)) -> f64 {
    let lowest = seen.mu_k.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = seen.mu_k.iter().copied().fold(0.0, f64::max);
    let falls_to = held
        .law()
        .is_some_and(|law| law.has(Parameter::ViscousCoefficient));
    match parameter {
        Parameter::Mu0 if falls_to => lowest,
        Parameter::VS => scale,
        Parameter::Exponent => exponent,
        Parameter::ViscousCoefficient => 0.0,
        // μ_S, or the μ0 from which a law falls.
        _ => highest,
    }
}

/// Scales of the velocity from that of the slowest points to that of the fastest.
fn scales(speeds: &[f64]) -> Vec<f64> {
    let fastest = speeds.last().copied().unwrap_or(1.0);
    let slowest = speeds.iter().copied().find(|v| *v > 0.0).unwrap_or(fastest);
    let slowest = slowest.max(1e-3 * fastest);
    let ratio = pow(fastest / slowest, 1.0 / f64::from(SCALES - 1));
    (0..SCALES).map(|i| slowest * power(ratio, i)).collect()
}

/// The mean of the points nearest to a velocity.
fn near(seen: Seen, speed: f64) -> f64 {
    const MANY: usize = 5;
    let at = seen.speeds.partition_point(|v| *v < speed);
    let from = at
        .saturating_sub(MANY / 2)
        .min(seen.speeds.len().saturating_sub(MANY));
    let these = &seen.mu_k[from..seen.mu_k.len().min(from + MANY)];
    these.iter().sum::<f64>() / these.len() as f64
}
