//! The command line for a setting.

use super::law_kind::LawKind;
use super::parameter::Parameter;
use super::search::Protocol;
use super::setting_text::of_point;
use super::system::shipped;
use super::values::Setting;
use crate::critical::switch_on::Phase;

/// `slipmap COMMAND` with the friction law of a setting and its `wanted` parameters. Default values
/// are left out, and numbers have the fewest digits from which they are read unchanged. None for a
/// table and for a fitted law, which are in a file.
#[must_use]
pub fn command_line(
    command: &str,
    setting: &Setting,
    wanted: impl Fn(Parameter) -> bool,
) -> Option<String> {
    let law = match setting.law() {
        None => String::new(),
        // The errors of a fit are in a file, as points are.
        Some(_) if setting.fit_errors().is_some() => return None,
        Some(LawKind::Table(_)) => return None,
        Some(law) => format!(" --friction={}", law.name()),
    };
    let formula = setting.formula().map_or_else(String::new, |formula| {
        let own = setting.own().filter(|(_, value)| !value.is_nan());
        let sets = own.map(|(own, value)| format!(" --set={}={value}", own.name));
        format!(" --mu-k='{}'{}", formula.text(), sets.collect::<String>())
    });
    let flags = Parameter::ALL.into_iter().filter_map(|parameter| {
        let value = setting.get(parameter);
        let default = parameter.default_value().map(f64::to_bits);
        let said = wanted(parameter) && !value.is_nan() && default != Some(value.to_bits());
        let flag = parameter.long_flag().filter(|_| said)?;
        Some(format!(" --{flag}={value}"))
    });
    Some(format!(
        "slipmap {command}{law}{formula}{}",
        flags.collect::<String>()
    ))
}

/// `slipmap vc` for a setting; its v0 and its start are ignored.
#[must_use]
pub fn vc_command(setting: &Setting, protocol: Protocol) -> Option<String> {
    let command = match protocol {
        Protocol::Follow => "vc".to_owned(),
        Protocol::SwitchOn(Phase::Worst(_)) => "vc --protocol=switch-on --phase=worst".to_owned(),
        Protocol::SwitchOn(Phase::After(time)) => {
            format!("vc --protocol=switch-on --phase={time}")
        }
    };
    let known = |p: Parameter| setting.uses(p) && !p.of_start() && p != Parameter::V0;
    command_line(&command, setting, known)
}

/// `slipmap point` for a setting. None for a table and for a system that is no part of the program,
/// whose files are not known.
#[must_use]
pub fn point_command(setting: &Setting) -> Option<String> {
    command_at("point", setting)
}

/// The command line that asks `command`, which is `point` or `margins`, about a point; none for
/// measured friction and for a system that is not part of the program.
#[must_use]
pub fn command_at(command: &str, setting: &Setting) -> Option<String> {
    let Some(model) = setting.system() else {
        return command_line(command, setting, |parameter| of_point(setting, parameter));
    };
    let known = |name: &str| shipped::system(name).is_some_and(|known| known == *model);
    let mut names = shipped::SHIPPED.into_iter().map(|(name, _)| name);
    let name = names.find(|name| known(name))?;
    let sets: String = setting
        .own()
        .filter(|(own, value)| own.default.to_bits() != value.to_bits())
        .map(|(own, value)| format!(" --set={}={value}", own.name))
        .collect();
    let others = setting.others().iter().filter(|p| setting.uses(**p));
    let others: String = others
        .map(|p| format!(" --{}={}", p.name(), setting.get(*p)))
        .collect();
    Some(format!("slipmap {command} --system={name}{sets}{others}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setting::point_file::{PointOf, PointSpec};

    fn said(command: &str, text: &str, of: PointOf) -> Option<String> {
        let setting = PointSpec::read(text, of).unwrap().setting;
        command_line(command, &setting, |parameter| setting.uses(parameter))
    }

    #[test]
    fn only_what_is_given_is_said_and_to_the_last_digit() {
        let text = "[fixed]\nmu_prime = -0.30000000000000004\ntau = 1e-9\nalpha_v = 0\nmu_k = 1\n";
        let flags = "--mu-prime=-0.30000000000000004 --tau=0.000000001";
        let found = said("point", text, PointOf::Sliding).unwrap();
        assert_eq!(found, format!("slipmap point {flags}"));
        let text = "[fixed]\nalpha_n = -2\ntau = 0.5\nmass = 4\n[friction]\nlaw = \"weakening\"\n\
            mu_prime_rest = -1\nv_s = 0.5\n";
        let flags = "--friction=weakening --alpha-n=-2 --tau=0.5 --mass=4 --v-s=0.5 \
            --mu-prime-rest=-1";
        let found = said("vc", text, PointOf::CriticalVelocity).unwrap();
        assert_eq!(found, format!("slipmap vc {flags}"));
    }

    #[test]
    fn a_table_is_not_said_by_flags() {
        let text = "[fixed]\nv0 = 0.1\ntau = 1\n[friction]\nlaw = \"table\"\n\
            speeds = [0, 1]\nmu_k = [0.9, 0.5]\n";
        assert_eq!(said("point", text, PointOf::Sliding), None);
    }
}
