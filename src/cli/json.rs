//! The output of commands with `--json`: one object that includes the inputs, and the schemas of
//! these objects.

use std::collections::BTreeMap;
use std::io::Write;

use crate::report::visible::visible_json;
use crate::setting::law_kind::LawKind;
use crate::setting::setting_text::of_point;
use crate::setting::units::Units;
use crate::setting::{Parameter, Setting};
use serde::{Serialize, Serializer};
use serde_json::{Map, Value, json};
use utoipa::ToSchema;
use utoipa::openapi::{RefOr, Schema};

use super::failure::Failure;

/// Version of the keys of the JSON output of all commands. It increases when a key is removed or
/// changes its meaning, but not for new keys. 2: `last_release` counts from switch-on. 3:
/// `stable_delays` and `crossings` are null where they are not known, no longer empty.
const SCHEMA_VERSION: u32 = 3;

/// An answer with the version of its keys and the inputs.
#[derive(Serialize)]
struct Answer<'a, T> {
    schema_version: u32,
    inputs: &'a Inputs,
    #[serde(flatten)]
    value: &'a T,
}

/// The inputs with defaults filled in: enough to repeat the request. Keys are those of flags, with
/// `_` instead of `-`.
#[derive(Debug, Clone, Default, Serialize)]
#[serde(transparent)]
pub(super) struct Inputs(Map<String, Value>);

impl Inputs {
    /// The `wanted` parameters of a setting, its friction law and its units.
    pub(super) fn of_setting(
        setting: &Setting,
        units: &Units,
        wanted: impl Fn(Parameter) -> bool,
    ) -> Self {
        let parameters = Parameter::ALL.into_iter();
        let parameters = parameters.filter(|&p| of_point(setting, p) && wanted(p));
        let mut inputs = Self::default();
        for parameter in parameters {
            inputs = inputs.and(parameter.name(), setting.get(parameter));
        }
        if let Some(law) = setting.law() {
            inputs = inputs.and("friction", law.name());
            if let LawKind::Formula(formula) = law {
                inputs = inputs.and("mu_k", formula.text());
                let own = setting.own().map(|(own, value)| (&*own.name, value));
                let set: BTreeMap<&str, f64> = own.collect();
                inputs = inputs.and("set", set);
            }
            if let LawKind::Table(points) = law {
                inputs = inputs.and("speeds", points.speeds());
                inputs = inputs.and("mu_k", points.mu_k());
            }
        }
        inputs.and("units", &units.force_length_time)
    }

    /// Adds an input.
    pub(super) fn and(mut self, name: &str, value: impl Serialize) -> Self {
        // Serialising numbers, texts and lists of them cannot fail.
        let value = serde_json::to_value(value).unwrap_or_default();
        self.0.insert(name.to_owned(), value);
        self
    }
}

/// Prints an answer as one JSON object on standard output.
pub(super) fn print(inputs: &Inputs, value: &impl Serialize) -> Result<(), Failure> {
    let answer = Answer {
        schema_version: SCHEMA_VERSION,
        inputs,
        value,
    };
    let text = serde_json::to_string(&answer).map_err(std::io::Error::from)?;
    let text = visible_json(&text);
    Ok(writeln!(std::io::stdout(), "{text}")?)
}

/// Serialises pairs of a name and a value as an object, in order. Words of a name are joined.
pub(super) fn as_object<S: Serializer, T: Serialize>(
    pairs: &[(impl AsRef<str>, T)],
    to: S,
) -> Result<S::Ok, S::Error> {
    to.collect_map(
        pairs
            .iter()
            .map(|(name, value)| (name.as_ref().replace(' ', "_"), value)),
    )
}

/// The JSON Schema (2020-12) of the output of a command: one of several kinds of answers.
pub(super) struct AnswerSchema {
    command: &'static str,
    answers: Vec<Value>,
    parts: BTreeMap<String, RefOr<Schema>>,
}

impl AnswerSchema {
    pub(super) fn of(command: &'static str) -> Self {
        Self {
            command,
            answers: Vec::new(),
            parts: BTreeMap::new(),
        }
    }

    /// Adds a type that an answer may have.
    pub(super) fn or<T: ToSchema>(mut self) -> Self {
        let mut parts = vec![(T::name().into_owned(), T::schema())];
        T::schemas(&mut parts);
        self.parts.extend(parts);
        let part = format!("#/components/schemas/{}", T::name());
        self.answers.push(json!({ "$ref": part }));
        self
    }

    /// The whole schema.
    pub(super) fn schema(&self) -> Value {
        json!({
            "$schema": "https://json-schema.org/draft/2020-12/schema",
            "title": format!("slipmap {} --json", self.command),
            "type": "object",
            "required": ["schema_version", "inputs"],
            "properties": {
                "schema_version": {
                    "description": "Version of the keys of all answers",
                    "const": SCHEMA_VERSION,
                },
                "inputs": {
                    "description": "What was asked, with defaults filled in; keys as in flags",
                    "type": "object",
                },
            },
            "oneOf": self.answers,
            "unevaluatedProperties": false,
            "components": { "schemas": self.parts },
        })
    }
}
