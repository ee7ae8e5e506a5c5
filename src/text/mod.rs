//! Text that people write and read: numbers, names that are meant, TOML with places.
//!
//! - `document`: a table whose keys are taken one by one, each with its places
//! - `hexadecimal`: bytes as hexadecimal digits
//! - `nearest`: suggestions for unknown names
//! - `number`: numbers as messages show them
//! - `toml_reader`: TOML with the place of every key and value
//! - `toml_size`: bounds the memory for reading TOML
//! - `words`: the letters of names, ASCII or Greek, and which spellings are one name

#[cfg(feature = "sweep")]
pub(crate) mod document;
#[cfg(feature = "sweep")]
mod hexadecimal;
#[cfg(feature = "sweep")]
pub(crate) mod nearest;
mod number;
#[cfg(feature = "sweep")]
pub(crate) mod toml_reader;
#[cfg(feature = "sweep")]
mod toml_size;
#[cfg(feature = "sweep")]
pub(crate) mod words;

#[cfg(feature = "sweep")]
pub use hexadecimal::in_hexadecimal;
pub use number::{Shown, finite, to_digits};
#[cfg(feature = "sweep")]
pub use toml_reader::SpecError;
