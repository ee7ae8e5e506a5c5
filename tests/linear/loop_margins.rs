//! Margins of any loop: closed forms, and random loops against slipmap's own counts by the
//! argument principle, and against scans of L along the imaginary axis that are written here.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use num_complex::Complex64;

use crate::congruence::Chance;
use slipmap::linear::general::{Polynomial, RightOf, RootCounter, System};
use slipmap::linear::margins::{MarginSearch, PhaseMargin, SystemLoop};
use slipmap::model::Channel;

/// A loop by its numbers: U = B(1 − R E), V = −A e^(−sδ)(1 − E), or U = P, V = Q E.
#[derive(Debug, Clone)]
struct Given {
    own: Vec<f64>,
    fed: Vec<f64>,
    /// R and δ of B and A.
    channel: Option<Channel>,
    tau: f64,
}

/// Beyond the frequencies of scans, the size of L.
const SMALL: f64 = 0.01;

impl Given {
    fn direct(p: &[f64], q: &[f64], tau: f64) -> Self {
        Self {
            own: p.to_vec(),
            fed: q.to_vec(),
            channel: None,
            tau,
        }
    }

    /// With `factor` times the gain, and `later` by so much.
    fn system(&self, factor: f64, later: f64) -> (System, f64) {
        let fed: Vec<f64> = self.fed.iter().map(|c| factor * c).collect();
        let polynomial = |c: &[f64]| Polynomial::new(c).unwrap();
        match self.channel {
            None => (
                System::of_coefficients(&self.own, &fed).unwrap(),
                self.tau + later,
            ),
            Some(channel) => {
                let channel = Channel {
                    latency: channel.latency + later,
                    ..channel
                };
                let system = System::feedback(polynomial(&self.own), polynomial(&fed), channel);
                (system, self.tau)
            }
        }
    }

    /// Whether no root is unstable, by the argument principle at this one delay.
    fn stable(&self, factor: f64, later: f64) -> bool {
        let (system, tau) = self.system(factor, later);
        RootCounter::new(&system).right_of(tau, 0.0) == RightOf::Roots(0)
    }

    fn of(&self) -> SystemLoop {
        let (system, tau) = self.system(1.0, 0.0);
        SystemLoop::new(&system, tau).expect("a loop")
    }

    /// L at iω.
    fn loop_at(&self, omega: f64) -> Complex64 {
        let s = Complex64::new(0.0, omega);
        let value = |c: &[f64]| c.iter().rev().fold(Complex64::ZERO, |sum, c| sum * s + c);
        let echo = (-s * self.tau).exp();
        let (own, fed) = (value(&self.own), value(&self.fed));
        match self.channel {
            None => fed * echo / own,
            Some(Channel { memory, latency }) => {
                -fed * (-s * latency).exp() * (1.0 - echo) / (own * (1.0 - memory * echo))
            }
        }
    }

    /// Frequencies close together, up to where the loop is small.
    fn frequencies(&self) -> Vec<f64> {
        let turning = self.tau + self.channel.map_or(0.0, |channel| channel.latency);
        let (mut end, small) = (1e5, self.loop_at(1e12).norm() + SMALL);
        let below = |end: f64, k: u32| end * (1.0 - 0.002 * f64::from(k));
        // Without delay L comes to its value at infinity and does not turn.
        while end > 1.0
            && turning > 0.0
            && (0..120).all(|k| self.loop_at(below(end, k)).norm() < small)
        {
            end *= 0.8;
        }
        let steps = (2000.0 + 60.0 * end * turning).min(2e5) as u32;
        let even = (1..=steps).map(|k| end * f64::from(k) / f64::from(steps));
        let low = (0..20_000).map(|k| end * 1e-7_f64.powf(f64::from(k) / 2e4));
        let mut all: Vec<f64> = even.chain(low).collect();
        all.sort_by(f64::total_cmp);
        all
    }
}

/// A gain margin is a change of the count, and there is none before it.
fn check_gain(given: &Given) {
    let margin = MarginSearch::default().gain_margin(&given.of());
    for (limit, omega, far) in [
        (margin.limits.lower, margin.omegas[0], 0.0),
        (margin.limits.upper, margin.omegas[1], 1e3),
    ] {
        assert!(!limit.is_nan(), "{given:?}: gain not decided");
        let reached = if limit.is_finite() { limit } else { far };
        for k in 0..60 {
            let part = 0.5 - 0.5 * (PI * (f64::from(k) + 0.5) / 60.0).cos();
            let factor = 1.0 + part * (reached - 1.0);
            let near = (factor - reached).abs() <= 1e-9 * reached;
            assert!(
                near || given.stable(factor, 0.0),
                "{given:?}: lost at {factor} before {limit}"
            );
        }
        if limit > 0.0 && limit.is_finite() {
            let beyond = limit * (1.0 + 1e-9_f64.copysign(limit - 1.0));
            assert!(!given.stable(beyond, 0.0), "{given:?}: not lost at {limit}");
            if omega > 0.0 {
                let at = 1.0 + limit * given.loop_at(omega);
                assert!(at.norm() < 1e-6, "{given:?}: {limit} at {omega}: {at}");
            }
        }
    }
}

/// The phase margin is the least angle of a fine scan.
fn check_phase(given: &Given) {
    let found = given.of().phase();
    let above = |omega: f64| given.loop_at(omega).norm() - 1.0;
    let mut least = f64::INFINITY;
    let frequencies = given.frequencies();
    for pair in frequencies.windows(2) {
        let (mut low, mut high) = (pair[0], pair[1]);
        let sign = above(low) > 0.0;
        if (above(high) > 0.0) == sign {
            continue;
        }
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            match (above(middle) > 0.0) == sign {
                true => low = middle,
                false => high = middle,
            }
        }
        least = least.min((-given.loop_at(low)).arg().abs());
    }
    let PhaseMargin { angle, omega } = found;
    if least.is_finite() {
        assert!(
            (angle - least).abs() < 1e-7,
            "{given:?}: phase {angle}, scan {least}"
        );
    } else {
        // |L| is 1 nowhere, or below all frequencies of the scan.
        let below = omega < frequencies[0];
        assert!(angle == f64::INFINITY || below, "{given:?}: phase {angle}");
    }
    if angle.is_finite() {
        let at = given.loop_at(omega);
        assert!((at.norm() - 1.0).abs() < 1e-8, "{given:?}");
        assert!(((-at).arg().abs() - angle).abs() < 1e-8, "{given:?}");
    }
}

/// The latency margin is a change of the count, and there is none before it.
fn check_latency(given: &Given) {
    let (margin, omega) = given.of().latency();
    let own = given.channel.map_or(0.0, |channel| channel.latency);
    assert!(!margin.is_nan(), "{given:?}: latency not decided");
    if margin == 0.0 {
        // The latency of the setting itself may be what it needs.
        assert!(!given.stable(1.0, -own), "{given:?}: no latency");
        return;
    }
    let end = if margin.is_finite() { margin } else { 50.0 };
    for k in 0..40 {
        let late = end * (f64::from(k) + 0.5) / 40.0;
        assert!(
            given.stable(1.0, late - own),
            "{given:?}: lost at {late} before {margin}"
        );
    }
    if margin.is_finite() && margin > 0.0 {
        let total = margin
            + if given.channel.is_none() {
                given.tau
            } else {
                0.0
            };
        assert!(
            given.stable(1.0, margin - own - 1e-9 * total),
            "{given:?}: {margin}"
        );
        assert!(
            !given.stable(1.0, margin - own + 1e-9 * total),
            "{given:?}: {margin}"
        );
        let further = Complex64::new(0.0, -omega * (margin - own)).exp();
        let at = 1.0 + given.loop_at(omega) * further;
        assert!(at.norm() < 1e-6, "{given:?}: {margin} at {omega}: {at}");
    }
}

/// The modulus margin is the minimum of a fine scan, polished by golden sections.
fn check_modulus(given: &Given) {
    let found = given.of().modulus();
    assert!(!found.margin.is_nan(), "{given:?}: modulus not decided");
    let distance = |omega: f64| (1.0 + given.loop_at(omega)).norm();
    let frequencies = given.frequencies();
    let values: Vec<f64> = frequencies.iter().map(|omega| distance(*omega)).collect();
    let at_infinity = match (given.own.len(), given.channel) {
        (n, None) if given.fed.len() == n && given.tau > 0.0 => {
            (1.0 - (given.fed[n - 1] / given.own[n - 1]).abs()).abs()
        }
        (n, None) if given.fed.len() == n => (1.0 + given.fed[n - 1] / given.own[n - 1]).abs(),
        _ => 1.0,
    };
    let mut least = at_infinity.min(distance(1e-12));
    for k in 1..values.len() - 1 {
        let dip = values[k] <= values[k - 1] && values[k] <= values[k + 1];
        if !dip || values[k] > 1.2 * least {
            continue;
        }
        let (mut low, mut high) = (frequencies[k - 1], frequencies[k + 1]);
        let golden = 0.5 * (5_f64.sqrt() - 1.0);
        for _ in 0..90 {
            let (a, b) = (high - golden * (high - low), low + golden * (high - low));
            match distance(a) < distance(b) {
                true => high = b,
                false => low = a,
            }
        }
        least = least.min(distance(0.5 * (low + high)));
    }
    let margin = found.margin;
    // Beyond the scan L is small.
    let near = (margin - least).abs() <= 1e-9 * least;
    let beyond = margin < least && margin > at_infinity - SMALL;
    assert!(near || beyond, "{given:?}: modulus {margin}, scan {least}");
    if found.omega.is_finite() && found.omega > 0.0 {
        assert!(
            (distance(found.omega) - margin).abs() <= 1e-9 * margin,
            "{given:?}"
        );
    }
}

fn check(given: &Given) {
    assert!(given.of().stable(), "{given:?}");
    check_gain(given);
    check_phase(given);
    check_latency(given);
    check_modulus(given);
}

/// A polynomial of random zeros: most of them left, some at 0, some far away.
fn polynomial(chance: &mut Chance, degree: usize, at_zero: f64, stiff: bool) -> Vec<f64> {
    let mut all = vec![1.0];
    let mut times = |factor: &[f64]| {
        let mut product = vec![0.0; all.len() + factor.len() - 1];
        for (i, a) in all.iter().enumerate() {
            for (j, b) in factor.iter().enumerate() {
                product[i + j] += a * b;
            }
        }
        all = product;
    };
    let mut left = degree;
    while left > 0 {
        let decades = if stiff { 3.0 } else { 0.7 };
        let size = 10_f64.powf(chance.between(-decades, decades));
        if left >= 2 && chance.next() < 0.6 {
            times(&[size * size, 2.0 * chance.between(-0.05, 0.9) * size, 1.0]);
            left -= 2;
        } else {
            let zero = chance.next() < at_zero;
            times(&[
                if zero {
                    0.0
                } else {
                    chance.between(-0.1, 1.0) * size
                },
                1.0,
            ]);
            left -= 1;
        }
    }
    all
}

/// The next stable loop of random numbers; of every kind by its number.
fn random(chance: &mut Chance, number: usize) -> Given {
    loop {
        let degree = 1 + (chance.next() * 6.0) as usize % 6;
        let stiff = number.is_multiple_of(5);
        let own = polynomial(chance, degree, 0.3, stiff);
        let neutral = number.is_multiple_of(7) && number.is_multiple_of(2);
        let fed_degree = match neutral {
            true => degree,
            false => (chance.next() * degree as f64) as usize,
        };
        let mut fed = polynomial(chance, fed_degree, 0.1, stiff);
        let size = |c: &[f64]| c.iter().map(|c| c.abs()).sum::<f64>();
        let by = match neutral {
            true => chance.between(-0.9, 0.9),
            false => chance.between(-2.0, 2.0) * size(&own) / size(&fed),
        };
        for c in &mut fed {
            *c *= by;
        }
        let tau = match number % 11 {
            0 => 0.0,
            _ => 10_f64.powf(chance.between(-2.0, 1.0)),
        };
        let channel = (number % 2 == 1).then(|| Channel {
            memory: [0.0, chance.between(-0.8, 0.8)][number % 3 % 2],
            latency: [0.0, chance.between(0.0, 1.5)][number / 2 % 2],
        });
        let given = Given {
            own,
            fed,
            channel,
            tau: if channel.is_some() {
                tau.max(0.01)
            } else {
                tau
            },
        };
        if given.stable(1.0, 0.0) && given.of().stable() {
            return given;
        }
    }
}

#[test]
fn random_loops_have_the_margins_of_counts_and_scans() {
    let mut chance = Chance(47);
    for number in 0..500 {
        check(&random(&mut chance, number));
    }
}

/// An integrator with the gain k: the loop is k e^(−sτ)/s.
#[test]
fn an_integrator_has_its_closed_form() {
    for (k, tau) in [(0.5, 1.0), (1.2, 0.3), (1e-3, 20.0), (40.0, 0.01)] {
        let given = Given::direct(&[0.0, 1.0], &[k], tau);
        check(&given);
        let gain = MarginSearch::default().gain_margin(&given.of());
        let near = |a: f64, b: f64| assert!((a - b).abs() <= 1e-12 * b.abs(), "{a} {b}");
        near(gain.limits.upper, PI / (2.0 * k * tau));
        near(gain.omegas[1], PI / (2.0 * tau));
        assert_eq!(gain.limits.lower, 0.0);
        let phase = given.of().phase();
        near(phase.angle, FRAC_PI_2 - k * tau);
        near(phase.omega, k);
        near(given.of().latency().0, PI / (2.0 * k) - tau);
    }
}

/// A lag of first order with the gain k > 1: |L| = 1 at ω² = k² − 1.
#[test]
fn a_lag_has_its_closed_form() {
    for (k, tau) in [(2.0, 0.5), (1.05, 3.0), (5.0, 0.1)] {
        let given = Given::direct(&[1.0, 1.0], &[k], tau);
        check(&given);
        let omega: f64 = f64::sqrt(k * k - 1.0);
        let angle = PI - omega.atan() - omega * tau;
        assert!((given.of().phase().angle - angle).abs() < 1e-13);
        assert!((given.of().latency().0 - angle / omega).abs() < 1e-12);
    }
}

/// A double integrator with two gains; it falls at small gains as at large ones.
#[test]
fn a_double_integrator_needs_its_gains() {
    let given = Given::direct(&[0.0, 0.0, 1.0], &[0.4, 0.8], 0.3);
    check(&given);
    // Without delay it stands any gain.
    let at_once = Given::direct(&[0.0, 0.0, 1.0], &[0.4, 0.8], 0.0);
    check(&at_once);
    let limits = MarginSearch::default().gain_margin(&at_once.of()).limits;
    assert_eq!((limits.lower, limits.upper), (0.0, f64::INFINITY));
}

/// A neutral loop falls at the latest where roots accumulate, and stands all before it here.
#[test]
fn a_neutral_loop_falls_where_roots_accumulate() {
    // s + 1 + r(s + 3) e^(−sτ): |Q/P| falls from 3r to r.
    for (r, tau) in [(0.2, 1.0), (0.25, 0.1)] {
        let given = Given::direct(&[1.0, 1.0], &[3.0 * r, r], tau);
        check(&given);
        // s + 1 − r(s + 1/2) e^(−sτ): |Q/P| < r everywhere.
        let given = Given::direct(&[1.0, 1.0], &[-0.5 * r, -r], tau);
        check(&given);
        let margin = MarginSearch::default().gain_margin(&given.of());
        assert!((margin.limits.upper * r - 1.0).abs() < 1e-9);
        assert!(margin.omegas[1].is_nan());
        assert!((given.of().modulus().margin - (1.0 - r)).abs() < 1e-12);
    }
}

/// A pole of the plant on the axis: |1 + L| is infinite there, and nothing is lost.
#[test]
fn a_plant_with_a_pole_on_the_axis_is_as_any_other() {
    check(&Given::direct(&[1.0, 0.0, 1.0], &[0.0, 0.4], 0.2));
    // A root that P and Q share on the axis is one at any gain.
    let shared = Given::direct(&[1.0, 1.0, 1.0, 1.0], &[0.3, 0.0, 0.3], 0.2);
    assert!(!shared.of().stable());
}

/// No loop, and loops that are not stable.
#[test]
fn loops_without_margins_are_none() {
    let system = |p: &[f64], q: &[f64]| System::of_coefficients(p, q).unwrap();
    // 2(1 − e^(−sτ)) + s²: a root at 0 at every delay is left out.
    let without = system(&[2.0, 0.0, 1.0], &[-2.0]).without_roots_at_zero(1);
    assert!(SystemLoop::new(&without.unwrap(), 1.0).is_none());
    assert!(SystemLoop::new(&system(&[], &[]), 1.0).is_none());
    // Infinitely many unstable roots.
    assert!(!Given::direct(&[1.0, 1.0], &[1.0, 2.0], 0.5).of().stable());
    assert!(!Given::direct(&[-1.0, 1.0], &[0.5], 0.5).of().stable());
    // Nothing is fed back.
    let idle = Given::direct(&[1.0, 1.0], &[], 0.5).of();
    let limits = MarginSearch::default().gain_margin(&idle).limits;
    assert_eq!((limits.lower, limits.upper), (0.0, f64::INFINITY));
    assert_eq!(idle.phase().angle, f64::INFINITY);
    assert_eq!(idle.modulus().margin, 1.0);
    assert_eq!(idle.latency().0, f64::INFINITY);
}

/// Large gains are found far away, and small ones near 0.
#[test]
fn limits_are_found_over_many_decades() {
    for k in [1e-6, 1e-3, 1.0] {
        let given = Given::direct(&[1.0, 2.0, 1.0], &[k], 0.7);
        check_gain(&given);
    }
    let unit = 1e7;
    // The same loop in another unit of time.
    let [slow, fast] = [1.0, unit].map(|by: f64| {
        let given = Given::direct(&[by * by, 0.6 * by, 1.0], &[0.5 * by * by], 0.8 / by);
        let search = MarginSearch::default().gain_margin(&given.of());
        let modulus = given.of().modulus();
        [
            search.limits.upper,
            modulus.margin,
            search.omegas[1] / by,
            modulus.omega / by,
        ]
    });
    for (a, b) in slow.into_iter().zip(fast) {
        assert!((a - b).abs() < 1e-9 * a, "{a} {b}");
    }
    assert!(slow[0] < TAU);
}
