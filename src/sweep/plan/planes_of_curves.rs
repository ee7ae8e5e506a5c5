//! The planes in which crossing curves are traced, or why there are none.

use std::fmt;

use crate::setting::axis::plane_of_curves;
use crate::setting::parameter::Parameter;
use crate::setting::spec::SweepSpec;

/// The most planes whose crossing curves are traced without being asked for.
const PLANES_TRACED_UNASKED: u64 = 1000;
/// The most planes traced without being asked for where every curve is followed step by step.
const PLANES_WALKED_UNASKED: u64 = 100;

/// Why no crossing curves are traced.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoBoundaries {
    /// Nothing is about sliding at a velocity.
    NoSliding,
    /// There is no plane.
    NoPlane,
    /// The sweep says so.
    Unwanted,
    /// Of a digital loop none are known: it has delays of whole samples alone.
    Sampled,
    /// Of such a system none are known.
    OfSystem(&'static str),
    /// They are not asked for in planes without the delay.
    NoDelay,
    /// They are not asked for in so many planes.
    TooMany {
        /// The planes.
        planes: u64,
        /// The most planes that are traced without being asked for.
        most: u64,
    },
}

impl fmt::Display for NoBoundaries {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        const ONLY_ASKED: &str = "they are traced only where the sweep has boundaries = true; a \
            picture traces those that it shows";
        match self {
            Self::NoSliding => f.write_str("the sweep is not about sliding at a velocity"),
            Self::NoPlane => f.write_str("fewer than two of its axes matter for linear stability"),
            Self::Unwanted => f.write_str("the sweep has boundaries = false"),
            Self::Sampled => f.write_str("a digital loop has delays of whole samples alone"),
            Self::OfSystem(what) => write!(f, "of {what} none are known"),
            Self::NoDelay => write!(f, "between two axes without the delay {ONLY_ASKED}"),
            Self::TooMany { planes, most } => {
                write!(f, "in {planes} planes, more than {most}, {ONLY_ASKED}")
            }
        }
    }
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
    if spec.is_sampled() {
        return Err(NoBoundaries::Sampled);
    }
    if let Some(of) = spec.without_curves() {
        return Err(NoBoundaries::OfSystem(of));
    }
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
