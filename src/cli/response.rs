//! `slipmap simulate --system`: the response of a system from a file in time.

use std::io::Write;
use std::path::Path;

use clap::ValueEnum;
use serde::Serialize;
use utoipa::ToSchema;

use crate::explore::response::{Excitation, ResponseError, TimeResponse};
use crate::linear::response::{NoResponse, SETTLED};
use crate::model::stop::Stop;
use crate::report::numbers::{grouped, unit_behind};
use crate::report::picture::{self, Picture, ResponsePicture};
use crate::report::table::write_response;
use crate::setting::Parameter;
use crate::text::finite;

use super::asked::{Asked, subject};
use super::asks::OfStickSlip;
use super::cell::alone;
use super::digits::Digits;
use super::failure::Failure;
use super::json;
use super::output::{check_picture, tell_dimensionless};
use super::parameters::ParameterArgs;
use super::say::{self, ForPeople};
use super::signals::Signals;
use super::system_args::{OTHERS, SystemArgs};
use super::text_output::To;

/// Samples of a response.
const SAMPLES: usize = 2001;

/// The flags of a response.
#[derive(Debug, clap::Args)]
pub(super) struct ResponseArgs {
    #[command(flatten)]
    pub system: SystemArgs,
    /// With --system, for a loop of plant and controller: a step of the reference, or of a
    /// disturbance at the input of the plant, from rest [default: a disturbance of the state, with
    /// y = 1 at t = 0 and nothing before]
    #[arg(long, value_enum, value_name = "OF", requires = "system")]
    step: Option<Step>,
}

/// What steps.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum Step {
    /// The reference
    Reference,
    /// A disturbance at the input of the plant
    Disturbance,
}

/// The JSON of a response. Times are in the unit of the delay.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct ResponseOut {
    /// What the system is, by its file; may be empty.
    system: String,
    /// `start`, `reference` or `disturbance`.
    step: &'static str,
    /// Whether the system is stable; only then it settles.
    stable: bool,
    /// The real part of the rightmost root; null where it is not known.
    #[schema(required)]
    abscissa: Option<f64>,
    /// Until when the response was followed.
    until: f64,
    /// The value at which it settles; null where it does not.
    #[schema(required)]
    final_value: Option<f64>,
    /// The largest value in the direction of the final value; without one, or with 0, the value of
    /// the largest size.
    peak: f64,
    /// When the peak is reached.
    peak_time: f64,
    /// By how much the peak is above the final value, in percent of it; null where that is 0 or
    /// there is none.
    #[schema(required)]
    overshoot: Option<f64>,
    /// The time from 10 % to 90 % of the final value; null where it is not reached.
    #[schema(required)]
    rise_time: Option<f64>,
    /// From when on it stays within 2 % of the final value, or within 2 % of the peak of a final
    /// value of 0; null where it is outside at the end.
    #[schema(required)]
    settling_time: Option<f64>,
    /// The number of Taylor steps.
    steps: usize,
    /// The file of its samples; null where none was written.
    #[schema(required)]
    trace: Option<String>,
}

/// Where a response is told.
pub(super) struct Told<'a> {
    pub until: Option<f64>,
    /// Where its samples go.
    pub samples: Option<To<'a>>,
    pub picture: Option<&'a Path>,
    pub digits: Digits,
    pub json: bool,
}

impl ResponseArgs {
    /// Whether a system is given.
    pub(super) fn is_given(&self) -> bool {
        self.system.system.is_some()
    }

    /// The system at its setting, given beside these flags and `others`.
    pub(super) fn asked(
        &self,
        parameters: &ParameterArgs<OfStickSlip>,
        others: bool,
    ) -> Result<Option<Asked>, Failure> {
        alone("--system", others || parameters.any_but_units(&OTHERS))?;
        parameters.refuse_units()?;
        let (sets, units) = (parameters.sets(), parameters.units());
        self.system
            .read(sets, &units, None, |p| parameters.given(p))
    }

    /// Computes the response and tells it.
    pub(super) fn main(
        &self,
        asked: &Asked,
        told: &Told,
        signals: &Signals,
    ) -> Result<(), Failure> {
        if let Some(picture) = told.picture {
            let other = match told.samples {
                Some(To::File(path)) => Some(path),
                _ => None,
            };
            check_picture("--picture", picture, other)?;
        }
        let (to, name) = match self.step {
            None => (Excitation::Start, "start"),
            Some(Step::Reference) => (Excitation::Reference, "reference"),
            Some(Step::Disturbance) => (Excitation::Disturbance, "disturbance"),
        };
        let until = (told.until, SAMPLES);
        let found = signals.or_end("there is no response", || {
            TimeResponse::of(&asked.setting, to, until, &Stop::default())
        });
        let found = found.map_err(|error| refused(&error))?;
        if let Some(to) = told.samples {
            to.write(signals, "there is no response", |out, stop| {
                write_response(&found.response, &asked.units.time(), out, stop)
            })?;
        }
        if let Some(picture) = told.picture {
            draw(asked, &found, picture)?;
        }
        match (told.samples, told.json) {
            (_, true) => {
                let inputs = asked.inputs(|_| true).and("step", name);
                let inputs = inputs.and("until", found.until);
                json::print(&inputs, &out(asked, &found, name, told))
            }
            (Some(To::StandardOutput), false) => Ok(()),
            (samples, false) => {
                print(&mut ForPeople::begin(), asked, (&found, name), told.digits)?;
                if let Some(To::File(path)) = samples {
                    let rows = grouped(found.response.t.len() as u64);
                    say::result(format_args!("{}: {rows} samples", path.display()))?;
                }
                told.picture
                    .map_or(Ok(()), |picture| say::result(picture.display()))
            }
        }
    }
}

fn refused(error: &ResponseError) -> Failure {
    let help = match error {
        ResponseError::NoAnswer(why) => return why.clone().into(),
        ResponseError::NoLoop(_) => "leave --step out for a disturbance of its state",
        ResponseError::NoResponse(NoResponse::TooLong { .. } | NoResponse::Grows { .. }) => {
            "--until T ends it earlier"
        }
        ResponseError::NoResponse(_) => "point tells its roots",
    };
    Failure::bad_input_with_help(error.to_string(), help)
}

fn out(asked: &Asked, found: &TimeResponse, step: &'static str, told: &Told) -> ResponseOut {
    let of = &found.response.measures;
    ResponseOut {
        system: asked
            .setting
            .system()
            .map_or(String::new(), |of| of.title.clone()),
        step,
        stable: found.stability.stable,
        abscissa: finite(found.stability.spectrum.abscissa),
        until: found.until,
        final_value: of.final_value,
        peak: of.peak,
        peak_time: of.peak_time,
        overshoot: of.overshoot.map(|share| 100.0 * share),
        rise_time: of.rise_time,
        settling_time: of.settling_time,
        steps: found.response.steps,
        trace: match told.samples {
            Some(To::File(path)) => Some(path.display().to_string()),
            _ => None,
        },
    }
}

/// What becomes of the response, in words.
fn verdict(asked: &Asked, found: &TimeResponse, digits: Digits) -> String {
    let of = &found.response.measures;
    let unit = unit_behind(&asked.units.time());
    let time = |value: f64| digits.of(value) + &unit;
    let band = |at: f64| {
        let of = if at == 0.0 { " of the peak" } else { "" };
        format!("within {} %{of}", 100.0 * SETTLED)
    };
    let abscissa = found.stability.spectrum.abscissa;
    match (of.final_value, of.settling_time) {
        (Some(at), Some(from)) => {
            let (at, band) = (digits.of(at), band(at));
            format!("settles at {at}: {band} from t = {} on", time(from))
        }
        (Some(at), None) => {
            let (at, band) = (digits.of(at), band(at));
            format!(
                "goes to {at}, and is not {band} at t = {}",
                time(found.until)
            )
        }
        (None, _) if abscissa > 0.0 => {
            let growth = time(1.0 / abscissa);
            format!("does not settle: disturbances grow by a factor e in {growth}")
        }
        (None, _)
            if found
                .stability
                .n_unstable
                .is_none_or(|_| found.stability.marginal) =>
        {
            "is not known to settle: stability is not decided".to_owned()
        }
        (None, _) => "does not settle".to_owned(),
    }
}

/// Writes the response for people.
fn print(
    out: &mut impl Write,
    asked: &Asked,
    (found, name): (&TimeResponse, &str),
    digits: Digits,
) -> std::io::Result<()> {
    let of = &found.response.measures;
    let unit = unit_behind(&asked.units.time());
    let time = |value: f64| digits.of(value) + &unit;
    let optional = |value: Option<f64>, unit: &str| match value {
        Some(value) => digits.of(value) + unit,
        None => "none".to_owned(),
    };
    let subject = subject(&asked.setting, "the system");
    let verdict = verdict(asked, found, digits);
    writeln!(out, "the response of {subject} {verdict}")?;
    let to = match name {
        "start" => "a disturbance of the state, y = 1 at t = 0".to_owned(),
        _ => format!("a step of the {name}, 1 from t = 0 on"),
    };
    let peak = format!("{} at t = {}", digits.of(of.peak), time(of.peak_time));
    let tau = asked.setting.get(Parameter::Tau);
    let mut rows = vec![
        ("to", to),
        ("tau", time(tau)),
        ("final_value", optional(of.final_value, "")),
        ("peak", peak),
    ];
    if let Some(share) = of.overshoot {
        rows.push(("overshoot", digits.of(100.0 * share) + " %"));
        rows.push(("rise_time", optional(of.rise_time, &unit)));
    }
    rows.extend([
        ("settling_time", optional(of.settling_time, &unit)),
        ("until", time(found.until)),
        ("steps", found.response.steps.to_string()),
    ]);
    for (name, value) in rows {
        writeln!(out, "  {name:<16} {value}")?;
    }
    tell_dimensionless(out, &asked.units)
}

fn draw(asked: &Asked, found: &TimeResponse, path: &Path) -> Result<(), Failure> {
    let title = asked.setting.system().map_or("", |of| &of.title);
    let drawn = ResponsePicture {
        of: &found.response,
        time: &asked.units.time(),
        title: if title.is_empty() {
            "Response in time"
        } else {
            title
        },
    };
    let picture = picture::draw_response(&drawn, path);
    let saved = picture.and_then(Picture::save);
    saved.map_err(|error| Failure::failed(error.to_string()))
}
