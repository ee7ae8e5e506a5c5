//! Joins the pieces of a curve, so that dashes go through where one piece meets the next.

use std::collections::HashMap;

use super::scene::Point;

/// Ends that are nearer to one another than this, in pixels, are the same.
const SAME: f64 = 0.05;

/// The pieces joined wherever the end of one is an end of another; closed curves end where they
/// begin.
pub(super) fn chained(pieces: Vec<Vec<Point>>) -> Vec<Vec<Point>> {
    let mut left = Left::of(pieces.into_iter().filter(|p| p.len() > 1).collect());
    let mut chains = Vec::new();
    for number in (0..left.pieces.len()).rev() {
        let Some(mut chain) = left.pieces[number].take() else {
            continue;
        };
        // Behind its end first, then before its start.
        for _ in 0..2 {
            while let Some(more) = chain.last().and_then(|end| left.taken_at(*end)) {
                chain.extend(more.into_iter().skip(1));
            }
            chain.reverse();
        }
        chains.push(chain);
    }
    chains
}

/// The square of the plane in which a place lies: ends that are the same lie in neighbouring ones.
fn square((x, y): Point) -> (i64, i64) {
    ((x / SAME).floor() as i64, (y / SAME).floor() as i64)
}

/// Whether two ends are the same.
fn same(a: Point, b: Point) -> bool {
    (a.0 - b.0).hypot(a.1 - b.1) < SAME
}

/// The pieces that are in no chain yet.
struct Left {
    /// The pieces by their numbers; none in the place of one that is taken.
    pieces: Vec<Option<Vec<Point>>>,
    /// The numbers of the pieces with an end in a square, decreasing.
    ends: HashMap<(i64, i64), Vec<usize>>,
}

impl Left {
    fn of(pieces: Vec<Vec<Point>>) -> Self {
        let mut ends: HashMap<_, Vec<usize>> = HashMap::new();
        for (i, piece) in pieces.iter().enumerate().rev() {
            for end in [piece.first(), piece.last()].into_iter().flatten() {
                ends.entry(square(*end)).or_default().push(i);
            }
        }
        let pieces = pieces.into_iter().map(Some).collect();
        Self { pieces, ends }
    }

    /// Takes a piece that begins or ends at a place, turned so that it begins there.
    fn taken_at(&mut self, at: Point) -> Option<Vec<Point>> {
        let (column, row) = square(at);
        let beside = |of: i64| (-1..=1).map(move |step| of.saturating_add(step));
        let mut around =
            beside(column).flat_map(|column| beside(row).map(move |row| (column, row)));
        let mut piece = around.find_map(|square| {
            let (here, pieces) = (self.ends.get_mut(&square)?, &mut self.pieces);
            while here.pop_if(|i| pieces[*i].is_none()).is_some() {}
            let is_end = |end: Option<&Point>| end.is_some_and(|end| same(*end, at));
            let meets = |piece: &Vec<Point>| is_end(piece.first()) || is_end(piece.last());
            let mut numbers = here.iter().rev();
            let found = numbers.find(|i| pieces[**i].as_ref().is_some_and(meets))?;
            pieces[*found].take()
        })?;
        if !same(piece[0], at) {
            piece.reverse();
        }
        Some(piece)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ends that are nearly the same are found in whichever squares they lie, and no others.
    #[test]
    fn ends_are_the_same_within_a_distance() {
        for (x, y) in [(0.0, 0.0), (1.0, -1.0), (-3.02, 7.049), (0.0499, 0.0499)] {
            for (dx, dy) in [
                (0.04, 0.0),
                (-0.04, 0.0),
                (0.0, 0.04),
                (0.03, 0.03),
                (-0.03, -0.03),
            ] {
                let joined = |far: f64| {
                    let one = vec![(x - 5.0, y), (x, y)];
                    let other = vec![(x + far * dx, y + far * dy), (x + 5.0, y + 2.0)];
                    chained(vec![one, other]).len() == 1
                };
                assert!(joined(1.0) && !joined(1.5), "{x} {y} {dx} {dy}");
            }
        }
    }

    #[test]
    fn pieces_in_any_order_and_direction_are_one_curve() {
        let square = [(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0)];
        let side = |a: usize, b: usize| vec![square[a], square[b]];
        let apart = vec![(20.0, 20.0), (30.0, 30.0)];
        let pieces = vec![
            side(0, 1),
            side(3, 2),
            apart.clone(),
            side(1, 2),
            side(3, 0),
        ];
        let chains = chained(pieces);
        assert_eq!(chains.len(), 2);
        let closed = chains.iter().find(|chain| chain.len() == 5).unwrap();
        assert_eq!(closed.first(), closed.last());
        assert!(chains.contains(&apart));
        let open = chained(vec![side(1, 2), side(1, 0)]);
        assert!(
            open == [[square[0], square[1], square[2]]]
                || open == [[square[2], square[1], square[0]]]
        );
    }
}
