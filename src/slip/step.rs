//! One step of a motion: polynomials in the time since its start, how they follow from the
//! equations, and what can be read off them.

use crate::model::Dashpots;
use crate::model::law::Series;
use crate::model::series::{
    Coefficients, MOST_ORDER, PER_NEXT, first_zero, largest, shifted, spread, value,
};

/// The polynomials of one step, of the time since its start.
#[derive(Debug, Clone)]
pub struct Step {
    /// Length.
    pub length: f64,
    /// For how long the polynomials hold to the tolerance.
    pub(super) radius: f64,
    pub(super) order: usize,
    pub(super) u: Coefficients,
    pub(super) a: Coefficients,
    pub(super) n: Coefficients,
    /// The pull of spring and dashpot, a + d ȧ.
    pub(super) force: Coefficients,
    /// a(t−τ), less R S(t−τ) where the feedback has memory.
    pub(super) delayed: Coefficients,
    /// S(t) where the feedback has a latency; else meaningless.
    pub(super) late: Coefficients,
    /// Whether the feedback has a latency.
    pub(super) is_late: bool,
    /// The pulling velocity without S, its slope, and the part of S that is added to it.
    pub(super) pull: (f64, f64, f64),
}

impl Step {
    /// A step of no length, at rest.
    pub(super) const NONE: Self = Self {
        length: 0.0,
        radius: 0.0,
        order: 0,
        u: [0.0; MOST_ORDER + 1],
        a: [0.0; MOST_ORDER + 1],
        n: [0.0; MOST_ORDER + 1],
        force: [0.0; MOST_ORDER + 1],
        delayed: [0.0; MOST_ORDER + 1],
        late: [0.0; MOST_ORDER + 1],
        is_late: false,
        pull: (0.0, 0.0, 0.0),
    };

    pub(super) fn range(c: &Coefficients, order: usize) -> &[f64] {
        &c[..=order]
    }

    /// `c` times `factor`, with `shift` added to it.
    pub(super) fn scaled(c: &Coefficients, factor: f64, shift: f64) -> Coefficients {
        let mut scaled = c.map(|c| factor * c);
        scaled[0] += shift;
        scaled
    }

    /// ẋ, a and N at `s` since the start of the step.
    #[must_use]
    pub fn state(&self, s: f64) -> (f64, f64, f64) {
        let at = |c| value(Self::range(c, self.order), s);
        (at(&self.u), at(&self.a), at(&self.n))
    }

    /// The pulling velocity at `s`.
    #[must_use]
    pub fn velocity(&self, s: f64) -> f64 {
        let (v0, slope, alpha_v) = self.pull;
        v0 + slope * s + alpha_v * self.fed_back(s)
    }

    /// S at `s`, which is fed back: a(t) − a(t−τ), with its memory and latency. Meaningless before
    /// control acts.
    #[must_use]
    pub fn fed_back(&self, s: f64) -> f64 {
        let at = |c| value(Self::range(c, self.order), s);
        match self.is_late {
            true => value(&self.late, s),
            false => at(&self.a) - at(&self.delayed),
        }
    }

    /// S, as far as the order of the step.
    pub(super) fn signal(&self) -> Coefficients {
        if self.is_late {
            return self.late;
        }
        let mut signal = self.a;
        for (signal, delayed) in signal.iter_mut().zip(&self.delayed) {
            *signal -= delayed;
        }
        signal
    }

    /// S at the start of a step from the elongation `a`.
    pub(super) fn fed_back_at_start(&self, a: f64) -> f64 {
        match self.is_late {
            true => self.late[0],
            false => a - self.delayed[0],
        }
    }

    /// Becomes the step of no length at its own end.
    pub(super) fn move_to_end(&mut self) {
        let (length, order) = (self.length, self.order);
        let Self {
            u,
            a,
            n,
            force,
            delayed,
            late,
            ..
        } = self;
        for c in [u, a, n, force] {
            *c = shifted(&c[..=order], length);
        }
        for c in [delayed, late] {
            *c = shifted(&c[..], length);
        }
        self.pull.0 += self.pull.1 * length;
        self.length = 0.0;
    }

    /// ẋ and the acceleration at the start of the step.
    pub(super) fn start(&self) -> (f64, f64) {
        (self.u[0], self.u[1])
    }

    /// The displacement since the start of the step at `s`.
    #[must_use]
    pub fn displacement(&self, s: f64) -> f64 {
        self.integral(&self.u, s)
    }

    /// The integral of the elongation over the whole step.
    pub(super) fn integral_of_elongation(&self) -> f64 {
        self.integral(&self.a, self.length)
    }

    /// The integral of `c` from the start of the step to `s`.
    fn integral(&self, c: &Coefficients, s: f64) -> f64 {
        let mut mean = [0.0; MOST_ORDER + 1];
        for (mean, (c, per_next)) in mean.iter_mut().zip(c.iter().zip(&PER_NEXT)) {
            *mean = c * per_next;
        }
        s * value(Self::range(&mean, self.order), s)
    }

    /// The smaller one of `known` and the smallest load of the step.
    #[must_use]
    pub(super) fn smallest_load(&self, known: f64) -> f64 {
        if self.n[0] - spread(Self::range(&self.n, self.order), self.length) >= known {
            return known;
        }
        let flipped = Self::scaled(&self.n, -1.0, 0.0);
        -largest(Self::range(&flipped, self.order), self.length, -known)
    }

    /// The larger one of `known` and the largest force of the step, |a + d ȧ|.
    #[must_use]
    pub(crate) fn largest_force(&self, known: f64) -> f64 {
        self.farthest(&self.force, 0.0, known)
    }

    /// The smallest and the largest |ẋ| of the step, or those `known` where they are beyond.
    #[must_use]
    pub(crate) fn speeds(&self, [least, most]: [f64; 2]) -> [f64; 2] {
        let u = Self::range(&self.u, self.order);
        let most = self.farthest(&self.u, 0.0, most);
        if u[0].abs() - spread(u, self.length) >= least {
            return [least, most];
        }
        // ẋ keeps its sign in a step.
        let direction = value(u, 0.5 * self.length).signum();
        let back = Self::scaled(&self.u, -direction, 0.0);
        let slowest = -largest(Self::range(&back, self.order), self.length, -least);
        [slowest.max(0.0), most]
    }

    /// a + d ȧ at the end of the step.
    pub(super) fn force_at_end(&self) -> f64 {
        value(Self::range(&self.force, self.order), self.length)
    }

    /// The largest |ẋ − `v0`| or |a − `rest`| of the step, or `known` if that is larger.
    #[must_use]
    pub(crate) fn deviation(&self, (v0, rest): (f64, f64), known: f64) -> f64 {
        let one = self.farthest(&self.u, v0, known);
        self.farthest(&self.a, rest, one)
    }

    /// The largest distance of `c` from `centre`, or `known` if that is larger.
    fn farthest(&self, c: &Coefficients, centre: f64, known: f64) -> f64 {
        if (c[0] - centre).abs() + spread(Self::range(c, self.order), self.length) <= known {
            return known;
        }
        [1.0, -1.0].iter().fold(known, |found, factor| {
            let c = Self::scaled(c, *factor, -factor * centre);
            largest(Self::range(&c, self.order), self.length, found)
        })
    }

    /// The last time in the step at which |ẋ − `v0`| exceeds `band`; none if it never does.
    #[must_use]
    pub(crate) fn last_outside(&self, v0: f64, band: f64) -> Option<f64> {
        let u = Self::range(&self.u, self.order);
        if (u[0] - v0).abs() + spread(u, self.length) <= band {
            return None;
        }
        if (value(u, self.length) - v0).abs() > band {
            return Some(self.length);
        }
        // Backwards from the end.
        let mut reversed = shifted(u, self.length);
        reversed
            .iter_mut()
            .skip(1)
            .step_by(2)
            .for_each(|c| *c = -*c);
        let crossing = |factor: f64| {
            let room = Self::scaled(&reversed, -factor, band + factor * v0);
            first_zero(Self::range(&room, self.order), self.length)
        };
        let back = [crossing(1.0), crossing(-1.0)].into_iter().flatten();
        let back = back.fold(f64::INFINITY, f64::min);
        back.is_finite().then_some(self.length - back)
    }
}

/// What acts in a step: v = `v0` + `slope` s + `alpha_v` S, s after its start, n = `load` +
/// `alpha_n` S, and the dashpots. An actuator at a limit has that limit and no gain.
#[derive(Debug, Clone, Copy)]
pub(super) struct Control {
    pub v0: f64,
    pub slope: f64,
    pub load: f64,
    pub alpha_v: f64,
    pub alpha_n: f64,
    pub dashpots: Dashpots,
}

impl Control {
    /// v without S, its slope, and the part of S.
    pub(super) fn pull(&self) -> (f64, f64, f64) {
        (self.v0, self.slope, self.alpha_v)
    }
}

impl Step {
    /// Fills coefficient `k` of the load and of the force, and returns that of ȧ.
    #[inline(always)]
    fn controlled(&mut self, control: Control, k: usize) -> f64 {
        let difference = match self.is_late {
            true => self.late[k],
            false => self.a[k] - self.delayed[k],
        };
        let (v0, load) = match k {
            0 => (control.v0, control.load),
            1 => (control.slope, 0.0),
            _ => (0.0, 0.0),
        };
        self.n[k] = load + control.alpha_n * difference;
        let rate = v0 + control.alpha_v * difference - self.u[k];
        self.force[k] = self.a[k] + control.dashpots.damping * rate;
        rate
    }

    /// Fills load and force of a step whose ẋ and a are known.
    pub(super) fn fill_forces(&mut self, control: Control) {
        for k in 0..=self.order.min(MOST_ORDER) {
            self.controlled(control, k);
        }
    }

    /// Computes the coefficients of a stuck block of order 1 and higher.
    pub(super) fn stick(&mut self, control: Control) {
        let order = self.order.min(MOST_ORDER);
        for (k, per_next) in PER_NEXT.iter().enumerate().take(order) {
            self.u[k + 1] = 0.0;
            self.a[k + 1] = self.controlled(control, k) * per_next;
        }
        self.controlled(control, order);
    }

    /// Computes the coefficients of a block in slip.
    pub(super) fn slip(&mut self, control: Control, direction: f64, series: &mut impl Series) {
        let order = self.order.min(MOST_ORDER);
        for (k, per_next) in PER_NEXT.iter().enumerate().take(order) {
            let rate = self.controlled(control, k);
            let friction = series.extend(k, direction * self.u[k], &self.n);
            self.a[k + 1] = rate * per_next;
            let held = direction * friction + control.dashpots.viscous * self.u[k];
            self.u[k + 1] = (self.force[k] - held) * per_next;
        }
        self.controlled(control, order);
    }
}
