//! Any linear system with one delay, D(λ) = P(λ) + Q(λ) e^(−λτ), retarded or neutral.
//!
//! - `polynomial`: P, Q and what is made of them, each coefficient with a bound on its error
//! - `zeros`: all zeros of such a polynomial, in discs that are known to hold them
//! - `factored`: the zeros of F from the values of P and Q, where its coefficients cancel
//! - `composition`: what D is composed of, and all that depends on which it is
//! - `loop_sides`: a system as a loop, U + k V
//! - `system`: one setting, its class, and |P|² − |Q|² and D on a vertical line
//! - `unit`: the unit of time in which a system is of the order of 1, and lines in other units
//! - `switches`: where |P| and |Q| change places on such a line
//! - `right_of`: how many roots lie right of a line, in closed form
//! - `turning`: the whole turns that the count is made of
//! - `equation`: a system as what finds and follows roots takes it
//! - `at_origin`: roots at 0 at every delay that are left out
//! - `exact`: D and P on the axis with twice the digits
//! - `rightmost`: the rightmost roots, or where roots accumulate
//! - `line`: all delays of a setting: crossings and counts
//! - `zero_delay`: the count as the delay goes to 0
//! - `count`: the count at one delay
//! - `row`: counts and margins at many delays
//! - `stable`: the delays at which it is stable
//! - `latency`: feedback that comes late
//! - `curves`: exact boundaries over a plane of two parameters
//! - `ends`: where lobes of feedback with memory and latency end
//! - `starts`: where the curves of a plane begin to be followed
//! - `level`, `sides`: curves on which a function vanishes, and what holds on both sides of them
//! - `plane`: a system over a plane of two of its parameters
//! - `reason`: why a cell is not like the others
//! - `isolate`: positive zeros of F that are simple and apart, by Descartes' rule on halved
//!   intervals
//! - `parts`: what a system is made of: its feedback form, e^(−στ), angles with their errors
//! - `precise`: crossings that rounding blurs, with more digits
//! - `products`: products of numbers with bounds on their errors, sums of them, |P(iω)|²
//! - `routh`: zeros right of the imaginary axis by Routh's array
//! - `shifted`: P and Q on any vertical line, F = |P|² − |κQ|² there, and the argument of −P Q*

mod at_origin;
mod composition;
mod count;
pub mod curves;
pub mod ends;
mod equation;
mod exact;
mod factored;
mod isolate;
mod latency;
mod level;
pub mod line;
mod loop_sides;
mod parts;
pub(crate) mod plane;
pub(crate) mod polynomial;
mod precise;
mod products;
pub(crate) mod reason;
pub(crate) mod right_of;
pub(crate) mod rightmost;
mod routh;
mod row;
mod shifted;
mod sides;
pub mod stable;
mod starts;
mod switches;
pub(crate) mod system;
mod turning;
mod unit;
mod zero_delay;
pub(crate) mod zeros;

pub use at_origin::OriginError;
pub(super) use composition::enough;
pub use latency::Form;
pub use line::DelayLine;
pub(super) use loop_sides::{LoopSide, beyond_positive, without_idle_zeros};
pub use plane::{SystemPlane, SystemSetting};
pub use polynomial::{MOST_DEGREE, Polynomial};
pub use precise::source::Source;
pub(super) use products::product;
pub use reason::Reason;
pub use right_of::RootCounter;
pub use rightmost::Spectrum;
pub use system::{Class, System};
pub use turning::{RightOf, Turning};
