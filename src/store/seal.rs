//! The seal of a map: a checksum of all its bytes, in a line of text behind them.
//!
//! HDF5 has checksums of its own for most of what describes the data, and a map has one of its
//! values and texts; references between datasets and what nobody thought of are under the seal
//! alone. Readers do not see it. A program that opens a map to write to it drops it.

use std::fs::{File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;

use sha2::{Digest, Sha256};

use crate::sweep::plan::in_hexadecimal;

/// What comes before the digest.
const BEFORE: &[u8] = b"\nslipmap map, sha256 of all before this line: ";
/// Bytes of a seal: a digest in hexadecimal, and the end of the line.
const LENGTH: usize = BEFORE.len() + 64 + 1;
/// Bytes that are read at once.
const BLOCK: usize = 1 << 20;

/// What a file's last bytes say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Seal {
    /// All bytes are those that were sealed.
    Whole,
    /// Some are not.
    Broken,
    /// There is no seal.
    Missing,
}

/// Puts the seal behind a file that is closed.
///
/// # Errors
/// When the system refuses.
pub(super) fn put(path: &Path) -> io::Result<()> {
    let mut file = OpenOptions::new().read(true).append(true).open(path)?;
    let length = file.metadata()?.len();
    let seal = line(&mut file, length)?;
    file.write_all(&seal)
}

/// Whether a file is as it was sealed.
///
/// # Errors
/// When it cannot be read.
pub(super) fn check(path: &Path) -> io::Result<Seal> {
    let mut file = File::open(path)?;
    let Some(length) = file.metadata()?.len().checked_sub(LENGTH as u64) else {
        return Ok(Seal::Missing);
    };
    file.seek(SeekFrom::Start(length))?;
    let mut found = [0; LENGTH];
    file.read_exact(&mut found)?;
    if !found.starts_with(BEFORE) {
        return Ok(Seal::Missing);
    }
    file.rewind()?;
    Ok(match line(&mut file, length)? == found {
        true => Seal::Whole,
        false => Seal::Broken,
    })
}

/// The seal of the first `length` bytes.
fn line(file: &mut File, length: u64) -> io::Result<Vec<u8>> {
    let mut hash = Sha256::new();
    let mut block = vec![0; BLOCK];
    let mut rest = file.take(length);
    loop {
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
        assert_eq!(check(&path).unwrap(), Seal::Missing);
        put(&path).unwrap();
        assert_eq!(check(&path).unwrap(), Seal::Whole);
        let sealed = std::fs::read(&path).unwrap();
        assert!(sealed.starts_with(b"all of it\n"));
        for bit in 0..sealed.len() * 8 {
            let mut bytes = sealed.clone();
            bytes[bit / 8] ^= 1 << (bit % 8);
            std::fs::write(&path, &bytes).unwrap();
            assert_ne!(check(&path).unwrap(), Seal::Whole, "bit {bit}");
        }
        std::fs::write(&path, &sealed[..sealed.len() - 1]).unwrap();
        assert_eq!(check(&path).unwrap(), Seal::Missing);
    }
}
