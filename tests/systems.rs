//! Systems from files through the real program: every row of the tables that a shipped system
//! carries, mistakes, and what the JSON says of what there is not.

#[allow(dead_code, reason = "systems come from files here")]
#[path = "common/general_rows.rs"]
mod general_rows;
#[path = "common/program.rs"]
mod program;

use general_rows::{Row, rows};
use program::{Folder, err, expect, out};
use serde_json::Value;

/// Ends of stable intervals and first crossings agree to this, relative.
const ENDS: f64 = 1e-9;

fn json(folder: &Folder, args: &[&str]) -> Value {
    let output = folder.run(&[&["point", "--json"], args].concat());
    assert_eq!(output.status.code(), Some(0), "{args:?}: {}", err(&output));
    serde_json::from_str(&out(&output)).unwrap()
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
    for (key, allowed) in [("first_crossing", ENDS), ("essential_abscissa", 1e-12)] {
        match row.number(key) {
            Some(expected) => near(&found[key], expected, allowed, place),
            None => assert_eq!(found[key], Value::Null, "{place}: {key}"),
        }
    }
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
    answer
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

#[test]
fn what_there_is_not_is_null_and_has_its_reason() {
    let system = |p: &str, q: &str| format!("P = \"{p}\"\nQ = \"{q}\"\n");
    let folder = Folder::with(&[
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
    ]);
    let at = |file: &str, more: &[&str]| {
        json(
            &folder,
            &[&["--system", file, "--tau", "0.2"], more].concat(),
        )
    };
    let infinite = at("infinite.toml", &[]);
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
    assert_eq!(
        (&infinite["stable"], &infinite["delay_margin_sign"]),
        (&false.into(), &(-1).into())
    );
    for (file, reason) in [
        ("limit.toml", "neutral-limit"),
        ("origin.toml", "root-at-origin"),
        ("axis.toml", "root-on-axis"),
    ] {
        let found = at(file, &[]);
        assert_eq!(
            (&found["reason"], &found["marginal"]),
            (&reason.into(), &true.into()),
            "{file}"
        );
        assert_eq!(found["stable"], false, "{file}");
    }
    let damped = at("damped.toml", &["--set", "width=0.3", "--line", "-0.5"]);
    for key in [
        "n_at_zero_delay",
        "first_crossing",
        "first_change",
        "delay_margin",
    ] {
        assert_eq!(damped[key], Value::Null, "{key}");
    }
    assert_eq!(damped["line_of_delays"], false);
    for key in ["stable_delays", "crossings"] {
        assert_eq!(damped[key], Value::Array(Vec::new()), "{key}");
    }
    assert_eq!(damped["n_unstable"], 0);
    assert!(damped["n_right_of_line"].is_u64());
    assert!(at("damped.toml", &[]).get("n_right_of_line").is_none());
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
    let schema: Value = serde_json::from_str(&out(&output)).unwrap();
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
        &["--tau", "1", "--plot", "roots.png"],
    ] {
        refused(&folder, &[&turning[..], more].concat());
    }
    refused(&folder, &["point", "--system", "turnig", "--tau", "1"]);
    refused(&folder, &["point", "--system", "none.toml", "--tau", "1"]);
    refused(&folder, &["point", "--set", "zeta=1", "--tau", "1"]);
    let letter = ["point", "--system", "letter", "--tau", "1", "--set"];
    refused(&folder, &[&letter[..], &["memory=1"]].concat());
    refused(&folder, &[&letter[..], &["latency=-1"]].concat());
    for text in [
        good.replace("2*zeta", "2*zeat"),
        good.replace("2*zeta*s", "2 zeta s"),
        good.replace("s^2", "s**2"),
        good.replace("+ 1\"", "+\""),
        good.replace("+ 1\"", "+ (1\""),
        good.replace("s^2", "s^17"),
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
    ] {
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
