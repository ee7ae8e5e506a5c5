//! Opens HDF5 files to read them, or says why not. An opened object leads to no other file, loads
//! no code, and takes no more memory than slipmap's own files do.

use std::ffi::{CStr, CString, c_char, c_int, c_uint, c_void};
use std::mem::MaybeUninit;
use std::path::Path;
use std::ptr::null_mut;
use std::sync::LazyLock;

use hdf5::plist::dataset_create::Layout;
use hdf5::{Dataset, File, Group};
use hdf5_sys::h5::{H5_index_t, H5_iter_order_t};
use hdf5_sys::h5i::hid_t;
#[allow(deprecated, reason = "libraries before 1.12 have no other")]
use hdf5_sys::h5l::H5Lget_info1;
use hdf5_sys::h5l::{H5L_info_t, H5L_info1_t, H5L_type_t, H5Literate, H5Lunregister};
use hdf5_sys::h5p::{H5P_DEFAULT, H5Pget_external_count, H5Pget_filter2, H5Pget_nfilters};
use hdf5_sys::h5pl::{H5PLremove, H5PLsize};
use hdf5_sys::h5z::{H5Z_FILTER_DEFLATE, H5Z_FILTER_SHUFFLE};

use super::error::StoreError;
use super::lock;
use super::regular;

/// The most bytes of a chunk: four times what slipmap writes. Larger chunks are refused.
const MOST_OF_CHUNK: usize = 8 << 20;
/// The most members of a group: several times what any map holds. Larger groups are refused.
const MOST_NAMES: usize = 1000;
/// The first bytes of a file of HDF5.
const SIGNATURE: [u8; 8] = *b"\x89HDF\r\n\x1a\n";
/// HDF5's number of the shuffle filter.
pub(super) const SHUFFLE: c_int = H5Z_FILTER_SHUFFLE;
/// HDF5's number of the deflate filter.
pub(super) const DEFLATE: c_int = H5Z_FILTER_DEFLATE;

unsafe extern "C" {
    /// The binding declares a pointer parameter, which the library's function does not have.
    fn H5PLset_loading_state(kinds: c_uint) -> i32;
}

/// Confines every call of the library to the opened file: it loads no filter plugins and follows no
/// external links.
static CONFINED: LazyLock<bool> = LazyLock::new(|| {
    hdf5::sync::sync(|| {
        // SAFETY: both functions take only numbers; the calls run under the library's lock.
        let kinds = unsafe {
            H5PLset_loading_state(0) >= 0 && H5Lunregister(H5L_type_t::H5L_TYPE_EXTERNAL) >= 0
        };
        kinds && no_plugin_is_found()
    })
});

/// Leaves no folder in which plugins are looked for: newer libraries load all that are there where
/// a file cannot be opened, whatever kinds may be loaded.
fn no_plugin_is_found() -> bool {
    let mut folders = 0;
    // SAFETY: the pointer is to a number that lives; the caller holds the library's lock.
    let counted = unsafe { H5PLsize(&raw mut folders) } >= 0;
    // SAFETY: the call takes a number alone, and there are still folders.
    counted && (0..folders).all(|_| unsafe { H5PLremove(0) } >= 0)
}

/// Whether the file begins with the signature of HDF5.
fn begins_as_hdf5(path: &Path) -> bool {
    let read = regular::head(path, SIGNATURE.len() as u64);
    read.is_ok_and(|head| head == SIGNATURE)
}

/// Opens the file at `path`. `refuse` makes the error for a file of the wrong kind, with the
/// reason.
pub(super) fn to_read(
    path: &Path,
    refuse: impl Fn(&Path, String) -> StoreError,
) -> Result<File, StoreError> {
    let metadata = std::fs::metadata(path).map_err(StoreError::io("open", path))?;
    if metadata.is_dir() {
        return Err(refuse(path, "it is a folder".into()));
    }
    if !metadata.is_file() {
        return Err(refuse(path, "it is no regular file".into()));
    }
    if path.to_str().is_none() {
        let why = "its name is not UTF-8, and HDF5 does not open it";
        return Err(refuse(path, why.into()));
    }
    regular::open(path).map_err(|not| StoreError::io("open", path)(not.into()))?;
    if !*CONFINED {
        let why = "the HDF5 library here cannot be kept from opening other files";
        return Err(refuse(path, why.into()));
    }
    // The library is given no file of another kind: reading some files of the system never ends.
    let opened = || match begins_as_hdf5(path) {
        true => File::open(path),
        false => Err("it is no HDF5 file".into()),
    };
    // The library locks the files that it writes. The lock may have been released a moment ago.
    let once_more = |refused| match lock::is_held(path) {
        true => Err(refused),
        false => opened(),
    };
    let file = opened().or_else(once_more).map_err(|_| {
        if lock::is_held(path) {
            return StoreError::InUse {
                path: path.to_owned(),
            };
        }
        match begins_as_hdf5(path) {
            true => StoreError::DamagedFile {
                path: path.to_owned(),
            },
            false => refuse(path, "it is no HDF5 file".into()),
        }
    })?;
    let root = file.group("/").and_then(|root| vet_group(&root));
    root.map_err(|why| refuse(path, why.to_string()))?;
    Ok(file)
}

/// Refuses a group whose names are compressed.
fn vet_group(group: &Group) -> hdf5::Result<()> {
    // The library would inflate the names itself, without a limit.
    match filters(group.create_plist()?.id())[..] {
        [] => Ok(()),
        _ => Err("the names in it are compressed".into()),
    }
}

/// Opens a group inside another, by its name.
///
/// # Errors
/// Where it is missing, in another place or file, or cannot be read.
pub(super) fn group(of: &Group, name: &str) -> hdf5::Result<Group> {
    refuse_links(of, name)?;
    let group = of.group(name)?;
    vet_group(&group)?;
    Ok(group)
}

/// Opens a dataset of a group, by its name.
///
/// # Errors
/// Where it is missing, in another place or file, or not stored as slipmap stores datasets.
pub(super) fn dataset(of: &Group, name: &str) -> hdf5::Result<Dataset> {
    refuse_links(of, name)?;
    let dataset = of.dataset(name)?;
    vet_dataset(&dataset).map_err(|why| format!("{name} {why}"))?;
    Ok(dataset)
}

fn refuse_links(group: &Group, name: &str) -> hdf5::Result<()> {
    if group.link_exists(name) && !is_hard(group, name) {
        return Err(format!("{name} is a link to something else").into());
    }
    Ok(())
}

/// The names in a group: links of all kinds, none of which is followed.
///
/// # Errors
/// Where there are more than in any map, or one is not UTF-8.
pub(super) fn names(group: &Group) -> hdf5::Result<Vec<String>> {
    let mut names: Vec<Option<String>> = Vec::new();
    let told = hdf5::sync::sync(|| {
        // SAFETY: the group is open, and `add_name` gets the vector that it expects. The native
        // order is deliberate: for any other, the library gathers all links first, and frees memory
        // that it never allocated where a link is damaged.
        unsafe {
            H5Literate(
                group.id(),
                H5_index_t::H5_INDEX_NAME,
                H5_iter_order_t::H5_ITER_NATIVE,
                null_mut(),
                Some(add_name),
                (&raw mut names).cast(),
            )
        }
    });
    if told < 0 {
        return Err("the names in a group cannot be read".into());
    }
    if names.len() > MOST_NAMES {
        return Err(format!("a group with more than {MOST_NAMES} members").into());
    }
    let names: Option<Vec<String>> = names.into_iter().collect();
    names.ok_or_else(|| "a name that is not UTF-8".into())
}

/// Adds a name, and ends the search where there are too many.
unsafe extern "C" fn add_name(
    _: hid_t,
    name: *const c_char,
    _: *const H5L_info_t,
    names: *mut c_void,
) -> c_int {
    // SAFETY: the library passes a null-terminated string and the pointer that it was given, which
    // points to a live vector.
    let (name, names) = unsafe {
        let names = names.cast::<Vec<Option<String>>>().as_mut();
        (CStr::from_ptr(name), names)
    };
    let Some(names) = names else {
        return -1;
    };
    names.push(name.to_str().ok().map(str::to_owned));
    c_int::from(names.len() > MOST_NAMES)
}

/// Whether a name stands for an object of this file itself, and is no link to one elsewhere.
fn is_hard(group: &Group, name: &str) -> bool {
    let Ok(name) = CString::new(name) else {
        return false;
    };
    #[allow(deprecated, reason = "libraries before 1.12 have no other")]
    let mut link = MaybeUninit::<H5L_info1_t>::zeroed();
    #[allow(deprecated, reason = "libraries before 1.12 have no other")]
    let asked = hdf5::sync::sync(|| {
        // SAFETY: the group is open, the name ends in a null byte, and the library fills in `link`.
        unsafe { H5Lget_info1(group.id(), name.as_ptr(), link.as_mut_ptr(), H5P_DEFAULT) }
    });
    // SAFETY: the kind is the first member. A file may hold kinds that the binding's enum lacks, so
    // it is read as a number.
    let kind = unsafe { link.as_ptr().cast::<c_int>().read() };
    asked >= 0 && kind == H5L_type_t::H5L_TYPE_HARD as c_int
}

/// The filters of the chunks of a dataset.
pub(super) fn filters_of(dataset: &Dataset) -> hdf5::Result<Vec<c_int>> {
    Ok(filters(dataset.create_plist()?.id()))
}

/// The filters that a property list names.
fn filters(plist: hid_t) -> Vec<c_int> {
    hdf5::sync::sync(|| {
        // SAFETY: the property list is open; results that are not needed get a null pointer or the
        // length 0.
        unsafe {
            let count = H5Pget_nfilters(plist).max(0);
            let filter = |number: c_int| {
                let (mut flags, mut values) = (0, 0);
                H5Pget_filter2(
                    plist,
                    number as c_uint,
                    &raw mut flags,
                    &raw mut values,
                    null_mut(),
                    0,
                    null_mut(),
                    null_mut(),
                )
            };
            (0..count).map(filter).collect()
        }
    })
}

/// Refuses a dataset that slipmap cannot have written, before anything in it is read.
fn vet_dataset(dataset: &Dataset) -> Result<(), String> {
    let damaged = |error: hdf5::Error| format!("cannot be read: {error}");
    if dataset.loc_info().map_err(damaged)?.num_links != 1 {
        return Err("stands under several names".into());
    }
    let plist = dataset.create_plist().map_err(damaged)?;
    // SAFETY: the property list is open.
    let outside = hdf5::sync::sync(|| unsafe { H5Pget_external_count(plist.id()) });
    if outside != 0 {
        return Err("has its values in another file".into());
    }
    match plist.get_layout().map_err(damaged)? {
        Layout::Compact | Layout::Contiguous => Ok(()),
        Layout::Virtual => Err("has its values in other datasets".into()),
        Layout::Chunked => {
            if !matches!(
                filters(plist.id())[..],
                [] | [DEFLATE | SHUFFLE] | [SHUFFLE, DEFLATE]
            ) {
                return Err("is stored by filters that slipmap does not use".into());
            }
            let chunk = plist.get_chunk().map_err(damaged)?.unwrap_or_default();
            if chunk.len() != dataset.ndim() {
                return Err("has chunks of another number of dimensions".into());
            }
            if !plist
                .get_chunk_opts()
                .map_err(damaged)?
                .is_none_or(|opts| opts.is_empty())
            {
                return Err("has chunks that are not compressed at the edges".into());
            }
            let element = dataset.dtype().map_err(damaged)?.size();
            let bytes = chunk.iter().copied().try_fold(element, usize::checked_mul);
            match bytes {
                Some(1..=MOST_OF_CHUNK) => Ok(()),
                _ => Err("has chunks of more bytes than slipmap writes".into()),
            }
        }
    }
}
