//! Finished pieces of a sweep on disk, until the map is put together.
//!
//! Beside a map `MAP.h5` stands a folder `MAP.h5.tiles`, with a folder `I-of-N` in it for every
//! shard (`1-of-1`: the whole sweep). It holds a [`manifest`], a lock, and tile files
//! ([`mod@format`]), each closed, synced and renamed before the next one is begun: whatever ends a
//! run, what they hold is kept. A file holds the pieces of about two seconds.
//!
//! - `folder`: a shard's folder, claimed by the process that fills it
//! - `format`: the layout of a tile file
//! - `growing`: the tiles of a map that is still computed, as chunks of its columns
//! - `reader`: the tile files of a folder, checked and read
//! - `record`: a piece as bytes with a checksum, encoded on the computing threads
//! - `shards`: the folders of all shards of a map
//! - `survey`: what they hold, seen from outside

pub mod folder;
pub mod format;
pub mod growing;
pub mod manifest;
pub mod reader;
pub mod record;
pub mod shards;
pub mod survey;

pub use folder::TileFolder;
pub use growing::GrowingMap;
pub use manifest::Manifest;
pub use reader::{Damaged, TileReader};
pub use record::{Record, RecordEncoder};
pub use survey::Survey;
