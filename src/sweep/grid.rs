//! A sweep computed into memory: for programs that want numbers and no file.

use std::convert::Infallible;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::cells::best::BestSettings;
use super::cells::boundaries::BoundaryPlane;
use super::cells::buffers::TileBuffers;
use super::engine::{self, Computed, Encode, RunError, Sink};
use super::events::Silent;
use super::plan::Plan;
use super::plan::pieces::{Piece, Todo};
use super::plan::tile::for_each_index;

/// All values of a sweep in memory.
///
/// ```
/// use std::sync::Arc;
/// use slipmap::sweep::grid::Grid;
/// use slipmap::sweep::{Plan, SweepSpec};
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
/// let grid = Grid::compute(&plan, 1)?;
/// // Row by row, the last axis fastest: without control both roots are unstable at every delay.
/// assert_eq!(grid.cells.n_unstable.as_deref().unwrap()[9..], [2; 9]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Grid {
    plan: Arc<Plan>,
    /// The cells of the whole map in the order of its axes, the last one fastest.
    pub cells: TileBuffers,
    /// The crossing curves, plane by plane.
    pub curves: Vec<BoundaryPlane>,
    /// The best settings, plane by plane; none where a parameter is outside the model's range.
    pub best: Vec<Option<BestSettings>>,
}

impl Grid {
    /// Computes all of `plan` on `threads` threads. It takes the memory of all cells at once, which
    /// for large sweeps is more than there is.
    ///
    /// # Errors
    /// When a parameter is outside the model's range, or the threads cannot be started.
    pub fn compute(plan: &Arc<Plan>, threads: usize) -> Result<Self, RunError<Infallible>> {
        let planes = |count: u64| usize::try_from(count).unwrap_or(usize::MAX);
        let mut taken = Taken {
            cells: TileBuffers::of_cells(plan, planes(plan.cells())),
            curves: vec![None; planes(plan.boundary_planes())],
            best: vec![None; planes(plan.best_planes())],
            plan: Arc::clone(plan),
        };
        let (todo, stop) = (Todo::all(plan.pieces()), Arc::new(AtomicBool::new(false)));
        engine::run(plan, todo, threads, &mut taken, &Silent, &stop)?;
        Ok(Self {
            plan: taken.plan,
            cells: taken.cells,
            curves: taken.curves.into_iter().flatten().collect(),
            best: taken.best,
        })
    }

    /// The sweep.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }
}

/// What has come so far.
struct Taken {
    plan: Arc<Plan>,
    cells: TileBuffers,
    curves: Vec<Option<BoundaryPlane>>,
    best: Vec<Option<BestSettings>>,
}

/// Pieces as they are computed, to be handed to another thread.
struct Copies;

/// A piece that belongs to itself.
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

impl Sink for Taken {
    type Encoder = Copies;
    type Error = Infallible;

    fn encoder(&self) -> Copies {
        Copies
    }

    fn write(&mut self, piece: Piece, piece_taken: Owned) -> Result<(), Infallible> {
        match (piece, piece_taken) {
            (Piece::Curves(number), Owned::Curves(plane)) => {
                self.curves[number as usize] = Some(plane);
            }
            (Piece::Best(number), Owned::Best(best)) => self.best[number as usize] = best,
            (Piece::Tile(number), Owned::Tile(tile)) => self.put_tile(number as usize, &tile),
            // Each kind of piece is computed as such.
            _ => {}
        }
        Ok(())
    }
}

impl Taken {
    fn put_tile(&mut self, number: usize, from: &TileBuffers) {
        let tiles = &self.plan.tiles;
        let (tile, strides) = (tiles.tile(number), tiles.strides());
        for_each_index(&tile.extent, None, |inside| {
            let place = inside.iter().zip(&strides).map(|(i, stride)| i * stride);
            let place = place.sum();
            let index = tile.offset.iter().zip(inside).map(|(o, i)| o + i);
            let at = (index.zip(tiles.shape())).fold(0, |at, (i, &length)| at * length + i);
            self.cells.take_cell(at, from, place);
        });
    }
}
