//! A table whose keys are taken one by one, each with its places.

use std::ops::Range;

use super::toml_reader::{Entry, SpecError};

/// A table of a text. Whatever the order in which its keys are taken, the first error of the text
/// is the one that is reported.
pub(crate) struct Document<'t> {
    known: Vec<&'static str>,
    /// The entries that are not taken yet.
    left: Vec<Entry<'t>>,
    /// The keys in the order of the text, with the places of key and value.
    places: Vec<(&'t str, Range<usize>, Range<usize>)>,
    /// The first error so far, with the place of its key.
    error: Option<(usize, SpecError)>,
}

impl<'t> Document<'t> {
    /// The table of these entries, which may have the `known` keys.
    pub(crate) fn of(
        entries: Vec<Entry<'t>>,
        known: impl IntoIterator<Item = &'static str>,
    ) -> Self {
        let place = |of: &Entry<'t>| (of.key, of.key_span.clone(), of.span.clone());
        Self {
            known: known.into_iter().collect(),
            places: entries.iter().map(place).collect(),
            left: entries,
            error: None,
        }
    }

    /// The entry of a known key, which is taken by it.
    pub(crate) fn entry(&mut self, key: &str) -> Option<Entry<'t>> {
        let place = self.left.iter().position(|entry| entry.key == key)?;
        self.known.contains(&key).then(|| self.left.remove(place))
    }

    /// The entry of a key that is not taken yet.
    pub(crate) fn ahead(&self, key: &str) -> Option<&Entry<'t>> {
        self.left.iter().find(|entry| entry.key == key)
    }

    /// The value of a key; none where it is not given or not understood.
    pub(crate) fn take<T>(
        &mut self,
        key: &str,
        read: impl FnOnce(&Entry<'t>) -> Result<T, SpecError>,
    ) -> Option<T> {
        let entry = self.entry(key)?;
        let value = read(&entry);
        value.map_err(|error| self.note(&entry, error)).ok()
    }

    /// Takes several keys in the order of the text.
    pub(crate) fn each(
        &mut self,
        keys: &[&str],
        mut read: impl FnMut(&Entry<'t>) -> Result<(), SpecError>,
    ) {
        let given: Vec<&str> = self.places.iter().map(|(key, ..)| *key).collect();
        for key in given.into_iter().filter(|key| keys.contains(key)) {
            self.take(key, &mut read);
        }
    }

    /// Refuses keys that belong elsewhere, as `help` says.
    pub(crate) fn refuse(&mut self, keys: &[&str], help: &str) {
        while let Some(place) = self.left.iter().position(|of| keys.contains(&of.key)) {
            let entry = self.left.remove(place);
            self.note(&entry, entry.elsewhere(help));
        }
    }

    /// Whether a string that is not taken yet passes a test, apart from those under keys of `but`.
    pub(crate) fn any_string_but(&self, but: &[&str], test: impl Fn(&str) -> bool) -> bool {
        let mut left = self.left.iter().filter(|entry| !but.contains(&entry.key));
        left.any(|entry| entry.in_strings(&|text| test(text).then_some(())).is_some())
    }

    fn note(&mut self, entry: &Entry, error: SpecError) {
        let place = entry.key_span.start;
        if self.error.as_ref().is_none_or(|(first, _)| place < *first) {
            self.error = Some((place, error));
        }
    }

    /// Checks that every key was understood, and that none is left.
    pub(crate) fn finish(&mut self) -> Result<(), SpecError> {
        if !self.left.is_empty() {
            let entry = self.left.remove(0);
            self.note(&entry, entry.unknown(&self.known));
        }
        self.error.take().map_or(Ok(()), |(_, error)| Err(error))
    }

    /// The place of a key.
    pub(crate) fn key(&self, key: &str) -> Option<&Range<usize>> {
        let mut places = self.places.iter();
        places.find_map(|(of, place, _)| (*of == key).then_some(place))
    }

    /// The place of the value of a key.
    pub(crate) fn value(&self, key: &str) -> Option<&Range<usize>> {
        let mut places = self.places.iter();
        places.find_map(|(of, _, place)| (*of == key).then_some(place))
    }

    /// The keys in the order of the text, with their places.
    pub(crate) fn keys(&self) -> impl DoubleEndedIterator<Item = (&'t str, &Range<usize>)> {
        self.places.iter().map(|(key, place, _)| (*key, place))
    }
}

impl<'t> Entry<'t> {
    /// The value as a table with these keys.
    pub(crate) fn document(
        &self,
        known: impl IntoIterator<Item = &'static str>,
    ) -> Result<Document<'t>, SpecError> {
        Ok(Document::of(self.table()?, known))
    }
}
