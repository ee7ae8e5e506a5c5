//! What addresses say behind the question mark.

use serde::de::Error;
use serde::{Deserialize, Deserializer};
use utoipa::IntoParams;

/// How a sweep is handed in.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
pub(super) struct SubmitQuery {
    /// Before all that wait.
    #[serde(default, deserialize_with = "flag")]
    pub first: bool,
    /// It does not begin until it is released.
    #[serde(default, deserialize_with = "flag")]
    pub hold: bool,
    /// What its name is made of; without it the title of the sweep.
    pub name: Option<String>,
}

/// What is to be told of the cost of a sweep.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
pub(super) struct CostQuery {
    /// Seconds too, from a timed sample.
    #[serde(default, deserialize_with = "flag")]
    pub timed: bool,
}

/// How a sweep is taken out.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
pub(super) struct DropQuery {
    /// What is computed of its map goes too, unless the map is complete.
    #[serde(default, deserialize_with = "flag")]
    pub tiles: bool,
}

/// A flag: its name alone says yes.
fn flag<'de, D: Deserializer<'de>>(from: D) -> Result<bool, D::Error> {
    match String::deserialize(from)?.as_str() {
        "" | "true" => Ok(true),
        "false" => Ok(false),
        other => Err(Error::custom(format!(
            "expected true or false, not {other}"
        ))),
    }
}
