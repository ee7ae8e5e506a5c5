//! Responses in time of systems from files, through the real program.

use crate::program::{self, Folder, err, expect, out};
use serde_json::Value;
use std::f64::consts::PI;

fn json(args: &[&str]) -> Value {
    let output = Folder::new().run(&[&["simulate", "--json"], args].concat());
    assert_eq!(output.status.code(), Some(0), "{args:?}: {}", err(&output));
    program::json(&output)
}

/// The rightmost pair alone is left at late times: in one period y changes by e^(abscissa period).
#[test]
fn responses_decay_as_their_rightmost_roots() {
    let folder = Folder::new();
    for of in [
        "--system turning --set zeta=0.05 --set width=0.1 --tau 8",
        "--system smith_predictor --tau 0.3",
        "--system ring_road --tau 0.9",
    ] {
        let system = of;
        let of: Vec<&str> = of.split(' ').collect();
        let point = folder.run(&[&["point", "--json"], &of[..]].concat());
        let point = program::json(&point);
        let [abscissa, frequency] =
            ["abscissa", "frequency"].map(|key| point[key].as_f64().unwrap());
        let period = match frequency {
            0.0 => 1.0 / abscissa.abs(),
            omega => 2.0 * PI / omega,
        };
        let until = (120.0 / abscissa.abs() / period).ceil() * period;
        let until = format!("{until:?}");
        let args = [&["simulate", "--output", "-", "--until", &until], &of[..]].concat();
        let rows = out(&folder.run(&args));
        let last = |rows: &str| -> f64 {
            rows.lines()
                .last()
                .unwrap()
                .split(',')
                .nth(1)
                .unwrap()
                .parse()
                .unwrap()
        };
        let end = last(&rows);
        let before = format!("{:?}", until.parse::<f64>().unwrap() - period);
        let args = [&["simulate", "--output", "-", "--until", &before], &of[..]].concat();
        let rate = (end / last(&out(&folder.run(&args)))).ln() / period;
        assert!(
            (rate - abscissa).abs() < 1e-5 * abscissa.abs(),
            "{system}: {rate} {abscissa}"
        );
    }
}

#[test]
fn a_loop_follows_its_reference_and_forgets_its_disturbance() {
    let of = ["--system", "pi_loop", "--tau", "1", "--step"];
    let step = json(&[&of[..], &["reference"]].concat());
    assert_eq!(
        (&step["step"], &step["final_value"]),
        (&"reference".into(), &1.0.into())
    );
    // s + 0.5 e^(−s): the pole of the plant is cancelled. The method of steps gives the peak.
    let y = |t: f64| -> f64 {
        let terms = (0..20).filter(|j| t > f64::from(*j)).map(|j| {
            let since = t - f64::from(j);
            let each = (1..=j).map(|i| -0.5 * since / f64::from(i));
            each.product::<f64>()
        });
        1.0 - terms.sum::<f64>()
    };
    let [peak, at, overshoot, settled] =
        ["peak", "peak_time", "overshoot", "settling_time"].map(|key| step[key].as_f64().unwrap());
    assert!((peak - y(at)).abs() < 1e-12 && (overshoot - 100.0 * (peak - 1.0)).abs() < 1e-10);
    assert!([-0.1, 0.1].iter().all(|by| y(at + by) < peak), "{step}");
    assert!(((y(settled) - 1.0).abs() - 0.02).abs() < 1e-10, "{step}");
    let disturbed = json(&[&of[..], &["disturbance"]].concat());
    assert_eq!(disturbed["final_value"], 0.0);
    assert_eq!(disturbed["overshoot"], Value::Null);
    let start = json(&["--system", "pi_loop", "--tau", "4"]);
    assert_eq!(
        (&start["stable"], &start["final_value"]),
        (&false.into(), &Value::Null)
    );
    assert_eq!(
        (&start["settling_time"], &start["trace"]),
        (&Value::Null, &Value::Null)
    );
}

#[test]
fn responses_are_written_and_drawn() {
    let folder = Folder::new();
    let of = [
        "simulate",
        "--system",
        "pi_loop",
        "--tau",
        "1",
        "--step",
        "reference",
    ];
    let files = ["-o", "step.csv", "--picture", "step.svg"];
    let told = folder.run(&[&of[..], &files].concat());
    expect(&told, 0, "settles at 1: within 2 %");
    let rows = std::fs::read_to_string(folder.path().join("step.csv")).unwrap();
    assert_eq!(rows.lines().next(), Some("t,y"));
    assert_eq!(rows.lines().count(), 2002);
    assert_eq!(out(&folder.run(&[&of[..], &["-o", "-"]].concat())), rows);
    let picture = std::fs::read_to_string(folder.path().join("step.svg")).unwrap();
    assert!(
        picture.contains("response") || picture.contains("<path"),
        "{picture}"
    );
}

#[test]
fn responses_that_there_are_not_are_told() {
    let folder = Folder::with(&[("step.csv", "t,y\n")]);
    let of = "simulate --system pi_loop --tau 1 --step reference";
    let of: Vec<&str> = of.split(' ').collect();
    for (args, says) in [
        (&["-o", "step.h5"][..], "is written as CSV"),
        (&["-o", "step.csv"], "already there"),
        (&["--until", "0"], "--until 0 is outside its range"),
        (&["--until", "1e12"], "at most 10000000 are taken"),
        (&["--v0", "3"], "--system"),
        (&["--seed", "3"], "--system"),
        (&["--set", "gain=1 N"], "unit"),
    ] {
        let output = folder.run(&[&of[..], args].concat());
        assert_eq!(output.status.code(), Some(2), "{args:?}: {}", err(&output));
        assert!(
            err(&output).replace("\n  │ ", " ").contains(says),
            "{args:?}: {}",
            err(&output)
        );
    }
    for (system, says) in [
        ("turning", "this system has no reference"),
        ("ring_road", "this system has no reference"),
        ("unknown", "neither a file nor the name"),
    ] {
        let args = [
            "simulate",
            "--system",
            system,
            "--tau",
            "1",
            "--step",
            "reference",
        ];
        let output = folder.run(&args);
        assert_eq!(output.status.code(), Some(2), "{system}");
        assert!(err(&output).contains(says), "{}", err(&output));
    }
    let late = [
        "simulate",
        "--system",
        "letter",
        "--tau",
        "4",
        "--latency",
        "0.1",
    ];
    let late = folder.run(&[&late[..], &["--set", "alpha_v=-0.3"]].concat());
    assert!(err(&late).contains("with a latency"), "{}", err(&late));
}
