use super::shipped::{SHIPPED, system, text_of};
use super::*;

#[test]
fn shipped_systems_are_read_and_written_as_the_same() {
    for (name, text) in SHIPPED {
        let model: SystemModel = text.parse().unwrap_or_else(|e| panic!("{name}: {e:?}"));
        assert_eq!(model.to_toml().parse(), Ok(model.clone()), "{name}");
        let sweep = format!("system = {}\n", model.to_inline_table());
        let document = crate::text::toml_reader::parse(&sweep).unwrap();
        let entries = crate::text::toml_reader::entries(document.get_ref(), "");
        assert_eq!(
            SystemModel::of_table(&entries[0], &sweep),
            Ok(model.clone()),
            "{name}"
        );
        assert_eq!(system(name), Some(model.clone()));
        assert!(!model.title.is_empty() && text_of(name).is_some());
        assert!(!model.depends_on_delay());
        for own in &model.parameters {
            assert_ne!(own.long_name, own.name, "{name}");
        }
    }
}

#[test]
fn their_parameters_are_those_of_the_tables() {
    let names = |name: &str| -> Vec<String> {
        let model = system(name).unwrap();
        model
            .parameters
            .iter()
            .map(|own| own.name.clone())
            .collect()
    };
    for (name, parameters) in [
        ("letter", "mu_prime alpha_v alpha_n"),
        (
            "lags",
            "mu_prime alpha_v alpha_n load_lag velocity_lag sensor_lag",
        ),
        (
            "rate_state",
            "direct evolution state_time load_memory alpha_v alpha_n",
        ),
        ("turning", "zeta width"),
        ("turning_two_modes", "zeta zeta_2 omega_2 gain_2 width"),
        ("pd", "damping stiffness k_p k_d k_a"),
        ("delayed_oscillator", "delta b"),
        ("pyragas_focus", "mu omega_0 gain"),
    ] {
        assert_eq!(names(name).join(" "), parameters, "{name}");
    }
}

/// Texts, each with the part that the error points at and its message.
const MISFITS: &[(&str, Option<&str>, &str)] = &[
    ("", None, "a system needs its polynomials"),
    ("P = \"s\"", None, "P alone makes no system"),
    ("P = \"s\"\nA = \"1\"", Some("A"), "not both"),
    ("P = \"s\"\nQ = \"1\"\nB = \"1\"", Some("B"), "not both"),
    ("B = \"s\"\nA = \"s\"", Some("\"s\""), "the smaller one"),
    ("P = 3\nQ = \"1\"", Some("3"), "expected a string"),
    ("P = \"s + x\"\nQ = \"1\"", Some("x"), "P: unknown name `x`"),
    ("P = \"s +\"\nQ = \"1\"", Some("\""), "found the end"),
    (
        "P = '''\n s + x'''\nQ = \"1\"",
        Some("x"),
        "unknown name `x`",
    ),
    (
        "P = \"s + \\u0078\"\nQ = \"1\"",
        Some("\"s + \\u0078\""),
        "unknown name",
    ),
    ("p = \"s\"", Some("p"), "unknown key `p`"),
    ("parameters = 3", Some("3"), "expected a table"),
    ("[parameters]\ns = 1", Some("s"), "s is reserved"),
    ("[parameters]\ntau = 1", Some("tau"), "tau is reserved"),
    ("[parameters]\nsqrt = 1", Some("sqrt"), "it is a function"),
    (
        "[parameters]\nabscissa = 1",
        Some("abscissa"),
        "maps have a variable",
    ),
    ("[parameters]\n_a = 1", Some("_a"), "no name of a parameter"),
    (
        "[parameters]\n\"a b\" = 1",
        Some("\"a b\""),
        "no name of a parameter",
    ),
    (
        "[parameters]\na = \"1\"",
        Some("\"1\""),
        "expected a number",
    ),
    (
        "[parameters]\na = { usual = 1 }",
        Some("usual"),
        "unknown key",
    ),
    (
        "[parameters]\na = { minimum = 1 }",
        Some("a"),
        "its default 0 is not among 1 or more",
    ),
    (
        "[parameters]\na = { default = 3, maximum = 2 }",
        Some("3"),
        "its default 3 is not among -1000000000000 to 2",
    ),
    (
        "[parameters]\na = { minimum = 1, maximum = 0 }",
        Some("{ minimum = 1, maximum = 0 }"),
        "larger than its maximum",
    ),
    (
        "[parameters]\na = { unit = \"\" }",
        Some("\"\""),
        "expected a unit",
    ),
    (
        "P = \"s\"\nQ = \"1\"\n[parameters]\na = 1",
        Some("a"),
        "no effect",
    ),
    (
        "B = \"s\"\nA = \"memory\"\n[parameters]\nmemory = 1",
        Some("memory"),
        "memory is reserved",
    ),
    ("speed_axis = {}", Some("{}"), "name is missing"),
    (
        "speed_axis = { unit = \"rmp\" }",
        Some("\"rmp\""),
        "unknown unit",
    ),
    (
        "speed_axis = { period = \"a\" }",
        Some("\"a\""),
        "expected \"tau\"",
    ),
];

#[test]
fn what_does_not_fit_is_told_in_its_place() {
    for (text, part, says) in MISFITS.iter().copied() {
        let error = text.parse::<SystemModel>().expect_err(text);
        let found = error.span.clone().map(|span| &text[span]);
        assert_eq!(found, part, "{text}: {error:?}");
        assert!(error.message.contains(says), "{text}: {error:?}");
    }
}

#[test]
fn a_degree_that_grows_with_parameters_is_refused_where_it_does() {
    let text = "B = \"a*s^2 + 1\"\nA = \"s\"\n[parameters]\na = 1";
    let model: SystemModel = text.parse().unwrap();
    let mut at = model.defaults();
    assert!(model.at(&mut at).is_ok());
    at.own[0] = 0.0;
    let error = model.at(&mut at).unwrap_err().to_string();
    assert_eq!(
        error,
        "A: its degree is 1 here and that of B 0: not smaller"
    );
    let text = "P = \"s + 1/a\"\nQ = \"tau\"\n[parameters]\na = 0";
    let model: SystemModel = text.parse().unwrap();
    assert!(model.depends_on_delay());
    let error = model.at(&mut model.defaults()).unwrap_err().to_string();
    assert_eq!(error, "P: `1/a` has no finite value at this setting");
}
