//! Cases with known answers: one constructor gives the problem and its reference, for tests and
//! benches alike.

use super::{Control, FrictionLaw, Groups, Oscillator, SlidingPoint};

/// A point of parameter space with what is known about its linear stability.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinearCase {
    /// Where the case comes from.
    pub source: &'static str,
    /// Dimensionless groups.
    pub groups: Groups,
    /// Delay in units of √(M/κ).
    pub tau: f64,
    /// Number of characteristic roots with positive real part.
    pub n_unstable: u64,
}

/// The parameters of the letter's Fig. 3(a), velocity control, and Fig. 3(b), load control: both
/// stable.
///
/// # Panics
/// Never: the letter's law is well posed.
#[must_use]
pub fn letter_fig3() -> [LinearCase; 2] {
    let case = |source, v0, alpha_v, alpha_n, tau| {
        let law = FrictionLaw::weakening(0.5, 0.5, 1.0).expect("the letter's law is well posed");
        let sliding = SlidingPoint::of_law(&law, v0).expect("the letter's v0 is positive");
        LinearCase {
            source,
            groups: Oscillator::default().groups(sliding, Control { alpha_v, alpha_n }),
            tau,
            n_unstable: 0,
        }
    };
    [
        case("the letter, Fig. 3(a)", 0.35, -0.33, 0.0, 4.15),
        case("the letter, Fig. 3(b)", 0.1, 0.0, -10.0, 0.5),
    ]
}

/// A stable cell of velocity control beyond the letter's limit b ≈ −0.68, inside the exact one.
#[must_use]
pub fn beyond_the_letters_limit() -> LinearCase {
    LinearCase {
        source: "derived: inside the first lobe at b = -0.7",
        groups: Groups::new(-0.7, -0.3174, 0.0),
        tau: 4.312_957,
        n_unstable: 0,
    }
}

/// A stable cell of load control with positive gain.
#[must_use]
pub fn positive_load_gain() -> LinearCase {
    LinearCase {
        source: "derived: first positive-gain lobe at b = -0.1",
        groups: Groups::new(-0.1, 0.0, 0.3),
        tau: 5.6,
        n_unstable: 0,
    }
}
