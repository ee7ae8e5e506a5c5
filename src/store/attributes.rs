//! Attributes in the forms that every netCDF-4 reader understands.

use std::ffi::CString;

use hdf5::{H5Type, Location};
use hdf5_sys::h5a::{H5Aclose, H5Acreate2, H5Awrite};
use hdf5_sys::h5i::hid_t;
use hdf5_sys::h5p::H5P_DEFAULT;
use hdf5_sys::h5s::{H5S_class_t, H5Sclose, H5Screate};
use hdf5_sys::h5t::{H5T_class_t, H5T_cset_t, H5Tclose, H5Tcreate, H5Tset_cset};

/// Writes a text attribute as a null-terminated string of fixed length.
///
/// The binding writes null-padded strings only, which netCDF readers pass over on dimension scales without a word.
pub(super) fn put_text(at: &Location, name: &str, text: &str) -> hdf5::Result<()> {
    let bytes = CString::new(text.replace('\0', " ")).map_err(|e| e.to_string())?;
    let name = CString::new(name).map_err(|e| e.to_string())?;
    let length = bytes.as_bytes_with_nul().len();
    hdf5::sync::sync(|| {
        // SAFETY: `at` is an open object, both strings end in a null byte and outlive the calls, `length` counts the
        // terminator, and every identifier is closed whatever happened; the calls run under the library's lock.
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

/// Describes a dataset of kinds, of which `names` are those with the numbers 0, 1, ….
pub(super) fn put_flags(at: &Location, long_name: &str, names: &[&str]) -> hdf5::Result<()> {
    let values: Vec<u8> = (0..names.len() as u8).collect();
    put_text(at, "long_name", long_name)?;
    put_numbers(at, "flag_values", &values)?;
    put_text(at, "flag_meanings", &names.join(" "))
}

/// More bytes than this are no text of slipmap's.
const MOST_TEXT: usize = 64 << 20;

/// Reads a text attribute of fixed or variable length.
pub(super) fn text(at: &Location, name: &str) -> hdf5::Result<String> {
    use hdf5::types::{TypeDescriptor, VarLenUnicode};
    let attribute = at.attr(name)?;
    let kind = attribute.dtype()?.to_descriptor()?;
    if attribute.size() != 1 {
        return Err("a text attribute holds one string".into());
    }
    match kind {
        TypeDescriptor::FixedAscii(_) | TypeDescriptor::FixedUnicode(_) => fixed_text(&attribute),
        TypeDescriptor::VarLenAscii | TypeDescriptor::VarLenUnicode => {
            let text = attribute.read_raw::<VarLenUnicode>()?;
            // The binding takes the pointer for a string, and the bytes for UTF-8; neither is known of a file.
            match text.first().filter(|text| !text.as_ptr().is_null()) {
                Some(text) => utf8(text.as_bytes()),
                None => Err("a text attribute holds no string".into()),
            }
        }
        _ => Err("a text attribute holds text".into()),
    }
}

/// Reads a string of fixed length; the binding's own fixed strings have theirs in the type.
fn fixed_text(attribute: &hdf5::Attribute) -> hdf5::Result<String> {
    let kind = attribute.dtype()?;
    if kind.size() > MOST_TEXT {
        return Err(format!("a text attribute of {} bytes", kind.size()).into());
    }
    let mut bytes = vec![0_u8; kind.size()];
    let read = hdf5::sync::sync(|| {
        // SAFETY: the buffer holds one element of the attribute's own type.
        unsafe { hdf5_sys::h5a::H5Aread(attribute.id(), kind.id(), bytes.as_mut_ptr().cast()) }
    });
    failure(&[], read)?;
    let end = bytes.iter().position(|&b| b == 0).unwrap_or(bytes.len());
    utf8(&bytes[..end])
}

fn utf8(bytes: &[u8]) -> hdf5::Result<String> {
    let text = std::str::from_utf8(bytes).map_err(|e| e.to_string())?;
    Ok(text.to_owned())
}
