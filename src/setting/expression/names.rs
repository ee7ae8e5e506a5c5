//! The names in the text of an expression, before it is read.

use super::reader::{NUMBER_PI, functions};
use crate::text::words;

/// The names in a text that are not those of functions or of π, each once.
pub(in crate::setting) fn names_in(text: &str) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for word in text.split(|c| !words::belongs(c)) {
        let after = word.as_ptr() as usize + word.len() - text.as_ptr() as usize;
        let called = text[after..].trim_start().starts_with('(');
        let begins = word.starts_with(|c: char| words::begins(c) || c == '_');
        let known = words::same(word, NUMBER_PI) || functions(true).any(|known| known == word);
        let is_new = || !names.iter().any(|name| words::same(name, word));
        if begins && !called && !known && is_new() {
            names.push(word);
        }
    }
    names
}
