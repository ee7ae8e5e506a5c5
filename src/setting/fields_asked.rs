//! The fields that are asked for, where they are to be computed, and what is said of a need that is
//! not met.

use super::axis::Axis;
use super::field::Field;
use super::parameter::Parameter;
use super::spec::SweepSpec;
use super::values::Setting;
use crate::text::SpecError;

/// Fields, and where they are to be computed.
#[derive(Clone, Copy)]
pub(super) struct FieldsAsked<'a> {
    /// The fields, in the order of the file.
    pub fields: &'a [Field],
    /// The parameters that are no axes.
    pub fixed: &'a Setting,
    pub axes: &'a [Axis],
    /// Whether it is the limit of a short delay.
    pub limit: bool,
    /// Whether curves or best settings are asked for, which are about one v0.
    pub planes: bool,
}

/// A need that is not met.
pub(super) struct Unmet {
    pub at: ReportedAt,
    /// The error, without a place.
    pub error: SpecError,
}

/// What an unmet need is reported at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ReportedAt {
    /// The field.
    Field,
    /// The name of the friction law.
    Law,
    /// The parameter, or the field where it is not given.
    Parameter(Parameter),
}

impl ReportedAt {
    pub(super) fn refuse(self, message: impl Into<String>, help: impl Into<String>) -> Unmet {
        Unmet {
            at: self,
            error: SpecError::whole(message).help(help),
        }
    }
}

impl<'a> FieldsAsked<'a> {
    /// The fields of a sweep.
    pub(super) fn of(spec: &'a SweepSpec) -> Self {
        let curves = spec.boundaries == Some(true) || !spec.degrees_of_stability.is_empty();
        Self {
            fields: &spec.fields,
            fixed: &spec.fixed,
            axes: &spec.axes,
            limit: spec.limit,
            planes: curves || spec.best,
        }
    }

    pub(super) fn any(&self, of: fn(Field) -> bool) -> bool {
        self.fields.iter().any(|&field| of(field))
    }

    /// The values of a parameter: those of its axis, or the fixed one.
    pub(super) fn values(&self, parameter: Parameter) -> impl Iterator<Item = f64> {
        let axis = self.axes.iter().find(|axis| axis.parameter == parameter);
        let fixed = axis.is_none().then(|| self.fixed.get(parameter));
        axis.into_iter()
            .flat_map(|axis| &axis.values)
            .copied()
            .chain(fixed)
    }

    /// Whether the feedback of some cells is read from time to time.
    pub(super) fn is_sampled(&self) -> bool {
        self.values(Parameter::SampleTime).any(|h| h > 0.0)
    }

    /// Whether a parameter without a default has a value.
    pub(super) fn has(&self, parameter: Parameter) -> bool {
        self.values(parameter).any(|value| !value.is_nan())
    }

    /// Whether anything depends on v0. A law without v0 still has a critical velocity.
    pub(super) fn needs_v0(&self) -> bool {
        let about_v0 = |field: Field| field.of_sliding() || field == Field::Regime;
        !self.any(Field::of_vc) || self.planes || self.any(about_v0)
    }

    /// The error of a field that needs a friction law, which is not there.
    pub(super) fn without_law(&self, why: &str) -> Option<Unmet> {
        self.fixed.law().is_none().then(|| {
            let help = match self.needs_v0() {
                true => "give [friction] and v0 instead of mu_prime and mu_k",
                false => "give [friction] instead of mu_prime and mu_k",
            };
            ReportedAt::Field.refuse(format!("this field needs a friction law: {why}"), help)
        })
    }
}
