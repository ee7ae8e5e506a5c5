//! What a setting is, among the notes of its picture.

use super::text::{Rich, assignment};
use crate::setting::quantity::Quantity;
use crate::setting::units::Units;
use crate::setting::{Parameter, Setting};

/// The most parameters of a system that are told.
const MOST_OWN: usize = 8;

/// The parameters of linear stability with their values: slope, gains and delay of the block; those
/// of a system from a file, and its delay.
pub(super) fn inputs(setting: &Setting, units: &Units) -> Vec<Rich> {
    let known = |parameter: Parameter, value: f64| {
        assignment(parameter, value, &units.of_parameter(parameter))
    };
    let of = |parameter: Parameter| known(parameter, setting.get(parameter));
    if setting.system().is_none() {
        let slope = setting.sliding_point().ok();
        let slope = slope.map(|at| known(Parameter::MuPrime, at.mu_prime));
        let others = [Parameter::AlphaV, Parameter::AlphaN, Parameter::Tau];
        return slope.into_iter().chain(others.map(of)).collect();
    }
    let own = setting.own().take(MOST_OWN);
    let own = own.map(|(own, value)| {
        let quantity = Quantity::Own(own.clone());
        assignment(&quantity, value, &quantity.unit(units))
    });
    let others = setting.others().iter().copied();
    let others = others.filter(|p| *p == Parameter::Tau || setting.get(*p) != 0.0);
    own.chain(others.map(of)).collect()
}

/// The title of a picture of `what` of a system from a file, or of what is `of_block`.
pub(super) fn title_of(setting: &Setting, (of_block, what): (&str, &str)) -> String {
    match setting.system().map(|model| &*model.title) {
        None => of_block.to_owned(),
        Some("") => format!("A system: {what}"),
        Some(title) => format!("{title}: {what}"),
    }
}
