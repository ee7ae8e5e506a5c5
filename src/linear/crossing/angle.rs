//! Angles of points, two at a time.

use std::f64::consts::TAU;

use wide::f64x2;

/// The argument of `cosine` + i `sine` in [0, 2π].
///
/// A phase that is negative by less than rounding becomes 2π, which is right: there is no crossing
/// at τ = 0⁻, but there is one a turn later. Exact zero stays 0.
#[inline(always)]
pub(super) fn phase(sine: f64x2, cosine: f64x2) -> f64x2 {
    let angle = atan2(sine, cosine);
    angle + (f64x2::splat(TAU) & angle.simd_lt(f64x2::ZERO))
}

/// The angles of the points (x, y) in [−π, π], to a few units in the last place; 0 at the origin.
///
/// After Cephes and Agner Fog's vector class library, as in the crate wide. That one fuses products
/// and sums where the processor can; here the bits are the same on all processors.
#[inline(always)]
fn atan2(y: f64x2, x: f64x2) -> f64x2 {
    const MORE_BITS: f64 = 6.123_233_995_736_766e-17;
    let one = f64x2::ONE;
    let (ahead, aside) = (x.abs(), y.abs());
    let steep = aside.simd_gt(ahead);
    let t = steep.select(ahead, aside) / steep.select(aside, ahead);
    // From 0.66 to 1 the angle is π/4 and that of the rest.
    let near_diagonal = t.simd_ge(f64x2::splat(0.66));
    let rest = near_diagonal.select(t - one, t) / near_diagonal.select(one + t, one);
    let octant = near_diagonal & f64x2::FRAC_PI_4;
    let correction = near_diagonal & f64x2::splat(0.5 * MORE_BITS);
    let mut angle = arctangent(rest) + (octant + correction);
    angle = steep.select(f64x2::FRAC_PI_2 - angle, angle);
    angle = (x | y).simd_eq(f64x2::ZERO).select(f64x2::ZERO, angle);
    angle = x.is_sign_negative().select(f64x2::PI - angle, angle);
    y.is_sign_negative().select(-angle, angle)
}

/// The arctangent of |z| ≤ 0.66: a rational function of z².
#[inline(always)]
fn arctangent(z: f64x2) -> f64x2 {
    const P: [f64; 5] = [
        -6.485_021_904_942_025e1,
        -1.228_866_684_490_136_1e2,
        -7.500_855_792_314_705e1,
        -1.615_753_718_733_365e1,
        -8.750_608_600_031_904e-1,
    ];
    const Q: [f64; 5] = [
        1.945_506_571_482_614e2,
        4.853_903_996_359_137e2,
        4.328_810_604_912_903e2,
        1.650_270_098_316_988_5e2,
        2.485_846_490_142_306_3e1,
    ];
    let x = z * z;
    let (x2, [p, q]) = (x * x, [P, Q].map(|c| c.map(f64x2::splat)));
    let x4 = x2 * x2;
    let above = (p[3] * x + p[2]) * x2 + (p[1] * x + p[0]) + p[4] * x4;
    let below = x2 * (x * q[3] + q[2]) + (x4 * (q[4] + x) + (x * q[1] + q[0]));
    (above / below) * (z * x) + z
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_lanes_have_the_angle() {
        let sizes = [0.0, 1e-300, 1e-9, 0.3, 0.659, 0.661, 1.0, 1.5, 2.5, 1e9];
        let all: Vec<f64> = sizes.iter().flat_map(|&s| [s, -s]).collect();
        for &y in &all {
            for &x in &all {
                let [first, second] = atan2([y, x].into(), [x, y].into()).to_array();
                for (found, (y, x)) in [(first, (y, x)), (second, (x, y))] {
                    if (x, y) != (0.0, 0.0) {
                        let expected = f64::atan2(y, x);
                        let apart = (found - expected).abs();
                        assert!(apart <= 2.0 * f64::EPSILON * expected.abs(), "{y} {x}");
                    }
                }
            }
        }
        for i in 0..20_000 {
            let y = f64::from(i) * 1e-4;
            let found = atan2(f64x2::splat(y), f64x2::ONE).to_array();
            let apart = found.map(|angle| (angle - y.atan()).abs());
            assert!(apart[0] <= 2.0 * f64::EPSILON * y.atan(), "{y}");
            assert_eq!(found[0], found[1]);
        }
    }
}
