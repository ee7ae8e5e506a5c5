//! Where |P| and κ|Q| change places on a vertical line: the positive zeros of F_σ.
//!
//! Each is given with what is not known of it. Zeros that rounding does not tell apart come as one,
//! which counts by the change of sign of F across all of them.

use super::polynomial::Polynomial;
use super::zeros::{Set, Zeros};
use crate::model::elementary::pow;

/// A positive zero of F, or several that cannot be told apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Switch {
    /// Its frequency ω = √x.
    pub omega: f64,
    /// A bound on the error of ω.
    pub error: f64,
    /// Half the change of the sign of F with growing x.
    pub sign: i8,
    /// It is one zero and simple.
    pub simple: bool,
}

/// The positive zeros of F by falling frequency.
#[derive(Debug, Clone, Default)]
pub(super) struct Switches {
    /// Them.
    pub list: Vec<Switch>,
    /// The sign of F right of 0; none where zeros near 0 leave it open.
    pub at_zero: Option<bool>,
    /// Below this frequency there may be further zeros.
    pub open_below: f64,
}

impl Switches {
    /// Of the polynomial `f` in x = ω². F(0) is taken for 0 exactly where it may be 0.
    ///
    /// Returns false, and leaves nothing known, where the highest coefficient may be 0.
    pub(super) fn find(&mut self, f: &Polynomial) -> bool {
        self.list.clear();
        self.open_below = 0.0;
        self.at_zero = None;
        if !f.leading().decided() {
            return false;
        }
        let mut rest = *f;
        if !f.coefficient(0).decided() && f.degree() > 0 {
            // A zero at 0 itself, or so near that nothing tells it from there.
            self.open_below = near_zero(f);
            rest = f.divided_by_variable();
        }
        let zeros = Zeros::of(&rest);
        self.add_sets(&rest, &zeros);
        true
    }

    fn add_sets(&mut self, f: &Polynomial, zeros: &Zeros) {
        let mut sets: [Option<(f64, f64, Set)>; super::polynomial::MOST_DEGREE] =
            [None; super::polynomial::MOST_DEGREE];
        let mut count = 0;
        for set in zeros.sets() {
            if let Some((from, to)) = set.on_real_axis().filter(|(_, to)| *to > 0.0) {
                sets[count] = Some((from, to, set));
                count += 1;
            }
        }
        sets[..count].sort_by(|a, b| {
            let middle = |s: &Option<(f64, f64, Set)>| s.map_or(0.0, |(from, to, _)| from + to);
            middle(b).total_cmp(&middle(a))
        });
        let mut positive = f.leading().value > 0.0;
        let constant = f.coefficient(0);
        for (from, to, set) in sets[..count].iter().flatten() {
            let odd = set.count() % 2 == 1;
            if *from <= 0.0 {
                // It covers 0: only the signs tell how many zeros lie right of it.
                self.open_below = self.open_below.max(to.sqrt());
                if !constant.decided() {
                    return;
                }
                let before = constant.value > 0.0;
                self.list.push(switch((0.0, *to), None, (before, positive)));
                positive = before;
                continue;
            }
            let before = positive ^ odd;
            let lone = (set.count() == 1).then(|| set.middle().re);
            self.list
                .push(switch((*from, *to), lone, (before, positive)));
            positive = before;
        }
        self.at_zero = Some(positive);
    }
}

/// The switch within `from` < x < `to`, at `centre` if that is known, where F changes from one sign
/// to the other.
fn switch((from, to): (f64, f64), centre: Option<f64>, (before, after): (bool, bool)) -> Switch {
    let (low, high) = (from.max(0.0).sqrt(), to.sqrt());
    let omega = centre.map_or(0.5 * (low + high), f64::sqrt);
    let error = (high - omega).max(omega - low) + f64::EPSILON * omega;
    Switch {
        omega,
        error,
        sign: direction(before, after),
        simple: centre.is_some(),
    }
}

/// Half the change of the sign of F, positive or not.
pub(super) const fn direction(before: bool, after: bool) -> i8 {
    after as i8 - before as i8
}

/// A frequency beyond which the error of F(0) moves no zero that is near 0.
fn near_zero(f: &Polynomial) -> f64 {
    let constant = f.coefficient(0);
    let most = constant.value.abs() + constant.error;
    if most == 0.0 {
        return 0.0;
    }
    // |c_k| xᵏ outweighs it from there on, for the first k of which the sign is known.
    (1..=f.degree())
        .map(|k| (k, f.coefficient(k)))
        .filter(|(_, c)| c.decided())
        .map(|(k, c)| pow(2.0 * most / (c.value.abs() - c.error), 0.5 / k as f64))
        .fold(f64::INFINITY, f64::min)
        .min(1e300)
}
