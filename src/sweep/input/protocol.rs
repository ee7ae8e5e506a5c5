//! The protocol of a sweep that stands for itself; those of motions are in
//! [`crate::sweep::cells::vc`].

/// What a critical velocity is the answer to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Protocol {
    /// Coulomb friction and load control as τ → 0: the closed form of [`crate::critical::limit`].
    Limit,
}

impl Protocol {
    /// The name in sweep files and maps.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Limit => "limit",
        }
    }
}
