//! Reads the best settings of a map.

use hdf5::Group;

use super::error::StoreError;
use super::map_file::MapFile;
use super::open;
use super::values::{Number, whole};
use crate::linear::best::Kind;
use crate::setting::Parameter;
use crate::sweep::described::schema::{BEST, best as names};
use crate::sweep::plan::tile::index_of;

/// The best setting of one plane of a map, in the units of the map.
#[derive(Debug, Clone, PartialEq)]
pub struct MapBest {
    /// Values of the axes outside the plane, in the order of the map's axes.
    pub outer: Vec<f64>,
    /// The gain.
    pub gain: f64,
    /// The delay.
    pub tau: f64,
    /// The spectral abscissa.
    pub abscissa: f64,
    /// The lowest frequency among the rightmost roots.
    pub frequency: f64,
    /// −1/abscissa; none where the setting is not stable.
    pub relaxation_time: Option<f64>,
    /// Why it is the best; none where there was no search, and all numbers are then NaN.
    pub kind: Option<Kind>,
    /// Whether the argument principle confirms the abscissa.
    pub certified: bool,
    /// Number of stable regions of the plane, with those that are not told.
    pub regions: u64,
}

impl MapFile {
    /// The axes (gain, delay) of the planes whose best settings the map holds; none for a map
    /// without best settings.
    #[must_use]
    pub fn best_plane(&self) -> Option<(usize, usize)> {
        self.plane_of(BEST)
    }

    /// The best setting of every plane, in the order of the axes outside of it. Empty where the map
    /// holds none.
    ///
    /// # Errors
    /// When the file is damaged.
    pub fn best(&self) -> Result<Vec<MapBest>, StoreError> {
        let Some((gain, tau)) = self.best_plane() else {
            return Ok(Vec::new());
        };
        let outer: Vec<&[f64]> = (0..self.axes().len())
            .filter(|&axis| axis != gain && axis != tau)
            .map(|axis| self.axes()[axis].values.as_slice())
            .collect();
        let lengths: Vec<usize> = outer.iter().map(|values| values.len()).collect();
        let planes = lengths.iter().product();
        let read = || -> hdf5::Result<Vec<MapBest>> {
            let group = Columns {
                group: self.group(BEST)?,
                planes,
            };
            let gains = group.read::<f64>(self.axes()[gain].parameter.name())?;
            let taus = group.read::<f64>(Parameter::Tau.name())?;
            let abscissas = group.read::<f64>(names::ABSCISSA)?;
            let frequencies = group.read::<f64>(names::FREQUENCY)?;
            let times = group.read::<f64>(names::RELAXATION_TIME)?;
            let kinds = group.read::<i8>(names::KIND)?;
            let certified = group.read::<i8>(names::CERTIFIED)?;
            let regions = group.read::<i32>(names::REGIONS)?;
            let best = |i: usize| MapBest {
                outer: (index_of(i as u64, &lengths).into_iter().zip(&outer))
                    .map(|(at, values)| values[at])
                    .collect(),
                gain: gains[i],
                tau: taus[i],
                abscissa: abscissas[i],
                frequency: frequencies[i],
                relaxation_time: Some(times[i]).filter(|time| !time.is_nan()),
                kind: kind(kinds[i]),
                certified: certified[i] == 1,
                regions: regions[i].max(0) as u64,
            };
            Ok((0..planes).map(best).collect())
        };
        read().map_err(StoreError::hdf5("read the best settings of", self.path()))
    }
}

/// The group, with one value per plane in each variable.
struct Columns {
    group: Group,
    planes: usize,
}

impl Columns {
    fn read<T: Number>(&self, name: &str) -> hdf5::Result<Vec<T>> {
        let values = whole::<T>(&open::dataset(&self.group, name)?)?;
        if values.len() == self.planes {
            Ok(values)
        } else {
            Err(format!("{name} has not one value for each plane").into())
        }
    }
}

/// The kind with this number; none for the fill value.
fn kind(number: i8) -> Option<Kind> {
    let place = usize::try_from(number).ok()?;
    Kind::ALL.get(place).copied()
}
