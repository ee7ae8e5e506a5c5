//! The zeros of largest size, and a certificate that none is larger.
//!
//! The k-th largest size is where the number of zeros outside a circle falls below k: halving finds
//! it. A zero on the circle of that size lies at an angle at which |U| = |V| there, or on the real
//! axis; Newton's method in λh = ln z does the rest.

use std::f64::consts::{PI, TAU};

use num_complex::Complex64;

use super::SampledLoop;
use super::circle::{Circle, slope, value};
use super::line::{SampledLine, multiple};
use super::outside::Weights;
use crate::linear::count::{Count, MarginalTolerance};
use crate::linear::general::{RightOf, Spectrum};
use crate::linear::line::{Line, Roots};
use crate::linear::newton::Root;
use crate::linear::spectrum::Incomplete;
use crate::model::elementary::{exp, expm1, norm, sincos};

/// Zeros smaller than e to this over the number of samples in the delay are not looked for: their
/// powers vanish.
const SMALLEST: f64 = -500.0;
/// The first ln |z| that is tried above 0, over the number of samples.
const ABOVE: f64 = 0.93;
/// The largest ln |z| of a zero that is looked for.
const LARGEST: f64 = 600.0;
/// Halvings of a range of ln r until it is as narrow as Newton's method needs.
const HALVINGS: u32 = 46;
/// Steps of Newton's method.
const MOST_STEPS: u32 = 30;
/// How far from the halved ln r a polished zero may lie, over the width of the first range.
const NEAR: f64 = 1e-7;
/// The margins that a certificate tries, relative, the least first.
const MARGINS: [f64; 5] = [1e-12, 1e-10, 1e-9, 1e-8, 1e-6];

/// The roots of a digital loop.
pub struct SampledRoots {
    of: SampledLoop,
}

/// ln z of a zero, with a bound on its error.
#[derive(Debug, Clone, Copy)]
struct Zero {
    log: Complex64,
    error: f64,
}

impl Zero {
    /// Whether it stands for itself alone, not for a pair.
    fn is_real(&self) -> bool {
        self.log.im == 0.0 || self.log.im == PI
    }
}

impl SampledLoop {
    /// The zeros of largest size at a delay of `multiple` sample times, pairs counted once, until
    /// `wanted` are known; and whether one may be missing.
    fn largest(&self, multiple: u64, wanted: usize) -> (Vec<Zero>, bool) {
        let mut found: Vec<Zero> = Vec::new();
        let samples = (multiple + self.late) as f64;
        let smallest = SMALLEST / samples;
        // Halving does not meet |z| = 1, on which a block without friction has its own pair.
        let (mut least, mut high) = (-1.0 / samples, ABOVE / samples);
        let enough = 2 * wanted as u64;
        let mut total = self.outside(least, multiple);
        while total < enough && least > smallest {
            least = (2.0 * least).max(smallest);
            total = self.outside(least, multiple);
        }
        while self.outside(high, multiple) > 0 && high < LARGEST {
            high *= 2.0;
        }
        let (width, mut known) = (high - least, 0);
        while found.len() < wanted && known < total {
            let (mut low, mut above) = (least, high);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + above);
                if self.outside(middle, multiple) > known {
                    low = middle;
                } else {
                    above = middle;
                }
            }
            let before = found.len();
            self.polish_on(0.5 * (low + above), NEAR * width, multiple, &mut found);
            let near = found[before..].iter();
            let new: u64 = near.map(|zero| if zero.is_real() { 1 } else { 2 }).sum();
            let spread = 1e-9 * width;
            let there = self.outside(low - spread, multiple);
            if new == 0 || known + new != there {
                return (found, false);
            }
            known += new;
            high = low;
        }
        (found, true)
    }

    /// The largest Re λ h of a root at a delay of `multiple` samples; none where it is not found.
    pub(crate) fn largest_growth(&self, multiple: u64) -> Option<f64> {
        let (found, _) = self.largest(multiple, 1);
        found.first().map(|zero| zero.log.re)
    }

    /// Adds the zeros whose ln |z| is `growth` to within `near`.
    fn polish_on(&self, growth: f64, near: f64, multiple: u64, found: &mut Vec<Zero>) {
        let before = found.len();
        let mut starts = vec![0.0, PI];
        let (circle, weights) = (Circle::new(growth), Weights::new(growth, multiple));
        // Where there are too many, those that were found are tried.
        let _ = self.each_junction(&circle, weights, |junction| starts.push(junction.angle));
        for angle in starts {
            let Some(zero) = self.polish(Complex64::new(growth, angle), multiple) else {
                continue;
            };
            let known = |other: &Zero| norm(other.log - zero.log) <= near;
            if (zero.log.re - growth).abs() <= near && !found.iter().any(known) {
                found.push(zero);
            }
        }
        found[before..].sort_by(|one, other| {
            let by_size = other.log.re.total_cmp(&one.log.re);
            by_size.then(one.log.im.total_cmp(&other.log.im))
        });
    }

    /// The zero to which Newton's method leads from `log`; a real one stays real.
    fn polish(&self, start: Complex64, multiple: u64) -> Option<Zero> {
        let mut log = start;
        let mut last = f64::INFINITY;
        for _ in 0..MOST_STEPS {
            let (value, slope, rounding) = self.at(log, multiple);
            let step = value / slope;
            let size = norm(step);
            if !size.is_finite() {
                return None;
            }
            let error = rounding / norm(slope) + f64::EPSILON * norm(log);
            if size <= error || (size >= last && size <= 1e-9 * norm(log).max(1e-300)) {
                return Some(Zero {
                    log: folded(log),
                    error: error.max(size),
                });
            }
            log -= step;
            last = size;
            if start.im == 0.0 || start.im == PI {
                log.im = start.im;
            }
        }
        None
    }

    /// (1) of the room at z = e^`log` and its derivative with respect to `log`, both over
    /// z^(m+l) where that is large, with a bound on the rounding of the first.
    fn at(&self, log: Complex64, multiple: u64) -> (Complex64, Complex64, f64) {
        let (m, l) = (multiple as f64, self.late as f64);
        let zeta = minus_one(log);
        let z = zeta + 1.0;
        let [p, q] = [self.step.open, self.step.held].map(|c| value(c, zeta));
        let [p_slope, q_slope] = [self.step.open, self.step.held].map(|c| z * slope(c, zeta));
        let less = if log.re > 0.0 { m + l } else { 0.0 };
        let [both, late, delay, none] = [m + l, l, m, 0.0].map(|exponent| {
            let size = exp((exponent - less) * log.re);
            let (sine, cosine) = sincos((exponent - less) * log.im);
            Complex64::new(size * cosine, size * sine)
        });
        let of_open = both - self.memory * late;
        let of_held = none - delay;
        let value = of_open * p + of_held * q;
        let slope = of_open * p_slope
            + of_held * q_slope
            + ((m + l - less) * both - self.memory * (l - less) * late) * p
            + (-less * none - (m - less) * delay) * q;
        let size = (norm(both) + norm(late)) * self.blur(0, zeta)
            + (norm(none) + norm(delay)) * self.blur(1, zeta);
        (
            value,
            slope,
            8.0 * f64::EPSILON * (1.0 + (m + l) * log.im.abs()) * size,
        )
    }

    /// The sum of the sizes of the terms of p or q.
    fn blur(&self, which: usize, zeta: Complex64) -> f64 {
        let [c0, c1, c2] = [self.step.open, self.step.held][which];
        let far = norm(zeta);
        c0.abs() + (c1.abs() + c2.abs() * far) * far
    }
}

/// The logarithm of the same zero, or of its conjugate, with an angle in [0, π].
fn folded(log: Complex64) -> Complex64 {
    let turns = (log.im / TAU).round();
    Complex64::new(log.re, (log.im - TAU * turns).abs())
}

/// e^`log` − 1, exact where `log` is small.
fn minus_one(log: Complex64) -> Complex64 {
    let (half_sine, half_cosine) = sincos(0.5 * log.im);
    let size = exp(log.re);
    Complex64::new(
        expm1(log.re) - 2.0 * size * half_sine * half_sine,
        2.0 * size * half_sine * half_cosine,
    )
}

impl SampledRoots {
    /// The roots of `of`.
    #[must_use]
    pub fn new(of: SampledLoop) -> Self {
        Self { of }
    }

    /// The rightmost roots at the delay `tau`, of which the unstable ones are counted already.
    #[must_use]
    pub fn counted(&self, tau: f64, wanted: usize, count: Option<Count>) -> Spectrum {
        let mut spectrum = Spectrum {
            count,
            roots: Vec::new(),
            abscissa: f64::NAN,
            essential_abscissa: f64::NEG_INFINITY,
            margin: f64::NAN,
            certified: false,
            reason: None,
            missing: None,
        };
        let Some(multiple) = self.samples(tau) else {
            return spectrum;
        };
        let h = self.of.sample_time;
        let (zeros, complete) = self.of.largest(multiple, wanted);
        spectrum.roots = zeros
            .iter()
            .map(|zero| Root {
                lambda: zero.log / h,
                error: zero.error / h,
            })
            .collect();
        spectrum.roots.truncate(wanted);
        if !complete {
            let line = spectrum
                .roots
                .last()
                .map_or(f64::NEG_INFINITY, |r| r.lambda.re);
            spectrum.missing = Some(Incomplete { line });
        }
        let Some(first) = spectrum.roots.first() else {
            return spectrum;
        };
        spectrum.abscissa = first.lambda.re;
        let unit = spectrum.abscissa.abs().max(1.0);
        let outside = |line: f64| self.of.outside(line * h, multiple);
        let clear = MARGINS.into_iter().find(|margin| {
            outside(spectrum.abscissa + margin * unit) == 0
                && outside(spectrum.abscissa - margin * unit) > 0
        });
        if let (Some(margin), Some(count)) = (clear, spectrum.count) {
            spectrum.margin = margin;
            let apart = spectrum.abscissa.abs() > margin * unit;
            let agrees = (count.n_unstable > 0) == (spectrum.abscissa > 0.0);
            spectrum.certified = agrees && apart && !count.marginal;
        }
        spectrum
    }

    fn samples(&self, tau: f64) -> Option<u64> {
        multiple(tau, self.of.sample_time)
    }
}

impl Roots for SampledRoots {
    fn line(&self, time_unit: f64) -> Box<dyn Line> {
        Box::new(self.of.line(time_unit))
    }

    fn count(&self, tau: f64, time_unit: f64) -> Option<Count> {
        let line: SampledLine = self.of.line(time_unit);
        line.count(tau, MarginalTolerance::default())
    }

    fn spectrum(&self, tau: f64, wanted: usize) -> Spectrum {
        self.counted(tau, wanted, self.count(tau, 1.0))
    }

    fn counted(&self, tau: f64, wanted: usize, count: Option<Count>) -> Spectrum {
        Self::counted(self, tau, wanted, count)
    }

    fn right_of(&self, tau: f64, line: f64) -> RightOf {
        match self.samples(tau) {
            Some(multiple) => match self.of.outside(line * self.of.sample_time, multiple) {
                u64::MAX => RightOf::Undecided,
                roots => RightOf::Roots(roots),
            },
            None => RightOf::Undecided,
        }
    }

    fn uncontrolled(&self) -> bool {
        self.of.groups.uncontrolled()
    }
}
