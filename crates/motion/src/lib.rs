//! Motion of a flexible body between events, in closed form, and the numerical methods for it.
//!
//! This crate is independent of laws, sensors and scenarios: `flexsc-core` combines them.
//!
//! - [`State`], [`Stretch`], [`crossing`]: modes in closed form, and the certified search for crossings;
//! - [`linear`]: coupled linear motion by poles and residues; [`turning`]: three-axis bodies;
//! - [`numerics`]: special functions, quadrature, roots; [`lanes`]: the same arithmetic on many runs in SIMD lanes;
//! - [`time`], [`quantity`], [`random`], [`attitude`], [`guard`], [`waveform`]: instants, validated numbers, seeded
//!   streams, vectors and quaternions, conditions of events, commands as functions of time.
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
