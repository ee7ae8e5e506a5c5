//! A block whose v0 follows a programme: its corners, and v0 between them.
//!
//! v0 is linear in time within a step, and steps end on corners. There a has a kink: its first
//! derivative jumps with v0, its second one with the slope of v0.

use super::{Event, Mode, Motion};
use crate::slip::history::SMOOTH;
use crate::slip::programme::Corner;

/// Where v0 is on its way, in the units of a motion.
#[derive(Debug, Clone)]
pub(super) struct Course {
    corners: Box<[Corner]>,
    /// The index of the corner ahead.
    ahead: usize,
    /// The time of the last corner, or 0, and v0 from then on.
    from: (f64, f64),
}

impl Course {
    /// The time of the corner ahead; +∞ where there is none.
    fn next(&self) -> f64 {
        self.corners.get(self.ahead).map_or(f64::INFINITY, |c| c.at)
    }

    /// The slope of v0 until the corner ahead.
    fn slope(&self) -> f64 {
        let ahead = self.corners.get(self.ahead);
        ahead.map_or(0.0, |corner| corner.slope_from(self.from))
    }
}

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
    pub(in crate::slip) fn last_v0(&self) -> f64 {
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
