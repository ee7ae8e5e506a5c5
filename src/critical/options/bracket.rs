//! Options of the bounds of a critical velocity that is not decided.

options! {
    /// How bounds are found where searches disagree. Distances are relative.
    BracketOptions {
        /// How far the lower bound lies below the lowest end: at least, and as a share of the
        /// spread of the ends of slow searches. Still slower ones end up to that much lower.
        below: [f64; 2] = [0.05, 1.0], in 0.0..=10.0;
        /// How far the lower bound lies below the lowest end at most.
        farthest_below: f64 = 0.5, in 0.0..=0.99;
        /// How far above the highest end the first v0 lies at which the loss of stick-slip is
        /// checked. Each further step upwards is twice as large.
        above: f64 = 0.025, in 1e-6..=1.0;
        /// The largest step between v0 at which the loss of stick-slip is checked.
        largest_above: f64 = 0.3, in 1e-3..=10.0;
        /// The most v0 at which the loss of stick-slip is checked.
        most_above: u32 = 40, in 1..=10_000;
        /// The number of phases of a cycle from all of which stick-slip has to be lost.
        phases: u32 = 6, in 1..=1_000;
        /// The most steps of the integrator from one phase to the next.
        steps_of_cycle: u32 = 20_000, in 10..=10_000_000;
        /// Where velocity control makes sticks longer by this factor, a slow search has to find the
        /// same end as simulation. The memory is then so long that faster searches may pass an end.
        long_sticks: f64 = 2.0, in 1.0..=1e6;
        /// Where velocity control makes sticks long, an end with sticks shorter than this is not
        /// known: ramps by other programs go on with still shorter sticks.
        short_stick: f64 = 1e-5, in 1e-12..=1e-2;
        /// Where slow searches begin, as a share of the lowest end that is known.
        slow_from: f64 = 0.2, in 1e-6..=1.0;
        /// The largest steps of v0 in the two slow searches.
        slow_steps: [f64; 2] = [0.05, 0.03], in 1e-4..=1.0;
        /// The first slow search takes stick-slip for irregular if it does not repeat within the
        /// first number of cycles, plus the second for each unit of the delay. What ends by chance
        /// ends at a lower v0 the longer it is held at each.
        slow_cycles: [f64; 2] = [60.0, 2.0], in 0.0..=1e5;
        /// The second slow search holds stick-slip so many times as long as the first. Holding it
        /// longer still hardly lowers ends by chance.
        held_longer: f64 = 5.0, in 1.0..=1e3;
        /// The most steps of the integrator in each slow search: some seconds.
        steps: u64 = 10_000_000, in 100..=1_000_000_000_000;
    }
}
