//! A sweep computed into memory, for programs that want numbers and no file.

use std::convert::Infallible;
use std::sync::Arc;

use super::cells::boundaries::BoundaryPlane;
use super::cells::buffers::TileBuffers;
use super::engine::{self, Computed, Encode, RunError, Sink};
use super::events::Attended;
use super::plan::Plan;
use super::plan::pieces::{Piece, Todo};
use super::plan::tile::{for_each_index, memory_strides, place_of};
use crate::answers::best::BestSettings;

/// All values of a sweep in memory.
///
/// ```
/// use std::sync::Arc;
/// use slipmap::sweep::events::Attended;
/// use slipmap::sweep::grid::Grid;
/// use slipmap::setting::SweepSpec;
/// use slipmap::sweep::Plan;
///
/// let sweep: SweepSpec = "
/// fields = [\"n_unstable\", \"abscissa\"]
/// [axes]
/// alpha_v = [-0.33, 0.0]
/// tau = { from = 1.0, to = 5.0, points = 9 }
/// [fixed]
/// mu_prime = -0.3
/// ".parse()?;
/// let plan = Arc::new(Plan::new(sweep)?);
/// let grid = Grid::compute(&plan, 1, Attended::silently(&Arc::default()))?;
/// // Row by row, the last axis fastest: without control both roots are unstable at every delay.
/// assert_eq!(grid.cells.n_unstable.as_deref().unwrap()[9..], [2; 9]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Grid {
    plan: Arc<Plan>,
    /// Distance in memory between neighbouring cells along each axis.
    strides: Vec<usize>,
    /// The cells of the whole map in the order of its axes, the last one fastest.
    pub cells: TileBuffers,
    /// The crossing curves, plane by plane.
    pub curves: Vec<BoundaryPlane>,
    /// The best settings, plane by plane; none where a parameter is outside the model's range.
    pub best: Vec<Option<BestSettings>>,
}

impl Grid {
    /// Computes all of `plan` on `threads` threads, or on this one where `threads` is at most 1.
    /// All cells are in memory at once. Asked to stop, several threads end as [`engine::run`] does,
    /// and this one between pieces and, where cells take long, between cells.
    ///
    /// # Errors
    /// When the system cannot provide the memory, a parameter is outside the model's range, the
    /// threads cannot be started, or it is stopped.
    pub fn compute(
        plan: &Arc<Plan>,
        threads: usize,
        attended: Attended,
    ) -> Result<Self, RunError<Infallible>> {
        let mut grid = Self::empty(plan)?;
        let (todo, mut taken) = (Todo::all(plan.pieces()), Taken(&mut grid));
        match threads {
            0 | 1 => engine::run_here(plan, todo, &mut taken, attended)?,
            _ => engine::run(plan, todo, threads, &mut taken, attended)?,
        }
        Ok(grid)
    }

    fn empty(plan: &Arc<Plan>) -> Result<Self, RunError<Infallible>> {
        let cells = room_for(plan)?;
        Ok(Self {
            cells: TileBuffers::of_cells(&plan.spec.fields, cells),
            curves: vec![BoundaryPlane::default(); plan.boundary_planes() as usize],
            best: vec![None; plan.best_planes() as usize],
            strides: memory_strides(plan.shape()),
            plan: Arc::clone(plan),
        })
    }

    /// The sweep.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The sweep, kept by whoever takes the grid apart.
    pub(super) fn shared_plan(&self) -> Arc<Plan> {
        Arc::clone(&self.plan)
    }

    fn put_tile(&mut self, number: usize, from: &TileBuffers) {
        let tile = self.plan.tiles.tile(number);
        let strides = self.plan.tiles.strides();
        let first = place_of(&tile.offset, &self.strides);
        // The last axis is the fastest in both layouts.
        let last = tile.extent.len() - 1;
        for_each_index(&tile.extent, Some(last), |inside| {
            let (at, there) = (
                first + place_of(inside, &self.strides),
                place_of(inside, &strides),
            );
            let length = tile.extent[last];
            self.cells
                .take_cells(at..at + length, from, there..there + length);
        });
    }
}

/// The number of cells of a sweep, if the system can provide memory for them.
fn room_for(plan: &Plan) -> Result<usize, RunError<Infallible>> {
    let fields = plan.spec.fields.iter().map(|field| field.bytes());
    let status = size_of::<u8>();
    let bytes = fields.sum::<usize>() + status;
    let cells = usize::try_from(plan.cells()).ok();
    let all = cells.and_then(|cells| cells.checked_mul(bytes));
    let fits = all.is_some_and(|all| Vec::<u8>::new().try_reserve_exact(all).is_ok());
    cells.filter(|_| fits).ok_or(RunError::Memory {
        cells: plan.cells(),
        bytes: bytes as u64,
    })
}

/// Copies pieces, so that they can be sent to another thread.
struct Copies;

/// A piece that owns its contents.
enum Owned {
    Curves(BoundaryPlane),
    Best(Option<BestSettings>),
    Tile(Box<TileBuffers>),
}

impl Encode for Copies {
    type Encoded = Owned;

    fn encode(&mut self, _: Piece, computed: Computed) -> Owned {
        match computed {
            Computed::Curves(plane) => Owned::Curves(plane.clone()),
            Computed::Best(best) => Owned::Best(best.cloned()),
            Computed::Tile(buffers) => Owned::Tile(Box::new(buffers.clone())),
        }
    }
}

/// Receives the pieces.
struct Taken<'g>(&'g mut Grid);

impl Sink for Taken<'_> {
    type Encoder = Copies;
    type Error = Infallible;

    fn encoder(&self) -> Copies {
        Copies
    }

    fn write(&mut self, piece: Piece, piece_taken: Owned) -> Result<(), Infallible> {
        match (piece, piece_taken) {
            (Piece::Curves(number), Owned::Curves(plane)) => {
                self.0.curves[number as usize] = plane;
            }
            (Piece::Best(number), Owned::Best(best)) => self.0.best[number as usize] = best,
            (Piece::Tile(number), Owned::Tile(tile)) => self.0.put_tile(number as usize, &tile),
            // The contents always match the kind of piece.
            _ => {}
        }
        Ok(())
    }
}
