//! Panels above one another, with a common axis from left to right and their own scales upwards.

use super::page::{Area, LABEL, SMALL};
use super::panels::{Panel, fitting_across, fitting_up, inside, left_margin};
use super::scene::{Align, Scene};
use super::text::Rich;
use crate::meaning::colour::INK;
use crate::meaning::scale::Scale;
use crate::meaning::ticks::Tick;

/// Space between panels, relative to the font of numbers.
const GAP: f64 = 0.55;

/// One row of a stack.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Row {
    /// The scale from bottom to top.
    pub scale: Scale,
    /// The title to the left of the panel.
    pub title: Rich,
}

/// Panels of equal height.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Stack {
    /// The panels from the top.
    pub panels: Vec<Panel>,
    across: Vec<Tick>,
    up: Vec<Vec<Tick>>,
    titles: Vec<Rich>,
    below: Rich,
    outside: Area,
}

impl Stack {
    /// Lays out `rows` in `outside`, with `below` as the title of their common axis.
    pub(super) fn new(scene: &Scene, outside: Area, x: Scale, below: Rich, rows: Vec<Row>) -> Self {
        let u = scene.unit();
        let n = rows.len().max(1) as f64;
        let gap = GAP * SMALL * u;
        let foot = (2.1 * SMALL + 1.1 * LABEL) * u;
        let height = (outside.height() - foot - n * gap) / n;
        let up: Vec<Vec<Tick>> = rows
            .iter()
            .map(|row| fitting_up(&row.scale, height, u))
            .collect();
        let labels = up.iter().flatten().filter_map(|t| t.label.as_deref());
        let left = outside.left + left_margin(labels, u);
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
            titles: rows.into_iter().map(|row| row.title).collect(),
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
            let title = &self.titles[i];
            let size = title.fitting(LABEL * u, panel.area.height());
            let middle = 0.5 * (panel.area.top + panel.area.bottom);
            let at = (outside.left + 0.85 * LABEL * u, middle);
            scene.upward_text(at, title, size, INK);
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
