//! A sweep file's keys for the critical velocity.

use std::ops::Range;

use super::parameter::Parameter;
use super::search::{LIMIT, PHASES, Protocol, Search};
use crate::critical::switch_on::Phase;
use crate::text::nearest::did_you_mean;
use crate::text::toml_reader::{Entry, SpecError};

/// Default share of cells that are recomputed.
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
    /// Reads an entry if it is one of the keys; returns whether it is.
    pub(super) fn read(&mut self, entry: &Entry) -> Result<bool, SpecError> {
        match entry.key {
            "protocol" => {
                let name = entry.string()?;
                if !Protocol::NAMES.contains(&name) {
                    let known = || Protocol::NAMES.into_iter().chain([LIMIT]);
                    let meant = did_you_mean(name, known());
                    let known = known().collect::<Vec<_>>().join(", ");
                    return Err(entry
                        .error(format!("unknown protocol \"{name}\""))
                        .help(format!("{meant}known: {known}")));
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

    /// The given keys, with their places.
    pub(super) fn given(&self) -> impl Iterator<Item = (&'static str, &Range<usize>)> {
        let places = [&self.protocol_place, &self.worst_place, &self.verify_place];
        let keys = ["protocol", "phase", "verify"].into_iter().zip(places);
        keys.filter_map(|(key, place)| Some((key, place.as_ref()?)))
    }

    /// The search; `phase` is the place of a given phase of switch-on.
    pub(super) fn search(&self, phase: Option<&Range<usize>>) -> Result<Search, SpecError> {
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
