//! Fields at any points: what the cells of a map hold, where the points are no grid.

use std::convert::Infallible;

use super::cells::buffers::TileBuffers;
use super::cells::worker::Worker;
use super::engine::{RunError, each_attended};
use super::events::Attended;
use super::plan::Plan;
use crate::linear::MarginalTolerance;
use crate::model::stop::Stop;
use crate::setting::axis::Axis;
use crate::setting::basin::Basin;
use crate::setting::field::Field;
use crate::setting::needs::check_kinds;
use crate::setting::parameter::Parameter;
use crate::setting::search::{Protocol, Search};
use crate::setting::simulation::{DISTURBED, Simulation};
use crate::setting::spec::SweepSpec;
use crate::setting::units::Units;
use crate::setting::values::Setting;
use crate::text::SpecError;

/// What is evaluated, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct Wanted {
    fields: Vec<Field>,
    /// How close to a crossing a point counts as marginal.
    pub tolerance: MarginalTolerance,
    /// How far and how exactly motions are followed.
    pub simulation: Simulation,
    /// The starts over which a share is taken.
    pub basin: Basin,
    /// The protocol for critical velocities.
    pub protocol: Protocol,
}

impl Wanted {
    /// These fields, with what bounds their errors, and defaults for all else.
    ///
    /// # Errors
    /// Refuses fields of the limit of a short delay, which has no delays.
    pub fn of(fields: &[Field]) -> Result<Self, SpecError> {
        check_kinds(fields)?;
        Ok(Self {
            fields: Field::with_bounds(fields.to_vec()),
            tolerance: MarginalTolerance::default(),
            simulation: Simulation::default(),
            basin: Basin::default(),
            protocol: Protocol::Follow,
        })
    }

    /// All fields, in the order of the columns.
    #[must_use]
    pub fn fields(&self) -> &[Field] {
        &self.fields
    }

    /// The sweep of the delays of one setting. A motion without a start begins as in sweep files.
    fn sweep(&self, setting: &Setting, delays: Axis) -> SweepSpec {
        let any = |of: fn(Field) -> bool| self.fields.iter().any(|&field| of(field));
        let critical = any(Field::of_vc).then_some(Search {
            protocol: self.protocol,
            verify: 0.0,
        });
        let mut start = Parameter::ALL.into_iter().filter(|p| p.of_start());
        let mut simulation = self.simulation.clone();
        if start.all(|p| setting.get(p).is_nan()) {
            simulation.disturbance = DISTURBED;
        }
        SweepSpec {
            title: String::new(),
            picture: None,
            limit: false,
            axes: vec![delays],
            fixed: setting.clone(),
            fields: self.fields.clone(),
            boundaries: Some(false),
            degrees_of_stability: Vec::new(),
            best: false,
            tolerance: self.tolerance,
            simulation,
            basin: any(Field::of_basin).then_some(self.basin),
            critical,
            units: Units::default(),
            text: String::new(),
        }
    }
}

/// Some delays at one setting, whose own delay is ignored.
#[derive(Debug, Clone, Copy)]
pub struct Points<'a> {
    /// All other parameters.
    pub setting: &'a Setting,
    /// The delays, in any order.
    pub delays: &'a [f64],
}

/// Computes fields and statuses at all of `points`, on `threads` threads or on this one where
/// `threads` is at most 1. The answer has one cell for each delay, setting after setting.
///
/// The cells have the bits of those of a map with the same line of delays. Roots and critical
/// velocities are followed from delay to delay: in the last bits they may depend on the delays
/// beside them. Where a field has no value, or a setting is outside its model, there is a fill
/// value, and the status says why.
///
/// ```
/// use std::sync::Arc;
/// use slipmap::sweep::evaluate::{Points, Wanted, evaluate};
/// use slipmap::sweep::events::Attended;
/// use slipmap::setting::{Field, Parameter, Setting};
///
/// let of = |alpha_v| {
///     let numbers = [("mu_prime", -0.3), ("alpha_v", alpha_v)];
///     Setting::checked(numbers, None, &[Parameter::Tau])
/// };
/// let (setting, controlled) = (of(0.0)?, of(-0.5)?);
/// let points = [
///     Points { setting: &setting, delays: &[4.15] },
///     Points { setting: &controlled, delays: &[4.15, 1.0] },
/// ];
/// let wanted = Wanted::of(&[Field::NUnstable])?;
/// let found = evaluate(&points, &wanted, 2, Attended::silently(&Arc::default()))?;
/// assert_eq!(found.n_unstable.as_deref(), Some(&[2, 0, 2][..]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When a delay is outside its range, a setting lacks what a field needs, in the words of sweep
/// files, it is stopped, or the threads cannot be started.
pub fn evaluate(
    points: &[Points],
    wanted: &Wanted,
    threads: usize,
    attended: Attended,
) -> Result<TileBuffers, RunError<Infallible>> {
    for points in points {
        for delay in points.delays {
            Parameter::Tau.check(*delay)?;
        }
        let delays = points.delays.to_vec();
        wanted.sweep(points.setting, along(delays)).check_needs()?;
    }
    let cells = |points: &Points| points.delays.len() as u64;
    let work = |points: &Points, stop: &Stop| at_setting(points, wanted, stop);
    let found = each_attended(points, threads, attended, cells, work)?;
    let cells = points.iter().map(|points| points.delays.len()).sum();
    let mut all = TileBuffers::of_cells(&wanted.fields, cells);
    let mut at = 0;
    for (cells, places) in &found {
        let Some(places) = places else {
            let count = cells.status.len();
            all.take_cells(at..at + count, cells, 0..count);
            at += count;
            continue;
        };
        for &place in places {
            all.take_cells(at..at + 1, cells, place..place + 1);
            at += 1;
        }
    }
    Ok(all)
}

/// The cells of one setting, and the place of each delay among them where that is another; none
/// after a stop.
fn at_setting(
    points: &Points,
    wanted: &Wanted,
    stop: &Stop,
) -> Option<(TileBuffers, Option<Vec<usize>>)> {
    let (delays, places) = in_order(points.delays);
    let mut cells = TileBuffers::of_cells(&wanted.fields, delays.len());
    if delays.is_empty() {
        return Some((cells, places));
    }
    // No list in memory is so long that this fails: it would need two million tiles.
    let plan = Plan::new(wanted.sweep(points.setting, along(delays))).ok()?;
    let mut worker = Worker::new(&plan);
    for number in 0..plan.tiles.len() {
        let tile = plan.tiles.tile(number);
        if !worker.compute(&tile, stop) {
            return None;
        }
        let (first, count) = (tile.offset[0], tile.extent[0]);
        if plan.tiles.len() == 1 && worker.buffers.status.len() == count {
            return Some((worker.buffers, places));
        }
        cells.take_cells(first..first + count, &worker.buffers, 0..count);
    }
    Some((cells, places))
}

fn along(delays: Vec<f64>) -> Axis {
    Axis {
        parameter: Parameter::Tau.into(),
        values: delays,
    }
}

/// These delays in increasing order, each once, and the place of each of them there; none where
/// they are in order already.
fn in_order(delays: &[f64]) -> (Vec<f64>, Option<Vec<usize>>) {
    if delays.is_sorted_by(|one, next| one < next) {
        return (delays.to_vec(), None);
    }
    let mut order: Vec<(f64, usize)> = delays.iter().copied().zip(0..).collect();
    order.sort_unstable_by(|(one, _), (other, _)| one.total_cmp(other));
    let mut values: Vec<f64> = Vec::with_capacity(delays.len());
    let mut places = vec![0; delays.len()];
    for (delay, at) in order {
        if values.last() != Some(&delay) {
            values.push(delay);
        }
        places[at] = values.len() - 1;
    }
    (values, Some(places))
}
