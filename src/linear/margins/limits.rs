//! What margins are told as.

/// Where stability is lost on both sides of a setting.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// The value below; that of the parameter's range where it is not lost.
    pub lower: f64,
    /// The value above; infinite where it is not lost.
    pub upper: f64,
}

impl Limits {
    /// Where that is not known.
    pub const UNDECIDED: Self = Self {
        lower: f64::NAN,
        upper: f64::NAN,
    };
}

/// Margins of the loop: (1) of the room.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopMargins {
    /// In radians; infinite where |L| is 1 nowhere.
    pub phase: f64,
    /// In units of √(M/κ); infinite where no latency matters.
    pub latency: f64,
}
