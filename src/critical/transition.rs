//! How stick-slip ends or changes its kind as v0 grows, what follows, and why that may not be
//! known.

use super::event_functions::Event;
use super::options::TransitionOptions;
use super::problem::{CriticalVelocity, Method};
use super::return_map::Period;

/// How stick-slip ends at v_c.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Transition {
    /// The slip grazes ẋ = ẍ = 0 at its end.
    Grazing,
    /// The orbit vanishes, as where its stick does, or loses its stability, while its stops are
    /// still crossings of ẋ = 0.
    Fold,
    /// The last stick-slip has more than one slip in a period: one period has doubled before.
    PeriodDoubling,
    /// The last stick-slip does not repeat.
    Irregular,
    /// N ≤ 0 on the way: the model ends at `v_liftoff`, and there is no v_c.
    LiftOff,
    /// Stick-slip survives up to the largest v0 that was tried.
    Persists,
    /// No stick-slip is sustained at any v0 that was tried: v_c = 0.
    Never,
    /// Stick-slip does not survive switching on above v_c. The protocol [`super::switch_on`] does
    /// not tell how it ends.
    Lost,
}

impl Transition {
    /// All transitions, in the order of their numbers in a map.
    pub(crate) const ALL: [Self; 8] = [
        Self::Grazing,
        Self::Fold,
        Self::PeriodDoubling,
        Self::Irregular,
        Self::LiftOff,
        Self::Persists,
        Self::Never,
        Self::Lost,
    ];

    /// The name in maps and messages.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Grazing => "grazing",
            Self::Fold => "fold",
            Self::PeriodDoubling => "period-doubling",
            Self::Irregular => "irregular",
            Self::LiftOff => "lift-off",
            Self::Persists => "persists",
            Self::Never => "never",
            Self::Lost => "lost",
        }
    }
}

/// Why the end of a branch, or what follows it, is not known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Undetermined {
    /// There is no orbit where the branch should begin.
    NotSustained,
    /// Periods do not come to rest, however small the step of v0: the orbit loses its stability
    /// without an event.
    NotSettled,
    /// The branch goes on beyond the velocities that are searched, or gains a memory.
    OutsideDomain,
    /// Steps fail, but no event function vanishes there.
    NoEvent,
    /// Too many v0 were tried.
    TooManyTrials,
    /// The event is not where it was located, or its orbit does not attract.
    NotConfirmed,
    /// The block comes near another stop beyond the event, or its outcome takes too long.
    TooClose,
}

/// An event on a branch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Located {
    pub event: Event,
    pub v0: f64,
}

/// An event with the last period before it. A period whose second slip or a later one grazes begins
/// with that slip, so that the first one grazes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ending {
    pub event: Event,
    pub v0: f64,
    pub period: Period,
}

/// What follows an event as v0 grows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Sequel {
    /// Stick-slip ends. The number is a lower bound of the minima of ẋ after that, over v0: 0 where
    /// none is known, 1 where the stick vanished or the block lifts off.
    Ends(f64),
    /// Stick-slip with so many slips in a period.
    Periodic(usize),
    /// Stick-slip that does not repeat.
    Irregular,
    /// What follows is not known.
    Undetermined(Undetermined),
}

impl Ending {
    /// The ending at a located event.
    pub(super) fn new(Located { event, v0 }: Located, period: Period) -> Self {
        Self { event, v0, period }
    }

    /// This ending as the end of stick-slip: an event that else only changes its kind counts as the
    /// vanishing of its stick.
    pub(super) fn of_stick_slip(self) -> Self {
        match self.event.may_end() {
            true => self,
            false => Self {
                event: Event::StickVanishes,
                ..self
            },
        }
    }

    /// The critical velocity, where stick-slip ends, found by `method`.
    pub(super) fn critical_velocity(&self, method: Method) -> CriticalVelocity {
        let (v0, period) = (self.v0, &self.period);
        let (transition, longer) = match self.event {
            Event::LiftOff => return CriticalVelocity::of_lift_off(v0, method),
            // At the graze itself the slip lasts until the minimum of ẋ.
            Event::Graze(_) => {
                let to_minimum = period.cycles()[0].to_minimum;
                (Transition::Grazing, to_minimum.min(period.stick_time()))
            }
            Event::StickVanishes | Event::Reversal | Event::NewStop => (Transition::Fold, 0.0),
        };
        CriticalVelocity {
            stick_time: period.stick_time() - longer,
            slip_time: period.slip_time() + longer,
            n_min: period.n_min(),
            ..CriticalVelocity::nothing(v0, transition, method)
        }
    }
}

/// Whether the slip `i` is the same in two periods.
pub(super) fn same_slip(
    one: &Period,
    other: &Period,
    i: usize,
    options: &TransitionOptions,
) -> bool {
    (one.cycles()[i].slip / other.cycles()[i].slip - 1.0).abs() <= options.same_slip
}

#[cfg(test)]
mod tests {
    use super::super::return_map::Cycle;
    use super::*;

    fn ending(event: Event) -> Ending {
        let cycle = Cycle {
            to_minimum: 0.3,
            slip: 3.0,
            stick: 2.0,
            n_min: 0.5,
            ..Cycle::NONE
        };
        Ending {
            event,
            v0: 0.4,
            period: Period::of(cycle),
        }
    }

    #[test]
    fn names_are_told_apart() {
        let mut names = Transition::ALL.map(Transition::name);
        names.sort_unstable();
        assert!(names.windows(2).all(|pair| pair[0] != pair[1]));
        assert!(Transition::ALL.is_sorted());
    }

    #[test]
    fn each_event_ends_stick_slip_in_its_way() {
        let told = |event| ending(event).critical_velocity(Method::GrazeOrbit);
        let graze = told(Event::Graze(0));
        assert_eq!((graze.vc, graze.transition), (0.4, Transition::Grazing));
        // The slip lasts until the minimum of ẋ, the stick that much less.
        assert_eq!((graze.slip_time, graze.stick_time), (3.3, 1.7));
        assert_eq!(graze.n_min, 0.5);
        let fold = told(Event::StickVanishes);
        assert_eq!((fold.vc, fold.transition), (0.4, Transition::Fold));
        assert_eq!((fold.slip_time, fold.stick_time), (3.0, 2.0));
        let lifted = told(Event::LiftOff);
        assert!(lifted.vc.is_nan() && lifted.v_liftoff == 0.4);
        assert_eq!(lifted.transition, Transition::LiftOff);
    }

    #[test]
    fn a_change_after_which_nothing_is_left_is_the_end_of_a_stick() {
        for event in [Event::Reversal, Event::NewStop, Event::StickVanishes] {
            let end = ending(event).of_stick_slip();
            assert_eq!(end.event, Event::StickVanishes);
        }
        assert_eq!(
            ending(Event::Graze(0)).of_stick_slip().event,
            Event::Graze(0)
        );
    }

    #[test]
    fn slips_are_the_same_to_a_tenth() {
        let options = TransitionOptions::default();
        let of = |slip| {
            Period::of(Cycle {
                slip,
                ..Cycle::NONE
            })
        };
        assert!(same_slip(&of(3.0), &of(3.2), 0, &options));
        assert!(!same_slip(&of(3.0), &of(3.5), 0, &options));
        assert!(!same_slip(&of(f64::NAN), &of(3.5), 0, &options));
    }
}
