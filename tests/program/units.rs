//! Numbers with units, in flags and in files: what they are turned into, what is told of them, and
//! which are refused. The line of inputs with which answers begin.

use serde_json::Value;

use crate::program::{self, Folder, err, expect, out};

const RIG: &str = "--friction weakening --mu0 0.5 --v-s 50mm/s --mass 2.4kg --stiffness 9.5N/mm \
    --normal-load 50N --v0 1mm/s --alpha-n=-5.5N/mm --tau 5ms";

fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

fn json(folder: &Folder, line: &str) -> Value {
    let output = folder.run(&words(&format!("{line} --json")));
    expect(&output, 0, "");
    program::json(&output)
}

#[test]
fn flags_with_units_are_numbers_of_the_si() {
    let folder = Folder::new();
    let plain = "--friction weakening --mu0 0.5 --v-s 0.05 --mass 2.4 --stiffness 9500 \
        --normal-load 50 --v0 0.001 --alpha-n=-5500 --tau 0.005 --units SI";
    for command in ["point", "margins", "vc"] {
        let [with, without] = [RIG, plain].map(|of| json(&folder, &format!("{command} {of}")));
        assert_eq!(with, without);
        assert_eq!(with["inputs"]["units"], serde_json::json!(["N", "m", "s"]));
    }
    // In millimetres the same numbers are other ones.
    let mm = json(&folder, &format!("point {RIG} --units N,mm,s"));
    for (name, value) in [
        ("v0", 1.0),
        ("v_s", 50.0),
        ("mass", 0.0024),
        ("stiffness", 9.5),
        ("alpha_n", -5.5),
        ("tau", 0.005),
    ] {
        assert_eq!(mm["inputs"][name], value, "{name}");
    }
    let [si, mm] = [json(&folder, &format!("point {RIG}")), mm].map(|of| of["abscissa"].as_f64());
    let (si, mm) = (si.unwrap(), mm.unwrap());
    assert!((si - mm).abs() < 1e-9 * si.abs(), "{si} {mm}");
}

#[test]
fn an_answer_tells_its_inputs() {
    let folder = Folder::new();
    let line = |args: &str| {
        let output = folder.run(&words(args));
        expect(&output, 0, "inputs: ");
        let told = out(&output);
        let mut lines = told.lines().filter(|line| line.starts_with("inputs: "));
        lines.next().unwrap().to_owned()
    };
    let period = "free period 2 pi sqrt(mass/stiffness) = 0.0998674 s";
    let rig = format!(
        "inputs: alpha_v = 0 s-1, alpha_n = -5500 N m-1, tau = 0.005 s, v0 = 0.001 m s-1, \
         mass = 2.4 kg, stiffness = 9500 N m-1, normal_load = 50 N, mu0 = 0.5, \
         v_s = 0.05 m s-1, mu_s = 1, friction = weakening; {period}, \
         friction force mu_k normal_load = 24.5098 N"
    );
    for command in ["point", "margins", "basin --starts 64"] {
        assert_eq!(line(&format!("{command} {RIG}")), rig);
    }
    let motion = line(&format!("simulate {RIG} --x-dot0 0"));
    assert!(motion.contains("x_dot0 = 0 m s-1"), "{motion}");
    let vc = line(&format!("vc {RIG}"));
    let force = format!("{period}, static friction force mu_s normal_load = 50 N");
    assert!(vc.ends_with(&force) && !vc.contains("v0"), "{vc}");
    let best = line("best --mu-prime=-0.3 --normal-load 2");
    assert_eq!(
        best,
        "inputs: mu_prime = -0.3, normal_load = 2; free period 2 pi sqrt(mass/stiffness) = \
         6.28319, friction force mu_k normal_load = 2"
    );
}

#[test]
fn units_that_do_not_fit_are_refused() {
    let folder = Folder::new();
    for (flags, says) in [
        (
            "--v0 3kg",
            "--v0 <V0>': kg is no unit of velocity (length/time); type",
        ),
        (
            "--v0 3mm",
            "mm is no unit of velocity (length/time); type a number and its unit, such as 3 mm/s",
        ),
        ("--v0 3 mm", "as in 3mm, or in quotes"),
        (
            "--v0 3mm/s --mass 2.4kgg",
            "no unit \"kgg\" is known here; did you mean `kg`?",
        ),
        (
            "--v0 3mm/s --mu-s 2mm",
            "mm is a unit of length, and this is a number without one",
        ),
        ("--v0 fast", "such as 2.5mm/s"),
        (
            "--v0 3mm/s --units bar,m,s",
            "the declared unit \"bar\" is not known as a unit of force",
        ),
        (
            "--v0 3mm/s --units dimensionless",
            "all numbers here are dimensionless",
        ),
    ] {
        let line = format!("point --friction coulomb --mu0 0.3 --tau 0 {flags}");
        expect(&folder.run(&words(&line)), 2, says);
    }
    let line = "point --friction coulomb --mu0 0.3 --v0 1 --units N,mm,s --line";
    expect(
        &folder.run(&[&words(line)[..], &["1 mm"]].concat()),
        2,
        "rate (1/time)",
    );
    let best = "best --mu-prime=-0.3 --control load --units SI --alpha-to 3s";
    expect(
        &folder.run(&words(best)),
        2,
        "--alpha-to 3 s: s is no unit of stiffness",
    );
    let system = "point --system pd --tau 3ms";
    expect(&folder.run(&words(system)), 2, "system from a file");
}

const SWEEP: &str = r#"fields = ["n_unstable", "abscissa", "basin_share"]
degree_of_stability = ["1 1/s"]
[axes]
v0 = { from = "20 mm/s", to = "40 mm/s", points = 2 }
alpha_n = [-6000, "-5.5 N/mm"]
tau = ["1 ms", 0.02]
[fixed]
mass = "2.4 kg"
stiffness = "9.5 kN/m"
normal_load = 50
[friction]
law = "weakening"
mu0 = 0.5
v_s = "5 cm/s"
[simulation]
horizon = "0.5 min"
[basin]
starts = 64
x_dot0 = { from = 0, to = "100 mm/s" }
"#;

/// The same sweep with numbers of the SI alone.
fn plain(sweep: &str) -> String {
    let mut text = format!("units = \"SI\"\n{sweep}");
    for (amount, number) in [
        ("1 1/s", "1"),
        ("20 mm/s", "0.02"),
        ("40 mm/s", "0.04"),
        ("-5.5 N/mm", "-5500"),
        ("1 ms", "0.001"),
        ("2.4 kg", "2.4"),
        ("9.5 kN/m", "9500"),
        ("5 cm/s", "0.05"),
        ("0.5 min", "30"),
        ("100 mm/s", "0.1"),
    ] {
        let amount = format!("\"{amount}\"");
        assert!(text.contains(&amount), "{amount}");
        text = text.replace(&amount, number);
    }
    text
}

#[test]
fn a_sweep_with_units_is_the_map_of_its_numbers() {
    let folder = Folder::with(&[("with.toml", SWEEP), ("without.toml", &plain(SWEEP))]);
    let assumed = "all others are in N, m, s and kg";
    for sweep in ["with", "without"] {
        let run = folder.run(&["run", &format!("{sweep}.toml")]);
        expect(&run, 0, "8 cells");
        assert_eq!(
            err(&run).contains(assumed),
            sweep == "with",
            "{}",
            err(&run)
        );
    }
    for table in ["cells", "boundaries"] {
        let [with, without] = ["with.h5", "without.h5"].map(|map| {
            let told = folder.run(&["export", map, "--table", table, "--comments", "-o", "-"]);
            let text = out(&told);
            let rows = text.lines().filter(|line| !line.starts_with('#'));
            rows.map(String::from).collect::<Vec<_>>()
        });
        assert!(with == without && !with.is_empty(), "{table}: {with:?}");
    }
    let info = folder.run(&["info", "with.h5"]);
    expect(
        &info,
        0,
        "alpha_n              2 points, -6000 to -5500 N m-1",
    );
    // The text of the sweep is kept as it is.
    let sweep = out(&folder.run(&["info", "with.h5", "--sweep"]));
    assert!(sweep.contains("\"-5.5 N/mm\""), "{sweep}");
}

#[test]
fn a_case_with_units_is_followed_in_them() {
    let units = "units = { force = \"N\", length = \"mm\", time = \"ms\" }\n";
    let case = "switch_on = \"70 ms\"\nhorizon = \"1 s\"\n\
        fixed = { v0 = \"1 m/s\", mass = \"2 kg\", stiffness = \"2 N/mm\", normal_load = \"10 N\" }\n\
        friction = { law = \"coulomb\", mu0 = 0.3 }\nstart = { x_dot0 = \"0.5 m/s\" }\n\
        trace = { until = \"0.2 s\", interval = \"5 ms\" }\n";
    let folder = Folder::with(&[("mm.toml", &format!("{units}{case}")), ("si.toml", case)]);
    let [mm, si] = ["mm", "si"].map(|name| json(&folder, &format!("simulate {name}.toml")));
    for (told, length, time, mass) in [(&mm, 1e3, 1e3, 2e3), (&si, 1.0, 1.0, 2.0)] {
        let case = &told["inputs"]["case"];
        let parameters = &case["parameters"];
        assert_eq!(case["horizon"], time, "{case}");
        assert_eq!(case["start"]["x_dot0"].as_f64(), Some(0.5 * length / time));
        assert_eq!(parameters["mass"], mass, "{case}");
    }
    let [mm, si] = [mm, si].map(|told| told["peak_force"].as_f64().unwrap());
    assert!((mm - si).abs() < 1e-9 * si && si > 3.0, "{mm} {si}");
}

#[test]
fn mistakes_of_units_in_files_are_pointed_at() {
    for (key, says) in [
        (
            "v0 = \"3 kg\"",
            "fixed.v0: kg is no unit of velocity (length/time)",
        ),
        (
            "v0 = \"3\"",
            "a number without a unit stands without quotes",
        ),
        (
            "v0 = \"fast\"",
            "or a number and its unit, such as \"1.5 mm/s\"",
        ),
        ("v0 = \"3 mm/second\"", "no unit \"second\" is known here"),
        ("v0 = \"3 kg/m s\"", "can be read in two ways"),
        ("mu_k = \"3 m\"", "this is a number without one"),
        ("v0 = \"1e300 km/s\"", "v0 = 1e303 is outside its range"),
        ("v0 = \"1e307 km/s\"", "1e307 km/s is too large a number"),
    ] {
        let text = format!("[fixed]\n{key}\n[friction]\nlaw = \"coulomb\"\nmu0 = 0.3\n");
        let folder = Folder::with(&[("case.toml", &text)]);
        expect(&folder.run(&["simulate", "case.toml"]), 2, says);
    }
    let text = "[fixed]\nv0 = \"3 m/s\"\n[friction]\nlaw = \"coulomb\"\nmu0 = 0.3\n";
    for (units, says) in [
        (
            "units = \"dimensionless\"\n",
            "all numbers here are dimensionless",
        ),
        (
            "units = { force = \"bar\", length = \"m\", time = \"s\" }\n",
            "\"bar\" is not known",
        ),
        (
            "units = { force = \"N\", length = \"s\", time = \"m\" }\n",
            "as a unit of length",
        ),
        ("units = { force = \"N\" }\n", "all three"),
    ] {
        let folder = Folder::with(&[("case.toml", &format!("{units}{text}"))]);
        expect(&folder.run(&["simulate", "case.toml"]), 2, says);
    }
}
