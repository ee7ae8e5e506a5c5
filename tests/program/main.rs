//! The program as its users meet it: command lines, files that it reads and writes, sound and
//! damaged ones, pictures, other text, and scripts around it.

#[path = "../common/chance.rs"]
mod chance;
#[path = "../common/curve_files.rs"]
mod curve_files;
#[path = "../common/general_rows.rs"]
mod general_rows;
#[path = "../common/limited.rs"]
mod limited;
#[path = "../common/map.rs"]
mod map;
#[cfg(target_os = "linux")]
#[path = "../common/processes.rs"]
mod processes;
#[path = "../common/program.rs"]
mod program;
#[cfg(target_os = "linux")]
#[path = "../common/queue_files.rs"]
mod queue_files;

mod actuators;
mod cli;
mod compare;
mod curves;
mod damaged;
mod digital;
mod export;
mod fits;
mod flips;
mod formulas;
mod loop_plot;
mod loops;
mod manners;
mod matrix_systems;
mod measure;
mod names;
mod own_systems;
mod pictures;
mod point_plot;
mod progress;
mod published_loops;
#[cfg(target_os = "linux")]
mod queue;
mod reproduce;
mod responses;
mod return_map;
mod rig;
mod shards;
mod speeds;
mod system_margins;
mod systems;
mod systems_of_others;
mod traces;
mod units;
mod unlike;
mod verify;
