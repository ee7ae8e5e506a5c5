//! The samples of a motion, up to a limit.

use super::trace::{Sample, Trace};

/// What happens to samples beyond a limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Most {
    /// This many are refused.
    Refused(usize),
    /// This many are thinned, repeatedly: every second sample goes, except those at events. This
    /// many events are refused.
    Thinned(usize),
}

impl Most {
    pub(super) const fn number(self) -> usize {
        match self {
            Self::Refused(most) | Self::Thinned(most) => most,
        }
    }
}

/// Samples at strictly increasing times.
#[derive(Debug)]
pub(super) struct Samples {
    most: Most,
    /// Samples, each with a flag: true if it is never thinned out.
    kept: Vec<(Sample, bool)>,
    /// Of the samples without the flag, one in this many is kept.
    stride: usize,
    /// How many were left out since the last one that was kept.
    passed: usize,
}

impl Samples {
    pub(super) fn new(most: Most) -> Self {
        Self {
            most,
            kept: Vec::new(),
            stride: 1,
            passed: 0,
        }
    }

    /// The limit.
    pub(super) fn most(&self) -> usize {
        self.most.number()
    }

    /// Whether there are too many.
    pub(super) fn too_many(&self) -> bool {
        self.kept.len() > self.most()
    }

    /// Adds a sample, unless there is already one at its time or it is thinned out. A `marked`
    /// sample is never thinned out.
    pub(super) fn add(&mut self, marked: bool, sample: impl FnOnce() -> Sample) {
        if !marked {
            self.passed += 1;
            if self.passed < self.stride {
                return;
            }
        }
        let sample = sample();
        if self.kept.last().is_some_and(|(last, _)| last.t >= sample.t) {
            return;
        }
        self.passed = 0;
        self.kept.push((sample, marked));
        if matches!(self.most, Most::Thinned(_)) && self.too_many() {
            self.thin();
        }
    }

    /// Removes every second of the samples that may be thinned out.
    fn thin(&mut self) {
        let mut odd = false;
        self.kept.retain(|(_, marked)| {
            odd = !odd && !marked;
            *marked || odd
        });
        self.stride *= 2;
    }

    pub(super) fn into_vec(self) -> Vec<Sample> {
        self.kept.into_iter().map(|(sample, _)| sample).collect()
    }
}

impl Trace {
    /// The same trace with `most` samples at most, unless there are more events: of the others
    /// every second one goes, again and again, but for the first and the last.
    #[must_use]
    pub fn thinned(self, most: usize) -> Self {
        let mut events = self.events.iter().map(|event| event.t).peekable();
        let last = self.samples.len().saturating_sub(1);
        let mut kept = Samples::new(Most::Thinned(most));
        for (place, sample) in self.samples.iter().enumerate() {
            while events.next_if(|&t| t < sample.t).is_some() {}
            let at_event = events.peek().is_some_and(|&t| t <= sample.t);
            kept.add(at_event || place == 0 || place == last, || *sample);
        }
        Self {
            samples: kept.into_vec(),
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::answers::trace::TraceEvent;
    use crate::slip::motion::{Event, Mode};
    use crate::slip::outcome::{Outcome, Summary};

    fn at(t: f64) -> Sample {
        Sample {
            t,
            x: 0.0,
            x_dot: 0.0,
            a: 0.0,
            v: 0.0,
            n: 1.0,
            pulling_force: 0.0,
            friction_force: 0.0,
            mode: Mode::Stick,
        }
    }

    #[test]
    fn what_is_marked_stays_and_the_rest_is_thinned_evenly() {
        let mut samples = Samples::new(Most::Thinned(100));
        for i in 0..10_000_u32 {
            samples.add(i % 500 == 0, || at(f64::from(i)));
            assert!(!samples.too_many());
        }
        let times: Vec<f64> = samples.into_vec().iter().map(|s| s.t).collect();
        assert!((50..=100).contains(&times.len()), "{}", times.len());
        assert!((0..20).all(|i| times.contains(&(500.0 * f64::from(i)))));
        let widest = times.windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max);
        assert!(widest <= 256.0, "{widest}");
        assert!(times.windows(2).all(|w| w[0] < w[1]));
    }

    #[test]
    fn a_trace_keeps_its_events_and_its_ends() {
        let event = |t: f64| TraceEvent {
            t,
            kind: Event::Release,
            a: 0.0,
        };
        let trace = Trace {
            samples: (0..5000_u32).map(|i| at(f64::from(i))).collect(),
            events: [0.5, 7.0, 8.0, 4321.0].map(event).into(),
            summary: Summary::without(Outcome::Sliding),
        };
        let few = trace.clone().thinned(60);
        let times: Vec<f64> = few.samples.iter().map(|s| s.t).collect();
        assert!((30..=60).contains(&times.len()), "{}", times.len());
        assert!(times.windows(2).all(|w| w[0] < w[1]));
        assert!(
            [0.0, 7.0, 8.0, 4321.0, 4999.0]
                .iter()
                .all(|t| times.contains(t))
        );
        assert_eq!(few.events, trace.events);
        assert_eq!(trace.clone().thinned(5000).samples, trace.samples);
    }

    #[test]
    fn too_many_marks_are_too_many() {
        for (most, marked) in [(Most::Thinned(10), true), (Most::Refused(10), false)] {
            let mut samples = Samples::new(most);
            for i in 0..12_u32 {
                samples.add(marked, || at(f64::from(i)));
            }
            assert!(samples.too_many(), "{most:?}");
        }
    }
}
