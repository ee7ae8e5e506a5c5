//! The curves of a plane as columns of numbers, in the form in which tiles and the map hold them.

#[cfg(feature = "store")]
use serde::{Deserialize, Serialize};

use super::curve_column::{
    BoundaryColumn, CORNER, Column, ColumnMut, DescribedColumn, Named, Per, column,
};
use super::curve_words::{CURVE_KINDS, DIRECTION, DIRECTIONS, STABLE_SIDE, STABLE_SIDES};
use super::schema::{CORNER_DEGREE_OF_STABILITY, DEGREE_OF_STABILITY};
use crate::linear::curves::{Corner, CurvePiece};
use crate::sweep::cells::boundaries::BoundaryPlane;

macro_rules! boundary_columns {
    (
        $(#[$about:meta])*
        $Rows:ident { $($(#[$doc:meta])* $name:ident: $kind:ty = $row:expr;)+ }
    ) => {
        $(#[$about])*
        #[derive(Debug, Clone, Default, PartialEq)]
        #[cfg_attr(feature = "store", derive(Serialize, Deserialize))]
        pub struct $Rows {
            /// Whether some curves are left out because too many cross the plane.
            pub left_out: bool,
            $($(#[$doc])* pub $name: Vec<$kind>,)+
        }

        impl $Rows {
            /// All columns with what they are, in the order of the map.
            #[must_use]
            pub(crate) fn columns(&self) -> Vec<(&'static BoundaryColumn, Column<'_>)> {
                vec![$({
                    const ABOUT: &BoundaryColumn = &$row;
                    (ABOUT, Column::from(&self.$name))
                }),+]
            }

            /// All columns with what they are, to be filled.
            #[must_use]
            pub(crate) fn columns_mut(&mut self) -> Vec<(&'static BoundaryColumn, ColumnMut<'_>)> {
                vec![$({
                    const ABOUT: &BoundaryColumn = &$row;
                    (ABOUT, ColumnMut::from(&mut self.$name))
                }),+]
            }

            /// Appends the rows of `more`.
            pub(crate) fn extend(&mut self, more: &Self) {
                self.left_out |= more.left_out;
                $(self.$name.extend_from_slice(&more.$name);)+
            }

            /// Removes all rows.
            pub(crate) fn clear(&mut self) {
                $(self.$name.clear();)+
            }
        }
    };
}

boundary_columns! {
    /// The curves of one plane, column by column: one row per curve, per vertex and per corner.
    CurveRows {
        /// Per curve: number of vertices.
        vertex_count: i32 = BoundaryColumn {
            counts: Some(Per::Vertex.name()),
            ..column(Per::Curve, Named::Number("vertex_count", "number of vertices of the curve"))
        };
        /// Per curve: k.
        branch: i64 = column(
            Per::Curve,
            Named::Number("branch", "branch number k of the crossing delay"),
        );
        /// Per curve: −1, 0, 1.
        direction: i8 = BoundaryColumn {
            flags: Some((&[-1, 0, 1], DIRECTIONS)),
            ..column(
                Per::Curve,
                Named::Number(DIRECTION, "how a pair of roots crosses with growing SECOND"),
            )
        };
        /// Per curve: −1 shorter delays, 0 neither, 1 longer delays, ∓2 smaller and larger p.
        stable_side: i8 = BoundaryColumn {
            flags: Some((&[-2, -1, 0, 1, 2], STABLE_SIDES)),
            ..column(
                Per::Curve,
                Named::Number(
                    STABLE_SIDE,
                    "side of the curve on which sliding is stable, to its degree of stability",
                ),
            )
        };
        /// Per curve: σ.
        degree: f64 = BoundaryColumn {
            optional: true,
            ..column(
                Per::Curve,
                Named::Rate(
                    DEGREE_OF_STABILITY,
                    "degree of stability: roots on the curve have this real part, negated",
                ),
            )
        };
        /// Per curve: what lies on the line.
        kind: i8 = BoundaryColumn {
            flags: Some((&[0, 1, 2], CURVE_KINDS)),
            optional: true,
            ..column(
                Per::Curve,
                Named::Number(
                    "kind",
                    "what lies on the line along the curve: a pair of roots, a real root (at the \
                    origin, where the line is the imaginary axis), or the leading coefficient \
                    vanishes and roots come from infinity",
                ),
            )
        };
        /// Per vertex: the parameter.
        p: f64 = column(Per::Vertex, Named::Parameter(""));
        /// Per vertex: the delay, or another second parameter.
        q: f64 = column(Per::Vertex, Named::Second(""));
        /// Per vertex: the frequency.
        omega: f64 = column(Per::Vertex, Named::Frequency("omega", "crossing frequency"));
        /// Per corner: the parameter.
        corner_p: f64 = column(Per::Corner, Named::Parameter(CORNER));
        /// Per corner: the delay, or another second parameter.
        corner_q: f64 = column(Per::Corner, Named::Second(CORNER));
        /// Per corner: the larger frequency.
        corner_omega_upper: f64 = column(
            Per::Corner,
            Named::Frequency(
                "corner_omega_upper",
                "larger frequency; at degree of stability 0 the pair crosses to the right",
            ),
        );
        /// Per corner: the smaller frequency.
        corner_omega_lower: f64 = column(
            Per::Corner,
            Named::Frequency(
                "corner_omega_lower",
                "smaller frequency; at degree of stability 0 the pair crosses to the left",
            ),
        );
        /// Per corner: the branch of the pair with the larger frequency.
        corner_branch_upper: i64 = column(
            Per::Corner,
            Named::Number("corner_branch_upper", "branch of the pair with the larger frequency"),
        );
        /// Per corner: the branch of the other pair.
        corner_branch_lower: i64 = column(
            Per::Corner,
            Named::Number("corner_branch_lower", "branch of the pair with the smaller frequency"),
        );
        /// Per corner: 1 where the stable region has one.
        corner_stable: i8 = BoundaryColumn {
            flags: Some((&[0, 1], "no yes")),
            ..column(
                Per::Corner,
                Named::Number("corner_bounds_stable", "the stable region has a corner here"),
            )
        };
        /// Per corner: σ.
        corner_degree: f64 = column(
            Per::Corner,
            Named::Rate(
                CORNER_DEGREE_OF_STABILITY,
                "degree of stability of the curves that meet",
            ),
        );
    }
}

impl CurveRows {
    /// All columns in words.
    #[must_use]
    pub fn described() -> Vec<DescribedColumn> {
        let rows = Self::default();
        let columns = rows.columns().into_iter();
        columns.map(|(about, _)| about.described()).collect()
    }

    /// The rows of the curves of a plane.
    #[must_use]
    pub fn of(plane: &BoundaryPlane) -> Self {
        let mut rows = Self::default();
        for of in &plane.curves {
            let Ok(curves) = &of.curves else {
                rows.left_out = true;
                continue;
            };
            for piece in &curves.pieces {
                rows.push_piece(piece, of.degree_of_stability);
            }
            for corner in &curves.corners {
                rows.push_corner(corner, of.degree_of_stability);
            }
        }
        rows
    }

    fn push_piece(&mut self, piece: &CurvePiece, degree: f64) {
        self.degree.push(degree);
        self.vertex_count.push(piece.vertices.len() as i32);
        self.branch.push(piece.branch as i64);
        self.direction.push(piece.direction.sign());
        self.stable_side.push(piece.stable_side.sign());
        self.kind.push(piece.kind.number());
        for vertex in &piece.vertices {
            self.p.push(vertex.p);
            self.q.push(vertex.q);
            self.omega.push(vertex.omega);
        }
    }

    fn push_corner(&mut self, corner: &Corner, degree: f64) {
        let (upper, lower) = (corner.upper, corner.lower);
        self.corner_degree.push(degree);
        self.corner_p.push(corner.p);
        self.corner_q.push(corner.q);
        self.corner_omega_upper.push(upper.0);
        self.corner_omega_lower.push(lower.0);
        self.corner_branch_upper.push(upper.1 as i64);
        self.corner_branch_lower.push(lower.1 as i64);
        self.corner_stable.push(i8::from(corner.bounds_stable));
    }

    /// Number of vertices of all curves.
    #[must_use]
    pub(crate) fn vertices(&self) -> usize {
        self.p.len()
    }

    /// Number of curves.
    #[must_use]
    pub fn curves(&self) -> usize {
        self.vertex_count.len()
    }

    /// Number of corners.
    #[must_use]
    pub(crate) fn corners(&self) -> usize {
        self.corner_stable.len()
    }

    /// Whether the columns have the same lengths, and the curves as many vertices as they say.
    #[must_use]
    pub(crate) fn is_consistent(&self) -> bool {
        let vertices = self.vertex_count.iter().try_fold(0_usize, |sum, &n| {
            usize::try_from(n).ok().and_then(|n| sum.checked_add(n))
        });
        let (curves, corners) = (Some(self.curves()), Some(self.corners()));
        self.columns().into_iter().all(|(about, column)| {
            Some(column.len())
                == match about.per {
                    Per::Curve => curves,
                    Per::Vertex => vertices,
                    Per::Corner => corners,
                }
        })
    }
}
