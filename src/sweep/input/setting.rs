//! One value for every parameter, and what has to be given for it.

use std::cmp::Ordering;

use super::law_kind::LawKind;
use super::parameter::{Group, Parameter};
use crate::model::{Control, FrictionLaw, Groups, ModelError, Oscillator, SlidingPoint};

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
            Self::Unused(p) if p.of_friction_law() => {
                format!("{} is for the laws {}", name(p), LawKind::with(p))
            }
            Self::Unused(_) => {
                let [mu_prime, mu_k, v0] = [MuPrime, MuK, V0].map(name);
                format!(
                    "give either {mu_prime} (with {mu_k}) or a friction law with {v0}, not both"
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
        match (law, parameter.group()) {
            (_, Group::Limit) => false,
            (Some(_), Group::Sliding) => false,
            (Some(law), Group::Law) => {
                parameter == Parameter::MuS || law.parameters().contains(&parameter)
            }
            (None, Group::Law | Group::Pull) => false,
            _ => true,
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

    /// The friction law with its parameters.
    ///
    /// # Errors
    /// When the law is ill-posed, see [`FrictionLaw`].
    pub fn friction_law(&self) -> Result<Option<FrictionLaw>, ModelError> {
        self.law.as_ref().map(|law| law.at(self)).transpose()
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

    /// Whether there is a delay that nothing acts on: both gains are 0.
    #[must_use]
    pub fn has_idle_delay(&self) -> bool {
        self.control() == Control::default() && self.get(Parameter::Tau) > 0.0
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
