//! Crossings that rounding blurs, computed once more with many digits.
//!
//! Nearly flat friction and weak feedback on an oscillator with little damping bring zeros of F so
//! near to one another, or −Q/P so near to 1, that f64 does not tell them apart. How many roots are
//! unstable depends on it. Such crossings are rare, so the digits may cost time.
//!
//! - `number`: numbers of three doubles
//! - `turn`: their sines and cosines
//! - `polynomial`: polynomials of them, on the imaginary axis
//! - `source`: what the coefficients of the controlled oscillator come from
//! - `on_axis`: F and the phase of −Q/P
//! - `resolve`: the crossings

mod number;
mod on_axis;
mod polynomial;
pub(super) mod resolve;
pub(super) mod source;
mod turn;
