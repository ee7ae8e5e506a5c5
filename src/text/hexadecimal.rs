//! Bytes as hexadecimal digits.

/// Bytes as hexadecimal digits, two for each.
#[must_use]
pub fn in_hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|b| format!("{b:02x}")).collect()
}
