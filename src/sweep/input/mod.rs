//! What the user wrote: parameters, axes, fields, and the files that name them.
//!
//! - `axis`: axis values, each from its index alone
//! - `basin`: of which starts a share is taken that slides: the table `[basin]`, ranges by default
//! - `best_plane`: the plane of a sweep whose best settings are looked for
//! - `case_file`: the case file: one motion, read and checked once
//! - `catalogue`: enumerations whose facts stand in a table, a row for each value
//! - `command`: the command line that asks for a setting
//! - `draft`: reads a sweep file, once
//! - `field`: a row for every field: name, meaning, unit, type, what computes it, what its missing
//!   value means
//! - `friction_table`: the points of a table from a sweep file or from two columns
//! - `given`: the tables that sweep and case files share: `[fixed]`, `[friction]`, `[units]`
//! - `keys`: a row for every key of sweep and case files: name, what it takes, default, meaning
//! - `law_kind`: a row for every friction law that parameters describe: name, formula, parameters,
//!   constructor
//! - `limit_spec`: what a sweep of the limit may give, and what has no meaning in it
//! - `linear_model`: the linear model of a setting: the letter's groups, or a general system
//! - `nearest`: what was meant by a name that is not known
//! - `own_system`: a system from a file with values of its own parameters, in a setting
//! - `parameter`: a row for every parameter: name, symbol, meaning, unit, range, default, flag
//! - `point_file`: a point of parameter space as text
//! - `quantity`: what an axis is of: a parameter of slipmap, or one of a system's own
//! - `regime_at_v0`: regimes of a working velocity, by name
//! - `search`: how critical velocities are looked for: by which protocol, how many are recomputed
//! - `setting`: one value for every parameter, and what has to be given for it
//! - `setting_text`: a setting as tables of a sweep or case file
//! - `simulation`: how far and how exactly motions are followed; the motion of a setting
//! - `source`: what fields are computed from
//! - `spec`: a sweep as its file describes it
//! - `spec_values`: the values of its keys
//! - `system`: a system from a file: its polynomials, its own parameters, and the `System` at
//!   values of them
//! - `system_draft`: the system of a sweep: its parameters, and what it cannot have
//! - `table_file`: a sweep or case file with the points of the friction curve that it names
//! - `toml_reader`: TOML with the place of every key and value
//! - `units`: the units in which a sweep is written
//! - `vc_keys`: its keys for the critical velocity

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
pub mod keys;
pub mod law_kind;
mod limit_spec;
pub mod linear_model;
pub mod nearest;
mod own_system;
pub mod parameter;
pub mod point_file;
pub mod quantity;
pub mod regime_at_v0;
pub mod search;
pub mod setting;
pub mod setting_text;
pub mod simulation;
pub mod source;
pub mod spec;
mod spec_values;
pub mod system;
mod system_draft;
pub mod table_file;
pub mod toml_reader;
pub mod units;
mod vc_keys;
