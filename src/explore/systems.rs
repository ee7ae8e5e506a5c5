//! Systems in the place of the block: those that are part of the program, and one from a text.

use std::str::FromStr;

use serde::Serialize;

use super::known::{KnownPage, KnownParameter};
use crate::setting::needs::fields_of_system;
use crate::setting::system::parameter::OwnParameter;
use crate::setting::system::{SystemModel, shipped};
use crate::setting::{Field, Parameter};
use crate::text::SpecError;
use crate::text::toml_reader::quoted;

/// What parameters of systems belong to.
const GROUP: &str = "system";

/// A system, with what can be set and asked of it.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct KnownSystem {
    /// The word for it in texts; null for one that is no part of the program.
    #[cfg_attr(feature = "serve", schema(required))]
    pub name: Option<&'static str>,
    /// What it is; may be empty.
    pub title: String,
    /// What it is, with its polynomials.
    pub text: String,
    /// The text of its file.
    pub toml: String,
    /// The value of the key `system` in a text, as TOML.
    pub value: String,
    /// Its own parameters.
    pub own: Vec<KnownParameter>,
    /// The names of its other parameters, which other models have too.
    pub others: Vec<&'static str>,
    /// The names of the fields that its maps can have.
    pub fields: Vec<&'static str>,
}

impl KnownSystem {
    /// All that are part of the program.
    #[must_use]
    pub fn shipped() -> Vec<Self> {
        let all = shipped::SHIPPED.into_iter();
        let known = all.filter_map(|(name, text)| {
            let model = shipped::system(name)?;
            Some(Self::of(&model, text, Some(name)))
        });
        known.collect()
    }

    /// The system that a system file describes, by its text.
    ///
    /// # Errors
    /// Points at the first mistake.
    pub fn read(text: &str) -> Result<Self, SpecError> {
        Ok(Self::of(&SystemModel::from_str(text)?, text, None))
    }

    fn of(model: &SystemModel, text: &str, name: Option<&'static str>) -> Self {
        let others = Parameter::of_systems(model.is_feedback()).iter();
        let own = model.parameters.iter();
        Self {
            name,
            title: model.title.clone(),
            text: model.in_one_line(),
            toml: text.to_owned(),
            value: name.map_or_else(|| model.to_inline_table(), quoted),
            own: own.map(|own| parameter(own)).collect(),
            others: others.map(|p| p.name()).collect(),
            fields: fields_of_system(model).map(Field::name).collect(),
        }
    }
}

/// One of a system's own parameters, with its default as the value at first.
fn parameter(own: &OwnParameter) -> KnownParameter {
    let page = ends(own).map(|ends| KnownPage {
        first: None,
        slider: ends,
        axis: ends,
        folded: None,
    });
    KnownParameter {
        default: Some(own.default),
        ..KnownParameter::own(own, GROUP, page)
    }
}

/// The ends of a slider and an axis: those of the range where it has both, else from 0 to twice the
/// default, or around it where that is 0; none where the range is a single value.
fn ends(own: &OwnParameter) -> Option<[f64; 2]> {
    let usual = match own.default {
        0.0 => [-1.0, 1.0],
        default if default > 0.0 => [0.0, 2.0 * default],
        default => [2.0 * default, 0.0],
    };
    let [low, high] = match own.ends() {
        (Some(low), Some(high)) => [low, high],
        (low, high) => {
            let low = low.map_or(usual[0], |low| low.max(usual[0]));
            [low, high.map_or(usual[1], |high| high.min(usual[1]))]
        }
    };
    (low < high).then_some([low, high])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setting::point_file::{PointOf, PointSpec};
    use crate::setting::quantity::Quantity;

    #[test]
    fn what_is_told_of_a_system_is_read_as_that_system() {
        let own = "title = \"Mine\"\nP = \"s^2 + c*s + 1\"\nQ = \"k*tau\"\n[parameters]\n\
            c = { default = 0.2, minimum = 0 }\nk = { maximum = 0.5 }\n";
        let mut all = KnownSystem::shipped();
        assert_eq!(all.len(), shipped::SHIPPED.len());
        all.push(KnownSystem::read(own).unwrap());
        for known in all {
            let text = format!("system = {}\n[fixed]\ntau = 1.0\n", known.value);
            let setting = PointSpec::read(&text, PointOf::Sliding).unwrap().setting;
            let model = setting.system().unwrap();
            let expected = known.name.map_or_else(|| own.parse().ok(), shipped::system);
            assert_eq!(Some(model), expected.as_ref());
            let names: Vec<&str> = known.own.iter().map(|of| &*of.name).collect();
            let quantities = model.quantities();
            let all: Vec<&str> = quantities.iter().map(Quantity::name).collect();
            assert_eq!([&names[..], &known.others].concat(), all);
            let of_delay = known.fields.contains(&"delay_margin");
            assert_eq!(of_delay, known.name.is_some());
            assert!(known.fields.contains(&"abscissa") && !known.fields.contains(&"vc"));
        }
    }

    /// Sliders and axes lie within the range, with the default.
    #[test]
    fn parameters_of_systems_have_ends() {
        let page = |said: &str| {
            let text = format!("P = \"s + k\"\nQ = \"1\"\n[parameters]\nk = {said}\n");
            let known = KnownSystem::read(&text).unwrap();
            known.own[0].page.as_ref().map(|page| page.slider)
        };
        for (said, ends) in [
            ("0", Some([-1.0, 1.0])),
            ("{ minimum = 0 }", Some([0.0, 1.0])),
            ("0.02", Some([0.0, 0.04])),
            ("-3", Some([-6.0, 0.0])),
            (
                "{ default = 7, minimum = 5, maximum = 10 }",
                Some([5.0, 10.0]),
            ),
            ("{ default = 7, minimum = 5 }", Some([5.0, 14.0])),
            ("{ default = 0, maximum = 0 }", Some([-1.0, 0.0])),
            ("{ default = 2, minimum = 2, maximum = 2 }", None),
        ] {
            assert_eq!(page(said), ends, "{said}");
        }
        for known in KnownSystem::shipped() {
            for of in known.own {
                let ([low, high], default) = (of.range, of.default.unwrap());
                let page = of.page.unwrap();
                let [from, to] = page.slider;
                assert!(low <= from && from <= default && default <= to && to <= high);
            }
        }
    }

    #[test]
    fn a_mistake_in_a_system_is_told_in_its_place() {
        let text = "P = \"s^2 + c*s + 1\"\nQ = \"kk\"\n[parameters]\nc = 0.1\n";
        let place = KnownSystem::read(text).unwrap_err().span.unwrap();
        assert!(text[place].contains("kk"));
        assert!(KnownSystem::read("").is_err());
    }
}
