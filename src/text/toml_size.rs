//! Bounds the memory for reading TOML: counts the signs and words of a text before it is read.
//!
//! Each of them takes about a hundred bytes while a text is read.

use super::toml_reader::SpecError;

/// The most signs and words: brackets, commas, dots, keys, values, line ends, runs of blanks. A
/// number is one word, and a comma counts together with blanks and one line end behind it.
const MOST: u64 = 2_000_000;

/// Refuses a text with too many signs and words.
///
/// # Errors
/// Points at the first one that is too many.
pub(crate) fn check(text: &str) -> Result<(), SpecError> {
    let bytes = text.as_bytes();
    let (mut at, mut count) = (0, 0);
    while at < bytes.len() {
        count += 1;
        if count > MOST {
            let message = format!("more than {MOST} words and signs, which is too much to read");
            let help = "an axis of many points is written as { from = 0, to = 1, points = 1000 }";
            return Err(SpecError::at(at..at + 1, message).help(help));
        }
        at += length(&bytes[at..]);
    }
    Ok(())
}

/// The length of the sign or word at the beginning of `bytes`, which are not empty.
fn length(bytes: &[u8]) -> usize {
    let until = |end: &dyn Fn(u8) -> bool| {
        let rest = bytes[1..].iter();
        1 + rest.take_while(|byte| !end(**byte)).count()
    };
    match bytes[0] {
        b' ' | b'\t' => until(&|byte| !matches!(byte, b' ' | b'\t')),
        b'#' => until(&|byte| byte == b'\n'),
        quote @ (b'"' | b'\'') => length_of_string(bytes, quote),
        b',' => length_of_comma(bytes),
        b'0'..=b'9' | b'+' | b'-' => length_of_number(bytes),
        sign if is_sign(sign) => 1,
        _ => length_of_word(bytes),
    }
}

/// The length of a word, of which the first byte is not looked at.
fn length_of_word(bytes: &[u8]) -> usize {
    let ends = |byte| is_sign(byte) || matches!(byte, b' ' | b'\t' | b'#' | b'"' | b'\'');
    1 + bytes[1..].iter().take_while(|byte| !ends(**byte)).count()
}

/// The length of a number with its decimal point, or else of a word: dots divide keys of digits.
fn length_of_number(bytes: &[u8]) -> usize {
    let whole = length_of_word(bytes);
    if bytes.get(whole) != Some(&b'.') {
        return whole;
    }
    let end = whole + length_of_word(&bytes[whole..]);
    match bytes[end + blanks(&bytes[end..])..].first() {
        Some(b'.' | b'=') => whole,
        _ => end,
    }
}

/// The length of a comma with the blanks behind it, one line end, and the blanks of the next line.
fn length_of_comma(bytes: &[u8]) -> usize {
    let mut at = 1 + blanks(&bytes[1..]);
    let line_end = match &bytes[at..] {
        [b'\n', ..] => 1,
        [b'\r', b'\n', ..] => 2,
        _ => return at,
    };
    at += line_end;
    at + blanks(&bytes[at..])
}

/// The number of blanks at the beginning of `bytes`.
fn blanks(bytes: &[u8]) -> usize {
    let blank = |byte: &&u8| matches!(byte, b' ' | b'\t');
    bytes.iter().take_while(blank).count()
}

fn is_sign(byte: u8) -> bool {
    matches!(
        byte,
        b'.' | b'=' | b',' | b'[' | b']' | b'{' | b'}' | b'\r' | b'\n'
    )
}

/// The length of a string with its quotes; one that does not end goes to the end of its line, or of
/// the text after three quotes.
fn length_of_string(bytes: &[u8], quote: u8) -> usize {
    let three = [quote; 3];
    let (end, one_line): (&[u8], _) = match bytes.starts_with(&three) {
        true => (&three, false),
        false => (&three[..1], true),
    };
    let mut at = end.len();
    while at < bytes.len() {
        match bytes[at] {
            b'\\' if quote == b'"' => at += 1,
            b'\n' if one_line => return at,
            _ if bytes[at..].starts_with(end) => return at + end.len(),
            _ => {}
        }
        at += 1;
    }
    bytes.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parts(text: &str) -> Vec<&str> {
        let (mut at, mut parts) = (0, Vec::new());
        while at < text.len() {
            let next = at + length(&text.as_bytes()[at..]);
            parts.push(&text[at..next]);
            at = next;
        }
        parts
    }

    #[test]
    fn texts_are_cut_at_their_signs() {
        let text =
            "a.b = [1.5, \"x, \\\" #y\"] # c, d\n'k' = '''\n, ''' \"open, \n= \"\"\"open, \n";
        let cut = [
            "a",
            ".",
            "b",
            " ",
            "=",
            " ",
            "[",
            "1.5",
            ", ",
            "\"x, \\\" #y\"",
            "]",
            " ",
            "# c, d",
            "\n",
            "'k'",
            " ",
            "=",
            " ",
            "'''\n, '''",
            " ",
            "\"open, ",
            "\n",
            "=",
            " ",
            "\"\"\"open, \n",
        ];
        assert_eq!(parts(text), cut);
        assert_eq!(parts("µ=\"ä\\"), ["µ", "=", "\"ä\\"]);
    }

    #[test]
    fn a_decimal_number_is_one_word_and_a_comma_takes_the_line_end_behind_it() {
        let text = "[-1.5e-3, \r\n\t+2.0,\n\n7,]";
        let cut = [
            "[", "-1.5e-3", ", \r\n\t", "+2.0", ",\n", "\n", "7", ",", "]",
        ];
        assert_eq!(parts(text), cut);
        // Keys of digits are divided.
        assert_eq!(parts("1.2 =3.4"), ["1", ".", "2", " ", "=", "3.4"]);
        assert_eq!(parts("1.2.x"), ["1", ".", "2.x"]);
    }

    #[test]
    fn a_list_of_many_decimals_is_accepted() {
        for behind in [",", ", ", ",\n    "] {
            let list = format!("x = [{}]\n", format!("-1.25{behind}").repeat(600_000));
            assert_eq!(check(&list), Ok(()));
        }
    }

    #[test]
    fn the_first_that_is_too_many_is_pointed_at() {
        let most = usize::try_from(MOST).unwrap();
        assert_eq!(check(&",".repeat(most)), Ok(()));
        let error = check(&format!("{}ab", ",".repeat(most))).unwrap_err();
        assert_eq!(error.span, Some(most..most + 1));
    }
}
