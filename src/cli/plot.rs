//! `slipmap plot`: a picture of a map.

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use slipmap::report::picture::{self, Picture, PictureError, PictureKind, PictureOptions};
use slipmap::sweep::input::field::fields_meant;
use slipmap::sweep::{Field, Parameter};

use super::cell::parse_at;
use super::failure::Failure;
use super::open::open;
use super::say;
use super::signals::Signals;

/// What a signal leaves.
const NOT_DRAWN: &str = "the picture is not drawn";

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The map
    #[arg(value_name = "MAP.h5")]
    map: PathBuf,
    /// The picture to write, .png or .svg [default: the map's name with .png, beside it]
    #[arg(short, long, value_name = "PICTURE")]
    output: Option<PathBuf>,
    /// What to show, a field of the map [default: the first held of regime, vc, outcome, abscissa,
    /// n_unstable]
    #[arg(long, value_name = "NAME", value_parser = parse_field)]
    field: Option<Field>,
    /// Curves or cells [default: curves where the map holds them for a few values of one axis and
    /// no abscissa, and no --field is given]
    #[arg(long)]
    kind: Option<Kind>,
    /// Hold an axis at the value nearest to this; again for the same axis: show several values of
    /// it
    #[arg(long, value_name = "AXIS=VALUE", value_parser = parse_at)]
    at: Vec<(Parameter, f64)>,
}

/// Kinds of pictures by name.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum Kind {
    /// The exact boundaries of stability
    Boundaries,
    /// A heat map of a field
    Heat,
}

fn parse_field(name: &str) -> Result<Field, String> {
    Field::from_name(name).ok_or_else(|| fields_meant(name))
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let signals = Signals::catch()?;
    let map = open(&args.map, &signals, NOT_DRAWN)?;
    let path = match &args.output {
        Some(path) => path.clone(),
        None => beside(&args.map),
    };
    let options = PictureOptions {
        field: args.field,
        kind: args.kind.map(|kind| match kind {
            Kind::Boundaries => PictureKind::Boundaries,
            Kind::Heat => PictureKind::Heat,
        }),
        at: args.at.clone(),
        ..PictureOptions::default()
    };
    let drawn = signals.or_end(NOT_DRAWN, || picture::draw(&map, &path, &options));
    drawn
        .and_then(Picture::save)
        .map_err(|error| failure(error, args))?;
    say::result(path.display())?;
    Ok(())
}

/// The name of the picture beside a map.
pub(super) fn beside(map: &Path) -> PathBuf {
    map.with_extension("png")
}

fn failure(error: PictureError, args: &Args) -> Failure {
    let bad = |flag: &str, error: PictureError, help: String| {
        Failure::bad_input_with_help(format!("{flag}{error}"), help)
    };
    match error {
        PictureError::Store(error) => error.into(),
        PictureError::Render(_) => Failure::failed(error.to_string()),
        PictureError::Extension { .. } => {
            let help = "name the picture like fig.png or fig.svg";
            bad("--output: ", error, help.into())
        }
        PictureError::OverMap { .. } => bad("", error, "-o writes elsewhere".into()),
        PictureError::NoSuchField { ref held, .. } => {
            let help = format!("it holds {held}");
            bad("--field: ", error, help)
        }
        PictureError::NoCurves { .. } => {
            let help =
                "--kind heat draws the cells; boundaries = true in a sweep file traces curves";
            bad("--kind boundaries: ", error, help.into())
        }
        PictureError::NotAnAxis { ref axes, .. } => {
            let help = format!("its axes: {axes}");
            bad("--at: ", error, help)
        }
        PictureError::OutsideAxis { parameter, .. } => {
            let help = format!(
                "slipmap info {} lists the axis {}",
                args.map.display(),
                parameter.name()
            );
            bad("--at: ", error, help)
        }
        PictureError::SeveralValues { .. } => {
            let help = "hold all axes but one at one value each";
            bad("--at: ", error, help.into())
        }
        PictureError::NothingToDraw => {
            let help = "slipmap point says everything about one point";
            bad("", error, help.into())
        }
        PictureError::Size { .. } => Failure::bad_input(error.to_string()),
    }
}
