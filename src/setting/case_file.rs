//! One motion as described by a case file, read and checked once.
//!
//! ```toml
//! title = "Velocity control"      # optional
//! switch_on = 70.0                # when control begins to act, 0 by default; false: never
//! # until when the outcome is looked for; by default 1000 √(M/κ) after switch-on and `programme`
//! horizon = 1000.0
//! tolerance = 1e-12               # error allowed in a step, relative; 1e-15 to 1e-3
//! steps = 1000000                 # the most steps
//! seed = 0                        # what the noise of readings is drawn with
//!
//! [friction]                      # as in sweep files
//! law = "weakening"
//! mu0 = 0.5
//! v_s = 0.5
//!
//! [fixed]                         # as in sweep files; tau may be left out where both gains are 0
//! v0 = 0.35
//! alpha_v = -0.33
//! tau = 4.15
//!
//! [feedback]                      # optional: control by the return map, in the place of gains
//! control = "return-map"          # with sample_time in [fixed]
//! amplitude = 0.5                 # the largest change of the load
//! model = "reconstructed"         # or "exact", by default: from the friction law
//! record = 20                     # the most readings from which it is reconstructed
//! pulse = 0.01                    # the largest pulse of the load in it
//!
//! [start]                         # optional: at t = 0, and the elongation before
//! x_dot0 = 0.3535                 # v0 by default
//! a0 = 0.294                      # that of sliding at v0 by default, μ_K(v0) N0/κ
//! # or, with switch_on left out: switch_on_phase = 0.2, the time from a release of
//! # uncontrolled stick-slip, which is t = 0, to switch-on, modulo the period
//!
//! [[programme]]                   # optional: v0 in time, in the order of time
//! at = 50.0                       # from then on
//! v0 = 0.2
//!
//! [[programme]]
//! at = 90.0
//! v0 = 0.05
//! ramp = true                     # linear from the entry before; false by default: a jump
//!
//! [trace]                         # optional
//! until = 150.0                   # end of the trace; by default when the outcome is known
//! samples = 24                    # in each step of the integrator; or interval = 0.05, in time
//!
//! [units]                         # optional, as in sweep files
//! ```

use super::feedback_table::GivenFeedback;
use super::given::GivenParameters;
use super::keys::{CASE, TRACE, names};
use super::parameter::{Group, LARGEST, Parameter};
use super::programme::GivenProgramme;
use super::simulation::{DISTURBED, POSITIVE, Simulation};
use super::units::Units;
use super::values::Setting;
use crate::slip::case::{Case, CaseError};
use crate::text::Shown;
use crate::text::document::Document;
use crate::text::toml_reader::{Entry, SpecError, entries, parse};

/// Samples per step if the file gives no number.
const SAMPLES: u32 = 24;
/// The most samples per step.
const MOST_SAMPLES: u64 = 64;

/// Keys of sweep files that case files do not have.
const OF_SWEEPS: [&str; 5] = ["fields", "axes", "boundaries", "best", "protocol"];

/// Keys that only system files have.
const OF_SYSTEMS: [&str; 4] = ["P", "Q", "B", "A"];

/// How densely a motion is sampled between its events.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sampling {
    /// A number of samples in each step of the integrator, 1 to 64.
    PerStep(u32),
    /// At all multiples of this time.
    Interval(f64),
}

/// A case as described by its file: every value in range, every name known.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseSpec {
    /// Title for pictures and the trace; may be empty.
    pub title: String,
    /// All parameters; with a friction law.
    pub setting: Setting,
    /// The motion.
    pub case: Case,
    /// Whether the file gives no start. The block then starts faster than sliding by [`DISTURBED`]:
    /// exactly in equilibrium it would stay there, stable or not.
    pub start_assumed: bool,
    /// End of the trace, in time; none for the time when the outcome is known.
    pub until: Option<f64>,
    /// How densely to sample.
    pub sampling: Sampling,
    /// Units of the parameters.
    pub units: Units,
    /// The text of the file.
    pub text: String,
}

/// The kind of a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TextKind {
    /// A sweep file.
    Sweep,
    /// A case file.
    Case,
    /// A setting alone, which both kinds have. With a friction law it can be read as a case.
    Setting,
    /// A system file.
    System,
    /// An experiment.
    Experiment,
}

/// The kind of a text, by its keys; none where they do not fit one kind.
#[must_use]
pub(crate) fn kind_of_text(text: &str) -> Option<TextKind> {
    let document = parse(text).ok()?;
    let entries = entries(document.get_ref(), "");
    let all = |known: &[&str]| entries.iter().all(|entry| known.contains(&entry.key));
    if entries.iter().any(|entry| OF_SWEEPS.contains(&entry.key)) {
        Some(TextKind::Sweep)
    } else if entries.iter().any(|e| OF_SYSTEMS.contains(&e.key)) {
        Some(TextKind::System)
    } else if entries.iter().any(|e| e.key == "experiment") {
        Some(TextKind::Experiment)
    } else if entries.is_empty() || !all(&names(&CASE)) {
        None
    } else if all(&["fixed", "friction", "units"]) {
        Some(TextKind::Setting)
    } else {
        Some(TextKind::Case)
    }
}

/// Whether a text is a case file rather than a sweep file. It has no key that only sweeps have, and
/// either a key that only cases have or everything that a case needs.
#[must_use]
pub(crate) fn is_case_file(text: &str) -> bool {
    let Ok(document) = parse(text) else {
        return false;
    };
    let entries = entries(document.get_ref(), "");
    let has = |keys: &[&str]| entries.iter().any(|entry| keys.contains(&entry.key));
    !has(&OF_SWEEPS)
        && (has(&["switch_on", "trace", "programme", "feedback"])
            || text.parse::<CaseSpec>().is_ok())
}

impl CaseSpec {
    /// A remark on readings that are rounded to steps larger than the elongation of sliding at v0:
    /// they tell next to nothing of the motion.
    #[must_use]
    pub(crate) fn resolution_remark(&self) -> Option<String> {
        let case = &self.case;
        let (step, sliding) = (case.feedback.readings.resolution, case.sliding_elongation());
        (case.feedback.is_sampled() && step > sliding).then(|| {
            let unit = self.units.of_parameter(Parameter::Resolution);
            let [step, sliding] = [step, sliding].map(|a| format!("{}{unit}", Shown(a)));
            format!(
                "resolution = {step} is more than the elongation of sliding at v0, {sliding}: \
                 readings tell next to nothing of the motion"
            )
        })
    }

    /// The setting in the end, with the last v0 of a programme.
    #[must_use]
    pub fn last_setting(&self) -> Setting {
        let mut setting = self.setting.clone();
        setting.set(Parameter::V0, self.case.last_v0());
        setting
    }

    /// An error at the place of a parameter in the text.
    pub(crate) fn error_at(&self, parameter: Parameter, message: impl Into<String>) -> SpecError {
        let place = || {
            let parsed = parse(&self.text).ok()?;
            let mut document = Document::of(entries(parsed.get_ref(), ""), names(&CASE));
            let given = GivenParameters::of(&mut document, &self.text, moves);
            given.place(parameter).cloned()
        };
        let mut error = SpecError::whole(message);
        error.span = place();
        error
    }

    /// The error of a trace that would be too long, at the key of the text that makes it so.
    #[must_use]
    pub fn too_long(&self, message: String) -> SpecError {
        let place = || {
            let parsed = parse(&self.text).ok()?;
            let mut document = Document::of(entries(parsed.get_ref(), ""), ["trace"]);
            let keys = document.entry("trace")?.document(names(&TRACE)).ok()?;
            let mut of = ["interval", "samples", "until"].into_iter();
            let found = of.find_map(|key| keys.value(key));
            found.or(document.key("trace")).cloned()
        };
        SpecError {
            span: place(),
            ..SpecError::whole(message)
                .help("[trace] until = … ends it earlier, interval = … makes it coarser")
        }
    }
}

impl std::str::FromStr for CaseSpec {
    type Err = SpecError;

    /// Reads a case file.
    ///
    /// # Errors
    /// Points at the first place that is not understood, out of range or contradictory.
    fn from_str(text: &str) -> Result<Self, SpecError> {
        let parsed = parse(text)?;
        let mut document = Document::of(entries(parsed.get_ref(), ""), names(&CASE));
        document.refuse(
            &OF_SWEEPS,
            "it is a key of a sweep file, of a map: `slipmap run` takes it",
        );
        document.refuse(
            &["experiment"],
            "it is a key of an experiment: `slipmap measure` takes it",
        );
        let title = document.take("title", Entry::line).unwrap_or_default();
        let given = GivenParameters::of(&mut document, text, moves);
        let units = given.units().clone();
        let switch_on = document.take("switch_on", |entry| read_switch_on(entry, &units));
        let trace = document.take("trace", |entry| read_trace(entry, &units));
        let trace = trace.unwrap_or_default();
        let feedback = document.take("feedback", |entry| GivenFeedback::read(entry, &units));
        let programme = document.take("programme", |entry| GivenProgramme::read(entry, &units));
        let simulation = Simulation::of(&mut document, &units);
        document.finish()?;
        let setting = setting(&given)?;
        Ok(Self {
            title: title.to_owned(),
            case: case(
                &document,
                &given,
                (&simulation, programme, feedback),
                switch_on,
                &setting,
            )?,
            setting,
            start_assumed: !given.has_start(),
            until: trace.until,
            sampling: trace.sampling.unwrap_or(Sampling::PerStep(SAMPLES)),
            units,
            text: text.to_owned(),
        })
    }
}

/// Whether the parameter belongs to a motion under a friction law.
fn moves(parameter: Parameter) -> bool {
    matches!(parameter.group(), Group::Model | Group::Pull | Group::Start)
}

/// Reads when control begins to act: a time, or +∞ for `false`.
fn read_switch_on(entry: &Entry, units: &Units) -> Result<f64, SpecError> {
    match entry.boolean() {
        Ok(false) => Ok(f64::INFINITY),
        Ok(true) => Err(entry
            .error("true says not when")
            .help("a time from 0 on, or false for never")),
        Err(_) => units.number_within(entry, Parameter::Tau.dimension(), 0.0..=LARGEST),
    }
}

/// The table `[trace]`.
#[derive(Default)]
struct TraceKeys {
    until: Option<f64>,
    sampling: Option<Sampling>,
}

fn read_trace(trace: &Entry, units: &Units) -> Result<TraceKeys, SpecError> {
    let time = |entry: &Entry| units.number_within(entry, Parameter::Tau.dimension(), POSITIVE);
    let mut table = trace.document(names(&TRACE))?;
    let mut trace = TraceKeys {
        until: table.take("until", time),
        sampling: None,
    };
    table.each(&["samples", "interval"], |entry| {
        let sampling = match entry.key {
            "samples" => Sampling::PerStep(read_samples(entry)?),
            _ => Sampling::Interval(time(entry)?),
        };
        match trace.sampling.replace(sampling) {
            Some(_) => Err(SpecError::at(
                entry.key_span.clone(),
                "trace: either samples in each step or an interval, not both",
            )),
            None => Ok(()),
        }
    });
    table.finish()?;
    Ok(trace)
}

/// The setting of a case, with the defaults of its delay and its start.
fn setting(given: &GivenParameters) -> Result<Setting, SpecError> {
    let Some(law_place) = given.law_place() else {
        return Err(SpecError::whole("a case needs a friction law")
            .help("for example: [friction] law = \"weakening\", mu0 = 0.5, v_s = 0.5"));
    };
    given.check_motions()?;
    let mut setting = given.setting();
    let optional = (!setting.control().act()).then_some(Parameter::Tau);
    given.check(optional.as_slice(), Some(law_place))?;
    if setting.get(Parameter::Tau).is_nan() {
        setting.set(Parameter::Tau, 0.0);
    }
    if !given.has_start() {
        let v0 = setting.get(Parameter::V0);
        setting.set(Parameter::XDot0, (1.0 + DISTURBED) * v0);
    }
    Ok(setting)
}

/// The motion of a case, with the defaults that depend on parameters.
fn case(
    document: &Document,
    given: &GivenParameters,
    (simulation, programme, feedback): (&Simulation, Option<GivenProgramme>, Option<GivenFeedback>),
    switch_on: Option<f64>,
    setting: &Setting,
) -> Result<Case, SpecError> {
    given.check_start()?;
    let phase = given.place(Parameter::SwitchOnPhase);
    if let (Some(place), Some(_)) = (document.key("switch_on"), phase) {
        let message = "switch_on: switch_on_phase says when control begins to act";
        return Err(SpecError::at(place.clone(), message).help("leave one of them out"));
    }
    let steered = feedback.as_ref();
    let return_map = steered.map(|of| of.control(setting.get(Parameter::NormalLoad)));
    let case = simulation
        .case_under(setting, switch_on.unwrap_or(0.0), return_map)
        .map_err(|error| given.refused(&error))?
        .ok_or_else(|| SpecError::whole("a case needs a friction law"))?;
    let name = match phase {
        Some(_) => Parameter::SwitchOnPhase.name(),
        None => "switch_on",
    };
    if case.switch_on.is_finite() {
        simulation.check_horizon(document.value("horizon"), name, case.switch_on)?;
    }
    let case = match programme {
        Some(given) => given.added_to(case, simulation, document.value("horizon"))?,
        None => case,
    };
    case.motion()
        .map_err(|error| refused(given, steered, &error))?;
    Ok(case)
}

/// An error of the model, at the place of the parameter or key if the file gives it.
fn refused(
    given: &GivenParameters,
    feedback: Option<&GivenFeedback>,
    error: &CaseError,
) -> SpecError {
    let name = match error {
        CaseError::Model(error) => error.parameter,
        CaseError::NoCycle(_) => Parameter::SwitchOnPhase.name(),
        CaseError::SampleTime { .. } => Parameter::SampleTime.name(),
        CaseError::BesideReturnMap { name, .. } => name,
        CaseError::NoRecursion(_) => "record",
    };
    let place = Parameter::from_name(name).and_then(|p| given.place(p));
    let of_feedback = || feedback.and_then(|feedback| feedback.place(name));
    SpecError {
        message: error.to_string(),
        span: place.or_else(of_feedback).cloned(),
        help: match error {
            CaseError::Model(of) if of.parameter == "sample_time" && feedback.is_some() => {
                Some("the time from reading to reading, in [fixed]: sample_time = 0.9".into())
            }
            CaseError::BesideReturnMap { .. } => {
                Some("leave it out; `amplitude` bounds the load".into())
            }
            _ => None,
        },
    }
}

fn read_samples(entry: &Entry) -> Result<u32, SpecError> {
    match entry.whole()? {
        n @ 1..=MOST_SAMPLES => Ok(n as u32),
        n => Err(entry.error(format!("{n} is outside its range: 1 to {MOST_SAMPLES}"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::slip::motion::Accuracy;

    const PLAIN: &str = "[friction]\nlaw = \"coulomb\"\nmu0 = 0.4\n[fixed]\nv0 = 0.1\n";

    #[test]
    fn what_is_left_out_has_its_default() {
        let spec: CaseSpec = PLAIN.parse().unwrap();
        let case = &spec.case;
        assert_eq!(case.initial_state(), (1.01 * 0.1, 0.4));
        assert!(spec.start_assumed);
        let said: CaseSpec = format!("{PLAIN}[start]\nx_dot0 = 0.1\n").parse().unwrap();
        assert_eq!(said.case.initial_state(), (0.1, 0.4));
        assert!(!said.start_assumed);
        assert_eq!(case.switch_on, f64::INFINITY, "nothing to switch on");
        assert_eq!((case.feedback.tau, case.horizon), (0.0, 1000.0));
        assert_eq!(case.accuracy, Accuracy::default());
        assert_eq!((spec.until, spec.sampling), (None, Sampling::PerStep(24)));
    }

    #[test]
    fn a_case_is_told_from_a_sweep() {
        for (text, case) in [
            (PLAIN, true),
            ("switch_on = 1", true),
            ("[trace]", true),
            (&*format!("{PLAIN}[axis]\ntau = [1]"), false),
            ("", false),
            ("[fixed]\nv0 = 1", false),
            ("[axis]\ntau = [1]", false),
            ("friction = ", false),
        ] {
            assert_eq!(is_case_file(text), case, "{text}");
            assert!(!is_case_file(&format!("axes.tau = [1]\n{text}")));
        }
    }

    #[test]
    fn the_key_that_makes_a_trace_too_long_is_pointed_at() {
        for (trace, at) in [
            ("[trace]\nuntil = 9.0\ninterval = 1e-9\n", "1e-9"),
            ("[trace]\nuntil = 9.0\n", "9.0"),
            ("[trace]\n", "trace"),
        ] {
            let text = format!("{PLAIN}{trace}");
            let spec: CaseSpec = text.parse().unwrap();
            let place = spec.too_long(String::new()).span.unwrap();
            assert_eq!(&text[place], at);
        }
        let spec: CaseSpec = PLAIN.parse().unwrap();
        assert_eq!(spec.too_long(String::new()).span, None);
    }

    #[test]
    fn mistakes_are_pointed_at() {
        for (text, says, at) in [
            ("", "needs a friction law", None),
            ("[fixed]\nv0 = 1\n", "needs a friction law", None),
            ("horizons = 3", "unknown key `horizons`", Some("horizons")),
            ("switch_on = true", "true says not when", Some("true")),
            ("switch_on = -1.0", "switch_on: -1 is outside", Some("-1.0")),
            ("horizon = nan", "horizon: expected a finite", Some("nan")),
            ("tolerance = 1e-20", "tolerance: ", Some("1e-20")),
            ("start = { x = 1 }", "unknown key `start.x`", Some("x")),
            ("trace = { samples = 0 }", "trace.samples: 0 is", Some("0")),
            (
                "trace = { samples = 1, interval = 1.0 }",
                "not both",
                Some("interval"),
            ),
            (
                "switch_on = 7.0\nhorizon = 5.0\nfixed.alpha_v = 1\nfixed.tau = 1",
                "not later than",
                Some("5.0"),
            ),
            (
                "fixed.tau = 0.0\nfixed.alpha_n = 1.0",
                "tau = 0",
                Some("tau"),
            ),
            (
                "fixed.alpha_n = 1.0",
                "tau is not given",
                Some("\"coulomb\""),
            ),
            ("fixed.mu_k = 1.0", "mu_k has no meaning", Some("mu_k")),
            (
                "fixed.load_lag = 0.3",
                "load_lag = 0.3 is outside",
                Some("load_lag"),
            ),
        ] {
            let friction = "friction = { law = \"coulomb\", mu0 = 0.4 }\nfixed.v0 = 0.1\n";
            let whole = match at {
                Some(_) => format!("{text}\n{friction}"),
                None => text.to_owned(),
            };
            let error = whole.parse::<CaseSpec>().unwrap_err();
            assert!(error.message.contains(says), "{text}: {error}");
            let place = error.span.clone().map(|span| &whole[span]);
            assert_eq!(place, at, "{text}: {error}");
        }
    }
}
