//! Signals over time as sequences of pieces, each a constant or a polynomial: their minimum, and that over a sliding window.
//!
//! A signal is right-continuous: a piece has its start and not its end. Windows are closed.

mod fit;
mod piece;
mod sliding;

pub use fit::fit;
pub use piece::{Curve, PieceValues, SignalPiece, Witnessed};
pub use sliding::SlidingMinimum;
