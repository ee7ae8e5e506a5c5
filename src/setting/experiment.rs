//! An experiment that measures friction through control, read and checked once.
//!
//! ```toml
//! title = "Friction at ten velocities"    # optional
//! seed = 0                        # what the noise of readings is drawn with
//!
//! [experiment]
//! v0 = { from = 0.02, to = 2.0, points = 10, spacing = "log" }     # or a list
//! setting = "best"                # for each v0; or "given": that in [fixed]
//! control = "load"                # or "velocity": with setting = "best"
//! start = "sliding"               # 1 % off it; or "step" from the v0 before; or "stick-slip"
//! wait = 60.0                     # 25 relaxation times and 2 delays by default
//! average = 1000.0                # 100 relaxation times by default
//! drift = 0.0                     # r of v0 (1 + r t)
//! repeats = 1                     # each with noise of its own
//!
//! [friction]                      # as in case files
//! law = "weakening"
//! mu0 = 0.5
//! v_s = 0.5
//!
//! [fixed]                         # as in case files, without v0
//! sample_time = 0.05
//! noise = 0.001
//! ```

use std::ops::Range;

use super::best_plane::parameter_of;
use super::given::GivenParameters;
use super::given_key::GivenKey;
use super::keys::{CASE, EXPERIMENT, EXPERIMENT_FILE, names};
use super::parameter::{Group, Parameter};
use super::quantity::Quantity;
use super::simulation::{NOT_IN_MOTIONS, POSITIVE, Simulation};
use super::units::Units;
use super::values::Setting;
use crate::linear::best::SearchedGain;
use crate::text::Shown;
use crate::text::document::Document;
use crate::text::toml_reader::{Entry, SpecError, entries, parse};

/// The most v0.
const MOST_V0: u64 = 1000;
/// The most measurements of each.
const MOST_REPEATS: u64 = 100_000;
/// The largest drift, over the inverse unit of time.
const LARGEST_DRIFT: f64 = 1e12;

/// Where gain and delay come from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Chosen {
    /// The file gives them.
    Given,
    /// For each v0 the best robust ones, of this gain.
    Best(SearchedGain),
}

impl Chosen {
    /// Its name in files and answers.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Given => "given",
            Self::Best(_) => "best",
        }
    }
}

/// How a block begins at each v0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Begin {
    /// Faster than it is pulled by 1 %, as after a small step of v0.
    Sliding,
    /// From sliding at the v0 before: v0 jumps. The first one as `Sliding`.
    Step,
    /// Just released from uncontrolled stick-slip; as `Sliding` where there is none.
    StickSlip,
}

impl Begin {
    const ALL: [Self; 3] = [Self::Sliding, Self::Step, Self::StickSlip];

    /// Its name in files and answers.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sliding => "sliding",
            Self::Step => "step",
            Self::StickSlip => "stick-slip",
        }
    }
}

/// An experiment: every value in range, every name known.
#[derive(Debug, Clone, PartialEq)]
pub struct ExperimentSpec {
    /// Title; may be empty.
    pub title: String,
    /// All parameters but v0, with a friction law; gain and delay with [`Chosen::Given`].
    pub setting: Setting,
    /// The pulling velocities, at least one.
    pub v0: Vec<f64>,
    /// Where gain and delay come from.
    pub chosen: Chosen,
    /// How the block begins at each v0.
    pub begin: Begin,
    /// How long each v0 is held before the mean begins; none for the default.
    pub wait: Option<f64>,
    /// How long the elongation is averaged; none for the default.
    pub average: Option<f64>,
    /// r of v0 (1 + r t), in 1/time.
    pub drift: f64,
    /// How often each v0 is measured, at least once.
    pub repeats: u32,
    /// Steps, tolerance and seed.
    pub simulation: Simulation,
    /// Units of the parameters.
    pub units: Units,
}

impl std::str::FromStr for ExperimentSpec {
    type Err = SpecError;

    /// Reads an experiment.
    ///
    /// # Errors
    /// Points at the first place that is not understood, out of range or contradictory.
    fn from_str(text: &str) -> Result<Self, SpecError> {
        let parsed = parse(text)?;
        let mut document = Document::of(entries(parsed.get_ref(), ""), names(&EXPERIMENT_FILE));
        let known = names(&EXPERIMENT_FILE);
        let mut of_cases = names(&CASE);
        of_cases.retain(|key| !known.contains(key));
        document.refuse(
            &of_cases,
            "it is a key of a case file; how an experiment begins and lasts stands in [experiment]",
        );
        let title = document.take("title", Entry::line).unwrap_or_default();
        let given = GivenParameters::of(&mut document, text, takes);
        let units = given.units().clone();
        let keys = document.take("experiment", |table| Keys::read(table, &units));
        let simulation = Simulation::of(&mut document, &units);
        document.finish()?;
        let Some(keys) = keys else {
            return Err(
                SpecError::whole("an experiment needs the table [experiment]")
                    .help("for example: [experiment] v0 = [0.1, 0.2, 0.5]"),
            );
        };
        let setting = setting(&given, &keys)?;
        keys.check(&given, &setting)?;
        Ok(Self {
            title: title.to_owned(),
            setting,
            v0: keys.v0,
            chosen: keys.chosen,
            begin: keys.begin,
            wait: keys.wait,
            average: keys.average.map(|(average, _)| average),
            drift: keys.drift,
            repeats: keys.repeats,
            simulation,
            units,
        })
    }
}

/// Whether an experiment takes the parameter.
fn takes(parameter: Parameter) -> bool {
    matches!(parameter.group(), Group::Model)
}

/// The table `[experiment]`.
struct Keys {
    v0: Vec<f64>,
    place_of_v0: Range<usize>,
    chosen: Chosen,
    begin: Begin,
    wait: Option<f64>,
    average: Option<(f64, Range<usize>)>,
    drift: f64,
    repeats: u32,
}

impl Keys {
    fn read(table: &Entry, units: &Units) -> Result<Self, SpecError> {
        let mut keys = table.document(names(&EXPERIMENT))?;
        let time = |entry: &Entry| units.number_within(entry, Parameter::Tau.dimension(), POSITIVE);
        let v0 = keys.take("v0", |entry| read_v0(entry, units));
        let best = keys.take("setting", read_setting).unwrap_or(true);
        let control = keys.take("control", read_control);
        let begin = keys.take("start", read_begin).unwrap_or(Begin::Sliding);
        let wait = keys.take("wait", time);
        let average = keys.take("average", |entry| Ok((time(entry)?, entry.span.clone())));
        let drift = keys.take("drift", |entry| {
            let range = -LARGEST_DRIFT..=LARGEST_DRIFT;
            units.number_within(entry, Parameter::AlphaV.dimension(), range)
        });
        let repeats = keys.take("repeats", read_repeats).unwrap_or(1);
        keys.finish()?;
        let place = keys.value("v0").cloned();
        let (Some(v0), Some(place_of_v0)) = (v0, place) else {
            let error = SpecError::at(table.key_span.clone(), "[experiment] needs v0");
            return Err(error.help("for example: v0 = [0.1, 0.2, 0.5]"));
        };
        if let (false, Some(place)) = (best, keys.key("control")) {
            let message = "control has no meaning with setting = \"given\"";
            return Err(SpecError::at(place.clone(), message)
                .help("alpha_n, alpha_v and tau in [fixed] say what controls"));
        }
        Ok(Self {
            v0,
            place_of_v0,
            chosen: match best {
                true => Chosen::Best(control.unwrap_or(SearchedGain::Load)),
                false => Chosen::Given,
            },
            begin,
            wait,
            average,
            drift: drift.unwrap_or(0.0),
            repeats,
        })
    }

    /// Checks what several keys say together.
    fn check(&self, given: &GivenParameters, setting: &Setting) -> Result<(), SpecError> {
        let [least, most] = [Parameter::VMin, Parameter::VMax].map(|limit| setting.get(limit));
        if let Some(v0) = self.v0.iter().find(|v0| **v0 <= least || **v0 >= most) {
            let message = format!(
                "v0 = {} is not between v_min and v_max, {} and {}",
                Shown(*v0),
                Shown(least),
                Shown(most)
            );
            return Err(SpecError::at(self.place_of_v0.clone(), message)
                .help("control acts around v0: v_min < v0 < v_max"));
        }
        let sample_time = setting.get(Parameter::SampleTime);
        match &self.average {
            Some((average, place)) if *average < sample_time => {
                let message = format!(
                    "average = {} is shorter than sample_time = {}: it has no reading",
                    Shown(*average),
                    Shown(sample_time)
                );
                Err(SpecError::at(place.clone(), message))
            }
            _ => {
                let mut at = setting.clone();
                let slides = |v0: &f64| {
                    at.set(Parameter::V0, *v0);
                    at.sliding_point().map(|_| ())
                };
                let slides = self.v0.iter().try_for_each(slides);
                slides.map_err(|error| given.refused(&error))
            }
        }
    }
}

/// Reads the velocities, a list or a range.
fn read_v0(entry: &Entry, units: &Units) -> Result<Vec<f64>, SpecError> {
    let key = GivenKey::from(Quantity::Known(Parameter::V0));
    let axis = key.axis(entry, units, MOST_V0)?;
    match axis.len() as u64 {
        1..=MOST_V0 => Ok(axis.values),
        more => Err(entry.error(format!("{more} velocities: at most {MOST_V0}"))),
    }
}

/// One of the words that a key takes.
fn word<T: Copy>(entry: &Entry, known: &[(&str, T)]) -> Result<T, SpecError> {
    let said = entry.string()?;
    let found = known.iter().find(|(name, _)| *name == said);
    found.map(|(_, value)| *value).ok_or_else(|| {
        let names: Vec<&str> = known.iter().map(|(name, _)| *name).collect();
        let error = entry.error(format!("unknown {} \"{said}\"", entry.key));
        error.help(format!("known: {}", names.join(", ")))
    })
}

/// Whether the best settings are looked for.
fn read_setting(entry: &Entry) -> Result<bool, SpecError> {
    word(entry, &[("best", true), ("given", false)])
}

fn read_control(entry: &Entry) -> Result<SearchedGain, SpecError> {
    let known = [
        ("load", SearchedGain::Load),
        ("velocity", SearchedGain::Velocity),
    ];
    word(entry, &known)
}

fn read_begin(entry: &Entry) -> Result<Begin, SpecError> {
    word(entry, &Begin::ALL.map(|begin| (begin.name(), begin)))
}

fn read_repeats(entry: &Entry) -> Result<u32, SpecError> {
    match entry.whole()? {
        repeats @ 1..=MOST_REPEATS => Ok(repeats as u32),
        other => Err(entry.error(format!("{other} is outside its range: 1 to {MOST_REPEATS}"))),
    }
}

/// The setting of an experiment, without v0.
fn setting(given: &GivenParameters, keys: &Keys) -> Result<Setting, SpecError> {
    let Some(law_place) = given.law_place() else {
        return Err(SpecError::whole("an experiment needs a friction law")
            .help("for example: [friction] law = \"weakening\", mu0 = 0.5, v_s = 0.5"));
    };
    given.check_motions()?;
    let refuse = |parameter: Parameter, why: String, help: &str| match given.place(parameter) {
        Some(place) => Err(SpecError::at(place.clone(), why).help(help)),
        None => Ok(()),
    };
    let v0 = Parameter::V0;
    refuse(
        v0,
        "v0: the velocities of an experiment stand in [experiment]".to_owned(),
        "leave it out here",
    )?;
    for of_start in Parameter::ALL.into_iter().filter(|p| p.of_start()) {
        let why = format!("{} has no meaning in an experiment", of_start.name());
        refuse(
            of_start,
            why,
            "start in [experiment] says how each v0 begins",
        )?;
    }
    let mut optional = vec![v0];
    if let Chosen::Best(gain) = keys.chosen {
        for searched in [parameter_of(gain), Parameter::Tau] {
            let why = format!("a value of {} is given, which is searched", searched.name());
            refuse(
                searched,
                why,
                "leave it out; or setting = \"given\" in [experiment]",
            )?;
        }
        optional.push(Parameter::Tau);
    }
    let mut setting = given.setting();
    if keys.chosen == Chosen::Given && !setting.control().act() {
        let error = SpecError::whole("setting = \"given\", but no gain acts");
        return Err(
            error.help("give alpha_n or alpha_v, and tau, in [fixed]; or setting = \"best\"")
        );
    }
    given.check(&optional, Some(law_place))?;
    if matches!(keys.chosen, Chosen::Best(_)) {
        setting.set(Parameter::Tau, 0.0);
    }
    let lags = setting.check_of_letter(NOT_IN_MOTIONS, "0 where motions are followed");
    lags.map_err(|error| given.refused(&error))?;
    Ok(setting)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: &str = "[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";

    fn read(experiment: &str, fixed: &str) -> Result<ExperimentSpec, SpecError> {
        format!("[experiment]\n{experiment}\n{LAW}[fixed]\n{fixed}").parse()
    }

    #[test]
    fn what_is_left_out_has_its_default() {
        let spec = read("v0 = [0.2, 0.1]", "").unwrap();
        assert_eq!(spec.v0, [0.2, 0.1]);
        assert_eq!(spec.chosen, Chosen::Best(SearchedGain::Load));
        assert_eq!(
            (spec.begin, spec.repeats, spec.drift),
            (Begin::Sliding, 1, 0.0)
        );
        assert_eq!((spec.wait, spec.average), (None, None));
        let range = "v0 = { from = 0.1, to = 10, points = 3, spacing = \"log\" }\n\
            setting = \"given\"\nstart = \"stick-slip\"\nwait = 3\naverage = \"20\"";
        let range = range.replace("\"20\"", "20");
        let spec = read(&range, "alpha_n = -10\ntau = 0.5").unwrap();
        assert_eq!(spec.v0, [0.1, 1.0, 10.0]);
        assert_eq!((spec.chosen, spec.begin), (Chosen::Given, Begin::StickSlip));
        assert_eq!((spec.wait, spec.average), (Some(3.0), Some(20.0)));
    }

    #[test]
    fn mistakes_are_pointed_at() {
        for (experiment, fixed, says, at) in [
            ("", "", "[experiment] needs v0", "experiment"),
            ("v0 = []", "", "the list is empty", "[]"),
            ("v0 = [0.1, -1]", "", "v0", "-1"),
            ("v0 = [0.1]\naverage = 0.0", "", "average", "0.0"),
            ("v0 = [0.1]\nwait = -2", "", "wait", "-2"),
            ("v0 = [0.1]\nrepeats = 0", "", "1 to 100000", "0"),
            (
                "v0 = [0.1]\nstart = \"rest\"",
                "",
                "unknown start",
                "\"rest\"",
            ),
            ("v0 = [0.1]", "v0 = 0.3", "stand in [experiment]", "v0"),
            ("v0 = [0.1]", "tau = 0.3", "which is searched", "tau"),
            ("v0 = [0.1]", "noise = 0.1", "there are none", "noise"),
            ("v0 = [0.1]", "load_lag = 0.1", "load_lag", "load_lag"),
            (
                "v0 = [0.1]\naverage = 0.01",
                "sample_time = 0.05",
                "no reading",
                "0.01",
            ),
            (
                "v0 = [0.1]\nsetting = \"given\"\ncontrol = \"load\"",
                "alpha_n = -1\ntau = 1",
                "no meaning",
                "control",
            ),
            (
                "v0 = [0.1, 0.9]",
                "v_max = 0.5",
                "between v_min",
                "[0.1, 0.9]",
            ),
        ] {
            let text = format!("[experiment]\n{experiment}\n{LAW}[fixed]\n{fixed}");
            let error = text.parse::<ExperimentSpec>().unwrap_err();
            assert!(error.message.contains(says), "{error} {says}");
            let span = error.span.clone().map(|span| &text[span]);
            assert_eq!(span, Some(at), "{error}");
        }
        let error = "[experiment]\nv0 = [0.1]\n"
            .parse::<ExperimentSpec>()
            .unwrap_err();
        assert!(error.message.contains("friction law"), "{error}");
        let error = LAW.parse::<ExperimentSpec>().unwrap_err();
        assert!(error.message.contains("[experiment]"), "{error}");
        let error = read("v0 = [0.1]\nsetting = \"given\"", "").unwrap_err();
        assert!(error.message.contains("no gain acts"), "{error}");
        let text = format!("switch_on = 3\n[experiment]\nv0 = [0.1]\n{LAW}");
        let error = text.parse::<ExperimentSpec>().unwrap_err();
        assert_eq!(&text[error.span.unwrap()], "switch_on");
    }
}
