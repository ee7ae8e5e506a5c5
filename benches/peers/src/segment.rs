//! One stretch between two kinks: the crate integrates, this records its dense output and looks for
//! the event.
//!
//! The crate's own events give several of these motions wrong events, or wrong event times: hence
//! the search here.

use differential_equations::control::ControlFlag;
use differential_equations::interpolate::Interpolation;
use differential_equations::prelude::{ExplicitRungeKutta, IVP, Solout};
use differential_equations::solution::Solution;

use crate::history::{History, NODES, Piece};
use crate::problem::{Regime, State};

#[derive(Debug, Clone, Copy)]
pub enum Method {
    Dopri5,
    Dop853,
    Rkv878e,
}

impl Method {
    pub const ALL: [(&str, Self); 3] = [
        ("dopri5", Self::Dopri5),
        ("dop853", Self::Dop853),
        ("rkv878e", Self::Rkv878e),
    ];
}

pub struct Segment {
    pub pieces: Vec<Piece>,
    pub t: f64,
    pub state: State,
    /// Whether an event ended it.
    pub event: bool,
}

/// Records steps until an event.
struct Recorder<'a> {
    regime: Regime,
    past: &'a History,
    pieces: Vec<Piece>,
    last: (f64, State),
    /// Events count after the motion has been on the near side once.
    armed: bool,
    event: bool,
}

impl Recorder<'_> {
    /// Positive until the event: the speed in slip, what holds the block in stick.
    fn distance(&self, t: f64, state: &State) -> f64 {
        if self.regime.slips() {
            return self.regime.direction * state[1];
        }
        let delayed = self.past.at(t - self.regime.parameters.tau)[0];
        self.regime.load(state[0], delayed) - state[0].abs()
    }

    /// The event in a step whose end lies beyond it, by regula falsi (Illinois).
    fn locate<I>(&self, from: (f64, State), to: (f64, State), dense: &mut I) -> (f64, State)
    where
        I: Interpolation<f64, State> + ?Sized,
    {
        let (mut low, mut high) = (from.0, to.0);
        let mut found = to.1;
        let (mut at_low, mut at_high) = (self.distance(low, &from.1), self.distance(high, &found));
        let mut side = 0;
        while at_high < 0.0 && high - low > 1e-15 * (1.0 + high) {
            let chord = (low * at_high - high * at_low) / (at_high - at_low);
            let inside = at_low > 0.0 && chord > low && chord < high;
            let middle = if inside { chord } else { 0.5 * (low + high) };
            if middle <= low || middle >= high {
                break;
            }
            let state = dense.interpolate(middle).expect("within the step");
            let value = self.distance(middle, &state);
            if value <= 0.0 {
                (high, at_high, found) = (middle, value, state);
                at_low *= if side < 0 { 0.5 } else { 1.0 };
                side = -1;
            } else {
                (low, at_low) = (middle, value);
                at_high *= if side > 0 { 0.5 } else { 1.0 };
                side = 1;
            }
        }
        (high, found)
    }
}

impl Solout<f64, State> for &mut Recorder<'_> {
    fn solout<I>(
        &mut self,
        t: f64,
        before: f64,
        state: &State,
        state_before: &State,
        dense: &mut I,
        _: &mut Solution<f64, State>,
    ) -> ControlFlag<f64, State>
    where
        I: Interpolation<f64, State> + ?Sized,
    {
        if t <= before {
            return ControlFlag::Continue;
        }
        let length = t - before;
        let mut values = [*state_before; NODES];
        values[NODES - 1] = *state;
        for (k, value) in values.iter_mut().enumerate().take(NODES - 1).skip(1) {
            let at = before + length * k as f64 / (NODES - 1) as f64;
            *value = dense.interpolate(at).expect("within the step");
        }
        self.pieces.push(Piece {
            from: before,
            length,
            values,
        });
        self.last = (t, *state);
        let distance = self.distance(t, state);
        if self.armed && distance <= 0.0 {
            self.last = self.locate((before, *state_before), self.last, dense);
            self.event = true;
            return ControlFlag::Terminate;
        }
        self.armed |= distance > 0.0;
        ControlFlag::Continue
    }
}

/// Follows `regime` from `start` to `end` or the event that ends it.
pub fn follow(
    regime: Regime,
    past: &History,
    start: (f64, State),
    end: f64,
    (method, tolerance): (Method, f64),
) -> Segment {
    let mut recorder = Recorder {
        regime,
        past,
        pieces: Vec::new(),
        last: start,
        armed: false,
        event: false,
    };
    recorder.armed = recorder.distance(start.0, &start.1) > 0.0;
    let problem = IVP::dde(&regime, start.0, end, start.1, |t| past.at(t)).solout(&mut recorder);
    let solved = match method {
        Method::Dopri5 => {
            let method = ExplicitRungeKutta::dopri5();
            problem
                .method(method.rtol(tolerance).atol(tolerance))
                .solve()
        }
        Method::Dop853 => {
            let method = ExplicitRungeKutta::dop853();
            problem
                .method(method.rtol(tolerance).atol(tolerance))
                .solve()
        }
        Method::Rkv878e => {
            let method = ExplicitRungeKutta::rkv878e();
            problem
                .method(method.rtol(tolerance).atol(tolerance))
                .solve()
        }
    };
    solved.unwrap_or_else(|e| panic!("{method:?} at {tolerance:e}, t = {}: {e:?}", start.0));
    Segment {
        pieces: recorder.pieces,
        t: recorder.last.0,
        state: recorder.last.1,
        event: recorder.event,
    }
}
