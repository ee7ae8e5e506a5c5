//! Where eigenvalues of G on the imaginary axis have the modulus 1: the crossing frequencies with
//! their phases.

use std::f64::consts::TAU;

use num_complex::Complex64;

use super::dense::Matrix;
use super::singular::Square;
use super::{MatrixSystem, Slopes};
use crate::linear::collocation::{eigenvalues_of_complex, eigenvalues_of_real};
use crate::linear::newton::divide;
use crate::model::elementary::{arg, ln, norm, sincos};

/// How far from the imaginary axis an eigenvalue may lie, relative, to be tried as a frequency.
const NEAR_AXIS: f64 = 0.05;
/// A frequency below this part of the largest row is none.
const LEAST: f64 = 1e-14;
/// How far from 1 a modulus may be for its phase to be tried, in its logarithm.
const NEAR_CIRCLE: f64 = 1.0;
/// Steps of Newton's method.
const MOST_STEPS: u32 = 30;
/// How many of them may fail to halve the one before: where nothing crosses, none does for long.
const MOST_STALLS: u32 = 4;
/// Steps as small as this halve one another only, where several eigenvalues are equal.
const NEAR: f64 = 1e-6;
/// How far from other frequencies one is at which several eigenvalues may cross, relative.
const APART: f64 = 1e-5;
/// How far beside a frequency they are counted, relative.
const BESIDE: f64 = 1e-7;
/// How near two solutions are that are one, relative.
const SAME: f64 = 1e-9;
/// Halvings of a gap in which the number of large eigenvalues changes for no known reason.
const HALVINGS: u32 = 60;
/// How often such a gap is searched.
const MOST_SEARCHES: u32 = 64;

/// A frequency ω > 0 at which an eigenvalue of G(iω) is e^(iθ).
#[derive(Debug, Clone, Copy)]
pub(super) struct Junction {
    pub omega: f64,
    pub omega_error: f64,
    /// θ in (0, 2π].
    pub phase: f64,
    pub phase_error: f64,
    /// Where the eigenvalue goes with growing ω: 1 into the circle, with which pairs of roots cross
    /// to the right, −1 out of it, 0 where that is not known.
    pub sign: i8,
}

/// All junctions of an axis.
pub(super) struct OnAxis {
    /// By falling frequency.
    pub junctions: Vec<Junction>,
    /// Whether the number of eigenvalues outside the circle between them confirms that these are
    /// all.
    pub complete: bool,
}

impl MatrixSystem {
    /// All frequencies at which an eigenvalue of G has the modulus 1, but for those that are
    /// `left_out`, where the spectral radius of D is below 1. None where the eigenvalue iteration
    /// fails.
    pub(super) fn on_axis(&self, left_out: &dyn Fn(&Junction) -> bool) -> Option<OnAxis> {
        let least = LEAST * self.bound();
        let left_out = |of: &Junction| of.omega <= least || left_out(of);
        let mut found: Vec<Junction> = Vec::new();
        for lambda in self.frequencies()? {
            if lambda.re.abs() <= NEAR_AXIS * norm(lambda) && lambda.im > least {
                self.add_near(lambda, &left_out, &mut found);
            }
        }
        let mut complete = self.unexplained(least, &found);
        if complete.is_some() {
            self.repeat(&mut found);
            complete = self.unexplained(least, &found);
        }
        for _ in 0..MOST_SEARCHES {
            let Some(gap) = complete else {
                break;
            };
            let before = found.len();
            let place = self.place_of_change(gap, &found);
            self.add_near(Complex64::new(0.0, place), &left_out, &mut found);
            if found.len() == before {
                break;
            }
            complete = self.unexplained(least, &found);
        }
        found.sort_by(|one, other| other.omega.total_cmp(&one.omega));
        Some(OnAxis {
            junctions: found,
            complete: complete.is_none(),
        })
    }

    /// Repeats junctions at which several equal eigenvalues cross the circle.
    fn repeat(&self, found: &mut Vec<Junction>) {
        for place in 0..found.len() {
            let of = found[place];
            let beside = BESIDE.max(8.0 * of.omega_error / of.omega);
            let near = |other: &&Junction| (other.omega - of.omega).abs() <= APART * of.omega;
            if beside > 0.1 * APART || found.iter().filter(near).count() > 1 {
                continue;
            }
            let number = |side: f64| self.outside(of.omega * (1.0 + side));
            let (Some(low), Some(high)) = (number(-beside), number(beside)) else {
                continue;
            };
            let inwards = low as i64 - high as i64;
            if inwards.abs() > 1 {
                found[place].sign = inwards.signum() as i8;
                let again = found[place];
                found.extend((1..inwards.abs()).map(|_| again));
            }
        }
    }

    /// The eigenvalues with Im λ ≥ 0 of the closed loop of G(λ) ⊗ 1 and 1 ⊗ G(−λ).
    fn frequencies(&self) -> Option<Vec<Complex64>> {
        let (n, k) = (self.states(), self.signals());
        if n * k == 0 {
            return Some(Vec::new());
        }
        let [a_first, b_first, c_first, d_first] =
            [&self.a, &self.b, &self.c, &self.d].map(|of| of.beside_unit(k));
        let [a_other, b_other, c_other, d_other] =
            [&self.a, &self.b, &self.c, &self.d].map(|of| of.in_unit(k));
        // With the states x of 1 ⊗ G(−λ) and X of the other: u = W (C X − D (C x)) is what the loop
        // gives back, W = (1 − D ⊗ D)⁻¹.
        let w = inverse(&Matrix::unit(k * k).plus(&d_first.times(&d_other), -1.0))?;
        let from_first = w.times(&c_first);
        let from_other = w.times(&d_first).times(&c_other).mapped(|value| -value);
        // y = D u − C x is what it hands to G.
        let y_first = d_other.times(&from_first);
        let y_other = d_other.times(&from_other).plus(&c_other, -1.0);
        let half = n * k;
        let top = [
            b_other.times(&from_other).plus(&a_other, -1.0),
            b_other.times(&from_first),
        ];
        let bottom = [
            b_first.times(&y_other),
            b_first.times(&y_first).plus(&a_first, 1.0),
        ];
        eigenvalues_of_real(2 * half, |i, j| {
            let row = if i < half { &top } else { &bottom };
            row[j / half].at(i % half, j % half)
        })
    }

    /// The eigenvalues of G(iω).
    fn gains(&self, omega: f64) -> Option<Vec<Complex64>> {
        let (n, k) = (self.states(), self.signals());
        let resolvent = Square::of(n, |i, j| {
            let own = if i == j { omega } else { 0.0 };
            Complex64::new(-self.a.at(i, j), own)
        })
        .inverse()?;
        let g = |row: usize, column: usize| {
            let fed = resolvent.trace(|i, j| (self.b.at(i, column) * self.c.at(row, j)).into());
            fed + self.d.at(row, column)
        };
        eigenvalues_of_complex(k, g)
    }

    /// The number of eigenvalues of G(iω) outside the unit circle.
    pub(super) fn outside(&self, omega: f64) -> Option<usize> {
        let gains = self.gains(omega)?;
        Some(gains.iter().filter(|mu| mu.norm_sqr() > 1.0).count())
    }

    /// Adds the junctions to which Newton's method leads from the frequency of `start`, or a touch
    /// where the circle is met there within rounding.
    fn add_near(
        &self,
        start: Complex64,
        left_out: &dyn Fn(&Junction) -> bool,
        found: &mut Vec<Junction>,
    ) {
        let Some(gains) = self.gains(start.im) else {
            return;
        };
        let away = |mu: &Complex64| ln(norm(*mu)).abs();
        let nearest = gains.iter().map(away).fold(f64::INFINITY, f64::min);
        for mu in gains {
            let distance = away(&mu);
            if distance > NEAR_CIRCLE && distance > nearest {
                continue;
            }
            let new = self
                .sharpened(start.im, arg(mu))
                .or_else(|| self.touch(start.im, mu));
            let Some(new) = new.filter(|of| !left_out(of)) else {
                continue;
            };
            let known = |of: &Junction| {
                let apart = (of.omega - new.omega).abs();
                let turned = (of.phase - new.phase).abs();
                let near = SAME * new.omega + of.omega_error + new.omega_error;
                let turn = SAME + of.phase_error + new.phase_error;
                apart <= near && turned.min((TAU - turned).abs()) <= turn
            };
            if !found.iter().any(known) {
                found.push(new);
            }
        }
    }

    /// The junction at which Newton's method on det M(iω, e^(−iθ)) ends.
    fn sharpened(&self, omega: f64, phase: f64) -> Option<Junction> {
        let (mut omega, mut phase) = (omega, phase);
        let (mut last, mut stalls) = (f64::INFINITY, 0);
        for _ in 0..MOST_STEPS {
            let slopes = self.slopes_at(omega, phase)?;
            let [along_omega, along_phase] = slopes.real_parts();
            let determinant = along_omega.re * along_phase.im - along_omega.im * along_phase.re;
            // 1 + s_ω δω + s_θ δθ = 0.
            let step = [-along_phase.im, along_omega.im].map(|part| part / determinant);
            let size = step[0].abs() / omega + step[1].abs();
            if !size.is_finite() {
                return None;
            }
            let spread = |one: Complex64| norm(one) * slopes.rounding / determinant.abs();
            let errors = [spread(along_phase), spread(along_omega)];
            let settled = step[0].abs() <= errors[0] && step[1].abs() <= errors[1];
            if settled || (size >= 0.5 * last && size <= 1e-10) {
                // With λ(θ) the root of M, dλ/dθ = −s_θ/s_λ, and s_ω = i s_λ.
                let turn = divide(along_phase, along_omega);
                let inwards = turn.im;
                let sign = if inwards.abs() <= f64::EPSILON * norm(turn) {
                    0
                } else if inwards > 0.0 {
                    1
                } else {
                    -1
                };
                return Some(Junction {
                    omega: omega + step[0],
                    omega_error: errors[0].max(step[0].abs()) + f64::EPSILON * omega,
                    phase: turned(phase + step[1]),
                    phase_error: errors[1].max(step[1].abs()) + 2.0 * f64::EPSILON,
                    sign,
                });
            }
            // Far steps are shortened: a branch is followed, not left.
            let part = (0.5 / size).min(1.0);
            omega += part * step[0];
            phase += part * step[1];
            stalls += u32::from(size >= 0.5 * last && size > NEAR);
            last = size;
            if omega <= 0.0 || stalls > MOST_STALLS {
                return None;
            }
        }
        None
    }

    /// The touch at ω where the eigenvalue `mu` of G(iω) has the modulus 1 within rounding.
    fn touch(&self, omega: f64, mu: Complex64) -> Option<Junction> {
        let phase = arg(mu);
        let slopes = self.slopes_at(omega, phase)?;
        let error = 4.0 * slopes.rounding / norm(slopes.along_z);
        (ln(norm(mu)).abs() <= error).then(|| Junction {
            omega,
            omega_error: slopes.rounding / norm(slopes.along_lambda) + SAME * omega,
            phase: turned(phase),
            phase_error: error,
            sign: 0,
        })
    }

    fn slopes_at(&self, omega: f64, phase: f64) -> Option<Slopes> {
        let (sine, cosine) = sincos(phase);
        self.slopes(Complex64::new(0.0, omega), Complex64::new(cosine, -sine))
    }

    /// A gap between frequencies at whose ends the number of eigenvalues outside the circle does
    /// not differ by what is known to happen between; none where all of them are explained.
    fn unexplained(&self, least: f64, found: &[Junction]) -> Option<(f64, f64)> {
        let mut known: Vec<f64> = found.iter().map(|of| of.omega).collect();
        known.sort_by(f64::total_cmp);
        let highest = known.last().copied().unwrap_or(0.0).max(self.bound());
        let mut places = vec![least.max(1e-3 * known.first().copied().unwrap_or(highest))];
        let between = known
            .windows(2)
            .filter(|pair| pair[1] > pair[0] * (1.0 + 1e-12));
        places.extend(between.map(|pair| 0.5 * (pair[0] + pair[1])));
        places.push(4.0 * highest);
        places.windows(2).rev().find_map(|gap| {
            let explained = self.change(gap[0], gap[1], found) == Some(0);
            (!explained).then_some((gap[0], gap[1]))
        })
    }

    /// By how much the number of eigenvalues outside the circle differs between two frequencies
    /// from what is known.
    fn change(&self, from: f64, to: f64, found: &[Junction]) -> Option<i64> {
        let [low, high] = [self.outside(from)?, self.outside(to)?].map(|number| number as i64);
        let inside = |of: &&Junction| from < of.omega && of.omega <= to;
        let inwards: i64 = found
            .iter()
            .filter(inside)
            .map(|of| i64::from(of.sign))
            .sum();
        Some(low - high - inwards)
    }

    /// A place within a gap at which something unknown happens.
    fn place_of_change(&self, (mut from, mut to): (f64, f64), found: &[Junction]) -> f64 {
        for _ in 0..HALVINGS {
            let middle = if to > 4.0 * from {
                (from * to).sqrt()
            } else {
                0.5 * (from + to)
            };
            match self.change(middle, to, found) {
                Some(0) => to = middle,
                _ => from = middle,
            }
        }
        0.5 * (from + to)
    }

    /// A frequency of the order of the largest of the open loop.
    pub(in crate::linear) fn bound(&self) -> f64 {
        let n = self.states();
        let row = |i: usize| {
            let own: f64 = (0..n).map(|j| self.a.at(i, j).abs()).sum();
            let fed: f64 = (0..self.signals()).map(|k| self.b.at(i, k).abs()).sum();
            own + fed
        };
        (0..n).map(row).fold(f64::MIN_POSITIVE, f64::max)
    }
}

impl Slopes {
    /// The derivatives with respect to ω and θ at λ = iω, z = e^(−iθ).
    fn real_parts(&self) -> [Complex64; 2] {
        [
            Complex64::i() * self.along_lambda,
            -Complex64::i() * self.along_z,
        ]
    }
}

/// An angle as one in (0, 2π].
fn turned(angle: f64) -> f64 {
    let within = angle - TAU * (angle / TAU).floor();
    if within > 0.0 { within } else { TAU }
}

/// The inverse of a real matrix.
pub(super) fn inverse(of: &Matrix) -> Option<Matrix> {
    let n = of.rows();
    let inverse = Square::of(n, |i, j| of.at(i, j).into()).inverse()?;
    Some(Matrix::of(n, n, |i, j| inverse.at(i, j).re))
}
