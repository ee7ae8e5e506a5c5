//! The panels of a motion over time: their curves, scales and titles.

use super::span::Span;
use super::stack::{Row, Stack};
use super::text::{Rich, suffix};
use crate::answers::trace::Sample;
use crate::meaning::colour::{self, FRICTION_FORCE, PULLING_FORCE, Rgb};
use crate::meaning::scale::Scale;
use crate::setting::CaseSpec;
use crate::slip::outcome::Outcome;

/// Width of a curve.
pub(super) const WIDTH: f64 = 2.6;
/// Widths of the two forces, which are equal while the block sticks: the second lies on the first.
const FORCE_WIDTHS: [f64; 2] = [5.0, 2.2];
/// The most decades of the velocity's deviation from v0.
const MOST_DECADES: i32 = 9;
/// The scale of the deviation begins at this part of its largest value in a free period.
const BELOW: f64 = 0.3;

/// The value of a sample that a curve shows.
pub(super) type Value = Box<dyn Fn(&Sample) -> f64>;

/// A curve over time.
pub(super) struct Curve {
    /// Its value.
    pub of: Value,
    /// Its colour.
    pub colour: Rgb,
    /// Its width, in units of the picture.
    pub width: f64,
    /// Its name in the legend; empty for none.
    pub name: &'static str,
}

impl Curve {
    fn new(of: impl Fn(&Sample) -> f64 + 'static, colour: Rgb, name: &'static str) -> Self {
        Self {
            of: Box::new(of),
            colour,
            width: WIDTH,
            name,
        }
    }
}

/// How much a panel is wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Wanted {
    /// It is always there.
    Always,
    /// Where there is room, first.
    First,
    /// Where there is still room.
    Then,
}

/// A panel over time.
pub(super) struct Strip {
    wanted: Wanted,
    /// What it shows in words, and as a symbol with its unit.
    title: [Rich; 2],
    /// Its scale.
    pub scale: Scale,
    /// Its curves, in the order of drawing.
    pub curves: Vec<Curve>,
}

impl Strip {
    fn new(wanted: Wanted, title: [&str; 2], curves: Vec<Curve>, samples: &[Sample]) -> Self {
        Self {
            wanted,
            title: title.map(|text| Rich::default().and_formula(text)),
            scale: scale(curves.iter().map(|curve| &curve.of), samples),
            curves,
        }
    }

    /// The velocities of pull and block.
    pub(super) fn of_velocities(spec: &CaseSpec, span: &Span) -> Self {
        let unit = suffix(&spec.units.of([0, 1, -1]), "  (", ")");
        let curves = vec![
            Curve::new(|s| s.v, colour::of_line(2, 3), "pulling velocity v"),
            Curve::new(
                |s| s.x_dot,
                colour::of_line(0, 3),
                "velocity of the block ẋ",
            ),
        ];
        let title = ["velocities", &format!("ẋ, v{unit}")];
        Self::new(Wanted::Always, title, curves, span.samples)
    }

    /// Its row among the others.
    pub(super) fn row(&self) -> Row {
        Row {
            scale: self.scale,
            title: self.title.to_vec(),
        }
    }
}

/// The panels over time that have room in a stack of some height. The last one shows the controlled
/// quantity, if there is one.
pub(super) fn fitting(spec: &CaseSpec, outcome: Outcome, span: &Span, room: f64) -> Vec<Strip> {
    let mut strips = all(spec, outcome, span);
    for least in [Wanted::Then, Wanted::First] {
        if !Stack::is_roomy(strips.len(), room) {
            strips.retain(|strip| strip.wanted != least);
        }
    }
    strips
}

fn all(spec: &CaseSpec, outcome: Outcome, span: &Span) -> Vec<Strip> {
    let samples = span.samples;
    let [dark, light] = [colour::of_line(0, 3), colour::of_line(2, 3)];
    let unit = |dimension| suffix(&spec.units.of(dimension), "  (", ")");
    let with_unit = |symbol: &str, dimension| format!("{symbol}{}", unit(dimension));
    let [of_speed, of_force] = [[0, 1, -1], [1, 0, 0]];
    let strip =
        |wanted, words, symbol: &str, curves| Strip::new(wanted, [words, symbol], curves, samples);
    let always = Wanted::Always;
    let mut strips = vec![Strip::of_velocities(spec, span)];
    strips.extend(deviation(spec, outcome, span, &unit(of_speed)));
    let curves = vec![Curve::new(|s| s.a, dark, "")];
    strips.push(strip(
        always,
        "elongation",
        &with_unit("a", [0, 1, 0]),
        curves,
    ));
    let title = with_unit("F", of_force);
    strips.push(strip(Wanted::First, "forces", &title, forces(spec)));
    let control = spec.setting.control();
    if control.alpha_n != 0.0 || spec.case.feedback.return_map.is_some() {
        let curves = vec![Curve::new(|s| s.n, dark, "")];
        strips.push(strip(always, "load", &with_unit("N", of_force), curves));
    } else if control.alpha_v != 0.0 {
        let curves = vec![Curve::new(|s| s.v, light, "")];
        let title = with_unit("v", of_speed);
        strips.push(strip(always, "pulling velocity", &title, curves));
    }
    strips
}

fn forces(spec: &CaseSpec) -> Vec<Curve> {
    let pulling = match spec.case.oscillator.dashpots().damping {
        0.0 => "spring force",
        _ => "force of spring and dashpot",
    };
    let mut curves = vec![
        Curve::new(|s| s.pulling_force, PULLING_FORCE, pulling),
        Curve::new(|s| s.friction_force, FRICTION_FORCE, "friction force"),
    ];
    for (curve, width) in curves.iter_mut().zip(FORCE_WIDTHS) {
        curve.width = width;
    }
    curves
}

/// The velocity's distance from v0 on a logarithmic scale, on which its decay is a straight line;
/// none where the block does not come to slide.
fn deviation(spec: &CaseSpec, outcome: Outcome, span: &Span, unit: &str) -> Option<Strip> {
    if outcome != Outcome::Sliding {
        return None;
    }
    let v0 = spec.case.last_v0();
    let of = move |s: &Sample| (s.x_dot - v0).abs();
    let period = free_period(spec);
    let [begin, end] = span.ends();
    // Between its largest values it passes 0 again and again.
    let largest = |from: f64, to: f64| {
        let there = span.samples.iter().filter(|s| (from..=to).contains(&s.t));
        there.map(of).fold(0.0, f64::max)
    };
    let least = largest(begin, begin + period).min(largest(end - period, end));
    let shown = span.samples.iter().map(of).filter(|v| *v >= BELOW * least);
    let scale = Scale::over_decades(shown, MOST_DECADES)?;
    let lowest = 1e-3 * scale.value(0.0);
    Some(Strip {
        wanted: Wanted::Then,
        title: ["deviation".to_owned(), format!("|ẋ − v_0|{unit}")]
            .map(|text| Rich::default().and_formula(&text)),
        scale,
        curves: vec![Curve::new(
            move |s| of(s).max(lowest),
            colour::of_line(0, 3),
            "",
        )],
    })
}

/// 2π √(M/κ).
pub(super) fn free_period(spec: &CaseSpec) -> f64 {
    std::f64::consts::TAU * spec.case.oscillator.time_unit()
}

/// The scale that holds all values, with a little room around them.
pub(super) fn scale<'v>(of: impl Iterator<Item = &'v Value>, samples: &[Sample]) -> Scale {
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
            pulling_force: 0.0,
            friction_force: 0.0,
            mode: crate::slip::motion::Mode::Stick,
        };
        let of: [Value; 2] = [Box::new(|s| s.a), Box::new(|s| s.n)];
        for (of, value) in of.iter().zip([0.0, 2.0]) {
            let scale = scale([of].into_iter(), &[sample]);
            assert!((scale.part(value) - 0.5).abs() < 1e-12);
        }
        assert!(scale(of.iter(), &[]).holds(0.5));
    }
}
