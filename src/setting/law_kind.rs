//! The friction law of a sweep.

use super::catalogue::catalogue;
use super::parameter::{Group, Parameter};
use super::values::Setting;
use crate::model::{FrictionLaw, ModelError, RateAndState, Table};
use crate::text::SpecError;
use crate::text::nearest::did_you_mean;

/// The facts about a law that is described by parameters alone.
struct Row {
    /// The name in flags and sweep files.
    name: &'static str,
    /// Its formula, for the help.
    formula: &'static str,
    /// The parameters that describe it, besides μ_S.
    parameters: &'static [Parameter],
    /// How many of them must be given. If not all, the missing one follows from the others.
    needed: usize,
    /// The law of a setting.
    law: fn(&Setting) -> Result<FrictionLaw, ModelError>,
}

catalogue! {
    /// A friction law that is described by parameters alone.
    pub enum Formula: Row {
        /// [`FrictionLaw::coulomb`].
        Coulomb = Row {
            name: "coulomb",
            formula: "μ_K = μ0",
            parameters: &[Parameter::Mu0],
            needed: 1,
            law: |at| FrictionLaw::coulomb(mu0_and_v_s(at).0, at.get(Parameter::MuS)),
        };
        /// [`FrictionLaw::weakening`].
        Weakening = Row {
            name: "weakening",
            formula: "μ_K = μ0/(1 + v/v_s)",
            parameters: &[Parameter::Mu0, Parameter::VS, Parameter::MuPrimeRest],
            needed: 2,
            law: |at| {
                let (mu0, v_s) = mu0_and_v_s(at);
                FrictionLaw::weakening(mu0, v_s, at.get(Parameter::MuS))
            },
        };
        /// [`FrictionLaw::stribeck`].
        Stribeck = Row {
            name: "stribeck",
            formula: "μ_K = μ0 + (μ_S − μ0) exp(−(v/v_s)²)",
            parameters: &[Parameter::Mu0, Parameter::VS],
            needed: 2,
            law: |at| {
                let (mu0, v_s) = mu0_and_v_s(at);
                FrictionLaw::stribeck(mu0, v_s, at.get(Parameter::MuS))
            },
        };
        /// [`RateAndState`], which is not a function of the velocity alone.
        RateAndState = Row {
            name: "rate-and-state",
            formula: "μ = μ0 + A_f ln(v/v*) + B_f ln(v* θ/D_c)",
            parameters: &[
                Parameter::Mu0,
                Parameter::VStar,
                Parameter::DirectEffect,
                Parameter::EvolutionEffect,
                Parameter::SlipDistance,
            ],
            needed: 5,
            law: |_| Err(ModelError::of_law(OF_VELOCITY)),
        };
    }
}

impl Formula {
    /// The name in flags and sweep files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.row().name
    }

    /// Its formula, for the help.
    #[must_use]
    pub const fn formula(self) -> &'static str {
        self.row().formula
    }

    /// The law of that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|law| law.name() == name)
    }

    /// The law of that name.
    ///
    /// # Errors
    /// Suggests a law for an unknown name.
    pub fn named(name: &str) -> Result<Self, SpecError> {
        Self::from_name(name).ok_or_else(|| {
            let formulas = Self::ALL.into_iter().map(Self::name);
            let meant = did_you_mean(name, formulas.chain([LawKind::TABLE]));
            SpecError::whole(format!("unknown friction law \"{name}\""))
                .help(format!("{meant}known: {}", LawKind::names()))
        })
    }
}

/// μ0 and v_s of velocity weakening: each as given, or from the other and the slope at rest.
fn mu0_and_v_s(at: &Setting) -> (f64, f64) {
    let (mu0, v_s) = (at.get(Parameter::Mu0), at.get(Parameter::VS));
    let slope = at.get(Parameter::MuPrimeRest);
    match (mu0.is_nan(), v_s.is_nan()) {
        (true, false) => (-slope * v_s, v_s),
        (false, true) => (mu0, -mu0 / slope),
        _ => (mu0, v_s),
    }
}

/// A friction law, with its data besides parameters.
#[derive(Debug, Clone, PartialEq)]
pub enum LawKind {
    /// A formula.
    Formula(Formula),
    /// [`FrictionLaw::table`].
    Table(Table),
}

/// The name of what a law with a state is not, for messages.
pub(super) const OF_VELOCITY: &str = "a law of the velocity alone";
/// Why motions under a law with a state are not followed.
pub const NO_MOTIONS: &str = "its coefficient has no value at rest, so that sticks are slow slips: \
    motions under it are not followed";

impl LawKind {
    /// The name of [`LawKind::Table`].
    pub const TABLE: &str = "table";

    /// The name in flags and sweep files.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Formula(law) => law.name(),
            Self::Table(_) => Self::TABLE,
        }
    }

    /// The names of all laws.
    #[must_use]
    pub fn names() -> String {
        let formulas = Formula::ALL.into_iter().map(Formula::name);
        formulas.chain([Self::TABLE]).collect::<Vec<_>>().join(", ")
    }

    /// The names of the laws with this parameter.
    #[must_use]
    pub fn with(parameter: Parameter) -> String {
        let described = |law: &Formula| {
            let law = Self::Formula(*law);
            law.parameters().contains(&parameter) || law.optional() == parameter
        };
        let laws = Formula::ALL
            .into_iter()
            .filter(described)
            .map(Formula::name);
        let table = (parameter == Parameter::MuS).then_some(Self::TABLE);
        laws.chain(table).collect::<Vec<_>>().join(", ")
    }

    /// The one parameter of the law that need not be given.
    #[must_use]
    pub const fn optional(&self) -> Parameter {
        match self.has_state() {
            true => Parameter::LoadMemory,
            false => Parameter::MuS,
        }
    }

    /// Whether the coefficient depends on a state besides the velocity. There is then no
    /// [`FrictionLaw`], and motions are not followed.
    #[must_use]
    pub const fn has_state(&self) -> bool {
        matches!(self, Self::Formula(Formula::RateAndState))
    }

    /// Whether only laws with a state have this parameter.
    #[must_use]
    pub fn only_with_state(parameter: Parameter) -> bool {
        let laws = Formula::ALL.map(Self::Formula).into_iter();
        let mut with =
            laws.filter(|law| law.parameters().contains(&parameter) || law.optional() == parameter);
        parameter.group() == Group::Law && with.all(|law| law.has_state())
    }

    /// The law of a setting, with its state; none for a law without a state.
    pub(super) fn with_state(&self, setting: &Setting) -> Option<RateAndState> {
        self.has_state().then(|| RateAndState {
            mu0: setting.get(Parameter::Mu0),
            v_star: setting.get(Parameter::VStar),
            direct_effect: setting.get(Parameter::DirectEffect),
            evolution_effect: setting.get(Parameter::EvolutionEffect),
            slip_distance: setting.get(Parameter::SlipDistance),
            load_memory: setting.get(Parameter::LoadMemory),
        })
    }

    /// The parameters that describe the law; see [`LawKind::needed`] for how many must be given.
    #[must_use]
    pub const fn parameters(&self) -> &'static [Parameter] {
        match self {
            Self::Formula(law) => law.row().parameters,
            Self::Table(_) => &[],
        }
    }

    /// How many of [`LawKind::parameters`] must be given. If not all, the missing one follows from
    /// the others.
    #[must_use]
    pub const fn needed(&self) -> usize {
        match self {
            Self::Formula(law) => law.row().needed,
            Self::Table(_) => 0,
        }
    }

    /// The law with the parameters of a setting.
    pub(super) fn at(&self, setting: &Setting) -> Result<FrictionLaw, ModelError> {
        match self {
            Self::Formula(law) => (law.row().law)(setting),
            Self::Table(table) => FrictionLaw::table(table.clone(), setting.get(Parameter::MuS)),
        }
    }
}
