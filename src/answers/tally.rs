//! How many starts had which outcome, and shares of them with their errors.

use super::basin::{Place, STUDENT_95, UNSEEN_95};
use crate::setting::basin::SCRAMBLINGS;
use crate::slip::outcome::Outcome;

/// If fewer starts than this differ from the others, their spread is not reliable. Bounds of
/// independent starts (Clopper and Pearson) then lie within [`UNSEEN_95`] of the counted number.
const FEW: f64 = 5.0;

/// A share of the starts, with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Share {
    /// Between 0 and 1.
    pub share: f64,
    /// Its standard error, from the spread between scramblings. Where all or nearly all starts
    /// agree, [`STUDENT_95`] times it is at least [`UNSEEN_95`] starts: parts of the region may
    /// contain none.
    pub error: f64,
}

/// How many starts of each scrambling had each outcome.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Tally([[u32; Outcome::ALL.len()]; SCRAMBLINGS as usize]);

impl Tally {
    /// Counts one more start.
    pub fn count(&mut self, place: Place, outcome: Outcome) {
        self.0[place.scrambling as usize][outcome as usize] += 1;
    }

    /// How many starts had an outcome.
    #[must_use]
    pub fn starts(&self, outcome: Outcome) -> u32 {
        self.0.iter().map(|counts| counts[outcome as usize]).sum()
    }

    /// The share of starts with one of these outcomes; NaN without any start. All scramblings have
    /// equally many.
    #[must_use]
    pub fn share(&self, of: &[Outcome]) -> Share {
        let all: u32 = self.0.iter().flatten().sum();
        let scramblings = f64::from(SCRAMBLINGS);
        let each = f64::from(all) / scramblings;
        let counted = |counts: &[u32; Outcome::ALL.len()]| {
            let counted: u32 = of.iter().map(|outcome| counts[*outcome as usize]).sum();
            f64::from(counted)
        };
        let sum: f64 = self.0.iter().map(counted).sum();
        let mean = sum / scramblings;
        let squared = |counts| {
            let off = counted(counts) - mean;
            off * off
        };
        let squares: f64 = self.0.iter().map(squared).sum();
        let error = (squares / (scramblings * (scramblings - 1.0))).sqrt() / each;
        let all = f64::from(all);
        let least = match sum.min(all - sum) < FEW {
            true => UNSEEN_95 / STUDENT_95,
            false => 1.0,
        };
        Share {
            share: sum / all,
            error: error.max(least / all),
        }
    }
}
