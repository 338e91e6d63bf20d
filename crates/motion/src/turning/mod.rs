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
mod bearing;
#[cfg(test)]
mod borne_tests;
mod bounds;
mod common;
mod driven;
mod facing;
mod feel;
mod felt_abreast;
mod flow;
mod free;
mod gimbal;
mod heated;
mod method;
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
pub use bearing::{Bearing, HarmonicLine, Slip};
pub use common::CommonSteps;
pub use driven::{Angles, DrivenPanel, DrivenSpacecraft, Driving, Hinge, PanelMode};
pub use flow::{Acting, FlowEffort, Turning};
pub use free::{ClampedModes, Free};
pub use gimbal::Gimbal;
pub use heated::Heated;
pub use model::{Flexible, FreeMode, Rotor, Surroundings};
pub use pace::SHAKE;
pub use slipping::SlippedRotor;
pub use state::TurningSight;
