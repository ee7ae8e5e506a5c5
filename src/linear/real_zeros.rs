//! All zeros of a real function f of the frequency ω.
//!
//! The zeros are found by going along ω in steps that nothing can be hidden in. With M ≥ |f″| up to
//! the end of a step h from ω, there is
//!
//! ```text
//! no zero             where |f| − h max(0, −sgn(f) f′) − M h²/2 > 0,                         (1)
//! at most one zero    where |f′| > M h.                                                      (2)
//! ```
//!
//! The longer of the two steps is taken: one evaluation a step. Where both come to nothing the sign
//! of f is lost in rounding, as at a touch. Such a stretch is told as it is, with the signs of f on
//! both sides. Counts with latency and margins search in this way.

use super::rounded::Rounded;
use crate::model::elementary::power;

/// Steps after which the zeros are too many to be listed.
pub(super) const MOST_STEPS: u64 = 1 << 17;
/// A step is at most this many times as long as the step before: the bound M belongs to its end.
const GROWTH: f64 = 2.0;
/// The part of the way to the last zero that is tried as the first step.
const FIRST_STEP: f64 = 1.0 / 16.0;
/// Steps shorter than this part of ω lead nowhere.
const SHORTEST_STEP: f64 = 1e-13;
/// What rounding of the length of a step itself may add to it.
const A_LITTLE_LESS: f64 = 1.0 - 1e-9;
/// Parts of a step that are tried until the sign of f is known at its end.
const PARTS: [f64; 5] = [1.0, 0.9, 0.77, 0.6, 0.4];
/// Halvings of ω from the last zero down until the sign of f near 0 is known.
const MOST_HALVINGS: i32 = 60;
/// The relative precision from which one step more of Newton's method comes to that of rounding.
const NEARLY: f64 = 1e-10;
/// The most steps of Newton's method, with halvings between, until a zero is polished.
const MOST_POLISHINGS: usize = 100;

/// A function f whose zeros are looked for.
pub trait RealFunction {
    /// f and f′ at `omega` ≥ 0.
    fn at(&self, omega: f64) -> At;

    /// M ≥ |f″| up to `omega`.
    fn bend(&self, omega: f64) -> f64;
}

/// f and f′ at one frequency with bounds on their errors.
#[derive(Debug, Clone, Copy)]
pub struct At {
    pub(super) omega: f64,
    pub(super) value: Rounded,
    pub(super) slope: Rounded,
}

impl At {
    /// The sign of f, or none where it is lost.
    #[inline]
    pub(super) fn sign(&self) -> Option<bool> {
        self.value.decided().then_some(self.value.value > 0.0)
    }
}

/// A zero, or several that cannot be told apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Switch {
    /// The frequency ω of the zero.
    pub omega: f64,
    /// A bound on the error of ω.
    pub error: f64,
    /// Half the change of the sign of f with growing ω.
    pub sign: i8,
    /// Whether this is one zero, and simple.
    pub simple: bool,
}

/// The zeros are too many to be listed, or their number is open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct TooMany;

/// How zeros are searched for.
#[derive(Debug, Clone, Copy)]
pub(super) struct Search {
    /// A frequency beyond which no zero is asked for.
    pub to: f64,
    /// The relative precision of zeros; 0 for that of rounding.
    pub precision: f64,
}

/// Half the change between two signs, each given as whether it is positive.
pub(super) const fn direction(before: bool, after: bool) -> i8 {
    after as i8 - before as i8
}

/// Tells `found` all zeros of `f` from `here`, where its sign is known, by rising frequency; beyond
/// the last of them it is taken for positive. `found` ends the search by returning false. `left` is
/// how many steps may be taken, less by those that were.
///
/// # Errors
/// When there are too many, or `found` ended it.
#[inline]
pub(super) fn zeros_from(
    f: &impl RealFunction,
    here: At,
    search: Search,
    left: &mut u64,
    mut found: impl FnMut(Switch) -> bool,
) -> Result<(), TooMany> {
    let mut way = Way {
        f,
        here,
        step: 0.5 * FIRST_STEP * (search.to - here.omega),
        search,
    };
    while *left > 0 {
        if way.here.omega >= search.to {
            return Ok(());
        }
        *left -= 1;
        if let Some(switch) = way.go()
            && !found(switch)
        {
            return Err(TooMany);
        }
    }
    Err(TooMany)
}

/// Tells `found` all zeros of `f` up to `to`, and maybe some beyond it, by rising frequency: 0
/// where f may be 0 there, and one zero for each stretch on which the sign of f is lost. With each
/// it tells whether f changes its sign there; where not, f may come near 0 without a zero.
///
/// # Errors
/// When there are too many, and where nothing is known of f.
pub(super) fn zeros(
    f: &impl RealFunction,
    to: f64,
    mut found: impl FnMut(f64, bool),
) -> Result<(), TooMany> {
    if to == 0.0 {
        return Ok(());
    }
    let mut here = f.at(0.0);
    if here.sign().is_none() {
        found(0.0, true);
        here = beyond_zero(f, &here, to).ok_or(TooMany)?;
    }
    let search = Search {
        to,
        precision: NEARLY,
    };
    zeros_from(f, here, search, &mut { MOST_STEPS }, |switch| {
        found(nearer(f, &switch), switch.sign != 0);
        true
    })
}

/// A place with a known sign of f before which there is no zero but the one at or near 0, `zero`.
fn beyond_zero(f: &impl RealFunction, zero: &At, to: f64) -> Option<At> {
    let longest = FIRST_STEP * to;
    let step = A_LITTLE_LESS * monotone(zero, f.bend(longest)).min(longest);
    let mut ends = PARTS.iter().map(|part| f.at(part * step));
    let there = ends.find(|there| step > 0.0 && there.value.decided());
    there.or_else(|| lowest_decided(f, to))
}

/// The lowest place with a known sign of f among halvings of the way to `to`.
pub(super) fn lowest_decided(f: &impl RealFunction, to: f64) -> Option<At> {
    (0..=MOST_HALVINGS)
        .rev()
        .map(|halvings| f.at(to * power(0.5, halvings)))
        .find(|here| here.value.decided())
}

/// A zero that is nearly known, by one step more: no bound on errors holds it back, which are
/// generous. Where f only touches 0, the place where its slope is 0.
fn nearer(f: &impl RealFunction, switch: &Switch) -> f64 {
    let Switch { omega, error, .. } = *switch;
    let step = if switch.sign == 0 {
        let [before, after] = [omega - error, omega + error].map(|at| f.at(at).slope.value);
        error * (before + after) / (before - after)
    } else {
        let at = f.at(omega);
        -at.value.value / at.slope.value
    };
    if step.abs() <= error {
        omega + step
    } else {
        omega
    }
}

/// A part of the way from one known sign of f to the next.
struct Way<'f, F> {
    f: &'f F,
    /// The last place with a known sign.
    here: At,
    step: f64,
    search: Search,
}

impl<F: RealFunction> Way<'_, F> {
    /// Goes one step on; the switch that lies in it, if one does.
    #[inline]
    fn go(&mut self) -> Option<Switch> {
        let from = self.here;
        let longest = GROWTH * self.step;
        let (step, monotone) = step(self.f, &from, longest);
        let step = step.min(longest);
        if step < SHORTEST_STEP * from.omega {
            return self.leap(&from);
        }
        for part in PARTS {
            let omega = from.omega + part * step;
            let there = self.f.at(omega);
            let Some(sign) = there.sign() else { continue };
            self.here = there;
            self.step = part * step;
            let before = from.value.value > 0.0;
            if sign == before {
                return None;
            }
            if monotone {
                let (omega, error) = polish(self.f, &from, &there, self.search.precision);
                return Some(Switch {
                    omega,
                    error,
                    sign: direction(before, sign),
                    simple: true,
                });
            }
            return Some(between(&from, &there));
        }
        self.leap(&from)
    }

    /// Goes over a stretch on which the sign of f is lost.
    fn leap(&mut self, from: &At) -> Option<Switch> {
        let to = self.search.to;
        let mut step = SHORTEST_STEP * from.omega.max(1e-3 * to);
        loop {
            let there = self.f.at(from.omega + step);
            if there.value.decided() {
                self.here = there;
                self.step = step;
                return Some(between(from, &there));
            }
            if there.omega > to {
                // Beyond the last zero.
                self.here = there;
                self.step = step;
                let mut end = there;
                end.value.value = 1.0;
                return Some(between(from, &end));
            }
            step *= 1.5;
        }
    }
}

/// All that may lie between two places with known signs of f, as one switch.
fn between(from: &At, to: &At) -> Switch {
    let omega = 0.5 * (from.omega + to.omega);
    Switch {
        omega,
        error: 0.5 * (to.omega - from.omega) + f64::EPSILON * omega,
        sign: direction(from.value.value > 0.0, to.value.value > 0.0),
        simple: false,
    }
}

/// The step (2) from `from`, as far as `bend` goes.
#[inline]
fn monotone(from: &At, bend: f64) -> f64 {
    (from.slope.value.abs() - from.slope.error) / bend
}

/// A step from `from` within which f has one zero at most, no longer than `longest`, and whether it
/// can have one.
#[inline]
fn step(f: &impl RealFunction, from: &At, longest: f64) -> (f64, bool) {
    let bend = f.bend(from.omega + longest);
    let left = from.value.value.abs() - from.value.error;
    let falling = -from
        .slope
        .value
        .copysign(from.slope.value * from.value.value);
    let falling = falling + from.slope.error;
    let root = (falling * falling + 2.0 * bend * left).sqrt();
    let clear = if falling > 0.0 {
        2.0 * left / (falling + root)
    } else {
        (root - falling) / bend
    };
    let monotone = monotone(from, bend);
    if clear >= monotone {
        (A_LITTLE_LESS * clear, false)
    } else {
        (A_LITTLE_LESS * monotone, true)
    }
}

/// The zero between `from` and `to`, at which the signs of f differ, f being monotone between; with
/// a bound on its error.
fn polish(f: &impl RealFunction, from: &At, to: &At, precision: f64) -> (f64, f64) {
    let rising = to.value.value > 0.0;
    let (mut low, mut high) = (from.omega, to.omega);
    let start = if from.value.value.abs() < to.value.value.abs() {
        from
    } else {
        to
    };
    let mut at = *start;
    let mut last = f64::INFINITY;
    for _ in 0..MOST_POLISHINGS {
        let newton = at.omega - at.value.value / at.slope.value;
        let step = (newton - at.omega).abs();
        let inside = low < newton && newton < high && step < 0.5 * last;
        if inside && step <= precision.max(4.0 * f64::EPSILON) * at.omega {
            break;
        }
        let next = if inside { newton } else { 0.5 * (low + high) };
        last = if inside { step } else { high - low };
        if next <= low || next >= high {
            break;
        }
        at = f.at(next);
        if (at.value.value > 0.0) == rising {
            high = next;
        } else {
            low = next;
        }
        if !at.value.decided() {
            break;
        }
    }
    (at.omega, error(f, &at, (from.omega, to.omega)))
}

/// How far the zero of f can be from where `at` is; f is monotone in the range.
fn error(f: &impl RealFunction, at: &At, (from, to): (f64, f64)) -> f64 {
    let above = at.value.value.abs() + at.value.error;
    let slope = at.slope.value.abs() - at.slope.error;
    let near = 2.0 * above / slope;
    // With |f′| at least half of what it is here, the zero is no farther than that.
    let error = if near > 0.0 && f.bend(at.omega + near) * near <= 0.5 * slope {
        near
    } else {
        (to - at.omega).max(at.omega - from)
    };
    error + f64::EPSILON * at.omega
}
