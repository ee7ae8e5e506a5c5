//! Groups and datasets of a map or trace, written as they are described.

use hdf5::plist::group_create::LinkCreationOrder;
use hdf5::plist::link_create::CharEncoding;
use hdf5::{Dataset, Extents, Group, Location};

use super::attributes::{put, put_numbers};
use super::codec::DEFLATE_LEVEL;
use super::netcdf::{Dimensions, named};
use crate::sweep::described::{self, Described, Element, FILL_VALUE, Value, Variable};

/// Calls a macro with the type of an element.
macro_rules! of_element {
    ($element:expr, $of:ident) => {
        match $element {
            Element::I8 => $of!(i8),
            Element::I32 => $of!(i32),
            Element::I64 => $of!(i64),
            Element::U8 => $of!(u8),
            Element::U16 => $of!(u16),
            Element::F64 => $of!(f64),
        }
    };
}

/// How the elements of a dataset are stored.
pub(super) struct Layout {
    /// The length of each dimension.
    pub shape: Extents,
    /// The shape of compressed chunks; none where there are none.
    pub chunk: Option<Vec<usize>>,
    /// Whether single bytes are shuffled before they are compressed, as other elements are.
    pub shuffle_bytes: bool,
}

/// Creates a dataset. Known values are written, whatever the layout of others.
pub(super) fn create(group: &Group, variable: &Variable, layout: &Layout) -> hdf5::Result<Dataset> {
    let name = &*variable.name;
    let mut builder = named(group.new_dataset_builder());
    if !name.is_ascii() {
        builder = builder.char_encoding(CharEncoding::Utf8);
    }
    match variable.values.as_deref() {
        Some([value]) if variable.dimensions.is_empty() => {
            let dataset = builder.empty::<f64>().create(name)?;
            dataset.write_scalar(value)?;
            return Ok(dataset);
        }
        Some(values) => return builder.with_data(values).create(name),
        None => {}
    }
    if let Some(chunk) = &layout.chunk {
        let of_bytes = matches!(variable.element, Element::I8 | Element::U8);
        if layout.shuffle_bytes || !of_bytes {
            builder = builder.shuffle();
        }
        builder = builder.deflate(DEFLATE_LEVEL).chunk(chunk.clone());
    }
    macro_rules! make {
        ($kind:ty) => {{
            if let Some(fill) = variable.fill {
                builder = builder.fill_value(fill as $kind);
            }
            let builder = builder.empty::<$kind>().shape(layout.shape.clone());
            builder.create(name)
        }};
    }
    of_element!(variable.element, make)
}

/// Writes the attributes of a dataset, and makes it the scale of its dimension if it is one.
pub(super) fn describe(
    dataset: &Dataset,
    variable: &Variable,
    dimensions: &mut Dimensions,
) -> hdf5::Result<()> {
    for attribute in &variable.attributes {
        match attribute.value {
            Value::Dimensions => dimensions.attach(dataset, &variable.dimensions)?,
            _ => put(dataset, attribute)?,
        }
    }
    match variable.is_scale {
        true => dimensions.add(dataset.clone(), None),
        false => Ok(()),
    }
}

/// Writes attributes of a file or a group.
pub(super) fn put_all(at: &Location, attributes: &[described::Attribute]) -> hdf5::Result<()> {
    attributes
        .iter()
        .try_for_each(|attribute| put(at, attribute))
}

/// Creates a group, with its attributes and those of its dimensions that have no coordinates.
pub(super) fn create_group(
    parent: &Group,
    described: &Described,
    about: &described::Group,
    dimensions: &mut Dimensions,
) -> hdf5::Result<Group> {
    let group = parent
        .create_group_builder()
        .with_gcpl(|gcpl| {
            gcpl.obj_track_times(false)
                .link_creation_order(LinkCreationOrder::Indexed)
        })
        .create(about.name)?;
    put_all(&group, &about.attributes)?;
    let own = described
        .dimensions
        .iter()
        .filter(|of| of.group == about.name);
    for dimension in own.filter(|of| !of.coordinates) {
        dimensions.add_bare(&group, &dimension.name, dimension.length.unwrap_or(0))?;
    }
    Ok(group)
}

/// Writes the fill value of a dataset of integers in which an element is missing.
pub(super) fn put_fill(dataset: &Dataset, element: Element, fill: f64) -> hdf5::Result<()> {
    macro_rules! put {
        ($kind:ty) => {
            put_numbers(dataset, FILL_VALUE, &[fill as $kind])
        };
    }
    match element {
        Element::F64 => Ok(()),
        element => of_element!(element, put),
    }
}

/// Writes all elements of a dataset, given as reals that hold each of them exactly.
pub(super) fn write(dataset: &Dataset, element: Element, values: &[f64]) -> hdf5::Result<()> {
    macro_rules! write {
        ($kind:ty) => {{
            let values: Vec<$kind> = values.iter().map(|&value| value as $kind).collect();
            match values[..] {
                [value] if dataset.ndim() == 0 => dataset.write_scalar(&value),
                _ => dataset.write_raw(&values),
            }
        }};
    }
    of_element!(element, write)
}
