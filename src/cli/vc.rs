//! `slipmap vc`: the critical velocity at one point.

use std::io::Write;

use crate::critical::switch_on::Phase;
use crate::explore::vc::{CriticalVelocity, ShortDelay};
use crate::model::stop::Stop;
use crate::report::numbers::{bound, rounded, unit_behind};
use crate::setting::point_file::PointOf;
use crate::setting::search::{self, PHASES};
use crate::setting::units::Units;
use crate::setting::{Field, Parameter, Setting};
use crate::text::{Shown, finite};
use clap::ValueEnum;
use serde::Serialize;
use serde_json::Value;

use super::asks::OfStickSlip;
use super::cell::{CellArgs, alone};
use super::failure::Failure;
use super::inputs_line;
use super::json::{self, AnswerSchema, Inputs};
use super::limit_args::LimitArgs;
use super::output::warn_beyond_curve;
use super::parameter_values::{TimeOr, in_units};
use super::parameters::{ParameterArgs, flag};
use super::say::ForPeople;
use super::setting::SettingArgs;

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
        return args.tell(&found, &point.setting, &point.units, point.protocol);
    }
    match args.protocol {
        ProtocolName::Limit => {
            let found = args.limit()?;
            let inputs = Inputs::default().and("protocol", found.protocol);
            let inputs = inputs
                .and("gamma", found.gamma)
                .and("mu_ratio", found.mu_ratio);
            print(
                args.json.then_some(&inputs),
                &found,
                |_: &str, _: &Value| None,
                &[],
                &Units::default(),
            )
        }
        protocol => {
            let (setting, units) = args.read()?;
            let protocol = match protocol {
                ProtocolName::SwitchOn => search::Protocol::SwitchOn(args.phase(&units)?),
                _ => search::Protocol::Follow,
            };
            let found = CriticalVelocity::of(&setting, protocol, &Stop::default());
            let found = found.map_err(|e| args.parameters.refused(&e))?;
            args.tell(&found, &setting, &units, protocol)
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

/// Number of digits after the first one of v_c and its bounds: as many as are known.
const DIGITS: usize = 5;

/// The bounds of v_c in words, if it is undecided.
fn not_known(found: &CriticalVelocity, units: &Units) -> Option<String> {
    let unit = unit_behind(&Field::Vc.unit(units));
    let lower = finite(found.vc_lower).map(|v| bound(v, DIGITS, false));
    let upper = finite(found.vc_upper).map(|v| bound(v, DIGITS, true));
    let ends = match (lower, upper) {
        (None, None) => String::new(),
        (None, Some(upper)) => format!(", below {upper}{unit}"),
        (Some(lower), None) => format!(", above {lower}{unit}"),
        (Some(lower), Some(upper)) => format!(", between {lower}{unit} and {upper}{unit}"),
    };
    (!found.decided).then(|| format!("not known{ends}"))
}

/// v_c in a line or two, with the velocity of lift-off.
pub(super) fn print_short(
    out: &mut impl Write,
    found: &CriticalVelocity,
    units: &Units,
) -> std::io::Result<()> {
    let unit = unit_behind(&Field::Vc.unit(units));
    let vc = match (not_known(found, units), finite(found.vc)) {
        (Some(text), _) => text,
        (None, Some(vc)) => format!("{}{unit}", rounded(vc, DIGITS)),
        (None, None) => format!("none: {}", found.outcome),
    };
    writeln!(out, "  {:<16} {vc}", Field::Vc.name())?;
    if let Some(v) = finite(found.v_liftoff).filter(|_| found.decided) {
        writeln!(
            out,
            "  {:<16} {}{unit}",
            Field::VLiftoff.name(),
            rounded(v, DIGITS)
        )?;
    }
    Ok(())
}

fn print_found(
    json: Option<&Inputs>,
    found: &CriticalVelocity,
    units: &Units,
) -> Result<(), Failure> {
    let not_known = not_known(found, units);
    let unit = unit_behind(&Field::Vc.unit(units));
    let told = |key: &str, value: &Value| {
        let rounded = |up: Option<bool>| Some(shown(value.as_f64()?, up) + &unit);
        match (key, &not_known) {
            ("vc", Some(_)) => not_known.clone(),
            // What is decided bounds itself.
            ("vc" | "v_liftoff" | "vc_lower" | "vc_upper", None) => rounded(None),
            ("vc_lower", Some(_)) => rounded(Some(false)),
            ("vc_upper", Some(_)) => rounded(Some(true)),
            ("windows", None) => {
                let of: Vec<[f64; 2]> = serde_json::from_value(value.clone()).ok()?;
                Some(windows(of) + &unit)
            }
            _ => None,
        }
    };
    let hidden: &[&str] = match not_known {
        Some(_) => &["v_liftoff", "windows"],
        None => &[],
    };
    print(json, found, told, hidden, units)
}

/// A velocity with as many digits as are known; a bound upwards or downwards.
fn shown(value: f64, up: Option<bool>) -> String {
    match up {
        Some(up) => bound(value, DIGITS, up),
        None => rounded(value, DIGITS),
    }
}

/// Windows in brackets.
fn windows(of: Vec<[f64; 2]>) -> String {
    let ends = of.into_iter().map(|ends| ends.map(|end| shown(end, None)));
    let ends: Vec<String> = ends.map(|[from, to]| format!("[{from},{to}]")).collect();
    format!("[{}]", ends.join(","))
}

/// Prints the object as one line of JSON with its inputs, or its entries one per line. For people
/// the value of a key is `told` in words of its own, if it has any, and keys are `hidden`.
fn print(
    json: Option<&Inputs>,
    found: &impl Serialize,
    told: impl Fn(&str, &Value) -> Option<String>,
    hidden: &[&str],
    units: &Units,
) -> Result<(), Failure> {
    if let Some(inputs) = json {
        return json::print(inputs, found);
    }
    let mut out = ForPeople::begin();
    let value = serde_json::to_value(found).map_err(std::io::Error::from)?;
    let entries = value.as_object().into_iter().flatten();
    for (key, value) in entries.filter(|(key, _)| !hidden.contains(&key.as_str())) {
        let unit = unit_behind(&unit_of(key, units));
        let shown = match (told(key, value), value) {
            (Some(text), _) => text,
            (None, Value::String(text)) => text.clone(),
            (None, Value::Null) => "none".into(),
            (None, other) => format!("{other}{unit}"),
        };
        writeln!(out, "{key:<20} {shown}")?;
    }
    if units.dimensionless() {
        writeln!(out, "{:<20} none: dimensionless", "units")?;
    }
    Ok(())
}

/// The unit of the value of a key.
fn unit_of(key: &str, units: &Units) -> String {
    // The field `windows` is their number, which has no unit.
    let field = match key {
        "windows" => Some(Field::Vc),
        _ => Field::from_name(key),
    };
    field.map_or_else(|| "1".into(), |field| field.unit(units))
}

impl Args {
    /// Reports the critical velocity of a setting.
    fn tell(
        &self,
        found: &CriticalVelocity,
        setting: &Setting,
        units: &Units,
        protocol: search::Protocol,
    ) -> Result<(), Failure> {
        warn_beyond_curve(found.beyond_curve(setting, units));
        let inputs = inputs(setting, units, protocol);
        if !self.json {
            inputs_line::print(&mut ForPeople::begin(), setting, units, &[Parameter::V0])?;
        }
        print_found(self.json.then_some(&inputs), found, units)
    }

    /// The setting, from a file or from flags, and its units.
    fn read(&self) -> Result<(Setting, Units), Failure> {
        if let Some(point) = self.file.point(PointOf::CriticalVelocityOfSetting)? {
            alone("--setting", self.parameters.any_but(&[]))?;
            return Ok((point.setting, point.units));
        }
        let setting = self.parameters.setting_without_v0()?;
        self.parameters.tell_static_friction("v_c depends on it");
        Ok((setting, self.parameters.units()))
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
