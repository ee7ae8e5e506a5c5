//! Control by the return map: what the load is set to at each reading near sliding.
//!
//! M. G. Rozman, M. Urbakh and J. Klafter, *Controlling chaotic frictional forces*, Phys. Rev. E
//! 57, 7340 (1998), after E. Ott, C. Grebogi and J. A. Yorke, Phys. Rev. Lett. 64, 1196 (1990):
//! the method with which the letter compares its own.
//!
//! At each reading the load is N0 + δN, held until the next one. Near sliding readings follow
//!
//! ```text
//! y_{k+1} − a* = t₁ (y_k − a*) + t₂ (y_{k−1} − a*) + g₁ δN_k + g₂ δN_{k−1}              (1)
//! ```

/// A recursion (1) of readings, in units of N0/κ for readings and N0 for loads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Recursion {
    /// t₁ and t₂: trace and negative determinant of what one sample time does to the block.
    pub readings: [f64; 2],
    /// g₁ and g₂.
    pub loads: [f64; 2],
    /// a*, the reading of sliding under the load N0.
    pub rest: f64,
}

/// A record near sliding under small known pulses of the load, to which (1) is fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Record {
    /// Its largest length in readings, at least [`Record::LEAST`]. It ends earlier where the block
    /// stops, or leaves the vicinity in which (1) holds.
    pub readings: u32,
    /// The largest pulse, above 0 and below N0, in the unit of N0.
    pub pulse: f64,
}

impl Record {
    /// The fewest readings: one for each of the five numbers of (1), and two before the first.
    pub const LEAST: u32 = 7;
    /// The most readings.
    pub const MOST: u32 = 100_000;
    /// The most readings of a record that nothing else is said of.
    pub const READINGS: u32 = 20;
    /// The largest pulse by default, in units of N0.
    pub const PULSE: f64 = 0.01;
}

/// Where the recursion (1) comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MapModel {
    /// From the friction law at the v0 of each reading, with a slope that is so many times μ_K′: 1
    /// for the exact one.
    Law {
        /// The slope of the model over that of the law.
        slope: f64,
    },
    /// From a record that is made before the motion, at its first v0.
    Reconstructed(Record),
    /// It is known.
    Known(Recursion),
}

impl MapModel {
    /// From the friction law as it is.
    pub const EXACT: Self = Self::Law { slope: 1.0 };
}

/// Control by the return map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReturnMap {
    /// The window: δN is 0 where more would be needed. Above 0 and below N0, in the unit of N0.
    pub amplitude: f64,
    /// Where (1) comes from.
    pub model: MapModel,
}

impl ReturnMap {
    /// This control in units of the load `force`.
    #[must_use]
    pub(super) fn over(self, force: f64) -> Self {
        let model = match self.model {
            MapModel::Reconstructed(record) => MapModel::Reconstructed(Record {
                pulse: record.pulse / force,
                ..record
            }),
            model => model,
        };
        Self {
            amplitude: self.amplitude / force,
            model,
        }
    }
}
