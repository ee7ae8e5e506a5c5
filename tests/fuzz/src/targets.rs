//! What is fuzzed: each target takes any bytes, and panics where something is not as it must be.

#[path = "map.rs"]
mod map;
#[path = "rows.rs"]
mod rows;
#[path = "texts.rs"]
mod texts;
#[path = "tiles.rs"]
mod tiles;

/// A target.
pub(crate) type Target = fn(&[u8]);

/// All targets by name.
pub(crate) const ALL: [(&str, Target); 6] = [
    ("sweep", texts::sweep),
    ("case", texts::case),
    ("manifest", texts::manifest),
    ("tiles", tiles::tiles),
    ("rows", rows::rows),
    ("map", map::map),
];
