//! Event functions: numbers that are positive along a branch of periodic stick-slip. One of them
//! vanishes where the branch ends or changes its kind.
//!
//! All have one sign: positive before the event, zero at it. They are numbered as on the page of
//! [`super`].
//!
//! ```text
//! depth          g_i = −min ẋ beyond the stop of slip i     g = 0: the stop is a graze     (E1)
//! load           min N over the period                      g = 0: lift-off                (E2)
//! stick time     the shortest stick                         g = 0: the stick vanishes      (E3)
//! missing force  the least μ_S N − |κa| at a stop           g = 0: the block turns back    (E4)
//! dip            the lowest minimum of ẋ before a stop      g = 0: a new stop              (E5)
//! ```
//!
//! (E1) is smooth in v0 up to its zero, where the slip time has a square root. For it the Taylor
//! polynomial of the last step of a slip is continued beyond the stop as if friction had not
//! changed its sign there.
//!
//! A new event function needs a variant and a field here, and its value in each cycle and period
//! (`return_map`). It needs a rule for a branch at its zero (`continuation`, `end_of_branch`,
//! `memoryless`), and a row in the table of [`super`]. For simulation to see it, it needs a line in
//! `regime::Response::event_functions`. The compiler asks for the rest.

/// The most slips in a period that is followed by continuation.
pub(super) const MOST_SLIPS: usize = 4;

/// The number of event functions.
pub(super) const EVENTS: usize = MOST_SLIPS + 4;

/// The zero of an event function.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Event {
    /// The stop of this slip, counted from 0, is a graze: ẋ = ẍ = 0 (E1).
    Graze(usize),
    /// N = 0 (E2).
    LiftOff,
    /// A stick of length 0 (E3).
    StickVanishes,
    /// At a stop the spring is as strong as static friction: the block turns back (E4).
    Reversal,
    /// A minimum of ẋ before a stop comes down to 0: a new stop (E5).
    NewStop,
}

impl Event {
    /// Whether stick-slip or the model may end at this event. Other events only change the kind of
    /// stick-slip.
    pub(super) const fn may_end(self) -> bool {
        matches!(self, Self::Graze(_) | Self::LiftOff | Self::StickVanishes)
    }

    /// Whether the event function of this event is a velocity; else it is a force or a time.
    const fn of_velocity(self) -> bool {
        matches!(self, Self::Graze(_) | Self::NewStop)
    }
}

/// The event functions of one period; NaN where the period has no such number. The same struct
/// holds their derivatives with respect to v0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct EventFunctions {
    /// How far below 0 each slip would have gone beyond its stop, in N0/√(κM).
    pub depth: [f64; MOST_SLIPS],
    /// The smallest load, in N0.
    pub load: f64,
    /// The shortest stick, in √(M/κ).
    pub stick_time: f64,
    /// The least force that is missing at a stop for the block to turn back, in N0.
    pub missing_force: f64,
    /// The lowest minimum of ẋ > 0 before a stop, in N0/√(κM).
    pub dip: f64,
}

impl EventFunctions {
    /// Event functions of which nothing is known.
    pub(super) const UNKNOWN: Self = Self {
        depth: [f64::NAN; MOST_SLIPS],
        load: f64::NAN,
        stick_time: f64::NAN,
        missing_force: f64::NAN,
        dip: f64::NAN,
    };

    /// The event function of `event` alone; the others are unknown.
    pub(super) fn alone(event: Event, value: f64) -> Self {
        let mut one = Self::UNKNOWN;
        match event {
            Event::Graze(slip) => one.depth[slip] = value,
            Event::LiftOff => one.load = value,
            Event::StickVanishes => one.stick_time = value,
            Event::Reversal => one.missing_force = value,
            Event::NewStop => one.dip = value,
        }
        one
    }

    /// Each event function with its event: (E1) to (E5) in order.
    pub(super) fn each(&self) -> [(Event, f64); EVENTS] {
        let others = [
            (Event::LiftOff, self.load),
            (Event::StickVanishes, self.stick_time),
            (Event::Reversal, self.missing_force),
            (Event::NewStop, self.dip),
        ];
        std::array::from_fn(|i| match i.checked_sub(MOST_SLIPS) {
            None => (Event::Graze(i), self.depth[i]),
            Some(other) => others[other],
        })
    }

    /// The event function that vanishes at `event`.
    pub(super) fn of(&self, event: Event) -> f64 {
        match event {
            Event::Graze(slip) => self.depth[slip],
            Event::LiftOff => self.load,
            Event::StickVanishes => self.stick_time,
            Event::Reversal => self.missing_force,
            Event::NewStop => self.dip,
        }
    }

    /// `f` of each event function and the same one of `other`.
    pub(super) fn with(&self, other: &Self, f: impl Fn(f64, f64) -> f64) -> Self {
        Self {
            depth: std::array::from_fn(|slip| f(self.depth[slip], other.depth[slip])),
            load: f(self.load, other.load),
            stick_time: f(self.stick_time, other.stick_time),
            missing_force: f(self.missing_force, other.missing_force),
            dip: f(self.dip, other.dip),
        }
    }

    /// The noise of the event function of `event` at `v0`, where forces and times are known to
    /// `noise`.
    pub(super) fn noise(event: Event, noise: f64, v0: f64) -> f64 {
        match event.of_velocity() {
            true => noise * v0,
            false => noise,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn some() -> EventFunctions {
        EventFunctions {
            depth: [0.1, 0.2, f64::NAN, f64::NAN],
            load: 0.3,
            stick_time: 0.4,
            missing_force: 0.5,
            dip: 0.6,
        }
    }

    #[test]
    fn each_has_its_event() {
        let all = some();
        let found: Vec<f64> = all.each().iter().map(|one| one.1).collect();
        assert_eq!(found[..2], [0.1, 0.2]);
        assert_eq!(found[MOST_SLIPS..], [0.3, 0.4, 0.5, 0.6]);
        for (event, value) in all.each() {
            assert_eq!(all.of(event).to_bits(), value.to_bits(), "{event:?}");
            let alone = EventFunctions::alone(event, 0.7).each();
            let known = alone.into_iter().filter(|one| !one.1.is_nan());
            assert_eq!(known.collect::<Vec<_>>(), [(event, 0.7)]);
        }
    }

    #[test]
    fn they_are_combined_one_by_one() {
        let sum = some().with(&some(), |a, b| a + b);
        assert_eq!((sum.depth[1], sum.dip), (0.4, 1.2));
        assert!(sum.depth[2].is_nan());
    }

    #[test]
    fn velocities_have_noise_in_proportion_to_v0() {
        let noise = |event| EventFunctions::noise(event, 1e-6, 0.01);
        assert_eq!(noise(Event::Graze(0)), noise(Event::NewStop));
        assert_eq!(noise(Event::LiftOff), 1e-6);
        assert_eq!(noise(Event::StickVanishes), 1e-6);
        assert!(noise(Event::NewStop) < 1.1e-8);
    }

    #[test]
    fn at_some_events_stick_slip_only_changes() {
        let ends = some().each().map(|(event, _)| event.may_end());
        assert_eq!(ends, [true, true, true, true, true, true, false, false]);
    }
}
