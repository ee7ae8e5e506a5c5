//! The critical velocity v_c: the velocity of the pull below which stick-slip survives.
//!
//! # The mathematics
//!
//! **State.** A block that is just released has ẋ = 0, and its spring is as strong as static
//! friction. Its future depends on its elongation over the last delay alone,
//!
//! ```text
//! φ(s) = a(t + s),   −τ ≤ s ≤ 0,   φ(0) = μ_S N,   N = 1 + α_n (φ(0) − φ(−τ))            (1)
//! ```
//!
//! in the units of [`crate::slip::motion`]. So the state at a release is a function.
//!
//! **Return map.** The block slips, stops, sticks and is released again. That takes one state to
//! the next,
//!
//! ```text
//! φ ↦ P(φ; v0, τ)                                                                        (2)
//! ```
//!
//! (`return_map`). Periodic stick-slip with k slips in a period is a fixed point of its k-th
//! iterate, φ = Pᵏ(φ). Stick-slip that attracts is found by iteration (`fixed_point`,
//! `with_history`):
//!
//! ```text
//! φ, P(φ), P²(φ), …  →  φ*(v0)                                                           (3)
//! ```
//!
//! where three periods in a row give the limit of a number g of the orbit (Aitken):
//!
//! ```text
//! g* = g₃ + Δ q/(1 − q),   Δ = g₃ − g₂,   q = Δ/(g₂ − g₁)                                (4)
//! ```
//!
//! Under pure load control a stick longer than τ erases all memory. Every release is the same then,
//! and the orbit is one slip (`memoryless`):
//!
//! ```text
//! φ(s) = φ(0) + v0 s,   φ(0) = μ_S (1 + α_n v0 τ)                                        (5)
//! ```
//!
//! **Event functions.** Along a branch of orbits five numbers are positive. As v0 grows, the branch
//! goes on until one of them vanishes (`event_functions`, E1 to E5). They are smooth in v0, so a
//! secant of the last two orbits predicts the zero (`continuation`):
//!
//! ```text
//! v0* = v0 − g(v0)/g′,   g′ = (g(v0) − g(v0 − h))/h,   the smallest v0* ≥ v0 of all g    (6)
//! ```
//!
//! | event | g | what follows (`transition`, `end_of_branch`, `after_event`) |
//! |---|---|---|
//! | graze | (E1) depth of a stop | the slip goes on: stick-slip ends, or has other slips |
//! | lift-off | (E2) smallest load | the model ends |
//! | vanishing stick | (E3) stick time | stick-slip ends in an oscillation without sticks: a fold |
//! | reversal | (E4) force missing at a stop | stick-slip that turns back at a stop follows |
//! | new stop | (E5) lowest minimum of ẋ | stick-slip with one more stop follows |
//!
//! At a graze the stop touches ẋ = ẍ = 0. The time of the stop is a square root of v_c − v0 there.
//! The delay brings it back into the next slip, so the derivative of P grows without bounds, as at
//! the grazing of Nordmark (J. Sound Vib. 145, 279, 1991). See di Bernardo, Budd, Champneys and
//! Kowalczyk, *Piecewise-smooth Dynamical Systems* (Springer 2008), chapters 7 and 8. The depth
//! (E1) is smooth all the same.
//!
//! No g announces these events: the fixed point of (2) loses its stability (period doubling, where
//! stick-slip goes on with twice the slips), meets an unstable one (saddle-node), or irregular
//! stick-slip is lost all at once (crisis). Iteration (3) then does not settle; simulation shows
//! what follows.
//!
//! **Algorithm** of the protocol `follow` ([`critical_velocity`]): raise v0 slowly from low values.
//!
//! ```text
//! branch ← slips without memory (5), else orbits with history (2), at a low v0
//! repeat
//!     repeat                                                        continuation
//!         predict the event by (6); step a share of the way there
//!         extrapolate the past linearly in v0; iterate (3) until settled, limit by (4)
//!         not an orbit of the same kind: undo, halve the step
//!     until the event is near or two predictions agree
//!     locate it once more with finer integration
//!     is its orbit attracting? release a block just past it         end_of_branch, after_event
//!         slips for good, or N ≤ 0:    v_c ← v0*, done
//!         periodic stick-slip:         branch ← that one            follow
//!         irregular stick-slip:        cross it by simulation, branch ← what follows
//!         not known:                   go on by simulation          ramp
//! ```
//!
//! Simulation (`ramp`, `regime`) holds stick-slip at one v0 after the other until its outcome is
//! known. v0 is raised by steps that are halved where stick-slip is lost, and the answer has to be
//! confirmed by other steps (`confirmation`). Where these disagree, two slow searches decide. If
//! they disagree as well, v_c is not decided, but bounded (`bracket`). Along a line of delays the
//! ends at the last delays predict the next one (`delay_step`, [`along_delay`]). By the other
//! protocol, [`switch_on`], control is switched on at a phase of uncontrolled stick-slip. Coulomb
//! friction under load control has a closed form as τ → 0: [`limit`], the letter's Fig. 4.
//!
//! Continuation by predictor and corrector with step control: Allgower and Georg, *Numerical
//! Continuation Methods* (Springer 1990); Keller, *Lectures on Numerical Methods in Bifurcation
//! Problems* (Tata Institute 1987); Doedel, *Lecture notes on numerical analysis of nonlinear
//! equations* (in Krauskopf, Osinga and Galán-Vioque, Springer 2007). All numbers that tune it are
//! in `options`, with their reasons. The predictor is in `step_control`, with a list of all rules
//! for step sizes.
//!
//! - `observers`: what a search observes of a motion: its last stops, a slip that goes on for good,
//!   irregular sticking
//! - `problem`: the question, which is the controlled oscillator, and the answer
//! - `search`: the result of a search by simulation
//! - `synthetic`: return maps of one number with closed forms, in the place of the oscillator's,
//!   for tests
//! - `work`: the work of a search, counted for tests

mod after_event;
pub mod along_delay;
mod bracket;
mod confirmation;
mod continuation;
mod delay_step;
mod end_of_branch;
mod event_functions;
mod fixed_point;
mod follow;
pub mod limit;
mod memoryless;
mod observers;
pub mod options;
mod problem;
mod ramp;
mod regime;
mod return_map;
mod search;
mod step_control;
pub mod switch_on;
#[cfg(test)]
mod synthetic;
mod transition;
mod with_history;
#[cfg(test)]
mod work;

pub use confirmation::by_simulation;
pub use follow::critical_velocity;
pub use options::{ContinuationOptions, Options, RampOptions};
pub use problem::{CriticalVelocity, CriticalWindows, GRAZE_PRECISION, Method, Problem};
pub use regime::Regime;
pub use transition::Transition;
