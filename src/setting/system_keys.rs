//! The keys of files of systems, one row for each, and the limits of the expressions in them.

use super::expression::{DEEPEST, LARGEST_EXPONENT, LONGEST, NUMBER_PI, functions};
use super::keys::{Key, key, needed};
use super::parameter::LARGEST;
use crate::linear::general::MOST_DEGREE;

/// The most parameters of a system.
pub(crate) const MOST_PARAMETERS: usize = 64;
/// The longest name of a parameter, in characters.
pub(crate) const LONGEST_NAME: usize = 40;

const POLYNOMIAL: &str = "an expression in s, or a list of coefficients, the highest power first";

const MATRIX: &str =
    "an array of rows, each an array of numbers and expressions without s; at most 32 rows";

const TRANSFER: &str = "an expression in s, which may divide, { num, den } with each as P is, or \
    an array of these, which is their product";

/// The keys of a system.
pub(crate) const SYSTEM: [Key; 17] = [
    key(
        "title",
        "one line of at most 200 characters",
        "none",
        "stands above pictures and in answers",
    ),
    key(
        "P",
        POLYNOMIAL,
        "none, beside B and A",
        "what does not depend on the delay, in D = P + Q exp(-s tau)",
    ),
    key(
        "Q",
        POLYNOMIAL,
        "none, beside B and A",
        "what is delayed by tau",
    ),
    key(
        "B",
        POLYNOMIAL,
        "none, beside P and Q",
        "the open loop, in D = B (1 - memory exp(-s tau)) - A exp(-s latency) (1 - exp(-s tau))",
    ),
    key(
        "A",
        POLYNOMIAL,
        "none, beside P and Q",
        "the feedback of differences; its degree is below that of B",
    ),
    key(
        "A0",
        MATRIX,
        "none, beside other forms",
        "what acts at once in x'(t) - E1 x'(t - tau) = A0 x(t) + A1 x(t - tau)",
    ),
    key(
        "A1",
        MATRIX,
        "none, beside feedback",
        "what is delayed; a system has A1 or feedback",
    ),
    key(
        "E1",
        MATRIX,
        "0",
        "the delayed rates; its spectral radius is below 1 where finitely many roots are unstable",
    ),
    key(
        "feedback",
        "{ B, K, C }, each an array of rows as A0 is",
        "none, beside A1",
        "A1 = B K C; K may be left out and is 1 then",
    ),
    key(
        "D",
        "an array of 2 to 9 polynomials, each a number or as P is",
        "none, beside other forms",
        "powers of the delay, D = p0 + p1 exp(-s tau) + p2 exp(-2 s tau) + ...; none has a higher \
         degree than p0",
    ),
    key(
        "plant",
        TRANSFER,
        "none, beside other forms",
        "a plant with negative feedback by its controller, delayed by tau: D = den + num exp(-s \
         tau) of both; nothing is cancelled",
    ),
    key(
        "controller",
        TRANSFER,
        "1, beside pid",
        "what acts on the plant",
    ),
    key(
        "pid",
        "{ k_p, k_i, k_d, t_f }, each a number or an expression without s",
        "none, beside controller",
        "the controller k_p + k_i/s + k_d s/(t_f s + 1); what is left out is 0",
    ),
    key(
        "delay",
        "\"tau\"",
        "\"tau\"",
        "that the loop has the delay; it stands here or in one block",
    ),
    key(
        "ignore_roots_at_zero",
        "a whole number, at most 32",
        "0",
        "so many roots at 0, which D has at every delay, come from its form and do not count; D \
         times s for a distributed delay has one",
    ),
    key(
        "parameters",
        "a table, each key the name of a parameter: its default, or a table of the keys below",
        "none",
        "the system's own parameters",
    ),
    key(
        "speed_axis",
        "a table",
        "none",
        "tau is the period of a rotation, of this speed: pictures over tau have it as their axis; \
         tables, answers, `[axes]` and `[fixed]` too where numbers have a unit of time",
    ),
];

/// The keys of a parameter of its own.
pub(crate) const OWN_PARAMETER: [Key; 5] = [
    key(
        "long_name",
        "one line",
        "its name",
        "what stands at axes and in maps",
    ),
    key(
        "default",
        "a number from minimum to maximum",
        "0",
        "its value where none is given",
    ),
    key("minimum", "a number", "-1e12", "its smallest value"),
    key("maximum", "a number", "1e12", "its largest value"),
    key(
        "unit",
        "1 to 20 letters, digits, spaces and - ^ / . % °",
        "\"1\"",
        "the unit of its numbers, which stands at axes and in maps; nothing is computed with it",
    ),
];

/// The keys of the axis of a speed.
pub(crate) const SPEED_AXIS: [Key; 3] = [
    needed("name", "one line", "what stands at the axis and in answers"),
    key("period", "\"tau\"", "\"tau\"", "whose inverse it is"),
    key(
        "unit",
        "\"rpm\", \"Hz\" or \"rad/s\"",
        "\"rpm\"",
        "60/tau with tau in seconds, 1/tau or 2 pi/tau; without a unit of time pictures show 2 \
         pi/tau without a unit",
    ),
];

/// The limits of expressions and of systems, each with what it is about.
pub(crate) fn limits() -> [(&'static str, String); 9] {
    let functions: Vec<&str> = functions(true).collect();
    [
        ("functions of an expression", functions.join(", ")),
        ("numbers by name", format!("{NUMBER_PI} or π")),
        ("bytes of an expression", format!("{LONGEST} at most")),
        (
            "signs, exponents and parentheses within one another",
            format!("{DEEPEST} at most"),
        ),
        (
            "whole exponents that are written out",
            format!("from -{LARGEST_EXPONENT} to {LARGEST_EXPONENT}"),
        ),
        (
            "degree of a polynomial in s",
            format!("{MOST_DEGREE} at most; that of A below that of B"),
        ),
        (
            "values of parameters",
            format!("from -{LARGEST:e} to {LARGEST:e}"),
        ),
        ("parameters", format!("{MOST_PARAMETERS} at most")),
        (
            "names of parameters",
            format!(
                "a letter, then letters, digits and _, {LONGEST_NAME} characters at most; letters \
                 are ASCII or Greek, and Greek ones stand in quotes as keys: \"ω\" = 2"
            ),
        ),
    ]
}
