//! Names in a map or trace file other than those of parameters and fields, and the versions of the
//! formats.

/// Version of the map format that is written. 2: [`DEGREE_OF_STABILITY`] of every curve. 3: indexes
/// with checksums, and a seal at the end of the file. 4: the fields `vc_lower` and `vc_upper`, from
/// which the regime and `v_smooth` follow. 5: `class` is renamed `regime`, and integers have no
/// `_FillValue` where no cell is missing. 6: motions without a given start begin faster than they
/// are pulled, see [`DISTURBED_SINCE`]; the field `last_release`.
pub(crate) const FORMAT_VERSION: i32 = 6;
/// The first version with a seal.
pub(crate) const SEALED_SINCE: i32 = 3;
/// The first version in which motions without a given start are disturbed. Before, they began in
/// equilibrium.
pub(crate) const DISTURBED_SINCE: i32 = 6;
/// The oldest version that is still read; readers refuse older and newer ones.
pub(crate) const OLDEST_FORMAT_VERSION: i32 = 1;

/// Conventions that a map follows.
pub(crate) const CONVENTIONS: &str = "CF-1.11";

/// Version of the trace format that is written. 2: see [`RELEASED_SINCE_SWITCH_ON`].
pub(crate) const TRACE_FORMAT_VERSION: i32 = 2;
/// The first version in which `last_release` counts from switch-on, as `settle_time` does. Before,
/// it counted from t = 0.
pub(crate) const RELEASED_SINCE_SWITCH_ON: i32 = 2;
/// The oldest version of a trace that is still read.
pub(crate) const OLDEST_TRACE_FORMAT_VERSION: i32 = 1;

/// Names in a trace file besides those of parameters.
pub(crate) mod trace {
    /// Root attribute: [`super::TRACE_FORMAT_VERSION`]; marks a file as a trace.
    pub(crate) const FORMAT_VERSION: &str = "slipmap_trace_format_version";
    /// Root attribute: the case file's text.
    pub(crate) const CASE: &str = "case";
    /// Root attribute: name of the outcome.
    pub(crate) const OUTCOME: &str = "outcome";
    /// Group and dimension of the events.
    pub(crate) const EVENT: &str = "event";
    /// The dimension: time. In the group of events: the time of each event.
    pub(crate) const TIME: &str = "t";
    /// The mode of the block from a sample on.
    pub(crate) const MODE: &str = "mode";
    /// Of events: what happens.
    pub(crate) const KIND: &str = "kind";
    /// Of events: the elongation at that time.
    pub(crate) const ELONGATION: &str = "a";
    /// Root attribute: number of steps taken until the outcome was known.
    pub(crate) const STEPS: &str = "steps";
}

/// Root attributes.
pub(crate) mod root {
    /// [`super::FORMAT_VERSION`] of the file; marks a file as a map.
    pub(crate) const FORMAT_VERSION: &str = "slipmap_format_version";
    /// Names of the axes, the map's dimensions in order, separated by blanks.
    pub(crate) const AXES: &str = "axes";
    /// Hash of the plan, see [`crate::sweep::Plan::hash`].
    pub(crate) const PLAN_HASH: &str = "plan_hash";
    /// The sweep file's text.
    pub(crate) const SWEEP: &str = "sweep";
    /// Title of the sweep.
    pub(crate) const TITLE: &str = "title";
    /// What wrote the file.
    pub(crate) const SOURCE: &str = "source";
    /// Version of the program.
    pub(crate) const PROGRAM_VERSION: &str = "program_version";
    /// Git revision of the program.
    pub(crate) const GIT_REVISION: &str = "git_revision";
    /// When and how the map was made.
    pub(crate) const HISTORY: &str = "history";
    /// Number of cells that are not computed yet; absent in a complete map.
    pub(crate) const CELLS_MISSING: &str = "cells_missing";
    /// The share of v0 by which blocks are faster than they are pulled at t = 0, where the sweep
    /// gives no start; absent where it gives one.
    pub(crate) const DISTURBANCE: &str = "disturbance";
    /// Tolerance of the marginal flag.
    pub(crate) const MARGINAL_TOLERANCE: &str = "marginal_tolerance";
    /// [`crate::setting::search::LIMIT`], for a map of that limit.
    pub(crate) const PROTOCOL: &str = "protocol";
    /// The text of the system in the form of a system file; absent for the letter's system.
    pub(crate) const SYSTEM: &str = "system";
    /// Name of the friction law, where there is one.
    pub(crate) const FRICTION_LAW: &str = "friction_law";
    /// Speeds of the points of a friction law from a table.
    pub(crate) const FRICTION_SPEEDS: &str = "friction_speeds";
    /// μ_K at these speeds.
    pub(crate) const FRICTION_MU_K: &str = "friction_mu_k";
    pub(crate) const FRICTION_FORMULA: &str = "friction_formula";
}

/// Attribute of datasets of cells: SHA-256 of the stored bytes of all chunks, one after the other,
/// last dimension fastest.
pub(crate) const CHUNKS_SHA256: &str = "chunks_sha256";

/// Root attribute: SHA-256 over everything in the map except the cells, the references between
/// datasets and the history.
pub(crate) const CONTENTS_SHA256: &str = "contents_sha256";

/// Attributes that summarise the values of a dataset of cells; counts of cells are u64.
pub(crate) mod summary {
    /// The smallest and the largest value, including infinite ones, in the type of the cells. The
    /// name is from the CF conventions.
    pub(crate) const ACTUAL_RANGE: &str = "actual_range";
    /// The smallest and the largest finite value; reals only.
    pub(crate) const FINITE_RANGE: &str = "finite_range";
    /// Number of cells with −∞ and with +∞; reals only.
    pub(crate) const INFINITE: &str = "cells_infinite";
    /// Number of cells without a value.
    pub(crate) const WITHOUT_VALUE: &str = "cells_without_value";
    /// Number of cells of each kind, or with each flag, in the order of `flag_meanings`.
    pub(crate) const FLAG_CELLS: &str = "flag_cells";
    /// Number of cells without any flag.
    pub(crate) const UNFLAGGED: &str = "cells_unflagged";
}

pub(crate) use crate::setting::map_names::{BEST, BOUNDARIES, STATUS};

/// Variables of the group of best settings, besides the gain and the delay.
pub(crate) mod best {
    /// The spectral abscissa.
    pub(crate) const ABSCISSA: &str = "abscissa";
    /// The lowest frequency among the rightmost roots.
    pub(crate) const FREQUENCY: &str = "frequency";
    /// −1/abscissa.
    pub(crate) const RELAXATION_TIME: &str = "relaxation_time";
    /// Number of the [`crate::linear::best::Kind`].
    pub(crate) const KIND: &str = "kind";
    /// Whether the argument principle confirms the abscissa.
    pub(crate) const CERTIFIED: &str = "certified";
    /// Number of stable regions of the plane, with those that are not told.
    pub(crate) const REGIONS: &str = "regions";
    /// The names of these variables.
    pub(crate) const ALL: [&str; 6] = [
        ABSCISSA,
        FREQUENCY,
        RELAXATION_TIME,
        CERTIFIED,
        REGIONS,
        KIND,
    ];
}

/// Value of the flags and counts in the group of best settings where nothing was found.
pub(crate) const BEST_FLAG_FILL: i8 = -1;

/// Attribute of a parameter's variable in the group of curves, where the variable cannot have the
/// parameter's name: that name.
pub(crate) const PARAMETER: &str = "parameter";

/// Attribute of both groups: the two axes that span the planes, the first parameter and the delay.
pub(crate) const PLANE: &str = "plane";

/// σ of each curve: roots on it have Re λ = −σ. Absent before format version 2, where it is 0.
pub(crate) const DEGREE_OF_STABILITY: &str = "degree_of_stability";
/// σ of the curves that meet in a corner.
pub(crate) const CORNER_DEGREE_OF_STABILITY: &str = "corner_degree_of_stability";

/// Attributes of fields over many starts.
pub(crate) mod basin {
    /// What the starts are: states, or phases of the uncontrolled cycle.
    pub(crate) const OVER: &str = "over";
    /// Number of starts.
    pub(crate) const STARTS: &str = "starts";
    /// Number of independent scramblings of their sequence.
    pub(crate) const SCRAMBLINGS: &str = "scramblings";
    /// The region of the starts, in words.
    pub(crate) const REGION: &str = "region";
    /// The range of their velocities, where the sweep gives it.
    pub(crate) const X_DOT0: &str = "x_dot0_range";
    /// The range of their elongations, where the sweep gives it.
    pub(crate) const A0: &str = "a0_range";
}

/// Attributes of fields of the critical velocity.
pub(crate) mod vc {
    /// Name of the protocol.
    pub(crate) const PROTOCOL: &str = "protocol";
    /// Number of phases among which the worst counts, for that protocol.
    pub(crate) const PHASES: &str = "phases";
    /// The largest v0 of the search for stick-slip, in [`V_MAX_UNIT`].
    pub(crate) const V_MAX: &str = "v_max";
    /// The unit of [`V_MAX`], in the words of the map.
    pub(crate) const V_MAX_UNIT: &str = "v_max_unit";
    /// Relative precision of the velocities.
    pub(crate) const PRECISION: &str = "precision";
}
