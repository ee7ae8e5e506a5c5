//! A friction law as a formula: an expression in the speed `v`, with named parameters.

use std::ops::Range;
use std::sync::Arc;

use super::expression::{Function, Misread, Op, Read, Tape, Written, names_in, read_number};
use super::keys::FRICTION_TABLE;
use super::map_names;
use super::parameter::{Group, LARGEST, Parameter};
use super::system::parameter::OwnParameter;
use super::units::Units;
use crate::model::elementary::{atan, cos, cosh, ln, sin, sinh, tanh};
use crate::model::law::formula::{Builder, Node, Operand};
use crate::model::{FrictionLaw, ModelError};
use crate::text::nearest::did_you_mean;
use crate::text::{SpecError, words};

/// The name of the speed.
const SPEED: &str = "v";
/// A formula as an example.
pub(crate) const EXAMPLE: &str = "mu0 + (mu_s - mu0)*exp(-v/v_s)";
/// The most parameters of a formula.
const MOST: usize = 32;

/// A formula whose parameters have no values yet.
#[derive(Debug, Clone, PartialEq)]
pub struct FormulaModel {
    /// The expression as it was written.
    text: String,
    tape: Tape,
    /// What its names stand for, in the order of the tape's values after the speed.
    names: Vec<Name>,
    /// Its parameters that other laws have too.
    known: Vec<Parameter>,
    own: Vec<Arc<OwnParameter>>,
}

/// What a name in a formula stands for.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Name {
    Known(Parameter),
    /// An own parameter, by its number.
    Own(usize),
}

/// A formula with values of its own parameters; those that have none are NaN.
#[derive(Debug, Clone, PartialEq)]
pub struct GivenFormula {
    model: Arc<FormulaModel>,
    values: Vec<f64>,
}

/// The place of a name in an expression.
fn place_of(name: &str, text: &str) -> Range<usize> {
    let at = name.as_ptr() as usize - text.as_ptr() as usize;
    at..at + name.len()
}

/// What a name stands for; `own` are the names before it that only this formula has.
fn meaning(name: &str, own: &[&str]) -> Result<Name, &'static str> {
    if let Some(parameter) = Parameter::from_name(&words::spelled(name)) {
        return match parameter.group() {
            Group::Law if parameter != Parameter::MuPrimeRest => Ok(Name::Known(parameter)),
            _ => Err("it is another parameter of slipmap"),
        };
    }
    if FRICTION_TABLE.iter().any(|key| key.name == name) {
        return Err("[friction] has a key of that name");
    }
    if map_names::taken().any(|taken| taken == name) {
        return Err("maps have a variable of that name");
    }
    Ok(Name::Own(own.len()))
}

impl FormulaModel {
    /// Reads an expression.
    fn of_text(text: &str) -> Read<Self> {
        let mut own = Vec::new();
        let mut meanings = Vec::new();
        let words = names_in(text).into_iter().filter(|name| *name != SPEED);
        let words: Vec<&str> = words.collect();
        if let Some(name) = words.get(MOST) {
            let message = format!("more than {MOST} names");
            return Err(Misread::at(place_of(name, text), message));
        }
        for name in &words {
            let meaning = meaning(name, &own).map_err(|why| {
                Misread::at(place_of(name, text), format!("{name} is reserved: {why}"))
                    .help(format!("call it {name}_1, for example"))
            })?;
            if let Name::Own(_) = meaning {
                own.push(*name);
            }
            meanings.push(meaning);
        }
        let names: Vec<&str> = [SPEED].into_iter().chain(words).collect();
        let tape = read_number(text, &names, false)?;
        let known = meanings.iter().filter_map(|name| match name {
            Name::Known(parameter) => Some(*parameter),
            Name::Own(_) => None,
        });
        Ok(Self {
            text: text.to_owned(),
            tape,
            known: known.filter(|p| *p != Parameter::MuS).collect(),
            names: meanings,
            own: own.into_iter().enumerate().map(own_parameter).collect(),
        })
    }
}

fn own_parameter((index, name): (usize, &str)) -> Arc<OwnParameter> {
    Arc::new(OwnParameter {
        index,
        name: words::spelled(name).into_owned(),
        long_name: format!("{name} of the friction law"),
        default: 0.0,
        minimum: -LARGEST,
        maximum: LARGEST,
        unit: "1".to_owned(),
        dimension: [0; 3],
    })
}

impl GivenFormula {
    /// Reads the expression of a file.
    pub(super) fn written(written: &Written) -> Result<Self, SpecError> {
        Ok(Self::of(written.read(FormulaModel::of_text)?))
    }

    /// Reads an expression.
    ///
    /// # Errors
    /// With the place in the text.
    pub fn read(text: &str) -> Result<Self, SpecError> {
        let model = FormulaModel::of_text(text).map_err(|misread| SpecError {
            span: Some(misread.place),
            help: misread.help,
            ..SpecError::whole(misread.message)
        })?;
        Ok(Self::of(model))
    }

    fn of(model: FormulaModel) -> Self {
        Self {
            values: vec![f64::NAN; model.own.len()],
            model: Arc::new(model),
        }
    }

    /// The expression as it was written.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.model.text
    }

    /// Its parameters that other laws have too, besides μ_S.
    #[must_use]
    pub(crate) fn known(&self) -> &[Parameter] {
        &self.model.known
    }

    /// Its own parameters with their values.
    pub(crate) fn own(&self) -> impl Iterator<Item = (&Arc<OwnParameter>, f64)> {
        self.model.own.iter().zip(self.values.iter().copied())
    }

    /// Its own parameter of that name.
    #[must_use]
    pub fn own_named(&self, name: &str) -> Option<&Arc<OwnParameter>> {
        let mut own = self.model.own.iter();
        own.find(|own| words::same(&own.name, name))
    }

    /// The error of a name that is none of its parameters.
    #[must_use]
    pub fn unknown(&self, name: &str) -> SpecError {
        let other = Parameter::from_name(name).filter(|p| self.model.known.contains(p));
        if let Some(flag) = other.and_then(Parameter::long_flag) {
            return SpecError::whole(format!("{name} has a flag of its own"))
                .help(format!("--{flag} gives it"));
        }
        let own = self.model.own.iter().map(|own| &*own.name);
        let known = self.model.known.iter().map(|p| p.name());
        let names: Vec<&str> = known.chain([Parameter::MuS.name()]).chain(own).collect();
        let meant = did_you_mean(name, names.iter().copied());
        SpecError::whole(format!("mu_k has no `{name}` in it"))
            .help(format!("{meant}its parameters: {}", names.join(", ")))
    }

    /// Gives an own parameter a dimension in these units.
    pub(crate) fn measure(&mut self, own: &OwnParameter, dimension: [i32; 3], units: &Units) {
        let model = Arc::make_mut(&mut self.model);
        model.own[own.index] = Arc::new(own.measured(units.of(dimension), dimension));
    }

    pub(super) fn get(&self, own: &OwnParameter) -> f64 {
        self.values[own.index]
    }

    #[inline]
    pub(super) fn set(&mut self, own: &OwnParameter, value: f64) {
        self.values[own.index] = value;
    }

    /// The first of its own parameters without a value that is not `varied`.
    pub(crate) fn missing(&self, varied: impl Fn(&OwnParameter) -> bool) -> Option<&OwnParameter> {
        let mut own = self.own();
        let (own, _) = own.find(|(own, value)| value.is_nan() && !varied(own))?;
        Some(own)
    }

    /// The error of an own parameter without a value.
    pub(crate) fn not_given(own: &OwnParameter, advice: String) -> SpecError {
        let message = format!("{} is not given: mu_k has it as a parameter", own.name);
        SpecError::whole(message).help(advice)
    }

    /// The law; `known` tells the parameters that other laws have too.
    pub(super) fn at(&self, known: impl Fn(Parameter) -> f64) -> Result<FrictionLaw, ModelError> {
        let mut make = Builder::default();
        let mut stack = Vec::new();
        for op in self.model.tape.ops() {
            let result = self.apply(*op, &mut make, &mut stack, &known);
            stack.push(result);
        }
        let last = stack.pop().unwrap_or(Operand::Number(f64::NAN));
        let formula = make.finish(last);
        let formula = formula.ok_or(ModelError::of_law("a formula of at most 64 operations"))?;
        FrictionLaw::formula(formula, known(Parameter::MuS))
    }

    /// The result of one operation on the top of the stack.
    fn apply(
        &self,
        op: Op,
        make: &mut Builder,
        stack: &mut Vec<Operand>,
        known: impl Fn(Parameter) -> f64,
    ) -> Operand {
        let mut next = || stack.pop().unwrap_or(Operand::Number(f64::NAN));
        match op {
            Op::Number(value) => Operand::Number(value),
            Op::Pi => Operand::Number(std::f64::consts::PI),
            Op::Value(0) => make.speed(),
            Op::Value(index) => Operand::Number(match self.model.names[usize::from(index) - 1] {
                Name::Known(parameter) => known(parameter),
                Name::Own(own) => self.values[own],
            }),
            Op::Negate => {
                let a = next();
                make.negative(a)
            }
            Op::Power(exponent) => {
                let a = next();
                make.power(a, Operand::Number(f64::from(exponent)))
            }
            Op::Apply(function) => {
                let a = next();
                applied(function, a, make)
            }
            _ => {
                let (b, a) = (next(), next());
                match op {
                    Op::Add => make.sum(a, b),
                    Op::Subtract => make.difference(a, b),
                    Op::Multiply => make.product(a, b),
                    Op::Divide => make.quotient(a, b),
                    Op::Raise => make.power(a, b),
                    // Not in the expression of a number, or refused by the reader.
                    _ => Operand::Number(f64::NAN),
                }
            }
        }
    }
}

fn applied(function: Function, a: Operand, make: &mut Builder) -> Operand {
    match function {
        Function::Sqrt => make.power(a, Operand::Number(0.5)),
        Function::Exp => make.exp(a),
        Function::Ln => make.function(a, ln, Node::Ln),
        Function::Sin => make.function(a, sin, Node::Sin),
        Function::Cos => make.function(a, cos, Node::Cos),
        Function::Sinh => make.function(a, sinh, Node::Sinh),
        Function::Cosh => make.function(a, cosh, Node::Cosh),
        Function::Tanh => make.function(a, tanh, Node::Tanh),
        Function::Atan => make.function(a, atan, Node::Atan),
    }
}
