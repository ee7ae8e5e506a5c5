//! How many roots of a system with latency lie right of a vertical line: equation (7) of
//! [`right_of`](super::super::right_of) in either form of [`on_line`](super::on_line).
//!
//! With the delay inside, 𝒫 has the zeros of B right of the line, and arguments are those of B and
//! A and the principal ones of 1 − RE and 1 − E. With the latency inside, 𝒫 and 𝒬 are sums of two
//! terms each, and [`sum`](super::sum) carries their arguments along.

use std::f64::consts::{PI, TAU};

use super::super::parts::{Angle, FeedbackForm};
use super::super::right_of::{Factors, RootCounter, SAME_TURN};
use super::super::switches::Switches;
use super::super::system::Class;
use super::super::turning::{NoNumber, RightOf, Turn, Turning, WholeTurns};
use super::on_line::{Form, OnLine};
use super::sum::Sum;
use super::window::Window;
use crate::linear::real_zeros::{Switch, TooMany};
use crate::model::Channel;
use crate::model::elementary::{arg, atan2, sincos};

/// The part of a turn below which a root near the real axis cannot have made a whole one.
const NO_TURN: f64 = 0.25;

/// The relative precision of frequencies that decides nearly every turn.
const ROUGH: f64 = 1e-3;
/// Turns of the delay over the range of frequencies, less those of the latency, up to which the
/// form with the latency costs less: it needs no arguments of sums.
const CHEAPER: f64 = 12.0;

/// The arguments of B and A, continuous in ω ≥ 0.
struct Arguments<'f> {
    open: &'f Factors,
    gain: &'f Factors,
    line: f64,
}

impl Arguments<'_> {
    fn at(&self, omega: f64) -> [f64; 2] {
        [self.open, self.gain].map(|factors| factors.argument(self.line, omega))
    }
}

/// 𝒫 and 𝒬 as sums, in the form with the latency inside; where R = 0 the second is 𝒜 alone.
type Sums = (Sum, Option<Sum>);

/// One line in one form.
struct Way<'f> {
    on_line: &'f OnLine,
    form: Form,
    arguments: Arguments<'f>,
    sums: Option<Sums>,
    /// n_𝒫.
    zeros: i64,
}

impl<'f> Way<'f> {
    fn new(
        on_line: &'f OnLine,
        form: Form,
        (open, gain): (&'f Factors, &'f Factors),
        switches: &mut Switches,
    ) -> Option<Self> {
        let line = on_line.line;
        let arguments = Arguments { open, gain, line };
        let mut zeros = open.right_of(line) as i64;
        let sums = match form {
            Form::Latency => None,
            Form::Delay => {
                let Channel { memory, latency } = on_line.channel;
                let first = Sum::new(&on_line.difference(1.0, 1.0), switches, |omega| {
                    let [open, gain] = arguments.at(omega);
                    [open, gain + PI - omega * latency]
                })?;
                zeros += first.more_zeros();
                let second = if memory == 0.0 {
                    None
                } else {
                    let difference = on_line.difference(-memory * memory, -1.0);
                    let sum = Sum::new(&difference, switches, |omega| {
                        let [open, gain] = arguments.at(omega);
                        [gain - omega * latency, open + half_turn(-memory)]
                    });
                    Some(sum?)
                };
                Some((first, second))
            }
        };
        Some(Self {
            on_line,
            form,
            arguments,
            sums,
            zeros,
        })
    }

    /// φ and ψ of (7) at `omega`, continuous in ω.
    fn rough(&self, omega: f64) -> [f64; 2] {
        let [open, gain] = self.arguments.at(omega);
        let of = self.on_line;
        match &self.sums {
            None => {
                let [kept, lost] = of.echoes(omega);
                let lost = if of.decay.lost.value >= 0.0 {
                    // Principal, from −π/2 to π/2.
                    atan2(lost.im, lost.re.max(0.0))
                } else {
                    // −κe^(−iωτ) is the larger term.
                    let turn = omega * of.tau;
                    let (sin, cos) = sincos(turn);
                    let per_kappa = 1.0 / of.decay.kappa.value;
                    atan2(-per_kappa * sin, 1.0 - per_kappa * cos) - turn + PI
                };
                [open + arg(kept), gain + PI + lost]
            }
            Some((first, second)) => {
                let (b, a) = of.at(omega, 0.0);
                let (b, a) = (b.value, a.value);
                let turned = gain - omega * of.channel.latency;
                let before = first.argument(omega, [open, turned + PI], [b, -a]);
                let behind = second.as_ref().map_or(turned, |sum| {
                    let arguments = [turned, open + half_turn(-of.channel.memory)];
                    sum.argument(omega, arguments, [a, -of.channel.memory * b])
                });
                [before, behind]
            }
        }
    }

    /// φ − ψ at `switch`: whole turns from [`Way::rough`], the fraction from B and A themselves.
    fn phase(&self, switch: &Switch) -> Option<Angle> {
        let Angle { value, error } = self.on_line.phase(self.form, switch.omega, switch.error)?;
        let [before, behind] = self.rough(switch.omega);
        let rough = before - behind;
        // The argument of −𝒫 𝒬* is half a turn from that of 𝒫 𝒬*.
        let fraction = value + PI;
        let phase = fraction + TAU * ((rough - fraction) / TAU).round();
        ((phase - rough).abs() < SAME_TURN).then_some(Angle {
            value: phase,
            error: error + 4.0 * f64::EPSILON * phase.abs(),
        })
    }

    fn turn(&self, switch: &Switch) -> Option<Turn> {
        let phase = self.phase(switch)?;
        Some(Turn {
            omega: switch.omega,
            omega_error: switch.error,
            sign: f64::from(switch.sign),
            phase: phase.value,
            phase_error: phase.error,
        })
    }

    /// Passes every turn of the line to `each`; returns n_P + ν₀ of (7).
    fn turns(
        &self,
        (window, precision): (Window, f64),
        left: &mut u64,
        mut each: impl FnMut(Turn) -> bool,
    ) -> Result<i64, NoNumber> {
        let undecided = |_: TooMany| NoNumber::Undecided;
        let wave = self.on_line.wave(self.form);
        let start = wave
            .zeros(window, (precision, left), |switch| {
                self.turn(&switch).is_some_and(&mut each)
            })
            .map_err(undecided)?;
        let longest = self.on_line.tau + self.on_line.channel.latency;
        if start.open_below * longest > NO_TURN {
            return Err(NoNumber::Undecided);
        }
        let constant = wave.parts[0].coefficient(0);
        let mut without_turns = self.zeros;
        // Where that is open though D(σ) is not, |𝒫| = |𝒬| without a root: then ν₀ = 0.
        if constant.decided() && constant.value < 0.0 {
            let [before, behind] = self.rough(0.0);
            without_turns += ((behind - before) / PI).round() as i64;
        }
        Ok(without_turns)
    }
}

/// The argument of a real number: 0 or π.
fn half_turn(sign: f64) -> f64 {
    if sign < 0.0 { PI } else { 0.0 }
}

impl RootCounter {
    /// The number of roots with Re λ > `line` at the delay `tau` ≥ 0 by one form of (7), for a
    /// system in feedback form; both forms agree.
    #[must_use]
    pub fn right_of_by(&self, form: Form, tau: f64, line: f64) -> RightOf {
        match self.system().feedback_form() {
            Some(feedback) if tau > 0.0 => self.right_of_by_form(feedback, form, tau, line),
            _ => self.right_of(tau, line),
        }
    }

    /// The number of roots that [`RootCounter::right_of`] tells, with latency. The form that costs
    /// less is tried first, with frequencies to no more digits than a turn takes. Where that leaves
    /// the number open, all digits are used, and then the other form.
    pub(in super::super) fn late_right_of(
        &self,
        feedback: &FeedbackForm,
        tau: f64,
        line: f64,
    ) -> RightOf {
        let on_line = match self.late_line(feedback, tau, line) {
            Ok(on_line) => on_line,
            Err(why) => return why.into(),
        };
        let window = on_line.window();
        let swings = (tau - feedback.channel.latency) * (window.to - window.from);
        let forms = if swings < CHEAPER {
            [Form::Latency, Form::Delay]
        } else {
            [Form::Delay, Form::Latency]
        };
        [(forms[0], ROUGH), (forms[0], 0.0), (forms[1], 0.0)]
            .into_iter()
            .map(|(form, precision)| self.by_form(&on_line, form, (window, precision)))
            .find(|found| *found != RightOf::Undecided)
            .unwrap_or(RightOf::Undecided)
    }

    fn right_of_by_form(
        &self,
        feedback: &FeedbackForm,
        form: Form,
        tau: f64,
        line: f64,
    ) -> RightOf {
        match self.late_line(feedback, tau, line) {
            Ok(on_line) => self.by_form(&on_line, form, (on_line.window(), 0.0)),
            Err(why) => why.into(),
        }
    }

    fn by_form(&self, on_line: &OnLine, form: Form, to: (Window, f64)) -> RightOf {
        let turn_by = match form {
            Form::Delay => on_line.tau,
            Form::Latency => on_line.channel.latency,
        };
        let mut turned = WholeTurns::at(turn_by);
        let without_turns = self.turns_of(on_line, form, to, |turn| turned.add(&turn));
        turned.right_of(without_turns)
    }

    /// Equation (7) on the imaginary axis with latency: for every delay, or with a given delay for
    /// every latency.
    pub(in super::super) fn late_unstable(&self, form: Form, tau: f64) -> Option<Turning> {
        let on_line = self
            .late_line(self.system().feedback_form()?, tau, 0.0)
            .ok()?;
        let mut turns = Vec::new();
        let to = (on_line.window(), 0.0);
        let without_turns = self.turns_of(&on_line, form, to, |turn| {
            turns.push(turn);
            true
        });
        Some(Turning {
            without_turns: without_turns.ok()?,
            turns,
            at_origin: None,
        })
    }

    fn late_line(&self, feedback: &FeedbackForm, tau: f64, line: f64) -> Result<OnLine, NoNumber> {
        let open = NoNumber::Undecided;
        match self.system().class() {
            Class::DegreeUnknown | Class::Refused => return Err(open),
            Class::Infinite => return Err(NoNumber::Infinite),
            _ => {}
        }
        let on_line = OnLine::new(feedback, tau, line).ok_or(open)?;
        if !on_line.right_of_essential().ok_or(open)? {
            return Err(NoNumber::Infinite);
        }
        if !on_line.on_real_axis().decided() {
            return Err(open);
        }
        Ok(on_line)
    }

    fn turns_of(
        &self,
        on_line: &OnLine,
        form: Form,
        to: (Window, f64),
        each: impl FnMut(Turn) -> bool,
    ) -> Result<i64, NoNumber> {
        let mut switches = Switches::default();
        let way = Way::new(on_line, form, self.late_factors(), &mut switches);
        let way = way.ok_or(NoNumber::Undecided)?;
        self.budget.spend(|left| way.turns(to, left, each))
    }
}
