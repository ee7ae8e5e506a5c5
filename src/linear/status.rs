//! The status bits of a cell.

/// An independent method confirmed the cell.
pub const CERTIFIED: u8 = 1;
/// The cell lies within rounding of a change of its count.
pub const MARGINAL: u8 = 2;
/// A computation in the cell did not converge.
pub const NOT_CONVERGED: u8 = 4;
/// Two methods disagree about the cell.
pub const DISAGREE: u8 = 8;
/// The count is larger than the map can hold, [`MOST_COUNTED`] stands for it.
pub const SATURATED: u8 = 16;
/// The cell was recomputed by a second method, as a sample.
pub const SAMPLED: u8 = 32;
/// The setting of the cell is outside the model's range: it has no values.
pub const OUTSIDE_MODEL: u8 = 64;

/// Something is amiss with a cell that has one of these.
pub const AMISS: u8 = MARGINAL | NOT_CONVERGED | DISAGREE | SATURATED | OUTSIDE_MODEL;

/// Every bit with its name as it stands in the map, in the order of the bits.
pub const FLAGS: [(u8, &str); 7] = [
    (CERTIFIED, "certified"),
    (MARGINAL, "marginal"),
    (NOT_CONVERGED, "not_converged"),
    (DISAGREE, "disagree"),
    (SATURATED, "saturated"),
    (SAMPLED, "sampled"),
    (OUTSIDE_MODEL, "outside_model"),
];

/// The largest count of unstable roots that a map holds; 65535 is the fill value of cells not
/// computed.
pub const MOST_COUNTED: u16 = u16::MAX - 1;

/// Stands for a count that does not exist: infinitely many roots are unstable, or their number is
/// not known. It is the fill value of a map.
pub const NOT_COUNTED: u16 = u16::MAX;
