//! Colour maps: perceptually uniform, and distinguishable by the colour-blind.

use colorous::Gradient;

use super::colour::Rgb;

/// A colour map, with its name in matplotlib.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColourMap {
    /// Dark purple, teal, yellow.
    Viridis,
    /// Dark blue, grey, yellow.
    Cividis,
    /// Dark blue, pink, yellow.
    Plasma,
    /// Two sides: brown, white, teal.
    BrBG,
    /// Two sides: orange, white, purple.
    PuOr,
}

/// The share of each side of a two-sided map that is used: darker colours stand for values beyond
/// the ends.
const USED: f64 = 0.8;

impl ColourMap {
    /// All maps: those for sizes, then the two-sided ones.
    pub const ALL: [Self; 5] = [
        Self::Viridis,
        Self::Cividis,
        Self::Plasma,
        Self::BrBG,
        Self::PuOr,
    ];

    /// The name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Viridis => "viridis",
            Self::Cividis => "cividis",
            Self::Plasma => "plasma",
            Self::BrBG => "BrBG",
            Self::PuOr => "PuOr",
        }
    }

    /// The map with this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|map| map.name() == name)
    }

    /// Whether it is two-sided, with a colour for the middle.
    #[must_use]
    pub const fn has_two_sides(self) -> bool {
        matches!(self, Self::BrBG | Self::PuOr)
    }

    /// The names of the maps with two sides, or of the others.
    pub(crate) fn names(two_sides: bool) -> String {
        let fitting = Self::ALL
            .into_iter()
            .filter(|map| map.has_two_sides() == two_sides);
        fitting.map(Self::name).collect::<Vec<_>>().join(", ")
    }

    fn gradient(self) -> Gradient {
        match self {
            Self::Viridis => colorous::VIRIDIS,
            Self::Cividis => colorous::CIVIDIS,
            Self::Plasma => colorous::PLASMA,
            Self::BrBG => colorous::BROWN_GREEN,
            Self::PuOr => colorous::PURPLE_ORANGE,
        }
    }

    /// The colour at a part of the way, 0 to 1.
    pub(crate) fn at(self, part: f64) -> Rgb {
        let part = match self {
            // The crate has this map in the opposite order.
            Self::PuOr => 1.0 - part,
            _ => part,
        };
        let colour = self.gradient().eval_continuous(part);
        Rgb(colour.r, colour.g, colour.b)
    }

    /// The colour on one side of a two-sided map, −1 to 1; 0 is the middle.
    pub(crate) fn on_side(self, strength: f64) -> Rgb {
        self.at(0.5 + 0.5 * USED * strength)
    }

    /// The colours of values beyond both ends of a map with two sides.
    pub(crate) fn beyond(self) -> (Rgb, Rgb) {
        (self.at(0.0), self.at(1.0))
    }
}
