//! `slipmap point`: everything about one point of parameter space.

use std::path::{Path, PathBuf};

use crate::explore::along_delay::AlongDelay;
use crate::explore::point::{BlockPoint, Point, SystemPoint};
use crate::explore::stability::{Stability, Wanted};
use crate::model::stop::Stop;
use crate::report::picture::{self, Picture, PointPicture};
use crate::setting::Parameter;
use crate::setting::amount::Amount;
use crate::setting::system::SpeedUnit;
use crate::setting::units::Units;
use crate::text::Shown;

use super::asked::Asked;
use super::digits::DigitsArgs;
use super::failure::Failure;
use super::json::{self, AnswerSchema};
use super::output::check_picture;
use super::parameter_values::{amount_of, in_units};
use super::point_args::PointArgs;
use super::point_text;
use super::say::{self, ForPeople};
use super::system_args::{OTHERS, SystemArgs};

/// Number of roots in a picture, with pairs counted once: enough to see their pattern.
const ROOTS_DRAWN: u8 = 14;

/// The largest real part of a line to the right of which roots are counted.
const LARGEST_LINE: f64 = 1e12;

#[derive(Debug, clap::Args)]
#[command(after_help = "Example: slipmap point --mu-prime -0.7 --alpha-v -0.3174 --tau 4.313")]
pub(super) struct Args {
    #[command(flatten)]
    point: PointArgs,
    #[command(flatten)]
    system: SystemArgs,
    /// With --system and --units, in the place of --tau: the speed of the rotation whose period the
    /// delay is, in revolutions per minute
    #[arg(long, value_name = "RPM", allow_hyphen_values = true, requires = "system",
          value_parser = parse_rpm)]
    rpm: Option<f64>,
    /// How many characteristic roots to list, from the right; pairs count once
    #[arg(long, value_name = "K", default_value_t = 4, allow_hyphen_values = true,
          value_parser = parse_roots)]
    roots: u8,
    /// Count the roots with a real part greater than SIGMA, in 1/time
    #[arg(long, value_name = "SIGMA", allow_hyphen_values = true,
          value_parser = amount_of(Parameter::AlphaV))]
    line: Option<Amount>,
    /// Draw the roots in the complex plane and the stable delays, as .png, .svg or .pdf
    #[arg(long, value_name = "PICTURE")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    digits: DigitsArgs,
    /// One JSON object on standard output; infinities are null
    #[arg(long)]
    json: bool,
}

fn parse_roots(text: &str) -> Result<u8, String> {
    let count = text.parse().ok().filter(|count| (1..=64).contains(count));
    count.ok_or_else(|| "expected a whole number from 1 to 64".to_owned())
}

fn parse_rpm(text: &str) -> Result<f64, String> {
    let speed = text.trim().parse();
    let speed = speed.map_err(|_| "expected a number greater than 0, such as 3000".to_owned())?;
    let checked = SpeedUnit::RevolutionsPerMinute.checked(speed);
    checked.map_err(|error| error.message)
}

impl Args {
    /// The real part of the line to the right of which roots are counted.
    fn line(&self, units: &Units) -> Result<Option<f64>, Failure> {
        let Some(line) = &self.line else {
            return Ok(None);
        };
        let line = in_units("--line", line, units)?;
        if line.abs() <= LARGEST_LINE {
            return Ok(Some(line));
        }
        let message = format!("--line {} is outside its range", Shown(line));
        let help = format!("a number of size at most {LARGEST_LINE:e}");
        Err(Failure::bad_input_with_help(message, help))
    }

    /// The setting, with a picture that it can have.
    fn asked(&self) -> Result<Asked, Failure> {
        let of_system = match &self.system.system {
            Some(_) => {
                self.point.check_alone("--system", &OTHERS)?;
                let (sets, units) = (self.point.sets(), self.point.units());
                self.system
                    .read(sets, &units, self.rpm, |p| self.point.given(p))?
            }
            None => self.point.cell_of_system()?,
        };
        if let Some(plot) = &self.plot {
            check_picture("--plot", plot, self.point.map())?;
        }
        match of_system {
            Some(asked) => Ok(asked),
            None => self.point.read(),
        }
    }
}

/// The schema of its JSON.
pub(super) fn described() -> AnswerSchema {
    AnswerSchema::of("point")
        .or::<BlockPoint>()
        .or::<SystemPoint>()
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let asked = args.asked()?;
    let (roots, line) = (args.roots, args.line(&asked.units)?);
    let point = Point::at(&asked.setting, Wanted { roots, line }, &Stop::default())?;
    let spectrum = &point.stability().spectrum;
    if let Some(why) = spectrum.fewer.as_ref().filter(|_| spectrum.incomplete) {
        say::remark(format_args!("warning: {why}"));
    }
    if args.json {
        let inputs = asked.inputs(|_| true).and("roots", args.roots);
        let inputs = match line {
            Some(line) => inputs.and("line", line),
            None => inputs,
        };
        json::print(&inputs, &point)?;
    } else {
        let mut out = ForPeople::begin();
        point_text::print(&mut out, &point, &asked, args.digits.get())?;
    }
    let Some(plot) = &args.plot else {
        return Ok(());
    };
    draw(&asked, point.stability(), plot)?;
    match args.json {
        true => Ok(()),
        false => say::result(plot.display()),
    }
}

/// Draws the point with the number of roots for a picture; with those of `listed` if some of the
/// others are not found.
fn draw(asked: &Asked, listed: &Stability, path: &Path) -> Result<(), Failure> {
    let wanted = Wanted {
        roots: ROOTS_DRAWN,
        line: None,
    };
    let more = Point::at(&asked.setting, wanted, &Stop::default())?;
    let stability = match more.stability() {
        more if !more.spectrum.incomplete => more,
        _ => listed,
    };
    let has_lines = asked.setting.has_lines();
    let along = has_lines
        .then(|| AlongDelay::of(&asked.setting))
        .transpose()?;
    let drawn = PointPicture {
        setting: &asked.setting,
        stability,
        along: along.as_ref(),
        units: &asked.units,
    };
    let picture = picture::draw_point(&drawn, path);
    let saved = picture.and_then(Picture::save);
    saved.map_err(|error| Failure::failed(error.to_string()))
}
