//! The limit of a short delay: the letter's Fig. 4 as a map and at one point, against reference
//! values; its mistakes.

use crate::program::{self, Folder, err, expect};
use slipmap::model::stop::Stop;
use slipmap::setting::{Field, SweepSpec};
use slipmap::sweep::Plan;

/// μ_K/μ_S, γ, v_c/ṽ, ω0 T, lift-off.
fn reference() -> Vec<[f64; 5]> {
    let table = include_str!("../reference/fig4.csv");
    let row = |line: &str| {
        let values: Vec<f64> = line.split(',').map(|v| v.parse().unwrap()).collect();
        values.try_into().unwrap()
    };
    table.lines().skip(1).map(row).collect()
}

fn columns(folder: &Folder, map: &str) -> Vec<(&'static str, Vec<f64>)> {
    let file = hdf5::File::open(folder.path().join(map)).unwrap();
    let names = Field::all_of_limit().map(Field::name);
    let column = |name| (name, file.dataset(name).unwrap().read_raw().unwrap());
    names.map(column).collect()
}

#[track_caller]
fn near(found: f64, expected: f64) {
    let error = (found / expected - 1.0).abs();
    assert!(error < 1e-12, "{found} {expected}");
}

#[test]
fn a_map_and_single_points_are_the_reference() {
    let rows = reference();
    let gammas: Vec<String> = rows.iter().map(|row| row[1].to_string()).collect();
    let gammas = gammas.join(", ");
    let folder = Folder::with(&[
        (
            "line.toml",
            &format!("protocol = \"limit\"\n[axes]\ngamma = [{gammas}]\n[fixed]\nmu_ratio = 0.5\n"),
        ),
        (
            "plane.toml",
            &format!(
                "protocol = \"limit\"\n[axes]\nmu_ratio = [0.3, 0.5, 1]\ngamma = [{gammas}]\n"
            ),
        ),
    ]);
    for (name, from) in [("line", 0), ("plane", rows.len())] {
        expect(&folder.run(&["run", &format!("{name}.toml")]), 0, "cells");
        let columns = columns(&folder, &format!("{name}.h5"));
        for (i, [_, _, vc, t, liftoff]) in rows.iter().enumerate() {
            near(columns[0].1[from + i], *vc);
            near(columns[1].1[from + i], *t);
            near(columns[2].1[from + i], *liftoff);
        }
    }
    let columns = columns(&folder, "line.h5");
    for (i, [ratio, gamma, ..]) in rows.iter().enumerate() {
        let [gamma, ratio] = [gamma, ratio].map(ToString::to_string);
        let args = ["vc", "--protocol", "limit", "--json", "--gamma", &gamma];
        let point = program::json(&folder.run(&[&args[..], &["--mu-ratio", &ratio]].concat()));
        for (name, cells) in &columns {
            // The reader of JSON is exact to the last bit but one.
            let ratio = point[name].as_f64().unwrap() / cells[i];
            assert!((ratio - 1.0).abs() < 1e-15, "{name} at {gamma}");
        }
        near(columns[0].1[i], rows[i][2]);
    }
    let file = hdf5::File::open(folder.path().join("plane.h5")).unwrap();
    let status = file.dataset("status").unwrap().read_raw::<u8>().unwrap();
    assert!(status.iter().all(|s| *s == 0));
    expect(&folder.run(&["info", "plane.h5"]), 0, "protocol limit");
}

/// Over many cells, in tiles of every size: lift-off above v_c, the approximations and their errors
/// as they are defined.
#[test]
fn lift_off_lies_above_the_critical_velocity() {
    let text = "protocol = \"limit\"\n[axes]\ngamma = { from = 1e-3, to = 0.999, points = 500 }\n\
                mu_ratio = { from = 0.01, to = 0.99, points = 50 }\n";
    let spec: SweepSpec = text.parse().unwrap();
    for cells in [1000, 1 << 18] {
        let plan = Plan::with_tiles_of(cells, spec.clone()).unwrap();
        let mut worker = slipmap::sweep::engine::Worker::new(&plan);
        let mut seen = 0;
        for number in 0..plan.tiles.len() {
            let tile = plan.tiles.tile(number);
            worker.compute(&tile, &Stop::default());
            let of = |field| {
                let mut columns = worker.buffers.columns.iter();
                let column = columns.find(|c| c.field == field);
                &column.unwrap().cells
            };
            let [vc, liftoff, weak, error] = [
                Field::VcOverVtilde,
                Field::LiftoffOverVtilde,
                Field::VcWeakControl,
                Field::WeakControlError,
            ]
            .map(of);
            for (i, _) in vc.iter().enumerate().filter(|(_, vc)| !vc.is_nan()) {
                assert!(
                    0.0 < vc[i] && vc[i] < liftoff[i],
                    "{} {}",
                    vc[i],
                    liftoff[i]
                );
                near(weak[i] / vc[i], 1.0 + error[i]);
                seen += 1;
            }
        }
        assert_eq!(seen, 25_000);
    }
}

#[test]
fn approximations_hold_where_the_letter_says() {
    let spec = "protocol = \"limit\"\n[axes]\ngamma = [1e-9, 1e-6, 0.99, 0.999]\n[fixed]\nmu_ratio = 0.5\n";
    let folder = Folder::with(&[("ends.toml", spec)]);
    expect(&folder.run(&["run", "ends.toml"]), 0, "4 cells");
    let columns = columns(&folder, "ends.h5");
    let [weak, strong] = [&columns[5].1, &columns[6].1];
    assert!(
        weak[0] < 1e-4 && weak[1] < 1e-2 && weak[3] > 1.0,
        "{weak:?}"
    );
    assert!(
        strong[3] < 1e-3 && strong[2] < 1e-2 && strong[0] > 1.0,
        "{strong:?}"
    );
}

#[test]
fn equal_plans_of_the_limit_have_equal_hashes_and_others_not() {
    let hash = |text: &str| Plan::new(text.parse().unwrap()).unwrap().hash();
    let base = "protocol = \"limit\"\n[axes]\ngamma = [0.1]\n[fixed]\nmu_ratio = 0.5\n";
    assert_eq!(hash(base), hash(&base.replace("0.5", "5e-1")));
    assert_ne!(hash(base), hash(&base.replace("0.5", "0.6")));
    assert_ne!(hash(base), hash(&base.replace("0.1", "0.2")));
    assert_ne!(
        hash(base),
        hash(&format!("fields = [\"omega0_T\"]\n{base}"))
    );
}

const LIMIT: &str = "protocol = \"limit\"\n";
const GAMMA: &str = "[axes]\ngamma = [0.1, 0.5]\n";
const RATIO: &str = "[fixed]\nmu_ratio = 0.5\n";

#[test]
fn mistakes_are_pointed_at() {
    let folder = Folder::new();
    let mut shown = String::new();
    for text in [
        format!("protocol = \"limits\"\n{GAMMA}{RATIO}"),
        format!("{LIMIT}{GAMMA}"),
        format!("{LIMIT}[axes]\nmu_ratio = [0.5]\n"),
        format!("{LIMIT}{GAMMA}{RATIO}tau = 1\n"),
        format!("{LIMIT}[axes]\nv0 = [1, 2]\ngamma = [0.1]\n{RATIO}"),
        format!("{LIMIT}{GAMMA}{RATIO}[friction]\nlaw = \"coulomb\"\nmu0 = 0.5\n"),
        format!("{LIMIT}fields = [\"vc_over_vtilde\", \"abscissa\"]\n{GAMMA}{RATIO}"),
        format!("{LIMIT}boundaries = true\n{GAMMA}{RATIO}"),
        format!("{LIMIT}{GAMMA}[fixed]\nmu_ratio = 1.5\n"),
        format!("{LIMIT}[axes]\ngamma = [0, 0.5]\n{RATIO}"),
        "fields = [\"n_unstable\", \"vc_over_vtilde\"]\n[axes]\nmu_prime = [1]\ntau = [1]\n".into(),
        "[axes]\nmu_prime = [1]\ntau = [1]\ngamma = [0.1]\n".into(),
    ] {
        std::fs::write(folder.path().join("sweep.toml"), text).unwrap();
        let output = folder.run(&["run", "sweep.toml"]);
        expect(&output, 2, "");
        shown += &err(&output);
    }
    insta::assert_snapshot!("mistakes", shown);
    assert_eq!(folder.files(), ["sweep.toml"]);
}

/// All velocities in one picture, one field of them, several ratios, and as a heat map.
#[test]
fn the_figure_is_drawn() {
    let plane = format!("{LIMIT}[axes]\ngamma = [0.1, 0.5, 0.9, 1]\nmu_ratio = [0.5, 0.6, 1]\n");
    let line = format!("{LIMIT}{GAMMA}{RATIO}");
    let folder = Folder::with(&[("plane.toml", &plane), ("line.toml", &line)]);
    for name in ["plane.toml", "line.toml"] {
        expect(&folder.run(&["run", name]), 0, ".png");
    }
    let svg = |args: &[&str]| {
        let args = [&["plot"], args, &["-o", "x.svg"]].concat();
        expect(&folder.run(&args), 0, "x.svg");
        std::fs::read_to_string(folder.path().join("x.svg")).unwrap()
    };
    let together = svg(&["line.h5"]);
    for label in [
        "lift-off",
        "/ṽ for γ → 0",
        "/ṽ for γ → 1",
        "pulling velocity",
    ] {
        assert!(together.contains(label), "{label}");
    }
    assert!(!together.contains("stable"));
    let single = svg(&["line.h5", "--field", "omega0_T"]);
    assert!(single.contains("duration") && !single.contains("lift-off"));
    let family = svg(&["plane.h5", "--at", "mu_ratio=0.5", "--at", "mu_ratio=1"]);
    assert!(!family.contains("lift-off"));
    for field in Field::all_of_limit() {
        let heat = svg(&["plane.h5", "--field", field.name()]);
        assert!(!heat.contains("unstable"), "{}", field.name());
    }
}
