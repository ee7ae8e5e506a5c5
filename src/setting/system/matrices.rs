//! Matrices in the file of a system: rows of numbers and of expressions of its parameters.

use std::ops::Range;

use super::expressed::Expression;
use crate::linear::matrix::{MOST_ROWS, Matrix, MatrixError, MatrixSystem};
use crate::setting::expression::{Coefficient, Stacks, Tape};
use crate::setting::no_answer::NoAnswer;
use crate::text::Shown;
use crate::text::toml_reader::{Entry, SpecError, quoted};

/// What an entry with s in it is told.
const WITH_VARIABLE: [&str; 2] = [
    "an entry with s in it",
    "entries are numbers or expressions of the parameters; polynomials in s are for P and Q",
];

/// A matrix as written in a text, before the names of the parameters are known.
pub(super) struct WrittenMatrix {
    pub name: &'static str,
    pub span: Range<usize>,
    columns: usize,
    rows: usize,
    entries: Vec<Coefficient>,
}

/// What stands in `feedback`: B, K and C.
pub(super) struct WrittenFeedback {
    pub b: WrittenMatrix,
    pub k: Option<WrittenMatrix>,
    pub c: WrittenMatrix,
}

/// A matrix of numbers and expressions.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Entries {
    name: &'static str,
    rows: usize,
    columns: usize,
    values: Vec<Value>,
}

#[derive(Debug, Clone, PartialEq)]
enum Value {
    Number(f64),
    Of(Expression),
}

/// The matrices of ẋ(t) − E₁ ẋ(t − τ) = A₀ x(t) + A₁ x(t − τ), or of A₁ = B K C.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Matrices {
    a0: Entries,
    delayed: Delayed,
}

#[derive(Debug, Clone, PartialEq)]
enum Delayed {
    Whole {
        a1: Entries,
        e1: Option<Entries>,
    },
    Feedback {
        b: Entries,
        k: Option<Entries>,
        c: Entries,
    },
}

impl WrittenMatrix {
    /// The matrix of this name that an entry of the text `whole` gives.
    pub(super) fn of(name: &'static str, entry: &Entry, whole: &str) -> Result<Self, SpecError> {
        if !entry.is_array() {
            return Err(entry.expected("an array of rows, such as [[0, 1], [\"-k\", -0.1]]"));
        }
        let rows = entry.array()?;
        if rows.is_empty() {
            let error = entry.error("an empty list is no matrix");
            return Err(error.help("one array for each row, such as [[0, 1], [\"-k\", -0.1]]"));
        }
        if rows.len() > MOST_ROWS {
            let message = format!("{} rows: at most {MOST_ROWS} are allowed", rows.len());
            return Err(entry.error(message));
        }
        let (mut columns, mut entries) = (0, Vec::new());
        for (i, row) in rows.iter().enumerate() {
            if !row.is_array() {
                return Err(row.expected("a row in brackets, such as [0, 1]"));
            }
            let row_entries = row.array()?;
            let length = row_entries.len();
            if i == 0 {
                columns = length;
            }
            if length == 0 || length > MOST_ROWS {
                return Err(row.error(format!("a row has 1 to {MOST_ROWS} entries, not {length}")));
            }
            if length != columns {
                return Err(row.error(format!(
                    "this row has {length} entries, the first {columns}"
                )));
            }
            for (j, element) in row_entries.iter().enumerate() {
                let name = format!("{name}[{i}][{j}]");
                entries.push(Coefficient::of(name, element, whole)?);
            }
        }
        Ok(Self {
            name,
            span: entry.span.clone(),
            columns,
            rows: rows.len(),
            entries,
        })
    }

    /// Refuses another size than `rows` by `columns`, where it is given; `why` says what wants it.
    fn sized(
        &self,
        (rows, columns): (Option<usize>, Option<usize>),
        why: &str,
    ) -> Result<(), SpecError> {
        let fits = |is: usize, wanted: Option<usize>| wanted.is_none_or(|wanted| is == wanted);
        if fits(self.rows, rows) && fits(self.columns, columns) {
            return Ok(());
        }
        let size = |rows: usize, columns: usize| match (rows, columns) {
            (1, 1) => "1 row of 1 entry".to_owned(),
            (1, n) => format!("1 row of {n} entries"),
            (m, 1) => format!("{m} rows of 1 entry"),
            (m, n) => format!("{m} rows of {n} entries"),
        };
        let has = size(self.rows, self.columns);
        let wanted = size(rows.unwrap_or(self.rows), columns.unwrap_or(self.columns));
        let message = format!("{} has {has}, and needs {wanted}", self.name);
        Err(SpecError::at(self.span.clone(), message).help(why))
    }

    fn read(&self, names: &[&str]) -> Result<Entries, SpecError> {
        let entries = self.entries.iter().map(|of| {
            Ok(match of {
                Coefficient::Number(value) => Value::Number(*value),
                Coefficient::Given(written) => {
                    Value::Of(Expression::number(written, names, WITH_VARIABLE)?)
                }
            })
        });
        Ok(Entries {
            name: self.name,
            rows: self.rows,
            columns: self.columns,
            values: entries.collect::<Result<_, SpecError>>()?,
        })
    }
}

impl WrittenFeedback {
    /// The table `feedback` of the text `whole`.
    pub(super) fn of(entry: &Entry, whole: &str) -> Result<Self, SpecError> {
        let mut table = entry.document(["B", "K", "C"])?;
        let mut matrix = |name| table.take(name, |entry| WrittenMatrix::of(name, entry, whole));
        let [b, k, c] = ["B", "K", "C"].map(&mut matrix);
        table.finish()?;
        let missing = |name: &str| {
            let error = entry.error(format!("{name} is missing"));
            error.help("feedback = { B, K, C }: A1 = B K C; K may be left out")
        };
        Ok(Self {
            b: b.ok_or_else(|| missing("B"))?,
            k,
            c: c.ok_or_else(|| missing("C"))?,
        })
    }
}

impl Matrices {
    /// ẋ(t) − E₁ ẋ(t − τ) = A₀ x(t) + A₁ x(t − τ).
    pub(super) fn whole(
        a0: &WrittenMatrix,
        a1: &WrittenMatrix,
        e1: Option<&WrittenMatrix>,
        names: &[&str],
    ) -> Result<Self, SpecError> {
        let n = square(a0)?;
        for of in [a1].into_iter().chain(e1) {
            of.sized((Some(n), Some(n)), "all matrices have the size of A0")?;
        }
        let e1 = e1.map(|e1| e1.read(names)).transpose()?;
        let (a0, a1) = (a0.read(names)?, a1.read(names)?);
        let delayed = Delayed::Whole { a1, e1 };
        Ok(Self { a0, delayed })
    }

    /// ẋ(t) = A₀ x(t) + B K C x(t − τ).
    pub(super) fn fed_back(
        a0: &WrittenMatrix,
        by: &WrittenFeedback,
        names: &[&str],
    ) -> Result<Self, SpecError> {
        let n = square(a0)?;
        by.b.sized((Some(n), None), "B has the rows of A0")?;
        let inputs = by.b.columns;
        let outputs = by.k.as_ref().map_or(inputs, |k| k.columns);
        if let Some(k) = &by.k {
            k.sized((Some(inputs), None), "K has a row for each column of B")?;
        }
        let why = "C has a row for each column of K, or of B without K, and the columns of A0";
        by.c.sized((Some(outputs), Some(n)), why)?;
        let delayed = Delayed::Feedback {
            b: by.b.read(names)?,
            k: by.k.as_ref().map(|k| k.read(names)).transpose()?,
            c: by.c.read(names)?,
        };
        let a0 = a0.read(names)?;
        Ok(Self { a0, delayed })
    }

    /// Its matrices.
    pub(super) fn each(&self) -> impl Iterator<Item = &Entries> {
        let delayed = match &self.delayed {
            Delayed::Whole { a1, e1 } => [Some(a1), e1.as_ref(), None],
            Delayed::Feedback { b, k, c } => [Some(b), k.as_ref(), Some(c)],
        };
        [&self.a0].into_iter().chain(delayed.into_iter().flatten())
    }

    /// Its keys with their values as TOML has them.
    pub(super) fn pairs(&self) -> Vec<(&'static str, String)> {
        let given: Vec<_> = self
            .each()
            .map(|of| (of.name, of.to_text(quoted)))
            .collect();
        match self.delayed {
            Delayed::Whole { .. } => given,
            Delayed::Feedback { .. } => {
                let inside = given[1..]
                    .iter()
                    .map(|(name, text)| format!("{name} = {text}"));
                let inside = inside.collect::<Vec<_>>().join(", ");
                vec![given[0].clone(), ("feedback", format!("{{ {inside} }}"))]
            }
        }
    }

    /// The system at these values.
    pub(super) fn at(&self, values: &[f64], stacks: &mut Stacks) -> Result<MatrixSystem, NoAnswer> {
        let a0 = self.a0.at(values, stacks)?;
        let mut optional = |of: &Option<Entries>| match of {
            Some(of) => of.at(values, stacks).map(Some),
            None => Ok(None),
        };
        let found = match &self.delayed {
            Delayed::Whole { a1, e1 } => {
                let e1 = optional(e1)?;
                MatrixSystem::of_matrices(&a0, &a1.at(values, stacks)?, e1.as_ref())
            }
            Delayed::Feedback { b, k, c } => {
                let k = optional(k)?;
                let (b, c) = (b.at(values, stacks)?, c.at(values, stacks)?);
                MatrixSystem::of_feedback(&a0, &b, k.as_ref(), &c)
            }
        };
        found.map_err(|error| refused("A1", &error))
    }
}

/// The size of a square matrix.
fn square(of: &WrittenMatrix) -> Result<usize, SpecError> {
    of.sized((None, Some(of.rows)), "it has as many columns as rows")?;
    Ok(of.rows)
}

/// Why numbers make no system of the form that `key` gives.
pub(super) fn refused(key: &'static str, error: &MatrixError) -> NoAnswer {
    NoAnswer::Undefined {
        polynomial: key.into(),
        what: format!("{error} at this setting"),
    }
}

impl Entries {
    /// Its name.
    pub(super) fn name(&self) -> &'static str {
        self.name
    }

    /// The expressions in it.
    pub(super) fn tapes(&self) -> impl Iterator<Item = &Tape> {
        self.values.iter().filter_map(|value| match value {
            Value::Number(_) => None,
            Value::Of(expression) => Some(expression.tape()),
        })
    }

    /// Its rows in brackets, with expressions as `written` says.
    pub(super) fn to_text(&self, written: impl Fn(&str) -> String) -> String {
        let entry = |value: &Value| match value {
            Value::Number(value) => Shown(*value).to_string(),
            Value::Of(expression) => written(&expression.text),
        };
        let row = |row: &[Value]| {
            let row: Vec<String> = row.iter().map(entry).collect();
            format!("[{}]", row.join(", "))
        };
        let rows: Vec<String> = self.values.chunks(self.columns).map(row).collect();
        format!("[{}]", rows.join(", "))
    }

    fn at(&self, values: &[f64], stacks: &mut Stacks) -> Result<Matrix, NoAnswer> {
        let entries = self.values.iter().enumerate();
        let entries = entries.map(|(place, value)| match value {
            Value::Number(value) => Ok(*value),
            Value::Of(expression) => {
                let found = expression.at(self.name, values, stacks);
                let found = found.map_err(|why| self.named(place, why))?;
                Ok(found.coefficients()[0])
            }
        });
        let entries = entries.collect::<Result<Vec<f64>, NoAnswer>>()?;
        Ok(Matrix::new(self.rows, self.columns, entries))
    }

    /// Why the entry at `place` has no value, with its name, as A0[0][1].
    fn named(&self, place: usize, why: NoAnswer) -> NoAnswer {
        let (row, column) = (place / self.columns, place % self.columns);
        match why {
            NoAnswer::Undefined { what, .. } => NoAnswer::Undefined {
                polynomial: format!("{}[{row}][{column}]", self.name).into(),
                what,
            },
            other => other,
        }
    }
}
