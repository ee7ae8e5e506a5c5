//! The points of a measured curve: readings folded to speeds of 0 or more, sorted, and averaged
//! where they are at the same speed.

use std::ops::Range;

use super::remark::Remark;
use crate::model::table::NEAREST;
use crate::text::SpecError;

/// A row of numbers: what was read at one speed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Reading {
    pub speed: f64,
    /// μ_K, with the sign of the force.
    pub mu_k: f64,
    pub origin: Origin,
}

/// Where a reading stands in the text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Origin {
    /// Its line, from 1 on.
    pub line: usize,
    /// The place of the speed.
    pub speed: Range<usize>,
    /// The place of the friction.
    pub friction: Range<usize>,
}

/// Which way the block slid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// At a speed of 0 or more.
    Forward,
    /// At a negative speed.
    Backward,
}

/// The readings at one speed in one direction.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredPoint {
    /// The speed, 0 or more.
    pub speed: f64,
    /// The mean of μ_K.
    pub mu_k: f64,
    /// How many readings.
    pub readings: usize,
    /// Their standard deviation; 0 for one.
    pub spread: f64,
    /// Which way the block slid.
    pub direction: Direction,
    /// Where the first one stands.
    pub(super) origin: Origin,
}

/// Parts of sorted values that are too near to one another for a table.
pub(super) fn near<T>(sorted: &[T], speed: impl Fn(&T) -> f64) -> impl Iterator<Item = &[T]> {
    sorted.chunk_by(move |one, other| speed(other) - speed(one) <= NEAREST * speed(other))
}

/// The mean of weighted values; of equal ones it is the same to the last bit.
pub(super) fn mean(first: f64, values: impl Iterator<Item = (f64, f64)>) -> f64 {
    let (mut sum, mut weights) = (0.0, 0.0);
    for (value, weight) in values {
        sum += weight * (value - first);
        weights += weight;
    }
    first + sum / weights
}

/// The points of readings, sorted by speed, and what is told of them. `column` is what messages
/// call that of the friction.
///
/// # Errors
/// At the first value of μ_K that is not greater than 0, or of another sign than those before.
pub(super) fn points(
    readings: Vec<Reading>,
    column: &str,
) -> Result<(Vec<MeasuredPoint>, Vec<Remark>), SpecError> {
    let (backward, forward): (Vec<_>, Vec<_>) = readings
        .into_iter()
        .partition(|reading| reading.speed < 0.0);
    let checked = |reading| checked(reading, column);
    let mut forward: Vec<Reading> = forward.into_iter().map(checked).collect::<Result<_, _>>()?;
    let mut backward = folded(backward, column)?;
    let mut remarks = Vec::new();
    let (turned, read) = (backward.len(), forward.len() + backward.len());
    let mut points = averaged(&mut forward, Direction::Forward);
    let behind = averaged(&mut backward, Direction::Backward);
    if turned > 0 {
        remarks.push(Remark::Folded {
            readings: turned,
            excess: excess(&behind, &points),
        });
    }
    points.extend(behind);
    points.sort_by(|one, other| one.speed.total_cmp(&other.speed));
    remarks.extend(of_averages(&points, read));
    Ok((points, remarks))
}

fn of_averages(points: &[MeasuredPoint], read: usize) -> Option<Remark> {
    let several = points.iter().filter(|point| point.readings > 1);
    let alone = points.iter().filter(|point| point.readings == 1).count();
    let spread = several.clone().map(|point| point.spread / point.mu_k);
    (read > points.len()).then(|| Remark::Averaged {
        readings: read - alone,
        points: several.count(),
        spread: spread.fold(0.0, f64::max),
    })
}

fn checked(reading: Reading, column: &str) -> Result<Reading, SpecError> {
    if reading.mu_k > 0.0 {
        return Ok(reading);
    }
    let line = reading.origin.line;
    let message = format!("line {line}, {column}: friction is greater than 0");
    let help = "a force against the motion is positive here: change its sign where all are \
                negative, else leave the row out";
    Err(SpecError::at(reading.origin.friction, message).help(help))
}

/// Readings at negative speeds as at positive ones. Where the force has the sign of the speed, that
/// is turned too.
fn folded(readings: Vec<Reading>, column: &str) -> Result<Vec<Reading>, SpecError> {
    let sign = match readings.first() {
        Some(first) if first.mu_k < 0.0 => -1.0,
        _ => 1.0,
    };
    let turn = |reading: Reading| {
        if sign * reading.mu_k > 0.0 {
            return Ok(Reading {
                speed: -reading.speed,
                mu_k: sign * reading.mu_k,
                ..reading
            });
        }
        let line = reading.origin.line;
        let message = format!(
            "line {line}, {column}: friction has one sign at all negative speeds, and is not 0"
        );
        Err(SpecError::at(reading.origin.friction, message)
            .help("correct the row, or leave it out"))
    };
    readings.into_iter().map(turn).collect()
}

fn averaged(readings: &mut [Reading], direction: Direction) -> Vec<MeasuredPoint> {
    readings.sort_by(|one, other| one.speed.total_cmp(&other.speed));
    near(readings, |reading| reading.speed)
        .map(|these| average(these, direction))
        .collect()
}

fn average(readings: &[Reading], direction: Direction) -> MeasuredPoint {
    let first = &readings[0];
    let of = |value: fn(&Reading) -> f64| {
        mean(
            value(first),
            readings.iter().map(|reading| (value(reading), 1.0)),
        )
    };
    let mu_k = of(|reading| reading.mu_k);
    let off = readings.iter().map(|reading| reading.mu_k - mu_k);
    let freedom = (readings.len() - 1).max(1) as f64;
    MeasuredPoint {
        speed: of(|reading| reading.speed),
        mu_k,
        readings: readings.len(),
        spread: (off.map(|off| off * off).sum::<f64>() / freedom).sqrt(),
        direction,
        origin: first.origin.clone(),
    }
}

/// By how much `these` lie above the lines between `others`, relative, on average over the speeds
/// common to both.
fn excess(these: &[MeasuredPoint], others: &[MeasuredPoint]) -> Option<f64> {
    let relative = |point: &MeasuredPoint| {
        let above = others.partition_point(|other| other.speed < point.speed);
        let high = others.get(above)?;
        let low = match above {
            0 if high.speed == point.speed => high,
            _ => others.get(above.checked_sub(1)?)?,
        };
        let part = match high.speed - low.speed {
            0.0 => 0.0,
            width => (point.speed - low.speed) / width,
        };
        let there = low.mu_k + part * (high.mu_k - low.mu_k);
        Some(point.mu_k / there - 1.0)
    };
    let found: Vec<f64> = these.iter().filter_map(relative).collect();
    (!found.is_empty()).then(|| found.iter().sum::<f64>() / found.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn readings(of: &[(f64, f64)]) -> Vec<Reading> {
        let reading = |(k, (speed, mu_k)): (usize, &(f64, f64))| Reading {
            speed: *speed,
            mu_k: *mu_k,
            origin: Origin {
                line: k + 1,
                speed: k..k,
                friction: k..k + 1,
            },
        };
        of.iter().enumerate().map(reading).collect()
    }

    #[test]
    fn readings_are_sorted_and_averaged() {
        let of = [(0.3, 0.25), (0.1, 0.5), (0.3, 0.75), (0.1, 0.5), (0.1, 0.5)];
        let (points, remarks) = points(readings(&of), "mu").unwrap();
        let told = |k: usize| {
            (
                points[k].speed,
                points[k].mu_k,
                points[k].readings,
                points[k].origin.line,
            )
        };
        assert_eq!([told(0), told(1)], [(0.1, 0.5, 3, 2), (0.3, 0.5, 2, 1)]);
        assert_eq!(
            (points[0].spread, points[1].spread),
            (0.0, 0.125_f64.sqrt())
        );
        let told = "5 readings at the same speeds are averaged to 2 points, with a standard \
                    deviation of up to 70.7 %";
        assert_eq!(
            remarks.iter().map(Remark::to_string).collect::<Vec<_>>(),
            [told]
        );
    }

    #[test]
    fn backward_is_told_from_forward() {
        for sign in [1.0, -1.0] {
            let of = [
                (-0.2, 0.9 * sign),
                (0.1, 1.0),
                (0.3, 1.0),
                (-0.3, 0.9 * sign),
            ];
            let (points, remarks) = points(readings(&of), "mu").unwrap();
            let backward = |point: &&MeasuredPoint| point.direction == Direction::Backward;
            assert_eq!(points.iter().filter(backward).count(), 2);
            assert!(points.is_sorted_by_key(|point| point.speed) && points[1].mu_k == 0.9);
            let told = "2 readings at negative speeds taken as at positive ones: mu_k is 10 % \
                        lower there on average";
            assert_eq!(remarks[0].to_string(), told);
        }
        let (_, remarks) = points(readings(&[(-0.2, 0.9), (0.3, 1.0)]), "mu").unwrap();
        assert!(remarks[0].to_string().contains("no speeds in common"));
    }

    #[test]
    fn signs_that_contradict_are_refused() {
        for (of, line) in [
            (&[(0.1, 0.5), (0.2, -0.5)][..], "line 2"),
            (&[(-0.1, 0.5), (-0.2, -0.5)], "line 2"),
            (&[(-0.1, -0.5), (-0.2, 0.5)], "line 2"),
            (&[(0.1, 0.0)], "line 1"),
        ] {
            let error = points(readings(of), "mu").unwrap_err();
            assert!(error.message.starts_with(line), "{error}");
        }
    }
}
