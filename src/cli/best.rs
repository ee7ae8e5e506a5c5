//! `slipmap best`: the settings of fastest decay.

use std::path::PathBuf;

use crate::answers::best::{Ranges, default_ranges, longest_delay};
use crate::answers::search_plane::SearchPlane;
use crate::explore::best::{Control, NotFound, Recommended, Searched};
use crate::explore::best_answer::{BestAnswer, BestSetting, SystemBest};
use crate::explore::robust::{MayBeOff, NotRobust, Spread};
use crate::model::ModelError;
use crate::model::stop::Stop;
use crate::report::numbers::rounded;
use crate::setting::point_file::PointOf;
use crate::setting::quantity::Quantity;
use crate::setting::system::SystemModel;
use crate::setting::units::Units;
use crate::setting::{Parameter, Setting};
use crate::text::nearest::did_you_mean;
use crate::text::{SpecError, words};

use super::asked::Asked;
use super::best_ranges::RangeArgs;
use super::best_text;
use super::cell::alone;
use super::failure::Failure;
use super::inputs_line;
use super::json::{self, AnswerSchema, Inputs};
use super::output::warn_beyond_curve;
use super::parameters::ParameterArgs;
use super::say::{self, ForPeople};
use super::sets::given_twice;
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
    parameters: ParameterArgs,
    #[command(flatten)]
    system: SystemArgs,
    /// With --system: the parameter of it that is searched beside the delay; given twice, two
    /// parameters at the delay --tau, or beside the delay where no --tau is given
    #[arg(long, value_name = "NAME", requires = "system")]
    search: Vec<String>,
    /// The gain that is searched; the other one is given as usual [default: velocity]
    #[arg(long, value_enum)]
    control: Option<Control>,
    #[command(flatten)]
    ranges: RangeArgs,
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
    let (asked, plane) = match args.system.system {
        Some(_) => args.asked_of_system()?,
        None => args.asked_of_block()?,
    };
    let default = default_ranges(&asked.setting, &plane)?;
    let ranges = args.ranges.of_plane(&asked, &plane, &default)?;
    let delays = args.delays(&asked, &plane)?;
    args.parameters.tell_static_friction("v_c depends on it");
    let named = asked.named;
    let told = Recommended::of(
        Searched {
            setting: asked.setting,
            units: asked.units,
            of: plane,
            ranges,
            delays,
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
        searched.extend(told.searched.p.known());
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

    /// The block, and the plane that is searched.
    fn asked_of_block(&self) -> Result<(Asked, SearchPlane), Failure> {
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
        Ok((asked, SearchPlane::with_delay(gain)))
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

    /// The system from a file, and the plane that is searched.
    fn asked_of_system(&self) -> Result<(Asked, SearchPlane), Failure> {
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
        let plane = self.plane(&asked.setting)?;
        let delay = !asked.setting.get(Parameter::Tau).is_nan();
        let given = |of: &Quantity| match *of == Parameter::Tau {
            true => delay,
            false => of.known().and_then(flag).is_some() || self.parameters.sets().has(of.name()),
        };
        let delay_twice = delay && self.ranges.has_delay();
        let tau = Parameter::Tau.into();
        let fixed = [&plane.q, &plane.p].into_iter().find(|of| given(of));
        if let Some(fixed) = fixed.or(delay_twice.then_some(&tau)) {
            return Err(Failure::bad_input_with_help(
                format!("a value of {} is given, which is searched", fixed.name()),
                "leave it out; --range NAME=FROM:TO, --search-from, --search-to, --tau-from and \
                 --tau-to are the ranges of the search",
            ));
        }
        Ok((asked, plane))
    }

    /// The delays that are searched where they are none of the plane; none where one is given.
    fn delays(&self, asked: &Asked, plane: &SearchPlane) -> Result<Option<(f64, f64)>, Failure> {
        if plane.has_delay() || !asked.setting.get(Parameter::Tau).is_nan() {
            return Ok(None);
        }
        let longest = longest_delay(&asked.setting);
        self.ranges.of_delay(asked, (0.0, longest)).map(Some)
    }

    /// The plane of the parameters that `--search` names; where the system has one alone, of that
    /// one and the delay.
    fn plane(&self, setting: &Setting) -> Result<SearchPlane, Failure> {
        let mut all = setting.system().map_or(vec![], SystemModel::quantities);
        all.retain(|of| *of != Parameter::Tau);
        let names: Vec<&str> = all.iter().map(Quantity::name).collect();
        let listed = names.join(", ");
        let named = |name: &String| {
            let found = all.iter().find(|of| words::same(of.name(), name)).cloned();
            found.ok_or_else(|| {
                let meant = did_you_mean(name, names.iter().copied());
                Failure::bad_input_with_help(
                    format!("--search: the system has no parameter {name}"),
                    format!("{meant}its parameters: {listed}"),
                )
            })
        };
        match (&*self.search, &*all) {
            ([], [alone]) => Ok(SearchPlane::with_delay(alone)),
            ([], _) => Err(Failure::bad_input_with_help(
                "--search is not given: which parameter is searched beside the delay",
                format!("parameters of the system: {listed}"),
            )),
            ([one], _) => Ok(SearchPlane::with_delay(named(one)?)),
            ([one, other], _) => {
                let (p, q) = (named(one)?, named(other)?);
                match p == q {
                    true => Err(given_twice(&format!("--search {}", p.name()))),
                    false => Ok(SearchPlane { p, q }),
                }
            }
            _ => Err(Failure::bad_input_with_help(
                "--search: at most two parameters are searched beside the delay",
                "give the others by --set NAME=VALUE",
            )),
        }
    }

    fn inputs(&self, named: Option<(&'static str, String)>, told: &Recommended) -> Inputs {
        let (of, Ranges { p, q }) = (&told.searched, told.ranges);
        let tau = told.setting.get(Parameter::Tau);
        let delays = match of.has_delay() {
            true => q,
            false => told.delays.unwrap_or((tau, tau)),
        };
        let asked = Asked {
            setting: told.setting.clone(),
            units: told.units.clone(),
            named,
        };
        let given = |name: &str| !of.has(name) && name != Parameter::Tau.name();
        let inputs = asked.inputs(given);
        let inputs = inputs.and("tau_from", delays.0).and("tau_to", delays.1);
        match asked.named {
            None => inputs
                .and("control", self.control())
                .and("alpha_from", p.0)
                .and("alpha_to", p.1)
                .and("robust", self.robust),
            Some(_) => inputs
                .and("search", of.p.name())
                .and("search_from", p.0)
                .and("search_to", p.1)
                .and("second", of.second().map(Quantity::name))
                .and("second_from", of.second().map(|_| q.0))
                .and("second_to", of.second().map(|_| q.1)),
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
