//! Maps for tests that look at what they hold.

#![allow(dead_code, reason = "no test uses all of it")]

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use hdf5::types::{FloatSize, IntSize, TypeDescriptor};
use hdf5::{Dataset, Group};
use slipmap::maps::maker::make_in_memory;
use slipmap::sweep::Plan;
use slipmap::sweep::described::root::Provenance;

/// Computes the map of a plan. A child that another test starts meanwhile holds the lock of what is
/// written for a moment, and then it is written again.
pub(crate) fn write(plan: &Plan, threads: usize, path: &Path) {
    let plan = Arc::new(plan.clone());
    let begun = Instant::now();
    while let Err(error) = make_in_memory(&plan, path, threads, &Provenance::default()) {
        assert!(begun.elapsed() < Duration::from_secs(20), "{error}");
        std::thread::sleep(Duration::from_millis(10));
    }
    settle(path);
}

/// Changes a file.
pub(crate) fn edit<T>(path: &Path, change: impl FnOnce(&hdf5::File) -> T) -> T {
    settle(path);
    let done = change(&hdf5::File::open_rw(path).unwrap());
    settle(path);
    done
}

/// Waits until a file that was open can be opened again: a child that another test started
/// meanwhile holds its lock too.
pub(crate) fn settle(path: &Path) {
    let file = std::fs::File::open(path).unwrap();
    file.lock().unwrap();
    // Not by closing it: a child may have inherited this one.
    file.unlock().unwrap();
}

/// The bytes of every dataset of a file, by name.
pub(crate) fn datasets(path: &Path) -> BTreeMap<String, Vec<u8>> {
    settle(path);
    let mut all = BTreeMap::new();
    collect(&hdf5::File::open(path).unwrap(), &mut all);
    all
}

fn collect(group: &Group, all: &mut BTreeMap<String, Vec<u8>>) {
    for dataset in group.datasets().unwrap() {
        all.insert(dataset.name(), bytes(&dataset));
    }
    for inner in group.groups().unwrap() {
        collect(&inner, all);
    }
}

fn bytes(dataset: &Dataset) -> Vec<u8> {
    macro_rules! raw {
        ($kind:ty) => {{
            let values = dataset.read_raw::<$kind>().unwrap();
            values.iter().flat_map(|v| v.to_le_bytes()).collect()
        }};
    }
    match dataset.dtype().unwrap().to_descriptor().unwrap() {
        TypeDescriptor::Float(FloatSize::U8) => raw!(f64),
        TypeDescriptor::Float(FloatSize::U4) => raw!(f32),
        TypeDescriptor::Unsigned(IntSize::U1) => raw!(u8),
        TypeDescriptor::Unsigned(IntSize::U2) => raw!(u16),
        TypeDescriptor::Integer(IntSize::U1) => raw!(i8),
        TypeDescriptor::Integer(IntSize::U4) => raw!(i32),
        TypeDescriptor::Integer(IntSize::U8) => raw!(i64),
        other => panic!("{} holds {other}", dataset.name()),
    }
}
