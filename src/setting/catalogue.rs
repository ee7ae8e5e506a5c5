//! Enumerations with a table of facts, one row for each value.

/// Makes an enumeration with a row of facts for each of its values: `Name::ALL` has them in the
/// order of their rows, and `value.row()` is the row.
///
/// The row of a value stands beside its name, so that nothing about it has to be said elsewhere.
macro_rules! catalogue {
    (
        $(#[$about:meta])*
        pub enum $Name:ident: $Row:ty {
            $($(#[$doc:meta])* $Value:ident = $row:expr;)+
        }
    ) => {
        $(#[$about])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum $Name {
            $($(#[$doc])* $Value,)+
        }

        impl $Name {
            /// The rows of the table, in order.
            pub const ALL: [Self; [$(stringify!($Value)),+].len()] = [$(Self::$Value),+];

            const fn row(self) -> &'static $Row {
                const ROWS: &[$Row] = &[$($row),+];
                &ROWS[self as usize]
            }
        }
    };
}

pub(super) use catalogue;
