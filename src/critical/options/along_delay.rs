//! Options of continuation along a line of delays.

options! {
    /// How the end of stick-slip at one delay starts the search at the next, and how far that is
    /// trusted. Distances in v0 and in the delay are relative.
    AlongDelayOptions {
        /// Cells from one that is found from scratch to the next.
        segment: usize = 64, in 2..=128;
        /// Cells of a segment where stick-slip of one kind followed another on the way: it may end
        /// earlier. Where these kinds are other ones at its end a segment is halved whatever its
        /// length.
        short_segment: usize = 16, in 2..=128;
        /// An end that surprises is searched from scratch, unless one of the last so many cells
        /// was.
        surprises: usize = 2, in 1..=128;
        /// An end that far from where it was expected surprises: it changes fast along the line.
        surprise: f64 = 3e-4, in 1e-9..=0.1;
        /// Where the time in slip changes by more than this share from one cell to the next, the
        /// next cell is on another branch. Along one branch it changes a few times less.
        jump_of_slip: f64 = 0.05, in 1e-9..=0.5;
        /// How well a continuation has to meet what was found from scratch.
        meets: f64 = 3e-5, in 1e-9..=1e-3;
        /// How well the times in slip have to meet there: they tell how many slips a period has.
        meets_in_time: f64 = 1e-2, in 1e-9..=0.5;

        /// How far off an end is taken to be before anything is known.
        first_off: f64 = 0.02, in 1e-9..=0.5;
        /// A cell starts so far below the predicted graze at first: the transient of a new start,
        /// whose size is not known yet, can bring about an end too early.
        graze_first: f64 = 3e-4, in 1e-9..=0.1;
        /// A cell starts at least so far below the predicted graze: event functions have their
        /// noise.
        graze_least: f64 = 1e-5, in 1e-9..=0.1;
        /// How far below the v0 at which a stick vanishes a cell starts at first.
        vanish_first: f64 = 3e-3, in 1e-9..=0.1;
        /// How far below the v0 at which a stick vanishes it starts at least.
        vanish_least: f64 = 1e-3, in 1e-9..=0.1;
        /// How far below lift-off a cell starts at first.
        lift_off_first: f64 = 3e-3, in 1e-9..=0.1;
        /// How far below lift-off it starts at least.
        lift_off_least: f64 = 2e-5, in 1e-9..=0.1;
        /// The largest distance below the predicted end at which a cell starts at first, and its
        /// first step of v0.
        farthest: f64 = 0.1, in 1e-6..=0.9;
        /// An orbit without a second past starts below by this share of the change of the end at
        /// least.
        off_by_change: f64 = 0.15, in 0.0..=1.0;
        /// Where no period is found from a start, it is moved farther off, by these factors.
        farther: [f64; 2] = [4.0, 30.0], in 1.0..=1_000.0;
        /// Where that does not help, it is moved off by this many times [`Self::farthest`].
        farthest_of_all: f64 = 2.0, in 1.0..=9.0;
        /// A cell starts below its end by this many times what the transient of the cell before
        /// needed.
        room: f64 = 1.5, in 1.0..=100.0;
        /// By how much nearer each cell starts at least.
        nearer: f64 = 0.5, in 0.01..=1.0;
        /// Cells in a row that may end by the slopes of one before.
        most_borrowed: u32 = 8, in 0..=128;
        /// From so far below its end the next one starts then, so that slopes can be told.
        for_slopes: f64 = 1e-4, in 1e-9..=1e-2;

        /// At most so many ends in a row are taken without following the block beyond them.
        most_unseen: u32 = 3, in 0..=128;
        /// The end of such a cell may differ by this from the expected one.
        as_expected: f64 = 3e-5, in 1e-9..=1e-2;
        /// Its time in slip may differ by this from that of the last cell that was followed beyond
        /// its end.
        same_slip: f64 = 0.02, in 1e-9..=0.5;
        /// Stick-slip ended as clearly as this there: the lowest minimum of ẋ beyond, over v0.
        clear: f64 = 2e-3, in 1e-9..=1.0;
        /// So many times the change of that since then fits into it.
        caution: f64 = 6.0, in 1.0..=1_000.0;
        /// The largest change of the delay to such an end where a stick vanishes.
        small_change: f64 = 0.03, in 0.0..=1.0;

        /// The largest change of the delay from cell to cell: a past is known for two delays.
        largest_change: f64 = 0.5, in 0.0..=0.9;
        /// No way that is shorter is cut into parts.
        least_change: f64 = 2e-3, in 1e-9..=0.5;
        /// The part of a way that is tried where the whole of it failed.
        part: f64 = 0.25, in 0.01..=0.9;
        /// The most trials on the way from one cell to the next.
        most_trials: u32 = 8, in 1..=1_000;
        /// How far from the last end, in its logarithm, the next one is predicted at most.
        farthest_log: f64 = 0.5, in 1e-3..=10.0;
        /// An end that was found otherwise before the first one leaves this share of how far off
        /// the next is taken to be.
        recalled: f64 = 0.25, in 0.0..=1.0;
    }
}
