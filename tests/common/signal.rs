//! Numbers told from a motion that slides on, and from its errors.

use slipmap::slip::motion::Motion;

/// Slope of a straight line through `points`.
pub(crate) fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let mean = points
        .iter()
        .fold((0.0, 0.0), |m, p| (m.0 + p.0 / n, m.1 + p.1 / n));
    let sums = points.iter().fold((0.0, 0.0), |s, p| {
        let (x, y) = (p.0 - mean.0, p.1 - mean.1);
        (s.0 + x * y, s.1 + x * x)
    });
    sums.0 / sums.1
}

/// a(t) at multiples of `every` from `from` on, `count` of them.
pub(crate) fn samples(motion: &mut Motion, from: f64, every: f64, count: usize) -> Vec<f64> {
    let mut found = Vec::new();
    while found.len() < count {
        let start = motion.t;
        assert_eq!(motion.advance(f64::MAX), None, "slides on");
        while found.len() < count {
            let s = from + every * found.len() as f64 - start;
            if s > motion.last_step().length {
                break;
            }
            found.push(motion.last_step().state(s.max(0.0)).1);
        }
    }
    found
}

/// Re λ and |Im λ| of a signal that is one pair of exponentials: s₊ = p s − q s₋, by least squares.
pub(crate) fn exponent(signal: &[f64], every: f64) -> (f64, f64) {
    let (mut a11, mut a12, mut a22, mut b1, mut b2) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for s in signal.windows(3) {
        // Each equation counts alike, however far the signal has decayed.
        let weight = 1.0 / (s[0] * s[0] + s[1] * s[1]);
        a11 += weight * s[1] * s[1];
        a12 -= weight * s[1] * s[0];
        a22 += weight * s[0] * s[0];
        b1 += weight * s[1] * s[2];
        b2 -= weight * s[0] * s[2];
    }
    let det = a11 * a22 - a12 * a12;
    let (p, q) = ((b1 * a22 - b2 * a12) / det, (a11 * b2 - a12 * b1) / det);
    (
        q.ln() / (2.0 * every),
        (p / (2.0 * q.sqrt())).acos() / every,
    )
}
