//! The units of the numbers that flags give, whichever flags these are.

use clap::ArgMatches;

use crate::setting::amount::Amount;
use crate::setting::units::Units;

use super::corners::Corner;
use super::parameter_values::TimeOr;
use super::sets::Set;

/// The units of the numbers of all flags: those `declared`, or the SI where none are and some
/// number has a unit.
pub(super) fn units_of(matches: &ArgMatches, declared: Option<&Units>) -> Units {
    let any = |id: &str| {
        let amounts = matches.try_get_many::<Amount>(id).ok().flatten();
        let times = matches.try_get_many::<TimeOr>(id).ok().flatten();
        let times = times.into_iter().flatten().filter_map(TimeOr::time);
        let sets = matches.try_get_many::<Set>(id).ok().flatten();
        let sets = sets.into_iter().flatten().map(|set| &set.amount);
        let corners = matches.try_get_many::<Corner>(id).ok().flatten();
        let corners = corners.into_iter().flatten().flat_map(Corner::amounts);
        let amounts = amounts.into_iter().flatten().chain(corners);
        let mut all = amounts.chain(times).chain(sets);
        all.any(Amount::needs_units)
    };
    match declared {
        Some(units) => units.clone(),
        None if matches.ids().any(|id| any(id.as_str())) => Units::assumed_si(),
        None => Units::default(),
    }
}
