//! Limits of the actuators beside what they limit: v0 and N0 lie within them.

use super::field::Field;
use super::fields_asked::{FieldsAsked, ReportedAt, Unmet};
use super::parameter::Parameter;
use super::values::Setting;
use crate::text::Shown;

/// Pairs of parameters of which the first has to be below the second. One of each is a limit. At a
/// limit itself control would act to one side alone, and no linear answer would hold.
const ORDERED: [[Parameter; 2]; 6] = {
    use Parameter::{LoadMax, LoadMin, NormalLoad, V0, VMax, VMin};
    [
        [VMin, VMax],
        [VMin, V0],
        [V0, VMax],
        [LoadMin, LoadMax],
        [LoadMin, NormalLoad],
        [NormalLoad, LoadMax],
    ]
};

/// A limit that excludes what it limits, or the other limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Excluding {
    /// The limit.
    pub limit: Parameter,
    message: [(Parameter, f64); 2],
    relation: &'static str,
}

impl Excluding {
    /// The first limit that excludes something, where a parameter has values between the `least`
    /// and the `most`; NaN where it has none.
    pub(super) fn find(
        least: impl Fn(Parameter) -> f64,
        most: impl Fn(Parameter) -> f64,
    ) -> Option<Self> {
        let [low, high] = ORDERED
            .into_iter()
            .find(|[low, high]| most(*low) >= least(*high))?;
        let [below, above] = [(low, most(low)), (high, least(high))];
        Some(match Parameter::LIMITS.contains(&high) {
            true => Self {
                limit: high,
                message: [above, below],
                relation: "not above",
            },
            false => Self {
                limit: low,
                message: [below, above],
                relation: "not below",
            },
        })
    }

    /// The need that is not met, in the words of files.
    pub(super) fn unmet(&self) -> Unmet {
        let [message, help] = [self.message(Parameter::key), self.help(Parameter::key)];
        ReportedAt::Parameter(self.limit).refuse(message, help)
    }

    /// The error in words. `name` gives the name of a parameter in the file or on the command line.
    pub(super) fn message(&self, name: fn(Parameter) -> String) -> String {
        let [one, other] = self
            .message
            .map(|(parameter, value)| format!("{} = {}", name(parameter), Shown(value)));
        format!("{one} is {} {other}", self.relation)
    }

    /// A suggestion for the error.
    pub(super) fn help(&self, name: fn(Parameter) -> String) -> String {
        use Parameter::{LoadMax, LoadMin, NormalLoad, V0, VMax, VMin};
        let [low, between, high] = match self.limit {
            VMin | VMax => [VMin, V0, VMax],
            _ => [LoadMin, NormalLoad, LoadMax],
        }
        .map(name);
        format!("control acts around {between}: {low} < {between} < {high}")
    }
}

/// The error of a limit that excludes a value of what it limits.
pub(super) fn excluding(asked: &FieldsAsked) -> Option<Unmet> {
    let least = |p| asked.values(p).fold(f64::NAN, f64::min);
    let most = |p| asked.values(p).fold(f64::NAN, f64::max);
    Excluding::find(least, most).map(|found| found.unmet())
}

/// The error of a field that is of limits, where no actuator has one.
pub(super) fn without_limits(asked: &FieldsAsked, field: Field) -> Option<Unmet> {
    let limits = Parameter::LIMITS;
    let is_given = |limit: &Parameter| {
        let default = limit.default_value();
        asked.values(*limit).any(|value| Some(value) != default)
    };
    limits.iter().all(|limit| !is_given(limit)).then(|| {
        ReportedAt::Field.refuse(
            format!(
                "{} is of actuators with limits, and none is given",
                field.name()
            ),
            format!("give one of {}", limits.map(Parameter::name).join(", ")),
        )
    })
}

impl Setting {
    /// The message and the help where a limit of an actuator excludes v0, N0 or the other limit;
    /// none where none does. The value of a parameter that is `left_aside` does not matter; `name`
    /// gives the name of a parameter.
    pub(crate) fn excluded_by_limits(
        &self,
        left_aside: Option<Parameter>,
        name: fn(Parameter) -> String,
    ) -> Option<(String, String)> {
        let value = |p| match left_aside == Some(p) {
            true => f64::NAN,
            false => self.get(p),
        };
        let found = Excluding::find(value, value)?;
        Some((found.message(name), found.help(name)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(numbers: &[(Parameter, f64)]) -> Option<String> {
        let mut setting = Setting::new(None);
        for (parameter, value) in numbers {
            setting.set(*parameter, *value);
        }
        let value = |p| setting.get(p);
        Excluding::find(value, value).map(|found| found.message(Parameter::key))
    }

    #[test]
    fn limits_stand_in_order_around_what_they_limit() {
        use Parameter::{LoadMax, LoadMin, NormalLoad, V0, VMax, VMin};
        assert_eq!(found(&[]), None);
        assert_eq!(found(&[(VMin, -1.0), (V0, 0.3), (VMax, 0.31)]), None);
        let told = |numbers: &[(Parameter, f64)], text: &str| {
            assert_eq!(found(numbers).as_deref(), Some(text));
        };
        told(
            &[(V0, 0.3), (VMax, 0.3)],
            "v_max = 0.3 is not above v0 = 0.3",
        );
        told(
            &[(V0, 0.3), (VMin, 0.4)],
            "v_min = 0.4 is not below v0 = 0.3",
        );
        told(
            &[(VMin, 0.4), (VMax, 0.2)],
            "v_max = 0.2 is not above v_min = 0.4",
        );
        told(
            &[(LoadMin, 1.5)],
            "load_min = 1.5 is not below normal_load = 1",
        );
        told(
            &[(NormalLoad, 20.0), (LoadMax, 10.0)],
            "load_max = 10 is not above normal_load = 20",
        );
    }
}
