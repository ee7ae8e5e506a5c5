//! `slipmap vc`: the critical velocity at one point.

use std::io::Write;

use crate::critical::switch_on::Phase;
use crate::explore::vc::{CriticalVelocity, ShortDelay};
use crate::model::stop::Stop;
use crate::setting::point_file::PointOf;
use crate::setting::search::{self, PHASES};
use crate::setting::units::Units;
use crate::setting::{Parameter, Setting};
use crate::text::{Shown, finite};
use clap::ValueEnum;

use super::asks::OfStickSlip;
use super::cell::{CellArgs, alone};
use super::digits::DigitsArgs;
use super::failure::Failure;
use super::inputs_line;
use super::json::{self, AnswerSchema, Inputs};
use super::limit_args::LimitArgs;
use super::output::{tell_dimensionless, warn_beyond_curve};
use super::parameter_values::{TimeOr, in_units};
use super::parameters::{ParameterArgs, flag};
use super::say::{self, ForPeople};
use super::setting::SettingArgs;
use super::vc_text::{self, VcText};

#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  slipmap vc --friction weakening --mu0 0.5 --v-s 0.5 --alpha-v=-0.33 --tau 4.15
  slipmap vc --friction weakening --mu0 0.5 --v-s 0.5 --alpha-v=-0.33 --tau 4.15 \
--protocol switch-on --phase 0.2
  slipmap vc --protocol limit --gamma 0.25 --mu-ratio 0.5")]
pub(super) struct Args {
    #[command(flatten)]
    parameters: ParameterArgs<OfStickSlip>,
    #[command(flatten)]
    cell: CellArgs,
    #[command(flatten)]
    file: SettingArgs,
    /// Protocol of the search
    #[arg(long, value_enum, default_value_t = ProtocolName::Follow)]
    protocol: ProtocolName,
    /// Time from a release to switch-on, or `worst` for the worst of 32 phases (with --protocol
    /// switch-on) [default: 0]
    #[arg(long, value_name = "T", allow_hyphen_values = true,
          value_parser = TimeOr::word("worst"))]
    phase: Option<TimeOr>,
    #[command(flatten)]
    limit: LimitArgs,
    #[command(flatten)]
    digits: DigitsArgs,
    /// One JSON object on standard output; null where there is no value
    #[arg(long)]
    json: bool,
}

/// Protocols by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ProtocolName {
    /// From controlled stick-slip at low v0, raised until stick-slip ends
    Follow,
    /// Control switched on at a phase of uncontrolled stick-slip
    SwitchOn,
    /// Coulomb friction, load control, τ → 0: closed form
    Limit,
}

/// Runs the subcommand.
pub(super) fn main(args: &Args) -> Result<(), Failure> {
    args.check()?;
    if let Some(point) = args.cell.point(PointOf::CriticalVelocity)? {
        let by_flags = args.protocol != ProtocolName::Follow || args.phase.is_some();
        alone("--map", by_flags || args.parameters.any_but(&[]))?;
        let found = CriticalVelocity::of(&point.setting, point.protocol, &Stop::default())?;
        let asked = (&point.setting, &point.units, None);
        return args.tell(&found, asked, point.protocol);
    }
    match args.protocol {
        ProtocolName::Limit => {
            let found = args.limit()?;
            if !args.json {
                let out = &mut ForPeople::begin();
                vc_text::print_limit(out, &found, args.digits.get())?;
                return Ok(tell_dimensionless(out, &Units::default())?);
            }
            let inputs = Inputs::default().and("protocol", found.protocol);
            let inputs = inputs
                .and("gamma", found.gamma)
                .and("mu_ratio", found.mu_ratio);
            json::print(&inputs, &found)
        }
        protocol => {
            let (setting, units, v0) = args.read()?;
            let protocol = match protocol {
                ProtocolName::SwitchOn => search::Protocol::SwitchOn(args.phase(&units)?),
                _ => search::Protocol::Follow,
            };
            let found = CriticalVelocity::of(&setting, protocol, &Stop::default());
            let found = found.map_err(|e| args.parameters.refused(&e))?;
            args.tell(&found, (&setting, &units, v0), protocol)
        }
    }
}

/// The schema of its JSON.
pub(super) fn described() -> AnswerSchema {
    AnswerSchema::of("vc")
        .or::<CriticalVelocity>()
        .or::<ShortDelay>()
}

fn inputs(setting: &Setting, units: &Units, protocol: search::Protocol) -> Inputs {
    let inputs = Inputs::of_setting(setting, units, |p| p != Parameter::V0);
    let inputs = inputs.and("protocol", protocol.name());
    match protocol {
        search::Protocol::Follow => inputs,
        search::Protocol::SwitchOn(Phase::After(phase)) => inputs.and("phase", phase),
        search::Protocol::SwitchOn(Phase::Worst(_)) => inputs.and("phase", "worst"),
    }
}

impl Args {
    /// Reports the critical velocity of a setting, and where `v0` stands to it.
    fn tell(
        &self,
        found: &CriticalVelocity,
        (setting, units, v0): (&Setting, &Units, Option<f64>),
        protocol: search::Protocol,
    ) -> Result<(), Failure> {
        warn_beyond_curve(found.beyond_curve(setting, units));
        if self.json {
            return json::print(&inputs(setting, units, protocol), found);
        }
        let digits = self.digits.get();
        let text = VcText {
            found,
            units,
            digits,
        };
        let out = &mut ForPeople::begin();
        writeln!(out, "{}", text.sentence(v0))?;
        inputs_line::print(out, setting, units, &[Parameter::V0])?;
        text.print(out)?;
        Ok(tell_dimensionless(out, units)?)
    }

    /// The setting, from a file or from flags, its units, and v0 if there is one.
    fn read(&self) -> Result<(Setting, Units, Option<f64>), Failure> {
        if let Some(point) = self.file.point(PointOf::CriticalVelocityOfSetting)? {
            alone("--setting", self.parameters.any_but(&[]))?;
            let v0 = finite(point.setting.get(Parameter::V0));
            return Ok((point.setting, point.units, v0));
        }
        let setting = self.parameters.setting_without_v0()?;
        self.parameters.tell_static_friction("v_c depends on it");
        let v0 = self.parameters.given(Parameter::V0);
        if v0.is_some() && self.json {
            say::note("--v0 is left aside: the critical velocity is one");
        }
        Ok((setting, self.parameters.units(), v0))
    }

    /// Checks that no flag of another protocol is given.
    fn check(&self) -> Result<(), Failure> {
        let refuse = |flag: &str, protocol: &str| {
            Err(Failure::bad_input_with_help(
                format!("{flag} has no meaning with this protocol"),
                format!("it belongs to --protocol {protocol}"),
            ))
        };
        if self.phase.is_some() && self.protocol != ProtocolName::SwitchOn {
            return refuse("--phase", "switch-on");
        }
        if self.protocol != ProtocolName::Limit {
            if let Some(parameter) = self.limit.any_given() {
                return refuse(&flag(parameter), "limit");
            }
        } else if self.parameters.any_but(&[]) || self.file.is_given() {
            return Err(Failure::bad_input_with_help(
                "the limit takes no parameters but --gamma, --damping-ratio and --mu-ratio",
                "for example: slipmap vc --protocol limit --gamma 0.25 --mu-ratio 0.5",
            ));
        }
        Ok(())
    }

    fn limit(&self) -> Result<ShortDelay, Failure> {
        let needed = |parameter| {
            self.limit.get(parameter).ok_or_else(|| {
                Failure::bad_input_with_help(
                    format!("{} is missing", flag(parameter)),
                    "the limit needs --gamma and --mu-ratio",
                )
            })
        };
        let gamma = needed(Parameter::Gamma)?;
        let mu_ratio = needed(Parameter::MuRatio)?;
        let damping_ratio = self.limit.get(Parameter::DampingRatio).unwrap_or(0.0);
        ShortDelay::at(gamma, damping_ratio, mu_ratio).map_err(|e| {
            let of = Parameter::OF_LIMIT
                .into_iter()
                .find(|p| p.name() == e.parameter);
            of.map_or_else(
                || Failure::from(e.clone()),
                |p| Failure::out_of_range(&flag(p), &e),
            )
        })
    }

    /// The phase of the flag.
    fn phase(&self, units: &Units) -> Result<Phase, Failure> {
        let time = match &self.phase {
            None => return Ok(Phase::After(0.0)),
            Some(TimeOr::Word) => return Ok(Phase::Worst(PHASES)),
            Some(TimeOr::Time(time)) => in_units("--phase", time, units)?,
        };
        if (0.0..=1e12).contains(&time) {
            return Ok(Phase::After(time));
        }
        Err(Failure::bad_input_with_help(
            format!("--phase {} is outside its range", Shown(time)),
            "a time from a release to switch-on: 0 or more, at most 1e12",
        ))
    }
}
