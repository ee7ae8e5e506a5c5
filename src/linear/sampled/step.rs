//! What one sample time does to the block: from reading to reading, with v and N held.
//!
//! About sliding (u, a)˙ = A (u, a) + g S with A = [[−b, 1], [−1, 0]] and g = (−a_n, a_v), so
//!
//! ```text
//! (u, a)_{k+1} = Φ (u, a)_k + Γ S_k,   Φ = e^(Ah) = 1 + A E,   Γ = E g,   E = ∫₀ʰ e^(As) ds
//! ```
//!
//! Everything is written in ζ = z − 1 and in E, which keeps all digits where h is small:
//!
//! ```text
//! p = det(z − Φ) = ζ² − tr(A E) ζ + det E,   q = (a_n + a_v b) det E + Γ₂ ζ
//! ```

use crate::model::Groups;

/// A quadratic in ζ, the constant first.
pub(super) type Quadratic = [f64; 3];

/// The longest time, over the larger of 1 and |b|, for which E is summed as a series.
const LONGEST: f64 = 0.5;
/// Terms of that series: the last is below rounding.
const TERMS: usize = 18;

/// p and q of a loop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Step {
    pub open: Quadratic,
    pub held: Quadratic,
}

impl Step {
    /// The step of these groups over `sample_time`.
    pub(super) fn of(groups: Groups, sample_time: f64) -> Self {
        let Groups { b, a_v, a_n } = groups;
        let [e0, e1] = integral(b, sample_time);
        let determinant = e0 * e0 - b * e0 * e1 + e1 * e1;
        Self {
            open: [determinant, b * e0 - e1 * (b * b - 2.0), 1.0],
            held: [groups.feedback(b) * determinant, e1 * a_n + e0 * a_v, 0.0],
        }
    }
}

/// What a time since a reading makes of (u, a, S): the rows of u and of a.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rows {
    pub u: [f64; 3],
    pub a: [f64; 3],
}

impl Rows {
    /// The time `s` ≥ 0 after a reading, by Φ = 1 + A E and Γ = E g.
    pub(super) fn after(groups: Groups, s: f64) -> Self {
        let Groups { b, a_v, a_n } = groups;
        let [e0, e1] = integral(b, s);
        // A E = −e₁ + (e₀ − b e₁) A, and A (u, a) = (a − b u, −u).
        let (same, turned) = (1.0 - e1, e0 - b * e1);
        Self {
            u: [same - b * turned, turned, -e0 * a_n + e1 * (a_v + b * a_n)],
            a: [-turned, same, e0 * a_v + e1 * a_n],
        }
    }
}

/// t₁, t₂, g₁ and g₂ of a block of these groups, read once in `sample_time`: about sliding the
/// reading after the next one is
///
/// ```text
/// a_{k+1} = t₁ a_k + t₂ a_{k−1} + g₁ S_k + g₂ S_{k−1}
/// ```
///
/// for p = z² − t₁ z − t₂ and q = g₁ z + g₂.
pub(crate) fn recursion(groups: Groups, sample_time: f64) -> [f64; 4] {
    let Step { open, held } = Step::of(groups, sample_time);
    let ([p0, p1, _], [q0, q1, _]) = (open, held);
    [2.0 - p1, p1 - p0 - 1.0, q1, q0 - q1]
}

/// E = e₀ + e₁ A.
fn integral(b: f64, h: f64) -> [f64; 2] {
    let mut halvings = 0;
    let mut part = h;
    while part * b.abs().max(1.0) > LONGEST {
        part *= 0.5;
        halvings += 1;
    }
    let mut sum = series(b, part);
    for _ in 0..halvings {
        // E(2s) = 2 E + A E².
        let square = product(b, sum, sum);
        let [s0, s1] = [-square[1], square[0] - b * square[1]];
        sum = [2.0 * sum[0] + s0, 2.0 * sum[1] + s1];
    }
    sum
}

/// E over a short time: Σ Aᵏ hᵏ⁺¹/(k + 1)!, with A² = −b A − 1.
fn series(b: f64, h: f64) -> [f64; 2] {
    let (mut term, mut sum) = ([h, 0.0], [h, 0.0]);
    for k in 2..2 + TERMS {
        let next = [-term[1], term[0] - b * term[1]];
        term = next.map(|c| c * h / k as f64);
        sum = [sum[0] + term[0], sum[1] + term[1]];
    }
    sum
}

/// The product of two numbers c₀ + c₁ A.
fn product(b: f64, c: [f64; 2], d: [f64; 2]) -> [f64; 2] {
    let both = c[1] * d[1];
    [c[0] * d[0] - both, c[0] * d[1] + c[1] * d[0] - b * both]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::elementary::{cos, expm1, sin};

    /// Without friction e^(Ah) turns the state by h.
    #[test]
    fn a_block_without_friction_turns() {
        for h in [1e-9_f64, 0.01, 0.7, 3.0, 40.0] {
            let step = Step::of(Groups::new(0.0, 0.0, 0.0), h);
            let [p0, p1, _] = step.open;
            let sine = sin(0.5 * h);
            let expected = 4.0 * sine * sine;
            assert!((p0 - expected).abs() <= 1e-13 * expected, "{h}");
            assert!((p1 - expected).abs() <= 1e-13 * expected, "{h}");
        }
    }

    /// The rows are those of the exponential: their determinant, and u̇ = a − b u − a_n S at once.
    #[test]
    fn rows_follow_the_equations() {
        let groups = Groups::new(-0.7, 0.3, -1.9);
        let ds = 1e-5;
        for s in [0.0, 0.2, 1.7] {
            let [at, next] = [s, s + ds].map(|s| Rows::after(groups, s));
            let determinant = at.u[0] * at.a[1] - at.u[1] * at.a[0];
            assert!((determinant - 1.0 - expm1(0.7 * s)).abs() < 1e-13, "{s}");
            for column in 0..3 {
                let signal = f64::from(column == 2);
                let [u, a] = [0.5 * (at.u[column] + next.u[column]), at.a[column]];
                let a = 0.5 * (a + next.a[column]);
                let [du, da] = [at.u, at.a].map(|row| row[column]);
                let [du, da] = [(next.u[column] - du) / ds, (next.a[column] - da) / ds];
                let off = du - (a + 0.7 * u + 1.9 * signal);
                assert!(off.abs() < 1e-8, "{s} {column} {off}");
                let off = da - (0.3 * signal - u);
                assert!(off.abs() < 1e-8, "{s} {column} {off}");
            }
        }
    }

    /// Readings of a block that turns freely, with a load that is held, are those of a shifted
    /// circle: a = cos(t + θ) + g S.
    #[test]
    fn the_next_reading_follows_from_two() {
        let h = 0.9;
        let [t1, t2, g1, g2] = recursion(Groups::new(0.0, 0.0, 0.4), h);
        assert!((t1 - 2.0 * cos(h)).abs() < 1e-15 && (t2 + 1.0).abs() < 1e-15);
        // Under a steady load a rests at μ S.
        assert!(((g1 + g2) / (1.0 - t1 - t2) - 0.4).abs() < 1e-14);
        // From rest a reaches μ (1 − cos h).
        assert!((g1 - 0.4 * (1.0 - cos(h))).abs() < 1e-15);
    }

    /// The product of the zeros of p is det Φ = e^(−bh).
    #[test]
    fn the_area_shrinks_by_friction() {
        for (b, h) in [(-0.3_f64, 0.5_f64), (0.9, 2.0), (5.0, 1.0), (-1e-3, 1e-3)] {
            let [p0, p1, p2] = Step::of(Groups::new(b, 0.1, 0.2), h).open;
            let expected = expm1(-b * h);
            assert!((p0 - p1 + p2 - 1.0 - expected).abs() < 1e-14, "{b} {h}");
        }
    }
}
