//! Why a picture could not be drawn.

use std::path::PathBuf;

use crate::setting::quantity::Quantity;
use crate::store::StoreError;

/// What went wrong.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// The map could not be read, or the picture could not be written.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The name of the picture does not end in .png, .svg or .pdf.
    #[error("{} is no name for a picture: it must end in .png, .svg or .pdf", path.display())]
    Extension {
        /// The name.
        path: PathBuf,
    },
    /// The picture would replace the file that it shows.
    #[error("the picture would replace {}, which it shows", path.display())]
    OverMap {
        /// The map or trace.
        path: PathBuf,
    },
    /// A stretch of time without two samples.
    #[error("there are no two samples in this stretch of time: the trace ends at t = {last}")]
    NoTime {
        /// When the trace ends.
        last: f64,
    },
    /// Text that leaves no room for what it is about.
    #[error("there is no room for panels beside their numbers, titles and legend")]
    NoRoom,
    /// A width or height outside the allowed range.
    #[error("a picture of {width} × {height} pixels is outside the range: {allowed} each way")]
    Size {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// The range allowed, in words.
        allowed: String,
    },
    /// An invalid range of values.
    #[error("the range {low} to {high} is none: two finite numbers, the smaller one first")]
    Range {
        /// The first.
        low: f64,
        /// The second.
        high: f64,
    },
    /// A logarithmic scale that begins at 0 or below.
    #[error("a logarithmic scale begins above 0, not at {low}")]
    LogRange {
        /// Where it would begin.
        low: f64,
    },
    /// Values that have no logarithm.
    #[error("{field} is {value} in some cells: a logarithmic scale has no place for that")]
    NoLogarithm {
        /// The field.
        field: &'static str,
        /// One of the values.
        value: f64,
    },
    /// A colour map that does not suit the field.
    #[error("{map} does not go with {field}, which {why}")]
    OtherColourMap {
        /// Name of the colour map.
        map: &'static str,
        /// Name of the field.
        field: &'static str,
        /// Why it does not suit.
        why: &'static str,
        /// Names of those that do.
        fitting: String,
    },
    /// An option without a meaning in this picture.
    #[error("{option} has no meaning in this picture: {why}")]
    NotForThis {
        /// The option.
        option: &'static str,
        /// What the picture shows instead.
        why: &'static str,
    },
    /// A name that the user did not choose is taken.
    #[error("{} is there and {holds}", path.display())]
    OthersWork {
        /// The name.
        path: PathBuf,
        /// The contents of the file there.
        holds: String,
    },
    /// No axis has more than one value to show.
    #[error("there is nothing to draw: every axis of the map has one value or is held at one")]
    NothingToDraw,
    /// The map lacks the field.
    #[error("the map does not hold {field}")]
    NoSuchField {
        /// The field.
        field: &'static str,
        /// Names of the fields that it holds.
        held: String,
    },
    /// The map has no crossing curves in the requested plane.
    #[error("the map holds no crossing curves to draw: {why}")]
    NoCurves {
        /// Why not.
        why: &'static str,
    },
    /// A value was given for a parameter that is no axis.
    #[error("{} is no axis of the map", parameter.name())]
    NotAnAxis {
        /// The parameter.
        parameter: Quantity,
        /// Names of the axes.
        axes: String,
    },
    /// A value was given outside an axis.
    #[error("{} = {value} is outside the map: {from} to {to}", parameter.name())]
    OutsideAxis {
        /// The parameter.
        parameter: Quantity,
        /// The value.
        value: f64,
        /// Smallest value of the axis.
        from: f64,
        /// Largest value of the axis.
        to: f64,
    },
    /// Several values were given for more than one axis.
    #[error(
        "several values are asked for of both {} and {}; one of them may have several",
        first.name(),
        second.name()
    )]
    SeveralValues {
        /// One axis.
        first: Quantity,
        /// The other axis.
        second: Quantity,
    },
    /// The picture could not be rendered.
    #[error("cannot render the picture: {0}")]
    Render(String),
}
