//! The steps of a response: Taylor series of states and signals; the delayed ones are kept.

use super::form::{Excited, MOST_STEPS, NoResponse};
use crate::model::stop::Stop;

/// The most numbers that the past of a response may take.
const MOST_PAST: usize = 20_000_000;
/// The size beyond which a response is not followed.
const LARGEST: f64 = 1e150;
/// The highest power of a series.
const ORDER: usize = 20;
/// The number of coefficients of a series.
const TERMS: usize = ORDER + 1;
/// The largest rate times the length of a step. The truncation of a series is then below
/// (4 · 0.5)^21/21! ≈ 4e-14, were the rates four times the bound.
const REACH: f64 = 0.5;
/// Steps between looks whether the work is to end.
const BETWEEN_LOOKS: usize = 1024;

/// How a response is divided.
#[derive(Debug, Clone, Copy)]
pub(super) struct Steps {
    /// So many steps make a delay; 0 without delay.
    per_delay: usize,
    /// The length of a step.
    length: f64,
    /// All steps.
    pub count: usize,
    until: f64,
}

/// One step of the response.
#[derive(Debug, Clone, Copy)]
pub(super) struct Step<'s> {
    /// The coefficients of the response in powers of the time from 0 to 1 in the step.
    series: &'s [f64; TERMS],
    pub from: f64,
    pub until: f64,
    pub length: f64,
    pub is_last: bool,
}

impl Step<'_> {
    /// The response at `share` of the step.
    pub(super) fn value(&self, share: f64) -> f64 {
        self.series.iter().rev().fold(0.0, |sum, c| sum * share + c)
    }

    /// A bound on how far it comes from a value.
    pub(super) fn farthest_from(&self, value: f64) -> f64 {
        let [first, rest @ ..] = self.series;
        (first - value).abs() + rest.iter().map(|c| c.abs()).sum::<f64>()
    }

    /// Its derivative in the share.
    pub(super) fn slope(&self, share: f64) -> f64 {
        let each = self.series.iter().enumerate().skip(1).rev();
        each.fold(0.0, |sum, (k, c)| sum * share + k as f64 * c)
    }

    /// The time at a share of it.
    pub(super) fn time(&self, share: f64) -> f64 {
        self.from + share * self.length
    }
}

/// Series of several quantities, with their coefficients of one power together.
struct Series {
    values: Vec<f64>,
    size: usize,
}

impl Series {
    fn new(size: usize) -> Self {
        Self {
            values: vec![0.0; size * TERMS],
            size,
        }
    }

    fn power(&self, k: usize) -> &[f64] {
        &self.values[k * self.size..(k + 1) * self.size]
    }

    fn set(&mut self, k: usize, i: usize, value: f64) {
        self.values[k * self.size + i] = value;
    }
}

impl Steps {
    pub(super) fn new(of: &Excited, until: f64) -> Result<Self, NoResponse> {
        let wanted = REACH / of.rate.max(f64::MIN_POSITIVE);
        let per_delay = match of.tau > 0.0 {
            true => (of.tau / wanted).ceil().max(1.0),
            false => 0.0,
        };
        let length = match of.tau > 0.0 {
            true => of.tau / per_delay,
            false => until / (until / wanted).ceil().max(1.0),
        };
        let count = (until / length).ceil().max(1.0);
        let past = per_delay.min(count) * (of.d.rows() * TERMS) as f64;
        if !(count <= MOST_STEPS as f64 && past <= MOST_PAST as f64) {
            return Err(NoResponse::TooLong { steps: count });
        }
        Ok(Self {
            per_delay: per_delay as usize,
            length,
            count: count as usize,
            until,
        })
    }

    /// Follows the response, step by step.
    ///
    /// # Errors
    /// When it grows out of all bounds.
    pub(super) fn each(
        &self,
        of: &Excited,
        stop: &Stop,
        mut look: impl FnMut(&Step),
    ) -> Result<(), NoResponse> {
        let (n, signals) = (of.start.len(), of.d.rows());
        let kept = self.per_delay.min(self.count);
        // What is delayed, of one delay; zeros, as nothing was before.
        let mut past = vec![0.0; kept * signals * TERMS];
        let mut delayed = Series::new(signals);
        let (mut states, mut fed) = (Series::new(n), Series::new(signals));
        let mut x = of.start.clone();
        let mut told = [0.0; TERMS];
        for step in 0..self.count {
            if step % BETWEEN_LOOKS == 0 && stop.is_set() {
                return Ok(());
            }
            let place = (step % kept.max(1)) * signals * TERMS;
            if kept > 0 {
                let from = &past[place..place + signals * TERMS];
                delayed.values.copy_from_slice(from);
            }
            of.series(self.length, &x, &delayed, (&mut states, &mut fed));
            if kept > 0 {
                past[place..place + signals * TERMS].copy_from_slice(&fed.values);
            }
            for (k, told) in told.iter_mut().enumerate() {
                *told = match of.told {
                    Some(i) if i < n => states.power(k)[i],
                    Some(i) => fed.power(k)[i - n],
                    None => 0.0,
                };
            }
            told[0] += of.offset;
            for (i, x) in x.iter_mut().enumerate() {
                *x = (0..TERMS)
                    .rev()
                    .fold(0.0, |sum, k| sum + states.power(k)[i]);
            }
            let from = self.time(step);
            let is_last = step + 1 == self.count;
            if !told.iter().chain(&x).all(|value| value.abs() < LARGEST) {
                return Err(NoResponse::Grows { at: from });
            }
            look(&Step {
                series: &told,
                from,
                until: if is_last {
                    self.until
                } else {
                    self.time(step + 1)
                },
                length: self.length,
                is_last,
            });
        }
        Ok(())
    }

    /// When a step begins.
    fn time(&self, step: usize) -> f64 {
        step as f64 * self.length
    }
}

impl Excited {
    /// The series of states and signals in a step of this length from the states `x` on.
    fn series(
        &self,
        length: f64,
        x: &[f64],
        delayed: &Series,
        (states, fed): (&mut Series, &mut Series),
    ) {
        let [to_states, to_signals] = &self.input;
        states.values[..x.len()].copy_from_slice(x);
        for k in 0..TERMS {
            let late = delayed.power(k);
            for (i, direct) in to_signals.iter().enumerate() {
                let own = sum(states.power(k), |j| self.c.at(i, j));
                let step = if k == 0 { *direct } else { 0.0 };
                fed.set(k, i, own + sum(late, |j| self.d.at(i, j)) + step);
            }
            if k == ORDER {
                break;
            }
            let by = length / (k + 1) as f64;
            for (i, direct) in to_states.iter().enumerate() {
                let own = sum(states.power(k), |j| self.a.at(i, j));
                let step = if k == 0 { *direct } else { 0.0 };
                let rate = own + sum(late, |j| self.b.at(i, j)) + step;
                states.set(k + 1, i, by * rate);
            }
        }
    }
}

/// Σ of the values times the weights.
fn sum(values: &[f64], weight: impl Fn(usize) -> f64) -> f64 {
    values
        .iter()
        .enumerate()
        .map(|(j, value)| weight(j) * value)
        .sum()
}
