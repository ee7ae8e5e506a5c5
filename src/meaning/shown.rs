//! All that a page needs to show the cells of a plane: the same as a picture of them has.

use std::collections::HashSet;

use serde::Serialize;

use super::alike::alike;
use super::colour::{HATCH, NO_VALUE, Rgb};
use super::gap::{Gap, Rule};
use super::legend::{self, Entry, Mark};
use super::numbers::suffix;
use super::paint::{Paint, Shades};
use super::scale::Scale;
use super::steps::Steps;
use crate::setting::Field;
use crate::sweep::engine::{FEW_FILL, N_UNSTABLE_FILL};

/// Colours of a bar from its lower to its upper end.
const BAR: usize = 64;
/// Numbers beside a bar, about.
const TICKS: usize = 5;

/// The meaning of the colours of some cells.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub(crate) struct Shown {
    /// Lines above the legend.
    pub heading: Vec<String>,
    /// The colours of numbers; none of a field with classes.
    #[cfg_attr(feature = "serve", schema(required))]
    pub scale: Option<ShownScale>,
    /// The legend: what occurs, besides the bar of the scale.
    pub entries: Vec<ShownEntry>,
    /// How cells without a value to show are filled.
    pub fills: Vec<ShownGap>,
    /// The colour of the lines over them.
    pub hatch: String,
    /// The colour of what has no value and no reason for it.
    pub none: String,
}

/// The colours of numbers.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub(crate) struct ShownScale {
    /// Where the colour changes; an equal number has the upper one.
    pub ends: Vec<f64>,
    /// The colours below, between and above the ends.
    pub colours: Vec<String>,
    /// The colour of 0, if it has one of its own.
    #[cfg_attr(feature = "serve", schema(required))]
    pub zero: Option<String>,
    /// The colour of ∞.
    pub infinite: String,
    /// The colour of −∞.
    pub minus_infinite: String,
    /// The bar: colours at equal parts of the way up the scale.
    pub bar: Vec<String>,
    /// Numbers beside it.
    pub ticks: Vec<ShownTick>,
}

/// A number beside a bar.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub(crate) struct ShownTick {
    /// The part of the way up.
    pub part: f64,
    /// The number.
    pub text: String,
}

/// An entry of a legend.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub(crate) struct ShownEntry {
    /// Its words.
    pub text: String,
    /// The colour of its cells; none where it is about cells without a value to show.
    #[cfg_attr(feature = "serve", schema(required))]
    pub colour: Option<String>,
    /// The number of these in `gaps`.
    #[cfg_attr(feature = "serve", schema(required))]
    pub gap: Option<u8>,
}

/// How cells without a value to show are filled.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub(crate) struct ShownGap {
    /// Its number in `gaps`.
    pub gap: u8,
    /// A word for it.
    pub name: &'static str,
    /// Why there is no value.
    pub text: &'static str,
    /// Whether there is an answer which is not known, whatever number the cell has.
    pub unknown: bool,
    /// The colour below the lines.
    pub ground: String,
    /// The directions of lines: `rising`, `falling`, `upright`, `level`.
    pub lines: Vec<&'static str>,
}

/// The cells of a field as they are stored.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Column<'a> {
    /// Kinds and small counts.
    U8(&'a [u8]),
    /// Numbers of unstable roots.
    U16(&'a [u16]),
    /// Real numbers.
    F64(&'a [f64]),
}

impl Column<'_> {
    /// The value of a cell; NaN where there is none.
    pub(crate) fn value(&self, cell: usize) -> f64 {
        let value = match self {
            Self::U8(cells) => cells
                .get(cell)
                .filter(|n| **n != FEW_FILL)
                .map(|n| (*n).into()),
            Self::U16(cells) => {
                let counted = cells.get(cell).filter(|n| **n != N_UNSTABLE_FILL);
                counted.map(|n| (*n).into())
            }
            Self::F64(cells) => cells.get(cell).copied(),
        };
        value.unwrap_or(f64::NAN)
    }

    /// How many cells from one on are the same as it.
    fn alike_from(&self, cell: usize) -> usize {
        let length = match self {
            Self::U8(cells) => alike(cells.get(cell..).unwrap_or_default(), |a, b| a == b),
            Self::U16(cells) => alike(cells.get(cell..).unwrap_or_default(), |a, b| a == b),
            Self::F64(cells) => alike(cells.get(cell..).unwrap_or_default(), |a, b| {
                a.to_bits() == b.to_bits()
            }),
        };
        // No value follows one that is not there.
        if length == 0 { usize::MAX } else { length }
    }
}

/// Where the stretch of equal cells ends that one lies in: each is gone through once.
struct Stretch<'a> {
    column: Column<'a>,
    end: usize,
}

impl<'a> Stretch<'a> {
    fn of(column: Column<'a>) -> Self {
        Self { column, end: 0 }
    }

    /// The end of the stretch of a cell; they are asked for in order.
    fn end_from(&mut self, cell: usize) -> usize {
        if self.end <= cell {
            self.end = cell.saturating_add(self.column.alike_from(cell));
        }
        self.end
    }
}

/// The cells of a plane.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cells<'a> {
    pub field: Field,
    pub unit: &'a str,
    pub rule: Rule,
    pub values: Column<'a>,
    pub status: &'a [u8],
    /// The field that says why there is no value.
    pub why: Option<Column<'a>>,
}

impl Cells<'_> {
    /// What they mean, and for each of them 0 or the number of its gap. Those that `lack` are
    /// neither seen nor counted; those that `repeat` one of the others are not counted again.
    pub(crate) fn shown(
        &self,
        lack: impl Fn(usize) -> bool,
        repeat: impl Fn(usize) -> bool,
    ) -> (Shown, Vec<u8>) {
        let classes = Paint::of(self.field, &[]).scale().is_none();
        let mut gaps = vec![0; self.status.len()];
        let mut there = [false; Gap::ALL.len()];
        let mut values = Vec::new();
        let mut seen = HashSet::new();
        let mut stretches = [Some(self.values), Some(Column::U8(self.status)), self.why]
            .map(|column| column.map(Stretch::of));
        let mut begun = 0;
        while begun < gaps.len() {
            let value = self.values.value(begun);
            let why = self.why.filter(|_| value.is_nan());
            let why = why.map(|why| why.value(begun));
            let ends = stretches.iter_mut().flatten();
            let ended = ends.fold(gaps.len(), |end, of| end.min(of.end_from(begun)));
            let gap = self.rule.gap(value, self.status[begun], why);
            let told = |cell: &usize| !lack(*cell);
            if let Some(gap) = gap {
                for cell in (begun..ended).filter(told) {
                    gaps[cell] = number_of(gap);
                    there[gap as usize] = true;
                }
            } else if classes {
                if (begun..ended).any(|cell| told(&cell)) && seen.insert(value.to_bits()) {
                    values.push(value);
                }
            } else {
                // A real number matters by how often it is there.
                let counts = |cell: &usize| told(cell) && !repeat(*cell);
                values.extend((begun..ended).filter(counts).map(|_| value));
            }
            begun = ended;
        }
        (self.told(&values, |gap| there[gap as usize]), gaps)
    }

    fn told(&self, values: &[f64], there: impl Fn(Gap) -> bool + Copy) -> Shown {
        let field = self.field;
        let paint = Paint::of(field, values);
        let name = || {
            let name = field.short_name().to_owned() + &suffix(self.unit, " (", ")");
            let side = legend::side(field).map(str::to_owned);
            [name].into_iter().chain(side).collect()
        };
        let list = legend::list_heading(field, &paint);
        let heading = list.map_or_else(name, |heading| vec![heading.to_owned()]);
        let entries = legend::entries(field, &paint, values).into_iter();
        let gaps = Gap::ALL.into_iter().filter(|gap| there(*gap));
        Shown {
            heading,
            scale: paint.scale().and_then(|scale| match paint.shades() {
                Shades::Steps(steps) => Some(ShownScale::of(&steps, &scale)),
                Shades::Counts | Shades::Kinds(_) => None,
            }),
            entries: entries
                .chain(legend::of_gaps(field, there))
                .map(ShownEntry::of)
                .collect(),
            fills: gaps.map(|gap| ShownGap::of(gap, field)).collect(),
            hatch: HATCH.hex(),
            none: NO_VALUE.hex(),
        }
    }
}

/// The number of a gap, from 1.
fn number_of(gap: Gap) -> u8 {
    gap as u8 + 1
}

impl ShownScale {
    fn of(steps: &Steps, scale: &Scale) -> Self {
        let middle = |i: usize| scale.value((i as f64 + 0.5) / BAR as f64);
        let tick = |tick: super::ticks::Tick| ShownTick {
            part: scale.part(tick.value),
            text: tick.label.unwrap_or_default(),
        };
        Self {
            ends: steps.ends.clone(),
            colours: steps.colours.iter().map(|colour| colour.hex()).collect(),
            zero: steps.zero.map(Rgb::hex),
            infinite: steps.infinite.hex(),
            minus_infinite: steps.minus_infinite.hex(),
            bar: (0..BAR).map(|i| steps.colour(middle(i)).hex()).collect(),
            ticks: scale
                .ticks(TICKS)
                .into_iter()
                .map(tick)
                .filter(|tick| !tick.text.is_empty())
                .collect(),
        }
    }
}

impl ShownEntry {
    fn of(entry: Entry) -> Self {
        let (colour, gap) = match entry.mark {
            Mark::Colour(colour) => (Some(colour.hex()), None),
            Mark::Gap(gap) => (None, Some(number_of(gap))),
        };
        Self {
            text: entry.text,
            colour,
            gap,
        }
    }
}

impl ShownGap {
    fn of(gap: Gap, field: Field) -> Self {
        Self {
            gap: number_of(gap),
            name: gap.name(),
            text: gap.words(field),
            unknown: gap.is_unknown(),
            ground: gap.ground().hex(),
            lines: gap.lines().iter().map(|run| run.name()).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::status::MARGINAL;
    use crate::sweep::engine::STATUS_FILL;

    fn cells<'a>(field: Field, values: Column<'a>, status: &'a [u8]) -> Cells<'a> {
        Cells {
            field,
            unit: "1",
            rule: Rule::of(field, &[field]),
            values,
            status,
            why: None,
        }
    }

    #[test]
    fn a_marginal_cell_is_not_stable() {
        let counts = [0, 2, 0, 0, N_UNSTABLE_FILL, 0];
        let status = [0, 0, MARGINAL, STATUS_FILL, 0, 0];
        // It may be the first one with its number.
        let turned = cells(Field::NUnstable, Column::U16(&[0, 0]), &[MARGINAL, 0]);
        let (shown, _) = turned.shown(|_| false, |_| false);
        assert_eq!(shown.entries.len(), 2);
        let told = cells(Field::NUnstable, Column::U16(&counts), &status);
        let (shown, gaps) = told.shown(|cell| cell == 5, |_| false);
        let numbers = [Gap::Marginal, Gap::NotComputed, Gap::NoValue].map(number_of);
        assert_eq!(gaps, [0, 0, numbers[0], numbers[1], numbers[2], 0]);
        let texts: Vec<&str> = shown.entries.iter().map(|entry| &*entry.text).collect();
        let expected = ["0, stable", "2", "marginal", "no value", "not computed"];
        assert_eq!(texts, expected);
        assert_eq!(shown.heading, ["unstable roots"]);
        assert!(shown.scale.is_none());
        assert_eq!(shown.fills.len(), 3);
        // What is not there is not told of.
        let (shown, _) = told.shown(|cell| cell > 1, |_| false);
        assert!(shown.fills.is_empty());
    }

    /// A cell that many pixels show counts once for the ends of the scale.
    #[test]
    fn what_is_repeated_does_not_count_again() {
        let numbers = [vec![1.0; 20], vec![50.0; 200]].concat();
        let told = cells(Field::LatencyMargin, Column::F64(&numbers), &[0; 220]);
        let top = |shown: &Shown| {
            let scale = shown.scale.as_ref();
            scale.map(|scale| scale.ends[scale.ends.len() - 1])
        };
        let (once, _) = told.shown(|_| false, |cell| cell > 20);
        let (often, _) = told.shown(|_| false, |_| false);
        let (few, _) = told.shown(|cell| cell > 20, |_| false);
        assert_eq!(top(&once), top(&few));
        assert!(top(&often) >= top(&few));
    }

    #[test]
    fn every_field_is_shown_as_in_a_picture() {
        let numbers = [-3.0, -0.0, 0.0, 0.5, 1.0, 40.0, f64::INFINITY, f64::NAN];
        let status = [0; 8];
        for field in Field::ALL {
            let (shown, gaps) =
                cells(field, Column::F64(&numbers), &status).shown(|_| false, |_| false);
            let there: Vec<f64> = { numbers.iter().zip(&gaps) }
                .filter_map(|(value, gap)| (*gap == 0).then_some(*value))
                .collect();
            let paint = Paint::of(field, &there);
            assert_eq!(shown.scale.is_some(), paint.scale().is_some());
            let Some(scale) = shown.scale else { continue };
            for value in there.into_iter().filter(|v| v.is_finite() && *v != 0.0) {
                let place = scale.ends.partition_point(|end| *end <= value);
                let expected = paint.shades().colour(value).hex();
                assert_eq!(scale.colours[place], expected, "{} {value}", field.name());
            }
            assert!(scale.ticks.len() > 1, "{}", field.name());
            assert_eq!(scale.bar.len(), BAR);
        }
    }
}
