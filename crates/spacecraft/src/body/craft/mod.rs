//! A spacecraft assembled from its parts: a rigid hub, appendages with clamped modes, rotors.
//!
//! [`Spacecraft`] and [`Appendage`] are the forms of a scenario; [`Craft`] is the body in free modes that is assembled
//! from them before a run (`docs/spacecraft.md`).

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

/// Rotor of the hub that turns freely about its axis.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct HubRotor {
    /// Unit vector along the rotor's axis, in the body's axes.
    pub axis: Vector,
    /// Moment of inertia about that axis (kg m²).
    pub spin_inertia: f64,
}

/// Spacecraft assembled from hub and appendages.
#[derive(Clone, Debug, PartialEq)]
pub struct Craft {
    /// Rigid body and free modes, without the action of the modes on the rotation. Positions are from the total centre
    /// of mass.
    pub spatial: Spatial,
    /// Two-way coupling of rotation and modes.
    pub flexible: Flexible,
    /// Total mass (kg).
    pub mass: f64,
    /// Total centre of mass, from the point O (m).
    pub centre: Vector,
    /// Clamped modes in the body's axes, appendage by appendage.
    pub parts: Vec<Part>,
    /// Thermal bending of the appendages.
    pub bendings: Vec<Bending>,
    /// Off-diagonal damping of the free modes, the largest |Dq_ij| W/|W_i² - W_j²|.
    pub damping_coupling: f64,
    /// Hub and appendages with drives and hinges for the integrator; `None` if there are neither.
    pub driven: Option<Arc<DrivenSpacecraft>>,
}
