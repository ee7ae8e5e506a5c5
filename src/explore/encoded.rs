//! Answers with many numbers as bytes: a head in JSON, then arrays.
//!
//! ```text
//! length of the JSON, u32 | JSON | padding to a multiple of 8 | arrays, each padded likewise
//! ```
//!
//! All numbers are little-endian, like the typed arrays of browsers on every machine that runs one.
//! The JSON names each array with its type, its length and its offset, counted from the end of the
//! padding. An array with many equal numbers in a row may be stored as `runs`: the numbers of the
//! runs, padded, then as many u32, the places where each run ends.

use serde::Serialize;

use crate::meaning::alike::alike;

/// Arrays begin at multiples of this.
const ALIGNED: usize = 8;

/// Numbers that arrays hold.
pub trait Element: Copy {
    /// Its name in heads.
    const KIND: &str;
    /// Adds its bytes.
    fn put(self, bytes: &mut Vec<u8>);
    /// Whether another one has the same bytes.
    fn is(self, other: Self) -> bool;
}

macro_rules! element {
    ($($kind:ident),*) => {$(
        impl Element for $kind {
            const KIND: &str = stringify!($kind);
            fn put(self, bytes: &mut Vec<u8>) {
                bytes.extend(self.to_le_bytes());
            }
            fn is(self, other: Self) -> bool {
                self.to_le_bytes() == other.to_le_bytes()
            }
        }
    )*};
}
element!(u8, u16, u32, f64);

/// Where numbers are.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct Array {
    #[serde(rename = "type")]
    kind: &'static str,
    offset: usize,
    length: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    runs: Option<usize>,
}

/// The arrays of an answer, one after the other.
#[derive(Debug, Default)]
pub struct Arrays(Vec<u8>);

impl Arrays {
    /// Adds numbers one by one.
    pub fn push<T: Element>(&mut self, numbers: impl IntoIterator<Item = T>) -> Array {
        let offset = self.0.len();
        let mut length = 0;
        let numbers = numbers.into_iter();
        // Reserving exactly avoids that a long array takes twice its memory while it grows.
        self.0
            .reserve_exact(numbers.size_hint().0 * size_of::<T>() + ALIGNED);
        for number in numbers {
            number.put(&mut self.0);
            length += 1;
        }
        self.pad();
        Array {
            kind: T::KIND,
            offset,
            length,
            runs: None,
        }
    }

    /// Adds numbers as runs of equal ones, or one by one where that is shorter.
    pub fn push_runs<T: Element>(&mut self, numbers: &[T]) -> Array {
        // A run takes one number and four bytes.
        let most = size_of_val(numbers) / (size_of::<T>() + 4);
        let mut runs: Vec<(T, u32)> = Vec::new();
        let mut begun = 0;
        while let Some(&number) = numbers.get(begun) {
            if runs.len() == most {
                return self.push(numbers.iter().copied());
            }
            begun += alike(&numbers[begun..], T::is);
            runs.push((number, begun as u32));
        }
        let array = self.push(runs.iter().map(|(number, _)| *number));
        self.push(runs.iter().map(|(_, end)| *end));
        Array {
            length: numbers.len(),
            runs: Some(runs.len()),
            ..array
        }
    }

    fn pad(&mut self) {
        self.0.resize(self.0.len().next_multiple_of(ALIGNED), 0);
    }

    /// The whole answer.
    ///
    /// # Errors
    /// When the head cannot be written as JSON.
    pub fn behind(self, head: &impl Serialize) -> Result<Vec<u8>, serde_json::Error> {
        let [mut bytes, arrays] = self.parts(head)?;
        bytes.extend(arrays);
        Ok(bytes)
    }

    /// The whole answer in two parts, for answers too long to copy.
    ///
    /// # Errors
    /// As [`Arrays::behind`].
    pub fn parts(self, head: &impl Serialize) -> Result<[Vec<u8>; 2], serde_json::Error> {
        let head = serde_json::to_vec(head)?;
        let begun = (4 + head.len()).next_multiple_of(ALIGNED);
        let mut bytes = Vec::with_capacity(begun);
        bytes.extend((head.len() as u32).to_le_bytes());
        bytes.extend(head);
        bytes.resize(begun, 0);
        Ok([bytes, self.0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_are_aligned_and_runs_end_where_numbers_change() {
        let mut arrays = Arrays::default();
        let plain = arrays.push([1_u8, 2, 3]);
        let runs = arrays.push_runs(&[[7_u16; 5], [9; 5], [7; 5]].concat());
        let short = arrays.push_runs(&[0.5, 1.5]);
        assert_eq!((plain.offset, plain.length, plain.runs), (0, 3, None));
        assert_eq!((runs.offset, runs.length, runs.runs), (8, 15, Some(3)));
        assert_eq!((short.offset, short.length, short.runs), (32, 2, None));
        // No number is the same as any, but has the same bytes.
        assert_eq!(Arrays::default().push_runs(&[f64::NAN; 4]).runs, Some(1));
        assert_eq!(arrays.0[8..14], [7, 0, 9, 0, 7, 0]);
        assert_eq!(arrays.0[16..28], [5, 0, 0, 0, 10, 0, 0, 0, 15, 0, 0, 0]);
        let bytes = arrays.behind(&plain).unwrap();
        let length = u32::from_le_bytes(bytes[..4].try_into().unwrap()) as usize;
        assert_eq!(
            &bytes[4..4 + length],
            br#"{"type":"u8","offset":0,"length":3}"#
        );
        assert_eq!(bytes.len() % ALIGNED, 0);
        assert_eq!(bytes[(4 + length).next_multiple_of(ALIGNED)], 1);
    }
}
