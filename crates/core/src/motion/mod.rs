//! How a body moves between events.

pub mod crossing;
pub(crate) mod guess;
pub mod linear;
mod state;
pub mod stretch;
pub mod turning;

pub use state::{Phase, Sensed, State};
pub use stretch::{Expansion, Stretch};
