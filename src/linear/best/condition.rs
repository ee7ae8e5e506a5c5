//! What holds at a setting of fastest decay, as two equations for p and q.
//!
//! The abscissa is the largest real part of a root, a maximum of functions that are smooth but
//! where roots meet. At its minimum either several roots share the real part, or a root is double
//! or triple, or the gradient vanishes along what is left free. With D the characteristic function,
//! a prime for d/dλ and indices for derivatives with respect to the two parameters of the plane:
//!
//! - a double pair: D(μ) = 0 where D′(μ) = 0, a complex equation
//! - a triple real root: D(ν) = D′(ν) = 0 where D″(ν) = 0
//! - a double real root at rest: D(μ) = 0, and D_p D′_q − D_q D′_p = 0, by which μ does not move
//!   along the curve D = D′ = 0
//! - roots with equal real parts; where there are only two, ∇Re λ₁ × ∇Re λ₂ = 0 as well
//! - one root at rest: ∇Re λ = 0

use num_complex::Complex64;

use super::search::{Family, Place, Search};
use crate::linear::equation::Equation;
use crate::linear::newton::polish;
use crate::model::elementary::{norm, pow};

/// Steps of Newton's method towards a zero of D′ or D″.
const MOST_STEPS: u32 = 30;
/// Roots nearer to one another than this, relative, are one and the same.
const ONE_PLACE: f64 = 1e-8;
/// What is nearer to a multiple root than this, relative, is part of it.
const PART_OF_MULTIPLE: f64 = 1e-3;
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
    fn moved<F: Family>(self, search: &Search<F>, place: Place) -> Option<Self> {
        let setting = search.family.setting(place)?;
        let at = |lambda| F::derivatives(&setting, search.family.delay(place), lambda);
        match self {
            Self::Root(start) => {
                let root = polish(F::equation(&setting), search.family.delay(place), start)?;
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
    fn blur<F: Family>(self, setting: &F::Setting, tau: f64) -> f64 {
        let lambda = self.lambda();
        let equation = F::equation(setting);
        let jet = equation.jet(tau, lambda);
        let m = self.multiplicity();
        let derivative = norm(F::derivatives(setting, tau, lambda)[m as usize]);
        let factorial = f64::from((1..=m).product::<u32>());
        let rounding = equation.rounding(&jet, tau, lambda);
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
    /// What is active at a place nearby; none where something is lost, or two of it became one.
    pub(super) fn moved(&self, search: &Search<impl Family>, place: Place) -> Option<Self> {
        let followed = self.followed.iter().map(|f| f.moved(search, place));
        let moved = Self {
            followed: followed.collect::<Option<_>>()?,
        };
        moved.apart().then_some(moved)
    }

    /// Whether what is followed lies in different places.
    fn apart(&self) -> bool {
        self.followed.iter().enumerate().all(|(i, of)| {
            let p = of.lambda();
            let near = |other: &Followed| {
                let simple = of.multiplicity().max(other.multiplicity()) == 1;
                let place = if simple { ONE_PLACE } else { PART_OF_MULTIPLE };
                norm(p - other.lambda()) <= place * (1.0 + norm(p))
            };
            !self.followed[i + 1..].iter().any(near)
        })
    }

    /// The real part that is minimal.
    pub(super) fn abscissa(&self) -> f64 {
        let real_parts = self.followed.iter().map(|f| f.lambda().re);
        real_parts.fold(f64::NEG_INFINITY, f64::max)
    }

    /// What vanishes at an optimum inside the box: two numbers.
    pub(super) fn inside<F: Family>(&self, search: &Search<F>, place: Place) -> Option<[f64; 2]> {
        let setting = search.family.setting(place)?;
        let derivatives = |l: Complex64| F::derivatives(&setting, search.family.delay(place), l);
        let gradient = |l| search.family.gradient(place, l);
        let gap = |i: usize| self.followed[i].lambda().re - self.followed[i + 1].lambda().re;
        let first = self.followed[0];
        Some(match (first, self.followed.len()) {
            (Followed::DoublePair(l), _) => {
                let value = derivatives(l)[0];
                [value.re, value.im]
            }
            (Followed::TripleReal(l), _) => {
                let [value, slope, ..] = derivatives(l.into());
                [value.re, slope.re]
            }
            (Followed::DoubleReal(l), 1) => {
                let value = derivatives(l.into())[0].re;
                let by = search.family.by_parameters(place, l.into())?;
                [value, (by.p * by.slope_q - by.q * by.slope_p).re]
            }
            (Followed::DoubleReal(l), _) => [derivatives(l.into())[0].re, gap(0)],
            (Followed::Root(l), 1) => gradient(l)?,
            (Followed::Root(_), 2) => {
                let [p, q] = [0, 1].map(|i| gradient(self.followed[i].lambda()));
                let (p, q) = (p?, q?);
                [gap(0), p[0] * q[1] - p[1] * q[0]]
            }
            (Followed::Root(_), 3) => [gap(0), gap(1)],
            _ => return None,
        })
    }

    /// What vanishes at an optimum on an edge of the box, where only p (`along_p`) or only q
    /// is free.
    pub(super) fn on_edge<F: Family>(
        &self,
        search: &Search<F>,
        place: Place,
        along_p: bool,
    ) -> Option<f64> {
        let setting = search.family.setting(place)?;
        let first = self.followed[0];
        Some(match (first, self.followed.len()) {
            (Followed::DoubleReal(l), 1) => {
                F::derivatives(&setting, search.family.delay(place), l.into())[0].re
            }
            (Followed::Root(l), 1) => search.family.gradient(place, l)?[usize::from(!along_p)],
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
    pub(super) fn blur<F: Family>(&self, setting: &F::Setting, tau: f64) -> f64 {
        let blurs = self.followed.iter().map(|f| f.blur::<F>(setting, tau));
        blurs.fold(0.0, f64::max)
    }
}

/// The place next to `from` where D has a double real root, as it has at `from` with the root `mu`:
/// p moved by `step`.0 and q as it comes out, or q moved by `step`.1 where p is to come out
/// (`step`.0 is zero). None where the curve of such places does not reach
/// that far.
pub(super) fn along_double_roots<F: Family>(
    search: &Search<F>,
    from: (Place, f64),
    step: (f64, f64),
) -> Option<Place> {
    let (mut place, mut mu) = from;
    let by_p = step.0 != 0.0;
    let slopes = |place, mu: f64| {
        let by = search.family.by_parameters(place, mu.into())?;
        let [free, held] = [(by.q.re, by.slope_q.re), (by.p.re, by.slope_p.re)];
        Some(if by_p { (free, held) } else { (held, free) })
    };
    let move_free = |place: &mut Place, by: f64| {
        *(if by_p { &mut place.q } else { &mut place.p }) += by;
    };
    let derivatives = |place: Place, mu: f64| {
        let setting = search.family.setting(place)?;
        Some(F::derivatives(&setting, search.family.delay(place), mu.into()).map(|d| d.re))
    };
    // Along the curve D and D′ keep vanishing.
    let ((free, free_slope), (held, held_slope)) = slopes(place, mu)?;
    let by = -(step.0 + step.1) * held / free;
    mu -= (held_slope * (step.0 + step.1) + free_slope * by) / derivatives(place, mu)?[2];
    place.p += step.0;
    place.q += step.1;
    move_free(&mut place, by);
    for _ in 0..MOST_STEPS {
        let [value, first, second, _] = derivatives(place, mu)?;
        let ((free, free_slope), _) = slopes(place, mu)?;
        let determinant = first * free_slope - second * free;
        let by_mu = (value * free_slope - first * free) / determinant;
        let by = (first * first - second * value) / determinant;
        if !(by_mu.is_finite() && by.is_finite()) {
            return None;
        }
        mu -= by_mu;
        move_free(&mut place, -by);
        let value_of_free = if by_p { place.q } else { place.p };
        if by_mu.abs() <= 1e-13 * (1.0 + mu.abs())
            && by.abs() <= 1e-13 * (1.0 + value_of_free.abs())
        {
            return Some(place);
        }
    }
    None
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
