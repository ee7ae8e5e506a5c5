//! Maps and traces on disk: HDF5 files that netCDF-4 readers open with named coordinates. The only
//! place that knows HDF5. What they say is described in [`crate::sweep::described`].
//!
//! - [`tiles`]: finished pieces of a sweep in files of their own, checked when they are read
//! - `map_writer`: the map's file, under a temporary name until it is complete
//! - `map_file`: reads maps
//! - [`trace_file`]: writes motions sampled over time, and recognises them
//! - `output`: the temporary name, the lock, the final rename
//! - `attributes`: attributes in the forms that every netCDF-4 reader understands
//! - `best_reader`: reads the best settings of a map
//! - `best_writer`: writes the best settings of every plane
//! - `boundary_writer`: writes curves, plane by plane
//! - `cell_blocks`: reads cells in the order of the axes, block by block
//! - `chunk_layout`: how chunks are stored, and how to decode them; a chunk is inflated to its own
//!   size and no further
//! - `codec`: HDF5's shuffle and deflate on the computing threads
//! - `columns`: the columns of a map, chunk by chunk as stored in the file
//! - `contents_hash`: a hash of everything in a map besides its cells
//! - `curve_reader`: reads the crossing curves of a map
//! - `durable`: files written whole, synced and renamed
//! - `error`: why a map or trace could not be written or read, with the file's name and the cause
//! - `lock`: locks that end with the process that holds them
//! - `map_summary`: ranges and counts, from a map's attributes or from all its cells
//! - `netcdf`: dimension scales as netCDF-4 readers expect them
//! - `open`: the only way to open HDF5 files and their objects; it refuses links to other files,
//!   filter plugins and foreign storage
//! - `picked`: the indices that a hyperslab picks along one axis
//! - `regular`: opens regular files, and no others, for all of slipmap
//! - `sample`: which cells are checked by a second method: some of every outcome by every method
//! - `seal`: a checksum of all bytes of a map, appended to the file
//! - `soundness`: whether a map's file is as it was written: schema, checksums
//! - `source`: where the pieces of a map come from; pieces in memory
//! - `stamp`: the length, time and node of a file, to detect changes
//! - `summary`: ranges of fields, counts of kinds and flags, read from
//!   attributes
//! - `trace_reader`: recognises traces and reads them
//! - `values`: reads values, chunk by chunk
//! - `variables`: groups and datasets, written as they are described

mod attributes;
mod best_reader;
mod best_writer;
mod boundary_writer;
pub(crate) mod cell_blocks;
pub mod chunk_layout;
mod codec;
pub(crate) mod columns;
mod contents_hash;
pub mod curve_reader;
pub(crate) mod durable;
mod error;
pub(crate) mod lock;
pub mod map_file;
mod map_summary;
pub mod map_writer;
mod netcdf;
mod open;
pub mod output;
mod picked;
pub mod regular;
pub(crate) mod sample;
mod seal;
pub(crate) mod soundness;
pub mod source;
pub(crate) mod stamp;
mod summary;
pub mod tiles;
pub mod trace_file;
pub(crate) mod trace_reader;
mod values;
mod variables;

pub use crate::sweep::described::summary::{FieldSummary, StatusCounts};
pub use best_reader::MapBest;
pub use error::StoreError;
pub use map_file::{MapAxis, MapFile};
pub use map_writer::MapWriter;
pub use output::Output;
pub use trace_reader::TraceFile;
