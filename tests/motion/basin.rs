//! Shares of starts that end in sliding: against closed forms, fine grids and pinned values; maps
//! of them; mistakes.

use std::path::Path;
use std::sync::Arc;

use crate::map::write;
use crate::program::{self, Folder, err, expect, out};
use serde_json::Value;
use slipmap::answers::basin::{STUDENT_95, UNSEEN_95};
use slipmap::explore::basin::{BasinShare, Followed};
use slipmap::setting::{Field, SweepSpec};
use slipmap::slip::outcome::Outcome;
use slipmap::sweep::Plan;
use slipmap::sweep::cells::second_look::{Answer, Question, Stored, second_look};
use slipmap::sweep::events::Attended;
use slipmap::sweep::grid::Grid;

const LAW: &str = "[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";
const FLAGS: [&str; 6] = ["--friction", "weakening", "--mu0", "0.5", "--v-s", "0.5"];
const FIG3A: [&str; 6] = ["--v0", "0.35", "--alpha-v", "-0.33", "--tau", "4.15"];
const FIG3B: [&str; 6] = ["--v0", "0.1", "--alpha-n", "-10", "--tau", "0.5"];

fn plan(text: &str) -> Plan {
    Plan::new(text.parse::<SweepSpec>().unwrap()).unwrap()
}

/// The share in the one cell of a sweep, with all starts.
fn share(text: &str) -> BasinShare {
    let plan = plan(text);
    let basin = plan.spec.basin.unwrap();
    let setting = plan.setting(&vec![0; plan.shape().len()]);
    BasinShare::of(
        &Followed::of(
            &setting,
            &plan.spec.simulation,
            &basin,
            (2, &Arc::default()),
        )
        .unwrap(),
    )
}

fn json(folder: &Folder, args: &[&str]) -> Value {
    let output = folder.run(&[&["basin", "--json"], args].concat());
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    program::json(&output)
}

/// A block without control on friction that grows with the speed, μ_K = μ0 + c v: its slip is a
/// linear oscillation, so the starts that never stick are those inside of the one that touches
/// ẋ = 0 at a = μ0, followed backwards to ẋ = 0. All others stick, and go on sticking since μ_S lies
/// above where that began.
#[test]
fn a_linear_law_has_its_known_share() {
    let (v0, mu0, c) = (0.5_f64, 0.4, 0.05_f64);
    let (from, to) = ([-0.4, 1.6], [0.0, 1.2]);
    // ẋ − v0 = u, a − μ0 − c v0 = b: u' = b − c u, b' = −u, from u = −v0, b = −c v0.
    let (half, omega) = (0.5 * c, (1.0 - 0.25 * c * c).sqrt());
    let b_at = |t: f64| {
        // b'' + c b' + b = 0 with b(0) = −c v0, b'(0) = v0.
        let (first, second) = (-c * v0, (v0 - half * c * v0) / omega);
        (-half * t).exp() * (first * (omega * t).cos() + second * (omega * t).sin())
    };
    let u_at = |t: f64| -(b_at(t + 1e-6) - b_at(t - 1e-6)) / 2e-6;
    // Backwards until u = −v0 again, by bisection; beyond half a period of oscillation.
    let (mut short, mut long) = (3.5_f64, 6.2_f64);
    for _ in 0..60 {
        let middle = 0.5 * (short + long);
        match u_at(-middle) > -v0 {
            true => short = middle,
            false => long = middle,
        }
    }
    let highest = mu0 + c * v0 + b_at(-short);
    assert!(highest > mu0 && highest < 0.95, "{highest}");
    // The area between the path and ẋ = 0, which lies on its left going backwards: ∫ (ẋ) da.
    let steps = 200_000;
    let step = short / f64::from(steps);
    let area: f64 = (0..steps)
        .map(|i| {
            let (t, next) = (-step * f64::from(i), -step * f64::from(i + 1));
            (v0 + u_at(0.5 * (t + next))) * (b_at(next) - b_at(t))
        })
        .sum::<f64>()
        .abs();
    let exact = area / ((from[1] - from[0]) * (to[1] - to[0]));
    for starts in [256, 4096, 32768] {
        let found = share(&format!(
            "fields = [\"basin_share\"]\n[axes]\nv0 = [{v0}]\n[basin]\nstarts = {starts}\n\
             a0 = {{ from = {}, to = {} }}\nx_dot0 = {{ from = {}, to = {} }}\n[friction]\n\
             law = \"table\"\nspeeds = [0.0, 10.0]\nmu_k = [{mu0}, {}]\n[fixed]\ntau = 0.0\n",
            from[0],
            from[1],
            to[0],
            to[1],
            mu0 + 10.0 * c
        ));
        let [low, high] = found.interval.unwrap();
        let error = found.basin_share_error;
        // Of three intervals each may miss by its half again once in 200 times.
        let beyond = (found.basin_share - exact).abs();
        assert!(beyond < 1.5 * STUDENT_95 * error, "{exact} {found:?}");
        assert!(high - low < 5.0 * error && found.basin_share == found.basin_share_upper);
        // By chance the error would be √(p(1 − p)/N).
        let by_chance = (exact * (1.0 - exact) / f64::from(starts)).sqrt();
        assert!(
            error
                < [0.9, 0.5, 0.4][usize::from(starts > 256) + usize::from(starts > 4096)]
                    * by_chance
        );
        let stuck = found
            .outcomes
            .iter()
            .find(|of| of.outcome == "stick-slip")
            .unwrap();
        assert!((stuck.share + found.basin_share - 1.0).abs() < 1e-12);
    }
}

/// The letter's "quite large": all states and phases of its Fig. 3(a); of Fig. 3(b) those from which
/// the block does not lift off.
#[test]
fn shares_of_the_letters_figure_3() {
    let folder = Folder::new();
    let found = |figure: &[&str], over: &str| {
        let told = json(&folder, &[&FLAGS, figure, &["--over", over]].concat());
        assert_eq!(told["basin_share"], told["basin_share_upper"], "{told}");
        let number = |key: &str| told[key].as_f64().unwrap();
        (number("basin_share"), number("basin_share_error"))
    };
    let one = 1.0 / 4096.0;
    // All agree: 95 % confidence holds what none of so many starts may lie in.
    for over in ["state", "phase"] {
        let (share, error) = found(&FIG3A, over);
        let unseen = STUDENT_95 * error;
        assert!(
            share == 1.0 && (unseen - UNSEEN_95 * one).abs() < 1e-12,
            "{error}"
        );
    }
    // One start or two may change sides where a boundary is computed a little differently.
    let near = |(share, error): (f64, f64), told: (f64, f64)| {
        let off = ((share - told.0).abs(), (error - told.1).abs());
        assert!(off.0 < 2.5 * one && off.1 < 0.5 * one, "{share} {error}");
    };
    near(found(&FIG3B, "state"), (0.69556, 0.00091));
    near(found(&FIG3B, "phase"), (0.92847, 0.00059));
}

/// The same starts by a grid of their outcomes, as in `sweeps/basin_load.toml`.
#[test]
fn a_share_is_that_of_a_map_of_outcomes() {
    let (points, law) = (96, LAW);
    let fixed = "[fixed]\nv0 = 0.118\nalpha_n = -7.0\ntau = 1.0\n";
    // Midpoints of equal parts of the ranges −0.6 to 2 and −1 to 1.5.
    let axis = |name: &str, from: f64, to: f64| {
        let half = 0.5 * (to - from) / f64::from(points);
        let (first, last) = (from + half, to - half);
        format!("{name} = {{ from = {first:?}, to = {last:?}, points = {points} }}\n")
    };
    let (a0, x_dot0) = (axis("a0", -0.6, 2.0), axis("x_dot0", -1.0, 1.5));
    let grid = plan(&format!(
        "fields = [\"outcome\"]\n[axes]\n{a0}{x_dot0}{fixed}{law}"
    ));
    let grid = Grid::compute(&Arc::new(grid), 2, Attended::silently(&Arc::default())).unwrap();
    let ends = &grid.cells.kinds[0].cells;
    let found = share(&format!(
        "fields = [\"basin_share\"]\n[axes]\nmass = [1.0]\n{fixed}{law}[basin]\nstarts = 8192\n\
         a0 = {{ from = -0.6, to = 2.0 }}\nx_dot0 = {{ from = -1.0, to = 1.5 }}\n"
    ));
    for of in &found.outcomes {
        let outcome = Outcome::ALL
            .into_iter()
            .find(|o| o.name() == of.outcome)
            .unwrap();
        let cells: u32 = ends
            .iter()
            .map(|end| u32::from(*end == outcome as u8))
            .sum();
        let share = f64::from(cells) / ends.len() as f64;
        // A grid errs by some part of a cell along every boundary.
        let allowed = STUDENT_95 * of.error + 0.3 / f64::from(points);
        assert!((share - of.share).abs() < allowed, "{share} {of:?}");
    }
    assert!((0.3..0.7).contains(&found.basin_share), "{found:?}");
}

#[test]
fn threads_change_no_byte_and_starts_are_told() {
    let folder = Folder::new();
    let args = |threads: &'static str, name: &'static str| {
        let more = ["--starts", "256", "--threads", threads, "-o", name];
        [&["basin"], &FLAGS[..], &FIG3B, &more].concat()
    };
    let [one, four] = [args("1", "one.csv"), args("4", "four.csv")].map(|a| folder.run(&a));
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    assert_eq!(read("one.csv"), read("four.csv"));
    insta::assert_snapshot!("basin", out(&one));
    assert_eq!(out(&one).replace("one.csv", "four.csv"), out(&four));
    let text = read("one.csv");
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows[0], ["scrambling", "x_dot0", "a0", "outcome"]);
    assert_eq!(rows.len(), 257);
    let sliding = rows.iter().filter(|row| row[3] == "sliding").count();
    let share = format!("{:.4} ±", sliding as f64 / 256.0);
    assert!(out(&one).contains(&share), "{share}");
    // Each start is a case of its own.
    for row in rows[1..].iter().step_by(37) {
        let case = format!(
            "{LAW}[fixed]\nv0 = 0.1\nalpha_n = -10\ntau = 0.5\n[start]\nx_dot0 = {}\na0 = {}\n",
            row[1], row[2]
        );
        std::fs::write(folder.path().join("case.toml"), case).unwrap();
        let said = folder.run(&["simulate", "case.toml", "--json", "--fresh"]);
        let said = program::json(&said);
        assert_eq!(said["outcome"], row[3]);
    }
    let phases = [&["basin"], &FLAGS[..], &FIG3B, &["--over", "phase"]].concat();
    let shown = out(&folder.run(&[&phases[..], &["--starts", "64", "-o", "p.csv"]].concat()));
    insta::assert_snapshot!("basin_over_phases", shown);
    assert!(read("p.csv").starts_with("scrambling,switch_on_phase,outcome\n0,"));
}

/// What is not decided is not counted as sliding, nor left out.
#[test]
fn undecided_starts_are_told() {
    let folder = Folder::new();
    let told = json(
        &folder,
        &[&FLAGS[..], &FIG3A, &["--starts", "64", "--horizon", "50"]].concat(),
    );
    assert_eq!(
        (&told["basin_share"], &told["basin_share_upper"]),
        (&0.0.into(), &1.0.into())
    );
    assert_eq!(told["interval"], serde_json::json!([0.0, 1.0]));
    assert_eq!(told["inputs"]["horizon"], 50.0);
    let text = format!(
        "fields = [\"basin_share\"]\n[axes]\ntau = [4.15, 5.5]\n{LAW}[fixed]\nv0 = 0.35\n\
         alpha_v = -0.33\n[basin]\nstarts = 64\n[simulation]\nhorizon = 50.0\n"
    );
    let grid = Grid::compute(
        &Arc::new(plan(&text)),
        1,
        Attended::silently(&Arc::default()),
    )
    .unwrap();
    let cells: Vec<_> = grid.cells.columns.iter().map(|c| c.cells.clone()).collect();
    // At τ = 5.5 sliding is unstable, whatever is undecided.
    let error = UNSEEN_95 / STUDENT_95 / 64.0;
    assert_eq!(cells, [vec![0.0, 0.0], vec![error, 0.0], vec![1.0, 0.0]]);
    assert_eq!(grid.cells.status, [4, 0]);
}

/// Without uncontrolled stick-slip there is nothing to switch on in; a delay of too many cycles
/// cannot be followed.
#[test]
fn cells_without_a_cycle_have_no_share() {
    // Released at μ_S N0/κ, friction that grows with the speed lets the block stick again or not.
    let text = |mu_s: &str, tau: &str| {
        format!(
            "fields = [\"basin_share\"]\n[axes]\nv0 = [0.3]\n[basin]\nover = \"phase\"\n\
             [fixed]\nalpha_n = -0.5\ntau = {tau}\n[friction]\nlaw = \"table\"\n\
             speeds = [0.0, 10.0]\nmu_k = [0.4, 6.4]\nmu_s = {mu_s}\n"
        )
    };
    let grid = Grid::compute(
        &Arc::new(plan(&text("0.45", "1.0"))),
        1,
        Attended::silently(&Arc::default()),
    )
    .unwrap();
    assert!(
        grid.cells
            .columns
            .iter()
            .all(|column| column.cells[0].is_nan())
    );
    assert_eq!(grid.cells.status, [0]);
    let told = share(&text("0.45", "1.0"));
    assert!(told.basin_share.is_nan());
    assert_eq!((told.interval, told.starts), (None, 0));
    let sticks = share(&text("9.0", "1.0"));
    assert!(sticks.period.unwrap() > 20.0 && sticks.starts == 256);
    let grid = Grid::compute(
        &Arc::new(plan(&text("9.0", "1e9"))),
        1,
        Attended::silently(&Arc::default()),
    )
    .unwrap();
    let cells: Vec<_> = grid.cells.columns.iter().map(|c| c.cells[0]).collect();
    assert_eq!(
        (&cells[..], grid.cells.status[0]),
        (&[0.0, 0.0, 1.0][..], 4)
    );
}

/// Both kinds of starts, with fields of linear stability, in physical units.
fn sweeps() -> [String; 2] {
    [
        format!(
            "fields = [\"basin_share\", \"n_unstable\"]\n[axes]\n\
             tau = {{ from = 0.3, to = 1.2, points = 4 }}\nalpha_n = [-12.0, -7.0, -2.0]\n\
             [fixed]\nv0 = 0.11\nmass = 4.0\nstiffness = 2.0\nnormal_load = 3.0\n\
             [basin]\nstarts = 64\nx_dot0 = {{ from = 0.0, to = 0.5 }}\n{LAW}"
        ),
        format!(
            "fields = [\"basin_share\"]\n[axes]\nv0 = [0.08, 0.12, 0.3]\ntau = [0.5, 1.0]\n\
             [fixed]\nalpha_n = -7.0\n[basin]\nover = \"phase\"\nstarts = 64\n{LAW}"
        ),
    ]
}

#[test]
fn maps_do_not_depend_on_threads_or_tiles() {
    let folder = tempfile::tempdir().unwrap();
    let [one, two] = ["one.h5", "two.h5"].map(|name| folder.path().join(name));
    let bits = |path: &Path, name: &str| -> Vec<u64> {
        let cells = hdf5::File::open(path).unwrap().dataset(name).unwrap();
        let cells = cells.read_raw::<f64>().unwrap();
        cells.into_iter().map(f64::to_bits).collect()
    };
    for text in sweeps() {
        let spec: SweepSpec = text.parse().unwrap();
        write(&Plan::new(spec.clone()).unwrap(), 1, &one);
        for (threads, cells) in [(2, 1), (2, 5)] {
            write(
                &Plan::with_tiles_of(cells, spec.clone()).unwrap(),
                threads,
                &two,
            );
            for name in ["basin_share", "basin_share_error", "basin_share_upper"] {
                assert_eq!(bits(&one, name), bits(&two, name), "{name}");
            }
        }
    }
}

/// A cell of a map is what the command says; second methods agree, and see what is wrong.
#[test]
fn cells_of_maps_are_checked() {
    for (text, at) in sweeps()
        .into_iter()
        .zip([["tau=0.6", "alpha_n=-7"], ["v0=0.3", "tau=1"]])
    {
        let folder = Folder::with(&[("sweep.toml", &text)]);
        let plan = plan(&text);
        expect(&folder.run(&["run", "sweep.toml"]), 0, "sweep.h5");
        let told = out(&folder.run(&["info", "sweep.h5"]));
        assert!(told.contains("start ") && told.contains("64 "), "{told}");
        let verified = folder.run(&["verify", "sweep.h5"]);
        expect(
            &verified,
            0,
            "basin_share, by collocation from other starts",
        );
        assert!(out(&verified).contains("0 differ"), "{}", out(&verified));
        let cell = json(
            &folder,
            &["--map", "sweep.h5", "--at", at[0], "--at", at[1]],
        );
        let export = ["export", "sweep.h5", "--at", at[0], "--at", at[1]];
        let rows = out(&folder.run(&[&export[..], &["--field", "basin_share"]].concat()));
        let row: Vec<&str> = rows.lines().nth(1).unwrap().split(',').collect();
        let share = row[row.len() - 2].parse::<f64>().unwrap();
        assert_eq!(cell["basin_share"].as_f64(), Some(share), "{rows}");
        assert_eq!(cell["starts"], 64);
        let grid = Grid::compute(
            &Arc::new(plan.clone()),
            2,
            Attended::silently(&Arc::default()),
        )
        .unwrap();
        let mut wrong = 0;
        for number in 0..plan.cells() {
            let columns = plan.shape()[1] as u64;
            let index = [(number / columns) as usize, (number % columns) as usize];
            for (off, wanted) in [(0.0, Answer::Agrees), (0.6, Answer::Differs)] {
                let value = |field: Field| {
                    let column = grid.cells.columns.iter().find(|c| c.field == field);
                    let value = column.map_or(f64::NAN, |c| c.cells[number as usize]);
                    match field {
                        Field::BasinShareError => value,
                        _ if value < 0.5 => value + off,
                        _ => value - off,
                    }
                };
                let stored = Stored {
                    status: 0,
                    value: &value,
                };
                let answers = second_look(&plan, &index, &stored).unwrap();
                let of_share = answers.iter().find(|(q, _)| *q == Question::BasinShare);
                assert_eq!(of_share.unwrap().1, wanted, "{index:?} {off}");
                wrong += 1;
            }
        }
        assert!(wrong >= 12);
    }
}

#[test]
fn a_signal_ends_it() {
    let folder = Folder::new();
    let long = [&["basin"], &FLAGS[..], &FIG3A, &["--starts", "1048576"]].concat();
    let started = folder.start(&long);
    std::thread::sleep(std::time::Duration::from_millis(700));
    started.signal("-INT");
    let ended = started.ended();
    assert_eq!(ended.status.code(), Some(130));
    assert!(err(&ended).contains("interrupted: there is no share"));
}

#[test]
fn mistakes_are_shown_in_place() {
    let folder = Folder::new();
    let mut shown = String::new();
    let mut refused = |args: &[&str]| {
        let output = folder.run(args);
        assert_eq!(output.status.code(), Some(2), "{args:?} {}", err(&output));
        assert_eq!(out(&output), "");
        shown += &err(&output);
    };
    for more in [
        &["--starts", "0"][..],
        &["--starts", "1000"],
        &["--starts", "1e99"],
        &["--x-dot0-from", "nan"],
        &["--x-dot0-to", "1e300"],
        &["--a0-from", "2", "--a0-to", "1"],
        &["--a0-from", "2"],
        &["--over", "phase", "--a0-to", "1"],
        &["--over", "phases"],
        &["--horizon", "-1"],
        &["--horizon", "nan"],
        &["-o", "starts.txt"],
        &["--threads", "0"],
    ] {
        refused(&[&["basin"], &FLAGS[..], &FIG3A, more].concat());
    }
    refused(&["basin"]);
    refused(&["basin", "--mu-prime", "-0.3", "--tau", "1"]);
    refused(&[&["basin"], &FLAGS[..], &FIG3A[2..]].concat());
    refused(&[&["basin"], &FLAGS[..], &["--v0", "nan"]].concat());
    refused(&["basin", "--map", "none.h5"]);
    let fixed = "[fixed]\nalpha_v = -0.33\ntau = 4.15\n";
    let fields = "fields = [\"basin_share\"]\n[axes]\nv0 = [0.35]\n";
    let other = |fields: &str| format!("fields = [{fields}]\n[axes]\nv0 = [0.35]\n{fixed}{LAW}");
    for text in [
        "fields = [\"basin_share\"]\n[axes]\nmu_prime = [-0.3]\n[fixed]\ntau = 1\n".to_owned(),
        format!("fields = [\"basin_share\"]\n[axes]\nmass = [1]\n{fixed}{LAW}"),
        format!("{fields}{fixed}{LAW}[basin]\nstarts = 0\n"),
        format!("{fields}{fixed}{LAW}[basin]\nstart = 64\n"),
        format!("{fields}{fixed}{LAW}[basin]\nover = \"states\"\n"),
        format!("{fields}{fixed}{LAW}[basin]\na0 = {{ from = 1.0, to = 0.0 }}\n"),
        format!("{fields}{fixed}{LAW}[basin]\na0 = {{ from = 1.0 }}\n"),
        format!("{fields}{fixed}{LAW}[basin]\nx_dot0 = {{ from = 1.0, to = nan }}\n"),
        format!("{fields}{fixed}{LAW}[basin]\nx_dot0 = [0.0, 1.0]\n"),
        format!("{fields}{fixed}{LAW}[basin]\nover = \"phase\"\na0 = {{ from = 0, to = 1 }}\n"),
        format!("{fields}{fixed}{LAW}[start]\nx_dot0 = 1.0\n"),
        other("\"basin_share\", \"outcome\""),
        other("\"vc\", \"basin_share_upper\""),
        format!("{}[basin]\nstarts = 64\n", other("\"outcome\"")),
        format!("protocol = \"follow\"\n{fields}{fixed}{LAW}"),
        format!("{fields}{LAW}[fixed]\nalpha_v = -0.33\ntau = 0\n"),
    ] {
        std::fs::write(folder.path().join("sweep.toml"), text).unwrap();
        refused(&["run", "sweep.toml"]);
    }
    assert_eq!(folder.files(), ["sweep.toml"]);
    insta::assert_snapshot!("mistakes", shown);
}
