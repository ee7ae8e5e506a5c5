//! Stick and slip by restarts: the crate integrates between kinks and is told where they are.

use crate::history::History;
use crate::problem::{END, Parameters, Regime, State};
use crate::segment::{Method, follow};

/// Kinks are stepped on this often, one delay after the other, while they grow smoother.
const ECHOES: usize = 4;

/// Times nearer than this are the same.
const SAME: f64 = 1e-11;

/// The times at which segments must end.
struct Stops(Vec<f64>);

impl Stops {
    fn add(&mut self, time: f64) {
        let place = self.0.partition_point(|&t| t <= time);
        self.0.insert(place, time);
    }

    fn next(&self, t: f64) -> f64 {
        let place = self.0.partition_point(|&s| s <= t + SAME);
        self.0.get(place).map_or(END, |&s| s.min(END))
    }
}

/// The motion from rest at a = 0 to [`END`].
pub fn run(p: Parameters, setting: (Method, f64)) -> History {
    let mut history = History::default();
    let mut stops = Stops(Vec::new());
    for echo in 0..=ECHOES {
        stops.add(p.switch_on + echo as f64 * p.tau);
    }
    let (mut t, mut state) = (0.0, State::zeros());
    let mut regime = Regime {
        parameters: p,
        controlled: false,
        direction: 0.0,
    };
    while t < END - SAME {
        regime.controlled = t >= p.switch_on - SAME;
        let mut end = stops.next(t);
        if regime.controlled {
            end = end.min(t + p.tau);
        }
        if !regime.slips() && state[0].abs() >= load(&regime, &history, t, &state) - 1e-13 {
            regime.direction = state[0].signum();
        }
        let segment = follow(regime, &history, (t, state), end, setting);
        history.pieces.extend(segment.pieces);
        (t, state) = (segment.t, segment.state);
        if segment.event {
            (regime.direction, state[1]) = after_event(&regime, &history, t, &state);
            for echo in 0..=ECHOES {
                let time = t + echo as f64 * p.tau;
                if time > t + SAME && time > p.switch_on {
                    stops.add(time);
                }
            }
        }
    }
    history
}

fn load(regime: &Regime, history: &History, t: f64, state: &State) -> f64 {
    let delayed = history.at(t - regime.parameters.tau)[0];
    regime.load(state[0], delayed)
}

/// Direction and velocity after release or after coming to rest.
fn after_event(regime: &Regime, history: &History, t: f64, state: &State) -> (f64, f64) {
    let holds = regime.slips() && state[0].abs() < load(regime, history, t, state);
    let velocity = if regime.slips() { 0.0 } else { state[1] };
    let direction = if holds { 0.0 } else { state[0].signum() };
    (direction, velocity)
}
