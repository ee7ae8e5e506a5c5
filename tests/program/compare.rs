//! `slipmap compare`: shares, their page, the same bytes on any number of threads, bad input.

use crate::program::{self, Folder, err, expect, out};

const FIG3B: &str = include_str!("../../sweeps/fig3b.toml");
const ROUTE: &str = include_str!("../../sweeps/return_map_route.toml");
const FEW: &str = "--starts 64 --sample-time 0.5,0.9 --horizon 60";

fn folder() -> Folder {
    let idle = FIG3B
        .replace("alpha_n = -10.0\n", "")
        .replace("tau = 0.5\n", "");
    let velocity = FIG3B.replace("alpha_n = -10.0\n", "alpha_v = -0.33\n");
    Folder::with(&[
        ("velocity.toml", &velocity),
        ("fig3b.toml", FIG3B),
        ("route.toml", ROUTE),
        ("idle.toml", &idle),
    ])
}

fn run(folder: &Folder, line: &str) -> std::process::Output {
    folder.run(&line.split_whitespace().collect::<Vec<_>>())
}

/// Two runs on one and two threads say and write the same, and the page has what they say.
#[test]
fn bytes_do_not_depend_on_threads() {
    let folder = folder();
    let mut all = Vec::new();
    for threads in [1, 2] {
        let line = format!(
            "compare fig3b.toml --over amplitude --amplitude 0.1,0.5 {FEW} --threads {threads}"
        );
        let told = run(&folder, &format!("{line} -o page.html"));
        expect(&told, 0, "");
        let page = std::fs::read_to_string(folder.path().join("page.html")).unwrap();
        let json = out(&run(&folder, &format!("{line} --json")));
        all.push((out(&told), page, json));
    }
    assert_eq!(all[0], all[1]);
    let (told, page, json) = &all[0];
    assert!(
        told.contains("return map, h = 0.9") && told.contains("delayed feedback"),
        "{told}"
    );
    for part in [
        "<svg",
        "return map, h = 0.5",
        "from stick-slip",
        "width=device-width",
        "slipmap compare",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert!(!page.contains("<script") && !page.contains("<?xml"));
    let json: serde_json::Value = serde_json::from_str(json).unwrap();
    assert_eq!(json["over"], "amplitude");
    assert_eq!(json["amplitude"], serde_json::Value::Null);
    assert_eq!(json["methods"].as_array().unwrap().len(), 3);
    let delayed = &json["methods"][0];
    assert_eq!(delayed["sample_time"], serde_json::Value::Null);
    // With half of the load delayed feedback reaches sliding from everywhere.
    for kind in ["near", "stick_slip"] {
        let share = delayed[kind][1]["share"].as_f64().unwrap();
        assert_eq!(delayed[kind][1]["lift_off"], 0);
        assert_eq!(delayed[kind][1]["undecided"], 0);
        assert!(share > 0.95, "{delayed}");
    }
    let other = run(
        &folder,
        &format!("compare fig3b.toml --over amplitude --amplitude 0.1,0.5 {FEW} --seed 1 --json"),
    );
    assert_ne!(program::json(&other)["methods"], json["methods"]);
}

/// A slope that is wrong changes the return map alone, and noise ends what exact readings reach.
#[test]
fn slopes_and_noise_are_varied() {
    let folder = folder();
    let told = run(
        &folder,
        &format!("compare fig3b.toml --over slope --slope=-0.4,0,0.4 {FEW} --json"),
    );
    let told = program::json(&told);
    let delayed = &told["methods"][0]["near"];
    assert_eq!(delayed[0]["share"], delayed[2]["share"]);
    let told = run(
        &folder,
        &format!("compare fig3b.toml --over noise --noise 0,0.05 --amplitude 0.1 {FEW} --json"),
    );
    let told = program::json(&told);
    let of = |value: usize| told["methods"][2]["near"][value]["share"].as_f64().unwrap();
    assert!(of(1) < of(0), "{told}");
}

/// A map from the record by default is nearly as good as the exact one: the record ends before it
/// is no longer linear, and a longer one is allowed.
#[test]
fn a_reconstructed_map_is_nearly_as_good() {
    let folder = folder();
    for record in ["", "--record 200"] {
        let line = format!(
            "compare fig3b.toml --over amplitude --amplitude 0.5 --sample-time 0.9 --starts 64 \
             --horizon 100 --model reconstructed {record} --json"
        );
        let told = program::json(&run(&folder, &line));
        let share = told["methods"][1]["near"][0]["share"].as_f64().unwrap();
        assert!(share > 0.8, "{told}");
    }
}

/// Without control sliding is lost where it becomes unstable, under control lower.
#[test]
fn a_route_says_where_sliding_is_lost() {
    let folder = folder();
    let route = "compare route.toml --over route --amplitude 0.5 --sample-time 0.9 --json";
    let told = program::json(&run(&folder, route));
    let lost = |method: usize| told["methods"][method]["lost_at"].as_f64();
    // The last v0 above 0.618 is stable; disturbances need time to grow.
    assert!((0.3..0.619).contains(&lost(0).unwrap()), "{told}");
    for method in [1, 2] {
        assert!(lost(method).is_none_or(|v0| v0 < 0.1), "{told}");
    }
}

/// The route tells the error of the slope and the noise that it was asked with.
#[test]
fn a_route_tells_what_does_not_vary() {
    let folder = folder();
    let route = "compare route.toml --over route --amplitude 0.5 --sample-time 0.9 --slope 0.2 \
        --noise 0.001";
    let told = out(&run(&folder, &format!("{route} -o route.html")));
    let line = "model exact, slope = 0.2, noise = 0.001";
    assert!(told.contains(line), "{told}");
    let page = std::fs::read_to_string(folder.path().join("route.html")).unwrap();
    assert!(page.contains(line));
    let json = program::json(&run(&folder, &format!("{route} --json")));
    assert_eq!(
        (&json["slope"], &json["noise"]),
        (&0.2.into(), &0.001.into())
    );
}

#[test]
fn mistakes_are_answered() {
    let folder = folder();
    let mut told = String::new();
    for line in [
        "compare idle.toml --over amplitude",
        "compare velocity.toml --over amplitude",
        "compare fig3b.toml --over route",
        "compare fig3b.toml --over amplitude --amplitude 0.5,1.5",
        "compare fig3b.toml --over slope --amplitude 0.1,0.5",
        "compare fig3b.toml --over slope --slope=-1.5",
        "compare fig3b.toml --over noise --noise=-1",
        "compare fig3b.toml --over amplitude --sample-time 3.3",
        "compare fig3b.toml --over amplitude --starts 65",
        "compare fig3b.toml --over amplitude --model reconstructed --record 6",
        "compare fig3b.toml --over amplitude -o page.txt",
        "compare fig3b.toml --over amplitude -o nodir/page.html",
        "compare fig3b.toml",
    ] {
        let output = run(&folder, line);
        expect(&output, 2, "");
        told += &format!("{line}\n{}\n", err(&output));
    }
    insta::assert_snapshot!("mistakes_of_compare", told);
}
