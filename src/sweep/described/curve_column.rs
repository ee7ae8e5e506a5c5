//! What a column of the group of curves is called, what its numbers belong to, and the numbers.

use super::Element;

/// Stands before the name of a parameter where its values are those of corners.
pub(crate) const CORNER: &str = "corner_";

/// What each number of a column belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Per {
    /// One piece of a curve.
    Curve,
    /// A vertex of a piece. The vertices of all pieces follow one another.
    Vertex,
    /// A point where two curves cross.
    Corner,
}

impl Per {
    /// The dimensions of columns.
    pub(crate) const ALL: [Self; 3] = [Self::Curve, Self::Vertex, Self::Corner];

    /// The name of the dimension.
    #[must_use]
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Curve => "curve",
            Self::Vertex => "vertex",
            Self::Corner => "corner",
        }
    }
}

/// What a column is called, and the unit of its numbers.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Named {
    /// A number with this name and this meaning.
    Number(&'static str, &'static str),
    /// A frequency.
    Frequency(&'static str, &'static str),
    /// A rate of decay.
    Rate(&'static str, &'static str),
    /// The first parameter of the plane; its name follows this prefix.
    Parameter(&'static str),
    /// The second parameter of the plane, the delay where it is an axis; its name follows this
    /// prefix.
    Second(&'static str),
}

/// What a column is called, and what its numbers are.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BoundaryColumn {
    /// What each number belongs to.
    pub per: Per,
    /// Its name and unit.
    pub named: Named,
    /// Numbers that stand for kinds, and the words for them.
    pub flags: Option<(&'static [i8], &'static str)>,
    /// The dimension whose elements the column counts, see CF's contiguous ragged arrays.
    pub counts: Option<&'static str>,
    /// Maps of the first versions lack the column; it then counts as zero in all rows.
    pub optional: bool,
}

pub(super) const fn column(per: Per, named: Named) -> BoundaryColumn {
    BoundaryColumn {
        per,
        named,
        flags: None,
        counts: None,
        optional: false,
    }
}

/// The numbers of a column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Column<'a> {
    /// i8.
    I8(&'a [i8]),
    /// i32.
    I32(&'a [i32]),
    /// i64.
    I64(&'a [i64]),
    /// f64.
    F64(&'a [f64]),
}

/// The numbers of a column, to be filled.
#[derive(Debug, PartialEq)]
pub(crate) enum ColumnMut<'a> {
    /// i8.
    I8(&'a mut Vec<i8>),
    /// i32.
    I32(&'a mut Vec<i32>),
    /// i64.
    I64(&'a mut Vec<i64>),
    /// f64.
    F64(&'a mut Vec<f64>),
}

macro_rules! column_of {
    ($($kind:ty: $variant:ident),*) => {
        $(
            impl<'a> From<&'a Vec<$kind>> for Column<'a> {
                fn from(numbers: &'a Vec<$kind>) -> Self {
                    Self::$variant(numbers)
                }
            }

            impl<'a> From<&'a mut Vec<$kind>> for ColumnMut<'a> {
                fn from(numbers: &'a mut Vec<$kind>) -> Self {
                    Self::$variant(numbers)
                }
            }
        )*

        impl Column<'_> {
            /// The type of the numbers.
            #[must_use]
            pub(crate) fn element(self) -> Element {
                match self {
                    $(Self::$variant(_) => Element::$variant,)*
                }
            }

            /// How many there are.
            pub(super) fn len(self) -> usize {
                match self {
                    $(Self::$variant(numbers) => numbers.len(),)*
                }
            }
        }
    };
}
column_of!(i8: I8, i32: I32, i64: I64, f64: F64);

/// A column for the reference of map files: what its numbers belong to, its name, its meaning.
pub(crate) type DescribedColumn = (&'static str, String, String);

impl Named {
    /// Name and meaning of what is not a parameter.
    #[must_use]
    pub(crate) fn own(self) -> Option<(&'static str, &'static str)> {
        match self {
            Self::Number(name, meaning)
            | Self::Frequency(name, meaning)
            | Self::Rate(name, meaning) => Some((name, meaning)),
            Self::Parameter(_) | Self::Second(_) => None,
        }
    }
}

impl BoundaryColumn {
    /// The column for the reference.
    pub(super) fn described(&self) -> DescribedColumn {
        let (name, mut meaning) = match self.named {
            Named::Parameter(prefix) => (format!("{prefix}PARAMETER"), "the parameter".into()),
            Named::Second(prefix) => (
                format!("{prefix}SECOND"),
                "the second parameter, the delay in planes with it".into(),
            ),
            Named::Number(name, meaning)
            | Named::Frequency(name, meaning)
            | Named::Rate(name, meaning) => (name.to_owned(), meaning.to_owned()),
        };
        if let Some((values, words)) = self.flags {
            let words = values.iter().zip(words.split(' '));
            let words: Vec<_> = words
                .map(|(value, word)| format!("{value} {word}"))
                .collect();
            meaning = format!("{meaning}: {}", words.join(", "));
        }
        (self.per.name(), name, meaning)
    }
}
