//! Options of switching control on.

options! {
    /// How long a block is followed after control was switched on. Shares are those of the time
    /// that stick-slip is waited for to repeat.
    SwitchOnOptions {
        /// A slip is followed so many times as long until its outcome is known. Near an unstable
        /// oscillation, or near neutral stability of sliding, that takes long.
        longest: f64 = 100.0, in 1.0..=1e6;
        /// The share of the time within which the block has to be released for stick-slip to go on.
        recent: f64 = 0.25, in 0.01..=0.9;
        /// A block that is released so often after long slips sticks again and again.
        returns: u32 = 3, in 1..=1_000;
        /// The number of windows in that time in which minima of ẋ are compared.
        windows: f64 = 8.0, in 1.0..=1_000.0;
        /// Windows in a row in which the lowest minimum has to rise for a slip to calm down.
        rises: u32 = 16, in 2..=10_000;
        /// About how many steps an uncontrolled cycle takes: they count towards the limit of steps.
        steps_of_cycle: u64 = 40, in 1..=100_000;
    }
}
