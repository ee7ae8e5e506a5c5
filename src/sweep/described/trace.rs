//! A motion over time, with its events in a group of their own, and its outcome and parameters as
//! attributes and scalars.

use super::cells::{coordinates, scalars};
use super::root::{self, Provenance};
use super::schema::trace as names;
use super::{
    Attribute, DIMENSIONS, Dimension, Element, FILL_VALUE, Group, Variable, about, attribute, kinds,
};
use crate::answers::trace::{EVENTS, MODES, Sample, Trace, TraceEvent};
use crate::setting::case_file::CaseSpec;
use crate::setting::parameter::Parameter;
use crate::setting::units::Units;

/// The number of a mode or kind that stands for no value.
const FLAG_FILL: u8 = 255;

/// Bytes of a sample before compression: time, the quantities, the mode.
pub(crate) const BYTES_OF_A_SAMPLE: u64 = 8 * (1 + QUANTITIES.len() as u64) + 1;

/// A quantity of a motion, one for each sample.
pub struct Quantity {
    /// Name in files.
    pub name: &'static str,
    /// Its meaning, in words.
    pub long_name: &'static str,
    /// Powers of force, length and time in its unit.
    dimension: [i32; 3],
    /// Its value.
    of: fn(&Sample) -> f64,
}

impl Quantity {
    /// Its value at a sample.
    #[must_use]
    pub(crate) fn of(&self, sample: &Sample) -> f64 {
        (self.of)(sample)
    }

    /// Its unit, "1" where it has none.
    #[must_use]
    pub(crate) fn unit(&self, units: &Units) -> String {
        units.of(self.dimension)
    }
}

/// Time, over which the quantities are given.
pub(crate) const TIME: Quantity = Quantity {
    name: names::TIME,
    long_name: "time",
    dimension: [0, 0, 1],
    of: |s| s.t,
};

/// The quantities in the order of the file.
pub(crate) const QUANTITIES: [Quantity; 7] = [
    Quantity {
        name: "x",
        long_name: "position of the block",
        dimension: [0, 1, 0],
        of: |s| s.x,
    },
    Quantity {
        name: "x_dot",
        long_name: "velocity of the block",
        dimension: [0, 1, -1],
        of: |s| s.x_dot,
    },
    Quantity {
        name: "a",
        long_name: "elongation of the spring",
        dimension: [0, 1, 0],
        of: |s| s.a,
    },
    Quantity {
        name: "v",
        long_name: "pulling velocity",
        dimension: [0, 1, -1],
        of: |s| s.v,
    },
    Quantity {
        name: "N",
        long_name: "normal load",
        dimension: [1, 0, 0],
        of: |s| s.n,
    },
    Quantity {
        name: "pulling_force",
        long_name: "force of the spring, and of the dashpot beside it, on the block",
        dimension: [1, 0, 0],
        of: |s| s.pulling_force,
    },
    Quantity {
        name: "friction_force",
        long_name: "friction force on the block, positive backwards",
        dimension: [1, 0, 0],
        of: |s| s.friction_force,
    },
];

/// The dimensions of a trace.
pub(super) fn dimensions(trace: &Trace) -> Vec<Dimension> {
    vec![
        Dimension {
            group: "",
            name: TIME.name.to_owned(),
            length: Some(trace.samples.len()),
            coordinates: true,
        },
        Dimension {
            group: names::EVENT,
            name: names::EVENT.to_owned(),
            length: Some(trace.events.len()),
            coordinates: false,
        },
    ]
}

/// A variable over one dimension: reals, or the numbers of kinds.
fn over(
    dimension: usize,
    name: &str,
    element: Element,
    coordinates: Option<Attribute>,
) -> Variable {
    let (fill, told) = match element {
        Element::U8 => (f64::from(FLAG_FILL), attribute(FILL_VALUE, [FLAG_FILL])),
        _ => (f64::NAN, attribute(FILL_VALUE, [f64::NAN])),
    };
    let first = [told].into_iter().chain(coordinates);
    Variable {
        fill: Some(fill),
        attributes: first.chain([DIMENSIONS]).collect(),
        ..Variable::computed(name, element, vec![dimension])
    }
}

/// The root and the group of events.
pub(super) fn groups(spec: &CaseSpec, trace: &Trace, provenance: &Provenance) -> Vec<Group> {
    let (setting, units) = (&spec.setting, &spec.units);
    let told = Parameter::ALL.into_iter();
    let told = told.filter(|&p| setting.uses(p) && !p.of_start());
    let told: Vec<_> = told.map(|p| (p.into(), setting.get(p))).collect();
    let mut variables = scalars(&told, units);
    let coordinates = coordinates(&variables);
    variables.push(Variable {
        attributes: about(TIME.long_name, &TIME.unit(units)).into(),
        is_scale: true,
        ..Variable::known(TIME.name, vec![0], column(trace, TIME.of))
    });
    for quantity in &QUANTITIES {
        let mut variable = over(0, quantity.name, Element::F64, coordinates.clone());
        let about = about(quantity.long_name, &quantity.unit(units));
        variable.attributes.extend(about);
        variables.push(variable);
    }
    let mut mode = over(0, names::MODE, Element::U8, coordinates);
    let words = MODES.map(|(_, name)| name);
    mode.attributes.extend(kinds("what the block does", &words));
    variables.push(mode);
    let root = Group {
        name: "",
        attributes: root::of_trace(spec, trace, provenance),
        variables,
    };
    vec![root, events(units)]
}

fn events(units: &Units) -> Group {
    let real = |name, long_name, unit: &str| {
        let mut variable = over(1, name, Element::F64, None);
        variable.attributes.extend(about(long_name, unit));
        variable
    };
    let mut kind = over(1, names::KIND, Element::U8, None);
    let words = EVENTS.map(|(_, name)| name);
    kind.attributes.extend(kinds("what happens", &words));
    let elongation = "elongation of the spring then";
    let title = "events of the motion until its outcome was known, and to the end of the trace";
    Group {
        name: names::EVENT,
        attributes: vec![attribute("title", title)],
        variables: vec![
            real(names::TIME, "time of the event", &TIME.unit(units)),
            kind,
            real(names::ELONGATION, elongation, &units.of([0, 1, 0])),
        ],
    }
}

/// The values of the variables over time that are computed, one after the other.
pub(crate) fn columns(trace: &Trace) -> impl Iterator<Item = Vec<f64>> {
    let quantities = QUANTITIES.iter().map(|quantity| column(trace, quantity.of));
    let mode = |sample: &Sample| number(&MODES, &sample.mode);
    quantities.chain(std::iter::once_with(move || {
        trace.samples.iter().map(mode).collect()
    }))
}

/// The values of the variables of events.
#[must_use]
pub(crate) fn event_columns(events: &[TraceEvent]) -> [Vec<f64>; 3] {
    [
        events.iter().map(|event| event.t).collect(),
        events
            .iter()
            .map(|event| number(&EVENTS, &event.kind))
            .collect(),
        events.iter().map(|event| event.a).collect(),
    ]
}

fn column(trace: &Trace, of: fn(&Sample) -> f64) -> Vec<f64> {
    trace.samples.iter().map(of).collect()
}

/// The number of `value` among `all`.
fn number<T: PartialEq>(all: &[(T, &str)], value: &T) -> f64 {
    let place = all.iter().position(|(known, _)| known == value);
    place.map_or(f64::from(FLAG_FILL), |place| place as f64)
}
