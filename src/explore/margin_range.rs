//! The ends of margins, and how far they are.
//!
//! What is not known is NaN here, and a limit that is not lost infinite; JSON has null for both.

use serde::Serialize;

use crate::linear::margins::Limits;

/// Both ends of a range.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct Range {
    /// The lower end; null where there is none.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub lower: f64,
    /// The upper end; null where there is none.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub upper: f64,
}

impl Range {
    /// No ends.
    pub(super) const NONE: Self = Self {
        lower: f64::NAN,
        upper: f64::NAN,
    };

    pub(super) const fn of([lower, upper]: [f64; 2]) -> Self {
        Self { lower, upper }
    }
}

/// How far a parameter may go down and up.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct Margin {
    /// The distance downwards; null where no smaller value matters.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub lower: f64,
    /// The distance upwards; null where no larger value matters.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub upper: f64,
    /// The value below at which stability, or the decay rate, is lost; null where at none.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub from: f64,
    /// The value above; null where at none.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub to: f64,
}

impl Margin {
    /// A margin from limits. A lower limit at `least`, the lower end of the parameter's range,
    /// loses nothing.
    pub(super) fn of(at: f64, limits: Limits, least: f64) -> Self {
        let from = match limits.lower <= least {
            true => f64::NEG_INFINITY,
            false => limits.lower,
        };
        Self {
            lower: at - from,
            upper: limits.upper - at,
            from,
            to: limits.upper,
        }
    }
}
