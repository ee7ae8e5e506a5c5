//! Checks of a cell of a map by methods that did not compute it.

use crate::answers::basin::{BasinProblem, STUDENT_95, Tally};
use crate::answers::vc;
use crate::critical::switch_on::Phase;
use crate::critical::{CriticalVelocity, Method, Regime, Transition};
use crate::linear::general;
use crate::linear::line::Linear;
use crate::linear::status::{DISAGREE, MARGINAL, NOT_CONVERGED, OUTSIDE_MODEL, SATURATED};
use crate::model::ModelError;
use crate::setting::field::{Field, number_of_transition};
use crate::setting::search::Protocol;
use crate::setting::values::Setting;
use crate::slip::case::Case;
use crate::slip::motion::{Accuracy, Integrator};
use crate::slip::outcome::Outcome;
use crate::sweep::plan::Plan;

/// The stored contents of one cell of a map.
pub struct Stored<'a> {
    /// The status.
    pub status: u8,
    /// The value of a field; NaN where it has none, and for fields that the map lacks.
    pub value: &'a dyn Fn(Field) -> f64,
}

/// A question to a second method.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Question {
    /// The number of unstable roots, by the argument principle.
    Count,
    /// Whether some root has the abscissa as real part and none lies to its right, by the argument
    /// principle.
    Abscissa,
    /// The outcome of the motion, followed by collocation.
    Outcome,
    /// The share of starts that end in sliding, from other starts, followed by collocation.
    BasinShare,
    /// The critical velocity, by simulation with collocation and steps of v0 of its own.
    CriticalVelocity,
    /// The critical velocity by switching on: whether stick-slip survives just below and just above
    /// it, by collocation.
    SwitchOn,
}

impl Question {
    /// What is compared with what, in words.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Count => "n_unstable, by the argument principle",
            Self::Abscissa => "abscissa, by the argument principle",
            Self::Outcome => "outcome, by collocation",
            Self::BasinShare => "basin_share, by collocation from other starts",
            Self::CriticalVelocity => "vc, by simulation with collocation",
            Self::SwitchOn => "vc of switch-on, by collocation below and above it",
        }
    }
}

/// The answer of a second method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Answer {
    /// It found the same result.
    Agrees,
    /// It found another result.
    Differs,
    /// The cell is marked as marginal, not converged or in dispute, or the method has no answer
    /// there.
    Open,
}

/// Every question that can be asked of the cell at `index`, one index per axis, with its answer.
///
/// # Errors
/// When a parameter of the cell is outside the model's range, and its status does not say so.
pub fn second_look(
    plan: &Plan,
    index: &[usize],
    stored: &Stored,
) -> Result<Vec<(Question, Answer)>, ModelError> {
    let setting = plan.setting(index);
    let mut answers = Vec::new();
    let holds = |field| plan.spec.fields.contains(&field);
    if plan.spec.has_sliding() && (holds(Field::NUnstable) || holds(Field::Abscissa)) {
        let tau = plan.delay(index);
        let model = match setting.linear() {
            Err(_) if has(stored, OUTSIDE_MODEL) => None,
            model => Some(model?),
        };
        for (question, field) in [
            (Question::Count, Field::NUnstable),
            (Question::Abscissa, Field::Abscissa),
        ] {
            if holds(field) {
                let of_roots = |model| of_roots(question, model, tau, stored);
                answers.push((question, model.as_ref().map_or(Answer::Open, of_roots)));
            }
        }
    }
    if plan.spec.follows_motions() && holds(Field::Outcome) {
        answers.push((Question::Outcome, outcome(plan, &setting, stored)?));
    }
    if plan.spec.basin.is_some() && holds(Field::BasinShare) {
        answers.push((Question::BasinShare, basin_share(plan, &setting, stored)));
    }
    if let Some(search) = plan.spec.critical
        && holds(Field::Vc)
        && holds(Field::Outcome)
    {
        let (question, answer) = match search.protocol.at(&setting) {
            Protocol::Follow => {
                let holds_liftoff = holds(Field::VLiftoff);
                let answer = critical_velocity(&setting, stored, holds_liftoff)?;
                (Question::CriticalVelocity, answer)
            }
            Protocol::SwitchOn(phase) => {
                let answer = switched_on(&setting, stored, phase)?;
                (Question::SwitchOn, answer)
            }
        };
        answers.push((question, answer));
    }
    Ok(answers)
}

/// What the argument principle says at a delay, of the abscissa or of the count.
fn of_roots(
    question: Question,
    (model, unit): &(Linear, f64),
    tau: f64,
    stored: &Stored,
) -> Answer {
    let roots = model.roots_at_any_cost();
    let right_of = |line: f64| match roots.right_of(tau / unit, line) {
        general::RightOf::Infinite => Some(u64::MAX),
        other => other.finite(),
    };
    match question {
        Question::Abscissa => abscissa(&right_of, *unit, stored),
        _ => count(&right_of, stored),
    }
}

/// Whether a cell is flagged with one of these, or outside the model's range.
fn has(stored: &Stored, flags: u8) -> bool {
    stored.status & (flags | OUTSIDE_MODEL) != 0
}

fn told(same: bool) -> Answer {
    if same {
        Answer::Agrees
    } else {
        Answer::Differs
    }
}

/// The number of roots to the right of a line, by the argument principle: the largest u64 for
/// infinitely many, none where it is unknown.
type RightOf<'a> = dyn Fn(f64) -> Option<u64> + 'a;

fn count(right_of: &RightOf<'_>, stored: &Stored) -> Answer {
    let counted = (stored.value)(Field::NUnstable);
    let refused = stored.status & NOT_CONVERGED != 0 && counted.is_nan();
    if refused || stored.status & (MARGINAL | SATURATED) != 0 {
        return Answer::Open;
    }
    match right_of(0.0) {
        Some(roots) => told(roots as f64 == counted),
        // A count that is missing says why in its status.
        None if counted.is_nan() => Answer::Differs,
        None => Answer::Open,
    }
}

fn abscissa(right_of: &RightOf<'_>, unit: f64, stored: &Stored) -> Answer {
    let abscissa = (stored.value)(Field::Abscissa) * unit;
    let infinite = stored.status & SATURATED != 0 && abscissa.is_nan();
    let open = stored.status & (NOT_CONVERGED | DISAGREE) != 0 || infinite;
    if open || abscissa == f64::NEG_INFINITY {
        return Answer::Open;
    }
    let margin = (stored.value)(Field::CertificateMargin);
    let margin = margin.max(1e-12) * abscissa.abs().max(1.0);
    match (right_of(abscissa + margin), right_of(abscissa - margin)) {
        (Some(beyond), Some(reached)) => told(beyond == 0 && reached > 0),
        // The abscissa is NaN, and the status does not say why.
        _ if abscissa.is_nan() => Answer::Differs,
        _ => Answer::Open,
    }
}

/// The smallest error allowed in a step of collocation.
const SECOND_TOLERANCE: f64 = 1e-11;

fn outcome(plan: &Plan, setting: &Setting, stored: &Stored) -> Result<Answer, ModelError> {
    let number = (stored.value)(Field::Outcome);
    let undecided = Outcome::Undecided as u8;
    if has(stored, NOT_CONVERGED) || number == f64::from(undecided) {
        return Ok(Answer::Open);
    }
    let Some(case) = plan.spec.simulation.case(setting, 0.0)? else {
        return Ok(Answer::Open);
    };
    let case = Case {
        accuracy: Accuracy {
            integrator: Integrator::Collocation,
            tolerance: case.accuracy.tolerance.max(SECOND_TOLERANCE),
        },
        steps: case.steps.saturating_mul(vc::MORE_STEPS),
        ..case
    };
    let followed = case.motion().and_then(|mut motion| {
        let abscissa = case.stable_abscissa()?;
        Ok(case.follow(&mut motion, abscissa, &mut ()).outcome)
    });
    Ok(match followed {
        Ok(Outcome::Undecided) => Answer::Open,
        Ok(found) => told(f64::from(found as u8) == number),
        Err(_) => told(number == f64::from(Outcome::NoCycle as u8)),
    })
}

/// The most starts of a second look at a share.
const SECOND_STARTS: u32 = 64;
/// How far two shares may be apart, as a multiple of the difference that one pair in twenty
/// exceeds. Not one pair in a thousand is this far apart: checking a hundred cells must not raise
/// false alarms.
const APART: f64 = 3.0;

fn basin_share(plan: &Plan, setting: &Setting, stored: &Stored) -> Answer {
    let value = |field| (stored.value)(field);
    let share = value(Field::BasinShare);
    let Some(basin) = &plan.spec.basin else {
        return Answer::Open;
    };
    let Ok(Some(asked)) = BasinProblem::of(setting, &plan.spec.simulation, basin) else {
        return Answer::Open;
    };
    // A share of 0 follows from the number of unstable roots, which is another question.
    if let Some(known) = asked.known() {
        return told(share == known.share || (share.is_nan() && known.share.is_nan()));
    }
    let asked = asked.again(SECOND_STARTS, SECOND_TOLERANCE);
    let (mut tally, mut follower, mut motion) = (Tally::default(), asked.follower(), None);
    for place in asked.places() {
        tally.count(place, follower.follow(place, &mut motion, &mut ()));
    }
    let (other, upper) = (asked.cell(&tally), value(Field::BasinShareUpper));
    let error = value(Field::BasinShareError);
    let error = (error * error + other.error * other.error).sqrt();
    let apart = (share - other.upper).max(other.share - upper);
    told(apart <= APART * STUDENT_95 * error)
}

fn critical_velocity(
    setting: &Setting,
    stored: &Stored,
    holds_liftoff: bool,
) -> Result<Answer, ModelError> {
    if has(stored, NOT_CONVERGED | DISAGREE) {
        return Ok(Answer::Open);
    }
    let number = (stored.value)(Field::Outcome);
    let is_it = |transition: &Transition| f64::from(number_of_transition(*transition)) == number;
    let Some(transition) = Transition::ALL.into_iter().find(is_it) else {
        return Ok(Answer::Differs);
    };
    if transition == Transition::LiftOff && !holds_liftoff {
        return Ok(Answer::Open);
    }
    let asked = vc::VcProblem::of(setting)?;
    let found = CriticalVelocity {
        vc: (stored.value)(Field::Vc),
        vc_lower: f64::NAN,
        vc_upper: f64::NAN,
        transition,
        method: Method::Simulation,
        v_liftoff: match transition {
            Transition::LiftOff => (stored.value)(Field::VLiftoff),
            _ => f64::NAN,
        },
        stick_time: f64::NAN,
        slip_time: f64::NAN,
        n_min: f64::NAN,
        sustained: transition != Transition::Never,
        decided: true,
    };
    let agrees = asked.simulation_agrees(&found, Integrator::Collocation);
    Ok(agrees.map_or(Answer::Open, told))
}

/// Relative distance from an edge at which control is switched on in stick-slip.
const BESIDE: f64 = 1e-4;

/// Whether stick-slip survives switching on just below the critical velocity, and not just above
/// it. The worst of many phases stays open: it would take as many motions.
fn switched_on(setting: &Setting, stored: &Stored, phase: Phase) -> Result<Answer, ModelError> {
    let vc = (stored.value)(Field::Vc);
    let lost = f64::from(number_of_transition(Transition::Lost));
    let told_here = !has(stored, NOT_CONVERGED | DISAGREE);
    if !told_here || matches!(phase, Phase::Worst(_)) || (stored.value)(Field::Outcome) != lost {
        return Ok(Answer::Open);
    }
    let asked = vc::VcProblem::of(setting)?;
    let [below, above] = asked.survives_beside(vc, BESIDE, phase, Integrator::Collocation);
    Ok(match (below, above) {
        (Regime::Irregular | Regime::Undecided, _) => Answer::Open,
        (_, Regime::Irregular | Regime::Undecided) => Answer::Open,
        _ => told(below.persists() && !above.persists()),
    })
}
