//! Every parameter of a sweep: its one name in flags, sweep files and maps, its meaning, unit and
//! range.

use std::cmp::Ordering;

use crate::model::{Control, FrictionLaw, Groups, ModelError, Oscillator, SlidingPoint, Table};

/// The largest size of any parameter, and one over the smallest of those that must be positive: far
/// beyond any experiment, and small enough that no dimensionless group overflows.
pub(super) const LARGEST: f64 = 1e12;

/// A parameter of the model, of the friction law or of the control.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Parameter {
    /// μ_K′(v0), the slope of the friction law at the sliding velocity.
    MuPrime,
    /// α_v, the gain of velocity control.
    AlphaV,
    /// α_N, the gain of load control.
    AlphaN,
    /// τ, the delay.
    Tau,
    /// v0, the unperturbed pulling velocity.
    V0,
    /// μ_K(v0), the kinetic friction coefficient at the sliding velocity.
    MuK,
    /// M, the mass of the block.
    Mass,
    /// κ, the stiffness of the spring.
    Stiffness,
    /// N0, the unperturbed normal load.
    NormalLoad,
    /// μ0 of a friction law.
    Mu0,
    /// v_s of a friction law.
    VS,
    /// μ_K′(0⁺), the slope of the weakening law at rest: −μ0/v_s.
    MuPrimeRest,
    /// μ_S, the static friction coefficient.
    MuS,
    /// ẋ at t = 0.
    XDot0,
    /// Elongation at t = 0 and before.
    A0,
    /// Time from a release of uncontrolled stick-slip to switch-on.
    SwitchOnPhase,
    /// γ = −μ_K α_N τ/(2√(κM)) of [`Protocol::Limit`](super::protocol::Protocol::Limit).
    Gamma,
    /// μ_K/μ_S of the same.
    MuRatio,
}

/// Ranges that a parameter's values can be held to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Range {
    Any,
    NotNegative,
    Positive,
    Part,
    Negative,
}

impl Parameter {
    /// All parameters.
    pub const ALL: [Self; 18] = [
        Self::MuPrime,
        Self::AlphaV,
        Self::AlphaN,
        Self::Tau,
        Self::V0,
        Self::MuK,
        Self::Mass,
        Self::Stiffness,
        Self::NormalLoad,
        Self::Mu0,
        Self::VS,
        Self::MuPrimeRest,
        Self::MuS,
        Self::XDot0,
        Self::A0,
        Self::SwitchOnPhase,
        Self::Gamma,
        Self::MuRatio,
    ];

    /// The start of a motion: where none is given it slides at v0.
    pub const START: [Self; 3] = [Self::XDot0, Self::A0, Self::SwitchOnPhase];

    /// All parameters of the limit of a short delay.
    pub const LIMIT: [Self; 2] = [Self::Gamma, Self::MuRatio];

    /// The name as the key in a file.
    #[must_use]
    pub fn key(self) -> String {
        self.name().into()
    }

    /// The name, the same word everywhere (flags write `-` for `_`).
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::MuPrime => "mu_prime",
            Self::AlphaV => "alpha_v",
            Self::AlphaN => "alpha_n",
            Self::Tau => "tau",
            Self::V0 => "v0",
            Self::MuK => "mu_k",
            Self::Mass => "mass",
            Self::Stiffness => "stiffness",
            Self::NormalLoad => "normal_load",
            Self::Mu0 => "mu0",
            Self::VS => "v_s",
            Self::MuPrimeRest => "mu_prime_rest",
            Self::MuS => "mu_s",
            Self::XDot0 => "x_dot0",
            Self::A0 => "a0",
            Self::SwitchOnPhase => "switch_on_phase",
            Self::Gamma => "gamma",
            Self::MuRatio => "mu_ratio",
        }
    }

    /// The parameter of that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|p| p.name() == name)
    }

    /// What it is, for `long_name` in maps and labels in pictures.
    #[must_use]
    pub const fn long_name(self) -> &'static str {
        match self {
            Self::MuPrime => "slope of the kinetic friction coefficient at the sliding velocity",
            Self::AlphaV => "gain of velocity control",
            Self::AlphaN => "gain of load control",
            Self::Tau => "delay of the feedback",
            Self::V0 => "unperturbed pulling velocity",
            Self::MuK => "kinetic friction coefficient at the sliding velocity",
            Self::Mass => "mass of the block",
            Self::Stiffness => "stiffness of the spring",
            Self::NormalLoad => "unperturbed normal load",
            Self::Mu0 => "kinetic friction coefficient mu0 of the friction law",
            Self::VS => "velocity scale of the friction law",
            Self::MuPrimeRest => "slope of the kinetic friction coefficient at rest",
            Self::MuS => "static friction coefficient",
            Self::XDot0 => "velocity of the block at t = 0",
            Self::A0 => "elongation of the spring at t = 0 and before",
            Self::SwitchOnPhase => "time from release to switch-on",
            Self::Gamma => "strength of load control",
            Self::MuRatio => "kinetic over static friction coefficient",
        }
    }

    /// The symbol of the letter.
    #[must_use]
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::MuPrime => "μ′",
            Self::AlphaV => "α_v",
            Self::AlphaN => "α_N",
            Self::Tau => "τ",
            Self::V0 => "v0",
            Self::MuK => "μ_K",
            Self::Mass => "M",
            Self::Stiffness => "κ",
            Self::NormalLoad => "N0",
            Self::Mu0 => "μ0",
            Self::VS => "v_s",
            Self::MuPrimeRest => "μ′(0)",
            Self::MuS => "μ_S",
            Self::XDot0 => "ẋ0",
            Self::A0 => "a0",
            Self::SwitchOnPhase => "φ",
            Self::Gamma => "γ",
            Self::MuRatio => "μ_K/μ_S",
        }
    }

    /// Powers of force, length and time in its unit.
    pub(super) const fn dimension(self) -> [i32; 3] {
        match self {
            Self::MuPrime | Self::MuPrimeRest => [0, -1, 1],
            Self::AlphaV => [0, 0, -1],
            Self::AlphaN | Self::Stiffness => [1, -1, 0],
            Self::Tau | Self::SwitchOnPhase => [0, 0, 1],
            Self::A0 => [0, 1, 0],
            Self::V0 | Self::VS | Self::XDot0 => [0, 1, -1],
            Self::MuK | Self::Mu0 | Self::MuS | Self::Gamma | Self::MuRatio => [0, 0, 0],
            Self::Mass => [1, -1, 2],
            Self::NormalLoad => [1, 0, 0],
        }
    }

    /// The value where a sweep does not give one; none where it must, and for [`Parameter::START`].
    #[must_use]
    pub const fn default_value(self) -> Option<f64> {
        match self {
            Self::AlphaV | Self::AlphaN => Some(0.0),
            Self::MuK | Self::Mass | Self::Stiffness | Self::NormalLoad | Self::MuS => Some(1.0),
            Self::MuPrime | Self::Tau | Self::V0 => None,
            Self::Mu0 | Self::VS | Self::MuPrimeRest => None,
            Self::XDot0 | Self::A0 | Self::SwitchOnPhase => None,
            Self::Gamma | Self::MuRatio => None,
        }
    }

    /// True for the parameters that only a friction law has.
    #[must_use]
    pub const fn of_friction_law(self) -> bool {
        matches!(self, Self::Mu0 | Self::VS | Self::MuPrimeRest | Self::MuS)
    }

    /// True for [`Parameter::START`].
    #[must_use]
    pub const fn of_start(self) -> bool {
        matches!(self, Self::XDot0 | Self::A0 | Self::SwitchOnPhase)
    }

    /// True for [`Parameter::LIMIT`].
    #[must_use]
    pub const fn of_limit(self) -> bool {
        matches!(self, Self::Gamma | Self::MuRatio)
    }

    const fn range(self) -> Range {
        match self {
            Self::MuPrime | Self::AlphaV | Self::AlphaN | Self::XDot0 | Self::A0 => Range::Any,
            Self::Tau | Self::SwitchOnPhase => Range::NotNegative,
            Self::MuRatio => Range::Part,
            Self::MuPrimeRest => Range::Negative,
            _ => Range::Positive,
        }
    }

    /// The range allowed, in words.
    #[must_use]
    pub const fn allowed(self) -> &'static str {
        match self.range() {
            Range::Any => "a finite number of size at most 1e12",
            Range::NotNegative => "0 or more, at most 1e12",
            Range::Positive => "greater than 0, between 1e-12 and 1e12",
            Range::Part => "greater than 0, between 1e-12 and 1",
            Range::Negative => "less than 0, between -1e12 and -1e-12",
        }
    }

    /// `value` if it is in range.
    ///
    /// # Errors
    /// Names the parameter, the value and the range allowed.
    pub fn check(self, value: f64) -> Result<f64, ModelError> {
        let inside = value.abs() <= LARGEST
            && match self.range() {
                Range::Any => true,
                Range::NotNegative => value >= 0.0,
                Range::Positive => value >= 1.0 / LARGEST,
                Range::Part => (1.0 / LARGEST..=1.0).contains(&value),
                Range::Negative => value <= -1.0 / LARGEST,
            };
        if inside {
            Ok(value)
        } else {
            Err(ModelError {
                parameter: self.name(),
                value,
                allowed: self.allowed(),
            })
        }
    }
}

/// The units in which a sweep is written; none given means dimensionless.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Units {
    /// Names of the units of force, length and time, as UDUNITS writes them.
    pub force_length_time: Option<[String; 3]>,
}

impl Units {
    /// The unit of a quantity with these powers of force, length and time; "1" where it has none.
    #[must_use]
    pub fn of(&self, dimension: [i32; 3]) -> String {
        let Some(names) = &self.force_length_time else {
            return "1".into();
        };
        let factors: Vec<String> = names
            .iter()
            .zip(dimension)
            .filter(|&(_, power)| power != 0)
            .map(|(name, power)| match power {
                1 => name.clone(),
                _ => format!("{name}{power}"),
            })
            .collect();
        if factors.is_empty() {
            "1".into()
        } else {
            factors.join(" ")
        }
    }

    /// The unit of a parameter.
    #[must_use]
    pub fn of_parameter(&self, parameter: Parameter) -> String {
        self.of(parameter.dimension())
    }

    /// The unit of time.
    #[must_use]
    pub fn time(&self) -> String {
        self.of([0, 0, 1])
    }

    /// The unit of a rate of decay, one over time.
    #[must_use]
    pub fn rate(&self) -> String {
        self.of([0, 0, -1])
    }

    /// The unit of an angular frequency.
    #[must_use]
    pub fn angular_frequency(&self) -> String {
        match &self.force_length_time {
            Some([_, _, time]) => format!("rad {time}-1"),
            None => "1".into(),
        }
    }
}

/// Which friction law a sweep uses, with what it has besides parameters.
#[derive(Debug, Clone, PartialEq)]
pub enum LawKind {
    /// [`FrictionLaw::coulomb`].
    Coulomb,
    /// [`FrictionLaw::weakening`].
    Weakening,
    /// [`FrictionLaw::stribeck`].
    Stribeck,
    /// [`FrictionLaw::table`].
    Table(Table),
}

impl LawKind {
    /// The laws that parameters alone describe.
    pub const FORMULAS: [Self; 3] = [Self::Coulomb, Self::Weakening, Self::Stribeck];

    /// The name of [`LawKind::Table`].
    pub const TABLE: &str = "table";

    /// The name in flags and sweep files.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Coulomb => "coulomb",
            Self::Weakening => "weakening",
            Self::Stribeck => "stribeck",
            Self::Table(_) => Self::TABLE,
        }
    }

    /// The names of all laws.
    #[must_use]
    pub fn names() -> String {
        let formulas = Self::FORMULAS.iter().map(Self::name);
        formulas.chain([Self::TABLE]).collect::<Vec<_>>().join(", ")
    }

    /// The parameters that describe the law, besides μ_S.
    #[must_use]
    pub const fn parameters(&self) -> &'static [Parameter] {
        match self {
            Self::Coulomb => &[Parameter::Mu0],
            Self::Weakening => &[Parameter::Mu0, Parameter::VS, Parameter::MuPrimeRest],
            Self::Stribeck => &[Parameter::Mu0, Parameter::VS],
            Self::Table(_) => &[],
        }
    }

    /// How many of [`LawKind::parameters`] have to be given: what one of them is follows from the
    /// others, if it is not all.
    #[must_use]
    pub const fn needed(&self) -> usize {
        match self {
            Self::Weakening => 2,
            _ => self.parameters().len(),
        }
    }
}

/// Why a set of given parameters does not make a setting.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GivenError {
    /// This one is needed and not given.
    Missing(Parameter),
    /// This one is given and would have no effect.
    Unused(Parameter),
    /// This one is given and follows from others that are given too.
    Follows(Parameter),
}

impl GivenError {
    /// What is wrong, in words, for a setting with the friction law `law`; `name` is how parameters
    /// are called where they are given.
    #[must_use]
    pub fn message(self, law: Option<&LawKind>, name: fn(Parameter) -> String) -> String {
        match (self, law) {
            (Self::Follows(p), _) => {
                let [mu0, v_s] = [Parameter::Mu0, Parameter::VS].map(name);
                let p = name(p);
                format!("{p} is given as well as {mu0} and {v_s}: it is -mu0/v_s")
            }
            (Self::Missing(p), Some(law))
                if law.parameters().len() > law.needed() && p.of_friction_law() =>
            {
                let names: Vec<_> = law.parameters().iter().map(|p| name(*p)).collect();
                let (p, law) = (name(p), law.name());
                format!(
                    "{p} is not given: the {law} law needs two of {}",
                    names.join(", ")
                )
            }
            (Self::Missing(p), _) => format!("{} is not given", name(p)),
            (Self::Unused(p), _) if p.of_limit() => {
                format!("{} is a parameter of protocol = \"limit\"", name(p))
            }
            (Self::Unused(p), Some(law)) => {
                format!("{} has no meaning with the {} law", name(p), law.name())
            }
            (Self::Unused(p), None) => format!("{} needs a friction law", name(p)),
        }
    }

    /// What could be done about it; `name` as in [`GivenError::message`].
    #[must_use]
    pub fn help(self, name: fn(Parameter) -> String) -> String {
        use Parameter::{Mu0, MuK, MuPrime, MuPrimeRest, V0, VS};
        match self {
            Self::Missing(p) => format!("{}: {}, {}", name(p), p.long_name(), p.allowed()),
            Self::Unused(p) if p.of_limit() => {
                "protocol = \"limit\" in a sweep file asks for v_c as the delay vanishes; its \
                parameters are gamma and mu_ratio"
                    .into()
            }
            Self::Follows(_) => {
                format!(
                    "give two of {}",
                    [Mu0, VS, MuPrimeRest].map(name).join(", ")
                )
            }
            Self::Unused(MuPrimeRest) => {
                let slope = name(MuPrimeRest);
                format!("{slope} is the slope -mu0/v_s of the weakening law at rest")
            }
            Self::Unused(_) => {
                let [mu_prime, mu_k, v0] = [MuPrime, MuK, V0].map(name);
                format!(
                    "give either {mu_prime} (with {mu_k}) or a friction law with {v0}, not \
                    both"
                )
            }
        }
    }
}

/// One value for every parameter: a point of parameter space.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    values: [f64; Parameter::ALL.len()],
    law: Option<LawKind>,
}

impl Setting {
    /// The default values; those without a default are NaN until they are set. `law`: where μ_K and
    /// μ_K′ come from.
    #[must_use]
    pub fn new(law: Option<LawKind>) -> Self {
        let values = Parameter::ALL.map(|p| p.default_value().unwrap_or(f64::NAN));
        Self { values, law }
    }

    /// The value of a parameter.
    #[inline]
    #[must_use]
    pub fn get(&self, parameter: Parameter) -> f64 {
        self.values[parameter as usize]
    }

    /// Sets the value of a parameter.
    #[inline]
    pub fn set(&mut self, parameter: Parameter, value: f64) {
        self.values[parameter as usize] = value;
    }

    /// The friction law that the setting uses, if any.
    #[must_use]
    pub fn law(&self) -> Option<&LawKind> {
        self.law.as_ref()
    }

    /// True for the parameters on which a cell of this setting depends: those that it takes and has
    /// a value of. Not asked of the limit of a short delay, see
    /// [`SweepSpec::uses`](super::spec::SweepSpec::uses).
    #[must_use]
    pub fn uses(&self, parameter: Parameter) -> bool {
        let taken = parameter.of_start() || Self::takes(self.law.as_ref(), parameter);
        taken && !self.get(parameter).is_nan()
    }

    /// True for the parameters that a setting with this law can have, its start left aside.
    fn takes(law: Option<&LawKind>, parameter: Parameter) -> bool {
        match (law, parameter) {
            _ if parameter.of_limit() => false,
            (Some(_), Parameter::MuPrime | Parameter::MuK) => false,
            (Some(law), Parameter::Mu0 | Parameter::VS | Parameter::MuPrimeRest) => {
                law.parameters().contains(&parameter)
            }
            (Some(_), _) => true,
            (None, _) => !parameter.of_friction_law() && parameter != Parameter::V0,
        }
    }

    /// Every parameter that a setting with this law needs is given, and none that would be ignored.
    /// The start of a motion is another matter: linear stability knows none.
    ///
    /// # Errors
    /// Names the first parameter that is missing or unused.
    pub fn check_given(
        law: Option<&LawKind>,
        given: impl Fn(Parameter) -> bool,
    ) -> Result<(), GivenError> {
        for parameter in Parameter::ALL.into_iter().filter(|p| !p.of_start()) {
            let taken = Self::takes(law, parameter);
            if given(parameter) && !taken {
                return Err(GivenError::Unused(parameter));
            }
            let of_law = law.is_some_and(|law| law.parameters().contains(&parameter));
            let needed = taken && !of_law && parameter.default_value().is_none();
            if needed && !given(parameter) {
                return Err(GivenError::Missing(parameter));
            }
        }
        law.map_or(Ok(()), |law| Self::check_law_given(law, given))
    }

    /// Checks that as many parameters of the law are given as it needs.
    fn check_law_given(law: &LawKind, given: impl Fn(Parameter) -> bool) -> Result<(), GivenError> {
        let parameters = law.parameters();
        let there = parameters.iter().filter(|p| given(**p)).count();
        match (there.cmp(&law.needed()), parameters) {
            (Ordering::Less, _) => {
                let missing = parameters.iter().find(|p| !given(**p));
                missing.map_or(Ok(()), |p| Err(GivenError::Missing(*p)))
            }
            (Ordering::Greater, [.., last]) => Err(GivenError::Follows(*last)),
            _ => Ok(()),
        }
    }

    /// μ0 and v_s of the law, each given or from the other and the slope at rest.
    fn mu0_and_v_s(&self) -> (f64, f64) {
        let of = |p| self.get(p);
        let (mu0, v_s) = (of(Parameter::Mu0), of(Parameter::VS));
        let slope = of(Parameter::MuPrimeRest);
        match (mu0.is_nan(), v_s.is_nan()) {
            (true, false) => (-slope * v_s, v_s),
            (false, true) => (mu0, -mu0 / slope),
            _ => (mu0, v_s),
        }
    }

    /// The friction law with its parameters.
    ///
    /// # Errors
    /// When the law is ill-posed, see [`FrictionLaw`].
    pub fn friction_law(&self) -> Result<Option<FrictionLaw>, ModelError> {
        let (mu0, v_s) = self.mu0_and_v_s();
        let mu_s = self.get(Parameter::MuS);
        self.law
            .as_ref()
            .map(|law| match law {
                LawKind::Coulomb => FrictionLaw::coulomb(mu0, mu_s),
                LawKind::Weakening => FrictionLaw::weakening(mu0, v_s, mu_s),
                LawKind::Stribeck => FrictionLaw::stribeck(mu0, v_s, mu_s),
                LawKind::Table(table) => FrictionLaw::table(table.clone(), mu_s),
            })
            .transpose()
    }

    /// μ_K and μ_K′ at the sliding velocity: from the friction law, or as given.
    ///
    /// # Errors
    /// When the law is ill-posed.
    pub fn sliding_point(&self) -> Result<SlidingPoint, ModelError> {
        match self.friction_law()? {
            Some(law) => SlidingPoint::of_law(&law, self.get(Parameter::V0)),
            None => Ok(SlidingPoint {
                mu_k: self.get(Parameter::MuK),
                mu_prime: self.get(Parameter::MuPrime),
            }),
        }
    }

    /// The oscillator.
    ///
    /// # Errors
    /// When mass, stiffness or load are not positive.
    pub fn oscillator(&self) -> Result<Oscillator, ModelError> {
        Oscillator::new(
            self.get(Parameter::Mass),
            self.get(Parameter::Stiffness),
            self.get(Parameter::NormalLoad),
        )
    }

    /// The dimensionless groups and the unit of time √(M/κ).
    ///
    /// # Errors
    /// When a parameter is outside the model's range.
    pub fn groups(&self) -> Result<(Groups, f64), ModelError> {
        let oscillator = self.oscillator()?;
        let groups = oscillator.groups(self.sliding_point()?, self.control());
        Ok((groups, oscillator.time_unit()))
    }

    /// Both gains.
    #[inline]
    #[must_use]
    pub fn control(&self) -> Control {
        Control {
            alpha_v: self.get(Parameter::AlphaV),
            alpha_n: self.get(Parameter::AlphaN),
        }
    }
}
