//! Limits of actuators and dashpots, given to the program: what they do to a motion, and what is
//! refused.

use crate::program::{self, Folder, err, expect, out};

const CASE: &str = "switch_on = 70.0\n[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n\
    [fixed]\nv0 = 0.1\nalpha_n = -10.0\ntau = 0.5\nload_min = 0.6\n\
    [start]\nx_dot0 = 0.0\na0 = 0.0\n[trace]\nuntil = 120.0\ninterval = 0.01\n";

fn flags<'a>(command: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let law = [
        command,
        "--friction",
        "weakening",
        "--mu0",
        "0.5",
        "--v-s",
        "0.5",
    ];
    [&law[..], more].concat()
}

/// The letter's Fig. 3(b) with the load held: its samples have been at the limit for as long as it
/// says.
#[test]
fn a_load_that_is_held_is_told() {
    let folder = Folder::with(&[("case.toml", CASE)]);
    let told = folder.run(&["simulate", "case.toml", "--json"]);
    expect(&told, 0, "");
    let told = program::json(&told);
    assert_eq!(told["n_min"], 0.6);
    let [time, share] = ["time_at_limit", "share_at_limit"].map(|key| told[key].as_f64().unwrap());
    let decided = told["decided"].as_f64().unwrap();
    assert!(
        (share * (decided - 70.0) - time).abs() < 1e-9 * time,
        "{told}"
    );
    let csv = folder.run(&["export", "case.h5", "-o", "case.csv"]);
    expect(&csv, 0, "");
    let csv = std::fs::read_to_string(folder.path().join("case.csv")).unwrap();
    let mut rows = csv.lines();
    let names: Vec<_> = rows.next().unwrap().split(',').collect();
    let column = |name: &str| names.iter().position(|n| *n == name).unwrap();
    let [t, n] = [column("t"), column("N")];
    let number = |row: &str, of: usize| row.split(',').nth(of).unwrap().parse::<f64>().unwrap();
    let held = rows.filter(|row| {
        let at = number(row, t);
        at > 70.0 && at < decided && number(row, n) == 0.6
    });
    let seen = 0.01 * held.count() as f64;
    assert!(time > 1.0 && (seen - time).abs() < 0.1, "{seen} {time}");
}

/// Under velocity control the pull stays within its limits, and reaches both.
#[test]
fn a_pull_stays_within_its_limits() {
    let limits = "alpha_v = -0.33\ntau = 4.15\nv_min = 0.05\nv_max = 0.15\n";
    let case = CASE.replace("alpha_n = -10.0\ntau = 0.5\nload_min = 0.6\n", limits);
    let folder = Folder::with(&[("case.toml", &case)]);
    expect(&folder.run(&["simulate", "case.toml"]), 0, "time_at_limit");
    expect(&folder.run(&["export", "case.h5", "-o", "case.csv"]), 0, "");
    let csv = std::fs::read_to_string(folder.path().join("case.csv")).unwrap();
    let mut rows = csv.lines();
    let mut names = rows.next().unwrap().split(',');
    let column = names.position(|name| name == "v").unwrap();
    let pull = |row: &str| row.split(',').nth(column).unwrap().parse::<f64>().unwrap();
    let (least, most) = rows.map(pull).fold((1.0_f64, 0.0_f64), |(least, most), v| {
        (least.min(v), most.max(v))
    });
    assert_eq!((least, most), (0.05, 0.15));
}

/// Without limits nothing is told of them.
#[test]
fn a_motion_without_limits_has_none() {
    let case = CASE.replace("load_min = 0.6\n", "");
    let folder = Folder::with(&[("case.toml", &case)]);
    let told = folder.run(&["simulate", "case.toml"]);
    assert!(!out(&told).contains("at_limit"), "{}", out(&told));
}

#[test]
fn limits_that_exclude_what_they_limit_are_refused() {
    let folder = Folder::new();
    for (more, says) in [
        (
            &["--v0", "0.1", "--v-max", "0.05"][..],
            "--v-max = 0.05 is not above --v0 = 0.1",
        ),
        (
            &["--v0", "0.1", "--v-min", "0.2"],
            "--v-min = 0.2 is not below --v0 = 0.1",
        ),
        (
            &["--v0", "0.1", "--load-max", "0.5"],
            "--load-max = 0.5 is not above --normal-load = 1",
        ),
        (
            &["--v0", "0.1", "--load-min", "3", "--load-max", "2"],
            "--load-max = 2 is not above --load-min = 3",
        ),
        (
            &["--v0", "0.1", "--load-min=-1"],
            "--load-min -1 is outside its range",
        ),
        (
            &["--v0", "0.1", "--damping=-1"],
            "--damping -1 is outside its range",
        ),
        (
            &["--v0", "0.1", "--viscous=-1"],
            "--viscous -1 is outside its range",
        ),
    ] {
        let args = flags(
            "point",
            &[&["--alpha-n=-10", "--tau", "0.5"], more].concat(),
        );
        expect(&folder.run(&args), 2, says);
    }
    let case = CASE.replace("load_min = 0.6", "load_min = 1.5");
    let folder = Folder::with(&[("case.toml", &case)]);
    let refused = folder.run(&["simulate", "case.toml"]);
    expect(&refused, 2, "load_min = 1.5 is not below normal_load = 1");
    expect(&refused, 2, "load_min < normal_load < load_max");
    assert!(err(&refused).contains("10 │"), "{}", err(&refused));
}

/// A limit is compared with all values of an axis.
#[test]
fn limits_hold_for_every_cell_of_a_sweep() {
    let sweep = "fields = [\"outcome\", \"time_at_limit\"]\n[axes]\nv0 = { from = 0.1, to = 0.9, \
        points = 3 }\n[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n[fixed]\n\
        alpha_v = -0.3\ntau = 4.0\nv_max = 0.5\n";
    let unlimited = sweep.replace("v_max = 0.5\n", "");
    let folder = Folder::with(&[("sweep.toml", sweep), ("unlimited.toml", &unlimited)]);
    let refused = folder.run(&["run", "sweep.toml"]);
    expect(&refused, 2, "v_max = 0.5 is not above v0 = 0.9");
    let refused = folder.run(&["run", "unlimited.toml"]);
    expect(
        &refused,
        2,
        "time_at_limit is of actuators with limits, and none is given",
    );
    assert_eq!(folder.files(), ["sweep.toml", "unlimited.toml"]);
}

/// The search for v_c looks no farther than the largest pull.
#[test]
fn stick_slip_persists_up_to_the_largest_pull() {
    let folder = Folder::new();
    let of = |most: &str| {
        let control = [
            "--alpha-v=-0.33",
            "--tau",
            "4.15",
            "--v-max",
            most,
            "--json",
        ];
        let told = folder.run(&flags("vc", &control));
        expect(&told, 0, "");
        program::json(&told)
    };
    let far = of("30");
    assert!(
        (far["vc"].as_f64().unwrap() - 0.344467).abs() < 1e-5,
        "{far}"
    );
    let near = of("0.3");
    assert_eq!(near["outcome"], "persists", "{near}");
    assert_eq!(near["vc_lower"], 0.3, "{near}");
    assert!(near["vc"].is_null(), "{near}");
}

/// With a smallest load nothing lifts off, however small it is; and no load below it is told.
#[test]
fn a_load_that_is_held_never_lifts_off() {
    let folder = Folder::new();
    for least in ["1e-10", "1e-6", "1e-3"] {
        let control = ["--alpha-n=-10", "--tau", "5", "--load-min", least, "--json"];
        let told = folder.run(&flags("vc", &control));
        expect(&told, 0, "");
        let told = program::json(&told);
        assert_ne!(told["outcome"], "lift-off", "{told}");
        assert!(told["v_liftoff"].is_null(), "{told}");
    }
    let control = [
        "--alpha-n=-10",
        "--tau",
        "0.5",
        "--load-min",
        "0.95",
        "--json",
    ];
    let told = program::json(&folder.run(&flags("vc", &control)));
    assert_eq!(told["n_min"], 0.95, "{told}");
}

/// A v0 that is left aside is not compared with limits; the windows of v_c begin at the smallest
/// pull.
#[test]
fn critical_velocities_are_looked_for_within_the_limits() {
    let folder = Folder::new();
    let control = [
        "--alpha-v=-0.33",
        "--tau",
        "4.15",
        "--v0",
        "0.1",
        "--v-min",
        "0.2",
        "--json",
    ];
    let told = folder.run(&flags("vc", &control));
    expect(&told, 0, "--v0 is left aside");
    let told = program::json(&told);
    assert_eq!(told["windows"][0][0], 0.2, "{told}");
}
