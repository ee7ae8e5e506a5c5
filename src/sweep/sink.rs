//! Where the computed pieces of a sweep go.

use super::cells::boundaries::BoundaryPlane;
use super::cells::buffers::TileBuffers;
use super::plan::pieces::Piece;
use crate::answers::best::BestSettings;

/// The place where pieces go. Encoding happens on the computing threads, writing on the thread that
/// called [`run`](super::engine::run).
pub trait Sink {
    /// The encoder of pieces; each thread has its own.
    type Encoder: Encode;
    /// Why writing failed.
    type Error;

    /// A new encoder, for one thread.
    fn encoder(&self) -> Self::Encoder;

    /// Takes a piece. Pieces come in no particular order.
    ///
    /// # Errors
    /// Ends the sweep.
    fn write(
        &mut self,
        piece: Piece,
        encoded: <Self::Encoder as Encode>::Encoded,
    ) -> Result<(), Self::Error>;

    /// Does what is to be done at intervals while no piece comes.
    ///
    /// # Errors
    /// Ends the sweep.
    fn pause(&mut self) -> Result<(), Self::Error> {
        Ok(())
    }

    /// Makes all written pieces durable. The engine calls this at the end of the sweep, even after
    /// an error.
    ///
    /// # Errors
    /// Becomes the error of the sweep, unless it already has one.
    fn flush(&mut self) -> Result<(), Self::Error> {
        Ok(())
    }
}

/// The contents of a computed piece.
#[derive(Debug, Clone, Copy)]
pub enum Computed<'a> {
    /// The curves of a plane.
    Curves(&'a BoundaryPlane),
    /// The best settings of a plane; none where a parameter is outside the model's range.
    Best(Option<&'a BestSettings>),
    /// The cells of a tile.
    Tile(&'a TileBuffers),
}

/// Encodes computed pieces for a sink.
pub trait Encode: Send + 'static {
    /// A piece ready to be written.
    type Encoded: Send + 'static;

    /// Encodes a piece.
    fn encode(&mut self, piece: Piece, computed: Computed) -> Self::Encoded;
}
