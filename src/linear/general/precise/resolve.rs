//! The crossings at zeros of F that f64 blurs.

use super::super::parts::Angle;
use super::super::system::System;
use super::number::{Number, UNIT};
use super::on_axis::{At, OnAxis};
use crate::linear::real_zeros::Switch;

/// A phase is blurred where its error may be larger than this: in systems up to the degree of a
/// feedback loop, and above. The bounds of ordinary systems grow with the degree, and are not to
/// make them slow.
const BLURRED_PHASE: [f64; 2] = [1e-9, 1e-6];
/// The highest degree of a feedback loop: friction with a state, and three lags.
const OF_LOOPS: usize = 6;
/// A frequency is blurred where its relative error may be larger than this.
const BLURRED_FREQUENCY: f64 = 1e-9;
/// Rounding errors of the gains and the slope themselves, in units of ε of what they make of F: two
/// zeros that these may join are a touch.
const ROUNDINGS: f64 = 16.0;
/// The most steps of Newton's method: they double the digits.
const MOST_STEPS: usize = 12;
/// Steps below this part of ω are the last.
const LAST_STEP: f64 = 16.0 * UNIT;

/// Whether the crossing at `switch` with the argument `phase` of −P Q* is known too little: the
/// zero may be several, or the phase is uncertain, or it may be 0 as well as 2π.
#[inline]
pub(in super::super) fn blurred(system: &System, switch: &Switch, phase: Option<&Angle>) -> bool {
    let allowed = BLURRED_PHASE[usize::from(system.p.degree().max(system.q.degree()) > OF_LOOPS)];
    let known = phase.is_some_and(|of| of.error <= allowed && is_not_0(of, switch));
    !(known && switch.simple && switch.error <= BLURRED_FREQUENCY * switch.omega)
}

/// Whether the argument `phase` of −P Q* is known not to be 0 at the zero near `switch`.
#[inline]
pub(in super::super) fn is_not_0(phase: &Angle, switch: &Switch) -> bool {
    phase.value.abs() > phase.error + 2.0 * switch.error
}

/// A crossing that was found with many digits.
#[derive(Clone, Copy)]
pub(in super::super) struct Resolved {
    /// Its frequency.
    pub switch: Switch,
    /// The argument of −P Q* there.
    pub phase: Angle,
    /// Whether the argument is known to be on one side of 0.
    pub decided: bool,
}

/// Resolves the crossings of one line.
pub(in super::super) struct Resolver<'s> {
    system: &'s System,
    /// The delay, where the line is one of latencies.
    tau: Option<f64>,
    on_axis: Option<Box<OnAxis>>,
}

/// A zero of F, and how far it may be from there.
#[derive(Clone, Copy)]
struct Zero {
    omega: Number,
    radius: f64,
}

impl<'s> Resolver<'s> {
    /// For the line of delays of `system`.
    pub(in super::super) fn new(system: &'s System) -> Self {
        Self {
            system,
            tau: None,
            on_axis: None,
        }
    }

    /// For the line of latencies of `system` at the delay `tau`.
    pub(in super::super) fn of_latencies(system: &'s System, tau: f64) -> Self {
        Self {
            tau: Some(tau),
            ..Self::new(system)
        }
    }

    /// The system.
    pub(in super::super) fn system(&self) -> &System {
        self.system
    }

    /// The crossings at `switch`, no more than two; none of them where F has no zeros there after
    /// all. None where that stays open.
    #[cold]
    #[inline(never)]
    pub(in super::super) fn resolve(&mut self, switch: &Switch) -> Option<[Option<Resolved>; 2]> {
        if self.on_axis.is_none() {
            self.on_axis = match self.tau {
                None => Some(Box::new(OnAxis::of_delays(self.system))),
                Some(tau) => OnAxis::of_latencies(self.system, tau).map(Box::new),
            };
        }
        let on_axis = self.on_axis.as_deref()?;
        Around { on_axis, switch }.resolve()
    }
}

/// F around one switch.
struct Around<'a> {
    on_axis: &'a OnAxis,
    switch: &'a Switch,
}

impl Around<'_> {
    fn resolve(&self) -> Option<[Option<Resolved>; 2]> {
        let Switch {
            omega,
            error,
            sign,
            simple,
        } = *self.switch;
        let centre = Number::of(omega);
        if simple {
            return Some([Some(self.crossing(centre, sign)?), None]);
        }
        let bend = 2.0 * self.on_axis.at(centre)?.bend().abs();
        if bend <= self.on_axis.third(omega + error) * error {
            return None;
        }
        // F″ keeps its sign: F′ vanishes where its sign differs at both ends.
        let [low, high] = [-error, error].map(|by| self.slope(centre + Number::of(by)));
        match (low?, high?) {
            (low, high) if low != high => self.beside_extremum(),
            _ if sign == 0 => Some([None, None]),
            _ => Some([Some(self.crossing(centre, sign)?), None]),
        }
    }

    /// Whether F grows at `omega`; none where that is open.
    fn slope(&self, omega: Number) -> Option<bool> {
        let slope = self.on_axis.at(omega)?.slope();
        slope.decided().then_some(slope.value > 0.0)
    }

    /// The crossings where F′ vanishes once: at most one on each side of that place.
    fn beside_extremum(&self) -> Option<[Option<Resolved>; 2]> {
        let (extremum, at) = self.extremum()?;
        let (value, bend) = (at.modulus(), at.bend());
        let expected = self.switch.sign;
        let possible = value.error + ROUNDINGS * f64::EPSILON * at.size();
        if value.value.abs() <= possible {
            let apart = ((value.value.abs() + possible) / bend.abs()).sqrt();
            let touch = self.touch(extremum, &at, apart).filter(|_| expected == 0);
            return Some([Some(touch?), None]);
        }
        if (value.value > 0.0) == (bend > 0.0) {
            return (expected == 0).then_some([None, None]);
        }
        let half = (-value.value / bend).sqrt();
        let upwards = if bend > 0.0 { 1 } else { -1 };
        let side = |sign: i8| {
            let start = extremum + Number::of(f64::from(sign) * half);
            self.crossing(start, sign * upwards)
        };
        match expected {
            0 => Some([Some(side(1)?), Some(side(-1)?)]),
            sign => Some([Some(side(sign * upwards)?), None]),
        }
    }

    /// Where F′ vanishes in the range of the switch, and F there.
    fn extremum(&self) -> Option<(Number, At)> {
        let mut omega = Number::of(self.switch.omega);
        for _ in 0..MOST_STEPS {
            let at = self.on_axis.at(omega)?;
            let slope = at.slope();
            let step = slope.value / (2.0 * at.bend());
            omega = omega - Number::of(step);
            if !self.in_range(omega) {
                return None;
            }
            if step.abs() <= LAST_STEP * omega.value() || !slope.decided() {
                return Some((omega, self.on_axis.at(omega)?));
            }
        }
        None
    }

    fn in_range(&self, omega: Number) -> bool {
        let Switch {
            omega: at, error, ..
        } = *self.switch;
        let apart = (omega - Number::of(at)).value().abs();
        apart <= error * (1.0 + 1e-9) + f64::EPSILON * at
    }

    /// The simple zero to which Newton's method leads from `start`.
    fn zero(&self, start: Number) -> Option<Zero> {
        let mut omega = start;
        for _ in 0..MOST_STEPS {
            let at = self.on_axis.at(omega)?;
            let (value, slope) = (at.modulus(), at.slope());
            let step = value.value / slope.value;
            if step.abs() > LAST_STEP * omega.value() && value.decided() {
                omega = omega - Number::of(step);
                if !self.in_range(omega) {
                    return None;
                }
                continue;
            }
            let least = slope.value.abs() - slope.error;
            let above = value.value.abs() + value.error;
            let radius = 4.0 * above / least + LAST_STEP * omega.value();
            let third = self.on_axis.third(omega.value() + radius);
            let change = (2.0 * at.bend().abs() + third * radius) * radius;
            return (least > 0.0 && change <= 0.25 * least).then_some(Zero { omega, radius });
        }
        None
    }

    /// The crossing at the zero to which `start` leads, where F changes its sign by `sign`.
    fn crossing(&self, start: Number, sign: i8) -> Option<Resolved> {
        let Zero { omega, radius } = self.zero(start)?;
        let at = self.on_axis.at(omega)?;
        let rises = if at.slope().value > 0.0 { 1 } else { -1 };
        let phase = phase(&at, radius).filter(|_| rises == sign)?;
        Some(Self::resolved(omega, radius, sign, phase))
    }

    /// Two zeros that may be one, no farther than `apart` from the extremum of F.
    fn touch(&self, extremum: Number, at: &At, apart: f64) -> Option<Resolved> {
        let nearer = apart < self.switch.error;
        let phase = phase(at, apart).filter(|_| nearer)?;
        Some(Self::resolved(extremum, apart, 0, phase))
    }

    fn resolved(omega: Number, radius: f64, sign: i8, (phase, decided): (Angle, bool)) -> Resolved {
        let omega = omega.value();
        let switch = Switch {
            omega,
            error: radius + f64::EPSILON * omega,
            sign,
            simple: sign != 0,
        };
        Resolved {
            switch,
            phase,
            decided,
        }
    }
}

/// The argument of −P Q* where the frequency is known to within `moved`, and whether it is known to
/// be on one side of 0.
fn phase(at: &At, moved: f64) -> Option<(Angle, bool)> {
    let [along, across] = at.turned(moved);
    let beyond = along.value < -along.error;
    let angle = Angle::of(along.value, -across.value, along.error, across.error)?;
    Some((angle, beyond || across.decided()))
}
