//! What can be said: parameters, fields, laws, units, settings, and the files that name them.
//!
//! - `actuator_limits`: limits of the actuators beside what they limit
//! - `amount`: a number as people write it, with the unit behind it
//! - `axis`: axis values, each from its index alone
//! - `basin`: the starts over which a share is taken: the table `[basin]`, default ranges
//! - `best_plane`: the planes of a sweep in which the best setting is searched for
//! - `case_file`: the case file: one motion, read and checked once
//! - `catalogue`: enumerations with a table of facts, one row for each value
//! - `checked`: a setting of named numbers, checked as a file is
//! - `command`: the command line for a setting
//! - `curve_remark`: remarks on velocities at which a measured friction law says little
//! - `experiment`: an experiment that measures friction through control, read and checked once
//! - `expression`: expressions of named numbers
//! - `feedback_table`: the table `[feedback]` of a case file: control by the return map
//! - `field`: a row for every field: name, meaning, unit, type, source, meaning of a missing value
//! - `fields_asked`: the fields that are asked for, and where
//! - `fit_keys`: the keys of what a fit says
//! - `fit_errors`: standard errors and correlations of a fitted law
//! - `fitted_sliding`: what they leave open of the slope where the block slides
//! - `formula`: a friction law as an expression in the speed
//! - `formula_keys`: the keys of `[friction]` that belong to a formula
//! - `friction_table`: the points of a table as numbers in a sweep or case file
//! - `given`: the tables that sweep and case files share: `[fixed]`, `[friction]`, `[units]`
//! - `given_error`: whether given parameters make a setting, and why not, in words
//! - `given_key`: what a key gives: a parameter in its own numbers, or the delay as a speed
//! - `given_system`: the system of a sweep: its parameters, and the keys that it cannot have
//! - `keys`: a row for every key of sweep and case files: name, values, default, meaning
//! - `law_kind`: a row for every friction law that parameters describe: name, formula, parameters,
//!   constructor
//! - `limit_spec`: sweeps of the limit of a short delay, and what they may contain
//! - `linear_model`: the feedback, the groups and the linear model of a setting
//! - `map_names`: the names in a map that no parameter of a system may have; the most axes
//! - `measured`: a measured friction curve from a text of columns
//! - `needs`: what fields need of a sweep: a row for each need
//! - `no_answer`: why a setting has no linear model, or no answer
//! - `noisy_slope`: slopes of a measured curve that its own points contradict
//! - `own_system`: a system from a file with values of its own parameters, in a setting
//! - `parameter`: a row for every parameter: name, symbol, meaning, unit, range, default, flag
//! - `point_file`: a point of parameter space as text
//! - `programme`: v0 in time: the tables `[[programme]]` of a case file
//! - `quantity`: the quantity of an axis: a parameter of slipmap, or one of a system's own
//! - `regime_at_v0`: regimes of a working velocity, by name
//! - `sampling`: what a digital loop asks of the other parameters
//! - `search`: the search for critical velocities: its protocol, and the share recomputed
//! - `setting_text`: a setting as tables of a sweep or case file
//! - `simulation`: how far and how exactly motions are followed; the motion of a setting
//! - `source`: what fields are computed from
//! - `spec`: a sweep as described by its file
//! - `spec_values`: the values of a sweep file's keys
//! - `sweep_file`: reads a sweep file, once
//! - `system_keys`: the keys of files of systems, and limits of expressions
//! - `system`: a system from a file: its polynomials, its own parameters, and the `System` at
//!   values of them
//! - `table_file`: a sweep or case file with the contents of the files that it names
//! - `unit`: a unit of measurement, from the words that people write
//! - `units`: the units of a sweep
//! - `values`: one value for every parameter, and which of them must be given
//! - `vc_keys`: a sweep file's keys for the critical velocity

pub(crate) mod actuator_limits;
pub(crate) mod amount;
pub mod axis;
pub mod basin;
pub(crate) mod best_plane;
pub mod case_file;
mod catalogue;
mod checked;
pub mod command;
mod curve_remark;
pub mod experiment;
mod expression;
pub(crate) mod feedback_table;
pub mod field;
mod fields_asked;
pub mod fit_errors;
pub(crate) mod fit_keys;
pub mod fitted_sliding;
pub mod formula;
pub(crate) mod formula_keys;
mod friction_table;
mod given;
mod given_error;
mod given_key;
mod given_system;
pub(crate) mod keys;
pub mod law_kind;
mod limit_spec;
pub mod linear_model;
pub mod map_names;
pub mod measured;
pub(crate) mod needs;
pub mod no_answer;
mod noisy_slope;
mod own_system;
pub mod parameter;
pub mod point_file;
mod programme;
pub mod quantity;
pub mod regime_at_v0;
mod sampling;
pub mod search;
pub mod setting_text;
pub mod simulation;
pub mod source;
pub(crate) mod spec;
mod spec_values;
mod sweep_file;
pub mod system;
pub(crate) mod system_keys;
pub mod table_file;
pub(crate) mod unit;
pub mod units;
pub mod values;
mod vc_keys;

pub use axis::Axis;
pub use case_file::CaseSpec;
pub use experiment::ExperimentSpec;
pub use field::Field;
pub use parameter::Parameter;
pub use spec::SweepSpec;
pub use values::Setting;
