//! Motion of a flexible body between events, in closed form, and the numerical methods for it.
//!
//! This crate is independent of laws, sensors and scenarios: `flexsc-core` combines them.
//!
//! - [`axis_model`], [`three_axis_model`]: models of a body about one axis and about three;
//! - [`AxisState`], [`MotionPiece`], [`crossing`]: modes in closed form, and the certified search for crossings;
//! - [`linear`]: coupled linear motion by poles and residues; [`three_axis`]: the integrator of three-axis bodies;
//! - [`flow`]: motion between events, about one axis and of modes that do not act back on the body;
//! - [`wrench`]: torques, forces and rotors that act on a body;
//! - [`guard`], [`waveform`]: conditions of events, commands as functions of time.
//!
//! Names in brackets, such as \[Likins70\], are sources: `docs/references.md` lists them.

pub mod axis_model;
pub mod chain_model;
pub mod crossing;
pub mod damping;
pub mod flow;
pub mod frequency_drift;
pub mod guard;
pub mod linear;
mod one_axis_state;
pub mod periodic_torque;
pub mod polynomial_piece;
pub mod predicted_crossing;
pub mod sine;
pub mod three_axis;
pub mod three_axis_model;
pub mod waveform;
pub mod wrench;

pub use one_axis_state::{AngleObservation, AxisState, LARGEST_STATE, ModeState, is_bounded};
pub use polynomial_piece::{MotionPiece, SeriesExpansion};
