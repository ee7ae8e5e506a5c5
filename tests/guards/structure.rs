//! Holds the structure that DESIGN.md describes.

mod uses;

use std::path::{Path, PathBuf};

const LAYERS: [&str; 18] = [
    "text", "model", "linear", "slip", "critical", "setting", "fit", "answers", "sweep", "meaning",
    "explore", "store", "maps", "report", "letter", "queue", "serve", "cli",
];
/// The rooms of a sweep, each above those before it; beside them stands what a sweep tells.
const ROOMS: [&str; 10] = [
    "events",
    "plan",
    "cells",
    "described",
    "sink",
    "engine",
    "grid",
    "filled",
    "evaluate",
    "estimate",
];

fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(sources(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            files.push(path);
        }
    }
    files
}

/// Code of a file without its comments.
fn code(path: &Path) -> String {
    let text = std::fs::read_to_string(path).unwrap();
    text.lines()
        .filter(|l| !l.trim_start().starts_with("//"))
        .collect::<Vec<_>>()
        .join("\n")
}

#[test]
fn layers_use_only_those_below() {
    let mut imports = 0;
    for (height, layer) in LAYERS.iter().enumerate() {
        for path in sources(&Path::new("src").join(layer)) {
            let code = code(&path);
            for above in &LAYERS[height + 1..] {
                for form in [format!("crate::{above}"), format!("slipmap::{above}")] {
                    assert!(!code.contains(&form), "{} uses {form}", path.display());
                }
            }
            imports += code.matches("use crate::").count();
        }
    }
    assert!(imports > 20, "the test still sees the imports: {imports}");
}

#[test]
fn rooms_of_a_sweep_use_only_those_below() {
    let room_of = |path: &Path| {
        let inside = path.strip_prefix("src/sweep").ok()?.with_extension("");
        let first = inside.iter().next()?.to_str()?.to_owned();
        ROOMS.iter().position(|room| *room == first)
    };
    let mut uses = 0;
    for (path, used) in uses::graph(&sources(Path::new("src"))) {
        let Some(room) = room_of(&path) else {
            continue;
        };
        for other in used {
            let below = room_of(&other).is_none_or(|other| other <= room);
            assert!(below, "{} uses {}", path.display(), other.display());
            // The facade names what is in all rooms.
            assert!(!other.ends_with("sweep/mod.rs"), "{}", path.display());
            uses += 1;
        }
    }
    assert!(uses > 100, "the test still sees them: {uses}");
}

/// Two files may know one another, such as a type and its parts; more, or such of two rooms, are
/// one job in pieces.
#[test]
fn no_circles_but_pairs_in_one_room() {
    let graph = uses::graph(&sources(Path::new("src")));
    assert!(
        graph
            .values()
            .map(std::collections::BTreeSet::len)
            .sum::<usize>()
            > 400
    );
    for circle in uses::circles(&graph) {
        let rooms: std::collections::BTreeSet<_> = circle.iter().map(|p| p.parent()).collect();
        assert!(circle.len() <= 2 && rooms.len() == 1, "{circle:?}");
    }
}

/// Files of one job are short; a longer one says why it is.
#[test]
fn files_are_short_or_say_why() {
    for path in sources(Path::new("src")) {
        let text = std::fs::read_to_string(&path).unwrap();
        let text = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
        let lines = text.lines().count();
        let says = text
            .lines()
            .any(|l| l.starts_with("//! Longer than most files: "));
        let tests = path.ends_with("tests.rs");
        assert!(
            lines <= 400 || says || tests,
            "{}: {lines} lines",
            path.display()
        );
        assert!(lines > 400 || !says, "{} is short by now", path.display());
    }
}

/// Memory and latency are held by `Channel`, and linear models are told apart where they are made and
/// where a worker picks the kernel of a line.
#[test]
fn the_feedback_and_the_kinds_of_models_have_one_place() {
    let with = |texts: &[&str]| -> Vec<String> {
        let holds = |path: &PathBuf| {
            let code = code(path);
            texts.iter().all(|text| code.contains(text))
        };
        let mut files: Vec<PathBuf> = sources(Path::new("src"));
        files.retain(holds);
        files.sort();
        let name = |path: &PathBuf| path.to_str().unwrap().to_owned();
        files.iter().map(name).collect()
    };
    let both = ["pub memory: f64,", "pub latency: f64,"];
    assert_eq!(with(&both), ["src/model/feedback.rs"]);
    assert_eq!(
        with(&["Linear::Letter("]),
        [
            "src/setting/linear_model.rs",
            "src/sweep/cells/lines.rs",
            "src/sweep/cells/worker.rs",
        ]
    );
}

/// Lines that fit beside one another on a screen.
#[test]
fn lines_are_within_100_columns() {
    for path in sources(Path::new("src")) {
        let text = std::fs::read_to_string(&path).unwrap();
        for (number, line) in text.lines().enumerate() {
            let columns = line.chars().count();
            assert!(
                columns <= 100,
                "{}:{}: {columns}",
                path.display(),
                number + 1
            );
        }
    }
}

#[test]
fn the_ground_layers_are_pure() {
    for layer in ["text", "model", "linear", "slip", "critical"] {
        for path in sources(&Path::new("src").join(layer)) {
            for word in [
                "std::fs",
                "std::io",
                "std::time",
                "std::thread",
                "println!",
                "std::env",
            ] {
                assert!(
                    !code(&path).contains(word),
                    "{} uses {word}",
                    path.display()
                );
            }
        }
    }
}

#[test]
fn libraries_stay_in_their_rooms() {
    for (library, room) in [
        ("rayon", "src/sweep/engine.rs"),
        ("sobol_burley", "src/answers/sobol.rs"),
        ("levenberg_marquardt", "src/fit/least_squares.rs"),
        ("nalgebra", "src/fit"),
        ("statrs", "src/fit/choice.rs"),
        ("hdf5", "src/store"),
        ("wide", "src/linear/crossing"),
        ("faer", "src/linear/collocation.rs"),
        ("libm", "src/model/elementary.rs"),
        ("indicatif", "src/report/progress.rs"),
        ("plotters", "src/report/picture"),
        ("csv", "src/report/table, src/setting/measured/sheet.rs"),
        ("encoding_rs", "src/setting/measured/decoded.rs"),
        ("maud", "src/letter/page.rs"),
        ("axum", "src/serve"),
        ("clap", "src/cli"),
        ("miette", "src/cli"),
        ("winnow", "src/setting/expression/reader.rs"),
    ] {
        let mut seen = false;
        for path in sources(Path::new("src")) {
            let code = code(&path);
            let inside = room.split(", ").any(|room| path.starts_with(room));
            let used = [
                format!("use {library}::"),
                format!(" {library}::"),
                format!("({library}::"),
            ]
            .iter()
            .any(|form| code.contains(form));
            assert!(!used || inside, "{} uses {library}", path.display());
            seen |= used;
        }
        assert!(seen, "{library} is used in {room}");
    }
}

/// Files that were named from outside are opened by `src/store/regular.rs` alone, which refuses
/// what is no regular file.
#[test]
fn files_are_opened_in_one_place() {
    // The HDF5 library opens by name, and folders and files of slipmap's own are synced.
    let own = [
        "src/store/regular.rs",
        "src/store/open.rs",
        "src/store/durable.rs",
        "src/store/seal.rs",
        "src/revision.rs",
        "src/cli/address_space.rs",
    ];
    let mut seen = 0;
    for path in sources(Path::new("src")) {
        let code = code(&path);
        let code = code.split("#[cfg(test)]").next().unwrap();
        let code = code
            .replace("MapFile::open(", "")
            .replace("TraceFile::open(", "");
        let opens = [
            "File::open(",
            "File::options(",
            "OpenOptions",
            "fs::read(",
            "fs::read_to_string(",
            "fs::copy(",
        ];
        let used = opens.iter().find(|word| code.contains(**word));
        let allowed = path.ends_with("tests.rs") || own.iter().any(|own| path == Path::new(own));
        assert!(
            used.is_none() || allowed || path.ends_with("test_reader.rs"),
            "{} uses {used:?}",
            path.display()
        );
        seen += usize::from(used.is_some());
    }
    assert!(seen > 4, "the test still sees them: {seen}");
}

#[test]
fn every_file_that_the_design_names_exists() {
    let text = std::fs::read_to_string("DESIGN.md").unwrap();
    assert!(text.len() <= 12_000, "{} bytes", text.len());
    let mut names = 0;
    for name in text.split('`').skip(1).step_by(2) {
        if name.starts_with("src/") || name.starts_with("tests/") || name.starts_with("scripts/") {
            assert!(Path::new(name).exists(), "{name}");
            names += 1;
        }
    }
    assert!(names > 30, "{names} names");
}

/// The head of a room's file lists all files and rooms in it, and lists none that is not there.
#[test]
fn rooms_list_their_files() {
    let all = sources(Path::new("src"));
    let rooms: std::collections::BTreeSet<_> = all.iter().filter_map(|p| p.parent()).collect();
    let mut listed = 0;
    for room in rooms.into_iter().filter(|room| *room != Path::new("src")) {
        let inside = room.join("mod.rs");
        let head = if inside.exists() {
            inside
        } else {
            room.with_extension("rs")
        };
        let text = std::fs::read_to_string(&head).unwrap();
        let docs = text.lines().take_while(|line| line.starts_with("//!"));
        let docs: Vec<&str> = docs.collect();
        let whole = docs.join("\n");
        for path in all.iter().filter(|path| path.parent() == Some(room)) {
            let name = path.file_stem().unwrap().to_str().unwrap();
            let known = name == "mod" || name == "tests" || whole.contains(&format!("`{name}`"));
            assert!(known, "{} does not list {name}", head.display());
            listed += 1;
        }
        let items = docs.iter().filter_map(|line| line.strip_prefix("//! - "));
        for item in items.filter_map(|item| item.split(':').next()) {
            let names = item.split('`').skip(1).step_by(2);
            for name in names.filter(|name| name.chars().all(|c| c.is_lowercase() || c == '_')) {
                let there = room.join(name).is_dir() || room.join(format!("{name}.rs")).exists();
                assert!(there, "{} lists {name}", head.display());
            }
        }
    }
    assert!(listed > 250, "{listed}");
}
