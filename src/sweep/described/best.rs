//! The best settings in a map: one value per plane (gain, delay), over the axes outside of it.
//!
//! The group shares the dimensions of the map. The axes outside the planes stand in it once more,
//! as variables of the same names, so that readers which open one group alone have coordinates.

#[cfg(feature = "store")]
use serde::{Deserialize, Serialize};

use super::cells::about_parameter;
use super::schema::{BEST, BEST_FLAG_FILL, PLANE, best as names};
use super::{Attribute, DIMENSIONS, Element, FILL_VALUE, Group, Variable, about, attribute, flags};
use crate::answers::best::BestSettings;
use crate::linear::best::Kind;
use crate::setting::parameter::Parameter;
use crate::setting::quantity::Quantity;
use crate::setting::units::Units;
use crate::sweep::plan::Plan;

/// The best setting of one plane as the values of the group's variables; fill values where there is
/// none.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "store", derive(Serialize, Deserialize))]
pub(crate) struct BestRow {
    numbers: [f64; 5],
    flags: [i8; 2],
    regions: i32,
}

impl BestRow {
    /// The row of what was found in a plane.
    #[must_use]
    pub(crate) fn of(found: Option<&BestSettings>) -> Self {
        let Some(found) = found else {
            return Self {
                numbers: [f64::NAN; 5],
                flags: [BEST_FLAG_FILL; 2],
                regions: i32::from(BEST_FLAG_FILL),
            };
        };
        let best = &found.overall;
        let kind = Kind::ALL.iter().position(|&kind| kind == best.kind);
        Self {
            numbers: [
                best.p,
                best.q,
                best.abscissa,
                best.frequency(),
                best.relaxation_time().unwrap_or(f64::NAN),
            ],
            flags: [
                kind.map_or(BEST_FLAG_FILL, |kind| kind as i8),
                i8::from(best.certified),
            ],
            regions: (found.regions.len() + found.regions_left_out) as i32,
        }
    }

    /// The values of the variables that are computed, in the order of the group.
    pub(crate) fn values(&self) -> impl Iterator<Item = f64> {
        let numbers = self.numbers.into_iter();
        let flags = self.flags.map(f64::from).into_iter();
        numbers.chain(flags).chain([f64::from(self.regions)])
    }
}

/// A variable that is computed for every plane, over the axes `outer`.
fn variable(
    outer: &[usize],
    name: &str,
    element: Element,
    about: [Attribute; 2],
    flags: Option<[Attribute; 2]>,
) -> Variable {
    let fill = match element {
        Element::F64 => f64::NAN,
        _ => f64::from(BEST_FLAG_FILL),
    };
    let dimensions = (!outer.is_empty()).then_some(DIMENSIONS);
    let told = fill.is_nan().then(|| attribute(FILL_VALUE, [fill]));
    let attributes = dimensions.into_iter().chain(about);
    let attributes = attributes.chain(flags.into_iter().flatten()).chain(told);
    Variable {
        fill: Some(fill),
        attributes: attributes.collect(),
        ..Variable::computed(name, element, outer.to_vec())
    }
}

/// The variables of the best setting, in the order of [`BestRow::values`].
fn variables(outer: &[usize], gain: &Quantity, units: &Units) -> Vec<Variable> {
    let tau = Quantity::from(Parameter::Tau);
    let real = |name: &str, of: [Attribute; 2]| variable(outer, name, Element::F64, of, None);
    let flag = |name, of, kinds| variable(outer, name, Element::I8, of, Some(kinds));
    let frequency = "lowest frequency among the rightmost roots";
    let numbers: Vec<i8> = (0..).take(Kind::ALL.len()).collect();
    let words = Kind::ALL.map(|kind| kind.name().replace(' ', "_"));
    vec![
        real(gain.name(), about_parameter(gain, units)),
        real(tau.name(), about_parameter(&tau, units)),
        real(
            names::ABSCISSA,
            about("largest real part of a characteristic root", &units.rate()),
        ),
        real(
            names::FREQUENCY,
            about(frequency, &units.angular_frequency()),
        ),
        real(
            names::RELAXATION_TIME,
            about("relaxation time, where sliding is stable", &units.time()),
        ),
        flag(
            names::KIND,
            about("what makes the setting the best", "1"),
            flags(numbers.as_slice(), &words.join(" ")),
        ),
        flag(
            names::CERTIFIED,
            about("the argument principle confirms the abscissa", "1"),
            flags([0_i8, 1], "no yes"),
        ),
        variable(
            outer,
            names::REGIONS,
            Element::I32,
            about("number of stable regions", "1"),
            None,
        ),
    ]
}

/// The group for the planes of `plan` spanned by the axes `gain` and delay.
pub(super) fn group(plan: &Plan, (gain, tau): (usize, usize)) -> Group {
    let (axes, units) = (&plan.spec.axes, &plan.spec.units);
    let outer: Vec<usize> = (0..axes.len()).filter(|&a| a != gain && a != tau).collect();
    let coordinate = |&axis: &usize| {
        let of = &axes[axis];
        let [long_name, unit] = about_parameter(&of.parameter, units);
        Variable {
            attributes: vec![long_name, unit, DIMENSIONS],
            ..Variable::known(of.parameter.name(), vec![axis], of.values.clone())
        }
    };
    let coordinates = outer.iter().map(coordinate);
    let gain = &axes[gain].parameter;
    let title = "settings of fastest decay within the ranges of the gain and the delay";
    Group {
        name: BEST,
        attributes: vec![
            attribute("title", title),
            attribute(PLANE, format!("{} {}", gain.name(), Parameter::Tau.name())),
        ],
        variables: coordinates.chain(variables(&outer, gain, units)).collect(),
    }
}
