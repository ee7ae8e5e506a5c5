//! How wide a picture is printed, how fine, and with how large a text.

use crate::report::numbers::rounded;
use crate::report::picture::Print;

/// The flags.
#[derive(Debug, Clone, Copy, clap::Args)]
pub(super) struct PrintArgs {
    /// Width in print, in mm, cm, in or pt, such as 86mm, a column: the picture has the shape of
    /// --size, and its text is as large as --font says
    #[arg(long, value_name = "LENGTH", value_parser = parse_width)]
    width: Option<f64>,
    /// Pixels in an inch, with --width [default: 300]
    #[arg(long, value_name = "N", requires = "width", value_parser = parse_dpi)]
    dpi: Option<f64>,
    /// Size of numbers and notes in points, with --width [default: 7]
    #[arg(long, value_name = "POINTS", requires = "width", value_parser = parse_font)]
    font: Option<f64>,
}

impl PrintArgs {
    /// How the picture is printed, if that is said.
    pub(super) fn get(self) -> Option<Print> {
        let usual = Print::default();
        self.width.map(|width| Print {
            width,
            dpi: self.dpi.unwrap_or(usual.dpi),
            font: self.font.unwrap_or(usual.font),
        })
    }

    /// The words for it in the name of a picture.
    pub(super) fn words(self) -> impl Iterator<Item = String> {
        let given = [("mm", self.width), ("dpi", self.dpi), ("pt", self.font)];
        let given = given.into_iter();
        given.filter_map(|(unit, value)| Some(format!("{}{unit}", rounded(value?, 4))))
    }
}

/// Reads a length in print, in millimetres.
fn parse_width(text: &str) -> Result<f64, String> {
    let units = [("mm", 1.0), ("cm", 10.0), ("in", 25.4), ("pt", 25.4 / 72.0)];
    let read = units.into_iter().find_map(|(unit, size)| {
        let number: f64 = text.strip_suffix(unit)?.trim().parse().ok()?;
        Some(number * size)
    });
    let read = read.filter(|width| (10.0..=1000.0).contains(width));
    read.ok_or_else(|| "expected a length from 10 mm to 1 m, such as 86mm, 8.6cm or 3.4in".into())
}

fn parse_dpi(text: &str) -> Result<f64, String> {
    let read = text
        .parse()
        .ok()
        .filter(|dpi| (50.0..=2400.0).contains(dpi));
    read.ok_or_else(|| "expected a number from 50 to 2400".into())
}

fn parse_font(text: &str) -> Result<f64, String> {
    let number = text.strip_suffix("pt").unwrap_or(text).trim();
    let read = number.parse().ok().filter(|pt| (3.0..=72.0).contains(pt));
    read.ok_or_else(|| "expected a size in points from 3 to 72, such as 8 or 8pt".into())
}
