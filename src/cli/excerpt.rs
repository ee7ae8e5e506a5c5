//! What a message shows of a text: every long line is cut to what is near its place.

use std::ops::Range;

/// The most characters of a line that are shown.
const COLUMNS: usize = 100;
/// The most of them before the place.
const BEFORE: usize = 40;
/// Stands for what is cut off.
const CUT: &str = "…";

/// A text with the same lines, none of them longer than a screen is wide, and the place in it that
/// corresponds to `span`.
pub(super) fn excerpt(text: &str, span: Range<usize>) -> (String, Range<usize>) {
    let mut cut = String::new();
    let mut place = 0..0;
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let end = start + line.len();
        let kept = kept(line, span.start.checked_sub(start));
        let shown = cut.len() + if kept.start > 0 { CUT.len() } else { 0 };
        let moved = |at: usize| shown + (at - start).clamp(kept.start, kept.end) - kept.start;
        let last = end == text.len();
        for (of, at) in [(&mut place.start, span.start), (&mut place.end, span.end)] {
            if (start..end).contains(&at) || (last && at == end) {
                *of = moved(at);
            }
        }
        if kept.start > 0 {
            cut += CUT;
        }
        cut += &line[kept.clone()];
        if kept.end < line.len() {
            cut += CUT;
            cut += &line[line.trim_end_matches(['\r', '\n']).len()..];
        }
        start = end;
    }
    (cut, place)
}

/// The bytes of a line that are shown, where `place` is a byte of it, or beyond it.
fn kept(line: &str, place: Option<usize>) -> Range<usize> {
    let bare = line.trim_end_matches(['\r', '\n']);
    let columns = bare.chars().count();
    if columns <= COLUMNS {
        return 0..line.len();
    }
    let column = match place.filter(|at| *at <= bare.len()) {
        Some(at) => bare.char_indices().take_while(|(i, _)| *i < at).count(),
        None => 0,
    };
    let first = column.saturating_sub(BEFORE);
    let byte = |column: usize| {
        let mut places = bare.char_indices().map(|(at, _)| at);
        places.nth(column).unwrap_or(bare.len())
    };
    byte(first)..byte(first + COLUMNS)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(text: &str, span: Range<usize>) -> (String, String) {
        let (cut, place) = excerpt(text, span);
        let at = cut[place].to_owned();
        (cut, at)
    }

    #[test]
    fn short_lines_are_left_alone() {
        for text in ["", "a = 1", "a = 1\r\nb = 2\n", "ä\n"] {
            for at in (0..=text.len()).filter(|at| text.is_char_boundary(*at)) {
                assert_eq!(excerpt(text, at..at), (text.to_owned(), at..at));
            }
        }
        assert_eq!(shown("a = 1\nb = 2\n", 6..7).1, "b");
    }

    #[test]
    fn long_lines_are_cut_around_the_place() {
        let text = format!("x = 1\n{}é!{}\r\nend", "é".repeat(500), "z".repeat(100_000));
        let at = text.find('!').unwrap();
        let (cut, place) = shown(&text, at..at + 1);
        assert_eq!(place, "!");
        let lines: Vec<&str> = cut.split('\n').collect();
        assert_eq!((lines[0], lines[2]), ("x = 1", "end"));
        assert_eq!(lines[1].chars().count(), COLUMNS + 3, "{cut}");
        assert!(lines[1].starts_with('…') && lines[1].ends_with("…\r"));
        // What goes on beyond the excerpt ends with it.
        let (cut, place) = shown(&text, at..text.len() - 5);
        assert!(place.starts_with("!z") && place.len() <= COLUMNS && cut.len() < 400);
        let (cut, place) = shown(&text, 0..1);
        assert!(place == "x" && cut.chars().count() < 120);
    }
}
