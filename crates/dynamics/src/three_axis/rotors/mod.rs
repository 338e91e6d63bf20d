//! Rotors of the body: in bearings with friction and imbalance, and in gimbals.
//!
//! Order of reading: `bearing.rs` (state, friction and imbalance of a rotor), `stick_slip.rs` (which rotors stick at an
//! instant), `zero_crossing.rs` (search for the instant at which one stops or breaks away), `gimbal.rs` (momentum as a
//! known function of time).

pub mod bearing;
pub mod gimbal;
pub mod stick_slip;
mod zero_crossing;

pub use bearing::{Bearing, BearingLoads, HarmonicLine, RotorStage, RotorState, SlipDirection};
pub use gimbal::{Gimbal, GimbalMomentum};
pub use stick_slip::{RotorObservation, change_of_inertia};
