//! The past as the crate's dense output gave it: eight values in each accepted step, and the
//! polynomial through them.

use crate::problem::State;

pub const NODES: usize = 8;

/// Barycentric weights of [`NODES`] evenly spaced nodes, up to a factor.
const WEIGHTS: [f64; NODES] = [-1.0, 7.0, -21.0, 35.0, -35.0, 21.0, -7.0, 1.0];

/// One accepted step.
pub struct Piece {
    pub from: f64,
    pub length: f64,
    pub values: [State; NODES],
}

/// All steps since t = 0, in order of time; before t = 0 the block rests at a = 0.
#[derive(Default)]
pub struct History {
    pub pieces: Vec<Piece>,
}

impl History {
    pub fn at(&self, t: f64) -> State {
        let after = self.pieces.partition_point(|p| p.from <= t);
        let Some(piece) = self.pieces.get(after.max(1) - 1) else {
            return State::zeros();
        };
        let place = (t - piece.from) / piece.length * (NODES - 1) as f64;
        let (mut sum, mut total) = (State::zeros(), 0.0);
        for (k, (value, weight)) in piece.values.iter().zip(WEIGHTS).enumerate() {
            let distance = place - k as f64;
            if distance == 0.0 {
                return *value;
            }
            let share = weight / distance;
            sum += value * share;
            total += share;
        }
        sum / total
    }
}
