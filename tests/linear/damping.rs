//! Dashpots beside the spring and to the ground, against the determinant of the two linear equations
//! of motion in physical units, which knows no groups.

use std::sync::Arc;

use num_complex::Complex64;
use slipmap::answers::margins::SettingMargins;
use slipmap::linear::margins::MarginSearch;
use slipmap::model::stop::Stop;
use slipmap::setting::law_kind::LawKind;
use slipmap::setting::{Parameter, Setting, SweepSpec};
use slipmap::sweep::Plan;
use slipmap::sweep::events::Attended;
use slipmap::sweep::grid::Grid;

use crate::chance::{Chance, asked};

/// The value of a parameter.
type Numbers = Vec<(&'static str, f64)>;

fn number(numbers: &Numbers, name: &str) -> f64 {
    let found = numbers.iter().find(|(given, _)| *given == name);
    found.map_or(0.0, |(_, value)| *value)
}

/// What friction does to a disturbance u of the velocity and one of the load: their factors in the
/// force. With a state the law is linearised with it.
fn friction(of: impl Fn(&str) -> f64, state: bool, s: Complex64) -> [Complex64; 2] {
    if !state {
        return [
            (of("mu_prime") * of("normal_load")).into(),
            of("mu_k").into(),
        ];
    }
    // θ = D/v0 + ϑ: ϑ (s + v0/D) = −u/v0 − c μ D s ν/(v0 B N0), ν being that of the load.
    let [v0, distance, evolution] = ["v0", "slip_distance", "evolution_effect"].map(&of);
    let effect = of("direct_effect") - evolution;
    let mu = of("mu0") + effect * (v0 / of("v_star")).ln();
    let decay = s + v0 / distance;
    let of_state = of("normal_load") * evolution * v0 / distance;
    let by_velocity = of("normal_load") * of("direct_effect") / v0 - of_state / (v0 * decay);
    let taken = of("load_memory") * mu * distance / (v0 * evolution * of("normal_load"));
    [by_velocity, mu - of_state * taken * s / decay]
}

/// The determinant of u and the elongation a, times 1 − R e^(−sτ), at whose zeros it has poles:
///
/// ```text
/// (Ms + F_u + c_g) u = κ a + c ȧ − F_N ν,   ȧ = v − u,   s a = v − u
/// ```
fn determinant(numbers: &Numbers, state: bool, s: Complex64) -> Complex64 {
    let of = |name: &str| number(numbers, name);
    let echo = (-s * of("tau")).exp();
    let remembered = 1.0 - of("memory") * echo;
    let signal = (-s * of("latency")).exp() * (1.0 - echo) / remembered;
    let lag = |name: &str| 1.0 + s * of(name);
    let signal = signal / lag("sensor_lag");
    let velocity = of("alpha_v") * signal / lag("velocity_lag");
    let load = of("alpha_n") * signal / lag("load_lag");
    let [by_velocity, by_load] = friction(of, state, s);
    let own = of("mass") * s + by_velocity + of("viscous") + of("damping");
    let spring = of("stiffness") + of("damping") * velocity - by_load * load;
    (own * (s - velocity) + spring) * remembered
}

/// The zero of the determinant next to `s`, by Newton's method with a difference quotient.
fn zero(numbers: &Numbers, state: bool, mut s: Complex64) -> Complex64 {
    for _ in 0..8 {
        let h = 1e-5 * (1.0 + s.norm());
        let at = |s| determinant(numbers, state, s);
        s -= at(s) / ((at(s + h) - at(s - h)) / (2.0 * h));
    }
    s
}

/// A setting by chance; every second one with memory, latency and lags, every fourth one under
/// rate-and-state friction.
fn by_chance(chance: &mut Chance, i: u64) -> (Numbers, bool) {
    let state = i % 4 == 3;
    let mut numbers = vec![
        ("mass", chance.log(0.3, 3.0)),
        ("stiffness", chance.log(0.3, 3.0)),
        ("normal_load", chance.log(0.3, 3.0)),
        ("damping", chance.between(0.0, 1.0)),
        ("viscous", chance.between(0.0, 0.5)),
        ("alpha_v", chance.between(-1.5, 1.5)),
        ("alpha_n", chance.between(-3.0, 3.0)),
        ("tau", chance.between(0.1, 9.0)),
    ];
    if i % 2 == 1 {
        numbers.extend([
            ("memory", chance.between(-0.8, 0.8)),
            ("latency", chance.between(0.0, 1.0)),
            ("load_lag", chance.between(0.0, 0.5)),
            ("velocity_lag", chance.between(0.0, 0.5)),
            ("sensor_lag", chance.between(0.0, 0.3)),
        ]);
    }
    numbers.extend(match state {
        true => vec![
            ("mu0", chance.between(0.3, 0.8)),
            ("v_star", 1.0),
            ("v0", chance.log(0.1, 2.0)),
            ("direct_effect", chance.between(0.005, 0.05)),
            ("evolution_effect", chance.between(0.005, 0.09)),
            ("slip_distance", chance.log(0.02, 1.0)),
            ("load_memory", chance.between(0.0, 0.5)),
        ],
        false => vec![
            ("mu_prime", chance.between(-1.5, 0.5)),
            ("mu_k", chance.between(0.2, 1.0)),
        ],
    });
    (numbers, state)
}

fn setting(numbers: &Numbers, state: bool) -> Setting {
    let law = state.then(|| LawKind::named("rate-and-state").unwrap());
    Setting::checked(numbers.iter().copied(), law, &[]).unwrap()
}

#[test]
fn roots_are_zeros_of_the_determinant() {
    let mut chance = Chance(38);
    let (mut roots, mut settings) = (0, 0);
    for i in 0..asked("SLIPMAP_DAMPED", 1000) {
        let (numbers, state) = by_chance(&mut chance, i);
        let setting = setting(&numbers, state);
        let (linear, unit) = setting.linear().unwrap();
        let tau = number(&numbers, "tau") / unit;
        let found = linear.roots(&Stop::default()).spectrum(tau, 4);
        settings += u32::from(found.certified);
        for root in found.roots {
            let s = root.lambda / unit;
            let exact = zero(&numbers, state, s);
            let off = (s - exact).norm() / (1.0 + exact.norm());
            assert!(off < 1e-11, "{numbers:?}: {s} {exact} {off:e}");
            roots += 1;
        }
    }
    assert!(settings > 900 && roots > 3600, "{settings} {roots}");
}

/// The number of unstable roots at the gain `alpha_v` of a short delay, where sliding is unstable
/// without dashpots whatever the positive gain is.
fn unstable(damping: f64, slope: f64, alpha_v: f64, tau: f64) -> u64 {
    let numbers = vec![
        ("mu_prime", slope),
        ("damping", damping),
        ("alpha_v", alpha_v),
        ("tau", tau),
    ];
    let (linear, unit) = setting(&numbers, false).linear().unwrap();
    let count = linear.roots(&Stop::default()).count(tau, unit);
    count.expect("known").n_unstable
}

#[test]
fn positive_gains_of_short_delays_amplify_the_dashpot() {
    assert_eq!(unstable(0.2, -0.9246, 85.0, 0.01), 0);
    assert_eq!(unstable(0.2, -0.9246, 75.0, 0.01), 2);
    assert_ne!(unstable(0.0, -0.9246, 85.0, 0.01), 0);
    // The longest delay with a stable gain: the argument of D along a contour in steps of 1e-3 has no
    // turn right before it (0.0235, 0.32), and one right after it (0.0239, 0.33).
    for (damping, slope, longest) in [(0.2, -0.8848, 0.023661), (1.0, -1.5573, 0.326392)] {
        let any = |tau: f64| {
            let gains = (1..4000).map(|i| f64::from(i) / 4000.0 / tau);
            gains
                .into_iter()
                .any(|gain| unstable(damping, slope, gain, tau) == 0)
        };
        assert!(any(longest * 0.999) && !any(longest * 1.001), "{damping}");
    }
}

/// A sweep of one gain and the delay of a damped block.
fn plane(gain: &str, fields: &str, more: &str) -> Grid {
    let text = format!(
        "fields = [{fields}]\n{more}\n[axes]\n{gain} = {{ from = -2.0, to = 1.0, points = 31 }}\n\
         tau = {{ from = 0.05, to = 12.0, points = 40 }}\n[fixed]\nmu_prime = -0.5\nmu_k = 0.6\n\
         damping = 0.12\nviscous = 0.05\nmass = 1.3\nstiffness = 0.8\nnormal_load = 1.1\n{}",
        match gain {
            "alpha_v" => "alpha_n = -0.3\n",
            _ => "alpha_v = -0.2\n",
        }
    );
    let spec: SweepSpec = text.parse().unwrap();
    let plan = Arc::new(Plan::new(spec).unwrap());
    Grid::compute(&plan, 1, Attended::silently(&Arc::default())).unwrap()
}

fn numbers_at(grid: &Grid, gain: &'static str, value: f64, tau: f64) -> Numbers {
    let fixed = &grid.plan().spec.fixed;
    let of = |p: Parameter| (p.name(), fixed.get(p));
    let mut numbers = vec![(gain, value), ("tau", tau)];
    numbers.extend(
        Parameter::ALL
            .map(of)
            .into_iter()
            .filter(|(name, value)| !value.is_nan() && *name != gain && *name != "tau"),
    );
    numbers
}

/// Along the gains the curves are crossings.
#[test]
fn curves_go_along_the_physical_gains() {
    for gain in ["alpha_v", "alpha_n"] {
        let grid = plane(gain, "\"n_unstable\"", "boundaries = true");
        let curves = grid.curves[0].curves[0].curves.as_ref().unwrap();
        let mut vertices = 0;
        for vertex in curves.pieces.iter().flat_map(|piece| &piece.vertices) {
            let numbers = numbers_at(&grid, gain, vertex.p, vertex.q);
            let at = Complex64::new(0.0, vertex.omega);
            assert!(
                determinant(&numbers, false, at).norm() < 1e-9,
                "{gain} {vertex:?}"
            );
            vertices += 1;
        }
        assert!(vertices > 200, "{vertices}");
    }
}

/// No setting of the grid decays faster than the best one, which itself is a zero of the
/// determinant.
#[test]
fn best_settings_are_along_the_physical_gains() {
    for gain in ["alpha_v", "alpha_n"] {
        let grid = plane(gain, "\"abscissa\"", "best = true");
        let best = &grid.best[0].as_ref().unwrap().overall;
        let cells = &grid.cells.columns[0].cells;
        let least = cells.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(best.abscissa < least && least < 0.0, "{best:?} {least}");
        let numbers = numbers_at(&grid, gain, best.p, best.q);
        let s = Complex64::new(best.abscissa, best.frequencies[0]);
        // At the best setting two roots may be one: errors are square roots.
        assert!((zero(&numbers, false, s) - s).norm() < 1e-5, "{best:?}");
    }
}

/// Derivatives of the abscissa against difference quotients of zeros of the determinant.
#[test]
fn sensitivities_are_those_of_the_physical_parameters() {
    let names = ["alpha_v", "alpha_n", "mu_prime", "tau"];
    let fields = ["alpha_v", "alpha_n", "mu_prime", "tau"].map(|p| format!("\"d_abscissa_d_{p}\""));
    for more in ["", "latency = 0.3\nvelocity_lag = 0.2\nload_lag = 0.1\n"] {
        let text = format!(
            "fields = [\"abscissa\", \"frequency\", {}]\n[axes]\ntau = [2.7]\n[fixed]\n\
             mu_prime = -0.5\nmu_k = 0.6\ndamping = 0.12\nviscous = 0.05\nalpha_v = -0.4\n\
             alpha_n = -0.3\nmass = 1.3\nstiffness = 0.8\nnormal_load = 1.1\n{more}",
            fields.join(", ")
        );
        let plan = Arc::new(Plan::new(text.parse().unwrap()).unwrap());
        let grid = Grid::compute(&plan, 1, Attended::silently(&Arc::default())).unwrap();
        let read = |name: &str| {
            let of = |column: &&_| -> bool { field_name(column) == name };
            grid.cells.columns.iter().find(of).unwrap().cells[0]
        };
        let s = Complex64::new(read("abscissa"), read("frequency"));
        for name in names {
            let moved = |by: f64| {
                let mut numbers = numbers_at(&grid, "tau", 2.7, 2.7);
                numbers
                    .iter_mut()
                    .filter(|(n, _)| *n == name)
                    .for_each(|(_, v)| *v += by);
                zero(&numbers, false, s).re
            };
            let h = 1e-5;
            let quotient = (moved(h) - moved(-h)) / (2.0 * h);
            let found = read(&format!("d_abscissa_d_{name}"));
            assert!(
                (found - quotient).abs() < 1e-8,
                "{name}: {found} {quotient}"
            );
        }
    }
}

/// The limits of gains, delay and slope are where exact counts of other settings change.
#[test]
fn margins_are_of_the_physical_parameters() {
    let mut chance = Chance(7);
    let (mut tried, mut limits) = (0, 0);
    while tried < 60 {
        let (mut numbers, _) = by_chance(&mut chance, tried % 2);
        numbers.retain(|(name, _)| *name != "tau");
        numbers.push(("tau", chance.between(0.2, 4.0)));
        let setting = setting(&numbers, false);
        let around = SettingMargins::of(&setting, 0.0).unwrap().unwrap();
        if !around.stable() {
            continue;
        }
        tried += 1;
        let mut search = MarginSearch::default();
        let stable = |changes: &[(&'static str, f64)]| {
            let mut changed = numbers.clone();
            for (name, value) in &mut changed {
                let new = changes.iter().find(|(of, _)| of == name);
                *value = new.map_or(*value, |(_, new)| *new);
            }
            let (linear, unit) = self::setting(&changed, false).linear().unwrap();
            let tau = number(&changed, "tau");
            let count = linear.roots(&Stop::default()).count(tau, unit);
            count.is_some_and(|count| count.stable())
        };
        let gains = |k: f64| ["alpha_v", "alpha_n"].map(|name| (name, k * number(&numbers, name)));
        let gain = around.gain(&mut search);
        let (third, slope) = around.third(&mut search);
        assert_eq!(third, Parameter::MuPrime);
        let delay = around.delay();
        for (limit, inwards) in [(gain.lower, 1.0), (gain.upper, -1.0)] {
            if limit.is_finite() && limit > 0.0 {
                limits += 1;
                let at = |off: f64| stable(&gains(limit * (1.0 + inwards * off)));
                assert!(at(1e-7) && !at(-1e-7), "{numbers:?} gain {limit}");
            }
        }
        for (name, limit, inwards) in [
            ("mu_prime", slope.lower, 1.0),
            ("mu_prime", slope.upper, -1.0),
            ("tau", delay.lower, 1.0),
            ("tau", delay.upper, -1.0),
        ] {
            if limit.is_finite() && limit != 0.0 {
                limits += 1;
                let at = |off: f64| stable(&[(name, limit + inwards * off)]);
                assert!(at(1e-7) && !at(-1e-7), "{numbers:?} {name} {limit}");
            }
        }
    }
    assert!(limits > 120, "{limits}");
}

fn field_name(column: &slipmap::sweep::cells::buffers::Column) -> &'static str {
    column.field.name()
}
