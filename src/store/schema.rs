//! Names in a map file that are not those of a parameter or field, and the version of its format.

/// Version of the layout described here. Readers refuse others.
pub const FORMAT_VERSION: i32 = 1;

/// Conventions that a map follows.
pub const CONVENTIONS: &str = "CF-1.11";

/// Root attributes.
pub mod root {
    /// [`super::FORMAT_VERSION`] of the file; marks a file as a map.
    pub const FORMAT_VERSION: &str = "slipmap_format_version";
    /// Names of the axes, the map's dimensions in order, separated by blanks.
    pub const AXES: &str = "axes";
    /// Hash of the plan, see [`crate::sweep::Plan::hash`].
    pub const PLAN_HASH: &str = "plan_hash";
    /// The sweep file's text.
    pub const SWEEP: &str = "sweep";
    /// Title of the sweep.
    pub const TITLE: &str = "title";
    /// What wrote the file.
    pub const SOURCE: &str = "source";
    /// Version of the program.
    pub const PROGRAM_VERSION: &str = "program_version";
    /// Git revision of the program.
    pub const GIT_REVISION: &str = "git_revision";
    /// When and how the map was made.
    pub const HISTORY: &str = "history";
    /// Tolerance of the marginal flag.
    pub const MARGINAL_TOLERANCE: &str = "marginal_tolerance";
    /// Name of the friction law, where there is one.
    pub const FRICTION_LAW: &str = "friction_law";
}

/// Name of the status of each cell.
pub const STATUS: &str = "status";
/// Name of the group of crossing curves.
pub const BOUNDARIES: &str = "boundaries";

/// Attribute of that group: the two axes that span the planes of the curves, the parameter and the delay.
pub const PLANE: &str = "plane";
