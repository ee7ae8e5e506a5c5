//! The unit of time in which a system is of the order of 1, and lines in other units.

use super::composition::Composition;
use super::line::DelayLine;
use super::parts::FeedbackForm;
use super::polynomial::Polynomial;
use super::system::System;
use crate::linear::rounded::Rounded;
use crate::model::Channel;

/// Frequencies within so many powers of two of 1 stay as they are.
const FEW: i64 = 5;
/// The largest power of two by which a coefficient may change.
const MOST: i64 = 1000;

/// The exponent of a finite number other than 0.
#[inline]
fn exponent(x: f64) -> i64 {
    ((x.to_bits() >> 52) & 0x7ff) as i64 - 1023
}

/// 2^`power`.
fn power_of_two(power: i64) -> f64 {
    f64::from_bits(((1023 + power) as u64) << 52)
}

impl Polynomial {
    /// The inverse of about the mean size of its zeros other than 0, a power of two; 1 where that
    /// is of the order of 1.
    #[inline]
    pub(super) fn time_unit(&self) -> f64 {
        let c = self.coefficients();
        let Some(first) = c.iter().position(|c| *c != 0.0) else {
            return 1.0;
        };
        let n = (c.len() - 1 - first) as i64;
        if n == 0 {
            return 1.0;
        }
        let power = (exponent(c[first]) - exponent(c[c.len() - 1])).div_euclid(n);
        if power.abs() <= FEW {
            return 1.0;
        }
        power_of_two((-power).clamp(-MOST / n, MOST / n))
    }

    /// The polynomial in s·`unit`, times `unit` to the power of `degree`; `unit` is a power of two.
    pub(super) fn in_unit(&self, unit: f64, degree: usize) -> Self {
        let mut power = 1.0;
        for _ in self.degree()..degree {
            power *= unit;
        }
        let mut powers = [0.0; super::polynomial::MOST_DEGREE + 1];
        for k in (0..=self.degree()).rev() {
            powers[k] = power;
            power *= unit;
        }
        Self::of(self.degree(), |k| {
            let Rounded { value, error } = self.coefficient(k);
            Rounded {
                value: value * powers[k],
                error: error * powers[k],
            }
        })
    }
}

impl System {
    /// The unit of time, a power of two, in which the first and the last coefficient of P, or of
    /// the open loop, are about as large as one another; 1 where frequencies are of the order of 1
    /// anyway, and where the numbers are known that the system comes from, which have no unit.
    #[inline]
    #[must_use]
    pub fn time_unit(&self) -> f64 {
        if self.source.is_some() {
            return 1.0;
        }
        let feedback = self.feedback_form();
        feedback.map_or(&self.p, |of| &of.open).time_unit()
    }

    /// This system with its delay and latency in units of `unit`, a power of two: a root λ of
    /// this one is a root λ·`unit` there.
    #[must_use]
    pub(crate) fn in_unit(&self, unit: f64) -> Self {
        let n = match self.feedback_form() {
            Some(feedback) => feedback.open.degree(),
            None => self.p.degree().max(self.q.degree()),
        };
        let [p, q] = [&self.p, &self.q].map(|of| of.in_unit(unit, n));
        let feedback = self.feedback_form().map(|of| FeedbackForm {
            open: of.open.in_unit(unit, n),
            gain: of.gain.in_unit(unit, n),
            channel: Channel {
                latency: of.channel.latency / unit,
                ..of.channel
            },
        });
        let without_feedback = match self.leaves_origin_out() {
            true => Composition::BesideOrigin,
            false => Composition::Direct,
        };
        Self::classified(p, q, feedback.map_or(without_feedback, Composition::from))
    }
}

impl DelayLine {
    /// This line with delays in a unit of time of which `time_unit` makes one dimensionless.
    #[must_use]
    pub fn in_physical_time(mut self, time_unit: f64) -> Self {
        self.scale(time_unit);
        self
    }

    pub(super) fn scale(&mut self, time_unit: f64) {
        for crossing in &mut self.crossings {
            *crossing = crossing.scaled(time_unit);
        }
        if let Some(passage) = &mut self.passage {
            passage.tau *= time_unit;
            passage.error *= time_unit;
        }
        self.open_from *= time_unit;
        self.time_unit *= time_unit;
    }
}
