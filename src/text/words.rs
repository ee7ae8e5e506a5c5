//! Words that are names: their letters, ASCII or Greek, and which spellings are one name.

use std::borrow::Cow;

/// The Greek letters of names. Those that look like Latin letters, `ο` and most capitals, are none.
const GREEK: &str = "αβγδεζηθικλμνξπρστυφχψωΓΔΘΛΞΠΣΦΨΩ";
/// Greek letters that cannot be told from Latin ones.
const LIKE_LATIN: &str = "οΑΒΕΖΗΙΚΜΝΟΡΤΥΧ";
/// Second forms of Greek letters, each with the letter that it is.
const FORMS: [(char, char); 8] = [
    ('\u{b5}', 'μ'),
    ('\u{3d1}', 'θ'),
    ('\u{3d5}', 'φ'),
    ('\u{3f0}', 'κ'),
    ('\u{3f1}', 'ρ'),
    ('\u{3f5}', 'ε'),
    ('\u{2126}', 'Ω'),
    ('\u{2206}', 'Δ'),
];
/// Greek letters that are names of their own, each with its name in ASCII.
const NAMES: [(&str, &str); 2] = [("τ", "tau"), ("π", "pi")];

/// The usual form of a letter.
fn usual(letter: char) -> char {
    let form = FORMS.iter().find(|(form, _)| *form == letter);
    form.map_or(letter, |(_, usual)| *usual)
}

/// Whether a name may begin with this character.
pub(crate) fn begins(c: char) -> bool {
    c.is_ascii_alphabetic() || GREEK.contains(usual(c))
}

/// Whether this character may stand in a name.
pub(crate) fn belongs(c: char) -> bool {
    begins(c) || c.is_ascii_digit() || c == '_'
}

/// What is said of a character that may not stand in a name, where it is a Greek letter.
pub(crate) fn greek_advice(c: char) -> Option<String> {
    let alike = LIKE_LATIN.contains(c);
    alike.then(|| format!("the Greek `{c}` cannot be told from a Latin letter: type the Latin one"))
}

/// The spelling of a name by which it is known: each Greek letter in its usual form, and `tau` and
/// `pi` for τ and π alone.
pub(crate) fn spelled(name: &str) -> Cow<'_, str> {
    if name.is_ascii() {
        return name.into();
    }
    let letters: String = name.chars().map(usual).collect();
    match NAMES.iter().find(|(greek, _)| *greek == letters) {
        Some((_, ascii)) => (*ascii).into(),
        None => letters.into(),
    }
}

/// Whether two spellings are one name.
pub(crate) fn same(first: &str, second: &str) -> bool {
    first == second || spelled(first) == spelled(second)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn greek_letters_have_one_form_and_none_looks_latin() {
        for (first, second, one) in [
            ("\u{b5}", "\u{3bc}", true),
            ("\u{2126}_2", "\u{3a9}_2", true),
            ("\u{3c4}", "tau", true),
            ("\u{3c0}", "pi", true),
            ("\u{3c4}_2", "tau_2", false),
            ("\u{3bd}", "v", false),
            ("omega", "\u{3c9}", false),
        ] {
            assert_eq!(same(first, second), one, "{first} {second}");
        }
        assert!("ωζµϕ∆".chars().all(begins) && "ω_2".chars().all(belongs));
        for letter in LIKE_LATIN.chars() {
            assert!(!belongs(letter) && greek_advice(letter).is_some());
        }
        assert!(!belongs('ö') && !belongs('ώ') && !begins('2') && greek_advice('ω').is_none());
    }
}
