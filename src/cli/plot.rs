//! `slipmap plot`: a picture of a map or a trace.

use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};

use crate::report::picture::{self, ColourMap, Picture, PictureError, PictureKind, PictureOptions};
use crate::setting::amount::Amount;
use crate::setting::units::Units;
use crate::setting::{Field, Parameter};
use crate::store::{MapFile, TraceFile, trace_reader};
use clap::ValueEnum;
use clap::builder::{PossibleValuesParser, TypedValueParser};

use super::at::{At, Axes, parse_at};
use super::failure::Failure;
use super::open::{held_field, open};
use super::parameter_values::{amount_of, in_units};
use super::print_args::PrintArgs;
use super::say;
use super::signals::Signals;
use super::text_output::STANDARD_OUTPUT;

/// The message after a signal.
const NOT_DRAWN: &str = "the picture is not drawn";
/// The name from which a picture on standard output gets its format.
const PIPED: &str = "-.png";

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The map, or the trace of a motion
    #[arg(value_name = "FILE.h5")]
    map: PathBuf,
    /// The picture to write, .png, .svg or .pdf; - for a PNG on standard output [default: beside
    /// the map, MAP.png or, with other options, their values between, as in MAP.vc.png; only an
    /// earlier picture of the same map and field is replaced]
    #[arg(short, long, value_name = "PICTURE")]
    output: Option<PathBuf>,
    /// What to show, a field of the map [default: the `picture` of its sweep file, else the first
    /// held of regime, v_smooth, vc, outcome, abscissa, n_unstable]
    #[arg(long, value_name = "NAME")]
    field: Option<String>,
    /// Curves or cells [default: curves where the map holds them for a few values of one axis and
    /// no abscissa, and no field is named]
    #[arg(long)]
    kind: Option<Kind>,
    /// Hold an axis at the value nearest to this; again for the same axis: show several values of
    /// it
    #[arg(long, value_name = "AXIS=VALUE", value_parser = parse_at)]
    at: Vec<At>,
    /// Width and height in pixels
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = SIZE, value_parser = parse_size)]
    size: (u32, u32),
    #[command(flatten)]
    print: PrintArgs,
    /// The title, "" for none [default: the sweep's, or what the field is where the sweep shows
    /// another]
    #[arg(long, value_name = "TEXT")]
    title: Option<String>,
    /// Of a trace, the time from which it is shown
    #[arg(long, value_name = "T", allow_hyphen_values = true,
          value_parser = amount_of(Parameter::Tau))]
    from: Option<Amount>,
    /// Of a trace, the time until which it is shown
    #[arg(long, value_name = "T", allow_hyphen_values = true,
          value_parser = amount_of(Parameter::Tau))]
    to: Option<Amount>,
    /// Leave out the lines below the title: what is shown, and at which values
    #[arg(long)]
    no_subtitle: bool,
    /// The ends of the scale of values; what lies beyond has colours of its own
    #[arg(
        long,
        value_name = "LOW,HIGH",
        allow_hyphen_values = true,
        value_parser = parse_range
    )]
    range: Option<(f64, f64)>,
    /// The colours of values, by their names in matplotlib: one of the first three for sizes, one
    /// of the last two for values on both sides of 0
    #[arg(long, value_name = "NAME", value_parser = colour_maps())]
    colour_map: Option<ColourMap>,
    /// A logarithmic scale of values, where none is below 0
    #[arg(long)]
    log: bool,
    /// Leave out what colours and lines mean
    #[arg(long)]
    no_legend: bool,
}

/// The default size of a picture.
const SIZE: &str = "1600x1100";

fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let sides = text.split_once('x').and_then(|(width, height)| {
        let side = |text: &str| text.trim().parse().ok();
        Some((side(width)?, side(height)?))
    });
    sides.ok_or_else(|| format!("expected WIDTHxHEIGHT, for example {SIZE}"))
}

fn parse_range(text: &str) -> Result<(f64, f64), String> {
    let ends = text.split_once(',').and_then(|(low, high)| {
        let end = |text: &str| text.trim().parse().ok();
        Some((end(low)?, end(high)?))
    });
    ends.ok_or_else(|| "expected LOW,HIGH, for example 0,0.5".into())
}

/// Colour maps by name.
fn colour_maps() -> impl TypedValueParser<Value = ColourMap> {
    let names = PossibleValuesParser::new(ColourMap::ALL.map(ColourMap::name));
    names.try_map(|name| ColourMap::from_name(&name).ok_or("no such colour map"))
}

/// Kinds of pictures by name.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum Kind {
    /// The exact boundaries of stability
    Boundaries,
    /// A heat map of a field
    Heat,
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let signals = Signals::catch()?;
    let piped = args.output.as_deref() == Some(Path::new(STANDARD_OUTPUT));
    if piped && std::io::stdout().is_terminal() {
        return Err(Failure::bad_input_with_help(
            "--output -: a terminal shows no PNG",
            "-o NAME.png writes a file; a pipe or a file takes what goes to standard output",
        ));
    }
    let path = match &args.output {
        Some(_) if piped => PathBuf::from(PIPED),
        Some(path) => path.clone(),
        None => named_after(&args.map, &shown(args)),
    };
    let options = PictureOptions {
        kind: args.kind.map(|kind| match kind {
            Kind::Boundaries => PictureKind::Boundaries,
            Kind::Heat => PictureKind::Heat,
        }),
        size: args.size,
        print: args.print.get(),
        title: args.title.clone(),
        no_subtitle: args.no_subtitle,
        range: args.range,
        colour_map: args.colour_map,
        log: args.log,
        no_legend: args.no_legend,
        ..PictureOptions::default()
    };
    let drawn = if trace_reader::is_trace(&args.map) {
        refuse_of_maps(args)?;
        let trace = TraceFile::open(&args.map)?;
        let options = PictureOptions {
            time: args.time(&trace.spec.units)?,
            ..options
        };
        signals.or_end(NOT_DRAWN, || {
            picture::draw_trace_file(&trace, &path, &options)
        })
    } else {
        refuse_of_traces(args)?;
        let map = open(&args.map, &signals, NOT_DRAWN)?;
        let options = shown_of(&map, args, options)?;
        signals.or_end(NOT_DRAWN, || picture::draw(&map, &path, &options))
    };
    if piped {
        let picture = drawn.map_err(|error| failure(error, args))?;
        return Ok(std::io::stdout().lock().write_all(picture.bytes())?);
    }
    let save = match args.output {
        Some(_) => Picture::save,
        None => Picture::save_unasked,
    };
    drawn.and_then(save).map_err(|error| failure(error, args))?;
    say::result(path.display())
}

/// The options of the picture, from the flags and this map.
fn shown_of(
    map: &MapFile,
    args: &Args,
    options: PictureOptions,
) -> Result<PictureOptions, Failure> {
    let axes = Axes::from(map);
    let at = args.at.iter();
    let at = at.map(|at| {
        let (axis, value) = at.on(&axes)?;
        Ok((axes.of(axis).clone(), value))
    });
    let field = args.field.as_deref().map(|name| held_field(map, name));
    Ok(PictureOptions {
        field: field.transpose()?,
        at: at.collect::<Result<_, Failure>>()?,
        ..options
    })
}

impl Args {
    /// The stretch of time that is shown of a trace.
    fn time(&self, units: &Units) -> Result<[Option<f64>; 2], Failure> {
        let of = |flag, amount: &Option<Amount>| {
            let value = amount.as_ref().map(|amount| in_units(flag, amount, units));
            value.transpose()
        };
        Ok([of("--from", &self.from)?, of("--to", &self.to)?])
    }
}

/// Refuses options for traces: a map has no time.
fn refuse_of_traces(args: &Args) -> Result<(), Failure> {
    let given = [("--from", args.from.is_some()), ("--to", args.to.is_some())];
    match given.into_iter().find(|(_, given)| *given) {
        None => Ok(()),
        Some((flag, _)) => Err(Failure::bad_input_with_help(
            format!("{flag} has no meaning for a map: it is about the time of a motion"),
            "--at holds an axis at a value",
        )),
    }
}

/// Refuses options for maps: a motion has no fields and no axes to choose from.
fn refuse_of_maps(args: &Args) -> Result<(), Failure> {
    let given = [
        ("--field", args.field.is_some()),
        ("--kind", args.kind.is_some()),
        ("--at", !args.at.is_empty()),
    ];
    match given.into_iter().find(|(_, given)| *given) {
        None => Ok(()),
        Some((flag, _)) => Err(Failure::bad_input_with_help(
            format!("{flag} has no meaning for a trace of one motion"),
            "its picture shows the motion over time, and its velocity over its elongation",
        )),
    }
}

/// The words in the name of the requested picture: how it differs from the picture of a run.
fn shown(args: &Args) -> Vec<String> {
    let kind = args.kind.and_then(|kind| kind.to_possible_value());
    let name = |name: &String| Field::from_name(name).map_or(name.clone(), |f| f.name().into());
    let mut words: Vec<String> = args.field.iter().map(name).collect();
    words.extend(kind.map(|kind| kind.get_name().to_owned()));
    words.extend(args.at.iter().map(At::in_file_name));
    if args.size != PictureOptions::default().size {
        words.push(format!("{}x{}", args.size.0, args.size.1));
    }
    words.extend(args.print.words());
    let time = [("from", &args.from), ("to", &args.to)].into_iter();
    words.extend(time.filter_map(|(end, t)| Some(format!("{end}={}", t.as_ref()?))));
    words.extend(args.title.iter().map(|title| match title.trim() {
        "" => "untitled".to_owned(),
        _ => "titled".to_owned(),
    }));
    words.extend(args.range.map(|(low, high)| format!("range={low},{high}")));
    words.extend(args.colour_map.map(|map| map.name().to_owned()));
    let flags = [
        (args.no_subtitle, "no-subtitle"),
        (args.log, "log"),
        (args.no_legend, "no-legend"),
    ];
    let set = flags.into_iter().filter(|(set, _)| *set);
    words.extend(set.map(|(_, word)| word.to_owned()));
    words
}

fn named_after(map: &Path, words: &[String]) -> PathBuf {
    let mut name = map.file_stem().unwrap_or_default().to_owned();
    for word in words {
        name.push(".");
        name.push(word);
    }
    name.push(".png");
    map.with_file_name(name)
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
            let help = "name the picture like fig.png, fig.svg or fig.pdf";
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
        PictureError::OutsideAxis { ref parameter, .. } => {
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
        PictureError::Range { .. } | PictureError::LogRange { .. } => {
            Failure::bad_input(format!("--range: {error}"))
        }
        PictureError::NoLogarithm { .. } => Failure::bad_input(format!("--log: {error}")),
        PictureError::OtherColourMap { ref fitting, .. } => {
            let help = format!("these do: {fitting}");
            bad("--colour-map: ", error, help)
        }
        PictureError::NotForThis { .. } => Failure::bad_input(error.to_string()),
        PictureError::OthersWork { .. } => {
            bad("", error, "-o draws elsewhere, or replaces it".into())
        }
        error => of_sheet(&error, args),
    }
}

/// A picture that cannot be had on its sheet, or of its time.
fn of_sheet(error: &PictureError, args: &Args) -> Failure {
    let told = error.to_string();
    match error {
        PictureError::NoTime { .. } => Failure::bad_input(format!("--from, --to: {told}")),
        PictureError::NoRoom => {
            let help = "a smaller --font, a larger --width, --no-legend, or fewer values with --at";
            Failure::bad_input_with_help(told, help)
        }
        PictureError::Size { width, height, .. }
            if args.print.get().is_some() && (*width, *height) != args.size =>
        {
            let help = "--dpi makes it finer or coarser";
            Failure::bad_input_with_help(format!("--width: {told}"), help)
        }
        PictureError::Size { .. } => Failure::bad_input(format!("--size: {told}")),
        _ => Failure::failed(told),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_named_by_what_they_show() {
        let of = |words: &[&str]| {
            let words: Vec<String> = words.iter().map(ToString::to_string).collect();
            named_after(Path::new("a/map.h5"), &words)
        };
        assert_eq!(of(&[]), Path::new("a/map.png"));
        assert_eq!(of(&[]), beside(Path::new("a/map.h5")));
        assert_eq!(of(&["vc"]), Path::new("a/map.vc.png"));
        assert_eq!(
            of(&["vc", "heat", "tau=0.5"]),
            Path::new("a/map.vc.heat.tau=0.5.png")
        );
    }

    #[test]
    fn sizes_are_read() {
        assert_eq!(parse_size(SIZE), Ok(PictureOptions::default().size));
        for text in ["", "800", "800x", "axb", "-1x5", "1.5x2"] {
            assert!(parse_size(text).unwrap_err().contains("WIDTHxHEIGHT"));
        }
    }
}
