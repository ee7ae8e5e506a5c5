//! Tests that colours with different meanings can be told apart by everybody: with normal sight and
//! with each of the three kinds of colour blindness.
//!
//! The sight of a dichromat is simulated by G. M. Machado, M. M. Oliveira and L. A. F. Fernandes,
//! "A Physiologically-based Model for Simulation of Color Vision Deficiency", IEEE Transactions on
//! Visualization and Computer Graphics 15 (2009) 1291, at severity 1. Differences are CIEDE2000.
//! For two areas side by side, a careful eye sees a difference of 2; a difference of 10 is seen at
//! a glance.
//!
//! Hatched cells are told apart by their lines.

use palette::color_difference::Ciede2000;
use palette::convert::FromColorUnclamped;
use palette::{Lab, LinSrgb, Srgb};

use crate::meaning::colour::{
    self, ABOVE, BELOW, HATCH, INFINITE, INK, LAST_COUNT, LIFTS_OFF, MINUS_INFINITE, NO_VALUE,
    PAPER, PERSISTS, Rgb, STABLE, UNKNOWN, UNSTABLE, ZERO,
};
use crate::meaning::gradient::ColourMap;
use crate::setting::Field;
use crate::setting::field::OUTCOMES;

/// The least difference between two meanings, and between a meaning and an end of a colour map.
const APART: f64 = 10.0;
/// The least difference between a meaning and any colour of a colour map, whose bar stands beside
/// it.
const ANYWHERE: f64 = 7.0;

type Matrix = [[f64; 3]; 3];

/// Matrices on linear RGB: normal sight, protanopia, deuteranopia, tritanopia.
const SIGHTS: [(&str, Matrix); 4] = [
    (
        "normal",
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    ),
    (
        "protanopia",
        [
            [0.152_286, 1.052_583, -0.204_868],
            [0.114_503, 0.786_281, 0.099_216],
            [-0.003_882, -0.048_116, 1.051_998],
        ],
    ),
    (
        "deuteranopia",
        [
            [0.367_322, 0.860_646, -0.227_968],
            [0.280_085, 0.672_501, 0.047_413],
            [-0.011_820, 0.042_940, 0.968_881],
        ],
    ),
    (
        "tritanopia",
        [
            [1.255_528, -0.076_749, -0.178_779],
            [-0.078_411, 0.930_809, 0.147_602],
            [0.004_733, 0.691_367, 0.303_900],
        ],
    ),
];

fn seen(Rgb(r, g, b): Rgb, matrix: &Matrix) -> Lab<palette::white_point::D65, f64> {
    let linear: LinSrgb<f64> = Srgb::new(r, g, b).into_format::<f64>().into_linear();
    let channel = |row: &[f64; 3]| {
        let sum = row[0] * linear.red + row[1] * linear.green + row[2] * linear.blue;
        sum.clamp(0.0, 1.0)
    };
    let [r, g, b] = [0, 1, 2].map(|i| channel(&matrix[i]));
    Lab::from_color_unclamped(LinSrgb::new(r, g, b))
}

/// The smallest difference among all kinds of sight, and for which it is smallest.
fn difference(a: Rgb, b: Rgb) -> (f64, &'static str) {
    let of = |(sight, matrix): &(&'static str, Matrix)| {
        (seen(a, matrix).difference(seen(b, matrix)), *sight)
    };
    let all = SIGHTS.iter().map(of);
    all.fold((f64::INFINITY, ""), |least, next| {
        if next.0 < least.0 { next } else { least }
    })
}

type Named = (&'static str, Rgb);

/// Pairs of meanings that are too similar.
fn alike(meanings: &[Named]) -> Vec<String> {
    let mut found = Vec::new();
    for (i, (name, colour)) in meanings.iter().enumerate() {
        for (other, beside) in &meanings[..i] {
            let (difference, sight) = difference(*colour, *beside);
            if difference < APART {
                found.push(format!("{name} and {other}: {difference:.1}, {sight}"));
            }
        }
    }
    found
}

/// Meanings that are too similar to a colour of a scale.
fn on_the_scale(meanings: &[Named], scale: &[Rgb]) -> Vec<String> {
    let mut found = Vec::new();
    for (name, colour) in meanings {
        for (i, on_scale) in scale.iter().enumerate() {
            let (difference, sight) = difference(*colour, *on_scale);
            if difference < ANYWHERE {
                found.push(format!("{name} and {i}: {difference:.1}, {sight}"));
            }
        }
    }
    found
}

fn none(found: &[String], of: &str) {
    assert!(found.is_empty(), "{of}: {found:#?}");
}

/// Colours of cells without a value, which occur beside those of every field.
const GAPS: [Named; 2] = [("lifts off", LIFTS_OFF), ("persists", PERSISTS)];

#[test]
fn the_matrices_and_the_difference_are_the_published_ones() {
    for (sight, matrix) in SIGHTS {
        for row in matrix {
            assert!(
                (row.iter().sum::<f64>() - 1.0).abs() < 2e-6,
                "{sight}: white stays"
            );
        }
    }
    // G. Sharma, W. Wu and E. N. Dalal, Color Research and Application 30 (2005) 21, pair 1.
    let lab = |l, a, b| Lab::<palette::white_point::D65, f64>::new(l, a, b);
    let found = lab(50.0, 2.6772, -79.7751).difference(lab(50.0, 0.0, -82.7485));
    assert!((found - 2.0425).abs() < 1e-4);
    // Red and green of equal lightness.
    let (red, green) = (Rgb(0xc0, 0x50, 0x50), Rgb(0x60, 0x80, 0x40));
    assert!(seen(red, &SIGHTS[0].1).difference(seen(green, &SIGHTS[0].1)) > 30.0);
    assert!(difference(red, green).0 < 15.0);
}

#[test]
fn sizes() {
    let meanings = [
        ("0", ZERO),
        ("above", ABOVE),
        ("below", BELOW),
        ("infinite", INFINITE),
        ("minus infinite", MINUS_INFINITE),
    ];
    let meanings = [&meanings[..], &GAPS].concat();
    none(&alike(&meanings), "among one another");
    for map in ColourMap::ALL
        .into_iter()
        .filter(|map| !map.has_two_sides())
    {
        let scale: Vec<Rgb> = (0..=64)
            .map(|i| colour::of_size(map, f64::from(i) / 64.0))
            .collect();
        none(&on_the_scale(&meanings, &scale), map.name());
        let [low, high] = [0.0, 1.0].map(|end| colour::of_size(map, end));
        for end in [("low", low), ("high", high)] {
            // The colours below and above the scale continue its steps.
            let others = meanings.iter().filter(|(name, _)| {
                !matches!((end.0, *name), ("low", "below") | ("high", "above"))
            });
            let with: Vec<Named> = others.copied().chain([end]).collect();
            none(&alike(&with), map.name());
        }
        let next = [(low, BELOW), (high, ABOVE)];
        assert!(
            next.iter()
                .all(|(end, beyond)| difference(*end, *beyond).0 > ANYWHERE)
        );
    }
}

#[test]
fn values_with_two_sides() {
    for map in ColourMap::ALL.into_iter().filter(|map| map.has_two_sides()) {
        let at = |value: f64| colour::two_sided(map, value, 1.0);
        let [worse, better] = [-1.0, 1.0].map(|end| colour::beyond(map, end));
        let [never, always] = [-1.0, 1.0].map(|end| colour::beyond(map, end * f64::INFINITY));
        let beyond = [
            ("worse", worse),
            ("better", better),
            ("-infinity", never),
            ("infinity", always),
        ];
        let ends = [("-1", at(-1.0)), ("1", at(1.0))];
        // The smallest values on both sides.
        let middle = [("-0", at(-1e-9)), ("+0", at(1e-9))];
        none(&alike(&[&beyond[..], &ends, &middle].concat()), map.name());
        let scale: Vec<Rgb> = (-32..=32).map(|i| at(f64::from(i) / 32.0)).collect();
        none(&on_the_scale(&beyond, &scale), map.name());
    }
}

#[test]
fn counts_and_kinds() {
    let counts = ["0", "1", "2", "3", "4", "5", "6", "7", "8"]
        .into_iter()
        .zip((0..=LAST_COUNT).map(|n| colour::of_count(n as f64)));
    let counts: Vec<Named> = counts.collect();
    assert_eq!(counts.len(), LAST_COUNT + 1);
    none(&alike(&counts), "counts");
    let kinds = |field: Field, numbers: &[usize]| -> Vec<Named> {
        let names = field.kinds().unwrap();
        let named = |&n: &usize| (names[n], colour::of_kind(field, n as f64));
        // Undecided cells are hatched.
        numbers
            .iter()
            .map(named)
            .filter(|(name, _)| *name != "undecided")
            .collect()
    };
    let numbers = |names: &[&str]| -> Vec<usize> {
        let place = |name: &&str| OUTCOMES.iter().position(|other| other == name).unwrap();
        names.iter().map(place).collect()
    };
    let motions: Vec<usize> = (0..7).collect();
    none(
        &alike(&kinds(Field::Outcome, &motions)),
        "outcomes of motions",
    );
    let mut ends: Vec<usize> = (7..OUTCOMES.len()).collect();
    ends.extend(numbers(&["lift-off"]));
    none(&alike(&kinds(Field::Outcome, &ends)), "ends of stick-slip");
    none(&alike(&kinds(Field::Regime, &[0, 1, 2, 3, 4])), "regimes");
    let few = ["0", "1", "2", "3"].into_iter().zip(0..);
    let few = few.map(|(name, n)| (name, colour::of_kind(Field::Windows, f64::from(n))));
    none(&alike(&few.chain(GAPS).collect::<Vec<_>>()), "small counts");
}

/// With more than five lines, each has its value written beside it.
#[test]
fn lines_and_what_lies_below_them() {
    const NAMES: [&str; 5] = ["0", "1", "2", "3", "4"];
    for n in 2..=NAMES.len() {
        let lines = (0..n).map(|i| (NAMES[i], colour::of_line(i, n)));
        let lines: Vec<Named> = lines.chain([("paper", PAPER)]).collect();
        none(&alike(&lines), "lines");
    }
    let below = [("paper", PAPER), ("stable", colour::STABLE_TINT)];
    none(&alike(&[&below[..], &GAPS].concat()), "below lines");
    let of_traces = [
        ("velocity", colour::of_line(0, 3)),
        ("pulling velocity", colour::of_line(2, 3)),
        ("spring force", colour::PULLING_FORCE),
        ("friction force", colour::FRICTION_FORCE),
        ("marks", colour::SOFT_INK),
        ("sticks", colour::STUCK),
        ("paper", PAPER),
        ("lift-off", UNSTABLE[3]),
    ];
    none(&alike(&of_traces), "traces");
}

#[test]
fn lines_over_cells_are_seen() {
    for ground in [UNKNOWN, NO_VALUE, PAPER] {
        assert!(difference(HATCH, ground).0 > 3.0 * APART);
    }
    for ground in [STABLE, UNSTABLE[0], PAPER] {
        assert!(difference(INK, ground).0 > 3.0 * APART, "boundaries");
    }
}

/// Larger values are lighter for everybody; two-sided scales are lightest in the middle.
#[test]
fn colour_maps_are_monotone_in_lightness() {
    for (sight, matrix) in SIGHTS {
        for map in ColourMap::ALL {
            let lightness = |i: i32| seen(map.at(f64::from(i) / 64.0), &matrix).l;
            for i in 0..64 {
                let rises = lightness(i + 1) - lightness(i);
                let monotone = match (map.has_two_sides(), i) {
                    // The middle itself.
                    (true, 31 | 32) => rises.abs() < 1.0,
                    (true, 33..) => rises < 0.0,
                    _ => rises > 0.0,
                };
                assert!(monotone, "{} at {i}, {sight}: {rises}", map.name());
            }
        }
    }
}
