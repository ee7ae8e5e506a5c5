//! What a map or a trace says together with all its numbers, for programs that want no file: the
//! groups, variables and attributes that the file has, but the hashes of what is stored.

use super::described::best::BestRow;
use super::described::curve_column::Column;
use super::described::curve_rows::CurveRows;
use super::described::curves::{CurveTable, outer_values};
use super::described::root::Provenance;
use super::described::schema::{BEST, BOUNDARIES};
use super::described::summary::CellsSummary;
use super::described::{Described, Element, FILL_VALUE, Group, Value, Variable, attribute, trace};
use super::grid::Grid;
use super::plan::Plan;
use crate::answers::trace::Trace;
use crate::setting::case_file::CaseSpec;
use crate::setting::field::Storage;
use crate::sweep::cells::boundaries::plane;

/// The numbers of a variable, the last dimension fastest.
#[derive(Debug, Clone, PartialEq)]
pub enum Numbers {
    /// i8.
    I8(Vec<i8>),
    /// i32.
    I32(Vec<i32>),
    /// i64.
    I64(Vec<i64>),
    /// u8.
    U8(Vec<u8>),
    /// u16.
    U16(Vec<u16>),
    /// f64.
    F64(Vec<f64>),
}

/// A map or trace with its numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Filled {
    /// What it says. Every dimension has its length.
    pub described: Described,
    /// For each group, the numbers of its variables.
    pub numbers: Vec<Vec<Numbers>>,
}

impl Numbers {
    /// Reals that hold numbers of this type exactly.
    fn of(element: Element, values: Vec<f64>) -> Self {
        macro_rules! cast {
            ($variant:ident) => {
                Self::$variant(values.iter().map(|&value| value as _).collect())
            };
        }
        match element {
            Element::I8 => cast!(I8),
            Element::I32 => cast!(I32),
            Element::I64 => cast!(I64),
            Element::U8 => cast!(U8),
            Element::U16 => cast!(U16),
            Element::F64 => Self::F64(values),
        }
    }
}

impl From<Column<'_>> for Numbers {
    fn from(column: Column) -> Self {
        match column {
            Column::I8(numbers) => Self::I8(numbers.to_vec()),
            Column::I32(numbers) => Self::I32(numbers.to_vec()),
            Column::I64(numbers) => Self::I64(numbers.to_vec()),
            Column::F64(numbers) => Self::F64(numbers.to_vec()),
        }
    }
}

impl Filled {
    /// The map of a sweep.
    ///
    /// ```
    /// use std::sync::Arc;
    /// use slipmap::setting::SweepSpec;
    /// use slipmap::sweep::Plan;
    /// use slipmap::sweep::described::root::Provenance;
    /// use slipmap::sweep::events::Attended;
    /// use slipmap::sweep::filled::{Filled, Numbers};
    /// use slipmap::sweep::grid::Grid;
    ///
    /// let sweep: SweepSpec = "[axes]\ntau = [1, 2]\n[fixed]\nmu_prime = -0.3\n".parse()?;
    /// let plan = Arc::new(Plan::new(sweep)?);
    /// let grid = Grid::compute(&plan, 1, Attended::silently(&Arc::default()))?;
    /// let map = Filled::of_map(grid, &Provenance::default());
    /// let count = map.described.root().variables.iter().position(|v| v.name == "n_unstable");
    /// assert_eq!(map.numbers[0][count.unwrap()], Numbers::U16(vec![2, 2]));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn of_map(grid: Grid, provenance: &Provenance) -> Self {
        let plan = grid.shared_plan();
        let mut described = Described::of_map(&plan, provenance);
        let best = best(&grid, &described);
        let (curves, lengths) = curves(&grid, &plan);
        let own = described.dimensions.iter_mut();
        let own = own.filter(|dimension| dimension.group == BOUNDARIES);
        for (dimension, length) in own.zip(lengths) {
            dimension.length = Some(length);
        }
        tell_summaries(&mut described.groups[0], &grid, &plan);
        let mut cells = cells(grid, &plan).into_iter();
        let mut parts = [(BOUNDARIES, curves.into_iter()), (BEST, best.into_iter())];
        let numbers = described.groups.iter().map(|group| {
            let mut of = parts.iter_mut().find(|(name, _)| *name == group.name);
            fill(group, || match &mut of {
                Some((_, columns)) => columns.next(),
                None => cells.next(),
            })
        });
        let numbers = numbers.collect();
        let mut whole = Self { described, numbers };
        whole.tell_missing();
        whole
    }

    /// The trace of a motion.
    #[must_use]
    pub fn of_trace(spec: &CaseSpec, found: &Trace, provenance: &Provenance) -> Self {
        let described = Described::of_trace(spec, found, provenance);
        let events = trace::event_columns(&found.events);
        let columns = trace::columns(found).chain(events);
        let elements = described.groups.iter().flat_map(|group| &group.variables);
        let computed = elements.filter(|variable| variable.values.is_none());
        let mut columns = computed
            .zip(columns)
            .map(|(variable, column)| Numbers::of(variable.element, column));
        let numbers = described.groups.iter();
        let numbers = numbers
            .map(|group| fill(group, || columns.next()))
            .collect();
        Self { described, numbers }
    }

    /// Tells the fill value of integers in the group of best settings where one is missing.
    fn tell_missing(&mut self) {
        let groups = self.described.groups.iter_mut().zip(&self.numbers);
        for (group, columns) in groups.filter(|(group, _)| group.name == BEST) {
            for (variable, numbers) in group.variables.iter_mut().zip(columns) {
                let missing = match (numbers, variable.fill) {
                    (Numbers::I8(of), Some(fill)) => of.contains(&(fill as i8)),
                    (Numbers::I32(of), Some(fill)) => of.contains(&(fill as i32)),
                    _ => false,
                };
                if missing {
                    tell_fill(variable);
                }
            }
        }
    }
}

/// The numbers of the variables of a group; `computed` has those that are not known before.
fn fill(group: &Group, mut computed: impl FnMut() -> Option<Numbers>) -> Vec<Numbers> {
    let variables = group.variables.iter();
    let of = |variable: &Variable| match &variable.values {
        Some(values) => Numbers::F64(values.clone()),
        None => computed().unwrap_or(Numbers::of(variable.element, Vec::new())),
    };
    variables.map(of).collect()
}

/// Tells the fill value of a variable of integers.
fn tell_fill(variable: &mut Variable) {
    let Some(fill) = variable.fill else { return };
    let value: Value = match variable.element {
        Element::I8 => [fill as i8].into(),
        Element::I32 => [fill as i32].into(),
        Element::U8 => [fill as u8].into(),
        Element::U16 => [fill as u16].into(),
        Element::I64 | Element::F64 => return,
    };
    variable.attributes.push(attribute(FILL_VALUE, value));
}

/// Tells the summaries of the fields and of the status in the root.
fn tell_summaries(root: &mut Group, grid: &Grid, plan: &Plan) {
    let (summary, cells) = (CellsSummary::of(&grid.cells), plan.cells());
    let mut computed = root.variables.iter_mut().filter(|of| of.values.is_none());
    for (field, told) in plan.spec.fields.iter().zip(&summary.fields) {
        let Some(variable) = computed.next() else {
            return;
        };
        let attributes = told.attributes(field.storage(), cells);
        variable.attributes.extend(attributes);
        if told.missing(cells) > 0 && field.storage() != Storage::Real {
            tell_fill(variable);
        }
    }
    if let Some(status) = computed.next() {
        status.attributes.extend(summary.status.attributes(cells));
    }
}

/// The fields in the order of the map, then the status.
fn cells(grid: Grid, plan: &Plan) -> Vec<Numbers> {
    let mut of = grid.cells;
    let mut kinds = of.kinds.into_iter();
    let mut reals = of.columns.into_iter();
    let fields = plan.spec.fields.iter().map(|field| match field.storage() {
        Storage::Count => Numbers::U16(of.n_unstable.take().unwrap_or_default()),
        Storage::Kind | Storage::Few => {
            Numbers::U8(kinds.next().map_or_else(Vec::new, |column| column.cells))
        }
        Storage::Real => Numbers::F64(reals.next().map_or_else(Vec::new, |column| column.cells)),
    });
    let mut columns: Vec<Numbers> = fields.collect();
    columns.push(Numbers::U8(of.status));
    columns
}

/// The columns of the curves of all planes, and the lengths of their dimensions.
fn curves(grid: &Grid, plan: &Plan) -> (Vec<Numbers>, [usize; 3]) {
    let mut table = CurveTable::new(plan);
    for (number, of) in grid.curves.iter().enumerate() {
        let outer = outer_values(plan, &plane(plan, number as u64));
        table.append(&CurveRows::of(of), &outer);
    }
    let columns = table.columns().into_iter().map(Numbers::from);
    (columns.collect(), table.lengths())
}

/// The columns of the best settings of all planes.
fn best(grid: &Grid, described: &Described) -> Vec<Numbers> {
    let Some(group) = described.group(BEST) else {
        return Vec::new();
    };
    let rows: Vec<Vec<f64>> = grid
        .best
        .iter()
        .map(|found| BestRow::of(found.as_ref()).values().collect())
        .collect();
    let computed = group.variables.iter().filter(|of| of.values.is_none());
    let column = |(place, variable): (usize, &Variable)| {
        Numbers::of(
            variable.element,
            rows.iter().map(|row| row[place]).collect(),
        )
    };
    computed.enumerate().map(column).collect()
}
