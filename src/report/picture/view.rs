//! The part of a map that is shown: the axes of the plane, and the values along the others.

use super::error::PictureError;
use super::speed;
use super::text::{Rich, assignment};
use crate::meaning::first;
use crate::setting::Parameter;
use crate::setting::axis::nearest;
use crate::setting::quantity::Quantity;
use crate::setting::units::Units;
use crate::store::MapFile;
use crate::store::map_file::MapAxis;

/// The most panels, or colours, that can be told apart.
pub(super) const MOST_PANELS: usize = 12;

/// The part of a map that a picture shows.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct View {
    /// Axis from left to right.
    pub x: usize,
    /// The axis from bottom to top; none in a picture along one axis.
    pub y: Option<usize>,
    /// The axis along which the panels differ; none for a single one.
    pub along: Option<usize>,
    /// For each panel an index along every axis; 0 along the plane's.
    pub panels: Vec<Vec<usize>>,
    /// How many panels there would be without the limit.
    pub of: usize,
}

/// Requested values along one axis, as indices.
type Asked = Option<Vec<usize>>;

impl View {
    /// The view of `map` at the values `at`, each replaced by the nearest one on its axis.
    pub(super) fn new(map: &MapFile, at: &[(Quantity, f64)]) -> Result<Self, PictureError> {
        let asked = asked(map, at)?;
        let free: Vec<usize> = (0..map.axes().len())
            .filter(|&a| asked[a].is_none() && map.axes()[a].values.len() > 1)
            .collect();
        let axes = first::Axes {
            free: &free,
            boundary: map.boundary_plane(),
            is_delay: &|a| map.axes()[a].parameter == Parameter::Tau,
            is_speed: &|a| speed::is_shown(map, &map.axes()[a]),
        };
        let (x, y) = axes.plane().ok_or(PictureError::NothingToDraw)?;
        let outside = |a: &usize| *a != x && Some(*a) != y;
        let several = several(map, &asked)?;
        let along = several.or_else(|| free.iter().copied().find(outside));
        // A line plot shows one line unless several are requested.
        let along = along.filter(|_| y.is_some() || several.is_some());
        let all: Vec<usize> = match along {
            Some(axis) => match &asked[axis] {
                Some(indices) => indices.clone(),
                None => (0..map.axes()[axis].values.len()).collect(),
            },
            None => vec![0],
        };
        let held: Vec<usize> = (0..map.axes().len())
            .map(|a| match &asked[a] {
                Some(indices) => indices.first().copied().unwrap_or(0),
                None if outside(&a) => map.axes()[a].values.len() / 2,
                None => 0,
            })
            .collect();
        let of = all.len();
        let panels = evenly(&all, MOST_PANELS)
            .into_iter()
            .map(|i| {
                let mut index = held.clone();
                if let Some(axis) = along {
                    index[axis] = i;
                }
                index
            })
            .collect();
        Ok(Self {
            x,
            y,
            along: along.filter(|_| of > 1),
            panels,
            of,
        })
    }

    /// True if this is the plane of the map's crossing curves.
    pub(super) fn is_boundary_plane(&self, map: &MapFile) -> bool {
        let upright = |y: usize| map.boundary_plane() == Some((self.x, y));
        self.y.is_some_and(upright) || self.is_turned(map)
    }

    /// Whether this is the plane of the curves with their second parameter from left to right.
    pub(super) fn is_turned(&self, map: &MapFile) -> bool {
        self.y
            .is_some_and(|y| map.boundary_plane() == Some((y, self.x)))
    }

    /// Number of axes outside the plane along which the map varies.
    pub(super) fn outer_axes(&self, map: &MapFile) -> usize {
        (0..map.axes().len())
            .filter(|&a| a != self.x && Some(a) != self.y && map.axes()[a].values.len() > 1)
            .count()
    }

    /// The values of the axes outside the plane in a panel, in the order of the axes.
    pub(super) fn outer_values(&self, map: &MapFile, panel: &[usize]) -> Vec<f64> {
        (0..map.axes().len())
            .filter(|&a| a != self.x && Some(a) != self.y)
            .map(|a| map.axes()[a].values[panel[a]])
            .collect()
    }

    /// Whether a panel shows the plane at these values of the axes outside it.
    pub(super) fn shows(&self, map: &MapFile, outer: &[f64]) -> bool {
        let mut panels = self.panels.iter();
        panels.any(|panel| self.outer_values(map, panel) == outer)
    }

    /// What distinguishes a panel from the others, "μ′ = −0.3"; none for a single panel.
    pub(super) fn heading(&self, map: &MapFile, panel: &[usize]) -> Option<Rich> {
        let axis = self.along?;
        let MapAxis {
            parameter,
            unit,
            values,
        } = &map.axes()[axis];
        Some(assignment(parameter, values[panel[axis]], unit))
    }

    /// The common values of all panels, and how many panels are left out.
    pub(super) fn notes(&self, map: &MapFile) -> Vec<Rich> {
        let mut notes = Vec::new();
        if let Some(axis) = self.along.filter(|_| self.of > self.panels.len()) {
            let text = format!("{} of {} values of ", self.panels.len(), self.of);
            notes.push(Rich::plain(&text).and_symbol(&map.axes()[axis].parameter));
        }
        for (a, axis) in map.axes().iter().enumerate() {
            if a != self.x && Some(a) != self.y && Some(a) != self.along {
                let value = self.panels.first().map_or(0, |panel| panel[a]);
                notes.push(assignment(&axis.parameter, axis.values[value], &axis.unit));
            }
        }
        let units = map.units();
        for (parameter, value) in map.scalars() {
            if first::is_told(&parameter, value) {
                notes.push(assignment(&parameter, value, &parameter.unit(&units)));
            }
        }
        if units == Units::default() {
            notes.push(Rich::plain("dimensionless"));
        }
        notes
    }
}

fn asked(map: &MapFile, at: &[(Quantity, f64)]) -> Result<Vec<Asked>, PictureError> {
    let mut asked: Vec<Asked> = vec![None; map.axes().len()];
    for (parameter, value) in at {
        let (parameter, value) = (parameter.clone(), *value);
        let found = map.axes().iter().position(|a| a.parameter == parameter);
        let Some(axis) = found else {
            let names: Vec<&str> = map.axes().iter().map(|a| a.parameter.name()).collect();
            return Err(PictureError::NotAnAxis {
                parameter,
                axes: names.join(", "),
            });
        };
        let index = nearest(&map.axes()[axis].values, value);
        let index = index.map_err(|[from, to]| PictureError::OutsideAxis {
            parameter,
            value,
            from,
            to,
        })?;
        let indices = asked[axis].get_or_insert_default();
        if !indices.contains(&index) {
            indices.push(index);
            indices.sort_unstable();
        }
    }
    Ok(asked)
}

/// The axis for which several values are requested.
fn several(map: &MapFile, asked: &[Asked]) -> Result<Option<usize>, PictureError> {
    let has_several = |a: &usize| asked[*a].as_ref().is_some_and(|i| i.len() > 1);
    let mut axes = (0..asked.len()).filter(has_several);
    let first = axes.next();
    if let (Some(first), Some(second)) = (first, axes.next()) {
        return Err(PictureError::SeveralValues {
            first: map.axes()[first].parameter.clone(),
            second: map.axes()[second].parameter.clone(),
        });
    }
    Ok(first)
}

/// At most `most` of `all`, evenly spread, both ends among them.
fn evenly(all: &[usize], most: usize) -> Vec<usize> {
    if all.len() <= most {
        return all.to_vec();
    }
    let last = all.len() - 1;
    (0..most)
        .map(|i| all[(i * last + (most - 1) / 2) / (most - 1)])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_are_spread_evenly_with_both_ends() {
        let all: Vec<usize> = (0..40).collect();
        let some = evenly(&all, 12);
        assert_eq!((some.len(), some[0], some[11]), (12, 0, 39));
        assert!(some.windows(2).all(|w| (3..=4).contains(&(w[1] - w[0]))));
        assert_eq!(evenly(&all[..5], 12), [0, 1, 2, 3, 4]);
    }
}
