//! Pieces of a page in Markdown.

use std::fmt::Write;

/// A heading.
pub(super) fn heading(page: &mut String, depth: usize, text: &str) {
    let _ = write!(page, "\n{} {text}\n\n", "#".repeat(depth));
}

/// A paragraph.
pub(super) fn paragraph(page: &mut String, text: &str) {
    let _ = write!(page, "{text}\n\n");
}

/// A table with a row for each of `rows`; nothing without rows.
pub(super) fn table<const N: usize>(page: &mut String, titles: [&str; N], rows: Vec<[String; N]>) {
    let line = |cells: [String; N]| {
        let cells = cells.map(|cell| cell.replace('|', "\\|").replace('\n', " "));
        format!("| {} |\n", cells.join(" | "))
    };
    page.push_str(&line(titles.map(String::from)));
    page.push_str(&line([(); N].map(|()| "---".to_owned())));
    for row in rows {
        page.push_str(&line(row));
    }
    page.push('\n');
}

/// A name as it is written in files.
pub(super) fn code(text: &str) -> String {
    format!("`{text}`")
}
