//! Regimes of working velocities.

/// The regime of a working velocity v0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum RegimeAtV0 {
    /// Sliding is linearly stable, and there is no stick-slip beside it.
    Stable,
    /// Sliding is linearly stable, and stick-slip coexists with it.
    Bistable,
    /// Sliding is linearly unstable.
    Unstable,
    /// Sliding is linearly stable, but the way to it leads through N ≤ 0.
    LiftOff,
    /// Sliding is marginal, or the fate of stick-slip is unknown.
    Undecided,
}

impl RegimeAtV0 {
    /// All, in the order of their numbers in a map.
    pub(crate) const ALL: [Self; 5] = [
        Self::Stable,
        Self::Bistable,
        Self::Unstable,
        Self::LiftOff,
        Self::Undecided,
    ];

    /// The name in maps.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stable => "stable",
            Self::Bistable => "bistable",
            Self::Unstable => "unstable",
            Self::LiftOff => "lift-off",
            Self::Undecided => "undecided",
        }
    }
}
