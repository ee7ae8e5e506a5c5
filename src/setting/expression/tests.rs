use num_complex::Complex64;
use proptest::prelude::*;

use super::names::names_in;
use super::reader::*;
use super::{Misread, Stacks, Tape};
use crate::linear::general::polynomial::{MOST_DEGREE, Polynomial};

const NAMES: [&str; 3] = ["a", "b_2", "tau"];

/// A text without divisors in s.
fn polynomial(text: &str) -> Result<Tape, Misread> {
    let read = read(text, &NAMES)?;
    assert!(read.under.is_empty(), "{text}");
    Ok(read.over)
}

fn coefficients(text: &str, values: &[f64]) -> Vec<f64> {
    let tape = polynomial(text).unwrap_or_else(|e| panic!("{text}: {e:?}"));
    let found = tape.at(values, &mut Stacks::default());
    found
        .unwrap_or_else(|e| panic!("{text}: {e:?}"))
        .coefficients()
        .to_vec()
}

#[test]
fn what_is_written_is_what_is_evaluated() {
    let (a, b, tau) = (2.0, -3.0, 0.5_f64);
    for (text, expected) in [
        ("0", vec![0.0]),
        ("-9.1e-05", vec![-9.1e-05]),
        (".5 + 1.E2", vec![100.5]),
        ("s", vec![0.0, 1.0]),
        ("s^2 + 2*a*s + 1", vec![1.0, 4.0, 1.0]),
        ("-s^2", vec![0.0, 0.0, -1.0]),
        ("(-s)^2", vec![0.0, 0.0, 1.0]),
        ("- - 3", vec![3.0]),
        ("1 - 2 - 3", vec![-4.0]),
        ("8/2/2", vec![2.0]),
        ("2*3^2", vec![18.0]),
        ("a^-2", vec![0.25]),
        ("a*-b_2", vec![6.0]),
        ("a - s", vec![2.0, -1.0]),
        ("(s + 1)*(s - 1)/a", vec![-0.5, 0.0, 0.5]),
        ("(1 + a*s)^3", vec![1.0, 6.0, 12.0, 8.0]),
        ("s^0", vec![1.0]),
        ("min(a, b_2, 7) + max(a, b_2)", vec![-1.0]),
        ("sqrt(a + 2)*s", vec![0.0, 2.0]),
        ("exp(0) + log(1) + sin(0) + cos(0)", vec![2.0]),
        ("4^tau + a^(1/a - 1/2)", vec![3.0]),
        ("-4^0.5", vec![-2.0]),
        ("2^3^2", vec![512.0]),
        ("ln(1) + tanh(0) + cosh(0) + sinh(0) + atan(0)", vec![1.0]),
        ("tau*s + s*tau", vec![0.0, 1.0]),
        ("s*s*s - s^3", vec![0.0]),
        ("\n (\t(s))\r\n", vec![0.0, 1.0]),
    ] {
        assert_eq!(coefficients(text, &[a, b, tau]), expected, "{text}");
    }
}

/// Texts, each with the part that the error points at.
#[test]
fn what_is_not_understood_is_told_in_its_place() {
    for (text, part, says) in [
        ("", "", "found the end"),
        ("2*", "", "found the end"),
        ("2 s", "s", "expected an operator"),
        ("2zeta", "z", "expected an operator"),
        ("a**2", "**", "found `*`"),
        ("a*/2", "/", "found `/`"),
        ("s + ö", "ö", "found `ö`"),
        ("s + ζ*a", "ζ", "unknown name `ζ`"),
        ("s + ω_2(a)", "ω_2", "unknown function `ω_2`"),
        ("a + Α", "Α", "found `Α`"),
        ("π(s + 1)", "π", "not a function"),
        ("(s + 1", "(", "not closed"),
        ("(s + 1]", "]", "found `]`"),
        ("s + 1)", ")", "closes nothing"),
        ("s, 1", ",", "no place here"),
        ("()", ")", "found `)`"),
        ("b2*s", "b2", "unknown name `b2`"),
        ("sgrt(a)", "sgrt", "unknown function `sgrt`"),
        ("a(s + 1)", "a", "not a function"),
        ("s (s + 1)", "s", "not a function"),
        ("sqrt + 1", "sqrt", "needs an argument"),
        ("sqrt(a, b_2)", "sqrt(a, b_2)", "takes one, 2 given"),
        ("1 + max(a)", "max(a)", "takes two or more"),
        ("sqrt(a", "(", "not closed"),
        ("exp(-s*tau)", "-s*tau", "exp of what has s in it"),
        ("1/(s^17*(s^16 - 1))", "s^17*(s^16 - 1)", "degree 33"),
        ("1/s^17/(s^16 - 1)", "1/s^17/(s^16 - 1)", "degree 33"),
        ("(s + 1)^-33", "(s + 1)^-33", "degree 33"),
        (
            "1/(s + 1)^17 + 1/(s - 1)^17",
            "1/(s + 1)^17 + 1/(s - 1)^17",
            "degree 34",
        ),
        ("s^a", "a", "whole number"),
        ("s^0.5", "0.5", "whole number"),
        ("2^s", "s", "an exponent with s in it"),
        ("a^65", "65", "too large"),
        ("1e999", "1e999", "too large"),
        (".", ".", "expected a number"),
        ("(1 + s)^33", "(1 + s)^33", "degree 33"),
        ("1 + s^9*(s^24 - 1)", "s^9*(s^24 - 1)", "degree 33"),
    ] {
        let error = read(text, &NAMES).expect_err(text);
        assert_eq!(&text[error.place.clone()], part, "{text}: {error:?}");
        assert!(error.message.contains(says), "{text}: {error:?}");
    }
    let error = read("b2 + 1", &NAMES).unwrap_err();
    assert!(error.help.unwrap().starts_with("did you mean `b_2`?"));
    let error = read("sgrt(2)", &NAMES).unwrap_err();
    assert!(error.help.unwrap().starts_with("did you mean `sqrt`?"));
}

/// The determinant of a matrix as a sum of products, as a computer algebra program expands it.
fn expanded(of: &[Vec<String>], rows: &[usize], columns: &[usize]) -> Vec<String> {
    let [row, rows @ ..] = rows else {
        return vec![String::new()];
    };
    let mut terms = Vec::new();
    for (place, column) in columns.iter().enumerate() {
        let entry = &of[*row][*column];
        if entry != "0" {
            let others: Vec<usize> = columns.iter().copied().filter(|c| c != column).collect();
            let sign = if place % 2 == 0 { "" } else { "(-1)*" };
            let minors = expanded(of, rows, &others).into_iter();
            terms.extend(minors.map(|minor| match minor.is_empty() {
                true => format!("{sign}({entry})"),
                false => format!("{sign}({entry})*{minor}"),
            }));
        }
    }
    terms
}

/// Its value where the entries are numbers, by elimination.
fn determinant(mut of: Vec<Vec<Complex64>>) -> Complex64 {
    let mut product = Complex64::new(1.0, 0.0);
    for k in 0..of.len() {
        product *= of[k][k];
        let (above, below) = of.split_at_mut(k + 1);
        for row in below {
            let by = row[k] / above[k][k];
            for (entry, from) in row.iter_mut().zip(&above[k]).skip(k) {
                *entry -= by * from;
            }
        }
    }
    product
}

/// Seven masses, each with springs to the next two: what is pasted has tens of kilobytes.
#[test]
fn a_determinant_that_was_expanded_elsewhere_is_read() {
    const N: usize = 7;
    let names = ["m", "zeta", "stiffness", "coupling_1", "coupling_2"];
    let values = [1.25, 0.03, 2.5, -0.75, 0.4];
    let entry = |i: usize, j: usize| match i.abs_diff(j) {
        0 => format!("{}*m*s^2 + 2*zeta*s + stiffness", i + 1),
        1 => "coupling_1 + zeta*s".to_owned(),
        2 => "coupling_2".to_owned(),
        _ => "0".to_owned(),
    };
    let rows: Vec<Vec<String>> = (0..N)
        .map(|i| (0..N).map(|j| entry(i, j)).collect())
        .collect();
    let all: Vec<usize> = (0..N).collect();
    let text = expanded(&rows, &all, &all).join(" + ");
    assert!((20_000..=LONGEST).contains(&text.len()), "{}", text.len());
    let tape = read(&text, &names).unwrap().over;
    let found = tape.at(&values, &mut Stacks::default()).unwrap();
    assert_eq!(found.degree(), 2 * N);
    let [m, zeta, stiffness, first, second] = values;
    for s in [(0.3, 0.9), (-0.2, 1.7), (0.0, 2.4)] {
        let s = Complex64::new(s.0, s.1);
        let number = |i: usize, j: usize| match i.abs_diff(j) {
            0 => (i + 1) as f64 * m * s * s + 2.0 * zeta * s + stiffness,
            1 => first + zeta * s,
            2 => second.into(),
            _ => 0.0.into(),
        };
        let rows = (0..N).map(|i| (0..N).map(|j| number(i, j)).collect());
        let expected = determinant(rows.collect());
        let value = found.coefficients().iter().rev();
        let value = value.fold(Complex64::ZERO, |sum, c| sum * s + c);
        assert!((value - expected).norm() < 1e-10 * expected.norm(), "{s}");
    }
}

#[test]
fn greek_letters_are_letters_and_pi_is_the_number() {
    let names = ["ω", "μ_2", "tau"];
    let values = [2.0, -3.0, 0.5];
    let found = |text: &str| {
        let tape = read(text, &names)
            .unwrap_or_else(|e| panic!("{text}: {e:?}"))
            .over;
        let found = tape.at(&values, &mut Stacks::default()).unwrap();
        (found.coefficients().to_vec(), found.errors().to_vec())
    };
    // The micro sign is the letter, and τ the delay.
    assert_eq!(found("s^2 + 2*ω*s + \u{b5}_2").0, [-3.0, 4.0, 1.0]);
    assert_eq!(found("τ*s + tau").0, [0.5, 0.5]);
    for text in ["pi/ω*s", "π/ω*s"] {
        let (values, errors) = found(text);
        assert_eq!(values, [0.0, std::f64::consts::FRAC_PI_2], "{text}");
        // π is no double.
        assert!(errors[1] > 6e-17 && errors[1] < 1e-15, "{errors:?}");
    }
    assert_eq!(
        names_in("ω*\u{3bc}*exp(pi) + \u{b5} + _x*ω"),
        ["ω", "μ", "_x"]
    );
}

/// A text that is too deep or too long is refused, without overflow.
#[test]
fn long_texts_are_refused() {
    let many = |part: &str, n: usize| part.repeat(n);
    for text in [
        many("(", 60_000),
        many("-", 60_000),
        many("sqrt(", 12_000),
        many("2^", 30_000) + "1",
        many("1+", 32_000) + "1" + &many(" ", 2000),
    ] {
        assert!(read(&text, &NAMES).is_err(), "{text}");
    }
    let long = many("a+", 32_000) + "a";
    assert_eq!(coefficients(&long, &[0.5, 0.0, 0.0]), [16_000.5]);
    assert!(read(&(many("1^", 64) + "1"), &NAMES).is_ok());
    assert!(read(&(many("(", 64) + "1" + &many(")", 64)), &NAMES).is_ok());
}

#[test]
fn what_has_no_value_is_told_in_its_place() {
    for (text, part) in [
        ("s + 1/(a - 2)", "1/(a - 2)"),
        ("s/(a - 2) + 1", "s/(a - 2)"),
        ("sqrt(b_2)", "sqrt(b_2)"),
        ("1 + log(0*a)*s", "log(0*a)"),
        ("exp(1e5)", "exp(1e5)"),
        ("(1e300*s + 1)*(1e300*s)", "(1e300*s + 1)*(1e300*s)"),
    ] {
        let tape = polynomial(text).unwrap();
        let place = tape
            .at(&[2.0, -3.0, 0.5], &mut Stacks::default())
            .unwrap_err();
        assert_eq!(&text[place], part, "{text}");
    }
}

/// Coefficients of a dividend and of the factors below it, at a = 2, b_2 = −3, tau = 0.5.
#[test]
fn divisors_in_s_stand_below_once_each() {
    let (s, lag) = (vec![0.0, 1.0], vec![1.0, 2.0]);
    for (text, over, under) in [
        ("1/(a*s + 1)", vec![1.0], vec![lag.clone()]),
        (
            "b_2/(s*(a*s + 1))",
            vec![-3.0],
            vec![s.clone(), lag.clone()],
        ),
        // The factors of a divisor count each by itself, so that no common one comes twice.
        (
            "1/s + 3/(s*(a*s + 1))",
            vec![4.0, 2.0],
            vec![s.clone(), lag.clone()],
        ),
        (
            "1/(a*s + 1) + s/(a*s + 1)",
            vec![1.0, 1.0],
            vec![lag.clone()],
        ),
        ("1/s - 1/s^2", vec![-1.0, 1.0], vec![s.clone(), s.clone()]),
        ("1 + a/(s*4)", vec![0.5, 1.0], vec![s.clone()]),
        ("-1/(-s)", vec![1.0], vec![s.clone()]),
        ("1/(1 + 1/s)", vec![0.0, 1.0], vec![vec![1.0, 1.0]]),
        ("(1/s)/(1/(a*s + 1))", vec![1.0, 2.0], vec![s.clone()]),
        ("1/(s/4)", vec![4.0], vec![s.clone()]),
        ("s^-2*tau", vec![0.5], vec![s.clone(), s.clone()]),
        (
            "(s/(a*s + 1))^2",
            vec![0.0, 0.0, 1.0],
            vec![lag.clone(), lag.clone()],
        ),
        ("(1/s)^-1", vec![0.0, 1.0], vec![]),
        // Nothing is cancelled.
        ("s/s", vec![0.0, 1.0], vec![s.clone()]),
        ("(s + 1)/(s + 1) - 1", vec![0.0], vec![vec![1.0, 1.0]]),
    ] {
        let read = read(text, &NAMES).unwrap_or_else(|e| panic!("{text}: {e:?}"));
        let value = |tape: &Tape| {
            let found = tape.at(&[2.0, -3.0, 0.5], &mut Stacks::default());
            found
                .unwrap_or_else(|e| panic!("{text}: {e:?}"))
                .coefficients()
                .to_vec()
        };
        assert_eq!(value(&read.over), over, "{text}");
        let found: Vec<_> = read
            .under
            .iter()
            .map(|factor| value(&factor.tape()))
            .collect();
        assert_eq!(found, under, "{text}");
    }
    // A divisor that is 0 at all s has no inverse.
    let read = read("s + 1/((a - 2)*s)", &NAMES).unwrap();
    let tape = read.over.at(&[2.0, 0.0, 0.0], &mut Stacks::default());
    assert!(tape.is_err(), "{tape:?}");
    let fraction = "1/(1 + ".repeat(50) + "s" + &")".repeat(50);
    let error = super::reader::read(&fraction, &NAMES).unwrap_err();
    assert!(error.message.contains("too long"), "{error:?}");
}

/// An expression as a tree, evaluated by the rules of arithmetic, independently of `read`.
#[derive(Debug, Clone)]
enum Tree {
    Number(f64),
    Name(usize),
    Variable,
    Negated(Box<Self>),
    Two(char, Box<Self>, Box<Self>),
    Power(Box<Self>, u32),
}

impl Tree {
    /// The tree as text, with every parenthesis or with as few as precedence allows.
    fn print(&self, all: bool) -> String {
        let inside = |of: &Self, wrapped: bool| match wrapped {
            true => format!("({})", of.print(all)),
            false => of.print(all),
        };
        match self {
            Self::Number(value) => format!("{value:?}"),
            Self::Name(index) => NAMES[*index].into(),
            Self::Variable => VARIABLE.into(),
            Self::Negated(of) => format!("-{}", inside(of, all || of.strength() < 2)),
            Self::Power(of, n) => format!("{}^{n}", inside(of, all || of.strength() < 4)),
            Self::Two(op, a, b) => {
                let own = self.strength();
                let (a, b) = (
                    inside(a, all || a.strength() < own),
                    inside(b, all || b.strength() <= own),
                );
                format!("{a} {op} {b}")
            }
        }
    }

    fn strength(&self) -> u8 {
        match self {
            Self::Two('+' | '-', ..) => 0,
            Self::Two(..) => 1,
            Self::Negated(_) => 2,
            Self::Power(..) => 3,
            Self::Number(value) if value.is_sign_negative() => 0,
            Self::Number(_) | Self::Name(_) | Self::Variable => 4,
        }
    }

    fn degree(&self) -> usize {
        match self {
            Self::Number(_) | Self::Name(_) => 0,
            Self::Variable => 1,
            Self::Negated(of) => of.degree(),
            Self::Two('*', a, b) => a.degree() + b.degree(),
            Self::Two(_, a, b) => a.degree().max(b.degree()),
            Self::Power(of, n) => of.degree() * *n as usize,
        }
    }

    /// The value at `s`, and the same without cancellation.
    fn value(&self, s: f64, values: &[f64]) -> (f64, f64) {
        let of = |tree: &Self| tree.value(s, values);
        match self {
            Self::Number(value) => (*value, value.abs()),
            Self::Name(index) => (values[*index], values[*index].abs()),
            Self::Variable => (s, s.abs()),
            Self::Negated(a) => (-of(a).0, of(a).1),
            Self::Power(a, n) => (of(a).0.powi(*n as i32), of(a).1.powi(*n as i32)),
            Self::Two(op, a, b) => {
                let ((a, size_a), (b, size_b)) = (of(a), of(b));
                match op {
                    '+' => (a + b, size_a + size_b),
                    '-' => (a - b, size_a + size_b),
                    '/' => (a / b, size_a / b.abs() + a.abs() * size_b / (b * b)),
                    _ => (a * b, size_a * size_b),
                }
            }
        }
    }
}

fn tree() -> impl Strategy<Value = Tree> {
    tree_with(vec!['+', '-', '*'])
}

/// Trees with these operations of two operands.
fn tree_with(ops: Vec<char>) -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![
        prop_oneof![(0..9_u8).prop_map(f64::from), 1e-9..1e3_f64].prop_map(Tree::Number),
        (0..NAMES.len()).prop_map(Tree::Name),
        Just(Tree::Variable),
    ];
    leaf.prop_recursive(6, 24, 2, move |inner| {
        let op = proptest::sample::select(ops.clone());
        prop_oneof![
            inner.clone().prop_map(|a| Tree::Negated(Box::new(a))),
            (op, inner.clone(), inner.clone()).prop_map(|(op, a, b)| Tree::Two(
                op,
                Box::new(a),
                Box::new(b)
            )),
            (inner, 0..4_u32).prop_map(|(a, n)| Tree::Power(Box::new(a), n)),
        ]
    })
}

proptest! {
    /// A printed tree is read as the same polynomial, however many parentheses it has.
    #[test]
    fn printed_trees_are_read_as_they_are(
        tree in tree().prop_filter("a small degree", |t| t.degree() <= MOST_DEGREE),
        values in proptest::array::uniform3(-3.0..3.0_f64),
        s in -1.5..1.5_f64,
    ) {
        let (exact, size) = tree.value(s, &values);
        for all in [false, true] {
            let text = tree.print(all);
            let tape = match polynomial(&text) {
                Ok(tape) => tape,
                // Powers within powers of numbers, and signs, can be more than there may be.
                Err(error) => panic!("{text}: {error:?}"),
            };
            prop_assert!(tape.degree() <= tree.degree());
            let Ok(found) = tape.at(&values, &mut Stacks::default()) else {
                continue;
            };
            let value = |of: &[f64]| of.iter().rev().fold(0.0, |sum, c| sum * s + c);
            let apart = (value(found.coefficients()) - exact).abs();
            prop_assert!(apart <= 1e-12 * size + 1e-300, "{text}: {apart:e} of {size:e}");
            // The bound is no smaller than the actual error, and not much larger.
            let bound: f64 = found.errors().iter().rev().fold(0.0, |sum, e| sum * s.abs() + e);
            prop_assert!(bound <= 1e-11 * size + 1e-290, "{text}: {bound:e} of {size:e}");
        }
    }

    /// A tree with divisions is one polynomial over others, of the same value.
    #[test]
    fn quotients_have_the_value_of_their_tree(
        tree in tree_with(vec!['+', '-', '*', '/', '/']),
        values in proptest::array::uniform3(-3.0..3.0_f64),
        s in -1.5..1.5_f64,
    ) {
        let (exact, size) = tree.value(s, &values);
        let text = tree.print(false);
        let read = match read(&text, &NAMES) {
            Ok(read) => read,
            Err(error) => {
                prop_assert!(error.message.contains("degree"), "{text}: {error:?}");
                return Ok(());
            }
        };
        let of = |polynomial: &Polynomial, s: f64| {
            polynomial.coefficients().iter().rev().fold(0.0, |sum, c| sum * s + c)
        };
        let sizes = |polynomial: &Polynomial| {
            polynomial.coefficients().iter().rev().fold(0.0, |sum, c| sum * s.abs() + c.abs())
        };
        let mut stacks = Stacks::default();
        let (mut under, mut size_under) = (1.0, 1.0);
        for factor in &read.under {
            let Ok(factor) = factor.tape().at(&values, &mut stacks) else { return Ok(()) };
            (under, size_under) = (under * of(&factor, s), size_under * sizes(&factor));
        }
        let Ok(over) = read.over.at(&values, &mut stacks) else { return Ok(()) };
        if size < 1e9 && size_under < 1e9 {
            let (apart, scale) = ((of(&over, s) - exact * under).abs(), sizes(&over));
            let allowed = scale + size * size_under;
            prop_assert!(apart <= 1e-9 * allowed, "{text}: {apart:e} of {allowed:e}");
        }
    }

    /// Nothing makes the reader panic.
    #[test]
    fn any_text_is_read_or_refused(text in "[-+*/^() .,0-9a-eswxτ_]{0,40}") {
        if let Err(error) = read(&text, &NAMES) {
            prop_assert!(text.get(error.place).is_some(), "{text}");
        }
    }
}
