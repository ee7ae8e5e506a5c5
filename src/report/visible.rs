//! Makes texts from files safe for a terminal.

/// A text in which control characters are spelled out, except tabs and line ends. So are characters
/// that change the direction of writing or end a line invisibly. None of them reaches the terminal.
#[must_use]
pub fn visible(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\n' | '\t' => shown.push(c),
            c if c.is_control() || is_unseen(c) => shown.extend(c.escape_default()),
            c => shown.push(c),
        }
    }
    shown
}

/// The most characters of a text in a message.
const LONGEST: usize = 4000;

/// A text on one line, with control characters spelled out, and cut if it is too long to read.
#[must_use]
pub fn visible_line(text: &str) -> String {
    visible(&shortened(text)).replace('\n', "\\n")
}

/// The beginning of a text that is too long for a message, or all of it.
#[must_use]
pub fn shortened(text: &str) -> std::borrow::Cow<'_, str> {
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &text[..end]).into(),
        None => text.into(),
    }
}

/// JSON in which such characters are escaped. They occur only inside its strings, and each has an
/// escape of four digits.
#[must_use]
pub fn visible_json(json: &str) -> String {
    let mut shown = String::with_capacity(json.len());
    for c in json.chars() {
        match c.is_control() || is_unseen(c) {
            true => shown += &format!("\\u{:04x}", u32::from(c)),
            false => shown.push(c),
        }
    }
    shown
}

/// Directional marks, embeddings, overrides and isolates, line and paragraph separators, the byte
/// order mark.
fn is_unseen(c: char) -> bool {
    matches!(
        c,
        '\u{61c}'
            | '\u{200b}'..='\u{200f}'
            | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}'
            | '\u{feff}'
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_moves_the_cursor() {
        let text = "a\u{1b}[2J\u{7}\u{9b}1m\r\u{7f}\u{202e}b\u{2066}µ\n\tc";
        let shown = visible(text);
        assert_eq!(
            shown,
            "a\\u{1b}[2J\\u{7}\\u{9b}1m\\r\\u{7f}\\u{202e}b\\u{2066}µ\n\tc"
        );
        assert_eq!(visible_line("a\nb"), "a\\nb");
        assert_eq!(visible_line(&"µ".repeat(LONGEST)).chars().count(), LONGEST);
        let shown = visible_line(&"µ".repeat(LONGEST + 1));
        assert!(shown.ends_with("µ…") && shown.chars().count() == LONGEST + 1);
        let json = serde_json::to_string("\u{9b}\u{1b}\u{202e}").unwrap();
        assert_eq!(visible_json(&json), "\"\\u009b\\u001b\\u202e\"");
    }
}
