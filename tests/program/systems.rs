//! Systems from files through the real program: every row of the tables that a shipped system
//! carries, mistakes, and what the JSON says of what there is not.

use crate::general_rows::{Row, rows};
use crate::program::{self, Folder, err, expect, out};
use serde_json::Value;

/// Ends of stable intervals and first crossings agree to this, relative.
const ENDS: f64 = 1e-9;

fn json(folder: &Folder, args: &[&str]) -> Value {
    let output = folder.run(&[&["point", "--json"], args].concat());
    assert_eq!(output.status.code(), Some(0), "{args:?}: {}", err(&output));
    program::json(&output)
}

fn near(found: &Value, expected: f64, allowed: f64, place: &str) {
    let found = found.as_f64().unwrap_or(f64::INFINITY);
    let apart = (found - expected).abs();
    let scale = expected.abs().max(1.0);
    assert!(
        found == expected || apart <= allowed * scale,
        "{place}: {found} instead of {expected}"
    );
}

/// One row against what the program says of the system with the row's columns as parameters.
fn check_row(folder: &Folder, system: &str, parameters: &[&str], row: &Row) -> Value {
    let place = &row.place;
    let sets: Vec<String> = parameters
        .iter()
        .map(|name| format!("{name}={:?}", row.or_zero(name)))
        .collect();
    let (tau, line) = (
        row.or_zero("tau").to_string(),
        row.or_zero("line").to_string(),
    );
    let mut args = vec![
        "--system", system, "--tau", &tau, "--line", &line, "--roots", "2",
    ];
    args.extend(sets.iter().flat_map(|set| ["--set", set]));
    let answer = json(folder, &args);
    let found = &answer;
    let whole = |column: &str| row.number(column).map(|n| n as i64);
    for key in [
        "n_unstable",
        "n_at_zero_delay",
        "n_right_of_line",
        "first_change",
    ] {
        assert_eq!(found[key].as_i64(), whole(key), "{place}: {key}");
    }
    assert_eq!(found["certified"], true, "{place}");
    assert_eq!(
        (&found["marginal"], &found["reason"]),
        (&false.into(), &Value::Null),
        "{place}"
    );
    assert_eq!(found["stable"], row.or_zero("n_unstable") == 0.0, "{place}");
    let root = found["roots"][0].as_array().unwrap();
    near(
        &found["abscissa"],
        row.or_zero("re_rightmost"),
        1e-12,
        place,
    );
    near(&root[0], row.or_zero("re_rightmost"), 1e-12, place);
    near(&root[1], row.or_zero("im_rightmost"), 1e-12, place);
    let gains = ["alpha_v", "alpha_n"];
    let idle = parameters.contains(&"memory") && gains.iter().all(|gain| row.or_zero(gain) == 0.0);
    for (key, allowed) in [("first_crossing", ENDS), ("essential_abscissa", 1e-12)] {
        match row.number(key) {
            // Without gains there is nothing to remember.
            Some(_) if key == "essential_abscissa" && idle => {}
            Some(expected) => near(&found[key], expected, allowed, place),
            None => assert_eq!(found[key], Value::Null, "{place}: {key}"),
        }
    }
    check_line(found, row);
    answer
}

/// Crossings and stable delays of the row's line.
fn check_line(found: &Value, row: &Row) {
    let place = &row.place;
    let moving = found["crossings"].as_array().unwrap().iter();
    let moving = moving.filter(|c| c["direction"] != "touch").count();
    assert_eq!(
        moving,
        row.or_zero("n_crossing_frequencies") as usize,
        "{place}"
    );
    let stable = found["stable_delays"].as_array().unwrap();
    let expected = row.intervals("stable_delays");
    assert!(stable.len() >= expected.len(), "{place}: {stable:?}");
    for (found, (from, to)) in stable.iter().zip(&expected) {
        near(&found[0], *from, ENDS, place);
        near(&found[1], *to, ENDS, place);
    }
}

fn table(name: &str) -> Vec<Row> {
    let path = format!("tests/reference/general_{name}.csv");
    rows(name, &std::fs::read_to_string(path).unwrap())
}

#[test]
fn rows_of_the_tables_by_shipped_systems() {
    let folder = Folder::new();
    let mut checked = 0;
    let rate_state = [
        "direct",
        "evolution",
        "state_time",
        "load_memory",
        "alpha_v",
        "alpha_n",
    ];
    let lags = [
        "mu_prime",
        "alpha_v",
        "alpha_n",
        "load_lag",
        "velocity_lag",
        "sensor_lag",
    ];
    let pd = ["damping", "stiffness", "k_p", "k_d", "k_a"];
    let memory = ["mu_prime", "alpha_v", "alpha_n", "memory"];
    for (name, system, parameters) in [
        ("lag", "lags", &lags[..]),
        ("rate_state", "rate_state", &rate_state),
        ("pd", "pd", &pd),
        ("etdas", "letter", &memory),
    ] {
        for row in table(name) {
            check_row(&folder, system, parameters, &row);
            checked += 1;
        }
    }
    let late = ["mu_prime", "alpha_v", "alpha_n", "memory", "latency"];
    for row in table("latency") {
        let found = check_row(&folder, "letter", &late, &row);
        match row.text("latency_margin") {
            "inf" => assert_eq!(found["latency_margin"], Value::Null, "{}", row.place),
            _ => near(
                &found["latency_margin"],
                row.or_zero("latency_margin"),
                1e-11,
                &row.place,
            ),
        }
        let stable = found["stable_latencies"].as_array().unwrap();
        for (found, (from, to)) in stable.iter().zip(row.intervals("stable_latencies")) {
            near(&found[0], from, ENDS, &row.place);
            near(&found[1], to, ENDS, &row.place);
        }
        checked += 1;
    }
    for row in table("chatter") {
        let two = ["zeta", "zeta_2", "omega_2", "gain_2", "width"];
        match row.number("omega_2") {
            None => check_row(&folder, "turning", &["zeta", "width"], &row),
            Some(_) => check_row(&folder, "turning_two_modes", &two, &row),
        };
        checked += 1;
    }
    assert!(checked >= 432, "{checked}");
}

/// Closed forms of the two that no table has.
#[test]
fn the_delayed_oscillator_and_the_focus_are_stable_where_they_should_be() {
    let folder = Folder::new();
    // At τ = 2π boundaries are the lines b = (−1)^k (δ − k²/4): stable are triangles between them,
    // for 0 < b < min(δ, 1/4 − δ) and for 0 < −b < min(δ − 1/4, 1 − δ).
    for (delta, b, stable) in [
        (0.2, 0.04, true),
        (0.2, 0.06, false),
        (0.2, -0.04, false),
        (0.1, 0.09, true),
        (0.1, 0.11, false),
        (0.6, -0.34, true),
        (0.6, -0.36, false),
        (0.6, 0.1, false),
    ] {
        let sets = [format!("delta={delta}"), format!("b={b}")];
        let tau = std::f64::consts::TAU.to_string();
        let args = [
            "--system",
            "delayed_oscillator",
            "--set",
            &sets[0],
            "--set",
            &sets[1],
        ];
        let found = json(&folder, &[&args[..], &["--tau", &tau]].concat());
        assert_eq!(found["stable"], stable, "{delta} {b}");
    }
    // Some delay makes the focus stable where gain > 2 ω₀ (√(μ² + ω₀²) − ω₀)/μ.
    let mu: f64 = 0.3;
    let least = 2.0 * ((mu * mu + 1.0).sqrt() - 1.0) / mu;
    for (gain, stable) in [(least + 1e-3, true), (least - 1e-3, false)] {
        let set = format!("gain={gain}");
        let args = [
            "--system",
            "pyragas_focus",
            "--set",
            "mu=0.3",
            "--set",
            &set,
            "--tau",
            "1",
        ];
        let found = json(&folder, &args);
        let some = !found["stable_delays"].as_array().unwrap().is_empty();
        assert_eq!(some, stable, "{gain}");
    }
}

/// The letter as a system says what the letter itself does.
#[test]
fn the_letter_as_a_system_is_the_letter() {
    let folder = Folder::new();
    for (mu_prime, alpha_v, alpha_n, tau) in [
        ("-0.3", "-0.33", "0", "4.15"),
        ("-0.1", "0", "-2", "0.5"),
        ("-0.7", "-0.3174", "0", "4.313"),
        ("0.2", "0.5", "1.5", "2"),
    ] {
        let flags = [
            "--mu-prime",
            mu_prime,
            "--alpha-v",
            alpha_v,
            "--alpha-n",
            alpha_n,
        ];
        let own = json(&folder, &[&flags[..], &["--tau", tau]].concat());
        let sets = [
            ("mu_prime", mu_prime),
            ("alpha_v", alpha_v),
            ("alpha_n", alpha_n),
        ];
        let sets = sets.map(|(name, value)| format!("{name}={value}"));
        let mut args = vec!["--system", "letter", "--tau", tau];
        args.extend(sets.iter().flat_map(|set| ["--set", set]));
        let as_system = json(&folder, &args);
        for key in [
            "n_unstable",
            "stable",
            "marginal",
            "certified",
            "delay_margin_sign",
        ] {
            assert_eq!(own[key], as_system[key], "{key}");
        }
        for key in ["abscissa", "frequency", "delay_margin"] {
            match own[key].as_f64() {
                Some(expected) => near(&as_system[key], expected, 1e-11, key),
                None => assert_eq!(as_system[key], Value::Null, "{key}"),
            }
        }
    }
}

const TAU_DEPENDENT: &str = "P = \"s^2 + (2*zeta + width*tau/10)*s + 1 + width\"\nQ = \"-width\"\n\
    [parameters]\nzeta = 0.02\nwidth = { unit = \"N m-1\" }\n";

/// A folder with systems out of the ordinary.
fn odd_systems() -> Folder {
    let system = |p: &str, q: &str| format!("P = \"{p}\"\nQ = \"{q}\"\n");
    Folder::with(&[
        ("damped.toml", TAU_DEPENDENT),
        ("infinite.toml", &system("s^2 + s + 1", "2*s^2")),
        ("limit.toml", &system("s^2 + 3*s + 1", "s^2")),
        ("origin.toml", &system("s^2 + 0.5*s + 1", "-1")),
        ("axis.toml", &system("(s^2 + 1)*(s + 2)", "0.5*(s^2 + 1)")),
        ("refused.toml", &system("s^2 + s + 1", "s^2 + s + 1")),
        (
            "supremum.toml",
            &system("(s + 9)*(s + 9)", "0.5*s^2 + 9*s + 40"),
        ),
    ])
}

/// One of them at a delay.
fn odd(folder: &Folder, file: &str, more: &[&str]) -> Value {
    json(
        folder,
        &[&["--system", file, "--tau", "0.2"], more].concat(),
    )
}

#[test]
fn what_there_is_not_is_null_and_has_its_reason() {
    let folder = odd_systems();
    let at = |file: &str| odd(&folder, file, &[]);
    let infinite = at("infinite.toml");
    for key in [
        "n_unstable",
        "n_at_zero_delay",
        "abscissa",
        "delay_margin",
        "latency_margin",
    ] {
        assert_eq!(infinite[key], Value::Null, "{key}");
    }
    assert_eq!(infinite["reason"], "infinite");
    assert_eq!(infinite["stable"], false);
    // Without delay it is 3 s² + s + 1.
    let without = json(&folder, &["--system", "infinite.toml", "--tau", "0"]);
    assert_eq!(without["n_unstable"], 0);
    assert_eq!(without["reason"], Value::Null);
    near(&without["abscissa"], -1.0 / 6.0, 1e-12, "without delay");
    let sweep = "system = \"infinite.toml\"\nfields = [\"reason\"]\n[axes]\ntau = [0, 1]\n";
    std::fs::write(folder.path().join("map.toml"), sweep).unwrap();
    expect(&folder.run(&["run", "map.toml", "-o", "map.h5"]), 0, "");
    let table = folder.run(&["export", "map.h5", "-o", "map.csv"]);
    expect(&table, 0, "");
    let table = std::fs::read_to_string(folder.path().join("map.csv")).unwrap();
    let reasons: Vec<&str> = table.lines().filter(|l| !l.starts_with('#')).collect();
    assert!(
        reasons[1].starts_with("0,") && !reasons[1].contains("infinite"),
        "{table}"
    );
    assert!(
        reasons[2].starts_with("1,") && reasons[2].contains("infinite"),
        "{table}"
    );
    for (file, reason) in [
        ("limit.toml", "neutral-limit"),
        ("origin.toml", "root-at-origin"),
        ("axis.toml", "root-on-axis"),
    ] {
        let found = at(file);
        assert_eq!(
            (&found["reason"], &found["marginal"]),
            (&reason.into(), &true.into()),
            "{file}"
        );
        assert_eq!(found["stable"], false, "{file}");
    }
}

#[test]
fn what_depends_on_the_delay_knows_no_other() {
    let folder = odd_systems();
    let at = |file: &str, more: &[&str]| odd(&folder, file, more);
    let damped = at("damped.toml", &["--set", "width=0.3", "--line", "-0.5"]);
    for key in [
        "n_at_zero_delay",
        "first_crossing",
        "first_change",
        "delay_margin",
        "stable_delays",
        "crossings",
    ] {
        assert_eq!(damped.get(key), Some(&Value::Null), "{key}");
    }
    assert_eq!(damped["line_of_delays"], false);
    assert_eq!(damped["delay_margin_kind"], "unknown");
    assert_eq!(damped["n_unstable"], 0);
    assert!(damped["n_right_of_line"].is_u64());
    assert_eq!(at("damped.toml", &[])["n_right_of_line"], Value::Null);
    let args = [
        "point",
        "--system",
        "refused.toml",
        "--tau",
        "0.2",
        "--json",
    ];
    expect(
        &folder.run(&args),
        2,
        "|P| = |Q| on all of the imaginary axis",
    );
    // For people as well.
    for file in ["infinite.toml", "damped.toml", "limit.toml", "axis.toml"] {
        let output = folder.run(&["point", "--system", file, "--tau", "0.2"]);
        assert_eq!(output.status.code(), Some(0), "{}", err(&output));
        assert!(
            out(&output).starts_with("the system is "),
            "{}",
            out(&output)
        );
    }
}

/// Polynomials as lists of coefficients, in files and in the tables of sweeps, are those of the
/// expressions that say the same.
#[test]
fn lists_of_coefficients_are_as_good_as_expressions() {
    let parameters = "[parameters]\nzeta = 0.05\nwidth = 0.1\n";
    let lists = "P = [1, \"2*zeta\", \"1 + width\"]\nQ = [\"-width\"]\n";
    let expressions = "P = \"s^2 + 2*zeta*s + (1 + width)\"\nQ = \"-width\"\n";
    let rest = "fields = [\"n_unstable\", \"abscissa\"]\nboundaries = false\n\
        [axes]\nwidth = [0.0, 0.2, 0.4]\ntau = [0.5, 3.0, 8.0]\n";
    let inline = "{ P = [1, \"2*zeta\", \"1 + width\"], Q = [\"-width\"], \
        parameters = { zeta = 0.05, width = 0.1 } }";
    let folder = Folder::with(&[
        ("lists.toml", &*format!("{lists}{parameters}")),
        ("expressions.toml", &format!("{expressions}{parameters}")),
        ("by_file.toml", &format!("system = \"lists.toml\"\n{rest}")),
        ("inline.toml", &format!("system = {inline}\n{rest}")),
        (
            "same.toml",
            &format!("system = \"expressions.toml\"\n{rest}"),
        ),
    ]);
    let at = |system: &str| json(&folder, &["--system", system, "--tau", "8", "--roots", "3"]);
    let (mut by_lists, mut by_expressions) = (at("lists.toml"), at("expressions.toml"));
    for answer in [&mut by_lists, &mut by_expressions] {
        answer["inputs"]["system"].take();
    }
    assert_eq!(by_lists, by_expressions);
    let tables = ["by_file", "inline", "same"].map(|sweep| {
        let map = format!("{sweep}.h5");
        let run = folder.run(&["run", "--quiet", &format!("{sweep}.toml"), "-o", &map]);
        expect(&run, 0, "");
        let told = out(&folder.run(&["info", &map]));
        let shown = "P = s^2 + 2*zeta*s + (1 + width), Q = -width";
        assert!(told.contains(shown), "{told}");
        let table = out(&folder.run(&["export", &map]));
        let rows = table.lines().filter(|line| !line.starts_with('#'));
        rows.map(str::to_owned).collect::<Vec<_>>()
    });
    assert_eq!(tables[0].len(), 10);
    assert!(tables.iter().all(|rows| *rows == tables[0]), "{tables:?}");
}

/// All descriptions within a value.
fn descriptions(of: &Value, into: &mut String) {
    match of {
        Value::Object(map) => map.iter().for_each(|(key, value)| match value {
            Value::String(text) if key == "description" => *into += &text.to_lowercase(),
            value => descriptions(value, into),
        }),
        Value::Array(list) => list.iter().for_each(|value| descriptions(value, into)),
        _ => {}
    }
}

/// Every key that can be null says in the schema when it is.
#[test]
fn the_schema_says_what_null_means() {
    let folder = Folder::new();
    let output = folder.run(&["schema", "point"]);
    let schema = program::json(&output);
    let mut nullable = 0;
    for (part, schema) in schema["components"]["schemas"].as_object().unwrap() {
        let all = schema["allOf"].as_array().into_iter().flatten();
        for object in all.chain([schema]) {
            for (key, of) in object["properties"].as_object().into_iter().flatten() {
                let own = of["type"].as_array();
                let own = own.is_some_and(|types| types.contains(&"null".into()));
                let choices = of["oneOf"].as_array();
                let choice = choices.is_some_and(|all| all.iter().any(|one| one["type"] == "null"));
                let items = of["items"].to_string().contains("\"null\"");
                if own || choice || items {
                    nullable += 1;
                    let mut said = String::new();
                    descriptions(of, &mut said);
                    assert!(said.contains("null"), "{part}.{key}: {of}");
                }
            }
        }
    }
    assert!(nullable > 20, "{nullable}");
}

/// Variants of a good system, each with one mistake.
fn bad_systems(good: &str) -> Vec<String> {
    vec![
        good.replace("2*zeta", "2*zeat"),
        good.replace("2*zeta*s", "2 zeta s"),
        good.replace("s^2", "s**2"),
        good.replace("+ 1\"", "+\""),
        good.replace("+ 1\"", "+ (1\""),
        good.replace("s^2", "s^33"),
        good.replace("s^2", "s^0.5"),
        good.replace("s^2", "s^2/s"),
        good.replace("-zeta", "exp(-s)"),
        good.replace("-zeta", "sqr(zeta)"),
        good.replace("-zeta", "1/zeta"),
        good.replace("-zeta", "1"),
        good.replace("minimum", "minimun"),
        good.replace("zeta = {", "tau = {"),
        good.replace("zeta = {", "exp = {"),
        good.replace('P', "B"),
        good.replace('Q', "R"),
        good.replace("Q = \"-zeta\"\n", ""),
        good.replace('P', "B")
            .replace('Q', "A")
            .replace("-zeta", "zeta*s^2"),
        "speed_axis = { name = \"speed\", unit = \"mph\" }".into(),
        good.replace("\"-zeta\"", "3"),
        good.replace("\"-zeta\"", "[]"),
        good.replace("\"-zeta\"", "[1, nan]"),
        good.replace("\"-zeta\"", "[1, [\"-zeta\"]]"),
        good.replace("\"-zeta\"", "[1, \"-zeat\"]"),
        good.replace("\"-zeta\"", "[1, \"zeta*s\"]"),
        good.replace("\"-zeta\"", "[\"1/zeta\", 2]"),
        good.replace("\"-zeta\"", &format!("[1{}]", ", 0".repeat(33))),
    ]
}

#[test]
fn mistakes_are_shown_in_place() {
    let good = "P = \"s^2 + 2*zeta*s + 1\"\nQ = \"-zeta\"\n[parameters]\nzeta = { minimum = 0 }\n";
    let folder = Folder::with(&[("good.toml", good)]);
    let mut shown = String::new();
    let mut refused = |folder: &Folder, args: &[&str]| {
        let output = folder.run(args);
        assert_eq!(output.status.code(), Some(2), "{args:?} {}", err(&output));
        assert_eq!(out(&output), "");
        shown += &err(&output);
    };
    let turning = ["point", "--system", "turning"];
    for more in [
        &[][..],
        &["--tau", "-1"],
        &["--tau", "1", "--set", "zeta"],
        &["--tau", "1", "--set", "zeta=nan"],
        &["--tau", "1", "--set", "zeta=-1"],
        &["--tau", "1", "--set", "widht=1"],
        &["--tau", "1", "--set", "width=1", "--set", "width=2"],
        &["--tau", "1", "--set", "tau=2"],
        &["--tau", "1", "--set", "memory=0.5"],
        &["--tau", "1", "--mu-prime", "-0.3"],
        &["--tau", "1", "--line", "inf"],
    ] {
        refused(&folder, &[&turning[..], more].concat());
    }
    refused(&folder, &["point", "--system", "turnig", "--tau", "1"]);
    refused(&folder, &["point", "--system", "none.toml", "--tau", "1"]);
    refused(&folder, &["point", "--set", "zeta=1", "--tau", "1"]);
    let letter = ["point", "--system", "letter", "--tau", "1", "--set"];
    refused(&folder, &[&letter[..], &["memory=1"]].concat());
    refused(&folder, &[&letter[..], &["latency=-1"]].concat());
    for text in bad_systems(good) {
        let folder = Folder::with(&[("system.toml", &*text)]);
        let args = ["point", "--system", "system.toml", "--tau", "1"];
        let output = folder.run(&args);
        if output.status.code() == Some(0) {
            continue;
        }
        refused(&folder, &args);
    }
    insta::assert_snapshot!("mistakes", shown);
}

const LOBES: &str = "title = \"Lobes\"\nsystem = \"turning\"\n\
    fields = [\"n_unstable\", \"abscissa\", \"frequency\", \"delay_margin\"]\n\
    [axes]\nwidth = { from = 0.0, to = 0.5, points = 6 }\n\
    tau = { from = 0.5, to = 9.5, points = 10 }\n[fixed]\nzeta = 0.05\n";

const BY_DELAY: &str = "system = \"damped.toml\"\nfields = [\"n_unstable\", \"abscissa\"]\n\
    [axes]\ntau = [0.0, 0.7, 3.0, 11.0]\nwidth = [0.0, 0.2, 0.4]\n";

/// The rows of a map as text, by the names of the columns.
fn exported(folder: &Folder, map: &str) -> Vec<Row> {
    let output = folder.run(&["export", map]);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    rows(map, &out(&output))
}

/// Every cell of a map is what `point` says there, and `verify` finds nothing.
fn check_map(folder: &Folder, sweep: &str, system: &[&str], fields: &[&str]) {
    let output = folder.run(&["run", sweep, "-o", "map.h5", "--quiet", "--fresh"]);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    expect(&folder.run(&["verify", "map.h5"]), 0, "");
    for row in exported(folder, "map.h5") {
        let (width, tau) = (row.text("width"), row.text("tau"));
        let set = format!("width={width}");
        let found = json(folder, &[system, &["--set", &set, "--tau", tau]].concat());
        for field in fields {
            match found[field].as_f64() {
                Some(expected) => {
                    let cell = row.number(field).unwrap();
                    let apart = (cell - expected).abs();
                    assert!(
                        apart <= 1e-11 * expected.abs().max(1.0),
                        "{} {field}",
                        row.place
                    );
                }
                None => assert!(
                    row.number(field).is_none_or(f64::is_infinite),
                    "{}",
                    row.place
                ),
            }
        }
        assert_eq!(row.text("reason"), "none", "{}", row.place);
        let at = [
            "--map",
            "map.h5",
            "--at",
            &set,
            "--at",
            &format!("tau={tau}"),
        ];
        let of_cell = json(folder, &at);
        for field in ["n_unstable", "roots", "parameters", "tau"] {
            assert_eq!(of_cell[field], found[field], "{field}");
        }
    }
}

#[test]
fn cells_of_a_sweep_are_points_of_the_system() {
    let folder = Folder::with(&[
        ("lobes.toml", LOBES),
        ("by_delay.toml", BY_DELAY),
        ("damped.toml", TAU_DEPENDENT),
    ]);
    let system = ["--system", "turning", "--set", "zeta=0.05"];
    let fields = ["n_unstable", "abscissa", "frequency", "delay_margin"];
    check_map(&folder, "lobes.toml", &system, &fields);
    let system = ["--system", "damped.toml"];
    check_map(
        &folder,
        "by_delay.toml",
        &system,
        &["n_unstable", "abscissa"],
    );
    // The delay need not be the innermost axis, nor be one.
    let other = BY_DELAY.replace("tau = [0.0, 0.7, 3.0, 11.0]\n", "");
    let other = other + "[fixed]\ntau = 3.0\n";
    let folder = Folder::with(&[("by_delay.toml", &*other), ("damped.toml", TAU_DEPENDENT)]);
    let run = folder.run(&["run", "by_delay.toml", "-o", "map.h5", "--quiet"]);
    assert_eq!(run.status.code(), Some(0), "{}", err(&run));
    assert_eq!(exported(&folder, "map.h5").len(), 3);
}

/// A map says all of its system: the file it was in, and the names in it, are not needed again.
#[test]
fn a_map_is_complete_without_the_file_of_its_system() {
    let folder = Folder::with(&[("by_delay.toml", BY_DELAY), ("damped.toml", TAU_DEPENDENT)]);
    let run = |args: &[&str]| {
        let output = folder.run(&[&["run", "by_delay.toml", "-o", "map.h5"], args].concat());
        assert_eq!(output.status.code(), Some(0), "{}", err(&output));
        err(&output) + &out(&output)
    };
    run(&["--quiet"]);
    assert!(run(&[]).contains("already complete"));
    let info = folder.run(&["info", "map.h5", "--json"]);
    let info = program::json(&info);
    let system = info["origin"]["system"].as_str().unwrap();
    assert!(system.contains("Q = -width"), "{system}");
    assert_eq!(info["units"]["width"], "N m-1");
    assert_eq!(info["fixed"]["zeta"], 0.02);
    // Another text of the system is another plan.
    let text = TAU_DEPENDENT.replace("tau/10", "tau/11");
    std::fs::write(folder.path().join("damped.toml"), text).unwrap();
    let other = folder.run(&["run", "by_delay.toml", "-o", "map.h5"]);
    assert_eq!(other.status.code(), Some(2), "{}", err(&other));
    std::fs::remove_file(folder.path().join("damped.toml")).unwrap();
    for args in [
        &["verify", "map.h5"][..],
        &["plot", "map.h5", "-o", "map.svg"],
        &["info", "map.h5"],
        &["status", "map.h5"],
        &["export", "map.h5", "--comments"],
        &[
            "point",
            "--map",
            "map.h5",
            "--at",
            "tau=3",
            "--at",
            "width=0.2",
        ],
    ] {
        expect(&folder.run(args), 0, "");
    }
    let picture = std::fs::read_to_string(folder.path().join("map.svg")).unwrap();
    assert!(
        picture.contains("width") && picture.contains("(N m⁻¹)"),
        "{picture}"
    );
    for command in ["vc", "simulate"] {
        let at = ["--map", "map.h5", "--at", "tau=3", "--at", "width=0.2"];
        expect(
            &folder.run(&[&[command], &at[..]].concat()),
            2,
            "a system from a file",
        );
    }
}

/// A map computed whole and one merged from shards have the same cells.
#[test]
fn shards_of_a_system_are_merged() {
    let folder = Folder::with(&[("lobes.toml", LOBES)]);
    for shard in ["1/2", "2/2"] {
        let args = [
            "run",
            "lobes.toml",
            "-o",
            "parts.h5",
            "--shard",
            shard,
            "--quiet",
        ];
        expect(&folder.run(&args), 0, "");
    }
    expect(&folder.run(&["merge", "parts.h5"]), 0, "");
    expect(
        &folder.run(&["run", "lobes.toml", "-o", "whole.h5", "--quiet"]),
        0,
        "",
    );
    let text = |map: &str| out(&folder.run(&["export", map]));
    assert_eq!(text("parts.h5"), text("whole.h5"));
    assert!(text("whole.h5").lines().count() == 61);
}

/// Lobes stand over the speed of the spindle, from left to right.
#[test]
fn lobes_are_drawn_over_the_speed() {
    let physical = "title = \"Lobes\"\nfields = [\"n_unstable\"]\n\
        system = { P = \"s^2 + 2*zeta*omega*s + omega^2*(1 + w)\", Q = \"-omega^2*w\", \
        parameters = { zeta = 0.05, omega = 600, w = 0 }, \
        speed_axis = { name = \"spindle speed\", unit = \"rpm\" } }\n\
        [axes]\nw = { from = 0.0, to = 0.5, points = 21 }\n\
        tau = { from = 0.01, to = 0.06, points = 51 }\n[units]\nforce = \"N\"\n\
        length = \"m\"\ntime = \"s\"\n";
    let folder = Folder::with(&[("lobes.toml", physical)]);
    expect(
        &folder.run(&["run", "lobes.toml", "-o", "map.h5", "--quiet"]),
        0,
        "",
    );
    expect(&folder.run(&["plot", "map.h5", "-o", "map.svg"]), 0, "");
    let picture = std::fs::read_to_string(folder.path().join("map.svg")).unwrap();
    for label in ["spindle speed", "(rpm)", "2000", "6000"] {
        assert!(picture.contains(label), "{label}");
    }
    assert!(!picture.contains("delay of the feedback"));
    expect(
        &folder.run(&["plot", "map.h5", "--at", "w=0.3", "-o", "line.svg"]),
        0,
        "",
    );
    let picture = std::fs::read_to_string(folder.path().join("line.svg")).unwrap();
    assert!(picture.contains("spindle speed"));
}

#[test]
fn mistakes_of_sweeps_are_shown_in_place() {
    let mut shown = String::new();
    let fields = |field: &str| LOBES.replace("\"delay_margin\"", &format!("\"{field}\""));
    for text in [
        LOBES.replace("\"turning\"", "\"turnig\""),
        LOBES.replace("\"turning\"", "\"bad.toml\""),
        LOBES.replace("\"turning\"", "3"),
        LOBES.replace("\"turning\"", "{ P = \"s^2 + x\", Q = \"1\" }"),
        LOBES.replace("zeta", "zita"),
        LOBES.replace("zeta = 0.05", "zeta = -0.05"),
        LOBES.replace("width = { from = 0.0", "zeta = { from = 0.0"),
        LOBES.replace("zeta = 0.05", "zeta = 0.05\ntau = 3"),
        LOBES.replace("tau = { from = 0.5, to = 9.5, points = 10 }\n", ""),
        LOBES.replace("zeta = 0.05", "memory = 0.5"),
        LOBES.to_owned() + "[friction]\nlaw = \"coulomb\"\n",
        "best = true\n".to_owned() + LOBES,
        "protocol = \"limit\"\n".to_owned() + LOBES,
        fields("vc"),
        fields("outcome"),
        fields("stability_radius"),
        fields("stiffness_ratio"),
        fields("d_abscissa_d_tau"),
        BY_DELAY.replace("\"abscissa\"", "\"delay_margin\""),
    ] {
        let bad = TAU_DEPENDENT.replace("width*tau", "width*taw");
        let folder = Folder::with(&[
            ("sweep.toml", &*text),
            ("bad.toml", &*bad),
            ("damped.toml", TAU_DEPENDENT),
        ]);
        let output = folder.run(&["plan", "sweep.toml"]);
        assert_eq!(output.status.code(), Some(2), "{text}: {}", err(&output));
        shown += &err(&output);
    }
    insta::assert_snapshot!("mistakes_of_sweeps", shown);
}

/// Python's h5py reads the axes, the cells and what the system is.
#[cfg(feature = "external-readers")]
#[test]
fn h5py_reads_a_map_of_turning() {
    const SCRIPT: &str = "import h5py, json, sys\n\
        with h5py.File(sys.argv[1]) as f:\n\
        \x20   print(json.dumps({\n\
        \x20       'system': f.attrs['system'].decode(),\n\
        \x20       'dims': [d[0].name for d in f['n_unstable'].dims],\n\
        \x20       'width': f['width'][:].tolist(),\n\
        \x20       'about': f['width'].attrs['long_name'].decode(),\n\
        \x20       'zeta': f['zeta'][()],\n\
        \x20       'n_unstable': f['n_unstable'][:].ravel().tolist()}))\n";
    let folder = Folder::with(&[("lobes.toml", LOBES)]);
    expect(
        &folder.run(&["run", "lobes.toml", "-o", "map.h5", "--quiet"]),
        0,
        "",
    );
    let program = std::env::var("SLIPMAP_PYTHON").unwrap_or_else(|_| "python3".into());
    let mut python = std::process::Command::new(program);
    python
        .args(["-c", SCRIPT, "map.h5"])
        .current_dir(folder.path());
    let output = crate::program::output(&mut python);
    assert!(output.status.success(), "{}", err(&output));
    let read = program::json(&output);
    let system: slipmap::setting::system::SystemModel =
        read["system"].as_str().unwrap().parse().unwrap();
    assert_eq!(
        Some(system),
        slipmap::setting::system::shipped::system("turning")
    );
    assert_eq!(read["dims"], serde_json::json!(["/width", "/tau"]));
    assert_eq!(read["about"], "chip width over stiffness");
    assert_eq!(read["zeta"], 0.05);
    assert_eq!(read["width"].as_array().unwrap().len(), 6);
    let cells = exported(&folder, "map.h5").into_iter();
    let cells: Vec<i64> = cells.map(|row| row.or_zero("n_unstable") as i64).collect();
    assert_eq!(read["n_unstable"], serde_json::json!(cells));
    assert!(cells.contains(&0) && cells.contains(&2));
}
