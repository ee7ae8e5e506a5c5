//! What a map can hold for each cell.

/// A quantity computed for every cell. `status` comes with every map and is not listed here.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Field {
    /// Number of unstable roots.
    NUnstable,
    /// Signed distance in τ to the nearest change of stability.
    DelayMargin,
}

impl Field {
    /// All fields, in the order in which maps hold them.
    pub const ALL: [Self; 2] = [Self::NUnstable, Self::DelayMargin];

    /// The name in sweep files and maps.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::NUnstable => "n_unstable",
            Self::DelayMargin => "delay_margin",
        }
    }

    /// The field of that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|f| f.name() == name)
    }

    /// Bytes per cell, uncompressed.
    #[must_use]
    pub const fn bytes(self) -> usize {
        match self {
            Self::NUnstable => size_of::<u16>(),
            Self::DelayMargin => size_of::<f64>(),
        }
    }
}

/// The names of all fields, for messages.
#[must_use]
pub fn known_fields() -> String {
    Field::ALL.map(Field::name).join(", ")
}
