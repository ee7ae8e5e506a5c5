//! The parameters, friction laws and fields of the program, with all their facts.

use serde::Serialize;

use crate::setting::law_kind::{LawKind, NamedLaw};
use crate::setting::parameter::{Folded, Page};
use crate::setting::units::Units;
use crate::setting::{Field, Parameter};

/// All tables.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct Known {
    /// The version of the program.
    pub version: &'static str,
    /// Parameters, in their order everywhere.
    pub parameters: Vec<KnownParameter>,
    /// Friction laws.
    pub laws: Vec<KnownLaw>,
    /// What a map can hold.
    pub fields: Vec<KnownField>,
}

/// A parameter.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct KnownParameter {
    /// The word for it in texts.
    pub name: &'static str,
    /// Its symbol.
    pub symbol: &'static str,
    /// What it is.
    pub long_name: &'static str,
    /// Its unit where no units are given: "1".
    pub unit: String,
    /// Powers of force, length and time in its unit.
    pub dimension: [i32; 3],
    /// Its value where none is given; none where one has to be.
    #[cfg_attr(feature = "serve", schema(required))]
    pub default: Option<f64>,
    /// The smallest and the largest value.
    pub range: [f64; 2],
    /// The same in words.
    pub allowed: &'static str,
    /// What it belongs to: `model`, `sliding`, `pull`, `law`, `start` or `limit`.
    pub group: &'static str,
    /// The flag that gives it on the command line, if there is one.
    #[cfg_attr(feature = "serve", schema(required))]
    pub flag: Option<String>,
    /// How the page offers it; none where it does not.
    #[cfg_attr(feature = "serve", schema(required))]
    pub page: Option<KnownPage>,
}

/// How the page offers a parameter.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct KnownPage {
    /// The value at first; none where it is the default.
    #[cfg_attr(feature = "serve", schema(required))]
    pub first: Option<f64>,
    /// The ends of its slider.
    pub slider: [f64; 2],
    /// The ends of its axis at first.
    pub axis: [f64; 2],
    /// The box that folds its slider away: `feedback` or `model`; none where it is in sight.
    #[cfg_attr(feature = "serve", schema(required))]
    pub folded: Option<&'static str>,
}

/// A friction law.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct KnownLaw {
    /// The word for it in texts.
    pub name: &'static str,
    /// Its formula; none for a table.
    #[cfg_attr(feature = "serve", schema(required))]
    pub formula: Option<&'static str>,
    /// The parameters that describe it, besides μ_S.
    pub parameters: Vec<&'static str>,
    /// How many of them have to be given.
    pub needed: usize,
    /// Those that need not be given, besides μ_S.
    pub optional: Vec<&'static str>,
    /// Whether motions are followed under it.
    pub motions: bool,
}

/// A field of a map.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct KnownField {
    /// The word for it in texts.
    pub name: &'static str,
    /// What it is.
    pub long_name: &'static str,
    /// The same in a few words.
    pub short_name: &'static str,
    /// What a reader should know besides.
    #[cfg_attr(feature = "serve", schema(required))]
    pub comment: Option<&'static str>,
    /// How its values are spread, which tells what scale shows them.
    pub spread: &'static str,
    /// The sign of values where sliding is stable, for values on both sides of 0.
    #[cfg_attr(feature = "serve", schema(required))]
    pub stable_sign: Option<f64>,
    /// The names of its kinds, by their numbers.
    #[cfg_attr(feature = "serve", schema(required))]
    pub kinds: Option<Vec<&'static str>>,
    /// How it is stored: `count`, `kind`, `few` or `real`.
    pub storage: &'static str,
}

impl Known {
    /// Everything. A law that is a formula has no parameters before it is written.
    #[must_use]
    pub fn all() -> Self {
        let formulas = NamedLaw::all().iter().map(KnownLaw::of);
        let table = KnownLaw {
            name: LawKind::TABLE,
            formula: None,
            parameters: Vec::new(),
            optional: Vec::new(),
            needed: 0,
            motions: true,
        };
        Self {
            version: crate::VERSION,
            parameters: Parameter::ALL.map(KnownParameter::of).into(),
            laws: formulas.chain([table]).collect(),
            fields: Field::ALL.map(KnownField::of).into(),
        }
    }
}

impl KnownParameter {
    fn of(parameter: Parameter) -> Self {
        Self {
            name: parameter.name(),
            symbol: parameter.symbol(),
            long_name: parameter.long_name(),
            unit: Units::default().of_parameter(parameter),
            dimension: parameter.dimension(),
            default: parameter.default_value(),
            range: parameter.range(),
            allowed: parameter.allowed(),
            group: parameter.group().name(),
            flag: parameter.long_flag().map(|flag| format!("--{flag}")),
            page: parameter.page().map(KnownPage::of),
        }
    }
}

impl KnownPage {
    fn of(page: Page) -> Self {
        let Page {
            first,
            slider,
            axis,
            folded,
        } = page;
        Self {
            first,
            slider,
            axis,
            folded: folded.map(Folded::name),
        }
    }
}

impl KnownLaw {
    fn of(named: &'static NamedLaw) -> Self {
        let law = LawKind::Named(named);
        let optional = law.optional().iter().filter(|p| **p != Parameter::MuS);
        Self {
            name: named.name(),
            formula: Some(named.formula()),
            parameters: law.parameters().iter().map(|p| p.name()).collect(),
            optional: optional.map(|p| p.name()).collect(),
            needed: law.needed(),
            motions: !law.has_state(),
        }
    }
}

impl KnownField {
    /// The facts about a field.
    #[must_use]
    pub fn of(field: Field) -> Self {
        Self {
            name: field.name(),
            long_name: field.long_name(),
            short_name: field.short_name(),
            comment: field.comment(),
            spread: field.spread().name(),
            stable_sign: field.spread().stable_sign(),
            kinds: field.kinds(),
            storage: field.storage().name(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_those_that_are_checked() {
        for (parameter, known) in Parameter::ALL.into_iter().zip(Known::all().parameters) {
            let [from, to] = known.range;
            assert!(parameter.check(from).is_ok() && parameter.check(to).is_ok());
            assert!(parameter.check(from - from.abs() * 1e-12 - 1e-13).is_err());
            assert!(parameter.check(to + to.abs() * 1e-12 + 1e-13).is_err());
        }
    }

    /// The page sets as many parameters of a law as that needs. It begins within their ranges.
    #[test]
    fn the_page_offers_what_laws_need() {
        let known = Known::all();
        let offered = |name: &str| {
            let mut all = known.parameters.iter();
            all.any(|known| known.name == name && known.page.is_some())
        };
        for law in known.laws.iter().filter(|law| law.motions) {
            let those = law.parameters.iter().filter(|name| offered(name));
            assert_eq!(those.count(), law.needed, "{}", law.name);
        }
        let mut pages = 0;
        for known in &known.parameters {
            let Some(page) = &known.page else { continue };
            pages += 1;
            let [low, high] = known.range;
            let first = page.first.or(known.default).expect("a value at first");
            for value in [page.slider, page.axis].concat().into_iter().chain([first]) {
                assert!((low..=high).contains(&value), "{}: {value}", known.name);
            }
            for [from, to] in [page.slider, page.axis] {
                assert!(from < to, "{}", known.name);
            }
            assert!(
                (page.slider[0]..=page.slider[1]).contains(&first),
                "{}",
                known.name
            );
        }
        assert!(pages > 10, "{pages}");
    }
}
