//! What the server tells of the meaning of cells, of the first view of a map, and in the list.

use serde_json::{Value, json};

use super::brute::complete;
use super::{entry, id, make};
use crate::program::Folder;
use crate::server::Serving;

/// Sliding is marginal without control.
const MARGINAL: &str = "title = \"A slope of 0\"\npicture = \"delay_margin\"\n\
    fields = [\"n_unstable\", \"delay_margin\", \"abscissa\"]\n[axes]\nalpha_v = { from = -1.6, \
    to = 0.4, points = 21 }\ntau = { from = 0.0, to = 12.0, points = 13 }\n[fixed]\n\
    mu_prime = 0.0\n";

fn texts(entries: &Value) -> Vec<&str> {
    let entries = entries.as_array().unwrap().iter();
    entries
        .map(|entry| entry["text"].as_str().unwrap())
        .collect()
}

/// The number of a gap in `gaps`.
fn gap(shown: &Value, name: &str) -> Option<f64> {
    let mut fills = shown["fills"].as_array().unwrap().iter();
    fills.find(|fill| fill["name"] == name)?["gap"].as_f64()
}

#[test]
fn a_marginal_cell_is_told_as_such_and_not_as_stable() {
    let folder = Folder::new();
    make(&folder, "marginal", MARGINAL);
    let serving = Serving::new(&folder);
    let id = id(&serving, "marginal.h5");
    let window = |field: &str| {
        let query = format!("window?field={field}&x=alpha_v&y=tau&w=21&h=13");
        complete(&serving, &format!("/api/v1/maps/{id}/{query}"))
    };
    for field in ["n_unstable", "delay_margin", "abscissa"] {
        let told = window(field);
        let shown = &told.head["shown"];
        let numbers = |name: &str| told.numbers(&told.head[name]);
        let (gaps, status) = (numbers("gaps"), numbers("status"));
        let marginal = gap(shown, "marginal").expect("some are marginal");
        assert!(status.iter().any(|status| *status as u8 & 2 != 0));
        for (gap, status) in gaps.iter().zip(&status) {
            assert_eq!(*gap == marginal, *status as u8 & 2 != 0, "{field}");
        }
        assert!(texts(&shown["entries"]).contains(&"marginal"), "{field}");
    }
    let counts = window("n_unstable");
    assert_eq!(counts.head["shown"]["scale"], Value::Null);
    assert_eq!(counts.head["shown"]["heading"], json!(["unstable roots"]));
    assert_eq!(
        texts(&counts.head["shown"]["entries"]),
        ["0, stable", "2", "marginal"]
    );
    let scale = &window("abscissa").head["shown"]["scale"];
    let count = |name: &str| scale[name].as_array().unwrap().len();
    assert_eq!(count("colours"), count("ends") + 1);
}

/// Another field of the map says why a cell has no value.
#[test]
fn a_motion_without_a_value_says_that_it_lifts_off() {
    let folder = Folder::new();
    let sweep = "fields = [\"outcome\", \"settle_time\"]\n[axes]\nalpha_n = { from = -3.0, to = \
        3.0, points = 7 }\ntau = { from = 0.5, to = 4.5, points = 5 }\n[fixed]\nv0 = 0.35\n\
        [friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";
    make(&folder, "motions", sweep);
    let serving = Serving::new(&folder);
    let id = id(&serving, "motions.h5");
    let window = |field: &str| {
        let query = format!("window?field={field}&x=alpha_n&y=tau&w=7&h=5");
        complete(&serving, &format!("/api/v1/maps/{id}/{query}"))
    };
    let outcome = window("outcome");
    let outcome = outcome.numbers(&outcome.head["values"]);
    let told = window("settle_time");
    let gaps = told.numbers(&told.head["gaps"]);
    let lifts_off = gap(&told.head["shown"], "lifts-off").expect("some lift off");
    let mut count = 0;
    for (outcome, gap) in outcome.iter().zip(&gaps) {
        assert_eq!(*outcome == 3.0, *gap == lifts_off, "{outcome} {gap}");
        count += usize::from(*gap == lifts_off);
    }
    assert!(count > 2, "{count}");
    let words = texts(&told.head["shown"]["entries"]);
    assert!(words.contains(&"no value: lifts off"), "{words:?}");
}

#[test]
fn the_first_view_is_that_of_the_picture_and_the_list_tells_titles_and_sizes() {
    let folder = Folder::new();
    make(&folder, "marginal", MARGINAL);
    make(
        &folder,
        "without",
        &MARGINAL.replace("picture = \"delay_margin\"\n", ""),
    );
    let serving = Serving::new(&folder);
    for (name, field) in [("marginal.h5", "delay_margin"), ("without.h5", "abscissa")] {
        let id = id(&serving, name);
        let told = serving.get(&format!("/api/v1/maps/{id}")).json();
        let first = json!({ "field": field, "x": "alpha_v", "y": "tau" });
        assert_eq!(told["first"], first, "{name}");
        let listed = entry(&serving, name);
        assert_eq!(listed["title"], "A slope of 0");
        let size = std::fs::metadata(folder.path().join(name)).unwrap().len();
        assert_eq!(listed["bytes"], size);
        assert_eq!(listed["seconds_left"], Value::Null, "it is complete");
        let scalars = told["scalars"].as_array().unwrap().iter();
        let told: Vec<_> = scalars.filter(|of| of["told"] == true).collect();
        assert!(told.iter().any(|of| of["name"] == "mu_prime"));
        assert!(told.iter().all(|of| of["name"] != "mass"));
    }
    let known = serving.get("/api/v1/parameters").json();
    let mut fields = known["fields"].as_array().unwrap().iter();
    let counts = fields.find(|field| field["name"] == "n_unstable").unwrap();
    assert_eq!(counts["classes"][0]["text"], "0, stable");
    assert_eq!(counts["largest"], 65_534);
    assert_eq!(known["flags"][1]["text"], "marginal");
}
