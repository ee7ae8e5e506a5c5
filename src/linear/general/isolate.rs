//! The positive zeros of a real polynomial that are simple and well apart, without its others.
//!
//! The variations of sign of the Bernstein coefficients on an interval are the number of zeros in
//! it, or more by an even number: 0 and 1 are exact (Descartes' rule, Vincent's theorem). Intervals
//! that have more are halved by de Casteljau's averages. Every coefficient carries a bound on its
//! error, and where a sign is in doubt nothing is said: [`Zeros`](super::zeros::Zeros) then take
//! apart what can be. The interval to begin with ends at a bound on the positive zeros (Akritas,
//! Strzeboński and Vigklas 2008) in powers of two.
//!
//! An isolated zero is polished by Halley's method within its interval. What is told of it is
//! proved by the signs on both sides.

use super::polynomial::Polynomial;

/// The highest degree of a polynomial whose zeros are isolated.
pub(super) const MOST: usize = 8;
/// The most halvings of an interval.
const DEEPEST: u32 = 40;
/// The most intervals that are looked at.
const MOST_INTERVALS: u32 = 120;
/// The most steps of Halley's method, with halvings between.
const MOST_STEPS: u32 = 60;
/// Steps below this part of t are the last.
const LAST_STEP: f64 = 1e-5;
/// The end of the interval is such a number times a power of two, so that no zero of a setting in
/// round numbers falls on the middle of an interval.
const UNEVEN: f64 = 1.09375;

/// 1/d at the index d.
const INVERSE: [f64; MOST + 1] = {
    let mut all = [0.0; MOST + 1];
    let mut d = 1;
    while d <= MOST {
        all[d] = 1.0 / d as f64;
        d += 1;
    }
    all
};

/// A zero, and how far from there it may be.
#[derive(Debug, Clone, Copy)]
pub(super) struct Enclosed {
    pub centre: f64,
    pub radius: f64,
}

/// Zeros by falling size.
#[derive(Debug, Clone, Copy)]
pub(super) struct PositiveZeros {
    all: [Enclosed; MOST],
    count: usize,
}

impl PositiveZeros {
    /// The positive zeros of `f`, whose highest coefficient and constant are certain to differ from
    /// 0; none where some zeros are too near to one another, or to the real axis, for rounding to
    /// tell.
    #[inline]
    pub(super) fn of(f: &Polynomial) -> Option<Self> {
        let mut zeros = Self {
            all: [Enclosed {
                centre: 0.0,
                radius: 0.0,
            }; MOST],
            count: 0,
        };
        let found = match f.degree() {
            0 => true,
            1 => zeros.find::<2>(f),
            2 => zeros.find::<3>(f),
            3 => zeros.find::<4>(f),
            4 => zeros.find::<5>(f),
            5 => zeros.find::<6>(f),
            6 => zeros.find::<7>(f),
            7 => zeros.find::<8>(f),
            8 => zeros.find::<9>(f),
            _ => false,
        };
        found.then_some(zeros)
    }

    /// The zeros by falling size.
    #[inline]
    pub(super) fn all(&self) -> &[Enclosed] {
        &self.all[..self.count]
    }

    #[inline]
    fn find<const L: usize>(&mut self, f: &Polynomial) -> bool {
        let sign = if f.leading().value < 0.0 { -1.0 } else { 1.0 };
        let (mut c, mut e) = ([0.0; L], [0.0; L]);
        for k in 0..L {
            c[k] = sign * f.coefficients()[k];
            e[k] = f.errors()[k];
        }
        let Some(end) = upper_bound(&c, &e) else {
            return false;
        };
        if end == 0.0 {
            return true;
        }
        // Rounding of the scales, of Horner's scheme and of the sums below.
        let unit = (4.0 * L as f64 + 4.0) * f64::EPSILON;
        let mut power = 1.0;
        for k in 0..L {
            c[k] *= power;
            e[k] = e[k] * power + unit * c[k].abs();
            power *= end;
        }
        if !(c[L - 1].is_finite() && power.is_finite()) {
            return false;
        }
        let (mut b, mut errors) = ([0.0; L], [0.0; L]);
        for k in 0..L {
            b[k] = c[k] * Binomials::<L>::INVERSE[k];
            errors[k] = e[k] * Binomials::<L>::INVERSE[k];
        }
        for j in 1..L {
            for i in (j..L).rev() {
                b[i] += b[i - 1];
                errors[i] += errors[i - 1];
            }
        }
        let mut search = Search {
            c,
            e,
            end,
            intervals: 0,
            zeros: self,
        };
        search.look(&b, &errors, (0.0, 1.0), DEEPEST)
    }
}

/// 1 over the binomial coefficients of degree L − 1.
struct Binomials<const L: usize>;

impl<const L: usize> Binomials<L> {
    const INVERSE: [f64; L] = {
        let mut all = [1.0; L];
        let (mut binomial, mut k) = (1.0, 0);
        while k < L {
            all[k] = 1.0 / binomial;
            binomial = binomial * (L - 1 - k) as f64 / (k + 1) as f64;
            k += 1;
        }
        all
    };
}

/// The largest whole number that is no more than log₂ of `x` > 0; none where `x` is extreme.
#[inline(always)]
fn exponent(x: f64) -> Option<i64> {
    let exponent = ((x.to_bits() >> 52) & 0x7ff) as i64 - 1023;
    (exponent.abs() < 900).then_some(exponent)
}

/// A bound on the positive zeros of the polynomial whose highest coefficient is positive: 0 where
/// it has none, none where the coefficients are extreme.
#[inline(always)]
fn upper_bound<const L: usize>(c: &[f64; L], e: &[f64; L]) -> Option<f64> {
    let mut used = [1_i64; L];
    let mut highest = f64::NEG_INFINITY;
    for k in (0..L - 1).rev() {
        let negative = e[k] - c[k];
        if negative <= 0.0 {
            continue;
        }
        let above = exponent(negative)? + 1;
        let (mut least, mut at) = (f64::INFINITY, L - 1);
        for j in k + 1..L {
            let positive = c[j] - e[j];
            if positive > 0.0 {
                let power = above - exponent(positive)? + used[j];
                let root = power as f64 * INVERSE[j - k];
                if root < least {
                    (least, at) = (root, j);
                }
            }
        }
        used[at] += 1;
        if least > highest {
            highest = least;
        }
    }
    if highest == f64::NEG_INFINITY {
        return Some(0.0);
    }
    let below = highest as i64;
    let power = below + i64::from((below as f64) < highest);
    if power.abs() * (L as i64) >= 900 {
        return None;
    }
    Some(UNEVEN * f64::from_bits(((1023 + power) as u64) << 52))
}

/// What does not change from interval to interval.
struct Search<'z, const L: usize> {
    /// The polynomial in t = x/`end`, and the errors of its terms with their rounding.
    c: [f64; L],
    e: [f64; L],
    end: f64,
    intervals: u32,
    zeros: &'z mut PositiveZeros,
}

impl<const L: usize> Search<'_, L> {
    /// Finds the zeros within `from` < t < `from` + `width`, where `b` are the Bernstein
    /// coefficients with their `errors`. False where they are in doubt.
    fn look(
        &mut self,
        b: &[f64; L],
        errors: &[f64; L],
        (from, width): (f64, f64),
        left: u32,
    ) -> bool {
        self.intervals += 1;
        let n = L - 1;
        let decided = |i: usize| b[i].abs() > errors[i];
        if !(decided(0) && decided(n)) || self.intervals > MOST_INTERVALS {
            return false;
        }
        let (mut variations, mut place, mut open) = (0, 0, false);
        let mut positive = b[0] > 0.0;
        for (i, &coefficient) in b.iter().enumerate().skip(1) {
            open |= !decided(i);
            if (coefficient > 0.0) != positive {
                positive = !positive;
                variations += 1;
                place = i;
            }
        }
        if !open && variations == 0 {
            return true;
        }
        if !open && variations == 1 {
            // Where the polygon of the coefficients crosses 0.
            let part = b[place - 1] / (b[place - 1] - b[place]);
            let start = from + width * ((place - 1) as f64 + part) / n as f64;
            return self.polish((from, from + width), start, positive);
        }
        if left == 0 {
            return false;
        }
        let (mut right, mut right_errors) = (*b, *errors);
        let (mut below, mut below_errors) = (*b, *errors);
        for j in 1..L {
            for i in 0..L - j {
                right[i] = 0.5 * (right[i] + right[i + 1]);
                right_errors[i] =
                    0.5 * (right_errors[i] + right_errors[i + 1]) + f64::EPSILON * right[i].abs();
            }
            below[j] = right[0];
            below_errors[j] = right_errors[0];
        }
        let half = 0.5 * width;
        self.look(&right, &right_errors, (from + half, half), left - 1)
            && self.look(&below, &below_errors, (from, half), left - 1)
    }

    /// F at `t`.
    #[inline(always)]
    fn value(&self, t: f64) -> f64 {
        let mut sum = self.c[L - 1];
        for k in (0..L - 1).rev() {
            sum = sum * t + self.c[k];
        }
        sum
    }

    /// F, F′ and F″/2 at `t`.
    #[inline(always)]
    fn jet(&self, t: f64) -> (f64, f64, f64) {
        let (mut value, mut slope, mut bend) = (0.0, 0.0, 0.0);
        for k in (0..L).rev() {
            bend = bend * t + slope;
            slope = slope * t + value;
            value = value * t + self.c[k];
        }
        (value, slope, bend)
    }

    /// A bound on the error of F at `t` and a little beyond.
    #[inline(always)]
    fn error(&self, t: f64) -> f64 {
        let mut sum = self.e[L - 1];
        for k in (0..L - 1).rev() {
            sum = sum * t + self.e[k];
        }
        1.01 * sum
    }

    /// Polishes the one zero within `low` < t < `high`, from `start`; `rising` where F is positive
    /// beyond.
    #[inline]
    fn polish(&mut self, (mut low, mut high): (f64, f64), start: f64, rising: bool) -> bool {
        let mut t = start;
        let mut wider = 1.0;
        for _ in 0..MOST_STEPS {
            let (value, slope, bend) = self.jet(t);
            if (value > 0.0) == rising {
                high = t;
            } else {
                low = t;
            }
            let step = value * slope / (slope * slope - value * bend);
            let mut next = t - step;
            let inside = next > low && next < high;
            if value == 0.0 {
                next = t;
            } else if !inside {
                next = 0.5 * (low + high);
            }
            if (next - t).abs() <= LAST_STEP * t {
                let radius =
                    wider * (2.0 * self.error(next) / slope.abs() + 4.0 * f64::EPSILON * next);
                if self.holds(next, radius, rising) {
                    return self.add(next, radius);
                }
                wider *= 4.0;
            }
            t = next;
        }
        false
    }

    /// Whether the signs of F on both sides prove that the zero is within `radius` of `t`.
    #[inline(always)]
    fn holds(&self, t: f64, radius: f64, rising: bool) -> bool {
        let (below, above) = (self.value(t - radius), self.value(t + radius));
        let error = self.error(t);
        let (below, above) = if rising {
            (-below, above)
        } else {
            (below, -above)
        };
        radius < 1e-4 * t && below > error && above > error
    }

    #[inline(always)]
    fn add(&mut self, t: f64, radius: f64) -> bool {
        let zeros = &mut *self.zeros;
        if zeros.count == MOST {
            return false;
        }
        zeros.all[zeros.count] = Enclosed {
            centre: t * self.end,
            radius: (radius + 2.0 * f64::EPSILON * t) * self.end,
        };
        zeros.count += 1;
        true
    }
}
