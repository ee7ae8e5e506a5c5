//! The planes in which crossing curves are traced, or why there are none.

use crate::setting::axis::plane_of_curves;
use crate::setting::parameter::Parameter;
use crate::setting::spec::SweepSpec;

/// The most planes whose crossing curves are traced without being asked for.
const PLANES_TRACED_UNASKED: u64 = 1000;
/// The most planes traced without being asked for where every curve is followed step by step.
const PLANES_WALKED_UNASKED: u64 = 100;

/// Why no crossing curves are traced.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NoBoundaries {
    /// Nothing is about sliding at a velocity.
    #[error("the sweep is not about sliding at a velocity")]
    NoSliding,
    /// There is no plane.
    #[error("fewer than two of its axes matter for linear stability")]
    NoPlane,
    /// The sweep says so.
    #[error("the sweep has boundaries = false")]
    Unwanted,
    /// They are not asked for in planes without the delay.
    #[error(
        "between two axes without the delay they are traced only where the sweep has \
         boundaries = true; a picture traces those that it shows"
    )]
    NoDelay,
    /// They are not asked for in so many planes.
    #[error(
        "in {planes} planes, more than {most}, they are traced only where the sweep has \
         boundaries = true; a picture traces those that it shows"
    )]
    TooMany {
        /// The planes.
        planes: u64,
        /// The most planes that are traced without being asked for.
        most: u64,
    },
}

impl NoBoundaries {
    /// Whether `boundaries = true` would have them traced.
    #[must_use]
    pub(crate) const fn is_only_unasked(self) -> bool {
        matches!(self, Self::NoDelay | Self::TooMany { .. })
    }
}

/// The axes (p, q) of the planes of a sweep in which crossing curves are traced.
///
/// # Errors
/// Why none are.
pub(super) fn of(spec: &SweepSpec) -> Result<(usize, usize), NoBoundaries> {
    if !spec.has_sliding() {
        return Err(NoBoundaries::NoSliding);
    }
    let (p, q) = plane_of_curves(&spec.axes).ok_or(NoBoundaries::NoPlane)?;
    let outer = spec.axes.iter().enumerate();
    let outer = outer.filter(|&(i, _)| i != p && i != q);
    let planes: u64 = outer.map(|(_, axis)| axis.len() as u64).product();
    let asked = !spec.degrees_of_stability.is_empty();
    match spec.boundaries.or(asked.then_some(true)) {
        Some(true) => return Ok((p, q)),
        Some(false) => return Err(NoBoundaries::Unwanted),
        None => {}
    }
    let most = match (traced_by_closed_form(spec, q), spec.is_of_letter()) {
        (true, _) => PLANES_TRACED_UNASKED,
        (false, false) => PLANES_WALKED_UNASKED,
        // In the letter's own planes without the delay, curves are traced only when asked for.
        (false, true) => return Err(NoBoundaries::NoDelay),
    };
    match planes <= most {
        true => Ok((p, q)),
        false => Err(NoBoundaries::TooMany { planes, most }),
    }
}

/// Whether the curves in planes with the second axis `q` come from the closed form for the letter's
/// lines of delays.
#[must_use]
pub(crate) fn traced_by_closed_form(spec: &SweepSpec, q: usize) -> bool {
    spec.axes[q].parameter == Parameter::Tau && spec.is_of_letter()
}
