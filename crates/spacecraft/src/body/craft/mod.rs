//! A spacecraft from its parts: a rigid hub, appendages known by their clamped modes, rotors.
//!
//! [`Spacecraft`] and [`Appendage`] are what a scenario writes, [`Craft`] is what they come to before anything moves: one body in
//! free modes (`docs/spacecraft.md`).

mod appendage;
mod assembly;
mod check;
mod clamped;
mod damping;
mod drive;
mod hinge;
mod limit;
mod mass;
mod moving;
mod results;
mod spacecraft;
mod thermal;
mod turned;

use std::sync::Arc;

use crate::attitude::Vector;
use crate::body::Spatial;
use crate::motion::turning::{DrivenSpacecraft, Flexible};

pub use appendage::{Appendage, Plate};
pub use assembly::Part;
pub use clamped::ClampedMode;
pub use drive::{Drive, DrivePoint, Piece, Track};
pub use hinge::Hinge;
pub use limit::Limit;
pub use moving::Moving;
pub use results::Units;
pub use spacecraft::Spacecraft;
pub use thermal::{Bending, Thermal};
pub use turned::{Turn, Turned};

/// A rotor of the hub that turns freely about its axis.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct HubRotor {
    /// Unit vector along its axis, in the body's axes.
    pub axis: Vector,
    /// Moment of inertia about that axis (kg m²).
    pub spin_inertia: f64,
}

/// A spacecraft as it moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Craft {
    /// Its rigid body and its free modes, which do not act back on it. Positions are from the total centre of mass.
    pub spatial: Spatial,
    /// The coupling of its rotation and its modes in both directions.
    pub flexible: Flexible,
    /// Total mass (kg).
    pub mass: f64,
    /// Total centre of mass, from the point O (m).
    pub centre: Vector,
    /// The clamped modes as the hub sees them, appendage by appendage.
    pub parts: Vec<Part>,
    /// Thermal bending of its appendages.
    pub bendings: Vec<Bending>,
    /// Off-diagonal damping of the free modes, the largest |Dq_ij| W/|W_i² - W_j²|.
    pub damping_coupling: f64,
    /// The same parts as drives and hinges turn them, if any does.
    pub driven: Option<Arc<DrivenSpacecraft>>,
}
