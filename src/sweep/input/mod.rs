//! What the user wrote: parameters, axes, fields, and the files that name them.

pub mod axis;
pub mod basin;
pub mod best_plane;
pub mod case_file;
mod catalogue;
pub mod command;
mod draft;
pub mod field;
pub mod friction_table;
mod given;
pub mod law_kind;
mod limit_spec;
pub mod nearest;
pub mod parameter;
pub mod point_file;
pub mod regime_at_v0;
pub mod search;
pub mod setting;
pub mod setting_text;
pub mod simulation;
pub mod source;
pub mod spec;
mod spec_values;
pub mod table_file;
pub mod toml_reader;
pub mod units;
mod vc_keys;
