//! The meaning of colours, beside the panels.

use super::error::PictureError;
use super::hatch;
use super::page::{Area, SMALL};
use super::panels::fitting_up;
use super::scene::{Align, Scene};
use super::symbols::Symbol;
use super::text::Rich;
use crate::meaning::colour::{INK, Rgb, SOFT_INK};
use crate::meaning::gap::Gap;
use crate::meaning::scale::Scale;

const SWATCH: f64 = 44.0;
const GAP: f64 = 14.0;
const LINE: f64 = 1.55;
const BAR_WIDTH: f64 = 30.0;
const BAR_STEPS: usize = 256;
/// A legend is not made smaller than by this factor.
const LEAST: f64 = 0.5;
/// The least height of a bar, relative to the font of its numbers.
const LEAST_BAR: f64 = 2.0;

/// How an entry is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Swatch {
    /// A line of this width, over an area with that colour if there is one.
    Line(Rgb, f64, Option<Rgb>),
    /// A dashed line of this width, with the (length, gap) of its dashes.
    Dashed(Rgb, f64, (f64, f64)),
    /// A box.
    Box(Rgb),
    /// A symbol.
    Symbol(Symbol),
    /// Nothing: words alone.
    None,
    /// A box filled like cells with this gap.
    Gap(Gap),
    /// A dot of this diameter.
    Dot(Rgb, f64),
    /// A dot in a ring, with the diameters of ring, hole and dot.
    Ring(Rgb, f64, f64, f64),
}

/// A list of colours with their meanings.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Legend {
    /// Lines above the list.
    pub heading: Vec<Rich>,
    /// The list, from the top.
    pub entries: Vec<(Swatch, Rich)>,
}

impl Legend {
    /// Width in pixels.
    pub(super) fn width(&self, u: f64) -> f64 {
        let headings = self.heading.iter().map(|line| line.width(SMALL * u));
        let entries = self.entries.iter();
        entries
            .map(|(_, text)| (SWATCH + GAP) * u + text.width(SMALL * u))
            .chain(headings)
            .fold(0.0, f64::max)
    }

    /// Height in pixels.
    pub(super) fn height(&self, u: f64) -> f64 {
        let headings = 1.3 * self.heading.len() as f64 + 0.3;
        (headings + LINE * self.entries.len() as f64) * SMALL * u
    }

    /// Draws the legend at the upper left corner of `area`, smaller where the sheet ends before it.
    pub(super) fn draw(&self, scene: &mut Scene, area: Area) {
        let unit = scene.unit();
        let room = f64::from(scene.size.1) - 0.5 * SMALL * unit - area.top;
        let u = unit * (room / self.height(unit)).clamp(LEAST, 1.0);
        let mut y = heading(scene, area, &self.heading, u);
        for (swatch, text) in &self.entries {
            let middle = y + 0.5 * LINE * SMALL * u;
            let (left, right) = (area.left, area.left + SWATCH * u);
            let half = 0.5 * SMALL * u;
            let (from, to) = ((left, middle - half), (right, middle + half));
            match *swatch {
                Swatch::Box(colour) => {
                    scene.rect(from, to, colour);
                    scene.outline(from, to, SOFT_INK, u);
                }
                Swatch::None => {}
                Swatch::Dot(colour, dot) => {
                    scene.dot((0.5 * (left + right), middle), colour, dot * u);
                }
                Swatch::Ring(colour, ring, hole, dot) => {
                    let at = (0.5 * (left + right), middle);
                    scene.ring(at, colour, (ring * u, hole * u));
                    scene.dot(at, colour, dot * u);
                }
                Swatch::Symbol(symbol) => symbol.draw((left + 0.5 * (right - left), middle), scene),
                Swatch::Gap(gap) => {
                    scene.rect(from, to, gap.ground());
                    hatch::fill(from, to, gap, scene);
                    scene.outline(from, to, SOFT_INK, u);
                }
                Swatch::Dashed(colour, width, dash) => {
                    let line = [(left, middle), (right, middle)];
                    scene.dashed(&line, colour, width * u, dash);
                }
                Swatch::Line(colour, width, below) => {
                    if let Some(below) = below {
                        scene.rect(from, to, below);
                    }
                    scene.path(vec![(left, middle), (right, middle)], colour, width * u);
                }
            }
            let at = (right + GAP * u, middle + 0.32 * SMALL * u);
            scene.text(at, Align::Start, text, SMALL * u, INK);
            y += LINE * SMALL * u;
        }
    }
}

fn heading(scene: &mut Scene, area: Area, lines: &[Rich], u: f64) -> f64 {
    let mut y = area.top;
    for line in lines {
        y += SMALL * u;
        scene.text((area.left, y), Align::Start, line, SMALL * u, INK);
        y += 0.3 * SMALL * u;
    }
    y + 0.3 * SMALL * u
}

/// A bar of colours with numbers.
pub(super) struct Bar<'a> {
    /// Lines above the bar.
    pub heading: Vec<Rich>,
    /// The values.
    pub scale: Scale,
    /// The colour of a value.
    pub colour: &'a dyn Fn(f64) -> Rgb,
}

impl Bar<'_> {
    /// Width in pixels.
    pub(super) fn width(&self, u: f64) -> f64 {
        let ticks = self.scale.ticks(8);
        let labels = ticks.iter().filter_map(|t| t.label.as_deref());
        let numbers = labels
            .map(|l| (BAR_WIDTH + 18.0) * u + Rich::plain(l).width(SMALL * u))
            .fold(0.0, f64::max);
        let headings = self.heading.iter().map(|line| line.width(SMALL * u));
        headings.fold(numbers, f64::max)
    }

    /// Draws the bar over the height of `area`.
    ///
    /// # Errors
    /// When it has no room there.
    pub(super) fn draw(&self, scene: &mut Scene, area: Area) -> Result<(), PictureError> {
        let u = scene.unit();
        let top = heading(scene, area, &self.heading, u) + 0.4 * SMALL * u;
        if area.bottom - top < LEAST_BAR * SMALL * u {
            return Err(PictureError::NoRoom);
        }
        let (left, right) = (area.left, area.left + BAR_WIDTH * u);
        let height = area.bottom - top;
        let place = |part: f64| area.bottom - height * part;
        // Each step reaches from the top to the bottom of the bar, under the next one, so that no
        // gap shows.
        for i in (0..BAR_STEPS).rev() {
            let [low, high] = [i, i + 1].map(|i| i as f64 / BAR_STEPS as f64);
            let colour = (self.colour)(self.scale.value(0.5 * (low + high)));
            scene.rect((left, place(high)), (right, area.bottom), colour);
        }
        scene.outline((left, top), (right, area.bottom), INK, 1.2 * u);
        for tick in fitting_up(&self.scale, height, u) {
            let y = place(self.scale.part(tick.value));
            scene.ruler((right, y), (right + 7.0 * u, y), INK, 1.4 * u);
            let at = (right + 14.0 * u, y + 0.31 * SMALL * u);
            let label = tick.label.as_deref().unwrap_or_default();
            scene.text(at, Align::Start, &Rich::plain(label), SMALL * u, INK);
        }
        Ok(())
    }
}
