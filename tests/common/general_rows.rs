//! The tables of independently computed systems with one delay, `tests/reference/general_*.csv`.

#![allow(dead_code, reason = "no test uses all of it")]

use std::collections::HashMap;

use slipmap::linear::general::{Polynomial, System};
use slipmap::model::Channel;

/// One row: its cells by the names of the columns.
pub(crate) struct Row {
    cells: HashMap<String, String>,
    /// Where it stands, for messages.
    pub(crate) place: String,
}

impl Row {
    /// The number in a column, or none where the cell is empty.
    pub(crate) fn number(&self, column: &str) -> Option<f64> {
        let cell = self.cells.get(column)?;
        (!cell.is_empty()).then(|| {
            cell.parse()
                .unwrap_or_else(|_| panic!("{}: {cell}", self.place))
        })
    }

    /// The number in a column that is 0 where the cell is empty or there is no such column.
    pub(crate) fn or_zero(&self, column: &str) -> f64 {
        self.number(column).unwrap_or(0.0)
    }

    /// The text in a column.
    pub(crate) fn text(&self, column: &str) -> &str {
        self.cells.get(column).map_or("", String::as_str)
    }

    /// Intervals `from:to;…`, open ones to infinity.
    pub(crate) fn intervals(&self, column: &str) -> Vec<(f64, f64)> {
        let ends = |text: &str| {
            let (from, to) = text.split_once(':').expect("an interval");
            let to = if to.is_empty() {
                f64::INFINITY
            } else {
                to.parse().expect("a number")
            };
            (from.parse().expect("a number"), to)
        };
        self.text(column)
            .split(';')
            .filter(|s| !s.is_empty())
            .map(ends)
            .collect()
    }
}

/// The rows of a table.
pub(crate) fn rows(name: &str, table: &str) -> Vec<Row> {
    let mut lines = table.lines();
    let header = split(lines.next().expect("a header"));
    lines
        .enumerate()
        .map(|(i, line)| Row {
            cells: header.iter().cloned().zip(split(line)).collect(),
            place: format!("{name}, row {}: {line}", i + 1),
        })
        .collect()
}

fn split(line: &str) -> Vec<String> {
    let (mut cells, mut cell, mut quoted) = (Vec::new(), String::new(), false);
    for c in line.chars() {
        match c {
            '"' => quoted = !quoted,
            ',' if !quoted => cells.push(std::mem::take(&mut cell)),
            c => cell.push(c),
        }
    }
    cells.push(cell);
    cells
}

fn polynomial(coefficients: &[f64]) -> Polynomial {
    Polynomial::new(coefficients).expect("a small degree")
}

fn product(factors: &[&[f64]]) -> Polynomial {
    let one = polynomial(&[1.0]);
    factors
        .iter()
        .fold(one, |p, f| p.times(&polynomial(f)).expect("a small degree"))
}

/// P and Q of the kinds that list coefficients.
fn coefficients(row: &Row) -> System {
    let read = |letter: &str| -> Vec<f64> {
        (0..7)
            .map_while(|k| row.number(&format!("{letter}{k}")))
            .collect()
    };
    System::of_coefficients(&read("p"), &read("q")).expect("a small degree")
}

/// B and A of control with lags; time in units of √(M/κ), N₀ = μ_K = 1.
fn with_lags(row: &Row) -> (Polynomial, Polynomial) {
    let [b, a_v, a_n] = ["mu_prime", "alpha_v", "alpha_n"].map(|name| row.or_zero(name));
    let [load, velocity, sensor] =
        ["load_lag", "velocity_lag", "sensor_lag"].map(|name| row.or_zero(name));
    let open = product(&[
        &[1.0, b, 1.0],
        &[1.0, load],
        &[1.0, velocity],
        &[1.0, sensor],
    ]);
    let gain =
        product(&[&[a_n, a_n * velocity]]).plus(&product(&[&[a_v * b, a_v], &[1.0, load]]), 1.0);
    (open, gain)
}

/// B and A under rate-and-state friction.
fn rate_state(row: &Row) -> (Polynomial, Polynomial) {
    let [direct, evolution, time, c, a_v, a_n] = [
        "direct",
        "evolution",
        "state_time",
        "load_memory",
        "alpha_v",
        "alpha_n",
    ]
    .map(|name| row.or_zero(name));
    let friction = [direct - evolution, direct * time];
    let open =
        product(&[&[1.0, time], &[1.0, 0.0, 1.0]]).plus(&product(&[&[0.0, 1.0], &friction]), 1.0);
    let gain = product(&[&[a_n, a_n * (1.0 - c) * time]])
        .plus(&product(&[&[a_v], &friction]), 1.0)
        .plus(&product(&[&[0.0, a_v], &[1.0, time]]), 1.0);
    (open, gain)
}

fn chatter(row: &Row) -> System {
    let (zeta, width) = (row.or_zero("zeta"), row.or_zero("width"));
    let first = [1.0, 2.0 * zeta, 1.0];
    let (modes, flexibility) = match row.number("omega_2") {
        None => (product(&[&first]), polynomial(&[1.0])),
        Some(omega) => {
            let zeta_2 = row.or_zero("zeta_2");
            let second = [omega * omega, 2.0 * zeta_2 * omega, 1.0];
            let gain = row.or_zero("gain_2");
            (
                product(&[&first, &second]),
                polynomial(&second).plus(&polynomial(&first), gain),
            )
        }
    };
    let q = flexibility
        .times(&polynomial(&[-width]))
        .expect("a small degree");
    System::direct(modes.plus(&q, -1.0), q)
}

fn pd(row: &Row) -> System {
    let [damping, stiffness, k_p, k_d, k_a] =
        ["damping", "stiffness", "k_p", "k_d", "k_a"].map(|name| row.or_zero(name));
    System::of_coefficients(&[stiffness, damping, 1.0], &[k_p, k_d, k_a]).expect("a small degree")
}

/// The tables whose systems have no latency, with the system of each row.
pub(crate) fn without_latency() -> Vec<(Row, System)> {
    let feedback = |(open, gain): (Polynomial, Polynomial), row: &Row| {
        System::feedback(
            open,
            gain,
            Channel {
                memory: row.or_zero("memory"),
                latency: 0.0,
            },
        )
    };
    let mut all = Vec::new();
    let mut add = |name: &str, table: &str, system: &dyn Fn(&Row) -> System| {
        for row in rows(name, table) {
            let system = system(&row);
            all.push((row, system));
        }
    };
    add(
        "retarded",
        include_str!("../reference/general_retarded.csv"),
        &coefficients,
    );
    add(
        "neutral",
        include_str!("../reference/general_neutral.csv"),
        &coefficients,
    );
    add(
        "etdas",
        include_str!("../reference/general_etdas.csv"),
        &|r| feedback(with_lags(r), r),
    );
    add("lag", include_str!("../reference/general_lag.csv"), &|r| {
        feedback(with_lags(r), r)
    });
    add(
        "rate_state",
        include_str!("../reference/general_rate_state.csv"),
        &|r| feedback(rate_state(r), r),
    );
    add(
        "chatter",
        include_str!("../reference/general_chatter.csv"),
        &chatter,
    );
    add("pd", include_str!("../reference/general_pd.csv"), &pd);
    all
}

/// The table of systems with latency.
pub(crate) fn with_latency() -> Vec<(Row, System)> {
    rows("latency", include_str!("../reference/general_latency.csv"))
        .into_iter()
        .map(|row| {
            let (open, gain) = with_lags(&row);
            let system = System::feedback(
                open,
                gain,
                Channel {
                    memory: row.or_zero("memory"),
                    latency: row.or_zero("latency"),
                },
            );
            (row, system)
        })
        .collect()
}

/// The degenerate ones.
pub(crate) fn degenerate() -> Vec<(Row, System)> {
    rows(
        "degenerate",
        include_str!("../reference/general_degenerate.csv"),
    )
    .into_iter()
    .map(|row| {
        let system = coefficients(&row);
        (row, system)
    })
    .collect()
}
