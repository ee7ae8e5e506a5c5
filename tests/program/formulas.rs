//! Friction laws that are formulas, by the program: in flags, case files and sweeps, and what is
//! refused.

use serde_json::Value;

use crate::program::{self, Folder, err, expect, out};

const LAW: &str = "law = \"formula\"\nmu_k = \"mu0 + (mu_s - mu0)*exp(-(v/v_s)^delta) + sigma*v\"\n\
    mu0 = 0.3\nv_s = 0.2\n";

/// The `point` of some flags as JSON.
fn point(folder: &Folder, flags: &[&str]) -> Value {
    let output = folder.run(&[&["point", "--json"], flags].concat());
    expect(&output, 0, "");
    program::json(&output)
}

/// The same law by its name and as a formula, and its slope worked out here.
#[test]
fn a_formula_says_what_the_law_of_its_form_says() {
    let folder = Folder::new();
    let given = [
        "--v0",
        "0.15",
        "--mu0",
        "0.3",
        "--v-s",
        "0.2",
        "--alpha-n=-2",
        "--tau",
        "0.6",
    ];
    let slope = |mu: f64, at: f64| (mu - 0.3) * at;
    let q = 0.15_f64 / 0.2;
    let by_hand = [
        (
            "weakening",
            "mu0/(1 + v/v_s)",
            -0.3 / 0.2 / (1.0 + q).powi(2),
        ),
        (
            "stribeck",
            "mu0 + (mu_s - mu0)*exp(-(v/v_s)^2)",
            slope(1.0, -2.0 * q / 0.2 * (-q * q).exp()),
        ),
        (
            "hyperbolic",
            "mu0 + (mu_s - mu0)/cosh(v/v_s)",
            slope(1.0, -q.tanh() / q.cosh() / 0.2),
        ),
    ];
    for (law, formula, expected) in by_hand {
        let named = point(&folder, &[&["--friction", law], &given[..]].concat());
        let formula = point(
            &folder,
            &[&["--friction", "formula", "--mu-k", formula], &given[..]].concat(),
        );
        for answer in [&named, &formula] {
            let slope = answer["mu_prime"].as_f64().unwrap();
            assert!(
                (slope - expected).abs() < 1e-13,
                "{law}: {slope} {expected}"
            );
        }
        let [one, other] = [&named, &formula].map(|of| of["abscissa"].as_f64().unwrap());
        assert!((one - other).abs() < 1e-12, "{law}");
        assert_eq!(named["n_unstable"], formula["n_unstable"]);
    }
}

/// Own parameters are axes, stand in the map with their units, and a cell is asked again by the
/// command that its point tells.
#[test]
fn own_parameters_are_axes_of_maps() {
    let axes = "fields = [\"n_unstable\", \"abscissa\"]\n[axes]\ndelta = [0.5, 1, 2]\n\
        sigma = [0, \"100 s/km\"]\ntau = [0.2, 0.6, 1.4]\n[fixed]\nv0 = \"150 mm/s\"\n\
        alpha_n = -2\n[friction]\n";
    let folder = Folder::with(&[("map.toml", &(axes.to_owned() + LAW))]);
    let run = |args: &[&str]| {
        let output = folder.run(args);
        expect(&output, 0, "");
        out(&output)
    };
    run(&["run", "map.toml", "-o", "map.h5"]);
    let csv = run(&["export", "map.h5"]);
    let rows: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    let column = |name: &str| {
        let found = rows[0]
            .iter()
            .position(|title| title.split_whitespace().next() == Some(name));
        found.unwrap_or_else(|| panic!("{name} in {:?}", rows[0]))
    };
    let [delta, sigma, tau, count] = ["delta", "sigma", "tau", "n_unstable"].map(column);
    assert_eq!(rows.len(), 1 + 3 * 2 * 3);
    for row in &rows[1..] {
        let sets = [
            format!("delta={}", row[delta]),
            format!("sigma={}", row[sigma]),
        ];
        let answer = point(
            &folder,
            &[
                "--friction",
                "formula",
                "--mu-k",
                "mu0 + (mu_s - mu0)*exp(-(v/v_s)^delta) + sigma*v",
                "--set",
                &sets[0],
                "--set",
                &sets[1],
                "--mu0=0.3",
                "--v-s=0.2",
                "--v0=0.15",
                "--alpha-n=-2",
                "--tau",
                row[tau],
            ],
        );
        assert_eq!(answer["n_unstable"].to_string(), row[count], "{row:?}");
    }
    let sigmas = rows[1..]
        .iter()
        .map(|row| row[sigma].parse::<f64>().unwrap());
    assert_eq!(sigmas.fold(0.0, f64::max), 0.1);
    let at = ["--at=delta=2", "--at", "sigma=100 s/km", "--at=tau=0.6"];
    for command in ["point", "margins"] {
        let told = run(&[&[command, "--map", "map.h5"], &at[..]].concat());
        assert!(told.contains("sigma = 0.1 m-1 s;"), "{told}");
    }
    let info = run(&["info", "map.h5"]);
    assert!(info.contains("formula") && info.contains("sigma"), "{info}");
}

/// Each mistake, with what is said of it.
#[test]
fn mistakes_in_formulas_are_told_in_their_place() {
    let ok = "sigma = 0.1\ndelta = 1.5\n";
    let with = |law: &str| format!("[axes]\ntau = [1]\nv0 = [1, 2]\n[friction]\n{law}");
    for (law, says) in [
        (format!("{LAW}{ok}sgima = 1\n"), "did you mean `sigma`?"),
        (
            format!("{LAW}delta = 1.5\n"),
            "sigma is not given: mu_k has it",
        ),
        (format!("{LAW}{ok}sigma = 2\n"), "sigma"),
        (
            format!("{LAW}{ok}").replace("exp", "exq"),
            "did you mean `exp`? known: sqrt, exp, ln, log, sin, cos, sinh, cosh, tanh, atan",
        ),
        (
            format!("{LAW}{ok}").replace("sigma*v", "mass*v"),
            "mass is reserved",
        ),
        (
            format!("{LAW}{ok}").replace("sigma*v", "min(v, 1)"),
            "min and max have kinks",
        ),
        (
            format!("{LAW}{ok}").replace("0.1", "-0.4"),
            "at the speed 1 is outside its range",
        ),
        (
            format!("{LAW}{ok}").replace("sigma*v", "sigma*ln(v)"),
            "at the speed 0",
        ),
        (
            format!("{LAW}{ok}").replace("sigma*v", "3*sigma"),
            "at most mu_s = 1",
        ),
        ("law = \"formula\"\nmu0 = 0.3\n".into(), "mu_k is not given"),
        (
            format!(
                "{LAW}{ok}units = {{ sigma = \"s/mm\" }}\n[units]\nforce = \"N\"\nlength = \"m\"\n\
            time = \"s\"\n"
            ),
            "1 s/mm is 1000 m-1 s",
        ),
        (
            format!("{LAW}units = {{ sigma = \"s2/m\" }}\n{ok}").replace("0.1", "\"0.1 s/m\""),
            "s/m is no unit of",
        ),
        (
            format!("{LAW}{ok}units = {{ sgima = \"s/m\" }}\n"),
            "did you mean `sigma`?",
        ),
    ] {
        let folder = Folder::with(&[("map.toml", &with(&law))]);
        let output = folder.run(&["plan", "map.toml"]);
        expect(&output, 2, "");
        let error = err(&output);
        let words = error.split_whitespace().filter(|word| *word != "│");
        let one_line = words.collect::<Vec<_>>().join(" ");
        assert!(one_line.contains(says), "{law}: {error}");
        assert!(!one_line.contains(", min"), "{law}: {error}");
    }
}

/// What the flag of a formula leaves open, and how it is told again.
#[test]
fn formulas_in_flags_are_completed_and_told_in_one_line() {
    let folder = Folder::new();
    let line = ["point", "--friction=formula", "--v0=0.5", "--mu-k"];
    let open = folder.run(&[&line[..], &["a + 0.1*v"]].concat());
    expect(&open, 2, "a is not given: mu_k has it as a parameter");
    expect(&open, 2, "help: add --set a=VALUE");
    let broken = folder.run(&[&line[..], &["0.3 +\n  0.1*v\r\n"]].concat());
    expect(&broken, 0, "");
    let told = out(&broken);
    let mut inputs = told.lines().filter(|line| line.starts_with("inputs: "));
    let inputs = inputs.next().unwrap();
    assert!(inputs.contains("mu_k = 0.3 + 0.1*v; free period"), "{told}");
}

/// A map of 8 cells, whose first axis is `own`, of the formula `mu_k`.
fn own_map(own: &str, mu_k: &str) -> String {
    format!(
        "fields = [\"n_unstable\", \"abscissa\"]\nboundaries = false\n[axes]\n{own}\n\
         tau = [0.2, 1]\n[fixed]\nv0 = 0.5\nalpha_n = -2\n[friction]\nlaw = \"formula\"\n\
         mu_k = \"{mu_k}\"\n"
    )
}

/// Where μ_K is at most 0 at v0, above μ_S at rest, or no number, a cell of a map says that it has
/// no value, and a point says why.
#[test]
fn cells_without_a_coefficient_say_so() {
    for (own, mu_k, with, why) in [
        (
            "sigma = [-1, -0.7, -0.5, 0.2]",
            "0.3 + sigma*v",
            &[-0.5, 0.2][..],
            "at the speed 0.5",
        ),
        (
            "rest = [0.4, 0.9, 1.1, 2]",
            "0.2 + (rest - 0.2)*exp(-v/0.3)",
            &[0.4, 0.9],
            "at most mu_s",
        ),
        (
            "u = [-1, 0.3, 0.6, 2]",
            "0.5 + 0.1*ln(u - v)",
            &[0.6, 2.0],
            "at the speed",
        ),
    ] {
        let folder = Folder::with(&[("map.toml", &own_map(own, mu_k))]);
        expect(&folder.run(&["run", "map.toml", "-q"]), 0, "map.h5");
        let verified = folder.run(&["verify", "map.h5", "--cells", "8"]);
        expect(&verified, 0, "0 differ");
        let info = out(&folder.run(&["info", "map.h5"]));
        assert!(info.contains("outside_model  4 cells"), "{info}");
        let csv = out(&folder.run(&["export", "map.h5"]));
        assert_eq!(csv.lines().count(), 1 + 8);
        for row in csv.lines().skip(1) {
            let row: Vec<&str> = row.split(',').collect();
            let name = own.split(' ').next().unwrap();
            let at = [format!("{name}={}", row[0]), format!("tau={}", row[1])];
            let asked = ["--map", "map.h5", "--at", &at[0], "--at", &at[1]];
            if with.contains(&row[0].parse().unwrap()) {
                let certified = slipmap::linear::status::CERTIFIED.to_string();
                assert_eq!(row.last(), Some(&&*certified), "{row:?}");
                assert!(!row[2].is_empty() && !row[3].is_empty(), "{row:?}");
            } else {
                assert_eq!(row[2..], ["", "", "", "64"]);
                let told = folder.run(&[&["point"], &asked[..]].concat());
                expect(&told, 2, "outside its range");
                assert!(err(&told).contains(why), "{}", err(&told));
            }
        }
    }
}

/// Without v0 the critical velocity has no value there, and a sweep without any coefficient is
/// refused.
#[test]
fn critical_velocities_without_a_coefficient_say_so() {
    let text = "fields = [\"vc\", \"outcome\"]\n[axes]\nrest = [0.5, 1.1]\n[fixed]\n\
        alpha_n = -8\ntau = 0.3\n[friction]\nlaw = \"formula\"\nmu_k = \"rest - 0.2*v\"\n";
    let folder = Folder::with(&[
        ("map.toml", text),
        ("none.toml", &text.replace("0.5, ", "1.2, ")),
    ]);
    expect(&folder.run(&["run", "map.toml", "-q"]), 0, "");
    let csv = out(&folder.run(&["export", "map.h5"]));
    let rows: Vec<&str> = csv.lines().skip(1).collect();
    assert!(!rows[0].ends_with(",64"), "{csv}");
    assert_eq!(rows[1], "1.1,,,64");
    let refused = folder.run(&["run", "none.toml"]);
    expect(&refused, 2, "is outside its range: at most mu_s = 1");
    expect(&refused, 2, "at rest = 1.2");
}

/// The critical velocity by some flags of the formula law.
fn critical_velocity(folder: &Folder, law: &[&str]) -> Value {
    let line = [
        "vc",
        "--json",
        "--friction",
        "formula",
        "--alpha-n=-8",
        "--tau=0.3",
        "--mu-s=0.6",
    ];
    let output = folder.run(&[&line[..], law].concat());
    expect(&output, 0, "");
    program::json(&output)
}

/// The same law in several writings, narrow beside the velocities of the block: parts of two of
/// them exceed all numbers.
#[test]
fn writings_of_one_law_have_one_critical_velocity() {
    let folder = Folder::new();
    for (one, other, v_s) in [
        ("0.3+0.2/cosh(v/v_s)^2", "0.3+0.2*(1-tanh(v/v_s)^2)", "1e-4"),
        (
            "0.3+0.2/(1+exp((v-0.05)/v_s))",
            "0.3+0.1*(1-tanh((v-0.05)/(2*v_s)))",
            "1e-4",
        ),
        (
            "0.3+0.3*exp(-(v/v_s)^2)",
            "0.3+0.3*exp(-(v/v_s)^(1.9999999+0.0000001))",
            "0.05",
        ),
    ] {
        let v_s = format!("--v-s={v_s}");
        let [one, other] =
            [one, other].map(|text| critical_velocity(&folder, &["--mu-k", text, &v_s]));
        let [first, second] = [&one, &other].map(|answer| answer["vc"].as_f64().unwrap());
        assert!(one["decided"] == true && other["decided"] == true);
        assert!(
            first > 0.03 && (first - second).abs() < 1e-5 * first,
            "{first} {second}"
        );
    }
}

/// A whole power is that of a number below 0, too, however large the exponent is.
#[test]
fn whole_powers_of_negative_numbers_are_followed() {
    let folder = Folder::new();
    let motion = |base: &str, exponent: &str| {
        let start = "simulate --json --fresh --friction=formula --mu-s=0.6 --v0=0.1 --x-dot0=0 \
            --a0=0.3";
        let start: Vec<&str> = start.split_whitespace().collect();
        let law = format!("0.4 + 0.1*({base})^n");
        let output = folder.run(&[&start[..], &["--mu-k", &law, "--set", exponent]].concat());
        expect(&output, 0, "");
        let told = program::json(&output);
        ["slip_time", "period"].map(|name| told[name].as_f64().unwrap())
    };
    let [one, other] = [("v-1", "n=66"), ("(v-1)^33", "n=2")].map(|(of, n)| motion(of, n));
    let off = one.iter().zip(other).map(|(a, b)| (a - b).abs() / b);
    assert!(off.fold(0.0, f64::max) < 1e-8, "{one:?} {other:?}");
}

/// Where friction has no value, nothing is decided.
#[test]
fn motions_without_a_coefficient_are_undecided() {
    let folder = Folder::new();
    for (law, start) in [
        ("0.5-0.4*v", "--x-dot0=2"),
        ("0.4+0.05*ln(1.5-v)", "--x-dot0=1.49"),
    ] {
        let line = [
            "simulate",
            "--json",
            "--friction",
            "formula",
            "--mu-s=0.6",
            "--v0=0.1",
        ];
        let output = folder.run(&[&line[..], &["--mu-k", law, start, "--a0=2"]].concat());
        expect(
            &output,
            2,
            "friction has no coefficient above 0 at a speed of the block, at t =",
        );
    }
    let steep = "simulate --friction stribeck --mu0=0.3 --mu-s=0.6 --v-s=0.1 --exponent=0.2 \
        --v0=0.1 --x-dot0=0 --a0=0";
    let steep: Vec<&str> = steep.split_whitespace().collect();
    let told = folder.run(&steep);
    expect(&told, 0, "");
    assert!(
        out(&told).contains("or friction has no coefficient"),
        "{}",
        out(&told)
    );
    let answer = critical_velocity(&folder, &["--mu-k", "0.5-0.2*exp(-0.1/v)"]);
    assert_eq!(answer["decided"], false, "{answer}");
}

/// Laws that are infinitely steep or curved at rest: the margin of v0 is told soon, and stability
/// changes there and not before.
#[test]
fn margins_of_v0_end_where_steep_laws_become_unstable() {
    let folder = Folder::new();
    for (exponent, more) in [("0.5", ""), ("0.5", "--sensor-lag=0.1"), ("1.5", "")] {
        let law = format!("0.3 + 0.2*exp(-(v/0.05)^{exponent})");
        let given = ["--friction=formula", "--mu-k", &law, "--mu-s=0.5"];
        let control = ["--alpha-v=-0.4", "--tau=4.15"];
        let more = Some(more).filter(|more| !more.is_empty());
        let flags: Vec<&str> = given.into_iter().chain(control).chain(more).collect();
        let output = folder.run(&[&["margins", "--json", "--v0=0.1"], &flags[..]].concat());
        expect(&output, 0, "");
        let told = program::json(&output);
        let margin = &told["v0_margin"];
        let lower = margin["from"].as_f64().unwrap();
        assert_eq!(told["undecided"], Value::Array(vec![]), "{told}");
        let unstable = |v0: f64| {
            let v0 = format!("--v0={v0}");
            point(&folder, &[&[&*v0], &flags[..]].concat())["n_unstable"].clone()
        };
        assert_eq!(unstable(lower * (1.0 + 1e-6)), 0, "{exponent} {more:?}");
        assert_eq!(unstable(lower * (1.0 - 1e-6)), 2, "{exponent} {more:?}");
        let between = (1..5).map(|i| lower + (0.1 - lower) * f64::from(i) / 5.0);
        assert!(
            between.into_iter().all(|v0| unstable(v0) == 0),
            "{exponent} {more:?}"
        );
    }
}

/// A parameter with a unit is one in the declared units, or the SI, in flags and files alike; a
/// saved setting keeps it.
#[test]
fn own_parameters_have_the_units_they_are_given_in() {
    let file = "[fixed]\nv0 = \"500 mm/s\"\ntau = 0\n[friction]\nlaw = \"formula\"\n\
        mu_k = \"mu0-sigma*v\"\nmu0 = 0.3\nsigma = \"100 s/km\"\n";
    let folder = Folder::with(&[("given.toml", file)]);
    let law = ["--friction", "formula", "--mu-k=mu0-sigma*v", "--mu0=0.3"];
    let told = |more: &[&str]| out(&folder.run(&[&["point"], &law[..], more].concat()));
    let si = told(&["--set", "sigma=0.1 s/m", "--v0=500mm/s"]);
    assert!(si.contains("sigma = 0.1 m-1 s;"), "{si}");
    assert!(si.contains("mu_prime         -0.1 m-1 s"), "{si}");
    let given = out(&folder.run(&["point", "--setting", "given.toml"]));
    assert_eq!(given, si);
    let slow = told(&["--set=sigma=100s/km", "--units=N,mm,s", "--v0=500"]);
    assert!(slow.contains("sigma = 0.0001 mm-1 s;"), "{slow}");
    assert!(slow.contains("mu_k             0.25\n"), "{slow}");
    let save = "best --v0=1m/s --control=load --save=saved.toml --set=sigma=0.1s/m";
    let save: Vec<&str> = save.split(' ').chain(law).collect();
    expect(&folder.run(&save), 0, "saved.toml");
    let saved = out(&folder.run(&["point", "--setting", "saved.toml"]));
    assert!(saved.contains("sigma = 0.1 m-1 s;"), "{saved}");
    for (more, says) in [
        (&["--set=sigma=0.1s/q"][..], "no unit \"q\" is known"),
        (
            &["--set=sigma=0.1s/m", "--units=dimensionless"],
            "--set sigma=0.1 s/m: a number has a unit",
        ),
        (
            &["--set=sigma=1e11km"],
            "sigma = 100000000000000 is outside",
        ),
        (&["--set=sigma=s/m"], "must be a finite number"),
    ] {
        let refused = folder.run(&[&["point", "--v0=0.5"], &law[..], more].concat());
        expect(&refused, 2, says);
    }
    let system = ["point", "--system=turning", "--tau=1", "--set=zeta=1s"];
    expect(&folder.run(&system), 2, "a number has a unit");
}
