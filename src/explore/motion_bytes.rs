//! A motion as bytes, see [`super::encoded`].

use std::collections::BTreeMap;

use serde::Serialize;

use super::encoded::{Array, Arrays};
use super::motion::{Followed, MotionSummary};
use crate::answers::trace::{MODES, Sample};

/// The command that repeats the motion.
const SIMULATE: &str = "slipmap simulate case.toml";

/// What a motion says before its numbers. Where units are given, `unit_t` and so on tell those of
/// its arrays.
#[derive(Debug, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct MotionHead {
    #[serde(flatten)]
    summary: MotionSummary,
    #[serde(flatten)]
    #[cfg_attr(feature = "serve", schema(ignore))]
    units: BTreeMap<String, String>,
    /// Samples by their names.
    arrays: BTreeMap<&'static str, Array>,
    /// The names of the modes, by their numbers.
    modes: [&'static str; MODES.len()],
    /// What gives the same, with the text of the request in that file.
    command: &'static str,
    /// What it assumes of friction at velocities that were not measured; null where it assumes
    /// nothing.
    #[cfg_attr(feature = "serve", schema(required))]
    warning: Option<String>,
}

/// A quantity of samples.
struct Quantity {
    name: &'static str,
    /// Powers of force, length and time in its unit.
    dimension: [i32; 3],
    of: fn(&Sample) -> f64,
}

const QUANTITIES: [Quantity; 6] = [
    Quantity {
        name: "t",
        dimension: [0, 0, 1],
        of: |s| s.t,
    },
    Quantity {
        name: "x",
        dimension: [0, 1, 0],
        of: |s| s.x,
    },
    Quantity {
        name: "x_dot",
        dimension: [0, 1, -1],
        of: |s| s.x_dot,
    },
    Quantity {
        name: "a",
        dimension: [0, 1, 0],
        of: |s| s.a,
    },
    Quantity {
        name: "v",
        dimension: [0, 1, -1],
        of: |s| s.v,
    },
    Quantity {
        name: "N",
        dimension: [1, 0, 0],
        of: |s| s.n,
    },
];

/// The bytes of a motion.
///
/// # Errors
/// When its head cannot be written as JSON.
pub fn encoded(followed: &Followed) -> Result<Vec<u8>, serde_json::Error> {
    let (units, samples) = (&followed.spec.units, &followed.trace.samples);
    let mut arrays = Arrays::default();
    let mut heads: BTreeMap<_, _> = QUANTITIES
        .iter()
        .map(|quantity| (quantity.name, arrays.push(samples.iter().map(quantity.of))))
        .collect();
    let number = |sample: &Sample| MODES.iter().position(|(mode, _)| *mode == sample.mode);
    let modes: Vec<u8> = samples.iter().filter_map(number).map(|n| n as u8).collect();
    heads.insert("mode", arrays.push_runs(&modes));
    let named = |quantity: &Quantity| {
        let unit = units.of(quantity.dimension);
        (format!("unit_{}", quantity.name), unit)
    };
    let given = units.force_length_time.is_some();
    let head = MotionHead {
        summary: MotionSummary::of(&followed.trace),
        units: QUANTITIES.iter().filter(|_| given).map(named).collect(),
        arrays: heads,
        modes: MODES.map(|(_, name)| name),
        command: SIMULATE,
        warning: followed.beyond_curve(),
    };
    arrays.behind(&head)
}
