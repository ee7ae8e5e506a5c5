//! Margins of loops that other programs, books and papers tell, by `slipmap margins --system`.
//!
//! The table has what another program computed with forty digits, from the crossings of the loop
//! and the number of unstable roots of the closed one, and what is published: to its digits where
//! the published number is right to them, else as `published_otherwise`, with settings that were
//! rounded, frequencies of a grid or misprints.

use serde_json::Value;

use crate::program::{self, Folder, err};

struct Row<'t> {
    name: &'t str,
    plant: [&'t str; 2],
    tau: &'t str,
    /// Ends of the gain, phase in degrees, delay, distance from −1.
    numbers: [f64; 5],
    published: &'t str,
}

const TABLE: &str = include_str!("../reference/loop_margins.csv");

fn rows() -> impl Iterator<Item = Row<'static>> {
    TABLE.lines().skip(1).map(|line| {
        let cells: Vec<&str> = line.splitn(12, ',').collect();
        let number = |i: usize| -> f64 { cells[i].parse().unwrap() };
        Row {
            name: cells[0],
            plant: [cells[1], cells[2]],
            tau: cells[3],
            numbers: [number(4), number(5), number(6), number(7), number(8)],
            published: cells[9],
        }
    })
}

/// The margins of a loop in the order of the table; what is null is infinite.
fn margins(folder: &Folder, row: &Row) -> [f64; 5] {
    let [num, den] = row.plant.map(|of| of.replace(' ', ", "));
    let text = format!("plant = {{ num = [{num}], den = [{den}] }}\ndelay = \"tau\"\n");
    std::fs::write(folder.path().join("loop.toml"), text).unwrap();
    let args = [
        "margins",
        "--system",
        "loop.toml",
        "--tau",
        row.tau,
        "--json",
    ];
    let output = folder.run(&args);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}: {}",
        row.name,
        err(&output)
    );
    let told = program::json(&output);
    assert_eq!(told["decays"], true, "{}: {told}", row.name);
    let of = |value: &Value| value.as_f64().unwrap_or(f64::INFINITY);
    [
        told["gain_margin"]["lower"].as_f64().unwrap_or(0.0),
        of(&told["gain_margin"]["upper"]),
        of(&told["phase_margin"]).to_degrees(),
        of(&told["tau_margin"]["upper"]),
        of(&told["modulus_margin"]),
    ]
}

/// The number that a published one of this name is compared with.
fn named(name: &str, [lower, upper, phase, delay, modulus]: [f64; 5]) -> f64 {
    match name {
        "gm" => upper,
        "gml" => lower,
        "gm_db" => 20.0 * upper.log10(),
        "pm" => phase,
        "pm_rad" => phase.to_radians(),
        "dm" => delay,
        "mm" => modulus,
        "ms" => 1.0 / modulus,
        _ => panic!("{name} is no margin"),
    }
}

#[test]
fn margins_are_those_of_other_programs_and_books() {
    let folder = Folder::new();
    let (mut loops, mut published, mut late) = (0, 0, 0);
    for row in rows() {
        let found = margins(&folder, &row);
        for (i, (found, expected)) in found.iter().zip(row.numbers).enumerate() {
            let apart = match found == &expected {
                true => 0.0,
                false => (found / expected - 1.0).abs(),
            };
            assert!(apart < 1e-9, "{} number {i}: {found} {expected}", row.name);
        }
        for said in row.published.split_whitespace() {
            let (name, digits) = said.split_once('=').unwrap();
            let value = named(name, found);
            let of_digits: f64 = digits.parse().unwrap();
            let decimals = digits.split_once('.').map_or(0, |(_, behind)| behind.len());
            let half = (0.5 * 0.1_f64.powi(decimals as i32)).max(1e-13 * of_digits.abs());
            let equal = value == of_digits || (value - of_digits).abs() <= half * (1.0 + 1e-9);
            assert!(equal, "{}: {said}, not {value}", row.name);
            published += 1;
        }
        loops += 1;
        late += u32::from(row.tau != "0");
    }
    println!("{loops} loops, {late} with a delay, {published} published numbers");
    assert!(
        loops >= 70 && late >= 40 && published >= 100,
        "{loops} {late} {published}"
    );
}
