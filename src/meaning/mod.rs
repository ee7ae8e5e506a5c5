//! What the cells of a field mean to the eye: pictures and the page show the same colours, scales,
//! hatches and words, all of which are said here.
//!
//! ```text
//! values and statuses → [gap] which cells show no value → [paint] a scale of the others
//!     → [steps] the colour of each → [legend] entries → [shown] the same as plain data
//! ```
//!
//! - `alike`: stretches of equal neighbours
//! - `colour`: colours, and which class has which
//! - `first`: the field and the axes of a picture where nobody says more
//! - `flags`: the bits of a status in words
//! - `gap`: why a cell shows no value: the rule, its words, and how such cells are filled
//! - `gradient`: colour maps; the only file that imports colorous
//! - `legend`: entries of a legend
//! - `numbers`: numbers and units in texts
//! - `paint`: the rules of scales, where their ends come from, and what lies beyond
//! - `scale`, `ticks`: from values to places, and round values
//! - `shown`: all about the cells of a plane, for the page
//! - `steps`: a scale as stretches of one colour

pub(crate) mod alike;
pub(crate) mod colour;
pub(crate) mod first;
pub(crate) mod flags;
pub(crate) mod gap;
pub(crate) mod gradient;
pub(crate) mod legend;
pub(crate) mod numbers;
pub(crate) mod paint;
pub(crate) mod scale;
pub(crate) mod shown;
pub(crate) mod steps;
pub(crate) mod ticks;
