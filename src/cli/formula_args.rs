//! The friction law of `--friction formula --mu-k EXPRESSION --set NAME=VALUE`.

use crate::setting::Setting;
use crate::setting::formula::{EXAMPLE, GivenFormula};
use crate::setting::law_kind::LawKind;
use crate::setting::quantity::Quantity;
use crate::setting::units::Units;
use crate::text::SpecError;

use super::failure::Failure;
use super::sets::SetArgs;

/// The failure for parameters that nothing names.
fn no_formula() -> Failure {
    Failure::bad_input_with_help(
        "--set gives a parameter that a system or a formula names: neither is given",
        "--system NAME, or --friction formula --mu-k 'EXPRESSION'",
    )
}

/// The law of the expression `mu_k`, with values of its own parameters in `units`. They have the
/// units in which they are given.
pub(super) fn law(mu_k: Option<&str>, sets: &SetArgs, units: &Units) -> Result<LawKind, Failure> {
    let Some(text) = mu_k else {
        return Err(Failure::bad_input_with_help(
            "--mu-k is not given: the formula law is an expression in the speed v",
            format!("--mu-k '{EXAMPLE}' --mu0 0.3 --v-s 0.1; other names by --set NAME=VALUE"),
        ));
    };
    let formula = GivenFormula::read(text);
    let mut formula = formula.map_err(|error| Failure::in_file(error, "--mu-k", text))?;
    let mut given = Vec::new();
    for set in sets.each()? {
        let own = formula.own_named(&set.name).cloned();
        let own = own.ok_or_else(|| set.refused(formula.unknown(&set.name)))?;
        let value = own.check(set.value(units)?);
        let value = value.map_err(|why| set.refused(SpecError::whole(why)))?;
        formula.measure(&own, set.amount.dimension(), units);
        given.push((Quantity::Own(own), value));
    }
    let mut setting = Setting::new(Some(LawKind::Formula(formula)));
    for (own, value) in given {
        setting.vary(&own, value);
    }
    if let Some(own) = setting.formula().and_then(|of| of.missing(|_| false)) {
        let advice = format!("add --set {}=VALUE", own.name);
        return Err(Failure::of_input(GivenFormula::not_given(own, advice)));
    }
    setting.law().cloned().ok_or_else(no_formula)
}

/// Refuses parts of a formula where there is none: a text that is `no_number`, and own parameters.
pub(super) fn check_none(no_number: Option<&String>, sets: &SetArgs) -> Result<(), Failure> {
    match no_number {
        Some(text) => Err(Failure::bad_input_with_help(
            format!("--mu-k {text}: expected a number, such as 0.4"),
            "an expression in v is for --friction formula",
        )),
        None if sets.any() => Err(no_formula()),
        None => Ok(()),
    }
}
