//! What is made of a map's columns once the library has read them: curves, and ranges of values.

use slipmap::store::FieldSummary;
use slipmap::store::curve_reader::curves_of;
use slipmap::sweep::described::curve_rows::CurveRows;

/// Columns of any lengths with any numbers.
pub(super) fn rows(data: &[u8]) {
    let mut bytes = Bytes(data);
    let curves = usize::from(bytes.byte() % 16);
    let outer = usize::from(bytes.byte() % 3);
    let odd = bytes.byte();
    // A bit of `odd` makes one column longer than the others.
    let length = |column: u8, sound: usize| sound + usize::from(odd >> column & 1);
    let vertex_count: Vec<i32> = (0..length(0, curves)).map(|_| bytes.count()).collect();
    let vertices = vertex_count.iter().map(|&n| i64::from(n).clamp(0, 100));
    let vertices = vertices.sum::<i64>() as usize;
    let rows = CurveRows {
        branch: (0..length(1, curves))
            .map(|_| bytes.number() as i64)
            .collect(),
        direction: (0..length(2, curves)).map(|_| bytes.byte() as i8).collect(),
        stable_side: (0..length(3, curves)).map(|_| bytes.byte() as i8).collect(),
        kind: (0..curves).map(|_| bytes.byte() as i8).collect(),
        degree: (0..length(4, curves)).map(|_| bytes.real()).collect(),
        p: (0..length(5, vertices)).map(|_| bytes.real()).collect(),
        q: (0..length(6, vertices)).map(|_| bytes.real()).collect(),
        omega: (0..length(7, vertices)).map(|_| bytes.real()).collect(),
        vertex_count,
        ..CurveRows::default()
    };
    let columns: Vec<Vec<f64>> = (0..outer)
        .map(|_| (0..curves).map(|_| bytes.real()).collect())
        .collect();
    match curves_of(&rows, &columns) {
        Some(found) => {
            assert_eq!(found.len(), rows.vertex_count.len());
            let held: usize = found.iter().map(|c| c.piece.vertices.len()).sum();
            assert_eq!(held, rows.p.len());
        }
        None => assert!(odd != 0 || rows.vertex_count.iter().any(|n| !(0..=100).contains(n))),
    }
    let mut summary = FieldSummary::of_reals(&rows.p);
    summary.add(&FieldSummary::of_reals(&rows.degree));
    assert!(summary.range.is_none_or(|(low, high)| low <= high));
}

/// Bytes one after the other, and zeros after the last.
struct Bytes<'a>(&'a [u8]);

impl Bytes<'_> {
    fn byte(&mut self) -> u8 {
        let Some((&first, rest)) = self.0.split_first() else {
            return 0;
        };
        self.0 = rest;
        first
    }

    fn number(&mut self) -> u64 {
        u64::from_le_bytes([(); 8].map(|()| self.byte()))
    }

    fn real(&mut self) -> f64 {
        match self.byte() {
            0 => f64::from_bits(self.number()),
            1 => f64::INFINITY,
            2 => f64::NEG_INFINITY,
            3 => f64::NAN,
            n => f64::from(n),
        }
    }

    fn count(&mut self) -> i32 {
        match self.byte() {
            250 => i32::MAX,
            251 => i32::MIN,
            252 => -1,
            n => i32::from(n % 8),
        }
    }
}
