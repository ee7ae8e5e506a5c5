//! Maps of roots: every cell is what a point there has, for any order of axes, number of threads
//! and size of tiles.

use std::path::Path;

use slipmap::linear::rightmost::Rightmost;
use slipmap::linear::status::{CERTIFIED, DISAGREE, MARGINAL, NOT_CONVERGED};
use slipmap::linear::{Crossings, MarginalTolerance};
use slipmap::model::stop::Stop;
use slipmap::setting::field::Storage;
use slipmap::setting::{Field, Parameter, Setting};
use slipmap::store::MapFile;
use slipmap::sweep::plan::BLOCK_OF_DELAYS;
use slipmap::sweep::{Plan, engine};

use crate::map::write;

const ALL: &str = "[\"n_unstable\", \"delay_margin\", \"abscissa\", \"abscissa_2\", \"abscissa_8\", \"frequency\", \
                   \"frequency_2\", \"frequency_8\", \"relaxation_time\", \"d_abscissa_d_tau\", \"d_abscissa_d_alpha_v\", \
                   \"d_abscissa_d_alpha_n\", \"d_abscissa_d_mu_prime\"]";

/// Sweeps with delays last, first, in the middle and not at all; without delay and without control;
/// in other units.
const SWEEPS: [&str; 4] = [
    "[axes]\nmu_prime = [-0.3, 0.2]\nalpha_n = { from = -3, to = 1, points = 9 }\ntau = { from = 0, to = 12, points = 41 }\n[fixed]\nalpha_v = -0.1\n",
    "[axes]\ntau = { from = 0.01, to = 30, points = 43, spacing = \"log\" }\nalpha_v = { from = -1, to = 1, points = 11 }\n[fixed]\nmu_prime = -0.1\nmass = 4\nstiffness = 9\nnormal_load = 3\nmu_k = 0.5\nalpha_n = -2\n",
    "[axes]\nalpha_v = [-0.4, 0]\ntau = { from = 0, to = 9, points = 31 }\nmu_prime = [-2.5, -0.5, 0, 2.5]\n",
    "[axes]\nmu_prime = { from = -1, to = 1, points = 13 }\nalpha_v = { from = -1, to = 1, points = 14 }\n[fixed]\ntau = 4.3\n",
];

/// The cells of a map, field by field.
struct Cells {
    status: Vec<u8>,
    columns: Vec<(Field, Vec<f64>)>,
}

impl Cells {
    fn read(path: &Path, plan: &Plan) -> Self {
        let file = hdf5::File::open(path).unwrap();
        let real = |field: &&Field| field.storage() == Storage::Real;
        let column = |&field: &Field| (field, file.dataset(field.name()).unwrap().read_raw());
        let columns = plan.spec.fields.iter().filter(real).map(column);
        Self {
            status: file.dataset("status").unwrap().read_raw().unwrap(),
            columns: columns.map(|(f, cells)| (f, cells.unwrap())).collect(),
        }
    }

    fn get(&self, name: &str) -> &[f64] {
        let field = Field::from_name(name).unwrap();
        let column = self.columns.iter().find(|c| c.0 == field);
        &column.unwrap_or_else(|| panic!("no {name}")).1
    }
}

fn index_of(mut cell: usize, shape: &[usize]) -> Vec<usize> {
    let mut index = vec![0; shape.len()];
    for axis in (0..shape.len()).rev() {
        index[axis] = cell % shape[axis];
        cell /= shape[axis];
    }
    index
}

/// The eight rightmost roots at a setting, dimensionless, and the unit of time.
fn roots(setting: &Setting) -> (Rightmost, f64) {
    let (groups, unit) = setting.groups().unwrap();
    let tau = setting.get(Parameter::Tau) / unit;
    let count = Crossings::of(groups).count(tau, MarginalTolerance::default());
    (Rightmost::at(groups, tau, 8, count), unit)
}

/// Equal to rounding, or both infinite or without a value.
fn same(a: f64, b: f64) -> bool {
    a == b || (a.is_nan() && b.is_nan()) || (a - b).abs() <= 1e-11 * b.abs().max(1.0)
}

#[test]
fn every_cell_has_the_roots_of_its_point() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.h5");
    let mut absent = 0;
    for text in SWEEPS {
        let plan = Plan::new(format!("fields = {ALL}\n{text}").parse().unwrap()).unwrap();
        write(&plan, 2, &path);
        let cells = Cells::read(&path, &plan);
        for (cell, status) in cells.status.iter().enumerate() {
            let setting = plan.setting(&index_of(cell, plan.shape()));
            let (found, unit) = roots(&setting);
            let place = format!("{text} {cell}: {found:?}");
            assert!(found.missing.is_none(), "{place}");
            let bad = status & (NOT_CONVERGED | DISAGREE);
            assert!(bad == 0 && status & (CERTIFIED | MARGINAL) != 0, "{place}");
            for (rank, suffix) in [(0, ""), (1, "_2"), (7, "_8")] {
                let root = found.roots.get(rank);
                absent += usize::from(root.is_none());
                let re = root.map_or(f64::NEG_INFINITY, |r| r.lambda.re / unit);
                let re_found = cells.get(&format!("abscissa{suffix}"))[cell];
                assert!(same(re_found, re), "{place}: {re_found}");
                let im = root.map_or(f64::NAN, |r| r.lambda.im / unit);
                let im_found = cells.get(&format!("frequency{suffix}"))[cell];
                // Equal real parts may come in either order.
                let tie = found
                    .roots
                    .windows(2)
                    .any(|w| same(w[0].lambda.re, w[1].lambda.re));
                assert!(tie || same(im_found, im), "{place}: {im_found}");
            }
            let abscissa = cells.get("abscissa")[cell];
            let expected = if abscissa < 0.0 {
                -1.0 / abscissa
            } else {
                f64::INFINITY
            };
            assert_eq!(cells.get("relaxation_time")[cell], expected, "{place}");
            let margin = cells.get("certificate_margin")[cell];
            assert!((0.0..1e-2).contains(&margin), "{place}: {margin}");
        }
    }
    assert!(
        absent > 100,
        "cells with one pair only are among them: {absent}"
    );
}

/// Derivatives against difference quotients, all in physical units.
#[test]
fn derivatives_are_those_of_the_abscissa_in_physical_units() {
    const FIXED: [(&str, f64); 4] = [
        ("mass", 2.0),
        ("stiffness", 7.0),
        ("normal_load", 3.0),
        ("mu_k", 0.4),
    ];
    let cell = |at: [f64; 4]| -> Vec<(Field, f64)> {
        let fixed = FIXED
            .map(|(name, value)| format!("{name} = {value}\n"))
            .concat();
        let text = format!(
            "fields = {ALL}\n[axes]\nalpha_v = [{:?}]\ntau = [{:?}]\n[fixed]\nalpha_n = {:?}\nmu_prime = {:?}\n{fixed}",
            at[1], at[0], at[2], at[3]
        );
        let plan = Plan::new(text.parse().unwrap()).unwrap();
        let mut worker = engine::Worker::new(&plan);
        worker.compute(&plan.tiles.tile(0), &Stop::default());
        let columns = worker.buffers.columns.iter();
        columns.map(|c| (c.field, c.cells[0])).collect()
    };
    let value = |at: [f64; 4], name: &str| {
        let field = Field::from_name(name).unwrap();
        cell(at).into_iter().find(|c| c.0 == field).unwrap().1
    };
    let names = [
        "d_abscissa_d_tau",
        "d_abscissa_d_alpha_v",
        "d_abscissa_d_alpha_n",
        "d_abscissa_d_mu_prime",
    ];
    for at in [
        [2.1, -0.4, -9.0, -0.5],
        [0.3, 0.2, 4.0, 0.3],
        [1.1, -1.5, -40.0, -0.2],
    ] {
        for (i, name) in names.into_iter().enumerate() {
            let h = 1e-5 * f64::abs(at[i]);
            let shifted = |by: f64| {
                let mut at = at;
                at[i] += by;
                value(at, "abscissa")
            };
            let numeric = (shifted(h) - shifted(-h)) / (2.0 * h);
            let found = value(at, name);
            let error = (found - numeric).abs() / found.abs().max(1e-3);
            assert!(error < 1e-6, "{name} at {at:?}: {found} {numeric}");
        }
    }
}

/// The bytes of every dataset of the cells.
fn bytes(cells: &Cells) -> Vec<Vec<u8>> {
    let columns = cells.columns.iter();
    let mut all: Vec<Vec<u8>> = columns
        .map(|(_, cells)| cells.iter().flat_map(|v| v.to_le_bytes()).collect())
        .collect();
    all.push(cells.status.clone());
    all
}

/// One line over two blocks and a bit, in tiles of one, two or all of its blocks, and delays first
/// or last.
#[test]
fn cells_depend_neither_on_threads_nor_on_tiles() {
    let folder = tempfile::tempdir().unwrap();
    let points = 2 * BLOCK_OF_DELAYS + 100;
    let tau = format!("tau = {{ from = 0, to = 60, points = {points} }}\n");
    let gains = "alpha_n = [-1, 0.3]\n";
    let fields =
        "fields = [\"abscissa\", \"frequency_2\", \"d_abscissa_d_tau\"]\nboundaries = false\n";
    for axes in [[&tau, gains].concat(), [gains, &tau].concat()] {
        let text = format!("{fields}[axes]\n{axes}\n[fixed]\nmu_prime = -0.1\n");
        let mut first = None;
        for (cells, threads) in [(1, 1), (1 << 13, 2), (1 << 14, 1), (1 << 18, 2)] {
            let plan = Plan::with_tiles_of(cells, text.parse().unwrap()).unwrap();
            let path = folder.path().join("map.h5");
            write(&plan, threads, &path);
            let found = bytes(&Cells::read(&path, &plan));
            match &first {
                None => first = Some(found),
                Some(first) => assert!(*first == found, "{cells} cells, {threads} threads"),
            }
        }
    }
}

#[test]
fn the_summary_of_a_field_tells_infinite_and_missing_values() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.h5");
    let text = "fields = [\"abscissa\", \"abscissa_2\", \"frequency_2\"]\n[axes]\nalpha_v = [-0.4, 0, 0.4]\ntau = [0, 1, 2]\n[fixed]\nmu_prime = -0.1\n";
    let plan = Plan::new(text.parse().unwrap()).unwrap();
    assert_eq!(plan.bytes_per_cell(), 4 * 8 + 1);
    write(&plan, 1, &path);
    let map = MapFile::open(&path).unwrap();
    let held: Vec<_> = map.fields().iter().map(|f| f.name()).collect();
    assert_eq!(
        held,
        [
            "abscissa",
            "abscissa_2",
            "frequency_2",
            "certificate_margin"
        ]
    );
    let summary = |name| map.summary(Field::from_name(name).unwrap()).unwrap();
    assert_eq!(
        (summary("abscissa").infinite, summary("abscissa").missing(9)),
        ([0, 0], 0)
    );
    assert!(
        summary("abscissa")
            .range
            .is_some_and(|(low, high)| low < high)
    );
    // No control in one of three lines, no delay in one of three columns.
    assert_eq!(summary("abscissa_2").infinite, [5, 0]);
    assert_eq!(summary("frequency_2").missing(9), 5);
    assert_eq!(map.stability_field(), Some(Field::Abscissa));
}
