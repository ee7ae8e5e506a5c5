//! HDF5's own shuffle and deflate filters, applied on the computing threads.
//!
//! The library would apply them behind its one lock. Here each thread compresses its own chunks and
//! hands whole chunks to the library.

use std::collections::HashMap;
use std::sync::Arc;

use zlib_rs::{
    DeflateConfig, InflateConfig, ReturnCode, Strategy, compress_bound, compress_slice,
    decompress_slice,
};

/// The deflate level that the files name.
pub(super) const DEFLATE_LEVEL: u8 = 1;

/// Number of constant chunks that are remembered.
const MOST_CONSTANT: usize = 64;

/// A compressed chunk; equal chunks share their bytes.
pub(super) type Chunk = Arc<[u8]>;

/// Compresses chunks of one thread.
#[derive(Default)]
pub(super) struct ChunkCodec {
    shuffled: Vec<u8>,
    out: Vec<u8>,
    /// Chunks of one repeated element, by its bits and by the number and size of the elements.
    constant: HashMap<(u64, usize), Chunk>,
}

/// Elements that a chunk can hold.
pub(super) trait Element: Copy + PartialEq {
    /// Size in bytes.
    const SIZE: usize;
    /// How deflate looks for repetitions. Counts and flags come in long runs; searching only for
    /// runs is several times faster and compresses better.
    const STRATEGY: Strategy;
    /// The bits, for telling constant chunks apart.
    fn bits(self) -> u64;
    /// Bytes as they lie in memory.
    fn bytes(slice: &[Self]) -> &[u8];
}

macro_rules! element {
    ($kind:ty, $strategy:expr, $bits:expr) => {
        impl Element for $kind {
            const SIZE: usize = size_of::<$kind>();
            const STRATEGY: Strategy = $strategy;
            fn bits(self) -> u64 {
                $bits(self)
            }
            fn bytes(slice: &[Self]) -> &[u8] {
                // SAFETY: plain numbers have no padding, and any byte is a valid u8.
                unsafe { std::slice::from_raw_parts(slice.as_ptr().cast(), size_of_val(slice)) }
            }
        }
    };
}
element!(u8, Strategy::Rle, u64::from);
element!(u16, Strategy::Rle, u64::from);
element!(f64, Strategy::Default, f64::to_bits);

impl ChunkCodec {
    /// The chunk as HDF5 stores it: bytes shuffled (for elements longer than one) and deflated.
    pub(super) fn encode<T: Element>(&mut self, values: &[T]) -> Chunk {
        let Some(key) = constant_key(values) else {
            return self.compress(values);
        };
        if let Some(chunk) = self.constant.get(&key) {
            return Arc::clone(chunk);
        }
        let chunk = self.compress(values);
        if self.constant.len() >= MOST_CONSTANT {
            self.constant.clear();
        }
        self.constant.insert(key, Arc::clone(&chunk));
        chunk
    }

    fn compress<T: Element>(&mut self, values: &[T]) -> Chunk {
        let raw = T::bytes(values);
        let input = if T::SIZE == 1 {
            raw
        } else {
            shuffle(raw, T::SIZE, &mut self.shuffled);
            &self.shuffled
        };
        let bound = compress_bound(input.len());
        self.out.resize(bound.max(self.out.len()), 0);
        let config = DeflateConfig {
            level: i32::from(DEFLATE_LEVEL),
            strategy: T::STRATEGY,
            ..DeflateConfig::default()
        };
        match compress_slice(&mut self.out, input, config) {
            (chunk, ReturnCode::Ok) => Arc::from(&*chunk),
            // The buffer has the size that the library asks for, and the settings are constants.
            (_, code) => unreachable!("deflate ended with {code:?}"),
        }
    }
}

/// Inflates a chunk of single bytes to `length` bytes; none where it does not inflate to that
/// length.
pub(super) fn decode_bytes(chunk: &[u8], length: usize) -> Option<Vec<u8>> {
    let mut out = vec![0; length];
    match decompress_slice(&mut out, chunk, InflateConfig::default()) {
        (whole, ReturnCode::Ok) if whole.len() == length => Some(out),
        _ => None,
    }
}

/// The key of a chunk of one repeated element; none for any other chunk.
fn constant_key<T: Element>(values: &[T]) -> Option<(u64, usize)> {
    let first = *values.first()?;
    let same = values.iter().all(|v| v.bits() == first.bits());
    same.then(|| (first.bits(), values.len() * 16 + T::SIZE))
}

/// HDF5's shuffle: first bytes of all elements, then second bytes, and so on.
fn shuffle(raw: &[u8], size: usize, out: &mut Vec<u8>) {
    let count = raw.len() / size;
    out.resize(raw.len(), 0);
    for (byte, plane) in out.chunks_exact_mut(count).enumerate() {
        for (target, element) in plane.iter_mut().zip(raw.chunks_exact(size)) {
            *target = element[byte];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shuffle_puts_planes_together() {
        let mut out = Vec::new();
        shuffle(&[1, 2, 3, 4, 5, 6], 2, &mut out);
        assert_eq!(out, [1, 3, 5, 2, 4, 6]);
    }

    #[test]
    fn bytes_come_back() {
        let bytes: Vec<u8> = (0..5000_u32).map(|i| ((i * i) >> 7) as u8).collect();
        let chunk = ChunkCodec::default().encode(&bytes);
        assert_eq!(decode_bytes(&chunk, 5000), Some(bytes));
        assert_eq!(decode_bytes(&chunk, 4999), None);
        assert_eq!(decode_bytes(&chunk, 5001), None);
        assert_eq!(decode_bytes(b"no chunk", 10), None);
    }

    #[test]
    fn constant_chunks_are_compressed_once() {
        let mut codec = ChunkCodec::default();
        let first = codec.encode(&[2_u16; 1000]);
        assert!(Arc::ptr_eq(&first, &codec.encode(&[2_u16; 1000])));
        assert!(!Arc::ptr_eq(&first, &codec.encode(&[4_u16; 1000])));
        assert!(!Arc::ptr_eq(&first, &codec.encode(&[2_u8; 1000])));
        let mut other = [2_u16; 1000];
        other[999] = 3;
        assert!(!Arc::ptr_eq(&first, &codec.encode(&other)));
        assert_eq!(codec.encode(&[f64::NAN; 10]), codec.encode(&[f64::NAN; 10]));
    }
}
