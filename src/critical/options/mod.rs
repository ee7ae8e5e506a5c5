//! The numbers that tune a search for a critical velocity, in a table for each of its parts.
//!
//! Every option has its reason, its default and its range beside it. Maps are computed with the
//! defaults; benches/critical_options.rs shows what each option changes.
//!
//! - `along_delay`: options of continuation along a line of delays
//! - `bracket`: options of the bounds of a critical velocity that is not decided
//! - `continuation`: options of continuation in v0
//! - `ramp`: options of simulation while v0 is raised
//! - `switch_on`: options of switching control on
//! - `table`: the macro that makes options from such a table
//! - `transition`: options of what follows an event

#[macro_use]
mod table;
mod along_delay;
mod bracket;
mod continuation;
mod ramp;
mod switch_on;
mod transition;

pub use along_delay::AlongDelayOptions;
pub use bracket::BracketOptions;
pub use continuation::ContinuationOptions;
pub use ramp::RampOptions;
pub use switch_on::SwitchOnOptions;
pub use transition::TransitionOptions;

/// All options of a search.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Options {
    /// Continuation in v0.
    pub continuation: ContinuationOptions,
    /// What follows an event.
    pub transition: TransitionOptions,
    /// Continuation along a line of delays.
    pub along_delay: AlongDelayOptions,
    /// Simulation while v0 is raised.
    pub ramp: RampOptions,
    /// Bounds where v_c is not decided.
    pub bracket: BracketOptions,
    /// Switching control on.
    pub switch_on: SwitchOnOptions,
}

impl Options {
    /// The names of all options, such as `continuation.share`.
    pub fn names() -> impl Iterator<Item = String> {
        let tables = [
            ("continuation", ContinuationOptions::NAMES),
            ("transition", TransitionOptions::NAMES),
            ("along_delay", AlongDelayOptions::NAMES),
            ("ramp", RampOptions::NAMES),
            ("bracket", BracketOptions::NAMES),
            ("switch_on", SwitchOnOptions::NAMES),
        ];
        let names = |(table, names): (&'static str, &'static [&'static str])| {
            names.iter().map(move |name| format!("{table}.{name}"))
        };
        tables.into_iter().flat_map(names)
    }

    /// Multiplies the option of this name, or each of its numbers, by `factor`, within its range.
    /// False where that changes nothing.
    pub fn scale(&mut self, name: &str, factor: f64) -> bool {
        let Some((table, name)) = name.split_once('.') else {
            return false;
        };
        match table {
            "continuation" => self.continuation.scale(name, factor),
            "transition" => self.transition.scale(name, factor),
            "along_delay" => self.along_delay.scale(name, factor),
            "ramp" => self.ramp.scale(name, factor),
            "bracket" => self.bracket.scale(name, factor),
            "switch_on" => self.switch_on.scale(name, factor),
            _ => false,
        }
    }

    /// Whether every option lies in its range.
    #[must_use]
    pub fn within_ranges(&self) -> bool {
        self.continuation.within_ranges()
            && self.transition.within_ranges()
            && self.along_delay.within_ranges()
            && self.ramp.within_ranges()
            && self.bracket.within_ranges()
            && self.switch_on.within_ranges()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_lie_in_their_ranges() {
        assert!(Options::default().within_ranges());
        let mut outside = Options::default();
        outside.continuation.share = 1.5;
        assert!(!outside.within_ranges());
    }

    #[test]
    fn what_is_usual_is_not_told() {
        let mut options = ContinuationOptions::default();
        assert_eq!(format!("{options:?}"), "ContinuationOptions { .. }");
        options.share = 0.5;
        assert_eq!(
            format!("{options:?}"),
            "ContinuationOptions { share: 0.5, .. }"
        );
    }

    #[test]
    fn every_option_has_a_name_by_which_it_is_scaled() {
        let names: Vec<String> = Options::names().collect();
        assert!(names.len() > 60, "{}", names.len());
        for name in &names {
            let mut options = Options::default();
            let changed = options.scale(name, 0.5) || options.scale(name, 2.0);
            assert!(options.within_ranges(), "{name}");
            // Switches, and options that are 0 by default, do not change.
            let fixed = ["ramp.until_periodic", "ramp.patient", "ramp.glide"];
            assert_eq!(changed, !fixed.contains(&name.as_str()), "{name}");
        }
        assert!(!Options::default().scale("ramp.nothing", 2.0));
        assert!(!Options::default().scale("nothing", 2.0));
    }
}
