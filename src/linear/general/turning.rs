//! The whole turns of equation (7) of [`right_of`](super::right_of), and what they come to.

use std::f64::consts::TAU;

use super::at_origin::AtOrigin;

/// The number of roots right of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RightOf {
    /// So many roots.
    Roots(u64),
    /// Infinitely many: the line lies left of the one at which they accumulate.
    Infinite,
    /// A root lies within rounding of the line.
    Undecided,
}

impl RightOf {
    /// The number, where it is finite and known.
    #[must_use]
    pub fn finite(self) -> Option<u64> {
        match self {
            Self::Roots(n) => Some(n),
            Self::Infinite | Self::Undecided => None,
        }
    }
}

/// A frequency at which a turn of (7) is counted.
#[derive(Debug, Clone, Copy)]
pub(super) struct Turn {
    pub omega: f64,
    pub omega_error: f64,
    pub sign: f64,
    /// φ − ψ and a bound on its error.
    pub phase: f64,
    pub phase_error: f64,
}

impl Turn {
    /// m of (7), or none where it might round either way.
    #[inline]
    pub(super) fn turns(&self, tau: f64) -> Option<f64> {
        let angle = self.omega * tau;
        let turns = (self.phase + angle) / TAU;
        let error = self.phase_error
            + self.omega_error * tau
            + 4.0 * f64::EPSILON * (angle + self.phase.abs());
        let whole = (turns + 0.5).floor();
        let left = 0.5 - (turns - whole).abs();
        (left * TAU > error).then_some(whole)
    }
}

/// Equation (7) on one line, with everything in it that does not depend on the delay.
#[derive(Debug, Clone, Default)]
pub struct Turning {
    /// n_P + ν₀.
    pub(super) without_turns: i64,
    pub(super) turns: Vec<Turn>,
    /// What a root at 0 that is left out has to do with it.
    pub(super) at_origin: Option<AtOrigin>,
}

impl Turning {
    /// The number of roots right of the line at the delay `tau`: the one that this was made for, or
    /// any where the line is the imaginary axis. None where a root is too near to the line.
    #[must_use]
    pub fn at(&self, tau: f64) -> Option<u64> {
        let mut turned = WholeTurns::at(tau);
        let decided = self.turns.iter().all(|turn| turned.add(turn));
        let left_out = self.at_origin.map_or(Some(0), |at| at.counted(tau))?;
        let without_turns = self.without_turns - left_out;
        decided.then(|| turned.roots(without_turns)).flatten()
    }
}

/// Σ s_j m_j of (7) at one value of what turns, the delay or the latency.
#[derive(Debug, Clone, Copy)]
pub(super) struct WholeTurns {
    at: f64,
    sum: f64,
}

impl WholeTurns {
    #[inline]
    pub(super) const fn at(at: f64) -> Self {
        Self { at, sum: 0.0 }
    }

    /// Adds a turn; false where it might round either way.
    #[inline]
    pub(super) fn add(&mut self, turn: &Turn) -> bool {
        let Some(turns) = turn.turns(self.at) else {
            return false;
        };
        self.sum += turn.sign * turns;
        true
    }

    /// The number of roots by (7); `without_turns` is n_P + ν₀, which stands before the sum.
    #[inline]
    fn roots(self, without_turns: i64) -> Option<u64> {
        u64::try_from(without_turns + 2 * self.sum as i64).ok()
    }

    /// The number of roots right of a line, or why there is none.
    #[inline]
    pub(super) fn right_of(self, without_turns: Result<i64, NoNumber>) -> RightOf {
        match without_turns {
            Ok(without) => self
                .roots(without)
                .map_or(RightOf::Undecided, RightOf::Roots),
            Err(why) => why.into(),
        }
    }
}

/// Why (7) gives no number on a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NoNumber {
    Infinite,
    Undecided,
}

impl From<NoNumber> for RightOf {
    fn from(why: NoNumber) -> Self {
        match why {
            NoNumber::Infinite => Self::Infinite,
            NoNumber::Undecided => Self::Undecided,
        }
    }
}
