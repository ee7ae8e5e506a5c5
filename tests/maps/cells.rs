//! Maps: every cell is what the library says of its point, for any order of axes, and independent
//! of threads.

#[allow(dead_code, reason = "not every test binary uses all of it")]
use std::path::Path;

use crate::winding;
use slipmap::linear::Crossings;
use slipmap::linear::certificate::roots_right_of;
use slipmap::linear::curves::StableSide;
use slipmap::linear::general::{RightOf, RootCounter};
use slipmap::linear::status::MARGINAL;
use slipmap::model::stop::Stop;
use slipmap::setting::{Field, Parameter};
use slipmap::store::MapFile;
use slipmap::sweep::cells::best_planes::{best_of_plane, best_plane};
use slipmap::sweep::{Plan, engine};

use crate::map::{edit, write};

fn plan(text: &str) -> Plan {
    Plan::new(text.parse().unwrap_or_else(|e| panic!("{e}\n{text}"))).unwrap()
}

/// Indices of a cell along every axis.
fn index_of(mut cell: usize, shape: &[usize]) -> Vec<usize> {
    let mut index = vec![0; shape.len()];
    for axis in (0..shape.len()).rev() {
        index[axis] = cell % shape[axis];
        cell /= shape[axis];
    }
    index
}

const SWEEPS: [&str; 7] = [
    // Delays last, middle, first; several tiles with ragged edges.
    "fields = [\"n_unstable\", \"delay_margin\"]\n[axes]\nmu_prime = [-0.3, -0.1, 0.2]\nalpha_n = { from = -3, to = 1, points = 331 }\ntau = { from = 0, to = 12, points = 517 }\n[fixed]\nalpha_v = -0.1\n",
    "fields = [\"n_unstable\", \"delay_margin\"]\n[axes]\nalpha_v = { from = -1, to = 1, points = 401 }\ntau = { from = 0.01, to = 30, points = 701, spacing = \"log\" }\nmu_prime = [-0.1, 0.0]\n",
    "fields = [\"n_unstable\", \"delay_margin\"]\n[axes]\ntau = { from = 0, to = 9, points = 900 }\nalpha_v = { from = -1, to = 1, points = 301 }\nalpha_n = [-1, 0, 0.4]\n[fixed]\nmu_prime = -0.2\n",
    // A longer line than a tile.
    "fields = [\"n_unstable\", \"delay_margin\"]\n[axes]\ntau = { from = 0, to = 500, points = 300000 }\nalpha_n = [-1, 0.3]\n[fixed]\nmu_prime = -0.1\n",
    // No delay axis.
    "[axes]\nmu_prime = { from = -1, to = 1, points = 600 }\nalpha_v = { from = -1, to = 1, points = 700 }\n[fixed]\ntau = 4.3\n",
    // A friction law, physical units.
    "fields = [\"delay_margin\"]\n[axes]\nv0 = { from = 0.05, to = 2, points = 60 }\nmass = [0.5, 4]\ntau = { from = 0, to = 20, points = 200 }\n[fixed]\nalpha_n = -30\nstiffness = 9\nnormal_load = 3\n[friction]\nlaw = \"stribeck\"\nmu0 = 0.3\nv_s = 0.4\nmu_s = 0.8\n",
    // Crossings denser than cells.
    "[axes]\ntau = [1, 1e3, 1e6, 1e9]\nalpha_n = [-2, 0.5, 3]\n[fixed]\nmu_prime = -0.4\nalpha_v = 0.3\n",
];

#[test]
fn every_cell_is_what_the_library_says() {
    let folder = tempfile::tempdir().unwrap();
    for (number, text) in SWEEPS.iter().enumerate() {
        let plan = plan(text);
        let path = folder.path().join(format!("{number}.h5"));
        write(&plan, 2, &path);
        let file = hdf5::File::open(&path).unwrap();
        let status = file.dataset("status").unwrap().read_raw::<u8>().unwrap();
        let counts = file
            .dataset("n_unstable")
            .map(|d| d.read_raw::<u16>().unwrap());
        let margins = file
            .dataset("delay_margin")
            .map(|d| d.read_raw::<f64>().unwrap());
        assert_eq!(status.len() as u64, plan.cells());
        for cell in 0..status.len() {
            // All cells of small maps, every seventh of large ones and those at the ends.
            if status.len() > 100_000 && cell % 7 != 0 && cell + 20 < status.len() {
                continue;
            }
            let setting = plan.setting(&index_of(cell, plan.shape()));
            let (groups, unit) = setting.groups().unwrap();
            let crossings = Crossings::of(groups).in_physical_time(unit);
            let tau = setting.get(Parameter::Tau);
            let count = crossings.count(tau, plan.spec.tolerance);
            assert_eq!(
                status[cell] & MARGINAL != 0,
                count.marginal,
                "{text} {cell}"
            );
            if let Ok(counts) = &counts {
                assert_eq!(
                    u64::from(counts[cell]),
                    count.n_unstable.min(65534),
                    "{text} {cell}"
                );
            }
            if let Ok(margins) = &margins {
                assert_eq!(
                    margins[cell].to_bits(),
                    crossings.delay_margin(tau).to_bits(),
                    "{text} {cell}"
                );
                assert!(
                    count.marginal || (margins[cell] > 0.0) == (count.n_unstable == 0),
                    "{text} {cell}"
                );
            }
        }
    }
}

/// Every dataset of a file with its raw bytes, group by group.
fn datasets(group: &hdf5::Group) -> Vec<(String, Vec<u8>)> {
    let mut all = Vec::new();
    for dataset in group.datasets().unwrap() {
        let bytes = match dataset.dtype().unwrap().size() {
            1 => dataset
                .read_raw::<i8>()
                .unwrap()
                .iter()
                .map(|v| *v as u8)
                .collect(),
            2 => dataset
                .read_raw::<u16>()
                .unwrap()
                .iter()
                .flat_map(|v| v.to_le_bytes())
                .collect(),
            4 => dataset
                .read_raw::<i32>()
                .unwrap()
                .iter()
                .flat_map(|v| v.to_le_bytes())
                .collect(),
            _ => dataset
                .read_raw::<f64>()
                .unwrap()
                .iter()
                .flat_map(|v| v.to_le_bytes())
                .collect(),
        };
        all.push((dataset.name(), bytes));
    }
    for group in group.groups().unwrap() {
        all.extend(datasets(&group));
    }
    all
}

#[test]
fn the_same_sweep_gives_the_same_bytes_on_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let plan = plan(SWEEPS[0]);
    let mut first = None;
    for threads in [1, 2, 3, 7] {
        let path = folder.path().join(format!("{threads}.h5"));
        write(&plan, threads, &path);
        let found = datasets(&hdf5::File::open(&path).unwrap());
        assert!(found.len() > 15, "{} datasets", found.len());
        match &first {
            None => first = Some(found),
            Some(first) => assert!(*first == found, "{threads} threads"),
        }
    }
}

/// The map and the curves in it say the same: cells on the two sides of a bounding curve differ in
/// stability.
#[test]
fn curves_in_the_map_separate_its_stable_cells() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.h5");
    let plan = plan(&std::fs::read_to_string("sweeps/fig2b.toml").unwrap());
    write(&plan, 2, &path);
    let map = MapFile::open(&path).unwrap();
    assert_eq!(map.boundary_plane(), Some((1, 2)));
    let curves = map.curves_where(|_| true).unwrap();
    let bounding: Vec<_> = curves
        .iter()
        .filter(|c| c.piece.stable_side != StableSide::Neither)
        .collect();
    assert!(bounding.len() > 20);
    let mut checked = 0;
    for curve in bounding {
        let mu_prime = curve.outer[0];
        for v in &curve.piece.vertices {
            let stable = |tau: f64| {
                Crossings::of(slipmap::model::Groups::new(mu_prime, 0.0, v.p)).n_unstable(tau) == 0
            };
            let (before, after) = (stable(v.q - 1e-9), stable(v.q + 1e-9));
            // At the ends of a piece another curve passes through the same point.
            if before != after {
                assert_eq!(before, curve.piece.stable_side == StableSide::Shorter);
                checked += 1;
            }
        }
    }
    assert!(checked > 500, "{checked}");
}

const DEGREES: &str = "degree_of_stability = [0.05, 0.1]\n[axes]\nmass = [1, 4]\nalpha_n = { from = -6, to = 1, points = 50 }\ntau = { from = 0, to = 12, points = 50 }\n[fixed]\nmu_prime = -0.1\nalpha_v = -0.05\n[units]\nforce = \"N\"\nlength = \"m\"\ntime = \"s\"\n";

/// Curves of a degree of stability come back from the file, and roots are where they say: by
/// winding numbers.
#[test]
fn degrees_of_stability_bound_what_they_say() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.h5");
    let plan = plan(DEGREES);
    write(&plan, 2, &path);
    let map = MapFile::open(&path).unwrap();
    assert_eq!(map.degree_unit(), "s-1");
    let curves = map.curves_where(|_| true).unwrap();
    let mut checked = [0; 2];
    for curve in &curves {
        let sigma = curve.degree_of_stability;
        let Some(number) = [0.05, 0.1].iter().position(|s| *s == sigma) else {
            assert_eq!(sigma, 0.0);
            continue;
        };
        let vertices = &curve.piece.vertices;
        for v in vertices.iter().skip(1).step_by(9).take(vertices.len() / 9) {
            let mut setting = plan.spec.fixed.clone();
            setting.set(Parameter::Mass, curve.outer[0]);
            setting.set(Parameter::AlphaN, v.p);
            let (g, unit) = setting.groups().unwrap();
            let count =
                |tau: f64| winding::roots_right_of(g.b, g.a_v, g.a_n, tau / unit, -sigma * unit);
            let side = match curve.piece.stable_side {
                StableSide::Shorter => -1e-4,
                StableSide::Longer => 1e-4,
                StableSide::Neither | StableSide::Below | StableSide::Above => {
                    unreachable!("only what bounds is traced")
                }
            };
            // Next to a corner or a fold the decaying region is narrower than the step.
            let ends = [vertices[0], vertices[vertices.len() - 1]];
            if v.q < 1e-3 || ends.iter().any(|w| (v.q - w.q).hypot(v.p - w.p) < 0.05) {
                continue;
            }
            assert_eq!(count(v.q + side), Some(0), "{v:?}");
            assert_eq!(count(v.q - side), Some(2), "{v:?}");
            checked[number] += 1;
        }
    }
    assert!(checked.iter().all(|&n| n > 20), "{checked:?}");
    let corners = hdf5::File::open(&path).unwrap();
    let degrees = corners.dataset("boundaries/corner_degree_of_stability");
    assert!(degrees.unwrap().read_raw::<f64>().unwrap().contains(&0.05));
}

/// A map of the first format version holds no degrees of stability: its curves are crossings. A map
/// that slipmap 0.1.0 wrote before maps had a seal: `title`, `n_unstable`, `delay_margin`, curves
/// and best settings over mu_prime [-0.3, -0.1], alpha_v -1 to 0 (7 points), tau 0.5 to 8 (9
/// points).
#[test]
fn a_map_of_the_second_version_is_read() {
    let path = Path::new("tests/reference/format_version_2.h5");
    let map = MapFile::open(path).unwrap();
    assert_eq!(map.cells(), 126);
    let curves = map.curves_where(|_| true).unwrap();
    assert!(!curves.is_empty() && map.best().unwrap().len() == 2);
    let summary = map.summary(Field::DelayMargin).unwrap();
    assert!(summary.range.is_some() && summary.missing(126) == 0);
    // Every count is that of the argument principle.
    let plan = plan(&map.root_text("sweep").unwrap());
    for (alpha, tau) in [(0, 0), (3, 4), (6, 8), (2, 7)] {
        let index = [0, alpha, tau];
        let (groups, unit) = plan.setting(&index).groups().unwrap();
        let plane = map.plane(Field::NUnstable, &index, (1, 2), 100).unwrap();
        let expected = roots_right_of(groups, plan.delay(&index) / unit, 0.0).unwrap();
        assert_eq!(plane.cells[alpha * 9 + tau], f64::from(expected as u32));
    }
}

/// A map that was written while the regime was called `class`, and integers had a `_FillValue`:
/// `n_unstable`, `vc` and `class` over alpha_n [-10, -3], v0 [0.01, 1], tau [0.5, 1, 2]. Sweeps that
/// ask for `class` make the same plan, with the new name.
#[test]
fn a_map_of_the_fourth_version_has_a_regime() {
    let path = Path::new("tests/reference/format_version_4.h5");
    let map = MapFile::open(path).unwrap();
    assert_eq!(map.fields(), [Field::NUnstable, Field::Regime, Field::Vc]);
    let summary = map.summary(Field::Regime).unwrap();
    assert_eq!(summary.kinds.iter().sum::<u64>(), 12);
    assert_eq!(summary.missing(12), 0);
    let text = map.root_text("sweep").unwrap();
    let plan = plan(&text);
    assert_eq!(map.root_text("plan_hash").unwrap(), plan.hash());
    let folder = tempfile::tempdir().unwrap();
    let again = folder.path().join("again.h5");
    write(&plan, 1, &again);
    let new = MapFile::open(&again).unwrap();
    for index in [[0, 0], [0, 1], [1, 0], [1, 1]] {
        let cells = |map: &MapFile| {
            let plane = map.plane(Field::Regime, &[index[0], index[1], 0], (1, 2), 100);
            plane.unwrap().cells
        };
        assert_eq!(cells(&map), cells(&new));
    }
    let file = hdf5::File::open(&again).unwrap();
    assert!(file.link_exists("regime") && !file.link_exists("class"));
}

/// Every attribute that tells of cells, computed anew from the cells as HDF5 gives them.
#[test]
fn maps_tell_what_values_their_cells_have() {
    let infinite = "fields = [\"abscissa\", \"abscissa_2\"]\n[axes]\nalpha_v = [-0.4, 0, 0.4]\n\
                    tau = [0, 1, 2]\n[fixed]\nmu_prime = -0.1\n";
    let kinds = "fields = [\"n_unstable\", \"outcome\"]\n[axes]\nalpha_v = [-0.4, 0.4]\n\
                 tau = [0.5, 1, 2]\n[fixed]\nv0 = 0.3\n[start]\na0 = 0\n[friction]\n\
                 law = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";
    let folder = tempfile::tempdir().unwrap();
    for (number, text) in [SWEEPS[0], SWEEPS[5], infinite, kinds].iter().enumerate() {
        let path = folder.path().join(format!("{number}.h5"));
        write(&plan(text), 2, &path);
        let file = hdf5::File::open(&path).unwrap();
        let map = MapFile::open(&path).unwrap();
        for field in map.fields() {
            check_told(&file.dataset(field.name()).unwrap());
        }
        check_told_of_statuses(&file.dataset("status").unwrap());
    }
}

/// The numbers of an attribute; none where there is no such attribute.
fn attribute<T: hdf5::H5Type>(of: &hdf5::Dataset, name: &str) -> Vec<T> {
    let attribute = of.attr(name).ok();
    attribute.map_or(Vec::new(), |a| a.read_raw().unwrap())
}

fn number_of<T>(cells: &[T], hold: impl Fn(&T) -> bool) -> u64 {
    cells.iter().filter(|cell| hold(cell)).count() as u64
}

/// The smallest and the largest; empty for none.
fn ends(values: &[f64]) -> Vec<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let first = sorted.first().zip(sorted.last());
    first.map_or(Vec::new(), |(low, high)| vec![*low, *high])
}

fn check_told(dataset: &hdf5::Dataset) {
    let cells = dataset.read_raw::<f64>().unwrap();
    let fill = match dataset.dtype().unwrap().size() {
        1 => 255.0,
        2 => 65535.0,
        _ => f64::NAN,
    };
    let is_value = |v: &f64| !v.is_nan() && *v != fill;
    let missing = number_of(&cells, |v| !is_value(v));
    assert_eq!(attribute::<u64>(dataset, "cells_without_value"), [missing]);
    let integers = !fill.is_nan();
    assert_eq!(dataset.attr("_FillValue").is_ok(), missing > 0 || !integers);
    let kinds: Vec<f64> = attribute(dataset, "flag_values");
    if !kinds.is_empty() {
        let of = |kind: &f64| number_of(&cells, |v| v == kind);
        let expected: Vec<u64> = kinds.iter().map(of).collect();
        assert_eq!(attribute::<u64>(dataset, "flag_cells"), expected);
        return;
    }
    let values: Vec<f64> = cells.into_iter().filter(is_value).collect();
    assert_eq!(attribute::<f64>(dataset, "actual_range"), ends(&values));
    if !integers {
        let infinite =
            [f64::NEG_INFINITY, f64::INFINITY].map(|end| number_of(&values, |v| *v == end));
        assert_eq!(attribute::<u64>(dataset, "cells_infinite"), infinite);
        let finite: Vec<f64> = values.into_iter().filter(|v| v.is_finite()).collect();
        assert_eq!(attribute::<f64>(dataset, "finite_range"), ends(&finite));
    }
}

fn check_told_of_statuses(status: &hdf5::Dataset) {
    let cells = status.read_raw::<u8>().unwrap();
    let masks: Vec<u8> = attribute(status, "flag_masks");
    let with = |mask: &u8| number_of(&cells, |s| s & mask != 0);
    let expected: Vec<u64> = masks.iter().map(with).collect();
    assert_eq!(attribute::<u64>(status, "flag_cells"), expected);
    assert_eq!(
        attribute::<u64>(status, "cells_unflagged"),
        [number_of(&cells, |s| *s == 0)]
    );
    assert_eq!(attribute::<u64>(status, "cells_without_value"), [0]);
    assert!(status.attr("_FillValue").is_err());
}

/// Integers have a `_FillValue` where cells are missing alone: readers turn those into floats.
#[test]
fn integers_of_a_complete_map_have_no_fill_value() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.h5");
    write(&plan(SWEEPS[1]), 1, &path);
    let file = hdf5::File::open(&path).unwrap();
    let has = |name: &str, attribute: &str| file.dataset(name).unwrap().attr(attribute).is_ok();
    for name in ["n_unstable", "status"] {
        assert!(!has(name, "_FillValue"), "{name}");
        // Writers of classic netCDF would have to write a number that its types do not hold.
        assert!(!has(name, "valid_max"), "{name}");
    }
    assert!(has("delay_margin", "_FillValue"));
}

#[test]
fn maps_of_the_first_version_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.h5");
    write(&plan(SWEEPS[1]), 1, &path);
    let set_version = |file: &hdf5::File, version: i32| {
        let attribute = file.attr("slipmap_format_version").unwrap();
        attribute.write_raw(&[version]).unwrap();
        let group = file.group("boundaries").unwrap();
        for name in ["degree_of_stability", "corner_degree_of_stability"] {
            if group.link_exists(name) {
                group.unlink(name).unwrap();
            }
        }
    };
    let found = MapFile::open(&path)
        .unwrap()
        .curves_where(|_| true)
        .unwrap();
    edit(&path, |file| set_version(file, 1));
    assert_eq!(
        MapFile::open(&path)
            .unwrap()
            .curves_where(|_| true)
            .unwrap(),
        found
    );
    assert!(!found.is_empty() && found.iter().all(|c| c.degree_of_stability == 0.0));
    for version in [0, 7] {
        edit(&path, |file| set_version(file, version));
        let error = MapFile::open(&path).unwrap_err().to_string();
        assert!(error.contains("this program reads 1 to 6"), "{error}");
    }
}

#[test]
fn degrees_of_stability_are_part_of_the_plan() {
    let without = DEGREES.split_once('\n').unwrap().1;
    let hashes = [without, DEGREES, &DEGREES.replace("0.1]", "0.2]")].map(|t| plan(t).hash());
    assert!(hashes[0] != hashes[1] && hashes[1] != hashes[2]);
}

/// The best settings of every plane, in any order of the axes and of the gain's and the delay's
/// among them.
#[test]
fn best_settings_are_those_of_the_library() {
    let folder = tempfile::tempdir().unwrap();
    for (number, text) in [
        "best = true\n[axes]\nmu_prime = [-0.1, -0.5, -0.9]\nmu_k = [0.5, 1]\nalpha_v = [0.5, 0, -0.4, -1]\ntau = { from = 0, to = 12, points = 41 }\n",
        "best = true\nboundaries = false\n[axes]\ntau = { from = 0, to = 12, points = 41 }\nmu_prime = [-0.1, -0.5]\nalpha_n = { from = -8, to = 1, points = 31 }\nmass = [1, 4]\n",
        "best = true\n[axes]\nalpha_n = { from = -8, to = 1, points = 31 }\ntau = { from = 0, to = 12, points = 41 }\n[fixed]\nmu_prime = -0.3\n",
    ]
    .into_iter()
    .enumerate()
    {
        let plan = plan(text);
        let path = folder.path().join(format!("{number}.h5"));
        write(&plan, 2, &path);
        let map = MapFile::open(&path).unwrap();
        let (gain, tau) = map.best_plane().unwrap();
        assert_eq!(Some((gain, tau)), plan.best_plane());
        let planes: Vec<_> = (0..plan.best_planes()).map(|n| best_plane(&plan, n)).collect();
        let found = map.best().unwrap();
        assert_eq!(found.len(), planes.len());
        for (found, index) in found.iter().zip(&planes) {
            let expected = best_of_plane(&plan, index, &Stop::default()).unwrap();
            let best = &expected.overall;
            assert_eq!((found.gain, found.tau, found.abscissa), (best.p, best.q, best.abscissa));
            assert_eq!(found.relaxation_time, best.relaxation_time());
            assert_eq!((found.kind, found.certified), (Some(best.kind), best.certified));
            assert_eq!(found.regions, expected.regions.len() as u64);
            let outer: Vec<f64> = (0..index.len())
                .filter(|&axis| axis != gain && axis != tau)
                .map(|axis| plan.spec.axes[axis].values[index[axis]])
                .collect();
            assert_eq!(found.outer, outer);
        }
        let group = hdf5::File::open(&path).unwrap().group("best").unwrap();
        let shape: Vec<usize> = plan.shape().iter().enumerate().filter(|&(a, _)| a != gain && a != tau).map(|(_, &n)| n).collect();
        for name in [plan.spec.axes[gain].parameter.name(), "tau", "abscissa", "frequency", "relaxation_time", "kind", "certified", "regions"] {
            let dataset = group.dataset(name).unwrap();
            assert_eq!(dataset.shape(), shape, "{name}");
            for attribute in ["long_name", "units"] {
                assert!(dataset.attr(attribute).is_ok(), "{name} {attribute}");
            }
            let real = !["kind", "certified", "regions"].contains(&name);
            assert_eq!(dataset.attr("_FillValue").is_ok(), real, "{name}");
            assert_eq!(dataset.attr("DIMENSION_LIST").is_ok(), !shape.is_empty());
        }
    }
    let without = plan("[axes]\nalpha_v = [-1, 0]\ntau = [0, 1]\n[fixed]\nmu_prime = 1\n");
    let with =
        plan("best = true\n[axes]\nalpha_v = [-1, 0]\ntau = [0, 1]\n[fixed]\nmu_prime = 1\n");
    assert_ne!(without.hash(), with.hash());
    let path = folder.path().join("without.h5");
    write(&without, 1, &path);
    let map = MapFile::open(&path).unwrap();
    assert!(map.best_plane().is_none() && map.best().unwrap().is_empty());
}

#[test]
fn boundaries_can_be_asked_for_in_other_planes() {
    let folder = tempfile::tempdir().unwrap();
    for (number, (text, plane)) in [
        ("[axes]\nmu_prime = { from = -1, to = 0.5, points = 50 }\ntau = { from = 0, to = 9, points = 50 }\n[fixed]\nalpha_n = -1\n", Some((0, 1))),
        ("[axes]\ntau = { from = 0, to = 9, points = 50 }\nv0 = { from = 0.1, to = 2, points = 50 }\n[fixed]\nalpha_n = -1\n[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n", Some((1, 0))),
        ("boundaries = true\n[axes]\nmu_prime = [-1, 1]\nalpha_n = [-1, 0]\n[fixed]\ntau = 1\n", Some((0, 1))),
        ("[axes]\nmu_prime = [-1, 1]\nalpha_n = [-1, 0]\n[fixed]\ntau = 1\n", None),
        ("boundaries = false\n[axes]\nalpha_n = [-1, 0]\ntau = [0, 1]\n[fixed]\nmu_prime = 1\n", None),
    ].into_iter().enumerate() {
        let path = folder.path().join(format!("{number}.h5"));
        write(&plan(text), 1, &path);
        let map = MapFile::open(&path).unwrap();
        assert_eq!(map.boundary_plane(), plane, "{text}");
        assert_eq!(map.curves_where(|_| true).unwrap().is_empty(), plane.is_none());
    }
}

/// A small step in the plane to a side.
fn towards(side: StableSide) -> Option<(f64, f64)> {
    match side {
        StableSide::Neither => None,
        StableSide::Shorter => Some((0.0, -1e-5)),
        StableSide::Longer => Some((0.0, 1e-5)),
        StableSide::Below => Some((-1e-5, 0.0)),
        StableSide::Above => Some((1e-5, 0.0)),
    }
}

/// All roots lie left of −`sigma`.
fn decays(setting: &slipmap::setting::Setting, sigma: f64) -> bool {
    let (model, unit) = setting.linear().unwrap();
    let tau = setting.get(Parameter::Tau) / unit;
    RootCounter::new(&model.system().unwrap()).right_of(tau, -sigma * unit) == RightOf::Roots(0)
}

/// Sweeps with boundaries, and the parameters of their planes.
const PLANES: [(&str, &str); 6] = [
    (
        "[axes]\nalpha_v = { from = -1.5, to = 0.2, points = 20 }\ntau = { from = 0.1, to = 9, points = 20 }\n[fixed]\nmu_prime = -0.5\nmemory = 0.4\n",
        "alpha_v tau",
    ),
    (
        "[axes]\nlatency = { from = 0, to = 2, points = 20 }\ntau = { from = 0.1, to = 9, points = 20 }\n[fixed]\nmu_prime = -0.2\nalpha_v = -0.4\n",
        "latency tau",
    ),
    (
        "[axes]\nmemory = { from = -0.8, to = 0.8, points = 20 }\nalpha_v = { from = -1.5, to = 0.2, points = 20 }\n[fixed]\nmu_prime = -0.5\ntau = 5\n",
        "memory alpha_v",
    ),
    (
        "boundaries = true\n[axes]\nalpha_n = { from = -4, to = 1, points = 20 }\nalpha_v = { from = -1.5, to = 0.5, points = 20 }\n[fixed]\nmu_prime = -0.2\ntau = 1.5\n",
        "alpha_n alpha_v",
    ),
    (
        "system = \"turning\"\ndegree_of_stability = [0.01]\n[axes]\nwidth = { from = 0, to = 0.5, points = 20 }\ntau = { from = 1, to = 20, points = 20 }\n",
        "width tau",
    ),
    (
        "system = \"pd\"\n[axes]\nk_p = { from = -1, to = 3, points = 20 }\nk_d = { from = -1, to = 3, points = 20 }\n[fixed]\nstiffness = -0.5\ntau = 0.4\n",
        "k_p k_d",
    ),
];

/// Planes of other systems and of other parameters: right beside a boundary one side is stable, the
/// other is not.
#[test]
fn boundaries_of_any_plane() {
    let folder = tempfile::tempdir().unwrap();
    for (number, (text, plane)) in PLANES.into_iter().enumerate() {
        let path = folder.path().join(format!("{number}.h5"));
        let plan = plan(text);
        write(&plan, 1, &path);
        let map = MapFile::open(&path).unwrap();
        let (p, q) = map.boundary_plane().unwrap_or_else(|| panic!("{text}"));
        let [p, q] = [p, q].map(|axis| &plan.spec.axes[axis]);
        assert_eq!(
            format!("{} {}", p.parameter.name(), q.parameter.name()),
            plane
        );
        let stable = |at_p: f64, at_q: f64, sigma: f64| {
            let mut setting = plan.spec.fixed.clone();
            setting.vary(&p.parameter, at_p);
            setting.vary(&q.parameter, at_q);
            decays(&setting, sigma)
        };
        let (mut checked, mut degrees) = (0, 0);
        for curve in map.curves_where(|_| true).unwrap() {
            let vertices = &curve.piece.vertices;
            let Some(side) = towards(curve.piece.stable_side) else {
                continue;
            };
            degrees += u32::from(curve.degree_of_stability > 0.0);
            // In the middle of a piece no other one is near.
            let v = vertices[vertices.len() / 2];
            let beside = |sign: f64| {
                let (p, q) = (v.p + sign * side.0, v.q + sign * side.1);
                stable(p, q, curve.degree_of_stability)
            };
            if vertices.len() > 2 {
                assert!(
                    beside(1.0) && !beside(-1.0),
                    "{text}: {v:?} {:?}",
                    curve.piece.kind
                );
                checked += 1;
            }
        }
        assert!(checked > 0, "{text}");
        assert_eq!(degrees > 0, text.contains("degree"), "{text}");
    }
}

/// Computes a map in memory and calls `visit` with the parameters and the count of every cell.
fn cells(text: &str, mut visit: impl FnMut(&slipmap::setting::Setting, u16)) {
    let plan = plan(text);
    let mut worker = engine::Worker::new(&plan);
    let strides = plan.tiles.strides();
    for number in 0..plan.tiles.len() {
        let tile = plan.tiles.tile(number);
        worker.compute(&tile, &Stop::default());
        let n = worker.buffers.n_unstable.as_ref().unwrap();
        for cell in 0..tile.cells() as usize {
            let inside = index_of(cell, &tile.extent);
            let at: usize = inside.iter().zip(&strides).map(|(i, s)| i * s).sum();
            let index: Vec<usize> = inside
                .iter()
                .zip(&tile.offset)
                .map(|(i, o)| i + o)
                .collect();
            visit(&plan.setting(&index), n[at]);
        }
    }
}

/// The end of velocity control by the tangency condition, seen in a map: stable cells on one side
/// of it, none on the other.
#[test]
fn velocity_control_ends_in_the_map_where_the_tangency_says() {
    let end = slipmap::linear::lobes::LobeControl::Velocity { damping: 0.0 }.lobe_end(0);
    for (distance, width) in [(0.02, 0.02), (0.005, 0.004), (0.001, 0.0008)] {
        let (inside, outside) = (end.b + distance, end.b - distance);
        let text = format!(
            "[axes]\nmu_prime = [{inside}, {outside}]\n\
             alpha_v = {{ from = {}, to = {}, points = 1501 }}\n\
             tau = {{ from = {}, to = {}, points = 1501 }}\n",
            end.gain - width,
            end.gain + width,
            end.tau - 5.0 * width,
            end.tau + 5.0 * width,
        );
        let (mut stable_inside, mut stable_outside) = (0, 0);
        cells(&text, |setting, n| {
            if n == 0 {
                match setting.get(Parameter::MuPrime) > end.b {
                    true => stable_inside += 1,
                    false => stable_outside += 1,
                }
            }
        });
        assert!(stable_inside > 0, "no stable cell at b* + {distance}");
        assert_eq!(stable_outside, 0, "stable cells at b* - {distance}");
    }
}

/// The area of the first lobe of velocity control in the (a_v, τ) plane, by counting cells.
#[test]
fn areas_of_the_first_velocity_lobe() {
    for (b, area, range) in [
        (-0.60, 0.0427, (-0.55, -0.15, 3.6, 4.9)),
        (-0.68, 0.0030, (-0.40, -0.22, 4.0, 4.6)),
        (-0.70, 0.0007, (-0.38, -0.26, 4.1, 4.5)),
    ] {
        let (a0, a1, t0, t1) = range;
        let text = format!(
            "[axes]\nalpha_v = {{ from = {a0}, to = {a1}, points = 2001 }}\n\
             tau = {{ from = {t0}, to = {t1}, points = 2001 }}\n[fixed]\nmu_prime = {b}\n"
        );
        let mut stable = 0_u32;
        cells(&text, |_, n| stable += u32::from(n == 0));
        let found = f64::from(stable) * (a1 - a0) * (t1 - t0) / (2000.0 * 2000.0);
        assert!(
            (found - area).abs() < 0.5e-4 + 0.005 * area,
            "b = {b}: {found} instead of {area}"
        );
    }
}
