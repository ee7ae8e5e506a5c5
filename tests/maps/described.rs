//! What maps and traces say, against what the HDF5 library reads from the files.

use std::collections::BTreeSet;
use std::path::Path;

use crate::every_kind::{SWEEPS, plan};
use crate::map;
use hdf5::types::FixedUnicode;
use hdf5::{Attribute, Dataset, Location};
use slipmap::answers::Trace;
use slipmap::setting::CaseSpec;
use slipmap::store::{Output, trace_file};
use slipmap::sweep::described::root::Provenance;
use slipmap::sweep::described::{Described, Element, Group, Value, Variable};

/// What a file adds when its cells are known, and how HDF5 stores dimensions.
const ADDED: [&str; 14] = [
    "CLASS",
    "NAME",
    "_Netcdf4Dimid",
    "REFERENCE_LIST",
    "_FillValue",
    "chunks_sha256",
    "contents_sha256",
    "actual_range",
    "finite_range",
    "cells_infinite",
    "cells_without_value",
    "flag_cells",
    "cells_unflagged",
    "cells_missing",
];

fn is_of(dataset: &Dataset, element: Element) -> bool {
    let kind = dataset.dtype().unwrap();
    match element {
        Element::I8 => kind.is::<i8>(),
        Element::I32 => kind.is::<i32>(),
        Element::I64 => kind.is::<i64>(),
        Element::U8 => kind.is::<u8>(),
        Element::U16 => kind.is::<u16>(),
        Element::F64 => kind.is::<f64>(),
    }
}

/// More bytes than any text has here.
const LONGEST: usize = 1 << 14;

/// Whether an attribute has the type and the text or numbers that are described.
fn holds(attribute: &Attribute, value: &Value) -> bool {
    macro_rules! equal {
        ($kind:ty, $numbers:expr) => {{
            let read = attribute.read_raw::<$kind>().unwrap();
            let same = |a: &$kind, b: &$kind| a.to_le_bytes() == b.to_le_bytes();
            attribute.dtype().unwrap().is::<$kind>()
                && read.len() == $numbers.len()
                && read.iter().zip($numbers).all(|(a, b)| same(a, b))
        }};
    }
    match value {
        Value::Text(text) => {
            let read = attribute.read_scalar::<FixedUnicode<LONGEST>>();
            // With the null byte at the end.
            attribute.dtype().unwrap().size() == text.len() + 1 && read.unwrap().as_str() == text
        }
        Value::Dimensions => !attribute.shape().is_empty(),
        Value::I8(numbers) => equal!(i8, numbers),
        Value::I32(numbers) => equal!(i32, numbers),
        Value::U8(numbers) => equal!(u8, numbers),
        Value::U16(numbers) => equal!(u16, numbers),
        Value::U32(numbers) => equal!(u32, numbers),
        Value::U64(numbers) => equal!(u64, numbers),
        Value::F64(numbers) => equal!(f64, numbers),
    }
}

fn check_attributes(at: &Location, told: &[slipmap::sweep::described::Attribute], place: &str) {
    let mut left: BTreeSet<String> = at.attr_names().unwrap().into_iter().collect();
    for attribute in told {
        let name = attribute.name;
        assert!(left.remove(name), "{place} has no {name}");
        let read = at.attr(name).unwrap();
        assert!(holds(&read, &attribute.value), "{name} of {place}");
    }
    left.retain(|name| !ADDED.contains(&name.as_str()));
    assert!(left.is_empty(), "{place} also has {left:?}");
}

fn check_variable(group: &hdf5::Group, described: &Described, variable: &Variable) {
    let name = &variable.name;
    let dataset = group.dataset(name).unwrap();
    assert!(is_of(&dataset, variable.element), "{name}");
    assert_eq!(dataset.ndim(), variable.dimensions.len(), "{name}");
    for (length, &place) in dataset.shape().iter().zip(&variable.dimensions) {
        let told = described.dimensions[place].length;
        assert_eq!(*length, told.unwrap_or(*length), "{name}");
    }
    if let Some(values) = &variable.values {
        assert_eq!(dataset.read_raw::<f64>().unwrap(), *values, "{name}");
    }
    check_attributes(&dataset, &variable.attributes, name);
}

fn check(path: &Path, described: &Described) {
    let file = hdf5::File::open(path).unwrap();
    let mut left: BTreeSet<String> = file.member_names().unwrap().into_iter().collect();
    for Group {
        name,
        attributes,
        variables,
    } in &described.groups
    {
        let group = match name.is_empty() {
            true => file.group("/").unwrap(),
            false => file.group(name).unwrap(),
        };
        let path = |of: &str| match name.is_empty() {
            true => of.to_owned(),
            false => format!("{name}/{of}"),
        };
        if left.remove(*name) {
            let members = group.member_names().unwrap().into_iter();
            left.extend(members.map(|member| path(&member)));
        }
        check_attributes(&group, attributes, name);
        for variable in variables {
            check_variable(&group, described, variable);
            assert!(left.remove(&path(&variable.name)), "{}", variable.name);
        }
        for dimension in described.dimensions.iter().filter(|d| d.group == *name) {
            let own = left.remove(&path(&dimension.name));
            assert_eq!(own, !dimension.coordinates, "{}", dimension.name);
        }
    }
    assert!(left.is_empty(), "{left:?} is not described");
}

#[test]
fn maps_hold_what_is_described_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    for (number, text) in SWEEPS.iter().enumerate() {
        let (plan, path) = (plan(text), folder.path().join(format!("{number}.h5")));
        map::write(&plan, 2, &path);
        check(&path, &Described::of_map(&plan, &Provenance::default()));
    }
}

#[test]
fn a_trace_holds_what_is_described_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("trace.h5");
    let spec: CaseSpec = "horizon = 50\n[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n\
         [fixed]\nv0 = 0.35\nalpha_v = 0.0\ntau = 4.15\n[start]\nx_dot0 = 0.1\n"
        .parse()
        .unwrap();
    let trace = Trace::of(&spec).unwrap();
    assert!(!trace.events.is_empty());
    let provenance = Provenance::here("a test".into());
    let output = Output::claim(&path).unwrap();
    trace_file::write(&spec, &trace, output, &provenance).unwrap();
    map::settle(&path);
    check(&path, &Described::of_trace(&spec, &trace, &provenance));
}
