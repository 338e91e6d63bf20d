//! Motion of a flexible body between events, in closed form, and the numerical methods for it.
//!
//! This crate is independent of laws, sensors and scenarios: `flexsc-core` combines them.
//!
//! - [`AxisState`], [`MotionPiece`], [`crossing`]: modes in closed form, and the certified search for crossings;
//! - [`linear`]: coupled linear motion by poles and residues; [`three_axis`]: three-axis bodies;
//! - [`numerics`]: special functions, quadrature, roots; [`lanes`]: the same arithmetic on many runs in SIMD lanes;
//! - [`time`], [`quantity`], [`random`], [`attitude`], [`guard`], [`waveform`]: instants, validated numbers, seeded
//!   streams, vectors and quaternions, conditions of events, commands as functions of time.
//!
//! Names in brackets, such as \[Likins70\], are sources: `docs/references.md` lists them.

pub mod attitude;
pub mod crossing;
pub mod damping;
pub mod guard;
pub mod lanes;
pub mod linear;
pub mod numerics;
mod one_axis_state;
pub mod polynomial_piece;
pub mod predicted_crossing;
pub mod quantity;
pub mod random;
pub mod three_axis;
pub mod time;
pub mod waveform;

pub use one_axis_state::{AngleObservation, AxisState, ModeState};
pub use polynomial_piece::{MotionPiece, SeriesExpansion};
