//! The tables `[[programme]]` of a case file: v0 in time.

use std::ops::Range;

use super::keys::{PROGRAMME, names};
use super::parameter::{LARGEST, Parameter};
use super::simulation::{POSITIVE, Simulation};
use super::units::Units;
use crate::slip::case::Case;
use crate::slip::programme::{Corner, MOST_CORNERS, Programme, WrongCorner};
use crate::text::Shown;
use crate::text::toml_reader::{Entry, SpecError};

/// No limits of an actuator.
const FREE: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// A programme with its places in a file.
pub(super) struct GivenProgramme {
    programme: Programme,
    /// The places of each `at` and `v0`.
    places: Vec<[Range<usize>; 2]>,
}

impl GivenProgramme {
    /// Reads all tables; limits of the actuator are checked later.
    pub(super) fn read(entry: &Entry, units: &Units) -> Result<Self, SpecError> {
        if entry.is_table() {
            let error = entry.expected("an array of tables");
            return Err(error.help("write [[programme]], for each entry anew"));
        }
        let tables = entry.array()?;
        if let Some(beyond) = tables.get(MOST_CORNERS) {
            return Err(beyond.error(format!("one entry too many: at most {MOST_CORNERS}")));
        }
        let mut given = Self {
            programme: Programme::default(),
            places: Vec::new(),
        };
        for table in &tables {
            given.add(table, units)?;
        }
        given.check(FREE)?;
        Ok(given)
    }

    fn add(&mut self, entry: &Entry, units: &Units) -> Result<(), SpecError> {
        let mut table = entry.document(names(&PROGRAMME))?;
        let at = table.take("at", |entry| {
            units.number_within(entry, Parameter::Tau.dimension(), 0.0..=LARGEST)
        });
        let v0 = table.take("v0", |entry| {
            units.number_within(entry, Parameter::V0.dimension(), POSITIVE)
        });
        let ramp = table.take("ramp", Entry::boolean).unwrap_or_default();
        table.finish()?;
        let places = ["at", "v0"].map(|key| table.value(key).cloned());
        let ((Some(at), Some(v0)), [Some(of_at), Some(of_v0)]) = ((at, v0), places) else {
            let message = "at and v0 are needed, both";
            return Err(entry.error(message).help("for example: at = 50, v0 = 0.2"));
        };
        self.programme.0.push(Corner { at, v0, ramp });
        self.places.push([of_at, of_v0]);
        Ok(())
    }

    /// Checks the corners, with these limits of the actuator.
    fn check(&self, limits: [f64; 2]) -> Result<(), SpecError> {
        let checked = self.programme.check(limits);
        checked.map_err(|WrongCorner { index, error }| {
            let (key, place) = match error.parameter {
                Programme::AT => ("at", 0),
                _ => ("v0", 1),
            };
            let (value, allowed) = (Shown(error.value), error.allowed);
            let message =
                format!("programme[{index}].{key}: {value} is outside its range: {allowed}");
            SpecError {
                span: self.places.get(index).map(|places| places[place].clone()),
                ..SpecError::whole(message)
            }
        })
    }

    /// The case with this programme. Its horizon, at `place` if it is given, is later than the last
    /// corner.
    pub(super) fn added_to(
        self,
        case: Case,
        simulation: &Simulation,
        place: Option<&Range<usize>>,
    ) -> Result<Case, SpecError> {
        self.check(case.feedback.limits.velocity)?;
        let Some(last) = self.programme.last() else {
            return Ok(case);
        };
        simulation.check_horizon(place, "the last `at` of the programme", last.at)?;
        let later = simulation.horizon_after(last.at, &case.oscillator);
        Ok(Case {
            horizon: case.horizon.max(later),
            programme: self.programme,
            ..case
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::CaseSpec;
    use super::*;

    const CASE: &str = "[friction]\nlaw = \"coulomb\"\nmu0 = 0.4\n[fixed]\nv0 = 0.5\n";

    #[test]
    fn a_programme_is_read_in_its_units() {
        let text = format!(
            "units = {{ force = \"N\", length = \"mm\", time = \"s\" }}\n{CASE}\
             [[programme]]\nat = \"500 ms\"\nv0 = \"2 m/s\"\n\
             [[programme]]\nat = 3\nv0 = 1.0\nramp = true\n"
        );
        let case = text.parse::<CaseSpec>().unwrap().case;
        let corner = |at, v0, ramp| Corner { at, v0, ramp };
        let corners = [corner(0.5, 2000.0, false), corner(3.0, 1.0, true)];
        assert_eq!(case.programme.0, corners);
        assert_eq!((case.v0, case.last_v0()), (0.5, 1.0));
        assert_eq!(case.horizon, 1003.0);
    }

    #[test]
    fn the_horizon_counts_from_the_later_of_switch_on_and_the_last_corner() {
        let controlled = format!("{CASE}alpha_v = -0.3\ntau = 2.0\n");
        let horizon = |top: &str, at: f64| {
            let text = format!("{top}\n{controlled}[[programme]]\nat = {at:?}\nv0 = 1.0\n");
            text.parse::<CaseSpec>().unwrap().case.horizon
        };
        assert_eq!(horizon("switch_on = 70.0", 3.0), 1070.0);
        assert_eq!(horizon("switch_on = 7.0", 30.0), 1030.0);
        assert_eq!(horizon("horizon = 90.0", 30.0), 90.0);
    }

    #[test]
    fn mistakes_are_pointed_at() {
        let entry = |at: &str, v0: &str| format!("[[programme]]\nat = {at}\nv0 = {v0}\n");
        for (tables, says, at) in [
            (
                entry("5.0", "0.2") + &entry("4.0", "0.3"),
                "programme[1].at: 4 is outside its range: later than the entry before",
                "4.0",
            ),
            (
                entry("5.0", "0.2") + &entry("5.00", "0.3"),
                "later than the entry before",
                "5.00",
            ),
            (entry("0.0", "0.2"), "later than 0; v0 itself says", "0.0"),
            (entry("-1.0", "0.2"), "programme[0].at: -1 is", "-1.0"),
            (entry("5.0", "-0.2"), "programme[0].v0: -0.2 is", "-0.2"),
            (entry("5.0", "0.0"), "programme[0].v0: 0 is", "0.0"),
            (entry("5.0", "nan"), "expected a finite", "nan"),
            (
                entry("5.0", "0.2") + "ramp = 1\n",
                "programme[0].ramp: expected true or false",
                "1",
            ),
            (
                entry("5.0", "0.2") + "tau = 1\n",
                "unknown key `programme[0].tau`",
                "tau",
            ),
            ("programme = 3\n".into(), "expected an array", "3"),
            (
                "programme = [{ at = 1.0 }]\n".into(),
                "at and v0 are needed",
                "{ at = 1.0 }",
            ),
        ] {
            // A key of the whole file stands above its tables.
            let text = match tables.starts_with("programme") {
                true => format!("{tables}{CASE}"),
                false => format!("{CASE}{tables}"),
            };
            let error = text.parse::<CaseSpec>().unwrap_err();
            assert!(error.message.contains(says), "{error} {says}");
            assert_eq!(&text[error.span.clone().unwrap()], at, "{error}");
        }
    }

    #[test]
    fn limits_and_the_horizon_are_respected() {
        let tables = "[[programme]]\nat = 5.0\nv0 = 0.6\n[[programme]]\nat = 6.0\nv0 = 0.9\n";
        let limited = format!("{CASE}v_max = 0.75\nalpha_v = -0.1\ntau = 1.0\n{tables}");
        let error = limited.parse::<CaseSpec>().unwrap_err();
        assert!(error.message.contains("programme[1].v0: 0.9 is"), "{error}");
        assert!(error.message.contains("v_min and v_max"), "{error}");
        assert_eq!(&limited[error.span.unwrap()], "0.9");
        let early = format!("horizon = 6.0\n{CASE}{tables}");
        let error = early.parse::<CaseSpec>().unwrap_err();
        assert!(
            error.message.contains("not later than the last `at`"),
            "{error}"
        );
        let table = format!("{CASE}[programme]\nat = 5.0\nv0 = 0.6\n");
        let error = table.parse::<CaseSpec>().unwrap_err();
        assert!(
            error
                .help
                .is_some_and(|help| help.contains("[[programme]]"))
        );
    }
}
