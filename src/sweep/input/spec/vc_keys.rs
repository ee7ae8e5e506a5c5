//! What a sweep file says of the critical velocity, and what fields of it need.

use std::ops::Range;

use super::{Draft, Field};
use crate::critical::switch_on::Phase;
use crate::sweep::input::parameter::Parameter;
use crate::sweep::input::search::{PHASES, Protocol, Search};
use crate::sweep::input::setting::Setting;
use crate::sweep::input::toml_reader::{Entry, SpecError};

/// The share of cells that are recomputed where the file does not say.
const VERIFIED: f64 = 1.0 / 256.0;

/// The keys `protocol`, `phase` and `verify`, each with its place.
#[derive(Debug, Default)]
pub(super) struct VcKeys {
    switch_on: bool,
    verify: Option<f64>,
    protocol_place: Option<Range<usize>>,
    worst_place: Option<Range<usize>>,
    verify_place: Option<Range<usize>>,
}

impl VcKeys {
    /// Names of the keys.
    pub const KEYS: [&'static str; 3] = ["protocol", "phase", "verify"];

    /// Takes the value of an entry that is one of the keys; false where it is none.
    pub fn read(&mut self, entry: &Entry) -> Result<bool, SpecError> {
        match entry.key {
            "protocol" => {
                let name = entry.string()?;
                if !Protocol::NAMES.contains(&name) {
                    return Err(entry
                        .error(format!("unknown protocol \"{name}\""))
                        .help(format!("known: {}, limit", Protocol::NAMES.join(", "))));
                }
                self.switch_on = name != Protocol::Follow.name();
                self.protocol_place = Some(entry.span.clone());
            }
            "phase" => {
                if entry.string()? != "worst" {
                    return Err(entry.error("expected \"worst\"").help(
                        "one phase is given as switch_on_phase, fixed in [start] or as an axis",
                    ));
                }
                self.worst_place = Some(entry.span.clone());
            }
            "verify" => {
                self.verify = Some(entry.number_within(0.0..=1.0)?);
                self.verify_place = Some(entry.span.clone());
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// The keys that are given, with their places.
    fn given(&self) -> impl Iterator<Item = (&'static str, &Range<usize>)> {
        let places = [&self.protocol_place, &self.worst_place, &self.verify_place];
        let keys = Self::KEYS.into_iter().zip(places);
        keys.filter_map(|(key, place)| Some((key, place.as_ref()?)))
    }

    /// What is looked for, where `phase` is the place of a phase of switch-on that is given.
    fn search(&self, phase: Option<&Range<usize>>) -> Result<Search, SpecError> {
        let refuse = |place: &Range<usize>, message: &str, help: &str| {
            Err(SpecError::at(place.clone(), message).help(help))
        };
        let name = Parameter::SwitchOnPhase.name();
        let with_switch_on = "give protocol = \"switch-on\", or leave it out";
        match (self.switch_on, phase, &self.worst_place, &self.verify_place) {
            (false, Some(place), _, _) => {
                let message = format!("{name} has no meaning with the protocol follow");
                refuse(place, &message, with_switch_on)
            }
            (false, _, Some(place), _) => refuse(
                place,
                "phase has no meaning with the protocol follow",
                with_switch_on,
            ),
            (true, Some(_), Some(place), _) => refuse(
                place,
                "phase: switch_on_phase is given as well",
                "either one phase or the worst of all",
            ),
            (true, _, _, Some(place)) => refuse(
                place,
                "verify has no meaning with the protocol switch-on",
                "there every cell comes from simulation; leave it out",
            ),
            (true, _, worst, None) => Ok(Search {
                protocol: Protocol::SwitchOn(match worst {
                    Some(_) => Phase::Worst(PHASES),
                    None => Phase::After(0.0),
                }),
                verify: 0.0,
            }),
            (false, None, None, _) => Ok(Search {
                protocol: Protocol::Follow,
                verify: self.verify.unwrap_or(VERIFIED),
            }),
        }
    }
}

impl Draft {
    /// Whether anything in the sweep is about v0: a law without one still has a critical velocity.
    pub(super) fn needs_v0(&self) -> bool {
        let fields = self.fields.iter().flatten();
        let curves = self.boundaries == Some(true) || !self.degrees.is_empty();
        let about_v0 = |f: &Field| f.of_sliding() || *f == Field::Class;
        self.vc_place.is_none()
            || self.best.is_some()
            || curves
            || fields.copied().any(|f| about_v0(&f))
    }

    /// What is looked for, where a field of the critical velocity stands at `place`.
    pub(super) fn critical_search(
        &self,
        fixed: &Setting,
        place: &Range<usize>,
    ) -> Result<Search, SpecError> {
        self.check_law_is_there(place, "the critical velocity depends on the whole of it")?;
        if let Some((name, place)) = &self.start_place {
            let message = format!("{name} cannot stand beside fields of the critical velocity");
            return Err(SpecError::at(place.clone(), message).help(
                "it is about a motion from one start: make a sweep of its own for it; outcome can \
                stand in both",
            ));
        }
        self.check_no_effect_on_vc()?;
        self.check_delays(fixed, place)?;
        let phase = self.given.place(Parameter::SwitchOnPhase);
        self.vc.search(phase)
    }

    /// Nothing is given that would not be looked at.
    fn check_no_effect_on_vc(&self) -> Result<(), SpecError> {
        let place = |p: Parameter| Some((p.name(), self.given.place(p)?));
        let v0 = place(Parameter::V0).filter(|_| !self.needs_v0());
        let start = place(Parameter::XDot0).or(place(Parameter::A0));
        let simulation = self.simulation_place.as_ref().map(|s| ("simulation", s));
        let help = match v0 {
            Some(_) => {
                "v0 is what is looked for; the field class, fields of linear stability and \
                boundaries = true are about one"
            }
            None => {
                "the critical velocity does not depend on where a motion starts, and has \
                accuracies of its own"
            }
        };
        match v0.or(start).or(simulation) {
            Some((name, place)) => {
                let message = format!("{name} has no effect on the fields that are asked for");
                Err(SpecError::at(place.clone(), message).help(help))
            }
            None => Ok(()),
        }
    }

    /// No key of the critical velocity where no field of it is asked for.
    pub(super) fn check_no_search(&self) -> Result<(), SpecError> {
        match self.vc.given().next() {
            Some((key, place)) => {
                let message = format!("{key} has no effect on the fields that are asked for");
                let fields = Field::ALL.into_iter().filter(|f| f.of_vc());
                let names: Vec<_> = fields.map(Field::name).collect();
                Err(SpecError::at(place.clone(), message)
                    .help(format!("it is for the fields {}", names.join(", "))))
            }
            None => Ok(()),
        }
    }
}
