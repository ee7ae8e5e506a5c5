//! Settings around a setting that are not stable: along directions, by the closed form of the
//! stable delays, and where Newton's method finds a root on the line.

use num_complex::Complex64;

use super::affine::Affine;
use super::equations::OnLine;
use super::surroundings::{ALL, ANY_SLOPE, Changes, Surroundings, changes, largest};
use crate::model::elementary::power;

/// The most steps of Newton's method: at a touch each halves the distance.
const MOST_STEPS: u32 = 48;
/// The most steps of Newton's method that may lead away from a zero.
const MOST_ASTRAY: u32 = 3;
/// Computing a frequency with many digits takes as long as enclosing D so many times.
const WORK_OF_DIGITS: u32 = 500;

impl<L: OnLine> Surroundings<'_, L> {
    /// A setting that is not stable near `here`, or near a `candidate` for a zero of D (ω and
    /// changes), where one may be nearer than `bound`.
    pub(super) fn not_stable_near(
        &self,
        here: Changes,
        candidate: Option<[f64; 4]>,
        bound: f64,
        work: &mut u32,
    ) -> Option<Changes> {
        if largest(here) >= bound {
            return None;
        }
        let lost = (self.case.setting.decay == 0.0).then(|| {
            *work += L::WORK_OF_CROSSINGS;
            self.delay_lost(here, work)
        });
        let nearer = |found: &Changes| largest(*found) < bound;
        let on_line = lost.flatten().filter(nearer).or_else(|| {
            // Where roots only touch the line, no count tells.
            let near = candidate.filter(|at| nearer(&changes(*at)));
            self.newton(near?, work)
        })?;
        // Just beyond it, where that is not stable; where roots only touch the line, there.
        let beyond = on_line.map(|d| d * (1.0 + 1e-9));
        Some(if self.stable(beyond) { on_line } else { beyond })
    }

    /// The given changes of gain and third parameter, with the least change of the delay at which
    /// sliding is not stable.
    fn delay_lost(&self, [gain, _, third]: Changes, work: &mut u32) -> Option<Changes> {
        let (groups, tau) = self.changed([gain, 0.0, third]);
        let (interval, resolved) = self.case.on_line.stable_interval_at(groups, tau);
        *work += WORK_OF_DIGITS * resolved;
        let extent = self.extents[1];
        let change = match interval {
            None => 0.0,
            Some(_) if tau == 0.0 || extent == 0.0 => return None,
            Some(found) => {
                let ends = [found.from, found.to];
                let [below, above] = ends.map(|end| (end / tau - 1.0) / extent);
                if -below < above && found.from > 0.0 {
                    below
                } else {
                    above
                }
            }
        };
        let found = [gain, change, third];
        match change {
            0.0 => Some(self.shortened(found)),
            _ => change.is_finite().then_some(found),
        }
    }

    /// The changes nearest to a place at which D vanishes: Newton's method by the shortest steps,
    /// which come nearer also where roots only touch the line.
    fn newton(&self, mut at: [f64; 4], work: &mut u32) -> Option<Changes> {
        let fixed = self.fixed();
        let (mut last, mut astray) = (f64::INFINITY, 0);
        for _ in 0..MOST_STEPS {
            *work += 1;
            // Over a narrow box the parts are the derivatives.
            let widths: [f64; 4] = std::array::from_fn(|i| match i {
                0 => 1e-7 * (1.0 + at[0]),
                i if fixed[i - 1] => 0.0,
                _ => 1e-7,
            });
            let around = |i: usize| (at[i] - widths[i], at[i] + widths[i]);
            let [omega, gain, delay, third] = [0, 1, 2, 3].map(around);
            let narrow = self.point([omega, gain, delay, third, ANY_SLOPE])?;
            let over = narrow.enclosed().value;
            let (value, omega) = (over.centre, at[0]);
            let size = value.norm_sqr();
            if size < 1e-26 * power(1.0 + omega * omega, 2) {
                return Some(changes(at));
            }
            astray += u32::from(size >= last);
            last = size;
            if astray > MOST_ASTRAY {
                return None;
            }
            let by: [Complex64; 4] = std::array::from_fn(|i| match widths[i] {
                0.0 => Affine::<ALL>::ZERO,
                width => over.part[i] / width,
            });
            // J Jᵀ y = −D, and the step is Jᵀ y; at a touch J has lost a rank.
            let sum = |f: &dyn Fn(Complex64) -> f64| by.iter().map(|z| f(*z)).sum::<f64>();
            let (rr, ii) = (sum(&|z| z.re * z.re), sum(&|z| z.im * z.im));
            let ri = sum(&|z| z.re * z.im);
            let least = 1e-14 * (rr + ii);
            let determinant = (rr + least) * (ii + least) - ri * ri;
            let y_re = (ri * value.im - (ii + least) * value.re) / determinant;
            let y_im = (ri * value.re - (rr + least) * value.im) / determinant;
            for (a, z) in at.iter_mut().zip(by) {
                *a += z.re * y_re + z.im * y_im;
            }
            if !(at[0] >= 0.0 && changes(at).iter().all(|d| d.abs() < 1.0)) {
                return None;
            }
        }
        None
    }

    /// The nearest setting found in some directions that is not stable, up to `limit`.
    pub(super) fn nearest_along_directions(&self, fixed: [bool; 3], limit: f64) -> Option<Changes> {
        let mut nearest: Option<Changes> = None;
        for number in 0..27 {
            let direction = [number / 9, number / 3 % 3, number % 3].map(|i| f64::from(i) - 1.0);
            let moves_fixed = (0..3).any(|i| fixed[i] && direction[i] != 0.0);
            if moves_fixed || number == 13 {
                continue;
            }
            let most = nearest.map_or(limit, largest);
            let along = |s: f64| direction.map(|d| s * d);
            let mut steps = (1..=L::STEPS).map(|i| most * f64::from(i) / f64::from(L::STEPS));
            if let Some(s) = steps.find(|s| !self.stable(along(*s))) {
                let found = self.shortened(along(s));
                if nearest.is_none_or(|n| largest(found) < largest(n)) {
                    nearest = Some(found);
                }
            }
        }
        nearest
    }

    /// A setting that is not stable, on the way from the centre to another.
    fn shortened(&self, unstable: Changes) -> Changes {
        let (mut stable, mut not) = (0.0, 1.0);
        for _ in 0..40 {
            let middle = 0.5 * (stable + not);
            if self.stable(unstable.map(|d| middle * d)) {
                stable = middle;
            } else {
                not = middle;
            }
        }
        unstable.map(|d| not * d)
    }
}
