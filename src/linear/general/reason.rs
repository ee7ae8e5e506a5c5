//! Why a cell of a general system is not like the others.

/// What is special about a setting, in the order of the numbers that stand for it in a map; 0 there
/// is nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reason {
    /// P(0) + Q(0) = 0: a root at 0 at every delay. Marginal, and not counted.
    RootAtOrigin,
    /// P and Q have a zero on the imaginary axis in common: a root there at every delay. Marginal,
    /// and not counted.
    RootOnAxis,
    /// Infinitely many unstable roots.
    Infinite,
    /// ρ = 1: roots accumulate at the imaginary axis, and it is never exponentially stable.
    NeutralLimit,
    /// No root lies right of the line at which they accumulate: the spectral abscissa is that line,
    /// a supremum.
    NoRightmostRoot,
    /// The highest coefficient is within its error of 0.
    DegreeUnknown,
    /// |P| = |Q| on all of the imaginary axis: not answered.
    Refused,
}

impl Reason {
    /// All reasons, in the order of their numbers.
    pub(crate) const ALL: [Self; 7] = [
        Self::RootAtOrigin,
        Self::RootOnAxis,
        Self::Infinite,
        Self::NeutralLimit,
        Self::NoRightmostRoot,
        Self::DegreeUnknown,
        Self::Refused,
    ];

    /// The name, the same in JSON and in the flag meanings of a map.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::RootAtOrigin => "root-at-origin",
            Self::RootOnAxis => "root-on-axis",
            Self::Infinite => "infinite",
            Self::NeutralLimit => "neutral-limit",
            Self::NoRightmostRoot => "no-rightmost-root",
            Self::DegreeUnknown => "degree-unknown",
            Self::Refused => "refused",
        }
    }

    /// The number that stands for it in a map: 1 and more.
    #[must_use]
    pub const fn number(self) -> u8 {
        self as u8 + 1
    }
}
