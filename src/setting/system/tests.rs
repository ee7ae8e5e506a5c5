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
    ("P = 3\nQ = \"1\"", Some("3"), "or a list of coefficients"),
    ("P = []\nQ = [1]", Some("[]"), "P: an empty list"),
    (
        "P = [1, nan]\nQ = [1]",
        Some("nan"),
        "P[1]: expected a finite",
    ),
    ("P = [1, 1e999]\nQ = [1]", Some("1e999"), "a finite number"),
    (
        "P = [1, [2]]\nQ = [1]",
        Some("[2]"),
        "P[1]: expected a number or",
    ),
    (
        "P = [1]\nQ = [true]",
        Some("true"),
        "Q[0]: expected a number or",
    ),
    (
        "P = [1]\nQ = [1, \"2*s\"]",
        Some("s"),
        "Q[1]: a coefficient with s",
    ),
    (
        "P = [1, \"\"]\nQ = [1]",
        Some("\"\""),
        "P[1]: expected a number",
    ),
    ("P = [1, \"2*\"]\nQ = [1]", Some("\""), "found the end"),
    (
        "P = [1, \"2 stiff\"]\nQ = [1]",
        Some("s"),
        "expected an operator",
    ),
    (
        "P = [\"lambda\"]\nQ = [1]",
        Some("lambda"),
        "P[0]: unknown name",
    ),
    // No element is more than one number: together these two would make an expression.
    (
        "P = [\"(1\", \"2)\"]\nQ = [1]",
        Some("("),
        "P[0]: this `(` is not",
    ),
    (
        "P = [1]\nQ = [\"1) + (1\"]",
        Some(")"),
        "Q[0]: this `)` closes",
    ),
    (
        "P = [1]\nQ = [1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]",
        Some("[1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]"),
        "Q: a polynomial of degree 17 in s",
    ),
    ("B = [1, 2]\nA = [3, 0]", Some("[3, 0]"), "the smaller one"),
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
    (
        "P = \"s + rpm\"\nQ = \"1\"\nspeed_axis.name = \"n\"\nparameters.rpm = 1",
        Some("rpm"),
        "rpm is reserved",
    ),
];

/// Coefficients, the highest power first, are the expression that stands beside them.
#[test]
fn a_list_of_coefficients_is_the_expression_that_it_says() {
    let read = |p: &str, q: &str| -> SystemModel {
        let text = format!("P = {p}\nQ = {q}\n[parameters]\nzeta = 0.05\nk = 0.2\n");
        text.parse().unwrap_or_else(|e| panic!("{text}: {e:?}"))
    };
    let q = "[\"k\", \"zeta\"]";
    for (list, expression) in [
        ("[1, 0.04, 1.2]", "s^2 + 0.04*s + 1.2"),
        ("[-1, -1, -1]", "-s^2 - s - 1"),
        ("[-0.25, 0]", "-0.25*s"),
        ("[3]", "3"),
        ("[1, 0, -0.0, 2.5e-7, 1e300]", "s^4 + 2.5e-7*s + 1e300"),
        ("[0x10, 1_000.0]", "16*s + 1000"),
        // As in expressions, a power whose coefficient is zero is none.
        ("[0, 0.0, 1, 2]", "s + 2"),
        ("['-k']", "-k"),
        ("['k/2^zeta', 'max(k, 1)']", "k/2^zeta*s + max(k, 1)"),
        ("[0]", "0"),
        ("[0, 0]", "0"),
        ("[1, \"2*zeta\", \"1 + k\"]", "s^2 + 2*zeta*s + (1 + k)"),
        (
            "[\"k\", \" zeta \", '-k', \"2\"]",
            "k*s^3 + zeta*s^2 + (-k)*s + 2",
        ),
    ] {
        let (model, same) = (read(list, q), read(&format!("\"{expression}\""), q));
        assert_eq!(model.expressions().next(), Some(("P", expression)));
        assert_eq!(model, same, "{list}");
        assert_eq!(model.to_toml().parse(), Ok(model.clone()), "{list}");
    }
    // Zeros before the highest power have no place: no degree follows from them.
    let model = "B = [1, 2]\nA = [0, 0, 3]".parse::<SystemModel>();
    assert!(model.is_ok(), "{model:?}");
    let model = read("[1, 0.3, \"1/zeta\"]", q);
    let mut at = model.defaults();
    assert!(model.at(&mut at).is_ok());
    at.own[0] = 0.0;
    let error = model.at(&mut at).unwrap_err().to_string();
    assert_eq!(error, "P: `1/zeta` has no finite value at this setting");
}

/// What an element may be by itself can be too deep or too long with the others.
#[test]
fn lists_that_are_too_deep_or_too_long_are_refused_as_a_whole() {
    let deep = format!("\"{}1+1{}\", 2", "(".repeat(64), ")".repeat(64));
    let long = format!("\"1{}\", ", "+1".repeat(700)).repeat(3) + "1";
    for list in [deep, long] {
        let text = format!("P = [{list}]\nQ = [1]");
        let error = text.parse::<SystemModel>().expect_err(&text);
        assert_eq!(error.span, Some(4..list.len() + 6), "{error:?}");
    }
}

proptest::proptest! {
    /// Numbers in a list are the coefficients, to the last bit.
    #[test]
    fn numbers_of_lists_keep_their_bits(of in proptest::collection::vec(
        proptest::num::f64::NORMAL | proptest::num::f64::ZERO | proptest::num::f64::SUBNORMAL,
        1..=17,
    )) {
        let text = format!("P = {of:?}\nQ = [1]");
        let model: SystemModel = text.parse().unwrap_or_else(|e| panic!("{text}: {e:?}"));
        let Form::Direct([p, _]) = &model.form else {
            panic!("{text}");
        };
        let p = p.at("P", &[], &mut Stacks::default());
        let p = p.unwrap_or_else(|e| panic!("{text}: {e}"));
        let mut expected: Vec<f64> = of.iter().rev().copied().collect();
        while expected.len() > 1 && expected.last() == Some(&0.0) {
            expected.pop();
        }
        proptest::prop_assert_eq!(p.coefficients(), &*expected);
    }
}

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
