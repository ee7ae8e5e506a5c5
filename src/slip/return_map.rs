//! Control by the return map: at each reading the load that brings the block to sliding in two.
//!
//! With y = reading − a* and a recursion of readings as in `Recursion` the state is
//!
//! ```text
//! z = (y_k, t₂ y_{k−1} + g₂ δN_{k−1}),   z_{k+1} = Φ z_k + Γ δN_k,
//! Φ = [[t₁, 1], [t₂, 0]],   Γ = (g₁, g₂)                                                (1)
//! ```
//!
//! which needs no velocity: two readings and the load between them tell it. After
//! δN = −K z with K = (0 1) [Γ, ΦΓ]⁻¹ Φ² the second reading from now is that of sliding, and so is
//! the state then. The same comes from the state (ẋ, a), since K is the only such feedback of it.
//! Where |δN| would exceed the amplitude it is 0, as it is at the first reading. A block that
//! sticks is read like any other: nothing detects that it does.

use crate::linear::sampled::recursion;
use crate::model::elementary::{atan2, ln};
use crate::model::{Groups, MapModel, Recursion, ReturnMap};

use super::motion::parameters::Parameters;
use super::readings::part;

/// [Γ, ΦΓ] is singular where its determinant is less than this share of its numbers squared.
const SINGULAR: f64 = 1e-9;
/// The least |sin Ωh| for which the reading tells the velocity.
const LEAST_SINE: f64 = 0.05;
/// The bound of |z| for zeros that are searched, and by how many halvings.
const LARGEST: f64 = 64.0;
const HALVINGS: u32 = 64;
/// What pulses are drawn with beside the seed of readings.
const OF_PULSES: u64 = 0x7075_6c73_6573;

/// The recursion of a block with the parameters `p` that slides at `v0`, where the law's slope is
/// so many times as steep as it is.
pub(super) fn of_law(p: &Parameters, v0: f64, slope: f64) -> Recursion {
    let speed = v0 * p.velocity_unit;
    let mu_k = p.law.mu_k(speed);
    let b = slope * p.law.mu_prime(speed) * p.velocity_unit + p.dashpots.sum();
    let [t1, t2, g1, g2] = recursion(Groups::new(b, 0.0, mu_k), p.feedback.readings.sample_time);
    Recursion {
        readings: [t1, t2],
        loads: [g1, g2],
        rest: mu_k + p.dashpots.viscous * v0,
    }
}

/// The shortest and the longest time between readings that tell the velocity of a block with the
/// damping b̃, in units of √(M/κ): 0 < h < π/Ω with |sin Ωh| of at least 0.05.
pub(super) fn sample_times(b: f64) -> [f64; 2] {
    let omega = (1.0 - 0.25 * b * b).max(0.0).sqrt();
    let least = atan2(LEAST_SINE, (1.0 - LEAST_SINE * LEAST_SINE).sqrt());
    if omega == 0.0 {
        // A block that does not swing tells its velocity however late it is read.
        return [least, f64::INFINITY];
    }
    [least / omega, (std::f64::consts::PI - least) / omega]
}

/// A recursion with the feedback that goes with it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Steering {
    pub of: Recursion,
    /// K.
    gains: [f64; 2],
}

impl Steering {
    /// None where one reading more tells no more of the state, or no load changes it.
    pub(super) fn of(recursion: Recursion) -> Option<Self> {
        let Recursion {
            readings: [t1, t2],
            loads: [g1, g2],
            ..
        } = recursion;
        // [Γ, ΦΓ], whose second column is (t₁ g₁ + g₂, t₂ g₁).
        let moved = [t1 * g1 + g2, t2 * g1];
        let determinant = g1 * moved[1] - g2 * moved[0];
        let size = (g1 * moved[1]).abs() + (g2 * moved[0]).abs();
        // Φ² = [[t₁² + t₂, t₁], [t₁ t₂, t₂]]; the last row of the inverse is (−g₂, g₁)/det.
        let gains =
            [g1 * t1 * t2 - g2 * (t1 * t1 + t2), g1 * t2 - g2 * t1].map(|gain| gain / determinant);
        let known = determinant.abs() > SINGULAR * size && gains.iter().all(|k| k.is_finite());
        known.then_some(Self {
            of: recursion,
            gains,
        })
    }

    /// −K z from two readings less a*, and the load between them.
    fn load(&self, [now, before]: [f64; 2], load: f64) -> f64 {
        let ([_, t2], [_, g2]) = (self.of.readings, self.of.loads);
        -(self.gains[0] * now + self.gains[1] * (t2 * before + g2 * load))
    }

    /// By how much noise of a reading changes the load, at most.
    fn of_noise(&self) -> f64 {
        self.gains[0].abs() + (self.gains[1] * self.of.readings[1]).abs()
    }

    /// δN at rest of a block whose sliding is that of `block`: 0 where both say the same a*.
    fn at_rest(&self, block: &Recursion) -> f64 {
        let ([_, t2], [_, g2]) = (self.of.readings, self.of.loads);
        let ([t1, own], [g1, of_last]) = (block.readings, block.loads);
        let lever = (g1 + of_last) / (1.0 - t1 - own);
        let gain = self.gains[0] + self.gains[1] * t2;
        -gain * (block.rest - self.of.rest) / (1.0 + self.gains[1] * g2 + gain * lever)
    }

    /// The largest |z| of the block `block` under this control, near sliding: zeros of
    /// (z² − t₁ z − t₂)(z + K₂ g₂′) + (g₁ z + g₂)(K₁ z + K₂ t₂′), the dash of the control's own.
    fn largest_zero(&self, block: &Recursion) -> f64 {
        let ([t1, t2], [g1, g2]) = (block.readings, block.loads);
        let ([k1, k2], [_, own]) = (self.gains, self.of.loads);
        let (kept, past) = (k2 * own, k2 * self.of.readings[1]);
        let cubic = [
            kept - t1 + g1 * k1,
            g2 * k1 + g1 * past - t1 * kept - t2,
            g2 * past - t2 * kept,
        ];
        largest_zero(cubic)
    }
}

/// The largest |z| of the zeros of z³ + c₂ z² + c₁ z + c₀, to many digits; at least next to 0, at
/// most [`LARGEST`]. All zeros of p(r z) lie in the unit circle where r is larger (Jury 1962).
fn largest_zero([c2, c1, c0]: [f64; 3]) -> f64 {
    let within = |r: f64| {
        let [a, b, c] = [c2 / r, c1 / (r * r), c0 / (r * r * r)];
        1.0 + a + b + c > 0.0
            && 1.0 - a + b - c > 0.0
            && c.abs() < 1.0
            && 1.0 - c * c > (b - a * c).abs()
    };
    let (mut low, mut high) = (1e-6, LARGEST);
    for _ in 0..HALVINGS {
        let middle = (low * high).sqrt();
        match within(middle) {
            true => high = middle,
            false => low = middle,
        }
    }
    high
}

/// What steers the load, with what it remembers from one reading to the next.
#[derive(Debug, Clone, Copy)]
pub(super) struct Controller {
    of: ReturnMap,
    /// None while a record is made, or where nothing tells a feedback.
    steering: Option<Steering>,
    /// The v0 of a recursion that comes from the law.
    v0: f64,
    seed: u64,
    /// The last reading, if there is one, and the load that was set at it.
    pub(super) before: Option<f64>,
    pub(super) load: f64,
}

impl Controller {
    /// At the beginning of a motion with these parameters; none without control by the return map.
    pub(super) fn of(p: &Parameters) -> Option<Self> {
        let of = p.feedback.return_map?;
        let steering = match of.model {
            MapModel::Law { slope } => Steering::of(of_law(p, p.v0, slope)),
            MapModel::Known(recursion) => Steering::of(recursion),
            MapModel::Reconstructed(_) => None,
        };
        Some(Self {
            of,
            steering,
            v0: p.v0,
            seed: p.feedback.readings.seed ^ OF_PULSES,
            before: None,
            load: 0.0,
        })
    }

    /// δN from reading `number`, which is `y`, on.
    pub(super) fn steer(&mut self, number: i64, y: f64, p: &Parameters) -> f64 {
        let before = self.before.replace(y);
        let amplitude = self.of.amplitude;
        self.load = match self.of.model {
            MapModel::Reconstructed(record) => record.pulse * (2.0 * part(self.seed, number) - 1.0),
            MapModel::Law { .. } | MapModel::Known(_) => {
                self.look_at(p, p.v0);
                match (before, self.steering) {
                    (Some(before), Some(steering)) => {
                        let rest = steering.of.rest;
                        let wanted = steering.load([y - rest, before - rest], self.load);
                        if wanted.abs() <= amplitude {
                            wanted
                        } else {
                            0.0
                        }
                    }
                    _ => 0.0,
                }
            }
        };
        self.load
    }

    /// Takes the recursion of another v0 from the law.
    fn look_at(&mut self, p: &Parameters, v0: f64) {
        if let (MapModel::Law { slope }, true) = (self.of.model, v0 != self.v0) {
            self.v0 = v0;
            self.steering = Steering::of(of_law(p, v0, slope));
        }
    }

    /// By how much noise of a reading changes the load, at most.
    pub(super) fn of_noise(&self) -> f64 {
        self.steering.map_or(0.0, |steering| steering.of_noise())
    }

    /// The control that acts at `v0`.
    fn at(&self, p: &Parameters, v0: f64) -> Option<Steering> {
        let mut then = *self;
        then.look_at(p, v0);
        then.steering
    }

    /// δN at rest of a block that slides at `v0`: 0 unless the model is wrong about a*.
    pub(super) fn load_at_rest(&self, p: &Parameters, v0: f64) -> f64 {
        let steering = self.at(p, v0);
        steering.map_or(0.0, |steering| steering.at_rest(&of_law(p, v0, 1.0)))
    }

    /// The rate ln |z|/h of the slowest zero near sliding at `v0`; none where that is not stable.
    pub(super) fn stable_abscissa(&self, p: &Parameters, v0: f64) -> Option<f64> {
        let z = self.at(p, v0)?.largest_zero(&of_law(p, v0, 1.0));
        (z < 1.0).then(|| ln(z) / p.feedback.readings.sample_time)
    }
}

#[cfg(test)]
mod tests {
    use super::super::motion::{Accuracy, Motion};
    use super::*;
    use crate::model::{Dashpots, Feedback, FrictionLaw, Readings};

    const H: f64 = 0.9;

    fn steered(law: FrictionLaw, viscous: f64, v0: f64, model: MapModel) -> Parameters {
        let mut feedback = Feedback::new(0.0, 1.0, 2.0 * H);
        feedback.readings = Readings {
            sample_time: H,
            ..Readings::default()
        };
        feedback.return_map = Some(ReturnMap {
            amplitude: 0.9,
            model,
        });
        Parameters {
            law,
            velocity_unit: 1.0,
            dashpots: Dashpots {
                damping: 0.0,
                viscous,
            },
            feedback,
            v0,
            switch_on: 0.0,
        }
    }

    fn weakening() -> FrictionLaw {
        FrictionLaw::weakening(0.5, 0.5, 1.0).unwrap()
    }

    /// |ẋ − v0| and |a − a*| at the readings, the larger of both.
    fn deviations(p: &Parameters, off: f64, readings: u32) -> Vec<f64> {
        let mut motion = Motion::new(p.clone(), Accuracy::default(), p.v0 + off, 0.0);
        let rest = of_law(p, p.v0, 1.0).rest;
        motion.a = rest - 0.4 * off;
        let at = |k: u32, motion: &mut Motion| {
            let until = f64::from(k) * H;
            while motion.t < until {
                motion.advance(until);
            }
            (motion.u - p.v0).abs().max((motion.a - rest).abs())
        };
        (0..readings).map(|k| at(k, &mut motion)).collect()
    }

    /// Without friction that depends on the speed a block in slip is linear: two changes of the
    /// load end in sliding. The first needs two readings.
    #[test]
    fn two_loads_end_in_sliding() {
        for viscous in [0.0, 0.3] {
            let law = FrictionLaw::coulomb(0.4, 1.0).unwrap();
            let p = steered(law, viscous, 0.7, MapModel::EXACT);
            let off = deviations(&p, 0.05, 7);
            assert!(off[..3].iter().all(|off| *off > 1e-3), "{off:?}");
            assert!(off[3..].iter().all(|off| *off < 1e-12), "{off:?}");
        }
    }

    /// Under friction that weakens what two loads leave is of second order.
    #[test]
    fn what_is_left_is_of_second_order() {
        let p = steered(weakening(), 0.0, 0.1, MapModel::EXACT);
        let [large, small] = [1e-3, 1e-4].map(|off| deviations(&p, off, 4)[3]);
        assert!(
            small < 1e-6 && (50.0..200.0).contains(&(large / small)),
            "{large} {small}"
        );
    }

    /// A model whose slope is wrong decays as fast as its largest zero says.
    #[test]
    fn a_wrong_slope_decays_by_its_largest_zero() {
        for slope in [0.6, 0.8, 1.2, 1.4] {
            let p = steered(weakening(), 0.0, 0.1, MapModel::Law { slope });
            let controller = Controller::of(&p).unwrap();
            let abscissa = controller.stable_abscissa(&p, p.v0).unwrap();
            let off = deviations(&p, 1e-4, 40);
            // Over many readings, since zeros may be a pair that turns.
            let ends = |from: usize| off[from..from + 6].iter().copied().fold(0.0, f64::max);
            let found = ln(ends(14) / ends(4)) / (10.0 * H);
            assert!(
                (found / abscissa - 1.0).abs() < 0.35,
                "{slope}: {found} {abscissa}"
            );
            assert!(controller.load_at_rest(&p, p.v0) == 0.0);
        }
    }

    /// Zeros of products of known factors.
    #[test]
    fn the_largest_zero_is_found() {
        for [x, y, z] in [
            [0.5, -0.2, 0.1],
            [-0.9, 0.3, 0.3],
            [0.0, 0.0, 1e-3],
            [1.7, 0.2, -1.0],
        ] {
            let cubic = [-(x + y + z), x * y + y * z + z * x, -x * y * z];
            let largest = [x, y, z].map(f64::abs).into_iter().fold(0.0, f64::max);
            let found = largest_zero(cubic);
            assert!((found - largest).abs() < 1e-9, "{found} {largest}");
        }
        // (z² + 0.49)(z − 0.3).
        assert!((largest_zero([-0.3, 0.49, -0.147]) - 0.7).abs() < 1e-12);
    }

    /// A model that is wrong about a* leaves the load changed for good, by what is worked out.
    #[test]
    fn a_wrong_rest_leaves_the_load_changed() {
        let p = steered(weakening(), 0.0, 0.1, MapModel::EXACT);
        let right = of_law(&p, p.v0, 1.0);
        let wrong = Recursion {
            rest: right.rest + 0.01,
            ..right
        };
        let p = steered(weakening(), 0.0, 0.1, MapModel::Known(wrong));
        let expected = Controller::of(&p).unwrap().load_at_rest(&p, p.v0);
        let mut motion = Motion::new(p.clone(), Accuracy::default(), 0.1, right.rest);
        while motion.t < 200.0 {
            motion.advance(200.0);
        }
        let [_, load] = motion.last_reading().unwrap();
        assert!(
            (motion.u - 0.1).abs() < 1e-9 && expected.abs() > 1e-3,
            "{expected}"
        );
        assert!((load - expected).abs() < 1e-9, "{load} {expected}");
        assert!((motion.a - motion.sliding_elongation()).abs() < 1e-9);
    }

    #[test]
    fn sample_times_tell_the_velocity() {
        let [least, most] = sample_times(-0.694);
        let omega = (1.0_f64 - 0.25 * 0.694 * 0.694).sqrt();
        for h in [least, most] {
            assert!((crate::model::elementary::sin(omega * h) - 0.05).abs() < 1e-12);
        }
        assert!(least < 0.1 && most > 3.0);
        let [least, most] = sample_times(2.5);
        assert!(least < 0.0501 && most == f64::INFINITY);
    }
}
