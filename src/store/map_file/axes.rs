//! The axes of a map, and the system whose parameters they may be.

use std::path::Path;
use std::sync::Arc;

use hdf5::File;

use crate::setting::Parameter;
use crate::setting::axis::{Axis, MOST_POINTS};
use crate::setting::formula::GivenFormula;
use crate::setting::map_names::MOST_AXES;
use crate::setting::quantity::Quantity;
use crate::setting::system::SystemModel;
use crate::store::attributes::text;
use crate::store::error::StoreError;
use crate::store::open;
use crate::store::values::whole;
use crate::sweep::described::schema::root;
use crate::sweep::plan::MOST_CELLS;
use crate::text::SpecError;

/// An axis of a map.
#[derive(Debug, Clone, PartialEq)]
pub struct MapAxis {
    /// The parameter.
    pub parameter: Quantity,
    /// Its values.
    pub values: Vec<f64>,
    /// Its unit, "1" if dimensionless.
    pub unit: String,
}

/// Reads the axes, with the same checks as those of a sweep.
pub(super) fn read_axes(
    file: &File,
    system: Option<&SystemModel>,
    path: &Path,
) -> Result<Vec<MapAxis>, StoreError> {
    let names = text(file, root::AXES)
        .map_err(|_| StoreError::not_a_map(path, "it does not name its axes"))?;
    let formula = read_formula(file, path)?;
    let mut axes: Vec<MapAxis> = Vec::new();
    for name in names.split_whitespace() {
        let own = formula.as_ref().and_then(|formula| formula.own_named(name));
        let axis = match own {
            Some(own) => read_values(file, Quantity::Own(Arc::clone(own))).map(|axis| MapAxis {
                parameter: Quantity::Own(Arc::new(own.in_unit(&axis.unit))),
                ..axis
            }),
            None => read_axis(file, system, name),
        };
        let axis = axis.map_err(|why| StoreError::not_a_map(path, why))?;
        if axes.iter().any(|other| other.parameter == axis.parameter) {
            let why = format!("it names its axis {name} twice");
            return Err(StoreError::not_a_map(path, why));
        }
        axes.push(axis);
    }
    let lengths = axes.iter().map(|axis| axis.values.len() as u64);
    let cells = lengths.fold(1, u64::saturating_mul);
    if axes.is_empty() || axes.len() > MOST_AXES || cells > MOST_CELLS {
        let why = format!("it has {} axes and {cells} cells", axes.len());
        return Err(StoreError::not_a_map(path, why));
    }
    Ok(axes)
}

/// Reads the system of a file; none for the letter's.
pub(super) fn read_system(file: &File, path: &Path) -> Result<Option<SystemModel>, StoreError> {
    let Ok(text) = text(file, root::SYSTEM) else {
        return Ok(None);
    };
    let read = text.parse().map(Some);
    read.map_err(|error: SpecError| {
        StoreError::not_a_map(path, format!("its system is damaged: {error}"))
    })
}

/// Reads the formula of the friction law of a file; none of another law.
fn read_formula(file: &File, path: &Path) -> Result<Option<GivenFormula>, StoreError> {
    let Ok(text) = text(file, root::FRICTION_FORMULA) else {
        return Ok(None);
    };
    let read = GivenFormula::read(&text).map(Some);
    read.map_err(|error| {
        StoreError::not_a_map(path, format!("its friction law is damaged: {error}"))
    })
}

fn read_axis(file: &File, system: Option<&SystemModel>, name: &str) -> Result<MapAxis, String> {
    let unknown = || format!("it has an unknown axis {name}");
    let parameter = match system {
        Some(system) => system.quantity(name),
        None => Parameter::from_name(name).map(Quantity::from),
    };
    read_values(file, parameter.ok_or_else(unknown)?)
}

fn read_values(file: &File, parameter: Quantity) -> Result<MapAxis, String> {
    let name = parameter.name();
    let read = || -> hdf5::Result<(Vec<f64>, String)> {
        let dataset = open::dataset(file, name)?;
        match dataset.shape()[..] {
            [length] if length as u64 <= MOST_POINTS => {}
            _ => return Err("no axis has this shape".into()),
        }
        Ok((whole(&dataset)?, text(&dataset, "units")?))
    };
    let (values, unit) = read().map_err(|error| format!("its axis {name} is damaged: {error}"))?;
    let axis = Axis::new(parameter.clone(), values)
        .map_err(|error| format!("its axis {name} is damaged: {error}"))?;
    Ok(MapAxis {
        parameter,
        values: axis.values,
        unit,
    })
}
