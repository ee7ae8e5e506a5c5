//! Options of what follows an event.

options! {
    /// How the end of a branch of orbits is checked, and how its sequel is found. Distances in v0
    /// are relative, times in units of √(M/κ).
    TransitionOptions {
        /// The last orbits are this far below and above an event.
        precision: f64 = 1e-5, in 1e-9..=1e-3;
        /// An orbit this near below an event, over [`Self::precision`], is as good as one at it.
        at_event: f64 = 2.0, in 1.0..=100.0;
        /// The relative amount by which the slip may lengthen on the last bit of the way to a
        /// graze, where it grows as a square root.
        same_slip: f64 = 0.1, in 1e-3..=0.5;
        /// A stick vanishes if it is shorter than this just below the event.
        vanishing_stick: f64 = 1e-3, in 1e-9..=0.1;
        /// How well periods repeat where lift-off and vanishing sticks are checked.
        checked: f64 = 1e-3, in 1e-9..=0.1;
        /// Lift-off is checked this far below and above its velocity.
        lift_off: f64 = 1e-4, in 1e-9..=1e-2;

        /// A graze ends stick-slip if its orbit attracts this far below it. Nearer to it even that
        /// orbit need not attract: the effect of a delayed slip on the next one grows without
        /// bounds at a graze.
        below_graze: f64 = 1e-4, in 1e-9..=1e-2;
        /// The relative amount by which v0 is lowered in one period just below a graze. Disturbed
        /// by more the block would be thrown over the graze.
        disturbed_below_graze: f64 = 2e-5, in 1e-9..=1e-2;
        /// Periods just below a graze that repeat to this count as at rest.
        at_rest: f64 = 0.06, in 1e-9..=0.5;
        /// The relative amount by which v0 is lowered in one period where the stick vanishes.
        disturbed: f64 = 2e-4, in 1e-9..=1e-2;
        /// The number of periods within which an orbit has to come back.
        periods_back: usize = 30, in 4..=10_000;
        /// An orbit has come back after so many near periods in a row.
        near_in_a_row: u32 = 4, in 1..=100;
        /// A period is near within this share of the first distance.
        back: f64 = 0.05, in 1e-6..=0.9;
        /// The share of the first distance that suffices after the last period.
        back_at_last: f64 = 0.5, in 1e-6..=0.99;
        /// Distances of sticks below this are rounding.
        stick_noise: f64 = 1e-7, in 1e-15..=1e-2;
        /// Distances of sticks below this share of the last stick are rounding, if it is smaller.
        stick_left: f64 = 0.3, in 1e-3..=0.9;

        /// The block is released this far past a graze if it still stops at [`Self::precision`].
        past_graze: f64 = 1e-4, in 1e-9..=1e-2;
        /// Where it comes near another stop it is released this far past the graze as well: farther
        /// and nearer.
        past_again: [f64; 2] = [1e-4, 2e-6], in 1e-9..=1e-2;
        /// The block comes near another stop where a minimum of ẋ, over v0, is below this.
        clear: f64 = 0.05, in 1e-6..=0.9;
        /// How long after the time of the lowest minimum a block that was released again is
        /// followed: a period of free oscillation.
        after_minimum: f64 = std::f64::consts::TAU, in 0.0..=1e3;
        /// The minimum beyond the graze comes after this share of the slip at the earliest.
        earliest_minimum: f64 = 0.75, in 0.1..=0.99;
        /// The most steps of the integrator until the minimum beyond the graze.
        steps_of_slip: u32 = 5_000, in 100..=1_000_000;
        /// Where sliding is stable and minima of ẋ rise to this share of v0 the block slides. Those
        /// that rise to half of v0 may fall again: an unstable oscillation can surround sliding.
        sliding: f64 = 0.8, in 0.1..=0.999;
        /// The number of minima in a row that have to rise.
        rises: u32 = 2, in 1..=100;
        /// The longest time to wait.
        longest_wait: f64 = 5_000.0, in 10.0..=1e7;
        /// The block is released this far beyond a stick that vanished.
        past_vanished_stick: f64 = 1e-4, in 1e-9..=1e-2;
        /// No stick may come back for so many times a delay and two periods of free oscillation.
        windows_without_stick: u32 = 10, in 1..=1_000;

        /// How far beyond a change of kind the next kind is looked for: forces have to differ by
        /// more than their noise.
        past_change: f64 = 1e-4, in 1e-9..=1e-2;
        /// How far beyond its last orbit stick-slip of a lost branch is followed, one distance
        /// after the other until its kind changes.
        past_lost: [f64; 4] = [1e-4, 1e-3, 5e-3, 2e-2], in 1e-9..=0.5;
        /// Steps of v0 through irregular stick-slip, the first time and the second: where it leads
        /// should not depend on them.
        crossing_steps: [f64; 2] = [0.1, 0.03], in 1e-4..=1.0;
        /// The last step of v0 through irregular stick-slip: an end by chance is known to this.
        last_crossing_step: f64 = 2e-5, in 1e-9..=1e-2;
    }
}
