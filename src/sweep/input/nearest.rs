//! What was meant by a name that is not known.

/// Two names are near where so much of them is alike, 1 where all is.
const NEAR: f64 = 0.6;

/// The name of those `known` that is nearest to `name`, the first of equals, if one is near.
/// Capitals are not told from small letters, nor `-` from `_`.
#[must_use]
pub fn nearest<'k>(name: &str, known: impl IntoIterator<Item = &'k str>) -> Option<&'k str> {
    let plain = |name: &str| name.to_lowercase().replace('-', "_");
    let name = plain(name);
    let alike = |known: &str| strsim::normalized_damerau_levenshtein(&name, &plain(known));
    let all = known.into_iter().map(|known| (alike(known), known));
    let near = all.filter(|(alike, _)| *alike >= NEAR);
    let nearer = |a: (f64, _), b: (f64, _)| if b.0 > a.0 { b } else { a };
    near.reduce(nearer).map(|(_, name)| name)
}

/// "did you mean `tau`? ", or nothing.
#[must_use]
pub fn did_you_mean<'k>(name: &str, known: impl IntoIterator<Item = &'k str>) -> String {
    nearest(name, known).map_or_else(String::new, |near| format!("did you mean `{near}`? "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_of_the_finger_is_understood() {
        let known = [
            "mu_prime",
            "alpha_v",
            "alpha_n",
            "tau",
            "abscissa",
            "abscissa_2",
        ];
        for (name, meant) in [
            ("taw", Some("tau")),
            ("tua", Some("tau")),
            ("abscisa", Some("abscissa")),
            ("Alpha-V", Some("alpha_v")),
            ("alphan", Some("alpha_n")),
            ("alpha_w", Some("alpha_v")),
            ("mass", None),
            ("", None),
        ] {
            assert_eq!(nearest(name, known), meant, "{name}");
        }
        assert_eq!(did_you_mean("taw", known), "did you mean `tau`? ");
        assert_eq!(did_you_mean("x", known), "");
        assert_eq!(nearest("tau", []), None);
    }
}
