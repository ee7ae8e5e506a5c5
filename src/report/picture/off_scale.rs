//! Values along a line that have no place on its scale: values beyond its ends, infinite ones and,
//! on a logarithmic scale, zeros. They are drawn as bars at the edge of the panel.

use super::legend::Swatch;
use super::panels::Panel;
use super::scene::Scene;
use super::text::{Rich, number};
use crate::meaning::colour::Rgb;
use crate::meaning::gap::Gap;
use crate::meaning::paint::at_zero;
use crate::meaning::scale::Scale;
use crate::setting::Field;

/// Height of a bar, in units of the picture.
const HEIGHT: f64 = 8.0;

/// The value of a bar.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Off {
    Infinite,
    Above,
    MinusInfinite,
    Zero,
    Below,
}

impl Off {
    const ALL: [Self; 5] = [
        Self::Infinite,
        Self::Above,
        Self::MinusInfinite,
        Self::Zero,
        Self::Below,
    ];

    /// The kind of a value off the scale; none for a value on it.
    fn of(value: f64, panel: &Panel) -> Option<Self> {
        match value {
            f64::INFINITY => Some(Self::Infinite),
            f64::NEG_INFINITY => Some(Self::MinusInfinite),
            0.0 if panel.y.is_logarithmic() => Some(Self::Zero),
            v if v.is_nan() || panel.y.holds(v) => None,
            v if v > panel.y.value(1.0) => Some(Self::Above),
            _ => Some(Self::Below),
        }
    }

    const fn is_upper(self) -> bool {
        matches!(self, Self::Infinite | Self::Above)
    }

    fn words(self, field: Field, scale: &Scale) -> Rich {
        let shown = match self {
            Self::Infinite => number(f64::INFINITY),
            Self::MinusInfinite => number(f64::NEG_INFINITY),
            Self::Zero => number(0.0),
            Self::Above => format!("above {}", number(scale.value(1.0))),
            Self::Below => format!("below {}", number(scale.value(0.0))),
        };
        let unstable = |value: f64| field.tells_stable(value) == Some(false);
        let meaning = match self {
            Self::Zero => at_zero(field),
            Self::Infinite if unstable(f64::INFINITY) => ", unstable",
            Self::MinusInfinite if unstable(f64::NEG_INFINITY) => ", unstable",
            _ => "",
        };
        let edge = if self.is_upper() { "upper" } else { "lower" };
        Rich::default().and_formula(&format!("{shown} at the {edge} edge{meaning}"))
    }
}

/// Values along a line.
pub(super) struct Along<'a> {
    pub field: Field,
    pub values: &'a [f64],
    pub gaps: &'a [Option<Gap>],
    /// The edges of its cells, one more than there are cells.
    pub edges: &'a [f64],
    pub colour: Rgb,
}

impl Along<'_> {
    fn cells(&self, panel: &Panel, off: Off) -> impl Iterator<Item = usize> {
        let cells = self.values.iter().zip(self.gaps).enumerate();
        let there = cells
            .filter(move |(_, (value, gap))| gap.is_none() && Off::of(**value, panel) == Some(off));
        there.map(|(i, _)| i)
    }
}

/// Draws the bars of all lines, stacked at each edge; returns entries for the legend. Values beyond
/// the scale have bars only if the ends of the scale are `asked` for. By default the scale has all
/// values except those that fall to 0 and errors too large to matter.
pub(super) fn draw(
    panel: &Panel,
    lines: &[Along],
    asked: bool,
    scene: &mut Scene,
) -> Vec<(Swatch, Rich)> {
    let height = HEIGHT * scene.unit();
    let mut entries = Vec::new();
    let (mut above, mut below) = (0.0, 0.0);
    let beyond = |off: &Off| matches!(off, Off::Above | Off::Below);
    for off in Off::ALL.into_iter().filter(|off| asked || !beyond(off)) {
        for line in lines {
            let cells: Vec<usize> = line.cells(panel, off).collect();
            if cells.is_empty() {
                continue;
            }
            let (top, rows) = match off {
                _ if off.is_upper() => (panel.area.top + height * above, &mut above),
                _ => (panel.area.bottom - height * (below + 1.0), &mut below),
            };
            *rows += 1.0;
            for i in cells {
                let [a, b] = [i, i + 1].map(|i| panel.across(line.edges[i]));
                let (from, to) = ((a.min(b), top), (a.max(b), top + height));
                scene.rect(from, to, line.colour);
            }
            let swatch = Swatch::Line(line.colour, HEIGHT, None);
            entries.push((swatch, off.words(line.field, &panel.y)));
        }
    }
    entries
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::meaning::colour::INK;
    use crate::meaning::scale::Scale;
    use crate::report::picture::page::Area;
    use crate::report::picture::scene::Mark;

    #[test]
    fn infinities_and_zeros_are_at_the_edges() {
        let area = Area {
            left: 0.0,
            top: 0.0,
            right: 4.0,
            bottom: 100.0,
        };
        let panel = |y| Panel {
            area,
            x: Scale::linear(0.0, 4.0),
            y,
        };
        let values = [f64::INFINITY, 0.0, f64::NEG_INFINITY, f64::INFINITY];
        let line = Along {
            field: Field::RelaxationTime,
            values: &values,
            gaps: &[None, None, None, Some(Gap::NotConverged)],
            edges: &[0.0, 1.0, 2.0, 3.0, 4.0],
            colour: INK,
        };
        let bars = |y| {
            let mut scene = Scene::new((1600, 1100));
            let entries = draw(&panel(y), std::slice::from_ref(&line), true, &mut scene);
            let place = |mark: &Mark| match mark {
                Mark::Rect { from, to, .. } => (from.0, from.1, to.1),
                other => panic!("{other:?}"),
            };
            let texts: Vec<Rich> = entries.into_iter().map(|entry| entry.1).collect();
            (scene.marks.iter().map(place).collect::<Vec<_>>(), texts)
        };
        let (places, texts) = bars(Scale::linear(-1.0, 1.0));
        assert_eq!(places, [(0.0, 0.0, 8.0), (2.0, 92.0, 100.0)]);
        let expected = ["∞ at the upper edge, unstable", "−∞ at the lower edge"];
        assert_eq!(texts, expected.map(Rich::plain));
        // On a logarithmic scale 0 lies below all.
        let (places, texts) = bars(Scale::logarithmic(0.1, 1.0));
        assert_eq!(places.last(), Some(&(1.0, 84.0, 92.0)));
        assert_eq!(texts.last(), Some(&Rich::plain("0 at the lower edge")));
    }
}
