//! Where the values of a field come from.

use super::parameter::Parameter;
use super::regime_at_v0::RegimeAtV0;
use crate::critical::CriticalWindows;
use crate::critical::limit::LimitCell;
use crate::slip::outcome::Summary;

/// What computes a field. Where that takes long, the row of the field has the function that picks
/// its value; counts and roots are picked in `cells`, without a call for each cell.
#[derive(Debug, Clone, Copy)]
pub enum Source {
    /// The closed form of a whole line of delays.
    Line,
    /// The characteristic roots of a cell.
    Roots(OfRoots),
    /// The linear model of a cell, besides its counts and roots.
    Linear(OfLinear),
    /// How far a cell is from the boundary of stability.
    Margins(OfMargins),
    /// The motion of the block, which needs a friction law and depends on its start.
    Motion(fn(&Summary) -> f64),
    /// The critical velocity, which needs a friction law.
    Critical(fn(&VcCell) -> f64),
    /// The motion or, beside fields of the critical velocity, that.
    MotionOrCritical(fn(&Summary) -> f64, fn(&VcCell) -> f64),
    /// The motions from many starts, which need a friction law.
    Basin(fn(&BasinCell) -> f64),
    /// The limit of a short delay.
    Limit(fn(&LimitCell) -> f64),
}

/// A number that comes from the roots of a cell. Roots are ranked from the right, conjugate pairs
/// counted once; 0 is the rightmost one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OfRoots {
    /// Re λ of the root of this rank.
    RealPart(usize),
    /// |Im λ| of the root of this rank.
    Frequency(usize),
    /// The time in which a disturbance decays by a factor e.
    RelaxationTime,
    /// The derivative of the spectral abscissa with respect to a parameter.
    Derivative(Slope),
    /// How far right of the spectral abscissa no root is certified to lie.
    CertificateMargin,
}

/// What the linear model of a cell tells besides counts and roots.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OfLinear {
    /// Why the cell is not like others: 0, or the number of a
    /// [`Reason`](crate::linear::general::Reason).
    Reason,
    /// The real part at which roots accumulate.
    EssentialAbscissa,
    /// Stiffness over the critical one of rate-and-state friction.
    StiffnessRatio,
}

/// A margin of a cell, see [`margins`](crate::linear::margins).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OfMargins {
    /// The factor of both gains below 1 at which stability is lost.
    GainLower,
    /// The one above 1.
    GainUpper,
    /// The least angle of the loop.
    Phase,
    /// The largest further latency of the feedback.
    Latency,
    /// The largest relative box of parameters.
    StabilityRadius,
}

impl OfRoots {
    /// Number of roots from the right that it needs.
    pub(super) const fn needed(self) -> usize {
        match self {
            Self::RealPart(rank) | Self::Frequency(rank) => rank + 1,
            Self::RelaxationTime | Self::Derivative(_) | Self::CertificateMargin => 1,
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

/// What is known of stick-slip in a cell, in units of the sweep.
#[derive(Debug, Clone, Copy)]
pub struct VcCell<'a> {
    /// Where stick-slip survives, and how it ends.
    pub found: &'a CriticalWindows,
    /// What v0 is good for; none where no field asks.
    pub regime: Option<RegimeAtV0>,
    /// The velocity above which sliding is linearly stable and free of stick-slip; NaN where no
    /// field asks.
    pub v_smooth: f64,
}

/// What is known in a cell of the starts from which control ends in sliding; NaN where there is no
/// uncontrolled cycle to start in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BasinCell {
    /// Their share of all.
    pub share: f64,
    /// Its standard error, or that of `upper`, whichever is larger.
    pub error: f64,
    /// The share if all that are undecided came to slide.
    pub upper: f64,
}
