//! A motion over time, and its velocity over the elongation.

use super::error::PictureError;
use super::legend::{Legend, Swatch};
use super::options::PictureOptions;
use super::page::{self, Area};
use super::panels::{Panel, roomy};
use super::scene::Scene;
use super::span::Span;
use super::stack::{Row, Stack};
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

const WIDTH: f64 = 2.6;
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

/// The value of a sample that a curve shows.
type Value = fn(&Sample) -> f64;

/// A curve over time.
struct Curve {
    of: Value,
    colour: Rgb,
    name: &'static str,
}

/// A panel over time.
struct Strip {
    title: String,
    curves: Vec<Curve>,
}

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
    let strips = strips(spec);
    let settled = Some(settled(spec, trace)).filter(|t| span.holds(*t));
    let wide = body.width() >= WIDE * u;
    let mut legend = Legend::default();
    if !options.no_legend {
        legend.entries = entries(&span, settled, &strips);
        if wide {
            let portrait = [sliding(spec, span.samples)];
            legend.entries.extend(symbols::entries(&portrait));
        }
    }
    if !wide {
        let width = legend.width(u);
        let column = body.cut_right(width, if width > 0.0 { 24.0 * u } else { 0.0 });
        draw_strips(spec, (&span, settled), &strips, body, scene)?;
        legend.draw(scene, column);
        return Ok(());
    }
    let middle = body.left + OVER_TIME * body.width();
    let over_time = Area {
        right: middle - 10.0 * u,
        ..body
    };
    let beside = Area {
        left: middle + 14.0 * u,
        ..body
    };
    draw_strips(spec, (&span, settled), &strips, over_time, scene)?;
    let portrait = Area {
        bottom: body.bottom - legend.height(u) - 20.0 * u,
        ..beside
    };
    draw_portrait(spec, span.samples, portrait, scene);
    let column = Area {
        left: beside.left + 60.0 * u,
        top: portrait.bottom + 20.0 * u,
        ..beside
    };
    legend.draw(scene, column);
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
    let time = |t: f64| format!("{}{}", number(t), suffix(&units.time(), " ", ""));
    let summary = &trace.summary;
    let became = match summary.outcome {
        Outcome::Sliding => {
            let settled = settled(spec, trace);
            let later = match settled > span.end() {
                true => ", later than is shown",
                false => "",
            };
            format!(
                "outcome: sliding, within 1 % of v0 from t = {} on{later}",
                time(settled)
            )
        }
        Outcome::StickSlip => format!("outcome: stick-slip, period {}", time(summary.period)),
        Outcome::LiftOff => format!("outcome: lift-off at t = {}", time(summary.decided)),
        other => format!("outcome: {}", other.name()),
    };
    notes.push(Rich::plain(&became));
    notes
}

/// The time from which the block's velocity stays within 1 % of v0; NaN if it never does.
fn settled(spec: &CaseSpec, trace: &Trace) -> f64 {
    // Without control the time counts from the start.
    let controlled = spec.setting.control().act();
    let switched_on = Some(spec.case.switch_on).filter(|t| controlled && t.is_finite());
    switched_on.unwrap_or(0.0) + trace.summary.settle_time
}

/// The panels over time. The last one shows the controlled quantity, if there is one.
fn strips(spec: &CaseSpec) -> Vec<Strip> {
    let [dark, light] = [colour::of_line(0, 3), colour::of_line(2, 3)];
    let curve = |of, colour, name| Curve { of, colour, name };
    let units = &spec.units;
    let unit = |dimension| suffix(&units.of(dimension), "  (", ")");
    let velocity: Value = |s| s.v;
    let mut strips = vec![
        Strip {
            title: format!("velocities ẋ, v{}", unit([0, 1, -1])),
            curves: vec![
                curve(velocity, light, "pulling velocity v"),
                curve(|s| s.x_dot, dark, "velocity of the block ẋ"),
            ],
        },
        Strip {
            title: format!("elongation a{}", unit([0, 1, 0])),
            curves: vec![curve(|s| s.a, dark, "")],
        },
    ];
    let control = spec.setting.control();
    if control.alpha_n != 0.0 {
        strips.push(Strip {
            title: format!("load N{}", unit([1, 0, 0])),
            curves: vec![curve(|s| s.n, dark, "")],
        });
    } else if control.alpha_v != 0.0 {
        strips.push(Strip {
            title: format!("pulling velocity v{}", unit([0, 1, -1])),
            curves: vec![curve(velocity, light, "")],
        });
    }
    strips
}

fn draw_strips(
    spec: &CaseSpec,
    (span, settled): (&Span, Option<f64>),
    strips: &[Strip],
    area: Area,
    scene: &mut Scene,
) -> Result<(), PictureError> {
    let samples = span.samples;
    let u = scene.unit();
    let row = |strip: &Strip| Row {
        scale: scale(strip.curves.iter().map(|c| c.of), samples),
        title: Rich::plain(&strip.title),
    };
    let below = format!("time t{}", suffix(&spec.units.time(), "  (", ")"));
    let rows = strips.iter().map(row).collect();
    let stack = Stack::new(scene, area, span.scale(), Rich::plain(&below), rows);
    roomy(&stack.panels, scene)?;
    for panel in &stack.panels {
        shade_sticks(panel, span, scene);
    }
    stack.draw_grid(scene);
    for (panel, strip) in stack.panels.iter().zip(strips) {
        for event in span.marked() {
            mark(panel, event.t, mark_colour(event.kind), DASH, scene);
        }
        if let Some(settled) = settled {
            mark(panel, settled, SOFT_INK, SETTLED, scene);
        }
        for curve in &strip.curves {
            let points = samples.iter().map(|s| panel.at(s.t, (curve.of)(s)));
            scene.path(by_columns(points), curve.colour, WIDTH * u);
        }
    }
    stack.draw_axes(scene);
    Ok(())
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
    let (elongation, velocity): (Value, Value) = (|s| s.a, |s| s.x_dot);
    let x = scale([elongation].into_iter(), samples);
    let row = Row {
        scale: scale([velocity].into_iter(), samples),
        title: Rich::plain(&format!("velocity ẋ{}", unit([0, 1, -1]))),
    };
    let below = Rich::plain(&format!("elongation a{}", unit([0, 1, 0])));
    let stack = Stack::new(scene, area, x, below, vec![row]);
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

/// The scale that holds all values, with a little room around them.
fn scale(of: impl Iterator<Item = Value>, samples: &[Sample]) -> Scale {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for of in of {
        let values = samples.iter().map(of);
        (low, high) = values.fold((low, high), |(l, h), v| (l.min(v), h.max(v)));
    }
    if low > high {
        return Scale::linear(0.0, 1.0);
    }
    // A constant is drawn in the middle.
    let least = 1e-6 * high.abs().max(low.abs());
    let room = match high - low {
        span if span > least => 0.06 * span,
        _ if high == 0.0 => 1.0,
        _ => 0.1 * high.abs(),
    };
    Scale::linear(low - room, high + room)
}

/// What stands in the legend of the panels over time.
fn entries(span: &Span, settled: Option<f64>, strips: &[Strip]) -> Vec<(Swatch, Rich)> {
    let curves = strips.iter().flat_map(|strip| &strip.curves).rev();
    let named = curves.filter(|curve| !curve.name.is_empty());
    let mut entries: Vec<(Swatch, Rich)> = named
        .map(|c| (Swatch::Line(c.colour, WIDTH, None), Rich::plain(c.name)))
        .collect();
    if !span.sticks().is_empty() {
        entries.push((Swatch::Box(STUCK), Rich::plain("the block sticks")));
    }
    for event in span.marked() {
        let text = match event.kind {
            Event::LiftOff => "lift-off",
            _ => "control switched on",
        };
        let swatch = Swatch::Dashed(mark_colour(event.kind), MARK_WIDTH, DASH);
        entries.push((swatch, Rich::plain(text)));
    }
    if settled.is_some() {
        let swatch = Swatch::Dashed(SOFT_INK, MARK_WIDTH, SETTLED);
        let words = Rich::default().and_formula("from here within 1 % of v_0");
        entries.push((swatch, words));
    }
    entries
}

/// The place of steady sliding in the portrait, if it lies inside.
fn sliding(spec: &CaseSpec, samples: &[Sample]) -> Placed {
    let scales: [Value; 2] = [|s| s.a, |s| s.x_dot];
    let [x, y] = scales.map(|of| scale([of].into_iter(), samples));
    let place = symbols::sliding(&spec.setting);
    let held = place.filter(|(a, v0)| x.holds(*a) && y.holds(*v0));
    held.map(|at| (Symbol::Sliding, at)).into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_vary_has_a_scale() {
        let sample = Sample {
            t: 0.0,
            x: 0.0,
            x_dot: 0.0,
            a: 0.0,
            v: 1.0,
            n: 2.0,
            mode: crate::slip::motion::Mode::Stick,
        };
        let of: [Value; 2] = [|s| s.a, |s| s.n];
        for (of, value) in of.into_iter().zip([0.0, 2.0]) {
            let scale = scale([of].into_iter(), &[sample]);
            assert!((scale.part(value) - 0.5).abs() < 1e-12);
        }
        assert!(scale(of.into_iter(), &[]).holds(0.5));
    }
}
