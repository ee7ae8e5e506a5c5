//! Tests of systems from files.
//!
//! - `loops`: loops of plant and controller, and divisors in s

use super::shipped::{SHIPPED, system, text_of};
use super::*;

mod loops;

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
        ("ring_road", "alpha b"),
        ("pi_loop", "gain time_constant k_p k_i"),
        (
            "smith_predictor",
            "gain model_gain time_constant k_p k_i late",
        ),
    ] {
        assert_eq!(names(name).join(" "), parameters, "{name}");
    }
}

/// Texts, each with the part that the error points at and its message.
const MISFITS: &[(&str, Option<&str>, &str)] = &[
    ("", None, "a system needs its polynomials or matrices"),
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
        "P = [1]\nQ = [1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, \
         0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]",
        Some(
            "[1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, \
             0, 0, 0, 0, 0, 0, 0, 0]",
        ),
        "Q: a polynomial of degree 33 in s",
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
    ("[parameters]\npi = 1", Some("pi"), "it is the number pi"),
    (
        "[parameters]\n\"π\" = 1",
        Some("\"π\""),
        "it is the number pi",
    ),
    ("[parameters]\n\"τ\" = 1", Some("\"τ\""), "it is the delay"),
    ("[parameters]\n\"Α\" = 1", Some("\"Α\""), "no name of a"),
    (
        "[parameters]\n\"\u{b5}\" = 1\n\"\u{3bc}\" = 1",
        Some("\"\u{3bc}\""),
        "are one name",
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

/// Those of matrices and of powers of the delay.
const MISFITS_OF_MATRICES: &[(&str, Option<&str>, &str)] = &[
    ("A0 = [[1]]", None, "A0 alone makes no system"),
    ("A1 = [[1]]", None, "A1 alone makes no system"),
    ("A0 = [[1]]\nE1 = [[1]]", None, "A0 and E1 alone make"),
    ("P = \"s\"\nQ = \"1\"\nA0 = [[1]]", Some("A0"), "not both"),
    ("A0 = [[1]]\nD = [1, 2]", Some("D"), "not both"),
    (
        "A0 = [[1]]\nA1 = [[1]]\nfeedback = { B = [[1]], C = [[1]] }",
        Some("feedback"),
        "not both",
    ),
    ("A0 = 3\nA1 = [[1]]", Some("3"), "expected an array of rows"),
    (
        "A0 = []\nA1 = [[1]]",
        Some("[]"),
        "an empty list is no matrix",
    ),
    (
        "A0 = [[]]\nA1 = [[1]]",
        Some("[]"),
        "a row has 1 to 32 entries",
    ),
    (
        "A0 = [1, 2]\nA1 = [[1]]",
        Some("1"),
        "expected a row in brackets",
    ),
    (
        "A0 = [[1, 2], [3]]\nA1 = [[1]]",
        Some("[3]"),
        "1 entries, the first 2",
    ),
    (
        "A0 = [[1, 2]]\nA1 = [[1]]",
        Some("[[1, 2]]"),
        "needs 1 row of 1 entry",
    ),
    (
        "A0 = [[1]]\nA1 = [[1, 2], [3, 4]]",
        Some("[[1, 2], [3, 4]]"),
        "A1 has 2 rows of 2 entries",
    ),
    (
        "A0 = [[1]]\nA1 = [[1]]\nE1 = [[1, 2]]",
        Some("[[1, 2]]"),
        "E1 has 1 row of 2",
    ),
    (
        "A0 = [[1, 2], [3, 4]]\nfeedback = { B = [[1]], C = [[1, 2]] }",
        Some("[[1]]"),
        "B has 1 row of 1",
    ),
    (
        "A0 = [[1]]\nfeedback = { B = [[1]], C = [[1], [2]] }",
        Some("[[1], [2]]"),
        "C has 2 rows of 1",
    ),
    (
        "A0 = [[1]]\nfeedback = { B = [[1]], K = [[1], [2]], C = [[1]] }",
        Some("[[1], [2]]"),
        "K has 2 rows",
    ),
    (
        "A0 = [[1]]\nfeedback = { B = [[1]] }",
        Some("{ B = [[1]] }"),
        "C is missing",
    ),
    (
        "A0 = [[1]]\nfeedback = { B = [[1]], D = [[1]] }",
        Some("D"),
        "unknown key `feedback.D`",
    ),
    (
        "A0 = [[\"s + 1\"]]\nA1 = [[1]]",
        Some("s"),
        "A0[0][0]: an entry with s in it",
    ),
    (
        "A0 = [[\"k\"]]\nA1 = [[1]]",
        Some("k"),
        "A0[0][0]: unknown name `k`",
    ),
    (
        "A0 = [[true]]\nA1 = [[1]]",
        Some("true"),
        "expected a number or a string",
    ),
    (
        "A0 = [[1]]\nA1 = [[1]]\nparameters.k = 1",
        Some("k"),
        "stands in no expression",
    ),
    (
        "A0 = [[\"A1\"]]\nA1 = [[1]]\nparameters.A1 = 1",
        Some("A1"),
        "has a matrix of that name",
    ),
    (
        "A0 = [[1]]\nA1 = [[1]]\nignore_roots_at_zero = 1",
        Some("ignore_roots_at_zero"),
        "is for P and Q",
    ),
    ("D = [\"s\"]", Some("[\"s\"]"), "2 to 9 polynomials, not 1"),
    (
        "D = \"s\"",
        Some("\"s\""),
        "expected an array of polynomials",
    ),
    (
        "D = [\"s\", \"s^2\", 1]",
        Some("\"s^2\""),
        "D[1]: its degree is 2 and that of D[0] 1",
    ),
    ("D = [\"s\", \"x\", 1]", Some("x"), "D[1]: unknown name `x`"),
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
        assert_eq!(model.expressions()[0], ("P", expression.into()));
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

/// What a matrix may be at most, and what is read back from what is written.
#[test]
fn matrices_are_written_as_they_are_read() {
    let large = |n: usize| {
        format!(
            "[{}]",
            vec![format!("[1{}]", ", 0".repeat(n - 1)); n].join(", ")
        )
    };
    let of_size = |n: usize| format!("A0 = {0}\nA1 = {0}", large(n)).parse::<SystemModel>();
    assert!(of_size(32).is_ok());
    let error = of_size(33).unwrap_err();
    assert!(error.message.contains("33 rows: at most 32"), "{error:?}");
    for form in [
        "A0 = [[\"-k\", 1e-300], [0x10, -0.1]]\nA1 = [[0, 0], [\"k*tau\", 3]]\n\
            E1 = [[0, 0], [0, 0.5]]",
        "A0 = [[1]]\nfeedback = { B = [[1, 2]], K = [[\"k\"], [2]], C = [[3]] }",
        "A0 = [[1]]\nfeedback = { B = [[\"k\", 2]], C = [[3], [4]] }",
        "D = [\"s^2\", [1, \"k\"], -0.25, 0]",
        "D = [\"s\", \"k\"]",
    ] {
        let text = format!("{form}\n[parameters]\nk = 2\n");
        let model: SystemModel = text.parse().unwrap_or_else(|e| panic!("{text}: {e:?}"));
        assert_eq!(
            model.to_toml().parse(),
            Ok(model.clone()),
            "{}",
            model.to_toml()
        );
        assert_eq!(model.depends_on_delay(), form.contains("tau"));
        let sweep = format!("system = {}\n", model.to_inline_table());
        let document = crate::text::toml_reader::parse(&sweep).unwrap();
        let entries = crate::text::toml_reader::entries(document.get_ref(), "");
        assert_eq!(SystemModel::of_table(&entries[0], &sweep), Ok(model));
    }
}

/// Greek names are those of the file, in any form of their letters.
#[test]
fn greek_names_are_written_in_quotes_and_found_in_every_form() {
    let text = "P = \"s^2 + 2*ζ*ω_0*s + ω_0^2 + \u{b5}\"\nQ = \"-\u{3bc}*cos(2*pi*ζ)\"\n\
        [parameters]\n\"ζ\" = 0.05\n\"ω_0\" = 2\n\"\u{b5}\" = { default = 0.1 }\n";
    let model: SystemModel = text.parse().unwrap();
    let names: Vec<&str> = model.parameters.iter().map(|own| &*own.name).collect();
    assert_eq!(names, ["ζ", "ω_0", "\u{3bc}"]);
    assert_eq!(model.to_toml().parse(), Ok(model.clone()));
    let named = |name: &str| model.quantity(name).map(|of| of.name().to_owned());
    assert_eq!(named("\u{b5}").as_deref(), Some("\u{3bc}"));
    assert_eq!(named("τ").as_deref(), Some("tau"));
    assert!(!model.depends_on_delay() && named("mu").is_none());
    let bare = "P = \"s\"\nQ = \"1\"\n[parameters]\nω = 1\n";
    let error = bare.parse::<SystemModel>().unwrap_err();
    let help = error.help.unwrap_or_default();
    assert!(
        help.contains("in quotes: \"ω\""),
        "{} {help}",
        error.message
    );
}

/// What an element may be by itself can be too deep or too long with the others.
#[test]
fn lists_that_are_too_deep_or_too_long_are_refused_as_a_whole() {
    let deep = format!("\"{}1+1{}\", 2", "(".repeat(64), ")".repeat(64));
    let long = format!("\"1{}\", ", "+1".repeat(11_000)).repeat(3) + "1";
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
        1..=33,
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
    let all = MISFITS.iter().chain(MISFITS_OF_MATRICES);
    for (text, part, says) in all.chain(loops::MISFITS).copied() {
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
