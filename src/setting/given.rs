//! The parameters with values in a file: its tables `[fixed]` and `[friction]`, with the place of
//! every key.

use std::ops::Range;
use std::sync::Arc;

use super::actuator_limits::Excluding;
use super::amount::units_of;
use super::fields_asked::{ReportedAt, Unmet};
use super::fit_errors::{self, FitErrors};
use super::fit_keys;
use super::formula_keys::{FormulaKeys, given_twice};
use super::friction_table::GivenTable;
use super::given_error::GivenError;
use super::keys::FRICTION_TABLE;
use super::law_kind::LawKind;
use super::needs::{no_motions, two_starts};
use super::parameter::Parameter;
use super::quantity::Quantity;
use super::sampling::NotSampled;
use super::units::Units;
use super::values::Setting;
use crate::model::ModelError;
use crate::model::table::TableColumn;
use crate::text::document::Document;
use crate::text::toml_reader::{Entry, SpecError, unknown_key};

/// Parameters in the order of the file, each at most once.
#[derive(Debug, Default)]
pub(super) struct GivenParameters {
    units: Units,
    values: Vec<(Parameter, f64)>,
    formula: FormulaKeys,
    law: Option<(LawKind, Range<usize>)>,
    table: GivenTable,
    fit_errors: Option<Arc<FitErrors>>,
    places: Vec<(Parameter, Range<usize>)>,
}

impl GivenParameters {
    /// Nothing yet of the file `text`, of which `document` has the tables, with these units. The
    /// formula of a friction law is read first.
    pub(super) fn begin(document: &Document, text: &str, units: Units) -> Self {
        Self {
            formula: FormulaKeys::ahead(document, text, &units),
            units,
            ..Self::default()
        }
    }

    /// Nothing yet of what has no file, with this law.
    pub(super) fn of_law(law: Option<LawKind>) -> Self {
        Self {
            formula: FormulaKeys::of(law.as_ref()),
            law: law.map(|law| (law, 0..0)),
            ..Self::default()
        }
    }

    /// Takes the value of a parameter by its name, which has no place.
    pub(super) fn take_named(&mut self, name: &str, value: f64) -> Result<(), SpecError> {
        let nowhere = 0..0;
        if let Some(own) = self.formula.own_named(name) {
            self.formula.give(&own, &nowhere)?;
            return self.formula.put(&own, value, &nowhere);
        }
        let parameter = Parameter::from_name(name).ok_or_else(|| {
            let law = self.law.as_ref().map(|(law, _)| law);
            let all = Parameter::ALL.into_iter();
            let known = all.filter(|p| p.of_start() || Setting::takes(law, *p));
            unknown_key(name, name, &known.map(Parameter::name).collect::<Vec<_>>())
        })?;
        self.give(parameter, &nowhere)?;
        self.put(parameter, value, &nowhere)
    }

    /// Records that the file gives `parameter`, as a value or as an axis.
    pub(super) fn give(
        &mut self,
        parameter: Parameter,
        key: &Range<usize>,
    ) -> Result<(), SpecError> {
        if self.place(parameter).is_some() {
            return Err(given_twice(parameter.name(), key));
        }
        self.places.push((parameter, key.clone()));
        Ok(())
    }

    /// The tables of a document, in its order, and its units. For an unknown name, one of the
    /// parameters that the document `takes` is suggested.
    pub(super) fn of(
        document: &mut Document,
        text: &str,
        takes: impl Fn(Parameter) -> bool,
    ) -> Self {
        let units = units_of(document);
        let mut given = Self::begin(document, text, units);
        let tables = ["fixed", "friction", "start"];
        document.each(&tables, |table| given.read(table, &takes));
        given
    }

    /// The units of the file.
    pub(super) fn units(&self) -> &Units {
        &self.units
    }

    /// Records the parameter of an axis.
    pub(super) fn give_axis(&mut self, axis: &Entry) -> Result<Quantity, SpecError> {
        if let Some(own) = self.formula.own_named(axis.key) {
            self.formula.give(&own, &axis.key_span)?;
            return Ok(Quantity::Own(own));
        }
        let parameter = Parameter::from_name(axis.key);
        let parameter = parameter.ok_or_else(|| self.formula.unknown_axis(axis))?;
        self.give(parameter, &axis.key_span)?;
        Ok(parameter.into())
    }

    /// Reads one of the tables of parameters. For an unknown name, one of the parameters that the
    /// file `takes` is suggested.
    pub(super) fn read(
        &mut self,
        table: &Entry,
        takes: impl Fn(Parameter) -> bool,
    ) -> Result<(), SpecError> {
        match table.key {
            "fixed" => self.read_fixed(table, takes),
            "friction" => self.read_friction(table),
            _ => self.read_start(table),
        }
    }

    /// Reads the table `[fixed]`. For an unknown name, one of the parameters that the file `takes`
    /// is suggested.
    fn read_fixed(
        &mut self,
        fixed: &Entry,
        takes: impl Fn(Parameter) -> bool,
    ) -> Result<(), SpecError> {
        for entry in fixed.table()? {
            let known = Parameter::ALL.into_iter().filter(|p| !p.of_friction_law());
            let names = known.clone().filter(|p| takes(*p)).map(Parameter::name);
            let names: Vec<_> = names.collect();
            let parameter = known
                .into_iter()
                .find(|p| p.name() == entry.key)
                .ok_or_else(|| match Parameter::from_name(entry.key) {
                    Some(of_law) => entry.elsewhere(&format!(
                        "{} belongs in [friction], with a law",
                        of_law.name()
                    )),
                    None => entry.unknown(&names),
                })?;
            self.read_value(&entry, parameter)?;
        }
        Ok(())
    }

    /// Reads the table `[start]`: the start of a motion. The same parameters may stand in
    /// `[fixed]`.
    fn read_start(&mut self, start: &Entry) -> Result<(), SpecError> {
        for entry in start.table()? {
            let known = Parameter::from_name(entry.key).filter(|p| p.of_start());
            let parameter = known.ok_or_else(|| {
                let of_start = Parameter::ALL.into_iter().filter(|p| p.of_start());
                entry.unknown(&of_start.map(Parameter::name).collect::<Vec<_>>())
            })?;
            self.read_value(&entry, parameter)?;
        }
        Ok(())
    }

    /// Whether the start of a motion is given.
    pub(super) fn has_start(&self) -> bool {
        let mut of_start = Parameter::ALL.into_iter().filter(|p| p.of_start());
        of_start.any(|p| self.place(p).is_some())
    }

    /// Checks that a motion starts in a state or at a phase, not both.
    pub(super) fn check_start(&self) -> Result<(), SpecError> {
        self.met(two_starts(|parameter| self.place(parameter).is_some()))
    }

    fn read_value(&mut self, entry: &Entry, parameter: Parameter) -> Result<(), SpecError> {
        self.give(parameter, &entry.key_span)?;
        let value = self.units.number(entry, parameter.dimension())?;
        self.put(parameter, value, &entry.span)
    }

    /// Takes the value of a given parameter, which stands at `place`.
    fn put(
        &mut self,
        parameter: Parameter,
        value: f64,
        place: &Range<usize>,
    ) -> Result<(), SpecError> {
        parameter
            .check(value)
            .map_err(|e| SpecError::at(place.clone(), e.to_string()))?;
        self.values.push((parameter, value));
        Ok(())
    }

    /// Reads the table `[friction]`.
    fn read_friction(&mut self, friction: &Entry) -> Result<(), SpecError> {
        let of_laws = Parameter::ALL.into_iter().filter(|p| p.of_friction_law());
        let [law, table @ ..] = FRICTION_TABLE.map(|key| key.name);
        let known: Vec<_> = [law]
            .into_iter()
            .chain(of_laws.map(Parameter::name))
            .chain(table)
            .collect();
        let (mut law, mut fit) = (None, None);
        for entry in friction.table()? {
            if self.formula.take(&entry, &self.units)? {
                continue;
            }
            match Parameter::from_name(entry.key).filter(|p| p.of_friction_law()) {
                Some(parameter) => self.read_value(&entry, parameter)?,
                None if entry.key == "law" => law = Some(entry),
                None if entry.key == fit_errors::FIT => fit = Some(entry),
                None if self.table.read(&entry, &self.units)? => {}
                None => {
                    let of_formula = self.formula.unknown_key(&entry);
                    return Err(of_formula.unwrap_or_else(|| entry.unknown(&known)));
                }
            }
        }
        let missing = || SpecError::at(friction.key_span.clone(), "[friction] needs a law");
        let law = law.ok_or_else(missing)?;
        let kind = self.read_law(&law)?;
        let fit = fit.map(|fit| fit_keys::read(&fit, &kind)).transpose()?;
        self.fit_errors = fit.map(Arc::new);
        self.law = Some((kind, law.span.clone()));
        Ok(())
    }

    /// Reads the law named by `entry`, with its points if it is a table.
    fn read_law(&self, entry: &Entry) -> Result<LawKind, SpecError> {
        let name = entry.string()?;
        if name == LawKind::TABLE {
            return Ok(LawKind::Table(self.table.table(&entry.span)?));
        }
        if name == LawKind::FORMULA {
            return self.formula.law(entry);
        }
        let law = LawKind::named(name).map_err(|error| SpecError {
            help: error.help,
            ..entry.error(error.message)
        })?;
        self.table.check_none(name)?;
        Ok(law)
    }

    /// Checks that motions can be followed under the law, as far as the law alone decides this.
    pub(super) fn check_motions(&self) -> Result<(), SpecError> {
        self.met(self.law.as_ref().and_then(|(law, _)| no_motions(law)))
    }

    fn met(&self, unmet: Option<Unmet>) -> Result<(), SpecError> {
        unmet.map_or(Ok(()), |unmet| Err(self.unmet(unmet, None)))
    }

    /// The error of a need that is not met, at its place. `field` is the place of the field.
    pub(super) fn unmet(&self, unmet: Unmet, field: Option<&Range<usize>>) -> SpecError {
        let place = match unmet.at {
            ReportedAt::Field => field,
            ReportedAt::Law => self.law_place(),
            ReportedAt::Parameter(parameter) => self.place(parameter).or(field),
        };
        SpecError {
            span: place.cloned(),
            ..unmet.error
        }
    }

    /// An error of the model at its place, see [`GivenParameters::place_of`].
    pub(super) fn refused(&self, error: &ModelError) -> SpecError {
        let mu_s = Parameter::MuS;
        let said = self.place(mu_s).is_none().then(|| mu_s.default_value());
        SpecError {
            span: self.place_of(error).cloned(),
            ..SpecError::whole(error.with_default_mu_s(said.flatten()))
        }
    }

    /// The place at which an error of the model is reported: the value at rest of a table, the
    /// parameter that it names or from which that follows, else the name of the law. Where a fixed
    /// μ0 is above a given μ_S, the latter is to blame.
    fn place_of(&self, error: &ModelError) -> Option<&Range<usize>> {
        let at_rest = self.table.at_rest().or(self.formula.place());
        let named = Parameter::from_name(error.parameter);
        let fixed = |p: Parameter| self.values.iter().any(|(given, _)| *given == p);
        let mu_s = || match named {
            Some(p @ Parameter::Mu0) if fixed(p) => self.place(Parameter::MuS),
            _ => None,
        };
        // Without a value of its own it follows from the slope at rest.
        let slope = || match named {
            Some(Parameter::Mu0 | Parameter::VS) => self.place(Parameter::MuPrimeRest),
            _ => None,
        };
        let place = || named.and_then(|p| self.place(p));
        at_rest
            .filter(|_| error.parameter == TableColumn::MuK.name())
            .or_else(mu_s)
            .or_else(place)
            .or_else(slope)
            .or(self.law_place())
    }

    /// The place of the name of the friction law, if there is one.
    pub(super) fn law_place(&self) -> Option<&Range<usize>> {
        self.law.as_ref().map(|(_, place)| place)
    }

    /// The place of the key of a given parameter.
    pub(super) fn place(&self, parameter: Parameter) -> Option<&Range<usize>> {
        let found = self.places.iter().find(|(p, _)| *p == parameter);
        found.map(|(_, place)| place)
    }

    /// Every given parameter, with the place of its key, in the order of the file.
    pub(super) fn places(&self) -> impl Iterator<Item = &(Parameter, Range<usize>)> {
        self.places.iter()
    }

    /// A setting of the given values, checked as a point of sliding; parameters in `optional` may
    /// be left out.
    pub(super) fn sliding(&self, optional: &[Parameter]) -> Result<Setting, SpecError> {
        self.check(optional, None)?;
        let setting = self.setting();
        let open = optional
            .iter()
            .any(|p| self.place(*p).is_none() && *p != Parameter::Tau);
        match setting.sliding_point() {
            Err(error) if !open => Err(self.refused(&error)),
            _ => Ok(setting),
        }
    }

    /// A setting of the given values, and defaults for all others.
    pub(super) fn setting(&self) -> Setting {
        let mut setting = Setting::new(self.law.as_ref().map(|(law, _)| law.clone()));
        for (parameter, value) in &self.values {
            setting.set(*parameter, *value);
        }
        self.formula.fill(&mut setting);
        setting.fit_errors.clone_from(&self.fit_errors);
        setting
    }

    /// Checks that limits of actuators exclude nothing that has one value, and that nothing which
    /// has one contradicts the sample time. What is `optional` does not matter.
    fn check_limits(&self, optional: &[Parameter]) -> Result<(), SpecError> {
        let value = |p: Parameter| {
            if optional.contains(&p) {
                return f64::NAN;
            }
            let mut fixed = self.values.iter().filter(|(given, _)| *given == p);
            let default = self.place(p).is_none().then(|| p.default_value()).flatten();
            fixed
                .next()
                .map_or(default.unwrap_or(f64::NAN), |(_, value)| *value)
        };
        let excluding = Excluding::find(value, value).map(|found| found.unmet());
        self.met(excluding.or_else(|| NotSampled::find(value).map(|found| found.unmet())))
    }

    /// Checks that every needed parameter is given, and none that would be ignored. Parameters in
    /// `optional` may be left out. A missing one is reported at the friction law, or at `place`.
    pub(super) fn check(
        &self,
        optional: &[Parameter],
        place: Option<&Range<usize>>,
    ) -> Result<(), SpecError> {
        let law = self.law.as_ref().map(|(law, _)| law);
        let there = |p: Parameter| self.place(p).is_some() || optional.contains(&p);
        self.check_limits(optional)?;
        self.formula.check()?;
        Setting::check_given(law, there).map_err(|error| {
            let span = match error {
                GivenError::Unused(p) | GivenError::Follows(p) => self.place(p),
                GivenError::Missing(Parameter::V0) => self.law_place(),
                GivenError::Missing(p) if p.of_friction_law() => self.law_place(),
                GivenError::Missing(_) => place,
            };
            SpecError {
                message: error.message(law, Parameter::key),
                span: span.cloned(),
                help: Some(error.help(Parameter::key)),
            }
        })
    }
}
