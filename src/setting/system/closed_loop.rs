//! A loop of a plant and its controller, as transfer functions: D = d_c d_p + n_c n_p e^(−sτ).

use std::borrow::Cow;
use std::ops::Range;

use super::expressed::{Expression, times};
use crate::linear::general::{MOST_DEGREE, Polynomial, System};
use crate::setting::expression::{Stacks, Tape, Written};
use crate::setting::no_answer::NoAnswer;
use crate::setting::parameter::Parameter;
use crate::text::document::Document;
use crate::text::toml_reader::{Entry, SpecError, quoted};

pub(super) const PLANT: &str = "plant";
pub(super) const CONTROLLER: &str = "controller";
pub(super) const PID: &str = "pid";
pub(super) const DELAY: &str = "delay";
/// The gains of a PID controller, and the time of the filter of its derivative.
const GAINS: [&str; 4] = ["k_p", "k_i", "k_d", "t_f"];
/// What the setting is told where plant and controller together are at fault.
const LOOP: &str = "plant and controller";

const FORMS: &str = "an expression in s, { num, den }, or an array of these, their product";
/// What a gain with s in it is told.
const WITH_VARIABLE: [&str; 2] = [
    "a gain with s in it",
    "gains are numbers or expressions of the parameters; other controllers: controller = \"...\"",
];

/// The keys of a loop as written in a text.
pub(super) struct WrittenLoop {
    plant: Option<Written>,
    controller: Option<Written>,
    pid: Option<WrittenPid>,
    /// Where the delay is named.
    delays: Vec<Range<usize>>,
}

struct WrittenPid {
    gains: [Option<Written>; 4],
    span: Range<usize>,
}

/// A plant and what controls it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ClosedLoop {
    plant: Expression,
    controller: Controller,
}

#[derive(Debug, Clone, PartialEq)]
enum Controller {
    /// C = 1.
    None,
    Of(Expression),
    /// C = k_p + k_i/s + k_d s/(t_f s + 1), each none where it is not given.
    Pid(Box<[Option<Expression>; 4]>),
}

impl WrittenLoop {
    /// Takes the keys of a loop from the document of the text `whole`.
    pub(super) fn take(document: &mut Document, whole: &str) -> Self {
        let mut delays = Vec::new();
        let mut transfer = |name: &'static str| {
            document.take(name, |entry| read_transfer(entry, whole, &mut delays))
        };
        let [plant, controller] = [PLANT, CONTROLLER].map(&mut transfer);
        document.take(DELAY, |entry| read_delay(entry, &mut delays));
        delays.sort_by_key(|place| place.start);
        Self {
            plant,
            controller,
            pid: document.take(PID, |entry| WrittenPid::of(entry, whole)),
            delays,
        }
    }

    /// The loop with parameters of these `names`; none where no key of it is given.
    pub(super) fn read(
        &self,
        names: &[&str],
        document: &Document,
    ) -> Result<Option<ClosedLoop>, SpecError> {
        let given = [CONTROLLER, PID, DELAY].map(|key| document.key(key).cloned());
        let Some(plant) = &self.plant else {
            let [controller, pid, delay] = given;
            let alone = controller.map(|place| (CONTROLLER, place));
            let alone = alone.or(pid.map(|place| (PID, place)));
            return match alone.or(delay.map(|place| (DELAY, place))) {
                Some((key, place)) => Err(SpecError::at(place, format!("{key} without a plant"))
                    .help("add the plant, such as plant = { num = [1], den = [1, 0.5, 0] }")),
                None => Ok(None),
            };
        };
        if let [Some(controller), Some(pid), _] = given {
            let second = if controller.start < pid.start {
                pid
            } else {
                controller
            };
            let error = SpecError::at(second, "controller and pid: not both");
            return Err(
                error.help("give one; blocks in a product: controller = [\"...\", \"...\"]")
            );
        }
        if let [_, second, ..] = &self.delays[..] {
            let error = SpecError::at(second.clone(), "the delay is named twice");
            return Err(error.help("a loop has one delay: leave one of them out"));
        }
        let read = ClosedLoop {
            plant: Expression::of(plant, names)?,
            controller: match (&self.controller, &self.pid) {
                (Some(controller), _) => Controller::Of(Expression::of(controller, names)?),
                (None, Some(pid)) => Controller::Pid(Box::new(pid.read(names)?)),
                (None, None) => Controller::None,
            },
        };
        let of_controller = self.controller.as_ref().map(|of| &of.span);
        let of_controller = of_controller.or(self.pid.as_ref().map(|of| &of.span));
        read.check_degrees(&plant.span, of_controller)?;
        Ok(Some(read))
    }
}

/// A transfer function as written in a text; places of the delay in it are added to `delays`.
fn read_transfer(
    entry: &Entry,
    whole: &str,
    delays: &mut Vec<Range<usize>>,
) -> Result<Written, SpecError> {
    if !entry.is_array() {
        return block(entry, whole, delays);
    }
    let each = entry.array()?;
    if each.is_empty() {
        return Err(entry.error("an empty list is no product").help(FORMS));
    }
    let mut blocks = Vec::with_capacity(each.len());
    for of in &each {
        if of.is_number() {
            let error = of.error("a number in a list of blocks");
            return Err(
                error.help("coefficients belong in num and den: { num = [1], den = [1, 2] }")
            );
        }
        blocks.push((block(of, whole, delays)?, None));
    }
    Ok(Written::product(&entry.path, blocks, &entry.span))
}

/// One block: a number, an expression, or num and den.
fn block(entry: &Entry, whole: &str, delays: &mut Vec<Range<usize>>) -> Result<Written, SpecError> {
    if entry.is_string() || entry.is_number() {
        return Written::number(&entry.path, entry, whole);
    }
    if !entry.is_table() {
        return Err(entry.expected(FORMS));
    }
    let mut table = entry.document(["num", "den", DELAY])?;
    let mut part = |name| table.take(name, |of| Written::term(&of.path, of, whole));
    let [num, den] = ["num", "den"].map(&mut part);
    table.take(DELAY, |of| read_delay(of, delays));
    table.finish()?;
    let missing = |name: &str| {
        let error = entry.error(format!("{name} is missing"));
        error.help("a transfer function is { num = ..., den = ... }, numerator over denominator")
    };
    let (num, den) = (
        num.ok_or_else(|| missing("num"))?,
        den.ok_or_else(|| missing("den"))?,
    );
    if den.text == "0" {
        let error = SpecError::at(
            den.span.clone(),
            format!("{}: a denominator of 0", den.name),
        );
        return Err(error.help("den is the polynomial below num, such as [1, 0.5, 0]"));
    }
    let span = entry.span.clone();
    Ok(Written::product(&entry.path, vec![(num, Some(den))], &span))
}

fn read_delay(entry: &Entry, delays: &mut Vec<Range<usize>>) -> Result<(), SpecError> {
    let tau = Parameter::Tau.name();
    if !entry.is_string() || entry.string()? != tau {
        let error = entry.error(format!(
            "expected \"{tau}\": the delay is a parameter of its own"
        ));
        return Err(error.help("its value is given by --tau, or in [fixed] and [axes]"));
    }
    delays.push(entry.span.clone());
    Ok(())
}

impl WrittenPid {
    fn of(entry: &Entry, whole: &str) -> Result<Self, SpecError> {
        let mut table = entry.document(GAINS)?;
        let mut gain = |name| table.take(name, |of| Written::number(&of.path, of, whole));
        let gains = GAINS.map(&mut gain);
        let filter = table.key("t_f").cloned();
        table.finish()?;
        let form = "pid = { k_p = 1, k_i = 0.5, k_d = 0.2, t_f = 0.01 }; what is left out is 0";
        match (&gains, filter) {
            ([None, None, None, _], _) => {
                Err(entry.error("a controller without a gain").help(form))
            }
            ([_, _, None, Some(_)], Some(place)) => {
                let message = format!("{}.t_f has no effect: it filters k_d", entry.path);
                Err(SpecError::at(place, message).help("give k_d, or leave it out"))
            }
            _ => Ok(Self {
                gains,
                span: entry.span.clone(),
            }),
        }
    }

    fn read(&self, names: &[&str]) -> Result<[Option<Expression>; 4], SpecError> {
        let mut read = [const { None }; 4];
        for (read, written) in read.iter_mut().zip(&self.gains) {
            let number = |of: &Written| Expression::number(of, names, WITH_VARIABLE);
            *read = written.as_ref().map(number).transpose()?;
        }
        Ok(read)
    }
}

impl Controller {
    /// Upper bounds on the degrees of numerator and denominator.
    fn degrees(&self) -> [usize; 2] {
        match self {
            Self::None => [0, 0],
            Self::Of(of) => of.degrees(),
            Self::Pid(of) => {
                let [_, k_i, k_d, t_f] = of.each_ref().map(|of| usize::from(of.is_some()));
                [k_i + k_d, k_i + t_f]
            }
        }
    }

    /// Numerator and denominator at these values.
    fn at(&self, values: &[f64], stacks: &mut Stacks) -> Result<[Polynomial; 2], NoAnswer> {
        let one = Polynomial::constant(1.0, 0.0);
        let gains = match self {
            Self::None => return Ok([one, one]),
            Self::Of(of) => return of.quotient_at(CONTROLLER, values, stacks),
            Self::Pid(gains) => gains,
        };
        let mut numbers = [Polynomial::ZERO; 4];
        for (number, gain) in numbers.iter_mut().zip(&**gains) {
            if let Some(gain) = gain {
                *number = gain.at(PID, values, stacks)?;
            }
        }
        let [k_p, k_i, k_d, t_f] = numbers;
        let variable = Polynomial::variable();
        let times = |first: &Polynomial, second: &Polynomial| times(first, second, PID);
        // A part whose gain is 0 brings no factor: it would be a root that no part has.
        let filter = match k_d.is_zero() {
            true => one,
            false => times(&t_f, &variable)?.plus(&one, 1.0),
        };
        let (integrator, by) = match k_i.is_zero() {
            true => (one, Polynomial::ZERO),
            false => (variable, times(&k_i, &filter)?),
        };
        let direct = times(&k_p, &filter)?.plus(&times(&k_d, &variable)?, 1.0);
        let num = times(&direct, &integrator)?.plus(&by, 1.0);
        Ok([num, times(&filter, &integrator)?])
    }
}

impl ClosedLoop {
    /// Checks the degree of D, and that the whole loop is proper.
    fn check_degrees(
        &self,
        plant: &Range<usize>,
        controller: Option<&Range<usize>>,
    ) -> Result<(), SpecError> {
        let ([m, n], [above, below]) = (self.plant.degrees(), self.controller.degrees());
        let place = if above > below {
            controller.unwrap_or(plant)
        } else {
            plant
        };
        let (num, den) = (m + above, n + below);
        let refuse = |message: String| Err(SpecError::at(place.clone(), message));
        if num > den {
            let message = format!(
                "the loop is improper: its numerator has degree {num}, its denominator {den}"
            );
            let help = match self.controller {
                Controller::Pid(_) if above > below => {
                    "give t_f, the filter time of the derivative, or a plant of higher degree"
                }
                _ => "the denominators of plant and controller together have the higher degree",
            };
            return refuse(message).map_err(|error| error.help(help));
        }
        if den > MOST_DEGREE {
            return refuse(format!(
                "a loop of degree {den}: at most {MOST_DEGREE} is allowed"
            ));
        }
        Ok(())
    }

    /// Whether the controller is a PID one, whose parts have no poles where their gains are 0.
    pub(super) fn has_pid(&self) -> bool {
        matches!(self.controller, Controller::Pid(_))
    }

    /// Everything in it that is evaluated.
    pub(super) fn tapes(&self) -> impl Iterator<Item = &Tape> {
        let of_controller: Vec<&Expression> = match &self.controller {
            Controller::None => Vec::new(),
            Controller::Of(of) => vec![of],
            Controller::Pid(of) => of.iter().flatten().collect(),
        };
        let all = [&self.plant].into_iter().chain(of_controller);
        all.flat_map(Expression::tapes)
    }

    /// Its keys with what is written for them, each given gain as `written` says.
    fn each(&self, written: impl Fn(&str) -> String) -> Vec<(&'static str, String)> {
        let mut all = vec![(PLANT, written(&self.plant.text))];
        match &self.controller {
            Controller::None => {}
            Controller::Of(of) => all.push((CONTROLLER, written(&of.text))),
            Controller::Pid(of) => {
                let gains = GAINS.iter().zip(&**of);
                let gains = gains.filter_map(|(name, of)| of.as_ref().map(|of| (name, of)));
                let gains = gains.map(|(name, of)| format!("{name} = {}", written(&of.text)));
                let gains: Vec<String> = gains.collect();
                all.push((PID, format!("{{ {} }}", gains.join(", "))));
            }
        }
        all
    }

    /// Its parts as written, with their names.
    pub(super) fn texts(&self) -> Vec<(&'static str, Cow<'_, str>)> {
        let each = self.each(str::to_owned).into_iter();
        each.map(|(name, text)| (name, text.into())).collect()
    }

    /// Its keys with their values as TOML has them.
    pub(super) fn pairs(&self) -> Vec<(&'static str, String)> {
        self.each(quoted)
    }

    /// n_p d_c at these values: over D, what a disturbance at the input of the plant does to y.
    pub(super) fn disturbed_through(
        &self,
        values: &[f64],
        stacks: &mut Stacks,
    ) -> Result<Polynomial, NoAnswer> {
        let [num, _] = self.plant.quotient_at(PLANT, values, stacks)?;
        let [_, below] = self.controller.at(values, stacks)?;
        times(&num, &below, LOOP)
    }

    /// P, the denominators, and Q, the numerators, at these values.
    pub(super) fn at(&self, values: &[f64], stacks: &mut Stacks) -> Result<System, NoAnswer> {
        let [num, den] = self.plant.quotient_at(PLANT, values, stacks)?;
        let [above, below] = self.controller.at(values, stacks)?;
        let (p, q) = (times(&below, &den, LOOP)?, times(&above, &num, LOOP)?);
        let refuse = |what: String| NoAnswer::Undefined {
            polynomial: LOOP.into(),
            what,
        };
        let (m, n) = (q.degree(), p.degree());
        if m > n {
            let what = format!(
                "the loop is improper at this setting: its numerator has degree {m}, its \
                 denominator {n}"
            );
            return Err(refuse(what));
        }
        let sum = p.plus(&q, 1.0);
        let [last, error] = [sum.coefficients(), sum.errors()].map(|of| of.get(n).copied());
        if m == n && !q.is_zero() && last.unwrap_or(0.0).abs() <= error.unwrap_or(0.0) {
            let what = "an algebraic loop at this setting: 1 + C G = 0 for s to infinity, so that \
                        the loop has no solution; change a gain";
            return Err(refuse(what.to_owned()));
        }
        Ok(System::direct(p, q))
    }
}
