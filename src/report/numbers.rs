//! Numbers in forms for people.

use std::time::{Duration, SystemTime, UNIX_EPOCH};

use crate::text::{Shown, to_digits};

/// The last second of the year 9999, in seconds since 1970.
const LAST_SECOND: u64 = 253_402_300_799;

/// The time nearest to `time` that can be written as text: from 1970 to the end of 9999.
#[must_use]
pub fn representable(time: SystemTime) -> SystemTime {
    let last = UNIX_EPOCH + Duration::from_secs(LAST_SECOND);
    time.clamp(UNIX_EPOCH, last)
}

/// A count with thin spaces between groups of three digits: 8 658 009.
#[must_use]
pub fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

/// A quantity with a decimal prefix and three digits: "12.3 M".
#[must_use]
pub fn prefixed(value: f64) -> String {
    for (size, prefix) in [(1e12, " T"), (1e9, " G"), (1e6, " M"), (1e3, " k")] {
        if value >= size {
            return format!("{}{prefix}", three_digits(value / size));
        }
    }
    format!("{} ", three_digits(value)).trim_end().to_owned()
}

fn three_digits(value: f64) -> String {
    match value {
        v if v >= 99.95 => format!("{v:.0}"),
        v if v >= 9.995 => format!("{v:.1}"),
        v => format!("{v:.2}"),
    }
}

/// A number and its standard error, both to the third digit of the error.
#[must_use]
pub fn with_error(value: f64, error: f64) -> (String, String) {
    let first = error.abs().log10().floor();
    let places = (2.0 - first).clamp(0.0, 12.0) as usize;
    (format!("{value:.places$}"), format!("{error:.places$}"))
}

/// Bytes with a decimal prefix: "12.3 MB".
#[must_use]
pub fn bytes(n: u64) -> String {
    if n < 1000 {
        format!("{n} B")
    } else {
        format!("{}B", prefixed(n as f64))
    }
}

/// A duration in readable units: "0.12 s", "3 min 20 s", "5 h 12 min", "3 years".
#[must_use]
pub fn seconds(s: f64) -> String {
    let whole = s.round() as u64;
    match whole {
        0..60 if s < 9.995 => format!("{s:.2} s"),
        0..60 => format!("{s:.0} s"),
        60..3600 => format!("{} min {} s", whole / 60, whole % 60),
        3600..360_000 => format!("{} h {} min", whole / 3600, whole % 3600 / 60),
        360_000..TWO_YEARS => format!("{} days", whole / 86_400),
        TWO_YEARS..LONGEST => format!("{} years", whole / YEAR),
        _ => format!("more than {} years", grouped(LONGEST / YEAR)),
    }
}

/// Seconds of a year, and of the longest times that are told.
const YEAR: u64 = 31_557_600;
const TWO_YEARS: u64 = 2 * YEAR;
const LONGEST: u64 = 1000 * YEAR;

/// A number in full where that is short, else with four digits.
#[must_use]
pub fn short(value: f64) -> String {
    let plain = format!("{value}");
    if plain.len() <= 8 {
        plain
    } else {
        format!("{value:.3e}")
    }
}

/// A number with at most `digits` digits after its first one, and a zero without a sign. Nine
/// digits in all are the same on every machine.
#[must_use]
pub fn rounded(value: f64, digits: usize) -> String {
    // What is added makes of -0 a 0, and changes nothing else.
    Shown(to_digits(value, digits) + 0.0).to_string()
}

/// A bound with at most `digits` digits after its first one, rounded up or down: outwards, so that
/// it stays a bound.
#[must_use]
pub fn bound(value: f64, digits: usize, up: bool) -> String {
    let text = format!("{value:.digits$e}");
    let near = text.parse::<f64>().unwrap_or(value);
    let inside = if up { near < value } else { near > value };
    if !inside || !value.is_finite() {
        return Shown(near).to_string();
    }
    let exponent = text.split_once('e').and_then(|(_, e)| e.parse().ok());
    let step = 10_f64.powi(exponent.unwrap_or(0_i32) - digits as i32);
    let sign = if up { 1.0 } else { -1.0 };
    rounded(near + sign * step, digits)
}

/// A count of things with regular plurals: "1 plane", "12 000 planes".
#[must_use]
pub fn counted(n: u64, thing: &str) -> String {
    let plural = if n == 1 { "" } else { "s" };
    format!("{} {thing}{plural}", grouped(n))
}

/// A unit to follow a number, after a space; empty for "1".
#[must_use]
pub fn unit_behind(unit: &str) -> String {
    match unit {
        "" | "1" => String::new(),
        unit => format!(" {unit}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn people_can_read_them() {
        assert_eq!([unit_behind("1"), unit_behind("N m-1")], ["", " N m-1"]);
        assert_eq!(grouped(0), "0");
        assert_eq!(grouped(999), "999");
        assert_eq!(grouped(8_658_009), "8 658 009");
        assert_eq!(counted(1, "plane"), "1 plane");
        assert_eq!(counted(12_000, "plane"), "12 000 planes");
        assert_eq!(bound(0.123_456_4, 5, true), "0.123457");
        assert_eq!(bound(0.123_456_4, 5, false), "0.123456");
        assert_eq!(bound(0.123_456_6, 5, false), "0.123456");
        assert_eq!(bound(0.999_999_6, 5, false), "0.99999");
        assert_eq!(bound(-0.123_456_6, 5, true), "-0.123456");
        assert_eq!([bound(0.5, 5, true), bound(0.5, 5, false)], ["0.5", "0.5"]);
        assert_eq!(rounded(1.0 / 3.0, 2), "0.333");
        assert_eq!(rounded(1e-300 / 3.0, 2), "3.33e-301");
        assert_eq!(prefixed(12_345_678.0), "12.3 M");
        assert_eq!(prefixed(0.5), "0.50");
        assert_eq!(bytes(512), "512 B");
        assert_eq!(bytes(3_000_000_000), "3.00 GB");
        assert_eq!(seconds(0.123), "0.12 s");
        assert_eq!(seconds(200.0), "3 min 20 s");
        assert_eq!(short(-0.25), "-0.25");
        assert_eq!(short(1.0 / 3.0), "3.333e-1");
        assert_eq!(seconds(18_720.0), "5 h 12 min");
        assert_eq!(seconds(6e7), "694 days");
        assert_eq!(seconds(1e10), "316 years");
        for long in [4e10, 1e300, f64::INFINITY] {
            assert_eq!(seconds(long), "more than 1 000 years");
        }
    }
}
