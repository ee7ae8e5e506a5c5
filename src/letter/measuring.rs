//! Friction measured through control: the letter's application, with noise of the readings.

use super::LetterError;
use super::claim::{Claim, ClaimValue, Verdict};
use super::workshop::{Source, Workshop, source};
use crate::answers::measure::Prospect;
use crate::explore::measure::{Foretold, MeasuredV0};
use crate::linear::lobes::LobeControl;
use crate::setting::experiment::ExperimentSpec;
use crate::text::{Shown, to_digits};

const LOAD: Source = source!(
    "experiments/measure",
    quick: [("points = 10", "points = 5")]
);
const VELOCITY: Source = source!("experiments/measure_velocity");

/// How far a mean may be off, in its standard errors: further off is one of 16,000.
const FAR: f64 = 4.0;
/// The same without noise, where friction comes back to what is left of a disturbance.
const LEFT: f64 = 1e-6;
/// μ0 and v_s of the law of both experiments, the letter's Fig. 3.
const LAW: [f64; 2] = [0.5, 0.5];

/// Friction at one velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Point {
    v0: f64,
    /// The mean under control with its standard error, and that without control.
    found: f64,
    error: f64,
    uncontrolled: f64,
    /// Whether the block slid under control, and whether it did without.
    settled: bool,
    slides_anyway: bool,
    /// Whether stick-slip lives beside sliding: v0 is below v_c of its setting.
    below_vc: bool,
    /// μ_K of the law.
    law: f64,
}

impl Point {
    fn of(point: &MeasuredV0) -> Self {
        Self {
            v0: point.v0,
            found: point.mu_k,
            error: point.mu_k_error,
            uncontrolled: point.uncontrolled,
            settled: point.settled,
            slides_anyway: point.uncontrolled_settled,
            below_vc: point.prospect == Prospect::BelowVc.name(),
            law: point.law,
        }
    }

    /// Whether the law comes out, within what noise allows.
    fn is_right(&self) -> bool {
        self.settled && (self.found - self.law).abs() <= FAR * self.error + LEFT
    }

    /// Its distance from the law in standard errors.
    fn errors_off(&self) -> f64 {
        (self.found - self.law).abs() / self.error
    }
}

/// Friction under both controls.
#[derive(Debug, Clone, PartialEq)]
struct Measured {
    load: Vec<Point>,
    velocity: Vec<Point>,
    /// The velocity from which on velocity control has settings.
    velocity_from: f64,
}

impl Measured {
    fn verdict(&self) -> Verdict {
        let right = self.load.iter().filter(|point| point.is_right()).count();
        let weakens = !self.load.iter().any(|point| point.slides_anyway);
        let of = self.load.len();
        // The letter itself has velocity control end at a slope.
        let as_foreseen = |point: &Point| point.is_right() == (point.v0 > self.velocity_from);
        let velocity = self.velocity.iter().all(as_foreseen);
        Verdict::of_parts(
            of > 0 && right == of && weakens && velocity,
            2 * right > of && weakens,
        )
    }

    fn because(&self) -> String {
        let worst = self.load.iter().map(Point::errors_off);
        let off = self.load.iter().map(|p| p.uncontrolled / p.law - 1.0);
        let [largest, least] = [f64::max, f64::min].map(|of: fn(f64, f64) -> f64| {
            off.clone().map(f64::abs).reduce(of).unwrap_or(f64::NAN)
        });
        let [first, last] = [self.load.first(), self.load.last()];
        let v0 = |point: Option<&Point>| Shown(point.map_or(f64::NAN, |point| point.v0));
        let right = self.velocity.iter().filter(|point| point.is_right());
        let beside = self
            .load
            .iter()
            .chain(&self.velocity)
            .filter(|p| p.below_vc);
        format!(
            "At {} velocities from {} to {}, where sliding is unstable without control, the mean \
             of a noisy elongation under load control is μ_K to within {:.1} standard errors; \
             without control, in stick-slip, it is {:.0} to {:.0} % off. Velocity control has no \
             setting below v0 = {:.4} and measures right at {} of {} velocities. Blocks begin \
             near sliding: at {} velocities in all, below v_c of their settings, stick-slip would \
             live on.",
            self.load.len(),
            v0(first),
            v0(last),
            worst.fold(0.0, f64::max),
            100.0 * least,
            100.0 * largest,
            self.velocity_from,
            right.count(),
            self.velocity.len(),
            beside.count(),
        )
    }

    fn claim(&self) -> Claim {
        let at = (
            "last paragraph",
            "one can measure the effective friction force as a function of the sliding velocity \
             even in the velocity-weakening regime",
        );
        let how = "Experiments at one velocity each: control with the best robust setting, a wait \
            of 25 relaxation times, a mean of readings with noise of 0.001 N0/κ over 1000 √(M/κ) \
            under load control, without noise under velocity control. Right: within 4 standard \
            errors, or 10⁻⁶ without noise, of the law that was put in.";
        let worst = self.load.iter().map(Point::errors_off).fold(0.0, f64::max);
        let settled = self.velocity.iter().filter(|point| point.is_right());
        let of_load = self.load.iter().flat_map(|point| {
            let v0 = Shown(to_digits(point.v0, 4));
            let law = Shown(to_digits(point.law, 6));
            let meaning = format!("mean under load control; the law says {law}; standard error");
            [
                ClaimValue::of(format!("mu_k at {v0}"), meaning, point.found).within(point.error),
                ClaimValue::of(
                    format!("without control at {v0}"),
                    "the same mean of stick-slip",
                    point.uncontrolled,
                ),
            ]
        });
        let worst_is = "largest distance from the law under load control, standard errors";
        let counted = "velocities of six at which velocity control measures right";
        let from = "v0 below which velocity control has no setting, √(N0²/(κM))";
        Claim::new("measured_friction", at, self.verdict(), self.because(), how)
            .by(of_load)
            .by([
                ClaimValue::of("errors off", worst_is, worst),
                ClaimValue::of("velocity control", counted, settled.count() as f64),
                ClaimValue::of("velocity control from", from, self.velocity_from).within(1e-12),
            ])
            .repeat("slipmap measure sweeps/experiments/measure.toml")
            .repeat("slipmap measure sweeps/experiments/measure_velocity.toml")
    }
}

/// Friction at the velocities of an experiment.
fn measured(shop: &Workshop, source: &Source) -> Result<Vec<Point>, LetterError> {
    let text = source.text(shop.quick);
    let spec: ExperimentSpec = text.parse().map_err(LetterError::spec(source.name))?;
    let foretold = Foretold::of(spec, shop.threads, shop.attended)?;
    let found = foretold.measured(shop.threads, shop.attended)?;
    Ok(found.points.iter().map(Point::of).collect())
}

/// The velocity at which the law falls as steeply as velocity control allows.
fn velocity_from() -> f64 {
    let [mu0, v_s] = LAW;
    let steepest = -LobeControl::Velocity { damping: 0.0 }.lobe_end(0).b;
    v_s * ((mu0 / (v_s * steepest)).sqrt() - 1.0)
}

/// All claims of this file.
pub(super) fn claims(shop: &Workshop) -> Result<Vec<Claim>, LetterError> {
    shop.step("friction measured through control")?;
    let found = Measured {
        load: measured(shop, &LOAD)?,
        velocity: measured(shop, &VELOCITY)?,
        velocity_from: velocity_from(),
    };
    Ok(vec![found.claim()])
}

#[cfg(test)]
mod tests {
    use super::*;

    const POINT: Point = Point {
        v0: 0.1,
        found: 0.4,
        error: 1e-5,
        uncontrolled: 0.2,
        settled: true,
        slides_anyway: false,
        below_vc: false,
        law: 0.4,
    };

    #[test]
    fn friction_has_to_come_back_from_where_sliding_is_unstable() {
        let of = |load: &[Point], velocity: &[Point]| {
            let [load, velocity] = [load, velocity].map(<[Point]>::to_vec);
            let velocity_from = 0.087;
            Measured {
                load,
                velocity,
                velocity_from,
            }
            .verdict()
        };
        let off = Point {
            found: 0.401,
            ..POINT
        };
        let stuck = Point {
            settled: false,
            v0: 0.05,
            ..POINT
        };
        assert_eq!(of(&[POINT; 3], &[POINT, stuck]), Verdict::Confirmed);
        assert_eq!(of(&[POINT, POINT, off], &[POINT]), Verdict::Refined);
        assert_eq!(of(&[POINT, off], &[POINT]), Verdict::Contradicted);
        let fails_above = Point { v0: 0.2, ..stuck };
        assert_eq!(of(&[POINT; 3], &[fails_above]), Verdict::Refined);
        let slides = Point {
            slides_anyway: true,
            ..POINT
        };
        assert_eq!(of(&[slides; 3], &[POINT]), Verdict::Contradicted);
        assert_eq!(of(&[], &[]), Verdict::Contradicted);
    }

    /// The law of the sweeps is the one assumed here, and quick runs have fewer velocities.
    #[test]
    fn the_experiments_have_the_letters_law() {
        for (source, quick, velocities) in
            [(LOAD, false, 10), (LOAD, true, 5), (VELOCITY, false, 6)]
        {
            let spec: ExperimentSpec = source.text(quick).parse().unwrap();
            assert_eq!(spec.v0.len(), velocities);
            let law = spec.setting.friction_law().unwrap().unwrap();
            let off = law.mu_k(0.7) - LAW[0] / (1.0 + 0.7 / LAW[1]);
            assert!(off.abs() < 1e-15, "{off}");
        }
        assert!((velocity_from() - 0.086_962_846_3).abs() < 1e-10);
    }
}
