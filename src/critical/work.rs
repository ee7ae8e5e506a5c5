//! The work of a search, counted for tests: how many orbits continuation looks for, and how many
//! steps the integrator takes on its way to them.

use std::cell::Cell;

/// Trials of continuation, and the steps that the integrator takes in these trials.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Work {
    pub trials: u64,
    pub steps: u64,
}

thread_local! {
    static DONE: Cell<Work> = const { Cell::new(Work { trials: 0, steps: 0 }) };
}

/// One more orbit is looked for.
pub(super) fn count_trial() {
    DONE.with(|done| {
        let work = done.get();
        done.set(Work {
            trials: work.trials + 1,
            ..work
        });
    });
}

/// One more step is taken.
pub(super) fn count_step() {
    DONE.with(|done| {
        let work = done.get();
        done.set(Work {
            steps: work.steps + 1,
            ..work
        });
    });
}

/// What `search` finds, and its work.
pub(super) fn of<T>(search: impl FnOnce() -> T) -> (T, Work) {
    let before = DONE.get();
    let found = search();
    let after = DONE.get();
    let work = Work {
        trials: after.trials - before.trials,
        steps: after.steps - before.steps,
    };
    (found, work)
}
