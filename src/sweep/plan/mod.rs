//! The plan of a sweep: its cells, cut into tiles.
//!
//! - `memory`: bounds on the memory of a run, and how many threads they allow
//! - `pieces`: the pieces of a sweep, its shards, and what is still to be computed
//! - `planes_of_curves`: the planes in which crossing curves are traced, or why there are none
//! - `tile`: rectangular blocks of cells
//! - `tile_size`: the size of tiles, and where lines may be cut

pub(crate) mod memory;
pub mod pieces;
pub mod planes_of_curves;
pub mod tile;
mod tile_size;

use std::borrow::Cow;

use sha2::{Digest, Sha256};

use self::pieces::{Piece, Pieces};
use self::planes_of_curves::NoBoundaries;
use self::tile::{Tile, TileGrid};
pub use self::tile_size::BLOCK_OF_DELAYS;
use self::tile_size::{block, cells_per_tile, shared_along, tile_shape, timed_part};
use crate::critical::switch_on::Phase;
use crate::model::table::TableColumn;
use crate::setting::axis::Axis;
use crate::setting::basin::Basin;
use crate::setting::best_plane::gain_plane;
use crate::setting::law_kind::LawKind;
use crate::setting::parameter::Parameter;
use crate::setting::search::Protocol;
use crate::setting::spec::SweepSpec;
use crate::setting::values::Setting;
use crate::text::{SpecError, in_hexadecimal};

/// The most cells of a map.
pub const MOST_CELLS: u64 = 10_000_000_000_000;
/// The most tiles of a map: the lists of finished tiles and their places then take a quarter of a
/// gigabyte.
pub const MOST_TILES: usize = 1 << 21;
/// The most planes of curves and of best settings.
const MOST_PLANES: u64 = 1_000_000;

/// A sweep ready to run.
///
/// ```
/// use slipmap::setting::SweepSpec;
/// use slipmap::sweep::Plan;
///
/// let sweep: SweepSpec = "
/// fields = [\"n_unstable\"]
/// [axes]
/// alpha_v = { from = -1.0, to = 1.0, points = 21 }
/// tau = { from = 0.0, to = 10.0, points = 101 }
/// [fixed]
/// mu_prime = -0.3
/// ".parse()?;
/// let plan = Plan::new(sweep)?;
/// assert_eq!(plan.cells(), 21 * 101);
/// # Ok::<(), slipmap::text::SpecError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Plan {
    /// The sweep file's content.
    pub spec: SweepSpec,
    /// How the cells are cut into tiles.
    pub tiles: TileGrid,
    /// The axis of delays, if the delay is one.
    pub tau_axis: Option<usize>,
    /// The axis along which what takes longest in a cell does not change: v0 beside critical
    /// velocities. Tiles keep it together, and lines that differ along it alone follow one another.
    pub(crate) shared_axis: Option<usize>,
    /// The axes of the planes in which crossing curves are traced: (parameter, delay).
    pub boundary_plane: Option<(usize, usize)>,
}

impl Plan {
    /// Plans a sweep.
    ///
    /// # Errors
    /// When there are more cells than any machine could hold.
    pub fn new(spec: SweepSpec) -> Result<Self, SpecError> {
        let cells = cells_per_tile(&spec);
        Self::with_tiles_of(cells, spec)
    }

    /// Plans a sweep with tiles of about `cells_per_tile` cells. No value in the map depends on
    /// this size.
    ///
    /// # Errors
    /// As [`Plan::new`].
    pub fn with_tiles_of(cells_per_tile: usize, spec: SweepSpec) -> Result<Self, SpecError> {
        let shape: Vec<usize> = spec.axes.iter().map(Axis::len).collect();
        let cells = shape
            .iter()
            .try_fold(1_u64, |n, &len| n.checked_mul(len as u64))
            .filter(|&n| n <= MOST_CELLS);
        if cells.is_none() {
            let sizes: Vec<String> = shape.iter().map(ToString::to_string).collect();
            return Err(SpecError::whole(format!(
                "the map would have {} cells; at most {MOST_CELLS} are allowed",
                sizes.join(" × ")
            )));
        }
        let tau_axis = spec
            .axes
            .iter()
            .position(|axis| axis.parameter == Parameter::Tau);
        let shared_axis = shared_axis(&spec);
        let block = block(&spec);
        let tile = match shared_axis {
            Some(axis) => shared_along(axis, &shape, tau_axis, block, cells_per_tile),
            None => tile_shape(&shape, tau_axis, block, cells_per_tile),
        };
        let boundary_plane = planes_of_curves::of(&spec).ok();
        let tiles = TileGrid::new(shape, tile);
        if tiles.len() > MOST_TILES {
            return Err(SpecError::whole(format!(
                "the map would be cut into {} tiles of {} cells; at most {MOST_TILES} are allowed: \
                split the sweep",
                tiles.len(),
                tiles.tile_cells(),
            )));
        }
        let plan = Self {
            spec,
            tiles,
            tau_axis,
            shared_axis,
            boundary_plane,
        };
        let planes = plan.boundary_planes() + plan.best_planes();
        if planes > MOST_PLANES {
            return Err(SpecError::whole(format!(
                "curves or best settings in {planes} planes; at most {MOST_PLANES} are allowed: \
                leave out boundaries, degree_of_stability and best, or split the sweep"
            )));
        }
        Ok(plan)
    }

    /// The tiles of this shape, if these are how the map is cut, or how versions cut it that did
    /// not keep the axis v0 of critical velocities together.
    #[must_use]
    pub(crate) fn cut_into(&self, tile: &[usize]) -> Option<Cow<'_, TileGrid>> {
        if self.tiles.tile_shape() == tile {
            return Some(Cow::Borrowed(&self.tiles));
        }
        self.shared_axis?;
        let (shape, cells) = (self.shape(), cells_per_tile(&self.spec));
        let before = tile_shape(shape, self.tau_axis, block(&self.spec), cells);
        (before == tile).then(|| Cow::Owned(TileGrid::new(shape.to_vec(), before)))
    }

    /// The parts in which a sample of the cells is timed, each by the code of a whole tile.
    #[must_use]
    pub(crate) fn timed_parts(&self) -> TileGrid {
        let whole = [self.tau_axis, self.shared_axis];
        let part = timed_part(self.spec.cost(), self.tiles.tile_shape(), whole);
        TileGrid::new(self.shape().to_vec(), part)
    }

    /// Length of each axis, in the order of the map's dimensions.
    #[must_use]
    pub fn shape(&self) -> &[usize] {
        self.tiles.shape()
    }

    /// Number of cells.
    #[must_use]
    pub fn cells(&self) -> u64 {
        self.shape().iter().map(|&n| n as u64).product()
    }

    /// Number of cells of a piece; 0 unless it is a tile.
    #[must_use]
    pub fn cells_of(&self, piece: Piece) -> u64 {
        match piece {
            Piece::Tile(number) => self.tiles.cells_of(number),
            Piece::Curves(_) | Piece::Best(_) => 0,
        }
    }

    /// Uncompressed bytes of a cell, the status included.
    #[must_use]
    pub fn bytes_per_cell(&self) -> u64 {
        let fields: usize = self.spec.fields.iter().map(|f| f.bytes()).sum();
        (fields + size_of::<u8>()) as u64
    }

    /// The pieces of the sweep.
    #[must_use]
    pub fn pieces(&self) -> Pieces {
        Pieces {
            curves: self.boundary_planes(),
            best: self.best_planes(),
            tiles: self.tiles.len() as u64,
        }
    }

    /// Number of planes in which crossing curves are traced.
    #[must_use]
    pub fn boundary_planes(&self) -> u64 {
        match self.boundary_plane {
            Some((p, tau)) => {
                let of_plane = self.shape()[p] as u64 * self.shape()[tau] as u64;
                self.cells() / of_plane
            }
            None => 0,
        }
    }

    /// Whether crossing curves are traced, and walked step by step instead of by the closed form.
    #[must_use]
    pub fn walks_boundaries(&self) -> bool {
        let plane = self.boundary_plane;
        plane.is_some_and(|(_, q)| !planes_of_curves::traced_by_closed_form(&self.spec, q))
    }

    /// Why no crossing curves are traced; none where they are.
    #[must_use]
    pub fn no_boundaries(&self) -> Option<NoBoundaries> {
        planes_of_curves::of(&self.spec).err()
    }

    /// Number of planes in which the best setting is searched for.
    #[must_use]
    pub fn best_planes(&self) -> u64 {
        match self.best_plane() {
            Some((gain, tau)) => {
                self.cells() / (self.shape()[gain] as u64 * self.shape()[tau] as u64)
            }
            None => 0,
        }
    }

    /// The axes (gain, delay) of the planes in which the best setting is searched for; none without
    /// this search.
    #[must_use]
    pub fn best_plane(&self) -> Option<(usize, usize)> {
        gain_plane(&self.spec.axes).filter(|_| self.spec.best)
    }

    /// The parameters of the cell at `index`, one index per axis.
    #[must_use]
    pub fn setting(&self, index: &[usize]) -> Setting {
        let mut setting = self.spec.fixed.clone();
        for (axis, &i) in self.spec.axes.iter().zip(index) {
            setting.vary(&axis.parameter, axis.values[i]);
        }
        setting
    }

    /// The delays of the sweep in `range`, or the one fixed delay.
    #[must_use]
    pub fn delays(&self, range: std::ops::Range<usize>) -> Vec<f64> {
        match self.tau_axis {
            Some(axis) => self.spec.axes[axis].values[range].to_vec(),
            None => vec![self.spec.fixed.get(Parameter::Tau)],
        }
    }

    /// The delay of the cell at `index`.
    #[must_use]
    pub fn delay(&self, index: &[usize]) -> f64 {
        self.setting(index).get(Parameter::Tau)
    }

    /// The part of the delays that `tile` covers, as indices.
    #[must_use]
    pub fn delay_range(&self, tile: &Tile) -> std::ops::Range<usize> {
        match self.tau_axis {
            Some(axis) => tile.offset[axis]..tile.offset[axis] + tile.extent[axis],
            None => 0..1,
        }
    }

    /// Everything on which the cells depend: names, with their numbers. Equal plans have equal
    /// cells.
    fn facts(&self) -> Vec<(&str, Cow<'_, [f64]>)> {
        let spec = &self.spec;
        let fixed = &spec.fixed;
        let none = || Cow::Borrowed(&[][..]);
        let one = |value: f64| Cow::Owned(vec![value]);
        let mut facts = vec![(fixed.law().map_or("no law", LawKind::name), none())];
        if let Some(LawKind::Table(table)) = fixed.law() {
            facts.push((TableColumn::Speeds.name(), table.speeds().into()));
            facts.push((TableColumn::MuK.name(), table.mu_k().into()));
        }
        if let Some(formula) = fixed.formula() {
            let text = formula.text().bytes().map(f64::from).collect();
            facts.push((TableColumn::MuK.name(), text));
        }
        if let Some(system) = fixed.system() {
            let text = system.to_toml().into_bytes();
            facts.push(("system", text.into_iter().map(f64::from).collect()));
        }
        facts.push(("axes", one(spec.axes.len() as f64)));
        for axis in &spec.axes {
            facts.push((axis.parameter.name(), axis.values.as_slice().into()));
        }
        for parameter in Parameter::ALL.into_iter().filter(|&p| spec.uses(p)) {
            if !spec.axes.iter().any(|a| a.parameter == parameter) {
                facts.push((parameter.name(), one(fixed.get(parameter))));
            }
        }
        for (own, value) in fixed.own() {
            if !spec.axes.iter().any(|a| a.parameter.name() == own.name) {
                facts.push((&own.name, one(value)));
            }
        }
        facts.extend(spec.fields.iter().map(|f| (f.first_name(), none())));
        facts.push(("marginal", one(spec.tolerance.0)));
        facts.push(("boundaries", one(f64::from(self.boundary_plane.is_some()))));
        // Left out where empty: the hashes of earlier maps stay valid.
        if !spec.degrees_of_stability.is_empty() {
            let degrees = spec.degrees_of_stability.as_slice();
            facts.push(("degree_of_stability", degrees.into()));
        }
        if spec.best {
            facts.push(("best", none()));
        }
        if let Some(search) = spec.critical {
            let protocol = search.protocol;
            let phases = match protocol {
                Protocol::SwitchOn(Phase::Worst(phases)) => f64::from(phases),
                _ => 0.0,
            };
            facts.push((protocol.name(), vec![phases, search.verify].into()));
        }
        facts.extend(spec.basin.iter().flat_map(Basin::facts));
        if spec.follows_motions() || spec.basin.is_some() {
            facts.extend(spec.simulation.facts());
        }
        facts
    }

    /// A hash of everything on which the cells depend, in hexadecimal: equal plans have equal
    /// cells.
    #[must_use]
    pub fn hash(&self) -> String {
        let mut hash = Sha256::new();
        for (name, values) in self.facts() {
            hash.update((name.len() as u64).to_le_bytes());
            hash.update(name);
            put_numbers(&mut hash, &values);
        }
        in_hexadecimal(&hash.finalize())
    }

    /// The contents of the hash in words, to show where two plans differ: every name with its
    /// numbers, long lists as their ends and a hash.
    #[must_use]
    pub fn description(&self) -> Vec<(String, String)> {
        let described = |values: &[f64]| match values {
            [] => "yes".to_owned(),
            [one] => one.to_string(),
            [first, .., last] => {
                let mut hash = Sha256::new();
                put_numbers(&mut hash, values);
                let hash = in_hexadecimal(&hash.finalize());
                format!(
                    "{} numbers from {first} to {last}, #{}",
                    values.len(),
                    &hash[..8]
                )
            }
        };
        let facts = self.facts().into_iter();
        facts
            .map(|(name, values)| (name.to_owned(), described(&values)))
            .collect()
    }
}

/// The axis v0, if critical velocities are searched for.
fn shared_axis(spec: &SweepSpec) -> Option<usize> {
    spec.critical?;
    spec.axes.iter().position(|a| a.parameter == Parameter::V0)
}

fn put_numbers(hash: &mut Sha256, values: &[f64]) {
    hash.update((values.len() as u64).to_le_bytes());
    for value in values {
        hash.update(value.to_bits().to_le_bytes());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CRITICAL: &str = "fields = [\"vc\", \"n_unstable\"]\n[axes]\nv0 = [0.1, 0.2, 0.3]\n\
        tau = { from = 1, to = 9, points = 300 }\n[friction]\nlaw = \"coulomb\"\nmu0 = 0.5\n";

    /// Tiles keep all v0 of critical velocities together. Versions that did not are known by their
    /// tiles.
    #[test]
    fn an_axis_of_v0_is_shared_by_critical_velocities_alone() {
        let plan = |text: &str| Plan::new(text.parse::<SweepSpec>().unwrap()).unwrap();
        let critical = plan(CRITICAL);
        assert_eq!(critical.tiles.tile_shape(), [3, 128]);
        let tiles = |shape: &[usize]| critical.cut_into(shape).map(|tiles| tiles.len());
        assert_eq!(tiles(&[3, 128]), Some(3));
        assert_eq!(tiles(&[1, 128]), Some(9));
        assert_eq!(tiles(&[2, 128]), None);
        let counted = plan(&CRITICAL.replace("\"vc\", ", ""));
        assert_eq!(counted.shared_axis, None);
        assert!(counted.cut_into(&[1, 128]).is_none());
    }
}
