//! How a text of columns is to be read, and how that is said.

use super::speed_unit::SpeedUnit;
use crate::setting::units::Units;
use crate::text::nearest::did_you_mean;

/// What a column of a measured curve holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    Speed,
    Mu,
    Force,
    Load,
}

impl Role {
    pub(super) const ALL: [Self; 4] = [Self::Speed, Self::Mu, Self::Force, Self::Load];

    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Speed => "speed",
            Self::Mu => "mu",
            Self::Force => "force",
            Self::Load => "load",
        }
    }
}

/// Which columns hold what, each by its title or its number from 1 on.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Columns(Vec<(Role, String)>);

impl Columns {
    /// Columns from a text such as `speed=2,force=4` or `speed=v_belt,mu=5`.
    ///
    /// # Errors
    /// Says what is expected.
    pub fn read(text: &str) -> Result<Self, String> {
        let mut columns: Vec<(Role, String)> = Vec::new();
        for part in text.split(',') {
            let (name, column) = part
                .split_once('=')
                .ok_or("expected a list like speed=2,mu=3 or speed=v,force=F,load=5")?;
            let (name, column) = (name.trim(), column.trim());
            let mut roles = Role::ALL.into_iter();
            let role = roles.find(|role| role.name() == name).ok_or_else(|| {
                let known = Role::ALL.map(Role::name);
                let meant = did_you_mean(name, known);
                format!(
                    "no column is called {name}: {meant}known: {}",
                    known.join(", ")
                )
            })?;
            if columns.iter().any(|(given, _)| *given == role) {
                return Err(format!("{name} is given twice"));
            }
            if column.is_empty() {
                return Err(format!("the column of {name} is not said: {name}=2"));
            }
            columns.push((role, column.to_owned()));
        }
        let columns = Self(columns);
        match (
            columns.of(Role::Mu),
            columns.of(Role::Force).or(columns.of(Role::Load)),
        ) {
            (Some(_), Some(_)) => Err("mu is there already: a force and a load make it".into()),
            _ => Ok(columns),
        }
    }

    /// The column with this role, if it is given.
    pub(super) fn of(&self, role: Role) -> Option<&str> {
        let mut columns = self.0.iter();
        columns.find_map(|(of, column)| (*of == role).then_some(&**column))
    }
}

/// How options are said to the one who gives them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Spoken {
    /// As flags: `--speed-unit mm/s`.
    #[default]
    Flags,
    /// As keys of a file: `speed_unit = "mm/s"`.
    Keys,
}

impl Spoken {
    /// How to say which columns hold what.
    pub(super) fn columns(self, columns: &str) -> String {
        match self {
            Self::Flags => format!("--columns {columns}"),
            Self::Keys => format!("table = {{ …, columns = \"{columns}\" }}"),
        }
    }

    /// How to say the load.
    pub(super) const fn normal_load(self) -> &'static str {
        match self {
            Self::Flags => "--normal-load 12.5",
            Self::Keys => "normal_load = 12.5 in [fixed] or in the table",
        }
    }

    /// How to say the unit of speeds.
    pub(super) fn speed_unit(self, unit: &str) -> String {
        match self {
            Self::Flags => format!("--speed-unit {unit}"),
            Self::Keys => format!("table = {{ …, speed_unit = \"{unit}\" }}"),
        }
    }

    /// How to say the units of a setting.
    pub(super) const fn units(self) -> &'static str {
        match self {
            Self::Flags => "--units SI",
            Self::Keys => "units = \"SI\"",
        }
    }
}

/// How a text of columns is to be read.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CurveOptions {
    /// Which columns hold what, as far as titles do not tell.
    pub columns: Columns,
    /// The load by which forces are divided, where no column has it.
    pub normal_load: Option<f64>,
    /// The unit of the speeds; none: that of their title, or that of the setting.
    pub speed_unit: Option<SpeedUnit>,
    /// The units of the setting.
    pub units: Units,
    /// How options are said.
    pub spoken: Spoken,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_given_by_name_or_number() {
        let columns = Columns::read("speed=2, force = F (N)").unwrap();
        assert_eq!(columns.of(Role::Speed), Some("2"));
        assert_eq!(columns.of(Role::Force), Some("F (N)"));
        assert_eq!(columns.of(Role::Mu), None);
        for (text, why) in [
            ("", "expected a list"),
            ("2,4", "expected a list"),
            ("spede=2", "did you mean `speed`?"),
            ("speed=1,speed=2", "twice"),
            ("speed=", "is not said"),
            ("mu=1,force=2", "there already"),
        ] {
            assert!(Columns::read(text).unwrap_err().contains(why), "{text}");
        }
    }
}
