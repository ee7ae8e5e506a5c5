//! The critical velocity in the units of a setting, by either protocol.

use crate::critical::switch_on::{self, Phase, Scan, Trials, Windows};
use crate::critical::{
    CriticalVelocity, CriticalWindows, Method, Problem, RampOptions, Regime, Transition,
    along_delay, by_simulation, critical_velocity,
};
use crate::linear::MarginalTolerance;
use crate::linear::roots::narrowed;
use crate::model::ModelError;
use crate::model::elementary::pow;
use crate::model::stop::Stop;
use crate::setting::regime_at_v0::RegimeAtV0;
use crate::setting::search::Protocol;
use crate::setting::simulation::NOT_IN_MOTIONS;
use crate::setting::values::Setting;
use crate::slip::case::CaseUnits;
use crate::slip::motion::{Accuracy, Integrator};
use crate::slip::readings::check as check_readings;

/// Error allowed in a step when control is switched on.
const SWITCH_ON_ACCURACY: f64 = 1e-9;

/// The factor by which collocation may take more steps.
pub const MORE_STEPS: u64 = 100;

/// The problem of a setting in the units of a motion, and those units.
#[derive(Debug, Clone, PartialEq)]
pub struct VcProblem {
    /// The controlled oscillator.
    pub problem: Problem,
    /// The units of its motions, in units of the setting.
    pub units: CaseUnits,
}

impl VcProblem {
    /// The problem of a setting; its v0 is ignored.
    ///
    /// ```
    /// use slipmap::answers::vc::VcProblem;
    /// use slipmap::setting::law_kind::LawKind;
    /// use slipmap::setting::search::Protocol;
    /// use slipmap::setting::{Parameter, Setting};
    ///
    /// let law = LawKind::named("weakening")?;
    /// let numbers = [("mu0", 0.5), ("v_s", 0.5), ("alpha_v", -0.33), ("tau", 4.15)];
    /// let setting = Setting::checked(numbers, Some(law), &[Parameter::V0])?;
    /// let found = VcProblem::of(&setting)?.find(Protocol::Follow);
    /// assert!(found.critical.vc > 0.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When the setting has no friction law, or a value is outside the model's range: a gain needs
    /// a delay τ > 0.
    pub fn of(setting: &Setting) -> Result<Self, ModelError> {
        setting.check_of_letter(NOT_IN_MOTIONS, "0 where a critical velocity is looked for")?;
        let oscillator = setting.oscillator()?;
        let units = CaseUnits::of(&oscillator);
        let Some(law) = setting.friction_law()? else {
            return Err(ModelError::of_law("a friction law"));
        };
        let feedback = setting.feedback();
        let tau = feedback.tau;
        ModelError::check(
            "tau",
            tau,
            "greater than 0 where a gain acts",
            tau > 0.0 || !feedback.gains.act(),
        )?;
        check_readings(&feedback)?;
        let problem = Problem {
            velocity_unit: units.velocity,
            dashpots: oscillator.dashpot_ratios(),
            ..Problem::new(law, feedback.dimensionless(&oscillator))
        };
        Ok(Self { problem, units })
    }

    /// The same problem with a `stop`: once it is set, answers come soon but are meaningless.
    #[must_use]
    pub fn until(mut self, stop: Stop) -> Self {
        self.problem.stop = stop;
        self
    }

    /// The critical velocity by a protocol.
    #[must_use]
    pub fn find(&self, protocol: Protocol) -> CriticalWindows {
        let Self { problem, units } = self;
        match protocol {
            Protocol::Follow => followed(&critical_velocity(problem), problem, units),
            Protocol::SwitchOn(phase) => {
                let accuracy = Accuracy::of(SWITCH_ON_ACCURACY);
                let scan = Scan::default().within(problem);
                let phase = in_motion_units(phase, units);
                let windows = switch_on::windows(problem, phase, &scan, accuracy);
                let v_max = scan.v_max * problem.law.mu_s();
                switched_on(&windows, v_max, units.velocity)
            }
        }
    }

    /// The fate of stick-slip after switch-on at `phase`, in units of the setting, at two
    /// velocities: below and above `vc` by this share of it.
    #[must_use]
    pub fn survives_beside(
        &self,
        vc: f64,
        beside: f64,
        phase: Phase,
        integrator: Integrator,
    ) -> [Regime; 2] {
        let Self { problem, units } = self;
        let accuracy = Accuracy {
            integrator,
            ..Accuracy::of(SWITCH_ON_ACCURACY)
        };
        let phase = in_motion_units(phase, units);
        let steps = MORE_STEPS * Scan::default().within(problem).steps;
        let mut trials = Trials::new(problem, phase, accuracy, steps);
        let speed = vc / units.velocity;
        [1.0 - beside, 1.0 + beside].map(|share| trials.at(share * speed))
    }

    /// Whether simulation alone agrees with `found`, the answer by the protocol `follow`. It uses
    /// its own steps of v0 and this `integrator`, and must see stick-slip end at the same velocity,
    /// see [`CriticalVelocity::ends_like`].
    ///
    /// Large steps may throw stick-slip from one kind to another, which ends elsewhere. The answer
    /// is therefore false only if the smallest steps disagree, or two larger ones agree on another
    /// end. None where that is inconclusive, or the cell is undecided and claims nothing.
    #[must_use]
    pub fn simulation_agrees(
        &self,
        found: &CriticalVelocity,
        integrator: Integrator,
    ) -> Option<bool> {
        let Self { problem, units } = self;
        if !found.decided {
            return None;
        }
        let mut others = [None; SAMPLE_STEPS.len()];
        let tolerances = sample_tolerances(integrator);
        let steps = SAMPLE_STEPS.into_iter().zip(tolerances);
        for (([first, unseen], tolerance), other) in steps.zip(&mut others) {
            let options = RampOptions {
                first,
                largest: first,
                unseen,
                patient: true,
                total_steps: SAMPLE_TOTAL_STEPS,
                ..RampOptions::default()
            };
            let accuracy = Accuracy {
                integrator,
                ..Accuracy::of(tolerance)
            };
            let again = by_simulation(problem, &options, accuracy);
            if found.ends_like(&in_units(&again, units)) && tells(&again) {
                return Some(true);
            }
            *other = Some(again).filter(|again| again.decided);
        }
        differs(&others).then_some(false)
    }

    /// The regime of `v0`, in units of the setting; `found` is the critical velocity by `protocol`.
    #[must_use]
    pub fn regime_at(
        &self,
        v0: f64,
        protocol: Protocol,
        found: &CriticalWindows,
        tolerance: MarginalTolerance,
    ) -> RegimeAtV0 {
        let Self { problem, units } = self;
        let speed = v0 / units.velocity;
        let count = problem.sliding(speed).count(tolerance);
        if count.marginal {
            return RegimeAtV0::Undecided;
        }
        if !count.stable() {
            return RegimeAtV0::Unstable;
        }
        match protocol {
            Protocol::Follow => beside_sliding(v0, &found.critical),
            Protocol::SwitchOn(phase) => {
                let phase = in_motion_units(phase, units);
                let accuracy = Accuracy::of(SWITCH_ON_ACCURACY);
                let steps = Scan::default().within(problem).steps;
                match Trials::new(problem, phase, accuracy, steps).at(speed) {
                    Regime::Periodic | Regime::Irregular => RegimeAtV0::Bistable,
                    Regime::Ended | Regime::Slips | Regime::NoStickSlip => RegimeAtV0::Stable,
                    Regime::LiftOff => RegimeAtV0::LiftOff,
                    Regime::Undecided => RegimeAtV0::Undecided,
                }
            }
        }
    }

    /// The velocity above which, up to `v_max` (in units of μ_S N0/√(κM)), sliding is linearly
    /// stable and free of stick-slip. Above `free`, which is v_c or its upper bound, stick-slip
    /// does not survive. The result and `free` are in units of the setting. NaN where sliding is
    /// not stable at `v_max`, or `free` is NaN.
    #[must_use]
    pub fn v_smooth(&self, free: f64, v_max: f64) -> f64 {
        let Self { problem, units } = self;
        let unit = problem.law.mu_s();
        let stable = |v0: f64| problem.count(v0).stable();
        let [_, most] = problem.feedback.limits.velocity;
        let (lowest, mut above) = (free / units.velocity, (v_max * unit).min(most));
        if lowest.is_nan() || !stable(above) {
            return f64::NAN;
        }
        let ratio = pow(10.0, -1.0 / COUNTS_PER_DECADE);
        while above > lowest && above > SMALLEST_COUNTED * unit {
            let below = (above * ratio).max(lowest);
            if !stable(below) {
                let enough = |below: f64, above: f64| above - below <= f64::EPSILON * 8.0 * above;
                let (_, above) = narrowed(below, above, enough, |v0| !stable(v0));
                return above * units.velocity;
            }
            above = below;
        }
        free
    }
}

/// The critical velocities of a block of a line by the protocol `follow`, see
/// [`along_delay::critical_velocities`].
#[must_use]
pub fn find_in_line(
    problems: &[Problem],
    units: &CaseUnits,
    stopped: impl Fn() -> bool,
) -> Vec<Option<CriticalWindows>> {
    let found = along_delay::critical_velocities(problems, stopped).into_iter();
    let told = problems.iter().zip(found);
    told.map(|(problem, critical)| critical.map(|found| followed(&found, problem, units)))
        .collect()
}

/// The windows by the protocol `follow`: one from rest, or the smallest v, to the end
/// of stick-slip, or none.
fn followed(found: &CriticalVelocity, problem: &Problem, units: &CaseUnits) -> CriticalWindows {
    let critical = in_units(found, units);
    // No v0 is below the smallest v.
    let least = problem.feedback.limits.velocity[0].max(0.0);
    let top = match critical.transition {
        Transition::LiftOff => critical.v_liftoff,
        Transition::Persists => problem.v_max() * units.velocity,
        _ => critical.vc,
    };
    CriticalWindows {
        critical,
        windows: match critical.sustained {
            true => vec![[least * units.velocity, top]],
            false => Vec::new(),
        },
    }
}

/// The windows by switching on. v_c is the topmost edge of the windows. It is NaN where the topmost
/// window ends only at `v_max`, or where not all v0 were tried.
fn switched_on(found: &Windows, v_max: f64, velocity: f64) -> CriticalWindows {
    let top = found.top();
    let (vc, transition) = match top {
        _ if !found.complete => (f64::NAN, Transition::Never),
        None if found.v_liftoff.is_some() => (f64::NAN, Transition::LiftOff),
        None if !found.decided => (f64::NAN, Transition::Never),
        None => (0.0, Transition::Never),
        Some(top) if top >= v_max * (1.0 - 1e-9) => (f64::NAN, Transition::Persists),
        Some(top) => (top, Transition::Lost),
    };
    let [vc_lower, vc_upper] = match transition {
        Transition::LiftOff => [f64::NAN; 2],
        _ => found.top_within,
    };
    let edge = |v: f64| v * velocity;
    CriticalWindows {
        critical: CriticalVelocity {
            vc: edge(vc),
            vc_lower: edge(vc_lower),
            vc_upper: edge(vc_upper),
            transition,
            method: Method::Simulation,
            v_liftoff: edge(found.v_liftoff.unwrap_or(f64::NAN)),
            stick_time: f64::NAN,
            slip_time: f64::NAN,
            n_min: f64::NAN,
            sustained: top.is_some(),
            decided: found.decided,
        },
        windows: found.survives.iter().map(|w| w.map(edge)).collect(),
    }
}

/// `found` in physical units.
fn in_units(found: &CriticalVelocity, units: &CaseUnits) -> CriticalVelocity {
    CriticalVelocity {
        vc: found.vc * units.velocity,
        vc_lower: found.vc_lower * units.velocity,
        vc_upper: found.vc_upper * units.velocity,
        v_liftoff: found.v_liftoff * units.velocity,
        stick_time: found.stick_time * units.time,
        slip_time: found.slip_time * units.time,
        n_min: found.n_min * units.force,
        ..*found
    }
}

fn in_motion_units(phase: Phase, units: &CaseUnits) -> Phase {
    match phase {
        Phase::After(time) => Phase::After(time / units.time),
        Phase::Worst(_) => phase,
    }
}

/// Relative first steps of v0 where a cell is recomputed, and the steps through regions where
/// stick-slip ends by chance. They differ from those of the first computation. The smallest ones
/// throw stick-slip least from one kind to another; they decide where larger ones lead elsewhere.
const SAMPLE_STEPS: [[f64; 2]; 3] = [[0.35, 0.1], [0.05, 0.02], [0.02, 0.005]];
/// The most steps of the integrator in such a search.
const SAMPLE_TOTAL_STEPS: u64 = 10_000_000;
/// The errors of a step of the integrator in these searches.
const fn sample_tolerances(integrator: Integrator) -> [f64; 3] {
    match integrator {
        Integrator::Taylor => [1e-10, 1e-11, 1e-12],
        Integrator::Collocation => [1e-9, 1e-9, 1e-10],
    }
}

/// Whether searches by smaller and smaller steps, with other ends, contradict a cell.
fn differs(others: &[Option<CriticalVelocity>]) -> bool {
    let alike = |pair: &[Option<CriticalVelocity>]| match pair {
        [Some(one), Some(other)] => one.ends_like(other),
        _ => false,
    };
    others.last().is_some_and(Option::is_some) || others.windows(2).any(alike)
}

/// Whether a simulation is conclusive. One that gave up may have found an end, but not that there
/// is none.
fn tells(again: &CriticalVelocity) -> bool {
    again.decided || !matches!(again.transition, Transition::Persists | Transition::Never)
}

/// The regime of `v0` by the protocol `follow`, where sliding at `v0` is linearly stable: below
/// both bounds of the critical velocity, above both, or undecided.
fn beside_sliding(v0: f64, critical: &CriticalVelocity) -> RegimeAtV0 {
    let lifts_off = critical.transition == Transition::LiftOff;
    if lifts_off && !critical.sustained {
        // There are no bounds, because there is no stick-slip below.
        return match v0 >= critical.v_liftoff {
            _ if !critical.decided => RegimeAtV0::Undecided,
            true => RegimeAtV0::LiftOff,
            false => RegimeAtV0::Stable,
        };
    }
    if lifts_off && v0 >= critical.vc_upper {
        RegimeAtV0::LiftOff
    } else if v0 <= critical.vc_lower {
        RegimeAtV0::Bistable
    } else if v0 > critical.vc_upper {
        RegimeAtV0::Stable
    } else {
        RegimeAtV0::Undecided
    }
}

/// Velocities per decade at which unstable roots are counted.
const COUNTS_PER_DECADE: f64 = 64.0;
/// The smallest of these velocities, in units of μ_S N0/√(κM).
const SMALLEST_COUNTED: f64 = 1e-6;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Feedback, FrictionLaw};

    fn critical(transition: Transition, vc: f64, v_liftoff: f64) -> CriticalVelocity {
        let end = if v_liftoff.is_nan() { vc } else { v_liftoff };
        let persists = transition == Transition::Persists;
        CriticalVelocity {
            vc,
            vc_lower: if persists { 100.0 } else { end },
            vc_upper: end,
            transition,
            method: Method::Simulation,
            v_liftoff,
            stick_time: f64::NAN,
            slip_time: f64::NAN,
            n_min: f64::NAN,
            sustained: transition != Transition::Never,
            decided: true,
        }
    }

    #[test]
    fn stick_slip_beside_stable_sliding() {
        let none = f64::NAN;
        for (transition, vc, v_liftoff, at, regime) in [
            (Transition::Grazing, 0.3, none, 0.29, RegimeAtV0::Bistable),
            (Transition::Grazing, 0.3, none, 0.31, RegimeAtV0::Stable),
            (Transition::Never, 0.0, none, 1e-9, RegimeAtV0::Stable),
            (Transition::LiftOff, none, 0.2, 0.1, RegimeAtV0::Bistable),
            (Transition::LiftOff, none, 0.2, 0.2, RegimeAtV0::LiftOff),
            (Transition::Persists, none, none, 5.0, RegimeAtV0::Bistable),
            (
                Transition::Persists,
                none,
                none,
                101.0,
                RegimeAtV0::Undecided,
            ),
        ] {
            let mut critical = critical(transition, vc, v_liftoff);
            assert_eq!(beside_sliding(at, &critical), regime, "{transition:?} {at}");
            critical.decided = false;
            (critical.vc_lower, critical.vc_upper) = (0.0, none);
            assert_eq!(beside_sliding(at, &critical), RegimeAtV0::Undecided);
        }
    }

    /// Outside its bounds an undecided critical velocity still gives a regime.
    #[test]
    fn bounds_tell_the_class() {
        for (transition, v_liftoff, classes) in [
            (
                Transition::Irregular,
                f64::NAN,
                [
                    RegimeAtV0::Bistable,
                    RegimeAtV0::Undecided,
                    RegimeAtV0::Stable,
                ],
            ),
            (
                Transition::LiftOff,
                0.3,
                [
                    RegimeAtV0::Bistable,
                    RegimeAtV0::Undecided,
                    RegimeAtV0::LiftOff,
                ],
            ),
        ] {
            let critical = CriticalVelocity {
                vc_lower: 0.29,
                vc_upper: 0.32,
                decided: false,
                ..critical(transition, 0.3, v_liftoff)
            };
            let found = [0.28, 0.3, 0.33].map(|v0| beside_sliding(v0, &critical));
            assert_eq!(found, classes);
        }
    }

    /// If a block lifts off and does not stick at lower velocities, sliding has no stick-slip
    /// beside it below.
    #[test]
    fn lift_off_without_stick_slip_below() {
        let mut lifted = critical(Transition::LiftOff, f64::NAN, 0.2);
        lifted.sustained = false;
        for (v0, regime) in [(0.1, RegimeAtV0::Stable), (0.2, RegimeAtV0::LiftOff)] {
            assert_eq!(beside_sliding(v0, &lifted), regime);
        }
    }

    /// By the protocol `follow` a window reaches from rest to the end of stick-slip: v_c, lift-off,
    /// or the end of the range.
    #[test]
    fn whatever_ends_a_window_it_counts() {
        let law = FrictionLaw::coulomb(0.5, 2.0).unwrap();
        let problem = Problem::new(law, Feedback::new(0.0, 0.0, 1.0));
        let units = CaseUnits {
            time: 1.0,
            length: 3.0,
            velocity: 3.0,
            force: 1.0,
        };
        let windows = |found: &CriticalVelocity| followed(found, &problem, &units).windows;
        let none = f64::NAN;
        for (transition, vc, v_liftoff, top) in [
            (Transition::Grazing, 0.3, none, 0.9),
            (Transition::LiftOff, none, 0.2, 0.6),
            // v_max is 100 μ_S.
            (Transition::Persists, none, none, 600.0),
        ] {
            let found = windows(&critical(transition, vc, v_liftoff));
            assert_eq!(found.len(), 1, "{transition:?}");
            assert!(found[0][0] == 0.0 && (found[0][1] / top - 1.0).abs() < 1e-14);
        }
        assert!(windows(&critical(Transition::Never, 0.0, none)).is_empty());
        let mut lifted = critical(Transition::LiftOff, none, 0.2);
        lifted.sustained = false;
        assert!(windows(&lifted).is_empty());
    }

    /// A simulation that gave up is not conclusive about stick-slip that persists or never exists;
    /// one that found an end is.
    #[test]
    fn who_gives_up_does_not_agree() {
        for (transition, alone) in [
            (Transition::Persists, false),
            (Transition::Never, false),
            (Transition::Grazing, true),
            (Transition::LiftOff, true),
        ] {
            let mut again = critical(transition, 0.3, 0.3);
            assert!(tells(&again));
            again.decided = false;
            assert_eq!(tells(&again), alone, "{transition:?}");
        }
    }

    /// The smallest steps alone contradict, and two larger ones together. A single larger one may
    /// have been thrown elsewhere.
    #[test]
    fn ends_elsewhere_contradict_together() {
        let at = |vc: f64| Some(critical(Transition::Grazing, vc, f64::NAN));
        for (others, contradict) in [
            ([at(0.1), at(0.3), None], false),
            ([at(0.3), None, None], false),
            ([at(0.3), at(0.3), None], true),
            ([None, None, at(0.3)], true),
            ([at(0.1), at(0.3), at(0.3)], true),
            ([None; 3], false),
        ] {
            assert_eq!(differs(&others), contradict, "{others:?}");
        }
    }

    /// The topmost window counts, and one that is open at the end of the range has no edge.
    #[test]
    fn windows_tell_the_critical_velocity() {
        let windows = |survives: Vec<[f64; 2]>, v_liftoff| Windows {
            top_within: [survives.last().map_or(0.0, |window| window[1]); 2],
            survives,
            v_liftoff,
            decided: true,
            complete: true,
        };
        let two = vec![[0.001, 0.2], [0.3, 0.4]];
        let found = switched_on(&windows(two, Some(0.25)), 10.0, 2.0);
        assert_eq!(
            (found.critical.vc, found.critical.transition),
            (0.8, Transition::Lost)
        );
        assert_eq!(found.windows, [[0.002, 0.4], [0.6, 0.8]]);
        let bounds = |found: &CriticalWindows| [found.critical.vc_lower, found.critical.vc_upper];
        assert_eq!(bounds(&found), [0.8; 2]);
        let found = switched_on(&windows(vec![[0.1, 10.0]], None), 10.0, 1.0);
        assert!(found.critical.vc.is_nan() && found.critical.transition == Transition::Persists);
        assert_eq!(found.windows.len(), 1);
        let cut = Windows {
            decided: false,
            complete: false,
            ..windows(vec![[0.1, 0.2]], None)
        };
        let found = switched_on(&cut, 10.0, 1.0);
        assert!(found.critical.vc.is_nan() && !found.critical.decided);
        let found = switched_on(&windows(vec![], None), 10.0, 1.0);
        assert!(found.critical.vc == 0.0 && found.critical.transition == Transition::Never);
        let found = switched_on(&windows(vec![], Some(0.1)), 10.0, 1.0);
        assert!(found.critical.vc.is_nan() && found.critical.transition == Transition::LiftOff);
    }
}
