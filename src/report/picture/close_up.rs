//! The velocities around the time at which control is switched on, enlarged: in a long motion these
//! few periods are narrow.

use super::page::{Area, SMALL};
use super::panels::Panel;
use super::scene::Scene;
use super::span::Span;
use super::stack::Stack;
use super::strips::{Strip, free_period};
use super::text::{Rich, suffix};
use super::trace::OverTime;
use crate::meaning::colour::SOFT_INK;
use crate::setting::CaseSpec;
use crate::slip::motion::Event;

/// Free periods shown before switch-on and after it.
const PERIODS: [f64; 2] = [1.0, 3.0];
/// A motion is long if it takes so many times what is enlarged of it.
const LONG: f64 = 3.0;
/// The least height of the close-up and of what is below it, relative to the font of numbers.
const LEAST: f64 = 8.5;
/// Space below, in units of the picture.
const APART: f64 = 16.0;
/// Width of the frame around what is enlarged.
const FRAME: f64 = 2.2;
/// Space between that frame and the panel's own.
const WITHIN: f64 = 5.0;

/// A part of the velocities, and its place.
pub(super) struct CloseUp {
    /// Where it is.
    pub stack: Stack,
    ends: [f64; 2],
}

impl CloseUp {
    /// Draws the close-up at the top of an area, which it takes, if it is worthwhile and there is
    /// room.
    pub(super) fn of(
        spec: &CaseSpec,
        whole: &OverTime,
        area: &mut Area,
        scene: &mut Scene,
    ) -> Option<Self> {
        let ends = worthwhile(spec, &whole.span)?;
        let u = scene.unit();
        let height = 0.5 * area.height();
        if height < LEAST * SMALL * u {
            return None;
        }
        let span = whole.span.part(ends);
        let unit = suffix(&spec.units.time(), "  (", ")");
        let part = OverTime {
            span,
            settled: whole.settled.filter(|t| span.holds(*t)),
            strips: vec![Strip::of_velocities(spec, &span)],
            below: Rich::plain(&format!("time t{unit}, framed on the left")),
        };
        let place = Area {
            bottom: area.top + height,
            ..*area
        };
        let stack = part.stack(place, scene);
        part.draw(&stack, None, scene).ok()?;
        area.top = place.bottom + APART * u;
        Some(Self { stack, ends })
    }

    /// Draws a frame around its part of a panel.
    pub(super) fn frame(&self, panel: &Panel, scene: &mut Scene) {
        let Some(own) = self.stack.panels.first() else {
            return;
        };
        let [left, right] = self.ends.map(|t| panel.across(t));
        let u = scene.unit();
        let [top, bottom] = [1.0, 0.0].map(|part| panel.up(own.y.value(part)));
        // It stays within the frame of the panel.
        let top = top.max(panel.area.top + WITHIN * u);
        let bottom = bottom.min(panel.area.bottom - WITHIN * u);
        scene.outline((left, top), (right, bottom), SOFT_INK, FRAME * u);
    }
}

/// From when to when a close-up is worthwhile.
fn worthwhile(spec: &CaseSpec, span: &Span) -> Option<[f64; 2]> {
    let switched_on = span.marked().find(|event| event.kind == Event::SwitchOn)?;
    let period = free_period(spec);
    let [begin, end] = span.ends();
    let [before, after] = PERIODS.map(|periods| periods * period);
    let long = end - begin >= LONG * (before + after);
    let ends = [switched_on.t - before, switched_on.t + after];
    let ends = [ends[0].max(begin), ends[1].min(end)];
    let enough = span.part(ends).samples.len() > 2 && ends[1] - ends[0] >= period;
    (long && enough).then_some(ends)
}
