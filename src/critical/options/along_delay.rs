//! Options of continuation along a line of delays.

options! {
    /// How the end of stick-slip at one delay starts the search at the next, and how far that is
    /// trusted. Distances in v0 and in the delay are relative.
    AlongDelayOptions {
        /// Cells from one that is searched from scratch to the next.
        segment: usize = 64, in 2..=128;
        /// Cells in a segment where one kind of stick-slip followed another: it may end earlier.
        /// Where the kinds at the other end differ, a segment is halved whatever its length.
        short_segment: usize = 16, in 2..=128;
        /// A surprising end is searched from scratch, unless one of this many cells before it was.
        surprises: usize = 2, in 1..=128;
        /// An end this far from its prediction is surprising: it changes fast along the line.
        surprise: f64 = 3e-4, in 1e-9..=0.1;
        /// Where the time in slip changes by more than this share from one cell to the next, the
        /// next cell is on another branch. Along one branch it changes a few times less.
        jump_of_slip: f64 = 0.05, in 1e-9..=0.5;
        /// How well a continuation has to meet an end that was found from scratch.
        meets: f64 = 3e-5, in 1e-9..=1e-3;
        /// How well the times in slip have to meet at such an end: they tell how many slips a
        /// period has.
        meets_in_time: f64 = 1e-2, in 1e-9..=0.5;

        /// The error assumed for the prediction of an end before any error is known.
        first_off: f64 = 0.02, in 1e-9..=0.5;
        /// How far below the predicted graze a cell starts at first. A new start has a transient of
        /// unknown size, which can bring about an end too early.
        graze_first: f64 = 3e-4, in 1e-9..=0.1;
        /// How far below the predicted graze a cell starts at least: event functions have noise.
        graze_least: f64 = 1e-5, in 1e-9..=0.1;
        /// How far below the v0 at which a stick vanishes a cell starts at first.
        vanish_first: f64 = 3e-3, in 1e-9..=0.1;
        /// How far below the v0 at which a stick vanishes a cell starts at least.
        vanish_least: f64 = 1e-3, in 1e-9..=0.1;
        /// How far below lift-off a cell starts at first.
        lift_off_first: f64 = 3e-3, in 1e-9..=0.1;
        /// How far below lift-off a cell starts at least.
        lift_off_least: f64 = 2e-5, in 1e-9..=0.1;
        /// The largest distance below the predicted end at which a cell starts at first, and its
        /// first step of v0.
        farthest: f64 = 0.1, in 1e-6..=0.9;
        /// Without a second past a cell starts below its predicted end by at least this share of
        /// the change of the end.
        off_by_change: f64 = 0.15, in 0.0..=1.0;
        /// Where no period is found from a start, the start is moved farther off, by these factors.
        farther: [f64; 2] = [4.0, 30.0], in 1.0..=1_000.0;
        /// Where [`Self::farther`] does not help, the start is moved off by this many times
        /// [`Self::farthest`].
        farthest_of_all: f64 = 2.0, in 1.0..=9.0;
        /// A cell starts this many times as far below its end as the transient of the cell before
        /// needed.
        room: f64 = 1.5, in 1.0..=100.0;
        /// Each cell starts at most this many times as far below its end as the cell before.
        nearer: f64 = 0.5, in 0.01..=1.0;
        /// Cells in a row whose ends may be located with slopes of a cell before.
        most_borrowed: u32 = 8, in 0..=128;
        /// How far below its end a cell starts after [`Self::most_borrowed`] cells, so that it can
        /// have its own slopes.
        for_slopes: f64 = 1e-4, in 1e-9..=1e-2;

        /// The most ends in a row that are accepted without following the block beyond them.
        most_unseen: u32 = 3, in 0..=128;
        /// How far an end that is accepted unseen may be from its prediction.
        as_expected: f64 = 3e-5, in 1e-9..=1e-2;
        /// How much the time in slip of a cell with an unseen end may differ from that of the last
        /// cell that was followed beyond its end.
        same_slip: f64 = 0.02, in 1e-9..=0.5;
        /// How clearly stick-slip has to end at the last end that was followed: a lower bound of
        /// the minima of ẋ beyond it, over v0.
        clear: f64 = 2e-3, in 1e-9..=1.0;
        /// The minimum of [`Self::clear`] has to exceed its own change since the last end that was
        /// followed by this factor.
        caution: f64 = 6.0, in 1.0..=1_000.0;
        /// The largest change of the delay to an unseen end where a stick vanishes.
        small_change: f64 = 0.03, in 0.0..=1.0;

        /// The largest change of the delay from cell to cell: a past is known for two delays.
        largest_change: f64 = 0.5, in 0.0..=0.9;
        /// A way shorter than this is not cut into parts.
        least_change: f64 = 2e-3, in 1e-9..=0.5;
        /// The part of a way that is tried where the whole of it failed.
        part: f64 = 0.25, in 0.01..=0.9;
        /// The most trials on the way from one cell to the next.
        most_trials: u32 = 8, in 1..=1_000;
        /// The farthest that the next end is predicted from the last one, in its logarithm.
        farthest_log: f64 = 0.5, in 1e-3..=10.0;
        /// The share of the assumed error that is left once an earlier end, found in another way,
        /// is known.
        recalled: f64 = 0.25, in 0.0..=1.0;
    }
}
