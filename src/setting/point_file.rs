//! A point of parameter space as text: the tables that sweep and case files share.
//!
//! ```toml
//! [fixed]                         # as in sweep files
//! v0 = 0.35                       # or "350 mm/s": any number may have a unit
//! alpha_v = -0.33
//! tau = 4.15
//!
//! [friction]                      # optional, as in sweep files
//! law = "weakening"
//! mu0 = 0.5
//! v_s = 0.5
//!
//! [units]                         # optional, as in sweep files
//! ```
//!
//! In the place of `[friction]`, a point of sliding may have a `system`, as in sweep files;
//! `[fixed]` then has its parameters.
//!
//! For the critical velocity there may also be `protocol`, `phase` and, in `[start]`,
//! `switch_on_phase`, as in sweep files.

use super::amount::units_of;
use super::given::GivenParameters;
use super::given_system::GivenSystem;
use super::parameter::{Group, Parameter};
use super::search::Protocol;
use super::units::Units;
use super::values::Setting;
use super::vc_keys::VcKeys;
use crate::text::document::Document;
use crate::text::toml_reader::{SpecError, entries, parse};

/// What a point is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PointOf {
    /// Sliding: all parameters on which its stability depends.
    Sliding,
    /// Sliding at a delay that is searched for: one in the file is not needed.
    SlidingAtAnyDelay,
    /// Its critical velocity: a friction law, no v0, and a delay only if control acts.
    CriticalVelocity,
    /// The critical velocity of a setting, whose v0 is ignored if it has one.
    CriticalVelocityOfSetting,
    /// Its friction law alone.
    Law,
    /// Its friction law or its system, of which parameters may be missing: they vary.
    Subject,
}

impl PointOf {
    /// Whether a point for this purpose has the parameter.
    const fn takes(self, parameter: Parameter) -> bool {
        match (self, parameter.group()) {
            (_, Group::Limit | Group::Start) => false,
            (Self::Sliding | Self::SlidingAtAnyDelay | Self::Subject, _) => true,
            (Self::CriticalVelocity, Group::Pull) => false,
            (_, group) => !matches!(group, Group::Sliding),
        }
    }
}

/// A point: every value in range, every name known.
#[derive(Debug, Clone, PartialEq)]
pub struct PointSpec {
    /// All parameters.
    pub setting: Setting,
    /// Their units.
    pub units: Units,
    /// The protocol for the critical velocity.
    pub protocol: Protocol,
}

impl PointSpec {
    /// Reads a point.
    ///
    /// # Errors
    /// Points at the first place that is not understood, out of range or contradictory.
    pub fn read(text: &str, of: PointOf) -> Result<Self, SpecError> {
        let parsed = parse(text)?;
        let keys: &[&str] = match of {
            PointOf::CriticalVelocity => {
                &["protocol", "phase", "fixed", "friction", "start", "units"]
            }
            PointOf::CriticalVelocityOfSetting | PointOf::Law => &["fixed", "friction", "units"],
            PointOf::Sliding | PointOf::SlidingAtAnyDelay | PointOf::Subject => {
                &["system", "fixed", "friction", "units"]
            }
        };
        let entries = entries(parsed.get_ref(), "");
        let mut document = Document::of(entries, keys.iter().copied());
        if let Some(system) = GivenSystem::of(&mut document, text)? {
            return Self::of_system(document, system, of);
        }
        let given = GivenParameters::of(&mut document, text, |p| of.takes(p));
        let search = VcKeys::of(&mut document, &Protocol::NAMES);
        document.finish()?;
        let phase = given.place(Parameter::SwitchOnPhase);
        let protocol = search.search(&document, phase)?.protocol;
        let mut setting = given.setting();
        match of {
            PointOf::Sliding => setting = given.sliding(&[])?,
            PointOf::SlidingAtAnyDelay => setting = given.sliding(&[Parameter::Tau])?,
            PointOf::CriticalVelocity => check_critical(&given, &mut setting)?,
            PointOf::CriticalVelocityOfSetting => check_critical_of(&given, &mut setting)?,
            PointOf::Law => {
                given.check(&[Parameter::V0, Parameter::Tau], None)?;
            }
            PointOf::Subject => {
                return Ok(Self {
                    setting,
                    units: given.units().clone(),
                    protocol,
                });
            }
        }
        // Without v0, only the law itself can be checked.
        let law = setting.friction_law();
        law.map_err(|error| given.refused(&error))?;
        Ok(Self {
            protocol: protocol.at(&setting),
            setting,
            units: given.units().clone(),
        })
    }
}

impl PointSpec {
    /// Reads a point of a system.
    fn of_system(
        mut document: Document,
        mut system: GivenSystem,
        of: PointOf,
    ) -> Result<Self, SpecError> {
        let units = units_of(&mut document);
        document.each(&["fixed"], |table| system.read_fixed(table, &units));
        document.finish()?;
        if of == PointOf::Sliding {
            system.check_delay(None)?;
        }
        Ok(Self {
            setting: system.setting,
            units,
            protocol: Protocol::Follow,
        })
    }
}

/// Checks that there is a friction law, no v0, and a delay unless both gains are 0.
fn check_critical(given: &GivenParameters, setting: &mut Setting) -> Result<(), SpecError> {
    if let (Some(_), Some(place)) = (given.law_place(), given.place(Parameter::V0)) {
        let message = "v0 is what is looked for";
        return Err(SpecError::at(place.clone(), message).help("leave it out"));
    }
    check_critical_of(given, setting)
}

/// Checks that there is a friction law, and a delay unless both gains are 0.
fn check_critical_of(given: &GivenParameters, setting: &mut Setting) -> Result<(), SpecError> {
    if given.law_place().is_none() {
        let message = "the critical velocity depends on the whole friction law";
        return Err(SpecError::whole(message)
            .help("for example: [friction] law = \"weakening\", mu0 = 0.5, v_s = 0.5"));
    }
    given.check_motions()?;
    for parameter in [Parameter::XDot0, Parameter::A0] {
        if let Some(place) = given.place(parameter) {
            let message = format!("{} has no meaning here", parameter.name());
            let help = "the critical velocity is that of stick-slip, which has no other start";
            return Err(SpecError::at(place.clone(), message).help(help));
        }
    }
    let mut optional = vec![Parameter::V0];
    if !setting.control().act() {
        optional.push(Parameter::Tau);
    }
    given.check(&optional, given.law_place())?;
    if setting.get(Parameter::Tau).is_nan() {
        setting.set(Parameter::Tau, 0.0);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::critical::switch_on::Phase;
    use crate::setting::search::PHASES;

    const LAW: &str = "[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";

    #[test]
    fn a_point_is_read_for_what_is_asked_of_it() {
        let sliding = format!("[fixed]\nv0 = 0.35\nalpha_v = -0.33\ntau = 4.15\n{LAW}");
        let point = PointSpec::read(&sliding, PointOf::Sliding).unwrap();
        assert_eq!(point.setting.get(Parameter::Tau), 4.15);
        let point = PointSpec::read(LAW, PointOf::CriticalVelocity).unwrap();
        assert_eq!(point.setting.get(Parameter::Tau), 0.0);
    }

    #[test]
    fn the_protocol_of_a_critical_velocity_is_read() {
        let protocol = |text: &str| {
            let text = format!("{text}[fixed]\nalpha_v = -0.33\ntau = 4.15\n{LAW}");
            let read = PointSpec::read(&text, PointOf::CriticalVelocity);
            read.map(|point| point.protocol)
                .map_err(|error| error.message)
        };
        assert_eq!(protocol(""), Ok(Protocol::Follow));
        let switch_on = "protocol = \"switch-on\"\n";
        let after = |phase| Ok(Protocol::SwitchOn(Phase::After(phase)));
        assert_eq!(protocol(switch_on), after(0.0));
        let phase = format!("{switch_on}start = {{ switch_on_phase = 0.25 }}\n");
        assert_eq!(protocol(&phase), after(0.25));
        let worst = format!("{switch_on}phase = \"worst\"\n");
        let all = Protocol::SwitchOn(Phase::Worst(PHASES));
        assert_eq!(protocol(&worst), Ok(all));
        assert!(protocol("phase = \"worst\"\n").is_err());
        let start = "start = { x_dot0 = 0.25 }\n";
        assert!(protocol(start).unwrap_err().contains("x_dot0"));
        assert!(protocol("verify = 0.5\n").unwrap_err().contains("verify"));
    }

    #[test]
    fn what_does_not_fit_is_told_in_its_place() {
        let place = |text: &str, of: PointOf| {
            let error = PointSpec::read(text, of).unwrap_err();
            (error.span.map(|span| text[span].to_owned()), error.message)
        };
        let with_v0 = format!("[fixed]\nv0 = 0.35\n{LAW}");
        let (span, message) = place(&with_v0, PointOf::CriticalVelocity);
        assert_eq!(
            (span.as_deref(), &*message),
            (Some("v0"), "v0 is what is looked for")
        );
        let gained = format!("[fixed]\nalpha_v = -0.33\n{LAW}");
        let (_, message) = place(&gained, PointOf::CriticalVelocity);
        assert_eq!(message, "tau is not given");
        let (span, _) = place("[axes]\n", PointOf::Sliding);
        assert_eq!(span.as_deref(), Some("axes"));
        let (span, message) = place("[fixed]\ntau = -1\nmu_prime = 0.1\n", PointOf::Sliding);
        assert!(
            span.as_deref() == Some("-1") && message.contains("tau"),
            "{message}"
        );
        let ill = "[fixed]\nv0 = 0.1\ntau = 1\n[friction]\nlaw = \"coulomb\"\nmu0 = 2\n";
        assert!(place(ill, PointOf::Sliding).1.contains("mu0"));
    }
}
