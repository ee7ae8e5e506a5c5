//! Maps and traces on disk: HDF5 files that netCDF-4 readers open with named coordinates. The only
//! place that knows HDF5.
//!
//! - [`schema`]: names, meanings and format version
//! - [`tiles`]: finished pieces of a sweep in files of their own, checked when they are read
//! - [`map_writer`]: the map's file, under a temporary name until it is complete
//! - [`map_file`]: reads maps
//! - [`trace_file`]: writes motions sampled over time, and recognises them
//! - [`output`]: the temporary name, the lock, the final rename

mod attributes;
mod best_reader;
pub(crate) mod best_writer;
mod boundary_writer;
pub mod cell_blocks;
pub mod chunk_layout;
mod codec;
pub mod columns;
mod contents_hash;
pub mod curve_reader;
pub mod curve_rows;
pub mod describe;
mod durable;
mod error;
mod lock;
pub mod map_file;
mod map_summary;
pub mod map_writer;
mod netcdf;
mod open;
pub mod output;
pub(crate) mod sample;
pub mod schema;
mod seal;
pub mod soundness;
pub mod source;
pub mod stamp;
mod summary;
pub mod tiles;
pub mod trace_file;
pub mod trace_reader;
mod values;
mod variables;

pub use best_reader::MapBest;
pub use error::StoreError;
pub use map_file::{MapAxis, MapFile};
pub use map_writer::MapWriter;
pub use output::Output;
pub use summary::{FieldSummary, StatusCounts};
pub use trace_reader::TraceFile;
