//! Points in NumPy arrays as lines: all delays at fixed other parameters.

use numpy::ndarray::{ArrayViewD, Axis};
use slipmap::setting::quantity::Quantity;
use slipmap::setting::{Parameter, Setting};

/// A parameter with a number at every point.
pub(crate) struct Varied {
    pub(crate) of: Quantity,
    /// The numbers, once where they are the same along an axis.
    values: Vec<f64>,
    /// For each axis the distance of neighbours among the numbers, 0 where they are the same.
    strides: Vec<usize>,
}

impl Varied {
    /// The numbers of an array.
    pub(crate) fn of(of: Quantity, mut array: ArrayViewD<f64>) -> Self {
        for axis in (0..array.ndim()).map(Axis) {
            let same = |array: &ArrayViewD<f64>| match array.axis_iter(axis).next() {
                Some(first) => array.axis_iter(axis).all(|other| other == first),
                None => false,
            };
            if array.len_of(axis) > 1 && (array.stride_of(axis) == 0 || same(&array)) {
                array.collapse_axis(axis, 0);
            }
        }
        let lengths = array.shape();
        let stride = |axis: usize| match lengths[axis] {
            1 => 0,
            _ => lengths[axis + 1..].iter().product(),
        };
        Self {
            of,
            strides: (0..lengths.len()).map(stride).collect(),
            values: array.iter().copied().collect(),
        }
    }

    /// A number that is known, another one for each place; 1 where none is.
    pub(crate) fn any(&self, place: usize) -> f64 {
        let known = self.known().count();
        let chosen = self.known().nth(place % known.max(1));
        chosen.or(self.of.default_value()).unwrap_or(1.0)
    }

    /// The numbers that are known.
    pub(crate) fn known(&self) -> impl Iterator<Item = f64> {
        self.values.iter().copied().filter(|value| !value.is_nan())
    }
}

/// The lines of a set of points.
#[derive(Default)]
pub(crate) struct Lines {
    /// The setting of each line, and the place of its first delay in `delays`.
    pub(crate) settings: Vec<(Setting, usize)>,
    /// The delays of lines, one after the other, where they are not the same.
    delays: Vec<f64>,
    /// Whether a delay is NaN.
    pub(crate) some_unknown: bool,
    /// The delays with 0 in the place of NaN; empty where no delay is NaN.
    known: Vec<f64>,
    /// How many delays each line has.
    pub(crate) length: usize,
    /// The first point of each line, in the order of `settings`.
    pub(crate) first: Vec<usize>,
    /// The distance of the points of a line from its first one.
    pub(crate) along: Vec<usize>,
}

impl Lines {
    /// The lines of the points at which `varied` has numbers, all of the same shape. All else is
    /// that of `setting`. Lines with a number that is NaN have no setting: they are left out.
    pub(crate) fn of(setting: &Setting, varied: &[Varied], shape: &[usize]) -> Self {
        if shape.contains(&0) {
            return Self::default();
        }
        let is_delay = |of: &Varied| of.of == Parameter::Tau;
        let (inner, outer): (Vec<usize>, Vec<usize>) = (0..shape.len()).partition(|&axis| {
            let mut all = varied.iter();
            all.all(|of| of.strides[axis] == 0 || is_delay(of))
        });
        let along = places(&inner, shape);
        let delay = varied.iter().position(is_delay);
        let offsets = |of: &[usize], at: usize| {
            let lengths = of
                .iter()
                .map(|&axis| (shape[axis], varied[at].strides[axis]));
            combined(lengths)
        };
        let inside = delay.map(|at| offsets(&inner, at));
        let outside: Vec<Vec<usize>> = (0..varied.len()).map(|at| offsets(&outer, at)).collect();
        let shared = delay.is_none_or(|at| outside[at].iter().all(|offset| *offset == 0));
        let fixed = setting.get(Parameter::Tau);
        let fill = |delays: &mut Vec<f64>, line: usize| match (delay, &inside) {
            (Some(at), Some(inside)) => {
                let origin = outside[at][line];
                delays.extend(inside.iter().map(|i| varied[at].values[origin + i]));
            }
            _ => delays.resize(delays.len() + along.len(), fixed),
        };
        let (mut delays, mut settings, mut first) = (Vec::new(), Vec::new(), Vec::new());
        if shared {
            fill(&mut delays, 0);
        }
        for (line, place) in places(&outer, shape).into_iter().enumerate() {
            let mut at_line = setting.clone();
            let mut known = true;
            for (at, of) in varied.iter().enumerate().filter(|(_, of)| !is_delay(of)) {
                let value = of.values[outside[at][line]];
                known &= !value.is_nan();
                at_line.vary(&of.of, value);
            }
            if !known {
                continue;
            }
            let begin = if shared { 0 } else { delays.len() };
            if !shared {
                fill(&mut delays, line);
            }
            settings.push((at_line, begin));
            first.push(place);
        }
        let some_unknown = delays.iter().any(|delay| delay.is_nan());
        let known = |delay: &f64| if delay.is_nan() { 0.0 } else { *delay };
        Self {
            known: delays.iter().map(known).filter(|_| some_unknown).collect(),
            delays,
            some_unknown,
            length: along.len(),
            settings,
            first,
            along,
        }
    }
}

impl Lines {
    /// The delays of a line.
    pub(crate) fn delays(&self, line: usize) -> &[f64] {
        &self.delays[self.settings[line].1..][..self.length]
    }

    /// The delays of a line that are computed: 0 for those that are NaN.
    pub(crate) fn computed(&self, line: usize) -> &[f64] {
        match self.some_unknown {
            true => &self.known[self.settings[line].1..][..self.length],
            false => self.delays(line),
        }
    }
}

/// The place of every index of some axes in an array of this shape, the last axis fastest.
fn places(of: &[usize], shape: &[usize]) -> Vec<usize> {
    let step = |axis: usize| shape[axis + 1..].iter().product::<usize>();
    combined(of.iter().map(|&axis| (shape[axis], step(axis))))
}

/// The sum of steps at every index of axes with these lengths and steps, the last axis fastest.
fn combined(axes: impl Iterator<Item = (usize, usize)>) -> Vec<usize> {
    axes.fold(vec![0], |so_far, (length, step)| {
        let along = |from: usize| (0..length).map(move |i| from + i * step);
        so_far.into_iter().flat_map(along).collect()
    })
}
