//! Units of states, signals and time in which the numbers of a system are of one size. All are
//! powers of two: no digit changes.

use super::MatrixSystem;

impl MatrixSystem {
    /// The same system with states in units that make rows and columns of one size. The units are
    /// powers of two: no digit changes.
    pub(super) fn balanced(mut self) -> Self {
        const ROUNDS: usize = 64;
        let n = self.states();
        for _ in 0..ROUNDS {
            let mut changed = false;
            for i in 0..n {
                let others =
                    |of: &dyn Fn(usize) -> f64| -> f64 { (0..n).filter(|&j| j != i).map(of).sum() };
                let signals = 0..self.signals();
                let row = others(&|j| self.a.at(i, j).abs())
                    + signals.clone().map(|k| self.b.at(i, k).abs()).sum::<f64>();
                let column = others(&|j| self.a.at(j, i).abs())
                    + signals.map(|k| self.c.at(k, i).abs()).sum::<f64>();
                let unit = power_of_two(row, column);
                if unit != 1.0 {
                    changed = true;
                    self.scale_state(i, unit);
                }
            }
            for k in 0..self.signals() {
                let input: f64 = (0..n).map(|i| self.b.at(i, k).abs()).sum();
                let output: f64 = (0..n).map(|i| self.c.at(k, i).abs()).sum();
                // A signal in units `unit` times as large: its row shrinks, its column grows.
                let unit = power_of_two(output, input);
                if unit != 1.0 {
                    changed = true;
                    self.scale_signal(k, unit);
                }
            }
            if !changed {
                break;
            }
        }
        self
    }

    fn scale_state(&mut self, i: usize, unit: f64) {
        for j in 0..self.states() {
            if j != i {
                self.a.set(i, j, self.a.at(i, j) / unit);
                self.a.set(j, i, self.a.at(j, i) * unit);
            }
        }
        for k in 0..self.signals() {
            self.b.set(i, k, self.b.at(i, k) / unit);
            self.c.set(k, i, self.c.at(k, i) * unit);
        }
    }

    fn scale_signal(&mut self, k: usize, unit: f64) {
        for i in 0..self.states() {
            self.b.set(i, k, self.b.at(i, k) * unit);
            self.c.set(k, i, self.c.at(k, i) / unit);
        }
        for other in (0..self.signals()).filter(|&other| other != k) {
            self.d.set(k, other, self.d.at(k, other) / unit);
            self.d.set(other, k, self.d.at(other, k) * unit);
        }
    }

    /// The unit of time in which its largest rates are about 1, a power of two.
    pub(super) fn time_unit(&self) -> f64 {
        let size = self.bound();
        power_of_two(1.0, size * size)
    }

    /// This system with times in units of `unit`, a power of two: a root λ of this one is a root
    /// λ·`unit` there.
    pub(super) fn in_unit(mut self, unit: f64) -> Self {
        self.a = self.a.mapped(|value| unit * value);
        self.b = self.b.mapped(|value| unit * value);
        self.balanced()
    }
}

/// The power of two nearest to √(large/small), where it makes both of one size.
fn power_of_two(large: f64, small: f64) -> f64 {
    let ratio = large / small;
    if !(ratio.is_finite() && ratio > 0.0) || (0.25..=4.0).contains(&ratio) {
        return 1.0;
    }
    let (mut unit, mut left) = (1.0, ratio);
    while left >= 2.0 {
        (unit, left) = (2.0 * unit, 0.25 * left);
    }
    while left <= 0.5 {
        (unit, left) = (0.5 * unit, 4.0 * left);
    }
    unit
}
