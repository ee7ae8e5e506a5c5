//! Loops of plant and controller, and divisors in s, through the real program: against closed forms
//! of textbooks, and against the same systems multiplied out by hand.

use crate::program::{self, Folder, err, expect, out};
use serde_json::Value;
use std::f64::consts::PI;

fn point(system: &str, more: &[&str]) -> Value {
    let folder = Folder::with(&[("system.toml", system)]);
    let named = !system.contains('=');
    let of = if named { system } else { "system.toml" };
    let output = folder.run(&[&["point", "--json", "--system", of], more].concat());
    assert_eq!(output.status.code(), Some(0), "{system}: {}", err(&output));
    program::json(&output)
}

fn near(found: &Value, expected: f64, what: &str) {
    let number = found.as_f64().unwrap_or(f64::NAN);
    let apart = (number - expected).abs();
    assert!(
        apart <= 1e-12 * expected.abs().max(1.0),
        "{what}: {found}, not {expected}"
    );
}

/// phase margin over crossover frequency, for loops of textbooks.
#[test]
fn delay_margins_are_phase_margins_over_crossover_frequencies() {
    // K/(s (T s + 1)) alone.
    let (k, t) = (2.5_f64, 0.8_f64);
    let omega = (((1.0 + 4.0 * (k * t).powi(2)).sqrt() - 1.0) / (2.0 * t * t)).sqrt();
    let servo =
        "plant = { num = [\"K\"], den = [\"T\", 1, 0] }\nparameters.K = 2.5\nparameters.T = 0.8\n";
    let margin = (PI / 2.0 - (omega * t).atan()) / omega;
    near(
        &point(servo, &["--tau", "0"])["delay_margin"],
        margin,
        "servo",
    );
    // K/(T s + 1), K > 1.
    let lag = "plant = \"3/(2*s + 1)\"\ndelay = \"tau\"\n";
    let root = 8.0_f64.sqrt();
    let margin = (PI - root.atan()) * 2.0 / root;
    near(&point(lag, &["--tau", "0"])["delay_margin"], margin, "lag");
    // PI control that cancels the pole of the plant: k/s, whose pole at −1/T stays hidden.
    let pi = point("pi_loop", &["--tau", "1"]);
    near(&pi["delay_margin"], PI - 1.0, "pi_loop");
    let hidden = pi["roots"].as_array().unwrap().iter();
    let hidden = hidden.filter(|root| (root[0].as_f64().unwrap() + 0.25).abs() < 1e-12);
    assert_eq!(hidden.count(), 1, "{pi}");
    // PD control of 1/s²: ω⁴ = k_p² + k_d² ω².
    let (k_p, k_d) = (1.7_f64, 0.9_f64);
    let square = 0.5 * (k_d * k_d + (k_d.powi(4) + 4.0 * k_p * k_p).sqrt());
    let omega = square.sqrt();
    let text = "plant = \"1/s^2\"\npid = { k_p = 1.7, k_d = 0.9 }\n";
    let margin = (k_d * omega / k_p).atan() / omega;
    near(
        &point(text, &["--tau", "0"])["delay_margin"],
        margin,
        "double integrator",
    );
}

/// Gains at which a predictor with the right delay knows no delay any more.
#[test]
fn an_exact_smith_predictor_has_no_delay() {
    for tau in ["0.1", "3", "40"] {
        let exact = ["--set", "late=0", "--tau", tau];
        let found = point("smith_predictor", &exact);
        assert_eq!(found["n_unstable"], 0);
        assert_eq!(found["delay_margin_kind"], "infinite", "{found}");
        // (s + 1) s + 2 s + 2 over its denominators.
        near(&found["roots"][0][0], -1.0, tau);
        near(&found["roots"][1][0], -2.0, tau);
    }
    let by_hand = "D = [\"s*(s + 1) + 2*s + 2\", 0, \"-(2*s + 2)\", \"2*s + 2\"]\n";
    let (by_hand, found) = (
        point(by_hand, &["--tau", "0.3"]),
        point("smith_predictor", &["--tau", "0.3"]),
    );
    for key in ["n_unstable", "stable_delays", "reason"] {
        assert_eq!(by_hand[key], found[key], "{key}");
    }
    near(
        &found["abscissa"],
        by_hand["abscissa"].as_f64().unwrap(),
        "abscissa",
    );
}

#[test]
fn divisors_are_multiplied_out_as_by_hand() {
    for (divided, by_hand) in [
        (
            "P = \"s^2 + 1 + 0.5/(s + 1)\"\nQ = \"0.3*s/(s + 1) + 0.1/(s + 2)\"\n",
            "P = \"(s^2 + 1)*(s + 1)*(s + 2) + 0.5*(s + 2)\"\n\
             Q = \"0.3*s*(s + 2) + 0.1*(s + 1)\"\n",
        ),
        (
            "plant = [{ num = [1, -0.2], den = [1, 0.4, 2] }, \"1/(0.1*s + 1)\"]\n\
             pid = { k_p = 0.5, k_i = 0.2, k_d = 0.1, t_f = 0.05 }\n",
            "P = \"s*(0.05*s + 1)*(s^2 + 0.4*s + 2)*(0.1*s + 1)\"\n\
             Q = \"(s - 0.2)*(0.5*s*(0.05*s + 1) + 0.2*(0.05*s + 1) + 0.1*s^2)\"\n",
        ),
    ] {
        let (divided, by_hand) = (
            point(divided, &["--tau", "0.7"]),
            point(by_hand, &["--tau", "0.7"]),
        );
        for key in ["n_unstable", "n_at_zero_delay", "delay_margin_kind"] {
            assert_eq!(divided[key], by_hand[key], "{key}");
        }
        for place in 0..4 {
            let [found, expected] = [&divided, &by_hand].map(|of| &of["roots"][place]);
            near(&found[0], expected[0].as_f64().unwrap(), "Re");
            near(&found[1], expected[1].as_f64().unwrap(), "Im");
        }
    }
}

/// Maps, their curves and best settings take a loop as any system.
#[test]
fn maps_of_loops_are_computed_and_verified() {
    let sweep = "system = \"pi_loop\"\nfields = [\"n_unstable\", \"abscissa\"]\nboundaries = true\n\
        [axes]\nk_p = { from = 0, to = 3, points = 4 }\ntau = [0.5, 1.0, 2.5]\n[fixed]\nk_i = 0\n";
    let folder = Folder::with(&[("sweep.toml", sweep)]);
    expect(
        &folder.run(&["run", "sweep.toml", "-o", "map.h5", "--quiet"]),
        0,
        "",
    );
    expect(&folder.run(&["verify", "map.h5"]), 0, "12 agree, 0 differ");
    // Without the integral the loop is k_p/(4 s + 1): no root 0 comes from its form.
    let cells = out(&folder.run(&["export", "map.h5"]));
    let stable = cells
        .lines()
        .filter(|line| line.split(',').nth(2) == Some("0"));
    assert!(stable.count() >= 6, "{cells}");
    let best = folder.run(&["best", "--system", "pi_loop", "--search", "k_p", "--json"]);
    assert_eq!(best.status.code(), Some(0), "{}", err(&best));
}

#[test]
fn mistakes_in_loops_are_shown_in_place() {
    let mut shown = String::new();
    for text in [
        "plant = { num = [1], den = [1, 0] }\nP = \"s\"\n",
        "controller = \"1\"\n",
        "plant = \"1/s\"\ncontroller = \"2\"\npid = { k_p = 1 }\n",
        "plant = { num = [1], den = [1, 0], delay = \"tau\" }\ndelay = \"tau\"\n",
        "plant = { num = [1], den = [0] }\n",
        "plant = { num = [1], dem = [1] }\n",
        "plant = \"1/(s + 1)\"\npid = { k_p = 1, k_d = 1, t_f = 0 }\ncontroller = 1\n",
        "plant = \"(s^2 + 1)/(s + 1)\"\n",
        "plant = \"(1 - 2*s)/(2*s + 1)\"\n",
        "plant = \"K/s\"\n",
    ] {
        let folder = Folder::with(&[("system.toml", text)]);
        let output = folder.run(&["point", "--system", "system.toml", "--tau", "1"]);
        assert_eq!(output.status.code(), Some(2), "{text}: {}", err(&output));
        assert_eq!(out(&output), "");
        shown += &err(&output);
    }
    insta::assert_snapshot!(shown);
}
