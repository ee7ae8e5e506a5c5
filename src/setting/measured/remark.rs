//! What is told of a measured curve beside its points.

use std::fmt;

use crate::text::Shown;

/// Something that was done with the rows of a curve, or assumed of them.
#[derive(Debug, Clone, PartialEq)]
pub enum Remark {
    /// Rows that are no numbers were left out.
    LeftOut {
        /// How many.
        rows: usize,
        /// The line of the first one.
        line: usize,
    },
    /// Rows that a column says did not settle were left out.
    Unsettled {
        /// How many.
        rows: usize,
        /// The line of the first one.
        line: usize,
    },
    /// Readings at the same speeds were averaged.
    Averaged {
        /// How many readings.
        readings: usize,
        /// To how many points.
        points: usize,
        /// The largest standard deviation of them, relative to their mean.
        spread: f64,
    },
    /// Readings at negative speeds were taken as at positive ones.
    Folded {
        /// How many readings.
        readings: usize,
        /// By how much μ_K is larger there than forward, relative, on average; none where no
        /// speeds are common to both.
        excess: Option<f64>,
    },
    /// Numbers were converted from the unit of their title.
    Converted {
        /// What they are: speeds or forces.
        what: &'static str,
        /// That unit.
        from: String,
        /// The unit of the setting, or that of the load.
        to: String,
    },
    /// Speeds have a unit by their title, but the setting has none.
    NoUnits {
        /// The unit of the title.
        unit: String,
        /// How to say the units of the setting.
        say: &'static str,
    },
    /// Forces have a unit by their title, but the setting and so its load have none.
    NoUnitOfLoad {
        /// The unit of the title.
        unit: String,
        /// The load.
        load: f64,
        /// How to say the units of the setting.
        say: &'static str,
    },
    /// Titles do not tell what all columns hold.
    ByOrder {
        /// The column taken as the speed, and that taken as the friction.
        columns: [String; 2],
    },
}

/// Why rows are left out, of one row and of more.
const NO_NUMBERS: [&str; 2] = ["it is no numbers", "they are no numbers"];
const UNSETTLED: [&str; 2] = ["it did not settle", "they did not settle"];

/// Tells of rows that are left out, the first of which is `line`, and why.
fn left_out(
    f: &mut fmt::Formatter<'_>,
    (rows, line): (usize, usize),
    [one, more]: [&str; 2],
) -> fmt::Result {
    match rows {
        1 => write!(f, "line {line} is left out: {one}"),
        rows => write!(
            f,
            "{rows} rows are left out: {more}; the first is line {line}"
        ),
    }
}

impl fmt::Display for Remark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = |part: f64| Shown((1000.0 * part).round() / 10.0);
        match self {
            Self::LeftOut { rows, line } => left_out(f, (*rows, *line), NO_NUMBERS),
            Self::Unsettled { rows, line } => left_out(f, (*rows, *line), UNSETTLED),
            Self::Averaged {
                readings,
                points,
                spread,
            } => write!(
                f,
                "{readings} readings at the same speeds are averaged to {points} point{}, with a \
                 standard deviation of up to {} %",
                if *points == 1 { "" } else { "s" },
                percent(*spread)
            ),
            Self::Folded { readings, excess } => {
                let s = if *readings == 1 { "" } else { "s" };
                write!(
                    f,
                    "{readings} reading{s} at negative speeds taken as at positive ones: "
                )?;
                match excess.map(|excess| (percent(excess.abs()), excess < 0.0)) {
                    None => write!(f, "forward and backward have no speeds in common"),
                    Some((Shown(0.0), _)) => write!(f, "mu_k is the same there"),
                    Some((part, true)) => write!(f, "mu_k is {part} % lower there on average"),
                    Some((part, false)) => write!(f, "mu_k is {part} % higher there on average"),
                }
            }
            Self::Converted { what, from, to } => {
                write!(
                    f,
                    "{what} are in {from} by their title, and turned into {to}"
                )
            }
            Self::NoUnits { unit, say } => write!(
                f,
                "speeds are in {unit} by their title, but the setting has no units: they are taken \
                 as they are; {say} gives it units"
            ),
            Self::NoUnitOfLoad { unit, load, say } => write!(
                f,
                "forces are in {unit} by their title, but the setting has no units: they are \
                 divided by the normal load as it is given, {}; {say} gives it units",
                Shown(*load)
            ),
            Self::ByOrder {
                columns: [speed, mu],
            } => write!(
                f,
                "titles do not tell what all columns hold: {speed} is taken as the speed, {mu} as \
                 the friction"
            ),
        }
    }
}
