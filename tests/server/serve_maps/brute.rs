//! Windows on a map as they should be, by looking at every cell for every pixel.

use serde_json::Value;
use slipmap::linear::status::AMISS;
use slipmap::setting::Field;
use slipmap::store::MapFile;

use super::decoded::Decoded;
use crate::server::Serving;

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

/// What a pixel is of.
struct Pixel {
    nearest: usize,
    inside: Vec<usize>,
    beyond: bool,
}

/// The nearest cell to each pixel, the cells inside it, and whether it lies beyond them: by more
/// than half way to the neighbour of the last.
fn pixels(values: &[f64], ends: Option<(f64, f64)>, count: usize, scale: &str) -> Vec<Pixel> {
    let coordinate = |value: f64| match scale {
        "log" => value.abs().ln() * value.signum(),
        _ => value,
    };
    let mut sorted: Vec<f64> = values.iter().map(|&value| coordinate(value)).collect();
    sorted.sort_by(f64::total_cmp);
    let reach = match sorted[..] {
        [_] => (f64::NEG_INFINITY, f64::INFINITY),
        [first, second, ..] => {
            let [.., before, last] = sorted[..] else {
                unreachable!()
            };
            (first - (second - first) / 2.0, last + (last - before) / 2.0)
        }
        [] => unreachable!(),
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
        let inside: Vec<usize> = (0..values.len()).filter(inside).collect();
        Pixel {
            nearest: nearest.unwrap(),
            beyond: inside.is_empty() && !(reach.0..=reach.1).contains(&centre),
            inside,
        }
    };
    (0..count).map(pixel).collect()
}

/// What of a status says that something is amiss, for every cell of a map.
fn amiss(map: &MapFile) -> impl Fn(&[usize]) -> u8 {
    let file = hdf5::File::open(map.path()).unwrap();
    let all = file.dataset("status").unwrap().read_raw::<u8>().unwrap();
    let shape: Vec<usize> = map.axes().iter().map(|axis| axis.values.len()).collect();
    move |index| {
        let place = index
            .iter()
            .zip(&shape)
            .fold(0, |place, (i, n)| place * n + i);
        all[place] & AMISS
    }
}

/// All of a window is as it should be; how many of its pixels hide something.
#[track_caller]
pub(crate) fn check(serving: &Serving, id: &str, map: &MapFile, window: &Window) -> usize {
    let path = window.path(id, map);
    let told = complete(serving, &path);
    let numbers = |array: &Value| told.numbers(array);
    let along =
        |axis: usize, ends, count, scale| pixels(&map.axes()[axis].values, ends, count, scale);
    let across = along(window.x, window.x_ends, window.size.0, window.scales.0);
    let up = match window.y {
        Some(y) => along(y, window.y_ends, window.size.1, window.scales.1),
        None => vec![Pixel {
            nearest: 0,
            inside: vec![0],
            beyond: false,
        }],
    };
    let (row, column) = (window.y.unwrap_or(window.x), window.x);
    let plane = map
        .plane(window.field, &window.at, (row, column), usize::MAX)
        .unwrap();
    let cell = |x: usize, y: usize| plane.cells[y * plane.columns.len() + x];
    let amiss = amiss(map);
    let amiss = |x: usize, y: usize| {
        let mut at = window.at.clone();
        at[row] = y;
        at[column] = x;
        amiss(&at)
    };
    let (values, bits) = (numbers(&told.head["values"]), numbers(&told.head["bits"]));
    let index = numbers(&told.head["x"]["index"]);
    assert_eq!(values.len(), across.len() * up.len());
    let mut hiding = 0;
    for (ix, x) in across.iter().enumerate() {
        assert_eq!(index[ix], x.nearest as f64, "{path} {ix}");
        for (iy, y) in up.iter().enumerate() {
            let (place, at) = (ix * up.len() + iy, format!("{path} {ix} {iy}"));
            let found = values[place];
            let is_fill = found.is_nan() || found == 255.0 || found == 65535.0;
            if x.beyond || y.beyond {
                assert!(is_fill && bits[place] == 8.0, "{at}: {found}");
                continue;
            }
            let expected = cell(x.nearest, y.nearest);
            let fits = found == expected || expected.is_nan() && is_fill;
            assert!(fits, "{at}: {found} {expected}");
            let inside = x.inside.iter();
            let inside = inside.flat_map(|&x| y.inside.iter().map(move |&y| (x, y)));
            let mut values = inside.clone().map(|(x, y)| cell(x, y).to_bits());
            let first = values.next();
            let shows_sound = amiss(x.nearest, y.nearest) == 0;
            let several = values.any(|other| Some(other) != first)
                || shows_sound && inside.clone().any(|(x, y)| amiss(x, y) != 0);
            assert_eq!(bits[place], f64::from(u8::from(several)), "{at}");
            hiding += usize::from(several);
        }
    }
    let shown = told.head["y"]["index"]
        .as_object()
        .map(|_| numbers(&told.head["y"]["index"]));
    let mut all = shown.iter().flatten().zip(&up);
    assert!(all.all(|(i, y)| *i == y.nearest as f64), "{path}");
    hiding
}
