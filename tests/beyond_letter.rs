//! The letter's control with memory and lags, by its own parameters, against independently computed
//! tables; and nothing changes where there is none of them.

#[path = "common/general_rows.rs"]
#[allow(dead_code)]
mod general_rows;

use general_rows::{Row, rows};
use serde_json::Value;
use slipmap::explore::point::Point;
use slipmap::explore::stability::Wanted;
use slipmap::sweep::{Parameter, Setting};

const TABLES: [(&str, &str); 2] = [
    ("etdas", include_str!("reference/general_etdas.csv")),
    ("lag", include_str!("reference/general_lag.csv")),
];

fn all_rows() -> impl Iterator<Item = Row> {
    TABLES
        .into_iter()
        .flat_map(|(name, table)| rows(name, table))
}

/// The setting of a row, in units of time, length and force of which `units` make one of the
/// row's.
fn setting(row: &Row, [force, length, time]: [f64; 3]) -> Setting {
    let mut setting = Setting::new(None);
    for parameter in Parameter::ALL {
        let unit = [force, length, time]
            .iter()
            .zip(parameter.dimension())
            .map(|(unit, power)| unit.powi(power))
            .product::<f64>();
        let value = row
            .number(parameter.name())
            .or(parameter.default_value())
            .unwrap_or(f64::NAN);
        setting.set(parameter, value * unit);
    }
    setting
}

fn point(setting: &Setting, line: Option<f64>) -> Value {
    let point = Point::at(setting, Wanted { roots: 1, line }).unwrap();
    serde_json::to_value(point).unwrap()
}

fn near(found: &Value, expected: f64, error: f64) -> bool {
    let found = found.as_f64().unwrap_or(f64::NAN);
    (found - expected).abs() <= error * expected.abs().max(1.0)
}

#[test]
fn points_of_the_tables() {
    let mut checked = 0;
    for row in all_rows() {
        // In other units, too: nothing depends on them.
        for units in [[1.0; 3], [3.0, 0.02, 0.25]] {
            let time = units[2];
            let line = row.or_zero("line") / time;
            let found = point(&setting(&row, units), Some(line));
            let says = |key: &str, column: &str| {
                let expected = row.number(column).map(|n| n as i64);
                assert_eq!(
                    found[key].as_i64(),
                    expected,
                    "{key}: {}\n{found}",
                    row.place
                );
            };
            says("n_unstable", "n_unstable");
            says("n_at_zero_delay", "n_at_zero_delay");
            says("first_change", "first_change");
            says("n_right_of_line", "n_right_of_line");
            for (key, column, unit, error) in [
                ("first_crossing", "first_crossing", time, 1e-9),
                ("abscissa", "re_rightmost", 1.0 / time, 2e-12),
                ("frequency", "im_rightmost", 1.0 / time, 2e-12),
                (
                    "essential_abscissa",
                    "essential_abscissa",
                    1.0 / time,
                    1e-13,
                ),
            ] {
                let expected = row.number(column).map(|value| value * unit);
                let same = match expected {
                    Some(expected) => near(&found[key], expected, error),
                    None => found[key].is_null(),
                };
                assert!(same, "{key} {expected:?}: {}\n{found}", row.place);
            }
            assert_eq!(found["certified"], true, "{}", row.place);
            assert_eq!(found["reason"], Value::Null, "{}", row.place);
            assert_eq!(found["marginal"], false, "{}", row.place);
            let stable = row.or_zero("n_unstable") == 0.0;
            assert_eq!(found["stable"], stable, "{}", row.place);
            let expected = row.intervals("stable_delays");
            let intervals = found["stable_delays"].as_array().unwrap();
            assert!(intervals.len() >= expected.len(), "{}\n{found}", row.place);
            for (found, (from, to)) in intervals.iter().zip(expected) {
                let end = match to.is_finite() {
                    true => near(&found[1], to * time, 1e-9),
                    false => found[1].is_null(),
                };
                assert!(end && near(&found[0], from * time, 1e-9), "{}", row.place);
            }
            checked += 1;
        }
    }
    assert!(checked > 280, "{checked}");
}

/// The distance to the nearest change of stability, from the intervals of the table.
#[test]
fn delay_margins_of_the_tables() {
    let mut checked = 0;
    for row in all_rows() {
        let tau = row.or_zero("tau");
        let intervals = row.intervals("stable_delays");
        if intervals.len() >= 12 {
            continue;
        }
        let ends = intervals.iter().flat_map(|(from, to)| [*from, *to]);
        let ends = ends.filter(|end| *end > 0.0 && end.is_finite());
        let nearest = ends
            .map(|end| (end - tau).abs())
            .fold(f64::INFINITY, f64::min);
        let stable = row.or_zero("n_unstable") == 0.0;
        let found = point(&setting(&row, [1.0; 3]), None);
        let sign = if stable { 1.0 } else { -1.0 };
        assert_eq!(found["delay_margin_sign"], sign as i64, "{}", row.place);
        let same = match nearest.is_finite() {
            true => near(&found["delay_margin"], sign * nearest, 1e-9),
            false => found["delay_margin"].is_null(),
        };
        assert!(same, "{}\n{found}", row.place);
        checked += 1;
    }
    assert!(checked > 100, "{checked}");
}

/// What is known of the letter's own system stays, to the last bit.
#[test]
fn zeros_change_nothing() {
    for row in all_rows() {
        let mut plain = setting(&row, [3.0, 0.02, 0.25]);
        for parameter in Parameter::BEYOND_LETTER {
            plain.set(parameter, 0.0);
        }
        let mut negative = plain.clone();
        negative.set(Parameter::Memory, -0.0);
        let found = point(&plain, None);
        assert_eq!(found.to_string(), point(&negative, None).to_string());
        assert_eq!(found["reason"], Value::Null);
        // Margins of the letter's system are all there.
        assert_eq!(found["undecided"].as_array().map(Vec::len), Some(0));
    }
}

/// A lag too short to matter gives the letter's own counts, by the general way.
#[test]
fn short_lags_are_harmless() {
    for row in all_rows() {
        let mut plain = setting(&row, [1.0; 3]);
        for parameter in Parameter::BEYOND_LETTER {
            plain.set(parameter, 0.0);
        }
        let mut lagging = plain.clone();
        for parameter in Parameter::LAGS {
            lagging.set(parameter, 1e-10);
        }
        let (plain, lagging) = (point(&plain, None), point(&lagging, None));
        assert_eq!(plain["n_unstable"], lagging["n_unstable"], "{}", row.place);
        let abscissa = plain["abscissa"].as_f64().unwrap();
        assert!(
            near(&lagging["abscissa"], abscissa, 1e-7),
            "{}\n{lagging}",
            row.place
        );
    }
}
