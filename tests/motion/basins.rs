//! Maps of motions: outcomes at phases of switch-on against known velocities, cells against
//! `simulate`, threads, mistakes.

use std::path::Path;

use crate::program::{self, Folder, err, expect, out};
use slipmap::model::{Dashpots, Feedback, FrictionLaw};
use slipmap::setting::SweepSpec;
use slipmap::slip::cycle::after_release;
use slipmap::slip::motion::{Accuracy, Parameters};
use slipmap::slip::outcome::{Limits, Outcome};
use slipmap::slip::watch::{REPEATED, follow};
use slipmap::sweep::Plan;

use crate::map::write;

const LAW: &str = "[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";

fn outcomes(path: &Path) -> Vec<Outcome> {
    let file = hdf5::File::open(path).unwrap();
    let numbers = file.dataset("outcome").unwrap().read_raw::<u8>().unwrap();
    let outcome = |n: u8| Outcome::ALL[usize::from(n)];
    numbers.into_iter().map(outcome).collect()
}

/// The topmost velocities at which stick-slip survives that control is switched on so long after a
/// release.
#[test]
fn stick_slip_ends_at_the_known_velocities() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.h5");
    for (phase, v_c) in [
        (0.0, 0.233773),
        (0.05, 0.239537),
        (0.2, 0.260146),
        (0.3, 0.276639),
        (1.0, 0.344467),
    ] {
        let text = format!(
            "fields = [\"outcome\"]\n[axes]\nv0 = [{}, {}]\nswitch_on_phase = [{phase}]\n\
             [fixed]\nalpha_v = -0.33\ntau = 4.15\n{LAW}",
            v_c - 2e-6,
            v_c + 2e-6
        );
        write(&Plan::new(text.parse().unwrap()).unwrap(), 1, &path);
        let found = outcomes(&path);
        assert_eq!(found, [Outcome::StickSlip, Outcome::Sliding], "{phase}");
    }
}

/// Switched on when the block stops, stick-slip is lost, comes back and is lost again as v0 grows.
#[test]
fn survival_at_the_stop_phase_is_reentrant() {
    let survives = |v0: f64| {
        let p = Parameters {
            law: FrictionLaw::weakening(0.5, 0.5, 1.0).unwrap(),
            velocity_unit: 1.0,
            dashpots: Dashpots::default(),
            feedback: Feedback::new(-0.33, 0.0, 4.15),
            v0,
            switch_on: 0.0,
        };
        let accuracy = Accuracy::default();
        let (_, cycle) = after_release(&p, accuracy, 0.0).unwrap();
        let (mut motion, _) = after_release(&p, accuracy, cycle.slip_time).unwrap();
        let limits = Limits {
            horizon: 3000.0,
            steps: 1_000_000,
            stable_abscissa: Some(-0.01),
            repeated: REPEATED,
            cycles: usize::MAX,
        };
        follow(&mut motion, &limits, &mut ()).outcome == Outcome::StickSlip
    };
    for (v0, below) in [(0.26695, true), (0.27661, false), (0.344467, true)] {
        assert_eq!(survives(v0 - 1e-5), below, "below {v0}");
        assert_eq!(survives(v0 + 1e-5), !below, "above {v0}");
    }
}

/// Axes of starts first, last and beside delays; in physical units; with roots beside the motions.
const SWEEPS: [&str; 3] = [
    "fields = [\"outcome\", \"settle_time\", \"last_release\", \"n_min\", \"peak_force\"]\n[axes]\na0 = { from = -0.6, to = 2, points = 19 }\n\
     x_dot0 = { from = -1, to = 1.5, points = 17 }\n[fixed]\nv0 = 0.118\nalpha_n = -7\ntau = 1\n",
    "fields = [\"n_unstable\", \"abscissa\", \"outcome\", \"n_min\"]\n[axes]\nx_dot0 = [0.05, 0.3]\ntau = { from = 0.3, to = 1.2, points = 7 }\n\
     a0 = [0.2, 0.9]\n[fixed]\nv0 = 0.2\nalpha_n = -12\nmass = 4\nstiffness = 2\nnormal_load = 3\n",
    "fields = [\"outcome\", \"peak_force\"]\n[axes]\ntau = [1.0, 4.15, 9]\nv0 = [0.2, 0.3]\n[start]\nswitch_on_phase = 13.5\n\
     [fixed]\nalpha_v = -0.33\n[simulation]\nhorizon = 400\ntolerance = 1e-10\n",
];

#[test]
fn every_cell_is_what_simulate_says() {
    let folder = Folder::new();
    let map = folder.path().join("map.h5");
    for text in SWEEPS {
        let text = format!("{text}{LAW}");
        let plan = Plan::new(text.parse().unwrap()).unwrap();
        write(&plan, 2, &map);
        let found = outcomes(&map);
        let status = hdf5::File::open(&map).unwrap();
        let status = status.dataset("status").unwrap().read_raw::<u8>().unwrap();
        // Some cells, spread over the map: each is a run of the program.
        for cell in (0..found.len()).step_by(found.len().div_ceil(12)) {
            let case = case_of(&plan, cell);
            std::fs::write(folder.path().join("case.toml"), &case).unwrap();
            let said = folder.run(&["simulate", "case.toml", "--json", "--fresh"]);
            assert_eq!(err(&said), "", "{case}");
            let said = program::json(&said);
            assert_eq!(said["outcome"], found[cell].name(), "{case}");
            assert_eq!(status[cell] & 4 != 0, found[cell] == Outcome::Undecided);
            for field in plan.spec.fields.iter().filter(|f| f.of_motion()) {
                let Some(expected) = said.get(field.name()).filter(|v| !v.is_string()) else {
                    continue;
                };
                let file = hdf5::File::open(&map).unwrap();
                let cells = file.dataset(field.name()).unwrap();
                let value = cells.read_raw::<f64>().unwrap()[cell];
                // JSON is read to the last bit but one.
                let expected = expected.as_f64().unwrap_or(f64::NAN);
                let near = (expected - value).abs() <= 1e-15 * value.abs();
                assert!(near || expected.is_nan() && value.is_nan(), "{case}");
            }
        }
    }
}

/// The case file of a cell.
fn case_of(plan: &Plan, mut cell: usize) -> String {
    let mut index = vec![0; plan.shape().len()];
    for axis in (0..index.len()).rev() {
        index[axis] = cell % plan.shape()[axis];
        cell /= plan.shape()[axis];
    }
    let setting = plan.setting(&index);
    let (mut fixed, mut start) = (String::new(), String::new());
    for p in slipmap::setting::Parameter::ALL {
        if setting.uses(p) && !p.of_friction_law() {
            let table = if p.of_start() { &mut start } else { &mut fixed };
            *table += &format!("{} = {:?}\n", p.name(), setting.get(p));
        }
    }
    let how = &plan.spec.simulation;
    let horizon = how.horizon.map(|h| format!("horizon = {h:?}\n"));
    format!(
        "{}tolerance = {:?}\n{LAW}[fixed]\n{fixed}[start]\n{start}",
        horizon.unwrap_or_default(),
        how.tolerance
    )
}

#[test]
fn maps_do_not_depend_on_threads_or_tiles() {
    let folder = tempfile::tempdir().unwrap();
    let [one, two] = ["one.h5", "two.h5"].map(|name| folder.path().join(name));
    for text in SWEEPS {
        let spec: SweepSpec = format!("{text}{LAW}").parse().unwrap();
        let plan = Plan::new(spec.clone()).unwrap();
        write(&plan, 1, &one);
        for (threads, cells) in [(2, 256), (2, 5)] {
            write(
                &Plan::with_tiles_of(cells, spec.clone()).unwrap(),
                threads,
                &two,
            );
            for field in plan.spec.fields.iter().map(|f| f.name()).chain(["status"]) {
                let bits = |path: &Path| {
                    let file = hdf5::File::open(path).unwrap();
                    let cells = file.dataset(field).unwrap();
                    match cells.dtype().unwrap().size() {
                        1 => cells
                            .read_raw::<u8>()
                            .unwrap()
                            .into_iter()
                            .map(u64::from)
                            .collect(),
                        2 => cells
                            .read_raw::<u16>()
                            .unwrap()
                            .into_iter()
                            .map(u64::from)
                            .collect(),
                        _ => cells
                            .read_raw::<f64>()
                            .unwrap()
                            .into_iter()
                            .map(f64::to_bits)
                            .collect::<Vec<_>>(),
                    }
                };
                assert_eq!(bits(&one), bits(&two), "{field}");
            }
        }
    }
}

/// A delay of more cycles than can be followed.
#[test]
fn cells_that_cannot_start_are_undecided() {
    let text = format!(
        "fields = [\"outcome\", \"n_min\"]\n[axes]\nv0 = [0.1, 0.2]\nswitch_on_phase = [0.1, 0.4]\n\
         [fixed]\nalpha_v = -0.33\ntau = 1e9\n{LAW}"
    );
    let folder = Folder::with(&[("sweep.toml", &text)]);
    expect(&folder.run(&["run", "sweep.toml"]), 0, "sweep.h5: 4 cells");
    let info = out(&folder.run(&["info", "sweep.h5"]));
    let holds = |says: &str| assert!(info.contains(says), "{says}\n{info}");
    holds("4 undecided");
    holds("4 without a value");
    holds("not_converged  4 cells");
}

#[test]
fn mistakes_are_shown_in_place() {
    let folder = Folder::new();
    let fixed = "[fixed]\nalpha_v = 1\ntau = 1\n";
    let mut shown = String::new();
    for text in [
        "fields = [\"n_min\", \"outcome\"]\n[axes]\nx_dot0 = [1]\n[fixed]\nmu_prime = 1\ntau = 1\n"
            .to_owned(),
        format!(
            "fields = [\"outcome\"]\n[axes]\nv0 = [1]\n[start]\nx_dot0 = 1\nswitch_on_phase = 1\n{fixed}{LAW}"
        ),
        format!(
            "fields = [\"outcome\"]\n[axes]\nv0 = [1]\ntau = [0, 1]\n[fixed]\nalpha_n = 1\n{LAW}"
        ),
        format!("[axes]\nv0 = [1]\nx_dot0 = [1, 2]\n{fixed}{LAW}"),
        format!(
            "fields = [\"outcome\"]\n[axes]\nv0 = [1]\nswitch_on_phase = [-1, 2]\n{fixed}{LAW}"
        ),
        format!(
            "fields = [\"outcome\"]\n[axes]\nv0 = [1]\nswitch_on_phase = [1, 9]\n[simulation]\nhorizon = 5\n{fixed}{LAW}"
        ),
        format!(
            "fields = [\"outcome\"]\n[axes]\nv0 = [1]\n[simulation]\nhorizons = 5\n{fixed}{LAW}"
        ),
        format!("fields = [\"outcome\"]\n[axes]\nv0 = [1]\n[simulation]\nsteps = 0\n{fixed}{LAW}"),
    ] {
        std::fs::write(folder.path().join("sweep.toml"), text).unwrap();
        let output = folder.run(&["run", "sweep.toml"]);
        assert_eq!(output.status.code(), Some(2));
        shown += &err(&output);
    }
    let case = format!(
        "switch_on = 3.0\n{LAW}[fixed]\nv0 = 0.1\nalpha_v = 1\ntau = 1\n[start]\nswitch_on_phase = 1\n"
    );
    std::fs::write(folder.path().join("case.toml"), case).unwrap();
    let output = folder.run(&["simulate", "case.toml"]);
    assert_eq!(output.status.code(), Some(2));
    shown += &err(&output);
    insta::assert_snapshot!("mistakes", shown);
}
