//! Which files of `src` name which others, in their `use` lines and by paths in the code.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// A module: the names from the crate's root to it.
type Module = Vec<String>;

/// The files that each file uses, apart from its tests.
pub(crate) fn graph(sources: &[PathBuf]) -> BTreeMap<PathBuf, BTreeSet<PathBuf>> {
    let files: BTreeMap<Module, &PathBuf> = sources.iter().map(|p| (module(p), p)).collect();
    let used = |path: &PathBuf| {
        let own = module(path);
        let code = std::fs::read_to_string(path).unwrap();
        let code = without_tests(&code);
        let trees = use_trees(&code);
        let mut paths: Vec<String> = trees.iter().flat_map(|tree| expanded(tree)).collect();
        paths.extend(paths_in(&code));
        let found = paths.iter().filter_map(|used| file_of(used, &own, &files));
        found.filter(|found| found != path).collect()
    };
    sources.iter().map(|p| (p.clone(), used(p))).collect()
}

/// Circles: files that use one another, directly or by way of others.
pub(crate) fn circles(graph: &BTreeMap<PathBuf, BTreeSet<PathBuf>>) -> BTreeSet<BTreeSet<PathBuf>> {
    let reached = |from: &PathBuf| {
        let (mut seen, mut open) = (BTreeSet::new(), vec![from]);
        while let Some(next) = open.pop() {
            for used in graph.get(next).into_iter().flatten() {
                if seen.insert(used.clone()) {
                    open.push(used);
                }
            }
        }
        seen
    };
    let all: BTreeMap<&PathBuf, _> = graph.keys().map(|path| (path, reached(path))).collect();
    let circle = |path: &PathBuf| {
        let back = |other: &&PathBuf| all.get(other).is_some_and(|seen| seen.contains(path));
        all[path].iter().filter(back).cloned().collect()
    };
    let in_circles = graph.keys().filter(|path| all[*path].contains(*path));
    in_circles.map(circle).collect()
}

fn module(path: &Path) -> Module {
    let inside = path.strip_prefix("src").unwrap().with_extension("");
    let mut names: Module = inside
        .iter()
        .map(|name| name.to_str().unwrap().to_owned())
        .collect();
    names.pop_if(|last| ["mod", "lib", "main"].contains(&&**last));
    names
}

/// A file in one line, without its tests and comments.
fn without_tests(code: &str) -> String {
    let code = code.split("#[cfg(test)]\nmod tests {").next().unwrap();
    let lines = code.lines();
    let lines = lines.filter(|line| !line.trim_start().starts_with("//"));
    lines.collect::<Vec<_>>().join(" ")
}

/// Paths from the crate's root or from a module above, wherever they stand outside of `use` lines.
fn paths_in(code: &str) -> Vec<String> {
    let in_path = |letter: char| letter.is_alphanumeric() || "_:".contains(letter);
    // `pub(in crate::room)` uses nothing.
    let code = code.replace("(in crate::", "(in ");
    let words = code.split(|letter| !in_path(letter));
    let paths = words.filter(|word| word.starts_with("crate::") || word.starts_with("super::"));
    // `use crate::{…}` leaves a path without an end.
    let whole = paths.filter(|path| !path.ends_with(':'));
    whole.map(str::to_owned).collect()
}

/// What stands between `use` and the semicolon, without re-exports, which name what is inside.
fn use_trees(code: &str) -> Vec<String> {
    let mut trees = Vec::new();
    for (at, _) in code.match_indices("use ") {
        let before = code[..at].trim_end();
        let starts = before.is_empty() || before.ends_with([';', '}', ']', '{']);
        if starts && let Some(end) = code[at..].find(';') {
            trees.push(code[at + 4..at + end].split_whitespace().collect());
        }
    }
    trees
}

/// The paths of a tree of braces.
fn expanded(tree: &str) -> Vec<String> {
    let Some((head, rest)) = tree.split_once('{') else {
        return vec![tree.to_owned()];
    };
    let inner = rest.rsplit_once('}').map_or(rest, |(inner, _)| inner);
    let (mut parts, mut part, mut depth) = (Vec::new(), String::new(), 0);
    for letter in inner.chars() {
        match letter {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(std::mem::take(&mut part));
                continue;
            }
            _ => {}
        }
        part.push(letter);
    }
    parts.push(part);
    let parts = parts.into_iter().filter(|part| !part.is_empty());
    parts
        .flat_map(|part| expanded(&format!("{head}{part}")))
        .collect()
}

/// The file that holds what a path names.
fn file_of(path: &str, own: &Module, files: &BTreeMap<Module, &PathBuf>) -> Option<PathBuf> {
    let mut names: Vec<&str> = path.split("::").collect();
    let mut from: Module = match names[0] {
        "crate" | "slipmap" => {
            names.remove(0);
            Module::new()
        }
        "self" | "super" => own.clone(),
        // A module below this one, or another crate.
        child => {
            let below: Module = own.iter().cloned().chain([child.to_owned()]).collect();
            return files.get(&below).map(|file| (*file).clone());
        }
    };
    while let Some(first @ ("self" | "super")) = names.first().copied() {
        names.remove(0);
        if first == "super" {
            from.pop();
        }
    }
    from.extend(names.into_iter().map(str::to_owned));
    while !from.is_empty() {
        if let Some(file) = files.get(&from) {
            return Some((*file).clone());
        }
        from.pop();
    }
    None
}
