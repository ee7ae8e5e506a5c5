//! The picture of a point, `slipmap point --plot`: what stands in it is what the point's numbers
//! say.

use serde_json::Value;

use crate::program::{self, Folder, err, expect, out};

/// Roots that the picture shows, pairs counted once.
const ROOTS: usize = 14;

/// Where marks stand in a picture, in its units.
pub(crate) struct Svg(pub(crate) String);

impl Svg {
    /// The numbers of an attribute.
    fn numbers(line: &str, name: &str) -> Vec<f64> {
        let start = line.find(&format!(" {name}=\"")).unwrap() + name.len() + 3;
        let text = line[start..].split('"').next().unwrap();
        let numbers = text.split([',', ' ']).filter(|n| !n.is_empty());
        numbers.map(|n| n.parse().unwrap()).collect()
    }

    /// The middles of all dots of a diameter.
    pub(crate) fn dots(&self, diameter: f64) -> Vec<(f64, f64)> {
        let lines = self.0.lines().filter(|l| l.starts_with("<polyline"));
        let dots = lines.filter(|l| Self::numbers(l, "stroke-width") == [10.0 * diameter]);
        let middle = |line| {
            let p = Self::numbers(line, "points");
            (0.5 * (p[0] + p[2]), p[1])
        };
        dots.map(middle).collect()
    }

    /// Where upright dashed lines are, from left to right in the order of drawing, each once.
    pub(crate) fn uprights(&self) -> Vec<f64> {
        let lines = self.0.lines().filter(|l| l.starts_with("<polyline"));
        let thin = lines.filter(|l| Self::numbers(l, "stroke-width") == [18.0]);
        let points = thin.map(|line| Self::numbers(line, "points"));
        let upright = points.filter(|p| p.len() == 4 && p[0] == p[2] && p[1] != p[3]);
        let mut places: Vec<f64> = upright.map(|p| p[0]).collect();
        places.dedup();
        places
    }

    /// Left and right ends of all rectangles of a colour.
    fn boxes(&self, colour: &str) -> Vec<(f64, f64)> {
        let lines = self.0.lines().filter(|l| l.starts_with("<rect"));
        let of = lines.filter(|l| l.contains(&format!("fill=\"{colour}\"")));
        let ends = |line| {
            let at = |name| Self::numbers(line, name)[0];
            (at("x"), at("x") + at("width"))
        };
        of.map(ends).collect()
    }
}

fn drawn(folder: &Folder, args: &[&str]) -> (Value, Svg) {
    let all = [&["point"], args, &["--plot", "point.svg", "--json"]].concat();
    let output = folder.run(&all);
    expect(&output, 0, "\"abscissa\"");
    let roots = ROOTS.to_string();
    let more = folder.run(&[&["point"], args, &["--json", "--roots", &roots]].concat());
    assert_eq!(err(&more), "");
    let text = std::fs::read_to_string(folder.path().join("point.svg")).unwrap();
    (program::json(&more), Svg(text))
}

/// The straight line through (p, q) and another such pair.
fn line(p: (f64, f64), q: (f64, f64)) -> impl Fn(f64) -> f64 {
    move |x| p.1 + (x - p.0) * (q.1 - p.1) / (q.0 - p.0)
}

const FIG_3A: [&str; 10] = [
    "--friction",
    "weakening",
    "--mu0=0.5",
    "--v-s=0.5",
    "--v0=0.35",
    "--alpha-v=-0.33",
    "--tau=4.15",
    "--mass=2",
    "--stiffness=2",
    "--normal-load=2",
];

/// Every root that the closed form's JSON lists has its dot, with its conjugate, at its place: all
/// places follow from those of two roots.
#[test]
fn roots_and_stable_delays_stand_where_they_are() {
    let folder = Folder::new();
    for args in [
        &FIG_3A[..],
        &["--mu-prime=-0.3", "--alpha-v=-0.33", "--tau=9"],
        &["--mu-prime=-0.2", "--alpha-v=-0.4", "--tau=3"],
        &["--system=pi_loop", "--tau=2"],
    ] {
        let (told, svg) = drawn(&folder, args);
        let roots: Vec<[f64; 2]> = serde_json::from_value(told["roots"].clone()).unwrap();
        assert_eq!(roots.len(), ROOTS);
        let pairs = roots.iter().filter(|root| root[1] > 0.0).count();
        // Beside the roots: the point on the steps, and two entries of the legend.
        let dots = svg.dots(11.0);
        assert_eq!(dots.len(), ROOTS + pairs + 3, "{args:?}");
        let (plane, others) = dots.split_at(ROOTS + pairs);
        // From the left, so that the rightmost ones lie above all others.
        let first = plane[plane.len() - 1];
        let last = plane[0];
        let (r, l) = (roots[0], roots[ROOTS - 1]);
        assert!(l[1] > 0.0 && r[1] > 0.0, "pairs, for the scale");
        let across = line((r[0], first.0), (l[0], last.0));
        let up = line((-r[1], first.1), (l[1], last.1));
        for [re, im] in &roots {
            for im in [*im, -im] {
                let at = (across(*re), up(im));
                let near = |dot: &&(f64, f64)| (dot.0 - at.0).hypot(dot.1 - at.1) < 12.0;
                assert!(plane.iter().any(|dot| near(&dot)), "{re} {im}: {plane:?}");
            }
        }
        // The unstable half-plane begins on the imaginary axis, and right of it lie the unstable.
        let half = svg.boxes("#F7EAC9")[0];
        assert!((half.0 - across(0.0)).abs() < 12.0, "{half:?}");
        let unstable = plane.iter().filter(|dot| dot.0 > half.0).count() as u64;
        assert_eq!(told["n_unstable"], unstable);
        // A ring around the rightmost, and in the legend.
        assert_eq!(svg.dots(23.0).len(), 3);
        assert_stable_delays(&told, &svg, others[0]);
    }
}

/// Stable delays are shaded between their ends, which the delay's own place and one end fix.
fn assert_stable_delays(told: &Value, svg: &Svg, here: (f64, f64)) {
    let stable: Vec<[f64; 2]> = serde_json::from_value(told["stable_delays"].clone()).unwrap();
    let mut boxes = svg.boxes("#B7E0DB");
    // The last one is the legend's.
    boxes.pop();
    assert_eq!(boxes.len(), stable.len());
    let tau = told["tau"].as_f64().unwrap();
    let across = line((tau, here.0), (stable[0][1], boxes[0].1));
    for (interval, shaded) in stable.iter().zip(&boxes) {
        let [from, to] = interval.map(&across);
        assert!((from - shaded.0).abs() < 12.0, "{interval:?} {shaded:?}");
        assert!((to - shaded.1).abs() < 12.0, "{interval:?} {shaded:?}");
    }
}

#[test]
fn a_cell_of_a_map_is_drawn_in_its_units() {
    let sweep = "[axes]\nalpha_v = [-0.5, -0.2]\ntau = [1, 2, 3]\n[fixed]\nmu_prime = -0.1\n\
                 [units]\nforce = \"N\"\nlength = \"mm\"\ntime = \"ms\"\n";
    let folder = Folder::with(&[("map.toml", sweep)]);
    expect(&folder.run(&["run", "map.toml"]), 0, "6 cells");
    let cell = [
        "point",
        "--map",
        "map.h5",
        "--at",
        "alpha_v=-0.2",
        "--at",
        "tau=3",
    ];
    let plot = |name| folder.run(&[&cell[..], &["--plot", name]].concat());
    let output = plot("cell.svg");
    expect(&output, 0, "continuous sliding is");
    assert!(out(&output).ends_with("cell.svg\n"));
    let text = std::fs::read_to_string(folder.path().join("cell.svg")).unwrap();
    // Blanks beside one another are drawn as those that no line ends at.
    let text = text.replace('\u{a0}', " ");
    for label in ["Re λ  (ms⁻¹)", "Im λ  (rad ms⁻¹)", "  (ms)", " = 3 ms"] {
        assert!(text.contains(label), "{label}: {text}");
    }
    let before = folder.files();
    expect(
        &plot("cell.jpg"),
        2,
        "--plot cell.jpg is no name for a picture",
    );
    expect(&plot("map.h5"), 2, "no name for a picture");
    expect(&plot("no/cell.png"), 1, "no/cell.png");
    assert_eq!(folder.files(), before);
}

/// Pairs that stand alone, places on the imaginary axis, very long delays: something is drawn, and
/// nothing takes long.
#[test]
fn odd_points_are_drawn() {
    let folder = Folder::new();
    for args in [
        ["--mu-prime=-0.3", "--alpha-v=0", "--tau=2"],
        ["--mu-prime=0", "--alpha-v=0", "--tau=2"],
        ["--mu-prime=0", "--alpha-v=-0.1", "--tau=0"],
        ["--mu-prime=-0.3", "--alpha-v=-0.33", "--tau=1e9"],
        ["--mu-prime=-3e-7", "--alpha-n=-0.00001", "--tau=1"],
        ["--mu-prime=1e6", "--alpha-n=-1e9", "--tau=1e-3"],
    ] {
        let name = ["--plot", "odd.png"];
        let output = folder.run(&[&["point"], &args[..], &name].concat());
        expect(&output, 0, "odd.png");
        let picture = std::fs::read(folder.path().join("odd.png")).unwrap();
        assert!(picture.starts_with(b"\x89PNG"), "{args:?}");
    }
}
