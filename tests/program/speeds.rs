//! Speeds of rotations whose period is the delay: as an axis, of a point, in tables and pictures.

use crate::general_rows::{Row, rows};
use crate::program::{self, Folder, err, expect, out};

/// Turning with one mode of the natural frequency `omega`.
const SPINDLE: &str = "title = \"Spindle\"\nP = \"s^2 + 2*zeta*omega*s + omega^2*(1 + w)\"\n\
    Q = \"-omega^2*w\"\nspeed_axis = { name = \"spindle speed\", unit = \"rpm\" }\n\
    [parameters]\nzeta = 0.05\nomega = { default = 600, unit = \"rad/s\" }\nw = 0.1\n";

const LOBES: &str = "system = \"spindle.toml\"\nfields = [\"n_unstable\", \"abscissa\"]\n\
    picture = \"n_unstable\"\nboundaries = true\nunits = \"SI\"\n\
    [axes]\nw = { from = 0.0, to = 0.3, points = 7 }\n\
    rpm = { from = 1000, to = 6000, points = 41 }\n";

fn folder() -> Folder {
    Folder::with(&[("spindle.toml", SPINDLE), ("lobes.toml", LOBES)])
}

fn run(folder: &Folder, sweep: &str) {
    let args = ["run", sweep, "-o", "map.h5", "--quiet", "--fresh"];
    expect(&folder.run(&args), 0, "");
}

/// The text of an answer.
fn told(folder: &Folder, args: &[&str]) -> String {
    let output = folder.run(args);
    assert_eq!(output.status.code(), Some(0), "{args:?}: {}", err(&output));
    out(&output)
}

fn exported(folder: &Folder, more: &[&str]) -> Vec<Row> {
    rows(
        "map.h5",
        &told(folder, &[&["export", "map.h5"], more].concat()),
    )
}

/// The system of a row of `tests/reference/general_chatter.csv`, whose time is in 1/omega: its
/// delay is 17.474839, here 0.02 s.
#[test]
fn a_point_at_a_speed_is_that_of_its_period() {
    let folder = folder();
    let omega = 17.474839 / 0.02;
    let sets = ["zeta=0.01085", "w=0.0475408", &format!("omega={omega}")];
    let mut args = vec!["point", "--system", "spindle.toml", "--units", "SI"];
    args.extend(sets.iter().flat_map(|set| ["--set", set]));
    let at = |more: &[&str]| told(&folder, &[&args[..], more].concat());
    let by_speed = at(&["--rpm", "3000", "--json"]);
    assert_eq!(by_speed, at(&["--tau", "0.02", "--json"]));
    assert_eq!(by_speed, at(&["--tau", "20ms", "--json"]));
    let answer: serde_json::Value = serde_json::from_str(&by_speed).unwrap();
    assert_eq!(
        (&answer["tau"], &answer["n_unstable"]),
        (&0.02.into(), &2.into())
    );
    assert_eq!(answer["inputs"]["units"][2], "s");
    let abscissa = answer["abscissa"].as_f64().unwrap();
    assert!((abscissa / (0.007_598_967_152_464_854 * omega) - 1.0).abs() < 1e-11);
    let text = at(&["--rpm", "3000"]);
    for line in [
        "  tau              0.02 s\n",
        "  spindle speed    3000 rpm\n",
        // 60 omega/3.4857734875298524909, and over 5.7925877605478547477 and 9.5057965381106563699.
        "  stable speeds    spindle speed > 15039.6 rpm\n",
        "  stable speeds    5515.01 rpm < spindle speed < 9050.28 rpm\n",
    ] {
        assert!(text.contains(line), "{line}{text}");
    }
}

/// Values are evenly spaced in the speed; the table has it beside the delay, and so have curves.
#[test]
fn a_speed_is_an_axis_of_a_sweep() {
    let folder = folder();
    run(&folder, "lobes.toml");
    expect(&folder.run(&["verify", "map.h5"]), 0, "");
    let cells = exported(&folder, &["--at", "w=0.2"]);
    assert_eq!(cells.len(), 41);
    for (place, row) in cells.iter().enumerate() {
        let speed = 6000.0 - 125.0 * place as f64;
        assert_eq!(row.number("rpm"), Some(speed));
        assert_eq!(row.number("tau"), Some(60.0 / speed));
        let by_point = told(
            &folder,
            &[
                "point",
                "--system",
                "spindle.toml",
                "--units",
                "SI",
                "--set",
                "w=0.2",
                "--json",
                "--rpm",
                &speed.to_string(),
            ],
        );
        let point: serde_json::Value = serde_json::from_str(&by_point).unwrap();
        let apart = row.or_zero("abscissa") - point["abscissa"].as_f64().unwrap();
        assert!(apart.abs() < 1e-9, "{speed}: {apart}");
    }
    // Each lobe is lowest at w = 2 zeta (1 + zeta) and (omega/600)² = 1 + 2 zeta, the second at
    // omega tau = 4 pi - acos(1/21).
    let omega = 600.0 * 1.1_f64.sqrt();
    let tau = (4.0 * std::f64::consts::PI - (1.0_f64 / 21.0).acos()) / omega;
    let curves = exported(&folder, &["--table", "boundaries"]);
    let of_lobe = |row: &&Row| (3000.0..4000.0).contains(&row.or_zero("rpm"));
    let all = curves.iter().filter(of_lobe);
    let lowest = all
        .min_by(|a, b| a.or_zero("w").total_cmp(&b.or_zero("w")))
        .unwrap();
    assert!(
        (lowest.or_zero("w") - 0.105).abs() < 1e-3,
        "{}",
        lowest.place
    );
    assert!(
        (lowest.or_zero("rpm") * tau / 60.0 - 1.0).abs() < 0.02,
        "{}",
        lowest.place
    );
    let comments = told(&folder, &["export", "map.h5", "--comments"]);
    assert!(
        comments.contains("\n# rpm [rpm]: spindle speed\n"),
        "{comments}"
    );
    let at = [
        "point", "--map", "map.h5", "--at", "w=0.2", "--at", "tau=0.02",
    ];
    assert!(told(&folder, &at).contains("  spindle speed    3000 rpm\n"));
    let plot = ["plot", "map.h5", "-o", "map.svg"];
    expect(&folder.run(&plot), 0, "");
    let picture = std::fs::read_to_string(folder.path().join("map.svg")).unwrap();
    assert!(["spindle speed", "(rpm)", "3000"].map(|said| picture.contains(said)) == [true; 3]);
}

/// The value of `--at` may be a speed, whatever the unit of the axis of the system.
#[test]
fn an_axis_is_held_at_a_speed() {
    let folder = folder();
    run(&folder, "lobes.toml");
    let at = |given: &str| told(&folder, &["export", "map.h5", "--at", given]);
    let held = at("tau=0.02");
    assert_eq!(held.lines().count(), 8);
    for speed in ["rpm=3000", "Hz=50", "rad/s=314.16"] {
        assert_eq!(at(speed), held, "{speed}");
    }
    let point = ["point", "--map", "map.h5", "--at", "w=0.2"];
    let of_point = |given| told(&folder, &[&point[..], &["--at", given]].concat());
    assert_eq!(of_point("rpm=3000"), of_point("tau=0.02"));
    let line = |given: &str| {
        let args = ["plot", "map.h5", "--at", given, "-o", "line.svg"];
        expect(&folder.run(&args), 0, "");
        std::fs::read_to_string(folder.path().join("line.svg")).unwrap()
    };
    assert_eq!(line("rpm=3000"), line("tau=0.02"));
    let named = folder.run(&["plot", "map.h5", "--at", "rad/s=314.16"]);
    expect(&named, 0, "");
    let picture = folder.path().join("map.rad_per_s=314.16.png");
    assert!(picture.exists(), "{}", err(&named));
    let twice = ["export", "map.h5", "--at", "tau=0.02", "--at", "rpm=3000"];
    expect(&folder.run(&twice), 2, "--at rpm=3000: tau is given twice");
    // Between two speeds of the map the nearer one, whatever delay is nearer: 1000 and 1125 rpm.
    assert_eq!(at("rpm=1060"), at("rpm=1000"));
    assert_ne!(at("rpm=1060"), at("rpm=1125"));
    for (given, says) in [
        (
            "rpm=9000",
            "--at rpm=9000: tau=0.006666666666666667 is outside",
        ),
        ("rpm=0", "0 rpm is outside its range: greater than 0"),
        ("rpm=50Hz", "Hz is a unit of rate (1/time)"),
    ] {
        for command in ["export", "plot"] {
            let refused = folder.run(&[command, "map.h5", "--at", given]);
            expect(&refused, 2, says);
        }
    }
}

/// 60/τ needs seconds: dimensionless numbers have no rpm, wherever they are shown.
#[test]
fn without_units_no_speed_has_one() {
    let folder = folder();
    let lobes = "system = \"turning\"\nfields = [\"n_unstable\"]\n[axes]\n\
        width = [0.0, 0.1, 0.3]\ntau = { from = 1.0, to = 16.0, points = 31 }\n";
    std::fs::write(folder.path().join("plain.toml"), lobes).unwrap();
    run(&folder, "plain.toml");
    expect(&folder.run(&["plot", "map.h5", "-o", "map.svg"]), 0, "");
    let picture = std::fs::read_to_string(folder.path().join("map.svg")).unwrap();
    assert!(
        picture.contains("spindle speed") && picture.contains("2π/τ"),
        "{picture}"
    );
    let line = ["plot", "map.h5", "--at", "width=0.1", "-o", "line.svg"];
    expect(&folder.run(&line), 0, "");
    let line = std::fs::read_to_string(folder.path().join("line.svg")).unwrap();
    let table = told(&folder, &["export", "map.h5", "--comments"]);
    let curves = told(&folder, &["export", "map.h5", "--table", "boundaries"]);
    let point = told(&folder, &["point", "--system", "turning", "--tau", "8.5"]);
    let of_map = [
        "point",
        "--map",
        "map.h5",
        "--at",
        "width=0.1",
        "--at",
        "tau=8.5",
    ];
    let of_map = told(&folder, &of_map);
    for text in [picture, line, table, curves, point, of_map] {
        assert!(!text.contains("rpm"), "{text}");
    }
    for (args, says) in [
        (&["--rpm", "3000"][..], "dimensionless"),
        (&["--rpm", "0", "--units", "SI"], "greater than 0"),
        (
            &["--rpm", "3000", "--tau", "1", "--units", "SI"],
            "tau is given twice",
        ),
    ] {
        let output = folder.run(&[&["point", "--system", "turning"], args].concat());
        assert_eq!(output.status.code(), Some(2));
        assert!(err(&output).contains(says), "{}", err(&output));
    }
    let no_axis = ["point", "--system", "pd", "--rpm", "3000", "--units", "SI"];
    expect(&folder.run(&no_axis), 2, "period of a rotation");
    for command in ["export", "plot"] {
        let refused = folder.run(&[command, "map.h5", "--at", "rpm=3000"]);
        expect(&refused, 2, "rpm needs the unit of time");
        assert!(err(&refused).contains("type the delay: --at tau=VALUE"));
    }
    let rpm = lobes.replace("tau = {", "rpm = {");
    std::fs::write(folder.path().join("rpm.toml"), rpm).unwrap();
    let refused = folder.run(&["plan", "rpm.toml"]);
    let message = err(&refused);
    assert_eq!(refused.status.code(), Some(2));
    assert!(message.contains("rpm.toml:5:1") && message.contains("needs the unit of time"));
}

/// Where more stable delays follow than are told, so do speeds.
#[test]
fn how_many_more_speeds_are_stable_is_told() {
    let folder = folder();
    let args = "point --system spindle.toml --units SI --rpm 3000 --set w=0.11 --set zeta=0.052";
    let text = told(&folder, &args.split(' ').collect::<Vec<_>>());
    let of = |name: &str| text.lines().filter(|line| line.contains(name)).count();
    assert_eq!(
        (of("stable delays"), of("stable speeds")),
        (12, 12),
        "{text}"
    );
    let further = |end: &str| {
        let line = text.lines().find(|line| line.ends_with(end));
        let number = line.and_then(|line| line.trim().strip_prefix("and ")?.split(' ').next());
        number.and_then(|number| number.parse::<u32>().ok())
    };
    let delays = further("further intervals (--json lists them)");
    assert!(delays.is_some_and(|more| more > 0), "{text}");
    assert_eq!(further("(--json lists their delays)"), delays, "{text}");
}

/// The best setting of a system has the units that are said, and the speed of its delay.
#[test]
fn best_settings_are_told_in_units() {
    let folder = folder();
    let best = |more: &str| {
        let args = "best --system spindle.toml --search w --search-from 0.2 --search-to 0.3";
        told(
            &folder,
            &format!("{args} {more}").split(' ').collect::<Vec<_>>(),
        )
    };
    let text = best("--units SI --tau-from 10ms --tau-to 30ms");
    let rows: Vec<(&str, &str)> = text
        .lines()
        .filter_map(|line| Some((line.get(2..18)?.trim(), line.get(19..)?)))
        .collect();
    let row = |name: &str| rows.iter().find(|row| row.0 == name).unwrap().1;
    let number = |name: &str, unit: &str| -> f64 {
        let number = row(name).strip_suffix(unit);
        number
            .unwrap_or_else(|| panic!("{name}: {text}"))
            .parse()
            .unwrap()
    };
    let turns = number("tau", " s") * number("spindle speed", " rpm");
    assert!((turns / 60.0 - 1.0).abs() < 1e-7, "{text}");
    assert_eq!(row("omega"), "600 rad/s");
    assert!(number("abscissa", " s-1") < 0.0);
    assert!(number("delay_margin", " s") > 0.0);
    assert_eq!(row("searched"), "w 0.2 to 0.3, tau 0.01 s to 0.03 s");
    let plain = best("--tau-from 0.01 --tau-to 0.03");
    assert!(!plain.contains("rpm") && !plain.contains(" s\n"), "{plain}");
    let json = |more: &str| -> serde_json::Value {
        serde_json::from_str(&best(&format!("{more} --json"))).unwrap()
    };
    let in_units = json("--units SI --tau-from 10ms --tau-to 30ms");
    assert_eq!(in_units["inputs"]["units"][2], "s");
    assert_eq!(
        in_units["best"],
        json("--tau-from 0.01 --tau-to 0.03")["best"]
    );
    let late = "best --system letter --search alpha_v --search-from=-1 --search-to=0 --tau-from 1 \
        --tau-to 6 --set mu_prime=-0.3 --memory 0.3 --latency 0.1 --units SI";
    let late = told(&folder, &late.split_whitespace().collect::<Vec<_>>());
    assert!(late.contains("  memory           0.3\n"), "{late}");
    assert!(late.contains("  latency          0.1 s\n"), "{late}");
    let args = [
        "best",
        "--system",
        "spindle.toml",
        "--search",
        "w",
        "--tau-to",
        "3ms",
    ];
    expect(&folder.run(&args), 2, "--units SI");
}

/// Delays in ms have the same speeds, and lengths in mm are told in mm.
#[test]
fn axes_have_the_declared_units() {
    let folder = folder();
    let units = "units = { force = \"N\", length = \"mm\", time = \"ms\" }";
    let in_ms = LOBES.replace("units = \"SI\"", units);
    let in_ms = in_ms + "[fixed]\nomega = 0.6\n";
    std::fs::write(folder.path().join("ms.toml"), in_ms).unwrap();
    run(&folder, "ms.toml");
    let row = &exported(&folder, &["--at", "w=0.2", "--at", "tau=20ms"])[0];
    assert_eq!(
        (row.number("tau"), row.number("rpm")),
        (Some(20.0), Some(3000.0))
    );
    let block = "fields = [\"n_unstable\"]\n[axes]\nv0 = [\"1 mm/s\", \"2 mm/s\", \"3 mm/s\"]\n\
        tau = { from = 0, to = 1, points = 5 }\n[fixed]\nalpha_n = \"-1 N/mm\"\n\
        [friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = \"1 mm/s\"\n\
        [units]\nforce = \"N\"\nlength = \"mm\"\ntime = \"s\"\n";
    std::fs::write(folder.path().join("block.toml"), block).unwrap();
    run(&folder, "block.toml");
    expect(&folder.run(&["plot", "map.h5", "-o", "map.svg"]), 0, "");
    let picture = std::fs::read_to_string(folder.path().join("map.svg")).unwrap();
    assert!(picture.contains("(mm s⁻¹)"), "{picture}");
    assert!(program::json(&folder.run(&["info", "map.h5", "--json"]))["units"]["v0"] == "mm s-1");
}
