//! Charts: the cells and curves of a sweep, computed into memory.

use std::convert::Infallible;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::problem::{Problem, Why};
use crate::linear::curves::CurvePiece;
use crate::setting::SweepSpec;
use crate::setting::field::Storage;
use crate::setting::source::Cost;
use crate::sweep::Plan;
use crate::sweep::engine::RunError;
use crate::sweep::events::Attended;
use crate::sweep::grid::Grid;
use crate::sweep::plan::memory::Memory;

/// Bytes for the curves of a plane, unless there are very many.
const BYTES_OF_CURVES: u64 = 1 << 20;

/// Limits of a chart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// The most cells whose fields come from the closed form of a line.
    pub counted: u64,
    /// The most cells whose roots are followed.
    pub rooted: u64,
    /// The most cells whose motion is followed, or whose critical velocity is computed.
    pub followed: u64,
    /// The most bytes of all cells.
    pub bytes: u64,
    /// The most points of an axis.
    pub points: u64,
    /// The most planes in which curves are traced.
    pub planes: u64,
}

impl Default for Limits {
    /// Limits that usually keep a chart within a second on one core.
    fn default() -> Self {
        Self {
            counted: 4_000_000,
            rooted: 1_000_000,
            followed: 1000,
            bytes: 32 << 20,
            points: 1 << 16,
            planes: 16,
        }
    }
}

/// A curve of a chart.
#[derive(Debug, Clone, PartialEq)]
pub struct ChartCurve {
    /// σ: roots on the curve have Re λ = −σ.
    pub degree_of_stability: f64,
    /// The direction in which a pair crosses with increasing delay: −1 to the left, 0 touch, 1 to
    /// the right.
    pub direction: i8,
    /// The side on which sliding is stable: −1 shorter delays, 0 neither, 1 longer delays.
    pub stable_side: i8,
    /// Parameter and delay, vertex by vertex.
    pub vertices: Vec<[f64; 2]>,
}

impl ChartCurve {
    /// A traced curve.
    #[must_use]
    pub fn of(degree_of_stability: f64, piece: &CurvePiece) -> Self {
        Self {
            degree_of_stability,
            direction: piece.direction.sign(),
            stable_side: piece.stable_side.sign(),
            vertices: piece.vertices.iter().map(|v| [v.p, v.q]).collect(),
        }
    }
}

/// The problem of a chart beyond its limits.
fn too_large(detail: String) -> Problem {
    Problem::new(Why::TooLarge, detail).help("run it: slipmap run SWEEP.toml has no such limit")
}

/// A sweep in memory.
#[derive(Debug, Clone)]
pub struct Chart {
    /// Its cells.
    pub grid: Grid,
    /// The curves of all its planes.
    pub curves: Vec<ChartCurve>,
}

impl Chart {
    /// Reads the sweep in `text`, if it is within the limits of a chart.
    ///
    /// # Errors
    /// When the text is not understood, or has too many cells or planes.
    pub fn plan(text: &str, limits: Limits) -> Result<Arc<Plan>, Problem> {
        let plan = Plan::new(SweepSpec::read(text, limits.points)?)?;
        let (cells, most) = (plan.cells(), limits.most(&plan));
        if cells > most {
            return Err(too_large(format!(
                "a chart of these fields has at most {most} cells, this one has {cells}"
            )));
        }
        let (planes, most) = (plan.boundary_planes(), limits.planes);
        if planes > most {
            return Err(too_large(format!(
                "a chart has curves in at most {most} planes, this one in {planes}"
            )));
        }
        Ok(Arc::new(plan))
    }

    /// Computes the chart on this thread. `stop` is checked between tiles.
    ///
    /// # Errors
    /// When it cannot be computed, or is stopped.
    pub fn of(plan: &Arc<Plan>, stop: &Arc<AtomicBool>) -> Result<Self, RunError<Infallible>> {
        let grid = Grid::compute(plan, 1, Attended::silently(stop))?;
        let curves = curves(&grid);
        Ok(Self { grid, curves })
    }
}

impl Limits {
    /// The most cells of a sweep with these fields.
    fn most(&self, plan: &Plan) -> u64 {
        let most = match plan.spec.cost() {
            Cost::Counted => self.counted,
            Cost::Rooted | Cost::Searched | Cost::Proved => self.rooted,
            Cost::Followed | Cost::Critical => self.followed,
            Cost::FollowedOften => self.followed / u64::from(plan.spec.motions_per_cell()),
        };
        most.min(self.bytes / plan.bytes_per_cell())
    }
}

/// An upper bound on the bytes of a chart while it is computed and encoded.
#[must_use]
pub fn bytes(plan: &Plan) -> u64 {
    let cells = plan.cells() * plan.bytes_per_cell() + plan.boundary_planes() * BYTES_OF_CURVES;
    // What a field shows: a byte for each of its cells and, of one field at a time, real numbers in
    // a list that grows.
    let fields = &plan.spec.fields;
    let real = fields.iter().any(|field| field.storage() == Storage::Real);
    let shown = plan.cells() * (fields.len() as u64 + if real { 16 } else { 0 });
    Memory::of(plan).per_thread + 2 * cells + shown
}

/// Whether a chart may take many seconds: its cells follow motions or are searched through, roots
/// are those of another system than the letter's, or curves are walked step by step.
#[must_use]
pub fn is_slow(plan: &Plan) -> bool {
    let cost = plan.spec.cost();
    cost > Cost::Rooted
        || (cost == Cost::Rooted && !plan.spec.is_of_letter())
        || plan.walks_boundaries()
        || plan.best_planes() > 0
}

fn curves(grid: &Grid) -> Vec<ChartCurve> {
    let of_planes = grid.curves.iter().flat_map(|plane| &plane.curves);
    let mut curves = Vec::new();
    for of in of_planes {
        let Ok(traced) = &of.curves else { continue };
        let degree = of.degree_of_stability;
        curves.extend(
            traced
                .pieces
                .iter()
                .map(|piece| ChartCurve::of(degree, piece)),
        );
    }
    curves
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::Crossings;
    use std::sync::atomic::Ordering;

    const PLANE: &str = "[axes]\nmu_prime = { from = -0.9, to = 0.1, points = 40 }\n\
        tau = { from = 0.0, to = 9.0, points = 50 }\n[fixed]\nalpha_v = -0.33\n";

    fn chart(text: &str) -> Result<Chart, Problem> {
        let stop = Arc::new(AtomicBool::new(false));
        Ok(Chart::of(&Chart::plan(text, Limits::default())?, &stop)?)
    }

    #[test]
    fn cells_are_those_of_the_closed_form_and_curves_bound_them() {
        let found = chart(&format!("boundaries = true\n{PLANE}")).unwrap();
        let counts = found.grid.cells.n_unstable.as_deref().unwrap();
        let plan = found.grid.plan();
        for (i, &n) in counts.iter().enumerate() {
            let setting = plan.setting(&[i / 50, i % 50]);
            let (groups, _) = setting.groups().unwrap();
            let tau = plan.spec.axes[1].values[i % 50];
            assert_eq!(u64::from(n), Crossings::of(groups).n_unstable(tau));
        }
        assert!(counts.contains(&0) && counts.contains(&2));
        assert!(found.curves.iter().any(|curve| curve.stable_side != 0));
        assert!(found.curves.iter().all(|curve| curve.vertices.len() > 1));
    }

    #[test]
    fn roots_beyond_the_letter_and_walked_curves_are_slow() {
        let slow = |text: &str| is_slow(&Chart::plan(text, Limits::default()).unwrap());
        let rooted = format!("fields = [\"abscissa\"]\nboundaries = false\n{PLANE}");
        assert!(!slow(PLANE) && !slow(&rooted));
        assert!(slow(&format!("{rooted}memory = 0.97\n")));
        assert!(slow(&format!("{rooted}latency = 30\n")));
        // Curves are walked beyond the letter, and in planes without the delay.
        let counted = format!("boundaries = false\n{PLANE}memory = 0.97\n");
        assert!(!slow(&counted) && slow(&counted.replace("false", "true")));
        let gains = PLANE.replace("tau =", "alpha_n =") + "tau = 4\n";
        assert!(!slow(&gains) && slow(&format!("boundaries = true\n{gains}")));
    }

    fn too_many(cells: u64, most: u64) -> Problem {
        too_large(format!(
            "a chart of these fields has at most {most} cells, this one has {cells}"
        ))
    }

    #[test]
    fn too_much_is_refused_before_anything_is_computed() {
        for (fields, points, most) in [
            ("", 50_001, 4_000_000),
            ("fields = [\"abscissa\"]\n", 30_000, 1_000_000),
            (
                "fields = [\"abscissa\", \"frequency\", \"delay_margin\", \"relaxation_time\"]\n",
                12_000,
                // With the margin of the certificate, and the status.
                (32 << 20) / (5 * 8 + 1),
            ),
        ] {
            let longer = PLANE.replace("points = 50", &format!("points = {points}"));
            let longer = longer.replace("points = 40", "points = 100");
            let refused = chart(&format!("{fields}{longer}")).unwrap_err();
            let cells = 100 * points;
            assert_eq!(refused, too_many(cells, most));
        }
        let planes = "boundaries = true\n[axes]\nmass = { from = 1, to = 2, points = 17 }\n";
        let many = PLANE.replace("[axes]\n", planes);
        let planes = "a chart has curves in at most 16 planes, this one in 17";
        assert_eq!(chart(&many).unwrap_err(), too_large(planes.into()));
        let long = PLANE.replace("points = 50", "points = 65537");
        assert_eq!(chart(&long).unwrap_err().status, 422);
        let axis = "[axes]\ntau = { from = 0.1, to = 9, points = 1001 }\n[fixed]\nv0 = 0.2\n\
            [friction]\nlaw = \"coulomb\"\nmu0 = 0.5\n";
        let followed = chart(&format!("fields = [\"outcome\"]\n{axis}")).unwrap_err();
        assert_eq!(followed, too_many(1001, 1000));
        assert_eq!(followed.status, 413);
    }

    #[test]
    fn mistakes_say_where_and_a_stop_ends_it() {
        let refused = chart("[axes]\ntau = [1, 0]\n").unwrap_err();
        assert!(refused.span.is_some());
        let stop = Arc::new(AtomicBool::new(false));
        stop.store(true, Ordering::Relaxed);
        let plan = Chart::plan(PLANE, Limits::default()).unwrap();
        let stopped = Chart::of(&plan, &stop);
        assert!(matches!(stopped, Err(RunError::Interrupted)));
    }
}
