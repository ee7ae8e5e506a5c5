//! Where |P| and κ|Q| change places on a vertical line: the positive zeros of F_σ.
//!
//! Each zero comes with a bound on its error. Zeros that rounding does not tell apart come as one,
//! which counts by the change of sign of F across all of them.

use super::factored::Factored;
use super::isolate::{Enclosed, PositiveZeros};
use super::polynomial::{MOST_DEGREE, Polynomial};
use super::shifted::Shifted;
use super::zeros::{Set, Zeros};
use crate::linear::real_zeros::{Switch, direction};
use crate::model::elementary::pow;

/// A relative error of x that is not worth a slower way.
const ENOUGH: f64 = 1e-7;

/// The positive zeros of F by falling frequency.
#[derive(Debug, Clone, Default)]
pub(super) struct Switches {
    /// The zeros.
    pub list: Vec<Switch>,
    /// The sign of F right of 0; none where zeros near 0 leave it open.
    pub at_zero: Option<bool>,
    /// The frequency below which there may be further zeros.
    pub open_below: f64,
}

/// What is known of F near 0.
#[derive(Debug, Clone, Copy)]
pub(super) struct NearZero {
    /// The sign of F right of 0; none where zeros near 0 leave it open.
    pub sign: Option<bool>,
    /// The frequency below which there may be further zeros.
    pub open_below: f64,
}

impl Switches {
    /// Finds the positive zeros of the polynomial `f` in x = ω², which is F on `line` if that is
    /// given. F(0) is taken for 0 exactly where it may be 0.
    ///
    /// Returns false, and leaves nothing known, where the highest coefficient may be 0.
    pub(super) fn find(&mut self, f: &Polynomial, line: Option<&Shifted>) -> bool {
        let Self { list, .. } = self;
        list.clear();
        let found = each_switch(f, line, |switch| list.push(switch));
        self.open_below = found.map_or(0.0, |near| near.open_below);
        self.at_zero = found.and_then(|near| near.sign);
        found.is_some()
    }

    /// What is known of F near 0.
    pub(super) fn near_zero(&self) -> NearZero {
        NearZero {
            sign: self.at_zero,
            open_below: self.open_below,
        }
    }
}

/// Visits the switches of the polynomial `f` in x = ω², by falling frequency. Where `f` is F on
/// `line`, zeros that its coefficients do not tell apart are found from P and Q themselves. F(0) is
/// taken for 0 exactly where it may be 0. None, with no switch visited, where the highest
/// coefficient may be 0.
#[inline]
pub(super) fn each_switch(
    f: &Polynomial,
    line: Option<&Shifted>,
    mut visit: impl FnMut(Switch),
) -> Option<NearZero> {
    if !f.leading().decided() {
        return None;
    }
    if f.coefficient(0).decided() || f.degree() == 0 {
        return Some(switches_of(f, line, 0.0, &mut visit));
    }
    // A zero at 0 itself, or so near that nothing tells it from there.
    Some(switches_of(
        &f.divided_by_variable(),
        None,
        near_zero(f),
        &mut visit,
    ))
}

#[inline]
fn switches_of(
    f: &Polynomial,
    line: Option<&Shifted>,
    open_below: f64,
    visit: &mut impl FnMut(Switch),
) -> NearZero {
    let known = PositiveZeros::of(f);
    let Some(zeros) = known.as_ref().filter(|zeros| precise(zeros)) else {
        return otherwise(f, line, known.as_ref(), open_below, visit);
    };
    by_isolation(f, zeros, open_below, visit)
}

/// Visits the switches from isolated zeros of `f`.
#[inline(always)]
fn by_isolation(
    f: &Polynomial,
    zeros: &PositiveZeros,
    open_below: f64,
    visit: &mut impl FnMut(Switch),
) -> NearZero {
    let mut positive = f.leading().value > 0.0;
    for Enclosed { centre, radius } in zeros.all() {
        let range = (centre - radius, centre + radius);
        visit(switch(range, Some(*centre), (!positive, positive)));
        positive = !positive;
    }
    NearZero {
        sign: Some(positive),
        open_below,
    }
}

/// Visits the switches where the zeros of `f` are not `known` well, or not at all.
#[cold]
fn otherwise(
    f: &Polynomial,
    line: Option<&Shifted>,
    known: Option<&PositiveZeros>,
    open_below: f64,
    visit: &mut impl FnMut(Switch),
) -> NearZero {
    // Without its highest coefficient F is not what P and Q give.
    if let Some(line) = line.filter(|line| line.degree() == f.degree()) {
        return by_discs(f, &Factored::new(line).zeros(f), open_below, visit);
    }
    match known {
        Some(zeros) => by_isolation(f, zeros, open_below, visit),
        None => by_discs(f, &Zeros::of(f), open_below, visit),
    }
}

/// Whether all zeros are known so well that nothing is gained by a slower way.
#[inline]
fn precise(zeros: &PositiveZeros) -> bool {
    let mut all = zeros.all().iter();
    all.all(|zero| zero.radius <= ENOUGH * zero.centre)
}

/// Visits the switches from all `zeros` of `f`: those that are not apart count as one.
fn by_discs(
    f: &Polynomial,
    zeros: &Zeros,
    open_below: f64,
    visit: &mut impl FnMut(Switch),
) -> NearZero {
    let mut sets: [Option<(f64, f64, Set)>; MOST_DEGREE] = [None; MOST_DEGREE];
    let mut count = 0;
    for set in zeros.sets() {
        if let Some((from, to)) = set.on_real_axis().filter(|(_, to)| *to > 0.0) {
            sets[count] = Some((from, to, set));
            count += 1;
        }
    }
    sets[..count].sort_by(|a, b| {
        let middle = |s: &Option<(f64, f64, Set)>| s.map_or(0.0, |(from, to, _)| from + to);
        middle(b).total_cmp(&middle(a))
    });
    let mut positive = f.leading().value > 0.0;
    let constant = f.coefficient(0);
    let mut near = NearZero {
        sign: None,
        open_below,
    };
    for (from, to, set) in sets[..count].iter().flatten() {
        let odd = set.count() % 2 == 1;
        if *from <= 0.0 {
            // It covers 0: only the signs tell how many zeros lie right of it.
            near.open_below = near.open_below.max(to.sqrt());
            if !constant.decided() {
                return near;
            }
            let before = constant.value > 0.0;
            visit(switch((0.0, *to), None, (before, positive)));
            positive = before;
            continue;
        }
        let before = positive ^ odd;
        let lone = (set.count() == 1).then(|| set.middle().re);
        visit(switch((*from, *to), lone, (before, positive)));
        positive = before;
    }
    near.sign = Some(positive);
    near
}

/// The switch within `from` < x < `to`, at `centre` if that is known, where F changes from one sign
/// to the other.
fn switch((from, to): (f64, f64), centre: Option<f64>, (before, after): (bool, bool)) -> Switch {
    let (low, high) = (from.max(0.0).sqrt(), to.sqrt());
    let omega = centre.map_or(0.5 * (low + high), f64::sqrt);
    let error = (high - omega).max(omega - low) + f64::EPSILON * omega;
    Switch {
        omega,
        error,
        sign: direction(before, after),
        simple: centre.is_some(),
    }
}

/// A frequency beyond which the error of F(0) moves no zero that is near 0.
fn near_zero(f: &Polynomial) -> f64 {
    let constant = f.coefficient(0);
    let most = constant.value.abs() + constant.error;
    if most == 0.0 {
        return 0.0;
    }
    // |c_k| xᵏ outweighs it from there on, for the first k of which the sign is known.
    (1..=f.degree())
        .map(|k| (k, f.coefficient(k)))
        .filter(|(_, c)| c.decided())
        .map(|(k, c)| pow(2.0 * most / (c.value.abs() - c.error), 0.5 / k as f64))
        .fold(f64::INFINITY, f64::min)
        .min(1e300)
}
