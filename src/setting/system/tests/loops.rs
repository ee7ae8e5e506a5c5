//! Loops of plant and controller, and divisors in s.

use crate::linear::general::System;
use crate::linear::line::Linear;
use crate::setting::system::SystemModel;

/// Texts, each with the part that the error points at and its message.
pub(super) const MISFITS: &[(&str, Option<&str>, &str)] = &[
    ("plant = \"1/s^2\"\nP = \"s\"", Some("P"), "not both"),
    (
        "controller = \"1\"",
        Some("controller"),
        "controller without a plant",
    ),
    ("pid = { k_p = 1 }", Some("pid"), "pid without a plant"),
    ("delay = \"tau\"", Some("delay"), "delay without a plant"),
    (
        "pid = { k_p = 1 }\nplant = \"1/s\"\ncontroller = \"1\"",
        Some("controller"),
        "controller and pid: not both",
    ),
    (
        "plant = { num = [1], den = [1, 0], delay = 'tau' }\ndelay = \"tau\"",
        Some("\"tau\""),
        "the delay is named twice",
    ),
    (
        "plant = [{ num = 1, den = 's', delay = \"tau\" }, { num = 1, den = 's', delay = 'tau' }]",
        Some("'tau'"),
        "the delay is named twice",
    ),
    (
        "plant = \"1/s\"\ndelay = 0.3",
        Some("0.3"),
        "expected \"tau\"",
    ),
    (
        "plant = { num = [1] }",
        Some("{ num = [1] }"),
        "den is missing",
    ),
    (
        "plant = { den = [1] }",
        Some("{ den = [1] }"),
        "num is missing",
    ),
    (
        "plant = { num = 1, den = [0, 0.0] }",
        Some("[0, 0.0]"),
        "plant.den: a denominator of 0",
    ),
    (
        "plant = { num = 1, dem = 's' }",
        Some("dem"),
        "unknown key `plant.dem`",
    ),
    ("plant = [1, 2]", Some("1"), "a number in a list of blocks"),
    ("plant = []", Some("[]"), "no product"),
    ("plant = true", Some("true"), "expected an expression in s"),
    (
        "plant = [\"1/s\", { num = [1, \"x\"], den = 's' }]",
        Some("x"),
        "plant[1].num[1]: unknown name `x`",
    ),
    (
        "plant = \"s^2/(s + 1)\"",
        Some("\"s^2/(s + 1)\""),
        "the loop is improper",
    ),
    (
        "plant = \"1/(s + 1)\"\ncontroller.num = 1\npid = { k_i = 1, k_d = 1, k_p = 1 }",
        Some("controller"),
        "controller: den is missing",
    ),
    (
        "plant = \"2\"\npid = { k_p = 1, k_d = 1 }",
        Some("{ k_p = 1, k_d = 1 }"),
        "its numerator has degree 1, its denominator 0",
    ),
    (
        "plant = \"exp(-s)/s\"",
        Some("-s"),
        "plant: exp of what has s in it",
    ),
    (
        "plant = \"1/s^17\"\ncontroller = \"1/s^16\"",
        Some("\"1/s^17\""),
        "a loop of degree 33: at most 32",
    ),
    (
        "plant = \"1/s\"\npid = { k_p = \"s\" }",
        Some("s"),
        "a gain with s in it",
    ),
    ("plant = \"1/s\"\npid = { }", Some("{ }"), "without a gain"),
    (
        "plant = \"1/s\"\npid = { k_p = 1, t_f = 1 }",
        Some("t_f"),
        "it filters k_d",
    ),
    (
        "plant = \"1/s\"\npid = { kp = 1 }",
        Some("kp"),
        "unknown key `pid.kp`",
    ),
    (
        "plant = \"1/s\"\nignore_roots_at_zero = 1\nA0 = [[1]]",
        Some("A0"),
        "not both",
    ),
    (
        "P = \"1/(s^2 + 1)^10 + s\"\nQ = \"1/(s^2 + 2)^8\"",
        Some("\"1/(s^2 + 1)^10 + s\""),
        "a polynomial of degree 37 in s once divisors are multiplied out",
    ),
    (
        "B = \"s\"\nA = \"s/(s + 1)*s\"",
        Some("\"s/(s + 1)*s\""),
        "the smaller one",
    ),
];

fn model(text: &str) -> SystemModel {
    text.parse().unwrap_or_else(|e| panic!("{text}: {e:?}"))
}

/// The system at the defaults.
fn system(text: &str) -> Result<System, String> {
    let model = model(text);
    match model.at(&mut model.defaults()) {
        Ok(Linear::General(system)) => Ok(*system),
        Ok(other) => panic!("{text}: {other:?}"),
        Err(error) => Err(error.to_string()),
    }
}

/// Whether a text is the system of these coefficients of P and Q, the highest power first.
fn is(text: &str, p: &[f64], q: &[f64]) {
    let found = system(text).unwrap_or_else(|e| panic!("{text}: {e}"));
    for (found, expected) in found.polynomials().into_iter().zip([p, q]) {
        let highest_first: Vec<f64> = found.coefficients().iter().rev().copied().collect();
        assert_eq!(highest_first, expected, "{text}");
        assert!(
            found.errors().iter().all(|error| *error < 1e-13),
            "{text}: {found:?}"
        );
    }
}

#[test]
fn a_loop_is_denominators_and_delayed_numerators() {
    is("plant = \"2/(s*(4*s + 1))\"", &[4.0, 1.0, 0.0], &[2.0]);
    is(
        "plant = { num = 2, den = [4, 1, 0] }\ncontroller = \"3\"\ndelay = \"tau\"",
        &[4.0, 1.0, 0.0],
        &[6.0],
    );
    let blocks = "plant = [{ num = [2], den = \"s\" }, \"1/(4*s + 1)\"]\n\
        controller = { num = [1, 2], den = [\"a\", 1] }\nparameters.a = 8\n";
    is(blocks, &[32.0, 12.0, 1.0, 0.0], &[2.0, 4.0]);
    // Hidden modes stay, on both sides.
    is(
        "plant = \"1/(s - 1)\"\ncontroller = \"(s - 1)/(s + 2)\"",
        &[1.0, 1.0, -2.0],
        &[1.0, -1.0],
    );
    // An ideal derivative is proper with a plant of higher degree.
    is(
        "plant = \"1/s^2\"\npid = { k_p = 2, k_d = 3 }",
        &[1.0, 0.0, 0.0],
        &[3.0, 2.0],
    );
    is(
        "plant = \"1/s^2\"\npid = { k_p = 2, k_i = 4, k_d = 8, t_f = 0.5 }",
        &[0.5, 1.0, 0.0, 0.0, 0.0],
        &[9.0, 4.0, 4.0],
    );
}

/// A part of the controller whose gain is 0 has no root of its own.
#[test]
fn gains_of_zero_leave_no_factor() {
    let text =
        |gains: &str| format!("plant = \"1/(s + 1)\"\npid = {{ {gains} }}\nparameters.a = 0\n");
    let alone = [1.0, 1.0];
    is(&text("k_p = 2, k_i = \"a\""), &alone, &[2.0]);
    is(
        &text("k_p = 2, k_i = \"a\", k_d = 0, t_f = 3"),
        &alone,
        &[2.0],
    );
    is(&text("k_p = 2, k_d = \"a\", t_f = 3"), &alone, &[2.0]);
    is(&text("k_d = 0.5, t_f = \"a\""), &alone, &[0.5, 0.0]);
    is(&text("k_i = 3, k_p = \"a\""), &[1.0, 1.0, 0.0], &[3.0]);
    is(
        &text("k_i = 3, k_d = \"a\", t_f = 1"),
        &[1.0, 1.0, 0.0],
        &[3.0],
    );
}

#[test]
fn a_loop_that_is_none_at_a_setting_is_told() {
    let of = |text: &str| system(text).expect_err(text);
    let improper = "plant = \"1/(a*s + 1)\"\npid = { k_d = 1 }\nparameters.a = 0\n";
    assert!(
        of(improper).contains("improper at this setting"),
        "{}",
        of(improper)
    );
    let algebraic = "plant = \"(1 - a*s)/(2*s + 1)\"\nparameters.a = 2\n";
    assert!(
        of(algebraic).contains("an algebraic loop"),
        "{}",
        of(algebraic)
    );
    assert!(system("plant = \"(1 + 2*s)/(2*s + 1)\"").is_ok());
    let zero = "plant = { num = 1, den = [\"a\", \"a\"] }\nparameters.a = 0\n";
    assert_eq!(
        of(zero),
        "plant: `a*s + a` has no finite value at this setting"
    );
    let zero = "plant = \"1/(a*s)\"\nparameters.a = 0\n";
    assert!(of(zero).contains("has no finite value"), "{}", of(zero));
}

/// Both sides are multiplied by the least common multiple of the divisors.
#[test]
fn divisions_are_multiplied_out() {
    is(
        "P = \"s + 2/(s + 3)\"\nQ = \"1/(s + 3)\"",
        &[1.0, 3.0, 2.0],
        &[1.0],
    );
    is("P = \"1\"\nQ = \"4/(s*(s + 3))\"", &[1.0, 3.0, 0.0], &[4.0]);
    is(
        "P = \"1/s + 1\"\nQ = \"4/(s + 3)\"",
        &[1.0, 4.0, 3.0],
        &[4.0, 0.0],
    );
    is(
        "P = [1, 0]\nQ = \"k/s\"\nparameters.k = 7\n",
        &[1.0, 0.0, 0.0],
        &[7.0],
    );
    is(
        "D = [\"1 + 1/s\", \"2/(s + 1)\"]",
        &[1.0, 2.0, 1.0],
        &[2.0, 0.0],
    );
    let feedback = "B = \"s + 1/(s + 2)\"\nA = \"1/(s + 2)\"";
    is(feedback, &[1.0, 2.0, 0.0], &[1.0]);
    let zero = "P = \"s\"\nQ = \"1/(k*s + k)\"\nparameters.k = 0\n";
    assert_eq!(
        system(zero).unwrap_err(),
        "P: `k*s + k` has no finite value at this setting"
    );
}

#[test]
fn loops_are_written_as_they_are_read() {
    for form in [
        "plant = \"k/(s*(k*s + 1))\"",
        "plant = { num = [1, 2.5], den = [1, \"k\", -0.5, 0], delay = \"tau\" }\ncontroller = 2",
        "plant = [{ num = \"k - 1\", den = [1, 0] }, \"1/(s + 1)\"]\n\
         pid = { k_p = \"k\", k_i = 1e-3 }",
        "plant = \"1/s^2\"\npid = { k_p = 1, k_d = \"k\", t_f = 0 }\ndelay = \"tau\"",
        "P = \"s + k/(s + 1)\"\nQ = \"tau/(s + 2)\"",
        "D = [\"1 + k/s\", 0, \"1/(s + 1)\"]",
    ] {
        let model = model(&format!("{form}\n[parameters]\nk = 2\n"));
        let written = model.to_toml();
        assert_eq!(written.parse(), Ok(model.clone()), "{written}");
        assert_eq!(model.depends_on_delay(), form.contains("tau/"));
        let sweep = format!("system = {}\n", model.to_inline_table());
        let document = crate::text::toml_reader::parse(&sweep).unwrap();
        let entries = crate::text::toml_reader::entries(document.get_ref(), "");
        assert_eq!(SystemModel::of_table(&entries[0], &sweep), Ok(model));
    }
}
