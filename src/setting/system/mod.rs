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
//! # or matrices, x'(t) − E1 x'(t − tau) = A0 x(t) + A1 x(t − tau), E1 = 0 where it is left out
//! # A0 = [[0, 1], ["-k", -0.1]]
//! # A1 = [[0, 0], ["g", 0]]           # or feedback = { B, K, C } with A1 = B K C
//! # or powers of the delay, D = p0 + p1 e^(−s tau) + p2 e^(−2 s tau)
//! # D = ["s^2 + 1", "k*s", 0.1]
//! # or a loop, D = den + num e^(−s tau) of controller times plant
//! # plant = { num = ["K"], den = [1, 0.5, 0] }
//! # controller = "k_p + k_i/s"        # or pid = { k_p, k_i, k_d, t_f }
//!
//! # optional: so many roots at 0 at every delay come from the form and are no roots of the system
//! ignore_roots_at_zero = 0
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
//! - `closed_loop`: a loop of plant and controller, as transfer functions
//! - `expressed`: an expression as text and for evaluation
//! - `file`: reads the file; `forms`: the forms of a system; `matrices`: matrices in it
//! - `text`: writes it; [`shipped`]: systems that are part of the program
//! - `parameter`: a parameter of a system; `speed`: the speed of which its delay is the period

mod closed_loop;
mod expressed;
mod file;
pub(super) mod forms;
mod matrices;
pub mod parameter;
pub mod shipped;
mod speed;
mod text;

use std::borrow::Cow;
use std::sync::Arc;

use closed_loop::ClosedLoop;
use expressed::Expression;
use forms::MOST_POWERS;
use matrices::{Entries, Matrices};
use parameter::OwnParameter;

pub(crate) use speed::NO_SPEED;
pub use speed::{SpeedAxis, SpeedUnit, Turn};

use crate::linear::general::{OriginError, Polynomial, System};
use crate::linear::line::Linear;
use crate::linear::matrix::MatrixSystem;
use crate::model::Channel;
use crate::setting::expression::{Stacks, Tape};
use crate::setting::no_answer::NoAnswer;

/// The names of polynomials with powers of the delay.
const POWERS: [&str; MOST_POWERS] = [
    "D[0]", "D[1]", "D[2]", "D[3]", "D[4]", "D[5]", "D[6]", "D[7]", "D[8]",
];
/// The key of the number of roots that do not count.
const IGNORED_ROOTS: &str = "ignore_roots_at_zero";

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
    /// How many roots at 0, which it has at every delay, do not count.
    ignored_roots: usize,
    /// Its own parameters, in the order of the file.
    pub parameters: Vec<Arc<OwnParameter>>,
    /// The speed of the rotation of which the delay is the period, if it is one.
    pub speed_axis: Option<SpeedAxis>,
}

/// What D is made of, each part as text and in the form for evaluation.
#[derive(Debug, Clone, PartialEq)]
enum Form {
    /// P and Q.
    Direct([Expression; 2]),
    /// B and A.
    Feedback([Expression; 2]),
    /// A0 with A1, or with B, K and C.
    Matrices(Box<Matrices>),
    /// Σ p_k e^(−kλτ) of three or more.
    Powers(Vec<Expression>),
    /// A plant in a loop.
    Loop(Box<ClosedLoop>),
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

impl Evaluation {
    /// Puts the values of all names in their order.
    fn fill(&mut self) {
        self.values.clone_from(&self.own);
        self.values.push(self.tau);
    }
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
        self.tapes().any(|of| of.uses(tau))
    }

    /// What this system is where it has crossing curves and best settings only as far as its
    /// numbers make it P and Q, or none at all; none where it has them.
    #[must_use]
    pub(in crate::setting) fn without_curves(&self) -> Option<&'static str> {
        match self.form {
            Form::Matrices(_) => Some("a system of matrices that is no exact P + Q exp(-s tau)"),
            Form::Powers(_) => Some("a system with powers of its delay"),
            _ if self.ignored_roots > 0 => Some("a system with ignore_roots_at_zero"),
            _ => None,
        }
    }

    /// Whether parts of it vanish, with their poles, where a parameter is exactly 0: gains of a PID
    /// controller.
    #[must_use]
    pub(crate) fn drops_parts(&self) -> bool {
        matches!(&self.form, Form::Loop(of) if of.has_pid())
    }

    /// The polynomials and matrices as written, with their names.
    pub(crate) fn expressions(&self) -> Vec<(&'static str, Cow<'_, str>)> {
        if let Form::Matrices(of) = &self.form {
            let text = |of: &Entries| (of.name(), of.to_text(str::to_owned).into());
            return of.each().map(text).collect();
        }
        if let Form::Loop(of) = &self.form {
            return of.texts();
        }
        let all = self.polynomials();
        all.map(|(name, of)| (name, Cow::from(&of.text))).collect()
    }

    /// The polynomials, with their names.
    fn polynomials(&self) -> impl Iterator<Item = (&'static str, &Expression)> {
        let (names, all): (&[_], &[_]) = match &self.form {
            Form::Direct(all) => (&["P", "Q"], all),
            Form::Feedback(all) => (&["B", "A"], all),
            Form::Powers(all) => (&POWERS, all),
            Form::Matrices(_) | Form::Loop(_) => (&[], &[]),
        };
        names.iter().copied().zip(all)
    }

    /// All expressions in it.
    fn tapes(&self) -> Box<dyn Iterator<Item = &Tape> + '_> {
        match &self.form {
            Form::Matrices(of) => Box::new(of.each().flat_map(Entries::tapes)),
            Form::Loop(of) => Box::new(of.tapes()),
            _ => Box::new(self.polynomials().flat_map(|(_, of)| of.tapes())),
        }
    }

    /// All parameters at their defaults, without delay, memory and latency.
    #[must_use]
    pub fn defaults(&self) -> Evaluation {
        Evaluation {
            own: self.parameters.iter().map(|own| own.default).collect(),
            ..Evaluation::default()
        }
    }

    /// The linear model at a setting.
    ///
    /// # Errors
    /// Where an expression has no finite value, or the degree of A is not less than that of B.
    pub fn at(&self, at: &mut Evaluation) -> Result<Linear, NoAnswer> {
        at.fill();
        let found = match self.with_all_roots(at)? {
            Linear::General(system) if self.ignored_roots > 0 => system,
            found => return Ok(found),
        };
        let rest = found.without_roots_at_zero(self.ignored_roots);
        let rest = rest.map(|rest| Linear::General(Box::new(rest)));
        rest.map_err(|why| NoAnswer::Undefined {
            polynomial: IGNORED_ROOTS.into(),
            what: match why {
                OriginError::Fewer(0) => "D has no root at 0 at every delay here".into(),
                OriginError::Fewer(n) => {
                    format!("of the roots of D, {n} stays at 0 at every delay here, no more")
                }
                OriginError::Late => "with a latency, D(0) = 0 is not left out".into(),
            },
        })
    }

    /// The polynomials with powers of the delay at a setting; none in other forms.
    pub(super) fn powers_at(&self, at: &mut Evaluation) -> Result<Option<Vec<Vec<f64>>>, NoAnswer> {
        at.fill();
        match &self.form {
            Form::Powers(powers) => powers_of(powers, &at.values, &mut at.stacks).map(Some),
            _ => Ok(None),
        }
    }

    /// The numerator over D from a disturbance at the input of the plant to the output at a
    /// setting; none in other forms.
    pub(super) fn disturbed_through(
        &self,
        at: &mut Evaluation,
    ) -> Result<Option<Polynomial>, NoAnswer> {
        at.fill();
        match &self.form {
            Form::Loop(of) => of.disturbed_through(&at.values, &mut at.stacks).map(Some),
            _ => Ok(None),
        }
    }

    /// The system of the expressions; the values are in `at`.
    fn with_all_roots(&self, at: &mut Evaluation) -> Result<Linear, NoAnswer> {
        let (values, stacks) = (&at.values, &mut at.stacks);
        let system = match &self.form {
            Form::Powers(powers) => {
                let system = MatrixSystem::of_powers(&powers_of(powers, values, stacks)?);
                let system = system.map_err(|error| matrices::refused("D", &error))?;
                return Ok(Linear::Matrix(Box::new(system)));
            }
            Form::Matrices(of) => {
                let system = of.at(values, stacks)?;
                return Ok(Linear::Matrix(Box::new(system)));
            }
            Form::Direct([p, q]) => {
                System::direct(p.at("P", values, stacks)?, q.at("Q", values, stacks)?)
            }
            Form::Loop(of) => of.at(values, stacks)?,
            Form::Feedback([open, gain]) => {
                let (open, gain) = (open.at("B", values, stacks)?, gain.at("A", values, stacks)?);
                if !gain.is_zero() && gain.degree() >= open.degree() {
                    let (m, n) = (gain.degree(), open.degree());
                    let what = format!("its degree is {m} here and that of B {n}: not smaller");
                    return Err(NoAnswer::Undefined {
                        polynomial: "A".into(),
                        what,
                    });
                }
                System::feedback(open, gain, at.channel)
            }
        };
        Ok(Linear::General(Box::new(system)))
    }
}

/// The coefficients of polynomials with powers of the delay at these values.
fn powers_of(
    powers: &[Expression],
    values: &[f64],
    stacks: &mut Stacks,
) -> Result<Vec<Vec<f64>>, NoAnswer> {
    let each = POWERS.into_iter().zip(powers);
    let each = each.map(|(name, of)| {
        let found = of.at(name, values, stacks)?;
        Ok(found.coefficients().to_vec())
    });
    each.collect()
}

#[cfg(test)]
mod tests;
