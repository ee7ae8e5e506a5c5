//! Linear stability: counts, roots, crossings, curves, margins and best settings, of the letter's
//! system and of general ones. Without features it holds what needs the ground layers alone: that
//! is what `scripts/quick.sh` asks.

#[path = "../common/cases.rs"]
mod cases;
#[cfg(feature = "sweep")]
#[path = "../common/chain.rs"]
mod chain;
#[cfg(feature = "sweep")]
#[path = "../common/chance.rs"]
mod chance;
#[path = "../common/congruence.rs"]
mod congruence;
#[path = "../common/general_rows.rs"]
mod general_rows;
#[path = "../common/letter_system.rs"]
mod letter_system;
#[cfg(feature = "cli")]
#[path = "../common/program.rs"]
mod program;
#[path = "../common/walk.rs"]
mod walk;
#[path = "../common/winding.rs"]
mod winding;

mod at_origin;
#[cfg(feature = "cli")]
mod best_general;
#[cfg(feature = "cli")]
mod best_of_gains;
#[cfg(feature = "explore")]
mod beyond_letter;
#[cfg(feature = "sweep")]
mod bounded_cells;
#[cfg(feature = "sweep")]
mod chains;
mod counts;
#[cfg(feature = "sweep")]
mod damping;
mod general;
mod general_curves;
#[cfg(feature = "sweep")]
mod general_latency;
#[cfg(feature = "sweep")]
mod general_latency_random;
#[cfg(feature = "sweep")]
mod general_random;
mod general_row;
mod letter;
mod loop_margins;
#[cfg(feature = "cli")]
mod margin_maps;
mod margins;
mod margins_beyond;
#[cfg(feature = "sweep")]
mod matrices;
#[cfg(feature = "explore")]
mod near_resonance;
#[cfg(feature = "sweep")]
mod responses;
#[cfg(feature = "cli")]
mod robust;
#[cfg(feature = "sweep")]
mod robust_beyond;
mod roots;
#[cfg(feature = "sweep")]
mod sampled;
