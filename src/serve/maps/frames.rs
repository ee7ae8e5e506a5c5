//! Messages between the server and a process that reads a map: requests as lines of JSON, answers
//! as frames.
//!
//! ```text
//! number of the request, u64 | kind, u8 | length, u32 | so many bytes      all little-endian
//! ```

use std::io::{self, Read, Write};

use serde::{Deserialize, Serialize};
use utoipa::{IntoParams, ToSchema};

/// The most bytes of an answer.
const LONGEST: u32 = 64 << 20;

/// The status of answers about a damaged map.
const DAMAGED: u16 = 502;

/// The most pixels of a window each way.
pub(super) const MOST_PIXELS: usize = 2048;

/// A request with its number.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Request {
    pub number: u64,
    pub ask: Ask,
}

/// A question about a map.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) enum Ask {
    /// Its description for a list.
    Summary,
    /// Its full description, besides its cells.
    Description,
    /// Its cells in a plane, as pixels.
    Window(WindowQuery),
    /// Its curves in a plane.
    Curves(CurvesQuery),
    /// One cell.
    Cell(CellQuery),
    /// The sweep file's text; of a trace that of its case.
    Sweep,
    /// The motion of a trace.
    Motion,
}

/// A window on a map.
#[derive(Debug, Clone, Serialize, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct WindowQuery {
    /// The field that it shows.
    pub field: String,
    /// The axis from left to right.
    pub x: String,
    /// The axis from bottom to top; a line along `x` without it.
    pub y: Option<String>,
    /// Where it lies along the other axes: `AXIS:INDEX,AXIS:INDEX`; 0 where it does not say.
    #[serde(default)]
    pub at: String,
    /// The value of x at the left edge.
    pub x0: Option<f64>,
    /// The value of x at the right edge.
    pub x1: Option<f64>,
    /// The value of y at the lower edge.
    pub y0: Option<f64>,
    /// The value of y at the upper edge.
    pub y1: Option<f64>,
    /// Pixels from left to right, 1 to 2048.
    pub w: Option<usize>,
    /// Pixels from bottom to top, 1 to 2048.
    pub h: Option<usize>,
    /// How pixels are spread along x.
    #[serde(default)]
    pub xscale: ScaleName,
    /// How they are spread along y.
    #[serde(default)]
    pub yscale: ScaleName,
}

/// How pixels are spread.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "lowercase")]
pub(super) enum ScaleName {
    #[default]
    Linear,
    Log,
}

/// The curves of a plane.
#[derive(Debug, Clone, Serialize, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct CurvesQuery {
    /// The axis from left to right.
    pub x: String,
    /// The axis from bottom to top.
    pub y: String,
    /// Where the plane lies along the other axes, as of a window.
    #[serde(default)]
    pub at: String,
}

/// A cell.
#[derive(Debug, Clone, Serialize, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct CellQuery {
    /// Where: `AXIS:INDEX`, all axes.
    pub at: String,
}

/// The kind of an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Json,
    Text,
    Bytes,
    /// Why there is no answer, in JSON: [`Refused`].
    Problem,
    /// Another map has taken the place of this one; a new process has to be asked.
    OtherMap,
}

impl Kind {
    const ALL: [Self; 5] = [
        Self::Json,
        Self::Text,
        Self::Bytes,
        Self::Problem,
        Self::OtherMap,
    ];
}

/// Why there is no answer.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Refused {
    /// The status of the answer.
    pub status: u16,
    /// Why, in words.
    pub detail: String,
}

impl Refused {
    /// The map lacks what was requested.
    pub(super) fn asked(detail: impl Into<String>) -> Self {
        let status = 422;
        let detail = detail.into();
        Self { status, detail }
    }

    /// The map cannot be read now, whatever the file contains.
    pub(super) fn for_now(detail: impl Into<String>) -> Self {
        let status = 503;
        let detail = detail.into();
        Self { status, detail }
    }

    /// Whether the refusal is about the file, and so holds until the file changes.
    pub(super) fn is_of_file(&self) -> bool {
        self.status == DAMAGED
    }

    /// The map cannot be read.
    pub(super) fn damaged(detail: impl std::fmt::Display) -> Self {
        Self {
            status: DAMAGED,
            detail: format!("{detail}"),
        }
    }
}

/// Checks that an answer of `bytes` bytes can be sent. If not, the client may ask for less.
pub(super) fn fits(bytes: usize) -> Result<(), Refused> {
    match bytes <= LONGEST as usize {
        true => Ok(()),
        false => Err(Refused::asked(format!(
            "the answer would take {} MB, and {} MB are the most",
            bytes.div_ceil(1 << 20),
            LONGEST >> 20
        ))),
    }
}

/// An answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Frame {
    pub kind: Kind,
    pub bytes: Vec<u8>,
}

impl Frame {
    /// Writes an answer; `more` follows its bytes.
    ///
    /// # Errors
    /// When it cannot be written.
    pub(super) fn write(&self, more: &[u8], number: u64, out: &mut impl Write) -> io::Result<()> {
        let length = u32::try_from(self.bytes.len() + more.len()).map_err(io::Error::other)?;
        let mut head = Vec::with_capacity(13);
        head.extend(number.to_le_bytes());
        head.push(self.kind as u8);
        head.extend(length.to_le_bytes());
        out.write_all(&head)?;
        out.write_all(&self.bytes)?;
        out.write_all(more)?;
        out.flush()
    }

    /// The next answer, with the number of its request.
    pub(super) fn read(from: &mut impl Read) -> io::Result<(u64, Self)> {
        let mut head = [0; 13];
        from.read_exact(&mut head)?;
        let number = u64::from_le_bytes(std::array::from_fn(|i| head[i]));
        let length = u32::from_le_bytes(std::array::from_fn(|i| head[9 + i]));
        let kind = Kind::ALL.into_iter().find(|&kind| kind as u8 == head[8]);
        let odd = || io::Error::from(io::ErrorKind::InvalidData);
        let kind = kind.filter(|_| length <= LONGEST).ok_or_else(odd)?;
        // Read without reserving memory for the announced length.
        let mut bytes = Vec::new();
        bytes
            .try_reserve_exact(length as usize)
            .map_err(io::Error::other)?;
        from.take(length.into()).read_to_end(&mut bytes)?;
        match bytes.len() == length as usize {
            true => Ok((number, Self { kind, bytes })),
            false => Err(io::ErrorKind::UnexpectedEof.into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_read_as_they_were_written_and_cut_ones_refused() {
        let mut bytes = Vec::new();
        for (number, kind) in (7..).zip(Kind::ALL) {
            let frame = Frame {
                kind,
                bytes: vec![kind as u8; 10],
            };
            frame.write(&[], number, &mut bytes).unwrap();
        }
        let mut from = &bytes[..];
        for (number, kind) in (7..).zip(Kind::ALL) {
            let (found, frame) = Frame::read(&mut from).unwrap();
            assert_eq!((found, frame.kind, frame.bytes.len()), (number, kind, 10));
        }
        assert!((0..23).all(|end| Frame::read(&mut &bytes[..end]).is_err()));
        assert!(fits(LONGEST as usize).is_ok());
        assert_eq!(fits(LONGEST as usize + 1).unwrap_err().status, 422);
        bytes[8] = 77;
        assert!(Frame::read(&mut &bytes[..]).is_err());
    }
}
