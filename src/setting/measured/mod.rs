//! A measured friction curve from a text of columns, whatever program wrote it.
//!
//! - `chosen`: which columns hold the speed and the friction
//! - `decoded`: the bytes of a text as spreadsheets save it
//! - `number`: numbers with a decimal point or a decimal comma
//! - `options`: how a text is to be read, and how that is said
//! - `points`: readings folded, sorted and averaged
//! - `remark`: what is told of a curve beside its points
//! - `sheet`: rows and what separates their cells
//! - `speed_unit`: the unit of speeds and its conversion
//! - `title`: what the title of a column says

mod chosen;
mod decoded;
mod number;
mod options;
mod points;
mod remark;
mod sheet;
mod speed_unit;
mod title;

use chosen::{Choice, Chosen, Load, Titles};
use number::{DecimalMark, PLAIN};
use points::{Origin, Reading, mean, near, points};
use sheet::{Row, Sheet};

use super::parameter::Parameter;
use super::unit::{Scale, Unit};
use super::units::Units;
use crate::model::table::{TableColumn, TableError};
use crate::model::{FrictionLaw, Table};
use crate::text::SpecError;

pub use decoded::decoded;
pub use options::{Columns, CurveOptions, Spoken};
pub use points::{Direction, MeasuredPoint};
pub use remark::Remark;
pub use speed_unit::SpeedUnit;

/// A measured friction curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Its points, by increasing speed; those of both directions.
    pub points: Vec<MeasuredPoint>,
    /// What is told beside them.
    pub remarks: Vec<Remark>,
    /// What messages call the columns of the speed and of the friction.
    columns: [String; 2],
}

impl Measured {
    /// Reads a curve from a text of columns: a speed, and μ_K or a force in each row. Columns are
    /// separated by `;`, tabs, commas or blanks, numbers have decimal points or decimal commas.
    /// Lines that begin with `#` or `%` are comments. What columns hold is told by the options,
    /// else by their titles, else, where two of them are numbers, by their order.
    ///
    /// ```
    /// use slipmap::setting::measured::{CurveOptions, Measured};
    ///
    /// let text = "v;mu\n0,25;0,5\n-0,5;0,4\n0,5;0,4\n";
    /// let curve = Measured::read(text, &CurveOptions::default())?;
    /// assert_eq!(curve.points.len(), 3);
    /// assert_eq!(curve.table()?.speeds(), [0.25, 0.5]);
    /// # Ok::<(), slipmap::text::SpecError>(())
    /// ```
    ///
    /// # Errors
    /// Points at the row and column that is not understood, and says what to type.
    pub fn read(text: &str, options: &CurveOptions) -> Result<Self, SpecError> {
        let sheet = Sheet::of(text);
        if sheet.data().is_empty() {
            return Err(no_numbers(&sheet));
        }
        let titles = Titles::of(&sheet);
        let choice = Choice {
            sheet: &sheet,
            titles: &titles,
            options,
        };
        let mut chosen = choice.chosen()?;
        let mut remarks: Vec<Remark> = chosen.remark.take().into_iter().collect();
        let names = [chosen.speed, chosen.friction].map(|column| titles.name(column));
        let reader = Reader {
            sheet: &sheet,
            titles: &titles,
            options,
            chosen,
        };
        let (speed, of_speed) = reader.speed_scale()?;
        remarks.extend(of_speed);
        reader.check_load()?;
        let (force, of_force) = reader.force_scale()?;
        remarks.extend(of_force);
        let mark = reader.decimal_mark()?;
        let (readings, left_out) = reader.readings(&Scales { mark, speed, force })?;
        remarks.extend(left_out.into_iter().flatten());
        let (points, of_points) = points(readings, &names[1])?;
        remarks.extend(of_points);
        Ok(Self {
            points,
            remarks,
            columns: names,
        })
    }

    /// The curve through the points, those of both directions averaged.
    ///
    /// # Errors
    /// At the first value that is out of range, see [`Table::new`].
    pub fn table(&self) -> Result<Table, SpecError> {
        let groups: Vec<&[MeasuredPoint]> = near(&self.points, |point| point.speed).collect();
        let column = |value: fn(&MeasuredPoint) -> f64| {
            let of = |these: &&[MeasuredPoint]| {
                let weighted = these
                    .iter()
                    .map(|point| (value(point), point.readings as f64));
                mean(value(&these[0]), weighted)
            };
            groups.iter().map(of).collect::<Vec<f64>>()
        };
        let made = Table::new(column(|point| point.speed), column(|point| point.mu_k));
        made.map_err(|error| self.refused(&error, &groups))
    }

    /// The table of a friction law with the static coefficient `mu_s`, its default if none is
    /// given.
    ///
    /// # Errors
    /// As [`Measured::table`], and when the law is ill-posed, see [`FrictionLaw::table`].
    pub(crate) fn table_of_law(&self, mu_s: Option<f64>) -> Result<Table, SpecError> {
        let table = self.table()?;
        let default = Parameter::MuS.default_value().filter(|_| mu_s.is_none());
        let posed = FrictionLaw::table(table.clone(), mu_s.or(default).unwrap_or(1.0));
        posed.map_err(|error| SpecError {
            span: self
                .points
                .first()
                .map(|point| point.origin.friction.clone()),
            ..SpecError::whole(error.with_default_mu_s(default))
        })?;
        Ok(table)
    }

    fn refused(&self, error: &TableError, groups: &[&[MeasuredPoint]]) -> SpecError {
        let left_out = self.remarks.iter().find_map(|remark| match remark {
            Remark::LeftOut { .. } | Remark::Unsettled { .. } => Some(remark.to_string()),
            _ => None,
        });
        match error {
            TableError::Count { speeds: 0 | 1, .. } => SpecError {
                help: left_out,
                ..SpecError::whole(error.to_string())
            },
            TableError::Count { .. } => SpecError::whole(error.to_string())
                .help("average the readings over small ranges of the speed"),
            TableError::Value { index, column, .. } => {
                let origin = &groups[*index][0].origin;
                let (place, name) = match column {
                    TableColumn::Speeds => (&origin.speed, &self.columns[0]),
                    TableColumn::MuK => (&origin.friction, &self.columns[1]),
                };
                let message = format!("line {}, {name}: {error}", origin.line);
                SpecError::at(place.clone(), message)
            }
        }
    }
}

fn no_numbers(sheet: &Sheet) -> SpecError {
    let message = "no line has two numbers, a speed and mu_k or a force";
    SpecError {
        span: sheet.first().map(|row| row.place.clone()),
        ..SpecError::whole(message)
            .help("columns are separated by `;`, tabs, commas or blanks: 0.1, 0.52")
    }
}

/// What is told of rows that are left out: no numbers, or not settled.
type LeftOut = [Option<Remark>; 2];

/// Whether a cell of a column of answers says no.
fn is_no(cell: &str) -> bool {
    ["false", "no", "0"].contains(&&*cell.to_lowercase())
}

/// How the numbers of cells are read.
struct Scales {
    mark: DecimalMark,
    /// From the unit of the speeds to that of the setting.
    speed: Scale,
    /// From the unit of the forces to that of the load.
    force: Scale,
}

/// Reads the chosen columns of a sheet.
struct Reader<'s> {
    sheet: &'s Sheet<'s>,
    titles: &'s Titles<'s>,
    options: &'s CurveOptions,
    chosen: Chosen,
}

impl Reader<'_> {
    /// The factor of the speeds, and what is told of it.
    fn speed_scale(&self) -> Result<(Scale, Option<Remark>), SpecError> {
        let (spoken, units) = (self.options.spoken, &self.options.units);
        if let Some(unit) = &self.options.speed_unit {
            let scale = unit.scale_in(units);
            let scale = scale
                .map_err(|why| SpecError::whole(why).help(format!("say {}", spoken.units())))?;
            return Ok((scale, None));
        }
        let Some(unit) = self.titles.unit(self.sheet, self.chosen.speed) else {
            return Ok((Scale::ONE, None));
        };
        if units.dimensionless() {
            let (unit, say) = (unit.to_owned(), spoken.units());
            return Ok((Scale::ONE, Some(Remark::NoUnits { unit, say })));
        }
        let scale = SpeedUnit::read(unit)
            .and_then(|unit| unit.scale_in(units))
            .map_err(|why| {
                let name = self.titles.name(self.chosen.speed);
                SpecError::whole(format!("{name}: {why}"))
                    .help(format!("say the unit: {}", spoken.speed_unit("mm/s")))
            })?;
        let to = units.of_parameter(Parameter::V0);
        Ok((scale, converted("speeds", scale, [unit, &to])))
    }

    /// Rows of numbers, with speeds in units of the setting, and what is told of other rows. Those
    /// of which a column says that they did not settle are no points of a curve.
    fn readings(&self, scales: &Scales) -> Result<(Vec<Reading>, LeftOut), SpecError> {
        let mut readings = Vec::new();
        let (mut left_out, mut unsettled) = (None, None);
        let settled = self.titles.settled();
        for row in self.sheet.data() {
            let count = |of: &mut Option<(usize, usize)>| of.get_or_insert((0, row.line)).0 += 1;
            if settled.is_some_and(|column| is_no(row.cell(column))) {
                count(&mut unsettled);
                continue;
            }
            match self.reading(row, scales)? {
                Some(reading) => readings.push(reading),
                None => count(&mut left_out),
            }
        }
        let told = [
            left_out.map(|(rows, line)| Remark::LeftOut { rows, line }),
            unsettled.map(|(rows, line)| Remark::Unsettled { rows, line }),
        ];
        Ok((readings, told))
    }

    /// The decimal mark of the chosen columns.
    fn decimal_mark(&self) -> Result<DecimalMark, SpecError> {
        let (rows, columns) = (self.sheet.data(), self.chosen.columns());
        let cells = rows.iter().enumerate().flat_map(|(row, of)| {
            let cell = move |column: &usize| (of.cell(*column), (row, *column));
            columns.iter().map(cell)
        });
        DecimalMark::of(cells).map_err(|((row, column), why)| {
            let (row, name) = (&rows[row], self.titles.name(column));
            let message = format!("line {}, {name}: {why}", row.line);
            SpecError::at(self.sheet.place(row, column), message).help(PLAIN)
        })
    }

    /// The numbers of a row; none where it is not all numbers.
    fn reading(&self, row: &Row, scales: &Scales) -> Result<Option<Reading>, SpecError> {
        let Chosen {
            speed,
            friction,
            load,
            ..
        } = self.chosen;
        let number = |column: usize, scale: Scale| scales.mark.scaled(row.cell(column), scale);
        let speed = number(speed, scales.speed);
        let (Some(speed), Some(force)) = (speed, number(friction, scales.force)) else {
            return Ok(None);
        };
        let load = match load {
            None => 1.0,
            Some(Load::Fixed(load)) => load,
            Some(Load::Column(column)) => match number(column, Scale::ONE) {
                None => return Ok(None),
                Some(load) if load > 0.0 => load,
                Some(_) => {
                    let (line, name) = (row.line, self.titles.name(column));
                    let message = format!("line {line}, {name}: a load is greater than 0");
                    let place = self.sheet.place(row, column);
                    let help = "correct the row, or leave it out";
                    return Err(SpecError::at(place, message).help(help));
                }
            },
        };
        Ok(Some(Reading {
            speed,
            mu_k: force / load,
            origin: Origin {
                line: row.line,
                speed: self.sheet.place(row, self.chosen.speed),
                friction: self.sheet.place(row, friction),
            },
        }))
    }

    /// Refuses a load out of its range.
    fn check_load(&self) -> Result<(), SpecError> {
        match self.chosen.load {
            Some(Load::Fixed(load)) => {
                let checked = Parameter::NormalLoad.check(load);
                checked.map_err(|error| SpecError::whole(error.to_string()))?;
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// The factor from the unit of the forces to that of the load, where both are known, and what
    /// is told of it.
    fn force_scale(&self) -> Result<(Scale, Option<Remark>), SpecError> {
        let unit = |column: usize| self.titles.unit(self.sheet, column);
        let (Some(force), Some(load)) = (unit(self.chosen.friction), self.chosen.load) else {
            return Ok((Scale::ONE, None));
        };
        let of_load = match load {
            Load::Column(column) => unit(column),
            Load::Fixed(_) => self.options.units.force(),
        };
        match (of_load, load) {
            (Some(load), _) if force != load => {
                let scale = scale_of_force(force, load)?;
                Ok((scale, converted("forces", scale, [force, load])))
            }
            (None, Load::Fixed(load)) => {
                let (unit, say) = (force.to_owned(), self.options.spoken.units());
                Ok((Scale::ONE, Some(Remark::NoUnitOfLoad { unit, load, say })))
            }
            _ => Ok((Scale::ONE, None)),
        }
    }
}

/// The factor from one unit of force to another.
fn scale_of_force(force: &str, load: &str) -> Result<Scale, SpecError> {
    let read = |unit: &str| {
        let unit = Unit::read(unit).ok();
        unit.filter(|unit| unit.dimension() == Parameter::NormalLoad.dimension())
    };
    let units = read(force).zip(read(load));
    let scale = units.and_then(|(force, load)| force.scale_to(&load));
    scale.ok_or_else(|| {
        SpecError::whole(format!("the force is in {force}, and the load in {load}"))
            .help("give both in one unit, or in known units of force: N, mN, kN, lbf")
    })
}

/// What is told of numbers that are turned from one unit into another.
fn converted(what: &'static str, scale: Scale, units: [&str; 2]) -> Option<Remark> {
    let [from, to] = units.map(str::to_owned);
    (scale != Scale::ONE).then_some(Remark::Converted { what, from, to })
}

impl Units {
    /// The unit of force, if there are units.
    fn force(&self) -> Option<&str> {
        self.force_length_time.as_ref().map(|[force, ..]| &**force)
    }
}

#[cfg(test)]
mod tests;
