//! Follows a motion until its outcome is known; by what lasts too, where readings are held.

use std::f64::consts::TAU;

use super::motion::{Event, Mode, Motion};
use super::outcome::{Limits, Observer, Outcome, Summary};
use super::steady::{Held, Settled};
use super::step::Step;

/// Follows `motion` until its outcome is known.
pub fn follow(motion: &mut Motion, limits: &Limits, observer: &mut impl Observer) -> Summary {
    let mut watch = Watch::new(motion, *limits);
    loop {
        if let Some(outcome) = watch.ended(motion) {
            return watch.summary(motion, outcome);
        }
        let event = motion.advance(limits.horizon);
        watch.steps += 1;
        observer.step(motion, event);
        watch.see(motion, event);
        if watch.outcome.is_none() && observer.enough() {
            return watch.summary(motion, Outcome::Undecided);
        }
    }
}

/// The largest multiple period that is recognised.
const MOST_FOLD: usize = 4;
/// Cycles that are remembered.
const CYCLES: usize = MOST_FOLD + 1;
/// How well cycles have to repeat by default, relative.
pub const REPEATED: f64 = 1e-9;
/// Deviation from sliding, over v0, below which linear theory decides.
const SMALL: f64 = 1e-3;
/// Deviation of ẋ from v0, over v0, below which the motion counts as settled.
const SETTLED: f64 = 0.01;
/// Amplitudes larger than this, over the natural scale of the motion, count as diverged.
const BEYOND: f64 = 1e6;
/// The number of windows of equal amplitude after which a motion is an oscillation.
const EQUAL_WINDOWS: u32 = 4;

/// From one release to the next.
#[derive(Debug, Clone, Copy, Default)]
struct Cycle {
    period: f64,
    slip: f64,
    elongation: f64,
}

/// Cycles in a row that equal those a fixed number of cycles earlier.
#[derive(Debug, Clone, Copy, Default)]
struct Repeats {
    /// When the first of them began.
    since: f64,
    count: usize,
}

/// What has been seen of a motion.
struct Watch {
    limits: Limits,
    switch_on: f64,
    /// Since when v0 is what it is in the end, the last corner of its programme, and that v0.
    steady: f64,
    v0: f64,
    tau: f64,
    rest: f64,
    scale: f64,
    steps: u64,
    /// Until when it has been seen.
    seen: f64,
    outcome: Option<Outcome>,
    n_min: f64,
    peak: f64,
    time_at_limit: f64,
    unsettled: f64,
    last_release: f64,
    last_stop: f64,
    cycles: [Cycle; CYCLES],
    count: usize,
    /// For the multiple periods 1, 2, …
    repeats: [Repeats; MOST_FOLD],
    fold: usize,
    decay: Decay,
    window: Window,
    /// Where readings are held.
    held: Option<Held>,
}

/// The decay of small deviations.
#[derive(Debug, Clone, Copy)]
struct Decay {
    /// Since when the deviation has been small.
    small_since: f64,
    /// Start of the comparison, and the largest deviations in its first window and after one
    /// relaxation time.
    from: f64,
    first: f64,
    second: f64,
}

/// Amplitudes in successive windows of time.
#[derive(Debug, Clone, Copy)]
struct Window {
    length: f64,
    until: f64,
    amplitude: f64,
    before: f64,
    equal: u32,
}

impl Watch {
    fn new(motion: &Motion, limits: Limits) -> Self {
        let p = motion.parameters();
        let rest = motion.sliding_elongation();
        let tau = if p.switch_on.is_finite() {
            motion.feedback().remembered()
        } else {
            0.0
        };
        Self {
            limits,
            switch_on: p.switch_on,
            steady: motion.last_corner(),
            v0: motion.last_v0(),
            tau,
            rest,
            scale: (1.0 + p.v0.abs().max(motion.last_v0()))
                .max(motion.a.abs())
                .max(motion.u.abs()),
            steps: 0,
            seen: motion.t,
            outcome: None,
            n_min: f64::INFINITY,
            peak: 0.0,
            time_at_limit: match p.feedback.limits.act() {
                true => 0.0,
                false => f64::NAN,
            },
            unsettled: motion.t,
            last_release: f64::NAN,
            last_stop: f64::NAN,
            cycles: [Cycle::default(); CYCLES],
            count: 0,
            repeats: [Repeats::default(); MOST_FOLD],
            fold: 0,
            decay: Decay {
                small_since: f64::INFINITY,
                from: f64::INFINITY,
                first: 0.0,
                second: 0.0,
            },
            window: Window {
                length: tau + 4.0 * TAU,
                until: motion.t,
                amplitude: 0.0,
                before: f64::NAN,
                equal: 0,
            },
            held: Held::of(motion, limits.stable_abscissa),
        }
    }

    fn ended(&self, motion: &Motion) -> Option<Outcome> {
        if self.outcome.is_some() {
            return self.outcome;
        }
        let limits = &self.limits;
        let over =
            motion.t >= limits.horizon || self.steps >= limits.steps || self.count >= limits.cycles;
        over.then_some(Outcome::Undecided)
    }

    fn see(&mut self, motion: &Motion, event: Option<Event>) {
        let step = motion.last_step();
        // The start itself, not the end less the length: with rounding the first step under control
        // would seem to begin before switch-on.
        let start = std::mem::replace(&mut self.seen, motion.t);
        let size = motion.a.abs().max(motion.u.abs());
        let controlled = start >= self.switch_on || !self.switch_on.is_finite();
        if controlled && !motion.is_lost() {
            self.n_min = motion.smallest_load(self.n_min);
            self.peak = step.largest_force(self.peak);
            if motion.is_at_limit() {
                self.time_at_limit += step.length;
            }
        }
        if motion.is_lost() {
            self.outcome = Some(Outcome::Undecided);
            return;
        }
        if size > BEYOND * self.scale && event != Some(Event::LiftOff) {
            self.outcome = Some(Outcome::Diverged);
            return;
        }
        if let Some(t) = step.last_outside(self.v0, SETTLED * self.v0) {
            self.unsettled = start + t;
        }
        match event {
            Some(Event::LiftOff) => self.outcome = Some(Outcome::LiftOff),
            Some(Event::Release) => self.see_release(motion),
            Some(Event::Stick) => self.last_stop = motion.t,
            _ => {}
        }
        if self.outcome.is_none() && controlled && start >= self.steady {
            self.see_deviation(motion, step);
        }
    }

    /// Adds the cycle that ends with this release, and checks whether cycles repeat.
    fn see_release(&mut self, motion: &Motion) {
        let began = std::mem::replace(&mut self.last_release, motion.t);
        // Cycles before switch-on or the last corner, or across them, do not count.
        let after_switch_on = began >= self.switch_on || !self.switch_on.is_finite();
        if !(after_switch_on && began >= self.steady && self.last_stop > began) {
            return;
        }
        self.cycles[self.count % CYCLES] = Cycle {
            period: motion.t - began,
            slip: self.last_stop - began,
            elongation: motion.a,
        };
        self.count += 1;
        let steered = self.held.as_ref().is_some_and(Held::is_steered);
        let repeating = (1..=MOST_FOLD)
            .filter(|_| !steered)
            .find(|&fold| self.repeats(motion.t, fold));
        if let Some(fold) = repeating {
            self.fold = fold;
            self.outcome = Some(Outcome::StickSlip);
        }
        let last = self.cycle(0);
        if let (Some(held), None) = (&mut self.held, self.outcome) {
            let cycle = [last.period, last.slip, last.elongation];
            if held.goes_on(cycle, [began, motion.t], self.tau) {
                self.outcome = Some(Outcome::StickSlip);
            }
        }
    }

    /// The cycle `back` before the last one.
    fn cycle(&self, back: usize) -> Cycle {
        self.cycles[(self.count - 1 - back) % CYCLES]
    }

    /// Whether the cycles of the last delay, and `fold` at least, equal those `fold` earlier.
    fn repeats(&mut self, now: f64, fold: usize) -> bool {
        if self.count <= fold {
            return false;
        }
        let (p, q) = (self.cycle(0), self.cycle(fold));
        let repeated = self.limits.repeated;
        let near = |p: f64, q: f64| (p - q).abs() <= repeated * (p.abs() + q.abs()) + repeated;
        let equal =
            near(p.period, q.period) && near(p.slip, q.slip) && near(p.elongation, q.elongation);
        let repeats = &mut self.repeats[fold - 1];
        if !equal {
            repeats.count = 0;
            return false;
        }
        if repeats.count == 0 {
            repeats.since = now - p.period;
        }
        repeats.count += 1;
        repeats.count >= fold && now - repeats.since > self.tau
    }

    fn see_deviation(&mut self, motion: &Motion, step: &Step) {
        if motion.mode() == Mode::Stick {
            self.decay.small_since = f64::INFINITY;
            self.decay.from = f64::INFINITY;
            self.window.equal = 0;
            if let Some(held) = &mut self.held {
                held.amplitudes.forget();
                held.settled.iter_mut().for_each(Settled::forget);
            }
            return;
        }
        // A large deviation is needed only where it exceeds what was seen before.
        let now = (motion.u - self.v0).abs().max((motion.a - self.rest).abs());
        let known = match now > SMALL * self.v0 {
            true => self.window.amplitude.max(now),
            false => 0.0,
        };
        let deviation = step.deviation((self.v0, self.rest), known);
        self.see_decay(motion.t, step.length, deviation);
        self.see_amplitude(motion.t, deviation);
        let settled = self.held.as_mut().and_then(|held| held.settled.as_mut());
        if let (Some(settled), None) = (settled, self.outcome) {
            let times = [motion.t - step.length, motion.t];
            if settled.lasts(times, deviation, SMALL * self.v0) {
                self.outcome = Some(Outcome::Sliding);
            }
        }
    }

    fn see_decay(&mut self, now: f64, length: f64, deviation: f64) {
        let Some(abscissa) = self.limits.stable_abscissa else {
            return;
        };
        let decay = &mut self.decay;
        if deviation > SMALL * self.v0 {
            decay.small_since = f64::INFINITY;
            decay.from = f64::INFINITY;
            return;
        }
        let start = now - length;
        decay.small_since = decay.small_since.min(start);
        if start - decay.small_since < self.tau {
            return;
        }
        let window = self.tau.max(TAU);
        if decay.from == f64::INFINITY {
            (decay.from, decay.first, decay.second) = (start, 0.0, 0.0);
        }
        let relaxation = -1.0 / abscissa;
        if start < decay.from + window {
            decay.first = decay.first.max(deviation);
        } else if start >= decay.from + relaxation {
            decay.second = decay.second.max(deviation);
        }
        if now >= decay.from + relaxation.max(window) + window {
            // Beats of two roots decay unevenly; a deviation near rounding no longer decays.
            if decay.second <= 0.6 * decay.first || decay.first < 1e-11 {
                self.outcome = Some(Outcome::Sliding);
            }
            decay.from = f64::INFINITY;
        }
    }

    fn see_amplitude(&mut self, now: f64, deviation: f64) {
        let window = &mut self.window;
        window.amplitude = window.amplitude.max(deviation);
        if now < window.until {
            return;
        }
        // Where sliding is stable, a decay as slow as its abscissa does not count as equal
        // amplitude.
        let decay = self.limits.stable_abscissa.map_or(f64::INFINITY, f64::abs) * window.length;
        let same = (window.amplitude - window.before).abs()
            <= 1e-6_f64.min(0.1 * decay) * window.amplitude;
        window.equal = if same { window.equal + 1 } else { 0 };
        let large = window.amplitude > 10.0 * SMALL * self.v0;
        let lasts = self.held.as_mut().is_some_and(|held| {
            held.amplitudes.add([window.amplitude]);
            let kept_up = held.settled.map_or(0.0, |settled| settled.within);
            window.amplitude > kept_up && held.amplitudes.has_no_trend()
        });
        if (window.equal >= EQUAL_WINDOWS || lasts) && large {
            self.outcome = Some(Outcome::Oscillation);
        }
        window.before = window.amplitude;
        window.amplitude = 0.0;
        window.until = now + window.length;
    }

    fn summary(&self, motion: &Motion, outcome: Outcome) -> Summary {
        let (mut period, mut slip_time) = (f64::NAN, f64::NAN);
        if outcome == Outcome::StickSlip {
            let last = (0..self.fold).map(|back| self.cycle(back));
            (period, slip_time) = last.fold((0.0, 0.0), |(p, s), c| (p + c.period, s + c.slip));
        }
        let mut slips = self.fold as u32;
        if let (Some(held), Outcome::StickSlip, 0) = (&self.held, outcome, self.fold) {
            (period, slip_time, slips) = (held.cycles.mean(0), held.cycles.mean(1), 1);
        }
        Summary {
            outcome,
            decided: motion.t,
            settle_time: match outcome {
                Outcome::Sliding => Summary::after(self.switch_on, self.unsettled),
                _ => f64::NAN,
            },
            n_min: self.n_min,
            peak: self.peak,
            time_at_limit: self.time_at_limit,
            share_at_limit: self.time_at_limit / Summary::after(self.switch_on, motion.t),
            period,
            stick_time: period - slip_time,
            slip_time,
            last_release: Summary::released_after(outcome, self.last_release, self.switch_on),
            slips,
            steps: self.steps,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::rightmost::Rightmost;
    use crate::linear::{Crossings, MarginalTolerance};
    use crate::model::{Dashpots, Feedback, FrictionLaw, Groups};
    use crate::slip::motion::{Accuracy, Parameters};

    fn letter(v0: f64, alpha_v: f64, alpha_n: f64, tau: f64) -> Parameters {
        Parameters {
            law: FrictionLaw::weakening(0.5, 0.5, 1.0).unwrap(),
            velocity_unit: 1.0,
            dashpots: Dashpots::default(),
            feedback: Feedback::new(alpha_v, alpha_n, tau),
            v0,
            switch_on: 70.0,
        }
    }

    fn run(p: Parameters, u: f64) -> Summary {
        let groups = Groups::new(
            p.law.mu_prime(p.v0),
            p.feedback.gains.alpha_v,
            p.law.mu_k(p.v0) * p.feedback.gains.alpha_n,
        );
        let count = Crossings::of(groups).count(p.feedback.tau, MarginalTolerance::default());
        let root = Rightmost::at(groups, p.feedback.tau, 1, count).roots[0];
        let limits = Limits {
            horizon: 3000.0,
            steps: 1_000_000,
            stable_abscissa: count.stable().then_some(root.lambda.re),
            repeated: REPEATED,
            cycles: usize::MAX,
        };
        let rest = p.law.mu_k(p.v0);
        let mut motion = Motion::new(p, Accuracy::default(), u, rest);
        follow(&mut motion, &limits, &mut ())
    }

    #[test]
    fn the_letters_figure_3_ends_in_sliding() {
        let a = run(letter(0.35, -0.33, 0.0, 4.15), 1.01 * 0.35);
        let b = run(letter(0.1, 0.0, -10.0, 0.5), 1.01 * 0.1);
        for s in [a, b] {
            assert_eq!(s.outcome, Outcome::Sliding, "{s:?}");
            assert!(
                s.settle_time > 5.0 && s.settle_time < 300.0 && s.decided < 1000.0,
                "{s:?}"
            );
        }
        assert!((a.last_release - 27.029009396).abs() < 1e-8);
        assert!((b.last_release - 6.277483031).abs() < 1e-8);
        assert!(
            b.n_min >= 0.5 - 1e-12 && b.n_min < 0.6 && a.n_min == 1.0,
            "{a:?} {b:?}"
        );
    }

    #[test]
    fn below_the_critical_velocity_stick_slip_survives() {
        let s = run(letter(0.3, -0.33, 0.0, 4.15), 0.303);
        assert_eq!(s.outcome, Outcome::StickSlip, "{s:?}");
        assert!((s.period - s.stick_time - s.slip_time).abs() < 1e-12 && s.stick_time > 0.0);
        let s = run(letter(0.02, 0.0, -10.0, 0.5), 0.0202);
        assert_eq!(s.outcome, Outcome::StickSlip, "{s:?}");
        // Without control, for ever.
        let s = run(
            Parameters {
                switch_on: f64::INFINITY,
                ..letter(0.1, 0.0, 0.0, 1.0)
            },
            0.101,
        );
        assert_eq!(s.outcome, Outcome::StickSlip, "{s:?}");
        assert!(
            (s.slip_time - 3.44600138).abs() < 1e-8 && (s.stick_time - 15.85555061).abs() < 1e-8
        );
    }

    #[test]
    fn cycles_repeat_over_any_delay() {
        // Some hundred cycles in a delay. They start anew, slightly changed, with every delay.
        let p = Parameters {
            law: FrictionLaw::coulomb(0.5, 1.0).unwrap(),
            switch_on: 0.0,
            ..letter(1.0, -0.001, 0.0, 700.0)
        };
        let limits = Limits {
            horizon: 20_000.0,
            steps: 100_000,
            stable_abscissa: None,
            repeated: REPEATED,
            cycles: usize::MAX,
        };
        let mut motion = Motion::new(p, Accuracy::default(), 0.0, 0.0);
        let s = follow(&mut motion, &limits, &mut ());
        assert_eq!(s.outcome, Outcome::StickSlip, "{s:?}");
    }

    /// Two delays take more steps than are kept: the motion ends undecided, since its past is
    /// incomplete.
    #[test]
    fn what_is_lost_is_undecided() {
        let p = Parameters {
            law: FrictionLaw::coulomb(0.5, 1.0).unwrap(),
            switch_on: 0.0,
            ..letter(1.0, -0.001, 0.0, 1e7)
        };
        let limits = Limits {
            horizon: 1e9,
            steps: 10_000_000,
            stable_abscissa: None,
            repeated: REPEATED,
            cycles: usize::MAX,
        };
        // The delayed elongation is still the constant past, so cycles repeat; that is not checked
        // here.
        let mut motion = Motion::new(p, Accuracy::default(), 0.0, 0.0);
        let mut steps = 0;
        while !motion.is_lost() {
            motion.advance(limits.horizon);
            steps += 1;
        }
        assert!((60_000..70_000).contains(&steps), "{steps}");
        let s = follow(&mut motion, &limits, &mut ());
        assert_eq!(s.outcome, Outcome::Undecided, "{s:?}");
        assert_eq!(s.steps, 1);
    }

    #[test]
    fn the_first_step_under_control_counts() {
        // N jumps at switch-on and is smallest there, whatever the times are rounded to.
        for i in 0..100 {
            let p = Parameters {
                switch_on: [2.0, 0.9, 0.3, 8.0][i % 4],
                ..letter(0.3, 0.0, 0.8, 2.0)
            };
            let limits = Limits {
                horizon: p.switch_on + 1.0,
                steps: 1000,
                stable_abscissa: None,
                repeated: REPEATED,
                cycles: usize::MAX,
            };
            let mut motion =
                Motion::new(p.clone(), Accuracy::default(), 0.3, -0.6 + 0.012 * i as f64);
            let mut first = First(f64::NAN, false);
            let s = follow(&mut motion, &limits, &mut first);
            assert!(s.n_min <= first.0, "{p:?} {s:?} {}", first.0);
        }
    }

    /// The load right after switch-on.
    struct First(f64, bool);

    impl Observer for First {
        fn step(&mut self, motion: &Motion, event: Option<Event>) {
            if self.1 {
                self.0 = motion.last_step().state(0.0).2;
            }
            self.1 = event == Some(Event::SwitchOn);
        }
    }

    #[test]
    fn a_slow_decay_is_no_oscillation() {
        let p = Parameters {
            law: FrictionLaw::coulomb(0.5, 1.0).unwrap(),
            switch_on: 0.0,
            ..letter(0.5, -1e-9, 0.0, 3.0)
        };
        let s = run(p.clone(), 0.7);
        assert_eq!(s.outcome, Outcome::Undecided, "{s:?}");
        // Without control it is an oscillation.
        let p = Parameters {
            switch_on: f64::INFINITY,
            feedback: Feedback::new(0.0, 0.0, 3.0),
            ..p
        };
        let mut motion = Motion::new(p, Accuracy::default(), 0.7, 0.5);
        let limits = Limits {
            horizon: 3000.0,
            steps: 100_000,
            stable_abscissa: None,
            repeated: REPEATED,
            cycles: usize::MAX,
        };
        let s = follow(&mut motion, &limits, &mut ());
        assert_eq!(s.outcome, Outcome::Oscillation, "{s:?}");
    }

    /// Over the first delay the delayed elongation is constant, and Coulomb friction leaves a
    /// linear equation: on its growing direction the elongation is one exponential, and the load
    /// falls with it.
    #[test]
    fn the_last_step_of_a_diverged_motion_counts() {
        let (mu, alpha_v, alpha_n, v0, a0) = (0.5, 2.5_f64, -1e-8, 3.0, 1.5);
        let stiffness = 1.0 - mu * alpha_n;
        let rate = 0.5 * (alpha_v + (alpha_v * alpha_v - 4.0 * stiffness).sqrt());
        let rest = mu * (1.0 - alpha_n * a0) / stiffness;
        let p = Parameters {
            law: FrictionLaw::coulomb(mu, 1.0).unwrap(),
            switch_on: 0.0,
            ..letter(v0, alpha_v, alpha_n, 20.0)
        };
        let limits = Limits {
            horizon: 20.0,
            steps: 100_000,
            stable_abscissa: None,
            repeated: REPEATED,
            cycles: usize::MAX,
        };
        let mut motion = Motion::new(p, Accuracy::default(), v0 - rate * (a0 - rest), a0);
        let s = follow(&mut motion, &limits, &mut ());
        assert_eq!(s.outcome, Outcome::Diverged, "{s:?}");
        let elongation = rest + (a0 - rest) * (rate * s.decided).exp();
        assert!((s.peak / elongation - 1.0).abs() < 1e-9, "{s:?}");
        let load = 1.0 + alpha_n * (elongation - a0);
        assert!(load < 0.97 && (s.n_min - load).abs() < 1e-9, "{s:?} {load}");
    }

    #[test]
    fn strong_load_control_lifts_off() {
        let s = run(letter(1.5, 0.0, -10.0, 0.9), 0.5);
        assert_eq!(s.outcome, Outcome::LiftOff, "{s:?}");
        assert!(s.n_min <= 1e-9, "{s:?}");
    }
}
