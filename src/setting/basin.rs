//! The starts over which the share that ends in sliding is taken: the table `[basin]` of a sweep
//! file.

use std::borrow::Cow;
use std::ops::Range;

use super::keys::{BASIN, ENDS, names};
use super::parameter::Parameter;
use super::units::Units;
use super::values::Setting;
use crate::model::ModelError;
use crate::text::toml_reader::{Entry, SpecError};

/// Independent scramblings of the sequence of starts. Their spread estimates the error of a share,
/// to within 18 %.
pub const SCRAMBLINGS: u32 = 16;
/// Starts of a cell if the sweep file gives no number.
pub(crate) const STARTS: u32 = 256;
/// The fewest starts: four in each scrambling.
pub const FEWEST_STARTS: u32 = 4 * SCRAMBLINGS;
/// The most starts: 2¹⁶ in each scrambling, the length of the sequence.
pub const MOST_STARTS: u32 = SCRAMBLINGS << 16;

/// What the starts are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Over {
    /// Velocity and elongation in a box, with control on from t = 0.
    State,
    /// Control switched on at a phase of the uncontrolled cycle of stick and slip.
    Phase,
}

impl Over {
    /// All.
    pub const ALL: [Self; 2] = [Self::State, Self::Phase];

    /// The name in flags, sweep files and maps.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::State => "state",
            Self::Phase => "phase",
        }
    }
}

/// The starts over which a share is taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Basin {
    /// What the starts are.
    pub over: Over,
    /// How many are followed: a power of two between [`FEWEST_STARTS`] and [`MOST_STARTS`].
    pub starts: u32,
    /// The range of ẋ at t = 0; none for the range by default of the setting.
    pub x_dot0: Option<[f64; 2]>,
    /// The range of the elongation at t = 0 and before; none for the range
    /// by default of the setting.
    pub a0: Option<[f64; 2]>,
}

impl Default for Basin {
    fn default() -> Self {
        Self {
            over: Over::State,
            starts: STARTS,
            x_dot0: None,
            a0: None,
        }
    }
}

impl Basin {
    /// Everything on which shares depend: names, with their numbers, for the plan's hash.
    pub(crate) fn facts(&self) -> Vec<(&str, Cow<'_, [f64]>)> {
        let mut facts = vec![("starts over", Cow::Borrowed(&[][..]))];
        facts.push((self.over.name(), vec![f64::from(self.starts)].into()));
        let ranges = [("x_dot0 of starts", self.x_dot0), ("a0 of starts", self.a0)];
        let given = ranges
            .into_iter()
            .filter_map(|(name, range)| Some((name, range?)));
        facts.extend(given.map(|(name, range)| (name, range.to_vec().into())));
        facts
    }

    /// A description in words, for plans and maps.
    #[must_use]
    pub fn described(&self) -> String {
        let starts = self.starts;
        let range = |name: &str, range: Option<[f64; 2]>, by_default: &str| match range {
            Some([from, to]) => format!("{name} from {from} to {to}"),
            None => format!("{name} from {by_default}"),
        };
        match self.over {
            Over::State => format!(
                "{starts} states, control on from t = 0: {}; {}",
                range(
                    Parameter::XDot0.name(),
                    self.x_dot0,
                    "0 to v0 + sqrt(v0^2 + (mu_s normal_load)^2/(stiffness mass))"
                ),
                range(
                    Parameter::A0.name(),
                    self.a0,
                    "-mu_s normal_load/stiffness to mu_s normal_load/stiffness"
                ),
            ),
            Over::Phase => format!(
                "{starts} phases of uncontrolled stick-slip at which control is switched on"
            ),
        }
    }

    /// Checks a number of starts.
    ///
    /// # Errors
    /// Says which numbers are allowed.
    pub fn check_starts(starts: u64) -> Result<u32, String> {
        let range = u64::from(FEWEST_STARTS)..=u64::from(MOST_STARTS);
        match starts.is_power_of_two() && range.contains(&starts) {
            true => Ok(starts as u32),
            false => Err(format!(
                "{starts} starts; a power of two from {FEWEST_STARTS} to {MOST_STARTS} is needed"
            )),
        }
    }

    /// Checks a range of `parameter` for starts; it may be a single value.
    ///
    /// # Errors
    /// When an end is outside the parameter's range, or the ends are reversed.
    pub(crate) fn check_range(parameter: Parameter, range: [f64; 2]) -> Result<[f64; 2], String> {
        let [from, to] = range;
        for end in range {
            parameter.check(end).map_err(|e| e.to_string())?;
        }
        match from <= to {
            true => Ok(range),
            false => Err(format!(
                "{}: from {from} is larger than to {to}",
                parameter.name()
            )),
        }
    }

    /// Range of the velocities of the starts, for a setting with a friction law. By default it
    /// reaches from rest to v0 + √(v0² + μ_S² N0²/(κM)). This is the largest velocity of a block
    /// that is released at the limit of sticking and slides without friction; uncontrolled
    /// stick-slip is always slower.
    ///
    /// # Errors
    /// When a parameter is outside the model's range.
    pub fn velocities(&self, setting: &Setting) -> Result<[f64; 2], ModelError> {
        let fastest = || {
            let oscillator = setting.oscillator()?;
            let released = stuck(setting)? / oscillator.time_unit();
            let v0 = setting.get(Parameter::V0);
            Ok([0.0, v0 + (v0 * v0 + released * released).sqrt()])
        };
        self.x_dot0.map_or_else(fastest, Ok)
    }

    /// Range of the elongations of the starts, for a setting with a friction law. By default it is
    /// ±μ_S N0/κ, the elongations at which a block at rest stays at rest.
    ///
    /// # Errors
    /// When a parameter is outside the model's range.
    pub fn elongations(&self, setting: &Setting) -> Result<[f64; 2], ModelError> {
        let sticking = || stuck(setting).map(|limit| [-limit, limit]);
        self.a0.map_or_else(sticking, Ok)
    }
}

/// The largest elongation of a stuck block.
fn stuck(setting: &Setting) -> Result<f64, ModelError> {
    let oscillator = setting.oscillator()?;
    let mu_s = setting.friction_law()?.map_or(f64::NAN, |law| law.mu_s());
    Ok(mu_s * oscillator.normal_load() / oscillator.stiffness())
}

/// The table `[basin]`, with the last key that has no meaning over phases.
#[derive(Default)]
pub(super) struct BasinKeys {
    basin: Basin,
    box_place: Option<(String, Range<usize>)>,
}

impl BasinKeys {
    /// Reads the table.
    pub(super) fn read(table: &Entry, units: &Units) -> Result<Self, SpecError> {
        let mut table = table.document(names(&BASIN))?;
        let default = Basin::default();
        let [x_dot0, a0] = [Parameter::XDot0, Parameter::A0]
            .map(|of| table.take(of.name(), |entry| read_box(entry, of, units)));
        let basin = Basin {
            over: table.take("over", read_over).unwrap_or(default.over),
            starts: table.take("starts", read_starts).unwrap_or(default.starts),
            x_dot0,
            a0,
        };
        table.finish()?;
        let mut keys = table.keys().rev();
        let last = keys.find(|(key, _)| ["x_dot0", "a0"].contains(key));
        Ok(Self {
            basin,
            box_place: last.map(|(key, place)| (key.to_owned(), place.clone())),
        })
    }

    /// The starts that the table describes.
    pub(super) fn basin(&self) -> Result<Basin, SpecError> {
        match (&self.box_place, self.basin.over) {
            (Some((key, place)), Over::Phase) => {
                let message = format!("{key} has no meaning with over = \"phase\"");
                Err(SpecError::at(place.clone(), message).help(
                    "there the block is in uncontrolled stick-slip, whose phases are all taken; \
                     over = \"state\" is about velocities and elongations",
                ))
            }
            _ => Ok(self.basin),
        }
    }
}

fn read_starts(entry: &Entry) -> Result<u32, SpecError> {
    Basin::check_starts(entry.whole()?).map_err(|why| entry.error(why))
}

fn read_box(of: &Entry, parameter: Parameter, units: &Units) -> Result<[f64; 2], SpecError> {
    let mut table = of.document(ENDS)?;
    let number = |entry: &Entry| units.number(entry, parameter.dimension());
    let [from, to] = ENDS.map(|end| table.take(end, number));
    table.finish()?;
    let missing = |name| of.error(format!("{name} is missing"));
    let from = from.ok_or_else(|| missing("from"))?;
    let to = to.ok_or_else(|| missing("to"))?;
    Basin::check_range(parameter, [from, to]).map_err(|why| SpecError::at(of.span.clone(), why))
}

fn read_over(entry: &Entry) -> Result<Over, SpecError> {
    let name = entry.string()?;
    let known = Over::ALL.into_iter().find(|over| over.name() == name);
    known.ok_or_else(|| {
        entry
            .error(format!("unknown kind of starts \"{name}\""))
            .help(format!("known: {}", Over::ALL.map(Over::name).join(", ")))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setting::law_kind::LawKind;

    /// The default range scales with the units and contains the uncontrolled cycle. For Coulomb
    /// friction its largest velocity is v0 + √(v0² + ((μ_S − μ_K) N0)²/(κM)).
    #[test]
    fn the_box_by_default_holds_the_uncontrolled_cycle() {
        for (mass, stiffness, load, v0) in [(1.0, 1.0, 1.0, 0.1), (2.0, 7.0, 3.0, 40.0)] {
            let mut setting = Setting::new(Some(LawKind::named("coulomb").unwrap()));
            for (parameter, value) in [
                (Parameter::Mu0, 0.4),
                (Parameter::MuS, 0.9),
                (Parameter::Mass, mass),
                (Parameter::Stiffness, stiffness),
                (Parameter::NormalLoad, load),
                (Parameter::V0, v0),
            ] {
                setting.set(parameter, value);
            }
            let velocity = |mu: f64| mu * load / (mass * stiffness).sqrt();
            let [slowest, fastest] = Basin::default().velocities(&setting).unwrap();
            assert_eq!(slowest, 0.0);
            assert!(fastest > v0 + v0.hypot(velocity(0.5)));
            assert!((fastest - (v0 + v0.hypot(velocity(0.9)))).abs() < 1e-12 * fastest);
            let [low, high] = Basin::default().elongations(&setting).unwrap();
            assert!((high - 0.9 * load / stiffness).abs() < 1e-15 && low == -high);
        }
    }

    #[test]
    fn starts_are_powers_of_two() {
        assert_eq!(Basin::check_starts(64), Ok(64));
        assert_eq!(Basin::check_starts(1 << 20), Ok(1 << 20));
        for wrong in [0, 1, 32, 65, 1 << 21, u64::MAX] {
            assert!(
                Basin::check_starts(wrong)
                    .unwrap_err()
                    .contains("64 to 1048576")
            );
        }
    }
}
