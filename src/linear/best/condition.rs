//! What holds at a setting of fastest decay, as two equations for gain and delay.
//!
//! The abscissa is the largest real part of a root, a maximum of functions that are smooth but
//! where roots meet. At its minimum either several roots share the real part, or a root is double
//! or triple, or the gradient vanishes along what is left free. With D the characteristic function,
//! a prime for d/dλ and indices for derivatives with respect to the gain and the delay:
//!
//! - a double pair: D(μ) = 0 where D′(μ) = 0, a complex equation
//! - a triple real root: D(ν) = D′(ν) = 0 where D″(ν) = 0
//! - a double real root at rest: D(μ) = 0, and D_g D′_τ − D_τ D′_g = 0, by which μ does not move
//!   along the curve D = D′ = 0
//! - roots with equal real parts; where there are only two, ∇Re λ₁ × ∇Re λ₂ = 0 as well
//! - one root at rest: ∇Re λ = 0

use num_complex::Complex64;

use super::search::{Place, Search, SearchedGain};
use crate::linear::characteristic::Jet;
use crate::linear::newton::polish;
use crate::linear::sensitivity::Sensitivity;
use crate::model::elementary::{norm, pow};

/// Steps of Newton's method towards a zero of D′ or D″.
const MOST_STEPS: u32 = 30;
/// A pair is off the real axis by more than this, relative.
const OFF_AXIS: f64 = 1e-9;

/// A root, or a point at which derivatives of D vanish, that is followed from place to place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Followed {
    /// A zero of D.
    Root(Complex64),
    /// A zero of D′ off the real axis: where a pair is double if D vanishes there too.
    DoublePair(Complex64),
    /// A real zero of D′.
    DoubleReal(f64),
    /// A real zero of D″.
    TripleReal(f64),
}

impl Followed {
    /// The roots at a place nearby; none where one is lost.
    fn moved(self, search: &Search, place: Place) -> Option<Self> {
        let at = |lambda| derivatives(search, place, lambda);
        match self {
            Self::Root(start) => {
                let root = polish(search.groups(place.gain), place.tau, start)?;
                Some(Self::Root(root.lambda))
            }
            Self::DoublePair(start) => {
                let found = newton(start, |l| (at(l)[1], at(l)[2]))?;
                // On the real axis it is no pair.
                (found.im.abs() > OFF_AXIS * norm(found)).then_some(Self::DoublePair(found))
            }
            Self::DoubleReal(start) => {
                newton(start.into(), |l| (at(l)[1], at(l)[2])).map(|l| Self::DoubleReal(l.re))
            }
            Self::TripleReal(start) => {
                newton(start.into(), |l| (at(l)[2], at(l)[3])).map(|l| Self::TripleReal(l.re))
            }
        }
    }

    /// Where it is.
    pub(super) fn lambda(self) -> Complex64 {
        match self {
            Self::Root(lambda) | Self::DoublePair(lambda) => lambda,
            Self::DoubleReal(lambda) | Self::TripleReal(lambda) => lambda.into(),
        }
    }

    /// How many roots coincide there once its equations hold.
    fn multiplicity(self) -> u32 {
        match self {
            Self::Root(_) => 1,
            Self::DoublePair(_) | Self::DoubleReal(_) => 2,
            Self::TripleReal(_) => 3,
        }
    }

    /// How far rounding of D can move its real part: |m! ε/D^(m)|^(1/m) at a root of multiplicity
    /// m.
    pub(super) fn blur(self, search: &Search, place: Place) -> f64 {
        let lambda = self.lambda();
        let groups = search.groups(place.gain);
        let jet = Jet::at(groups, place.tau, lambda);
        let m = self.multiplicity();
        let derivative = norm(derivatives(search, place, lambda)[m as usize]);
        let factorial = f64::from((1..=m).product::<u32>());
        let rounding = jet.rounding(groups, place.tau, lambda);
        pow(factorial * rounding / derivative, 1.0 / f64::from(m))
    }
}

/// What holds at an optimum: what is followed, and which equations it satisfies.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Condition {
    /// The first one gives the abscissa.
    pub followed: Vec<Followed>,
}

impl Condition {
    /// What is active at a place nearby.
    pub(super) fn moved(&self, search: &Search, place: Place) -> Option<Self> {
        let followed = self.followed.iter().map(|f| f.moved(search, place));
        Some(Self {
            followed: followed.collect::<Option<_>>()?,
        })
    }

    /// The real part that is minimal.
    pub(super) fn abscissa(&self) -> f64 {
        let real_parts = self.followed.iter().map(|f| f.lambda().re);
        real_parts.fold(f64::NEG_INFINITY, f64::max)
    }

    /// What vanishes at an optimum inside the box: two numbers.
    pub(super) fn inside(&self, search: &Search, place: Place) -> Option<[f64; 2]> {
        let gap = |i: usize| self.followed[i].lambda().re - self.followed[i + 1].lambda().re;
        let first = self.followed[0];
        Some(match (first, self.followed.len()) {
            (Followed::DoublePair(l), _) => {
                let value = derivatives(search, place, l)[0];
                [value.re, value.im]
            }
            (Followed::TripleReal(l), _) => {
                let [value, slope, ..] = derivatives(search, place, l.into());
                [value.re, slope.re]
            }
            (Followed::DoubleReal(l), 1) => {
                let value = derivatives(search, place, l.into())[0].re;
                let by = by_parameters(search, place, l.into());
                [value, (by.gain * by.slope_tau - by.tau * by.slope_gain).re]
            }
            (Followed::DoubleReal(l), _) => [derivatives(search, place, l.into())[0].re, gap(0)],
            (Followed::Root(l), 1) => gradient(search, place, l),
            (Followed::Root(_), 2) => {
                let [p, q] = [0, 1].map(|i| gradient(search, place, self.followed[i].lambda()));
                [gap(0), p[0] * q[1] - p[1] * q[0]]
            }
            (Followed::Root(_), 3) => [gap(0), gap(1)],
            _ => return None,
        })
    }

    /// What vanishes at an optimum on an edge of the box, where only the gain (`along_gain`) or
    /// only the delay is free.
    pub(super) fn on_edge(&self, search: &Search, place: Place, along_gain: bool) -> Option<f64> {
        let first = self.followed[0];
        Some(match (first, self.followed.len()) {
            (Followed::DoubleReal(l), 1) => derivatives(search, place, l.into())[0].re,
            (Followed::Root(l), 1) => gradient(search, place, l)[usize::from(!along_gain)],
            (Followed::Root(l), 2) => l.re - self.followed[1].lambda().re,
            _ => return None,
        })
    }

    /// The number of roots that are followed, pairs and multiple roots counted in full.
    pub(super) fn roots(&self) -> u64 {
        let count = |f: &Followed| {
            let conjugates = if f.lambda().im == 0.0 { 1 } else { 2 };
            u64::from(conjugates * f.multiplicity())
        };
        self.followed.iter().map(count).sum()
    }

    /// How far rounding can move the abscissa.
    pub(super) fn blur(&self, search: &Search, place: Place) -> f64 {
        let blurs = self.followed.iter().map(|f| f.blur(search, place));
        blurs.fold(0.0, f64::max)
    }
}

/// D, D′, D″, D‴.
fn derivatives(search: &Search, place: Place, lambda: Complex64) -> [Complex64; 4] {
    let Place { gain, tau } = place;
    let groups = search.groups(gain);
    let jet = Jet::at(groups, tau, lambda);
    let third = (3.0 * groups.a_v - jet.feedback * tau) * jet.delayed * (tau * tau);
    [jet.value, jet.first, jet.second, third]
}

/// Derivatives of D and D′ with respect to the gain and the delay, at fixed λ.
struct ByParameters {
    gain: Complex64,
    tau: Complex64,
    slope_gain: Complex64,
    slope_tau: Complex64,
}

fn by_parameters(search: &Search, Place { gain, tau }: Place, lambda: Complex64) -> ByParameters {
    let groups = search.groups(gain);
    let jet = Jet::at(groups, tau, lambda);
    let memory = tau * jet.delayed;
    let tau_derivative = -jet.feedback * lambda * jet.delayed;
    let slope_tau =
        -jet.delayed * (groups.a_v * lambda + jet.feedback - jet.feedback * lambda * tau);
    let (gain, slope_gain) = match search.gain {
        SearchedGain::Velocity => {
            let size = groups.b + lambda;
            (-size * jet.difference, -jet.difference - size * memory)
        }
        SearchedGain::Load => (-jet.difference, -memory),
    };
    ByParameters {
        gain,
        tau: tau_derivative,
        slope_gain,
        slope_tau,
    }
}

/// The place next to `from` where D has a double real root, as it has at `from` with the root `mu`:
/// the gain moved by `step`.0 and the delay as it comes out, or the delay moved by `step`.1 where
/// the gain is to come out (`step`.0 is zero). None where the curve of such places does not reach
/// that far.
pub(super) fn along_double_roots(
    search: &Search,
    from: (Place, f64),
    step: (f64, f64),
) -> Option<Place> {
    let (mut place, mut mu) = from;
    let by_gain = step.0 != 0.0;
    let slopes = |place, mu: f64| {
        let by = by_parameters(search, place, mu.into());
        let [free, held] = [(by.tau.re, by.slope_tau.re), (by.gain.re, by.slope_gain.re)];
        if by_gain { (free, held) } else { (held, free) }
    };
    let move_free = |place: &mut Place, by: f64| {
        *(if by_gain {
            &mut place.tau
        } else {
            &mut place.gain
        }) += by;
    };
    let second = |place, mu: f64| derivatives(search, place, mu.into())[2].re;
    // Along the curve D and D′ keep vanishing.
    let ((free, free_slope), (held, held_slope)) = slopes(place, mu);
    let by = -(step.0 + step.1) * held / free;
    mu -= (held_slope * (step.0 + step.1) + free_slope * by) / second(place, mu);
    place.gain += step.0;
    place.tau += step.1;
    move_free(&mut place, by);
    for _ in 0..MOST_STEPS {
        let [value, first, second, _] = derivatives(search, place, mu.into()).map(|d| d.re);
        let ((free, free_slope), _) = slopes(place, mu);
        let determinant = first * free_slope - second * free;
        let by_mu = (value * free_slope - first * free) / determinant;
        let by = (first * first - second * value) / determinant;
        if !(by_mu.is_finite() && by.is_finite()) {
            return None;
        }
        mu -= by_mu;
        move_free(&mut place, -by);
        let value_of_free = if by_gain { place.tau } else { place.gain };
        if by_mu.abs() <= 1e-13 * (1.0 + mu.abs())
            && by.abs() <= 1e-13 * (1.0 + value_of_free.abs())
        {
            return Some(place);
        }
    }
    None
}

/// ∂Re λ/∂gain and ∂Re λ/∂τ at a simple root.
fn gradient(search: &Search, place: Place, lambda: Complex64) -> [f64; 2] {
    let by = Sensitivity::of(search.groups(place.gain), place.tau, lambda);
    let by_gain = match search.gain {
        SearchedGain::Velocity => by.a_v,
        SearchedGain::Load => by.a_n,
    };
    [by_gain.re, by.tau.re]
}

/// A zero of an analytic function near `start`, by Newton's method; `at` gives value and
/// derivative.
fn newton(start: Complex64, at: impl Fn(Complex64) -> (Complex64, Complex64)) -> Option<Complex64> {
    let mut lambda = start;
    for _ in 0..MOST_STEPS {
        let (value, slope) = at(lambda);
        let step = value / slope;
        if !step.is_finite() {
            return None;
        }
        lambda -= step;
        if norm(step) <= 4.0 * f64::EPSILON * norm(lambda) {
            return Some(lambda);
        }
    }
    // Rounding keeps the last steps from vanishing.
    let (value, slope) = at(lambda);
    (norm(value / slope) <= 1e-12 * norm(lambda)).then_some(lambda)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Groups;

    #[test]
    fn derivatives_match_difference_quotients() {
        for gain in [SearchedGain::Velocity, SearchedGain::Load] {
            let search = Search {
                fixed: Groups::new(-0.4, 0.3, -0.2),
                gain,
                gains: (-9.0, 9.0),
                delays: (0.0, 9.0),
            };
            let (place, lambda) = (
                Place {
                    gain: -0.7,
                    tau: 2.3,
                },
                Complex64::new(-0.2, 0.8),
            );
            let h = 1e-5;
            let d = |gain: f64, tau: f64, shift: f64| {
                let place = Place {
                    gain: place.gain + gain,
                    tau: place.tau + tau,
                };
                derivatives(&search, place, lambda + shift)
            };
            let quotient =
                |p: [Complex64; 4], q: [Complex64; 4]| [0, 1, 2].map(|i| (p[i] - q[i]) / (2.0 * h));
            let here = d(0.0, 0.0, 0.0);
            let by_lambda = quotient(d(0.0, 0.0, h), d(0.0, 0.0, -h));
            let by_gain = quotient(d(h, 0.0, 0.0), d(-h, 0.0, 0.0));
            let by_tau = quotient(d(0.0, h, 0.0), d(0.0, -h, 0.0));
            let by = by_parameters(&search, place, lambda);
            for (found, expected) in [
                (here[1], by_lambda[0]),
                (here[2], by_lambda[1]),
                (here[3], by_lambda[2]),
                (by.gain, by_gain[0]),
                (by.slope_gain, by_gain[1]),
                (by.tau, by_tau[0]),
                (by.slope_tau, by_tau[1]),
            ] {
                assert!((found - expected).norm() < 1e-8, "{found} {expected}");
            }
        }
    }
}
