//! The letter's control with memory, latency and lags, and under rate-and-state friction, by its own
//! parameters, against independently computed tables; and nothing changes where there is none of it.

use std::sync::Arc;

use crate::general_rows::{Row, rows};
use serde_json::Value;
use slipmap::explore::point::Point;
use slipmap::explore::stability::Wanted;
use slipmap::linear::status::{CERTIFIED, DISAGREE, MARGINAL, NOT_CONVERGED};
use slipmap::model::stop::Stop;
use slipmap::setting::field::Storage;
use slipmap::setting::law_kind::LawKind;
use slipmap::setting::{Field, Parameter, Setting, SweepSpec};
use slipmap::sweep::Plan;
use slipmap::sweep::cells::second_look::{Answer, Question, Stored, second_look};
use slipmap::sweep::events::Attended;
use slipmap::sweep::grid::Grid;

const TABLES: [(&str, &str); 4] = [
    ("etdas", include_str!("../reference/general_etdas.csv")),
    ("lag", include_str!("../reference/general_lag.csv")),
    ("latency", include_str!("../reference/general_latency.csv")),
    (
        "rate_state",
        include_str!("../reference/general_rate_state.csv"),
    ),
];

fn all_rows() -> impl Iterator<Item = Row> {
    TABLES
        .into_iter()
        .flat_map(|(name, table)| rows(name, table))
}

/// The setting of a row, in units of time, length and force of which `units` make one of the
/// row's.
fn setting(row: &Row, [force, length, time]: [f64; 3]) -> Setting {
    let with_state = row.number("state_time").is_some();
    let law = with_state.then(|| LawKind::named("rate-and-state").unwrap());
    let mut setting = Setting::new(law);
    for parameter in Parameter::ALL {
        let unit = [force, length, time]
            .iter()
            .zip(parameter.dimension())
            .map(|(unit, power)| unit.powi(power))
            .product::<f64>();
        let of_state = match parameter {
            _ if !with_state => None,
            Parameter::Mu0 | Parameter::VStar | Parameter::V0 => Some(1.0),
            Parameter::DirectEffect => row.number("direct"),
            Parameter::EvolutionEffect => row.number("evolution"),
            Parameter::SlipDistance => row.number("state_time"),
            _ => None,
        };
        let value = of_state
            .or(row.number(parameter.name()))
            .or(parameter.default_value())
            .unwrap_or(f64::NAN);
        setting.set(parameter, value * unit);
    }
    setting
}

fn point(setting: &Setting, line: Option<f64>) -> Value {
    let point = Point::at(setting, Wanted { roots: 1, line }, &Stop::default()).unwrap();
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
        let other = (checked % 4 == 0).then_some([3.0, 0.02, 0.25]);
        for units in [[1.0; 3]].into_iter().chain(other) {
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
                // What nothing feeds back is not remembered.
                let idle = row.or_zero("alpha_v") == 0.0 && row.or_zero("alpha_n") == 0.0;
                let expected = expected.filter(|_| !(idle && key == "essential_abscissa"));
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
            same_intervals(&row, "stable_delays", &found, time);
            same_latencies(&row, &found, time);
            checked += 1;
        }
    }
    assert!(checked > 350, "{checked}");
}

/// The latency margin counts from no latency at all, also where the setting's own is too long.
#[test]
fn the_latency_margin_does_not_depend_on_the_latency() {
    let at = |latency: f64| {
        let mut setting = Setting::new(None);
        for (parameter, value) in [
            (Parameter::MuPrime, -0.3),
            (Parameter::AlphaV, -0.33),
            (Parameter::Tau, 4.15),
            (Parameter::Latency, latency),
        ] {
            setting.set(parameter, value);
        }
        point(&setting, None)["latency_margin"].as_f64().unwrap()
    };
    assert!((at(0.0) - 0.175_588_644_23).abs() < 1e-10);
    for latency in [0.1, 0.2, 3.0] {
        assert!((at(latency) - at(0.0)).abs() < 1e-11, "{latency}");
    }
}

fn same_latencies(row: &Row, found: &Value, time: f64) {
    if row.number("latency").is_none() {
        return;
    }
    same_intervals(row, "stable_latencies", found, time);
    let told = &found["latency_margin"];
    let same = match row.text("latency_margin") {
        "inf" => told.is_null(),
        margin => near(told, margin.parse::<f64>().unwrap() * time, 1e-11),
    };
    assert!(same || found["decays"] == false, "{}\n{found}", row.place);
}

fn same_intervals(row: &Row, name: &str, found: &Value, time: f64) {
    let expected = row.intervals(name);
    let intervals = found[name].as_array().unwrap();
    assert!(intervals.len() >= expected.len(), "{}\n{found}", row.place);
    for (found, (from, to)) in intervals.iter().zip(expected) {
        let end = match to.is_finite() {
            true => near(&found[1], to * time, 1e-9),
            false => found[1].is_null(),
        };
        assert!(
            end && near(&found[0], from * time, 1e-9),
            "{name}: {}",
            row.place
        );
    }
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
        if plain.rate_and_state().is_some() {
            continue;
        }
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
        if plain.rate_and_state().is_some() {
            continue;
        }
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

const FIELDS: &str = "fields = [\"n_unstable\", \"delay_margin\", \"abscissa\", \"frequency\", \
    \"relaxation_time\", \"essential_abscissa\", \"d_abscissa_d_tau\", \
    \"d_abscissa_d_alpha_v\", \"d_abscissa_d_alpha_n\", \"d_abscissa_d_mu_prime\"]\n";

/// Gains and delays around a lobe of velocity control, one gain and one delay 0.
const PLANE: &str = "alpha_v = { from = -0.9, to = 0.1, points = 11 }\n\
    tau = { from = 0, to = 9, points = 13 }\n";
const FIXED: &str = "[fixed]\nmu_prime = -0.6\nalpha_n = 0.0\nmass = 2.0\nstiffness = 5.0\n";

/// Weakens steadily, with a critical stiffness.
const STATE: &str = "[friction]\nlaw = \"rate-and-state\"\nmu0 = 0.5\nv_star = 0.1\n\
    direct_effect = 0.02\nevolution_effect = 0.03\nslip_distance = 0.01\n";

/// Without control sliding is stable above the critical stiffness, whatever else there is; lags of
/// what does not act change nothing.
#[test]
fn the_critical_stiffness_is_where_sliding_becomes_stable() {
    for lags in ["", "load_lag = 0.3\nsensor_lag = 0.1\n"] {
        let grid = cells(&format!(
            "fields = [\"n_unstable\", \"stiffness_ratio\", \"abscissa\"]\n[axes]\n\
             stiffness = {{ from = 0.1, to = 5, points = 99 }}\nv0 = [0.003, 0.1, 2.0]\n\
             [fixed]\ntau = 1\nmass = 0.01\nnormal_load = 2\n{lags}{STATE}"
        ));
        let (ratios, counts) = (column(&grid, "stiffness_ratio"), &grid.cells.n_unstable);
        let counts = counts.as_ref().unwrap();
        for (ratio, &n) in ratios.iter().zip(counts) {
            assert_eq!(n, if *ratio < 1.0 { 2 } else { 0 }, "{ratio}");
        }
        let both = ratios.iter().filter(|ratio| **ratio < 1.0).count();
        assert!(both > 20 && both < ratios.len() - 20, "{both}");
    }
}

/// The cells of a sweep, computed into memory.
fn cells(text: &str) -> Grid {
    let plan = Plan::new(text.parse::<SweepSpec>().unwrap()).unwrap();
    Grid::compute(&Arc::new(plan), 2, Attended::silently(&Arc::default())).unwrap()
}

fn column(grid: &Grid, field: &str) -> Vec<f64> {
    let field = Field::from_name(field).unwrap();
    let columns = grid.cells.columns.iter().find(|c| c.field == field);
    columns.expect("a field of the sweep").cells.clone()
}

/// The value in a cell where a point there says it.
fn same_number(cell: f64, said: &Value) -> bool {
    match said.as_f64() {
        Some(said) => cell == said || (cell - said).abs() <= 1e-12 * said.abs(),
        None => !cell.is_finite(),
    }
}

#[test]
fn cells_of_maps_are_points() {
    for axis in [
        "memory = [-0.4, 0.0, 0.3, 0.9]\n",
        "sensor_lag = [0.0, 1e-9, 0.5]\n",
        "latency = [0.0, 0.3]\n",
    ] {
        let grid = cells(&format!("{FIELDS}[axes]\n{axis}{PLANE}{FIXED}"));
        let plan = grid.plan();
        let counts = grid.cells.n_unstable.as_ref().unwrap();
        let reasons = &grid.cells.kinds[0];
        assert_eq!(reasons.field, Field::Reason, "it comes unasked");
        let shape = plan.shape().to_vec();
        let mut stable = 0;
        for i in 0..counts.len() {
            let index = [
                i / (shape[1] * shape[2]),
                i / shape[2] % shape[1],
                i % shape[2],
            ];
            let setting = plan.setting(&index);
            let found = point(&setting, None);
            let status = grid.cells.status[i];
            assert_eq!(Some(u64::from(counts[i])), found["n_unstable"].as_u64());
            assert_eq!(status & MARGINAL != 0, found["marginal"] == true);
            assert_eq!(
                status & CERTIFIED != 0,
                found["certified"] == true,
                "{found}"
            );
            assert_eq!(status & (NOT_CONVERGED | DISAGREE), 0, "{found}");
            for name in [
                "abscissa",
                "frequency",
                "delay_margin",
                "essential_abscissa",
            ] {
                let cell = column(&grid, name)[i];
                assert!(same_number(cell, &found[name]), "{name} {cell}: {found}");
            }
            let names = Field::Reason.kinds().unwrap();
            let reason = names[usize::from(reasons.cells[i])];
            assert_eq!(reason, found["reason"].as_str().unwrap_or("none"));
            stable += u32::from(found["stable"] == true);
        }
        assert!(stable > 0, "{axis}");
    }
}

/// Where the memory is 0 the cells are those of a sweep without it, bit by bit.
#[test]
fn cells_without_memory_are_the_letters_own() {
    let with = cells(&format!(
        "{FIELDS}[axes]\nmemory = [0.0, 0.5]\n{PLANE}{FIXED}"
    ));
    let without = cells(&format!("{FIELDS}[axes]\n{PLANE}{FIXED}"));
    let len = without.cells.status.len();
    assert_eq!(with.cells.status[..len], without.cells.status[..]);
    let counts = |grid: &Grid| grid.cells.n_unstable.clone().unwrap();
    assert_eq!(counts(&with)[..len], counts(&without)[..]);
    for field in without
        .plan()
        .spec
        .fields
        .iter()
        .filter(|f| f.storage() == Storage::Real)
    {
        let bits = |grid: &Grid| -> Vec<u64> {
            let cells = column(grid, field.name());
            cells[..len].iter().map(|cell| cell.to_bits()).collect()
        };
        assert_eq!(bits(&with), bits(&without), "{}", field.name());
    }
}

/// The derivatives of a map against difference quotients of its own abscissas.
#[test]
fn derivatives_are_slopes_of_the_abscissa() {
    let with = |changed: &str, by: f64| {
        let value = |name: &str, at: f64| at + if name == changed { by } else { 0.0 };
        let (tau, alpha_v) = (value("tau", 1.3), value("alpha_v", -0.4));
        let (alpha_n, mu_prime) = (value("alpha_n", 0.7), value("mu_prime", -0.6));
        cells(&format!(
            "{FIELDS}[axes]\ntau = [{tau:?}]\n[fixed]\nmu_prime = {mu_prime:?}\n\
             alpha_v = {alpha_v:?}\nalpha_n = {alpha_n:?}\nmass = 2.0\nstiffness = 5.0\n\
             memory = 0.35\nload_lag = 0.1\nvelocity_lag = 0.4\nsensor_lag = 0.02\n\
             latency = 0.07\n"
        ))
    };
    let here = with("", 0.0);
    for name in ["tau", "alpha_v", "alpha_n", "mu_prime"] {
        let abscissa = |by: f64| column(&with(name, by), "abscissa")[0];
        let numeric = (abscissa(1e-5) - abscissa(-1e-5)) / 2e-5;
        let found = column(&here, &format!("d_abscissa_d_{name}"))[0];
        assert!((found - numeric).abs() < 1e-7, "{name}: {found} {numeric}");
    }
}

/// A second method looks at cells of general systems, too.
#[test]
fn cells_are_looked_at_twice() {
    let grid = cells(&format!(
        "{FIELDS}[axes]\nmemory = [-0.4, 0.3]\n{PLANE}{FIXED}"
    ));
    let plan = grid.plan();
    let counts = grid.cells.n_unstable.as_ref().unwrap();
    let mut agree = 0;
    for (i, &n) in counts.iter().enumerate() {
        let index = [i / (11 * 13), i / 13 % 11, i % 13];
        for shift in [0.0, 1.0] {
            let value = |field: Field| match field {
                Field::NUnstable => f64::from(n) + shift,
                field => column(&grid, field.name())[i],
            };
            let status = grid.cells.status[i];
            let stored = Stored {
                status,
                value: &value,
            };
            for (question, answer) in second_look(plan, &index, &stored).unwrap() {
                let wrong = shift > 0.0 && question == Question::Count;
                let expected = if wrong {
                    Answer::Differs
                } else {
                    Answer::Agrees
                };
                assert!(
                    answer == expected || answer == Answer::Open,
                    "{question:?} {index:?}"
                );
                agree += u32::from(answer == expected);
            }
        }
    }
    assert!(agree > 900, "{agree}");
}

#[test]
fn what_cannot_be_had_is_told_at_its_key() {
    let friction = "[friction]\nlaw = \"coulomb\"\nmu0 = 0.4\n";
    let sweep = |head: &str, fixed: &str| {
        format!("{head}[axes]\nalpha_n = [-1, 1]\ntau = [1, 2]\n[fixed]\n{fixed}")
    };
    let told = [
        (
            "fields = [\"phase_margin\"]\n",
            "v0 = 0.1\nmemory = 0.2\n",
            STATE,
        ),
        (
            "fields = [\"outcome\"]\n",
            "v0 = 0.1\nsensor_lag = 0.2\n",
            friction,
        ),
        ("fields = [\"vc\"]\n", "velocity_lag = 0.2\n", friction),
        ("fields = [\"stiffness_ratio\"]\n", "v0 = 0.1\n", friction),
        ("fields = [\"stability_radius\"]\n", "v0 = 0.1\n", STATE),
        (
            "fields = [\"d_abscissa_d_mu_prime\"]\n",
            "v0 = 0.1\n",
            STATE,
        ),
        ("fields = [\"basin_share\"]\n", "v0 = 0.1\n", STATE),
        ("fields = [\"vc\"]\n", "", STATE),
        (
            "",
            "v0 = 0.1\n",
            "[friction]\nlaw = \"rate-and-state\"\nmu0 = 0.5\nmu_s = 1\n",
        ),
        ("", "mu_prime = -0.1\nmemory = 1.0\n", ""),
        ("", "mu_prime = -0.1\nlatency = -1.0\n", ""),
    ]
    .map(|(head, fixed, law)| {
        let text = sweep(head, fixed) + law;
        let error = text.parse::<SweepSpec>().unwrap_err();
        let place = error.span.map(|span| text[span].to_owned());
        format!(
            "{}\n  at {}\n  {}\n",
            error.message,
            place.unwrap(),
            error.help.unwrap_or_default()
        )
    });
    insta::assert_snapshot!(told.concat());
}
