//! Systems of matrices of any rank, neutral ones and powers of the delay factor, against a table of
//! another program, closed forms, and a walk along the argument of det(λ(1 − E₁z) − A₀ − A₁z).
//! `SLIPMAP_MATRICES` says how many random ones of each kind.

use num_complex::Complex64;

use crate::chain::Chain;
use crate::chance::{Chance, asked};
use crate::walk::{Walk, zeros_between};
use slipmap::linear::MarginalTolerance;
use slipmap::linear::general::{DelayLine, Reason, RightOf, System};
use slipmap::linear::line::{Line, Linear, Roots};
use slipmap::linear::matrix::{Matrix, MatrixError, MatrixRoots, MatrixSystem};
use slipmap::model::stop::Stop;

/// ẋ − E₁ ẋ(t − τ) = A₀ x + A₁ x(t − τ).
#[derive(Debug, Clone)]
struct Written {
    a0: Vec<Vec<f64>>,
    a1: Vec<Vec<f64>>,
    e1: Vec<Vec<f64>>,
}

fn matrix(rows: &[Vec<f64>]) -> Matrix {
    Matrix::new(rows.len(), rows[0].len(), rows.concat())
}

fn zeros(n: usize) -> Vec<Vec<f64>> {
    vec![vec![0.0; n]; n]
}

/// The largest sum of sizes of a row.
fn size(of: &[Vec<f64>]) -> f64 {
    let rows = of.iter().map(|row| row.iter().map(|c| c.abs()).sum());
    rows.fold(0.0, f64::max)
}

impl Written {
    fn system(&self) -> MatrixSystem {
        let e1 = (size(&self.e1) > 0.0).then(|| matrix(&self.e1));
        MatrixSystem::of_matrices(&matrix(&self.a0), &matrix(&self.a1), e1.as_ref()).unwrap()
    }

    /// The determinant, by elimination.
    fn determinant(&self, lambda: Complex64, tau: f64) -> Complex64 {
        let n = self.a0.len();
        let z = (-lambda * tau).exp();
        let mut left: Vec<Vec<Complex64>> = (0..n)
            .map(|i| {
                let own = |j| if i == j { lambda } else { Complex64::ZERO };
                let entry = |j: usize| {
                    own(j) - lambda * self.e1[i][j] * z - self.a0[i][j] - self.a1[i][j] * z
                };
                (0..n).map(entry).collect()
            })
            .collect();
        let mut product = Complex64::ONE;
        for k in 0..n {
            let by_size = |i: &usize, j: &usize| left[*i][k].norm().total_cmp(&left[*j][k].norm());
            let pivot = (k..n).max_by(by_size).unwrap();
            if pivot != k {
                left.swap(pivot, k);
                product = -product;
            }
            product *= left[k][k];
            let (above, below) = left.split_at_mut(k + 1);
            let above = &above[k];
            for row in below {
                let factor = row[k] / above[k];
                for j in k..n {
                    row[j] -= factor * above[j];
                }
            }
        }
        product
    }

    /// How many roots lie right of `line`, within which D may change by half of itself only: a
    /// step that doubles without effect on the argument is taken for small.
    fn right_of(&self, tau: f64, line: f64) -> Option<u64> {
        let grown = (-line * tau).exp().max(1.0);
        let radius =
            1.1 * (size(&self.a0) + grown * size(&self.a1)) / (1.0 - grown * size(&self.e1));
        if radius <= 0.0 {
            return None;
        }
        let at = |lambda| self.determinant(lambda, tau);
        let near = |from: Complex64, here: Complex64, step: f64| {
            let ways = [Complex64::ONE, Complex64::i()];
            let parts = [0.25, 0.5, 1.0];
            step * tau <= 0.5
                && ways.iter().all(|way| {
                    parts.iter().all(|part| {
                        [1.0, -1.0].iter().all(|sign| {
                            let there = at(from + way * (sign * part * step));
                            (there - here).norm() <= 0.4 * here.norm()
                        })
                    })
                })
        };
        zeros_between(line, radius + line.abs(), &at, &near)
    }

    /// A system of `n` states with K delayed signals, stable or not far from it.
    fn random(chance: &mut Chance, rank: usize, neutral: bool) -> Self {
        let n = rank.max(2) + chance.of(9 - rank.max(2));
        let scale = chance.log(0.2, 5.0);
        let mut a0 = zeros(n);
        for (i, row) in a0.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                *entry = scale * (chance.normal() - if i == j { 1.5 } else { 0.0 });
            }
        }
        let product = |chance: &mut Chance, by: f64| {
            let mut all = zeros(n);
            for _ in 0..rank {
                let u: Vec<f64> = (0..n).map(|_| chance.normal()).collect();
                let v: Vec<f64> = (0..n).map(|_| by * chance.normal()).collect();
                for (row, u) in all.iter_mut().zip(&u) {
                    for (entry, v) in row.iter_mut().zip(&v) {
                        *entry += u * v;
                    }
                }
            }
            all
        };
        let by = scale * chance.log(0.05, 2.0);
        let a1 = product(chance, by);
        let mut e1 = zeros(n);
        if neutral {
            let raw = product(chance, 1.0);
            let by = chance.between(0.1, 0.7) / size(&raw);
            e1 = raw
                .iter()
                .map(|row| row.iter().map(|c| by * c).collect())
                .collect();
        }
        Self { a0, a1, e1 }
    }
}

/// A row of `reference/matrices.csv`.
struct Row {
    written: Written,
    tau: f64,
    n_unstable: u64,
    rightmost: Complex64,
}

fn table() -> Vec<Row> {
    let text = include_str!("../reference/matrices.csv");
    let array = |text: &str| -> Vec<Vec<f64>> {
        let rows = text.trim_matches(['[', ']']).split("], [");
        rows.map(|row| row.split(", ").map(|c| c.parse().unwrap()).collect())
            .collect()
    };
    let row = |line: &str| {
        let parts: Vec<&str> = line.split('"').collect();
        let numbers: Vec<f64> = parts[4]
            .split(',')
            .skip(1)
            .map(|c| c.parse().unwrap())
            .collect();
        let a0 = array(parts[1]);
        let [tau, n_unstable, re, im] = numbers[..] else {
            panic!("{line}");
        };
        Row {
            written: Written {
                e1: zeros(a0.len()),
                a0,
                a1: array(parts[3]),
            },
            tau,
            n_unstable: n_unstable as u64,
            rightmost: Complex64::new(re, im),
        }
    };
    text.lines().skip(1).map(row).collect()
}

#[test]
fn a_table_of_systems_is_found_again() {
    let rows = table();
    assert_eq!(rows.len(), 60);
    for (i, row) in rows.iter().enumerate() {
        let roots = MatrixRoots::new(row.written.system());
        let found = roots.spectrum(row.tau, 1);
        let count = found.count.expect("a count");
        assert!(!count.marginal, "{i}");
        assert_eq!(count.n_unstable, row.n_unstable, "{i}");
        let by_argument = roots.right_of(row.tau, 0.0);
        assert_eq!(by_argument, RightOf::Roots(row.n_unstable), "{i}");
        let root = found.roots[0].lambda;
        let apart = (root - Complex64::new(row.rightmost.re, row.rightmost.im.abs())).norm();
        assert!(
            apart <= 1e-10 * row.rightmost.norm(),
            "{i}: {root} {}",
            row.rightmost
        );
        assert!(found.certified, "{i}: {found:?}");
    }
}

/// Counts at the axis and left of it, against the walk; how many were compared and are undecided.
fn compare(written: &Written, tau: f64, seed: u64) -> [u64; 2] {
    let roots = MatrixRoots::new(written.system());
    let mut told = [0, 0];
    let line = roots.delays();
    let count = Line::count(&line, tau, MarginalTolerance::default());
    let decided = count.is_some_and(|count| !count.marginal);
    told[1] += u64::from(!decided);
    if let (Some(count), Some(walked)) = (count, written.right_of(tau, 0.0)) {
        told[0] += 1;
        assert!(
            !decided || count.n_unstable == walked,
            "{seed}: {count:?} {walked} {line:?}"
        );
    }
    let found = roots.on_line(&line, tau, 1);
    told[1] += u64::from(!found.certified && decided);
    if found.certified && found.reason.is_none() {
        let unit = 1e-6 * (1.0 + found.abscissa.abs());
        for (side, least) in [(unit, 0), (-unit, 1)] {
            if let Some(walked) = written.right_of(tau, found.abscissa + side) {
                told[0] += 1;
                assert!((walked > 0) == (least > 0), "{seed}: {found:?} {walked}");
            }
        }
    }
    told
}

#[test]
fn random_systems_agree_with_a_walk() {
    let asked = asked("SLIPMAP_MATRICES", 60);
    for neutral in [false, true] {
        let mut told = [0, 0];
        for seed in 0..asked {
            let mut chance = Chance(seed + if neutral { 1 << 32 } else { 0 });
            let rank = 1 + chance.of(3);
            let written = Written::random(&mut chance, rank, neutral);
            let tau = chance.log(0.05, 10.0);
            let [compared, undecided] = compare(&written, tau, seed);
            told = [told[0] + compared, told[1] + undecided];
        }
        println!("neutral {neutral}: {asked} systems, compared and undecided {told:?}");
        assert!(told[0] > 2 * asked, "{told:?}");
        assert!(100 * told[1] <= 2 * asked.max(100), "{told:?}");
    }
}

/// Σ p_k z^k with random coefficients, to z⁴.
#[test]
fn random_powers_agree_with_a_walk() {
    let asked = asked("SLIPMAP_MATRICES", 60);
    let mut told = [0, 0];
    for seed in 0..asked {
        let mut chance = Chance(seed + (1 << 40));
        let (degree, powers) = (1 + chance.of(6), 1 + chance.of(4));
        let tau = chance.log(0.1, 5.0);
        // p₀ by its zeros, most of them left of the axis.
        let mut p0 = vec![1.0];
        for _ in 0..degree {
            let zero = chance.normal() - 1.0;
            let shifted: Vec<f64> = std::iter::once(0.0).chain(p0.iter().copied()).collect();
            let scaled = p0.iter().map(|c| -zero * c).chain([0.0]);
            p0 = shifted.iter().zip(scaled).map(|(a, b)| a + b).collect();
        }
        let mut all = vec![p0];
        for _ in 0..powers {
            let gain = chance.log(0.02, 1.0);
            all.push((0..degree).map(|_| gain * chance.normal()).collect());
        }
        let roots = MatrixRoots::new(MatrixSystem::of_powers(&all).unwrap());
        let terms = all.iter().enumerate();
        let walk = Walk {
            terms: terms.map(|(k, p)| (p.clone(), k as f64 * tau)).collect(),
        };
        let count = roots.count(tau, 1.0).expect("a count");
        told[1] += u64::from(count.marginal);
        if let Some(walked) = walk.right_of(0.0) {
            told[0] += 1;
            assert!(
                count.marginal || count.n_unstable == walked,
                "{seed}: {count:?} {walked} {all:?} {tau}"
            );
        }
    }
    println!("{asked} systems, compared and undecided {told:?}");
    assert!(10 * told[0] > 9 * asked, "{told:?}");
    assert!(100 * told[1] <= 2 * asked.max(100), "{told:?}");
}

/// P + Q z as polynomials and as a companion matrix: all crossings, the counts and the abscissa.
#[test]
fn polynomials_and_their_companion_agree() {
    let cases: [(&[f64], &[f64], f64); 4] = [
        (&[1.0, 0.1, 1.0], &[0.5], 3.0),
        (&[2.0, 3.0, 1.0], &[-0.5, 1.2], 1.0),
        (&[0.5, 2.0, 1.0, 1.0], &[0.2, -0.4, 0.3], 7.0),
        (&[1.0, 0.3, 1.0], &[0.1, 0.2, 0.4], 2.0),
    ];
    for (p, q, tau) in cases {
        let system = System::of_coefficients(p, q).unwrap();
        let other = MatrixSystem::of_powers(&[p.to_vec(), q.to_vec()]).unwrap();
        let (one, other) = (DelayLine::of(&system), MatrixRoots::new(other));
        let line = other.delays();
        assert_eq!(one.crossings.len(), line.crossings.len());
        for (a, b) in one.crossings.iter().zip(&line.crossings) {
            assert!((a.omega - b.omega).abs() < 1e-13 * a.omega, "{a:?} {b:?}");
            assert!((a.theta - b.theta).abs() < 1e-12, "{a:?} {b:?}");
            assert_eq!(a.direction, b.direction);
        }
        assert_eq!(one.at_zero_delay, line.at_zero_delay);
        let stop = Stop::default();
        let letter = Linear::General(Box::new(system))
            .roots(&stop)
            .spectrum(tau, 3);
        let found = other.spectrum(tau, 3);
        for (a, b) in letter.roots.iter().zip(&found.roots) {
            assert!((a.lambda - b.lambda).norm() < 1e-11, "{letter:?} {found:?}");
        }
        assert!(found.missing.is_none() && found.roots.len() == 3);
    }
}

/// P and Q with random coefficients, and matrices of the same system that are no companion: every
/// number has few binary digits, so that both are exact.
fn given_both_ways(chance: &mut Chance) -> [Vec<f64>; 4] {
    let n = 1 + chance.of(7);
    let number = |chance: &mut Chance| (32.0 * chance.normal()).round() / 32.0;
    // Zeros left of the axis, or not far from it, one or two at a time.
    let mut p = vec![1.0];
    while p.len() <= n {
        let late = number(chance).abs() + 0.5;
        let factor = if p.len() == n {
            vec![late, 1.0]
        } else {
            vec![late, (4.0 * chance.between(-0.1, 1.0)).round() / 4.0, 1.0]
        };
        let mut product = vec![0.0; p.len() + factor.len() - 1];
        for (i, a) in p.iter().enumerate() {
            for (j, b) in factor.iter().enumerate() {
                product[i + j] += a * b;
            }
        }
        p = product;
    }
    let n = p.len() - 1;
    let q: Vec<f64> = (0..n).map(|_| number(chance)).collect();
    // The observer form, then sums of rows with the opposite sums of columns.
    let mut a = vec![0.0; n * n];
    let (mut b, mut c) = (vec![0.0; n], vec![0.0; n]);
    for i in 0..n {
        a[i * n + n - 1] = -p[i];
        b[i] = -q[i];
        if i > 0 {
            a[i * n + i - 1] += 1.0;
        }
    }
    c[n - 1] = 1.0;
    for _ in 0..if n > 1 { 4 } else { 0 } {
        let from = chance.of(n);
        let to = (from + 1 + chance.of(n - 1)) % n;
        let by = [-1.0, 0.5, 1.0, -0.5][chance.of(4)];
        for j in 0..n {
            a[to * n + j] += by * a[from * n + j];
        }
        b[to] += by * b[from];
        for row in a.chunks_mut(n) {
            row[from] -= by * row[to];
        }
        c[from] -= by * c[to];
    }
    [p, q, a, [b, c].concat()]
}

#[test]
fn one_delayed_signal_is_as_its_polynomials() {
    let asked = asked("SLIPMAP_MATRICES", 60);
    let stop = Stop::default();
    let mut crossings = 0;
    for seed in 0..asked {
        let mut chance = Chance(seed + (1 << 45));
        let [p, q, a, fed] = given_both_ways(&mut chance);
        let n = p.len() - 1;
        let (b, c) = fed.split_at(n);
        let system = MatrixSystem::of_feedback(
            &Matrix::new(n, n, a),
            &Matrix::new(n, 1, b.to_vec()),
            None,
            &Matrix::new(1, n, c.to_vec()),
        );
        let system = system.unwrap();
        let [one, other] = [
            Linear::General(Box::new(System::of_coefficients(&p, &q).unwrap())),
            Linear::Matrix(Box::new(system.clone())),
        ];
        let [one, other] = [one, other].map(|of| of.roots(&stop));
        let (line, same) = (one.line(1.0), other.line(1.0));
        let [of_line, of_same] = [&line, &same].map(|of| of.crossings().collect::<Vec<_>>());
        assert_eq!(of_line.len(), of_same.len(), "{seed}");
        for (x, y) in of_line.iter().zip(&of_same) {
            assert!((x.omega - y.omega).abs() <= 1e-12 * x.omega, "{seed}");
            assert!((x.theta - y.theta).abs() <= 1e-12, "{seed} {x:?} {y:?}");
            crossings += 1;
        }
        let by_matrices = MatrixRoots::new(system);
        for tau in [0.0, 0.3, 2.0, 9.0] {
            let [x, y, z] = [&*one, &*other, &by_matrices].map(|of| of.count(tau, 1.0).unwrap());
            assert_eq!(x.n_unstable, y.n_unstable, "{seed} {tau}");
            let decided = !(y.marginal || z.marginal);
            assert!(
                !decided || z.n_unstable == y.n_unstable,
                "{seed} {tau} {z:?}"
            );
        }
        let [x, y] = [&one, &other].map(|of| of.spectrum(1.0, 1).abscissa);
        assert!((x - y).abs() <= 1e-10 * (1.0 + x.abs()), "{seed} {x} {y}");
    }
    println!("{asked} systems, {crossings} crossings");
    assert!(crossings > asked, "{crossings}");
}

/// Chains with damping to 1e-9, every tenth of degree 18 to 32, against their own recursion.
#[test]
fn chains_given_as_matrices_are_right_or_undecided() {
    let asked = asked("SLIPMAP_MATRICES", 60);
    let (mut compared, mut undecided) = (0, 0);
    for seed in 0..asked {
        let mut chance = Chance(seed + (1 << 46));
        let damper = chance.log(1e-9, 1e-2);
        let long = seed % 10 == 9;
        let chain = Chain {
            masses: if long {
                9 + chance.of(8)
            } else {
                2 + chance.of(6)
            },
            spring: chance.between(0.5, 2.0),
            damper,
            gain: chance.normal() * chance.log(1.0, 100.0) * damper,
            rate_gain: chance.normal() * damper,
            tau: chance.log(0.1, 20.0),
        };
        let of = Linear::Matrix(Box::new(of_chain(&chain)));
        let count = of.roots(&Stop::default()).count(chain.tau, 1.0);
        let decided = count.filter(|count| !count.marginal);
        undecided += u64::from(decided.is_none());
        let Some(walked) = chain.right_of(0.0) else {
            continue;
        };
        compared += 1;
        assert!(
            decided.is_none_or(|count| count.n_unstable == walked),
            "{seed}: {chain:?} {count:?} {walked}"
        );
    }
    println!("{asked} chains, {compared} compared, {undecided} undecided");
    assert!(2 * compared > asked, "{compared}");
    assert!(100 * undecided <= 2 * asked.max(100), "{undecided}");
}

/// A lightly damped mass with the damping ratio ζ and a feedback just stronger than it: the
/// right values have 50 digits.
#[test]
fn damping_ratios_of_a_hundred_millionth_keep_their_digits() {
    // (λ² + 2ζλ + 1) + k z.
    for (zeta, k, delays) in [
        (1e-7, 1e-6, &[0.201_357_922][..]),
        (3e-8, 3e-7, &[0.201_357_921, 2.940_235_195][..]),
    ] {
        let a0 = Matrix::new(2, 2, vec![0.0, 1.0, -1.0, -2.0 * zeta]);
        let a1 = Matrix::new(2, 2, vec![0.0, 0.0, -k, 0.0]);
        let line = MatrixRoots::new(MatrixSystem::of_matrices(&a0, &a1, None).unwrap()).delays();
        for delay in delays {
            let near = |of: &slipmap::linear::Crossing| {
                let apart = (of.delay(0) - delay).abs();
                apart < 1e-8 && apart <= of.delay_error(*delay) + 1e-9
            };
            assert!(line.crossings.iter().any(near), "{zeta} {k}: {line:?}");
        }
    }
}

/// A chain of masses as its equations are written.
fn of_chain(of: &Chain) -> MatrixSystem {
    let m = of.masses;
    let laplacian = |i: usize, j: usize| match i.abs_diff(j) {
        0 if i + 1 < m => 2.0,
        0 => 1.0,
        1 => -1.0,
        _ => 0.0,
    };
    let mut written = Written {
        a0: zeros(2 * m),
        a1: zeros(2 * m),
        e1: zeros(2 * m),
    };
    for i in 0..m {
        written.a0[i][m + i] = 1.0;
        for j in 0..m {
            written.a0[m + i][j] = -of.spring * laplacian(i, j);
            written.a0[m + i][m + j] = -of.damper * laplacian(i, j);
        }
    }
    let last = &mut written.a1[2 * m - 1];
    (last[m - 1], last[2 * m - 1]) = (-of.gain, -of.rate_gain);
    written.system()
}

#[test]
fn chains_are_found_again_in_any_unit_of_time() {
    let table = include_str!("../reference/chains.csv");
    for row in table.lines().skip(1) {
        let numbers: Vec<f64> = row.split(',').map(|n| n.parse().unwrap()).collect();
        let chain = Chain {
            masses: numbers[0] as usize,
            spring: numbers[1],
            damper: numbers[2],
            gain: numbers[3],
            rate_gain: numbers[4],
            tau: numbers[5],
        };
        for unit in [1.0, 1e6, 1e-6] {
            let scaled = chain.in_unit(unit);
            let found = MatrixRoots::new(of_chain(&scaled)).spectrum(scaled.tau, 1);
            let count = found.count.expect("a count");
            assert_eq!(count.n_unstable, numbers[6] as u64, "{row} {unit}");
            assert!(
                !count.marginal && found.certified,
                "{row} {unit}: {found:?}"
            );
            let error = (found.abscissa / unit - numbers[7]).abs();
            assert!(error < 1e-10 * chain.spring.sqrt(), "{row} {unit}: {error}");
        }
    }
}

/// Chains of up to sixteen masses, thirty-two states, with damping down to a billionth.
#[test]
fn lightly_damped_chains_are_decided() {
    let asked = asked("SLIPMAP_MATRICES", 60);
    let mut chance = Chance(77);
    let (mut walked, mut undecided) = (0, 0);
    for _ in 0..asked {
        let light = chance.unit() < 0.5;
        let sign = |chance: &mut Chance| if chance.unit() < 0.3 { -1.0 } else { 1.0 };
        let chain = Chain {
            masses: 3 + chance.of(14),
            spring: 1.0,
            damper: if light {
                chance.log(1e-9, 1e-3)
            } else {
                chance.log(1e-3, 0.1)
            },
            gain: sign(&mut chance) * chance.log(0.003, 1.5),
            rate_gain: sign(&mut chance) * chance.log(0.001, 0.5),
            tau: chance.log(0.05, 10.0),
        };
        let unit = chance.log(1e-9, 1e9);
        let scaled = chain.in_unit(unit);
        let found = MatrixRoots::new(of_chain(&scaled)).spectrum(scaled.tau, 1);
        let count = found.count.expect("a count");
        undecided += u64::from(count.marginal || !found.certified);
        if std::env::var_os("SHOW").is_some() && !found.certified {
            println!("{chain:?} {unit} {count:?} {found:?}");
        }
        let beside = [-1e-9, 1e-9].map(|line| chain.right_of(line));
        if let (Some(n), true) = (beside[0], beside[0] == beside[1]) {
            walked += 1;
            assert!(
                count.marginal || count.n_unstable == n,
                "{chain:?} {unit}: {count:?} {n}"
            );
        }
    }
    println!("{asked} chains: {walked} walked, {undecided} undecided");
    assert!(2 * walked > asked, "{walked} of {asked}");
    assert!(50 * undecided <= asked.max(50), "{undecided} of {asked}");
}

/// What rests at 0 or on the axis, and what starts there.
#[test]
fn roots_that_lie_on_the_axis_are_told() {
    let one = |value| Matrix::new(1, 1, vec![value]);
    // ẋ = −x + x(t − τ): 0 is a root at every delay.
    let system = MatrixSystem::of_matrices(&one(-1.0), &one(1.0), None).unwrap();
    let line = MatrixRoots::new(system).delays();
    assert_eq!(line.reason, Some(Reason::RootAtOrigin));
    assert!(line.passage.is_none(), "{line:?}");
    // ẋ = x − x(t − τ): a real root passes it at τ = 1, to the right.
    let system = MatrixSystem::of_matrices(&one(1.0), &one(-1.0), None).unwrap();
    let line = MatrixRoots::new(system).delays();
    let passage = line.passage.expect("a real root passes");
    assert!(
        (passage.tau - 1.0).abs() < 1e-12 && passage.change == 1,
        "{line:?}"
    );
    // An oscillator without damping beside a delayed one: its pair stays.
    let apart = |b: f64, k: f64| Written {
        a0: vec![
            vec![0.0, 1.0, 0.0, 0.0],
            vec![-4.0, -b, 0.0, 0.0],
            vec![0.0, 0.0, 0.0, 1.0],
            vec![0.0, 0.0, -1.0, 0.0],
        ],
        a1: {
            let mut a1 = zeros(4);
            a1[1][0] = -k;
            a1
        },
        e1: zeros(4),
    };
    let line = MatrixRoots::new(apart(0.1, 0.5).system()).delays();
    assert_eq!(line.reason, Some(Reason::RootOnAxis));
    // ẍ + x = k (x − x(t − τ)): Re λ ≈ kτ/2 for short delays.
    for (k, right) in [(0.3, 2), (-0.3, 0)] {
        let a0 = Matrix::new(2, 2, vec![0.0, 1.0, k - 1.0, 0.0]);
        let a1 = Matrix::new(2, 2, vec![0.0, 0.0, -k, 0.0]);
        let line = MatrixRoots::new(MatrixSystem::of_matrices(&a0, &a1, None).unwrap()).delays();
        let walk = Walk {
            terms: vec![(vec![1.0 - k, 0.0, 1.0], 0.0), (vec![k], 0.5)],
        };
        assert_eq!(
            line.n_unstable(0.5),
            walk.right_of(0.0).unwrap(),
            "{line:?}"
        );
        assert_eq!(line.at_zero_delay, right, "{line:?}");
        assert!(line.marginal_at_zero);
    }
    // |E₁| > 1: infinitely many.
    let system = MatrixSystem::of_matrices(&one(-1.0), &one(0.1), Some(&one(1.5))).unwrap();
    let roots = MatrixRoots::new(system);
    assert_eq!(roots.delays().reason, Some(Reason::Infinite));
    assert_eq!(roots.right_of(1.0, 0.0), RightOf::Infinite);
}

fn diagonal(of: &[f64]) -> Vec<Vec<f64>> {
    let mut all = zeros(of.len());
    for (i, value) in of.iter().enumerate() {
        all[i][i] = *value;
    }
    all
}

/// Equal subsystems: their roots are equal, and cross together.
#[test]
fn equal_subsystems_count_as_often_as_there_are() {
    for (a0, c, tau, unstable) in [
        (&[0.3, 0.3, -1.0][..], -0.2, 0.001, 2),
        (&[-1.0, -0.5, -1.0], 0.66, 0.5, 1),
        (&[-2.0, -2.0, 0.3], -0.27, 0.5, 1),
        (&[-2.0, -2.0, -1.0], 1.51, 0.5, 1),
        (&[-1.0, -1.0, -1.0], -2.0, 3.0, 6),
    ] {
        let written = Written {
            a0: diagonal(a0),
            a1: diagonal(&vec![c; a0.len()]),
            e1: zeros(a0.len()),
        };
        assert_eq!(written.right_of(tau, 0.0), Some(unstable), "{a0:?}");
        let found = MatrixRoots::new(written.system()).spectrum(tau, 2);
        let count = found.count.expect("a count");
        assert_eq!(count.n_unstable, unstable, "{a0:?} {found:?}");
        assert!(
            !count.marginal && found.certified && found.missing.is_none(),
            "{a0:?} {found:?}"
        );
    }
    // Three oscillators side by side.
    let mut written = Written {
        a0: zeros(6),
        a1: zeros(6),
        e1: zeros(6),
    };
    for i in 0..3 {
        let (x, v) = (2 * i, 2 * i + 1);
        (written.a0[x][v], written.a0[v][x], written.a0[v][v]) = (1.0, -1.0, -0.1);
        written.a1[v][x] = 0.29;
    }
    let found = MatrixRoots::new(written.system()).spectrum(7.0176, 1);
    assert_eq!(written.right_of(7.0176, 0.0), Some(6));
    assert_eq!(found.count.expect("a count").n_unstable, 6, "{found:?}");
    assert!(found.certified, "{found:?}");
}

/// Blocks of Jordan's form, equal entries of a diagonal, Laplacians: what is told as decided is
/// right, and the walk around det M, the second method, agrees with that of this file.
#[test]
fn systems_of_special_structure_are_right_or_told() {
    let asked = 2 * asked("SLIPMAP_MATRICES", 60);
    let mut told = [0, 0];
    for seed in 0..asked {
        let mut chance = Chance(seed + (1 << 36));
        let n = 2 + chance.of(4);
        let mut written = Written {
            a0: zeros(n),
            a1: zeros(n),
            e1: zeros(n),
        };
        let some = |chance: &mut Chance| [-2.0, -1.0, -0.5, 0.3, 0.0][chance.of(5)];
        let value = some(&mut chance);
        for i in 0..n {
            written.a0[i][i] = if seed % 2 == 0 {
                value
            } else {
                some(&mut chance)
            };
            if i + 1 < n && chance.unit() < 0.5 {
                written.a0[i][i + 1] = 1.0;
            }
        }
        match seed % 3 {
            0 => written.a1 = diagonal(&vec![chance.between(-2.0, 2.0); n]),
            1 => {
                for i in 0..n {
                    for j in 0..n {
                        written.a1[i][j] = if i == j { 1.0 - n as f64 } else { 1.0 };
                    }
                }
            }
            _ => written.a1[n - 1][0] = chance.log(1e-6, 1.0),
        }
        let tau = chance.log(0.05, 10.0);
        let roots = MatrixRoots::new(written.system());
        let line = roots.delays();
        let count = Line::count(&line, tau, MarginalTolerance::default());
        let decided = count.is_some_and(|count| !count.marginal);
        told[1] += u64::from(!decided);
        if let Some(walked) = written.right_of(tau, 0.0) {
            told[0] += 1;
            let wrong = decided && count.is_some_and(|count| count.n_unstable != walked);
            assert!(!wrong, "{seed}: {count:?} {walked} {written:?} {tau}");
            let by_argument = roots.right_of(tau, 0.0);
            let same = by_argument == RightOf::Roots(walked) || by_argument == RightOf::Undecided;
            assert!(same, "{seed}: {by_argument:?} {walked}");
        }
    }
    println!("{asked} systems, compared and undecided {told:?}");
    assert!(3 * told[0] > asked, "{told:?}");
}

/// Pure consensus has a root at 0 at every delay.
#[test]
fn laplacians_have_a_root_at_the_origin() {
    for n in 2..6 {
        for (own, weight) in [(0.0, 1.0), (0.0, 0.3), (0.0, 1.7)] {
            let mut a1 = zeros(n);
            for i in 0..n {
                a1[i][i] = -weight;
                a1[i][(i + 1) % n] = weight;
            }
            let written = Written {
                a0: diagonal(&vec![own; n]),
                a1,
                e1: zeros(n),
            };
            let line = MatrixRoots::new(written.system()).delays();
            assert_eq!(
                line.reason,
                Some(Reason::RootAtOrigin),
                "{n} {weight}: {line:?}"
            );
        }
    }
    // Without feedback at all, and with one state.
    let alone = MatrixSystem::of_matrices(
        &Matrix::new(1, 1, vec![-1.0]),
        &Matrix::new(1, 1, vec![0.0]),
        None,
    );
    let found = MatrixRoots::new(alone.unwrap()).spectrum(1.0, 1);
    assert!(
        (found.abscissa + 1.0).abs() < 1e-12 && found.missing.is_none(),
        "{found:?}"
    );
}

#[test]
fn what_makes_no_system_is_refused() {
    let of = |rows, columns| Matrix::new(rows, columns, vec![0.5; rows * columns]);
    let refused = |a0: &Matrix, a1: &Matrix| MatrixSystem::of_matrices(a0, a1, None).unwrap_err();
    assert!(matches!(
        refused(&of(2, 3), &of(2, 2)),
        MatrixError::Size { what: "A0", .. }
    ));
    assert!(matches!(
        refused(&of(2, 2), &of(3, 3)),
        MatrixError::Size { what: "A1", .. }
    ));
    assert_eq!(
        refused(&of(64, 64), &of(64, 64)),
        MatrixError::TooLarge { rows: 64 }
    );
    let infinite = Matrix::new(1, 1, vec![f64::INFINITY]);
    assert!(matches!(
        refused(&infinite, &of(1, 1)),
        MatrixError::NotFinite { what: "A0" }
    ));
    let lower = MatrixSystem::of_powers(&[vec![1.0], vec![0.0, 1.0]]);
    assert!(matches!(lower, Err(MatrixError::Powers(_))));
    assert!(
        MatrixSystem::of_powers(&[]).is_err() && MatrixSystem::of_powers(&[vec![0.0]]).is_err()
    );
}
