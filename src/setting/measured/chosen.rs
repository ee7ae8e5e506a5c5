//! Which columns of a sheet hold the speed and the friction: as given, by their titles, or by their
//! order.

use super::options::{CurveOptions, Role};
use super::remark::Remark;
use super::sheet::{Row, Sheet};
use super::title::Title;
use crate::setting::unit::Unit;
use crate::text::SpecError;
use crate::text::nearest::did_you_mean;

/// The most columns in the list of a message.
const MOST_LISTED: usize = 12;

/// By what a force is divided.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Load {
    /// The load in a column.
    Column(usize),
    /// One load.
    Fixed(f64),
}

/// The columns of a curve, from 0 on.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Chosen {
    pub speed: usize,
    /// μ_K, or a force.
    pub friction: usize,
    /// By what the force is divided; none for μ_K.
    pub load: Option<Load>,
    /// What the choice assumes.
    pub remark: Option<Remark>,
}

impl Chosen {
    /// All columns.
    pub(super) fn columns(&self) -> Vec<usize> {
        let load = match self.load {
            Some(Load::Column(column)) => Some(column),
            _ => None,
        };
        [self.speed, self.friction]
            .into_iter()
            .chain(load)
            .collect()
    }
}

/// The titles of a sheet, one for each column.
pub(super) struct Titles<'s> {
    /// The row in which they stand.
    row: Option<&'s Row>,
    titles: Vec<Title<'s>>,
}

impl<'s> Titles<'s> {
    /// The last row before the data in which a title is understood, else the last one.
    pub(super) fn of(sheet: &'s Sheet) -> Self {
        let titles = |row: &'s Row| (0..sheet.width).map(|column| Title::of(row.cell(column)));
        // N alone may also be the unit of a force.
        let tells = |cell: &str| Title::of(cell).role().is_some() && Unit::read(cell).is_err();
        let understood = |row: &&Row| (0..sheet.width).any(|column| tells(row.cell(column)));
        let row = sheet.head().rfind(understood).or(sheet.head().last());
        Self {
            row,
            titles: row.map_or_else(Vec::new, |row| titles(row).collect()),
        }
    }

    /// The unit of a column: in its title, or in the row below the titles.
    pub(super) fn unit(&self, sheet: &'s Sheet, column: usize) -> Option<&'s str> {
        let below = |row: &Row| self.row.is_some_and(|titles| row.line > titles.line);
        let under = sheet.head().find(|row| below(row));
        let bare = |row: &'s Row| {
            let cell = row.cell(column);
            Title::of(cell)
                .unit
                .or(Some(cell).filter(|cell| !["", "-", "1"].contains(cell)))
        };
        self.titles
            .get(column)?
            .unit
            .or_else(|| under.and_then(bare))
    }

    /// The column that says whether a row settled, if there is one.
    pub(super) fn settled(&self) -> Option<usize> {
        self.titles.iter().position(Title::tells_settled)
    }

    /// A column in messages: its number, and its title if it has one.
    pub(super) fn name(&self, column: usize) -> String {
        match self.titles.get(column).map(|title| title.text) {
            None | Some("") => format!("column {}", column + 1),
            Some(title) => format!("column {} ({title})", column + 1),
        }
    }

    fn listed(&self, sheet: &Sheet) -> String {
        let title = |column: usize| match self.titles.get(column).map(|title| title.text) {
            None | Some("") => (column + 1).to_string(),
            Some(title) => format!("{} {title}", column + 1),
        };
        let mut listed: Vec<String> = (0..sheet.width.min(MOST_LISTED)).map(title).collect();
        if sheet.width > MOST_LISTED {
            listed.push("…".into());
        }
        listed.join(", ")
    }
}

/// The choice of columns for a sheet.
pub(super) struct Choice<'s> {
    pub sheet: &'s Sheet<'s>,
    pub titles: &'s Titles<'s>,
    pub options: &'s CurveOptions,
}

impl Choice<'_> {
    /// The columns of the curve.
    ///
    /// # Errors
    /// At the titles or the first row, with all columns and what to type.
    pub(super) fn chosen(&self) -> Result<Chosen, SpecError> {
        self.check_commas()?;
        let [mut speed, mut mu, force, load] = [
            self.column(Role::Speed)?,
            self.column(Role::Mu)?,
            self.column(Role::Force)?,
            self.column(Role::Load)?,
        ];
        let given = |role| self.options.columns.of(role).is_some();
        // A force that is asked for counts more than a title.
        mu = mu.filter(|_| !given(Role::Force) && !given(Role::Load));
        let mut remark = None;
        let numeric = (0..self.sheet.width).filter(|column| self.sheet.is_numeric(*column));
        // A load is neither of both.
        if let [first, second] = numeric.collect::<Vec<_>>()[..]
            && load.is_none()
        {
            let other = |than: usize| if than == first { second } else { first };
            let (found, friction) = (speed, mu.or(force));
            match (found, friction) {
                (None, None) => (speed, mu) = (Some(first), Some(second)),
                (None, Some(friction)) => speed = Some(other(friction)),
                (Some(speed), None) => mu = Some(other(speed)),
                _ => {}
            }
            if let (None, ..) | (_, None) = (found, friction)
                && let (Some(speed), Some(friction)) = (speed, mu.or(force))
            {
                let columns = [speed, friction].map(|column| self.titles.name(column));
                remark = self.titles.row.map(|_| Remark::ByOrder { columns });
            }
        }
        let speed = speed.ok_or_else(|| {
            let example = mu.or(force).map_or("speed=1,mu=2", |_| "speed=1");
            self.error(untold("the speed"), example)
        })?;
        if mu.or(force) == Some(speed) {
            let name = self.titles.name(speed);
            let message = format!("{name} is given as the speed and as the friction");
            return Err(self.error(message, "speed=1,mu=2"));
        }
        let load = match (mu, load, self.options.normal_load) {
            (Some(_), ..) => None,
            (None, Some(column), _) => Some(Load::Column(column)),
            (None, None, load) => load.map(Load::Fixed),
        };
        match (mu.or(force.filter(|_| load.is_some())), force) {
            (Some(friction), _) => Ok(Chosen {
                speed,
                friction,
                load,
                remark,
            }),
            (None, Some(force)) => Err(self.no_load(force)),
            (None, None) => {
                let message = untold("mu_k or the force of friction");
                Err(self.error(message, "mu=2"))
            }
        }
    }

    /// The column given for a role, else the one whose title has it.
    fn column(&self, role: Role) -> Result<Option<usize>, SpecError> {
        if let Some(name) = self.options.columns.of(role) {
            return self.named(role, name).map(Some);
        }
        let titled = |column: &usize| self.titles.titles[*column].role() == Some(role);
        let found: Vec<usize> = (0..self.titles.titles.len()).filter(titled).collect();
        match found[..] {
            [] => Ok(None),
            [column] => Ok(Some(column)),
            // What is not needed may be there twice.
            _ if role == Role::Load || (role == Role::Force && self.has(Role::Mu)) => Ok(None),
            [one, other, ..] => {
                let [one, other] = [one, other].map(|column| self.titles.name(column));
                let message = format!("{one} and {other} may both be the {}", role.name());
                Err(self.error(message, &example(role)))
            }
        }
    }

    fn has(&self, role: Role) -> bool {
        let mut titles = self.titles.titles.iter();
        self.options.columns.of(role).is_some() || titles.any(|title| title.role() == Some(role))
    }

    /// The column of this number or title.
    fn named(&self, role: Role, name: &str) -> Result<usize, SpecError> {
        let titles = &self.titles.titles;
        if let Some(column) = titles.iter().position(|title| title.is(name)) {
            return Ok(column);
        }
        let number: Option<usize> = name.parse().ok();
        match number {
            Some(number) if (1..=self.sheet.width).contains(&number) => Ok(number - 1),
            Some(number) => {
                let message = format!("there is no column {number}, given as the {}", role.name());
                Err(self.error(message, &example(role)))
            }
            None => {
                let meant = did_you_mean(name, titles.iter().map(|title| title.text));
                let message = format!("there is no column {name}, given as the {}", role.name());
                let mut error = self.error(message, &example(role));
                error.help = error.help.map(|help| format!("{meant}{help}"));
                Err(error)
            }
        }
    }

    /// Refuses rows that commas cut in more pieces than others: they may be decimal commas.
    fn check_commas(&self) -> Result<(), SpecError> {
        let width = self.sheet.width;
        let wide = |row: &&Row| row.width() > width;
        if !self.sheet.has_commas() {
            return Ok(());
        }
        match self.sheet.data().iter().find(wide) {
            None => Ok(()),
            Some(row) => {
                let message = format!(
                    "line {} has {} columns, others have {width}",
                    row.line,
                    row.width()
                );
                Err(SpecError::at(row.place.clone(), message).help(DECIMAL_COMMAS))
            }
        }
    }

    fn no_load(&self, force: usize) -> SpecError {
        let say = self.options.spoken;
        let name = self.titles.name(force);
        let message =
            format!("{name} is a force, and the load by which it is divided is not given");
        let help = format!(
            "say the load: {}, or its column: {}",
            say.normal_load(),
            say.columns("load=3")
        );
        SpecError {
            help: Some(help),
            ..self.error(message, "")
        }
    }

    /// An error at the titles, or else at the first row, with all columns and an example of what to
    /// type.
    fn error(&self, message: String, example: &str) -> SpecError {
        let mut help = format!(
            "columns: {}; say which: {}",
            self.titles.listed(self.sheet),
            self.options.spoken.columns(example)
        );
        if self.titles.row.is_none() && self.sheet.has_commas() && self.whole_numbers() {
            help += &format!("; {DECIMAL_COMMAS}");
        }
        let row = self.titles.row.or(self.sheet.first());
        SpecError {
            span: row.map(|row| row.place.clone()),
            ..SpecError::whole(message).help(help)
        }
    }

    /// Whether no number of the first rows has decimals.
    fn whole_numbers(&self) -> bool {
        let rows = self.sheet.data().iter().take(20);
        let mut cells = rows.flat_map(|row| (0..self.sheet.width).map(|column| row.cell(column)));
        cells.all(|cell| cell.bytes().all(|byte| byte.is_ascii_digit()))
    }
}

fn untold(what: &str) -> String {
    format!("it is not clear which column is {what}")
}

/// What to type for a column.
fn example(role: Role) -> String {
    format!("{}=2", role.name())
}

/// What to do where commas may be decimal ones.
const DECIMAL_COMMAS: &str =
    "if its commas are decimal ones, columns are to be separated by `;` or tabs";
