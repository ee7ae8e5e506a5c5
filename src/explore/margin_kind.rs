//! What a distance to a change of stability is: a number, infinite or unknown.

use serde::Serialize;

/// What a distance to a change of stability is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
#[serde(rename_all = "lowercase")]
pub enum MarginKind {
    /// A number.
    Finite,
    /// Stability never changes.
    Infinite,
    /// It is not known.
    Unknown,
}

impl MarginKind {
    pub(super) fn of(margin: f64) -> Self {
        match margin {
            m if m.is_nan() => Self::Unknown,
            m if m.is_infinite() => Self::Infinite,
            _ => Self::Finite,
        }
    }
}

/// The sign of a distance; 0 where it is not known.
pub(super) fn sign(margin: f64) -> i8 {
    match margin {
        0.0 => 0,
        // The cast turns NaN into 0.
        margin => margin.signum() as i8,
    }
}
