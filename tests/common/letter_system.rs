//! The letter's control written as a general system.

use slipmap::linear::general::{Polynomial, System};
use slipmap::model::{Channel, Groups};

/// B and A of the letter's control in dimensionless groups, with memory and latency.
pub(crate) fn letter(Groups { b, a_v, a_n }: Groups, memory: f64, latency: f64) -> System {
    let polynomial = |c: &[f64]| Polynomial::new(c).expect("a small degree");
    let (open, gain) = (
        polynomial(&[1.0, b, 1.0]),
        polynomial(&[a_n + a_v * b, a_v]),
    );
    System::feedback(open, gain, Channel { memory, latency })
}
