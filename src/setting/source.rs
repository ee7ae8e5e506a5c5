//! Where the values of a field come from.

use super::parameter::Parameter;
use super::regime_at_v0::RegimeAtV0;
use crate::critical::CriticalWindows;
use crate::critical::limit::LimitCell;
use crate::slip::outcome::Summary;

/// The computation behind a field. For expensive ones the row of the field has the function that
/// picks its value. Counts and roots are picked in `cells`, without a call for each cell.
#[derive(Debug, Clone, Copy)]
pub enum Source {
    /// The closed form of a whole line of delays.
    Line,
    /// The characteristic roots of a cell.
    Roots(OfRoots),
    /// The linear model of a cell, besides its counts and roots.
    Linear(OfLinear),
    /// The distance of a cell from the boundary of stability.
    Margins(OfMargins),
    /// The motion of the block, which needs a friction law and depends on its start.
    Motion(fn(&Summary) -> f64),
    /// The critical velocity, which needs a friction law.
    Critical(fn(&VcCell) -> f64),
    /// The motion or, beside fields of the critical velocity, the critical velocity.
    MotionOrCritical(fn(&Summary) -> f64, fn(&VcCell) -> f64),
    /// The motions from many starts, which need a friction law.
    Basin(fn(&BasinCell) -> f64),
    /// The limit of a short delay.
    Limit(fn(&LimitCell) -> f64),
}

/// What a cell costs, the cheapest first. The dearest field of a sweep decides on the size of its
/// tiles, its memory, and whether a stop is heeded between cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Cost {
    /// A share of the closed form of a line, or of the limit of a short delay: well below 1 µs.
    Counted,
    /// Roots, followed from delay to delay: thousands of times as much.
    Rooted,
    /// Margins, searched for in every cell.
    Searched,
    /// The stability radius, proved box by box: about 1 ms.
    Proved,
    /// A motion: about 1 ms.
    Followed,
    /// Motions from many starts.
    FollowedOften,
    /// A critical velocity: up to 1 s.
    Critical,
}

impl Source {
    /// What a cell costs.
    #[must_use]
    pub(crate) const fn cost(self) -> Cost {
        match self {
            Self::Line | Self::Linear(_) | Self::Limit(_) => Cost::Counted,
            Self::Roots(_) => Cost::Rooted,
            Self::Margins(OfMargins::StabilityRadius) => Cost::Proved,
            Self::Margins(_) => Cost::Searched,
            Self::Motion(_) | Self::MotionOrCritical(..) => Cost::Followed,
            Self::Basin(_) => Cost::FollowedOften,
            Self::Critical(_) => Cost::Critical,
        }
    }
}

/// A number from the roots of a cell. Roots are ranked from the right, with rank 0 for the
/// rightmost one; conjugate pairs count once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OfRoots {
    /// Re λ of the root of this rank.
    RealPart(usize),
    /// |Im λ| of the root of this rank.
    Frequency(usize),
    /// The time in which a disturbance decays by a factor e.
    RelaxationTime,
    /// The largest |z| = e^(Re λ h) of a digital loop.
    SpectralRadius,
    /// The derivative of the spectral abscissa with respect to a parameter.
    Derivative(Slope),
    /// Distance from the spectral abscissa to a line on its right that certifiably has no root to
    /// its right.
    CertificateMargin,
}

/// A quantity of the linear model of a cell, besides counts and roots.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OfLinear {
    /// Why the cell is special: 0 for no reason, or the number of a
    /// [`Reason`](crate::linear::general::Reason).
    Reason,
    /// The real part at which roots accumulate.
    EssentialAbscissa,
    /// Stiffness over the critical stiffness of rate-and-state friction.
    StiffnessRatio,
}

/// A margin of a cell, see [`margins`](crate::linear::margins).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OfMargins {
    /// The factor of both gains below 1 at which stability is lost.
    GainLower,
    /// The factor of both gains above 1 at which stability is lost.
    GainUpper,
    /// The smallest phase shift of the loop at which stability is lost.
    Phase,
    /// The largest latency of the feedback, counted from none, at which sliding stays stable.
    Latency,
    /// The least distance of the loop from −1.
    Modulus,
    /// The largest relative box of parameters.
    StabilityRadius,
}

impl OfRoots {
    /// Number of roots from the right that this needs.
    pub(super) const fn needed(self) -> usize {
        match self {
            Self::RealPart(rank) | Self::Frequency(rank) => rank + 1,
            Self::RelaxationTime
            | Self::SpectralRadius
            | Self::Derivative(_)
            | Self::CertificateMargin => 1,
        }
    }
}

/// A parameter with respect to which the spectral abscissa is differentiated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Slope {
    /// τ.
    Tau,
    /// α_v.
    AlphaV,
    /// α_N.
    AlphaN,
    /// μ_K′, at fixed μ_K.
    MuPrime,
}

impl Slope {
    /// The parameter.
    #[must_use]
    pub const fn parameter(self) -> Parameter {
        match self {
            Self::Tau => Parameter::Tau,
            Self::AlphaV => Parameter::AlphaV,
            Self::AlphaN => Parameter::AlphaN,
            Self::MuPrime => Parameter::MuPrime,
        }
    }
}

/// The results for stick-slip in a cell, in units of the sweep.
#[derive(Debug, Clone, Copy)]
pub struct VcCell<'a> {
    /// Where stick-slip survives, and how it ends.
    pub found: &'a CriticalWindows,
    /// The regime of v0; none where no field needs it.
    pub regime: Option<RegimeAtV0>,
    /// The velocity above which sliding is linearly stable and free of stick-slip; NaN where no
    /// field needs it.
    pub v_smooth: f64,
}

/// The share of starts in a cell from which control ends in sliding; NaN where there is no
/// uncontrolled cycle to start in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BasinCell {
    /// The share of all starts.
    pub share: f64,
    /// Its standard error, or that of `upper`, whichever is larger.
    pub error: f64,
    /// The share if all undecided starts ended in sliding.
    pub upper: f64,
}
