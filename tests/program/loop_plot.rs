//! The pictures of a loop, `slipmap margins --nyquist --bode`, marks stand
//! where the margins in numbers say.

use serde_json::Value;

use crate::point_plot::Svg;
use crate::program::{self, Folder, err, expect};

/// Diameters of the marks of margins, and of the ring about −1.
const DOT: f64 = 13.0;
const RING: f64 = 19.5;

/// The loops, each with how many ends its gain margin has.
const LOOPS: [(&[&str], usize); 3] = [
    (&["--system", "pi_loop", "--tau=1"], 1),
    (
        &[
            "--system",
            "pd",
            "--set",
            "stiffness=-1",
            "--set",
            "k_p=2",
            "--set",
            "k_d=2",
            "--tau=0.1",
        ],
        2,
    ),
    (&["--mu-prime=-0.3", "--alpha-v=-0.33", "--tau=4.15"], 2),
];

fn drawn(folder: &Folder, args: &[&str], flag: &str) -> (Value, Svg) {
    let output = folder.run(&[&["margins"], args, &[flag, "loop.svg", "--json"]].concat());
    expect(&output, 0, "\"gain_margin\"");
    let text = std::fs::read_to_string(folder.path().join("loop.svg")).unwrap();
    (program::json(&output), Svg(text))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

/// −1 and the end of the gain margin, −1/k on the real axis, give the scale of the plane. The mark of
/// the phase margin is at the distance 1 from 0 then, that of the modulus margin at its own from −1.
#[test]
fn marks_stand_in_the_plane_where_the_margins_are() {
    let folder = Folder::new();
    for (args, ends) in LOOPS {
        let (told, svg) = drawn(&folder, args, "--nyquist");
        let critical = svg.dots(RING)[0];
        let marks = svg.dots(DOT);
        let [gain, phase, modulus] = [0, ends, ends + 1].map(|i| marks[i]);
        let end = if ends == 2 { "lower" } else { "upper" };
        let factor = number(&told["gain_margin"][end]);
        let unit = (gain.0 - critical.0) / (1.0 - 1.0 / factor);
        assert!(
            unit > 0.0 && (gain.1 - critical.1).abs() < 0.02 * unit,
            "{args:?}"
        );
        let plane = |mark: (f64, f64)| {
            let (re, im) = (mark.0 - critical.0, critical.1 - mark.1);
            (re / unit - 1.0, im / unit)
        };
        let (re, im) = plane(phase);
        assert!((re.hypot(im) - 1.0).abs() < 0.02, "{args:?}: {re} {im}");
        let angle = number(&told["phase_margin"]);
        assert!(
            (im.abs().atan2(-re) - angle).abs() < 0.02,
            "{args:?}: {re} {im} {angle}"
        );
        let (re, im) = plane(modulus);
        let distance = number(&told["modulus_margin"]);
        assert!(
            ((re + 1.0).hypot(im) - distance).abs() < 0.02,
            "{args:?}: {re} {im}"
        );
    }
}

/// Over the frequency, marks at gain and phase crossings are as far apart as the logarithms of their
/// frequencies.
#[test]
fn marks_stand_over_the_frequency_where_the_margins_are() {
    let folder = Folder::new();
    for (args, _) in LOOPS {
        let (told, svg) = drawn(&folder, args, "--bode");
        let lines = svg.uprights();
        let of = &told["crossing_frequencies"];
        let told = [
            number(&of["gain_margin"]["lower"]),
            number(&of["gain_margin"]["upper"]),
            number(&of["phase_margin"]),
            number(&of["modulus_margin"]),
        ];
        let told: Vec<f64> = told.into_iter().filter(|omega| *omega > 0.0).collect();
        assert!(
            told.len() >= 3 && lines.len() >= 2 * told.len(),
            "{args:?} {lines:?}"
        );
        // The first and the second mark give the scale.
        let decade = (lines[1] - lines[0]) / (told[1] / told[0]).log10();
        for (x, omega) in lines.iter().zip(&told) {
            let expected = lines[0] + decade * (omega / told[0]).log10();
            assert!((x - expected).abs() < 12.0, "{args:?}: {x} {expected}");
        }
    }
}

/// What has no loop, and names that are no pictures, are refused before anything is written.
#[test]
fn what_has_no_loop_is_told() {
    let folder = Folder::new();
    for (args, said) in [
        (
            "--system pi_loop --tau 1 --nyquist loop.txt",
            "no name for a picture",
        ),
        (
            "--system pi_loop --tau 1 --nyquist a.svg --bode a.svg",
            "the same file",
        ),
        (
            "--system ring_road --tau 0.1 --bode a.svg",
            "there is no loop to draw",
        ),
        (
            "--mu-prime 0.3 --alpha-v 0 --tau 1 --bode a.svg",
            "there is no loop to draw",
        ),
    ] {
        let args: Vec<&str> = std::iter::once("margins").chain(args.split(' ')).collect();
        let output = folder.run(&args);
        assert!(!output.status.success(), "{args:?}");
        assert!(err(&output).contains(said), "{args:?}: {}", err(&output));
        assert!(!folder.path().join("a.svg").exists(), "{args:?}");
    }
}
