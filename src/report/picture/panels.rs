//! Panels side by side with common axes: one for a single plane, several for small multiples.

use super::error::PictureError;
use super::page::{Area, LABEL, SMALL};
use super::scene::{Align, Point, Scene};
use super::text::Rich;
use crate::meaning::colour::{GRID, INK};
use crate::meaning::scale::Scale;
use crate::meaning::ticks::Tick;

const TICK: f64 = 8.0;
const MINOR_TICK: f64 = 4.0;
const FRAME_WIDTH: f64 = 1.6;
/// Desired ratio of width to height of a panel.
const SHAPE: f64 = 1.25;
/// Weight of empty places, as a share of all panels, against the logarithm of the panels' shape.
const EMPTY: f64 = 6.0;
const MOST_TICKS: usize = 10;

/// One panel: its place and its scales.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Panel {
    /// The area inside the frame.
    pub area: Area,
    /// The scale from left to right.
    pub x: Scale,
    /// The scale from bottom to top.
    pub y: Scale,
}

impl Panel {
    /// The place of a value from left to right.
    pub(super) fn across(&self, x: f64) -> f64 {
        self.area.left + self.area.width() * self.x.part(x)
    }

    /// The place of a value from bottom to top.
    pub(super) fn up(&self, y: f64) -> f64 {
        self.area.bottom - self.area.height() * self.y.part(y)
    }

    /// The place of a pair of values.
    pub(super) fn at(&self, x: f64, y: f64) -> Point {
        (self.across(x), self.up(y))
    }
}

/// Drawing of a panel, with ticks from left to right and from bottom to top.
impl Panel {
    /// Draws a line at every tick with a label.
    pub(super) fn draw_grid(&self, scene: &mut Scene, across: &[Tick], up: &[Tick]) {
        let width = 1.2 * scene.unit();
        let Area {
            left,
            top,
            right,
            bottom,
        } = self.area;
        for tick in across.iter().filter(|t| t.label.is_some()) {
            let x = self.across(tick.value);
            scene.ruler((x, top), (x, bottom), GRID, width);
        }
        for tick in up.iter().filter(|t| t.label.is_some()) {
            let y = self.up(tick.value);
            scene.ruler((left, y), (right, y), GRID, width);
        }
    }

    /// Draws the frame.
    pub(super) fn draw_frame(&self, scene: &mut Scene) {
        let area = self.area;
        let width = FRAME_WIDTH * scene.unit();
        scene.outline((area.left, area.top), (area.right, area.bottom), INK, width);
    }

    /// Draws ticks below the panel, with or without labels.
    pub(super) fn draw_x_ticks(&self, scene: &mut Scene, ticks: &[Tick], labels: bool) {
        let u = scene.unit();
        let bottom = self.area.bottom;
        for tick in ticks {
            let x = self.across(tick.value);
            let length = length(tick) * u;
            scene.ruler((x, bottom), (x, bottom + length), INK, FRAME_WIDTH * u);
            if let Some(label) = tick.label.as_ref().filter(|_| labels) {
                let at = (x, bottom + TICK * u + 1.1 * SMALL * u);
                scene.text(at, Align::Middle, &Rich::plain(label), SMALL * u, INK);
            }
        }
    }

    /// Draws ticks to the left of the panel, with or without labels.
    pub(super) fn draw_y_ticks(&self, scene: &mut Scene, ticks: &[Tick], labels: bool) {
        let u = scene.unit();
        let left = self.area.left;
        for tick in ticks {
            let y = self.up(tick.value);
            let length = length(tick) * u;
            scene.ruler((left - length, y), (left, y), INK, FRAME_WIDTH * u);
            if let Some(label) = tick.label.as_ref().filter(|_| labels) {
                let at = (left - (TICK + 6.0) * u, y + 0.31 * SMALL * u);
                scene.text(at, Align::End, &Rich::plain(label), SMALL * u, INK);
            }
        }
    }
}

/// The texts at the panels.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Words {
    /// Below all panels.
    pub x: Rich,
    /// To the left of all panels.
    pub y: Rich,
    /// Above each panel.
    pub headings: Vec<Option<Rich>>,
    /// Words that replace the numbers 0, 1, … to the left; empty for numbers.
    pub names: Vec<&'static str>,
}

impl Words {
    /// The texts of two axes with numbers.
    pub(super) fn of(x: Rich, y: Rich, headings: Vec<Option<Rich>>) -> Self {
        Self {
            x,
            y,
            headings,
            names: Vec::new(),
        }
    }
}

/// The least side of a panel, relative to the font of numbers.
const LEAST: f64 = 2.0;

/// Refuses panels that are smaller than a few letters, or turned over.
pub(super) fn roomy(panels: &[Panel], scene: &Scene) -> Result<(), PictureError> {
    let least = LEAST * SMALL * scene.unit();
    let room = |panel: &Panel| panel.area.width() >= least && panel.area.height() >= least;
    match panels.iter().all(room) {
        true => Ok(()),
        false => Err(PictureError::NoRoom),
    }
}

/// Panels in rows.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Panels {
    /// The panels, row by row from the top.
    pub list: Vec<Panel>,
    columns: usize,
    ticks: (Vec<Tick>, Vec<Tick>),
    words: Words,
    outside: Area,
}

impl Panels {
    /// Lays out one panel for each heading in `outside`.
    pub(super) fn new(scene: &Scene, outside: Area, (x, y): (Scale, Scale), words: Words) -> Self {
        let u = scene.unit();
        let n = words.headings.len().max(1);
        let (columns, rows) = shape(n, outside.width() / outside.height());
        let heading = if words.headings.iter().any(Option::is_some) {
            1.85 * SMALL * u
        } else {
            0.5 * SMALL * u
        };
        let height = (outside.height() - (2.1 * SMALL + 1.1 * LABEL) * u) / rows as f64 - heading;
        let y_ticks = match words.names.is_empty() {
            true => fitting_up(&y, height, u),
            false => named(&y, &words.names),
        };
        let labels = y_ticks.iter().filter_map(|t| t.label.as_deref());
        let left = outside.left + left_margin(labels, u);
        // Half of the last label of the x axis extends to the right.
        let end = 1.1 * SMALL * u;
        // The last label of one panel stands beside the first one of the next.
        let x_ticks = x.ticks(MOST_TICKS);
        let labels = x_ticks.iter().filter_map(|t| t.label.as_deref());
        let room = labels
            .map(|l| Rich::plain(l).width(SMALL * u) + 0.5 * SMALL * u)
            .fold(1.8 * SMALL * u, f64::max);
        let gap = if columns > 1 { room } else { 0.0 };
        let width = (outside.right - end - left - gap * (columns - 1) as f64) / columns as f64;
        let x_ticks = fitting_across(&x, width, u);
        let panel = |i: usize| {
            let (row, column) = (i / columns, i % columns);
            let left = left + column as f64 * (width + gap);
            let top = outside.top + heading + row as f64 * (height + heading);
            Panel {
                area: Area {
                    left,
                    top,
                    right: left + width,
                    bottom: top + height,
                },
                x,
                y,
            }
        };
        Self {
            list: (0..n).map(panel).collect(),
            columns,
            ticks: (x_ticks, y_ticks),
            words,
            outside,
        }
    }

    /// Refuses panels that have no room.
    pub(super) fn check(&self, scene: &Scene) -> Result<(), PictureError> {
        roomy(&self.list, scene)
    }

    /// Draws grid lines, before the contents.
    pub(super) fn draw_grid(&self, scene: &mut Scene) {
        for panel in &self.list {
            panel.draw_grid(scene, &self.ticks.0, &self.ticks.1);
        }
    }

    /// Draws frames, ticks and texts, after the contents.
    pub(super) fn draw_axes(&self, scene: &mut Scene) {
        let u = scene.unit();
        for (i, panel) in self.list.iter().enumerate() {
            let area = panel.area;
            let lowest = i + self.columns >= self.list.len();
            panel.draw_frame(scene);
            panel.draw_x_ticks(scene, &self.ticks.0, lowest);
            panel.draw_y_ticks(scene, &self.ticks.1, i % self.columns == 0);
            if let Some(Some(heading)) = self.words.headings.get(i) {
                let at = (0.5 * (area.left + area.right), area.top - 0.38 * SMALL * u);
                let size = heading.fitting(SMALL * u, area.width());
                scene.text(at, Align::Middle, heading, size, INK);
            }
        }
        self.draw_titles(scene);
    }

    fn draw_titles(&self, scene: &mut Scene) {
        let u = scene.unit();
        let (Some(first), Some(last)) = (self.list.first(), self.list.last()) else {
            return;
        };
        let right = self.list[self.columns.min(self.list.len()) - 1].area.right;
        let outside = self.outside;
        let words = &self.words;
        let size = words.x.fitting(LABEL * u, outside.width());
        let middle = 0.5 * (first.area.left + right);
        let middle = inside(middle, words.x.width(size), outside.left, outside.right);
        let at = (middle, outside.bottom - 0.25 * LABEL * u);
        scene.text(at, Align::Middle, &words.x, size, INK);
        // Above the other axis's title, which may begin as far to the left.
        let lowest = outside.bottom - 1.4 * LABEL * u;
        let size = words.y.fitting(LABEL * u, lowest - outside.top);
        let middle = 0.5 * (first.area.top + last.area.bottom);
        let middle = inside(middle, words.y.width(size), outside.top, lowest);
        let at = (outside.left + 0.85 * LABEL * u, middle);
        scene.upward_text(at, &words.y, size, INK);
    }
}

/// The centre nearest to `middle` with which this width stays between two edges.
pub(super) fn inside(middle: f64, width: f64, from: f64, to: f64) -> f64 {
    middle.min(to - 0.5 * width).max(from + 0.5 * width)
}

fn length(tick: &Tick) -> f64 {
    if tick.label.is_some() {
        TICK
    } else {
        MINOR_TICK
    }
}

/// Columns and rows for `n` panels in an area with this ratio of width to height.
fn shape(n: usize, area: f64) -> (usize, usize) {
    let mismatch = |columns: usize| {
        let rows = n.div_ceil(columns);
        let panel = area * rows as f64 / columns as f64;
        let empty = (columns * rows - n) as f64 / n as f64;
        (panel / SHAPE).ln().abs() + EMPTY * empty
    };
    let columns = (1..=n)
        .min_by(|&a, &b| mismatch(a).total_cmp(&mismatch(b)))
        .unwrap_or(1);
    (columns, n.div_ceil(columns))
}

/// Room to the left of a panel for the title of an axis, these labels and ticks.
pub(super) fn left_margin<'a>(labels: impl Iterator<Item = &'a str>, u: f64) -> f64 {
    let widths = labels.map(|l| Rich::plain(l).width(SMALL * u));
    1.4 * LABEL * u + widths.fold(0.0, f64::max) + (TICK + 8.0) * u
}

/// As many ticks as fit side by side in a width.
pub(super) fn fitting_across(scale: &Scale, width: f64, u: f64) -> Vec<Tick> {
    let label_width = |l: &str| Rich::plain(l).width(SMALL * u) + 0.9 * SMALL * u;
    fitting(scale, label_width, width)
}

/// As many ticks as fit above one another in a height.
pub(super) fn fitting_up(scale: &Scale, height: f64, u: f64) -> Vec<Tick> {
    fitting(scale, |_| 1.7 * SMALL * u, height)
}

/// As [`fitting_up`], but closer where fewer than two would have a label.
pub(super) fn two_fitting_up(scale: &Scale, height: f64, u: f64) -> Vec<Tick> {
    let ticks = fitting_up(scale, height, u);
    let labels = |ticks: &[Tick]| ticks.iter().filter(|tick| tick.label.is_some()).count();
    if labels(&ticks) > 1 {
        return ticks;
    }
    let closer = fitting(scale, |_| 1.2 * SMALL * u, height);
    match labels(&closer) > labels(&ticks) {
        true => closer,
        false => ticks,
    }
}

/// A tick for each name whose number is on the scale.
fn named(scale: &Scale, names: &[&str]) -> Vec<Tick> {
    let ticks = names.iter().enumerate().map(|(number, name)| Tick {
        value: number as f64,
        label: Some((*name).to_owned()),
    });
    ticks.filter(|tick| scale.holds(tick.value)).collect()
}

/// As many ticks as there is room for labels of these sizes.
fn fitting(scale: &Scale, size: impl Fn(&str) -> f64, room: f64) -> Vec<Tick> {
    let fits = |ticks: &[Tick]| {
        let labelled: Vec<(f64, f64)> = ticks
            .iter()
            .filter_map(|t| Some((scale.part(t.value) * room, size(t.label.as_deref()?))))
            .collect();
        labelled
            .windows(2)
            .all(|w| (w[1].0 - w[0].0).abs() >= 0.5 * (w[0].1 + w[1].1))
    };
    let mut candidates = (1..=MOST_TICKS).rev().map(|most| scale.ticks(most));
    candidates
        .find(|ticks| !ticks.is_empty() && fits(ticks))
        .unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_panel_has_a_place() {
        for n in 1..=12 {
            let (columns, rows) = shape(n, 1.4);
            assert!(columns * rows >= n && columns * (rows - 1) < n);
        }
        assert_eq!(shape(1, 1.4), (1, 1));
        // Three side by side, not three of four.
        assert_eq!(shape(3, 1.4), (3, 1));
        assert_eq!(shape(9, 1.3), (3, 3));
        assert_eq!(shape(12, 1.4), (4, 3));
    }

    #[test]
    fn labels_do_not_touch() {
        let scale = Scale::linear(0.0, 12.0);
        assert!(fitting(&scale, |_| 100.0, 320.0).len() <= 3);
        assert!(fitting(&scale, |_| 10.0, 1000.0).len() >= 7);
    }
}
