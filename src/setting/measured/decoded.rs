//! The bytes of a text of columns as spreadsheets save it.

use encoding_rs::{Encoding, WINDOWS_1252};

/// The text in UTF-8, in UTF-16 with a byte order mark, or else in Windows-1252.
///
/// # Errors
/// Says why the bytes are no text.
pub fn decoded(bytes: Vec<u8>) -> Result<String, String> {
    let text = match Encoding::for_bom(&bytes) {
        Some((encoding, _)) => encoding.decode(&bytes).0.into_owned(),
        None => String::from_utf8(bytes)
            .unwrap_or_else(|error| WINDOWS_1252.decode(error.as_bytes()).0.into_owned()),
    };
    let no_text = |c: char| c.is_control() && !c.is_whitespace();
    match text.contains(no_text) {
        true => Err("it is not text: save the columns as CSV".into()),
        false => Ok(text),
    }
}
