//! How a flexible body moves between events, in closed form, and the numbers that this is computed with.
//!
//! Nothing here knows a law, a sensor or a scenario: `flexsc-core` puts them together.
//!
//! - [`State`], [`Stretch`], [`crossing`]: modes in closed form, and the certified search for crossings;
//! - [`linear`]: coupled linear motion by poles and residues; [`turning`]: bodies with three axes;
//! - [`numerics`]: special functions, quadrature, roots; [`lanes`]: the same arithmetic on many runs side by side;
//! - [`time`], [`quantity`], [`random`], [`attitude`], [`guard`], [`waveform`]: instants, valid numbers, seeded streams,
//!   vectors and quaternions, conditions of events, commands as functions of time.
//!
//! Names in brackets, such as \[Likins70\], are sources: `docs/references.md` lists them.

pub mod attitude;
pub mod crossing;
pub mod damping;
pub mod guard;
pub mod guess;
pub mod lanes;
pub mod linear;
pub mod numerics;
pub mod quantity;
pub mod random;
mod state;
pub mod stretch;
pub mod time;
pub mod turning;
pub mod waveform;

pub use state::{Phase, Sensed, State};
pub use stretch::{Expansion, Stretch};
