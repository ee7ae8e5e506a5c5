//! Integrals and minima of functions of one variable that have kinks, jumps and ends like those of
//! a square root.

/// Nodes and weights of Gauss's rule with five points on (−1, 1); those below 0 are mirrored.
const GAUSS: [(f64, f64); 3] = [
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
];
/// Panels at the start: what is narrower than a fifteenth of one may be overlooked.
const PANELS: u32 = 512;
/// Halvings of a panel at most. A jump in the last one contributes 2⁻⁴⁰ of its panel.
const HALVINGS: u32 = 40;
/// A panel is halved until its halves change it by less than this share of the size of the whole.
const FINE: f64 = 1e-13;

/// An integral, and how far off it is at most: the sum of all changes by the last halvings, which
/// are far larger than what is left after them, and the rounding.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Integral {
    pub value: f64,
    pub error: f64,
}

/// The integral of `of`, whose values are of the order of `size`, over an interval.
pub(super) fn integral(of: impl Fn(f64) -> f64, (from, to): (f64, f64), size: f64) -> Integral {
    let step = (to - from) / f64::from(PANELS);
    let fine = FINE * size * (to - from);
    let (mut value, mut error) = (0.0, 0.0);
    for i in 0..PANELS {
        let panel = (from + step * f64::from(i), step);
        let (part, change) = halved(&of, panel, gauss(&of, panel), fine, HALVINGS);
        value += part;
        error += change;
    }
    error += f64::from(PANELS) * f64::EPSILON * value.abs();
    Integral { value, error }
}

/// The integral over a panel, its start and length, of which `whole` is a first value; and the
/// change by the last halvings.
fn halved(
    of: &impl Fn(f64) -> f64,
    (from, length): (f64, f64),
    whole: f64,
    fine: f64,
    left: u32,
) -> (f64, f64) {
    let half = 0.5 * length;
    let halves = [(from, half), (from + half, half)].map(|panel| (panel, gauss(of, panel)));
    let better = halves[0].1 + halves[1].1;
    let change = (better - whole).abs();
    if change <= fine || left == 0 {
        return (better, change);
    }
    let parts = halves.map(|(panel, part)| halved(of, panel, part, fine, left - 1));
    (parts[0].0 + parts[1].0, parts[0].1 + parts[1].1)
}

/// Gauss's rule on a panel.
fn gauss(of: &impl Fn(f64) -> f64, (from, length): (f64, f64)) -> f64 {
    let (middle, half) = (from + 0.5 * length, 0.5 * length);
    let terms = GAUSS.map(|(node, weight)| match node {
        0.0 => weight * of(middle),
        _ => weight * (of(middle - half * node) + of(middle + half * node)),
    });
    half * terms.iter().sum::<f64>()
}

/// The smallest value of `of` near a place, by steps of `step` that are halved until they are lost
/// in rounding. Where it has no value it is infinite.
pub(super) fn minimum(of: impl Fn(f64) -> f64, at: f64, step: f64) -> f64 {
    let lost = f64::EPSILON * at.abs().max(step);
    let (mut place, mut least, mut step) = (at, of(at), step);
    while step > lost {
        let beside = [place - step, place + step].map(|place| (place, of(place)));
        match beside.into_iter().find(|(_, value)| *value < least) {
            Some(lower) => (place, least) = lower,
            None => step *= 0.5,
        }
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Kinks, jumps and square roots at places that no panel knows; integrals by hand.
    #[test]
    fn integrals_hold_their_errors() {
        type Known = (fn(f64) -> f64, f64);
        let (kink, jump, root) = (0.3, 0.123_456_789_f64, 0.1 * std::f64::consts::E);
        let known: [Known; 4] = [
            (|x| x * x, 1.0 / 3.0),
            (|x| (x - 0.3).abs(), 0.5 * (kink * kink + 0.7 * 0.7)),
            (|x| f64::from(x > 0.123_456_789), 1.0 - jump),
            (
                |x| (x - 0.1 * std::f64::consts::E).max(0.0).sqrt(),
                2.0 / 3.0 * (1.0 - root).powf(1.5),
            ),
        ];
        for (i, (of, value)) in known.into_iter().enumerate() {
            let found = integral(of, (0.0, 1.0), 1.0);
            let off = (found.value - value).abs();
            assert!(off <= found.error && found.error < 1e-11, "{i}: {found:?}");
        }
    }

    /// A smooth minimum, a kink, and the lowest place at the end of what is defined.
    #[test]
    fn minima_are_found() {
        let near = |found: f64, known: f64| assert!((found - known).abs() < 1e-12, "{found}");
        near(minimum(|x| (x - 0.3).powi(2) + 1.0, 0.25, 0.1), 1.0);
        near(minimum(|x| (x + 2.0).abs() + 0.5, -1.9, 0.25), 0.5);
        let ends = |x: f64| if x > 0.7 { x } else { f64::INFINITY };
        near(minimum(ends, 0.75, 0.01), 0.7);
    }
}
