//! A friction law among the points to which it was fitted, with what they leave open of it.

use super::legend::{Legend, Swatch};
use super::page;
use super::panels::Panel;
use super::scene::{Point, Scene};
use super::stack::{Row, Stack};
use super::text::{Rich, assignment, suffix};
use crate::fit::FittedLaw;
use crate::meaning::colour::{self, SOFT_INK, STABLE_TINT};
use crate::meaning::numbers::with_minus;
use crate::meaning::scale::Scale;
use crate::report::numbers::with_error;
use crate::setting::Parameter;
use crate::setting::measured::{Direction, MeasuredPoint};
use crate::setting::units::Units;

const WIDTH: f64 = 3.2;
/// Diameters of points, and of the holes in those of the other direction.
const DOT: f64 = 11.0;
const HOLE: f64 = 5.0;
const DASH: (f64, f64) = (9.0, 7.0);
/// Width of the line at v0.
const MARK: f64 = 2.0;

/// A fit with its points.
#[derive(Debug, Clone, Copy)]
pub struct FitPicture<'a> {
    /// What was fitted.
    pub fit: &'a FittedLaw,
    /// The points, by velocity.
    pub points: &'a [MeasuredPoint],
    /// The units of their velocities.
    pub units: &'a Units,
    /// What stands above the picture.
    pub title: &'a str,
}

/// Draws a fit.
pub(super) fn draw(of: &FitPicture, scene: &mut Scene) {
    let u = scene.unit();
    let mut body = page::head(scene, of.title, &notes(of));
    let legend = legend(of);
    let column = body.cut_right(legend.width(u), 30.0 * u);
    let (x, y) = scales(of);
    let below = format!(
        "sliding velocity{}",
        suffix(&of.units.of_parameter(Parameter::V0), "  (", ")")
    );
    let row = Row {
        scale: y,
        title: vec![Rich::default().and_formula("friction coefficient  μ_K")],
    };
    let stack = Stack::new(scene, body, x, Rich::plain(&below), &[row]);
    stack.draw_grid(scene);
    if let Some(panel) = stack.panels.first() {
        draw_curve(of, panel, scene);
        draw_points(of.points, panel, scene);
        legend.draw(
            scene,
            page::Area {
                top: panel.area.top,
                ..column
            },
        );
    }
    stack.draw_axes(scene);
}

/// The law, its slope with its error, and the noise.
fn notes(of: &FitPicture) -> Vec<Rich> {
    let mut notes = vec![Rich::plain(&format!("law: {}", of.fit.law))];
    let unit = |parameter| of.units.of_parameter(parameter);
    let v0 = of.fit.setting.get(Parameter::V0);
    notes.push(assignment(Parameter::V0, v0, &unit(Parameter::V0)));
    if let Ok(Some(sliding)) = of.fit.setting.fitted_sliding() {
        let unit = unit(Parameter::MuPrime);
        let (value, error) = with_error(sliding.at.mu_prime, sliding.mu_prime_error);
        let value = with_minus(&value);
        let text = format!(" = {value} ± {error}{}", suffix(&unit, " ", ""));
        notes.push(Rich::symbol(Parameter::MuPrime).and(&text));
    }
    notes
}

/// Scales that hold points and band.
fn scales(of: &FitPicture) -> (Scale, Scale) {
    let last = of.points.last().map_or(1.0, |point| point.speed);
    let v0 = of.fit.setting.get(Parameter::V0);
    let reach = of.fit.errors_in_interval();
    let band = of.fit.band.iter();
    let ends = band.flat_map(|at| [at.mu_k - reach * at.error, at.mu_k + reach * at.error]);
    let all = of.points.iter().map(|point| point.mu_k).chain(ends);
    let (low, high) = all.fold((f64::INFINITY, 0.0), |(low, high): (f64, f64), mu| {
        (low.min(mu), high.max(mu))
    });
    let room = 0.06 * (high - low).max(1e-3 * high);
    let x = Scale::linear(0.0, 1.03 * last.max(v0));
    (x, Scale::linear((low - room).max(0.0), high + room))
}

fn draw_curve(of: &FitPicture, panel: &Panel, scene: &mut Scene) {
    let u = scene.unit();
    let reach = of.fit.errors_in_interval();
    let within = |mu: f64| panel.up(mu).clamp(panel.area.top, panel.area.bottom);
    let slice = |at: &crate::fit::Band| {
        let ends = [at.mu_k - reach * at.error, at.mu_k + reach * at.error];
        let [low, high] = ends.map(within);
        (panel.across(at.speed), high, low)
    };
    let slices = of.fit.band.iter().map(slice).collect();
    scene.band(slices, STABLE_TINT);
    let curve: Vec<Point> = of
        .fit
        .band
        .iter()
        .map(|at| (panel.across(at.speed), within(at.mu_k)))
        .collect();
    let v0 = panel.across(of.fit.setting.get(Parameter::V0));
    let line = [(v0, panel.area.bottom), (v0, panel.area.top)];
    scene.dashed(&line, SOFT_INK, MARK * u, DASH);
    scene.path(curve, colour::of_line(0, 3), WIDTH * u);
}

fn draw_points(points: &[MeasuredPoint], panel: &Panel, scene: &mut Scene) {
    let u = scene.unit();
    for point in points {
        let at = panel.at(point.speed, point.mu_k);
        match point.direction {
            Direction::Forward => scene.dot(at, SOFT_INK, DOT * u),
            Direction::Backward => scene.ring(at, SOFT_INK, (DOT * u, HOLE * u)),
        }
    }
}

fn legend(of: &FitPicture) -> Legend {
    let backward = |point: &MeasuredPoint| point.direction == Direction::Backward;
    let mut entries = Vec::new();
    let (some_backward, all_backward) = (
        of.points.iter().any(backward),
        of.points.iter().all(backward),
    );
    if !all_backward {
        let name = if some_backward { "forward" } else { "measured" };
        entries.push((Swatch::Dot(SOFT_INK, DOT), Rich::plain(name)));
    }
    if some_backward {
        let ring = Swatch::Ring(SOFT_INK, DOT, HOLE, 0.0);
        entries.push((ring, Rich::plain("backward")));
    }
    let line = Swatch::Line(colour::of_line(0, 3), WIDTH, Some(STABLE_TINT));
    entries.push((line, Rich::plain("fitted, with 95 % band")));
    let v0 = Swatch::Dashed(SOFT_INK, MARK, DASH);
    entries.push((v0, Rich::symbol(Parameter::V0)));
    Legend {
        heading: Vec::new(),
        entries,
    }
}
