//! Finished pieces of a sweep on disk, until the map is put together.
//!
//! Beside a map `MAP.h5` stands a folder `MAP.h5.tiles`. It has a folder `I-of-N` for each shard,
//! or `1-of-1` for the whole sweep, with a `manifest`, a lock, and tile files ([`mod@format`]).
//! Each tile file is closed, synced and renamed before the next one is begun, so it outlasts any
//! end of the run. A file holds the pieces of about two seconds.
//!
//! - `done`: how much of a shard is computed
//! - `folder`: a shard's folder, claimed by the process that fills it
//! - `format`: the layout of a tile file
//! - `growing`: the tiles of a map that is still being computed, as chunks of its columns
//! - `reader`: the tile files of a folder, checked and read
//! - `record`: a piece as bytes with a checksum, encoded on the computing threads
//! - `shards`: the folders of all shards of a map
//! - `survey`: the contents of all shards, read without claiming them

pub mod done;
pub(crate) mod folder;
pub mod format;
pub(crate) mod growing;
pub(crate) mod manifest;
pub(crate) mod reader;
pub mod record;
pub mod shards;
pub mod survey;

pub use folder::TileFolder;
pub use growing::GrowingMap;
pub use manifest::Manifest;
pub use reader::{Damaged, TileReader};
pub use record::{Record, RecordEncoder};
pub use survey::Survey;
