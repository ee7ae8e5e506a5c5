//! The pieces of a sweep (planes of curves, planes of best settings, tiles), and which of them a
//! run has to compute.

use std::fmt;
use std::str::FromStr;
use std::sync::atomic::{AtomicU64, Ordering};

/// A part of a sweep that is computed, stored and checked on its own. Each kind is numbered from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Piece {
    /// The curves of a plane, see [`crate::sweep::cells::boundaries::plane`].
    Curves(u64),
    /// The best settings of a plane, see [`crate::sweep::cells::best_planes::best_plane`].
    Best(u64),
    /// The cells of a tile.
    Tile(u64),
}

/// How many pieces of each kind a plan has. Places number all of them: curves first, tiles last.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pieces {
    /// Planes of curves.
    pub curves: u64,
    /// Planes of best settings.
    pub best: u64,
    /// Tiles.
    pub tiles: u64,
}

impl Pieces {
    /// Number of all pieces.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.curves + self.best + self.tiles
    }

    /// The piece at `place`, which is less than [`Pieces::total`].
    #[must_use]
    pub fn at(&self, place: u64) -> Piece {
        match place.checked_sub(self.curves) {
            None => Piece::Curves(place),
            Some(rest) => match rest.checked_sub(self.best) {
                None => Piece::Best(rest),
                Some(rest) => Piece::Tile(rest),
            },
        }
    }

    /// The place of a piece; none for a piece that the plan lacks.
    #[must_use]
    pub fn place(&self, piece: Piece) -> Option<u64> {
        let (first, number, count) = match piece {
            Piece::Curves(n) => (0, n, self.curves),
            Piece::Best(n) => (self.curves, n, self.best),
            Piece::Tile(n) => (self.curves + self.best, n, self.tiles),
        };
        (number < count).then(|| first + number)
    }
}

/// One of `of` parts of a sweep: every `of`-th piece. `number` counts from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    number: u64,
    of: u64,
}

/// The most shards; more are taken for a typing error.
const MOST_SHARDS: u64 = 100_000;

impl Shard {
    /// The whole sweep.
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// Whether the piece at `place` belongs to the shard.
    #[must_use]
    pub(crate) fn holds(self, place: u64) -> bool {
        place % self.of == self.number - 1
    }

    /// Whether it is the whole sweep.
    #[must_use]
    pub(crate) fn is_whole(self) -> bool {
        self.of == 1
    }

    /// How many of `total` pieces belong to the shard.
    #[must_use]
    pub fn count(self, total: u64) -> u64 {
        (total + self.of - self.number) / self.of
    }

    /// The number of the shard, from 1, and how many shards there are.
    #[must_use]
    pub fn numbers(self) -> (u64, u64) {
        (self.number, self.of)
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

impl FromStr for Shard {
    type Err = String;

    /// Reads `I/N`, 1 ≤ I ≤ N.
    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text
            .split_once('/')
            .and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
        match numbers {
            Some((number, of)) if (1..=of).contains(&number) && of <= MOST_SHARDS => {
                Ok(Self { number, of })
            }
            _ => Err(format!(
                "expected I/N with I from 1 to N, N at most {MOST_SHARDS}"
            )),
        }
    }
}

/// The order in which pieces are computed; no value depends on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Order {
    /// By number.
    #[default]
    Forward,
    /// From the last to the first.
    Backward,
    /// Spread over the whole map from the beginning.
    Spread,
}

/// The pieces to compute; any thread may take the next one.
#[derive(Debug)]
pub struct Todo {
    pieces: Pieces,
    shard: Shard,
    order: Order,
    /// One bit for each finished piece.
    done: Vec<u64>,
    next: AtomicU64,
}

impl Todo {
    /// A list of all of `pieces`.
    #[must_use]
    pub fn all(pieces: Pieces) -> Self {
        Self::new(pieces, Shard::WHOLE, Order::Forward)
    }

    /// A list of the pieces of a shard, in `order`.
    #[must_use]
    pub fn new(pieces: Pieces, shard: Shard, order: Order) -> Self {
        Self {
            pieces,
            shard,
            order,
            done: vec![0; pieces.total().div_ceil(64) as usize],
            next: AtomicU64::new(0),
        }
    }

    /// Takes a piece off the list.
    pub(crate) fn mark_done(&mut self, piece: Piece) {
        if let Some(place) = self.pieces.place(piece) {
            self.done[(place / 64) as usize] |= 1 << (place % 64);
        }
    }

    fn wanted(&self, place: u64) -> bool {
        self.shard.holds(place) && self.done[(place / 64) as usize] >> (place % 64) & 1 == 0
    }

    /// All pieces on the list, by number.
    pub fn left(&self) -> impl Iterator<Item = Piece> {
        (0..self.pieces.total())
            .filter(|&place| self.wanted(place))
            .map(|place| self.pieces.at(place))
    }

    /// The next piece that no thread has taken.
    pub fn next(&self) -> Option<Piece> {
        let total = self.pieces.total();
        loop {
            let turn = self.next.fetch_add(1, Ordering::Relaxed);
            if turn >= total {
                return None;
            }
            let place = match self.order {
                Order::Forward => turn,
                Order::Backward => total - 1 - turn,
                Order::Spread => spread_over(total, turn),
            };
            if self.wanted(place) {
                return Some(self.pieces.at(place));
            }
        }
    }
}

/// A number in [0, 1) for each sample. Multiples of the golden ratio stay evenly spread at any
/// number of samples.
#[must_use]
pub fn spread(sample: u64) -> f64 {
    (sample as f64 * GOLDEN).fract()
}

/// The place, of `total`, that is visited at a turn, so that places are spread from the beginning
/// and each is visited once.
#[must_use]
pub(crate) fn spread_over(total: u64, turn: u64) -> u64 {
    (u128::from(turn) * u128::from(stride(total)) % u128::from(total)) as u64
}

const GOLDEN: f64 = 0.618_033_988_749_895;

/// SplitMix64's finalizer: it turns neighbouring numbers into unrelated ones.
#[must_use]
pub fn mixed(number: u64) -> u64 {
    let mut z = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// A number near the golden ratio of `total` and coprime to it: its multiples visit every place
/// once.
fn stride(total: u64) -> u64 {
    let golden = (total as f64 * GOLDEN) as u64;
    (golden.max(1)..=total.max(1))
        .find(|&n| gcd(n, total) == 1)
        .unwrap_or(1)
}

fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn all(todo: &Todo) -> Vec<Piece> {
        std::iter::from_fn(|| todo.next()).collect()
    }

    proptest! {
        /// Whatever the order and the shards, every unfinished piece is taken exactly once.
        #[test]
        fn every_piece_once(
            curves in 0_u64..20,
            best in 0_u64..5,
            tiles in 1_u64..300,
            of in 1_u64..9,
            done in 0_u64..300,
        ) {
            let pieces = Pieces { curves, best, tiles };
            for order in [Order::Forward, Order::Backward, Order::Spread] {
                let mut seen = Vec::new();
                for number in 1..=of {
                    let mut todo = Todo::new(pieces, Shard { number, of }, order);
                    todo.mark_done(Piece::Tile(done));
                    let mut given = all(&todo);
                    given.sort();
                    prop_assert_eq!(&given, &todo.left().collect::<Vec<_>>());
                    let here = todo.shard.count(pieces.total());
                    prop_assert!(here == given.len() as u64 || here == given.len() as u64 + 1);
                    seen.extend(given);
                }
                seen.sort();
                let mut expected: Vec<Piece> = (0..pieces.total()).map(|n| pieces.at(n)).collect();
                expected.retain(|&piece| piece != Piece::Tile(done));
                expected.sort();
                prop_assert_eq!(seen, expected);
            }
        }
    }

    #[test]
    fn shards_are_read() {
        assert_eq!("2/7".parse::<Shard>().unwrap().to_string(), "2/7");
        for bad in ["0/3", "4/3", "1", "a/b", "1/0", "-1/3", "1/100001", ""] {
            assert!(bad.parse::<Shard>().is_err(), "{bad}");
        }
    }
}
