//! A motion over time, and its velocity over the elongation.

use super::clip;
use super::close_up::CloseUp;
use super::error::PictureError;
use super::legend::{Legend, Swatch};
use super::options::PictureOptions;
use super::page::{self, Area};
use super::panels::{Panel, roomy};
use super::scene::Scene;
use super::span::Span;
use super::stack::{Row, Stack};
use super::strips::{self, Strip, Value, WIDTH, scale};
use super::symbols::{self, Placed, Symbol};
use super::text::{Rich, assignment, number, suffix};
use super::thinned::{apart, by_columns};
use crate::answers::Trace;
use crate::answers::trace::Sample;
use crate::meaning::colour::{self, Rgb, SOFT_INK, STUCK, UNSTABLE};
use crate::meaning::scale::Scale;
use crate::setting::{CaseSpec, Parameter};
use crate::slip::motion::Event;
use crate::slip::outcome::Outcome;

/// Width of the line at a switch-on or a lift-off.
const MARK_WIDTH: f64 = 2.0;
const DASH: (f64, f64) = (9.0, 7.0);
/// Dashes of the line at the time when the velocity has settled.
const SETTLED: (f64, f64) = (1.0, 5.0);
/// Share of the width for the panels over time.
const OVER_TIME: f64 = 0.655;
/// From so many units on there is room for the velocity over the elongation.
const WIDE: f64 = 1200.0;
/// The most points of the phase portrait, counted from the end: older ones would be covered.
const MOST_PORTRAIT: usize = 30_000;
/// Space above the legend and around the portrait.
const APART: f64 = 20.0;

/// Draws a trace of a case.
pub(super) fn draw(
    spec: &CaseSpec,
    options: &PictureOptions,
    trace: &Trace,
    scene: &mut Scene,
) -> Result<(), PictureError> {
    let span = Span::of(trace, options.time)?;
    let title = match spec.title.trim() {
        "" => "Motion of the block",
        title => title,
    };
    let title = match options.untitled() {
        true => "",
        false => options.title.as_deref().unwrap_or(title),
    };
    let notes = options.subtitle(notes(spec, trace, &span));
    let mut body = page::head(scene, title, &notes);
    let u = scene.unit();
    let settled = Some(settled(spec, trace)).filter(|t| span.holds(*t));
    let over_time = OverTime {
        span,
        settled,
        strips: strips::fitting(spec, trace.summary.outcome, &span, body.height() / u),
        below: Rich::plain(&format!("time t{}", suffix(&spec.units.time(), "  (", ")"))),
    };
    if body.width() >= WIDE * u {
        return draw_wide(spec, options, &over_time, body, scene);
    }
    let legend = |seen: &[&Panel]| over_time.legend(options, seen);
    let width = legend(&[]).width(u);
    let column = body.cut_right(width, if width > 0.0 { 24.0 * u } else { 0.0 });
    let stack = over_time.stack(body, scene);
    over_time.draw(&stack, None, scene)?;
    legend(&stack.panels.iter().collect::<Vec<_>>()).draw(scene, column);
    Ok(())
}

/// Draws the panels over time, and what has room beside them.
fn draw_wide(
    spec: &CaseSpec,
    options: &PictureOptions,
    over_time: &OverTime,
    body: Area,
    scene: &mut Scene,
) -> Result<(), PictureError> {
    let u = scene.unit();
    let middle = body.left + OVER_TIME * body.width();
    let stack = over_time.stack(
        Area {
            right: middle - 10.0 * u,
            ..body
        },
        scene,
    );
    let mut beside = Area {
        left: middle + 14.0 * u,
        ..body
    };
    let samples = over_time.span.samples;
    let portrait = [sliding(spec, samples)];
    let legend = |seen: &[&Panel]| {
        let mut legend = over_time.legend(options, seen);
        if !options.no_legend {
            legend.entries.extend(symbols::entries(&portrait));
        }
        legend
    };
    let height = legend(&[]).height(u);
    beside.bottom -= height + APART * u;
    let close_up = CloseUp::of(spec, over_time, &mut beside, scene);
    over_time.draw(&stack, close_up.as_ref(), scene)?;
    draw_portrait(spec, samples, beside, scene);
    let column = Area {
        left: beside.left + 60.0 * u,
        top: beside.bottom + APART * u,
        bottom: body.bottom,
        ..beside
    };
    let panels = close_up.iter().flat_map(|close_up| &close_up.stack.panels);
    let seen: Vec<&Panel> = stack.panels.iter().chain(panels).collect();
    legend(&seen).draw(scene, column);
    Ok(())
}

/// The setting, and the outcome of the motion.
fn notes(spec: &CaseSpec, trace: &Trace, span: &Span) -> Vec<Rich> {
    let (setting, units) = (&spec.setting, &spec.units);
    let mut notes = vec![];
    for parameter in [
        Parameter::V0,
        Parameter::AlphaV,
        Parameter::AlphaN,
        Parameter::Tau,
    ] {
        let value = setting.get(parameter);
        if value != 0.0 {
            notes.push(assignment(parameter, value, &units.of_parameter(parameter)));
        }
    }
    if let Some(last) = spec.case.programme.last() {
        let unit = suffix(&units.of_parameter(Parameter::V0), " ", "");
        let last = format!("in the end v_0 = {}{unit}", number(last.v0));
        notes.push(Rich::default().and_formula(&last));
    }
    let time = |t: f64| format!("{}{}", number(t), suffix(&units.time(), " ", ""));
    let summary = &trace.summary;
    let became = Rich::plain("outcome: ");
    let became = match summary.outcome {
        Outcome::Sliding => {
            let settled = settled(spec, trace);
            let later = match settled > span.end() {
                true => ", later than is shown",
                false => "",
            };
            let from = format!(" from t = {} on{later}", time(settled));
            became.and_formula("sliding, within 1 % of v_0").and(&from)
        }
        Outcome::StickSlip => became.and(&format!("stick-slip, period {}", time(summary.period))),
        Outcome::LiftOff => became.and(&format!("lift-off at t = {}", time(summary.decided))),
        other => became.and(other.name()),
    };
    notes.push(became);
    notes
}

/// The time from which the block's velocity stays within 1 % of v0; NaN if it never does.
fn settled(spec: &CaseSpec, trace: &Trace) -> f64 {
    // Without control the time counts from the start.
    let controlled = spec.case.feedback.acts();
    let switched_on = Some(spec.case.switch_on).filter(|t| controlled && t.is_finite());
    switched_on.unwrap_or(0.0) + trace.summary.settle_time
}

/// The panels over a stretch of time, and what is marked in them.
pub(super) struct OverTime<'t> {
    /// The stretch.
    pub span: Span<'t>,
    /// When the velocity has settled, if that is shown.
    pub settled: Option<f64>,
    /// The panels.
    pub strips: Vec<Strip>,
    /// The title of time.
    pub below: Rich,
}

impl OverTime<'_> {
    /// Lays out its panels.
    pub(super) fn stack(&self, area: Area, scene: &Scene) -> Stack {
        let rows: Vec<Row> = self.strips.iter().map(Strip::row).collect();
        Stack::new(scene, area, self.span.scale(), self.below.clone(), &rows)
    }

    /// Draws its panels, with a frame around what a close-up shows of the first.
    pub(super) fn draw(
        &self,
        stack: &Stack,
        close_up: Option<&CloseUp>,
        scene: &mut Scene,
    ) -> Result<(), PictureError> {
        roomy(&stack.panels, scene)?;
        for panel in &stack.panels {
            shade_sticks(panel, &self.span, scene);
        }
        stack.draw_grid(scene);
        for (panel, strip) in stack.panels.iter().zip(&self.strips) {
            for event in self.span.marked() {
                mark(panel, event.t, mark_colour(event.kind), DASH, scene);
            }
            if let Some(settled) = self.settled {
                mark(panel, settled, SOFT_INK, SETTLED, scene);
            }
            draw_curves(panel, strip, &self.span, scene);
        }
        if let (Some(close_up), Some(panel)) = (close_up, stack.panels.first()) {
            close_up.frame(panel, scene);
        }
        stack.draw_axes(scene);
        Ok(())
    }

    /// What is seen in some panels; without panels, all that may be.
    fn legend(&self, options: &PictureOptions, seen: &[&Panel]) -> Legend {
        let mut legend = Legend::default();
        if options.no_legend {
            return legend;
        }
        let entries = &mut legend.entries;
        for strip in &self.strips {
            let named = strip.curves.iter().rev().filter(|c| !c.name.is_empty());
            let entry = |c: &strips::Curve| {
                let name = Rich::plain(c.name);
                (Swatch::Line(c.colour, c.width, None), name)
            };
            entries.extend(named.map(entry));
        }
        let sticks = match seen {
            [] => !self.span.sticks().is_empty(),
            panels => panels.iter().any(|panel| self.span.sticks_in(panel)),
        };
        if sticks {
            entries.push((Swatch::Box(STUCK), Rich::plain("the block sticks")));
        }
        for event in self.span.marked() {
            let text = match event.kind {
                Event::LiftOff => "lift-off",
                _ => "control switched on",
            };
            let swatch = Swatch::Dashed(mark_colour(event.kind), MARK_WIDTH, DASH);
            entries.push((swatch, Rich::plain(text)));
        }
        if self.settled.is_some() {
            let swatch = Swatch::Dashed(SOFT_INK, MARK_WIDTH, SETTLED);
            let words = Rich::default().and_formula("from here within 1 % of v_0");
            entries.push((swatch, words));
        }
        legend
    }
}

/// Draws the curves of a strip, as far as they lie in its panel.
fn draw_curves(panel: &Panel, strip: &Strip, span: &Span, scene: &mut Scene) {
    let u = scene.unit();
    for curve in &strip.curves {
        let samples = span.samples.iter();
        let points = by_columns(samples.map(|s| panel.at(s.t, (curve.of)(s))));
        for part in clip::within(&points, panel.area) {
            scene.path(part, curve.colour, curve.width * u);
        }
    }
}

fn mark(panel: &Panel, t: f64, colour: Rgb, dash: (f64, f64), scene: &mut Scene) {
    let x = panel.across(t);
    let line = [(x, panel.area.bottom), (x, panel.area.top)];
    scene.dashed(&line, colour, MARK_WIDTH * scene.unit(), dash);
}

fn mark_colour(kind: Event) -> Rgb {
    match kind {
        Event::LiftOff => UNSTABLE[3],
        _ => SOFT_INK,
    }
}

fn shade_sticks(panel: &Panel, span: &Span, scene: &mut Scene) {
    let area = panel.area;
    for (from, to) in span.sticks() {
        let (left, right) = (panel.across(from), panel.across(to));
        scene.rect((left, area.top), (right, area.bottom), STUCK);
    }
}

fn draw_portrait(spec: &CaseSpec, samples: &[Sample], area: Area, scene: &mut Scene) {
    let u = scene.unit();
    let units = &spec.units;
    let unit = |dimension| suffix(&units.of(dimension), "  (", ")");
    let [x, y] = portrait_scales(samples);
    let row = Row {
        scale: y,
        title: ["velocity".to_owned(), format!("ẋ{}", unit([0, 1, -1]))]
            .map(|text| Rich::plain(&text))
            .into(),
    };
    let below = Rich::plain(&format!("elongation a{}", unit([0, 1, 0])));
    let stack = Stack::new(scene, area, x, below, &[row]);
    stack.draw_grid(scene);
    if let Some(panel) = stack.panels.first() {
        let points = samples.iter().map(|s| panel.at(s.a, s.x_dot));
        let mut points = apart(points);
        let old = points.len().saturating_sub(MOST_PORTRAIT);
        points.drain(..old);
        scene.path(points, colour::of_line(0, 3), 0.7 * WIDTH * u);
        symbols::draw(panel, &sliding(spec, samples), scene);
    }
    stack.draw_axes(scene);
}

/// The scales of elongation and velocity.
fn portrait_scales(samples: &[Sample]) -> [Scale; 2] {
    let of: [Value; 2] = [Box::new(|s| s.a), Box::new(|s| s.x_dot)];
    of.map(|of| scale(std::iter::once(&of), samples))
}

/// The place of steady sliding in the portrait, if it lies inside.
fn sliding(spec: &CaseSpec, samples: &[Sample]) -> Placed {
    let [x, y] = portrait_scales(samples);
    let place = symbols::sliding(&spec.last_setting());
    let held = place.filter(|(a, v0)| x.holds(*a) && y.holds(*v0));
    held.map(|at| (Symbol::Sliding, at)).into_iter().collect()
}
