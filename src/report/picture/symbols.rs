//! Places in a plane marked by a symbol: steady sliding, the best setting.

use super::legend::Swatch;
use super::panels::Panel;
use super::scene::{Point, Scene};
use super::text::Rich;
use super::view::View;
use crate::meaning::colour::{INK, PAPER};
use crate::setting::Parameter;
use crate::setting::values::Setting;
use crate::store::{MapFile, StoreError};

/// Half the size of a symbol, the width of its line, and the paper around it, in units of the
/// picture.
const SIZE: f64 = 9.0;
const WIDTH: f64 = 2.6;
const HALO: f64 = 6.5;
/// Corners of a ring.
const CORNERS: u32 = 32;

/// The kinds of symbols.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Symbol {
    /// Steady sliding at v0: a ring.
    Sliding,
    /// The setting of fastest decay: a diamond.
    Best,
}

impl Symbol {
    /// Its meaning.
    pub(super) const fn words(self) -> &'static str {
        match self {
            Self::Sliding => "even sliding at v_0",
            Self::Best => "fastest decay",
        }
    }

    /// Draws the symbol around a place.
    pub(super) fn draw(self, (x, y): Point, scene: &mut Scene) {
        let u = scene.unit();
        let corners = match self {
            Self::Sliding => CORNERS,
            Self::Best => 4,
        };
        let size = SIZE * u;
        let corner = |i: u32| {
            let angle = f64::from(i) / f64::from(corners) * std::f64::consts::TAU;
            (x + size * angle.cos(), y + size * angle.sin())
        };
        let line: Vec<Point> = (0..=corners).map(corner).collect();
        scene.path(line.clone(), PAPER, HALO * u);
        scene.path(line, INK, WIDTH * u);
    }
}

/// The symbols of a panel, with their places on its axes.
pub(super) type Placed = Vec<(Symbol, (f64, f64))>;

/// The symbols of every panel of a view with the axes (x, y).
///
/// # Errors
/// When the map cannot be read.
pub(super) fn of_view(map: &MapFile, view: &View, y: usize) -> Result<Vec<Placed>, StoreError> {
    let best = if map
        .best_plane()
        .is_some_and(|plane| [(view.x, y), (y, view.x)].contains(&plane))
    {
        map.best()?
    } else {
        Vec::new()
    };
    let swapped = map.best_plane() == Some((y, view.x));
    let of = |panel: &Vec<usize>| {
        let outer = view.outer_values(map, panel);
        let here = best
            .iter()
            .filter(|best| best.outer == outer && best.kind.is_some());
        let best = here.map(|best| match swapped {
            true => (Symbol::Best, (best.tau, best.gain)),
            false => (Symbol::Best, (best.gain, best.tau)),
        });
        let sliding = sliding_in(map, (view.x, y), panel);
        let all = best.chain(sliding.map(|at| (Symbol::Sliding, at)));
        all.filter(|(_, (at_x, at_y))| within(map, view.x, *at_x) && within(map, y, *at_y))
            .collect()
    };
    Ok(view.panels.iter().map(of).collect())
}

/// Whether a value is between the ends of an axis.
fn within(map: &MapFile, axis: usize, value: f64) -> bool {
    let mut values = map.axes()[axis].values.iter();
    let below = values.clone().any(|end| *end <= value);
    below && values.any(|end| *end >= value)
}

/// The meanings of the symbols in some panels, each once.
pub(super) fn entries(panels: &[Placed]) -> Vec<(Swatch, Rich)> {
    let all = panels.iter().flatten();
    let mut there: Vec<Symbol> = Vec::new();
    for (symbol, _) in all {
        if !there.contains(symbol) {
            there.push(*symbol);
        }
    }
    let entry = |symbol: Symbol| {
        let words = Rich::default().and_formula(symbol.words());
        (Swatch::Symbol(symbol), words)
    };
    there.into_iter().map(entry).collect()
}

/// Draws the symbols within a panel.
pub(super) fn draw(panel: &Panel, symbols: &[(Symbol, (f64, f64))], scene: &mut Scene) {
    for (symbol, (x, y)) in symbols {
        if panel.x.holds(*x) && panel.y.holds(*y) {
            symbol.draw(panel.at(*x, *y), scene);
        }
    }
}

/// The place of steady sliding in a plane of starts.
fn sliding_in(map: &MapFile, plane: (usize, usize), index: &[usize]) -> Option<(f64, f64)> {
    let parameters = [plane.0, plane.1].map(|axis| map.axes()[axis].parameter.known());
    let swapped = match parameters {
        [Some(Parameter::A0), Some(Parameter::XDot0)] => false,
        [Some(Parameter::XDot0), Some(Parameter::A0)] => true,
        _ => return None,
    };
    let mut setting = map.sweep().ok()?.fixed;
    for (axis, &i) in map.axes().iter().zip(index) {
        setting.vary(&axis.parameter, axis.values[i]);
    }
    let (elongation, velocity) = sliding(&setting)?;
    Some(match swapped {
        true => (velocity, elongation),
        false => (elongation, velocity),
    })
}

/// Elongation and velocity of steady sliding.
pub(super) fn sliding(setting: &Setting) -> Option<(f64, f64)> {
    let v0 = setting.get(Parameter::V0);
    let force = setting.sliding_point().ok()?.mu_k * setting.get(Parameter::NormalLoad);
    let elongation = force / setting.get(Parameter::Stiffness);
    (elongation.is_finite() && v0 > 0.0).then_some((elongation, v0))
}
