//! Where the stable regions of pure control end: minimal gains and the ends of lobes.
//!
//! Derived for this project, not in the letter. Crossings exist only where the discriminant of F,
//!
//! ```text
//! (b² + 2 a_n)² − 4 b² + 8 b a_v,                                                          (1)
//! ```
//!
//! is positive; [`super::gains`] has it with a dashpot. On its zero ω₋ = ω₊ = ω*, the fold of the
//! crossing curve. A lobe of stable delays between the fold's two arms shrinks to a point where the
//! arms have the same slope there,
//!
//! ```text
//! ω* dθ/dω = θ + 2πk   at   ω = ω*.                                                        (2)
//! ```

use std::f64::consts::{SQRT_2, TAU};

use num_complex::Complex64;

use super::crossing::Crossings;
use super::gains::velocity_fold;
use super::roots::bisect;
use crate::model::Groups;
use crate::model::elementary::arg;
use crate::model::groups::{feedback, open_loop};

/// The kinds of pure control whose lobes end at a finite slope of the friction law.
///
/// ```
/// use slipmap::linear::lobes::LobeControl;
///
/// // Velocity control cannot stabilise sliding below this slope; the letter says −0.68.
/// let end = LobeControl::Velocity { damping: 0.0 }.lobe_end(0);
/// assert!((end.b - -0.725_635_939_603).abs() < 1e-12);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LobeControl {
    /// Pure velocity control of negative gain.
    Velocity {
        /// d ≥ 0, the dashpot beside the spring: a_n = −d a_v.
        damping: f64,
    },
    /// Pure load control with positive gain, a_v = 0.
    PositiveLoad,
}

/// The point to which a lobe of stable delays shrinks, dimensionless.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LobeEnd {
    /// The slope b* < 0, dashpots included: the lobe exists for b* < b < 0.
    pub b: f64,
    /// Frequency ω* of the pair that touches the axis.
    pub omega: f64,
    /// Delay τ*.
    pub tau: f64,
    /// Gain there: a_v for velocity control, a_n for load control.
    pub gain: f64,
}

impl LobeControl {
    /// The groups on the fold (1) at slope `b` < 0, and its frequency ω*.
    fn fold(self, b: f64) -> (Groups, f64) {
        match self {
            Self::Velocity { damping } => {
                let a_v = velocity_fold(b, damping);
                let squared = 1.0 - 0.5 * b * b + damping * a_v;
                (
                    Groups::new(b, a_v, 0.0).coupled(damping),
                    squared.max(0.0).sqrt(),
                )
            }
            Self::PositiveLoad => (
                Groups::new(b, 0.0, minimal_positive_load_gain(b)),
                (1.0 + b).sqrt(),
            ),
        }
    }

    /// The most negative slope at which the fold has a frequency.
    fn steepest(self) -> f64 {
        match self {
            Self::Velocity { damping: 0.0 } => -SQRT_2,
            // There the fold comes to ω* = 0.
            Self::Velocity { damping } => {
                bisect(-SQRT_2, 0.0, |b| b * b - 2.0 + damping / (damping - b))
            }
            Self::PositiveLoad => -1.0,
        }
    }

    /// Where the lobe number `lobe` = k (0 is the one at the shortest delays) ends, by condition
    /// (2).
    #[must_use]
    pub fn lobe_end(self, lobe: u32) -> LobeEnd {
        let turns = TAU * f64::from(lobe);
        let slope_condition = |b: f64| {
            let (groups, omega) = self.fold(b);
            let (theta, derivative) = phase_and_derivative(groups, omega);
            omega * derivative - theta - turns
        };
        // Towards b = 0 the phase turns ever faster, at the steepest slope it does not turn at all.
        let mut shallow = 0.5 * self.steepest();
        while slope_condition(shallow) < 0.0 {
            shallow *= 0.5;
        }
        let steep = self.steepest() * (1.0 - 1e-9);
        let b = bisect(steep, shallow, slope_condition);
        let (groups, omega) = self.fold(b);
        let (theta, _) = phase_and_derivative(groups, omega);
        LobeEnd {
            b,
            omega,
            tau: (theta + turns) / omega,
            gain: match self {
                Self::Velocity { .. } => groups.a_v,
                Self::PositiveLoad => groups.a_n,
            },
        }
    }
}

/// θ of the letter's Eq. (5) and its derivative with the frequency, at fixed groups on the crossing
/// curve.
fn phase_and_derivative(groups: Groups, omega: f64) -> (f64, f64) {
    let Groups { b, a_v, a_n } = groups;
    let i = Complex64::i();
    let lambda = i * omega;
    let own = open_loop(b, lambda);
    let fed = feedback(a_n, a_v, b + lambda);
    let (d_own, d_fed) = (i * (2.0 * lambda + b), i * a_v);
    let theta = (-arg((fed - own) / fed)).rem_euclid(TAU);
    let derivative = ((d_own * fed - own * d_fed) / (fed * (fed - own))).im;
    (theta, derivative)
}

/// The weakest negative load gain a_n that stabilises at slope `b` < 0: −(b²/2 + |b|). Stable
/// delays exist right below it.
#[must_use]
pub fn minimal_negative_load_gain(b: f64) -> f64 {
    -(0.5 * b * b + b.abs())
}

/// The weakest positive load gain a_n at which roots cross at slope `b` < 0: |b| − b²/2.
///
/// It stabilises while b is above the end of the first lobe, see [`LobeControl::lobe_end`].
#[must_use]
pub fn minimal_positive_load_gain(b: f64) -> f64 {
    b.abs() - 0.5 * b * b
}

/// True if some delay is stable at these groups.
#[must_use]
pub fn has_stable_delay(groups: Groups) -> bool {
    Crossings::of(groups).stable_delays().next().is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_of_the_velocity_lobes() {
        let first = LobeControl::Velocity { damping: 0.0 }.lobe_end(0);
        assert!((first.b - -0.725_635_939_603).abs() < 1e-12, "{first:?}");
        assert!((first.omega - 0.858_327_584_072).abs() < 1e-12);
        assert!((first.tau - 4.363_587_932_563).abs() < 2e-11);
        assert!((first.gain - -0.315_057_744_535).abs() < 1e-12);
        let [second, third] = [1, 2].map(|k| LobeControl::Velocity { damping: 0.0 }.lobe_end(k).b);
        assert!((second - -0.369_620_351_789).abs() < 1e-12, "{second}");
        assert!((third - -0.240_297_356_210).abs() < 1e-12, "{third}");
    }

    /// ζ, the slope without the dashpot, ω*, the gain and the delay of ends with a dashpot of
    /// damping ratio ζ = d/2 beside the spring, by a program that shares nothing with this one.
    const DAMPED: [[f64; 5]; 7] = [
        [
            0.0,
            -0.7256359396031,
            0.858327584072,
            -0.315057744535,
            4.36358793256,
        ],
        [
            0.01,
            -0.7401182341093,
            0.857025441355,
            -0.311112866058,
            4.37992370341,
        ],
        [
            0.02,
            -0.7546997851432,
            0.855753073518,
            -0.307219643046,
            4.39605435968,
        ],
        [
            0.05,
            -0.7990305787274,
            0.852110885483,
            -0.295851638438,
            4.44319544795,
        ],
        [
            0.1,
            -0.8748052757453,
            0.846598811977,
            -0.27794685736,
            4.51751493517,
        ],
        [
            0.2,
            -1.032886766507,
            0.837459149665,
            -0.245973357581,
            4.65015791238,
        ],
        [
            0.5,
            -1.547254441942,
            0.820871343101,
            -0.176426525963,
            4.93574635671,
        ],
    ];

    #[test]
    fn ends_of_the_damped_velocity_lobe() {
        for [ratio, slope, omega, gain, tau] in DAMPED {
            let damping = 2.0 * ratio;
            let end = LobeControl::Velocity { damping }.lobe_end(0);
            let found = [end.b - damping, end.omega, end.gain, end.tau];
            for (found, expected) in found.into_iter().zip([slope, omega, gain, tau]) {
                assert!(
                    (found - expected).abs() < 1e-11,
                    "{ratio}: {found} {expected}"
                );
            }
        }
    }

    #[test]
    fn ends_of_the_positive_load_lobes() {
        let first = LobeControl::PositiveLoad.lobe_end(0);
        assert!((first.b - -0.356_930_047).abs() < 1e-9, "{first:?}");
        assert!((first.tau - 5.603_338_849).abs() < 1e-8);
        assert!((first.gain - 0.293_230_518).abs() < 1e-9);
        assert!((first.omega * first.omega - (1.0 - first.b.abs())).abs() < 1e-15);
        let second = LobeControl::PositiveLoad.lobe_end(1);
        assert!((second.b - -0.167_365_699).abs() < 1e-9, "{second:?}");
    }

    /// Beyond the fold nothing crosses, before it two frequencies close together do.
    #[test]
    fn the_ends_lie_on_folds() {
        for lobe in 0..6 {
            for (control, beyond) in [
                (LobeControl::Velocity { damping: 0.0 }, 1.0),
                (LobeControl::PositiveLoad, -1.0),
            ] {
                let end = control.lobe_end(lobe);
                let moved = |by: f64| match control {
                    LobeControl::Velocity { .. } => Groups::new(end.b, end.gain + by, 0.0),
                    LobeControl::PositiveLoad => Groups::new(end.b, 0.0, end.gain + by),
                };
                assert_eq!(Crossings::of(moved(1e-9 * beyond)).iter().count(), 0);
                let before: Vec<_> = Crossings::of(moved(-1e-9 * beyond))
                    .iter()
                    .copied()
                    .collect();
                assert_eq!(before.len(), 2);
                assert!(before.iter().all(|c| (c.omega - end.omega).abs() < 1e-3));
            }
        }
    }
}
