//! `slipmap best`: the settings of fastest decay.

use std::path::PathBuf;

use crate::answers::best::{Ranges, default_ranges};
use crate::explore::best::{Control, NotFound, Recommended, Searched};
use crate::explore::best_answer::{BestAnswer, BestSetting, SystemBest};
use crate::explore::robust::{MayBeOff, NotRobust, Spread};
use crate::model::ModelError;
use crate::model::stop::Stop;
use crate::report::numbers::rounded;
use crate::setting::amount::Amount;
use crate::setting::point_file::PointOf;
use crate::setting::quantity::Quantity;
use crate::setting::system::SystemModel;
use crate::setting::units::Units;
use crate::setting::{Parameter, Setting};
use crate::text::nearest::did_you_mean;
use crate::text::{Shown, SpecError, words};

use super::asked::Asked;
use super::asks::AtAnyDelay;
use super::best_text;
use super::cell::alone;
use super::failure::Failure;
use super::inputs_line;
use super::json::{self, AnswerSchema, Inputs};
use super::output::warn_beyond_curve;
use super::parameter_values::{amount_of, parse_amount};
use super::parameters::ParameterArgs;
use super::say::{self, ForPeople};
use super::setting;
use super::sweep_file::read_setting;
use super::system_args::{OTHERS, SystemArgs};

#[derive(Debug, clap::Args)]
#[command(after_help = "Example: slipmap best --mu-prime -0.3 --control velocity

Searched where no ranges are given, with b = μ′N0/√(κM): delays from 0 to \
four periods of the free oscillator; gains of \
velocity control up to ±2 max(1, |b|) √(κ/M); gains of load \
control from 4(1 + |b|) κ/μ_K below the weakest negative one that \
stabilises, -(|b| + b²/2) κ/μ_K, to 4(1 + |b|) κ/μ_K.")]
pub(super) struct Args {
    #[command(flatten)]
    parameters: ParameterArgs<AtAnyDelay>,
    #[command(flatten)]
    system: SystemArgs,
    /// With --system: the parameter of it that is searched beside the delay
    #[arg(long, value_name = "NAME", requires = "system")]
    search: Option<String>,
    /// The gain that is searched; the other one is given as usual [default: velocity]
    #[arg(long, value_enum)]
    control: Option<Control>,
    /// Smallest gain to search, or smallest value of --search
    #[arg(
        long,
        visible_alias = "search-from",
        allow_hyphen_values = true,
        value_name = "A",
        value_parser = parse_amount
    )]
    alpha_from: Option<Amount>,
    /// Largest gain to search, or largest value of --search
    #[arg(
        long,
        visible_alias = "search-to",
        allow_hyphen_values = true,
        value_name = "A",
        value_parser = parse_amount
    )]
    alpha_to: Option<Amount>,
    /// Shortest delay to search
    #[arg(long, allow_hyphen_values = true, value_name = "T",
          value_parser = amount_of(Parameter::Tau))]
    tau_from: Option<Amount>,
    /// Longest delay to search
    #[arg(long, allow_hyphen_values = true, value_name = "T",
          value_parser = amount_of(Parameter::Tau))]
    tau_to: Option<Amount>,
    /// Also find the setting of a block, whatever its feedback has, whose slowest decay is fastest
    /// when gain, delay and μ′ may all be off by this part of them, such as 0.05; or, with `fit`,
    /// when friction may be off by three standard errors of the fit in --setting
    #[arg(long, value_name = "SPREAD", allow_hyphen_values = true, value_parser = Spread::read)]
    robust: Option<Spread>,
    /// Take all but the delay and the gain that is searched from this file, as `slipmap fit --save`
    /// or `slipmap best --save` writes it
    #[arg(long, value_name = "SETTING.toml", conflicts_with = "system")]
    setting: Option<PathBuf>,
    /// Write the setting (the robust one with --robust), if it is stable, to a file; point and
    /// margins take it with --setting, and with a friction law vc, basin and simulate
    #[arg(long, value_name = "SETTING.toml")]
    save: Option<PathBuf>,
    /// One JSON object on standard output
    #[arg(long)]
    json: bool,
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let (asked, searched) = match args.system.system {
        Some(_) => args.asked_of_system()?,
        None => args.asked_of_block()?,
    };
    let default = default_ranges(&asked.setting, &searched)?;
    let ranges = args.ranges(&asked, &searched, &default)?;
    args.parameters.tell_static_friction("v_c depends on it");
    let named = asked.named;
    let told = Recommended::of(
        Searched {
            setting: asked.setting,
            units: asked.units,
            of: searched,
            ranges,
            robust: args.robust,
        },
        &Stop::default(),
    )?;
    warn_of_few_errors(&told);
    let (setting, units) = (&told.setting, &told.units);
    if let Some(found) = &told.vc {
        warn_beyond_curve(found.beyond_curve(setting, units));
    }
    if args.json {
        json::print(&args.inputs(named, &told), &BestSetting::of(&told))?;
    } else {
        let mut out = ForPeople::begin();
        let mut searched = vec![Parameter::Tau];
        searched.extend(told.searched.known());
        inputs_line::print(&mut out, setting, units, &searched)?;
        best_text::print(&mut out, &told)?;
    }
    let Some(path) = &args.save else {
        return Ok(());
    };
    if told.found.overall.relaxation_time().is_none() {
        let message = format!("{} is not written: no setting is stable", path.display());
        let help = "other ranges (--alpha-from, --tau-to, …) or the other --control may hold one";
        return Err(Failure::failed_with_help(message, help));
    }
    setting::save(setting, units, path)?;
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

    /// The block, and the gain that is searched.
    fn asked_of_block(&self) -> Result<(Asked, Quantity), Failure> {
        if let Some(path) = &self.save {
            setting::check_save(path)?;
        }
        let gain = self.control().parameter();
        let (setting, units) = self.block(gain)?;
        let refused = |error: ModelError| self.parameters.refused(&error);
        setting.sliding_point().map_err(refused)?;
        if self.robust.is_some() && setting.rate_and_state().is_some() {
            return Err(Failure::bad_input_with_help(
                "--robust is not known of friction with a state: gain, delay and mu_prime may be \
                 off, and mu_prime does not tell all of such friction",
                "leave --robust out, or give --mu-prime or a friction law of the velocity alone",
            ));
        }
        let asked = Asked {
            setting,
            units,
            named: None,
        };
        Ok((asked, gain.into()))
    }

    /// The block without its delay and the gain that is searched, from a file or flags, and its
    /// units.
    fn block(&self, gain: Parameter) -> Result<(Setting, Units), Failure> {
        let Some(path) = &self.setting else {
            let help = "leave it out; --alpha-from, --alpha-to, --tau-from and --tau-to are the \
                ranges of the search";
            let setting = self.parameters.setting_but(&[gain, Parameter::Tau], help)?;
            return Ok((setting, self.parameters.units()));
        };
        alone("--setting", self.parameters.any_but(&[]))?;
        let mut point = read_setting(path, PointOf::SlidingAtAnyDelay)?;
        for searched in [gain, Parameter::Tau] {
            let value = searched.default_value().unwrap_or(f64::NAN);
            point.setting.set(searched, value);
        }
        warn_beyond_curve(point.setting.curve_remark(&point.units));
        Ok((point.setting, point.units))
    }

    /// The system from a file, and the parameter of it that is searched.
    fn asked_of_system(&self) -> Result<(Asked, Quantity), Failure> {
        let flags = self.parameters.any_but_units(&OTHERS);
        alone("--system", flags || self.control.is_some())?;
        self.parameters.refuse_units()?;
        let robust = "leave it out: gain, delay and mu_prime may be off, and mu_prime is of a \
            block on its spring";
        for (flag, given, help) in [
            ("--robust", self.robust.is_some(), robust),
            (
                "--save",
                self.save.is_some(),
                "leave it out: it is for a block on its spring",
            ),
        ] {
            if given {
                let message = format!("{flag} is not known of a system from a file");
                return Err(Failure::bad_input_with_help(message, help));
            }
        }
        let flag = |parameter| self.parameters.given(parameter);
        let (sets, units) = (self.parameters.sets(), self.parameters.units());
        let asked = self.system.read_but_delay(sets, &units, flag)?;
        let asked = asked.ok_or_else(|| Failure::bad_input("--system is not given"))?;
        let searched = self.searched(&asked.setting)?;
        let delay = !asked.setting.get(Parameter::Tau).is_nan();
        let name = searched.name();
        let known = searched.known().and_then(flag).is_some();
        let fixed = [
            (delay, "tau"),
            (known || self.parameters.sets().has(name), name),
        ];
        if let Some((_, fixed)) = fixed.into_iter().find(|(given, _)| *given) {
            return Err(Failure::bad_input_with_help(
                format!("a value of {fixed} is given, which is searched"),
                "leave it out; --search-from, --search-to, --tau-from and --tau-to are the \
                 ranges of the search",
            ));
        }
        Ok((asked, searched))
    }

    /// The parameter that `--search` names; where the system has one alone, that one.
    fn searched(&self, setting: &Setting) -> Result<Quantity, Failure> {
        let mut all = setting.system().map_or(vec![], SystemModel::quantities);
        all.retain(|of| *of != Parameter::Tau);
        let names: Vec<&str> = all.iter().map(Quantity::name).collect();
        let listed = names.join(", ");
        let found = match (&self.search, &*all) {
            (Some(name), _) => all.iter().find(|of| words::same(of.name(), name)),
            (None, [alone]) => Some(alone),
            (None, _) => None,
        };
        found.cloned().ok_or_else(|| match &self.search {
            Some(name) => Failure::bad_input_with_help(
                format!("--search: the system has no parameter {name}"),
                format!("{}its parameters: {listed}", did_you_mean(name, names)),
            ),
            None => Failure::bad_input_with_help(
                "--search is not given: which parameter is searched beside the delay",
                format!("parameters of the system: {listed}"),
            ),
        })
    }

    /// The ranges that the flags give, over those searched by default.
    fn ranges(
        &self,
        asked: &Asked,
        searched: &Quantity,
        default: &Ranges,
    ) -> Result<Ranges, Failure> {
        let value = |of: &Quantity, flag: &'static str, end: &Option<Amount>| {
            let value = end.as_ref().map(|end| asked.value(of, flag, end));
            Ok((flag, value.transpose()?))
        };
        let [from, to] = match asked.named {
            None => ["--alpha-from", "--alpha-to"],
            Some(_) => ["--search-from", "--search-to"],
        };
        let tau = Parameter::Tau.into();
        let gain = [
            value(searched, from, &self.alpha_from),
            value(searched, to, &self.alpha_to),
        ];
        let tau = [
            value(&tau, "--tau-from", &self.tau_from),
            value(&tau, "--tau-to", &self.tau_to),
        ];
        Ok(Ranges {
            gain: range(gain, default.gain)?,
            tau: range(tau, default.tau)?,
        })
    }

    fn inputs(&self, named: Option<(&'static str, String)>, told: &Recommended) -> Inputs {
        let Ranges { gain, tau } = told.ranges;
        let asked = Asked {
            setting: told.setting.clone(),
            units: told.units.clone(),
            named,
        };
        let name = told.searched.name();
        let given = |of: &str| of != name && of != Parameter::Tau.name();
        let inputs = asked.inputs(given);
        let inputs = inputs.and("tau_from", tau.0).and("tau_to", tau.1);
        match asked.named {
            None => inputs
                .and("control", self.control())
                .and("alpha_from", gain.0)
                .and("alpha_to", gain.1)
                .and("robust", self.robust),
            Some(_) => inputs
                .and("search", name)
                .and("search_from", gain.0)
                .and("search_to", gain.1),
        }
    }
}

/// A setting that stands fewer standard errors of a fit than this is warned of.
const FEW_ERRORS: f64 = 2.0;

fn warn_of_few_errors(told: &Recommended) {
    if let (Some(MayBeOff::Errors(errors, _)), Some(_)) = (told.may_be_off, &told.robust)
        && errors < FEW_ERRORS
    {
        say::remark(format_args!(
            "warning: no setting stands more than {} standard errors of the fit: measure more \
             points near v0, or try the other --control",
            rounded(errors, 2)
        ));
    }
}

impl From<NotFound> for Failure {
    fn from(why: NotFound) -> Self {
        match why {
            NotFound::NoAnswer(why) => why.into(),
            NotFound::Robust(why @ NotRobust::TooWide(..)) => {
                let SpecError { message, help, .. } = why.told();
                Self::failed_with_help(message, help.unwrap_or_default())
            }
            NotFound::Robust(why) => Self::of_input(why.told()),
        }
    }
}

/// A flag, and the value that it gives.
type Given = Result<(&'static str, Option<f64>), Failure>;

/// The range that two flags give, with the ends of `default` where they give none.
fn range([from, to]: [Given; 2], default: (f64, f64)) -> Result<(f64, f64), Failure> {
    let ((from_flag, from), (to_flag, to)) = (from?, to?);
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
