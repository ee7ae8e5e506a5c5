//! What the title of a column says: which quantity stands below it, and its unit.

use super::options::Role;

/// Words for speeds.
const SPEED: [&str; 9] = [
    "speed",
    "velocity",
    "vel",
    "v",
    "v0",
    "geschwindigkeit",
    "gleitgeschwindigkeit",
    "vitesse",
    "velocidad",
];
/// Words for a coefficient, whatever stands beside them.
const COEFFICIENT: [&str; 2] = ["coefficient", "coeff"];
/// Words for coefficients of friction.
const MU: [&str; 12] = [
    "mu",
    "muk",
    "μ",
    "μk",
    "µ",
    "µk",
    "cof",
    "friction",
    "reibwert",
    "reibungszahl",
    "reibungskoeffizient",
    "reibkoeffizient",
];
/// Words for the force of friction.
const FORCE: [&str; 9] = [
    "force",
    "f",
    "ff",
    "fr",
    "ft",
    "kraft",
    "reibkraft",
    "reibungskraft",
    "tangential",
];
/// Words for the load, also as a force.
const LOAD: [&str; 9] = [
    "load",
    "normal",
    "normale",
    "fn",
    "normalkraft",
    "normallast",
    "last",
    "auflast",
    "anpresskraft",
];
/// Words for how far a column beside it may be off.
const ERROR: [&str; 8] = [
    "error",
    "err",
    "stderr",
    "std",
    "sd",
    "uncertainty",
    "fehler",
    "unsicherheit",
];
/// The name of a column that says whether a row was measured while sliding, as `slipmap measure`
/// writes it.
const SETTLED: &str = "settled";
/// The symbol of the load: a small one counts rows.
const SYMBOL_OF_LOAD: &str = "N";

/// A title.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Title<'t> {
    /// The whole of it.
    pub text: &'t str,
    name: &'t str,
    /// The unit in brackets, or after a slash between blanks.
    pub unit: Option<&'t str>,
}

impl<'t> Title<'t> {
    pub(super) fn of(text: &'t str) -> Self {
        let split = text
            .split_once(['[', '('])
            .or_else(|| text.split_once(" / "))
            .or_else(|| text.split_once(" in "));
        let (name, unit) = match split {
            Some((name, unit)) => (name, Some(unit)),
            None => (text, None),
        };
        let unit =
            unit.map(|unit| unit.trim_matches(|c: char| c.is_whitespace() || "[]()".contains(c)));
        Self {
            text,
            name: name.trim(),
            unit: unit.filter(|unit| !["", "1", "-", "–"].contains(unit)),
        }
    }

    /// Whether this name is meant: that of the title, with or without its unit.
    pub(super) fn is(&self, name: &str) -> bool {
        let same = |own: &str| own.to_lowercase() == name.to_lowercase();
        same(self.text) || same(self.name)
    }

    /// Whether the column says if a row settled.
    pub(super) fn tells_settled(&self) -> bool {
        self.name.eq_ignore_ascii_case(SETTLED)
    }

    /// What the column holds, where the title has a common name for it.
    pub(super) fn role(&self) -> Option<Role> {
        let name = self.name.to_lowercase().replace("load cell", "");
        let words: Vec<&str> = name.split(|c: char| !c.is_alphanumeric()).collect();
        let has = |known: &[&str]| words.iter().any(|word| known.contains(word));
        if has(&ERROR) {
            return None;
        }
        if self.name == SYMBOL_OF_LOAD || name.split_whitespace().any(is_normal_force) {
            return Some(Role::Load);
        }
        let named: [(&[&str], Role); 5] = [
            (&COEFFICIENT, Role::Mu),
            (&LOAD, Role::Load),
            (&FORCE, Role::Force),
            (&MU, Role::Mu),
            (&SPEED, Role::Speed),
        ];
        named
            .into_iter()
            .find_map(|(known, role)| has(known).then_some(role))
    }
}

/// Whether a word is F with the index N, such as `F_n` or `F_{N}`.
fn is_normal_force(word: &str) -> bool {
    let marks = |c: char| !c.is_alphanumeric();
    let parts: Vec<&str> = word.split(marks).filter(|part| !part.is_empty()).collect();
    parts.windows(2).any(|pair| pair == ["f", "n"])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn titles_tell_what_and_in_which_unit() {
        use Role::{Force, Load, Mu, Speed};
        for (text, role, unit) in [
            ("speed", Some(Speed), None),
            ("Sliding velocity [mm/s]", Some(Speed), Some("mm/s")),
            ("v / (m/s)", Some(Speed), Some("m/s")),
            ("v_belt (mm/s)", Some(Speed), Some("mm/s")),
            ("Geschwindigkeit in mm/s", Some(Speed), Some("mm/s")),
            ("mu_k", Some(Mu), None),
            ("mu_k_error", None, None),
            ("v (std)", Some(Speed), Some("std")),
            ("friction error [N]", None, Some("N")),
            ("settled", None, None),
            ("µ [-]", Some(Mu), None),
            ("friction coefficient", Some(Mu), None),
            ("friction", Some(Mu), None),
            ("Coefficient of friction force", Some(Mu), None),
            ("Friction force (N)", Some(Force), Some("N")),
            ("F_t [mN]", Some(Force), Some("mN")),
            ("Normal force", Some(Load), None),
            ("load [N]", Some(Load), Some("N")),
            ("FN", Some(Load), None),
            ("F_n", Some(Load), None),
            ("F_N [N]", Some(Load), Some("N")),
            ("$F_{N}$ (kN)", Some(Load), Some("kN")),
            ("F-n", Some(Load), None),
            ("N", Some(Load), None),
            ("N (N)", Some(Load), Some("N")),
            ("force normale [N]", Some(Load), Some("N")),
            ("n", None, None),
            ("F [N]", Some(Force), Some("N")),
            ("F N", Some(Force), None),
            ("Load cell (V)", None, Some("V")),
            ("time [s]", None, Some("s")),
            ("index", None, None),
            ("", None, None),
        ] {
            let title = Title::of(text);
            assert_eq!((title.role(), title.unit), (role, unit), "{text}");
        }
        let title = Title::of("Force (N)");
        assert!(title.is("force") && title.is("force (n)") && !title.is("f"));
    }
}
