//! The group of crossing curves and curves of degrees of stability: CF contiguous ragged arrays,
//! plane after plane.

use super::curve_column::{BoundaryColumn, CORNER, Column, Named, Per};
use super::curve_rows::CurveRows;
use super::curve_words::{DIRECTION, STABLE_SIDE, direction_along, stable_sides};
use super::group_names::names_of_axes;
use super::schema::{BOUNDARIES, PARAMETER, PLANE};
use super::{Attribute, DIMENSIONS, Dimension, Element, Group, Variable, about, attribute, flags};
use crate::setting::quantity::Quantity;
use crate::sweep::plan::Plan;

/// The dimensions of the group, in the order of [`Per`].
pub(super) fn dimensions() -> [Dimension; 3] {
    Per::ALL.map(|per| Dimension {
        group: BOUNDARIES,
        name: per.name().to_owned(),
        length: None,
        coordinates: false,
    })
}

/// Columns in the order of the group: those of the axes outside the planes follow the other columns
/// of curves, and of corners.
fn in_order<T>(
    columns: Vec<(&BoundaryColumn, T)>,
    of_curves: impl Iterator<Item = T>,
    of_corners: impl Iterator<Item = T>,
) -> Vec<T> {
    let (curves, others): (Vec<_>, Vec<_>) = columns
        .into_iter()
        .partition(|(about, _)| about.per == Per::Curve);
    let own = |(_, column)| column;
    let curves = curves.into_iter().map(own).chain(of_curves);
    curves
        .chain(others.into_iter().map(own))
        .chain(of_corners)
        .collect()
}

/// A parameter and its name in the group.
struct Held<'p>(&'p Quantity, String);

/// The planes of a sweep, and where their dimensions begin.
struct Planes<'p> {
    plan: &'p Plan,
    parameter: Held<'p>,
    second: Held<'p>,
    first_dimension: usize,
}

impl Planes<'_> {
    fn variable(
        &self,
        per: Per,
        name: &str,
        element: Element,
        (long_name, unit): (&str, &str),
    ) -> Variable {
        let dimensions = vec![self.first_dimension + per as usize];
        let [long_name, unit] = about(long_name, unit);
        Variable {
            attributes: vec![long_name, unit, DIMENSIONS],
            ..Variable::computed(name, element, dimensions)
        }
    }

    fn of_parameter(&self, per: Per, prefix: &str, Held(parameter, name): &Held) -> Variable {
        let unit = parameter.unit(&self.plan.spec.units);
        let about = (parameter.long_name(), &*unit);
        let mut variable = self.variable(per, &format!("{prefix}{name}"), Element::F64, about);
        if name != parameter.name() {
            variable
                .attributes
                .push(attribute(PARAMETER, parameter.name()));
        }
        variable
    }

    fn column(&self, about: &BoundaryColumn, element: Element) -> Variable {
        let units = &self.plan.spec.units;
        let own = |name, meaning: &str, unit: &str| {
            self.variable(about.per, name, element, (meaning, unit))
        };
        let mut variable = match about.named {
            Named::Number(name @ DIRECTION, _) => own(name, &direction_along(self.second.0), "1"),
            Named::Number(name, meaning) => own(name, meaning, "1"),
            Named::Frequency(name, meaning) => own(name, meaning, &units.angular_frequency()),
            Named::Rate(name, meaning) => own(name, meaning, &units.rate()),
            Named::Parameter(prefix) => self.of_parameter(about.per, prefix, &self.parameter),
            Named::Second(prefix) => self.of_parameter(about.per, prefix, &self.second),
        };
        variable.attributes.extend(self.kinds(about));
        variable
    }

    /// What the numbers of a column count or stand for.
    fn kinds(&self, about: &BoundaryColumn) -> Vec<Attribute> {
        let counted = about.counts.map(|of| attribute("sample_dimension", of));
        let kinds = about.flags.map(|(values, meanings)| {
            let sides = stable_sides([self.parameter.0, self.second.0]);
            let of_side = matches!(about.named, Named::Number(STABLE_SIDE, _));
            flags(values, if of_side { &sides } else { meanings })
        });
        counted
            .into_iter()
            .chain(kinds.into_iter().flatten())
            .collect()
    }
}

/// The group for the planes of `plan` spanned by the axes `p` and `q`.
pub(super) fn group(plan: &Plan, (p, q): (usize, usize), first_dimension: usize) -> Group {
    let axes = plan.spec.axes.iter().map(|axis| &axis.parameter);
    let names: Vec<&str> = axes.clone().map(Quantity::name).collect();
    let names = names_of_axes(&names).into_iter();
    let mut held: Vec<Held> = axes.zip(names).map(|(of, name)| Held(of, name)).collect();
    let (latest, first) = (p.max(q), p.min(q));
    let (latest, first) = (held.remove(latest), held.remove(first));
    let (parameter, second) = match p < q {
        true => (first, latest),
        false => (latest, first),
    };
    let plane = format!("{} {}", parameter.0.name(), second.0.name());
    let planes = Planes {
        plan,
        parameter,
        second,
        first_dimension,
    };
    let rows = CurveRows::default();
    let columns = rows.columns().into_iter();
    let columns = columns.map(|(about, column)| (about, planes.column(about, column.element())));
    let outer = |per, prefix| {
        let planes = &planes;
        let of = move |held: &Held| planes.of_parameter(per, prefix, held);
        held.iter().map(of)
    };
    let title = "exact crossing curves: where characteristic roots lie on the imaginary axis; and \
                 boundaries of degrees of stability";
    Group {
        name: BOUNDARIES,
        attributes: vec![attribute("title", title), attribute(PLANE, plane)],
        variables: in_order(
            columns.collect(),
            outer(Per::Curve, ""),
            outer(Per::Corner, CORNER),
        ),
    }
}

/// The curves of some planes, with the values of the axes outside the planes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CurveTable {
    rows: CurveRows,
    /// A column for each axis outside the planes.
    of_curves: Vec<Vec<f64>>,
    of_corners: Vec<Vec<f64>>,
}

impl CurveTable {
    /// An empty table for planes of `plan`.
    #[must_use]
    pub(crate) fn new(plan: &Plan) -> Self {
        let outer = outer_values(plan, &vec![0; plan.spec.axes.len()]).len();
        Self {
            rows: CurveRows::default(),
            of_curves: vec![Vec::new(); outer],
            of_corners: vec![Vec::new(); outer],
        }
    }

    /// Appends the curves of the next plane, which lies at the values `outer` of the axes outside
    /// of it.
    pub(crate) fn append(&mut self, rows: &CurveRows, outer: &[f64]) {
        self.rows.extend(rows);
        let columns = self.of_curves.iter_mut().zip(&mut self.of_corners);
        for ((of_curves, of_corners), &value) in columns.zip(outer) {
            of_curves.extend(std::iter::repeat_n(value, rows.curves()));
            of_corners.extend(std::iter::repeat_n(value, rows.corners()));
        }
    }

    /// Removes all rows.
    pub(crate) fn clear(&mut self) {
        self.rows.clear();
        let columns = self.of_curves.iter_mut().chain(&mut self.of_corners);
        columns.for_each(Vec::clear);
    }

    /// The length of each dimension, in the order of [`Per`].
    #[must_use]
    pub(crate) fn lengths(&self) -> [usize; 3] {
        let rows = &self.rows;
        [rows.curves(), rows.vertices(), rows.corners()]
    }

    /// The columns, in the order of the variables of the group.
    #[must_use]
    pub(crate) fn columns(&self) -> Vec<Column<'_>> {
        in_order(
            self.rows.columns(),
            self.of_curves.iter().map(Column::from),
            self.of_corners.iter().map(Column::from),
        )
    }
}

/// The values of the axes outside the planes of curves, for the plane at `index`.
pub(crate) fn outer_values(plan: &Plan, index: &[usize]) -> Vec<f64> {
    let (p, tau) = plan.boundary_plane.unwrap_or((usize::MAX, usize::MAX));
    let axes = plan.spec.axes.iter().zip(index).enumerate();
    axes.filter(|&(axis, _)| axis != p && axis != tau)
        .map(|(_, (axis, &i))| axis.values[i])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::Described;
    use super::super::curve_words::CURVE_KINDS;
    use super::super::root::Provenance;
    use super::*;
    use crate::setting::spec::SweepSpec;

    /// Without the delay in the plane the words of the map name both parameters.
    #[test]
    fn sides_are_told_by_the_parameters_of_the_plane() {
        for (axes, sides, grows) in [
            (
                "alpha_n = [-1, 0]\nalpha_v = [-1, 0]\n[fixed]\ntau = 1\nmu_prime = -0.3\n",
                "smaller_alpha_n smaller_alpha_v neither larger_alpha_v larger_alpha_n",
                "how a pair of roots crosses with growing alpha_v",
            ),
            (
                "alpha_n = [-1, 0]\ntau = [1, 2]\n[fixed]\nmu_prime = -0.3\n",
                "smaller_parameter shorter_delays neither longer_delays larger_parameter",
                "how a pair of roots crosses with growing delay",
            ),
        ] {
            let sweep = format!("boundaries = true\n[axes]\n{axes}");
            let plan = Plan::new(sweep.parse::<SweepSpec>().unwrap()).unwrap();
            let map = Described::of_map(&plan, &Provenance::default());
            let group = map.group(BOUNDARIES).unwrap();
            let said = |name: &str, attribute| group.variable(name).unwrap().text(attribute);
            assert_eq!(said("stable_side", "flag_meanings"), Some(sides));
            assert_eq!(said("direction", "long_name"), Some(grows));
            assert_eq!(said("kind", "flag_meanings"), Some(CURVE_KINDS));
        }
    }
}
