//! Attributes in the forms that every netCDF-4 reader understands.

use std::ffi::CString;

use hdf5::{H5Type, Location};
use hdf5_sys::h5a::{H5Aclose, H5Acreate2, H5Aread, H5Awrite};
use hdf5_sys::h5i::hid_t;
use hdf5_sys::h5p::H5P_DEFAULT;
use hdf5_sys::h5s::{H5S_class_t, H5Sclose, H5Screate};
use hdf5_sys::h5t::{
    H5T_class_t, H5T_cset_t, H5Tclose, H5Tcreate, H5Tget_class, H5Tis_variable_str, H5Tset_cset,
};

use super::values::{Number, is_of};
use crate::sweep::described::{Attribute, Value};

/// Writes a text attribute as a null-terminated string of fixed length.
///
/// The binding writes null-padded strings only. netCDF readers silently ignore those on dimension
/// scales.
pub(super) fn put_text(at: &Location, name: &str, text: &str) -> hdf5::Result<()> {
    let bytes = CString::new(text.replace('\0', " ")).map_err(|e| e.to_string())?;
    let name = CString::new(name).map_err(|e| e.to_string())?;
    let length = bytes.as_bytes_with_nul().len();
    hdf5::sync::sync(|| {
        // SAFETY: `at` is an open object, both strings end in a null byte and outlive the calls,
        // `length` counts the terminator, and every identifier is closed whatever happened; the
        // calls run under the library's lock.
        unsafe {
            let kind = H5Tcreate(H5T_class_t::H5T_STRING, length);
            H5Tset_cset(kind, H5T_cset_t::H5T_CSET_UTF8);
            let space = H5Screate(H5S_class_t::H5S_SCALAR);
            let attribute = H5Acreate2(
                at.id(),
                name.as_ptr(),
                kind,
                space,
                H5P_DEFAULT,
                H5P_DEFAULT,
            );
            let written = H5Awrite(attribute, kind, bytes.as_ptr().cast());
            let error = failure(&[kind, space, attribute], written);
            H5Aclose(attribute);
            H5Sclose(space);
            H5Tclose(kind);
            error
        }
    })
}

fn failure(identifiers: &[hid_t], result: i32) -> hdf5::Result<()> {
    if result < 0 || identifiers.iter().any(|&id| id < 0) {
        Err(hdf5::Error::query()?)
    } else {
        Ok(())
    }
}

/// Writes a numeric attribute of one or more values.
pub(super) fn put_numbers<T: H5Type>(at: &Location, name: &str, values: &[T]) -> hdf5::Result<()> {
    at.new_attr_builder().with_data(values).create(name)?;
    Ok(())
}

/// Writes an attribute as it is described. The dimensions of a variable are not written here.
pub(super) fn put(at: &Location, Attribute { name, value }: &Attribute) -> hdf5::Result<()> {
    match value {
        Value::Text(text) => put_text(at, name, text),
        Value::Dimensions => Ok(()),
        Value::I8(numbers) => put_numbers(at, name, numbers),
        Value::I32(numbers) => put_numbers(at, name, numbers),
        Value::U8(numbers) => put_numbers(at, name, numbers),
        Value::U16(numbers) => put_numbers(at, name, numbers),
        Value::U32(numbers) => put_numbers(at, name, numbers),
        Value::U64(numbers) => put_numbers(at, name, numbers),
        Value::F64(numbers) => put_numbers(at, name, numbers),
    }
}

/// The most bytes of an attribute: more than any that slipmap writes.
const MOST_BYTES: usize = 64 << 20;

/// Reads a text attribute of fixed length, as slipmap writes them. For strings of variable length
/// the library would trust the length that the file claims, so they are refused.
pub(super) fn text(at: &Location, name: &str) -> hdf5::Result<String> {
    let attribute = at.attr(name)?;
    let kind = attribute.dtype()?;
    // SAFETY: the type is open.
    let class = hdf5::sync::sync(|| unsafe { H5Tget_class(kind.id()) });
    let of_any_length = hdf5::sync::sync(|| unsafe { H5Tis_variable_str(kind.id()) });
    if class != H5T_class_t::H5T_STRING || of_any_length != 0 {
        return Err("a text attribute holds text of a fixed length".into());
    }
    if attribute.size() != 1 {
        return Err("a text attribute holds one string".into());
    }
    if kind.size() > MOST_BYTES {
        return Err(format!("a text attribute of {} bytes", kind.size()).into());
    }
    let mut bytes = vec![0_u8; kind.size()];
    let read = hdf5::sync::sync(|| {
        // SAFETY: the buffer holds one element of the attribute's own type.
        unsafe { H5Aread(attribute.id(), kind.id(), bytes.as_mut_ptr().cast()) }
    });
    failure(&[], read)?;
    let end = bytes.iter().position(|&b| b == 0).unwrap_or(bytes.len());
    utf8(&bytes[..end])
}

/// Reads an attribute of one number; none where it is missing or not one number of type `T`.
pub(super) fn one_number<T: Number>(at: &Location, name: &str) -> Option<T> {
    let attribute = at.attr(name).ok()?;
    match numbers(&attribute).ok()?[..] {
        [number] => Some(number),
        _ => None,
    }
}

/// Reads a numeric attribute that is stored as exactly the type `T`.
pub(super) fn numbers<T: Number>(attribute: &hdf5::Attribute) -> hdf5::Result<Vec<T>> {
    if !is_of::<T>(&attribute.dtype()) {
        return Err("an attribute of another type".into());
    }
    if attribute.size() > MOST_BYTES / size_of::<T>() {
        return Err(format!("an attribute of {} values", attribute.size()).into());
    }
    attribute.read_raw()
}

fn utf8(bytes: &[u8]) -> hdf5::Result<String> {
    let text = std::str::from_utf8(bytes).map_err(|e| e.to_string())?;
    Ok(text.to_owned())
}
