//! Which critical velocity a sweep asks for: its key `protocol`.

use super::toml_reader::{Entry, SpecError};

/// What a critical velocity is the answer to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Protocol {
    /// Coulomb friction and load control as τ → 0: the closed form of [`crate::critical::limit`].
    Limit,
}

impl Protocol {
    /// All protocols.
    pub const ALL: [Self; 1] = [Self::Limit];

    /// The name in sweep files and maps.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Limit => "limit",
        }
    }

    /// The protocol that `entry` names.
    pub(super) fn read(entry: &Entry) -> Result<Self, SpecError> {
        let name = entry.string()?;
        let found = Self::ALL.into_iter().find(|p| p.name() == name);
        found.ok_or_else(|| {
            entry
                .error(format!("unknown protocol \"{name}\""))
                .help(format!("known: {}", Self::ALL.map(Self::name).join(", ")))
        })
    }
}
