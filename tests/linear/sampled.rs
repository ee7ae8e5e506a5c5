//! Digital loops against eigenvalues of their state matrix and against an independent table.

use faer::Mat;
use num_complex::Complex64;

use crate::chance::{Chance, asked};
use slipmap::linear::MarginalTolerance;
use slipmap::linear::best::{Kind, SampledPlane};
use slipmap::linear::general::RightOf;
use slipmap::linear::line::{Line, Linear, Roots};
use slipmap::linear::margins::Limits;
use slipmap::linear::sampled::{GainLine, SampledLoop, SampledRoots};
use slipmap::model::stop::Stop;
use slipmap::model::{Channel, Groups};

/// A loop and its delay in samples.
#[derive(Debug, Clone, Copy)]
struct Sampled {
    groups: Groups,
    h: f64,
    m: u64,
    memory: f64,
    late: u64,
}

impl Sampled {
    fn channel(&self) -> Channel {
        Channel {
            memory: self.memory,
            latency: self.late as f64 * self.h,
        }
    }

    fn model(&self) -> SampledLoop {
        SampledLoop::new(self.groups, self.channel(), self.h).unwrap()
    }

    /// e^(Gh) of the block with a constant input, by a series over a small part of h and squaring.
    fn step(&self) -> [[f64; 3]; 3] {
        let Groups { b, a_v, a_n } = self.groups;
        let halvings = 20;
        let part = self.h / f64::from(1 << halvings);
        let g = [[-b, 1.0, -a_n], [-1.0, 0.0, a_v], [0.0; 3]];
        let product = |x: &[[f64; 3]; 3], y: &[[f64; 3]; 3]| {
            let mut z = [[0.0; 3]; 3];
            for i in 0..3 {
                for j in 0..3 {
                    z[i][j] = (0..3).map(|k| x[i][k] * y[k][j]).sum();
                }
            }
            z
        };
        // What is beyond 1 is squared apart, which keeps its digits.
        let scaled = g.map(|row| row.map(|c| c * part));
        let second = product(&scaled, &scaled);
        let third = product(&second, &scaled);
        let mut beyond = scaled;
        for i in 0..3 {
            for j in 0..3 {
                beyond[i][j] += second[i][j] / 2.0 + third[i][j] / 6.0;
            }
        }
        for _ in 0..halvings {
            let square = product(&beyond, &beyond);
            for i in 0..3 {
                for j in 0..3 {
                    beyond[i][j] = 2.0 * beyond[i][j] + square[i][j];
                }
            }
        }
        for (i, row) in beyond.iter_mut().enumerate() {
            row[i] += 1.0;
        }
        beyond
    }

    /// The sizes of the eigenvalues of the state: u, a, readings and signals of the past.
    fn sizes(&self) -> Vec<f64> {
        let (m, l) = (self.m as usize, self.late as usize);
        let readings = m + l;
        let signals = if self.memory == 0.0 { 0 } else { m };
        let n = 2 + readings + signals;
        let mut matrix = Mat::<f64>::zeros(n, n);
        // S_k = y_{k−l} − y_{k−l−m} + R S_{k−m}, with y_{k−j} in place 1 + j.
        let mut signal = vec![0.0; n];
        signal[1 + l] += 1.0;
        signal[1 + l + m] -= 1.0;
        if signals > 0 {
            signal[n - 1] += self.memory;
        }
        let step = self.step();
        for i in 0..2 {
            for j in 0..n {
                matrix[(i, j)] = step[i][2] * signal[j] + if j < 2 { step[i][j] } else { 0.0 };
            }
        }
        for j in 0..readings {
            matrix[(2 + j, 1 + j)] = 1.0;
        }
        for j in 0..signals {
            let row = 2 + readings + j;
            if j == 0 {
                (0..n).for_each(|k| matrix[(row, k)] = signal[k]);
            } else {
                matrix[(row, row - 1)] = 1.0;
            }
        }
        let values = matrix.eigenvalues().unwrap();
        let mut sizes: Vec<_> = values.iter().map(|z| z.re.hypot(z.im)).collect();
        sizes.sort_by(|one, other| other.total_cmp(one));
        sizes
    }

    fn random(chance: &mut Chance, simple: bool) -> Self {
        let m = 1 + (chance.unit() * 60.0) as u64;
        let tau = 0.1 + 9.0 * chance.unit();
        let gain = |part: f64, most: f64| most * (2.0 * part - 1.0);
        let [v, n, which] = [chance.unit(), chance.unit(), chance.unit()];
        Self {
            groups: Groups::new(
                gain(chance.unit(), 1.2),
                if which < 0.7 { gain(v, 1.5) } else { 0.0 },
                if which > 0.3 { gain(n, 4.0) } else { 0.0 },
            ),
            h: tau / m as f64,
            m,
            memory: if simple {
                0.0
            } else {
                gain(chance.unit(), 0.9)
            },
            late: if simple {
                0
            } else {
                (chance.unit() * 9.0) as u64
            },
        }
    }

    /// What is wrong with the counts and the largest root of this loop; nothing where eigenvalues
    /// lie too near to the circle to tell.
    fn wrong(&self) -> Option<String> {
        let sizes = self.sizes();
        let model = self.model();
        let expected = sizes.iter().filter(|size| **size > 1.0).count() as u64;
        let apart = sizes.iter().map(|size| (size - 1.0).abs());
        if apart.fold(f64::INFINITY, f64::min) < 1e-9 {
            return None;
        }
        let tau = self.m as f64 * self.h;
        let line = model.line(1.0).count(tau, MarginalTolerance::default());
        let line = line.map(|count| count.n_unstable);
        let found = model.n_unstable(self.m);
        if (found, line) != (expected, Some(expected)) {
            return Some(format!("{self:?}: {found}, {line:?} for {expected}"));
        }
        let spectrum = SampledRoots::new(model).spectrum(tau, 3);
        let radius = (spectrum.abscissa * self.h).exp();
        // Multiple eigenvalues are known to the root of their rounding.
        let near = 1e-6 * (sizes[0] - sizes[2]).clamp(1e-3, 1.0);
        let off = (radius - sizes[0]).abs();
        if off.is_nan() || off > near {
            return Some(format!("{self:?}: radius {radius} for {}", sizes[0]));
        }
        if sizes.len() > 3 && sizes[2] - sizes[3] > 1e-6 {
            let between = 0.5 * (sizes[2] + sizes[3]);
            let right = SampledRoots::new(model).right_of(tau, between.ln() / self.h);
            if right != RightOf::Roots(3) {
                return Some(format!("{self:?}: {right:?} outside {between}"));
            }
        }
        None
    }
}

#[test]
fn counts_and_radii_are_those_of_the_state_matrix() {
    for (simple, share) in [(true, 1), (false, 2)] {
        let wrong: Vec<_> = (0..asked("SLIPMAP_SAMPLED", 400) / share)
            .filter_map(|i| Sampled::random(&mut Chance(1997 + i), simple).wrong())
            .collect();
        assert!(
            wrong.is_empty(),
            "{}: {:#?}",
            wrong.len(),
            &wrong[..wrong.len().min(5)]
        );
    }
}

/// `rig_sampled.csv`: counts equal, and the spectral radius to 1e-9, of which ten digits are given.
#[test]
fn the_table_of_digital_loops() {
    let table = include_str!("../reference/rig_sampled.csv");
    let rows: Vec<Vec<f64>> = table
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    assert_eq!(rows.len(), 60);
    for row in rows {
        let [
            mu_prime,
            damping,
            viscous,
            alpha_v,
            alpha_n,
            tau,
            h,
            radius,
            unstable,
        ] = row[..]
        else {
            panic!("nine columns")
        };
        let b = mu_prime + damping + viscous;
        let groups = Groups::new(b, alpha_v, alpha_n - damping * alpha_v);
        let of_loop = SampledLoop::new(groups, Channel::default(), h).unwrap();
        let m = (tau / h).round() as u64;
        assert_eq!(of_loop.n_unstable(m) as f64, unstable, "{row:?}");
        let spectrum = SampledRoots::new(of_loop).spectrum(m as f64 * h, 1);
        let found = (spectrum.abscissa * h).exp();
        assert!((found - radius).abs() < 1e-9, "{found} {row:?}");
        assert!(spectrum.certified, "{row:?}");
    }
}

/// To first order a short sample time is a latency of half of it; what is left falls as its square.
#[test]
fn a_short_sample_time_is_a_latency_of_half_of_it() {
    for (groups, tau) in [
        (Groups::new(-0.3, -0.33, 0.0), 4.15),
        (Groups::new(-0.5, 0.0, -2.5), 0.6),
        (Groups::new(0.2, 0.5, 0.3), 2.0),
    ] {
        let apart = |m: u64| {
            let h = tau / m as f64;
            let of_loop = SampledLoop::new(groups, Channel::default(), h).unwrap();
            let sampled = SampledRoots::new(of_loop).spectrum(tau, 1).abscissa;
            let late = Channel {
                memory: 0.0,
                latency: 0.5 * h,
            };
            let roots = Linear::of_feedback(groups, late).roots(&Stop::default());
            (sampled - roots.spectrum(tau, 1).abscissa).abs()
        };
        let [coarse, middle, fine] = [40, 160, 640].map(apart);
        for (one, next) in [(coarse, middle), (middle, fine)] {
            let order = (one / next).log2() / 2.0;
            assert!((order - 2.0).abs() < 0.1, "{groups:?}: {order}");
        }
    }
}

/// A block without friction starts on the circle: with a latency of h/2 a pair leaves it as the
/// letter's does at a short delay.
#[test]
fn a_block_without_friction_has_its_counts() {
    for (a_v, a_n, m, h) in [
        (0.0, -0.4, 3, 0.05),
        (0.0, 0.4, 3, 0.05),
        (-0.2, 0.1, 20, 0.2),
        (0.3, -0.3, 40, 0.1),
        (-0.2, 0.0, 10, 0.3),
        (0.2, 0.0, 10, 0.3),
    ] {
        let sampled = Sampled {
            groups: Groups::new(0.0, a_v, a_n),
            h,
            m,
            memory: 0.0,
            late: 0,
        };
        assert_eq!(sampled.wrong(), None);
    }
}

/// Stable multiples of the sample time and distances to others are those of single counts.
#[test]
fn stable_multiples_are_those_of_counts() {
    for i in 0..60 {
        let sampled = Sampled::random(&mut Chance(77 + i), i % 3 != 0);
        let (model, h) = (sampled.model(), sampled.h);
        let line = model.line(1.0);
        let stable: Vec<_> = line.stable_intervals().collect();
        let counted = |m: u64| model.n_unstable(m) == 0;
        for m in 1..400 {
            let tau = m as f64 * h;
            let inside = stable
                .iter()
                .any(|s| s.from < tau + 0.5 * h && tau < s.to + 0.5 * h);
            assert_eq!(inside, counted(m), "{sampled:?} {m}");
            let margin = line.margin(tau);
            assert_eq!(margin > 0.0, inside);
            let steps = (margin.abs() / h).round();
            if steps < 200.0 {
                let steps = steps as u64;
                let other = |n: u64| n > 0 && counted(n) != inside;
                let nearer = (1..steps).any(|k| other(m + k) || other(m.saturating_sub(k)));
                assert!(!nearer, "{sampled:?} {m}");
                assert!(
                    other(m + steps) || other(m.saturating_sub(steps)),
                    "{sampled:?} {m} {margin} {stable:?}"
                );
            }
        }
    }
}

/// Gain, phase and latency margins are where single counts change.
#[test]
fn margins_are_where_counts_change() {
    let mut seen = 0;
    for i in 0..400 {
        let sampled = Sampled::random(&mut Chance(4000 + i), i % 2 == 0);
        let (model, m) = (sampled.model(), sampled.m);
        if !model.is_stable(m) {
            continue;
        }
        seen += 1;
        let stable = |factor: f64| model.with_gains(factor).n_unstable(m) == 0;
        let Limits { lower, upper } = model.gain_margin(m);
        assert!(lower < 1.0 && 1.0 < upper, "{sampled:?} {lower} {upper}");
        for step in 1..200 {
            let part = f64::from(step) / 200.0;
            let above = if upper.is_finite() { upper } else { 50.0 };
            let factors = [
                lower + (1.0 - lower) * part,
                above.powf(part) * (1.0 - 1e-9),
            ];
            for factor in factors {
                assert!(stable(factor), "{sampled:?} {lower} {upper} {factor}");
            }
        }
        assert!(upper.is_infinite() || !stable(upper * (1.0 + 1e-7)));
        assert!(
            lower == 0.0 || !stable(lower * (1.0 - 1e-7)),
            "{sampled:?} {lower}"
        );
        let without = Sampled { late: 0, ..sampled };
        let late = |late: u64| Sampled { late, ..without }.model().n_unstable(m) == 0;
        let latency = model.latency_margin(m).unwrap_or(40);
        assert!((0..=latency.min(40)).all(late) || latency == 0);
        assert!(
            model
                .latency_margin(m)
                .is_none_or(|latency| !late(latency + 1) || latency == 0)
        );
    }
    assert!(seen > 20, "{seen}");
}

/// |L| is 1 at the phase margin and nowhere nearer to −1: by many frequencies.
#[test]
fn phase_margins_are_those_of_the_loop() {
    for (groups, h, m) in [
        (Groups::new(-0.3, -0.33, 0.0), 0.0415, 100),
        (Groups::new(-0.5, 0.0, -2.5), 0.06, 10),
        (Groups::new(0.2, 0.5, 0.3), 0.1, 20),
    ] {
        let of_loop = SampledLoop::new(groups, Channel::default(), h).unwrap();
        let found = of_loop.phase_margin(m);
        // −L from the step of the block, by frequencies so dense that none is missed.
        let sampled = Sampled {
            groups,
            h,
            m,
            memory: 0.0,
            late: 0,
        };
        let step = sampled.step();
        let minus_loop = |angle: f64| {
            let z = Complex64::from_polar(1.0, angle);
            let [a, b] = [z - step[0][0], Complex64::from(-step[0][1])];
            let [c, d] = [Complex64::from(-step[1][0]), z - step[1][1]];
            let response = (a * step[1][2] - c * step[0][2]) / (a * d - b * c);
            response * (1.0 - z.powu(m as u32).inv())
        };
        let (mut least, mut before) = (f64::INFINITY, minus_loop(1e-7));
        for i in 1..2_000_000 {
            let now = minus_loop(1e-7 + std::f64::consts::PI * f64::from(i) / 2e6);
            if (now.norm() > 1.0) != (before.norm() > 1.0) {
                least = least.min(now.arg().abs());
            }
            before = now;
        }
        assert!((least - found).abs() < 1e-3, "{groups:?}: {found} {least}");
    }
}

/// Every root is listed once, pairs by their frequency in [0, π/h], and none is missing.
#[test]
fn roots_are_listed_once() {
    for i in 0..300 {
        let sampled = Sampled::random(&mut Chance(9000 + i), i % 3 != 0);
        if sampled.h > 1.0 || sampled.m < 3 {
            continue;
        }
        let (model, tau) = (sampled.model(), sampled.m as f64 * sampled.h);
        let spectrum = SampledRoots::new(model).spectrum(tau, 6);
        assert!(spectrum.missing.is_none(), "{sampled:?}");
        let sizes = sampled.sizes();
        let mut expected = sizes.iter();
        for root in &spectrum.roots {
            let (size, angle) = (
                (root.lambda.re * sampled.h).exp(),
                root.lambda.im * sampled.h,
            );
            let half_turn = std::f64::consts::PI * (1.0 + 1e-12);
            assert!((0.0..=half_turn).contains(&angle), "{sampled:?} {angle}");
            let alone = angle == 0.0 || (half_turn - angle).abs() < 1e-9;
            for _ in 0..if alone { 1 } else { 2 } {
                let one = expected.next().unwrap();
                assert!(
                    (one - size).abs() < 1e-5 * one,
                    "{sampled:?} {size} {sizes:?}"
                );
            }
        }
    }
}

/// An undamped block that makes whole half turns between readings is not told to be stable.
#[test]
fn half_turns_between_readings_are_not_decided() {
    use std::f64::consts::PI;
    for (h, m, a_v) in [(PI, 3, -1.8361155619348941), (2.0 * PI, 1, -0.111)] {
        let groups = Groups::new(0.0, a_v, 0.0);
        let of_loop = SampledLoop::new(groups, Channel::default(), h).unwrap();
        let roots = SampledRoots::new(of_loop);
        assert!(roots.count(f64::from(m) * h, 1.0).is_none());
        assert!(!roots.spectrum(f64::from(m) * h, 1).certified);
    }
}

/// A plane of gains from `gains` and of up to `multiples` samples around a loop.
struct Plane {
    of: Sampled,
    velocity: bool,
    gains: (f64, f64),
    multiples: u64,
}

impl Plane {
    fn random(chance: &mut Chance, simple: bool) -> Self {
        let velocity = chance.unit() < 0.5;
        let most = if velocity { 1.5 } else { 6.0 };
        let mut of = Sampled::random(chance, simple);
        of.h = 0.15 + 0.6 * chance.unit();
        of.late = of.late.min(3);
        of.groups.b = -of.groups.b.abs().min(0.6);
        Self {
            of,
            velocity,
            gains: (-most, most),
            multiples: 14,
        }
    }

    fn at(&self, gain: f64, m: u64) -> Sampled {
        let mut of = Sampled { m, ..self.of };
        match self.velocity {
            true => of.groups.a_v = gain,
            false => of.groups.a_n = gain,
        }
        of
    }

    /// The abscissa of a place by eigenvalues.
    fn abscissa(&self, gain: f64, m: u64) -> f64 {
        let of = self.at(gain, m);
        of.sizes()[0].ln() / of.h
    }

    fn search(&self) -> SampledPlane {
        let [without, one] = [0.0, 1.0].map(|gain| self.at(gain, 1).model());
        SampledPlane {
            loops: GainLine::through(without, &one),
            gains: self.gains,
            multiples: (1, self.multiples),
        }
    }
}

/// Best settings against eigenvalues: no place of a grid, and none near, decays faster; stable
/// places lie in regions, and the region of a place has its own stable gains.
#[test]
fn no_setting_decays_faster_than_the_best() {
    let mut chance = Chance(23);
    for number in 0..asked("SLIPMAP_SAMPLED", 600) / 20 {
        let plane = Plane::random(&mut chance, number % 2 == 0);
        let (h, search) = (plane.of.h, plane.search());
        let found = search.best(&Stop::default());
        let best = &found.overall;
        let m = (best.q / h).round() as u64;
        let there = plane.abscissa(best.p, m);
        // Multiple roots are known to the root of rounding.
        let near = 1e-5 * (1.0 + there.abs());
        assert!(
            (best.abscissa - there).abs() < near,
            "{number}: {best:?} {there}"
        );
        let (from, to) = plane.gains;
        let try_at = |gain: f64, m: u64| {
            let abscissa = plane.abscissa(gain, m);
            assert!(
                best.abscissa < abscissa + near,
                "{number}: {gain} {m} {abscissa} {best:?}"
            );
            let inside = |&(low, high): &(f64, f64)| low <= gain && gain <= high;
            if abscissa.abs() > 1e-6 {
                let stable = search.loops.stable(m, plane.gains).unwrap();
                assert_eq!(
                    stable.iter().any(inside),
                    abscissa < 0.0,
                    "{number}: {gain} {m}"
                );
            }
            if abscissa < -1e-6 && found.regions_left_out == 0 {
                let tau = m as f64 * h;
                let in_region = found.regions.iter().any(|region| {
                    let (shortest, longest) = region.q;
                    inside(&region.p) && shortest < tau + 1e-9 && tau < longest + 1e-9
                });
                assert!(in_region, "{number}: {gain} {m}");
            }
        };
        for m in 1..=plane.multiples {
            for i in 0..=24 {
                try_at(from + (to - from) * f64::from(i) / 24.0, m);
            }
        }
        for _ in 0..40 {
            let part = (2.0 * chance.unit() - 1.0) * 0.05 * (to - from);
            let m = (m + 1).saturating_sub((3.0 * chance.unit()) as u64);
            try_at((best.p + part).clamp(from, to), m.clamp(1, plane.multiples));
        }
    }
}

/// With many samples in a delay the best setting is that of the letter's continuous loop, a double
/// pair, but for the latency of half a sample.
#[test]
fn the_best_setting_of_short_samples_is_the_continuous_one() {
    // By `physics.md`, for mu' = -0.3: tau = 3.6158165, a_v = -0.2116364, abscissa -0.2066890.
    let apart = [0.04, 0.01].map(|h| {
        let [without, one] = [0.0, 1.0].map(|a_v| {
            SampledLoop::new(Groups::new(-0.3, a_v, 0.0), Channel::default(), h).unwrap()
        });
        let search = SampledPlane {
            loops: GainLine::through(without, &one),
            gains: (-2.0, 2.0),
            multiples: (1, (25.0 / h) as u64),
        };
        let found = search.best(&Stop::default());
        assert_eq!(found.regions.len(), 2, "{found:?}");
        assert!(found.overall.certified && found.overall.kind != Kind::Edge);
        assert!((found.overall.p + 0.211_636).abs() < 0.3 * h.sqrt());
        found.overall.abscissa + 0.206_688_968
    });
    assert!(apart[1] > 0.0 && apart[1] < 0.7 * apart[0], "{apart:?}");
}

/// What noise of readings does, against integrals over all frequencies by a program of its own:
/// (1/2π)∫|H(e^iθ)|² dθ of the mean, of u² and of u S.
#[test]
fn noise_is_that_of_all_frequencies() {
    for ((b, a_v, a_n, h, m), (memory, late, samples), expected) in [
        (
            (-0.694, 0.0, -4.17, 0.05, 10),
            (0.0, 0, 1000),
            [0.0313809342428, 0.902040026604, -0.150123687881],
        ),
        (
            (-0.694, 0.0, -4.17, 0.05, 10),
            (0.0, 0, 20),
            [0.283708353501, 0.902040026604, -0.150123687881],
        ),
        (
            (-0.3, -0.33, 0.0, 0.1, 42),
            (0.0, 0, 500),
            [0.0467540970146, 0.160431754691, 0.0546898447273],
        ),
        (
            (-0.3, -0.1, -1.2, 0.1, 6),
            (0.3, 2, 64),
            [0.140370423327, 0.504705060998, -0.10644588371],
        ),
        (
            (0.2, -0.2, -0.8, 0.3, 5),
            (-0.2, 0, 100),
            [0.0985119486309, 0.718574057533, 0.3287611954],
        ),
    ] {
        let of = Sampled {
            groups: Groups::new(b, a_v, a_n),
            h,
            m,
            memory,
            late,
        };
        let model = of.model();
        assert_eq!(model.n_unstable(m), 0, "{of:?}");
        let found = model.noise(m, samples, -0.02).unwrap();
        let found = [found.of_mean, found.u_square, found.u_signal];
        for (found, expected) in found.into_iter().zip(expected) {
            assert!(
                (found / expected - 1.0).abs() < 1e-9,
                "{of:?}: {found} {expected}"
            );
        }
    }
}

/// One root is found of a block without friction, whose own pair lies on the circle.
#[test]
fn the_largest_root_of_a_block_without_friction_is_found() {
    for (a_v, a_n) in [(0.0, -2.4), (-0.3, 0.0), (0.0, -0.1)] {
        let of = Sampled {
            groups: Groups::new(0.0, a_v, a_n),
            h: 0.05,
            m: 10,
            memory: 0.0,
            late: 0,
        };
        let expected = of.sizes()[0].ln() / of.h;
        let found = SampledRoots::new(of.model()).spectrum(0.5, 1);
        assert!(found.certified, "{a_v} {a_n}: {found:?}");
        assert!(
            (found.abscissa - expected).abs() < 1e-9,
            "{found:?} {expected}"
        );
    }
}
