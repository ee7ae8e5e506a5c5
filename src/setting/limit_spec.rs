//! A sweep of the limit of a short delay: γ, μ_K/μ_S and its own fields.

use std::ops::Range;

use super::field::Field;
use super::given::GivenParameters;
use super::parameter::Parameter;
use super::search::LIMIT;
use super::values::{GivenError, Setting};
use crate::text::toml_reader::{Entry, SpecError};

/// Keys at the top of a sweep file that are allowed in the limit.
const KEYS: [&str; 6] = ["title", "picture", "protocol", "fields", "axes", "fixed"];

/// Places of keys and fields that are allowed only in the limit, or only outside it.
#[derive(Default)]
pub(super) struct LimitDraft {
    /// The first key that is not allowed in the limit.
    foreign_key: Option<(String, Range<usize>)>,
    /// All requested fields.
    fields: Vec<(Field, Range<usize>)>,
}

impl LimitDraft {
    /// Records a key at the top of the file.
    pub(super) fn note_key(&mut self, entry: &Entry) {
        if self.foreign_key.is_none() && !KEYS.contains(&entry.key) {
            self.foreign_key = Some((entry.key.to_owned(), entry.key_span.clone()));
        }
    }

    /// Records the list of fields, which is already checked.
    pub(super) fn note_fields(&mut self, list: &Entry) -> Result<(), SpecError> {
        for element in list.array()? {
            if let Some(field) = Field::from_name(element.string()?) {
                self.fields.push((field, element.span));
            }
        }
        Ok(())
    }

    /// All requested fields, with their places.
    pub(super) fn fields(&self) -> impl Iterator<Item = &(Field, Range<usize>)> {
        self.fields.iter()
    }

    /// The first requested field of this kind, with its place.
    pub(super) fn first_field(&self, of: fn(Field) -> bool) -> Option<&(Field, Range<usize>)> {
        self.fields.iter().find(|(field, _)| of(*field))
    }

    /// The parameters of a sweep of the limit that are no axes. A missing one is reported at
    /// `axes`.
    pub(super) fn check(
        &self,
        given: &GivenParameters,
        axes: Option<&Range<usize>>,
    ) -> Result<Setting, SpecError> {
        let field = self.fields.iter().find(|(field, _)| !field.of_limit());
        let mut parameters = given.places();
        let parameter = parameters.find(|(parameter, _)| !parameter.of_limit());
        let foreign = self.foreign_key.as_ref();
        let foreign = foreign.map(|(key, place)| (key.as_str(), place));
        let foreign = foreign
            .or(field.map(|(field, place)| (field.name(), place)))
            .or(parameter.map(|(parameter, place)| (parameter.name(), place)));
        if let Some((name, place)) = foreign {
            return Err(no_meaning(name, place));
        }
        for parameter in Parameter::ALL.into_iter().filter(|p| p.of_limit()) {
            if given.place(parameter).is_none() {
                let error = GivenError::Missing(parameter);
                return Err(SpecError {
                    message: error.message(None, Parameter::key),
                    span: axes.cloned(),
                    help: Some(error.help(Parameter::key)),
                });
            }
        }
        let mut setting = given.setting();
        setting.set(Parameter::Tau, 0.0);
        Ok(setting)
    }

    /// Checks that no field of the limit is requested.
    pub(super) fn check_absent(&self) -> Result<(), SpecError> {
        match self.fields.iter().find(|(field, _)| field.of_limit()) {
            Some((field, place)) => {
                let message = format!("{} is a field of protocol = \"limit\"", field.name());
                Err(SpecError::at(place.clone(), message).help(
                    "protocol = \"limit\" asks for v_c as the delay vanishes; its parameters are \
                        gamma and mu_ratio",
                ))
            }
            None => Ok(()),
        }
    }
}

fn no_meaning(name: &str, place: &Range<usize>) -> SpecError {
    let protocol = LIMIT;
    let names: Vec<_> = Field::all_of_limit().map(Field::name).collect();
    let fields = names.join(", ");
    SpecError::at(
        place.clone(),
        format!("{name} has no meaning with protocol = \"{protocol}\""),
    )
    .help(format!(
        "the limit is Coulomb friction under load control as the delay vanishes; all it takes is \
        gamma, mu_ratio and the fields {fields}"
    ))
}
