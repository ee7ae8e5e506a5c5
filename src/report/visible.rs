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

/// JSON in which such characters are escaped. They occur only inside its strings.
#[must_use]
pub fn visible_json(json: &str) -> String {
    let mut shown = String::with_capacity(json.len());
    for c in json.chars() {
        match c.is_control() || is_unseen(c) {
            true => {
                let mut units = [0; 2];
                let units = c.encode_utf16(&mut units).iter();
                shown.extend(units.map(|unit| format!("\\u{unit:04x}")));
            }
            false => shown.push(c),
        }
    }
    shown
}

/// Characters that show nothing themselves: directional marks, embeddings, overrides and isolates,
/// line and paragraph separators, characters without a width, fillers, tags, the byte order mark.
fn is_unseen(c: char) -> bool {
    matches!(
        c,
        '\u{ad}'
            | '\u{34f}'
            | '\u{61c}'
            | '\u{115f}'
            | '\u{1160}'
            | '\u{17b4}'
            | '\u{17b5}'
            | '\u{180b}'..='\u{180f}'
            | '\u{200b}'..='\u{200f}'
            | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}'
            | '\u{3164}'
            | '\u{feff}'
            | '\u{ffa0}'
            | '\u{fff0}'..='\u{fffb}'
            | '\u{1bca0}'..='\u{1bca3}'
            | '\u{1d173}'..='\u{1d17a}'
            | '\u{e0000}'..='\u{e0fff}'
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
        let unseen = "a\u{ad}\u{200b}\u{2028}\u{3164}\u{e0041}\u{1d173}b";
        let shown = visible(unseen);
        let spelled = "a\\u{ad}\\u{200b}\\u{2028}\\u{3164}\\u{e0041}\\u{1d173}b";
        assert_eq!(shown, spelled);
        let json = serde_json::to_string(unseen).unwrap();
        let back: String = serde_json::from_str(&visible_json(&json)).unwrap();
        assert!(visible_json(&json).is_ascii() && back == unseen);
    }
}
