//! What a file says of itself: who made it, the sweep, the friction law, parameters.

use hdf5::{Dataset, File};

use super::attributes::{put_numbers, put_text};
use super::netcdf::named;
use super::schema::{self, root};
use crate::critical::switch_on::Phase;
use crate::sweep::input::basin::{Basin, SCRAMBLINGS};
use crate::sweep::input::law_kind::LawKind;
use crate::sweep::input::quantity::Quantity;
use crate::sweep::input::search::{LIMIT, Protocol, Search};
use crate::sweep::input::units::Units;
use crate::sweep::{Plan, Setting};

/// Who made a map, for its root attributes.
#[derive(Debug, Clone, Default)]
pub struct Provenance {
    /// Version of the program.
    pub program_version: String,
    /// Git revision of the program.
    pub git_revision: String,
    /// When and by which command; the one thing in a map that differs from run to run.
    pub history: String,
}

/// The root attributes of every file: title and who made it.
pub(super) fn put_provenance(
    file: &File,
    title: &str,
    provenance: &Provenance,
) -> hdf5::Result<()> {
    put_text(file, "Conventions", schema::CONVENTIONS)?;
    put_text(file, root::TITLE, title)?;
    let source = format!("slipmap {}", provenance.program_version);
    put_text(file, root::SOURCE, &source)?;
    put_text(file, root::HISTORY, &provenance.history)?;
    put_text(
        file,
        "references",
        "F.-J. Elmer, Controlling friction (1997)",
    )?;
    put_text(file, root::PROGRAM_VERSION, &provenance.program_version)?;
    put_text(file, root::GIT_REVISION, &provenance.git_revision)
}

pub(super) fn put_root(file: &File, plan: &Plan, provenance: &Provenance) -> hdf5::Result<()> {
    let names: Vec<&str> = plan.spec.axes.iter().map(|a| a.parameter.name()).collect();
    put_provenance(file, &plan.spec.title, provenance)?;
    put_numbers(file, root::FORMAT_VERSION, &[schema::FORMAT_VERSION])?;
    put_text(file, root::AXES, &names.join(" "))?;
    put_text(file, root::PLAN_HASH, &plan.hash())?;
    put_text(file, root::SWEEP, &plan.spec.text)?;
    if plan.spec.simulation.disturbance != 0.0 {
        let disturbance = plan.spec.simulation.disturbance;
        put_numbers(file, root::DISTURBANCE, &[disturbance])?;
    }
    put_numbers(file, root::MARGINAL_TOLERANCE, &[plan.spec.tolerance.0])?;
    if plan.spec.limit {
        put_text(file, root::PROTOCOL, LIMIT)?;
    }
    put_friction(file, &plan.spec.fixed)
}

/// Writes what the scalar coordinates leave out: the system, and the friction law with its table.
pub(super) fn put_friction(file: &File, setting: &Setting) -> hdf5::Result<()> {
    if let Some(system) = setting.system() {
        put_text(file, root::SYSTEM, &system.to_toml())?;
    }
    let Some(law) = setting.law() else {
        return Ok(());
    };
    put_text(file, root::FRICTION_LAW, law.name())?;
    if let LawKind::Table(table) = law {
        put_numbers(file, root::FRICTION_SPEEDS, table.speeds())?;
        put_numbers(file, root::FRICTION_MU_K, table.mu_k())?;
    }
    Ok(())
}

/// Values of parameters as scalar coordinates. Returns their names.
pub(super) fn put_scalars(
    file: &File,
    scalars: &[(Quantity, f64)],
    units: &Units,
) -> hdf5::Result<String> {
    let mut names = Vec::new();
    for (parameter, value) in scalars {
        let dataset = named(file.new_dataset_builder())
            .empty::<f64>()
            .create(parameter.name())?;
        dataset.write_scalar(value)?;
        describe_parameter(&dataset, parameter, units)?;
        names.push(parameter.name());
    }
    Ok(names.join(" "))
}

pub(super) fn describe_parameter(
    dataset: &Dataset,
    parameter: &Quantity,
    units: &Units,
) -> hdf5::Result<()> {
    put_text(dataset, "long_name", parameter.long_name())?;
    put_text(dataset, "units", &parameter.unit(units))
}

/// Writes the options of the search for critical velocities.
pub(super) fn put_search(dataset: &Dataset, search: &Search) -> hdf5::Result<()> {
    let protocol = search.protocol;
    put_text(dataset, schema::vc::PROTOCOL, protocol.name())?;
    if let Protocol::SwitchOn(Phase::Worst(phases)) = protocol {
        put_numbers(dataset, schema::vc::PHASES, &[phases])?;
    }
    put_numbers(dataset, schema::vc::V_MAX, &[protocol.v_max()])?;
    let unit = "mu_s * normal_load / sqrt(stiffness * mass)";
    put_text(dataset, schema::vc::V_MAX_UNIT, unit)?;
    put_numbers(dataset, schema::vc::PRECISION, &[protocol.precision()])
}

/// Writes which starts the share is taken over.
pub(super) fn put_basin(dataset: &Dataset, basin: &Basin) -> hdf5::Result<()> {
    put_text(dataset, schema::basin::OVER, basin.over.name())?;
    put_text(dataset, schema::basin::REGION, &basin.described())?;
    put_numbers(dataset, schema::basin::STARTS, &[basin.starts])?;
    put_numbers(dataset, schema::basin::SCRAMBLINGS, &[SCRAMBLINGS])?;
    let ranges = [
        (schema::basin::X_DOT0, basin.x_dot0),
        (schema::basin::A0, basin.a0),
    ];
    for (name, range) in ranges {
        if let Some(range) = range {
            put_numbers(dataset, name, &range)?;
        }
    }
    Ok(())
}
