//! A hash of everything in a map besides the cells themselves: axes, scalars, curves, best
//! settings, and what describes them.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};

use hdf5::{Dataset, File, Location};
use sha2::{Digest, Sha256};

use super::attributes::{numbers, text};
use super::open;
use super::values::{for_each_part, is_of};
use crate::sweep::described::schema::{BEST, BOUNDARIES, CHUNKS_SHA256, CONTENTS_SHA256, root};
use crate::text::in_hexadecimal;

/// Attributes that are not hashed: references to places in the file, the checksums, and when the
/// map was made.
const LEFT_OUT: [&str; 5] = [
    "DIMENSION_LIST",
    "REFERENCE_LIST",
    CHUNKS_SHA256,
    CONTENTS_SHA256,
    root::HISTORY,
];

/// The most attributes of an object: more than anything in a map has.
const MOST_ATTRIBUTES: usize = 64;

/// SHA-256, in hexadecimal, over every group and dataset, sorted by path. Each contributes its path
/// and attributes; a dataset that is not in `cells` also its shape and values.
///
/// # Errors
/// When something cannot be read, when the file has what no map has (other groups, nested groups,
/// links), or when `stop` is set.
pub(super) fn contents_hash(
    file: &File,
    cells: &[&str],
    stop: &AtomicBool,
) -> hdf5::Result<String> {
    let mut groups = vec![(String::new(), file.group("/")?)];
    for name in [BOUNDARIES, BEST] {
        if file.link_exists(name) {
            groups.push((format!("/{name}"), open::group(file, name)?));
        }
    }
    // Paths first, contents later: all contents together may be too large for memory.
    let mut parts = BTreeMap::new();
    for (path, group) in &groups {
        let own = if path.is_empty() { "/" } else { path };
        parts.insert(own.to_owned(), (group, None));
        for name in open::names(group)? {
            if !(path.is_empty() && [BOUNDARIES, BEST].contains(&&*name)) {
                parts.insert(format!("{path}/{name}"), (group, Some(name)));
            }
        }
    }
    let mut hash = Sha256::new();
    for (path, (group, name)) in parts {
        heed(stop)?;
        hash.update((path.len() as u64).to_le_bytes());
        hash.update(&path);
        match name {
            Some(name) => {
                let dataset = open::dataset(group, &name);
                let dataset = dataset.map_err(|why| format!("no map holds {name}: {why}"))?;
                let is_cells = cells.iter().any(|cell| path == format!("/{cell}"));
                add_dataset(&dataset, is_cells, &mut hash, stop)?;
            }
            None => add_part(&attributes(group)?, None, &mut hash, stop)?,
        }
    }
    Ok(in_hexadecimal(&hash.finalize()))
}

fn heed(stop: &AtomicBool) -> hdf5::Result<()> {
    match stop.load(Ordering::Relaxed) {
        true => Err("it was stopped".into()),
        false => Ok(()),
    }
}

fn add_dataset(
    dataset: &Dataset,
    is_cells: bool,
    hash: &mut Sha256,
    stop: &AtomicBool,
) -> hdf5::Result<()> {
    let mut head = attributes(dataset)?;
    if is_cells {
        return add_part(&head, None, hash, stop);
    }
    for length in dataset.shape() {
        head.extend((length as u64).to_le_bytes());
    }
    // Scales without coordinates have a length but no values.
    let values = (dataset.storage_size() > 0).then_some(dataset);
    add_part(&head, values, hash, stop)
}

/// Hashes a part: the length in bytes of all that follows, its attributes and shape, then its
/// values.
fn add_part(
    head: &[u8],
    values: Option<&Dataset>,
    hash: &mut Sha256,
    stop: &AtomicBool,
) -> hdf5::Result<()> {
    let bytes = match values {
        Some(dataset) => dataset.size().saturating_mul(dataset.dtype()?.size()),
        None => 0,
    };
    hash.update((head.len().saturating_add(bytes) as u64).to_le_bytes());
    hash.update(head);
    values.map_or(Ok(()), |dataset| add_values(dataset, hash, stop))
}

/// Names and values of all hashed attributes, sorted by name.
fn attributes(of: &Location) -> hdf5::Result<Vec<u8>> {
    let mut names = of.attr_names()?;
    if names.len() > MOST_ATTRIBUTES {
        return Err(format!("something with {} attributes", names.len()).into());
    }
    names.sort();
    let mut bytes = Vec::new();
    for name in names
        .iter()
        .filter(|name| !LEFT_OUT.contains(&name.as_str()))
    {
        bytes.extend(name.as_bytes());
        bytes.push(0);
        match text(of, name) {
            Ok(text) => bytes.extend(text.as_bytes()),
            Err(_) => bytes.extend(attribute_bytes(of, name)?),
        }
        bytes.push(0);
    }
    Ok(bytes)
}

macro_rules! by_type {
    ($kind:expr, $read:ident) => {{
        let kind = $kind;
        match () {
            () if is_of::<f64>(&kind) => $read!(f64),
            () if is_of::<f32>(&kind) => $read!(f32),
            () if is_of::<u8>(&kind) => $read!(u8),
            () if is_of::<u16>(&kind) => $read!(u16),
            () if is_of::<u32>(&kind) => $read!(u32),
            () if is_of::<u64>(&kind) => $read!(u64),
            () if is_of::<i8>(&kind) => $read!(i8),
            () if is_of::<i32>(&kind) => $read!(i32),
            () if is_of::<i64>(&kind) => $read!(i64),
            () => Err("a type that no map has".into()),
        }
    }};
}

fn attribute_bytes(of: &Location, name: &str) -> hdf5::Result<Vec<u8>> {
    let attribute = of.attr(name)?;
    macro_rules! read {
        ($kind:ty) => {{
            let values = numbers::<$kind>(&attribute)?;
            Ok(values.iter().flat_map(|v| v.to_le_bytes()).collect())
        }};
    }
    by_type!(attribute.dtype(), read)
}

fn add_values(dataset: &Dataset, hash: &mut Sha256, stop: &AtomicBool) -> hdf5::Result<()> {
    macro_rules! read {
        ($kind:ty) => {
            for_each_part::<$kind>(dataset, |values| {
                for value in values {
                    hash.update(value.to_le_bytes());
                }
                heed(stop)
            })
        };
    }
    by_type!(dataset.dtype(), read)
}
