//! The guide: its links, what it names, its reference, and the commands in it.

mod pages;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::program::{Folder, expect, out};
use pages::{Block, Page, pages};

/// Pages of the guide that the program prints itself.
const PRINTED: [&str; 7] = [
    "parameters",
    "laws",
    "fields",
    "sweep-files",
    "system-files",
    "map-file",
    "command-line",
];

#[test]
fn the_reference_is_what_the_program_prints() {
    let folder = Folder::new();
    for name in PRINTED {
        let printed = out(&folder.run(&["reference", name]));
        let path = format!("doc/guide/reference/{name}.md");
        if std::env::var_os("SLIPMAP_WRITE").is_some() {
            std::fs::write(&path, &printed).unwrap();
        }
        let page = std::fs::read_to_string(&path).unwrap_or_default();
        assert_eq!(
            page, printed,
            "{path} is not what the program prints: SLIPMAP_WRITE=1 cargo test --test guide"
        );
    }
}

/// Root attributes of a map are those of the reference.
#[test]
fn maps_hold_what_the_reference_says() {
    let folder = Folder::new();
    let sweep = "title = \"small\"\nfields = [\"n_unstable\", \"abscissa\"]\nboundaries = true\n\
                 degree_of_stability = [0.1]\nbest = true\n[axes]\nmu_prime = [-0.2, -0.1]\n\
                 alpha_v = [-1, -0.5, 0.5]\ntau = [1, 2, 3]\n";
    std::fs::write(folder.path().join("small.toml"), sweep).unwrap();
    expect(&folder.run(&["run", "small.toml"]), 0, "18 cells");
    let page = std::fs::read_to_string("doc/guide/reference/map-file.md").unwrap();
    let told = |name: &str| page.contains(&format!("`{name}`"));
    let file = hdf5::File::open(folder.path().join("small.h5")).unwrap();
    let mut seen = 0;
    for name in file.attr_names().unwrap() {
        assert!(told(&name), "the attribute {name}");
        seen += 1;
    }
    for name in file.dataset("abscissa").unwrap().attr_names().unwrap() {
        let of_netcdf = name.starts_with("DIMENSION_LIST") || name.starts_with("_Netcdf4");
        assert!(of_netcdf || told(&name), "the attribute {name} of cells");
    }
    let curves = file.group("boundaries").unwrap();
    for name in curves.member_names().unwrap() {
        let general = name
            .replace("alpha_v", "PARAMETER")
            .replace("tau", "SECOND");
        let outer = name.ends_with("mu_prime");
        let dimension = ["curve", "vertex", "corner"].contains(&&*name);
        assert!(outer || dimension || told(&general), "boundaries/{name}");
        seen += 1;
    }
    for name in file.group("best").unwrap().member_names().unwrap() {
        let gain = ["alpha_v", "mu_prime"].contains(&&*name);
        assert!(gain || told(&name), "best/{name}");
    }
    assert!(seen > 25, "{seen}");
}

#[test]
fn every_page_is_in_the_summary_and_every_link_leads_somewhere() {
    let all = pages();
    let summary = &all[Path::new("doc/SUMMARY.md")];
    let listed: BTreeSet<_> = summary.links().map(|(to, _)| to).collect();
    for path in all.keys() {
        let decision = path.starts_with("doc/decisions");
        let beside = path.ends_with("SUMMARY.md") || path.starts_with("README.md");
        assert!(
            decision || beside || listed.contains(path),
            "{} is not in doc/SUMMARY.md",
            path.display()
        );
    }
    let mut links = 0;
    for page in all.values() {
        for (to, anchor) in page.links() {
            let from = page.path.display();
            assert!(to.exists(), "{from} links to {}", to.display());
            if let Some(anchor) = anchor {
                let there = all[&to].anchors.contains(&anchor);
                assert!(there, "{from} links to {}#{anchor}", to.display());
            }
            links += 1;
        }
    }
    assert!(links > 60, "{links}");
}

/// Decisions are short to read, and each has its three parts.
#[test]
fn decisions_have_their_parts() {
    for (path, page) in pages() {
        if !path.starts_with("doc/decisions") || path.ends_with("README.md") {
            continue;
        }
        for part in ["## Context", "## Decision", "## Rejected"] {
            assert!(page.text.contains(part), "{}: {part}", path.display());
        }
        for paragraph in page.text.split("\n\n") {
            let words = paragraph.split_whitespace().count();
            assert!(
                words <= 120 || paragraph.starts_with('|'),
                "{}: {words} words: {paragraph}",
                path.display()
            );
        }
    }
}

/// Whether a file has a function, a type or a test of this name.
fn defines(text: &str, name: &str) -> bool {
    let last = name.rsplit("::").next().unwrap();
    let kinds = ["fn", "struct", "enum", "trait", "mod"];
    let defined = |name: &str| {
        kinds.iter().any(|kind| {
            let after = |end: &str| text.contains(&format!("{kind} {name}{end}"));
            ["(", "<", " ", ";", "\n"].into_iter().any(after)
        })
    };
    let owner = name.rsplit_once("::").map(|(owner, _)| owner);
    defined(last) && owner.is_none_or(|owner| text.contains(owner))
}

/// Files, functions, tests and claims that the equation index names are there.
#[test]
fn the_equation_index_names_what_is_there() {
    let text = std::fs::read_to_string("doc/guide/equations.md").unwrap();
    let claims = std::fs::read_to_string("tests/program/reproduce.rs").unwrap();
    let mut seen = [0; 2];
    for row in text.lines().filter(|line| line.starts_with("| ")) {
        let mut file: Option<(&str, String)> = None;
        for (name, before) in row
            .split('`')
            .skip(1)
            .step_by(2)
            .zip(row.split('`').step_by(2))
        {
            if Path::new(name).extension().is_some() {
                let text = std::fs::read_to_string(name);
                file = Some((name, text.unwrap_or_else(|_| panic!("{name}: {row}"))));
            } else if before.ends_with("claim ") {
                assert!(claims.contains(&format!("\"{name}\"")), "claim {name}");
                seen[0] += 1;
            } else {
                let (path, text) = file.as_ref().unwrap_or_else(|| panic!("{name}: {row}"));
                assert!(defines(text, name), "{path} has no {name}");
                seen[1] += 1;
            }
        }
    }
    assert!(seen[0] >= 28 && seen[1] > 50, "{seen:?}");
    for equation in [
        "1a", "1b", "1c", "2a", "2b", "3", "4", "5a", "5b", "6", "7", "8", "9", "10",
    ] {
        assert!(text.contains(&format!("({equation})")), "Eq. ({equation})");
    }
    let every = claims
        .split("const EXPECTED")
        .nth(1)
        .unwrap()
        .split("];")
        .next()
        .unwrap();
    for claim in every
        .split("(\"")
        .skip(1)
        .map(|rest| rest.split('"').next().unwrap())
    {
        assert!(text.contains(&format!("claim `{claim}`")), "{claim}");
    }
}

/// Lines of shell that are shown without output: each stands in the list of what is not run here,
/// and asks for commands, flags and files that there are.
#[test]
fn what_is_not_run_is_listed_and_exists() {
    let listed = std::fs::read_to_string("doc/guide/not-run.txt").unwrap();
    let listed: BTreeSet<&str> = listed
        .lines()
        .filter(|line| !line.starts_with('#'))
        .collect();
    let mut shown = BTreeSet::new();
    let folder = Folder::new();
    for page in pages()
        .values()
        .filter(|page| page.path.starts_with("doc/guide"))
    {
        for block in &page.blocks {
            if block.language == "sh" {
                shown.extend(block.commands());
            }
        }
    }
    let shown: BTreeSet<&str> = shown.iter().map(String::as_str).collect();
    assert_eq!(shown, listed, "doc/guide/not-run.txt");
    for line in shown {
        let words: Vec<_> = line.split_whitespace().collect();
        for word in &words {
            let ours = word.starts_with("scripts/") || word.starts_with("sweeps/");
            assert!(!ours || Path::new(word).exists(), "{word}: {line}");
        }
        let Some(at) = words.iter().position(|word| *word == "slipmap") else {
            continue;
        };
        let Some(command) = words.get(at + 1).filter(|word| !word.starts_with('-')) else {
            continue;
        };
        // With the help of a command below it, such as `jobs hold`.
        let below = words
            .get(at + 2)
            .filter(|word| *command == "jobs" && !word.contains('/'));
        let mut help = out(&folder.run(&[command, "--help"]));
        help += &below.map_or_else(String::new, |below| {
            out(&folder.run(&[command, below, "--help"]))
        });
        assert!(help.contains("Usage"), "{line}");
        // What stands behind -- is for another program.
        let ours = words.iter().take_while(|word| **word != "--");
        for flag in ours.filter(|word| word.starts_with("--")) {
            let flag = flag.split('=').next().unwrap();
            assert!(help.contains(flag), "{flag}: {line}");
        }
    }
}

/// A page in which what differs from run to run stands for anything. Outputs end with an empty
/// line, as trycmd has them.
fn masked(page: &Page) -> String {
    let mut text = String::new();
    let mut commands: Option<&str> = None;
    for line in page.text.lines() {
        let command = line.starts_with("$ ");
        match &mut commands {
            Some(ends) if command || line == "```" => {
                text.push_str(ends);
                *ends = "\n";
                text.push_str(line);
            }
            Some(ends) => {
                // What is told of a failure ends with an empty line of its own.
                if line.starts_with("? ") {
                    *ends = "\n\n";
                }
                text.push_str(&mask(line));
            }
            None => text.push_str(line),
        }
        text.push('\n');
        match line {
            "```console" => commands = Some(""),
            "```" => commands = None,
            _ => {}
        }
    }
    text
}

/// Times and sizes of an output.
fn mask(line: &str) -> String {
    let starts = ["time  ", "memory  ", "revision  ", "history  "];
    if starts.iter().any(|start| line.starts_with(start)) {
        return "[..]".to_owned();
    }
    let units = [
        "ms", "µs", "s", "min", "h", "B", "kB", "MB", "cells/s", "M", "k", "threads",
    ];
    let words: Vec<&str> = line.split(' ').collect();
    let is_number = |word: &str| {
        let digits = word.trim_matches(|c: char| !c.is_ascii_digit() && c != '.');
        !digits.is_empty()
            && digits
                .chars()
                .all(|c| c.is_ascii_digit() || ".,".contains(c))
    };
    let mut masked = Vec::new();
    let mut at = 0;
    while at < words.len() {
        let unit = words
            .get(at + 1)
            .map(|word| word.trim_matches([',', '.', ')', ';', ':']));
        if is_number(words[at]) && unit.is_some_and(|unit| units.contains(&unit)) {
            masked.push("[..]");
            at += 2;
        } else {
            masked.push(words[at]);
            at += 1;
        }
    }
    masked.join(" ")
}

fn copy(from: &Path, to: &Path) {
    std::fs::create_dir(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let from = entry.unwrap().path();
        let to = to.join(from.file_name().unwrap());
        if from.is_dir() {
            copy(&from, &to);
        } else {
            std::fs::copy(&from, &to).unwrap();
        }
    }
}

/// Every command that is shown with its output prints that output.
#[test]
fn commands_print_what_the_guide_shows() {
    let folder = tempfile::tempdir().unwrap();
    let cases = trycmd::TestCases::new();
    let mut pages_run = 0;
    for page in pages().values() {
        let shown = page.blocks.iter().any(|block| block.language == "console");
        if !shown || !page.path.starts_with("doc/guide") {
            continue;
        }
        let name: PathBuf = page
            .path
            .iter()
            .map(|part| part.to_str().unwrap())
            .collect::<Vec<_>>()
            .join("-")
            .into();
        let input = folder.path().join(name.with_extension("in"));
        std::fs::create_dir(&input).unwrap();
        copy(Path::new("sweeps"), &input.join("sweeps"));
        for Block { name, text, .. } in page.blocks.iter().filter(|block| !block.name.is_empty()) {
            std::fs::write(input.join(name), text).unwrap();
        }
        std::fs::write(folder.path().join(&name), masked(page)).unwrap();
        // An empty folder of expected files has the commands run in a copy.
        std::fs::create_dir(folder.path().join(name.with_extension("out"))).unwrap();
        pages_run += 1;
    }
    assert!(pages_run > 4, "{pages_run}");
    cases
        .env("NO_COLOR", "1")
        .env("COLUMNS", "100")
        .register_bin("slipmap", Path::new(env!("CARGO_BIN_EXE_slipmap")))
        .timeout(std::time::Duration::from_secs(300))
        .case(folder.path().join("*.md"));
}
