//! `slipmap fit`: a friction law fitted to measured points, with the errors of its slope.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};

use serde::Serialize;
use utoipa::ToSchema;

use crate::fit::{FittedLaw, LAWS, Wanted, fit};
use crate::report::numbers::{counted, rounded, unit_behind, with_error};
use crate::report::picture::{self, FitPicture};
use crate::setting::Parameter;
use crate::setting::fit_errors::{FitErrors, FittedNumber};
use crate::setting::fitted_sliding::FittedSliding;
use crate::setting::law_kind::LawKind;
use crate::setting::measured::{Measured, MeasuredPoint};
use crate::setting::units::Units;
use crate::text::to_digits;

use super::failure::Failure;
use super::fit_args::FitArgs;
use super::inputs_line;
use super::json::{self, AnswerSchema, Inputs};
use super::output::{check_picture, save_picture, tell_dimensionless};
use super::say::{self, ForPeople};
use super::setting;
use super::sweep_file::{STANDARD_INPUT, read_curve};

/// Digits after the first one of errors.
const OF_ERRORS: usize = 3;

#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: slipmap fit belt.csv --v0 1mm/s --normal-load 20N --save fit.toml

The errors hold for independent points, whatever the noise of each is. Where another law describes \
them nearly as well, the error of the slope holds the difference of both. What was fitted is \
rounded to a thousandth of its standard error."
)]
pub(super) struct Args {
    /// The measured points: columns of the speed, and of μ_K or a force, which is divided by
    /// --normal-load
    #[arg(value_name = "DATA.csv")]
    data: PathBuf,
    /// The law [default: the one with the lowest Bayesian information criterion]
    #[arg(long, value_parser = clap::builder::PossibleValuesParser::new(LAWS))]
    law: Option<String>,
    #[command(flatten)]
    rig: FitArgs,
    /// Write the law with its errors, and the rig, to a file; point, margins, best and vc take it
    /// with --setting
    #[arg(long, value_name = "SETTING.toml")]
    save: Option<PathBuf>,
    /// The picture to draw, .png, .svg or .pdf [default: the name of the data with -fit.png, here]
    #[arg(long, value_name = "PICTURE")]
    picture: Option<PathBuf>,
    /// One JSON object on standard output
    #[arg(long)]
    json: bool,
}

/// The JSON of a fit.
#[derive(Debug, Serialize, ToSchema)]
struct FitAnswer {
    /// The law: stribeck, weakening, hyperbolic or spline.
    law: &'static str,
    /// How it was chosen: by BIC, or by --law.
    chosen_by: &'static str,
    /// Its parameters by their names; of a spline μ_K at its points, as mu_k_1.
    parameters: BTreeMap<String, f64>,
    /// The standard errors of those that were fitted.
    standard_errors: BTreeMap<String, f64>,
    /// The velocities of the points of a spline; null for other laws.
    #[schema(required)]
    speeds: Option<Vec<f64>>,
    /// μ_K(v0).
    mu_k: f64,
    /// Its standard error.
    mu_k_error: f64,
    /// μ_K′(v0).
    mu_prime: f64,
    /// Its standard error.
    mu_prime_error: f64,
    /// Between these lies μ_K′(v0) with a probability of 95 %.
    mu_prime_interval: [f64; 2],
    /// The standard deviation of one reading about the law.
    noise: f64,
    /// The number of points.
    points: usize,
    /// The number of readings of which they are averages.
    readings: usize,
    /// The laws that were compared, the best one first.
    laws: Vec<Compared>,
}

/// A law that was compared.
#[derive(Debug, Serialize, ToSchema)]
struct Compared {
    /// Its name.
    law: &'static str,
    /// The number of its fitted parameters.
    parameters: usize,
    /// Its Bayesian information criterion; of a spline 6 more, because it has no form of its own.
    bic: f64,
}

/// What its JSON looks like.
pub(super) fn described() -> AnswerSchema {
    AnswerSchema::of("fit").or::<FitAnswer>()
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    if let Some(path) = &args.save {
        setting::check_save(path)?;
    }
    if let Some(picture) = &args.picture {
        check_picture("--picture", picture, Some(&args.data))?;
    }
    let rig = args.rig.setting()?;
    let curve = read_curve(&args.data, &args.rig.of_curve())?;
    let wanted = Wanted {
        law: args
            .law
            .as_deref()
            .and_then(|law| LAWS.into_iter().find(|of| *of == law)),
        mu_s: args.rig.given(Parameter::MuS),
    };
    let found = fit(&curve.points, wanted, rig);
    let found = found.map_err(|why| {
        let message = format!("{}: {why}", say::visible_line(&args.data.to_string_lossy()));
        Failure::bad_input_with_help(message, why.help())
    })?;
    let sliding = sliding(&found)?;
    warn_beyond(&curve.points, &found, &args.rig.units);
    tell_assumed_mu_s(args, &found);
    let picture = args.draw(&curve, &found)?;
    if let Some(path) = &args.save {
        setting::save(&found.setting, &args.rig.units, path)?;
    }
    if args.json {
        let answer = answer(args, &curve, &found, &sliding);
        json::print(&args.inputs(&found), &answer)?;
    } else {
        print(&mut ForPeople::begin(), args, &curve, (&found, &sliding))?;
    }
    let written = picture.iter().chain(&args.save);
    match args.json {
        true => Ok(()),
        false => written
            .into_iter()
            .try_for_each(|path| say::result(path.display())),
    }
}

/// Friction at v0, with its errors.
fn sliding(found: &FittedLaw) -> Result<FittedSliding, Failure> {
    let sliding = found.setting.fitted_sliding().map_err(|error| {
        Failure::bad_input_with_help(
            format!("the fitted law is refused: {error}"),
            "--mu-s is the static coefficient, at least that of the curve at rest; it is 1 \
             where it is neither given nor fitted",
        )
    })?;
    let errors = |of: &FittedSliding| of.mu_k_error.is_finite() && of.mu_prime_error.is_finite();
    let none = || Failure::failed("the fitted law has no slope at v0");
    sliding.filter(errors).ok_or_else(none)
}

/// Tells that μ_S is assumed, where neither the points nor a flag say it.
fn tell_assumed_mu_s(args: &Args, found: &FittedLaw) {
    let mut fitted = found
        .setting
        .fit_errors()
        .into_iter()
        .flat_map(FitErrors::errors);
    let mu_s = FittedNumber::Parameter(Parameter::MuS);
    let known = args.rig.given(Parameter::MuS).is_some() || fitted.any(|(of, _)| of == mu_s);
    if !known {
        let value = found.setting.get(Parameter::MuS);
        say::note(format_args!(
            "--mu-s is not given: mu_s is taken as {value}; vc, basin and simulate depend on it"
        ));
    }
}

/// Warns where v0 lies beyond the points.
fn warn_beyond(points: &[MeasuredPoint], found: &FittedLaw, units: &Units) {
    let (Some(first), Some(last)) = (points.first(), points.last()) else {
        return;
    };
    let v0 = found.setting.get(Parameter::V0);
    if !(first.speed..=last.speed).contains(&v0) {
        let unit = unit_behind(&units.of_parameter(Parameter::V0));
        say::remark(format_args!(
            "warning: v0 lies beyond the points, {} to {}{unit}: what is told of it follows from \
             the form of the law alone",
            rounded(first.speed, 5),
            rounded(last.speed, 5),
        ));
    }
}

/// The parameters of a law by their names, with the errors of those that were fitted.
fn parameters(found: &FittedLaw) -> Vec<(String, f64, Option<f64>)> {
    let setting = &found.setting;
    let errors: Vec<(FittedNumber, f64)> = setting
        .fit_errors()
        .into_iter()
        .flat_map(FitErrors::errors)
        .collect();
    if let Some(LawKind::Table(table)) = setting.law() {
        let points = table.mu_k().iter().zip(&errors).enumerate();
        return points
            .map(|(i, (mu, (_, error)))| (format!("mu_k_{}", i + 1), *mu, Some(*error)))
            .collect();
    }
    let law = setting.law();
    let all = law
        .iter()
        .flat_map(|law| law.parameters().iter().chain(law.optional()));
    let given = all.filter(|p| setting.uses(**p));
    let of = |p: &Parameter| {
        let fitted = errors
            .iter()
            .find(|(number, _)| *number == FittedNumber::Parameter(*p));
        (
            p.name().to_owned(),
            setting.get(*p),
            fitted.map(|(_, error)| *error),
        )
    };
    given.map(of).collect()
}

/// The ends between which the slope lies with a probability of 95 %.
fn interval(found: &FittedLaw, sliding: &FittedSliding) -> [f64; 2] {
    let reach = found.errors_in_interval() * sliding.mu_prime_error;
    [-reach, reach].map(|off| to_digits(sliding.at.mu_prime + off, OF_ERRORS + 2))
}

fn answer(args: &Args, curve: &Measured, found: &FittedLaw, sliding: &FittedSliding) -> FitAnswer {
    let parameters = parameters(found);
    let fitted = parameters
        .iter()
        .filter_map(|(name, _, error)| Some((name.clone(), (*error)?)));
    let error = |value: f64| to_digits(value, OF_ERRORS);
    FitAnswer {
        law: found.law,
        chosen_by: args.chosen_by(),
        standard_errors: fitted.collect(),
        parameters: parameters
            .iter()
            .map(|(name, value, _)| (name.clone(), *value))
            .collect(),
        speeds: found.speeds().map(<[f64]>::to_vec),
        mu_k: sliding.at.mu_k,
        mu_k_error: error(sliding.mu_k_error),
        mu_prime: sliding.at.mu_prime,
        mu_prime_error: error(sliding.mu_prime_error),
        mu_prime_interval: interval(found, sliding),
        noise: found.noise,
        points: curve.points.len(),
        readings: curve.points.iter().map(|point| point.readings).sum(),
        laws: found
            .contenders
            .iter()
            .map(|of| Compared {
                law: of.law,
                parameters: of.parameters,
                bic: to_digits(of.bic, 5),
            })
            .collect(),
    }
}

fn print(
    out: &mut impl Write,
    args: &Args,
    curve: &Measured,
    (found, sliding): (&FittedLaw, &FittedSliding),
) -> std::io::Result<()> {
    let units = &args.rig.units;
    let unit = |parameter| unit_behind(&units.of_parameter(parameter));
    inputs_line::print(out, &found.setting, units, &[])?;
    let how = match args.law {
        Some(_) => "as asked for".to_owned(),
        None => format!("chosen by BIC: {}", compared(found)),
    };
    writeln!(out, "friction law {}, {how}", found.law)?;
    let mut row = |name: &str, value: String| writeln!(out, "  {name:<20} {value}");
    let with_error = |value: f64, error: f64| {
        let (value, error) = with_error(value, error);
        format!("{value} +- {error}")
    };
    row(
        "points",
        format!("{}, noise {}", curve.points.len(), rounded(found.noise, 2)),
    )?;
    for (i, (name, value, error)) in parameters(found).into_iter().enumerate() {
        let of = Parameter::from_name(&name).map_or_else(String::new, unit);
        let at = found
            .speeds()
            .and_then(|speeds| speeds.get(i))
            .map(|speed| format!(" at {}{}", rounded(*speed, 5), unit(Parameter::V0)));
        let text = match error {
            Some(error) => with_error(value, error),
            None => format!("{}, held", rounded(value, 8)),
        };
        row(&name, text + &of + &at.unwrap_or_default())?;
    }
    row(
        "mu_k at v0",
        with_error(sliding.at.mu_k, sliding.mu_k_error),
    )?;
    let slope = with_error(sliding.at.mu_prime, sliding.mu_prime_error);
    let [from, to] = interval(found, sliding);
    let of_slope = unit(Parameter::MuPrime);
    row("mu_prime at v0", slope + &of_slope)?;
    row(
        "",
        format!(
            "with 95 % between {} and {}{of_slope}",
            rounded(from, 4),
            rounded(to, 4)
        ),
    )?;
    tell_dimensionless(out, units)
}

/// The best form of every law with its criterion, the best law first.
fn compared(found: &FittedLaw) -> String {
    let mut told: Vec<&str> = Vec::new();
    let mut words = Vec::new();
    for of in &found.contenders {
        if !told.contains(&of.law) {
            told.push(of.law);
            let parameters = counted(of.parameters as u64, "parameter");
            words.push(format!("{} {:.1} ({parameters})", of.law, of.bic));
        }
    }
    words.join(", ")
}

impl Args {
    fn chosen_by(&self) -> &'static str {
        match self.law {
            Some(_) => "--law",
            None => "BIC",
        }
    }

    fn inputs(&self, found: &FittedLaw) -> Inputs {
        let given = |parameter: Parameter| self.rig.given(parameter).is_some();
        let mut inputs = Inputs::default().and("data", self.data.display().to_string());
        for parameter in Parameter::ALL.into_iter().filter(|p| given(*p)) {
            inputs = inputs.and(parameter.name(), found.setting.get(parameter));
        }
        inputs
            .and("law", &self.law)
            .and("units", &self.rig.units.force_length_time)
    }

    /// Draws the picture. Under the default name it replaces only pictures of slipmap, and a
    /// failure is only a warning.
    fn draw(&self, curve: &Measured, found: &FittedLaw) -> Result<Option<PathBuf>, Failure> {
        let name = self
            .data
            .file_name()
            .map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        let drawn = FitPicture {
            fit: found,
            points: &curve.points,
            units: &self.rig.units,
            title: &say::visible_line(&name),
        };
        let mut beside = match self.data == Path::new(STANDARD_INPUT) {
            true => "points".into(),
            false => self.data.file_stem().unwrap_or_default().to_owned(),
        };
        beside.push("-fit.png");
        save_picture(self.picture.as_deref(), beside.into(), |path| {
            picture::draw_fit(&drawn, path)
        })
    }
}
