//! A hash of everything in a map besides the cells themselves: axes, scalars, curves, best settings, and what describes them.

use std::collections::BTreeMap;

use hdf5::types::{FloatSize, IntSize, TypeDescriptor};
use hdf5::{Dataset, File, Group, Location};
use sha2::{Digest, Sha256};

use super::attributes::text;
use super::map_file::whole;
use super::schema::{CHUNKS_SHA256, CONTENTS_SHA256, root};
use crate::sweep::plan::in_hexadecimal;

/// Attributes that are no part of it: references to places in the file, the checksums, and when the map was made.
const LEFT_OUT: [&str; 5] = [
    "DIMENSION_LIST",
    "REFERENCE_LIST",
    CHUNKS_SHA256,
    CONTENTS_SHA256,
    root::HISTORY,
];

/// SHA-256, in hexadecimal, over every group and dataset, sorted by name: name, attributes, and for datasets that are not
/// `cells` shape and values.
///
/// # Errors
/// When something cannot be read.
pub(super) fn contents_hash(file: &File, cells: &[&str]) -> hdf5::Result<String> {
    let mut parts = BTreeMap::new();
    parts.insert("/".to_owned(), attributes(file)?);
    collect(file, file, cells, &mut parts)?;
    let mut hash = Sha256::new();
    for (name, part) in parts {
        hash.update((name.len() as u64).to_le_bytes());
        hash.update(name);
        hash.update((part.len() as u64).to_le_bytes());
        hash.update(part);
    }
    Ok(in_hexadecimal(&hash.finalize()))
}

fn collect(
    file: &File,
    group: &Group,
    cells: &[&str],
    parts: &mut BTreeMap<String, Vec<u8>>,
) -> hdf5::Result<()> {
    for dataset in group.datasets()? {
        let mut part = attributes(&dataset)?;
        let name = dataset.name();
        if !cells.contains(&name.trim_start_matches('/')) {
            for length in dataset.shape() {
                part.extend((length as u64).to_le_bytes());
            }
            part.extend(values(file, &dataset)?);
        }
        parts.insert(name, part);
    }
    for inner in group.groups()? {
        parts.insert(inner.name(), attributes(&inner)?);
        collect(file, &inner, cells, parts)?;
    }
    Ok(())
}

/// Names and values of all attributes that count, by name.
fn attributes(of: &Location) -> hdf5::Result<Vec<u8>> {
    let mut names = of.attr_names()?;
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
            Err(_) => bytes.extend(numbers(of, name)?),
        }
        bytes.push(0);
    }
    Ok(bytes)
}

macro_rules! by_type {
    ($descriptor:expr, $read:ident) => {
        match $descriptor {
            TypeDescriptor::Float(FloatSize::U8) => $read!(f64),
            TypeDescriptor::Float(FloatSize::U4) => $read!(f32),
            TypeDescriptor::Unsigned(IntSize::U1) => $read!(u8),
            TypeDescriptor::Unsigned(IntSize::U2) => $read!(u16),
            TypeDescriptor::Unsigned(IntSize::U4) => $read!(u32),
            TypeDescriptor::Unsigned(IntSize::U8) => $read!(u64),
            TypeDescriptor::Integer(IntSize::U1) => $read!(i8),
            TypeDescriptor::Integer(IntSize::U4) => $read!(i32),
            TypeDescriptor::Integer(IntSize::U8) => $read!(i64),
            other => Err(format!("a type that no map has: {other}").into()),
        }
    };
}

fn numbers(of: &Location, name: &str) -> hdf5::Result<Vec<u8>> {
    /// More numbers than this are in no attribute.
    const MOST: usize = 1 << 24;
    let attribute = of.attr(name)?;
    if attribute.size() > MOST {
        return Err(format!("{name} has {} values", attribute.size()).into());
    }
    macro_rules! read {
        ($kind:ty) => {{
            let values = attribute.read_raw::<$kind>()?;
            Ok(values.iter().flat_map(|v| v.to_le_bytes()).collect())
        }};
    }
    by_type!(attribute.dtype()?.to_descriptor()?, read)
}

fn values(file: &File, dataset: &Dataset) -> hdf5::Result<Vec<u8>> {
    // Scales without coordinates have a length and nothing else.
    if dataset.storage_size() == 0 {
        return Ok(Vec::new());
    }
    macro_rules! read {
        ($kind:ty) => {{
            let values = whole::<$kind>(file, dataset)?;
            Ok(values.iter().flat_map(|v| v.to_le_bytes()).collect())
        }};
    }
    by_type!(dataset.dtype()?.to_descriptor()?, read)
}
