//! A file's keys for the critical velocity.

use std::ops::Range;

use super::parameter::Parameter;
use super::search::{LIMIT, PHASES, Protocol, Search};
use crate::critical::switch_on::Phase;
use crate::text::document::Document;
use crate::text::nearest::did_you_mean;
use crate::text::toml_reader::{Entry, SpecError};

/// Default share of cells that are recomputed.
const VERIFIED: f64 = 1.0 / 256.0;

/// The values of the keys `protocol`, `phase` and `verify`.
pub(super) struct VcKeys {
    protocol: &'static str,
    worst: bool,
    verify: Option<f64>,
}

impl VcKeys {
    /// The keys of a document, which may have one of these protocols.
    pub(super) fn of(document: &mut Document, protocols: &[&'static str]) -> Self {
        let protocol = document.take("protocol", |entry| read_protocol(entry, protocols));
        Self {
            protocol: protocol.unwrap_or(Protocol::Follow.name()),
            worst: document.take("phase", read_phase).is_some(),
            verify: document.take("verify", |entry| entry.number_within(0.0..=1.0)),
        }
    }

    /// Whether the limit of a short delay is asked for.
    pub(super) fn of_limit(&self) -> bool {
        self.protocol == LIMIT
    }

    /// The first key that is given, with the place of its value.
    pub(super) fn given<'d>(document: &'d Document) -> Option<(&'static str, &'d Range<usize>)> {
        let mut keys = ["protocol", "phase", "verify"].into_iter();
        keys.find_map(|key| Some((key, document.value(key)?)))
    }

    /// The search; `phase` is the place of a given phase of switch-on.
    pub(super) fn search(
        &self,
        document: &Document,
        phase: Option<&Range<usize>>,
    ) -> Result<Search, SpecError> {
        let refuse = |place: &Range<usize>, message: &str, help: &str| {
            Err(SpecError::at(place.clone(), message).help(help))
        };
        let name = Parameter::SwitchOnPhase.name();
        let with_switch_on = "give protocol = \"switch-on\", or leave it out";
        let switch_on = self.protocol != Protocol::Follow.name();
        let [worst, verify] = ["phase", "verify"].map(|key| document.value(key));
        match (switch_on, phase, worst, verify) {
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
            (true, _, _, None) => Ok(Search {
                protocol: Protocol::SwitchOn(match self.worst {
                    true => Phase::Worst(PHASES),
                    false => Phase::After(0.0),
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

fn read_protocol(entry: &Entry, protocols: &[&'static str]) -> Result<&'static str, SpecError> {
    let name = entry.string()?;
    let found = protocols.iter().find(|protocol| **protocol == name);
    found.copied().ok_or_else(|| {
        let known = || Protocol::NAMES.into_iter().chain([LIMIT]);
        let meant = did_you_mean(name, known());
        let known = known().collect::<Vec<_>>().join(", ");
        entry
            .error(format!("unknown protocol \"{name}\""))
            .help(format!("{meant}known: {known}"))
    })
}

fn read_phase(entry: &Entry) -> Result<(), SpecError> {
    match entry.string()? {
        "worst" => Ok(()),
        _ => Err(entry
            .error("expected \"worst\"")
            .help("one phase is given as switch_on_phase, fixed in [start] or as an axis")),
    }
}
