//! Responses in time: against polynomials of the method of steps and other closed forms, and
//! against an integrator of its own.

use crate::chance::Chance;
use slipmap::linear::general::{Polynomial, System};
use slipmap::linear::matrix::{Matrix, MatrixSystem};
use slipmap::linear::response::{Excited, NoResponse, Response};
use slipmap::model::stop::Stop;
use std::f64::consts::PI;

fn system(p: &[f64], q: &[f64]) -> System {
    System::of_coefficients(p, q).unwrap()
}

fn of(excited: &Excited, until: f64, settles_at: Option<f64>) -> Response {
    excited
        .response((until, 401), settles_at, &Stop::default())
        .unwrap()
}

fn near(found: f64, expected: f64, allowed: f64, what: &str) {
    let apart = (found - expected).abs();
    assert!(
        apart <= allowed * expected.abs().max(1.0),
        "{what}: {found}, not {expected}"
    );
}

/// y′ = −k y(t − τ) from y(0) = 1 on: Σ (−k)^j (t − jτ)^j/j! over the jτ before t.
fn by_steps(k: f64, tau: f64, t: f64) -> f64 {
    let (mut sum, mut factorial) = (0.0, 1.0);
    for j in 0..200 {
        let since = t - f64::from(j) * tau;
        if since < 0.0 {
            break;
        }
        factorial *= f64::from(j.max(1));
        sum += (-k * since).powi(j) / factorial;
    }
    sum
}

#[test]
fn an_integrator_with_delay_is_the_polynomials_of_the_method_of_steps() {
    for (k, tau) in [
        (1.0, 1.0),
        (0.37, 0.8),
        (1.5, 1.2),
        (20.0, 0.05),
        (1e-3, 900.0),
    ] {
        let integrator = system(&[0.0, 1.0], &[k]);
        let until = 9.3 * tau;
        let start = of(&Excited::by_start(&integrator, tau).unwrap(), until, None);
        let step = of(
            &Excited::by_reference(&integrator, tau).unwrap(),
            until,
            Some(1.0),
        );
        for (place, t) in start.t.iter().enumerate() {
            let expected = by_steps(k, tau, *t);
            near(start.y[place], expected, 1e-12, "start");
            near(step.y[place], 1.0 - expected, 1e-12, "reference");
        }
        // A disturbance at the input of 1/s with C = k: y′ = d − k y(t − τ).
        let one = Polynomial::constant(1.0, 0.0);
        let disturbed = Excited::by_disturbance(&integrator, &one, tau).unwrap();
        let disturbed = of(&disturbed, 2.0 * tau, Some(1.0 / k));
        for (t, y) in disturbed.t.iter().zip(&disturbed.y) {
            let late = (t - tau).max(0.0);
            near(*y, t - 0.5 * k * late * late, 1e-12, "disturbance");
        }
    }
}

/// y + c y(t − τ)′ jumps at every multiple of the delay.
#[test]
fn jumps_of_a_neutral_system_are_kept() {
    let (c, tau) = (0.5, 0.7);
    let neutral = system(&[1.0, 1.0], &[0.0, c]);
    let response = of(
        &Excited::by_start(&neutral, tau).unwrap(),
        1.9999 * tau,
        Some(0.0),
    );
    for (t, y) in response.t.iter().zip(&response.y) {
        let late = t - tau;
        let second = if late < 0.0 {
            0.0
        } else {
            c * (1.0 - late) * (-late).exp()
        };
        near(*y, (-t).exp() - second, 1e-13, "neutral");
    }
    let as_matrix = |value: f64| Matrix::new(1, 1, vec![value]);
    let (a0, a1, e1) = (as_matrix(-1.0), as_matrix(0.0), as_matrix(-c));
    let matrices = MatrixSystem::of_matrices(&a0, &a1, Some(&e1)).unwrap();
    let same = Excited::by_start_of_matrices(&matrices, 0, tau).unwrap();
    // Here only the rate is fed back, so x does not jump at τ: ẋ = −x − c ẋ(t − τ).
    let same = of(&same, 1.9999 * tau, Some(0.0));
    for (t, y) in same.t.iter().zip(&same.y) {
        let late = (t - tau).max(0.0);
        near(*y, (-t).exp() + c * late * (-late).exp(), 1e-13, "rate");
    }
}

/// Textbook measures of first and second order, with the delay 0 and as one that only shifts.
#[test]
fn measures_are_those_of_textbooks() {
    let lag = system(&[0.0, 1.0], &[1.0]);
    let step = of(&Excited::by_reference(&lag, 0.0).unwrap(), 20.0, Some(1.0)).measures;
    near(step.rise_time.unwrap(), 9.0_f64.ln(), 1e-12, "rise");
    near(
        step.settling_time.unwrap(),
        50.0_f64.ln(),
        1e-12,
        "settling",
    );
    near(step.overshoot.unwrap(), 0.0, 0.0, "overshoot");
    for zeta in [0.1_f64, 0.3, 0.7] {
        let second = system(&[0.0, 2.0 * zeta, 1.0], &[1.0]);
        let step = of(
            &Excited::by_reference(&second, 0.0).unwrap(),
            120.0,
            Some(1.0),
        )
        .measures;
        let damped = (1.0 - zeta * zeta).sqrt();
        let overshoot = (-PI * zeta / damped).exp();
        near(step.overshoot.unwrap(), overshoot, 1e-12, "overshoot");
        near(step.peak_time, PI / damped, 1e-7, "peak time");
        near(step.peak, 1.0 + overshoot, 1e-12, "peak");
        let envelope = (50.0 / damped).ln() / zeta;
        assert!(step.settling_time.unwrap() <= envelope + 1e-9, "{step:?}");
        assert!(
            step.settling_time.unwrap() > envelope - PI / damped,
            "{step:?}"
        );
    }
    let late = of(&Excited::by_reference(&lag, 0.2).unwrap(), 3.0, None).measures;
    assert_eq!(
        (late.final_value, late.settling_time, late.overshoot),
        (None, None, None)
    );
    let unsettled = of(&Excited::by_reference(&lag, 0.0).unwrap(), 3.0, Some(1.0)).measures;
    assert_eq!(unsettled.settling_time, None);
    assert!(unsettled.rise_time.is_some());
}

/// Powers, matrices, and P and Q of one system.
#[test]
fn forms_of_one_system_respond_alike() {
    let (p, q) = ([2.0, 0.6, 1.0], [0.5, 0.3]);
    let direct = of(
        &Excited::by_start(&system(&p, &q), 1.4).unwrap(),
        20.0,
        None,
    );
    let powers = [p.to_vec(), vec![0.0], q.to_vec()];
    let powers = of(
        &Excited::by_start_of_powers(&powers, 0.7).unwrap(),
        20.0,
        None,
    );
    // The observer form of the same: y is the second state.
    let a0 = Matrix::new(2, 2, vec![0.0, -2.0, 1.0, -0.6]);
    let a1 = Matrix::new(2, 2, vec![0.0, -0.5, 0.0, -0.3]);
    let matrices = MatrixSystem::of_matrices(&a0, &a1, None).unwrap();
    let matrices = Excited::by_start_of_matrices(&matrices, 1, 1.4).unwrap();
    let matrices = of(&matrices, 20.0, None);
    for (place, y) in direct.y.iter().enumerate() {
        near(powers.y[place], *y, 1e-12, "powers");
        near(matrices.y[place], *y, 1e-12, "matrices");
    }
    let still =
        Excited::by_start_of_matrices(&MatrixSystem::of_matrices(&a0, &a1, None).unwrap(), 1, 0.0)
            .unwrap();
    let (still, sum) = (of(&still, 20.0, None), system(&[2.5, 0.9, 1.0], &[0.0]));
    let sum = of(&Excited::by_start(&sum, 3.0).unwrap(), 20.0, None);
    for (place, y) in sum.y.iter().enumerate() {
        near(still.y[place], *y, 1e-12, "without delay");
    }
}

#[test]
fn what_has_no_response_is_told() {
    let constant = Excited::by_start(&system(&[1.0], &[0.5]), 1.0);
    assert!(
        matches!(constant, Err(NoResponse::Refused(_))),
        "{constant:?}"
    );
    let fast = Excited::by_start(&system(&[1.0, 1.0], &[0.5]), 1e-9).unwrap();
    let long = fast.response((100.0, 2), None, &Stop::default());
    assert!(matches!(long, Err(NoResponse::TooLong { .. })), "{long:?}");
    let grows = Excited::by_start(&system(&[-1.0, 1.0], &[0.0]), 1.0).unwrap();
    let grown = grows.response((1000.0, 2), None, &Stop::default());
    let Err(NoResponse::Grows { at }) = grown else {
        panic!("{grown:?}");
    };
    assert!((at - 150.0 * 10.0_f64.ln()).abs() < 2.0, "{at}");
    let two = Polynomial::new(&[0.0, 0.0, 1.0]).unwrap();
    let improper = Excited::by_disturbance(&system(&[1.0, 1.0], &[0.5]), &two, 1.0);
    assert!(
        matches!(improper, Err(NoResponse::Refused(_))),
        "{improper:?}"
    );
}

/// P ξ + Q ξ(t − τ) = u in phase variables, by Runge and Kutta's steps of fourth order with
/// Hermite's cubic in between for what is delayed: ξ and its derivatives at all `steps` per delay.
struct Plain {
    p: Vec<f64>,
    q: Vec<f64>,
    u: f64,
    h: f64,
    per_delay: usize,
    states: Vec<Vec<f64>>,
    /// At the beginning and at the end of every step.
    rates: Vec<[Vec<f64>; 2]>,
}

impl Plain {
    fn rate(&self, x: &[f64], late: &[f64]) -> Vec<f64> {
        let n = x.len();
        let weigh = |of: &[f64], x: &[f64]| of.iter().zip(x).map(|(c, x)| c * x).sum::<f64>();
        let highest = (self.u - weigh(&self.p[..n], x) - weigh(&self.q, late)) / self.p[n];
        let mut rate = x[1..].to_vec();
        rate.push(highest);
        rate
    }

    /// The states one delay before a step's beginning, middle or end, by halves of a step.
    fn late(&self, step: usize, halves: usize) -> Vec<f64> {
        let n = self.p.len() - 1;
        let place = 2 * step + halves;
        let Some(before) = place.checked_sub(2 * self.per_delay) else {
            return vec![0.0; n];
        };
        let (k, odd) = (before / 2, before % 2 == 1);
        if !odd {
            // At the end of the first delay the past is still empty, and its end is not yet x(0).
            return match (before, halves) {
                (0, 2) => vec![0.0; n],
                _ => self.states[k].clone(),
            };
        }
        let ([a, b], [from, to]) = (&[&self.states[k], &self.states[k + 1]], &self.rates[k]);
        let each = 0..n;
        each.map(|i| 0.5 * (a[i] + b[i]) + 0.125 * self.h * (from[i] - to[i]))
            .collect()
    }

    fn run(&mut self, count: usize) {
        let plus = |x: &[f64], by: f64, rate: &[f64]| -> Vec<f64> {
            x.iter().zip(rate).map(|(x, rate)| x + by * rate).collect()
        };
        for step in 0..count {
            let x = self.states[step].clone();
            let late = [0, 1, 2].map(|halves| self.late(step, halves));
            let first = self.rate(&x, &late[0]);
            let second = self.rate(&plus(&x, 0.5 * self.h, &first), &late[1]);
            let third = self.rate(&plus(&x, 0.5 * self.h, &second), &late[1]);
            let fourth = self.rate(&plus(&x, self.h, &third), &late[2]);
            let mut next = x;
            for (i, next) in next.iter_mut().enumerate() {
                let sum = first[i] + 2.0 * second[i] + 2.0 * third[i] + fourth[i];
                *next += self.h / 6.0 * sum;
            }
            let last = self.rate(&next, &late[2]);
            self.rates.push([first, last]);
            self.states.push(next);
        }
    }
}

/// ξ and its derivatives at the ends of delays, extrapolated from two lengths of a step.
fn plain(p: &[f64], q: &[f64], u: f64, x0: &[f64], tau: f64, delays: usize) -> Vec<Vec<f64>> {
    let run = |per_delay: usize| {
        let mut plain = Plain {
            p: p.to_vec(),
            q: q.to_vec(),
            u,
            h: tau / per_delay as f64,
            per_delay,
            states: vec![x0.to_vec()],
            rates: Vec::new(),
        };
        plain.run(delays * per_delay);
        (0..=delays)
            .map(|k| plain.states[k * per_delay].clone())
            .collect::<Vec<_>>()
    };
    let (coarse, fine) = (run(400), run(800));
    let pairs = fine.iter().zip(&coarse);
    pairs
        .map(|(fine, coarse)| {
            fine.iter()
                .zip(coarse)
                .map(|(f, c)| f + (f - c) / 15.0)
                .collect()
        })
        .collect()
}

/// Random loops, whose output is made of ξ in phase variables, not in the observer form.
#[test]
fn random_loops_respond_as_by_an_integrator_of_their_own() {
    let mut chance = Chance(47);
    for round in 0..60 {
        let n = 1 + chance.below(4) as usize;
        let m = chance.below(n as u64) as usize;
        let tau = chance.between(0.2, 1.5);
        let mut random = |k: usize| {
            (0..=k)
                .map(|_| chance.between(-1.0, 2.0))
                .collect::<Vec<_>>()
        };
        let (mut p, q, through) = (random(n), random(m), random(m));
        p[n] = 1.0 + p[n].abs();
        let of_loop = system(&p, &q);
        let delays = 6;
        let until = delays as f64 * tau;
        let found = |excited: Excited| {
            let samples = (until, delays + 1);
            excited.response(samples, None, &Stop::default()).unwrap().y
        };
        let weigh = |of: &[f64], x: &[f64]| of.iter().zip(x).map(|(c, x)| c * x).sum::<f64>();
        let step = plain(&p, &q, 1.0, &vec![0.0; n], tau, delays);
        let mut x0 = vec![0.0; n];
        x0[n - 1] = 1.0;
        let kick = plain(&p, &q, 0.0, &x0, tau, delays);
        let reference = found(Excited::by_reference(&of_loop, tau).unwrap());
        let through_polynomial = Polynomial::new(&through).unwrap();
        let disturbed = Excited::by_disturbance(&of_loop, &through_polynomial, tau).unwrap();
        let (disturbed, start) = (
            found(disturbed),
            found(Excited::by_start(&of_loop, tau).unwrap()),
        );
        for k in 0..=delays {
            let late = k
                .checked_sub(1)
                .map_or(0.0, |before| weigh(&q, &step[before]));
            near(reference[k], late, 1e-8, &format!("reference {round} {k}"));
            near(
                disturbed[k],
                weigh(&through, &step[k]),
                1e-8,
                &format!("disturbance {round} {k}"),
            );
            near(
                start[k],
                kick[k][n - 1],
                1e-8,
                &format!("start {round} {k}"),
            );
        }
    }
}
