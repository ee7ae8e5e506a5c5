//! Answers with many numbers, read as a page reads them.

use serde_json::Value;

use crate::server::Answer;

/// A head, and the arrays that it names.
pub(crate) struct Decoded {
    pub head: Value,
    arrays: Vec<u8>,
}

impl Decoded {
    pub(crate) fn of(answer: &Answer) -> Self {
        let (body, text) = (&answer.body, String::from_utf8_lossy(&answer.body));
        assert_eq!(answer.status, 200, "{text}");
        let length = u32::from_le_bytes(body[..4].try_into().unwrap()) as usize;
        Self {
            head: serde_json::from_slice(&body[4..4 + length]).unwrap(),
            arrays: body[(4 + length).next_multiple_of(8)..].to_vec(),
        }
    }

    /// The numbers of an array of the head.
    pub(crate) fn numbers(&self, array: &Value) -> Vec<f64> {
        let number = |key: &str| array[key].as_u64().unwrap() as usize;
        let at = number("offset");
        let Some(runs) = array["runs"].as_u64() else {
            return self.plain(&array["type"], at, number("length"));
        };
        let runs = runs as usize;
        let values = self.plain(&array["type"], at, runs);
        let size = size_of_kind(&array["type"]);
        let ends = self.plain(&"u32".into(), at + (runs * size).next_multiple_of(8), runs);
        let mut numbers = Vec::new();
        for (value, end) in values.into_iter().zip(ends) {
            numbers.resize(end as usize, value);
        }
        assert_eq!(numbers.len(), number("length"));
        numbers
    }

    fn plain(&self, kind: &Value, at: usize, length: usize) -> Vec<f64> {
        let size = size_of_kind(kind);
        let bytes = self.arrays[at..at + length * size].chunks_exact(size);
        let number = |bytes: &[u8]| match size {
            1 => f64::from(bytes[0]),
            2 => f64::from(u16::from_le_bytes(bytes.try_into().unwrap())),
            4 => f64::from(u32::from_le_bytes(bytes.try_into().unwrap())),
            _ => f64::from_le_bytes(bytes.try_into().unwrap()),
        };
        bytes.map(number).collect()
    }
}

fn size_of_kind(kind: &Value) -> usize {
    match kind.as_str().unwrap() {
        "u8" => 1,
        "u16" => 2,
        "u32" => 4,
        _ => 8,
    }
}
