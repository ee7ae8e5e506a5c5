//! The compositions of D: of P and Q, of B and A, and of B and A with latency. Lines, crossings and
//! bounds ask here which it is; jets and counts right of a line tell a latency by themselves.

use num_complex::Complex64;

use super::isolate::MOST;
use super::parts::{Angle, Decay, FeedbackForm};
use super::polynomial::Polynomial;
use super::reason::Reason;
use super::shifted::Shifted;
use super::switches::{NearZero, Switches, each_switch};
use super::system::{Class, System};
use crate::linear::characteristic::Jet;
use crate::linear::collocation::eigenvalues;
use crate::linear::real_zeros::Switch;
use crate::model::Channel;

/// An error of a phase that is not worth a slower evaluation, up to the degree of which zeros of F
/// are isolated and above.
const ENOUGH: [f64; 2] = [1e-6, 1e-11];

/// What D is composed of.
#[derive(Debug, Clone, Copy)]
pub(super) enum Composition {
    /// P and Q.
    Direct,
    /// P and Q, less a root at 0 at every delay.
    BesideOrigin,
    /// B, A and R, with digits that P and Q lose.
    Feedback(FeedbackForm),
    /// B, A and R with a latency: only without it P and Q say it all.
    Late(FeedbackForm),
}

impl From<FeedbackForm> for Composition {
    fn from(feedback: FeedbackForm) -> Self {
        if feedback.channel.latency > 0.0 {
            Self::Late(feedback)
        } else {
            Self::Feedback(feedback)
        }
    }
}

/// An error of a phase that is not worth a slower evaluation in a system of this degree.
pub(in crate::linear) fn enough(degree: usize) -> f64 {
    ENOUGH[usize::from(degree > MOST)]
}

impl Composition {
    /// This composition with all polynomials divided by λ.
    pub(super) fn divided_by_variable(&self) -> Self {
        match self {
            Self::Late(feedback) => Self::Late(feedback.divided_by_variable()),
            _ => Self::Direct,
        }
    }
}

impl System {
    /// The feedback form, where the system is in it.
    #[inline]
    pub(super) fn feedback_form(&self) -> Option<&FeedbackForm> {
        match &self.composition {
            Composition::Direct | Composition::BesideOrigin => None,
            Composition::Feedback(feedback) | Composition::Late(feedback) => Some(feedback),
        }
    }

    /// The latency δ; 0 where there is none.
    #[inline]
    #[must_use]
    pub fn latency(&self) -> f64 {
        self.feedback_form().map_or(0.0, |f| f.channel.latency)
    }

    /// This system with the latency `latency` ≥ 0; none where it is not in feedback form.
    #[must_use]
    pub fn with_latency(&self, latency: f64) -> Option<Self> {
        if self.uncontrolled() {
            return Some(*self);
        }
        let FeedbackForm {
            open,
            gain,
            channel,
        } = *self.feedback_form()?;
        let mut late = Self::feedback(open, gain, Channel { latency, ..channel });
        late.source = self.source;
        Some(late)
    }

    /// The class of what D is composed of.
    pub(super) fn find_class(&self) -> Class {
        match &self.composition {
            Composition::Late(feedback) => feedback.late_class(),
            _ => self.class_by_degrees(),
        }
    }

    /// P and Q, or B and A with latency, where only these have finitely many zeros; the rest of D
    /// depends on λ by exponentials alone.
    pub(crate) fn polynomials(&self) -> [&Polynomial; 2] {
        match &self.composition {
            Composition::Late(feedback) => [&feedback.open, &feedback.gain],
            _ => [&self.p, &self.q],
        }
    }

    /// What is known of F near 0, once `visit` has had every frequency at which |P| and |Q| change
    /// places on the imaginary axis, with the argument of −P Q* there. An error with its reason
    /// where they are not known, and without one where there are too many.
    #[inline]
    pub(super) fn each_on_axis(
        &self,
        on_axis: &Shifted,
        mut visit: impl FnMut(&Switch, Option<Angle>),
    ) -> Result<NearZero, Option<Reason>> {
        if let Composition::Late(feedback) = &self.composition {
            let mut switches = Switches::default();
            if !feedback.switches_on(0.0, 0.0, &mut switches) {
                return Err(None);
            }
            for switch in &switches.list {
                visit(switch, feedback.late_phase(switch.omega, switch.error));
            }
            return Ok(switches.near_zero());
        }
        let mut modulus = on_axis.modulus();
        if self.class() == Class::NeutralLimit {
            modulus = modulus.without_open_leading();
        }
        let enough = enough(on_axis.degree());
        let near = each_switch(&modulus, Some(on_axis), |switch| {
            visit(&switch, on_axis.phase(switch.omega, switch.error, enough));
        });
        near.ok_or(Some(Reason::DegreeUnknown))
    }

    /// Finds the frequencies at which |P| and |κQ| change places on Re λ = `line`.
    pub(super) fn switches_on(&self, tau: f64, line: f64, switches: &mut Switches) {
        if let Composition::Late(feedback) = &self.composition {
            feedback.switches_on(tau, line, switches);
        } else if let Some(decay) = Decay::new(line, tau) {
            let on_line = self.on_line(line, decay);
            let modulus = on_line.modulus().without_open_leading();
            switches.find(&modulus, Some(&on_line));
        }
    }

    /// A radius within which every root with Re λ ≥ `line` lies; infinite where κρ ≥ 1.
    #[must_use]
    pub(crate) fn root_bound(&self, tau: f64, line: f64) -> f64 {
        match &self.composition {
            Composition::Late(feedback) => feedback.late_root_bound(tau, line),
            _ => self.bound_by_coefficients(tau, line),
        }
    }

    /// D‴, of P‴ + (Q‴ − 3τQ″ + 3τ²Q′ − τ³Q) E what the delay makes large.
    pub(super) fn third(&self, jet: &Jet, tau: f64, lambda: Complex64) -> Complex64 {
        if let Composition::Late(feedback) = &self.composition {
            let [p_third, slope, bend, third] = feedback.thirds(lambda);
            let turned = tau * (3.0 * slope - tau * jet.feedback) - 3.0 * bend;
            return p_third + jet.delayed * (third + tau * turned);
        }
        if self.leaves_origin_out() {
            return self.third_beside_origin(jet, tau, lambda);
        }
        let [_, slope, bend] = self.q.jet(lambda);
        let p_third = self.p.derivative().jet(lambda)[2];
        p_third + tau * jet.delayed * (tau * (3.0 * slope - tau * jet.feedback) - 3.0 * bend)
    }

    /// D where exponentials are parabolas.
    pub(super) fn slow(&self, tau: f64) -> Option<Polynomial> {
        if let Composition::Late(feedback) = &self.composition {
            return feedback.slow(tau);
        }
        let parabola = Polynomial::new(&[0.0, tau, -0.5 * tau * tau]).ok()?;
        let fed = self.q.times(&parabola).ok()?;
        let sum = match self.leaves_origin_out() {
            true => self.p.plus(&self.q, 1.0),
            false => self.without_delay(),
        };
        Some(sum.plus(&fed, -1.0))
    }

    /// Approximate roots by collocation.
    pub(super) fn eigenvalues(&self, tau: f64, nodes: usize) -> Option<Vec<Complex64>> {
        match &self.composition {
            Composition::Late(feedback) => feedback.eigenvalues(tau, nodes),
            _ => eigenvalues(self.p.coefficients(), self.q.coefficients(), tau, nodes),
        }
    }

    /// P, P′, Q and Q′ at λ.
    #[inline]
    pub(in crate::linear) fn pair(&self, lambda: Complex64) -> [Complex64; 4] {
        if let Composition::Late(feedback) = &self.composition {
            return feedback.pair(lambda);
        }
        let ([p, p_slope, _], [q, q_slope, _]) = (self.p.jet(lambda), self.q.jet(lambda));
        [p, p_slope, q, q_slope]
    }
}
