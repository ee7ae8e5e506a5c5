//! Whether given parameters make a setting, and why they do not, in words.

use std::cmp::Ordering;

use super::law_kind::LawKind;
use super::parameter::Parameter;
use super::values::Setting;

/// Why a set of given parameters does not make a setting.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GivenError {
    /// This parameter is needed but not given.
    Missing(Parameter),
    /// This parameter is given but would have no effect.
    Unused(Parameter),
    /// This parameter is given, but follows from others that are also given.
    Follows(Parameter),
}

impl GivenError {
    /// The error in words, for a setting with the friction law `law`. `name` gives the name of a
    /// parameter in the file or on the command line.
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

    /// A suggestion for the error; `name` as in [`GivenError::message`].
    #[must_use]
    pub fn help(self, name: fn(Parameter) -> String) -> String {
        use Parameter::{Mu0, MuK, MuPrime, MuPrimeRest, V0, VS};
        match self {
            Self::Missing(p) => {
                let law = match (p, name(V0)) {
                    (MuPrime, v0) if v0.starts_with("--") => format!("; or --friction with {v0}"),
                    (MuPrime, v0) => format!("; or [friction] with {v0}"),
                    _ => String::new(),
                };
                format!("{}: {}, {}{law}", name(p), p.long_name(), p.allowed())
            }
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

impl Setting {
    /// Checks that every parameter that a setting with this law needs is given, and none that would
    /// be ignored. The start of a motion is not checked: linear stability does not depend on it.
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
}
