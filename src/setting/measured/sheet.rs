//! The rows of a text of columns: what separates them, where titles end and data begin.

use std::ops::Range;

use csv::{ReaderBuilder, StringRecord};

use super::number::is_number;

/// What stands between the cells of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Separator {
    Mark(u8),
    Blanks,
}

impl Separator {
    /// All of them; of two that fit as well, the first counts.
    const ALL: [Self; 4] = [
        Self::Mark(b';'),
        Self::Mark(b'\t'),
        Self::Mark(b','),
        Self::Blanks,
    ];

    /// The one with which most rows are numbers and nothing else, and then that with most rows of
    /// two numbers or more.
    fn of(text: &str) -> Self {
        let mut best = (Self::Blanks, (0, 0));
        for separator in Self::ALL {
            let mut fit = (0, 0);
            separator.each(text, |row| {
                let (numbers, others) = row.counts();
                fit.0 += usize::from(numbers > 1 && others == 0);
                fit.1 += usize::from(numbers > 1);
            });
            if fit > best.1 {
                best = (separator, fit);
            }
        }
        best.0
    }

    /// Calls `see` with every row that is neither a comment nor without any cell.
    fn each(self, text: &str, mut see: impl FnMut(Row)) {
        let mut line = Lines::of(text);
        let mut see = |place: Range<usize>, cells: StringRecord| {
            let comment = text[place.clone()].starts_with(['#', '%']);
            let line = line.at(place.start);
            let row = Row { line, place, cells };
            if !comment && row.width() > 0 {
                see(row);
            }
        };
        match self {
            Self::Mark(mark) => each_of_mark(text, mark, see),
            Self::Blanks => {
                let mut start = 0;
                for line in text.split_inclusive('\n') {
                    let cells: Vec<&str> = line.split_whitespace().collect();
                    see(bare(text, start..start + line.len()), cells.into());
                    start += line.len();
                }
            }
        }
    }
}

fn each_of_mark(text: &str, mark: u8, mut see: impl FnMut(Range<usize>, StringRecord)) {
    let mut reader = ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .delimiter(mark)
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    let mut cells = StringRecord::new();
    let mut start = 0;
    while let Ok(true) = reader.read_record(&mut cells) {
        let begun = cells.position().map_or(start, |at| at.byte() as usize);
        let end = reader.position().byte() as usize;
        cells.trim();
        see(behind_comments(text, begun..end), cells.clone());
        start = end;
    }
}

/// The place of a row without the comments before it.
fn behind_comments(text: &str, place: Range<usize>) -> Range<usize> {
    let mut row = bare(text, place);
    while text[row.clone()].starts_with('#') {
        let rest = &text[row.clone()];
        let line = rest.find('\n').map_or(rest.len(), |end| end + 1);
        row = bare(text, row.start + line..row.end);
    }
    row
}

/// A place of a text without the blanks around it.
fn bare(text: &str, place: Range<usize>) -> Range<usize> {
    let said = text.get(place.clone()).unwrap_or_default();
    // Some spreadsheets write a byte order mark at the beginning.
    let blank = |c: char| c.is_whitespace() || c == '\u{feff}';
    let start = place.start + said.len() - said.trim_start_matches(blank).len();
    start..start + said.trim_matches(blank).len()
}

/// Counts the lines of a text up to places that come one after the other.
struct Lines<'t> {
    text: &'t str,
    counted: usize,
    line: usize,
}

impl<'t> Lines<'t> {
    const fn of(text: &'t str) -> Self {
        Self {
            text,
            counted: 0,
            line: 1,
        }
    }

    fn at(&mut self, place: usize) -> usize {
        self.line += self.text[self.counted..place].matches('\n').count();
        self.counted = place;
        self.line
    }
}

/// A row: its cells without the blanks around them.
#[derive(Debug)]
pub(super) struct Row {
    /// Its line in the text, from 1 on.
    pub line: usize,
    /// Its place in the text.
    pub place: Range<usize>,
    cells: StringRecord,
}

impl Row {
    /// The cell of a column, from 0 on; empty where the row has none.
    pub(super) fn cell(&self, column: usize) -> &str {
        let cell = self.cells.get(column).unwrap_or_default();
        cell.trim_start_matches('\u{feff}')
    }

    /// The number of columns, without empty ones at the end.
    pub(super) fn width(&self) -> usize {
        let filled = |column: &usize| !self.cell(*column).is_empty();
        (0..self.cells.len())
            .rev()
            .find(filled)
            .map_or(0, |last| last + 1)
    }

    /// How many cells are numbers, and how many are something else.
    fn counts(&self) -> (usize, usize) {
        let mut filled = (0..self.cells.len()).map(|column| self.cell(column));
        let (mut numbers, mut others) = (0, 0);
        filled
            .by_ref()
            .filter(|cell| !cell.is_empty())
            .for_each(|cell| match is_number(cell) {
                true => numbers += 1,
                false => others += 1,
            });
        (numbers, others)
    }
}

/// A text of columns.
#[derive(Debug)]
pub(super) struct Sheet<'t> {
    text: &'t str,
    separator: Separator,
    /// Rows before the data: titles, units, and what else stands there.
    head: Vec<Row>,
    data: Vec<Row>,
    /// The number of columns of most rows of data.
    pub width: usize,
}

impl<'t> Sheet<'t> {
    /// The rows of a text. Data begin at the first row of numbers that has as many columns as most
    /// of them.
    pub(super) fn of(text: &'t str) -> Self {
        let separator = Separator::of(text);
        let mut rows = Vec::new();
        separator.each(text, |row| rows.push(row));
        let of_numbers = |row: &Row| row.counts().0 > 1;
        let of_data = rows.iter().filter(|row| of_numbers(row));
        let mut widths: Vec<usize> = of_data.map(Row::width).collect();
        widths.sort_unstable();
        let equal = widths.chunk_by(|one, other| one == other);
        let most = equal.max_by_key(|these| these.len());
        let width = most.map_or(0, |these| these[0]);
        let begins = |row: &Row| of_numbers(row) && row.width() == width;
        let begin = rows.iter().position(begins).unwrap_or(rows.len());
        let data = rows.split_off(begin);
        // A row with a number is no row of titles.
        let broken = |row: &mut Row| row.counts().0 > 0 && row.width() == width;
        let broken: Vec<Row> = rows.extract_if(.., broken).collect();
        Self {
            text,
            separator,
            head: rows,
            data: broken.into_iter().chain(data).collect(),
            width,
        }
    }

    /// Whether columns are separated by commas.
    pub(super) fn has_commas(&self) -> bool {
        self.separator == Separator::Mark(b',')
    }

    /// The rows of the data.
    pub(super) fn data(&self) -> &[Row] {
        &self.data
    }

    /// The rows before the data with as many columns as these: titles and units.
    pub(super) fn head(&self) -> impl DoubleEndedIterator<Item = &Row> {
        let wide = |row: &&Row| row.width() == self.width && self.width > 1;
        self.head.iter().filter(wide)
    }

    /// The first row of the text.
    pub(super) fn first(&self) -> Option<&Row> {
        self.head.first().or(self.data.first())
    }

    /// Whether a column has numbers in half of the rows of the data or more.
    pub(super) fn is_numeric(&self, column: usize) -> bool {
        let numbers = self.data().iter().filter(|row| is_number(row.cell(column)));
        2 * numbers.count() >= self.data().len()
    }

    /// The place of a cell in the text; of its row where quotes make that unclear.
    pub(super) fn place(&self, row: &Row, column: usize) -> Range<usize> {
        let said = &self.text[row.place.clone()];
        let cell = match self.separator {
            _ if said.contains('"') => None,
            Separator::Mark(mark) => said.split(char::from(mark)).nth(column),
            Separator::Blanks => said.split_whitespace().nth(column),
        };
        let Some(cell) = cell.map(str::trim).filter(|cell| !cell.is_empty()) else {
            return row.place.clone();
        };
        let start = row.place.start + (cell.as_ptr() as usize - said.as_ptr() as usize);
        start..start + cell.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The cells of all rows, joined by |, each row with its line.
    fn rows(text: &str) -> Vec<(usize, String)> {
        let sheet = Sheet::of(text);
        let joined = |row: &Row| row.cells.iter().collect::<Vec<_>>().join("|");
        sheet
            .data()
            .iter()
            .map(|row| (row.line, joined(row)))
            .collect()
    }

    #[test]
    fn separators_are_found() {
        for text in [
            "1;2\n3;4\n",
            "1\t2\r\n3\t4\r\n",
            "1, 2\n3, 4",
            "# a; b\n\n% 7 8\nv mu\n  1   2\n3 4\n",
            "\u{feff}1,2\n3,4\n",
            "\"1\",\"2\"\n3,4,\n",
        ] {
            let found: Vec<String> = rows(text).into_iter().map(|(_, row)| row).collect();
            assert!(
                found[0].ends_with("1|2") && found[1].starts_with("3|4"),
                "{text}: {found:?}"
            );
        }
        let decimal = ["0,1|0,5", "0,2|0,4"].map(String::from);
        for text in ["0,1;0,5\n0,2;0,4", "0,1\t0,5\n0,2\t0,4", "0,1 0,5\n0,2 0,4"] {
            let found: Vec<String> = rows(text).into_iter().map(|(_, row)| row).collect();
            assert_eq!(found, decimal, "{text}");
        }
    }

    #[test]
    fn lines_and_places_are_those_of_the_text() {
        let text = "Run 7\r\n\r\n\"v\";\"mu\r\n(1)\"\r\n0;  0.5\r\n# none\r\n1;x\r\n2;y\r\n";
        let sheet = Sheet::of(text);
        let lines: Vec<usize> = sheet.data().iter().map(|row| row.line).collect();
        assert_eq!(lines, [5, 7, 8]);
        assert_eq!(sheet.head().map(|row| row.line).collect::<Vec<_>>(), [3]);
        let place = |row: usize, column| &text[sheet.place(&sheet.data()[row], column)];
        assert_eq!((place(0, 1), place(1, 1), place(1, 2)), ("0.5", "x", "1;x"));
        assert!(sheet.is_numeric(0) && !sheet.is_numeric(1));
    }
}
