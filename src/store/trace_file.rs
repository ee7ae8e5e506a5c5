//! Writes traces: a motion over time, with its events in a group of their own, and its outcome and
//! parameters as attributes and scalars.

use hdf5::{File, Group};

use super::error::StoreError;
use super::map_writer::create_file;
use super::netcdf::Dimensions;
use super::output::Output;
use super::variables::{Layout, create, create_group, describe, put_all, write as write_values};
use crate::answers::Trace;
use crate::setting::CaseSpec;
use crate::sweep::described::root::Provenance;
use crate::sweep::described::{self, Described, trace};

/// Elements in a chunk.
const CHUNK: usize = 1 << 13;

/// Writes a trace under a temporary name and gives it its final one.
///
/// # Errors
/// When the system or the library refuses. The final name then has what it had before.
pub fn write(
    spec: &CaseSpec,
    trace: &Trace,
    output: Output,
    provenance: &Provenance,
) -> Result<(), StoreError> {
    let path = output.path().to_owned();
    let fill = || -> hdf5::Result<()> {
        let file = create_file(output.part())?;
        fill_file(&file, &Described::of_trace(spec, trace, provenance), trace)?;
        file.flush()?;
        file.close()
    };
    fill().map_err(StoreError::hdf5("write", &path))?;
    output.commit()
}

fn fill_file(file: &File, described: &Described, found: &Trace) -> hdf5::Result<()> {
    let mut dimensions = Dimensions::default();
    let [root, events] = &described.groups[..] else {
        return Err("a trace has a group of events".into());
    };
    put_all(file, &root.attributes)?;
    fill_group(
        file,
        described,
        root,
        trace::columns(found),
        &mut dimensions,
    )?;
    let group = create_group(file, described, events, &mut dimensions)?;
    let columns = trace::event_columns(&found.events).into_iter();
    fill_group(&group, described, events, columns, &mut dimensions)?;
    dimensions.finish()
}

/// Writes the variables of a group; `computed` are the values of those that are computed.
fn fill_group(
    group: &Group,
    described: &Described,
    about: &described::Group,
    mut computed: impl Iterator<Item = Vec<f64>>,
    dimensions: &mut Dimensions,
) -> hdf5::Result<()> {
    for variable in &about.variables {
        let shape = described.shape(variable);
        let layout = Layout {
            chunk: Some(shape.iter().map(|&n| CHUNK.min(n.max(1))).collect()),
            shape: shape.into(),
            shuffle_bytes: true,
        };
        let dataset = create(group, variable, &layout)?;
        if variable.values.is_none() {
            let values = computed.next().unwrap_or_default();
            if !values.is_empty() {
                write_values(&dataset, variable.element, &values)?;
                // Data still in the cache when the dataset is closed are silently lost where the
                // system refuses to write them.
                group.file()?.flush()?;
            }
        }
        describe(&dataset, variable, dimensions)?;
    }
    Ok(())
}
