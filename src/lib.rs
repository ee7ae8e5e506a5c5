//! Exact stability maps of delayed-feedback control of dry friction.
//!
//! A block on a spring, pulled over dry friction, sticks and slips. Feeding the delayed spring
//! elongation a(t) − a(t − τ) back to the pulling velocity (gain α_v) or to the normal load (gain
//! α_N) can turn this into continuous sliding. slipmap says for which gains and delays: exactly,
//! from the closed form of the crossing curves, over whole grids of parameters.
//!
//! Source of the model: F.-J. Elmer, *Controlling friction*, Institut für Physik, Universität
//! Basel, November 1997, "the letter". The [equation index](equations) leads from each of its
//! equations, figures and claims to the function that computes it and the test that holds it. The
//! guide in `doc` explains the rest.
//!
//! | module | what it holds | feature |
//! |---|---|---|
//! | [`text`] | numbers in messages; the errors of files, with their places | |
//! | [`model`] | the oscillator, friction laws, dimensionless groups | |
//! | [`linear`] | linear stability of continuous sliding at a point, along a line, in a plane | |
//! | [`slip`] | the nonlinear oscillator: stick, slip, lift-off, delayed feedback | |
//! | [`critical`] | the critical velocity below which stick-slip survives | |
//! | [`setting`] | parameters, fields, laws, units, settings, the files that name them | `sweep` |
//! | [`fit`] | friction laws fitted to measured points | `fit` |
//! | [`answers`] | margins, best settings, motions, critical velocities of a setting | `sweep` |
//! | [`sweep`] | plans, the engine that computes maps, what a map says | `sweep` |
//! | [`explore`] | requests about a point or a plane, as plain data | `explore` |
//! | [`store`] | map and trace files | `store` |
//! | [`maps`] | from a plan to its map; checks of maps | `store` |
//! | [`serve`] | a page in a browser, and the interface behind it | `serve` |
//! | [`report`] | progress, pictures | `store`, `picture`, `cli` |
//!
//! Beside them stands what belongs to the program alone: the claims of the letter, the queue of
//! sweeps and the command line. `cli`, the default, includes all features. With
//! `default-features = false` the first five modules remain, without libhdf5 and without a C
//! compiler.
//!
//! # Example
//!
//! All delays at which velocity control with α_v = −0.33 stabilises sliding on a weakening law at
//! v0 = 0.35, which are the parameters of the letter's Fig. 3(a):
//!
//! ```
//! use slipmap::linear::Crossings;
//! use slipmap::model::{Control, FrictionLaw, Oscillator, SlidingPoint};
//!
//! let law = FrictionLaw::weakening(0.5, 0.5, 1.0)?;
//! let oscillator = Oscillator::default();
//! let control = Control { alpha_v: -0.33, alpha_n: 0.0 };
//! let groups = oscillator.groups(SlidingPoint::of_law(&law, 0.35)?, control);
//!
//! let crossings = Crossings::of(groups);
//! let stable: Vec<_> = crossings.stable_delays().collect();
//! assert!(stable.iter().any(|s| s.from < 4.15 && 4.15 < s.to));
//! assert_eq!(crossings.n_unstable(4.15), 0);
//! assert_eq!(crossings.n_unstable(1.0), 2);
//! # Ok::<(), slipmap::model::ModelError>(())
//! ```

// Code that only other features use is compiled without them too.
#![cfg_attr(
    not(feature = "cli"),
    allow(dead_code, unreachable_pub, unused_imports)
)]

/// Version of this library and of the program.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Git revision of the source of this library and of the program.
pub const REVISION: &str = env!("SLIPMAP_GIT_REVISION");

#[cfg(feature = "sweep")]
#[cfg_attr(not(test), warn(clippy::disallowed_methods))]
pub mod answers;
#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod cli;
#[cfg_attr(not(test), warn(clippy::disallowed_methods))]
pub mod critical;
#[cfg(doc)]
#[doc = include_str!("../doc/guide/equations.md")]
pub mod equations {}
#[cfg(feature = "explore")]
#[cfg_attr(not(test), warn(clippy::disallowed_methods))]
pub mod explore;
#[cfg(feature = "fit")]
#[cfg_attr(not(test), warn(clippy::disallowed_methods))]
pub mod fit;
#[cfg(feature = "cli")]
pub(crate) mod letter;
#[cfg_attr(not(test), warn(clippy::disallowed_methods))]
pub mod linear;
#[cfg(feature = "store")]
#[cfg_attr(not(test), warn(clippy::disallowed_methods))]
pub mod maps;
#[cfg(any(feature = "explore", feature = "store"))]
#[cfg_attr(not(test), warn(clippy::disallowed_methods))]
pub(crate) mod meaning;
#[cfg_attr(not(test), warn(clippy::disallowed_methods))]
pub mod model;
#[cfg(feature = "serve")]
pub(crate) mod queue;
#[cfg(feature = "store")]
pub mod report;
#[cfg(test)]
mod revision;
#[cfg(feature = "serve")]
pub mod serve;
#[cfg(feature = "sweep")]
#[cfg_attr(not(test), warn(clippy::disallowed_methods))]
pub mod setting;
#[cfg_attr(not(test), warn(clippy::disallowed_methods))]
pub mod slip;
#[cfg(feature = "store")]
#[cfg_attr(not(test), warn(clippy::disallowed_methods))]
pub mod store;
#[cfg(feature = "sweep")]
#[cfg_attr(not(test), warn(clippy::disallowed_methods))]
pub mod sweep;
#[cfg_attr(not(test), warn(clippy::disallowed_methods))]
pub mod text;
