//! One value for every parameter, and which of them must be given.

use std::sync::Arc;

use super::fit_errors::FitErrors;
use super::formula::GivenFormula;
use super::law_kind::{LawKind, OF_VELOCITY};
use super::no_answer::NoAnswer;
use super::own_system::OwnSystem;
use super::parameter::{Group, Parameter};
use super::quantity::Quantity;
use super::system::parameter::OwnParameter;
use super::system::{Evaluation, SystemModel};
use crate::linear::general::Polynomial;
use crate::linear::line::Linear;
use crate::model::{Dashpots, FrictionLaw, ModelError, Oscillator, RateAndState, SlidingPoint};

/// One value for every parameter: a point of parameter space.
///
/// ```
/// use slipmap::setting::{Parameter, Setting};
///
/// let setting = Setting::checked([("mu_prime", -0.3), ("tau", 4.15)], None, &[])?;
/// assert_eq!(setting.get(Parameter::NormalLoad), 1.0);
/// # Ok::<(), slipmap::text::SpecError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    values: [f64; Parameter::ALL.len()],
    subject: Subject,
    /// What a fit says of the friction law.
    pub(super) fit_errors: Option<Arc<FitErrors>>,
}

/// What a setting describes.
#[derive(Debug, Clone, PartialEq)]
enum Subject {
    /// The block on its spring, with a friction law or given μ_K and μ_K′.
    Block(Option<LawKind>),
    /// A system from a file.
    File(OwnSystem),
}

impl Setting {
    /// A setting of default values; parameters without a default are NaN until they are set. μ_K
    /// and μ_K′ come from `law`, if there is one.
    #[must_use]
    pub fn new(law: Option<LawKind>) -> Self {
        let values = Parameter::ALL.map(|p| p.default_value().unwrap_or(f64::NAN));
        Self {
            values,
            subject: Subject::Block(law),
            fit_errors: None,
        }
    }

    /// The default values of a system from a file; its delay is NaN until it is set.
    #[must_use]
    pub fn of_system(model: Arc<SystemModel>) -> Self {
        Self {
            subject: Subject::File(OwnSystem::new(model)),
            ..Self::new(None)
        }
    }

    fn file(&self) -> Option<&OwnSystem> {
        match &self.subject {
            Subject::Block(_) => None,
            Subject::File(system) => Some(system),
        }
    }

    /// The system from a file, where it is not the letter's.
    #[must_use]
    pub fn system(&self) -> Option<&SystemModel> {
        self.file().map(|system| &*system.model)
    }

    /// The own parameters of the system or of the formula of friction, with their values.
    pub fn own(&self) -> impl Iterator<Item = (&Arc<OwnParameter>, f64)> {
        let system = self.file().into_iter().flat_map(OwnSystem::parameters);
        let formula = self.formula().into_iter().flat_map(GivenFormula::own);
        system.chain(formula)
    }

    /// The formula of the friction law, if it is one.
    #[must_use]
    pub fn formula(&self) -> Option<&GivenFormula> {
        match self.law() {
            Some(LawKind::Formula(formula)) => Some(formula),
            _ => None,
        }
    }

    /// The parameters of the system besides its own; none for the letter's system.
    #[must_use]
    pub fn others(&self) -> &'static [Parameter] {
        self.system()
            .map_or(&[], |model| Parameter::of_systems(model.is_feedback()))
    }

    /// The system from a file at this setting, evaluated in `at`; none for the letter's system.
    pub(super) fn system_in(&self, at: &mut Evaluation) -> Option<Result<Linear, NoAnswer>> {
        let system = self.file()?;
        system.put_into(at, self.feedback());
        Some(system.model.at(at))
    }

    /// The polynomials of a system with powers of its delay at this setting, each from the constant
    /// on; none of others.
    pub(crate) fn powers_of_delay(&self) -> Result<Option<Vec<Vec<f64>>>, NoAnswer> {
        let mut at = Evaluation::default();
        let Some(system) = self.file() else {
            return Ok(None);
        };
        system.put_into(&mut at, self.feedback());
        system.model.powers_at(&mut at)
    }

    /// The numerator over D of what a disturbance at the input of the plant does to the output;
    /// none where the system is no loop of plant and controller.
    pub(crate) fn disturbed_through(&self) -> Result<Option<Polynomial>, NoAnswer> {
        let mut at = Evaluation::default();
        let Some(system) = self.file() else {
            return Ok(None);
        };
        system.put_into(&mut at, self.feedback());
        system.model.disturbed_through(&mut at)
    }

    /// The value of the quantity of an axis.
    #[must_use]
    pub fn value_of(&self, quantity: &Quantity) -> f64 {
        match (quantity, &self.subject) {
            (Quantity::Known(parameter), _) => self.get(*parameter),
            (Quantity::Own(own), Subject::File(system)) => system.get(own),
            (Quantity::Own(own), Subject::Block(Some(LawKind::Formula(law)))) => law.get(own),
            (Quantity::Own(_), Subject::Block(_)) => f64::NAN,
        }
    }

    /// Sets the value of the quantity of an axis.
    #[inline]
    pub fn vary(&mut self, quantity: &Quantity, value: f64) {
        match (quantity, &mut self.subject) {
            (Quantity::Known(parameter), _) => self.set(*parameter, value),
            (Quantity::Own(own), Subject::File(system)) => system.set(own, value),
            (Quantity::Own(own), Subject::Block(Some(LawKind::Formula(law)))) => {
                law.set(own, value);
            }
            (Quantity::Own(_), Subject::Block(_)) => {}
        }
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
        match &self.subject {
            Subject::Block(law) => law.as_ref(),
            Subject::File(_) => None,
        }
    }

    /// Puts another friction law in the place of that of the block.
    pub(crate) fn take_law(&mut self, law: Option<LawKind>) {
        if let Subject::Block(old) = &mut self.subject {
            *old = law;
        }
    }

    /// True for the parameters on which a cell of this setting depends: those that it takes and has
    /// a value of. For the limit of a short delay, see
    /// [`SweepSpec::uses`](super::spec::SweepSpec::uses) instead.
    #[must_use]
    pub fn uses(&self, parameter: Parameter) -> bool {
        let taken = match &self.subject {
            Subject::Block(law) => parameter.of_start() || Self::takes(law.as_ref(), parameter),
            Subject::File(_) => self.others().contains(&parameter),
        };
        taken && self.says(parameter)
    }

    /// Whether a parameter has a value, and is not absent by that.
    pub(super) fn says(&self, parameter: Parameter) -> bool {
        let value = self.get(parameter);
        let absent = parameter.absent_by_default() && parameter.default_value() == Some(value);
        !value.is_nan() && !absent
    }

    /// The first of these parameters with which the setting goes beyond the letter's own system.
    /// Without gains, memory, latency and sampling have no effect and do not count.
    #[must_use]
    pub(super) fn beyond_letter(&self, of: &[Parameter]) -> Option<Parameter> {
        let idle = !self.control().act();
        let of_the_past = [Parameter::SampleTime, Parameter::Memory, Parameter::Latency];
        let left_aside = |p: Parameter| idle && of_the_past.contains(&p);
        let mut of = of.iter().copied();
        of.find(|&p| self.get(p) != 0.0 && !left_aside(p))
    }

    /// Whether the linear model is the letter's own.
    #[must_use]
    pub fn is_of_letter(&self) -> bool {
        self.check_of_letter(&Parameter::BEYOND_LETTER, "").is_ok()
    }

    /// Refuses settings that go beyond the letter's own system by one of these parameters, for
    /// computations that do not support them. `allowed` says what is allowed there, and where.
    ///
    /// # Errors
    /// Names the first of them that is not 0.
    pub fn check_of_letter(
        &self,
        of: &[Parameter],
        allowed: &'static str,
    ) -> Result<(), ModelError> {
        if self.system().is_some() {
            return Err(ModelError {
                parameter: "system",
                value: f64::NAN,
                allowed: "the letter's where a block on its spring is meant",
                at_speed: None,
            });
        }
        if self.rate_and_state().is_some() {
            return Err(ModelError::of_law(OF_VELOCITY));
        }
        match self.beyond_letter(of) {
            Some(parameter) => Err(ModelError {
                parameter: parameter.name(),
                value: self.get(parameter),
                allowed,
                at_speed: None,
            }),
            None => Ok(()),
        }
    }

    /// True for the parameters that a setting with this law can have, apart from those of its
    /// start.
    pub(super) fn takes(law: Option<&LawKind>, parameter: Parameter) -> bool {
        match (law, parameter.group()) {
            (_, Group::Limit) => false,
            (Some(_), Group::Sliding) => false,
            (Some(law), Group::Law) => law.has(parameter),
            (None, Group::Law | Group::Pull) => false,
            _ => true,
        }
    }

    /// The friction law with its parameters; none where there is no law of the velocity alone.
    ///
    /// # Errors
    /// When the law is ill-posed, see [`FrictionLaw`].
    pub fn friction_law(&self) -> Result<Option<FrictionLaw>, ModelError> {
        let law = self.law().filter(|law| !law.has_state());
        law.map(|law| law.at(self)).transpose()
    }

    /// The law of rate-and-state friction; none for other laws.
    #[must_use]
    pub fn rate_and_state(&self) -> Option<RateAndState> {
        self.law()?.with_state(self)
    }

    /// κ/κ_c of rate-and-state friction; infinite where sliding without control is stable at every
    /// stiffness, none for other laws.
    #[must_use]
    pub fn stiffness_ratio(&self) -> Option<f64> {
        let (law, oscillator) = (self.rate_and_state()?, self.oscillator().ok()?);
        let groups = law.groups(&oscillator, self.get(Parameter::V0));
        Some(groups.stiffness_ratio())
    }

    /// μ_K and μ_K′ at the sliding velocity: from the friction law, or as given.
    ///
    /// # Errors
    /// When the law is ill-posed.
    pub fn sliding_point(&self) -> Result<SlidingPoint, ModelError> {
        if let Some(law) = self.rate_and_state() {
            return law.steady(self.get(Parameter::V0));
        }
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
    /// When mass, stiffness or load are not positive, or a dashpot is negative.
    pub fn oscillator(&self) -> Result<Oscillator, ModelError> {
        let undamped = Oscillator::new(
            self.get(Parameter::Mass),
            self.get(Parameter::Stiffness),
            self.get(Parameter::NormalLoad),
        )?;
        let [damping, viscous] = Parameter::DASHPOTS.map(|dashpot| self.get(dashpot));
        if damping == 0.0 && viscous == 0.0 {
            return Ok(undamped);
        }
        undamped.damped(Dashpots { damping, viscous })
    }

    /// Whether a delay is given but has no effect, because both gains are 0.
    #[must_use]
    pub fn has_idle_delay(&self) -> bool {
        let idle = self.system().is_none() && !self.control().act();
        idle && self.get(Parameter::Tau) > 0.0
    }
}
