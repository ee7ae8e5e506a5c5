//! Values along a line that have no place on its scale: infinite ones and, on a logarithmic scale,
//! zeros. They are bars at the edge of the panel.

use super::colour::Rgb;
use super::legend::Swatch;
use super::paint::at_zero;
use super::panels::Panel;
use super::scene::Scene;
use super::text::{Rich, number};
use crate::report::known::Gap;
use crate::sweep::Field;

/// Height of a bar, in units of the picture.
const HEIGHT: f64 = 8.0;

/// The value of a bar.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Off {
    Infinite,
    MinusInfinite,
    Zero,
}

impl Off {
    const ALL: [Self; 3] = [Self::Infinite, Self::MinusInfinite, Self::Zero];

    /// The kind of a value; none where the panel has a place for it.
    fn of(value: f64, panel: &Panel) -> Option<Self> {
        match value {
            f64::INFINITY => Some(Self::Infinite),
            f64::NEG_INFINITY => Some(Self::MinusInfinite),
            0.0 if panel.y.is_logarithmic() => Some(Self::Zero),
            _ => None,
        }
    }

    fn words(self, field: Field) -> Rich {
        let (value, edge) = match self {
            Self::Infinite => (f64::INFINITY, "upper"),
            Self::MinusInfinite => (f64::NEG_INFINITY, "lower"),
            Self::Zero => (0.0, "lower"),
        };
        let meaning = match self {
            Self::Zero => at_zero(field),
            _ if field.tells_stable(value) == Some(false) => ", unstable",
            _ => "",
        };
        let text = format!("{} at the {edge} edge{meaning}", number(value));
        Rich::default().and_formula(&text)
    }
}

/// Values along a line.
pub(super) struct Along<'a> {
    pub field: Field,
    pub values: &'a [f64],
    pub gaps: &'a [Option<Gap>],
    /// The edges of its cells, one more than there are.
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

/// Draws the bars of all lines, those of one edge above one another; gives what they mean.
pub(super) fn draw(panel: &Panel, lines: &[Along], scene: &mut Scene) -> Vec<(Swatch, Rich)> {
    let height = HEIGHT * scene.unit();
    let mut entries = Vec::new();
    let (mut above, mut below) = (0.0, 0.0);
    for off in Off::ALL {
        for line in lines {
            let cells: Vec<usize> = line.cells(panel, off).collect();
            if cells.is_empty() {
                continue;
            }
            let (top, rows) = match off {
                Off::Infinite => (panel.area.top + height * above, &mut above),
                _ => (panel.area.bottom - height * (below + 1.0), &mut below),
            };
            *rows += 1.0;
            for i in cells {
                let [a, b] = [i, i + 1].map(|i| panel.across(line.edges[i]));
                let (from, to) = ((a.min(b), top), (a.max(b), top + height));
                scene.rect(from, to, line.colour);
            }
            let swatch = Swatch::Line(line.colour, HEIGHT, None);
            entries.push((swatch, off.words(line.field)));
        }
    }
    entries
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::picture::colour::INK;
    use crate::report::picture::page::Area;
    use crate::report::picture::scale::Scale;
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
            let entries = draw(&panel(y), std::slice::from_ref(&line), &mut scene);
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
