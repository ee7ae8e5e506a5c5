//! The friction law of a sweep.

use std::sync::LazyLock;

use super::formula::GivenFormula;
use super::parameter::{Group, Parameter};
use super::values::Setting;
use crate::model::law::{Form, Made};
use crate::model::{FrictionLaw, ModelError, RateAndState, Table};
use crate::text::SpecError;
use crate::text::nearest::did_you_mean;

/// The most parameters of a law, besides the optional one.
const MOST: usize = 8;

/// A law that parameters alone describe.
#[derive(Debug, PartialEq)]
pub struct NamedLaw {
    form: &'static Form,
    parameters: Vec<Parameter>,
    optional: Vec<Parameter>,
}

static NAMED: LazyLock<Vec<NamedLaw>> = LazyLock::new(|| Form::all().map(NamedLaw::of).collect());

impl NamedLaw {
    fn of(form: &'static Form) -> Self {
        assert!(
            form.parameters.len() + form.optional.len() <= MOST,
            "{} has too many parameters",
            form.name
        );
        let written = |name: &str| Parameter::from_name(name).expect("a law names parameters");
        let all = |names: &[&str]| names.iter().map(|name| written(name)).collect();
        Self {
            form,
            parameters: all(form.parameters),
            optional: all(form.optional),
        }
    }

    /// All named laws, in the order of lists.
    #[must_use]
    pub fn all() -> &'static [Self] {
        &NAMED
    }

    /// The name in flags and sweep files.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        self.form.name
    }

    /// Its formula, for the help.
    #[must_use]
    pub const fn formula(&self) -> &'static str {
        self.form.formula
    }

    /// The law of that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<&'static Self> {
        Self::all().iter().find(|law| law.name() == name)
    }

    /// What `of` makes of the numbers of [`Form::parameters`] and [`Form::optional`] in a setting.
    fn made<T>(&self, of: fn(&[f64]) -> T, setting: &Setting) -> T {
        let mut numbers = [f64::NAN; MOST];
        let parameters = || self.parameters.iter().chain(&self.optional);
        for (number, parameter) in numbers.iter_mut().zip(parameters()) {
            *number = setting.get(*parameter);
        }
        of(&numbers[..parameters().count()])
    }
}

/// A friction law, with its data besides parameters.
#[derive(Debug, Clone, PartialEq)]
pub enum LawKind {
    /// A law that parameters alone describe.
    Named(&'static NamedLaw),
    /// [`FrictionLaw::table`].
    Table(Table),
    /// [`FrictionLaw::formula`].
    Formula(GivenFormula),
}

/// The name of what a law with a state is not, for messages.
pub(super) const OF_VELOCITY: &str = "a law of the velocity alone";
/// Why motions under a law with a state are not followed.
pub const NO_MOTIONS: &str = "its coefficient has no value at rest, so that sticks are slow slips: \
    motions under it are not followed";

impl LawKind {
    /// The name of [`LawKind::Table`].
    pub const TABLE: &str = "table";
    /// The name of [`LawKind::Formula`].
    pub const FORMULA: &str = "formula";
    /// The names of the laws that more than parameters describe.
    const MORE: [&str; 2] = [Self::TABLE, Self::FORMULA];

    /// The law of this name that parameters alone describe.
    ///
    /// # Errors
    /// Suggests a law for an unknown name.
    pub fn named(name: &str) -> Result<Self, SpecError> {
        NamedLaw::from_name(name).map(Self::Named).ok_or_else(|| {
            let laws = NamedLaw::all().iter().map(NamedLaw::name);
            let meant = did_you_mean(name, laws.chain(Self::MORE));
            SpecError::whole(format!("unknown friction law \"{name}\""))
                .help(format!("{meant}known: {}", Self::names()))
        })
    }

    /// The name in flags and sweep files.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Named(law) => law.name(),
            Self::Table(_) => Self::TABLE,
            Self::Formula(_) => Self::FORMULA,
        }
    }

    /// The names of all laws.
    #[must_use]
    pub fn names() -> String {
        let laws = NamedLaw::all().iter().map(NamedLaw::name);
        laws.chain(Self::MORE).collect::<Vec<_>>().join(", ")
    }

    /// The laws that parameters alone describe, of those with this parameter.
    fn named_with(parameter: Parameter) -> impl Iterator<Item = Self> {
        let laws = NamedLaw::all().iter().map(Self::Named);
        laws.filter(move |law| law.has(parameter))
    }

    /// The names of the laws with this parameter.
    #[must_use]
    pub fn with(parameter: Parameter) -> String {
        let table = (parameter == Parameter::MuS).then_some(Self::TABLE);
        let laws = Self::named_with(parameter).map(|law| law.name());
        let more = table.into_iter().chain([Self::FORMULA]);
        laws.chain(more).collect::<Vec<_>>().join(", ")
    }

    /// Whether the law has this parameter, given or by default.
    #[must_use]
    pub fn has(&self, parameter: Parameter) -> bool {
        self.optional().contains(&parameter) || self.parameters().contains(&parameter)
    }

    /// The parameters of the law that need not be given.
    #[must_use]
    pub fn optional(&self) -> &[Parameter] {
        match self {
            Self::Named(law) => &law.optional,
            Self::Table(_) | Self::Formula(_) => &[Parameter::MuS],
        }
    }

    /// Whether the coefficient depends on a state besides the velocity. There is then no
    /// [`FrictionLaw`], and motions are not followed.
    #[must_use]
    pub const fn has_state(&self) -> bool {
        matches!(self, Self::Named(law) if law.form.has_state())
    }

    /// Whether only laws with a state have this parameter.
    #[must_use]
    pub fn only_with_state(parameter: Parameter) -> bool {
        let mut with = Self::named_with(parameter);
        parameter.group() == Group::Law && with.all(|law| law.has_state())
    }

    /// The law of a setting, with its state; none for a law without a state.
    pub(super) fn with_state(&self, setting: &Setting) -> Option<RateAndState> {
        match self {
            Self::Named(law) => match law.form.law {
                Made::WithState(made) => Some(law.made(made, setting)),
                Made::OfVelocity(_) => None,
            },
            Self::Table(_) | Self::Formula(_) => None,
        }
    }

    /// The parameters that describe the law; see [`LawKind::needed`] for how many must be given.
    #[must_use]
    pub fn parameters(&self) -> &[Parameter] {
        match self {
            Self::Named(law) => &law.parameters,
            Self::Table(_) => &[],
            Self::Formula(formula) => formula.known(),
        }
    }

    /// How many of [`LawKind::parameters`] must be given. If not all, the missing one follows from
    /// the others.
    #[must_use]
    pub fn needed(&self) -> usize {
        match self {
            Self::Named(law) => law.form.needed,
            Self::Table(_) => 0,
            Self::Formula(formula) => formula.known().len(),
        }
    }

    /// The law with the parameters of a setting.
    pub(super) fn at(&self, setting: &Setting) -> Result<FrictionLaw, ModelError> {
        match self {
            Self::Named(law) => match law.form.law {
                Made::OfVelocity(made) => law.made(made, setting),
                Made::WithState(_) => Err(ModelError::of_law(OF_VELOCITY)),
            },
            Self::Table(table) => FrictionLaw::table(table.clone(), setting.get(Parameter::MuS)),
            Self::Formula(formula) => formula.at(|parameter| setting.get(parameter)),
        }
    }
}
