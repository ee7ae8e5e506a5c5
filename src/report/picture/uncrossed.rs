//! Tests that in the pictures of all shipped sweeps no text meets a line, nor another text.

use std::fs;
use std::path::Path;
use std::sync::Arc;

use super::letters::{paths, texts};
use super::options::PictureOptions;
use super::page::Area;
use super::scene::Scene;
use super::{Print, clip, compose};
use crate::maps::maker::make_in_memory;
use crate::setting::{Parameter, SweepSpec};
use crate::store::{MapFile, regular};
use crate::sweep::Plan;
use crate::sweep::described::root::Provenance;

/// The most values of an axis: curves do not depend on them.
const MOST: usize = 3;
/// The most values of an axis along which the stability of sliding is all that is computed.
const MOST_LINEAR: usize = 9;
/// A sweep of which the first half of the delays is drawn: a critical velocity at its longest delay
/// and its largest gain takes half a minute.
const SLOW: &str = "robust_velocity";
/// Pixels by which parts of one line may seem to overlap, since widths are rounded.
const ROUNDING: f64 = 1.5;

/// A map of a sweep with few values on every axis of its plane.
fn small(path: &Path, folder: &Path) -> Option<MapFile> {
    let text = regular::read(path, 1 << 20).map(String::from_utf8);
    let text = text.unwrap_or_else(|_| panic!("{} is not read", path.display()));
    let text = text.unwrap();
    let has_axes = text.lines().any(|line| line.trim() == "[axes]");
    let mut spec: SweepSpec = has_axes.then(|| text.parse().unwrap())?;
    let linear = spec.fields.iter().all(|field| field.of_sliding());
    let most = if linear { MOST_LINEAR } else { MOST };
    let slow = path.file_stem().is_some_and(|stem| stem == SLOW);
    let plane = Plan::new(spec.clone()).unwrap().boundary_plane;
    for (i, axis) in spec.axes.iter_mut().enumerate() {
        let outer = plane.is_some_and(|(p, q)| i != p && i != q);
        if !outer && axis.values.len() > most {
            let half = slow && axis.parameter == Parameter::Tau;
            let last = (axis.values.len() - 1) / if half { 2 } else { 1 };
            axis.values = (0..most)
                .map(|k| axis.values[k * last / (most - 1)])
                .collect();
        }
    }
    let plan = Plan::new(spec).unwrap();
    let file = folder.join("map.h5");
    make_in_memory(&Arc::new(plan), &file, 2, &Provenance::default()).unwrap();
    Some(MapFile::open(&file).unwrap())
}

fn overlap(a: &Area, b: &Area) -> bool {
    let across = a.right.min(b.right) - a.left.max(b.left);
    let up = a.bottom.min(b.bottom) - a.top.max(b.top);
    across > ROUNDING && up > ROUNDING
}

/// Every text that a line crosses, another text covers, or the edge of the sheet cuts.
fn crossed(scene: &Scene) -> Vec<String> {
    let texts: Vec<_> = texts(scene).collect();
    let (width, height) = (f64::from(scene.size.0), f64::from(scene.size.1));
    let mut found = Vec::new();
    for (i, (text, area)) in texts.iter().enumerate() {
        if area.left < 0.0 || area.top < 0.0 || area.right > width || area.bottom > height {
            found.push(format!("{text:?} beyond the sheet"));
        }
        if paths(scene).any(|path| !clip::within(path, *area).is_empty()) {
            found.push(format!("a line through {text:?}"));
        }
        let others = texts[..i].iter();
        for (other, _) in others.filter(|(_, other)| overlap(area, other)) {
            found.push(format!("{text:?} over {other:?}"));
        }
    }
    found
}

#[test]
fn no_text_meets_a_line_in_any_shipped_picture() {
    let sweeps = Path::new(env!("CARGO_MANIFEST_DIR")).join("sweeps");
    let mut all: Vec<_> = fs::read_dir(sweeps)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|end| end == "toml"))
        .collect();
    all.sort();
    let folder = tempfile::tempdir().unwrap();
    let print = PictureOptions {
        print: Some(Print::default()),
        ..PictureOptions::default()
    };
    let mut drawn = 0;
    let mut found = Vec::new();
    for path in &all {
        let Some(map) = small(path, folder.path()) else {
            continue;
        };
        let name = path.file_stem().unwrap().to_string_lossy();
        for options in [&PictureOptions::default(), &print] {
            match compose(&map, options, 600) {
                Ok(scene) => {
                    drawn += 1;
                    let here = crossed(&scene).into_iter();
                    found.extend(here.map(|text| format!("{name}: {text}")));
                }
                Err(error) => {
                    let narrow = error.to_string().contains("no room");
                    assert!(narrow && options.print.is_some(), "{name}: {error}");
                }
            }
        }
    }
    assert!(found.is_empty(), "{found:#?}");
    assert!(drawn > 50, "{drawn}");
}
