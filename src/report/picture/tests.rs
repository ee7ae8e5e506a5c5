//! Pictures of small maps, from the map to the bytes.

use std::collections::HashSet;
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;

use super::*;
use crate::linear::Crossings;
use crate::linear::certificate::roots_right_of;
use crate::linear::curves::StableSide;
use crate::maps::maker::make_in_memory;
use crate::meaning::colour;
use crate::meaning::scale::Scale;
use crate::model::{Groups, elementary};
use crate::report::known::Known;
use crate::setting::axis::nearest;
use crate::setting::{Field, Parameter, SweepSpec};
use crate::store::map_file::MapCurve;
use crate::sweep::Plan;
use crate::sweep::described::root::Provenance;

const FIG2: &str = "
    title = \"Velocity control\"
    fields = [\"n_unstable\", \"delay_margin\"]
    boundaries = true
    [axes]
    mu_prime = [-0.1, -0.3]
    alpha_v = { from = -1.6, to = 0.4, points = 41 }
    tau = { from = 0.0, to = 12.0, points = 61 }
    [units]
    force = \"N\"
    length = \"m\"
    time = \"s\"";

struct Case {
    folder: tempfile::TempDir,
    map: MapFile,
}

impl Case {
    fn new(sweep: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.h5");
        let plan = Plan::new(sweep.parse::<SweepSpec>().unwrap()).unwrap();
        make_in_memory(&Arc::new(plan), &path, 1, &Provenance::default()).unwrap();
        let map = MapFile::open(&path).unwrap();
        Self { folder, map }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn draw(&self, name: &str, options: &PictureOptions) -> Result<Vec<u8>, PictureError> {
        draw(&self.map, &self.path(name), options)?.save()?;
        Ok(fs::read(self.path(name)).unwrap())
    }
}

fn decoded(bytes: &[u8]) -> (u32, u32, Vec<u8>) {
    let mut reader = png::Decoder::new(bytes).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size()];
    let info = reader.next_frame(&mut pixels).unwrap();
    (info.width, info.height, pixels)
}

fn of_kind(kind: PictureKind) -> PictureOptions {
    PictureOptions {
        kind: Some(kind),
        ..PictureOptions::default()
    }
}

#[test]
fn a_png_has_its_size_and_many_colours_and_is_the_same_twice() {
    let case = Case::new(FIG2);
    for kind in [PictureKind::Boundaries, PictureKind::Heat] {
        let bytes = case.draw("map.png", &of_kind(kind)).unwrap();
        let (width, height, pixels) = decoded(&bytes);
        assert_eq!((width, height), (1600, 1100));
        let colours: HashSet<&[u8]> = pixels.chunks_exact(3).collect();
        assert!(colours.len() > 60, "{}", colours.len());
        assert_eq!(case.draw("again.png", &of_kind(kind)).unwrap(), bytes);
    }
    let left: Vec<_> = fs::read_dir(case.folder.path()).unwrap().collect();
    assert_eq!(left.len(), 3, "the map and two pictures: {left:?}");
}

#[test]
fn stable_and_unstable_cells_differ() {
    let case = Case::new(FIG2);
    let options = PictureOptions {
        at: vec![(Parameter::MuPrime.into(), -0.1)],
        ..of_kind(PictureKind::Heat)
    };
    let (width, _, pixels) = decoded(&case.draw("map.png", &options).unwrap());
    let count = |colour: colour::Rgb| {
        let wanted = [colour.0, colour.1, colour.2];
        pixels.chunks_exact(3).filter(|p| *p == wanted).count()
    };
    let area = width as usize * 1100;
    // About a third of the plane is stable.
    assert!(count(colour::STABLE) > area / 10);
    assert!(count(colour::of_count(2.0)) > area / 10);
    // The edges of letters have any shade of grey.
    assert!(count(colour::NO_VALUE) < area / 1000);
}

#[test]
fn an_svg_names_values_axes_and_units() {
    let case = Case::new(FIG2);
    let bytes = case.draw("map.svg", &PictureOptions::default()).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    let labels = [
        "Velocity control",
        "−0.1",
        "−0.3",
        "gain of velocity control",
        "(s⁻¹)",
        "(s)",
    ];
    for label in labels {
        assert!(text.contains(label), "{label}");
    }
    assert!(text.len() < 1_000_000);
}

/// The title of a sweep is used only for the field that it shows.
#[test]
fn titles_tell_the_field() {
    let named = FIG2.replace("boundaries = true", "picture = \"delay_margin\"");
    let case = Case::new(&named);
    let text = |field, title: Option<&str>| {
        let options = PictureOptions {
            field,
            title: title.map(str::to_owned),
            ..PictureOptions::default()
        };
        String::from_utf8(case.draw("map.svg", &options).unwrap()).unwrap()
    };
    let unasked = text(None, None);
    assert_eq!(unasked, text(Some(Field::DelayMargin), None));
    assert!(unasked.contains("Velocity control"));
    assert!(unasked.contains("distance in delay") && !unasked.contains("delay_margin"));
    let other = text(Some(Field::NUnstable), None);
    assert!(other.contains("Number of characteristic roots"));
    assert!(other.contains("from: Velocity control"));
    let given = text(Some(Field::NUnstable), Some("My title"));
    assert!(given.contains("My title") && given.contains("number of") && !given.contains("n_unst"));
    assert!(!given.contains("Velocity control"));
}

#[test]
fn every_shape_of_map_is_drawn() {
    for axes in [
        "mu_prime = [-0.5, -0.1]\n tau = [0.0, 1.0, 2.0, 5.0]",
        "mu_prime = [-0.1]\n tau = { from = 0, to = 30, points = 3001 }",
        "mu_prime = [-0.2, -0.1]\n tau = [1.0]",
        "tau = { from = 0.001, to = 1000, points = 31, spacing = \"log\" }\n mu_prime = [-0.2, \
        -0.1]",
        "mu_prime = [0.1, 0.2]\n alpha_n = [-1.0, 0.0]\n alpha_v = [-0.2, -0.1]\n tau = [1.0, \
        2.0]",
    ] {
        let case = Case::new(&format!("[axes]\n{axes}"));
        for name in ["map.png", "map.svg"] {
            case.draw(name, &PictureOptions::default()).unwrap();
        }
    }
}

/// Along either axis of the plane of curves, shading ends exactly where stability changes, whatever
/// the cells are.
#[test]
fn a_line_is_shaded_to_the_exact_boundary() {
    let case = Case::new(&FIG2.replace("points = 61", "points = 7"));
    let (gain, delay) = (20, 2);
    let index = [1, gain, delay];
    let axes = case.map.axes();
    let exact = |alpha_v: f64| {
        let of = Crossings::of(Groups::new(-0.3, alpha_v, 0.0));
        let stable: Vec<_> = of.stable_delays().collect();
        let ends = stable.iter().flat_map(|of| [of.from, of.to]);
        ends.filter(|tau| (1e-9..12.0).contains(tau))
            .collect::<Vec<f64>>()
    };
    let near = |found: &mut Vec<f64>, expected: &[f64]| {
        found.sort_by(f64::total_cmp);
        assert_eq!(found.len(), expected.len(), "{found:?} {expected:?}");
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 2e-3, "{found} {expected}");
        }
    };
    let mut along_delay = stable_line::crossings(&case.map, 2, &index).unwrap();
    let expected = exact(axes[1].values[gain]);
    assert_eq!(expected.len(), 2, "{expected:?}");
    near(&mut along_delay, &expected);
    // At a crossing along the gain, stability changes at this delay.
    let tau = axes[2].values[delay];
    let along_gain = stable_line::crossings(&case.map, 1, &index).unwrap();
    assert!(!along_gain.is_empty());
    for alpha_v in along_gain {
        let ends = exact(alpha_v);
        assert!(ends.iter().any(|end| (end - tau).abs() < 1e-2), "{alpha_v}");
    }
    let options = PictureOptions {
        at: vec![
            (Parameter::MuPrime.into(), -0.3),
            (Parameter::AlphaV.into(), axes[1].values[gain]),
        ],
        ..PictureOptions::default()
    };
    let scene = compose(&case.map, &options, 1200).unwrap();
    let shaded = |mark: &&scene::Mark| match mark {
        scene::Mark::Rect { colour, .. } => *colour == colour::STABLE_TINT,
        _ => false,
    };
    // One of them is in the legend.
    let intervals = expected.len().div_ceil(2);
    assert_eq!(scene.marks.iter().filter(shaded).count(), intervals + 1);
}

/// Every field as a heat map and along a line, with cells without delay or control among them.
#[test]
fn every_field_is_drawn() {
    let others = [Field::StiffnessRatio, Field::SpectralRadius];
    let of_letter = |f: &Field| f.of_sliding() && !others.contains(f);
    let linear = || Field::ALL.into_iter().filter(of_letter);
    let names: Vec<String> = linear().map(|f| format!("{:?}", f.name())).collect();
    let case = Case::new(&format!(
        "fields = [{}]\n[axes]\nalpha_n = [-1.5, -1.0, -0.5, 0.0]\ntau = [0.0, 0.3, 0.6, 0.9, \
        6.0]\n[fixed]\nmu_prime = -0.1",
        names.join(", ")
    ));
    let mut pictures = HashSet::new();
    for field in linear() {
        for at in [
            vec![],
            vec![(Parameter::AlphaN.into(), -1.0)],
            vec![(Parameter::AlphaN.into(), 0.0)],
        ] {
            let options = PictureOptions {
                field: Some(field),
                at,
                size: (300, 300),
                ..PictureOptions::default()
            };
            pictures.insert(case.draw("map.png", &options).unwrap());
        }
    }
    assert!(pictures.len() > 2 * linear().count());
    let bytes = case.draw("map.svg", &PictureOptions::default()).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    assert!(text.contains("spectral abscissa") && text.contains("stable below 0"));
}

/// Draws every field as heat maps, and along a line at a value of one axis.
fn draw_every_field(case: &Case, line: (Parameter, f64)) {
    for &field in case.map.fields() {
        for at in [vec![], vec![(line.0.into(), line.1)]] {
            let options = PictureOptions {
                field: Some(field),
                at,
                ..PictureOptions::default()
            };
            case.draw("map.png", &options).unwrap();
        }
    }
}

#[test]
fn fields_of_motions_are_drawn() {
    let case = Case::new(
        "fields = [\"outcome\", \"settle_time\", \"n_min\", \"peak_force\"]\n[axes]\na0 = \
        [-0.4, 0.6, 1]\nx_dot0 = [0.1, 0.7]\n\
         [fixed]\nv0 = 0.118\nalpha_n = -7\ntau = 1\n[friction]\nlaw = \"weakening\"\nmu0 = \
         0.5\nv_s = 0.5\n",
    );
    draw_every_field(&case, (Parameter::XDot0, 0.1));
    let bytes = case.draw("map.svg", &PictureOptions::default()).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    for label in ["Motions of the block", "sliding", "stick-slip", "lift-off"] {
        assert!(text.contains(label), "{label}");
    }
}

#[test]
fn fields_of_the_critical_velocity_are_drawn() {
    let case = Case::new(
        "fields = [\"n_unstable\", \"vc\", \"outcome\", \"method\", \"class\", \"windows\", \
        \"v_liftoff\", \"stick_time\", \"vc_lower\", \"vc_upper\", \"v_smooth\"]\n\
         [axes]\nmu_prime_rest = [-1, -0.5]\nalpha_n = [-9, 0, 2]\ntau = [0.4, 1]\n[fixed]\nv0 \
         = 0.1\n\
         [friction]\nlaw = \"weakening\"\nmu0 = 0.5\n",
    );
    draw_every_field(&case, (Parameter::Tau, 1.0));
    let bytes = case.draw("map.svg", &PictureOptions::default()).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    for label in ["The critical velocity", "unstable", "boundary"] {
        assert!(text.contains(label), "{label}");
    }
}

#[test]
fn what_cannot_be_drawn_is_refused_and_leaves_nothing() {
    let case = Case::new(FIG2);
    let default = PictureOptions::default();
    let at = |parameter, value| PictureOptions {
        at: vec![(parameter, value), (Parameter::MuPrime.into(), -0.1)],
        ..default.clone()
    };
    let small = PictureOptions {
        size: (10, 10),
        ..default.clone()
    };
    let held = PictureOptions {
        kind: Some(PictureKind::Boundaries),
        ..at(Parameter::Tau.into(), 3.0)
    };
    for (name, options, says) in [
        ("map.h5", default.clone(), ".png, .svg or .pdf"),
        ("map", default.clone(), ".png, .svg or .pdf"),
        ("x.png", at(Parameter::Mass.into(), 1.0), "mass is no axis"),
        (
            "x.png",
            at(Parameter::Tau.into(), 12.5),
            "tau = 12.5 is outside the map: 0 to 12",
        ),
        ("x.png", held, "only one axis is left"),
        ("x.png", small, "outside the range"),
    ] {
        let error = case.draw(name, &options).unwrap_err().to_string();
        assert!(error.contains(says), "{error}");
    }
    assert_eq!(fs::read_dir(case.folder.path()).unwrap().count(), 1);
    let cell = Case::new("[axes]\nmu_prime = [-0.1]\n tau = [1.0]");
    let error = cell.draw("x.png", &default).unwrap_err();
    assert!(matches!(error, PictureError::NothingToDraw));
}

/// Without curves of its plane in the map, a picture traces them: on each a root lies on the axis,
/// by the letter's Eq. (3) written out, and inside the stable region the argument principle counts
/// no root.
#[test]
fn a_plane_at_a_delay_has_its_boundaries() {
    const DELAY: f64 = 2.0;
    let case = Case::new(
        "fields = [\"n_unstable\"]\n[axes]\nalpha_v = { from = -1.2, to = 0.4, points = 33 }\n\
         alpha_n = { from = -3, to = 0.5, points = 29 }\ntau = [1.0, 2.0]\n[fixed]\nmu_prime = \
         -0.3\n",
    );
    let view = View::new(&case.map, &[(Parameter::Tau.into(), DELAY)]).unwrap();
    assert!(!view.is_boundary_plane(&case.map));
    let curves = Curves::of(&case.map, &view).unwrap();
    assert!(!curves.stored && !curves.turned && curves.none.is_none());
    let (mut bounding, mut checked) = (0, 0);
    for curve in &curves.list {
        assert_eq!(curve.outer, [DELAY]);
        for v in &curve.piece.vertices {
            // D(λ) = λ² + bλ + 1 − (a_n + a_v (b + λ)) (1 − e^(−λτ)) at λ = iω.
            let (omega, b) = (v.omega, -0.3);
            let (sin, cos) = (
                elementary::sin(omega * DELAY),
                elementary::cos(omega * DELAY),
            );
            let feedback = [v.q + v.p * b, v.p * omega];
            let re = 1.0 - omega * omega - feedback[0] * (1.0 - cos) + feedback[1] * sin;
            let im = b * omega - feedback[0] * sin - feedback[1] * (1.0 - cos);
            assert!(re.abs() < 1e-9 && im.abs() < 1e-9, "{v:?}: {re} {im}");
        }
        bounding += u32::from(curve.bounds_stability());
        let side = match curve.piece.stable_side {
            StableSide::Shorter => -1e-5,
            StableSide::Longer => 1e-5,
            _ => continue,
        };
        let v = curve.piece.vertices[curve.piece.vertices.len() / 2];
        let count = |by: f64| roots_right_of(Groups::new(-0.3, v.p, v.q + by), DELAY, 0.0);
        assert_eq!((count(side), count(-side)), (Some(0), Some(2)), "{v:?}");
        checked += 1;
    }
    assert!(bounding > 0 && checked > 0, "{bounding} {checked}");
    let options = PictureOptions {
        at: vec![(Parameter::Tau.into(), DELAY)],
        ..PictureOptions::default()
    };
    let text = |options: &PictureOptions| {
        String::from_utf8(case.draw("map.svg", options).unwrap()).unwrap()
    };
    let drawn = text(&options);
    assert!(drawn.contains("boundary") && drawn == text(&options));
    let boundaries = PictureOptions {
        kind: Some(PictureKind::Boundaries),
        ..options
    };
    assert!(text(&boundaries).contains("its boundary"));
}

/// D(iω) of the letter under velocity control at μ′ = −0.3, with mass and stiffness 1.
fn at_crossing(alpha_v: f64, tau: f64, omega: f64) -> (f64, f64) {
    let (sin, cos) = (elementary::sin(omega * tau), elementary::cos(omega * tau));
    let (b, a) = (-0.3, alpha_v);
    // D(λ) = λ² + bλ + 1 − a (b + λ)(1 − e^(−λτ)).
    let re = 1.0 - omega * omega - a * (b * (1.0 - cos) - omega * sin);
    let im = b * omega - a * (omega * (1.0 - cos) + b * sin);
    (re, im)
}

/// A part of a plane is traced with curves of its own, which are as exact.
#[test]
fn an_inset_has_its_own_curves() {
    let case = Case::new(FIG2);
    let view = View::new(&case.map, &[]).unwrap();
    let part = [(-0.4, -0.05), (9.5, 10.5)];
    let curves = traced::within(&case.map, &view, part).unwrap();
    let lobe: Vec<_> = curves.iter().filter(|c| c.outer == [-0.3]).collect();
    let all = Curves::of(&case.map, &view).unwrap().list;
    let inside = |v: &&crate::linear::curves::Vertex| {
        (part[0].0..=part[0].1).contains(&v.p) && (part[1].0..=part[1].1).contains(&v.q)
    };
    let vertices = |curves: &[&MapCurve]| {
        let all = curves.iter().flat_map(|c| &c.piece.vertices);
        all.filter(inside).count()
    };
    let coarse: Vec<_> = all.iter().filter(|c| c.outer == [-0.3]).collect();
    assert!(vertices(&lobe) > 2 * vertices(&coarse));
    for v in lobe.iter().flat_map(|c| &c.piece.vertices) {
        let (re, im) = at_crossing(v.p, v.q, v.omega);
        assert!(re.abs() < 1e-9 && im.abs() < 1e-9, "{v:?}: {re} {im}");
    }
}

/// The cells of a map's first picture of counts, and the parts into which its curves cut them.
fn whole_and_cut(case: &Case) -> (Known, Known) {
    let view = View::new(&case.map, &[]).unwrap();
    let (x, y) = (view.x, view.y.unwrap());
    let axes = case.map.axes();
    let panel = panels::Panel {
        area: page::Area {
            left: 0.0,
            top: 0.0,
            right: 800.0,
            bottom: 800.0,
        },
        x: speed::scale(&case.map, &axes[x]),
        y: Scale::between(&axes[y].values),
    };
    let known = || Known::read(&case.map, Field::NUnstable, &view.panels[0], (y, x), 600).unwrap();
    let curves = Curves::of(&case.map, &view).unwrap();
    let all: Vec<_> = curves.list.iter().collect();
    let shown = (&*view.panels[0], Field::NUnstable);
    let cut = heat::cut(
        &case.map,
        (x, y),
        shown,
        &panel,
        known(),
        (&all, &curves),
        1.0,
    );
    let cut = cut.unwrap();
    (known(), cut)
}

/// How many places were compared, at how many of them the whole cell has another count than the
/// place itself, and at how many the part has.
fn wrong_counts(
    whole: &Known,
    cut: &Known,
    places: impl Iterator<Item = (usize, usize)>,
    counted: impl Fn(f64, f64) -> Option<f64>,
) -> [u32; 3] {
    let (cells, parts) = (&whole.plane, &cut.plane);
    let [mut all, mut whole_wrong, mut part_wrong] = [0; 3];
    for (row, column) in places {
        let (x, y) = (parts.columns[column], parts.rows[row]);
        let Some(count) = counted(x, y) else { continue };
        let own = nearest(&cells.rows, y).unwrap() * cells.columns.len()
            + nearest(&cells.columns, x).unwrap();
        all += 1;
        whole_wrong += u32::from(cells.cells[own] != count);
        part_wrong += u32::from(parts.cells[row * parts.columns.len() + column] != count);
    }
    [all, whole_wrong, part_wrong]
}

/// Cells cut along all crossing curves have the count of the argument principle nearly everywhere.
#[test]
fn cut_cells_have_the_count_of_their_place() {
    let case = Case::new(
        "fields = [\"n_unstable\"]\n[axes]\nalpha_v = { from = -1.5, to = 0.4, points = 11 }\n\
         tau = { from = 0.5, to = 12, points = 13 }\n[fixed]\nmu_prime = -0.3\n",
    );
    let (known, cut) = whole_and_cut(&case);
    let counted = |x: f64, y: f64| {
        let count = roots_right_of(Groups::new(-0.3, x, 0.0), y, 0.0);
        count.map(|count| count as f64)
    };
    let [rows, columns] = [&cut.plane.rows, &cut.plane.columns].map(Vec::len);
    let each = |n: usize| (0..n).step_by(5);
    let places = each(rows).flat_map(|row| each(columns).map(move |column| (row, column)));
    let [all, whole, wrong] = wrong_counts(&known, &cut, places, counted);
    assert!(all > 5000 && whole > 100, "{all} {whole}");
    assert!(
        wrong * 20 < whole,
        "{wrong} of {all} are wrong, {whole} before"
    );
}

/// A sweep of lobes of turning with these widths and delays.
fn turning(width: &str, tau: &str) -> String {
    format!(
        "system = \"turning\"\nfields = [\"n_unstable\"]\n[axes]\nwidth = {width}\ntau = {tau}\n\
         [fixed]\nzeta = 0.04\n"
    )
}

/// A sweep of load control under rate-and-state friction with these gains and delays.
fn creeping(alpha_n: &str, tau: &str) -> String {
    format!(
        "fields = [\"n_unstable\"]\nboundaries = true\n[axes]\nalpha_n = {alpha_n}\ntau = {tau}\n\
         [fixed]\nstiffness = 0.3\nv0 = 1.0\nmass = 0.1\n[friction]\nlaw = \"rate-and-state\"\n\
         mu0 = 0.6\nv_star = 1.0\ndirect_effect = 0.1\nevolution_effect = 0.4\n\
         slip_distance = 1.0\n"
    )
}

/// At how many places in the last column and the last row whole cells are wrong, where parts are so
/// at a tenth of them at most.
fn wrong_at_ends(sweep: fn(&str, &str) -> String, ranges: [[f64; 2]; 2]) -> u32 {
    let range = |[from, to]: [f64; 2]| format!("{{ from = {from}, to = {to}, points = 9 }}");
    let [first, second] = ranges.map(range);
    let coarse = Case::new(&sweep(&first, &second));
    let view = View::new(&coarse.map, &[]).unwrap();
    let (known, cut) = whole_and_cut(&coarse);
    let (columns, rows) = (&cut.plane.columns, &cut.plane.rows);
    let list = |all: &[f64], some: &[usize]| {
        let some: Vec<f64> = some.iter().map(|&i| all[i]).collect();
        format!("{some:?}")
    };
    let ends = [(last(columns), every(rows)), (every(columns), last(rows))];
    let wrong = ends.map(|(some_columns, some_rows)| {
        let lists = [list(columns, &some_columns), list(rows, &some_rows)];
        let fine = Case::new(&sweep(&lists[view.x], &lists[1 - view.x])).map;
        let plane = (view.y.unwrap(), view.x);
        let fine = fine.plane(Field::NUnstable, &view.panels[0], plane, 600);
        let fine = fine.unwrap();
        let counted = |x: f64, y: f64| {
            let (row, column) = (
                nearest(&fine.rows, y).ok()?,
                nearest(&fine.columns, x).ok()?,
            );
            Some(fine.cells[row * fine.columns.len() + column])
        };
        let places = some_rows
            .iter()
            .flat_map(|&row| some_columns.iter().map(move |&column| (row, column)));
        let [all, whole, wrong] = wrong_counts(&known, &cut, places, counted);
        assert!(
            whole > 0 && wrong * 10 <= whole,
            "{wrong} of {all}, {whole} before"
        );
        whole
    });
    wrong.iter().sum()
}

/// Cells in the last column and the last row are cut too, where curves end with the axis.
#[test]
fn cells_at_the_ends_of_axes_are_cut() {
    let wrong = wrong_at_ends(turning, [[0.0, 0.6], [1.0, 16.0]])
        + wrong_at_ends(creeping, [[-8.0, 1.0], [0.0, 12.0]]);
    assert!(wrong > 50, "{wrong}");
}

/// Indices of some of the last values: parts of the last cell.
fn last(values: &[f64]) -> Vec<usize> {
    (values.len() - 30..values.len()).step_by(5).collect()
}

/// Indices of some of all values.
fn every(values: &[f64]) -> Vec<usize> {
    (0..values.len()).step_by(4).collect()
}

/// What a sweep does not want traced is not traced for a picture either.
#[test]
fn boundaries_that_are_not_wanted_are_not_drawn() {
    let case = Case::new(
        "boundaries = false\n[axes]\nalpha_v = [-1, -0.5, 0]\nalpha_n = [-1, 0, 1]\n[fixed]\n\
         mu_prime = -0.3\ntau = 2\n",
    );
    let default = PictureOptions::default();
    let drawn = String::from_utf8(case.draw("map.svg", &default).unwrap()).unwrap();
    assert!(!drawn.contains("boundary"));
    let error = case.draw("map.svg", &of_kind(PictureKind::Boundaries));
    let says = error.unwrap_err().to_string();
    assert!(says.contains("its sweep has boundaries = false"), "{says}");
}

/// Counts that differ by one have different colours, and each has an entry of its own.
#[test]
fn odd_counts_are_not_even_ones() {
    let case = Case::new(
        "system = \"pd\"\n[axes]\nk_p = { from = -3, to = 4, points = 58 }\nk_d = { from = -2, \
         to = 8, points = 41 }\n[fixed]\ntau = 0.3\nstiffness = 1\ndamping = 0.1\n",
    );
    let view = View::new(&case.map, &[]).unwrap();
    let plane = case
        .map
        .plane(Field::NUnstable, &[0, 0], (view.y.unwrap(), view.x), 600);
    let plane = plane.unwrap();
    // D(0) = stiffness + k_p has the sign of (−1)^n: real roots pass 0 one by one.
    let width = plane.columns.len();
    for (i, n) in plane
        .cells
        .iter()
        .enumerate()
        .filter(|(_, n)| n.is_finite())
    {
        let at_zero = 1.0 + plane.columns[i % width];
        assert_eq!(n % 2.0 == 1.0, at_zero < 0.0, "{at_zero} {n}");
    }
    let occur: HashSet<usize> = plane.cells.iter().map(|n| *n as usize).collect();
    assert!(occur.contains(&1) && occur.contains(&3), "{occur:?}");
    let drawn = case.draw("map.png", &of_kind(PictureKind::Heat)).unwrap();
    let pixels = decoded(&drawn).2;
    let seen: HashSet<&[u8]> = pixels.chunks_exact(3).collect();
    for n in 0..=colour::LAST_COUNT {
        let colour::Rgb(r, g, b) = colour::of_count(n as f64);
        assert_eq!(seen.contains(&[r, g, b][..]), occur.contains(&n), "{n}");
    }
}
