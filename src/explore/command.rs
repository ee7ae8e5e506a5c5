//! The command lines that give the same answers.

use crate::sweep::input::law_kind::LawKind;
use crate::sweep::{Parameter, Setting};

/// `slipmap point` at a setting, with so many roots; none where flags cannot say it.
pub(super) fn point(setting: &Setting, roots: u8) -> Option<String> {
    Some(format!("slipmap point{} --roots={roots}", flags(setting)?))
}

/// `slipmap vc` of a setting; none where flags cannot say it.
pub(super) fn critical_velocity(setting: &Setting) -> Option<String> {
    Some(format!("slipmap vc{}", flags(setting)?))
}

/// What follows the motion of a case, whose text is in a file of that name.
pub(super) const SIMULATE: &str = "slipmap simulate case.toml";

/// The flags of a setting, each after a blank, but those of default values: numbers in the fewest
/// digits that are read as the same ones. None for a table, whose points are in a file.
fn flags(setting: &Setting) -> Option<String> {
    let law = match setting.law() {
        None => String::new(),
        Some(LawKind::Table(_)) => return None,
        Some(law) => format!(" --friction={}", law.name()),
    };
    let flags = Parameter::ALL.into_iter().filter_map(|parameter| {
        let value = setting.get(parameter);
        let default = parameter.default_value().map(f64::to_bits);
        let said = setting.uses(parameter) && default != Some(value.to_bits());
        let flag = parameter.long_flag().filter(|_| said)?;
        Some(format!(" --{flag}={value}"))
    });
    Some(law + &flags.collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::input::point_file::{PointOf, PointSpec};

    fn setting(text: &str, of: PointOf) -> Setting {
        PointSpec::read(text, of).unwrap().setting
    }

    #[test]
    fn only_what_is_given_is_said_and_to_the_last_digit() {
        let text = "[fixed]\nmu_prime = -0.30000000000000004\ntau = 1e-9\nalpha_v = 0\nmu_k = 1\n";
        let said = point(&setting(text, PointOf::Sliding), 16).unwrap();
        let flags = "--mu-prime=-0.30000000000000004 --tau=0.000000001 --roots=16";
        assert_eq!(said, format!("slipmap point {flags}"));
        let text = "[fixed]\nalpha_n = -2\ntau = 0.5\nmass = 4\n[friction]\nlaw = \"weakening\"\n\
            mu_prime_rest = -1\nv_s = 0.5\n";
        let said = critical_velocity(&setting(text, PointOf::CriticalVelocity)).unwrap();
        let flags = "--friction=weakening --alpha-n=-2 --tau=0.5 --mass=4 --v-s=0.5 \
            --mu-prime-rest=-1";
        assert_eq!(said, format!("slipmap vc {flags}"));
    }

    #[test]
    fn a_table_is_not_said_by_flags() {
        let text = "[fixed]\nv0 = 0.1\ntau = 1\n[friction]\nlaw = \"table\"\n\
            speeds = [0, 1]\nmu_k = [0.9, 0.5]\n";
        assert_eq!(point(&setting(text, PointOf::Sliding), 4), None);
    }
}
