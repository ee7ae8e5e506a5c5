//! The part of a trace that a picture shows.

use super::error::PictureError;
use super::panels::Panel;
use crate::answers::Trace;
use crate::answers::trace::{Sample, TraceEvent};
use crate::meaning::scale::Scale;
use crate::slip::motion::Event;

/// A stretch of time of a trace.
#[derive(Debug, Clone, Copy)]
pub(super) struct Span<'t> {
    trace: &'t Trace,
    /// Its samples.
    pub samples: &'t [Sample],
    /// When it begins and ends.
    ends: [f64; 2],
}

impl<'t> Span<'t> {
    /// From one time to another, which are those of the whole trace where none are given.
    pub(super) fn of(trace: &'t Trace, asked: [Option<f64>; 2]) -> Result<Self, PictureError> {
        let last = trace.samples.last().map_or(0.0, |sample| sample.t);
        let [from, to] = [asked[0].unwrap_or(0.0), asked[1].unwrap_or(last)];
        let to = to.min(last);
        let begun = trace.samples.partition_point(|sample| sample.t < from);
        let ended = trace.samples.partition_point(|sample| sample.t <= to);
        let few = ended < begun + 2 || !(from.is_finite() && to.is_finite());
        if few && asked != [None, None] {
            return Err(PictureError::NoTime { last });
        }
        Ok(Self {
            trace,
            samples: &trace.samples[begun.min(ended)..ended],
            ends: [from, to],
        })
    }

    /// A part of it, with a sample more at both ends, where there is one.
    pub(super) fn part(&self, [from, to]: [f64; 2]) -> Self {
        let begun = self.samples.partition_point(|sample| sample.t <= from);
        let ended = self.samples.partition_point(|sample| sample.t < to);
        let begun = begun.saturating_sub(1);
        let ended = (ended + 1).min(self.samples.len()).max(begun);
        Self {
            trace: self.trace,
            samples: &self.samples[begun..ended],
            ends: [from, to],
        }
    }

    /// When it begins and ends.
    pub(super) fn ends(&self) -> [f64; 2] {
        self.ends
    }

    /// When it ends.
    pub(super) fn end(&self) -> f64 {
        self.ends[1]
    }

    /// Whether a time is shown.
    pub(super) fn holds(&self, t: f64) -> bool {
        (self.ends[0]..=self.ends[1]).contains(&t)
    }

    /// The scale of its times.
    pub(super) fn scale(&self) -> Scale {
        let [from, to] = self.ends;
        // A lift-off ends the trace; its mark needs room beside the frame.
        let room = if self.lifts_off() { 0.03 } else { 0.0 };
        match to > from {
            true => Scale::linear(from, to + room * (to - from)),
            false => Scale::linear(from, from + 1.0),
        }
    }

    /// The events with a mark of their own.
    pub(super) fn marked(&self) -> impl Iterator<Item = &'t TraceEvent> {
        let here = *self;
        let events = self.trace.events.iter();
        events
            .filter(move |event| here.holds(event.t))
            .filter(|event| matches!(event.kind, Event::SwitchOn | Event::LiftOff))
    }

    fn lifts_off(&self) -> bool {
        self.marked().any(|event| event.kind == Event::LiftOff)
    }

    /// Stretches of time in which the block sticks.
    pub(super) fn sticks(&self) -> Vec<(f64, f64)> {
        let [begin, end] = self.ends;
        let sticks = self.trace.sticks().into_iter();
        let within = sticks.map(|(from, to)| (from.max(begin), to.min(end)));
        within.filter(|(from, to)| from < to).collect()
    }

    /// Whether a panel is wide enough for its sticks to be seen: one is a pixel wide, or several
    /// that lie closer than a pixel are.
    pub(super) fn sticks_in(&self, panel: &Panel) -> bool {
        let mut joined: Option<(f64, f64)> = None;
        for (from, to) in self.sticks() {
            let (left, right) = (panel.across(from), panel.across(to));
            let since = match joined {
                Some((since, last)) if left - last < 1.0 => since,
                _ => left,
            };
            if right.min(panel.area.right) - since.max(panel.area.left) >= 1.0 {
                return true;
            }
            joined = Some((since, right));
        }
        false
    }
}
