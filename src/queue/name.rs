//! Names of jobs: a number that orders them, and a word made of the name of the sweep file.

use std::ffi::{OsStr, OsString};
use std::fmt;

/// The extension of sweep files.
const ENDING: &str = ".toml";
/// What is put around a name for its lock.
const BEFORE_LOCK: &str = ".";
const BEHIND_LOCK: &str = ".lock";
/// The first number, and the distance of numbers, so that there is room before and between them.
const FIRST: u64 = 100_000;
const STEP: u64 = 10;
/// Digits of a number. Names are ordered as texts, so all have as many.
const DIGITS: usize = 6;
/// The least number with more digits.
const TOO_LARGE: u64 = 1_000_000;
/// The most letters of a word.
const LONGEST: usize = 64;
/// The most bytes of a name that a user has chosen; file systems take 255 with all around it.
const LONGEST_STEM: usize = 200;
/// The word of a sweep whose file has none.
const NAMELESS: &str = "sweep";

/// The name of a job: that of its file without the extension. A user may have chosen any.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Name(OsString);

impl Name {
    /// The name of a file in a folder of the queue; none if it is no sweep file.
    pub(crate) fn of_file(file: &OsStr) -> Option<Self> {
        Self::within(file, "", ENDING)
    }

    /// The name of the job that a lock is of; none if it is no lock of a job.
    pub(super) fn of_lock(file: &OsStr) -> Option<Self> {
        Self::within(file, BEFORE_LOCK, BEHIND_LOCK)
    }

    /// The name between what is put before and behind it.
    fn within(file: &OsStr, before: &str, behind: &str) -> Option<Self> {
        let bytes = file.as_encoded_bytes();
        let stem = bytes.strip_prefix(before.as_bytes())?;
        let stem = stem.strip_suffix(behind.as_bytes())?;
        if stem.is_empty() || stem.starts_with(b".") {
            return None;
        }
        // The bytes end before a part that is text.
        #[cfg(unix)]
        let stem = std::os::unix::ffi::OsStrExt::from_bytes(stem);
        #[cfg(not(unix))]
        let stem = std::str::from_utf8(stem).ok()?.as_ref();
        Some(Self(OsStr::to_os_string(stem)))
    }

    /// The name that a user gives; with the extension, or as the name of the map, it is the same.
    /// There is none where it would lead out of the folders of the queue.
    pub(crate) fn given(text: &str) -> Option<Self> {
        let stem = text.strip_suffix(ENDING).or(text.strip_suffix(".h5"));
        let stem = stem.unwrap_or(text);
        let is_name =
            !stem.is_empty() && !stem.starts_with('.') && !stem.contains(['/', '\\', '\0']);
        is_name.then(|| Self::of_stem(stem))
    }

    /// The name of a file, without its extension.
    pub(crate) fn of_stem(stem: &str) -> Self {
        Self(stem.into())
    }

    /// Whether the files of this job have names that a file system takes, with what is put before
    /// and behind them.
    pub(crate) fn is_short(&self) -> bool {
        self.0.len() <= LONGEST_STEM
    }

    /// A name of this number and this word.
    fn numbered(number: u64, word: &str) -> Self {
        Self(format!("{number:0DIGITS$}-{word}").into())
    }

    /// The name of a file of this job, with something before and behind it.
    pub(crate) fn file(&self, before: &str, behind: &str) -> OsString {
        let mut file = OsString::from(before);
        file.push(&self.0);
        file.push(behind);
        file
    }

    /// The name of its sweep file.
    pub(crate) fn sweep_file(&self) -> OsString {
        self.file("", ENDING)
    }

    /// The name of its lock.
    pub(super) fn lock_file(&self) -> OsString {
        self.file(BEFORE_LOCK, BEHIND_LOCK)
    }

    /// Its number and its word; none where a user has chosen another form.
    pub(crate) fn parts(&self) -> Option<(u64, &str)> {
        let (number, word) = self.0.to_str()?.split_once('-')?;
        let whole = !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit());
        Some((number.parse().ok().filter(|_| whole)?, word))
    }

    /// Its number, if it has as many digits as those that jobs are given. The others are not
    /// ordered by their numbers.
    fn number(&self) -> Option<u64> {
        let (number, word) = self.parts()?;
        let digits = self.0.len() - word.len() - 1;
        Some(number).filter(|_| digits == DIGITS)
    }

    /// A name behind all of `names`; none if there is none.
    pub(crate) fn behind<'a>(names: impl Iterator<Item = &'a Self>, word: &str) -> Option<Self> {
        let last = names.filter_map(Self::number).max();
        let next = last
            .map_or(FIRST, |last| (last / STEP + 1) * STEP)
            .max(FIRST);
        (next < TOO_LARGE).then(|| Self::numbered(next, word))
    }

    /// A name before all of `names`, which are of files that wait; none if there is none. `others`
    /// are names that are taken.
    pub(crate) fn before<'a>(
        names: impl Iterator<Item = &'a Self> + Clone,
        others: impl Fn(&Self) -> bool,
        word: &str,
    ) -> Option<Self> {
        let least = names.clone().min()?;
        let mut number = names.filter_map(Self::number).min().unwrap_or(FIRST);
        loop {
            number = (number / STEP * STEP).checked_sub(STEP)?;
            let name = Self::numbered(number, word);
            if name < *least && !others(&name) {
                return Some(name);
            }
        }
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        self.0.to_string_lossy().fmt(f)
    }
}

/// The word of a name, of small letters, digits and hyphens, from any text, such as the name of a
/// file without its extension.
pub(crate) fn word(text: &str) -> String {
    let mut word = String::new();
    for letter in text.chars() {
        match letter.to_ascii_lowercase() {
            letter if letter.is_ascii_alphanumeric() => word.push(letter),
            _ if word.is_empty() || word.ends_with('-') => {}
            _ => word.push('-'),
        }
        if word.len() == LONGEST {
            break;
        }
    }
    match word.trim_end_matches('-') {
        "" => NAMELESS.into(),
        word => word.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(texts: &[&str]) -> Vec<Name> {
        texts.iter().map(|text| Name::of_stem(text)).collect()
    }

    fn behind(texts: &[&str]) -> Option<String> {
        Name::behind(names(texts).iter(), "a").map(|name| name.to_string())
    }

    fn before(texts: &[&str]) -> Option<String> {
        let taken = |name: &Name| name.to_string() == "099970-a";
        Name::before(names(texts).iter(), taken, "a").map(|name| name.to_string())
    }

    #[test]
    fn words_are_made_of_any_text() {
        for (text, expected) in [
            ("fig2a", "fig2a"),
            ("Fig. 2(a) — new", "fig-2-a-new"),
            ("../../etc/passwd", "etc-passwd"),
            ("vc_load", "vc-load"),
            ("", "sweep"),
            ("漢字", "sweep"),
            ("--", "sweep"),
        ] {
            assert_eq!(word(text), expected);
        }
        assert_eq!(word(&"x".repeat(100)).len(), LONGEST);
        assert!(!word(&format!("{}-y", "x".repeat(63))).ends_with('-'));
    }

    #[test]
    fn numbers_go_in_tens_and_order_as_texts() {
        assert_eq!(behind(&[]).unwrap(), "100000-a");
        assert_eq!(behind(&["100000-b", "0042-c", "x"]).unwrap(), "100010-a");
        assert_eq!(behind(&["100013-b"]).unwrap(), "100020-a");
        assert_eq!(behind(&["9999999999999999999999-b"]).unwrap(), "100000-a");
        assert_eq!(behind(&["999990-b"]), None);
        assert_eq!(before(&["100000-b", "100010-c"]).unwrap(), "099990-a");
        assert_eq!(before(&["099980-b"]).unwrap(), "099960-a");
        assert_eq!(before(&["x", "y"]).unwrap(), "099990-a");
        // Names are texts: this one stands before every number of six digits that is left.
        assert_eq!(before(&["00-b", "100000-c"]), None);
        assert_eq!(before(&["000005-b"]), None);
        // One with fewer digits stands behind.
        assert_eq!(before(&["5-x"]).unwrap(), "099990-a");
        assert_eq!(before(&["5-x", "100000-c"]).unwrap(), "099990-a");
        assert_eq!(before(&[]), None);
    }

    #[test]
    fn files_that_are_no_sweeps_have_no_name() {
        let of = |file: &str| Name::of_file(file.as_ref()).map(|name| name.to_string());
        assert_eq!(of("0042-fig2a.toml").unwrap(), "0042-fig2a");
        for file in [
            ".0042-fig2a.lock",
            ".hidden.toml",
            ".toml",
            "readme.txt",
            "a.toml.part",
        ] {
            assert_eq!(of(file), None, "{file}");
        }
        assert_eq!(Name::given("a.toml"), Name::given("a"));
        assert_eq!(Name::given("a").unwrap().parts(), None);
        assert_eq!(Name::given("7-a-b").unwrap().parts(), Some((7, "a-b")));
        for outside in [
            "",
            ".",
            "..",
            "../a",
            "/tmp/a.toml",
            "a/b",
            ".lock",
            "a\0",
            ".toml",
        ] {
            assert_eq!(Name::given(outside), None, "{outside}");
        }
    }
}
