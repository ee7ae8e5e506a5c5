//! Windows on a map as they should be, by looking at every cell for every pixel.

use serde_json::Value;
use slipmap::store::MapFile;
use slipmap::sweep::Field;

use super::decoded::Decoded;
use super::server::Serving;

/// A window that is asked for.
#[derive(Debug, Clone)]
pub(crate) struct Window<'a> {
    pub field: Field,
    pub x: usize,
    pub y: Option<usize>,
    pub at: Vec<usize>,
    pub x_ends: Option<(f64, f64)>,
    pub y_ends: Option<(f64, f64)>,
    pub size: (usize, usize),
    pub scales: (&'a str, &'a str),
}

impl Window<'_> {
    /// Its address.
    pub(crate) fn path(&self, id: &str, map: &MapFile) -> String {
        let name = |axis: usize| map.axes()[axis].parameter.name();
        let field = self.field.name();
        let mut path = format!("/api/v1/maps/{id}/window?field={field}&x={}", name(self.x));
        if let Some(y) = self.y {
            path += &format!("&y={}", name(y));
        }
        let others = (0..map.axes().len()).filter(|&a| a != self.x && Some(a) != self.y);
        let at: Vec<String> = others
            .map(|a| format!("{}:{}", name(a), self.at[a]))
            .collect();
        path += &format!("&at={}&w={}&h={}", at.join(","), self.size.0, self.size.1);
        path += &format!("&xscale={}&yscale={}", self.scales.0, self.scales.1);
        for (axis, ends) in [("x", self.x_ends), ("y", self.y_ends)] {
            if let Some((from, to)) = ends {
                path += &format!("&{axis}0={from:?}&{axis}1={to:?}");
            }
        }
        path
    }
}

/// Asks until the window is complete.
pub(crate) fn complete(serving: &Serving, path: &str) -> Decoded {
    for _ in 0..200 {
        let window = Decoded::of(&serving.get(path));
        if window.head["complete"] == true {
            return window;
        }
    }
    panic!("{path} is never complete");
}

/// The nearest cell to each pixel, and the cells inside it.
fn pixels(
    values: &[f64],
    ends: Option<(f64, f64)>,
    count: usize,
    scale: &str,
) -> Vec<(usize, Vec<usize>)> {
    let coordinate = |value: f64| match scale {
        "log" => value.abs().ln() * value.signum(),
        _ => value,
    };
    let (from, to) = ends.unwrap_or((values[0], values[values.len() - 1]));
    let (a, b) = (coordinate(from), coordinate(to));
    let at = |part: f64| a + (b - a) * (part / count as f64);
    let pixel = |number: usize| {
        let centre = at(number as f64 + 0.5);
        let distance = |i: &usize| (coordinate(values[*i]) - centre).abs();
        let nearest = (0..values.len()).min_by(|i, j| distance(i).total_cmp(&distance(j)));
        let (mut low, mut high) = (at(number as f64), at(number as f64 + 1.0));
        let last = number + 1 == count;
        let rises = low <= high;
        if !rises {
            (low, high) = (high, low);
        }
        let inside = |i: &usize| {
            let u = coordinate(values[*i]);
            (low < u && u < high)
                || u == if rises { low } else { high }
                || (last && u == coordinate(to))
        };
        (nearest.unwrap(), (0..values.len()).filter(inside).collect())
    };
    (0..count).map(pixel).collect()
}

/// All of a window is as it should be.
#[track_caller]
pub(crate) fn check(serving: &Serving, id: &str, map: &MapFile, window: &Window) {
    let path = window.path(id, map);
    let told = complete(serving, &path);
    let numbers = |array: &Value| told.numbers(array);
    let along =
        |axis: usize, ends, count, scale| pixels(&map.axes()[axis].values, ends, count, scale);
    let across = along(window.x, window.x_ends, window.size.0, window.scales.0);
    let up = match window.y {
        Some(y) => along(y, window.y_ends, window.size.1, window.scales.1),
        None => vec![(0, vec![0])],
    };
    let (row, column) = (window.y.unwrap_or(window.x), window.x);
    let plane = map
        .plane(window.field, &window.at, (row, column), usize::MAX)
        .unwrap();
    let cell = |x: usize, y: usize| plane.cells[y * plane.columns.len() + x];
    let (values, bits) = (numbers(&told.head["values"]), numbers(&told.head["bits"]));
    let index = numbers(&told.head["x"]["index"]);
    assert_eq!(values.len(), across.len() * up.len());
    let mut hiding = 0;
    for (ix, (x, xs)) in across.iter().enumerate() {
        assert_eq!(index[ix], *x as f64, "{path} {ix}");
        for (iy, (y, ys)) in up.iter().enumerate() {
            let place = ix * up.len() + iy;
            let (found, expected) = (values[place], cell(*x, *y));
            let fill = expected.is_nan() && (found.is_nan() || found == 255.0 || found == 65535.0);
            assert!(
                found == expected || fill,
                "{path} {ix} {iy}: {found} {expected}"
            );
            let hidden = || {
                xs.iter()
                    .flat_map(|&x| ys.iter().map(move |&y| cell(x, y).to_bits()))
            };
            let several = hidden().any(|bits| Some(bits) != hidden().next());
            assert_eq!(bits[place] as u8 & 1 != 0, several, "{path} {ix} {iy}");
            hiding += usize::from(several);
        }
    }
    let all = across.len() * up.len();
    let shown = told.head["y"]["index"]
        .as_object()
        .map(|_| numbers(&told.head["y"]["index"]));
    assert!(shown.is_none_or(|shown| shown.iter().zip(&up).all(|(i, (y, _))| *i == *y as f64)));
    assert!(
        hiding <= all && bits.iter().all(|bits| *bits as u8 & !1 == 0),
        "{path}"
    );
}
