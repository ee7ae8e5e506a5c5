//! The flags of control by the return map: what case files say in their table `[feedback]`.

use crate::setting::Parameter;
use crate::setting::amount::Amount;
use crate::setting::feedback_table::{MODELS, RETURN_MAP};
use crate::setting::setting_text::number;
use crate::setting::units::Units;

use super::failure::Failure;
use super::parameter_values::{amount_of, in_units};

/// Control by the return map.
#[derive(Debug, Default, clap::Args)]
pub(super) struct ReturnMapArgs {
    /// Control in the place of delayed feedback, which has gains: at each reading the load is set
    /// to what brings the block to sliding. Needs --sample-time and --amplitude
    #[arg(long, value_name = "CONTROL", value_parser = [RETURN_MAP])]
    control: Option<String>,
    /// The largest change of the load under control by the return map, above 0 and below N0; where
    /// more is needed there is none
    #[arg(long, value_name = "LOAD", allow_hyphen_values = true,
          value_parser = amount_of(Parameter::NormalLoad))]
    amplitude: Option<Amount>,
    /// Where the return map comes from: the friction law, or a record near sliding
    #[arg(long, value_name = "MODEL", value_parser = MODELS)]
    model: Option<String>,
    /// The most readings of the record, at least 7 [default: 20]
    #[arg(long, value_name = "N")]
    record: Option<u64>,
    /// The largest pulse of the load in the record [default: 0.01 of N0]
    #[arg(long, value_name = "LOAD", allow_hyphen_values = true,
          value_parser = amount_of(Parameter::NormalLoad))]
    pulse: Option<Amount>,
}

impl ReturnMapArgs {
    /// Whether one of the flags is given.
    pub(super) fn any(&self) -> bool {
        !self.given().is_empty()
    }

    /// The flags that are given.
    fn given(&self) -> Vec<&'static str> {
        let all = [
            ("--control", self.control.is_some()),
            ("--amplitude", self.amplitude.is_some()),
            ("--model", self.model.is_some()),
            ("--record", self.record.is_some()),
            ("--pulse", self.pulse.is_some()),
        ];
        all.into_iter()
            .filter(|(_, is)| *is)
            .map(|(flag, _)| flag)
            .collect()
    }

    /// The table of a case file with these flags as keys, empty without them.
    ///
    /// # Errors
    /// Where a number has a unit that does not fit, or flags come without `--control`.
    pub(super) fn table(&self, units: &Units) -> Result<String, Failure> {
        let given = self.given();
        let Some(first) = given.first() else {
            return Ok(String::new());
        };
        let Some(control) = &self.control else {
            return Err(Failure::bad_input_with_help(
                format!("{first} is of control by the return map"),
                format!("give --control {RETURN_MAP} as well"),
            ));
        };
        let mut text = format!("\n[feedback]\ncontrol = {control:?}\n");
        for (flag, load) in [("--amplitude", &self.amplitude), ("--pulse", &self.pulse)] {
            if let Some(load) = load {
                let key = &flag[2..];
                text += &format!("{key} = {}\n", number(in_units(flag, load, units)?));
            }
        }
        if let Some(model) = &self.model {
            text += &format!("model = {model:?}\n");
        }
        text.extend(self.record.map(|record| format!("record = {record}\n")));
        Ok(text)
    }
}
