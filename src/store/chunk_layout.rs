//! How the cells of a column are stored: in chunks, each shuffled and deflated.

use zlib_rs::{InflateConfig, ReturnCode, decompress_slice};

/// How the chunks of a dataset are stored.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ChunkLayout {
    /// Values along each axis.
    pub shape: Vec<usize>,
    /// Values of a chunk along each axis, at least 1; chunks at the far edges extend beyond the
    /// dataset.
    pub chunk: Vec<usize>,
    /// Bytes of a value.
    pub element: usize,
    /// Whether chunks are deflated.
    pub deflated: bool,
    /// Whether chunks are shuffled: first the first bytes of all values, then the second bytes, and
    /// so on.
    pub shuffled: bool,
}

impl ChunkLayout {
    /// Number of chunks.
    #[must_use]
    pub fn chunks(&self) -> usize {
        let along = self.shape.iter().zip(&self.chunk);
        along.fold(1, |count: usize, (&whole, &length)| {
            count.saturating_mul(whole.div_ceil(length))
        })
    }

    /// Values of a whole chunk.
    #[must_use]
    pub fn cells(&self) -> usize {
        self.chunk.iter().product()
    }

    /// Bytes of a whole chunk.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.cells() * self.element
    }

    /// The values of a chunk as bytes, decoded from `stored`, including those beyond the edges.
    ///
    /// # Errors
    /// A description of what is wrong when `stored` is no valid chunk of this layout.
    pub(crate) fn decoded(&self, stored: Vec<u8>) -> Result<Vec<u8>, &'static str> {
        let mut bytes = stored;
        let length = self.bytes();
        if self.deflated {
            let mut out = vec![0; length];
            match decompress_slice(&mut out, &bytes, InflateConfig::default()) {
                (whole, ReturnCode::Ok) if whole.len() == length => {}
                _ => return Err("a chunk does not inflate to its own size"),
            }
            bytes = out;
        }
        if bytes.len() != length {
            return Err("a chunk has not its own size");
        }
        if self.shuffled && self.element > 1 {
            bytes = unshuffled(&bytes, self.element);
        }
        Ok(bytes)
    }
}

/// The inverse of HDF5's shuffle.
fn unshuffled(bytes: &[u8], size: usize) -> Vec<u8> {
    let count = bytes.len() / size;
    let mut out = vec![0; bytes.len()];
    for (byte, plane) in bytes.chunks_exact(count).enumerate() {
        for (value, &from) in out.chunks_exact_mut(size).zip(plane) {
            value[byte] = from;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chunks_at_the_far_edges_count() {
        let chunks = |shape: &[usize], chunk: &[usize]| {
            let layout = ChunkLayout {
                shape: shape.to_vec(),
                chunk: chunk.to_vec(),
                element: 2,
                deflated: true,
                shuffled: true,
            };
            layout.chunks()
        };
        assert_eq!(chunks(&[10, 7], &[3, 7]), 4);
        assert_eq!(chunks(&[20_000, 20_000], &[1, 1]), 400_000_000);
        assert_eq!(chunks(&[usize::MAX; 3], &[1, 1, 1]), usize::MAX);
    }
}
