//! The axes of a map, its fixed parameters, its fields and the status.

use super::schema::{self, STATUS};
use super::{
    Attribute, DIMENSIONS, Dimension, Element, FILL_VALUE, Variable, about, attribute, kinds,
};
use crate::critical::switch_on::Phase;
use crate::linear::status::FLAGS;
use crate::setting::basin::{Basin, SCRAMBLINGS};
use crate::setting::field::{Field, Storage};
use crate::setting::quantity::Quantity;
use crate::setting::search::{Protocol, Search};
use crate::setting::units::Units;
use crate::sweep::cells::buffers::{FEW_FILL, N_UNSTABLE_FILL, STATUS_FILL};
use crate::sweep::plan::Plan;

/// The dimensions of the cells.
pub(super) fn dimensions(plan: &Plan) -> Vec<Dimension> {
    let axes = plan.spec.axes.iter();
    axes.map(|axis| Dimension {
        group: "",
        name: axis.parameter.name().to_owned(),
        length: Some(axis.len()),
        coordinates: true,
    })
    .collect()
}

/// The meaning and the unit of a parameter.
pub(super) fn about_parameter(parameter: &Quantity, units: &Units) -> [Attribute; 2] {
    about(parameter.long_name(), &parameter.unit(units))
}

/// Values of parameters as single numbers.
pub(super) fn scalars(scalars: &[(Quantity, f64)], units: &Units) -> Vec<Variable> {
    let scalar = |(parameter, value): &(Quantity, f64)| Variable {
        attributes: about_parameter(parameter, units).into(),
        ..Variable::known(parameter.name(), Vec::new(), vec![*value])
    };
    scalars.iter().map(scalar).collect()
}

/// The attribute that names `scalars`; none without them.
pub(super) fn coordinates(scalars: &[Variable]) -> Option<Attribute> {
    let names: Vec<&str> = scalars.iter().map(|scalar| &*scalar.name).collect();
    (!names.is_empty()).then(|| attribute("coordinates", names.join(" ")))
}

/// The axes, the fixed parameters, the fields and the status.
pub(super) fn variables(plan: &Plan) -> Vec<Variable> {
    let spec = &plan.spec;
    let axes = spec.axes.iter().enumerate();
    let mut variables: Vec<Variable> = axes
        .map(|(place, axis)| Variable {
            attributes: about_parameter(&axis.parameter, &spec.units).into(),
            is_scale: true,
            ..Variable::known(axis.parameter.name(), vec![place], axis.values.clone())
        })
        .collect();
    let scalars = scalars(&spec.scalars(), &spec.units);
    let first: Vec<Attribute> = coordinates(&scalars)
        .into_iter()
        .chain([DIMENSIONS])
        .collect();
    variables.extend(scalars);
    let over_cells = |name: &str, element: Element, fill: f64| Variable {
        fill: Some(fill),
        attributes: first.clone(),
        ..Variable::computed(name, element, (0..spec.axes.len()).collect())
    };
    for field in &spec.fields {
        let (element, fill) = match field.storage() {
            Storage::Count => (Element::U16, f64::from(N_UNSTABLE_FILL)),
            Storage::Kind | Storage::Few => (Element::U8, f64::from(FEW_FILL)),
            Storage::Real => (Element::F64, f64::NAN),
        };
        let mut variable = over_cells(field.name(), element, fill);
        variable.attributes.extend(of_field(plan, *field));
        variables.push(variable);
    }
    let mut status = over_cells(STATUS, Element::U8, f64::from(STATUS_FILL));
    status.attributes.extend(about("status of the cell", "1"));
    status.attributes.extend([
        attribute("flag_masks", FLAGS.map(|(mask, _)| mask)),
        attribute("flag_meanings", FLAGS.map(|(_, name)| name).join(" ")),
    ]);
    variables.push(status);
    variables
}

/// There is no `valid_max`: netCDF-3 has no unsigned type, and writers of it refuse 65534.
fn of_field(plan: &Plan, field: Field) -> Vec<Attribute> {
    let spec = &plan.spec;
    let mut attributes = Vec::new();
    if field.storage() == Storage::Real {
        attributes.push(attribute(FILL_VALUE, [f64::NAN]));
    }
    let (long_name, comment) = match spec.critical {
        Some(_) => field.described_at_vc(),
        None => (field.long_name(), field.comment()),
    };
    match field.kinds() {
        Some(names) => attributes.extend(kinds(long_name, &names)),
        None => attributes.push(attribute("long_name", long_name)),
    }
    attributes.push(attribute("units", field.unit(&spec.units)));
    attributes.extend(comment.map(|comment| attribute("comment", comment)));
    if let Some(search) = spec.critical.filter(|_| !field.of_sliding()) {
        attributes.extend(of_search(&search));
    }
    if let Some(basin) = spec.basin.filter(|_| field.of_basin()) {
        attributes.extend(of_basin(&basin));
    }
    attributes.push(attribute("ancillary_variables", STATUS));
    attributes
}

/// The options of the search for critical velocities.
fn of_search(search: &Search) -> Vec<Attribute> {
    let protocol = search.protocol;
    let mut attributes = vec![attribute(schema::vc::PROTOCOL, protocol.name())];
    if let Protocol::SwitchOn(Phase::Worst(phases)) = protocol {
        attributes.push(attribute(schema::vc::PHASES, [phases]));
    }
    let unit = "mu_s * normal_load / sqrt(stiffness * mass)";
    attributes.extend([
        attribute(schema::vc::V_MAX, [protocol.v_max()]),
        attribute(schema::vc::V_MAX_UNIT, unit),
        attribute(schema::vc::PRECISION, [protocol.precision()]),
    ]);
    attributes
}

/// Which starts the share is taken over.
fn of_basin(basin: &Basin) -> Vec<Attribute> {
    let mut attributes = vec![
        attribute(schema::basin::OVER, basin.over.name()),
        attribute(schema::basin::REGION, basin.described()),
        attribute(schema::basin::STARTS, [basin.starts]),
        attribute(schema::basin::SCRAMBLINGS, [SCRAMBLINGS]),
    ];
    let x_dot0 = basin
        .x_dot0
        .map(|range| attribute(schema::basin::X_DOT0, range));
    let a0 = basin.a0.map(|range| attribute(schema::basin::A0, range));
    attributes.extend(x_dot0.into_iter().chain(a0));
    attributes
}
