//! `slipmap best`: the settings of fastest decay.

use std::path::PathBuf;

use slipmap::explore::point::Point;
use slipmap::explore::stability::Wanted;
use slipmap::explore::vc::CriticalVelocity;
use slipmap::linear::best::SearchedGain;
use slipmap::model::stop::Stop;
use slipmap::model::{ModelError, Shown};
use slipmap::sweep::cells::best::{Ranges, best_settings, default_ranges, robust_setting};
use slipmap::sweep::input::search::Protocol;
use slipmap::sweep::input::simulation::NOT_IN_MOTIONS;
use slipmap::sweep::{Parameter, Setting};

use super::asks::AtAnyDelay;
use super::best_answer::BestAnswer;
use super::best_system::{self, SystemBest};
use super::best_text;
use super::failure::Failure;
use super::json::{self, AnswerSchema, Inputs};
use super::margins;
use super::parameters::ParameterArgs;
use super::recommended::{Control, Recommended};
use super::say::{self, ForPeople};
use super::setting;
use super::system_args::SystemArgs;
use super::vc;

/// All that the margins of a setting need to be asked with.
const WANTED: Wanted = Wanted {
    roots: 1,
    line: None,
};

#[derive(Debug, clap::Args)]
#[command(after_help = "Example: slipmap best --mu-prime -0.3 --control velocity

Searched where no ranges are given, with b = μ′N0/√(κM): delays from 0 to \
four periods of the free oscillator; gains of \
velocity control up to ±2 max(1, |b|) √(κ/M); gains of load \
control from 4(1 + |b|) κ/μ_K below the weakest negative one that \
stabilises, -(|b| + b²/2) κ/μ_K, to 4(1 + |b|) κ/μ_K.")]
pub(super) struct Args {
    #[command(flatten)]
    pub(super) parameters: ParameterArgs<AtAnyDelay>,
    #[command(flatten)]
    pub(super) system: SystemArgs,
    /// With --system: the parameter of it that is searched beside the delay
    #[arg(long, value_name = "NAME", requires = "system")]
    pub(super) search: Option<String>,
    /// The gain that is searched; the other one is given as usual [default: velocity]
    #[arg(long, value_enum)]
    pub(super) control: Option<Control>,
    /// Smallest gain to search, or smallest value of --search
    #[arg(
        long,
        visible_alias = "search-from",
        allow_hyphen_values = true,
        value_name = "A"
    )]
    pub(super) alpha_from: Option<f64>,
    /// Largest gain to search, or largest value of --search
    #[arg(
        long,
        visible_alias = "search-to",
        allow_hyphen_values = true,
        value_name = "A"
    )]
    pub(super) alpha_to: Option<f64>,
    /// Shortest delay to search
    #[arg(long, allow_hyphen_values = true, value_name = "T")]
    pub(super) tau_from: Option<f64>,
    /// Longest delay to search
    #[arg(long, allow_hyphen_values = true, value_name = "T")]
    pub(super) tau_to: Option<f64>,
    /// Also find the setting whose slowest decay is fastest when gain, delay and μ′ may all be off
    /// by this part of them, such as 0.05
    #[arg(long, value_name = "SPREAD", allow_hyphen_values = true, value_parser = parse_spread)]
    pub(super) robust: Option<f64>,
    /// Write the setting (the robust one with --robust), if it is stable, to a file; point and
    /// margins take it with --setting, and with a friction law vc and basin, and simulate as a case
    /// file
    #[arg(long, value_name = "SETTING.toml")]
    pub(super) save: Option<PathBuf>,
    /// One JSON object on standard output
    #[arg(long)]
    pub(super) json: bool,
}

fn parse_spread(text: &str) -> Result<f64, String> {
    let spread = text.trim().parse().ok();
    let spread = spread.filter(|s: &f64| (1e-6..=0.9).contains(s));
    spread.ok_or_else(|| "expected a part, from 1e-6 to 0.9, such as 0.05 for 5 %".to_owned())
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    if args.system.system.is_some() {
        return best_system::main(args);
    }
    if let Some(path) = &args.save {
        setting::check_save(path)?;
    }
    let gain = args.control().searched();
    let help = "leave it out; --alpha-from, --alpha-to, --tau-from and --tau-to are the ranges of \
        the search";
    let setting = args
        .parameters
        .setting_but(&[args.control().parameter(), Parameter::Tau], help)?;
    let refused = |error: ModelError| args.parameters.refused(&error);
    setting.sliding_point().map_err(refused)?;
    let ranges = ranges(args, &default_ranges(&setting, gain)?)?;
    args.parameters.tell_static_friction("v_c depends on it");
    let told = args.recommend(&setting, gain, &ranges)?;
    if let Some(found) = &told.vc {
        vc::warn_beyond_curve(&told.setting, found, &args.parameters.units());
    }
    if args.json {
        let inputs = args.inputs(&setting, &ranges);
        json::print(&inputs, &BestAnswer::of(&told)?)?;
    } else {
        let mut out = ForPeople::begin();
        best_text::print(&mut out, &told, &args.parameters.units())?;
    }
    let Some(path) = &args.save else {
        return Ok(());
    };
    if told.found.overall.relaxation_time().is_none() {
        let message = format!("{} is not written: no setting is stable", path.display());
        let help = "other ranges (--alpha-from, --tau-to, …) or the other --control may hold one";
        return Err(Failure::failed_with_help(message, help));
    }
    setting::save(&told.setting, &args.parameters.units(), path)?;
    match args.json {
        true => Ok(()),
        false => say::result(path.display()),
    }
}

/// What its JSON looks like.
pub(super) fn described() -> AnswerSchema {
    AnswerSchema::of("best")
        .or::<BestAnswer>()
        .or::<SystemBest>()
}

impl Args {
    fn control(&self) -> Control {
        self.control.unwrap_or(Control::Velocity)
    }

    fn inputs(&self, setting: &Setting, ranges: &Ranges) -> Inputs {
        let searched = [self.control().parameter(), Parameter::Tau];
        let given = |parameter| !searched.contains(&parameter);
        let inputs = Inputs::of_setting(setting, &self.parameters.units(), given);
        let inputs = inputs.and("control", self.control());
        let inputs = inputs.and("alpha_from", ranges.gain.0);
        let inputs = inputs.and("alpha_to", ranges.gain.1);
        let inputs = inputs.and("tau_from", ranges.tau.0);
        let inputs = inputs.and("tau_to", ranges.tau.1);
        inputs.and("robust", self.robust)
    }

    fn recommend(
        &self,
        setting: &Setting,
        gain: SearchedGain,
        ranges: &Ranges,
    ) -> Result<Recommended, Failure> {
        let (found, robust) = match self.robust {
            Some(spread) => robust_setting(setting, gain, ranges, spread)?,
            None => (
                best_settings(setting, gain, ranges, &Stop::default())?,
                None,
            ),
        };
        let (gain, tau) = match &robust {
            Some(of) => (of.robust.gain, of.robust.tau),
            None => (found.overall.gain, found.overall.tau),
        };
        let mut best = setting.clone();
        best.set(self.control().parameter(), gain);
        best.set(Parameter::Tau, tau);
        let motions = !best.has_state() && best.beyond_letter(NOT_IN_MOTIONS).is_none();
        let vc = match best.law().filter(|_| motions) {
            Some(_) => Some(CriticalVelocity::of(
                &best,
                Protocol::Follow,
                &Stop::default(),
            )?),
            None => None,
        };
        let point = Point::at(&best, WANTED, &Stop::default())?;
        Ok(Recommended {
            control: self.control(),
            ranges: *ranges,
            spread: self.robust,
            found,
            robust,
            unstable_roots: margins::violations(&point.stability),
            margins: point.margins,
            vc,
            setting: best,
        })
    }
}

/// The ranges that the flags give, over those searched by default.
fn ranges(args: &Args, default: &Ranges) -> Result<Ranges, Failure> {
    let check = |parameter: Parameter| {
        move |flag: &str, value: f64| {
            let checked = parameter.check(value);
            checked.map_or_else(|e| Err(Failure::out_of_range(flag, &e)), |_| Ok(()))
        }
    };
    Ok(Ranges {
        gain: range(
            [
                ("--alpha-from", args.alpha_from),
                ("--alpha-to", args.alpha_to),
            ],
            default.gain,
            check(args.control().parameter()),
        )?,
        tau: range(
            [("--tau-from", args.tau_from), ("--tau-to", args.tau_to)],
            default.tau,
            check(Parameter::Tau),
        )?,
    })
}

/// The range that two flags give, with the ends of `default` where they give none. `check` refuses
/// the value of a flag.
pub(super) fn range(
    [(from_flag, from), (to_flag, to)]: [(&str, Option<f64>); 2],
    default: (f64, f64),
    check: impl Fn(&str, f64) -> Result<(), Failure>,
) -> Result<(f64, f64), Failure> {
    for (flag, value) in [(from_flag, from), (to_flag, to)] {
        if let Some(value) = value {
            check(flag, value)?;
        }
    }
    let (low, high) = (from.unwrap_or(default.0), to.unwrap_or(default.1));
    if low <= high {
        return Ok((low, high));
    }
    let origin = |given: Option<f64>| given.map_or(", its default", |_| "");
    Err(Failure::bad_input_with_help(
        format!(
            "{from_flag} {}{} is above {to_flag} {}{}",
            Shown(low),
            origin(from),
            Shown(high),
            origin(to)
        ),
        format!("{from_flag} must be at most {to_flag}"),
    ))
}
