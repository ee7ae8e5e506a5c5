//! The keys of `[friction]` that belong to a formula: its expression, its own parameters, their
//! units.

use std::ops::Range;
use std::sync::Arc;

use super::amount::Amount;
use super::expression::Written;
use super::formula::{EXAMPLE, GivenFormula};
use super::law_kind::LawKind;
use super::parameter::Parameter;
use super::quantity::Quantity;
use super::system::parameter::OwnParameter;
use super::units::Units;
use super::values::Setting;
use crate::model::table::TableColumn;
use crate::text::document::Document;
use crate::text::toml_reader::{Entry, SpecError, entries, parse};

/// The key of the units of own parameters.
pub(super) const UNITS: &str = "units";

/// What a file says of the formula of its friction law.
#[derive(Debug, Default)]
pub(super) struct FormulaKeys {
    /// The formula, and the place of its expression.
    formula: Option<(GivenFormula, Range<usize>)>,
    /// What is wrong with it.
    misread: Option<SpecError>,
    /// Values of its own parameters, and all that are given, with the places of their keys.
    values: Vec<(Arc<OwnParameter>, f64)>,
    places: Vec<(Arc<OwnParameter>, Range<usize>)>,
}

impl FormulaKeys {
    /// The formula in `[friction]` of `document`, whose whole text is `text`. It is read before all
    /// else: axes are of its parameters.
    pub(super) fn ahead(document: &Document, text: &str, units: &Units) -> Self {
        let table = |key: &str| document.ahead(key)?.table().ok();
        let axes = table("axes").unwrap_or_default();
        let friction = table("friction");
        let read = friction.and_then(|friction| read_formula(&friction, &axes, text, units));
        let (formula, misread) = match read.transpose() {
            Ok(formula) => (formula, None),
            Err(error) => (None, Some(error)),
        };
        Self {
            formula,
            misread,
            ..Self::default()
        }
    }

    /// The formula of a law that is known already.
    pub(super) fn of(law: Option<&LawKind>) -> Self {
        let formula = match law {
            Some(LawKind::Formula(formula)) => Some((formula.clone(), 0..0)),
            _ => None,
        };
        Self {
            formula,
            ..Self::default()
        }
    }

    /// Takes a key of `[friction]`. Returns whether it is one of the formula.
    pub(super) fn take(&mut self, entry: &Entry, units: &Units) -> Result<bool, SpecError> {
        let of_formula = [TableColumn::MuK.name(), UNITS].contains(&entry.key);
        if of_formula && let Some(misread) = &self.misread {
            return Err(misread.clone());
        }
        if of_formula && self.formula.is_some() {
            return Ok(true);
        }
        let Some(own) = self.own_named(entry.key) else {
            return Ok(false);
        };
        self.give(&own, &entry.key_span)?;
        let value = units.value(entry, &Quantity::Own(Arc::clone(&own)))?;
        self.put(&own, value, &entry.span)?;
        Ok(true)
    }

    /// Takes the value of an own parameter that is given, which stands at `place`.
    pub(super) fn put(
        &mut self,
        own: &Arc<OwnParameter>,
        value: f64,
        place: &Range<usize>,
    ) -> Result<(), SpecError> {
        let value = own.check(value);
        let value = value.map_err(|why| SpecError::at(place.clone(), why))?;
        self.values.push((Arc::clone(own), value));
        Ok(())
    }

    /// The own parameter of that name.
    pub(super) fn own_named(&self, name: &str) -> Option<Arc<OwnParameter>> {
        let (formula, _) = self.formula.as_ref()?;
        formula.own_named(name).cloned()
    }

    /// Records that the file gives an own parameter, as a value or as an axis.
    pub(super) fn give(
        &mut self,
        own: &Arc<OwnParameter>,
        key: &Range<usize>,
    ) -> Result<(), SpecError> {
        if self.places.iter().any(|(given, _)| given == own) {
            return Err(given_twice(&own.name, key));
        }
        self.places.push((Arc::clone(own), key.clone()));
        Ok(())
    }

    /// Checks that every own parameter is given.
    pub(super) fn check(&self) -> Result<(), SpecError> {
        let Some((formula, place)) = &self.formula else {
            return Ok(());
        };
        let given = |own: &OwnParameter| self.places.iter().any(|(of, _)| **of == *own);
        formula.missing(given).map_or(Ok(()), |own| {
            let advice = format!("[friction] {0} = VALUE, or an axis {0}", own.name);
            Err(SpecError {
                span: Some(place.clone()),
                ..GivenFormula::not_given(own, advice)
            })
        })
    }

    /// The place of the expression.
    pub(super) fn place(&self) -> Option<&Range<usize>> {
        self.formula.as_ref().map(|(_, place)| place)
    }

    /// The law; `entry` is its name.
    pub(super) fn law(&self, entry: &Entry) -> Result<LawKind, SpecError> {
        match &self.formula {
            Some((formula, _)) => Ok(LawKind::Formula(formula.clone())),
            None => Err(entry
                .error("mu_k is not given: the formula law is an expression in v")
                .help(format!(
                    "mu_k = \"{EXAMPLE}\", and a key for each name in it"
                ))),
        }
    }

    /// Puts the values into a setting with the law.
    pub(super) fn fill(&self, setting: &mut Setting) {
        for (own, value) in &self.values {
            setting.vary(&Quantity::Own(Arc::clone(own)), *value);
        }
    }

    /// The error of an unknown key of `[friction]`; none without a formula.
    pub(super) fn unknown_key(&self, entry: &Entry) -> Option<SpecError> {
        let (formula, _) = self.formula.as_ref()?;
        Some(SpecError {
            span: Some(entry.key_span.clone()),
            ..formula.unknown(entry.key)
        })
    }

    /// The error of an axis of no known parameter. Where the formula is not understood, it may be
    /// one of its own.
    pub(super) fn unknown_axis(&self, axis: &Entry) -> SpecError {
        if let Some(misread) = &self.misread {
            return misread.clone();
        }
        let formula = self.formula.iter().flat_map(|(formula, _)| formula.own());
        let own = formula.map(|(own, _)| &*own.name);
        let known = Parameter::ALL.map(Parameter::name).into_iter();
        axis.unknown(&known.chain(own).collect::<Vec<_>>())
    }
}

/// The formula in `[friction]` of a text, without values. Nothing else of the text is read.
///
/// # Errors
/// Where there is none, and where it is not understood.
pub(crate) fn formula_of(text: &str) -> Result<GivenFormula, SpecError> {
    let parsed = parse(text)?;
    let entries = entries(parsed.get_ref(), "");
    let document = Document::of(entries, ["friction"]);
    let FormulaKeys {
        formula, misread, ..
    } = FormulaKeys::ahead(&document, text, &Units::default());
    if let Some(misread) = misread {
        return Err(misread);
    }
    let none = || SpecError::whole("there is no formula").help("[friction] law = \"formula\"");
    formula.map(|(formula, _)| formula).ok_or_else(none)
}

/// The formula of `[friction]`, with the place of its expression; none of another law. Its own
/// parameters have the units in which they are given, there or as `axes`, or those of a table.
fn read_formula(
    friction: &[Entry],
    axes: &[Entry],
    text: &str,
    units: &Units,
) -> Option<ReadFormula> {
    let of = |key: &str| friction.iter().find(|entry| entry.key == key);
    let is_formula = |law: &&Entry| law.string().is_ok_and(|name| name == LawKind::FORMULA);
    of("law").filter(is_formula)?;
    let key = TableColumn::MuK.name();
    let written = Written::of(key.to_owned(), of(key)?, text);
    Some(written.and_then(|written| {
        let mut formula = GivenFormula::written(&written)?;
        for entry in friction.iter().chain(axes) {
            let amount = |text: &str| Amount::read(text)?.ok().filter(Amount::needs_units);
            let own = formula.own_named(entry.key).cloned();
            if let Some((own, amount)) = own.zip(entry.in_strings(&amount)) {
                formula.measure(&own, amount.dimension(), units);
            }
        }
        if let Some(table) = of(UNITS) {
            read_units(table, &mut formula, units)?;
        }
        Ok((formula, written.span))
    }))
}

/// A formula, with the place of its expression.
type ReadFormula = Result<(GivenFormula, Range<usize>), SpecError>;

/// Reads the units of own parameters. Plain numbers are in those of the file, so these have to be
/// the same.
fn read_units(table: &Entry, formula: &mut GivenFormula, units: &Units) -> Result<(), SpecError> {
    for entry in table.table()? {
        let unknown = || SpecError {
            span: Some(entry.key_span.clone()),
            ..formula.unknown(entry.key)
        };
        let own = formula.own_named(entry.key).cloned().ok_or_else(unknown)?;
        let text = entry.string()?;
        let dimension = units.dimension_of(text).map_err(|error| SpecError {
            help: error.help,
            ..entry.error(error.message)
        })?;
        formula.measure(&own, dimension, units);
    }
    Ok(())
}

/// The error of a parameter that is an axis as well as a value, or stands twice.
pub(super) fn given_twice(name: &str, key: &Range<usize>) -> SpecError {
    SpecError::at(key.clone(), format!("{name} is given twice"))
        .help("a parameter is either an axis or a fixed value")
}
