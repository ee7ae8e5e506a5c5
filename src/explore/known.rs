//! The parameters, friction laws and fields of the program, with all their facts.

use serde::Serialize;

use super::systems::KnownSystem;
use crate::linear::status::MOST_COUNTED;
use crate::meaning::flags::flags;
use crate::meaning::legend::{Entry, Mark, classes};
use crate::setting::field::Storage;
use crate::setting::formula::{EXAMPLE, GivenFormula};
use crate::setting::formula_keys::formula_of;
use crate::setting::law_kind::{LawKind, NamedLaw};
use crate::setting::parameter::{Folded, Group, Page};
use crate::setting::system::parameter::OwnParameter;
use crate::setting::units::Units;
use crate::setting::{Field, Parameter};
use crate::sweep::engine::FEW_FILL;
use crate::text::SpecError;

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
    /// The flags of a cell's status.
    pub flags: Vec<KnownFlag>,
    /// Systems that can stand in the place of the block.
    pub systems: Vec<KnownSystem>,
}

/// A parameter.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct KnownParameter {
    /// The word for it in texts.
    pub name: String,
    /// Its symbol.
    pub symbol: String,
    /// What it is.
    pub long_name: String,
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
    pub allowed: String,
    /// What it belongs to: `model`, `sliding`, `pull`, `law`, `start`, `limit` or, of what only one
    /// system has, `system`.
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
    /// The value at first, of a limit once it is on; none where it is the default.
    #[cfg_attr(feature = "serve", schema(required))]
    pub first: Option<f64>,
    /// The ends of its slider.
    pub slider: [f64; 2],
    /// The ends of its axis at first.
    pub axis: [f64; 2],
    /// The box that folds its slider away: `feedback`, `model` or, of what is off at first,
    /// `limits`; none where it is in sight.
    #[cfg_attr(feature = "serve", schema(required))]
    pub folded: Option<&'static str>,
}

/// A friction law.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct KnownLaw {
    /// The word for it in texts.
    pub name: &'static str,
    /// Its formula, of the law `formula` an example; none for a table.
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

/// The parameters of a friction law that is a formula.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct KnownFormula {
    /// Those that other laws have too, besides μ_S.
    pub known: Vec<&'static str>,
    /// Its own.
    pub own: Vec<KnownParameter>,
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
    /// Its classes by their numbers, the last one for all larger numbers too; none where its
    /// values lie on a scale.
    #[cfg_attr(feature = "serve", schema(required))]
    pub classes: Option<Vec<KnownClass>>,
    /// The number that stands for all larger ones too, if its numbers are counts.
    #[cfg_attr(feature = "serve", schema(required))]
    pub largest: Option<u16>,
}

/// A class of a field's values.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct KnownClass {
    /// Its words in a legend.
    pub text: String,
    /// The colour of its cells.
    pub colour: String,
}

/// A flag of a cell's status.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct KnownFlag {
    /// Its bit.
    pub mask: u8,
    /// Its name.
    pub name: &'static str,
    /// The same in words.
    pub text: &'static str,
}

impl Known {
    /// Everything. The law `formula` has the parameters of its example.
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
            laws: formulas.chain([table, KnownLaw::of_example()]).collect(),
            fields: Field::ALL.map(KnownField::of).into(),
            flags: KnownFlag::all(),
            systems: KnownSystem::shipped(),
        }
    }
}

impl KnownFlag {
    /// All flags, in the order of their bits.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let flags = flags().into_iter();
        flags
            .map(|(mask, name, text)| Self { mask, name, text })
            .collect()
    }
}

impl KnownParameter {
    fn of(parameter: Parameter) -> Self {
        Self {
            name: parameter.name().into(),
            symbol: parameter.symbol().into(),
            long_name: parameter.long_name().into(),
            unit: Units::default().of_parameter(parameter),
            dimension: parameter.dimension(),
            default: parameter.default_value(),
            range: parameter.range(),
            allowed: parameter.allowed().into(),
            group: parameter.group().name(),
            flag: parameter.long_flag().map(|flag| format!("--{flag}")),
            page: parameter.page().map(KnownPage::of),
        }
    }

    /// A parameter that only one formula or one system has, in this group, and how the page offers
    /// it.
    pub(super) fn own(own: &OwnParameter, group: &'static str, page: Option<KnownPage>) -> Self {
        Self {
            name: own.name.clone(),
            symbol: own.name.clone(),
            long_name: own.long_name.clone(),
            unit: own.unit.clone(),
            dimension: own.dimension,
            default: None,
            range: [own.minimum, own.maximum],
            allowed: own.allowed(),
            group,
            flag: None,
            page,
        }
    }

    /// A parameter that only one formula has. Nothing is known of its size.
    fn of_formula(own: &OwnParameter) -> Self {
        let ends = [0.0, 2.0];
        let page = KnownPage {
            first: Some(1.0),
            slider: ends,
            axis: ends,
            folded: None,
        };
        Self::own(own, Group::Law.name(), Some(page))
    }
}

impl KnownFormula {
    /// The parameters of the formula in `[friction]` of a text.
    ///
    /// # Errors
    /// Where there is none, and where it is not understood.
    pub fn read(text: &str) -> Result<Self, SpecError> {
        let formula = formula_of(text)?;
        Ok(Self {
            known: formula.known().iter().map(|p| p.name()).collect(),
            own: formula
                .own()
                .map(|(own, _)| KnownParameter::of_formula(own))
                .collect(),
        })
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

    /// The law of an expression, with that of the example.
    fn of_example() -> Self {
        let example = GivenFormula::read(EXAMPLE);
        let parameters = example.iter().flat_map(GivenFormula::known);
        let parameters: Vec<_> = parameters.map(|p| p.name()).collect();
        Self {
            name: LawKind::FORMULA,
            formula: Some(EXAMPLE),
            needed: parameters.len(),
            parameters,
            optional: Vec::new(),
            motions: true,
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
            classes: classes(field).map(|all| all.into_iter().map(KnownClass::of).collect()),
            largest: match field.storage() {
                Storage::Count => Some(MOST_COUNTED),
                Storage::Few => Some(u16::from(FEW_FILL - 1)),
                Storage::Kind | Storage::Real => None,
            },
        }
    }
}

impl KnownClass {
    fn of(class: Entry) -> Self {
        let colour = match class.mark {
            Mark::Colour(colour) => colour,
            Mark::Gap(gap) => gap.ground(),
        };
        Self {
            text: class.text,
            colour: colour.hex(),
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

    #[test]
    fn a_formula_tells_its_parameters() {
        let text = |mu_k: &str| format!("[friction]\nlaw = \"formula\"\nmu_k = \"{mu_k}\"\n");
        let found = KnownFormula::read(&text("mu0 + sigma*v^p + mu_s*0")).unwrap();
        assert_eq!(found.known, ["mu0"]);
        let own: Vec<&str> = found.own.iter().map(|of| &*of.name).collect();
        assert_eq!(own, ["sigma", "p"]);
        let wrong = text("mu0 + exq(v)");
        let place = KnownFormula::read(&wrong).unwrap_err().span.unwrap();
        assert!(wrong[place].contains("exq"));
        assert!(KnownFormula::read("[friction]\nlaw = \"coulomb\"\n").is_err());
        let law = Known::all().laws.pop().unwrap();
        assert_eq!(
            (law.name, &law.parameters[..]),
            ("formula", &["mu0", "v_s"][..])
        );
    }

    /// The page sets as many parameters of a law as that needs. It begins within their ranges.
    #[test]
    fn the_page_offers_what_laws_need() {
        let known = Known::all();
        let offered = |name: &str| {
            let mut all = known.parameters.iter();
            all.any(|known| known.name == name && known.page.is_some())
        };
        for law in &known.laws {
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
