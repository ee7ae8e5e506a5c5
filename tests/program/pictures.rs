//! What `slipmap plot` and the pictures of a run promise: which file, which scale, which colours.

#[cfg(target_os = "linux")]
use std::process::Command;

use crate::program::{self, Folder, err, expect, out};

const SWEEP: &str = "title = \"small\"\nfields = [\"n_unstable\", \"delay_margin\", \"abscissa\", \
                     \"frequency\", \"relaxation_time\"]\n[axes]\nalpha_v = { from = -1, to = 0, \
                     points = 21 }\ntau = { from = 0.5, to = 6, points = 23 }\n[fixed]\nmu_prime = \
                     -0.3\n";

fn bytes(folder: &Folder, name: &str) -> Vec<u8> {
    std::fs::read(folder.path().join(name)).unwrap()
}

fn text(folder: &Folder, name: &str) -> String {
    String::from_utf8(bytes(folder, name)).unwrap()
}

fn mapped() -> Folder {
    let folder = Folder::with(&[("m.toml", SWEEP)]);
    expect(&folder.run(&["run", "m.toml"]), 0, "m.png");
    folder
}

/// The run's picture of `m.vc.h5` has the name that `plot m.h5 --field vc` would give its own.
#[test]
fn a_picture_of_something_else_is_not_replaced() {
    let folder = mapped();
    let other = ["run", "m.toml", "-o", "m.frequency.h5"];
    expect(&folder.run(&other), 0, "m.frequency.png");
    let before = bytes(&folder, "m.frequency.png");
    let plot = ["plot", "m.h5", "--field", "frequency"];
    let refused = folder.run(&plot);
    expect(
        &refused,
        2,
        "m.frequency.png is there and a picture of m.frequency.h5",
    );
    expect(&refused, 2, "-o draws elsewhere");
    assert_eq!(bytes(&folder, "m.frequency.png"), before);
    let asked = [&plot[..], &["-o", "m.frequency.png"]].concat();
    expect(&folder.run(&asked), 0, "m.frequency.png");
    assert_ne!(
        bytes(&folder, "m.frequency.png"),
        before,
        "it was asked for by name"
    );
    // Now it is a run that would replace the other's.
    let again = ["run", "m.toml", "-o", "m.frequency.h5", "--fresh"];
    let warned = folder.run(&again);
    expect(
        &warned,
        0,
        "no picture: m.frequency.png is there and a picture of m.h5 field=frequency",
    );
}

/// Enough cells for several tiles.
const TILES: &str = "fields = [\"abscissa\"]\n[axes]\nalpha_v = { from = -1, to = 0, points = 200 }\n\
                     tau = { from = 0.5, to = 6, points = 200 }\n[fixed]\nmu_prime = -0.3\n";

/// Computes one shard of two.
fn half(folder: &Folder) {
    let args = ["run", "t.toml", "--shard", "1/2"];
    expect(&folder.run(&args), 0, "shard 1 of 2 is complete");
}

/// Completes the map.
fn finish(folder: &Folder) -> std::process::Output {
    let args = ["run", "t.toml", "--shard", "2/2"];
    expect(&folder.run(&args), 0, "shard 2 of 2 is complete");
    folder.run(&["merge", "t.h5"])
}

/// A picture of what is computed so far makes way for that of the complete map.
#[test]
fn the_final_picture_replaces_one_of_the_unfinished_map() {
    let folder = Folder::with(&[("t.toml", TILES)]);
    half(&folder);
    let plotted = folder.run(&["plot", "t.h5"]);
    expect(&plotted, 0, "t.png");
    expect(&plotted, 0, "t.h5 is not complete");
    let before = bytes(&folder, "t.png");
    let plotted = folder.run(&["plot", "t.h5"]);
    expect(&plotted, 0, "t.png");
    assert_eq!(bytes(&folder, "t.png"), before, "again the same");
    let finished = finish(&folder);
    expect(&finished, 0, "t.png");
    assert!(!err(&finished).contains("no picture"), "{}", err(&finished));
    let complete = bytes(&folder, "t.png");
    assert_ne!(complete, before);
    std::fs::remove_file(folder.path().join("t.png")).unwrap();
    expect(&folder.run(&["plot", "t.h5"]), 0, "t.png");
    assert_eq!(bytes(&folder, "t.png"), complete);
}

/// A file that slipmap did not draw of this map stays.
#[test]
fn work_of_others_is_not_replaced_by_a_finished_run() {
    let folder = Folder::with(&[("t.toml", TILES)]);
    half(&folder);
    std::fs::write(folder.path().join("t.png"), "mine").unwrap();
    expect(
        &folder.run(&["plot", "t.h5"]),
        2,
        "t.png is there and not by slipmap",
    );
    expect(
        &finish(&folder),
        0,
        "no picture: t.png is there and not by slipmap",
    );
    assert_eq!(text(&folder, "t.png"), "mine");
}

/// How a picture looks does not make it another one.
#[test]
fn the_same_field_is_drawn_again_in_its_place() {
    let folder = mapped();
    let plot = |title: &str| {
        let args = ["plot", "m.h5", "--field", "abscissa", "--title", title];
        expect(&folder.run(&args), 0, "m.abscissa.titled.png");
        bytes(&folder, "m.abscissa.titled.png")
    };
    assert_ne!(plot("A"), plot("B"));
    // The name of a run's picture, for another field than the run's.
    std::fs::rename(
        folder.path().join("m.abscissa.titled.png"),
        folder.path().join("m.png"),
    )
    .unwrap();
    expect(
        &folder.run(&["plot", "m.h5"]),
        2,
        "m.png is there and a picture of m.h5 field=abscissa",
    );
}

#[test]
fn another_picture_key_draws_the_picture_of_a_complete_map_again() {
    let folder = mapped();
    let drawn = bytes(&folder, "m.png");
    let run = |sweep: &str| {
        std::fs::write(folder.path().join("m.toml"), sweep).unwrap();
        let output = folder.run(&["run", "m.toml"]);
        expect(&output, 0, "m.h5 is already complete");
        out(&output).contains("m.png")
    };
    assert!(!run(SWEEP), "nothing has changed");
    let named = format!("picture = \"frequency\"\n{SWEEP}");
    assert!(run(&named));
    let of_frequency = bytes(&folder, "m.png");
    assert_ne!(of_frequency, drawn);
    assert!(!run(&named));
    assert_eq!(bytes(&folder, "m.png"), of_frequency);
    assert!(run(SWEEP), "the key is gone");
    assert_eq!(bytes(&folder, "m.png"), drawn);
}

#[test]
fn scales_are_as_asked() {
    let folder = mapped();
    let svg = |options: &[&str]| {
        let args = [&["plot", "m.h5", "-o", "m.svg"], options].concat();
        expect(&folder.run(&args), 0, "m.svg");
        text(&folder, "m.svg")
    };
    let frequency = ["--field", "frequency"];
    let usual = svg(&frequency);
    assert!(!usual.contains("above"));
    let narrow = svg(&["--field", "frequency", "--range", "0.9,1"]);
    assert!(narrow.contains("above 1") && narrow.contains("below 0.9"));
    let abscissa = svg(&["--field", "abscissa", "--range", "-0.01,0.02"]);
    assert!(abscissa.contains("above 0.02") && abscissa.contains("below −0.01"));
    assert_ne!(
        usual,
        svg(&["--field", "frequency", "--colour-map", "cividis"])
    );
    assert_ne!(
        svg(&["--field", "abscissa"]),
        svg(&["--field", "abscissa", "--colour-map", "PuOr"])
    );
    assert_ne!(usual, svg(&["--field", "frequency", "--log"]));
    let bare = svg(&["--field", "frequency", "--no-legend"]);
    let said = |text: &str| text.matches("frequency").count();
    assert_eq!(
        said(&bare) + 1,
        said(&usual),
        "the bar's heading is gone, the title stays"
    );
    // Along one axis the range is that of the ordinate.
    let line = ["--field", "frequency", "--at", "tau=2"];
    let narrow = svg(&[&line[..], &["--range", "0.7,0.9"]].concat());
    assert_ne!(svg(&line), narrow);
    for cut in ["above 0.9 at the upper edge", "below 0.7 at the lower edge"] {
        assert!(narrow.contains(cut) && !svg(&line).contains(cut), "{cut}");
    }
}

const VC: &str = "fields = [\"n_unstable\", \"vc\", \"outcome\", \"regime\"]\n[axes]\n\
                  alpha_n = [-10, -5, -1]\ntau = [0.2, 0.5, 1]\n[fixed]\nv0 = 0.2\n[friction]\n\
                  law = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";

/// An outcome beside critical velocities is another one; regimes along a line stand by their names
/// at the axis.
#[test]
fn pictures_tell_what_the_map_holds() {
    let folder = Folder::with(&[("vc.toml", VC)]);
    expect(&folder.run(&["run", "vc.toml"]), 0, "9 cells");
    let svg = |options: &[&str]| {
        let args = [&["plot", "vc.h5", "-o", "vc.svg"], options].concat();
        expect(&folder.run(&args), 0, "vc.svg");
        text(&folder, "vc.svg")
    };
    let outcome = svg(&["--field", "outcome"]);
    assert!(outcome.contains("How stick-slip ends"), "{outcome}");
    assert!(!outcome.contains("otion"), "{outcome}");
    // The sweep has no title: what it shows unasked is headed generally, another field is not.
    assert!(svg(&[]).contains("The critical velocity"));
    let n_unstable = svg(&["--field", "n_unstable"]);
    assert!(n_unstable.contains("Number of characteristic roots"));
    let regimes = svg(&["--field", "regime", "--at", "tau=0.5"]);
    for says in ["stable", "bistable", "unstable", "linearly stable"] {
        assert!(regimes.lines().any(|line| line == says), "{says}");
    }
    assert!(!regimes.contains("0: stable"), "{regimes}");
    let csv = folder.run(&["export", "vc.h5", "--comments"]);
    expect(&csv, 0, "# outcome: how stick-slip ends");
}

#[test]
fn what_an_option_cannot_mean_is_said() {
    let folder = mapped();
    let field = |field: &'static str, options: &[&'static str], says: &str| {
        let args = [&["plot", "m.h5", "-o", "x.png", "--field", field], options].concat();
        expect(&folder.run(&args), 2, says);
    };
    field(
        "abscissa",
        &["--log"],
        "--log has no meaning in this picture",
    );
    field(
        "abscissa",
        &["--colour-map", "viridis"],
        "these do: BrBG, PuOr",
    );
    field(
        "frequency",
        &["--colour-map", "BrBG"],
        "these do: viridis, cividis, plasma",
    );
    field(
        "n_unstable",
        &["--range", "0,2"],
        "each of its values has a colour of its own",
    );
    field(
        "frequency",
        &["--range", "2,1"],
        "--range: the range 2 to 1 is none",
    );
    field("frequency", &["--range", "0,nan"], "is none");
    field(
        "frequency",
        &["--range", "3"],
        "expected LOW,HIGH, for example 0,0.5",
    );
    field(
        "frequency",
        &["--range", "0,1", "--log"],
        "begins above 0, not at 0",
    );
    field(
        "frequency",
        &["--colour-map", "jet"],
        "possible values: viridis",
    );
    field(
        "abscissa",
        &["--at", "tau=4", "--log"],
        "a logarithmic scale has no place for that",
    );
    field(
        "abscissa",
        &["--at", "tau=2", "--colour-map", "BrBG"],
        "it shows lines, not cells",
    );
    assert_eq!(folder.files(), ["m.h5", "m.h5.log", "m.png", "m.toml"]);
}

/// Shapes and text, not an image.
#[test]
fn a_pdf_has_text_in_a_font_of_its_own() {
    let folder = mapped();
    let args = ["plot", "m.h5", "-o", "m.pdf"];
    expect(&folder.run(&args), 0, "m.pdf");
    let pdf = bytes(&folder, "m.pdf");
    assert!(pdf.starts_with(b"%PDF-"));
    let has = |word: &str| pdf.windows(word.len()).any(|part| part == word.as_bytes());
    assert!(has("DejaVuSans") && has("/FontFile2") && has("/ToUnicode"));
    assert!(!has("/Subtype /Image") && !has("/Subtype/Image"));
    expect(&folder.run(&args), 0, "m.pdf");
    assert_eq!(bytes(&folder, "m.pdf"), pdf, "the same bytes each time");
    let refused = folder.run(&["plot", "m.h5", "-o", "m.jpg"]);
    expect(&refused, 2, "it must end in .png, .svg or .pdf");
}

/// Infinite values are at the edge of a line's panel, not gaps.
#[test]
fn infinities_along_a_line_are_told() {
    let folder = mapped();
    let args = [
        "plot",
        "m.h5",
        "--field",
        "relaxation_time",
        "--at",
        "tau=4",
        "-o",
        "m.svg",
    ];
    expect(&folder.run(&args), 0, "m.svg");
    assert!(text(&folder, "m.svg").contains("∞ at the upper edge, unstable"));
}

/// The preview of a run on a terminal.
#[cfg(target_os = "linux")]
#[test]
fn the_preview_has_colours_as_color_says() {
    let preview = |color: &str, no_color: Option<&str>| {
        let folder = Folder::with(&[("m.toml", SWEEP)]);
        let program = env!("CARGO_BIN_EXE_slipmap");
        let shell = format!("{program} run m.toml --color {color}");
        let mut command = Command::new("script");
        command.args(["-qec", &shell, "/dev/null"]);
        command.current_dir(folder.path()).env_remove("NO_COLOR");
        if let Some(value) = no_color {
            command.env("NO_COLOR", value);
        }
        let output = program::output(&mut command);
        assert!(output.status.success(), "{}", err(&output));
        let text = out(&output);
        assert!(text.contains("unstable"), "{text}");
        text.contains("\u{1b}[38;5;")
    };
    assert!(preview("auto", None));
    assert!(!preview("auto", Some("1")));
    assert!(preview("always", Some("1")));
    assert!(!preview("never", None));
}

/// A picture is as wide as it is printed, and its text as large, in every format; a title and the
/// lines below it can be left out.
#[test]
fn a_picture_fits_the_column_of_a_journal() {
    let folder = mapped();
    let plot = |name: &str, more: &[&str]| {
        let args = [&["plot", "m.h5", "--width=86mm", "-o", name], more].concat();
        expect(&folder.run(&args), 0, name);
    };
    let number = |file: &[u8], at: usize| u32::from_be_bytes(file[at..at + 4].try_into().unwrap());
    plot("a.png", &["--dpi=600"]);
    let png = bytes(&folder, "a.png");
    assert_eq!([number(&png, 16), number(&png, 20)], [2031, 1397]);
    let chunk = png.windows(4).position(|word| word == b"pHYs").unwrap();
    // 600 in an inch, in a metre.
    assert_eq!(number(&png, chunk + 4), 23_622);
    plot("a.svg", &["--font=8pt"]);
    let svg = text(&folder, "a.svg");
    assert!(
        svg.starts_with("<svg width=\"86mm\" height=\"59.08"),
        "{svg:.80}"
    );
    // Texts are in tenths of a pixel, of which 300 are an inch.
    let size = |points: f64| points / 72.0 * 3000.0;
    let sizes = svg.split("font-size=\"").skip(1);
    let sizes = sizes.map(|rest| rest.split_once('"').unwrap().0.parse::<f64>().unwrap());
    let numbers = sizes.filter(|of| (of - size(8.0)).abs() < 1.0);
    assert!(numbers.count() > 9, "{svg}");
    let heads = |svg: &str| ["small", "dimensionless"].map(|text| svg.contains(text));
    assert_eq!(heads(&svg), [true; 2]);
    plot("bare.svg", &["--title", "", "--no-subtitle"]);
    let bare = text(&folder, "bare.svg");
    assert_eq!(heads(&bare), [false; 2]);
    plot("a.pdf", &["--size=1000x1000"]);
    let pdf = String::from_utf8_lossy(&bytes(&folder, "a.pdf")).into_owned();
    let sheet = pdf
        .split_once("/MediaBox [")
        .unwrap()
        .1
        .split_once(']')
        .unwrap()
        .0;
    let sides: Vec<f64> = sheet
        .split_whitespace()
        .map(|n| n.parse().unwrap())
        .collect();
    for side in &sides[2..] {
        assert!((side - 86.0 / 25.4 * 72.0).abs() < 0.1, "{sheet}");
    }
}

#[test]
fn a_sheet_that_cannot_be_is_refused() {
    let folder = mapped();
    for (args, says) in [
        (&["--width=86"][..], "expected a length from 10 mm to 1 m"),
        (&["--dpi=300"], "--width <LENGTH>"),
        (
            &["--width=86mm", "--font=40"],
            "there is no room for panels",
        ),
        (
            &["--width=86mm", "--size=1x1"],
            "--size: a picture of 1 × 1",
        ),
        (&["--width=20mm"], "--width: a picture of 236"),
        (
            &["--width=300mm", "--dpi=1200"],
            "--dpi makes it finer or coarser",
        ),
    ] {
        let refused = folder.run(&[&["plot", "m.h5", "-o", "b.png"], args].concat());
        expect(&refused, 2, says);
    }
    let named = folder.run(&["plot", "m.h5", "--width=3.5in", "--no-subtitle"]);
    expect(&named, 0, "m.88.9mm.no-subtitle.png");
}

/// A long motion has its switch-on enlarged, and its legend names what is seen.
#[test]
fn a_switch_on_is_enlarged_and_legends_name_what_is_seen() {
    let case = "switch_on = 100\n[fixed]\nv0 = 0.35\nalpha_v = -0.33\ntau = 4.15\n[friction]\n\
                law = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n[start]\nx_dot0 = 0\na0 = 0.9\n\
                [trace]\nuntil = 400\n";
    let once = "[fixed]\nv0 = 0.35\nviscous = 0.3\n[friction]\nlaw = \"coulomb\"\nmu0 = 0.5\n\
                mu_s = 0.5\n[start]\nx_dot0 = 0\na0 = 0.2\n[trace]\nuntil = UNTIL\n\
                interval = 0.5\n";
    let [brief, long] = ["20", "3000"].map(|until| once.replace("UNTIL", until));
    let damped = case.replace("[fixed]", "[fixed]\ndamping = 0.02");
    let folder = Folder::with(&[
        ("c.toml", case),
        ("damped.toml", &damped),
        ("brief.toml", &brief),
        ("long.toml", &long),
    ]);
    for name in ["c", "damped", "brief", "long"] {
        expect(
            &folder.run(&["simulate", &format!("{name}.toml")]),
            0,
            ".h5",
        );
    }
    let svg = |name: &str, more: &[&str]| {
        let of = format!("{name}.h5");
        let args = [&["plot", &of, "-o", "p.svg"], more].concat();
        expect(&folder.run(&args), 0, "p.svg");
        text(&folder, "p.svg")
    };
    let (framed, marked) = ("framed on the left", "control switched on");
    let whole = svg("c", &[]);
    assert!(whole.contains(framed) && whole.contains(marked));
    // Times of the close-up, from 93.7 to 118.8.
    assert!(whole.contains("\n105\n"));
    for (stretch, switched_on) in [
        (["--from=90", "--to=130"], true),
        (["--from=1", "--to=99"], false),
    ] {
        let part = svg("c", &stretch);
        assert!(!part.contains(framed), "{stretch:?}");
        assert_eq!(part.contains(marked), switched_on, "{stretch:?}");
    }
    assert!(!svg("c", &["--width=86mm"]).contains(framed));
    let damped = svg("damped", &[]);
    assert!(damped.contains("force of spring and dashpot") && !damped.contains("spring force"));
    let sticks = "the block sticks";
    assert!(svg("brief", &[]).contains(sticks));
    assert!(
        !svg("long", &[]).contains(sticks),
        "a stick of a quarter of a pixel"
    );
    assert!(svg("long", &["--to=20"]).contains(sticks));
}

/// A stretch of a trace is shown as such, and fits a column without its portrait.
#[test]
fn a_stretch_of_a_motion_is_shown() {
    let case = "[fixed]\nv0 = 0.35\nalpha_v = -0.33\ntau = 4.15\n[friction]\nlaw = \"weakening\"\n\
                mu0 = 0.5\nv_s = 0.5\n[start]\nx_dot0 = 0\n[trace]\nuntil = 60\n";
    let folder = Folder::with(&[("c.toml", case), ("m.toml", SWEEP)]);
    expect(&folder.run(&["simulate", "c.toml"]), 0, "c.h5");
    let svg = |more: &[&str]| {
        let args = [&["plot", "c.h5", "-o", "c.svg"], more].concat();
        expect(&folder.run(&args), 0, "c.svg");
        text(&folder, "c.svg")
    };
    // Numbers below the panels, of time.
    let tells = |svg: &str, number: &str| svg.contains(&format!("\n{number}\n"));
    let whole = svg(&[]);
    let part = svg(&["--from", "32", "--to", "38"]);
    assert!(tells(&whole, "60") && !tells(&whole, "33"));
    assert!(tells(&part, "33") && !tells(&part, "60"));
    assert!(whole.contains("elongation a") && whole.contains("even sliding at v"));
    for named in [
        "spring force",
        "friction force",
        "deviation",
        "the block sticks",
    ] {
        assert!(whole.contains(named), "{named}");
    }
    // Plain words have symbols as the letter sets them.
    assert!(!whole.contains("v0"));
    let column = svg(&["--width=86mm"]);
    assert!(tells(&column, "a") && !column.contains("even sliding at v"));
    assert!(!column.contains("spring force") && !column.contains("deviation"));
    expect(&folder.run(&["run", "m.toml"]), 0, "m.png");
    for (args, says) in [
        (
            &["c.h5", "--from=70"][..],
            "no two samples in this stretch of time: the trace ends at t = 60",
        ),
        (&["c.h5", "--from=5", "--to=4"], "no two samples"),
        (
            &["c.h5", "--width=86mm", "--font=40"],
            "there is no room for panels",
        ),
        (&["m.h5", "--from=1"], "--from has no meaning for a map"),
    ] {
        expect(
            &folder.run(&[&["plot", "-o", "x.png"], args].concat()),
            2,
            says,
        );
    }
    expect(&folder.run(&["plot", "c.h5", "--to=30"]), 0, "c.to=30.png");
}
