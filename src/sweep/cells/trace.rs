//! A motion sampled over time, with its events: a case followed to its outcome and to the end of
//! its trace.

use crate::slip::case::{Case, CaseError, CaseUnits};
use crate::slip::motion::{Event, MOST_KEPT, Mode, Motion};
use crate::slip::outcome::{Observer, Outcome, Summary};
use crate::sweep::input::case_file::{CaseSpec, Sampling};

/// More samples than this make no trace: some 300 MB.
const MOST_SAMPLES: usize = 2_000_000;

/// Modes by their numbers in a trace, with their names.
pub const MODES: [(Mode, &str); 3] = [
    (Mode::Stick, "stick"),
    (Mode::Forwards, "forwards"),
    (Mode::Backwards, "backwards"),
];

/// Events by their numbers in a trace, with their names.
pub const EVENTS: [(Event, &str); 5] = [
    (Event::Release, "release"),
    (Event::Stick, "stick"),
    (Event::Reversal, "reversal"),
    (Event::LiftOff, "liftoff"),
    (Event::SwitchOn, "switch_on"),
];

/// Why there is no trace.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TraceError {
    /// The model refuses the case.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// It would be too long.
    #[error("the trace would have more than {MOST_SAMPLES} samples or events")]
    TooLong,
    /// The delay is too long for its steps.
    #[error("two delays take more than {MOST_KEPT} steps, the most that are kept")]
    OutgrowsPast,
}

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
    /// What the block does from this time on.
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

/// A motion with what became of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// Samples at strictly growing times, from 0 to the end of the trace. Every event has one;
    /// where v or N jump, at switch-on, the one before it is next to it.
    pub samples: Vec<Sample>,
    /// All events until the outcome was known and to the end of the trace.
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
        let case = &spec.case;
        let mut listed = Events {
            units: case.units(),
            events: Vec::new(),
        };
        let summary = case.run(&mut listed)?;
        if listed.enough() {
            return Err(TraceError::TooLong);
        }
        let ended = matches!(summary.outcome, Outcome::LiftOff | Outcome::Diverged);
        let until = match spec.until {
            Some(until) if !(ended && until > summary.decided) => until,
            _ => summary.decided,
        };
        let mut recorder = Recorder::new(case, spec.sampling)?;
        recorder.record(until)?;
        // One motion twice, to rounding: a step that goes on to the end of what is asked for ends
        // elsewhere. Events of samples first.
        let mut events = recorder.events;
        let both = events.len();
        events.extend(listed.events.into_iter().skip(both));
        Ok(Self {
            samples: recorder.samples,
            events,
            summary,
        })
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

/// Lists the events of a motion.
struct Events {
    units: CaseUnits,
    events: Vec<TraceEvent>,
}

impl Observer for Events {
    fn step(&mut self, motion: &Motion, event: Option<Event>) {
        let there = event.map(|kind| physical(motion, kind, self.units));
        self.events.extend(there);
    }

    fn enough(&self) -> bool {
        self.events.len() > MOST_SAMPLES
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
struct Recorder {
    motion: Motion,
    /// Displacement since the start.
    x: f64,
    units: CaseUnits,
    steps: u64,
    sampling: Sampling,
    samples: Vec<Sample>,
    events: Vec<TraceEvent>,
}

/// One step of the motion, as it began.
#[derive(Clone, Copy)]
struct Begun {
    t: f64,
    x: f64,
    mode: Mode,
    /// An event or the beginning of the trace is there.
    marked: bool,
}

impl Recorder {
    fn new(case: &Case, sampling: Sampling) -> Result<Self, CaseError> {
        Ok(Self {
            motion: case.motion()?,
            x: 0.0,
            units: case.units(),
            steps: case.steps,
            sampling,
            samples: Vec::new(),
            events: Vec::new(),
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
            if self.motion.outgrows_its_past() {
                return Err(TraceError::OutgrowsPast);
            }
            let step = self.motion.last_step();
            self.x += step.displacement(step.length);
            self.sample_step(begun);
            let over = event == Some(Event::LiftOff) || self.motion.t >= end;
            if over || event == Some(Event::SwitchOn) {
                self.sample_end(begun, !over);
            }
            if self.samples.len() > MOST_SAMPLES {
                return Err(TraceError::TooLong);
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

    /// Samples the last step but for its end.
    fn sample_step(&mut self, begun: Begun) {
        let length = self.motion.last_step().length;
        match self.sampling {
            Sampling::PerStep(n) => {
                for part in 0..n {
                    self.add(begun, length * f64::from(part) / f64::from(n));
                }
            }
            Sampling::Interval(interval) => {
                let interval = interval / self.units.time;
                if begun.marked {
                    self.add(begun, 0.0);
                }
                let mut index = (begun.t / interval).ceil();
                while index * interval < begun.t + length && self.samples.len() <= MOST_SAMPLES {
                    self.add(begun, (index * interval - begun.t).max(0.0));
                    index += 1.0;
                }
            }
        }
    }

    /// Samples the end of the last step; `before`: next to it, because the next step begins with
    /// other values.
    fn sample_end(&mut self, begun: Begun, before: bool) {
        let length = self.motion.last_step().length;
        let mut sample = self.sample(begun, length);
        if before {
            sample.t = sample.t.next_down();
        } else {
            sample.mode = self.motion.mode();
        }
        self.push(sample);
    }

    fn add(&mut self, begun: Begun, s: f64) {
        let sample = self.sample(begun, s);
        self.push(sample);
    }

    fn push(&mut self, sample: Sample) {
        if self.samples.last().is_none_or(|last| last.t < sample.t) {
            self.samples.push(sample);
        }
    }

    /// The state `s` after the beginning of the last step.
    fn sample(&self, begun: Begun, s: f64) -> Sample {
        let (step, p, units) = (
            self.motion.last_step(),
            self.motion.parameters(),
            self.units,
        );
        let (u, a, n) = step.state(s);
        let difference = if begun.t >= p.switch_on {
            a - step.delayed_elongation(s)
        } else {
            0.0
        };
        Sample {
            t: (begun.t + s) * units.time,
            x: (begun.x + step.displacement(s)) * units.length,
            x_dot: u * units.velocity,
            a: a * units.length,
            v: (p.v0 + p.alpha_v * difference) * units.velocity,
            n: n * units.force,
            mode: begun.mode,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FIG3A: &str = include_str!("../../../sweeps/fig3a.toml");

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
        // x + a is where the spring is pulled: what v adds up to, by the trapezium rule.
        let mut pulled = samples[0].a;
        for w in samples.windows(2) {
            pulled += 0.5 * (w[1].t - w[0].t) * (w[0].v + w[1].v);
        }
        assert!((last.x + last.a - pulled).abs() < 1e-3, "{last:?} {pulled}");
        let stuck = samples.iter().filter(|s| s.mode == Mode::Stick);
        assert!(stuck.clone().count() > 50 && stuck.clone().all(|s| s.x_dot == 0.0));
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
        assert_eq!(Trace::of(&spec), Err(TraceError::TooLong));
    }
}
