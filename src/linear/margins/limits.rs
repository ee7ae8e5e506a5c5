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
    /// Limits that are not known.
    pub(crate) const UNDECIDED: Self = Self {
        lower: f64::NAN,
        upper: f64::NAN,
    };
}

/// Margins of the loop, (1) of `margins`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopMargins {
    /// The phase margin in radians; infinite where |L| is 1 nowhere.
    pub phase: f64,
    /// ω at which it is, in units of √(κ/M); NaN where that is not known.
    pub phase_omega: f64,
    /// The latency margin in units of √(M/κ); infinite where no latency matters.
    pub latency: f64,
}
