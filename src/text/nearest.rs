//! Suggestions for unknown names.

/// The similarity from which two names count as near; equal names have similarity 1.
const NEAR: f64 = 0.6;

/// The name among `known` that is most similar to `name`, if one is near; the first of equals.
/// Upper and lower case count as equal, and so do `-` and `_`.
#[must_use]
pub(crate) fn nearest<'k>(name: &str, known: impl IntoIterator<Item = &'k str>) -> Option<&'k str> {
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
pub(crate) fn did_you_mean<'k>(name: &str, known: impl IntoIterator<Item = &'k str>) -> String {
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
