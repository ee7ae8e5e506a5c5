//! Colours: perceptually ordered, and distinguishable by the colour-blind.

use super::gradient::ColourMap;
use crate::setting::Field;

/// A colour of the screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Rgb(pub u8, pub u8, pub u8);

impl Rgb {
    /// Its name in style sheets.
    pub(crate) fn hex(self) -> String {
        format!("#{:02x}{:02x}{:02x}", self.0, self.1, self.2)
    }
}

/// Text and frames.
pub(crate) const INK: Rgb = Rgb(0x22, 0x22, 0x22);
/// Less prominent text.
pub(crate) const SOFT_INK: Rgb = Rgb(0x5a, 0x5a, 0x5a);
/// Grid lines.
pub(crate) const GRID: Rgb = Rgb(0xe6, 0xe6, 0xe6);
/// Paper.
pub(crate) const PAPER: Rgb = Rgb(0xff, 0xff, 0xff);
/// Cells without a value, below the hatching.
pub(crate) const NO_VALUE: Rgb = Rgb(0xd9, 0xd9, 0xd9);
/// Cells outside the model's range, below the hatching.
pub(crate) const OUTSIDE_MODEL: Rgb = Rgb(0xbc, 0xbc, 0xbc);
/// Cells whose value is not known, below the hatching.
pub(crate) const UNKNOWN: Rgb = Rgb(0xf2, 0xf2, 0xf2);
/// The lines of the hatching.
pub(crate) const HATCH: Rgb = Rgb(0x5a, 0x5a, 0x5a);
/// Cells without a value because the block lifts off.
pub(crate) const LIFTS_OFF: Rgb = Rgb(0xc9, 0x94, 0xc7);
/// Cells without a value because stick-slip persists.
pub(crate) const PERSISTS: Rgb = Rgb(0xa0, 0x5e, 0x4a);
/// Values of 0, and values above and below a scale that does not include them.
pub(crate) const ZERO: Rgb = Rgb(0xbf, 0xe3, 0xff);
pub(crate) const ABOVE: Rgb = Rgb(0xe1, 0xfc, 0xc2);
pub(crate) const BELOW: Rgb = Rgb(0x00, 0x00, 0x00);
/// Infinite values on a scale of sizes.
pub(crate) const INFINITE: Rgb = Rgb(0xf5, 0x44, 0x00);
pub(crate) const MINUS_INFINITE: Rgb = Rgb(0x7f, 0x3b, 0x08);
/// Infinite values on a scale with two sides: (worse, better).
const ENDLESS: (Rgb, Rgb) = (Rgb(0x00, 0x00, 0x00), Rgb(0x20, 0x40, 0xff));
/// Stable cells.
pub(crate) const STABLE: Rgb = Rgb(0x5f, 0xb9, 0xae);
/// Stable areas below a line.
pub(crate) const STABLE_TINT: Rgb = Rgb(0xa0, 0xd5, 0xcf);
/// Areas where the block sticks, below a line.
pub(crate) const STUCK: Rgb = Rgb(0xe2, 0xd8, 0xc0);
/// The force of the spring on the block, and friction.
pub(crate) const PULLING_FORCE: Rgb = Rgb(0x00, 0x72, 0xb2);
pub(crate) const FRICTION_FORCE: Rgb = Rgb(0xd5, 0x5e, 0x00);
/// Cells with 2, 4, 6 and at least 8 unstable roots.
pub(crate) const UNSTABLE: [Rgb; 4] = [
    Rgb(0xf6, 0xe8, 0xc3),
    Rgb(0xdf, 0xc2, 0x7d),
    Rgb(0xbf, 0x81, 0x2d),
    Rgb(0x7a, 0x46, 0x08),
];
/// Cells with 1, 3, 5 and 7 unstable roots.
const ODD: [Rgb; 4] = [
    Rgb(0xd3, 0xc8, 0xf0),
    Rgb(0xa3, 0x8f, 0xd6),
    Rgb(0x75, 0x58, 0xb0),
    Rgb(0x40, 0x28, 0x6e),
];
/// The largest class of numbers of unstable roots. Larger numbers share its colour.
pub(crate) const LAST_COUNT: usize = 2 * UNSTABLE.len();

/// Outcomes: slides, sticks and slips, oscillates, lifts off, diverges, undecided, none. Then the
/// ends of stick-slip: grazing, fold, period doubling, irregular, persists, never, lost. The
/// colour-blind can tell all of them apart.
const OUTCOMES: [Rgb; 14] = [
    STABLE,
    Rgb(0xdf, 0xc2, 0x7d),
    Rgb(0x9e, 0x5a, 0x12),
    Rgb(0x2c, 0x4a, 0x7c),
    Rgb(0x22, 0x22, 0x22),
    Rgb(0xb9, 0xb9, 0xb9),
    Rgb(0xe8, 0xe8, 0xe8),
    Rgb(0x00, 0x99, 0x99),
    Rgb(0xdd, 0x99, 0x00),
    Rgb(0xbb, 0x77, 0x55),
    Rgb(0x99, 0x00, 0x00),
    Rgb(0x74, 0x2b, 0xd0),
    Rgb(0x25, 0x76, 0x92),
    Rgb(0xbb, 0x77, 0xdd),
];

/// Working velocities: stable, bistable, unstable, beyond a lift-off, undecided.
const REGIMES: [Rgb; 5] = [
    STABLE,
    Rgb(0xc2, 0xe3, 0xf2),
    Rgb(0xdf, 0xc2, 0x7d),
    Rgb(0x2c, 0x4a, 0x7c),
    NO_VALUE,
];

/// No reason, a root at the origin, one on the axis, infinitely many unstable roots, the neutral
/// limit, no rightmost root, degree unknown, refused.
const REASONS: [Rgb; 8] = [
    Rgb(0xc7, 0xea, 0xe5),
    Rgb(0xdf, 0xc2, 0x7d),
    Rgb(0x7a, 0x46, 0x08),
    Rgb(0x22, 0x22, 0x22),
    Rgb(0x2c, 0x4a, 0x7c),
    Rgb(0x35, 0x97, 0x8f),
    Rgb(0x9e, 0x9a, 0xc8),
    Rgb(0xbb, 0x77, 0x55),
];

/// The critical velocity from one slip, from the orbit, from simulation; small counts from 0 on.
const FEW: [Rgb; 4] = [
    Rgb(0xc7, 0xea, 0xe5),
    Rgb(0x35, 0x97, 0x8f),
    Rgb(0xdf, 0xc2, 0x7d),
    Rgb(0x7a, 0x46, 0x08),
];

/// Steps of [`two_sided`] on each side of zero: too fine to be distinguished, coarse enough for
/// cells to merge.
pub(crate) const STEPS: f64 = 32.0;

/// The weakest colour of [`two_sided`] on either side of zero, as a share of the strongest.
const TINT: f64 = 0.2;
/// Steps of [`of_size`], for the same reasons.
pub(crate) const SIZE_STEPS: f64 = 64.0;

/// The part of viridis used for lines: the rest is too light on white.
const LINES: f64 = 0.8;

/// The colour of line `i` of `n`, from dark to light.
pub(crate) fn of_line(i: usize, n: usize) -> Rgb {
    let part = if n > 1 {
        i as f64 / (n - 1) as f64
    } else {
        0.3
    };
    ColourMap::Viridis.at(LINES * part)
}

/// The class of a number of unstable roots: the number itself, up to [`LAST_COUNT`].
pub(crate) fn class_of_count(n: f64) -> usize {
    (n as usize).min(LAST_COUNT)
}

/// The colour of a number of unstable roots, one for each class.
pub(crate) fn of_count(n: f64) -> Rgb {
    if n.is_nan() {
        return NO_VALUE;
    }
    match class_of_count(n) {
        0 => STABLE,
        class if class.is_multiple_of(2) => UNSTABLE[class / 2 - 1],
        class => ODD[class / 2],
    }
}

/// The colour of the kind of `field` with this number, or of a small count.
pub(crate) fn of_kind(field: Field, number: f64) -> Rgb {
    let colours: &[Rgb] = match field {
        Field::Outcome => &OUTCOMES,
        Field::Regime => &REGIMES,
        Field::Reason => &REASONS,
        _ => &FEW,
    };
    match number {
        n if n.is_nan() => NO_VALUE,
        n => colours[(n as usize).min(colours.len() - 1)],
    }
}

/// The largest small count with a colour of its own.
pub(crate) fn last_of_few() -> usize {
    FEW.len() - 1
}

/// The colour of a value on a scale with two sides: the worse colour below zero, the better one
/// above, at full strength at ±`range`.
///
/// The strength grows with the square root, and both sides begin with a tint. Cells that are just
/// stable are the most common ones, and must not look like unstable cells.
pub(crate) fn two_sided(map: ColourMap, value: f64, range: f64) -> Rgb {
    let part = (value / range).clamp(-1.0, 1.0);
    if part.is_nan() {
        return NO_VALUE;
    }
    if part == 0.0 {
        return map.on_side(0.0);
    }
    let step = (part.abs().sqrt() * STEPS).ceil() / STEPS;
    let strength = TINT + (1.0 - TINT) * step;
    map.on_side(strength.copysign(part))
}

/// The colour of a value beyond the ends of a scale with two sides, or of an infinite one.
pub(crate) fn beyond(map: ColourMap, value: f64) -> Rgb {
    let (worse, better) = match value.is_infinite() {
        true => ENDLESS,
        false => map.beyond(),
    };
    if value < 0.0 { worse } else { better }
}

/// The colour of a size at `part` of the way from small to large: from dark to light.
pub(crate) fn of_size(map: ColourMap, part: f64) -> Rgb {
    map.at((part * SIZE_STEPS).round() / SIZE_STEPS)
}

/// `colour` mixed with paper; 0 gives paper.
pub(crate) fn pale(colour: Rgb, part: f64) -> Rgb {
    mix(PAPER, colour, part)
}

/// `colour` for letters, which need more contrast than lines.
pub(crate) fn darker(colour: Rgb) -> Rgb {
    mix(colour, INK, 0.35)
}

fn mix(a: Rgb, b: Rgb, part: f64) -> Rgb {
    let channel = |a: u8, b: u8| (f64::from(a) + (f64::from(b) - f64::from(a)) * part).round();
    Rgb(
        channel(a.0, b.0) as u8,
        channel(a.1, b.1) as u8,
        channel(a.2, b.2) as u8,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lightness(c: Rgb) -> f64 {
        0.2126 * f64::from(c.0) + 0.7152 * f64::from(c.1) + 0.0722 * f64::from(c.2)
    }

    #[test]
    fn lines_grow_lighter_and_stay_readable() {
        let colours: Vec<Rgb> = (0..12).map(|i| of_line(i, 12)).collect();
        assert!(
            colours
                .windows(2)
                .all(|w| lightness(w[0]) < lightness(w[1]))
        );
        assert!(lightness(colours[11]) < 200.0);
    }

    #[test]
    fn counts_grow_darker_and_stable_differs() {
        for counts in [[2.0, 4.0, 6.0, 8.0], [1.0, 3.0, 5.0, 7.0]] {
            let colours = counts.map(of_count);
            let darker = |w: &[Rgb]| lightness(w[0]) > lightness(w[1]);
            assert!(colours.windows(2).all(darker), "{counts:?}");
        }
        assert_eq!(of_count(120.0), of_count(8.0));
        assert_eq!(of_count(0.0), STABLE);
        assert_eq!(of_count(f64::NAN), NO_VALUE);
    }

    #[test]
    fn margins_tell_their_sign() {
        let map = ColourMap::BrBG;
        let [brown, zero, teal] = [-1e-9, 0.0, 1e-9].map(|m| two_sided(map, m, 1.0));
        assert!(brown.0 > brown.2 && teal.2 > teal.0);
        assert!(lightness(zero) > lightness(brown).max(lightness(teal)));
        let ends = [-1.0, 1.0].map(|v| two_sided(map, v, 1.0));
        let beyond = [f64::NEG_INFINITY, -5.0, 5.0, f64::INFINITY].map(|v| beyond(map, v));
        let mut colours = [&ends[..], &beyond].concat();
        colours.sort_unstable();
        colours.dedup();
        assert_eq!(colours.len(), 6);
    }
}
