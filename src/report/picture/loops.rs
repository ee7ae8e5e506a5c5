//! The loop of a setting, with the delay drawn exactly and its margins marked: as a curve in the
//! complex plane (Nyquist), or as size and angle over the frequency (Bode).

use num_complex::Complex64;

use super::clip;
use super::inputs::{inputs, title_of};
use super::legend::{Legend, Swatch};
use super::page::{self, Area};
use super::panels::Panel;
use super::scene::{Point, Scene};
use super::stack::{Row, Stack};
use super::text::{Rich, number, suffix};
use crate::explore::loop_response::LoopResponse;
use crate::explore::margins::Margins;
use crate::meaning::colour::{self, INK, Rgb, SOFT_INK};
use crate::meaning::scale::Scale;
use crate::model::elementary::norm;
use crate::setting::Setting;
use crate::setting::units::Units;
use crate::text::finite;

const WIDTH: f64 = 3.0;
const THIN: f64 = 1.8;
const DOT: f64 = 13.0;
const DASH: (f64, f64) = (9.0, 7.0);
/// The complex plane reaches as far as the loop, but from this to that, and to all of its marks.
const NEAREST: f64 = 1.35;
const FARTHEST: f64 = 2.5;
/// Angles are drawn down to so many degrees below that at the last mark.
const BELOW: f64 = 450.0;
/// Decades of the loop's size that are drawn, about 1.
const DECADES: (f64, f64) = (1e-4, 1e4);
/// Straight pieces of a circle.
const PIECES: u32 = 240;

/// How a loop is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LoopKind {
    /// L(iω) in the complex plane.
    Nyquist,
    /// |L| and its angle over ω.
    Bode,
}

/// The data of a picture of a loop.
#[derive(Debug, Clone, Copy)]
pub struct LoopPicture<'p> {
    /// The setting.
    pub setting: &'p Setting,
    /// Its loop.
    pub response: &'p LoopResponse,
    /// Its margins; none of them are marked where it is not stable.
    pub margins: &'p Margins,
    /// The units of all.
    pub units: &'p Units,
    /// How it is drawn.
    pub kind: LoopKind,
}

/// Draws a loop.
pub(super) fn draw(picture: &LoopPicture, scene: &mut Scene) {
    let what = match picture.kind {
        LoopKind::Nyquist => "the loop in the complex plane",
        LoopKind::Bode => "the loop over the frequency",
    };
    let mut notes = inputs(picture.setting, picture.units);
    if !picture.margins.decays {
        notes.push(Rich::plain("not stable: no margins"));
    }
    let mut body = page::head(
        scene,
        &title_of(
            picture.setting,
            (&format!("Control of sliding: {what}"), what),
        ),
        &notes,
    );
    let u = scene.unit();
    let legend = legend(picture);
    let column = body.cut_right(legend.width(u), 30.0 * u);
    let top = match picture.kind {
        LoopKind::Nyquist => draw_plane(picture, body, scene),
        LoopKind::Bode => draw_over_frequency(picture, body, scene),
    };
    legend.draw(scene, Area { top, ..column });
}

/// The colours of the loop, and of the places of gain, phase and modulus margin.
fn colours() -> [Rgb; 4] {
    [0, 1, 2, 3].map(|i| colour::of_line(i, 4))
}

/// L at a frequency, between the samples beside it; none beyond them.
fn at(response: &LoopResponse, omega: f64) -> Option<Complex64> {
    let samples = &response.samples;
    let i = samples.partition_point(|(there, _)| *there < omega);
    let (after, before) = (samples.get(i)?, samples.get(i.checked_sub(1)?)?);
    let part = (omega - before.0) / (after.0 - before.0);
    Some(before.1 + part * (after.1 - before.1))
}

/// The places of the margins on the loop: colour, ω.
fn places(picture: &LoopPicture) -> Vec<(Rgb, f64)> {
    let of = &picture.margins.crossing_frequencies;
    let [_, gain, phase, modulus] = colours();
    let all = [
        (gain, of.gain_margin.lower),
        (gain, of.gain_margin.upper),
        (phase, of.phase_margin),
        (modulus, of.modulus_margin),
    ];
    let known = all.into_iter();
    let known = known.filter(|(_, omega)| *omega > 0.0 && omega.is_finite());
    known.filter(|_| picture.margins.decays).collect()
}

/// The marks of the margins in the complex plane: −1/k at the ends of the gain margin, else L.
fn marks(picture: &LoopPicture) -> Vec<(Rgb, Complex64)> {
    let margins = picture.margins;
    let [_, gain, phase, modulus] = colours();
    let ends = margins.gain_margin.map(|of| [of.lower, of.upper]);
    let ends = ends.into_iter().flatten();
    let ends = ends.filter(|k| *k > 0.0 && k.is_finite());
    let of = &margins.crossing_frequencies;
    let on_loop = [(phase, of.phase_margin), (modulus, of.modulus_margin)];
    let on_loop = on_loop.into_iter();
    let on_loop = on_loop.filter_map(|(colour, at_omega)| {
        let of = at(picture.response, at_omega)?;
        Some((colour, of))
    });
    let of_gain = ends.map(|k| (gain, Complex64::new(-1.0 / k, 0.0)));
    of_gain.chain(on_loop).collect()
}

/// The complex plane; returns the upper edge of its panel.
fn draw_plane(picture: &LoopPicture, area: Area, scene: &mut Scene) -> f64 {
    let u = scene.unit();
    let response = picture.response;
    let largest = response.samples.iter().map(|(_, of)| norm(*of));
    let marks = marks(picture);
    let sizes = marks.iter().map(|(_, of)| norm(*of));
    let reach = largest.fold(NEAREST, f64::max).min(FARTHEST);
    let reach = 1.08 * sizes.fold(reach, f64::max);
    let row = |scale| Row {
        scale,
        title: vec![Rich::plain("Im L")],
    };
    let below = || Rich::plain("Re L");
    let square = Scale::linear(-reach, reach);
    let first = Stack::new(scene, area, square, below(), &[row(square)]);
    let Some(panel) = first.panels.first() else {
        return area.top;
    };
    // One unit is as long across as up.
    let ratio = panel.area.width() / panel.area.height();
    let (across, up) = (reach * ratio.max(1.0), reach / ratio.min(1.0));
    let (x, y) = (Scale::linear(-across, across), Scale::linear(-up, up));
    let stack = Stack::new(scene, area, x, below(), &[row(y)]);
    let Some(panel) = stack.panels.first() else {
        return area.top;
    };
    stack.draw_grid(scene);
    draw_circles(picture, panel, scene);
    let curve = |sign: f64| -> Vec<Point> {
        let samples = picture.response.samples.iter();
        samples
            .map(|(_, of)| panel.at(of.re, sign * of.im))
            .collect()
    };
    let [colour, ..] = colours();
    for (sign, colour, width) in [
        (-1.0, colour::pale(colour, 0.55), THIN),
        (1.0, colour, WIDTH),
    ] {
        for piece in clip::within(&curve(sign), panel.area) {
            scene.path(piece, colour, width * u);
        }
    }
    let critical = panel.at(-1.0, 0.0);
    scene.ring(critical, INK, (1.5 * DOT * u, 0.9 * DOT * u));
    for (colour, of) in marks {
        scene.dot(panel.at(of.re, of.im), colour, DOT * u);
    }
    stack.draw_axes(scene);
    panel.area.top
}

/// The unit circle, and the largest one about −1 that the loop does not enter.
fn draw_circles(picture: &LoopPicture, panel: &Panel, scene: &mut Scene) {
    let u = scene.unit();
    let circle = |centre: f64, radius: f64| -> Vec<Point> {
        let turn = |i: u32| std::f64::consts::TAU * f64::from(i) / f64::from(PIECES);
        let points = (0..=PIECES).map(|i| Complex64::from_polar(radius, turn(i)));
        points.map(|of| panel.at(centre + of.re, of.im)).collect()
    };
    let mut dashed = |points: Vec<Point>, colour: Rgb| {
        for piece in clip::within(&points, panel.area) {
            scene.dashed(&piece, colour, THIN * u, DASH);
        }
    };
    dashed(circle(0.0, 1.0), SOFT_INK);
    let [.., modulus] = colours();
    if let Some(radius) = finite(picture.margins.modulus_margin).filter(|of| *of > 0.0) {
        dashed(circle(-1.0, radius), modulus);
    }
}

/// Size and angle over the frequency; returns the upper edge of the first panel.
fn draw_over_frequency(picture: &LoopPicture, area: Area, scene: &mut Scene) -> f64 {
    let u = scene.unit();
    let samples = &picture.response.samples;
    let sizes: Vec<f64> = samples.iter().map(|(_, of)| norm(*of)).collect();
    let phases = picture.response.phases();
    let rows = rows(&sizes, &phases, least_phase(picture, &phases));
    let (lowest, highest) = rows[1].scale.ends();
    let [from, to] = [samples.first(), samples.last()].map(|of| of.map_or(1.0, |of| of.0));
    let unit = suffix(&picture.units.angular_frequency(), "  (", ")");
    let below = Rich::plain(&format!("frequency ω{unit}"));
    let stack = Stack::new(scene, area, Scale::logarithmic(from, to), below, &rows);
    let [size, phase] = &*stack.panels else {
        return area.top;
    };
    stack.draw_grid(scene);
    let across = |panel: &Panel, at: f64, scene: &mut Scene| {
        let ends = [
            (panel.area.left, panel.up(at)),
            (panel.area.right, panel.up(at)),
        ];
        scene.dashed(&ends, SOFT_INK, THIN * u, DASH);
    };
    across(size, 1.0, scene);
    let turns = (0..).map(|k| -180.0 - 360.0 * f64::from(k));
    for level in turns.take_while(|of| *of >= lowest) {
        if level <= highest {
            across(phase, level, scene);
        }
    }
    for (panel, values) in [(size, &sizes), (phase, &phases)] {
        draw_values(picture, panel, values, scene);
    }
    stack.draw_axes(scene);
    size.area.top
}

/// The least angle that is drawn, so far below that at the last mark.
fn least_phase(picture: &LoopPicture, phases: &[f64]) -> f64 {
    let last = places(picture).iter().map(|of| of.1).fold(0.0, f64::max);
    let all = picture.response.samples.iter().zip(phases);
    let marked = all.filter(|((omega, _), _)| *omega <= last);
    marked
        .map(|(_, phase)| phase - BELOW)
        .fold(-BELOW, f64::min)
}

/// The marks and the curve of one panel.
fn draw_values(picture: &LoopPicture, panel: &Panel, values: &[f64], scene: &mut Scene) {
    let u = scene.unit();
    for (colour, omega) in places(picture) {
        let x = panel.across(omega);
        let line = [(x, panel.area.bottom), (x, panel.area.top)];
        for piece in clip::within(&line, panel.area) {
            scene.dashed(&piece, colour, THIN * u, DASH);
        }
    }
    let points = picture.response.samples.iter().zip(values);
    let points: Vec<Point> = points.map(|((x, _), y)| panel.at(*x, *y)).collect();
    let [colour, ..] = colours();
    for piece in clip::within(&points, panel.area) {
        scene.path(piece, colour, WIDTH * u);
    }
}

/// The rows of size and angle.
fn rows(sizes: &[f64], phases: &[f64], least_phase: f64) -> [Row; 2] {
    let ends = |of: &[f64], (low, high): (f64, f64)| {
        let fold = |start: f64, f: fn(f64, f64) -> f64| of.iter().copied().fold(start, f);
        (fold(low, f64::min), fold(high, f64::max))
    };
    let (least, most) = ends(sizes, (0.5, 2.0));
    let (least, most) = (least.max(DECADES.0), most.min(DECADES.1));
    let (lowest, highest) = ends(phases, (-180.0, -180.0));
    let lowest = lowest.max(least_phase);
    let room = 0.06 * (highest - lowest).max(90.0);
    [
        Row {
            scale: Scale::logarithmic(0.8 * least, 1.25 * most),
            title: vec![Rich::plain("|L|")],
        },
        Row {
            scale: Scale::linear(lowest - room, highest + room).with_smallest_step(45.0),
            title: vec![Rich::plain("arg L"), Rich::plain("degrees")],
        },
    ]
}

/// What the colours are, with the margins in numbers.
fn legend(picture: &LoopPicture) -> Legend {
    let margins = picture.margins;
    let [curve, gain, phase, modulus] = colours();
    let mut entries = Vec::new();
    let mut entry = |swatch, text: &str| entries.push((swatch, Rich::plain(text)));
    entry(Swatch::Line(curve, WIDTH, None), "L(iω), ω > 0");
    let mark = |colour| match picture.kind {
        LoopKind::Nyquist => Swatch::Dot(colour, DOT),
        LoopKind::Bode => Swatch::Dashed(colour, THIN, DASH),
    };
    if picture.kind == LoopKind::Nyquist {
        let pale = colour::pale(curve, 0.55);
        entry(Swatch::Line(pale, THIN, None), "ω < 0");
        entry(Swatch::Ring(INK, 1.5 * DOT, 0.9 * DOT, 0.0), "−1");
        entry(Swatch::Dashed(SOFT_INK, THIN, DASH), "|L| = 1");
    }
    if !margins.decays {
        return Legend {
            heading: Vec::new(),
            entries,
        };
    }
    if let Some(of) = margins.gain_margin {
        let ends = [of.lower, of.upper].map(|end| finite(end).filter(|end| *end > 0.0));
        let text = match ends.map(|end| end.map(number)) {
            [Some(lower), Some(upper)] => format!("gain: {lower} to {upper} times"),
            [None, Some(upper)] => format!("gain: up to {upper} times"),
            [Some(lower), None] => format!("gain: from {lower} times on"),
            [None, None] => "gain: any".to_owned(),
        };
        entry(mark(gain), &text);
    }
    if let Some(angle) = finite(margins.phase_margin) {
        let degrees = number(angle.to_degrees());
        entry(mark(phase), &format!("phase: {degrees} degrees"));
    }
    if let Some(of) = finite(margins.modulus_margin) {
        entry(mark(modulus), &format!("distance from −1: {}", number(of)));
    }
    if let Some(upper) = margins.tau_margin.and_then(|of| finite(of.upper)) {
        let time = suffix(&picture.units.time(), " ", "");
        entry(
            Swatch::None,
            &format!("delay: {}{time} more", number(upper)),
        );
    }
    Legend {
        heading: Vec::new(),
        entries,
    }
}
