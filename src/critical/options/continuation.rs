//! Options of continuation in v0.

options! {
    /// How a periodic orbit of stick-slip is found at one v0, and how v0 is raised to where an
    /// event function vanishes. Steps, distances and differences are relative, times in units of
    /// √(M/κ), forces in N0 and velocities in N0/√(κM).
    ContinuationOptions {
        /// Error allowed in a step of the integrator. Smaller ones cost time; ends are checked by
        /// [`Self::finer`] ones.
        tolerance: f64 = 1e-6, in 1e-14..=1e-3;
        /// The most steps of the integrator in one slip and stick. A cycle takes some tens; at
        /// long delays hundreds.
        steps_of_cycle: u32 = 5_000, in 100..=1_000_000;
        /// A slip of which nothing is known yet has missed its stop after this time: some ten
        /// periods of free oscillation.
        longest_slip: f64 = 60.0, in 10.0..=10_000.0;
        /// A minimum of ẋ no farther than this from where the stop is expected, as a share of the
        /// slip, is the one that the stop cuts off.
        same_minimum: f64 = 0.1, in 0.0..=0.5;
        /// A slip that takes so many times as long as the one before has missed its stop.
        missed_stop: f64 = 1.6, in 1.05..=10.0;

        /// The most periods at one v0. Orbits that attract well come to rest in three; where more
        /// than this are needed a smaller step of v0 is cheaper.
        most_periods: usize = 12, in 3..=1_000;
        /// The most slips at one v0, where a period has several.
        most_cycles: usize = 24, in 4..=4_000;
        /// Event functions of three periods in a row differ by no more than this after a step of v0
        /// of usual size. Their limit is extrapolated from the three, so it is known far better.
        settled: f64 = 0.05, in 1e-9..=0.5;
        /// A step of v0 of at least this size is large.
        large_step: f64 = 0.3, in 0.0..=10.0;
        /// How settled orbits have to be after large steps: a rough orbit is enough to go on from.
        settled_after_large: f64 = 0.2, in 1e-9..=1.0;
        /// A step of v0 of at least this size, if it is not large, is middling.
        middling_step: f64 = 0.02, in 0.0..=10.0;
        /// How settled orbits have to be after middling steps.
        settled_after_middling: f64 = 0.1, in 1e-9..=1.0;
        /// A step of v0 smaller than this is small.
        small_step: f64 = 2e-3, in 0.0..=1.0;
        /// How settled orbits have to be after small steps, as a share of [`Self::settled`]: the
        /// end is near, and is extrapolated from the last two orbits.
        settled_after_small: f64 = 0.4, in 1e-3..=1.0;
        /// Differences from one period to the next have to fall at least by this factor. Those of
        /// an unstable orbit, followed closely, grow.
        contraction: f64 = 0.8, in 0.1..=0.999;
        /// Noise of event functions, relative to themselves, and to v0 or to the forces and times
        /// of free oscillation: the accuracy of the integration.
        noise: f64 = 1e-6, in 1e-15..=1e-3;
        /// Three members of a sequence give its limit (Aitken) where the ratio of their differences
        /// is below this. Above it the limit would be an extrapolation too far.
        aitken_ratio: f64 = 0.7, in 0.0..=0.95;
        /// The farthest that two pasts are extrapolated, in units of the difference between them.
        farthest_extrapolation: f64 = 3.0, in 0.0..=20.0;

        /// The largest step of v0, and the first one.
        largest_step: f64 = 1.0, in 1e-3..=10.0;
        /// The share of the way to the predicted event that is taken at once. The rest keeps a
        /// predictor of the first order from stepping over the event.
        share: f64 = 0.97, in 0.5..=0.999;
        /// The share of that way where slopes are those of another delay: transients are of the
        /// first order then.
        first_share: f64 = 0.7, in 0.3..=0.999;
        /// After a step that failed the next is smaller by this factor.
        reduction: f64 = 0.5, in 0.1..=0.9;
        /// After a step that succeeded the next may be larger by this factor.
        growth: f64 = 2.0, in 1.1..=10.0;
        /// A step beyond a v0 that failed is at most this share of the step that failed there: the
        /// size of that step alone may be the reason.
        retry_share: f64 = 0.3, in 0.01..=0.9;
        /// Periods that do not come to rest after a smaller step than this are left to simulation:
        /// the orbit loses its stability.
        unsettled_step: f64 = 0.02, in 0.0..=1.0;
        /// The largest step of v0 that may lead from one kind of stick-slip to another: v0 is
        /// raised slowly.
        jump: f64 = 1e-5, in 1e-9..=0.1;
        /// The shortest mean cycle of the same kind of stick-slip, over the one before and the
        /// change of v0: sticks shorten as v0 grows.
        shorter_cycle: f64 = 0.8, in 0.1..=0.99;
        /// The longest mean cycle of the same kind of stick-slip, over the one before and the
        /// change of v0.
        longer_cycle: f64 = 1.25, in 1.01..=10.0;
        /// The shortest mean slip of the same kind of stick-slip, over the one before.
        shorter_slip: f64 = 0.8, in 0.1..=0.99;
        /// The longest mean slip of the same kind of stick-slip, over the one before: slips
        /// lengthen near a graze.
        longer_slip: f64 = 1.4, in 1.01..=10.0;
        /// The most v0 that are tried on the way to one event. Some ten are enough, unless steps
        /// fail again and again.
        most_trials: u32 = 60, in 5..=10_000;

        /// Nearer than this to the event, the event is extrapolated from the last two orbits.
        near: f64 = 1e-4, in 1e-9..=1e-2;
        /// Within this of the event it is extrapolated as well, if two predictions agree.
        quite_near: f64 = 3e-3, in 1e-9..=0.1;
        /// How well two predictions of the event have to agree.
        agreement: f64 = 3e-6, in 1e-12..=1e-2;
        /// Within this of the event, and of where it was predicted, slopes of another delay
        /// suffice.
        borrowed: f64 = 3e-5, in 1e-12..=1e-2;
        /// Where a step just before the event failed, one more is made beyond it, so many times as
        /// long as [`Self::near`].
        last_step: f64 = 3.0, in 1.0..=100.0;

        /// The v0, in N0/√(κM), below which errors of the elongation matter for the depth of a
        /// stop, which has to be known compared with v0: the tolerance falls in proportion.
        slow: f64 = 0.03, in 0.0..=10.0;
        /// The v0, in N0/√(κM), above which a slip ends by a difference of forces that falls as
        /// 1/v0, while speeds grow as v0: the tolerance of the check falls as 1/v0².
        fast: f64 = 1.0, in 1e-3..=1e6;
        /// The tolerance of the check of an event, over [`Self::tolerance`].
        finer: f64 = 1e-2, in 1e-6..=1.0;
        /// How well the finer integration has to give the same event.
        same_event: f64 = 1e-5, in 1e-12..=1e-2;
        /// How far below an event the search with the finer tolerance begins.
        back: f64 = 2e-3, in 1e-6..=0.5;

        /// The most kinds of stick-slip that follow one another.
        most_kinds: usize = 24, in 1..=1_000;
        /// The first step of v0 with another kind of stick-slip than the first.
        first_step: f64 = 0.02, in 1e-6..=1.0;
        /// The first step of v0 after a graze that did not change the kind of stick-slip: the next
        /// end may be as near.
        step_past_graze: f64 = 2e-5, in 1e-9..=1.0;
    }
}
