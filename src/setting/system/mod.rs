//! A linear system with one delay from a file: P and Q, or B and A, as expressions of parameters
//! with names of their own.
//!
//! ```toml
//! title = "Turning with one mode"         # optional
//! P = "s^2 + 2*zeta*s + 1 + width"        # D = P + Q e^(−s tau)
//! Q = "-width"
//! # or as coefficients, the highest power first
//! # P = [1, "2*zeta", "1 + width"]
//! # Q = ["-width"]
//! # or the feedback form, deg A < deg B: D = B(1 − R e^(−s tau)) − A e^(−s δ)(1 − e^(−s tau)),
//! # with memory R and latency δ as parameters of every such system
//! # B = "s^2 + b*s + 1"
//! # A = "gain"
//!
//! [parameters]                            # a name for each
//! zeta = { long_name = "damping ratio", default = 0.02, minimum = 0 }
//! width = 0                               # or its default alone; 0 where there is none
//!
//! # optional: the delay is the period of a rotation, with this speed, 60/tau for "rpm"
//! [speed_axis]
//! name = "spindle_speed"
//! period = "tau"
//! unit = "rpm"
//! ```
//!
//! - `file`: reads the file; `text`: writes it; [`shipped`]: systems that are part of the program
//! - `parameter`: a parameter of a system; `speed`: the speed of which its delay is the period

mod file;
pub mod parameter;
pub mod shipped;
mod speed;
mod text;

use std::ops::Range;
use std::sync::Arc;

use parameter::OwnParameter;

pub(crate) use speed::NO_SPEED;
pub use speed::{SpeedAxis, SpeedUnit, Turn};

use crate::linear::general::System;
use crate::model::Channel;
use crate::setting::expression::{Stacks, Tape};
use crate::setting::no_answer::NoAnswer;

/// A system whose parameters have no values yet.
///
/// ```
/// use slipmap::model::stop::Stop;
/// use slipmap::setting::Setting;
/// use slipmap::setting::system::SystemModel;
/// use std::sync::Arc;
///
/// let model: SystemModel = "
/// P = \"s^2 + 2*zeta*s + 1\"
/// Q = \"k\"
/// [parameters]
/// zeta = { default = 0.05, long_name = \"damping ratio\" }
/// k = { default = 0.2, long_name = \"gain\" }
/// ".parse()?;
/// let setting = Setting::of_system(Arc::new(model));
/// let (linear, time_unit) = setting.linear()?;
/// let roots = linear.roots(&Stop::default());
/// assert_eq!(roots.count(0.1, time_unit).unwrap().n_unstable, 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct SystemModel {
    /// Title for pictures and maps; may be empty.
    pub title: String,
    form: Form,
    /// Its own parameters, in the order of the file.
    pub parameters: Vec<Arc<OwnParameter>>,
    /// The speed of the rotation of which the delay is the period, if it is one.
    pub speed_axis: Option<SpeedAxis>,
}

/// Two polynomials, each as text and in the form for evaluation.
#[derive(Debug, Clone, PartialEq)]
enum Form {
    /// P and Q.
    Direct([Expression; 2]),
    /// B and A.
    Feedback([Expression; 2]),
}

#[derive(Debug, Clone, PartialEq)]
struct Expression {
    text: String,
    tape: Tape,
}

/// The values on which a system depends, and scratch space for its evaluation.
#[derive(Debug, Clone, Default)]
pub struct Evaluation {
    /// The own parameters, in the order of [`SystemModel::parameters`].
    pub own: Vec<f64>,
    /// τ ≥ 0.
    pub tau: f64,
    /// R and δ; in feedback form only.
    pub channel: Channel,
    values: Vec<f64>,
    stacks: Stacks,
}

impl PartialEq for Evaluation {
    fn eq(&self, other: &Self) -> bool {
        let numbers = |e: &Self| [e.tau, e.channel.memory, e.channel.latency].map(f64::to_bits);
        self.own == other.own && numbers(self) == numbers(other)
    }
}

impl SystemModel {
    /// Whether the system is given as B and A; memory and latency are then parameters.
    #[must_use]
    pub(crate) fn is_feedback(&self) -> bool {
        matches!(self.form, Form::Feedback(_))
    }

    /// Whether the polynomials depend on the delay; there is then no line of delays.
    #[must_use]
    pub(crate) fn depends_on_delay(&self) -> bool {
        let tau = self.parameters.len();
        self.polynomials().any(|(_, of)| of.tape.uses(tau))
    }

    /// The polynomials as written, with their names.
    pub(crate) fn expressions(&self) -> impl Iterator<Item = (&'static str, &str)> {
        self.polynomials().map(|(name, of)| (name, &*of.text))
    }

    fn polynomials(&self) -> impl Iterator<Item = (&'static str, &Expression)> {
        let (names, all) = match &self.form {
            Form::Direct(all) => (["P", "Q"], all),
            Form::Feedback(all) => (["B", "A"], all),
        };
        names.into_iter().zip(all)
    }

    /// All parameters at their defaults, without delay, memory and latency.
    #[must_use]
    pub fn defaults(&self) -> Evaluation {
        Evaluation {
            own: self.parameters.iter().map(|own| own.default).collect(),
            ..Evaluation::default()
        }
    }

    /// The system at a setting.
    ///
    /// # Errors
    /// Where an expression has no finite value, or the degree of A is not less than that of B.
    pub fn at(&self, at: &mut Evaluation) -> Result<System, NoAnswer> {
        at.values.clone_from(&at.own);
        at.values.push(at.tau);
        let (values, stacks) = (&at.values, &mut at.stacks);
        match &self.form {
            Form::Direct([p, q]) => Ok(System::direct(
                p.at("P", values, stacks)?,
                q.at("Q", values, stacks)?,
            )),
            Form::Feedback([open, gain]) => {
                let (open, gain) = (open.at("B", values, stacks)?, gain.at("A", values, stacks)?);
                if !gain.is_zero() && gain.degree() >= open.degree() {
                    let (m, n) = (gain.degree(), open.degree());
                    let what = format!("its degree is {m} here and that of B {n}: not smaller");
                    return Err(NoAnswer::Undefined {
                        polynomial: "A",
                        what,
                    });
                }
                Ok(System::feedback(open, gain, at.channel))
            }
        }
    }
}

impl Expression {
    fn at(
        &self,
        polynomial: &'static str,
        values: &[f64],
        stacks: &mut Stacks,
    ) -> Result<crate::linear::general::Polynomial, NoAnswer> {
        self.tape.at(values, stacks).map_err(|place: Range<usize>| {
            let part = self.text.get(place).unwrap_or(&self.text);
            NoAnswer::Undefined {
                polynomial,
                what: format!("`{part}` has no finite value at this setting"),
            }
        })
    }
}

#[cfg(test)]
mod tests;
