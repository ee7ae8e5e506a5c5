//! The flag `--programme`: the corners of v0 in time.

use crate::setting::Parameter;
use crate::setting::amount::Amount;
use crate::setting::setting_text::number;
use crate::setting::units::Units;

use super::failure::Failure;
use super::parameter_values::{in_units, named_amount, on_one_line};

/// A corner.
const EXPECTED: &str = "at=T,v0=V, for a ramp at=T,v0=V,ramp; for example at=50,v0=0.2";

/// A corner of a programme, as given by the flag.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Corner {
    at: Amount,
    v0: Amount,
    ramp: bool,
}

impl Corner {
    /// Reads one; ranges are checked later.
    pub(super) fn read(text: &str) -> Result<Self, String> {
        let (mut at, mut v0, mut ramp) = (None, None, false);
        for part in text.split(',').map(str::trim) {
            if part == "ramp" && !ramp {
                ramp = true;
                continue;
            }
            let (name, amount) = named_amount(part, EXPECTED)?;
            let (place, of) = match name {
                "at" => (&mut at, Parameter::Tau),
                "v0" => (&mut v0, Parameter::V0),
                _ => return Err(format!("expected {EXPECTED}")),
            };
            let fits = amount.check(of.dimension());
            fits.map_err(|error| format!("{name}: {}", on_one_line(&error)))?;
            if place.replace(amount).is_some() {
                return Err(format!("{name} is given twice"));
            }
        }
        match (at, v0) {
            (Some(at), Some(v0)) => Ok(Self { at, v0, ramp }),
            _ => Err(format!("expected {EXPECTED}")),
        }
    }

    /// Its numbers.
    pub(super) fn amounts(&self) -> [&Amount; 2] {
        [&self.at, &self.v0]
    }

    /// The table of a case file that says the same, with numbers in `units`.
    ///
    /// # Errors
    /// When a unit cannot be turned into `units`.
    pub(super) fn table(&self, units: &Units) -> Result<String, Failure> {
        let [at, v0] = self
            .amounts()
            .map(|amount| in_units("--programme", amount, units).map(number));
        let ramp = if self.ramp { "ramp = true\n" } else { "" };
        Ok(format!(
            "\n[[programme]]\nat = {}\nv0 = {}\n{ramp}",
            at?, v0?
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_are_read() {
        let table = |text: &str| Corner::read(text).map(|of| of.table(&Units::si()).ok().unwrap());
        assert_eq!(
            table("at=50,v0=0.2").unwrap(),
            "\n[[programme]]\nat = 50.0\nv0 = 0.2\n"
        );
        assert_eq!(
            table("v0 = 20 mm/s, at = 1500 ms, ramp").unwrap(),
            "\n[[programme]]\nat = 1.5\nv0 = 0.02\nramp = true\n"
        );
        for (text, says) in [
            ("", "expected at=T,v0=V"),
            ("50,0.2", "expected at=T,v0=V"),
            ("at=50", "expected at=T,v0=V"),
            ("at=50,v=0.2", "expected at=T,v0=V"),
            ("at=50,at=51,v0=1", "at is given twice"),
            ("at=50,v0=fast", "must be a finite number"),
            ("at=50 mm,v0=1", "at: mm is no unit of"),
            ("at=50,v0=1,ramp,ramp", "expected at=T,v0=V"),
        ] {
            let error = table(text).unwrap_err();
            assert!(error.contains(says), "{text}: {error}");
        }
    }
}
