//! The unit of measured speeds, and its conversion into the units of a setting.

use crate::setting::units::Units;

/// A unit by its name, and how many of the base unit it is, as a fraction.
type Known = (&'static str, u64, u64);

/// Units of length, in metres.
const LENGTHS: [Known; 11] = [
    ("nm", 1, 1_000_000_000),
    ("um", 1, 1_000_000),
    ("µm", 1, 1_000_000),
    ("μm", 1, 1_000_000),
    ("mm", 1, 1000),
    ("cm", 1, 100),
    ("dm", 1, 10),
    ("m", 1, 1),
    ("km", 1000, 1),
    ("in", 254, 10_000),
    ("ft", 3048, 10_000),
];
/// Units of time, in seconds.
const TIMES: [Known; 6] = [
    ("us", 1, 1_000_000),
    ("ms", 1, 1000),
    ("s", 1, 1),
    ("sec", 1, 1),
    ("min", 60, 1),
    ("h", 3600, 1),
];
/// What is understood.
pub(super) const FORM: &str = "a length over a time, like mm/s or m/min";

/// A unit of speed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SpeedUnit {
    name: String,
    length: Known,
    time: Known,
}

fn known(units: &[Known], name: &str) -> Option<Known> {
    units.iter().find(|(unit, ..)| *unit == name).copied()
}

impl SpeedUnit {
    /// A unit such as `mm/s`, or `mm s-1`.
    ///
    /// # Errors
    /// Says what is expected.
    pub fn read(text: &str) -> Result<Self, String> {
        let name = text.trim();
        let plain = name.replace("⁻¹", "-1").replace(['^', '·', '*'], " ");
        let parts = match plain.split_once('/') {
            Some(parts) => Some(parts),
            None => plain
                .strip_suffix("-1")
                .and_then(|of| of.trim_end().rsplit_once(' ')),
        };
        let of = |(length, time): (&str, &str)| {
            Some(Self {
                name: name.to_owned(),
                length: known(&LENGTHS, length.trim())?,
                time: known(&TIMES, time.trim())?,
            })
        };
        parts
            .and_then(of)
            .ok_or_else(|| format!("{name} is no known unit of speed: expected {FORM}"))
    }

    /// The name, as it was given.
    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// The factor from this unit to that of `units`, as a fraction: one division or product of
    /// small whole numbers is rounded once.
    ///
    /// # Errors
    /// Says why there is none.
    pub(super) fn factor(&self, units: &Units) -> Result<(f64, f64), String> {
        let Some([_, length, time]) = &units.force_length_time else {
            return Err(format!(
                "speeds in {} need units of the setting, and it has none",
                self.name
            ));
        };
        let own = known(&LENGTHS, length).zip(known(&TIMES, time));
        let Some((length, time)) = own else {
            let name = &self.name;
            return Err(format!(
                "speeds in {name} cannot be turned into {length}/{time}"
            ));
        };
        let product = |of: [u64; 4]| of.into_iter().map(u128::from).product::<u128>();
        let above = product([self.length.1, self.time.2, length.2, time.1]);
        let below = product([self.length.2, self.time.1, length.1, time.2]);
        let common = common_divisor(above, below);
        Ok(((above / common) as f64, (below / common) as f64))
    }
}

fn common_divisor(mut one: u128, mut other: u128) -> u128 {
    while other != 0 {
        (one, other) = (other, one % other);
    }
    one
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_converted() {
        let factor = |unit: &str, units: &str| {
            let unit = SpeedUnit::read(unit)?;
            unit.factor(&Units::read(units).unwrap())
        };
        for (unit, units, expected) in [
            ("mm/s", "SI", (1.0, 1000.0)),
            ("mm s-1", "N,m,s", (1.0, 1000.0)),
            ("mm·s⁻¹", "N,mm,s", (1.0, 1.0)),
            ("µm/s", "N,mm,s", (1.0, 1000.0)),
            ("m/min", "SI", (1.0, 60.0)),
            ("km/h", "SI", (5.0, 18.0)),
            ("m / s", "N,mm,ms", (1.0, 1.0)),
            ("in/s", "N,mm,s", (127.0, 5.0)),
        ] {
            assert_eq!(factor(unit, units), Ok(expected), "{unit} {units}");
        }
        for (unit, units, why) in [
            ("rpm", "SI", "rpm is no known unit"),
            ("mm", "SI", "no known unit"),
            ("mm/s2", "SI", "no known unit"),
            ("mm/s", "dimensionless", "it has none"),
            ("mm/s", "N,furlong,s", "into furlong/s"),
        ] {
            assert!(factor(unit, units).unwrap_err().contains(why), "{unit}");
        }
    }
}
