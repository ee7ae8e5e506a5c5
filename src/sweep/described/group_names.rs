//! Names of parameters in the group of curves. None is the name of anything else in the group,
//! whatever a system calls its parameters.

use std::collections::HashSet;

use super::curve_column::{CORNER, Per};
use super::curve_rows::CurveRows;

/// Stands before the name of a parameter that something else in the group has.
pub(crate) const PREFIX: &str = "parameter_";

/// Every name in the group of curves that is not of a parameter.
#[must_use]
pub fn other_names() -> Vec<&'static str> {
    let rows = CurveRows::default();
    let columns = rows.columns().into_iter();
    let own = columns.filter_map(|(about, _)| about.named.own().map(|(name, _)| name));
    Per::ALL.map(Per::name).into_iter().chain(own).collect()
}

/// The names of `axes` in the group of curves, in order. Each axis has one variable there, and one
/// with [`CORNER`] before its name. It keeps its own name where both are free; else [`PREFIX`]
/// stands before it, as often as needed.
pub(crate) fn names_of_axes(axes: &[&str]) -> Vec<String> {
    names_beside(other_names(), axes)
}

/// The names of `axes` in a group whose other variables are called `others`.
fn names_beside<'a>(others: impl IntoIterator<Item = &'a str>, axes: &[&str]) -> Vec<String> {
    let variables = |name: &str| [name.to_owned(), format!("{CORNER}{name}")];
    let mut taken: HashSet<String> = others.into_iter().map(str::to_owned).collect();
    let of_another = |name: &str| {
        let corner = name.strip_prefix(CORNER);
        corner.is_some_and(|corner| axes.contains(&corner))
    };
    let mut names = vec![None; axes.len()];
    for (name, axis) in names.iter_mut().zip(axes) {
        let own = variables(axis);
        if !of_another(axis) && !own.iter().any(|variable| taken.contains(variable)) {
            taken.extend(own);
            *name = Some((*axis).to_owned());
        }
    }
    for (name, axis) in names
        .iter_mut()
        .zip(axes)
        .filter(|(name, _)| name.is_none())
    {
        let mut other = format!("{PREFIX}{axis}");
        while variables(&other)
            .iter()
            .any(|variable| taken.contains(variable))
        {
            other.insert_str(0, PREFIX);
        }
        taken.extend(variables(&other));
        *name = Some(other);
    }
    names.into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn free_names_are_kept_and_others_are_told_apart() {
        let names = |axes: &[&str]| names_beside(["omega", "corner_k"], axes);
        assert_eq!(names(&["width", "tau"]), ["width", "tau"]);
        assert_eq!(names(&["omega", "tau"]), ["parameter_omega", "tau"]);
        assert_eq!(names(&["k", "tau"]), ["parameter_k", "tau"]);
        assert_eq!(names(&["corner_k"]), ["parameter_corner_k"]);
        assert_eq!(names(&["corner_x", "x"]), ["parameter_corner_x", "x"]);
        assert_eq!(
            names(&["omega", "parameter_omega", "corner_parameter_omega"]),
            [
                "parameter_parameter_omega",
                "parameter_omega",
                "parameter_corner_parameter_omega"
            ]
        );
    }
}
