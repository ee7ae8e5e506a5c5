//! slipmap against a referee that shares no code with it, and against tables that other programs
//! worked out.
//!
//! The referee (`tests/referee/`) has friction laws, an integrator in fixed steps and protocols of
//! its own. `SLIPMAP_CASES` asks for so many motions by chance, and for a tenth as many critical
//! velocities and phases of switch-on; `SLIPMAP_SEED` for others.

#![allow(clippy::too_many_lines, reason = "a test tells one story")]

mod against;
mod asked;
mod block;
mod checks;
mod crowd;
mod echoes;
mod law;
#[path = "../common/map.rs"]
mod map;
mod past;
mod pchip;
mod ramp;
mod random;
mod readings;
mod return_map;
mod routes;
mod setting;
mod shares;
mod steps;
mod switch_on;
mod tables;

use std::sync::Arc;

use slipmap::explore::basin::Followed;
use slipmap::slip::outcome::Outcome;
use slipmap::sweep::Plan;

use against::Verdict;
use block::{Block, Event};
use crowd::{Tally, ask};
use law::{Friction, Law};
use random::{Chance, Start};
use setting::Setting;
use steps::Pace;
use switch_on::Fate;

/// An event and its time.
type Happened = (Event, f64);

/// A whole number that the environment gives.
fn given(name: &str) -> Option<u64> {
    let text = std::env::var(name).ok()?;
    Some(text.parse().expect("a whole number"))
}

fn seed() -> u64 {
    given("SLIPMAP_SEED").unwrap_or(20261122)
}

/// A tenth of the cases asked for, or so many by default.
fn tenth_of_cases(default: usize) -> usize {
    given("SLIPMAP_CASES").map_or(default, |n| n as usize / 10)
}

/// Nothing differs; the referee or slipmap says nothing for no more than these shares of the
/// questions.
fn holds(tally: &Tally, knife_edges: f64, undecided: f64) {
    assert!(tally.differ.is_empty(), "{} differ", tally.differ.len());
    let most = |share: f64| 2 + (share * tally.asked as f64) as usize;
    assert!(tally.knife_edges <= most(knife_edges), "{tally:?}");
    assert!(tally.undecided <= most(undecided), "{tally:?}");
}

/// Motions of all four laws under both controls, alone and together, with reversals and lift-off:
/// kinds and times of events.
#[test]
fn motions_by_chance() {
    let total = given("SLIPMAP_CASES").map_or(300, |n| n as usize);
    let tally = ask("motions", total, |number| {
        against::motion(&random::start(&mut Chance::of(seed(), number)))
    });
    holds(&tally, 0.01, 0.0);
    assert!(tally.compared > 10 * tally.asked, "{tally:?}");
}

/// The same with memory, latency or both in the feedback.
#[test]
fn motions_with_memory_and_latency() {
    let total = given("SLIPMAP_CASES").map_or(24, |n| n as usize);
    let tally = ask("motions with memory and latency", total, |number| {
        let mut chance = Chance::of(seed() ^ 0x5eed, number);
        against::motion(&random::remembering(&mut chance))
    });
    holds(&tally, 0.03, 0.0);
    assert!(tally.compared > 8 * tally.asked, "{tally:?}");
}

/// The same with one dashpot or both.
#[test]
fn motions_with_dashpots() {
    let total = given("SLIPMAP_CASES").map_or(60, |n| n as usize);
    let tally = ask("motions with dashpots", total, |number| {
        let mut chance = Chance::of(seed() ^ 0xda5d, number);
        against::motion(&random::damped(&mut chance))
    });
    holds(&tally, 0.03, 0.0);
    assert!(tally.compared > 5 * tally.asked, "{tally:?}");
}

/// The same with limits of actuators, and here and there dashpots, memory or latency.
#[test]
fn motions_with_limits() {
    let total = given("SLIPMAP_CASES").map_or(60, |n| n as usize);
    let tally = ask("motions with limits", total, |number| {
        let mut chance = Chance::of(seed() ^ 0x11317, number);
        against::motion(&random::limited(&mut chance))
    });
    holds(&tally, 0.03, 0.0);
    assert!(tally.compared > 5 * tally.asked, "{tally:?}");
}

/// The same with programmes of v0, and here and there dashpots, limits, memory or latency. Corners
/// are events.
#[test]
fn motions_by_programmes() {
    let total = given("SLIPMAP_CASES").map_or(24, |n| n as usize);
    let tally = ask("motions by programmes", total, |number| {
        let mut chance = Chance::of(seed() ^ 0x9609, number);
        against::motion(&random::programmed(&mut chance))
    });
    holds(&tally, 0.05, 0.0);
    assert!(tally.compared > 5 * tally.asked, "{tally:?}");
}

/// The same with friction laws that are formulas.
#[test]
fn motions_by_formulas() {
    let total = given("SLIPMAP_CASES").map_or(60, |n| n as usize);
    let tally = ask("motions by formulas", total, |number| {
        let mut chance = Chance::of(seed() ^ 0xf0f0, number);
        against::motion(&random::by_formula(&mut chance))
    });
    holds(&tally, 0.03, 0.0);
    assert!(tally.compared > 5 * tally.asked, "{tally:?}");
}

/// The same with readings at equal times, held in between, and here and there dashpots, limits,
/// memory or latency.
#[test]
fn motions_held_by_chance() {
    let total = given("SLIPMAP_CASES").map_or(60, |n| n as usize);
    let tally = ask("held motions", total, |number| {
        let mut chance = Chance::of(seed() ^ 0x4e1d, number);
        against::motion(&random::held(&mut chance))
    });
    holds(&tally, 0.03, 0.0);
    assert!(tally.compared > 5 * tally.asked, "{tally:?}");
}

/// Control by the return map, here and there with dashpots and programmes of v0.
#[test]
fn motions_under_the_return_map() {
    let total = given("SLIPMAP_CASES").map_or(300, |n| n as usize);
    let tally = ask("motions under the return map", total, |number| {
        let mut chance = Chance::of(seed() ^ 0x3e74, number);
        against::motion(&random::steered(&mut chance))
    });
    holds(&tally, 0.05, 0.0);
    assert!(tally.compared > 5 * tally.asked, "{tally:?}");
}

/// A motion under control from t = 0.
fn start(law: Law, mu_s: f64, gains: (f64, f64), tau: f64, v0: f64, (u, a): (f64, f64)) -> Start {
    Start {
        setting: Setting::plain(Friction { law, mu_s }, gains, tau, v0),
        x_dot0: u,
        a0: a,
        horizon: 250.0,
    }
}

/// Motions in which polynomials of the past were used where they were another's: long sticks under
/// velocity control, whose release was told 1e-4 to 1e-7 too late or too early; a lift-off; a
/// stick of no length at a release under Stribeck's law. At the default tolerance and at others.
#[test]
fn long_sticks_under_velocity_control() {
    let weakening = |mu0, v_s| Law::Weakening { mu0, v_s };
    let stribeck = |mu0, v_s| Law::Stribeck { mu0, v_s };
    let (v, narrow) = (0.026104832187075298, 0.026718338500675388);
    let starts = [
        start(
            weakening(0.658352010340304, 0.15104269937104776),
            0.9385092891223417,
            (-0.44999683788418166, 0.0),
            5.771734019081641,
            v,
            (v, -0.41404706094630433),
        ),
        start(
            weakening(0.7229944989567423, 0.026767682767183054),
            1.169130962159901,
            (-0.9327090842033727, -2.4395588220964304),
            0.41990950519275033,
            0.13101061936827846,
            (0.9024191071266787, -1.0880191798127072),
        ),
        start(
            stribeck(0.6614239073121728, 0.0442119351172203),
            1.0,
            (-0.35846634452807224, -0.11741163838669678),
            0.28128960709927125,
            0.027980631792363157,
            (1.9928705294589273, 0.3477380360278155),
        ),
        start(
            stribeck(0.30113306910065696, 0.051735358217012396),
            1.0,
            (-0.7058376213984501, 0.0),
            2.429312336371997,
            narrow,
            (0.0, 1.0265288151820025),
        ),
        start(
            Law::Coulomb {
                mu0: 0.3161755369122524,
            },
            1.0,
            (-0.9940221387267623, -1.4223391808983852),
            1.5807238513034667,
            0.057727470164116515,
            (0.0, 1.0125745286511714),
        ),
    ];
    for start in &starts {
        let verdict = against::motion(start);
        assert!(matches!(verdict, Verdict::Agree(2..)), "{verdict:?}");
        let text = asked::case_file(start);
        let exact = against::events_of_slipmap(&format!("tolerance = 1e-15\n{text}"), 250.0);
        for digits in 8..15 {
            let text = format!("tolerance = 1e-{digits}\n{text}");
            let found = against::events_of_slipmap(&text, 250.0);
            assert_eq!(found.len(), exact.len());
            for (one, other) in found.iter().zip(&exact) {
                // What rounding leaves grows over the sticks, as tolerances do.
                let allowed = 1e3 * 0.1_f64.powi(digits) + 1e-10;
                let off = (one.1 - other.1).abs();
                assert!(
                    one.0 == other.0 && off < allowed,
                    "{one:?} {other:?} at 1e-{digits}\n{text}"
                );
            }
        }
    }
}

/// The motions by chance have events of all kinds, laws and controls of all kinds.
#[test]
fn chance_leaves_nothing_out() {
    let mut counts = std::collections::BTreeMap::new();
    let mut count = |what: String| *counts.entry(what).or_insert(0) += 1;
    for number in 0..300 {
        let start = random::start(&mut Chance::of(seed(), number));
        let s = &start.setting;
        count(format!("{:?}", std::mem::discriminant(&s.friction.law)));
        count(format!("control {} {}", s.alpha_v != 0.0, s.alpha_n != 0.0));
        for (event, _) in against::events(&start, Pace::of(4.0)).0 {
            count(format!("{event:?}"));
        }
    }
    println!("{counts:?}");
    // Four laws, three controls, five events.
    assert_eq!(counts.len(), 12);
    assert!(counts.values().all(|n| *n >= 10), "{counts:?}");
}

/// Starts of basins of attraction, over states and over phases: what becomes of each, under velocity
/// and load control.
#[test]
fn starts_of_basins() {
    let mut starts = Vec::new();
    for (alpha_v, alpha_n, tau, v0) in [
        (-0.33, 0.0, 4.15, 0.35),
        (0.0, -10.0, 0.5, 0.1),
        (0.0, -7.0, 1.0, 0.118),
        (-0.33, 0.0, 4.15, 0.3),
    ] {
        let setting = Setting::plain(Friction::of_letter(), (alpha_v, alpha_n), tau, v0);
        for over in ["state", "phase"] {
            let sweep = format!(
                "fields = [\"basin_share\"]\n[axes]\nmass = [1]\n[basin]\nover = \"{over}\"\n\
                 starts = 64\n{}",
                asked::law_and_parameters(&setting)
            );
            let plan = Plan::new(sweep.parse().unwrap()).unwrap();
            let basin = plan.spec.basin.unwrap();
            let followed = Followed::of(
                &plan.setting(&[0]),
                &plan.spec.simulation,
                &basin,
                (2, &Arc::default()),
            );
            for (_, start, outcome) in followed.unwrap().starts().step_by(2) {
                starts.push((setting.clone(), over, start, outcome));
            }
        }
    }
    let tally = ask("starts of basins", starts.len(), |number| {
        let (setting, over, [first, second], outcome) = &starts[number];
        let (setting, pace) = (setting.clone(), Pace::of(2.0));
        let of_state = |setting| {
            let mut block = Block::at_rest_or_sliding(setting, pace, *first, *second);
            Some(switch_on::after(&mut block, 400.0))
        };
        let referee = match *over {
            "phase" => switch_on::fate(&setting, pace, *first, 40.0),
            _ => of_state(setting),
        };
        match (referee, against::fate_of(*outcome)) {
            (Some(one), Some(other)) if one == other => Verdict::Agree(1),
            (Some(one), Some(other)) => {
                Verdict::Differ(format!("{one:?}, {other:?}: {:?}", starts[number]))
            }
            _ => Verdict::Undecided,
        }
    });
    holds(&tally, 0.0, 0.02);
    let ends = |outcome| starts.iter().filter(|start| start.3 == outcome).count();
    let [sliding, sticking, lifting] =
        [Outcome::Sliding, Outcome::StickSlip, Outcome::LiftOff].map(ends);
    assert!(
        sliding > 80 && sticking > 10 && lifting > 20,
        "{sliding} {sticking} {lifting}"
    );
}

/// What slipmap claims of the critical velocity, against two ramps of v0.
#[test]
fn critical_velocities_by_chance() {
    let total = tenth_of_cases(60);
    let tally = ask("critical velocities", total, |number| {
        against::velocity(&random::problem(&mut Chance::of(seed(), number)))
    });
    holds(&tally, 0.1, 0.2);
}

/// The same with memory, latency or both in the feedback: the referee takes ten seconds for one, and
/// minutes where delays are long.
#[test]
fn critical_velocities_with_memory_and_latency() {
    let total = tenth_of_cases(2);
    let tally = ask("critical velocities with memory", total, |number| {
        let mut chance = Chance::of(seed() ^ 0x5eed, number);
        against::velocity(&random::remembering_problem(&mut chance))
    });
    holds(&tally, 0.1, 0.2);
}

/// The same with one dashpot or both.
#[test]
fn critical_velocities_with_dashpots() {
    let total = tenth_of_cases(12);
    let tally = ask("critical velocities with dashpots", total, |number| {
        let mut chance = Chance::of(seed() ^ 0xda50, number);
        against::velocity(&random::damped_problem(&mut chance))
    });
    holds(&tally, 0.1, 0.2);
}

/// The same with limits of actuators, and here and there dashpots.
#[test]
fn critical_velocities_with_limits() {
    let total = tenth_of_cases(12);
    let tally = ask("critical velocities with limits", total, |number| {
        let mut chance = Chance::of(seed() ^ 0x11317c, number);
        against::velocity(&random::limited_problem(&mut chance))
    });
    holds(&tally, 0.1, 0.2);
}

/// The same with friction laws that are formulas.
#[test]
fn critical_velocities_by_formulas() {
    let total = tenth_of_cases(12);
    let tally = ask("critical velocities by formulas", total, |number| {
        let mut chance = Chance::of(seed() ^ 0xf0fc, number);
        against::velocity(&random::problem_by_formula(&mut chance))
    });
    holds(&tally, 0.1, 0.2);
}

/// What becomes of stick-slip when control is switched on at a phase.
#[test]
fn switching_on_by_chance() {
    let total = tenth_of_cases(60);
    let tally = ask("phases of switch-on", total, |number| {
        let (setting, phase) = random::phase(&mut Chance::of(seed(), number));
        against::fate(&setting, phase)
    });
    holds(&tally, 0.1, 0.2);
}

/// The same with one dashpot or both, and limits.
#[test]
fn switching_on_of_a_rig() {
    let total = tenth_of_cases(30);
    let tally = ask("phases of switch-on of a rig", total, |number| {
        let (setting, phase) = random::rig_phase(&mut Chance::of(seed() ^ 0x419, number));
        against::fate(&setting, phase)
    });
    holds(&tally, 0.1, 0.2);
}

/// Event times of the table, by slipmap at its default tolerance and by this referee.
#[test]
fn motions_of_the_reference() {
    let motions = tables::motions();
    assert_eq!(motions.len(), 60);
    let events = motions
        .iter()
        .map(|(start, events)| (start, events.as_slice()));
    assert_eq!(wrong_events(events), [0, 0], "of slipmap and the referee");
}

/// In how many motions events differ from those expected by more than 1e-7: by slipmap at its
/// default tolerance, and by this referee.
fn wrong_events<'a>(motions: impl Iterator<Item = (&'a Start, &'a [Happened])>) -> [usize; 2] {
    let mut wrong = [0; 2];
    for (start, expected) in motions {
        let text = asked::case_file(start);
        let slipmap = against::events_of_slipmap(&text, start.horizon);
        let (referee, _) = against::events(start, Pace::of(0.5));
        for (who, found) in [slipmap, referee].into_iter().enumerate() {
            let differs = |(a, b): (&Happened, &Happened)| a.0 != b.0 || (a.1 - b.1).abs() > 1e-7;
            let pairs = expected.iter().zip(&found);
            if found.len() < expected.len() || pairs.into_iter().any(differs) {
                println!(
                    "{}\n# {found:?}, expected {expected:?}",
                    asked::simulate_command(&text)
                );
                wrong[who] += 1;
            }
        }
    }
    wrong
}

/// Events and last states of the motions of `rig_motions.csv`, with dashpots and limits.
#[test]
fn motions_of_a_rig() {
    rig(&tables::rig_motions(), 60);
}

/// The same of `rig_held.csv`, whose elongation is read at equal times and held in between.
#[test]
fn held_motions_of_a_rig() {
    rig(&tables::held_motions(), 40);
}

fn rig(motions: &[tables::RigMotion], number: usize) {
    assert_eq!(motions.len(), number);
    for (start, events, (a, x_dot)) in motions {
        if events.iter().any(|(event, _)| *event == Event::LiftOff) {
            continue;
        }
        let text = asked::case_file(start);
        let found = against::last_state_of_slipmap(&text, start.horizon);
        let off = (found.0 - a).abs().max((found.1 - x_dot).abs());
        assert!(off < 1e-7, "{found:?}\n{}", asked::simulate_command(&text));
    }
    let events = motions
        .iter()
        .map(|(start, events, _)| (start, events.as_slice()));
    let wrong = wrong_events(events);
    assert_eq!(wrong, [0, 0], "of slipmap and the referee");
}

/// Critical velocities of `rig_vc.csv`, with dashpots and limits.
#[test]
fn critical_velocities_of_a_rig() {
    let velocities = tables::rig_velocities();
    assert_eq!(velocities.len(), 30);
    let tally = ask("critical velocities of a rig", 30, |row| {
        let (setting, expected) = &velocities[row];
        against::known_velocity(setting, *expected)
    });
    holds(&tally, 0.0, 0.15);
}

/// Critical velocities of the table, by slipmap and by this referee.
#[test]
fn critical_velocities_of_the_reference() {
    let velocities = tables::velocities();
    assert_eq!(velocities.len(), 54);
    let tally = ask("critical velocities of the table", 54, |row| {
        let (setting, expected) = &velocities[row];
        against::known_velocity(setting, *expected)
    });
    holds(&tally, 0.0, 0.15);
}

/// What becomes of stick-slip in the table's settings, followed alone, as a cell of a map and as in
/// a scan of v0, and by this referee.
#[test]
fn switching_on_of_the_reference() {
    let fates = tables::fates();
    assert_eq!(fates.len(), 80);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.h5");
    let mut wrong = [0; 4];
    for (setting, phase, expected) in &fates {
        let text = asked::phase_file(setting, *phase);
        let alone = against::fate_of_slipmap(&text);
        let cell = cell(setting, *phase, &path);
        let referee = switch_on::fate(setting, Pace::of(2.0), *phase, 60.0);
        let trial = against::fate_of_trial(setting, *phase);
        for (who, found) in [alone, cell, trial, referee].into_iter().enumerate() {
            if found != Some(*expected) {
                println!(
                    "{}\n# {found:?}, expected {expected:?}",
                    asked::simulate_command(&text)
                );
                wrong[who] += 1;
            }
        }
    }
    assert_eq!(
        wrong, [0; 4],
        "of slipmap alone, in a map, in a scan; of the referee"
    );
}

/// The one cell of a map of outcomes.
fn cell(setting: &Setting, phase: f64, path: &std::path::Path) -> Option<Fate> {
    let sweep = format!(
        "fields = [\"outcome\"]\n[axes]\nswitch_on_phase = [{phase:?}]\n{}",
        asked::law_and_parameters(setting)
    );
    let plan = Plan::new(sweep.parse().unwrap()).unwrap();
    map::write(&plan, 1, path);
    map::settle(path);
    let file = hdf5::File::open(path).unwrap();
    let numbers = file.dataset("outcome").unwrap().read_raw::<u8>().unwrap();
    against::fate_of(Outcome::ALL[usize::from(numbers[0])])
}
