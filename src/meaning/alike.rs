//! Stretches of equal neighbours, of which most cells have many.

/// Numbers that are compared at once.
const BLOCK: usize = 32;

/// How many numbers from the first one on are the same as it.
pub(crate) fn alike<T: Copy>(numbers: &[T], same: impl Fn(T, T) -> bool) -> usize {
    let Some(&first) = numbers.first() else {
        return 0;
    };
    // Blocks are counted to their ends, which wide instructions do.
    let count = |block: &[T]| -> usize { block.iter().map(|n| usize::from(same(*n, first))).sum() };
    let mut begun = 0;
    while (numbers.get(begun..begun + BLOCK)).is_some_and(|block| count(block) == BLOCK) {
        begun += BLOCK;
    }
    let rest = numbers[begun..].iter();
    begun + rest.take_while(|n| same(**n, first)).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stretch_ends_at_the_first_other_number() {
        for length in [0, 1, 2, 31, 32, 33, 100] {
            for end in 0..=length {
                let numbers: Vec<u8> = (0..length).map(|i| u8::from(i >= end)).collect();
                let expected = if end == 0 { length } else { end };
                assert_eq!(alike(&numbers, |a, b| a == b), expected);
            }
        }
        let bits = |a: f64, b: f64| a.to_bits() == b.to_bits();
        assert_eq!(alike(&[f64::NAN, f64::NAN, 0.0], bits), 2);
    }
}
