//! Panels above one another, with a common axis from left to right and their own scales upwards.

use super::page::{Area, LABEL, SMALL};
use super::panels::{Panel, fitting_across, inside, left_margin, two_fitting_up};
use super::scene::{Align, Scene};
use super::text::Rich;
use crate::meaning::colour::INK;
use crate::meaning::scale::Scale;
use crate::meaning::ticks::Tick;

/// Space between panels, relative to the font of numbers.
const GAP: f64 = 0.55;
/// From this height on, relative to the font of numbers, there is room for one more panel.
const ROOMY: f64 = 4.5;
/// Words of a title are left out where they would have to be smaller than this share of their font.
const LEGIBLE: f64 = 0.68;

/// One row of a stack.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Row {
    /// The scale from bottom to top.
    pub scale: Scale,
    /// The title to the left of the panel, in lines that may be joined; the last one says enough.
    pub title: Vec<Rich>,
}

/// Panels of equal height.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Stack {
    /// The panels from the top.
    pub panels: Vec<Panel>,
    across: Vec<Tick>,
    up: Vec<Vec<Tick>>,
    /// The lines of the title of each panel.
    titles: Vec<Vec<Rich>>,
    below: Rich,
    outside: Area,
}

/// Height of the axis below a stack, in units of the picture.
const FOOT: f64 = 2.1 * SMALL + 1.1 * LABEL;

/// The lines of each title at panels of this height: joined, all, or the last one.
fn title_lines(rows: &[Row], height: f64, u: f64) -> Vec<Vec<Rich>> {
    let joined = |row: &Row| {
        let lines = row.title.iter().cloned();
        lines
            .reduce(|all, line| all.and("  ").then(line))
            .unwrap_or_default()
    };
    let width = |text: &Rich| text.width(LABEL * u);
    let one = rows.iter().all(|row| width(&joined(row)) <= height);
    let mut lines = rows.iter().flat_map(|row| &row.title);
    let legible = lines.all(|line| LEGIBLE * width(line) <= height);
    let lines = |row: &Row| match (one, legible) {
        (true, _) => vec![joined(row)],
        (false, true) => row.title.clone(),
        (false, false) => row.title.last().cloned().into_iter().collect(),
    };
    rows.iter().map(lines).collect()
}

impl Stack {
    /// Whether so many panels have room, not just for their curves, in a height in units of the
    /// picture.
    pub(super) fn is_roomy(panels: usize, height: f64) -> bool {
        height - FOOT >= panels as f64 * (ROOMY + GAP) * SMALL
    }

    /// Lays out `rows` in `outside`, with `below` as the title of their common axis.
    pub(super) fn new(scene: &Scene, outside: Area, x: Scale, below: Rich, rows: &[Row]) -> Self {
        let u = scene.unit();
        let n = rows.len().max(1) as f64;
        let gap = GAP * SMALL * u;
        let height = (outside.height() - FOOT * u - n * gap) / n;
        let up: Vec<Vec<Tick>> = rows
            .iter()
            .map(|row| two_fitting_up(&row.scale, height, u))
            .collect();
        let labels = up.iter().flatten().filter_map(|t| t.label.as_deref());
        let titles = title_lines(rows, height, u);
        let lines = titles.iter().map(Vec::len).max().unwrap_or(1);
        let left = outside.left + left_margin(labels, u) + LABEL * u * (lines as f64 - 1.0);
        // Half of the last label extends to the right.
        let right = outside.right - 1.1 * SMALL * u;
        let panel = |(i, row): (usize, &Row)| {
            let top = outside.top + gap + i as f64 * (height + gap);
            Panel {
                area: Area {
                    left,
                    top,
                    right,
                    bottom: top + height,
                },
                x,
                y: row.scale,
            }
        };
        Self {
            panels: rows.iter().enumerate().map(panel).collect(),
            across: fitting_across(&x, right - left, u),
            up,
            titles,
            below,
            outside,
        }
    }

    /// Draws grid lines, before the contents.
    pub(super) fn draw_grid(&self, scene: &mut Scene) {
        for (panel, up) in self.panels.iter().zip(&self.up) {
            panel.draw_grid(scene, &self.across, up);
        }
    }

    /// Draws frames, ticks and texts, after the contents.
    pub(super) fn draw_axes(&self, scene: &mut Scene) {
        let u = scene.unit();
        let outside = self.outside;
        for (i, (panel, up)) in self.panels.iter().zip(&self.up).enumerate() {
            let lowest = i + 1 == self.panels.len();
            panel.draw_frame(scene);
            panel.draw_x_ticks(scene, &self.across, lowest);
            panel.draw_y_ticks(scene, up, true);
            let middle = 0.5 * (panel.area.top + panel.area.bottom);
            let mut left = outside.left + 0.85 * LABEL * u;
            for line in &self.titles[i] {
                let size = line.fitting(LABEL * u, panel.area.height());
                scene.upward_text((left, middle), line, size, INK);
                left += LABEL * u;
            }
        }
        let Some(panel) = self.panels.last() else {
            return;
        };
        let size = self.below.fitting(LABEL * u, outside.width());
        let middle = 0.5 * (panel.area.left + panel.area.right);
        let middle = inside(middle, self.below.width(size), outside.left, outside.right);
        let at = (middle, outside.bottom - 0.25 * LABEL * u);
        scene.text(at, Align::Middle, &self.below, size, INK);
    }
}
