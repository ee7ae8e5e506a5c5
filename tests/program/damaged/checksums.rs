//! The checksums of HDF5's newer metadata, so that damage gets past them: Jenkins' lookup3, 4 bytes
//! behind each block.

use std::ops::Range;

/// Longer blocks are not looked for.
const LONGEST: usize = 2048;

fn word(bytes: &[u8], at: usize) -> u32 {
    let byte = |i: usize| bytes.get(at + i).copied().unwrap_or(0);
    u32::from_le_bytes([byte(0), byte(1), byte(2), byte(3)])
}

/// Jenkins' lookup3 of bytes, beginning with 0.
fn lookup3(bytes: &[u8]) -> u32 {
    let start = 0xdead_beef_u32.wrapping_add(bytes.len() as u32);
    let mut state = [start; 3];
    let mut at = 0;
    // What is not there counts as zeros.
    let add = |state: &mut [u32; 3], at: usize| {
        for (i, s) in state.iter_mut().enumerate() {
            *s = s.wrapping_add(word(bytes, at + 4 * i));
        }
    };
    while bytes.len() - at > 12 {
        add(&mut state, at);
        let [mut a, mut b, mut c] = state;
        for turn in [[4, 6, 8], [16, 19, 4]] {
            a = a.wrapping_sub(c) ^ c.rotate_left(turn[0]);
            c = c.wrapping_add(b);
            b = b.wrapping_sub(a) ^ a.rotate_left(turn[1]);
            a = a.wrapping_add(c);
            c = c.wrapping_sub(b) ^ b.rotate_left(turn[2]);
            b = b.wrapping_add(a);
        }
        state = [a, b, c];
        at += 12;
    }
    if bytes.is_empty() {
        return state[2];
    }
    add(&mut state, at);
    let [mut a, mut b, mut c] = state;
    c = (c ^ b).wrapping_sub(b.rotate_left(14));
    a = (a ^ c).wrapping_sub(c.rotate_left(11));
    b = (b ^ a).wrapping_sub(a.rotate_left(25));
    c = (c ^ b).wrapping_sub(b.rotate_left(16));
    a = (a ^ c).wrapping_sub(c.rotate_left(4));
    b = (b ^ a).wrapping_sub(a.rotate_left(14));
    (c ^ b).wrapping_sub(b.rotate_left(24))
}

/// The blocks of a sound file that begin at `places` and have their checksum behind them.
pub(crate) fn blocks(bytes: &[u8], places: &[usize]) -> Vec<Range<usize>> {
    let block = |&start: &usize| {
        let longest = (bytes.len() - start).saturating_sub(4).min(LONGEST);
        let fits = |&length: &usize| {
            let end = start + length;
            lookup3(&bytes[start..end]) == word(bytes, end)
        };
        (8..=longest).find(fits).map(|length| start..start + length)
    };
    places.iter().filter_map(block).collect()
}

/// Makes the checksums fit again.
pub(crate) fn repair(bytes: &mut [u8], blocks: &[Range<usize>]) {
    let length = bytes.len();
    for block in blocks.iter().filter(|block| block.end + 4 <= length) {
        let sum = lookup3(&bytes[block.clone()]);
        bytes[block.end..block.end + 4].copy_from_slice(&sum.to_le_bytes());
    }
}
