//! Three-axis dynamics of a flexible body with rotors, with two-way coupling between body and modes.
//!
//! With free modes W, phi, the total angular momentum H about the centre of mass in the body's axes, rotors a h, the
//! change J1 of the inertia and the canonical rates P of the modes, in which torques, rotors and w x H do not appear:
//!
//! ```text
//! G = H - sum a h,   Gt = G - J1(q) w,   w = J^-1 Gt + phi q',   H' = T - w x H,
//! q' = P + phi' Gt,   P' = -W² q - D q' + 1/2 [w' J1_i w] + f.
//! ```
//!
//! The momentum of rotors in gimbals is part of sum a h, a known function of time (`gimbal.rs`).
//!
//! The method (`method.rs`) is Gauss-Legendre of order 6 in mean axes, which preserves |H| and |Q|, with the modes as
//! exact oscillators (\[HairerLubichWanner06\], \[Likins70\]). Steps lie on a grid that depends only on the start of
//! the segment; an instant between grid points is reached by one shorter off-grid step, so that observation does not
//! change the motion.

mod acceleration;
mod appendages;
mod bearing;
#[cfg(test)]
mod bearing_tests;
mod bounds;
mod common;
mod facing;
mod flow;
mod free;
mod gimbal;
mod heated;
mod method;
mod modal_forcing;
mod modal_forcing_lanes;
mod model;
mod node_stages;
mod nodes;
mod pace;
mod response;
mod rotation;
mod settled;
mod shape;
mod slipping;
mod stage;
mod state;
mod step;
mod summed;
#[cfg(test)]
mod tests;
mod vectors;
mod watch;

pub use acceleration::Accelerations;
pub use appendages::{
    ArticulatedBody, ArticulatedMotion, ArticulatedPanel, DriveAngles, HingeGeometry, PanelMode,
};
pub use bearing::{Bearing, HarmonicLine, SlipDirection};
pub use common::SharedSteps;
pub use flow::{SegmentLoads, StepCounts, ThreeAxisMotion};
pub use free::{ClampedModes, FreeModes};
pub use gimbal::Gimbal;
pub use heated::ThermalForces;
pub use model::{FlexibleBody, FreeMode, Rotor, Surroundings};
pub use pace::SHAKE;
pub use slipping::RotorObservation;
pub use state::BodyView;
