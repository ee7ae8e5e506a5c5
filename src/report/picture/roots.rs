//! A point of parameter space: its characteristic roots in the complex plane, and the number of
//! unstable roots over the delay.

use super::inputs::{inputs, title_of};
use super::legend::{Legend, Swatch};
use super::page::{self, Area};
use super::panels::Panel;
use super::scene::Scene;
use super::stack::{Row, Stack};
use super::text::{Rich, number, suffix};
use super::value_scale;
use crate::explore::along_delay::AlongDelay;
use crate::explore::stability::Stability;
use crate::meaning::colour::{self, INK, Rgb, SOFT_INK, STABLE, UNSTABLE};
use crate::meaning::scale::Scale;
use crate::report::numbers::counted;
use crate::setting::units::Units;
use crate::setting::{Parameter, Setting};
use crate::text::finite;

/// Share of the width for the complex plane.
const PLANE: f64 = 0.56;
/// Diameters of a root, and of the ring around the rightmost ones.
const DOT: f64 = 11.0;
const RING: f64 = 23.0;
const HOLE: f64 = 17.0;
const WIDTH: f64 = 2.6;
/// Width of the lines at the setting's delay and at the certificate.
const MARK_WIDTH: f64 = 2.0;
const DASH: (f64, f64) = (9.0, 7.0);
/// Strength of the colours of stable delays and of the unstable half-plane.
const TINT: f64 = 0.45;

/// Real parts below this share of the imaginary ones count as 0.
const FLAT: f64 = 1e-9;

/// The data of a picture of a point.
#[derive(Debug, Clone, Copy)]
pub struct PointPicture<'p> {
    /// Its setting.
    pub setting: &'p Setting,
    /// Its stability, with the roots to draw.
    pub stability: &'p Stability,
    /// Its line of delays; none where that is not known.
    pub along: Option<&'p AlongDelay>,
    /// The units of all.
    pub units: &'p Units,
}

/// Draws a point.
pub(super) fn draw(picture: &PointPicture, scene: &mut Scene) {
    let words = ("Characteristic roots of sliding", "characteristic roots");
    let title = title_of(picture.setting, words);
    let body = page::head(scene, &title, &notes(picture));
    let u = scene.unit();
    let middle = body.left + PLANE * body.width();
    let plane = Area {
        right: middle - 10.0 * u,
        ..body
    };
    let beside = Area {
        left: middle + 14.0 * u,
        ..body
    };
    draw_plane(picture, plane, scene);
    let legend = legend(picture);
    let over_delay = Area {
        bottom: body.bottom - legend.height(u) - 20.0 * u,
        ..beside
    };
    let top = match picture.along {
        Some(along) => {
            draw_counts(picture, along, over_delay, scene);
            over_delay.bottom + 20.0 * u
        }
        None => beside.top + 20.0 * u,
    };
    let column = Area {
        left: beside.left + 60.0 * u,
        top,
        ..beside
    };
    legend.draw(scene, column);
}

/// The setting, its roots and stable delays.
fn notes(picture: &PointPicture) -> Vec<Rich> {
    let PointPicture {
        setting,
        stability,
        units,
        ..
    } = picture;
    let mut notes = inputs(setting, units);
    notes.push(Rich::plain(&verdict(setting, stability)));
    if let Some(abscissa) = finite(stability.spectrum.abscissa) {
        let rate = suffix(&units.rate(), " ", "");
        notes.push(Rich::plain(&format!(
            "spectral abscissa {}{rate}",
            number(abscissa)
        )));
    }
    if !stability.spectrum.certified {
        notes.push(Rich::plain("the roots are not certified"));
    }
    notes
}

fn verdict(setting: &Setting, stability: &Stability) -> String {
    let what = match setting.system() {
        None => "sliding is ",
        Some(_) => "",
    };
    match (stability.marginal, stability.stable, stability.n_unstable) {
        (true, ..) => format!("{what}marginal"),
        (_, true, _) => format!("{what}stable"),
        (.., Some(n)) => format!("{what}unstable: {}", counted(n, "root")),
        (.., None) => stability.reason.unwrap_or("not known").into(),
    }
}

/// The complex plane.
fn draw_plane(picture: &PointPicture, area: Area, scene: &mut Scene) {
    let (u, units) = (scene.unit(), picture.units);
    let spectrum = &picture.stability.spectrum;
    let (x, y) = scales(&spectrum.roots);
    let unit = |unit: &str| suffix(unit, "  (", ")");
    let title = format!("Im λ{}", unit(&units.angular_frequency()));
    let row = Row {
        scale: y,
        title: vec![Rich::plain(&title)],
    };
    let below = Rich::plain(&format!("Re λ{}", unit(&units.rate())));
    let stack = Stack::new(scene, area, x, below, &[row]);
    let Some(panel) = stack.panels.first() else {
        return;
    };
    let axis = panel.across(0.0);
    let (top, bottom) = (panel.area.top, panel.area.bottom);
    scene.rect((axis, top), (panel.area.right, bottom), half_plane());
    stack.draw_grid(scene);
    scene.ruler((axis, top), (axis, bottom), INK, MARK_WIDTH * u);
    if let Some(line) = finite(spectrum.certified_line) {
        let x = panel.across(line);
        scene.dashed(
            &[(x, bottom), (x, top)],
            SOFT_INK,
            0.7 * MARK_WIDTH * u,
            DASH,
        );
    }
    for (i, root) in spectrum.roots.iter().enumerate().rev() {
        for im in both(root[1]) {
            draw_root(panel, (root[0], im), i == 0, scene);
        }
    }
    stack.draw_axes(scene);
}

/// The imaginary parts of a root and its conjugate.
fn both(im: f64) -> Vec<f64> {
    if im == 0.0 { vec![im] } else { vec![im, -im] }
}

fn draw_root(panel: &Panel, (re, im): (f64, f64), rightmost: bool, scene: &mut Scene) {
    let (at, u) = (panel.at(re, im), scene.unit());
    let colour = colour_of_root(re);
    if rightmost {
        scene.ring(at, colour, (RING * u, HOLE * u));
    }
    scene.dot(at, colour, DOT * u);
}

fn colour_of_root(re: f64) -> Rgb {
    if re > 0.0 {
        UNSTABLE[3]
    } else {
        colour::of_line(0, 3)
    }
}

fn half_plane() -> Rgb {
    colour::pale(UNSTABLE[0], 2.0 * TINT)
}

/// Scales that hold all roots with their conjugates, and both sides of the imaginary axis.
fn scales(roots: &[[f64; 2]]) -> (Scale, Scale) {
    let fold = |of: usize, start: f64, f: fn(f64, f64) -> f64| {
        roots.iter().map(|root| root[of]).fold(start, f)
    };
    let (left, right) = (fold(0, 0.0, f64::min), fold(0, 0.0, f64::max));
    let highest = fold(1, 0.0, f64::max);
    // Roots on the axis up to rounding are drawn on it.
    let width = match right - left {
        width if width > FLAT * highest => width,
        _ if highest > 0.0 => 0.1 * highest,
        _ => 1.0,
    };
    let height = if highest > 0.0 { highest } else { width };
    (
        Scale::linear(left - 0.15 * width, right + 0.2 * width),
        Scale::linear(-1.1 * height, 1.1 * height),
    )
}

/// The number of unstable roots over the delay.
fn draw_counts(picture: &PointPicture, along: &AlongDelay, area: Area, scene: &mut Scene) {
    let tau = picture.setting.get(Parameter::Tau);
    let u = scene.unit();
    let most = along.steps.iter().map(|step| step.2).max().unwrap_or(0);
    let high = (most as f64).max(2.0);
    let step = value_scale::smallest_step(along.steps.iter().map(|step| step.2 as f64));
    let row = Row {
        scale: Scale::linear(-0.06 * high, 1.1 * high).with_smallest_step(step),
        title: vec![Rich::plain("number of unstable roots")],
    };
    let unit = suffix(&picture.units.time(), "  (", ")");
    let below = Rich::plain("delay  ").and_symbol(Parameter::Tau).and(&unit);
    let x = Scale::linear(0.0, along.until);
    let stack = Stack::new(scene, area, x, below, &[row]);
    let Some(panel) = stack.panels.first() else {
        return;
    };
    for interval in &along.stable {
        let [from, to] = [interval.from, interval.to].map(|t| panel.across(t.min(along.until)));
        let (top, bottom) = (panel.area.top, panel.area.bottom);
        scene.rect((from, top), (to, bottom), stable_delays());
    }
    stack.draw_grid(scene);
    let x = panel.across(tau);
    let line = [(x, panel.area.bottom), (x, panel.area.top)];
    scene.dashed(&line, INK, MARK_WIDTH * u, DASH);
    let stairs = along.steps.iter().flat_map(|&(from, to, n)| {
        let n = n as f64;
        [panel.at(from, n), panel.at(to, n)]
    });
    scene.path(stairs.collect(), colour::of_line(1, 3), WIDTH * u);
    if let Some(n) = picture.stability.n_unstable {
        scene.dot(panel.at(tau, n as f64), INK, DOT * u);
    }
    stack.draw_axes(scene);
}

fn stable_delays() -> Rgb {
    colour::pale(STABLE, TINT)
}

fn legend(picture: &PointPicture) -> Legend {
    let PointPicture {
        stability, along, ..
    } = picture;
    let mut entries = Vec::new();
    let mut entry = |swatch, text: &str| entries.push((swatch, Rich::plain(text)));
    let roots = &stability.spectrum.roots;
    if let Some([re, im]) = roots.first() {
        let words = ["rightmost root", "rightmost roots"][both(*im).len() - 1];
        entry(Swatch::Ring(colour_of_root(*re), RING, HOLE, DOT), words);
    }
    if roots.len() > 1 {
        let last = roots.last().map_or(INK, |root| colour_of_root(root[0]));
        let text = format!("the next ones, {} in all", number_of(roots));
        entry(Swatch::Dot(last, DOT), &text);
    }
    if stability.spectrum.certified_line.is_finite() {
        let line = Swatch::Dashed(SOFT_INK, 0.7 * MARK_WIDTH, DASH);
        entry(line, "no root is right of it, certified");
    }
    entry(Swatch::Box(half_plane()), "unstable half-plane");
    if let Some(along) = along {
        entry(Swatch::Box(stable_delays()), stable_words(along));
        let here = Swatch::Dashed(INK, MARK_WIDTH, DASH);
        entry(here, "the delay of the roots");
    }
    Legend {
        heading: Vec::new(),
        entries,
    }
}

/// How many roots are drawn.
fn number_of(roots: &[[f64; 2]]) -> usize {
    roots.iter().map(|root| both(root[1]).len()).sum()
}

fn stable_words(along: &AlongDelay) -> &'static str {
    match (along.stable.is_empty(), along.more_stable) {
        (true, _) => "stable delays: none",
        (_, true) => "stable delays; longer ones follow",
        _ => "stable delays",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_hold_both_half_planes() {
        for roots in [
            vec![],
            vec![[0.0, 0.0]],
            vec![[0.0, 1.0]],
            vec![[-0.5, 0.0], [-2.0, 40.0]],
            vec![[3.0, 0.5], [1.0, 0.0]],
            vec![[-1e-9, 1e9], [-2e-9, 3e9]],
            vec![[2.4e-6, 0.9], [2.3e-6, 0.8]],
        ] {
            let (x, y) = scales(&roots);
            assert!(x.part(0.0) > 0.02 && x.part(0.0) < 0.98, "{roots:?}");
            for [re, im] in roots {
                assert!(x.holds(re) && y.holds(im) && y.holds(-im));
            }
        }
    }
}
