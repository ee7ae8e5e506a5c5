//! Sweeps and maps by the library alone: no test here starts a program, which would hold the locks
//! of the maps that others write.

#[path = "../common/every_kind.rs"]
mod every_kind;
#[path = "../common/map.rs"]
mod map;
#[path = "../common/winding.rs"]
mod winding;

mod cells;
mod described;
mod evaluate;
mod grid;
mod root_maps;
mod sweep_files;
