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
        /// of usual size. Their limit is told from the three, so it is known far better.
        settled: f64 = 0.05, in 1e-9..=0.5;
        /// A step of v0 from this on is a large one.
        large_step: f64 = 0.3, in 0.0..=10.0;
        /// What large steps have to be settled to: a rough orbit is enough to go on from.
        settled_after_large: f64 = 0.2, in 1e-9..=1.0;
        /// A step of v0 from this on is a middling one.
        middling_step: f64 = 0.02, in 0.0..=10.0;
        /// What middling steps have to be settled to.
        settled_after_middling: f64 = 0.1, in 1e-9..=1.0;
        /// A step of v0 below this is a small one.
        small_step: f64 = 2e-3, in 0.0..=1.0;
        /// What small steps have to be settled to, as a share of [`Self::settled`]: the end is
        /// near, and told from the last two orbits.
        settled_after_small: f64 = 0.4, in 1e-3..=1.0;
        /// Differences from one period to the next that come to rest fall at least by this factor.
        /// An unstable orbit, followed from close by, has differences that grow.
        contraction: f64 = 0.8, in 0.1..=0.999;
        /// Noise of event functions, relative to themselves, and to v0 or to the forces and times
        /// of free oscillation: what the integration is accurate to.
        noise: f64 = 1e-6, in 1e-15..=1e-3;
        /// Three members of a sequence tell its limit (Aitken) where the ratio of their differences
        /// is below this; above it the limit would be an extrapolation too far.
        aitken_ratio: f64 = 0.7, in 0.0..=0.95;
        /// The farthest that two pasts are extrapolated, in units of what lies between them.
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
        /// A step beyond a v0 that failed is at most this share of the step that failed there: it
        /// may have been the size of the step alone.
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
        /// The longest one.
        longer_cycle: f64 = 1.25, in 1.01..=10.0;
        /// The shortest mean slip of the same kind of stick-slip, over the one before.
        shorter_slip: f64 = 0.8, in 0.1..=0.99;
        /// The longest one: slips lengthen near a graze.
        longer_slip: f64 = 1.4, in 1.01..=10.0;
        /// The most v0 that are tried on the way to one event. Some ten are enough, unless steps
        /// fail again and again.
        most_trials: u32 = 60, in 5..=10_000;

        /// Nearer than this to the event the rest of the way is told from the last two orbits.
        near: f64 = 1e-4, in 1e-9..=1e-2;
        /// Within this of the event the last two orbits tell it if both predict it alike.
        quite_near: f64 = 3e-3, in 1e-9..=0.1;
        /// How well two predictions of the event agree.
        agreement: f64 = 3e-6, in 1e-12..=1e-2;
        /// Within this of the event, and of where it was predicted, slopes of another delay tell
        /// it.
        borrowed: f64 = 3e-5, in 1e-12..=1e-2;
        /// Where a step short of the event failed one is made beyond that, so many times as long as
        /// [`Self::near`].
        last_step: f64 = 3.0, in 1.0..=100.0;

        /// Below this v0, over μ_S N0/√(κM), errors of the elongation are felt in the depth of a
        /// stop, which is to be known compared with v0: the tolerance falls in proportion.
        slow: f64 = 0.03, in 0.0..=10.0;
        /// Above this v0 what ends a slip is a difference of forces that falls as 1/v0, of speeds
        /// that grow as v0: the tolerance of the check falls as 1/v0².
        fast: f64 = 1.0, in 1e-3..=1e6;
        /// The tolerance of the check of an event, over [`Self::tolerance`].
        finer: f64 = 1e-2, in 1e-6..=1.0;
        /// How well an event has to be the same by the finer tolerance.
        same_event: f64 = 1e-5, in 1e-12..=1e-2;
        /// How far below an event the search with the finer tolerance begins.
        back: f64 = 2e-3, in 1e-6..=0.5;

        /// The most kinds of stick-slip that follow one another.
        most_kinds: usize = 24, in 1..=1_000;
        /// The first step of v0 with another kind of stick-slip than the first.
        first_step: f64 = 0.02, in 1e-6..=1.0;
        /// The first step of v0 where one slip that was expected to graze goes on as it was: the
        /// next end may be as near.
        step_past_graze: f64 = 2e-5, in 1e-9..=1.0;
    }
}
