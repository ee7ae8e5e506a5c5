//! A motion sampled over time, with its events: a case followed to its outcome and to the end of
//! its trace.

use super::samples::{Most, Samples};
pub use super::trace_error::TraceError;
use crate::model::stop::Stop;
use crate::setting::case_file::{CaseSpec, Sampling};
use crate::slip::case::{Case, CaseError, CaseUnits};
use crate::slip::forces::{Forces, State};
use crate::slip::motion::{Event, Mode, Motion};
use crate::slip::outcome::{Observer, Outcome, Summary};
use crate::slip::speeds::Speeds;

/// The most samples of a trace: some 300 MB.
pub(crate) const MOST_SAMPLES: usize = 2_000_000;

/// Modes by their numbers in a trace, with their names.
pub(crate) const MODES: [(Mode, &str); 3] = [
    (Mode::Stick, "stick"),
    (Mode::Forwards, "forwards"),
    (Mode::Backwards, "backwards"),
];

/// Events by their numbers in a trace, with their names.
pub(crate) const EVENTS: [(Event, &str); 6] = [
    (Event::Release, "release"),
    (Event::Stick, "stick"),
    (Event::Reversal, "reversal"),
    (Event::LiftOff, "liftoff"),
    (Event::SwitchOn, "switch_on"),
    (Event::Programme, "programme"),
];

/// The state at one time, in the case's units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Time.
    pub t: f64,
    /// Position of the block, 0 at t = 0.
    pub x: f64,
    /// Velocity of the block.
    pub x_dot: f64,
    /// Elongation of the spring.
    pub a: f64,
    /// Pulling velocity.
    pub v: f64,
    /// Normal load.
    pub n: f64,
    /// Force of the spring, and of the dashpot beside it, on the block.
    pub pulling_force: f64,
    /// Friction force on the block, positive where it acts backwards; without the dashpot to the
    /// ground.
    pub friction_force: f64,
    /// The mode of the block from this time on.
    pub mode: Mode,
}

/// An event, in the case's units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TraceEvent {
    /// When.
    pub t: f64,
    /// What.
    pub kind: Event,
    /// Elongation of the spring.
    pub a: f64,
}

impl TraceEvent {
    /// The name of its kind in files and messages.
    #[must_use]
    pub fn name(&self) -> &'static str {
        let named = EVENTS.iter().find(|(kind, _)| *kind == self.kind);
        named.map_or("", |(_, name)| name)
    }
}

/// A motion with its outcome.
///
/// ```
/// use slipmap::answers::Trace;
/// use slipmap::setting::CaseSpec;
///
/// let case: CaseSpec = "
/// [trace]
/// until = 60.0
/// [friction]
/// law = \"weakening\"
/// mu0 = 0.5
/// v_s = 0.5
/// [fixed]
/// v0 = 0.35
/// ".parse()?;
/// let trace = Trace::of(&case)?;
/// assert!(!trace.sticks().is_empty(), "without control the block sticks and slips");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// Samples at strictly increasing times, from 0 to the end of the trace. Every event has one.
    /// At switch-on and at corners of a programme, where v or N jumps, there is another one just
    /// before it.
    pub samples: Vec<Sample>,
    /// All events, until the outcome is known and to the end of the trace.
    pub events: Vec<TraceEvent>,
    /// The outcome.
    pub summary: Summary,
}

impl Trace {
    /// Follows the case of `spec`.
    ///
    /// # Errors
    /// When the model refuses a value, or the trace would be too long.
    pub fn of(spec: &CaseSpec) -> Result<Self, TraceError> {
        Self::within(spec, Most::Refused(MOST_SAMPLES), &Stop::default())
    }

    /// Follows the case of `spec` with at most `most` samples and events. `stop` is checked at
    /// every step.
    ///
    /// # Errors
    /// As [`Trace::of`], and when it is stopped.
    pub fn within(spec: &CaseSpec, most: Most, stop: &Stop) -> Result<Self, TraceError> {
        Self::with_speeds(spec, most, stop).map(|(trace, _)| trace)
    }

    /// As [`Trace::within`], with the speeds that the block reaches until the outcome is known and
    /// to the end of the trace, in units of the case.
    ///
    /// # Errors
    /// As [`Trace::within`].
    pub fn with_speeds(
        spec: &CaseSpec,
        most: Most,
        stop: &Stop,
    ) -> Result<(Self, Speeds), TraceError> {
        let case = &spec.case;
        let longest = most.number();
        let mut listed = Listed {
            units: case.units(),
            events: Vec::new(),
            speeds: Speeds::default(),
            most: longest,
            stop,
        };
        let summary = case.run(&mut listed)?;
        if stop.is_set() {
            return Err(TraceError::Stopped);
        }
        if listed.events.len() > longest {
            return Err(TraceError::TooLong(longest));
        }
        let ended = matches!(summary.outcome, Outcome::LiftOff | Outcome::Diverged);
        let until = match spec.until {
            Some(until) if !(ended && until > summary.decided) => until,
            _ => summary.decided,
        };
        let sampling = sampling(spec.sampling, until, most);
        let mut recorder = Recorder::new(case, sampling, most, stop)?;
        recorder.record(until)?;
        // The same motion was followed twice and agrees up to rounding: a step that is cut at the
        // end of the trace ends elsewhere. The events of the sampled motion come first.
        let mut events = recorder.events;
        let both = events.len();
        events.extend(listed.events.into_iter().skip(both));
        let speeds = listed.speeds.and(recorder.speeds);
        let trace = Self {
            samples: recorder.samples.into_vec(),
            events,
            summary,
        };
        Ok((trace, speeds.times(case.units().velocity)))
    }

    /// Stretches of time (from, to) in which the block sticks.
    #[must_use]
    pub fn sticks(&self) -> Vec<(f64, f64)> {
        let mut sticks = Vec::new();
        let mut since = None;
        for sample in &self.samples {
            match (sample.mode == Mode::Stick, since) {
                (true, None) => since = Some(sample.t),
                (false, Some(from)) => {
                    sticks.push((from, sample.t));
                    since = None;
                }
                _ => {}
            }
        }
        if let (Some(from), Some(last)) = (since, self.samples.last()) {
            sticks.push((from, last.t));
        }
        sticks
    }
}

/// How to sample until `until`: if there are too many intervals, they are lengthened by a whole
/// factor.
fn sampling(asked: Sampling, until: f64, most: Most) -> Sampling {
    match (asked, most) {
        (Sampling::Interval(interval), Most::Thinned(most)) => {
            let share = until / interval / (0.5 * most as f64);
            Sampling::Interval(interval * share.ceil().max(1.0))
        }
        _ => asked,
    }
}

/// Collects the events and the speeds of a motion.
struct Listed<'s> {
    units: CaseUnits,
    events: Vec<TraceEvent>,
    speeds: Speeds,
    most: usize,
    stop: &'s Stop,
}

impl Observer for Listed<'_> {
    fn step(&mut self, motion: &Motion, event: Option<Event>) {
        let there = event.map(|kind| physical(motion, kind, self.units));
        self.events.extend(there);
        self.speeds.step(motion, event);
    }

    fn enough(&self) -> bool {
        self.events.len() > self.most || self.stop.is_set()
    }
}

fn physical(motion: &Motion, kind: Event, units: CaseUnits) -> TraceEvent {
    TraceEvent {
        t: motion.t * units.time,
        kind,
        a: motion.a * units.length,
    }
}

/// Samples a motion step by step.
struct Recorder<'c> {
    case: &'c Case,
    motion: Motion,
    /// Displacement since the start.
    x: f64,
    units: CaseUnits,
    steps: u64,
    sampling: Sampling,
    samples: Samples,
    events: Vec<TraceEvent>,
    speeds: Speeds,
}

/// One step of the motion, at its beginning.
#[derive(Clone, Copy)]
struct Begun {
    t: f64,
    x: f64,
    mode: Mode,
    /// Whether an event or the beginning of the trace is there.
    marked: bool,
}

impl<'c> Recorder<'c> {
    fn new(case: &'c Case, sampling: Sampling, most: Most, stop: &Stop) -> Result<Self, CaseError> {
        Ok(Self {
            case,
            motion: case.motion()?.heeding(stop.clone()),
            x: 0.0,
            units: case.units(),
            steps: case.steps,
            sampling,
            samples: Samples::new(most),
            events: Vec::new(),
            speeds: Speeds::default(),
        })
    }

    /// Follows the motion until the time `until`, in physical units, or to lift-off.
    fn record(&mut self, until: f64) -> Result<(), TraceError> {
        let end = until / self.units.time;
        let mut marked = true;
        for _ in 0..self.steps {
            let begun = Begun {
                t: self.motion.t,
                x: self.x,
                mode: self.motion.mode(),
                marked,
            };
            let event = self.motion.advance(end);
            if self.motion.is_stopped() {
                return Err(TraceError::Stopped);
            }
            if self.motion.outgrows_its_past() {
                return Err(TraceError::OutgrowsPast);
            }
            if self.motion.is_lost() {
                return Err(TraceError::NoFriction(begun.t * self.units.time));
            }
            self.speeds.step(&self.motion, event);
            let step = self.motion.last_step();
            self.x += step.displacement(step.length);
            self.sample_step(begun);
            let over = event == Some(Event::LiftOff) || self.motion.t >= end;
            if over || matches!(event, Some(Event::SwitchOn | Event::Programme)) {
                self.sample_end(begun, !over);
            }
            if self.samples.too_many() {
                return Err(TraceError::TooLong(self.samples.most()));
            }
            if let Some(kind) = event {
                self.events.push(physical(&self.motion, kind, self.units));
            }
            marked = event.is_some();
            if over {
                break;
            }
        }
        Ok(())
    }

    /// Samples the last step, except its end.
    fn sample_step(&mut self, begun: Begun) {
        let length = self.motion.last_step().length;
        match self.sampling {
            Sampling::PerStep(n) => {
                for part in 0..n {
                    let marked = begun.marked && part == 0;
                    self.add(begun, marked, length * f64::from(part) / f64::from(n));
                }
            }
            Sampling::Interval(interval) => {
                let interval = interval / self.units.time;
                if begun.marked {
                    self.add(begun, true, 0.0);
                }
                let mut index = (begun.t / interval).ceil();
                while index * interval < begun.t + length && !self.samples.too_many() {
                    self.add(begun, false, (index * interval - begun.t).max(0.0));
                    index += 1.0;
                }
            }
        }
    }

    /// Samples the end of the last step. `before`: just before it, because the next step begins
    /// with other values.
    fn sample_end(&mut self, begun: Begun, before: bool) {
        let length = self.motion.last_step().length;
        let mode = match before {
            true => begun.mode,
            false => self.motion.mode(),
        };
        let mut sample = Sample::of(&self.motion, self.case, Begun { mode, ..begun }, length);
        if before {
            sample.t = sample.t.next_down();
        }
        self.samples.add(true, || sample);
    }

    fn add(&mut self, begun: Begun, marked: bool, s: f64) {
        let (motion, case) = (&self.motion, self.case);
        self.samples
            .add(marked, || Sample::of(motion, case, begun, s));
    }
}

impl Sample {
    /// The state of a motion, `s` after the beginning of its last step.
    fn of(motion: &Motion, case: &Case, begun: Begun, s: f64) -> Self {
        let units = case.units();
        let step = motion.last_step();
        let (u, a, n) = step.state(s);
        let limits = motion.parameters().feedback.limits;
        let state = State {
            mode: begun.mode,
            x_dot: u * units.velocity,
            a: a * units.length,
            v: limits.velocity_of(step.velocity(s)) * units.velocity,
            n: limits.load_of(n) * units.force,
        };
        let [t, x] = [begun.t + s, begun.x + step.displacement(s)];
        Self::in_state(t * units.time, x * units.length, state, case.forces(state))
    }

    /// The sample of a state.
    pub(crate) fn in_state(t: f64, x: f64, state: State, forces: Forces) -> Self {
        Self {
            t,
            x,
            x_dot: state.x_dot,
            a: state.a,
            v: state.v,
            n: state.n,
            pulling_force: forces.pulling,
            friction_force: forces.friction,
            mode: state.mode,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use std::sync::atomic::AtomicBool;

    const FIG3A: &str = include_str!("../../sweeps/fig3a.toml");

    fn trace(text: &str) -> (CaseSpec, Trace) {
        let spec: CaseSpec = text.parse().unwrap();
        let trace = Trace::of(&spec).unwrap();
        (spec, trace)
    }

    #[test]
    fn samples_obey_the_equations_between_them() {
        let (spec, trace) = trace(FIG3A);
        let samples = &trace.samples;
        assert!(samples.windows(2).all(|w| w[0].t < w[1].t));
        let last = samples.last().unwrap();
        assert_eq!(Some(last.t), spec.until);
        // x + a is the position of the pulled end: the integral of v by the trapezium rule.
        let mut pulled = samples[0].a;
        for w in samples.windows(2) {
            pulled += 0.5 * (w[1].t - w[0].t) * (w[0].v + w[1].v);
        }
        assert!((last.x + last.a - pulled).abs() < 1e-3, "{last:?} {pulled}");
        let stuck = samples.iter().filter(|s| s.mode == Mode::Stick);
        assert!(stuck.clone().count() > 50 && stuck.clone().all(|s| s.x_dot == 0.0));
    }

    /// The largest speed lies between samples, and the smallest is that of a block that sticks.
    #[test]
    fn speeds_are_those_of_the_samples_and_between_them() {
        let speeds = |text: &str| {
            let spec: CaseSpec = text.parse().unwrap();
            let found = Trace::with_speeds(&spec, Most::Refused(MOST_SAMPLES), &Stop::default());
            let (trace, speeds) = found.unwrap();
            let samples = trace.samples.iter().map(|sample| sample.x_dot.abs());
            (samples.fold(0.0, f64::max), speeds)
        };
        let (fastest, found) = speeds(FIG3A);
        assert!(found.least == 0.0 && found.most >= fastest, "{found:?}");
        assert!(found.most < fastest * (1.0 + 1e-4), "{found:?} {fastest}");
        let law = "[friction]\nlaw = \"coulomb\"\nmu0 = 0.5\n";
        let (_, found) = speeds(&format!(
            "horizon = 9\n[fixed]\nv0 = 2\n{law}[start]\nx_dot0 = 3\n"
        ));
        assert!(
            (found.least - 1.0).abs() < 1e-9 && (found.most - 3.0).abs() < 1e-9,
            "{found:?}"
        );
    }

    #[test]
    fn every_event_has_its_sample() {
        for sampling in ["", "interval = 0.25"] {
            let (_, trace) = trace(&FIG3A.replace("[trace]", &format!("[trace]\n{sampling}")));
            for event in &trace.events {
                let found = trace.samples.iter().any(|s| s.t == event.t);
                let beyond = trace.samples.last().is_some_and(|s| s.t < event.t);
                assert!(found || beyond, "{event:?}");
            }
            let jump = trace.samples.windows(2).find(|w| w[1].t == 70.0).unwrap();
            assert_eq!(jump[0].t, 70.0_f64.next_down());
            assert!(jump[0].v == 0.35 && jump[1].v != 0.35);
            let sticks = trace.sticks();
            let releases = trace.events.iter().filter(|e| e.kind == Event::Release);
            assert_eq!(sticks.len(), releases.count());
        }
    }

    #[test]
    fn units_scale_a_trace() {
        let plain = trace(FIG3A).1;
        // M = κ = N0 = 4: the units of time and length stay 1, that of force is 4.
        let heavy = "[fixed]\nmass = 4\nstiffness = 4\nnormal_load = 4\n";
        let heavy = trace(&FIG3A.replace("[fixed]\n", heavy)).1;
        assert_eq!(plain.events, heavy.events);
        let (p, h) = (plain.samples[1500], heavy.samples[1500]);
        assert_eq!((p.t, p.a, 4.0 * p.n), (h.t, h.a, h.n));
    }

    #[test]
    fn a_trace_that_is_too_long_is_refused() {
        let text = FIG3A.replace("[trace]", "[trace]\ninterval = 1e-9");
        let spec: CaseSpec = text.parse().unwrap();
        assert_eq!(Trace::of(&spec), Err(TraceError::TooLong(MOST_SAMPLES)));
    }

    /// Thinning keeps a part of any sampling, with every event and the end.
    #[test]
    fn what_is_thinned_is_a_part_of_the_whole() {
        for sampling in ["samples = 24", "interval = 0.001"] {
            let text = FIG3A.replace("[trace]", &format!("[trace]\n{sampling}"));
            let (spec, whole) = trace(&text);
            let stop = Stop::default();
            let thinned = Trace::within(&spec, Most::Thinned(300), &stop).unwrap();
            assert_eq!(thinned.events, whole.events);
            assert_eq!(thinned.summary.decided, whole.summary.decided);
            assert!((150..=300).contains(&thinned.samples.len()));
            assert_eq!(thinned.samples.last(), whole.samples.last());
            for sample in &thinned.samples {
                let near = whole.samples.iter().any(|s| (s.t - sample.t).abs() < 1e-9);
                assert!(near, "{sample:?}");
            }
            for event in &thinned.events {
                let found = thinned.samples.iter().any(|s| s.t == event.t);
                assert!(found || thinned.samples.last().unwrap().t < event.t);
            }
        }
        let spec: CaseSpec = FIG3A.parse().unwrap();
        let refused = Trace::within(&spec, Most::Thinned(5), &Stop::default());
        assert_eq!(refused, Err(TraceError::TooLong(5)));
    }

    #[test]
    fn a_stop_ends_it() {
        let (spec, flag) = (FIG3A.parse().unwrap(), Arc::new(AtomicBool::new(true)));
        let stopped = Trace::within(&spec, Most::Thinned(300), &Stop::when(&flag));
        assert_eq!(stopped, Err(TraceError::Stopped));
    }
}
