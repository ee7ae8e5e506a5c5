//! A block whose v0 follows a programme: its corners, and v0 between them.
//!
//! v0 is linear in time within a step, and steps end on corners. There a has a kink: its first
//! derivative jumps with v0, its second one with the slope of v0.

use super::course::Course;
use super::{Event, Mode, Motion};
use crate::slip::history::SMOOTH;
use crate::slip::programme::Corner;

impl Motion {
    /// From t = 0, which is now, v0 follows these corners, of times that increase from 0 on.
    pub(in crate::slip) fn follow_programme(&mut self, corners: Box<[Corner]>) {
        if corners.is_empty() {
            return;
        }
        let course = Course {
            corners,
            ahead: 0,
            from: (0.0, self.parameters.v0),
        };
        (self.corner, self.slope) = (course.next(), course.slope());
        self.course = Some(Box::new(course));
    }

    /// v0 in the end.
    #[must_use]
    pub(crate) fn last_v0(&self) -> f64 {
        let last = self.course.as_ref().and_then(|c| c.corners.last());
        last.map_or(self.parameters.v0, |corner| corner.v0)
    }

    /// Since when v0 is what it is in the end: the last corner; −∞ without a programme.
    #[must_use]
    pub(in crate::slip) fn last_corner(&self) -> f64 {
        let last = self.course.as_ref().and_then(|c| c.corners.last());
        last.map_or(f64::NEG_INFINITY, |corner| corner.at)
    }

    /// Brings v0 to where a ramp has it now.
    #[cold]
    pub(super) fn climb(&mut self) {
        if let Some(course) = &self.course {
            let (since, v0) = course.from;
            self.parameters.v0 = v0 + self.slope * (self.t - since);
        }
    }

    /// Passes the corner ahead, which is now. Returns the order of the kink of a there.
    #[cold]
    pub(super) fn pass_corner(&mut self) -> u32 {
        let (before, slope) = (self.parameters.v0, self.slope);
        let Some(course) = &mut self.course else {
            return SMOOTH;
        };
        let Some(corner) = course.corners.get(course.ahead) else {
            return SMOOTH;
        };
        course.from = (corner.at, corner.v0);
        let jumps = !corner.ramp && corner.v0 != before;
        course.ahead += 1;
        self.parameters.v0 = course.from.1;
        (self.corner, self.slope) = (course.next(), course.slope());
        if self.mode == Mode::Stick {
            self.even_since = self.t;
        }
        match (jumps, self.slope == slope) {
            (true, _) => 1,
            (false, false) => 2,
            (false, true) => SMOOTH,
        }
    }

    /// Passes a corner that is not later than the end of the last step, by a step of no length.
    #[cold]
    pub(super) fn pass_corner_here(&mut self) -> Event {
        self.step.move_to_end();
        let kink = self.pass_corner();
        (self.kink, self.signal_kink) = (self.kink.min(kink), self.signal_kink.min(kink));
        Event::Programme
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Accuracy, Integrator};
    use super::*;
    use crate::model::{ActuatorLimits, Dashpots, Feedback, FrictionLaw, Oscillator};
    use crate::slip::case::{Case, Start};
    use crate::slip::outcome::Outcome;
    use crate::slip::programme::Programme;

    fn corner(at: f64, v0: f64, ramp: bool) -> Corner {
        Corner { at, v0, ramp }
    }

    /// A case with M = κ = N0 = 1, without control.
    fn case(law: FrictionLaw, v0: f64, (x_dot0, a0): (f64, f64), corners: &[Corner]) -> Case {
        Case {
            oscillator: Oscillator::default(),
            law,
            feedback: Feedback::new(0.0, 0.0, 1.0),
            v0,
            programme: Programme(corners.to_vec()),
            switch_on: f64::INFINITY,
            start: Start::State { x_dot0, a0 },
            horizon: 1000.0,
            steps: 1_000_000,
            accuracy: Accuracy::default(),
        }
    }

    fn coulomb() -> FrictionLaw {
        FrictionLaw::coulomb(0.5, 1.0).unwrap()
    }

    fn weakening() -> FrictionLaw {
        FrictionLaw::weakening(0.5, 0.5, 1.0).unwrap()
    }

    /// The letter's Fig. 3(a), controlled from t = 70 on.
    fn fig3a(corners: &[Corner]) -> Case {
        Case {
            feedback: Feedback::new(-0.33, 0.0, 4.15),
            switch_on: 70.0,
            ..case(weakening(), 0.35, (0.3535, 0.294), corners)
        }
    }

    /// Times and kinds of events until `end`, and the motion there.
    fn events(case: &Case, end: f64) -> (Vec<(f64, Event)>, Motion) {
        let mut motion = case.motion().unwrap();
        let mut events = Vec::new();
        while motion.t < end {
            let event = motion.advance(end);
            events.extend(event.map(|event| (motion.t, event)));
        }
        (events, motion)
    }

    fn by(integrator: Integrator, case: &Case) -> Case {
        let accuracy = Accuracy {
            integrator,
            tolerance: 1e-12,
        };
        Case {
            accuracy,
            ..case.clone()
        }
    }

    /// A stuck block on a ramp: a = a0 + v0 t + k t²/2, so it is released where that is μ_S.
    #[test]
    fn a_stick_on_a_ramp_has_its_closed_form() {
        let corners = [corner(4.0, 0.5, true)];
        let given = case(coulomb(), 0.1, (0.0, 0.0), &corners);
        // Powers of s lose digits of what collocation knows at its nodes.
        for (integrator, most) in [(Integrator::Taylor, 1e-13), (Integrator::Collocation, 1e-9)] {
            let (found, _) = events(&by(integrator, &given), 3.9);
            // 0.1 t + 0.05 t² = 1.
            let release = 21.0_f64.sqrt() - 1.0;
            assert!(
                matches!(found[..], [(t, Event::Release), ..] if (t - release).abs() < most),
                "{found:?}"
            );
        }
    }

    /// Coulomb slip: with e = a − μ and ȧ = v0 + k t − ẋ it is ë = k − e, to the end of the ramp;
    /// beyond it ë = −e.
    #[test]
    fn a_slip_on_a_ramp_has_its_closed_form() {
        let (v0, slope, at, end) = (1.0, 0.4, 2.5, 4.0);
        let (u0, e0) = (1.3, 0.2);
        let given = case(coulomb(), v0, (u0, 0.5 + e0), &[corner(at, 2.0, true)]);
        let (cos, sin) = (at.cos(), at.sin());
        let rate = v0 - u0;
        let e = slope + (e0 - slope) * cos + rate * sin;
        let e_rate = -(e0 - slope) * sin + rate * cos;
        let left: f64 = end - at;
        let exact = e * left.cos() + e_rate * left.sin();
        for (integrator, most) in [(Integrator::Taylor, 1e-11), (Integrator::Collocation, 1e-9)] {
            let (found, motion) = events(&by(integrator, &given), end);
            assert_eq!(found, [(at, Event::Programme)]);
            assert!((motion.a - 0.5 - exact).abs() < most, "{}", motion.a);
            assert_eq!(motion.parameters().v0, 2.0);
        }
    }

    /// Corners are events at their times, at switch-on too.
    #[test]
    fn corners_are_events() {
        let corners = [
            corner(10.3, 0.4, false),
            corner(20.7, 0.2, true),
            corner(70.0, 0.3, false),
            corner(75.1, 0.5, true),
        ];
        let (found, motion) = events(&fig3a(&corners), 100.0);
        let there = found.iter().filter(|(_, event)| *event == Event::Programme);
        let times: Vec<f64> = there.map(|(t, _)| *t).collect();
        assert_eq!(times, corners.map(|corner| corner.at));
        let at = found.iter().position(|(t, _)| *t == 70.0).unwrap();
        assert_eq!(found[at].1, Event::SwitchOn);
        assert_eq!(found[at + 1], (70.0, Event::Programme));
        assert_eq!((motion.last_v0(), motion.last_corner()), (0.5, 75.1));
    }

    /// Corners to the same v0 change nothing.
    #[test]
    fn a_constant_programme_changes_nothing() {
        let corners = [corner(33.0, 0.35, false), corner(75.0, 0.35, true)];
        let (plain, _) = events(&fig3a(&[]), 120.0);
        let (mut found, _) = events(&fig3a(&corners), 120.0);
        found.retain(|(_, event)| *event != Event::Programme);
        assert_eq!(found.len(), plain.len());
        for (one, other) in found.iter().zip(&plain) {
            assert!(one.1 == other.1 && (one.0 - other.0).abs() < 1e-11 * (1.0 + one.0));
        }
    }

    /// A dashpot pulls at a stuck block as soon as v0 jumps.
    #[test]
    fn a_jump_under_damping_releases() {
        let dashpots = Dashpots {
            damping: 0.5,
            viscous: 0.0,
        };
        let plain = case(coulomb(), 0.1, (0.0, 0.0), &[corner(5.0, 2.0, false)]);
        let damped = Case {
            oscillator: Oscillator::default().damped(dashpots).unwrap(),
            ..plain
        };
        // a + d v0 is 0.55 before and 1.5 after.
        let (found, _) = events(&damped, 5.1);
        assert_eq!(found, [(5.0, Event::Programme), (5.0, Event::Release)]);
    }

    /// Under control errors fall with the tolerance.
    #[test]
    fn events_converge_with_the_tolerance() {
        let corners = [
            corner(20.0, 0.5, true),
            corner(60.0, 0.3, false),
            corner(80.0, 0.35, true),
        ];
        let release = |tolerance: f64, integrator: Integrator| {
            let accuracy = Accuracy {
                integrator,
                tolerance,
            };
            let case = Case {
                accuracy,
                ..fig3a(&corners)
            };
            let (found, _) = events(&case, 130.0);
            let slips = found.iter().filter(|(_, event)| *event == Event::Release);
            slips.map(|(t, _)| *t).collect::<Vec<_>>()
        };
        let exact = release(1e-15, Integrator::Taylor);
        assert!(
            exact.len() >= 5 && exact.iter().any(|t| *t > 70.0),
            "{exact:?}"
        );
        let off = |found: Vec<f64>| {
            assert_eq!(found.len(), exact.len());
            let each = found
                .iter()
                .zip(&exact)
                .map(|(one, other)| (one - other).abs());
            each.fold(0.0, f64::max)
        };
        for digits in [6, 8, 10, 12] {
            let tolerance = 0.1_f64.powi(digits);
            let error = off(release(tolerance, Integrator::Taylor));
            assert!(error < 1e3 * tolerance + 1e-11, "{error:e} at 1e-{digits}");
        }
        let error = off(release(1e-12, Integrator::Collocation));
        assert!(error < 1e-7, "{error:e} by collocation");
    }

    /// A ramp of v0 reaches a limit of v: v is held there, and both integrators agree.
    #[test]
    fn ramps_pass_limits() {
        let corners = [corner(72.0, 0.5, true), corner(90.0, 0.1, true)];
        let plain = fig3a(&corners);
        let limits = ActuatorLimits {
            velocity: [0.05, 0.52],
            ..plain.feedback.limits
        };
        let feedback = Feedback {
            limits,
            ..plain.feedback
        };
        let limited = Case { feedback, ..plain };
        let found = [Integrator::Taylor, Integrator::Collocation]
            .map(|integrator| events(&by(integrator, &limited), 120.0).0);
        assert_eq!(found[0].len(), found[1].len());
        for (one, other) in found[0].iter().zip(&found[1]) {
            assert!(
                one.1 == other.1 && (one.0 - other.0).abs() < 1e-7,
                "{one:?} {other:?}"
            );
        }
        let summary = limited.run(&mut ()).unwrap();
        assert!(summary.time_at_limit > 0.1, "{summary:?}");
    }

    /// The outcome is that after the last corner: sliding at 0.1 is unstable without control, and
    /// at 0.35 the letter's control ends stick-slip.
    #[test]
    fn the_outcome_is_that_of_the_last_v0() {
        let slow = fig3a(&[corner(200.0, 0.1, false)]).run(&mut ()).unwrap();
        assert_eq!(slow.outcome, Outcome::StickSlip, "{slow:?}");
        assert!(slow.decided > 200.0);
        let from_slow = Case {
            v0: 0.1,
            ..fig3a(&[corner(200.0, 0.35, false)])
        };
        let summary = from_slow.run(&mut ()).unwrap();
        assert_eq!(summary.outcome, Outcome::Sliding, "{summary:?}");
        assert!(
            summary.decided > 200.0 && summary.settle_time > 130.0,
            "{summary:?}"
        );
        assert_eq!(from_slow.stable_abscissa(), fig3a(&[]).stable_abscissa());
    }
}
