//! Coverage-guided fuzzing of the target that `SLIPMAP_FUZZ_TARGET` names, see `scripts/fuzz.sh`.

#![no_main]

mod memory;
mod targets;

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use targets::Target;

#[global_allocator]
static ALLOCATOR: memory::Capped = memory::Capped;

static TARGET: LazyLock<Target> = LazyLock::new(|| {
    let asked = std::env::var("SLIPMAP_FUZZ_TARGET").unwrap_or_default();
    let found = targets::ALL.into_iter().find(|(name, _)| *name == asked);
    let names = targets::ALL.map(|(name, _)| name).join(", ");
    found
        .unwrap_or_else(|| panic!("{asked:?} is no target; known: {names}"))
        .1
});

fuzz_target!(|data: &[u8]| TARGET(data));
