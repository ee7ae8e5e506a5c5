//! The letter's statements about stick-slip under control, as tests on coarse grids of the shipped
//! sweeps.

use slipmap::answers::vc;
use slipmap::critical::limit::CoulombLimit;
use slipmap::critical::{CriticalVelocity, Problem, critical_velocity};
use slipmap::linear::MarginalTolerance;
use slipmap::linear::rightmost::Rightmost;
use slipmap::model::{Feedback, FrictionLaw};
use slipmap::setting::regime_at_v0::RegimeAtV0;
use slipmap::setting::search::Protocol;
use slipmap::setting::{Parameter, SweepSpec};
use slipmap::slip::case::{Case, Start};
use slipmap::slip::cycle::after_release;
use slipmap::slip::motion::Accuracy;
use slipmap::slip::outcome::{Outcome, Summary};
use slipmap::sweep::Plan;

const FIG3B: &str = include_str!("../../sweeps/velocity_at_fig3b.toml");
const ROBUST_VELOCITY: &str = include_str!("../../sweeps/robust_velocity.toml");
const ROBUST_LOAD: &str = include_str!("../../sweeps/robust_load.toml");

/// A shipped sweep with some of its text replaced.
fn plan(text: &str, replaced: &[(&str, &str)]) -> Plan {
    let mut text = text.to_owned();
    for (from, to) in replaced {
        assert!(text.contains(from), "{from} is in the sweep");
        text = text.replace(from, to);
    }
    Plan::new(text.parse::<SweepSpec>().unwrap()).unwrap()
}

/// The indices of all cells.
fn cells(plan: &Plan) -> impl Iterator<Item = Vec<usize>> {
    let shape = plan.shape().to_vec();
    (0..shape.iter().product::<usize>()).map(move |mut cell| {
        let mut index = vec![0; shape.len()];
        for axis in (0..shape.len()).rev() {
            index[axis] = cell % shape[axis];
            cell /= shape[axis];
        }
        index
    })
}

/// What becomes of the motion of a cell before a horizon.
fn followed(plan: &Plan, index: &[usize], horizon: f64) -> Summary {
    let setting = plan.setting(index);
    let case = plan.spec.simulation.case(&setting, 0.0).unwrap().unwrap();
    Case { horizon, ..case }.run(&mut ()).unwrap()
}

/// "Stick-slip motion can not be destroyed by pure velocity control for that value of v0 for which
/// in Fig. 3(b) load control turns easily stick-slip motion into continuous sliding." Wherever it
/// is switched on, the block sticks again and again; where gains are large and positive it may
/// diverge.
#[test]
fn velocity_control_does_not_end_stick_slip_at_fig_3b() {
    let plan = plan(
        FIG3B,
        &[
            ("points = 111", "points = 12"),
            ("points = 149", "points = 16"),
        ],
    );
    let mut seen = [0; Outcome::ALL.len()];
    for (i, index) in cells(&plan).enumerate() {
        // What is irregular is followed for long in some cells.
        let horizon = if i % 8 == 0 { 10_000.0 } else { 1000.0 };
        let summary = followed(&plan, &index, horizon);
        seen[summary.outcome as usize] += 1;
        match summary.outcome {
            Outcome::StickSlip => {}
            Outcome::Undecided => assert!(
                summary.last_release > horizon - 250.0,
                "{index:?} {summary:?}"
            ),
            Outcome::Diverged => {
                let gain = plan.setting(&index).get(Parameter::AlphaV);
                assert!(gain > 0.1, "{index:?}");
            }
            other => panic!("{index:?}: {other:?}"),
        }
    }
    assert!(seen[Outcome::StickSlip as usize] > 300, "{seen:?}");
}

/// Nor where sliding is stable there, in its one small lobe: both persist beside one another, at
/// every phase of switch-on.
#[test]
fn nor_where_sliding_is_stable_there() {
    let lobe = [
        (
            "alpha_v = { from = -1.5, to = 0.15, points = 111 }",
            "alpha_v = { from = -0.328, to = -0.308, points = 11 }",
        ),
        (
            "tau = { from = 0.1, to = 14.9, points = 149 }",
            "tau = { from = 4.27, to = 4.335, points = 14 }",
        ),
        (
            "[0.0, 1.7, 8.024067]",
            "[0.0, 0.9, 1.7, 2.6, 3.4, 3.5, 5.0, 8.024067, 12.0, 16.0, 19.0, 19.3]",
        ),
    ];
    let plan = plan(FIG3B, &lobe);
    let mut stable = 0;
    for index in cells(&plan) {
        let setting = plan.setting(&index);
        let problem = vc::VcProblem::of(&setting).unwrap().problem;
        if problem.count(0.1).stable() {
            stable += 1;
            let outcome = followed(&plan, &index, 3000.0).outcome;
            assert_eq!(outcome, Outcome::StickSlip, "{index:?}");
        }
    }
    assert!(stable > 500, "{stable}");
    // From near by the block does come to slide.
    let setting = plan.setting(&[0, 6, 6]);
    let mut near = setting.clone();
    near.set(Parameter::SwitchOnPhase, f64::NAN);
    let mut case = plan.spec.simulation.case(&near, 0.0).unwrap().unwrap();
    case.start = Start::State {
        x_dot0: 0.1001,
        a0: 0.5 / 1.2,
    };
    assert_eq!(case.run(&mut ()).unwrap().outcome, Outcome::Sliding);
    let problem = vc::VcProblem::of(&setting).unwrap().problem;
    // By brute force, at α_v = −0.316 and τ = 4.3: v0 raised in small steps by a program of its
    // own.
    let found = critical_velocity(&problem);
    assert!(
        found.decided && (found.vc / 0.370_237_3 - 1.0).abs() < 1e-4,
        "{found:?}"
    );
}

/// The share of cells, at μ′ at rest of −1, in which `v0` is stable and free of stick-slip.
fn share(text: &str, v0: f64, points: u32) -> f64 {
    let points = format!("points = {points}");
    let plan = plan(
        text,
        &[("points = 31", &points), ("[-0.5, -1.0, -2.0]", "[-1.0]")],
    );
    let (mut stable, mut all) = (0.0, 0.0);
    for index in cells(&plan) {
        all += 1.0;
        let setting = plan.setting(&index);
        let asked = vc::VcProblem::of(&setting).unwrap();
        // Looking for v_c takes long, and is in vain where sliding is unstable.
        if !asked.problem.count(v0).stable() {
            continue;
        }
        let found = asked.find(Protocol::Follow);
        let tolerance = MarginalTolerance::default();
        let class = asked.regime_at(v0, Protocol::Follow, &found, tolerance);
        if class == RegimeAtV0::Stable {
            stable += 1.0;
        }
    }
    stable / all
}

/// "The velocity control is less robust than the load control": at low velocities it works in much
/// less of the plane of gain and delay, and below some velocity nowhere. At high ones it catches
/// up: load control then lifts the block off in places.
#[test]
fn velocity_control_is_less_robust_at_low_velocities() {
    for (v0, factor) in [(0.35, 10.0), (0.5, 4.0)] {
        let [velocity, load] = [ROBUST_VELOCITY, ROBUST_LOAD].map(|text| share(text, v0, 21));
        assert!(load > 0.1, "{v0} {load}");
        assert!(load > factor * velocity, "{v0} {velocity} {load}");
    }
    assert_eq!(share(ROBUST_VELOCITY, 0.2, 31), 0.0);
    assert!(share(ROBUST_LOAD, 0.2, 21) > 0.05);
    let [velocity, load] = [ROBUST_VELOCITY, ROBUST_LOAD].map(|text| share(text, 2.0, 11));
    assert!(velocity > 0.7 * load && load > 0.1, "{velocity} {load}");
}

/// Stick time over slip time of the uncontrolled cycle.
fn stick_over_slip(problem: &Problem, v0: f64) -> f64 {
    let parameters = problem.at(v0, 0.0);
    let (_, cycle) = after_release(&parameters, Accuracy::default(), 0.0).unwrap();
    cycle.stick_time / cycle.slip_time
}

fn letters(alpha_v: f64, alpha_n: f64, tau: f64) -> Problem {
    let law = FrictionLaw::weakening(0.5, 0.5, 1.0).unwrap();
    Problem::new(law, Feedback::new(alpha_v, alpha_n, tau))
}

/// "As a rule of thumb we found that in the case of pure velocity control the sticking time has to
/// be of the same order or less than the slipping time." SettingMargins the gain and the delay at which
/// velocity control smooths the lowest velocities, these are no lower than where the uncontrolled
/// block sticks twice as long as it slips; load control smooths those with tens of times. The
/// lowest velocity is that of brute force at α_v = −0.38, τ = 4.25, the ratio there that of SciPy's
/// DOP853.
#[test]
fn velocity_control_needs_short_sticks() {
    let smooth = |problem: &Problem| {
        let CriticalVelocity { vc, decided, .. } = critical_velocity(problem);
        (decided && problem.count(1.001 * vc).stable()).then_some(vc)
    };
    let lowest = (0..7)
        .flat_map(|i| (0..9).map(move |j| (i, j)))
        .filter_map(|(i, j)| {
            let (gain, delay) = (-0.42 + 0.02 * f64::from(i), 4.0 + 0.05 * f64::from(j));
            smooth(&letters(gain, 0.0, delay))
        })
        .fold(f64::INFINITY, f64::min);
    assert!((lowest / 0.221_303_8 - 1.0).abs() < 1e-4, "{lowest}");
    let ratio = stick_over_slip(&letters(0.0, 0.0, 0.0), lowest);
    assert!((ratio / 2.0057 - 1.0).abs() < 2e-4, "{ratio}");
    let load = smooth(&letters(0.0, -10.0, 0.5)).unwrap();
    assert!(stick_over_slip(&letters(0.0, 0.0, 0.0), load) > 10.0);
}

/// Coulomb friction of the letter's Fig. 4, μ_K/μ_S = 0.5, under load control with this γ.
fn coulomb(gamma: f64, tau: f64) -> Problem {
    let law = FrictionLaw::coulomb(0.5, 1.0).unwrap();
    Problem::new(law, Feedback::new(0.0, -2.0 * gamma / (0.5 * tau), tau))
}

/// v_c = 0 from γ = 1 on holds as the delay vanishes. At finite delays it is back at the longer
/// ones: from τ = 0.977 at γ = 1, 0.900 at 1.5, 0.794 at 2, 0.616 at 3 and 0.409 at 5. Where v_c =
/// 0 the rightmost root is real: nothing oscillates about sliding.
///
/// A slip after a stick without memory is linear in v0. Edges, where its minimum of ẋ is 0 as v0 →
/// 0, and v_c a fiftieth beyond τ = 0.977, 0.9, 0.794, 0.616, 0.409, where both parts of it graze,
/// are SciPy's (DOP853 from delay to delay).
#[test]
fn stick_slip_comes_back_beyond_critical_damping() {
    for (gamma, edge, beyond, vc) in [
        (1.0, 0.977_071, 0.977, 0.006_849_85),
        (1.5, 0.900_117, 0.9, 0.008_867_84),
        (2.0, 0.793_674, 0.794, 0.010_410_63),
        (3.0, 0.616_195, 0.616, 0.012_094_99),
        (5.0, 0.408_597, 0.409, 0.015_463_96),
    ] {
        for below in [0.1, 0.5, 0.99] {
            let problem = coulomb(gamma, below * edge);
            let found = critical_velocity(&problem);
            assert!(
                found.decided && found.vc == 0.0,
                "{gamma} {below} {found:?}"
            );
            let rightmost = Rightmost::at(
                problem.groups(1.0),
                problem.feedback.tau,
                1,
                problem.count(1.0),
            );
            assert_eq!(rightmost.roots[0].lambda.im, 0.0, "{gamma} {below}");
        }
        let found = critical_velocity(&coulomb(gamma, 1.01 * edge));
        assert!(found.decided && found.vc > 1e-4, "{gamma} {found:?}");
        let found = critical_velocity(&coulomb(gamma, 1.02 * beyond));
        assert!((found.vc / vc - 1.0).abs() < 1e-4, "{gamma} {found:?}");
    }
}

/// The critical velocity over ṽ less its limit as τ → 0, over τ.
fn rate(gamma: f64, tau: f64) -> f64 {
    let found = critical_velocity(&coulomb(gamma, tau));
    let limit = CoulombLimit::at(gamma, 0.5).unwrap().vc_over_vtilde;
    (found.vc / 0.5 - limit) / tau
}

/// The limit is approached as the first power of τ, from above for weak control, from below for
/// strong. The rates are SciPy's: DOP853 from delay to delay for the two parts of a slip, which is
/// linear in v0, at τ = 0.01 and 0.005.
#[test]
fn the_limit_of_short_delays_is_approached_in_proportion() {
    for (gamma, expected) in [
        (0.05, 0.008_171),
        (0.15, 0.002_649),
        (0.2, -0.001_677),
        (0.3, -0.011_470),
        (0.55, -0.034_329),
        (0.7, -0.036_918),
        (0.85, -0.019_195),
    ] {
        let rates = [0.02, 0.01, 0.005].map(|tau| rate(gamma, tau));
        // The rest of the rate is proportional to τ: its differences halve.
        let [first, second] = [rates[0] - rates[1], rates[1] - rates[2]];
        assert!((first - 2.0 * second).abs() < 2e-4, "{gamma} {rates:?}");
        let extrapolated = 2.0 * rates[2] - rates[1];
        assert!(
            (extrapolated - expected).abs() < 2e-4,
            "{gamma} {extrapolated}"
        );
    }
}
