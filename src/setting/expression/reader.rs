//! Reads an expression of named numbers: a number, or a polynomial in s.
//!
//! ```text
//! sum     = product { ("+" | "-") product }
//! product = signed { ("*" | "/") signed }
//! signed  = ("+" | "-") signed | power
//! power   = operand [ "^" exponent ]
//! operand = number | name | "(" sum ")" | function "(" sum { "," sum } ")"
//! ```
//!
//! Exponents and arguments of functions do not contain s; what contains it has whole powers.
//! Operations are recorded in the order in which they are read, for a [`Tape`]; divisors with s in
//! them beside it, for a [`Quotient`].

use std::ops::Range;

use winnow::Parser;
use winnow::ascii::{digit1, multispace0};
use winnow::combinator::{Infix, Prefix, alt, expression, opt};
use winnow::error::ParserError;
use winnow::stream::{LocatingSlice, Location, Stateful, Stream};
use winnow::token::{any, take_while};

use super::fraction::Quotient;
use super::part::{Misread, Part, Read, negated, power, product, quotient, sum};
use super::tape::{Function, Op, Tape};
use crate::text::nearest::did_you_mean;
use crate::text::words;

/// The longest expression, in bytes.
pub(in crate::setting) const LONGEST: usize = 1 << 16;
/// The deepest nesting of parentheses, signs and exponents.
pub(in crate::setting) const DEEPEST: usize = 64;

/// The name of the variable of polynomials.
pub(in crate::setting) const VARIABLE: &str = "s";
/// The name of the number π.
pub(in crate::setting) const NUMBER_PI: &str = "pi";
/// The functions of several numbers.
const OF_SEVERAL: [(&str, Op); 2] = [("min", Op::Smaller), ("max", Op::Larger)];

/// The names of functions; those that have `kinks` only if asked for.
pub(in crate::setting) fn functions(kinks: bool) -> impl Iterator<Item = &'static str> {
    let of_several = OF_SEVERAL.iter().filter(move |_| kinks);
    let of_one = Function::NAMED.iter().map(|(name, _)| *name);
    of_one.chain(of_several.map(|(name, _)| *name))
}

/// The operation of a function, and whether it takes several numbers.
fn function_of(name: &str) -> Option<(Op, bool)> {
    let of_one = Function::NAMED.iter().find(|(known, _)| *known == name);
    let of_several = OF_SEVERAL.iter().find(|(known, _)| *known == name);
    let one = of_one.map(|(_, function)| (Op::Apply(*function), false));
    one.or(of_several.map(|(_, op)| (*op, true)))
}

/// The known names, and how deep the reader is in parentheses.
#[derive(Debug, Clone)]
struct State<'n> {
    names: &'n [&'n str],
    /// The name of the variable of polynomials; none where a number is read.
    variable: Option<&'static str>,
    /// Whether functions may have kinks.
    kinks: bool,
    depth: usize,
    /// Places of the signs whose operands are being read.
    signs: Vec<usize>,
}

type Input<'n> = Stateful<LocatingSlice<&'n str>, State<'n>>;

impl<'n> ParserError<Input<'n>> for Misread {
    type Inner = Self;

    fn from_input(input: &Input<'n>) -> Self {
        let at = input.current_token_start();
        Self {
            certain: false,
            ..Self::at(at..at, "not understood")
        }
    }

    fn is_backtrack(&self) -> bool {
        !self.certain
    }

    fn into_inner(self) -> Result<Self, Self> {
        Ok(self)
    }
}

/// Goes one level deeper, unless that is too deep.
fn descend(input: &mut Input) -> Read<()> {
    if input.state.depth == DEEPEST {
        let at = input.current_token_start();
        let message =
            format!("more than {DEEPEST} signs, exponents and parentheses within one another");
        return Err(Misread::at(at..at, message));
    }
    input.state.depth += 1;
    Ok(())
}

fn ascend(input: &mut Input, part: Part) -> Part {
    input.state.depth -= 1;
    part
}

/// The next character and its place, without consuming it.
fn ahead(input: &Input) -> (Option<char>, Range<usize>) {
    let next = input.peek_token();
    let at = input.current_token_start();
    (next, at..at + next.map_or(0, char::len_utf8))
}

/// What was found, for messages.
fn found(next: Option<char>) -> String {
    match next {
        None => "the end".into(),
        Some(c) => format!("`{c}`"),
    }
}

fn operand(input: &mut Input) -> Read<Part> {
    multispace0.parse_next(input)?;
    match ahead(input) {
        (Some('0'..='9' | '.'), _) => number(input),
        (Some(c), _) if words::begins(c) || c == '_' => named(input),
        (Some('('), place) => {
            any.parse_next(input)?;
            descend(input)?;
            let inside = whole(input)?;
            let mut part = ascend(input, inside);
            part.place = place.start..closed(input, &place)?;
            Ok(part)
        }
        // Another parser handles signs.
        (Some('+' | '-'), _) => Err(Misread::from_input(input)),
        (next, place) => {
            let expected = "expected a number, a name or `(`";
            let message = format!("{expected}, found {}", found(next));
            let misread = Misread::at(place, message);
            Err(match next.and_then(words::greek_advice) {
                Some(advice) => misread.help(advice),
                None => misread,
            })
        }
    }
}

/// Reads the `)` that closes the parenthesis at `opened`; returns where it ends.
fn closed(input: &mut Input, opened: &Range<usize>) -> Read<usize> {
    multispace0.parse_next(input)?;
    match ahead(input) {
        (Some(')'), place) => {
            any.parse_next(input)?;
            Ok(place.end)
        }
        (None, _) => Err(Misread::at(opened.clone(), "this `(` is not closed")),
        (next, place) => Err(Misread::at(
            place,
            format!("expected `)` or an operator, found {}", found(next)),
        )),
    }
}

fn number(input: &mut Input) -> Read<Part> {
    let start = input.current_token_start();
    let mantissa = alt((
        (digit1, opt(('.', opt(digit1)))).void(),
        ('.', digit1).void(),
    ));
    let exponent = opt((alt(('e', 'E')), opt(alt(('+', '-'))), digit1));
    let text: Read<&str> = (mantissa, exponent).take().parse_next(input);
    let place = start..input.current_token_start();
    let Some(value) = text.ok().and_then(|text| text.parse::<f64>().ok()) else {
        return Err(Misread::at(start..start + 1, "expected a number"));
    };
    if !value.is_finite() {
        return Err(Misread::at(place, "this number is too large"));
    }
    let part = Part::of(Op::Number(value), None, place);
    Ok(Part {
        number: Some(value),
        ..part
    })
}

fn named(input: &mut Input) -> Read<Part> {
    let start = input.current_token_start();
    let name: &str = take_while(1.., words::belongs).parse_next(input)?;
    let place = start..start + name.len();
    let before = input.checkpoint();
    multispace0.parse_next(input)?;
    let called = ahead(input).0 == Some('(');
    let (names, variable, kinks) = (input.state.names, input.state.variable, input.state.kinks);
    let functions: Vec<&str> = functions(kinks).collect();
    let known = format!("known: {}", functions.join(", "));
    match function_of(name) {
        Some((_, true)) if !kinks => {
            return Err(Misread::at(place, "min and max have kinks").help(known));
        }
        Some(of) => return function(input, name, of, called, place),
        None => input.reset(&before),
    }
    let is_variable = variable == Some(name);
    let is_pi = words::same(NUMBER_PI, name);
    match names.iter().position(|known| words::same(known, name)) {
        Some(_) if called => Err(times_is_written(place)),
        None if (is_variable || is_pi) && called => Err(times_is_written(place)),
        None if is_pi => Ok(Part::of(Op::Pi, None, place)),
        Some(index) => Ok(Part::of(Op::Value(index as u8), None, place)),
        None if is_variable => Ok(Part::of(Op::Variable, Some(1), place)),
        None if called => {
            let meant = did_you_mean(name, functions);
            Err(Misread::at(place, format!("unknown function `{name}`"))
                .help(format!("{meant}{known}")))
        }
        None => {
            let known = || variable.into_iter().chain(names.iter().copied());
            let meant = did_you_mean(name, known());
            let known = known().collect::<Vec<_>>().join(", ");
            Err(
                Misread::at(place, format!("unknown name `{name}`")).help(format!(
                    "{meant}known: {known}; others belong in [parameters]"
                )),
            )
        }
    }
}

fn times_is_written(place: Range<usize>) -> Misread {
    Misread::at(place, "a name, not a function").help("a product is written with `*`")
}

/// A function whose name was read, and its arguments.
fn function(
    input: &mut Input,
    name: &str,
    (op, several): (Op, bool),
    called: bool,
    place: Range<usize>,
) -> Read<Part> {
    if !called {
        let message = format!("{name} is a function: it needs an argument in parentheses");
        return Err(Misread::at(place, message));
    }
    let opened = ahead(input).1;
    any.parse_next(input)?;
    descend(input)?;
    let mut arguments = Vec::new();
    loop {
        let argument = whole(input)?;
        if argument.degree.is_some() {
            let message = format!("{name} of what has s in it");
            return Err(Misread::at(argument.place, message).help(
                "functions are of parameters alone; the delay acts by the form of a system",
            ));
        }
        arguments.push(argument);
        multispace0.parse_next(input)?;
        if ahead(input).0 != Some(',') {
            break;
        }
        any.parse_next(input)?;
    }
    let end = closed(input, &opened)?;
    input.state.depth -= 1;
    let place = place.start..end;
    let count = arguments.len();
    let mut arguments = arguments.into_iter();
    let first = arguments.next();
    let part = match (first, several, count) {
        (Some(first), true, 2..) => arguments.fold(first, |all, next| all.with(next, op, None)),
        (Some(first), false, 1) => first.then(op, None),
        _ => {
            let wanted = if several { "two or more" } else { "one" };
            let message = format!("{name} takes {wanted}, {count} given");
            return Err(Misread::at(place, message));
        }
    };
    let mut part = Part {
        place: place.clone(),
        number: None,
        ..part
    };
    if let Some((_, last)) = part.ops.last_mut() {
        *last = place;
    }
    Ok(part)
}

fn sign<'n>(input: &mut Input<'n>) -> Read<Prefix<Input<'n>, Part, Misread>> {
    multispace0.parse_next(input)?;
    let at = input.current_token_start();
    let sign = any.parse_next(input)?;
    descend(input)?;
    input.state.signs.push(at);
    match sign {
        '-' => Ok(Prefix(8, |input, part| Ok(signed(input, negated(part))))),
        '+' => Ok(Prefix(8, |input, part| Ok(signed(input, part)))),
        _ => Err(Misread::from_input(input)),
    }
}

/// Applies the sign before a part.
fn signed(input: &mut Input, part: Part) -> Part {
    let mut part = ascend(input, part);
    if let Some(at) = input.state.signs.pop() {
        part.place.start = at;
    }
    part
}

fn operator<'n>(input: &mut Input<'n>) -> Read<Infix<Input<'n>, Part, Misread>> {
    multispace0.parse_next(input)?;
    let (next, place) = ahead(input);
    if matches!(next, None | Some(')' | ',')) {
        return Err(Misread::from_input(input));
    }
    any.parse_next(input)?;
    match next {
        Some('+') => Ok(Infix::Left(5, |_, a, b| {
            sum(a, b, [Op::Add, Op::AddPolynomials])
        })),
        Some('-') => Ok(Infix::Left(5, |_, a, b| {
            sum(a, b, [Op::Subtract, Op::SubtractPolynomials])
        })),
        Some('*') if ahead(input).0 == Some('*') => {
            let place = place.start..place.end + 1;
            Err(
                Misread::at(place, "expected a number, a name or `(`, found `*`")
                    .help("a power is written with `^`"),
            )
        }
        Some('*') => Ok(Infix::Left(7, |_, a, b| product(a, b))),
        Some('/') => Ok(Infix::Left(7, |_, a, b| quotient(a, b))),
        Some('^') => {
            descend(input)?;
            Ok(Infix::Right(9, |input, base, exponent| {
                power(base, ascend(input, exponent))
            }))
        }
        _ => {
            let message = format!("expected an operator, + - * / or ^, found {}", found(next));
            Err(Misread::at(place, message).help("a product is written with `*`"))
        }
    }
}

/// Reads a sum, up to the first character that cannot belong to it.
fn whole(input: &mut Input) -> Read<Part> {
    expression(operand)
        .prefix(sign)
        .infix(operator)
        .parse_next(input)
}

/// Reads `text` as a quotient of polynomials in s. `names` stand for the values in their order.
pub(in crate::setting) fn read(text: &str, names: &[&str]) -> Read<Quotient> {
    let (part, degree) = read_whole(text, names, (Some(VARIABLE), true))?.lifted();
    Ok(Quotient {
        over: Tape::new(part.ops, degree),
        under: part.under,
    })
}

/// Reads `text` as a number that has no `kinks` unless they are allowed, with `names` as in `read`.
pub(in crate::setting) fn read_number(text: &str, names: &[&str], kinks: bool) -> Read<Tape> {
    let part = read_whole(text, names, (None, kinks))?;
    Ok(Tape::new(part.ops, 0))
}

fn read_whole(text: &str, names: &[&str], of: (Option<&'static str>, bool)) -> Read<Part> {
    let (variable, kinks) = of;
    if text.len() > LONGEST {
        let message = format!("an expression of {} bytes: at most {LONGEST}", text.len());
        return Err(Misread::at(0..text.len(), message));
    }
    let mut input = Stateful {
        input: LocatingSlice::new(text),
        state: State {
            names,
            variable,
            kinks,
            depth: 0,
            signs: Vec::new(),
        },
    };
    let part = whole(&mut input)?;
    multispace0.parse_next(&mut input)?;
    match ahead(&input) {
        (None, _) => Ok(part),
        (Some(')'), place) => Err(Misread::at(place, "this `)` closes nothing")),
        (next, place) => Err(Misread::at(
            place,
            format!("{} has no place here", found(next)),
        )),
    }
}
