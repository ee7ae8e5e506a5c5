//! Joins the pieces of a curve, so that dashes go through where one piece meets the next.

use super::scene::Point;

/// Ends that are nearer to one another than this, in pixels, are the same.
const SAME: f64 = 0.05;

/// The pieces joined wherever the end of one is an end of another; closed curves end where they
/// begin.
pub(super) fn chained(pieces: Vec<Vec<Point>>) -> Vec<Vec<Point>> {
    let mut left: Vec<Vec<Point>> = pieces.into_iter().filter(|p| p.len() > 1).collect();
    let mut chains = Vec::new();
    while let Some(mut chain) = left.pop() {
        // Behind its end first, then before its start.
        for _ in 0..2 {
            while let Some(more) = taken_at(&mut left, chain.last().copied()) {
                chain.extend(more.into_iter().skip(1));
            }
            chain.reverse();
        }
        chains.push(chain);
    }
    chains
}

/// Takes a piece that begins or ends at a place out of the others, turned so that it begins there.
fn taken_at(pieces: &mut Vec<Vec<Point>>, at: Option<Point>) -> Option<Vec<Point>> {
    let same = |end: Option<&Point>| {
        at.zip(end)
            .is_some_and(|(a, b)| (a.0 - b.0).hypot(a.1 - b.1) < SAME)
    };
    let meets = |piece: &Vec<Point>| same(piece.first()) || same(piece.last());
    let mut piece = pieces.swap_remove(pieces.iter().position(meets)?);
    if !same(piece.first()) {
        piece.reverse();
    }
    Some(piece)
}

#[cfg(test)]
mod tests {
    use super::*;

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
