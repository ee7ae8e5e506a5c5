//! The seal of a map: a checksum of all its bytes, in a line of text at the end of the file.
//!
//! HDF5 has its own checksums for most of its metadata, and a map has checksums of its values and
//! texts. Everything else, such as references between datasets, is covered by the seal alone. HDF5
//! readers do not see it. A program that opens a map to write to it removes it.

use std::fs::{File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use sha2::{Digest, Sha256};

use super::regular;
use crate::text::in_hexadecimal;

/// The text before the digest.
const BEFORE: &[u8] = b"\nslipmap map, sha256 of all before this line: ";
/// Bytes of a seal: the text, a digest in hexadecimal, and the end of the line.
const LENGTH: usize = BEFORE.len() + 64 + 1;
/// Bytes read at once.
const BLOCK: usize = 1 << 20;

/// The state of a file's seal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Seal {
    /// All bytes are those that were sealed.
    Whole,
    /// Some bytes have changed.
    Broken,
    /// There is no seal.
    Missing,
}

/// Appends the seal to a closed file and reads it back. Once `stop` is set, reading ends, and what
/// is appended is no valid seal.
///
/// # Errors
/// When the system refuses, or does not give back what was written.
pub(super) fn put(path: &Path, stop: &AtomicBool) -> io::Result<()> {
    let mut file = OpenOptions::new().read(true).append(true).open(path)?;
    let length = file.metadata()?.len();
    let seal = line(&mut file, length, stop)?;
    file.write_all(&seal)?;
    match last(&mut file)? {
        (before, found) if before == length && found[..] == seal => Ok(()),
        _ => Err(io::Error::other("the seal is not read as it was written")),
    }
}

/// The number of bytes before the place of a seal, and the bytes there.
fn last(file: &mut File) -> io::Result<(u64, [u8; LENGTH])> {
    let mut found = [0; LENGTH];
    let before = file.metadata()?.len().saturating_sub(LENGTH as u64);
    file.seek(SeekFrom::Start(before))?;
    file.read_exact(&mut found)?;
    Ok((before, found))
}

/// Whether a file ends as a sealed one does, whatever its bytes are.
pub(super) fn is_there(path: &Path) -> bool {
    let end = regular::open(path).and_then(|mut file| Ok(last(&mut file)?));
    end.is_ok_and(|(_, found)| found.starts_with(BEFORE))
}

/// Checks a file against its seal.
///
/// Once `stop` is set, reading ends and the answer is meaningless.
///
/// # Errors
/// When it cannot be read.
pub(super) fn check(path: &Path, stop: &AtomicBool) -> io::Result<Seal> {
    let mut file = regular::open(path)?;
    if file.metadata()?.len() < LENGTH as u64 {
        return Ok(Seal::Missing);
    }
    let (length, found) = last(&mut file)?;
    if !found.starts_with(BEFORE) {
        return Ok(Seal::Missing);
    }
    file.rewind()?;
    Ok(match line(&mut file, length, stop)?[..] == found {
        true => Seal::Whole,
        false => Seal::Broken,
    })
}

/// The seal of the first `length` bytes.
fn line(file: &mut File, length: u64, stop: &AtomicBool) -> io::Result<Vec<u8>> {
    let mut hash = Sha256::new();
    let mut block = vec![0; BLOCK];
    let mut rest = file.take(length);
    while !stop.load(Ordering::Relaxed) {
        let read = match rest.read(&mut block) {
            Ok(0) => break,
            Ok(read) => read,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            Err(error) => return Err(error),
        };
        hash.update(&block[..read]);
    }
    let digest = in_hexadecimal(&hash.finalize());
    Ok([BEFORE, digest.as_bytes(), b"\n"].concat())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bit_is_sealed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        std::fs::write(&path, b"all of it").unwrap();
        let go = AtomicBool::new(false);
        let check = |path| check(path, &go).unwrap();
        assert_eq!(check(&path), Seal::Missing);
        put(&path, &go).unwrap();
        assert_eq!(check(&path), Seal::Whole);
        let sealed = std::fs::read(&path).unwrap();
        assert!(sealed.starts_with(b"all of it\n"));
        for bit in 0..sealed.len() * 8 {
            let mut bytes = sealed.clone();
            bytes[bit / 8] ^= 1 << (bit % 8);
            std::fs::write(&path, &bytes).unwrap();
            assert_ne!(check(&path), Seal::Whole, "bit {bit}");
        }
        std::fs::write(&path, &sealed[..sealed.len() - 1]).unwrap();
        assert_eq!(check(&path), Seal::Missing);
    }
}
