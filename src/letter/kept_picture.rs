//! Pictures in a folder that is kept: a last line by which they are known again, also where another
//! version drew them.

use std::path::Path;

use sha2::{Digest, Sha256};

use crate::store::regular;
use crate::text::in_hexadecimal;

/// The most bytes of a picture that is looked at.
const MOST_BYTES: u64 = 1 << 28;

/// A picture, SVG, with the last line of the figure `name`.
pub(super) fn marked(svg: &[u8], name: &str) -> Vec<u8> {
    [svg, last_line(svg, name).as_bytes()].concat()
}

/// Whether the file at `path` is a picture of the figure `name` that nobody has changed.
pub(super) fn is_kept(path: &Path, name: &str) -> bool {
    let itself = path.symlink_metadata().is_ok_and(|about| about.is_file());
    let Some(bytes) = itself
        .then(|| regular::read(path, MOST_BYTES).ok())
        .flatten()
    else {
        return false;
    };
    let length = last_line(b"", name).len();
    let before = bytes.len().checked_sub(length);
    let parts = before.map(|before| bytes.split_at(before));
    parts.is_some_and(|(svg, line)| line == last_line(svg, name).as_bytes())
}

/// The comment behind the end of a picture: its figure, and the checksum of all before.
fn last_line(svg: &[u8], name: &str) -> String {
    let checksum = in_hexadecimal(&Sha256::digest(svg));
    format!("<!-- slipmap reproduce, {name}, sha256 of all before: {checksum} -->\n")
}
