//! Exact boundaries of stability and of degrees of stability over a plane of two parameters of a
//! general system.
//!
//! - σ = 0: every curve along which a pair lies on the imaginary axis, cut where another root comes
//!   to it. Where q is the delay alone, all crossing delays of 257 lines are known, and each curve
//!   through one of them is followed as a whole. In other planes curves are found where the number
//!   of unstable roots changes along 257 columns of 256 steps each. In both, along the edges of
//!   smallest and largest q, too.
//! - σ > 0: what bounds the region where every root has Re λ < −σ, see [`decay`](mod@decay).
//! - Both: a real root at −σ, and |p_n| = κ|q_n| with κ = e^(στ): where p_n vanishes, a root comes
//!   from infinity; in neutral equations roots accumulate at the line.
//!
//! **Limits.** What fits between two columns is missed; in planes without lines of delays also
//! curves that every column passes twice within one of its steps.

use num_complex::Complex64;

use super::level::Level;
use super::plane::SystemPlane;
use super::sides::pieces;
use super::starts::starts;
use crate::linear::curves::{CurveKind, CurvePiece, PlaneCurves, StableSide, TooManyCurves};
use crate::linear::decay::{self, trace_whole};
use crate::linear::plane::Plane;
use crate::model::elementary::exp;

/// Traces the curves of `plane` for the degree of stability `sigma` ≥ 0, in the unit of time of the
/// plane: all curves for σ = 0, what bounds the region for σ > 0. Once the plane is stopped, the
/// answer comes soon but is meaningless.
///
/// # Errors
/// When there are more curves in the window than can be traced.
pub fn trace(plane: &SystemPlane, sigma: f64) -> Result<PlaneCurves, TooManyCurves> {
    let mut curves = if sigma == 0.0 {
        let mut curves = trace_whole(plane, sigma, &starts(plane)?)?;
        let at_origin = |p: f64, q: f64| plane.at(p, q, Complex64::ZERO).value.re;
        let level = Level {
            value: &at_origin,
            window: plane.window(),
            of_p: plane.has_lines(),
            stopped: &|| plane.stopped(),
        };
        let real = pieces(plane, sigma, CurveKind::RealRoot, &level);
        curves.pieces.extend(real);
        curves
    } else {
        decay::trace_in(plane, sigma)?
    };
    add_leading(plane, sigma, &mut curves);
    Ok(curves)
}

/// Adds where p_n + κq_n or p_n − κq_n vanishes.
fn add_leading(plane: &SystemPlane, sigma: f64, curves: &mut PlaneCurves) {
    let degree = plane.largest_degree();
    let vanishing = |sign: f64| {
        let value = |p: f64, q: f64| {
            let Some(setting) = plane.setting(p, q) else {
                return f64::NAN;
            };
            let [of_p, of_q] = setting.system.coefficients(degree);
            of_p + sign * exp(sigma * setting.tau) * of_q
        };
        let level = Level {
            value: &value,
            window: plane.window(),
            of_p: plane.has_lines() && sigma == 0.0,
            stopped: &|| plane.stopped(),
        };
        pieces(plane, sigma, CurveKind::LeadingCoefficient, &level)
    };
    let (mut all, second) = (vanishing(1.0), vanishing(-1.0));
    // Without q_n both are one.
    if all != second {
        all.extend(second);
    }
    let bounds = |piece: &CurvePiece| sigma == 0.0 || piece.stable_side != StableSide::Neither;
    curves.pieces.extend(all.into_iter().filter(bounds));
}
