//! The forces of control while the block comes to slide, from the motion of Fig. 3(b).

use super::claim::{Claim, ClaimValue, Verdict};
use super::return_map::PLACE;
use crate::answers::Trace;
use crate::model::least_squares::LeastSquares;

/// Changes of the load between which the decay is fitted, in N0: small enough that the rightmost
/// root is left alone, far above the error of a motion.
const FITTED: [f64; 2] = [1e-8, 1e-4];
/// The largest relative distance of two rates that are the same.
const SAME_RATE: f64 = 0.01;

/// How N − N0 decays, in units of the letter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Decay {
    /// The largest |N − N0| once control acts, in N0.
    pub largest: f64,
    /// The slope of ln |N − N0|, in its earlier half, and in its later one.
    pub rate: f64,
    pub halves: [f64; 2],
    /// The largest real part of a characteristic root, and how far it is off at most.
    pub abscissa: f64,
    pub margin: f64,
}

impl Decay {
    /// The decay along a trace, in the units of which N0 is `load`, beside an abscissa with its
    /// margin.
    pub(super) fn along(trace: &Trace, load: f64, (abscissa, margin): (f64, f64)) -> Self {
        let off = trace
            .samples
            .iter()
            .map(|s| (s.t, (s.n / load - 1.0).abs()));
        let mut envelope: Vec<_> = off.collect();
        let mut largest = 0.0;
        // The largest change from a time on: its envelope, however it oscillates.
        for (_, change) in envelope.iter_mut().rev() {
            largest = f64::max(largest, *change);
            *change = largest;
        }
        let [least, most] = FITTED;
        let fitted = envelope
            .into_iter()
            .filter(|(_, c)| (least..=most).contains(c));
        let logarithms: Vec<_> = fitted.map(|(t, change)| (t, change.ln())).collect();
        let (earlier, later) = logarithms.split_at(logarithms.len() / 2);
        Self {
            largest,
            rate: slope(&logarithms),
            halves: [slope(earlier), slope(later)],
            abscissa,
            margin,
        }
    }

    /// How far the rate is off: by as much as both halves of the time differ.
    fn error(&self) -> f64 {
        (self.halves[0] - self.halves[1]).abs()
    }

    fn verdict(&self) -> Verdict {
        let off = |rate: f64| (rate / self.abscissa - 1.0).abs();
        let straight = self.halves.iter().all(|rate| off(*rate) <= SAME_RATE);
        Verdict::of_parts(
            self.abscissa < 0.0 && straight && off(self.rate) <= SAME_RATE,
            self.rate < 0.0 && self.halves.iter().all(|rate| *rate < 0.0),
        )
    }

    pub(super) fn claim(&self) -> Claim {
        let because = format!(
            "At Fig. 3(b) control begins with changes of the load of up to {:.3} N0. Once they are \
             below {:.0e} N0 they decay as exp({:.5} t), in the earlier half of the time as in the \
             later one; the rightmost characteristic root has the real part {:.6}.",
            self.largest, FITTED[1], self.rate, self.abscissa,
        );
        let at = (
            PLACE,
            "But they decay exponentially by approaching the orbit",
        );
        let how = "A straight line through the logarithm of the largest |N − N0| from a time on, \
            where that is between 10⁻⁸ and 10⁻⁴ N0, beside the rightmost characteristic root. The \
            same rate: within 1 %.";
        let of = "rate of the decay of |N − N0|, √(κ/M); error: by how much its halves differ";
        let root = "largest real part of a characteristic root, √(κ/M)";
        let largest = "largest |N − N0| under control, N0";
        let margin = self.margin * self.abscissa.abs().max(1.0);
        Claim::new("control_forces", at, self.verdict(), because, how)
            .by([
                ClaimValue::of("rate", of, self.rate).within(self.error()),
                ClaimValue::of("abscissa", root, self.abscissa).within(margin),
                ClaimValue::of("largest", largest, self.largest).within(1e-8),
            ])
            .from(&["fig3b"])
            .repeat(
                "slipmap point --friction weakening --mu0 0.5 --v-s 0.5 --v0 0.1 --alpha-n=-10 \
                 --tau 0.5",
            )
    }
}

/// The slope of the straight line through points, by least squares; NaN for fewer than two.
fn slope(points: &[(f64, f64)]) -> f64 {
    let (times, heights): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
    let line = LeastSquares::of([vec![1.0; points.len()], times]);
    line.map_or(f64::NAN, |line| line.solve(&heights)[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::slip::motion::Mode;
    use crate::slip::outcome::Summary;

    /// A trace whose load is a damped cosine with a known rate.
    fn trace(of: impl Fn(f64) -> f64, summary: Summary) -> Trace {
        let sample = |i: u32| {
            let t = 0.05 * f64::from(i);
            let off = of(t);
            crate::answers::trace::Sample {
                t,
                x: 0.0,
                x_dot: 0.1,
                a: 0.4,
                v: 0.1,
                n: 2.0 * (1.0 + off),
                pulling_force: 0.0,
                friction_force: 0.0,
                mode: Mode::Forwards,
            }
        };
        Trace {
            samples: (0..1200).map(sample).collect(),
            events: Vec::new(),
            summary,
        }
    }

    #[test]
    fn the_rate_of_a_known_decay_is_found() {
        let spec: crate::setting::CaseSpec =
            include_str!("../../sweeps/fig3b.toml").parse().unwrap();
        let summary = Trace::of(&spec).unwrap().summary;
        let exponential = |t: f64| 0.3 * (-0.4 * t).exp();
        let found = Decay::along(&trace(exponential, summary), 2.0, (-0.4, 1e-12));
        assert!((found.rate + 0.4).abs() < 1e-6, "{found:?}");
        assert!((found.largest - 0.3).abs() < 1e-12, "{found:?}");
        assert_eq!(found.verdict(), Verdict::Confirmed);
        // Steps of the envelope of an oscillation average out over its periods.
        let oscillating = |t: f64| exponential(t) * (4.0 * t).cos();
        let found = Decay::along(&trace(oscillating, summary), 2.0, (-0.4, 1e-12));
        assert!((found.rate + 0.4).abs() < 0.004, "{found:?}");
        let other = Decay {
            abscissa: -0.5,
            ..found
        };
        assert_eq!(other.verdict(), Verdict::Refined);
        // As a power of time.
        let found = Decay::along(&trace(|t| 1e-3 / (1.0 + t), summary), 2.0, (-0.4, 1e-12));
        assert_ne!(found.verdict(), Verdict::Confirmed);
        let none = Decay::along(&trace(|_| 1.0, summary), 2.0, (-0.4, 1e-12));
        assert_eq!(none.verdict(), Verdict::Contradicted);
    }
}
