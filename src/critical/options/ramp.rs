//! Options of simulation while v0 is raised.

options! {
    /// How stick-slip is followed while v0 is raised, how long each v0 is held, and what confirms
    /// the answer. Steps are relative, times in units of √(M/κ).
    RampOptions {
        /// The first step of v0. Large ones are cheap; those that lose stick-slip are undone.
        first: f64 = 0.6, in 1e-6..=10.0;
        /// The largest step of v0.
        largest: f64 = 0.6, in 1e-6..=10.0;
        /// The largest step of v0 where cycles do not show whether stick-slip is of the same kind.
        unseen: f64 = 0.1, in 1e-6..=10.0;
        /// The last step, the precision of v_c by simulation. Searches have to agree to
        /// `GRAZE_PRECISION`.
        last: f64 = 1e-6, in 1e-12..=1e-2;
        /// Up to this v0, in the units of a motion, v0 glides: each is held for a few cycles only,
        /// and the outcome is not waited for. 0 where every v0 is held.
        glide: f64 = 0.0, in 0.0..=f64::INFINITY;
        /// The most v0 that are tried.
        trials: u32 = 1_000, in 1..=1_000_000;
        /// v0 up to which stick-slip is followed, in units of μ_S N0/√(κM); by continuation as
        /// well.
        v_max: f64 = 100.0, in 1e-3..=1e6;
        /// How well cycles have to repeat near the end.
        repeated: f64 = 1e-6, in 1e-12..=1e-2;
        /// The most steps of the integrator at one v0; more where velocity control makes sticks
        /// longer.
        steps: u64 = 50_000, in 100..=1_000_000_000;
        /// The most steps at all v0 together: some seconds.
        total_steps: u64 = 3_000_000, in 100..=1_000_000_000_000;
        /// Whether the search ends where stick-slip has come to repeat.
        until_periodic: bool = false, in false..=true;
        /// Whether a motion that loses stick-slip is always followed until its outcome is known.
        /// Else a loss counts once the minima of ẋ no longer fall, and only the last loss is
        /// followed for longer.
        patient: bool = false, in false..=true;

        /// Start velocities, over μ_S, in order, until stick-slip is sustained at one: by
        /// continuation as well.
        starts: [f64; 6] = [1e-2, 1e-1, 1e-3, 1e-4, 1e-5, 1e-6], in 1e-9..=1.0;
        /// The share of the way to the predicted end that is taken at first. With a larger one,
        /// such as that of continuation, transients lead to more ends that stay undecided.
        share: f64 = 0.9, in 0.1..=0.999;
        /// A v0 at which stick-slip was lost is tried once more from this much nearer: the size of
        /// the step may have lost it.
        nearby: f64 = 0.15, in 0.01..=0.9;
        /// The least share of the way to the predicted end that is taken at once: near its end
        /// stick-slip attracts from less and less far, and the share falls with each loss.
        least_share: f64 = 0.2, in 0.01..=0.9;
        /// The least share of that way where stick-slip was lost again and again, and the end is
        /// near.
        gentle_share: f64 = 0.03, in 1e-3..=0.9;
        /// Within this relative step of where periodic stick-slip is predicted to end, the end is
        /// near.
        near: f64 = 5e-3, in 1e-9..=0.1;
        /// Two v0 that differ by less than this share of the last step are near enough.
        near_enough: f64 = 0.75, in 0.5..=1.0;
        /// Stick-slip that survives so often where it had been lost, on a short way, is lost by
        /// chance, unless its end is near.
        most_passed: u32 = 6, in 1..=1_000;
        /// The length of the short way of [`Self::most_passed`].
        short_way: f64 = 1e-3, in 1e-9..=0.1;
        /// The last step from irregular stick-slip: near its end chance decides at each v0 whether
        /// it persists.
        last_irregular: f64 = 2e-5, in 1e-12..=1e-2;
        /// Steps below this carry a motion along its attractor.
        careful: f64 = 0.02, in 1e-6..=1.0;
        /// How well cycles have to repeat after steps larger than [`Self::careful`].
        roughly: f64 = 1e-4, in 1e-12..=1e-2;
        /// After a step no larger than this an end is near: irregular stick-slip is held for long.
        final_step: f64 = 2e-3, in 1e-9..=1.0;
        /// Sticks that shorten count as vanishing if they are predicted to vanish within this step.
        soon: f64 = 1e-2, in 1e-9..=1.0;

        /// How long a motion is followed: at least this time, this many delays, and this many of
        /// the longest cycles.
        patience: [f64; 3] = [600.0, 20.0, 30.0], in 0.0..=1e6;
        /// Stick-slip that does not repeat within the first number of cycles, plus the second for
        /// each unit of the delay, is irregular. These are for a v0 that glides.
        cycles_gliding: [f64; 2] = [4.0, 0.5], in 0.0..=1e4;
        /// The numbers of [`Self::cycles_gliding`] after usual steps of v0.
        cycles: [f64; 2] = [12.0, 1.0], in 0.0..=1e4;
        /// The numbers of [`Self::cycles_gliding`] where stick-slip is followed for long.
        cycles_at_length: [f64; 2] = [24.0, 1.0], in 0.0..=1e4;
        /// The numbers of [`Self::cycles_gliding`] near the end of stick-slip.
        cycles_near_end: [f64; 2] = [60.0, 4.0], in 0.0..=1e4;
        /// A slip goes on for good if there was no stop in the last part of the waiting time, this
        /// share of it.
        recent: f64 = 0.25, in 0.01..=0.9;
        /// Minima of ẋ fall if one is lower than those before by more than this share.
        falls: f64 = 1e-3, in 1e-9..=0.5;
        /// A motion diverges once it is this many times as large as the forces of stick-slip and
        /// the speed of the pull.
        far: f64 = 100.0, in 2.0..=1e6;
        /// Windows without a fall after which a slip counts as going on, where it is followed
        /// briefly. A window is a delay and two periods of free oscillation.
        windows: u32 = 3, in 1..=1_000;
        /// Windows without a fall after which a slip counts as going on, where it is followed for
        /// long.
        windows_at_length: u32 = 10, in 1..=1_000;
        /// Windows without a fall at the end of a motion after which a slip goes on.
        windows_at_last: u32 = 6, in 1..=1_000;

        /// Error allowed in a step of the integrator where stick-slip is followed.
        tolerance: f64 = 1e-8, in 1e-14..=1e-3;
        /// The first step of a search that confirms another one.
        confirm_first: f64 = 0.2, in 1e-6..=10.0;
        /// Error allowed in a step of the integrator in a search that confirms another one.
        confirm_tolerance: f64 = 1e-10, in 1e-14..=1e-3;
        /// Steps of v0 that glides.
        glide_step: f64 = 0.01, in 1e-6..=1.0;
        /// The most steps of the integrator in a search in which v0 glides: it stops at many more
        /// v0.
        glide_steps: u64 = 30_000_000, in 100..=1_000_000_000_000;
        /// How far below the end v0 stops gliding.
        glide_end: f64 = 0.02, in 1e-6..=0.9;
        /// The most v0 of a search in which v0 glides: more than it takes from the lowest to the
        /// largest.
        glide_trials: u32 = 3_000, in 10..=10_000_000;
        /// Sticks shorter than this are lost to rounding as v0 grows: how they end is not decided.
        vanishing_stick: f64 = 1e-6, in 1e-15..=1e-2;
        /// Depth of a stop, over v0, below which the last stop is a graze.
        grazing: f64 = 1e-3, in 1e-9..=0.1;
    }
}
