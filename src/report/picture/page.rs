//! The page: title, notes, and the remaining area.

pub(super) use super::print::SMALL;
use super::scene::{Align, Scene};
use super::text::Rich;
use crate::meaning::colour::{INK, SOFT_INK};

/// Font sizes in units, see [`Scene::unit`].
pub(super) const TITLE: f64 = 34.0;
/// Axis titles.
pub(super) const LABEL: f64 = 29.0;
/// Space at the edges of the sheet.
const EDGE: f64 = 34.0;
const TITLE_LINES: usize = 2;
const NOTE_LINES: usize = 3;
/// Height of a line relative to its font.
const LEADING: f64 = 1.3;

/// A rectangle in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Area {
    /// Left edge.
    pub left: f64,
    /// Upper edge.
    pub top: f64,
    /// Right edge.
    pub right: f64,
    /// Lower edge.
    pub bottom: f64,
}

impl Area {
    /// Width.
    pub(super) fn width(&self) -> f64 {
        self.right - self.left
    }

    /// Height.
    pub(super) fn height(&self) -> f64 {
        self.bottom - self.top
    }

    /// Whether two areas have a place in common inside their edges.
    pub(super) fn overlaps(&self, other: &Self) -> bool {
        self.left < other.right
            && other.left < self.right
            && self.top < other.bottom
            && other.top < self.bottom
    }

    /// Cuts a column of this width off the right, with a gap; returns the column.
    pub(super) fn cut_right(&mut self, width: f64, gap: f64) -> Self {
        let column = Self {
            left: self.right - width,
            ..*self
        };
        self.right = column.left - gap;
        column
    }
}

/// Writes title and notes; returns the remaining area.
pub(super) fn head(scene: &mut Scene, title: &str, notes: &[Rich]) -> Area {
    let u = scene.unit();
    let (width, height) = (f64::from(scene.size.0), f64::from(scene.size.1));
    let (left, right) = (EDGE * u, width - EDGE * u);
    let mut top = EDGE * u;
    for line in wrapped(title, TITLE * u, right - left) {
        top += TITLE * u * 0.8;
        scene.text(
            (left, top),
            Align::Start,
            &Rich::prose(&line),
            TITLE * u,
            INK,
        );
        top += TITLE * u * (LEADING - 0.8);
    }
    for line in note_lines(notes, SMALL * u, right - left) {
        top += SMALL * u * 0.9;
        let size = line.fitting(SMALL * u, right - left);
        scene.text((left, top), Align::Start, &line, size, SOFT_INK);
        top += SMALL * u * (LEADING - 0.9);
    }
    Area {
        left,
        top: top + 0.5 * SMALL * u,
        right,
        bottom: height - EDGE * u,
    }
}

/// A text in lines of at most `width`. If it does not fit into the allowed number of lines, it ends
/// in an ellipsis.
fn wrapped(text: &str, size: f64, width: f64) -> Vec<String> {
    let fits = |line: &str| Rich::plain(line).width(size) <= width;
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        let longer = lines.last().map(|line| format!("{line} {word}"));
        match longer.filter(|line| fits(line)) {
            Some(longer) => {
                lines.pop();
                lines.push(longer);
            }
            None => lines.push(word.to_owned()),
        }
    }
    let too_many = lines.len() > TITLE_LINES;
    lines.truncate(TITLE_LINES);
    let last = lines.len().saturating_sub(1);
    for (i, line) in lines.iter_mut().enumerate() {
        if !fits(line) || (too_many && i == last) {
            line.push('…');
            while !fits(line) && line.pop().is_some() && line.pop().is_some() {
                line.push('…');
            }
        }
    }
    lines
}

/// The notes in as many lines as they need, up to a limit.
fn note_lines(notes: &[Rich], size: f64, width: f64) -> Vec<Rich> {
    let mut lines: Vec<Rich> = Vec::new();
    for note in notes {
        let longer = lines
            .last()
            .map(|line| line.clone().and("    ").then(note.clone()));
        match longer.filter(|line| line.width(size) <= width) {
            Some(longer) => {
                lines.pop();
                lines.push(longer);
            }
            None => lines.push(note.clone()),
        }
    }
    lines.truncate(NOTE_LINES);
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_titles_are_wrapped_and_cut() {
        let title = "stability of sliding ".repeat(30);
        let lines = wrapped(&title, 30.0, 600.0);
        assert_eq!(lines.len(), TITLE_LINES);
        assert!(lines[1].ends_with('…'));
        assert!(lines.iter().all(|l| Rich::plain(l).width(30.0) <= 600.0));
        let lines = wrapped(&"x".repeat(500), 30.0, 600.0);
        assert!(lines.len() == 1 && Rich::plain(&lines[0]).width(30.0) <= 600.0);
        assert!(wrapped("", 30.0, 600.0).is_empty());
    }
}
