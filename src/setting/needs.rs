//! What fields need of a sweep: a row for each need, with its message.
//!
//! Sweep files ask the rows in stages, between other checks; fields at any points ask all of them.

use super::actuator_limits::{excluding, without_limits};
use super::field::Field;
use super::fields_asked::{FieldsAsked, ReportedAt, Unmet};
use super::given_error::GivenError;
use super::law_kind::{LawKind, NO_MOTIONS};
use super::parameter::Parameter;
use super::sampling::not_sampled;
use super::search::LIMIT;
use super::simulation::not_in_motions;
use super::source::{OfLinear, OfMargins, OfRoots, Source};
use super::spec::{SweepSpec, most};
use super::system::SystemModel;
use crate::model::RateAndState;
use crate::text::SpecError;

/// When a need is checked. Each stage takes for granted that the needs of those before it are met.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stage {
    /// The block, or the limit of a short delay.
    Protocol,
    /// The linear model and the friction law.
    Model,
    /// The other fields, and whether there is a law.
    Company,
    /// The values of parameters.
    Values,
}

/// A need of some fields.
struct Need {
    stage: Stage,
    of: fn(Field) -> bool,
    /// The error where it is not met.
    unmet: fn(&FieldsAsked, Field) -> Option<Unmet>,
}

const fn need(
    stage: Stage,
    of: fn(Field) -> bool,
    unmet: fn(&FieldsAsked, Field) -> Option<Unmet>,
) -> Need {
    Need { stage, of, unmet }
}

/// The needs. Of several unmet ones the first is reported, at the first field that has it.
const NEEDS: [Need; 21] = [
    need(Stage::Protocol, Field::of_limit, |asked, field| {
        (!asked.limit).then(|| of_limit(field))
    }),
    need(
        Stage::Protocol,
        |field| !field.of_limit(),
        |asked, field| asked.limit.then(|| no_meaning(field.name())),
    ),
    need(
        Stage::Model,
        |_| true,
        |asked, field| not_of_system(field, asked.fixed.system()?),
    ),
    need(Stage::Model, of_motions, |asked, _| {
        no_motions(asked.fixed.law()?)
    }),
    need(Stage::Model, of_motions, |asked, _| {
        let most = most(asked.fixed, asked.axes);
        let (parameter, message) = not_in_motions(&most)?;
        Some(ReportedAt::Parameter(parameter).refuse(message, LINEAR))
    }),
    need(
        Stage::Model,
        |field| field.of_margins() && field != Field::LatencyMargin,
        not_by_slope,
    ),
    need(
        Stage::Model,
        |field| field == Field::DAbscissaDMuPrime,
        not_by_slope,
    ),
    need(
        Stage::Model,
        |field| {
            field.of_margins() || matches!(field.source(), Source::Roots(OfRoots::Derivative(_)))
        },
        |asked, field| {
            asked.is_sampled().then(|| {
                ReportedAt::Field.refuse(
                    format!("{} is not known with a sample time", field.name()),
                    "n_unstable, abscissa, spectral_radius and delay_margin are",
                )
            })
        },
    ),
    need(
        Stage::Model,
        |field| field == Field::SpectralRadius,
        |asked, field| {
            (!asked.is_sampled()).then(|| {
                ReportedAt::Field.refuse(
                    format!("{} is of a digital loop", field.name()),
                    "give sample_time, the time from one reading to the next",
                )
            })
        },
    ),
    need(
        Stage::Model,
        |field| field == Field::StiffnessRatio,
        |asked, field| {
            let law = RateAndState::FORM.name;
            asked.fixed.rate_and_state().is_none().then(|| {
                ReportedAt::Field.refuse(
                    format!("{} is of the {law} law", field.name()),
                    format!("give [friction] law = \"{law}\", and v0"),
                )
            })
        },
    ),
    need(Stage::Company, Field::of_basin, |asked, field| {
        let others = match (asked.any(Field::of_vc), asked.any(Field::of_motion)) {
            (true, _) => "fields of the critical velocity",
            (false, true) => "fields of one motion",
            (false, false) => return None,
        };
        Some(ReportedAt::Field.refuse(
            format!("{} cannot stand beside {others}", field.name()),
            "it is about motions from many starts: make a sweep of its own for it; fields of \
                 linear stability can stand beside it",
        ))
    }),
    need(Stage::Company, Field::of_vc, |asked, _| {
        asked.without_law("the critical velocity depends on the whole of it")
    }),
    need(Stage::Company, of_motions, |asked, _| {
        asked.without_law("motions stick and slip by it")
    }),
    need(
        Stage::Company,
        |field| field.of_motion() && field != Field::Outcome,
        |asked, field| {
            asked.any(Field::of_vc).then(|| {
                ReportedAt::Field.refuse(
                    format!(
                        "{} cannot stand beside fields of the critical velocity",
                        field.name()
                    ),
                    "it is about a motion from one start: make a sweep of its own for it; outcome \
                     can stand in both",
                )
            })
        },
    ),
    need(
        Stage::Values,
        |_| true,
        |asked, _| {
            let (error, law) = (GivenError::Missing(Parameter::V0), asked.fixed.law()?);
            let missing = asked.needs_v0() && !asked.has(Parameter::V0);
            missing.then(|| {
                ReportedAt::Law.refuse(
                    error.message(Some(law), Parameter::key),
                    error.help(Parameter::key),
                )
            })
        },
    ),
    need(Stage::Values, |_| true, |asked, _| excluding(asked)),
    need(Stage::Values, |_| true, |asked, _| not_sampled(asked)),
    need(
        Stage::Values,
        |field| matches!(field, Field::TimeAtLimit | Field::ShareAtLimit),
        without_limits,
    ),
    need(Stage::Values, Field::of_motion, |asked, _| {
        two_starts(|parameter| asked.has(parameter))
    }),
    need(Stage::Values, of_motions, |asked, _| {
        let gains = [Parameter::AlphaV, Parameter::AlphaN];
        let acts = gains
            .iter()
            .any(|&p| asked.values(p).any(|gain| gain != 0.0));
        let at_once = || asked.values(Parameter::Tau).any(|tau| tau == 0.0);
        (acts && at_once()).then(|| Unmet {
            at: ReportedAt::Parameter(Parameter::Tau),
            error: SpecError::whole(
                "tau = 0 is outside its range: greater than 0 where gains act and motions are \
                     followed",
            ),
        })
    }),
    need(Stage::Values, Field::of_basin, |asked, field| {
        let mut start = Parameter::ALL.into_iter().filter(|p| p.of_start());
        let parameter = start.find(|&p| asked.has(p))?;
        Some(ReportedAt::Parameter(parameter).refuse(
            format!("{} says one start", parameter.name()),
            format!(
                "{} is of many: [basin] says their ranges, or over = \"phase\"",
                field.name()
            ),
        ))
    }),
];

const LINEAR: &str = "fields of linear stability take it: n_unstable, abscissa and others";

/// The first need of a stage that is not met, with the field.
pub(super) fn unmet(asked: &FieldsAsked, stage: Stage) -> Option<(Field, Unmet)> {
    let needs = NEEDS.iter().filter(|need| need.stage == stage);
    needs.into_iter().find_map(|need| {
        let mut fields = asked.fields.iter().filter(|field| (need.of)(**field));
        fields.find_map(|&field| Some((field, (need.unmet)(asked, field)?)))
    })
}

/// Checks that these are fields of a cell at a delay.
///
/// # Errors
/// Names the first field of the limit of a short delay.
pub(crate) fn check_kinds(fields: &[Field]) -> Result<(), SpecError> {
    match fields.iter().find(|field| field.of_limit()) {
        Some(field) => Err(of_limit(*field).error),
        None => Ok(()),
    }
}

impl SweepSpec {
    /// Checks that the sweep has all that its fields need.
    ///
    /// # Errors
    /// In the words of sweep files, without a place.
    pub(crate) fn check_needs(&self) -> Result<(), SpecError> {
        let asked = FieldsAsked::of(self);
        let stages = [Stage::Protocol, Stage::Model, Stage::Company, Stage::Values];
        match stages.into_iter().find_map(|stage| unmet(&asked, stage)) {
            Some((_, unmet)) => Err(unmet.error),
            None => Ok(()),
        }
    }
}

/// Whether motions are followed for the field.
fn of_motions(field: Field) -> bool {
    field.of_motion() || field.of_basin() || field.of_vc()
}

/// The error of a law that has no motions.
pub(super) fn no_motions(law: &LawKind) -> Option<Unmet> {
    law.has_state().then(|| {
        let message = format!("the {} law has no motions here", law.name());
        ReportedAt::Law.refuse(message, NO_MOTIONS)
    })
}

/// The error of a motion that starts in a state and at a phase.
pub(super) fn two_starts(has: impl Fn(Parameter) -> bool) -> Option<Unmet> {
    let phase = Parameter::SwitchOnPhase;
    let state = [Parameter::XDot0, Parameter::A0]
        .into_iter()
        .find(|&p| has(p));
    let state = state.filter(|_| has(phase))?;
    Some(ReportedAt::Parameter(phase).refuse(
        format!("{}: {} is given as well", phase.name(), state.name()),
        "a motion starts in a state (x_dot0, a0) or in uncontrolled stick-slip (switch_on_phase), \
         not both",
    ))
}

/// The error of a field that takes friction to be a function of the velocity, under a law with a
/// state: there the slope does not describe friction completely.
fn not_by_slope(asked: &FieldsAsked, field: Field) -> Option<Unmet> {
    let law = asked.fixed.law().filter(|law| law.has_state())?;
    let law = format!("the {} law", law.name());
    Some(ReportedAt::Field.refuse(
        format!("{} cannot be had with {law}", field.name()),
        format!("leave it out, or {law}; {LINEAR}"),
    ))
}

fn of_limit(field: Field) -> Unmet {
    ReportedAt::Field.refuse(
        format!("{} is a field of protocol = \"{LIMIT}\"", field.name()),
        "protocol = \"limit\" asks for v_c as the delay vanishes; its parameters are gamma and \
         mu_ratio",
    )
}

/// The error of a name that a sweep of the limit of a short delay cannot have.
pub(super) fn no_meaning(name: &str) -> Unmet {
    let names: Vec<_> = Field::all_of_limit().map(Field::name).collect();
    let fields = names.join(", ");
    ReportedAt::Field.refuse(
        format!("{name} has no meaning with protocol = \"{LIMIT}\""),
        format!(
            "the limit is Coulomb friction under load control as the delay vanishes; all it takes \
             is gamma, mu_ratio and the fields {fields}"
        ),
    )
}

/// The fields that maps of this system have.
pub(crate) fn fields_of_system(model: &SystemModel) -> impl Iterator<Item = Field> {
    let has = |field: &Field| !field.of_limit() && not_of_system(*field, model).is_none();
    Field::ALL.into_iter().filter(has)
}

/// The error of a field that a system from a file does not have.
fn not_of_system(field: Field, model: &SystemModel) -> Option<Unmet> {
    const OTHERS: &str = "n_unstable, abscissa, frequency, relaxation_time, reason and others are \
        of any system";
    let (why, help) = match field.source() {
        Source::Line if field == Field::DelayMargin && model.depends_on_delay() => (
            "it needs a line of delays, and the system depends on tau",
            "n_unstable and the roots are counted delay by delay",
        ),
        Source::Roots(OfRoots::Derivative(_)) => {
            ("it is known of the letter's parameters alone", OTHERS)
        }
        Source::Linear(OfLinear::StiffnessRatio) => ("it is of the rate-and-state law", OTHERS),
        Source::Roots(OfRoots::SpectralRadius) => ("it is of a digital loop", OTHERS),
        Source::Margins(OfMargins::StabilityRadius) => ("it needs the block on its spring", OTHERS),
        Source::Margins(OfMargins::Phase | OfMargins::Latency) => return None,
        Source::Margins(_) if let Some(of) = model.without_curves() => {
            return Some(ReportedAt::Field.refuse(
                format!("{} is not known of {of}", field.name()),
                "phase_margin, latency_margin and delay_margin are",
            ));
        }
        Source::Line | Source::Roots(_) | Source::Linear(_) | Source::Margins(_) => return None,
        _ => (
            "it needs the block on its spring; a system from a file has no motions",
            OTHERS,
        ),
    };
    Some(ReportedAt::Field.refuse(format!("{}: {why}", field.name()), help))
}
