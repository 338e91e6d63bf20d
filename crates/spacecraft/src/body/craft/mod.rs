//! A spacecraft assembled from its parts: a rigid hub, appendages with clamped modes, rotors.
//!
//! [`Spacecraft`] and [`Appendage`] are the forms of a scenario; [`AssembledSpacecraft`] is the body in free modes that is assembled
//! from them before a run (`docs/theory/modes.md`).

mod appendage;
mod assembly;
mod axes_orientation;
mod clamped;
mod craig_bampton;
mod drive;
mod fe_results;
mod fe_units;
mod free_damping;
mod hinge;
mod mass;
mod mount;
mod plate;
mod rate_limit;
mod spacecraft;
mod thermal;
mod translation;
mod validation;

use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_numerics::attitude::Vector;

pub use appendage::Appendage;
pub use assembly::ClampedModeInBody;
pub use axes_orientation::{AxesOrientation, AxisRotation};
pub use clamped::ClampedMode;
pub use craig_bampton::CraigBampton;
pub use drive::{AppendageDrive, DrivePiece, DrivePoint, TrackedObject};
pub use fe_units::FileUnits;
pub use hinge::Hinge;
pub use mount::Mount;
pub use plate::{Plate, PlateAxis, UniformPlate};
pub use rate_limit::RateLimit;
pub use spacecraft::Spacecraft;
pub use thermal::{Bending, Thermal};
pub use translation::Translation;

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
pub struct AssembledSpacecraft {
    /// Body in free modes, with drives and hinges at their initial angles. Positions are from the total centre of mass.
    pub model: ThreeAxisModel,
    /// Total mass (kg).
    pub mass: f64,
    /// Total centre of mass, from the point O (m).
    pub centre: Vector,
    /// Clamped modes in the body's axes, appendage by appendage.
    pub parts: Vec<ClampedModeInBody>,
    /// Thermal bending of the appendages.
    pub bendings: Vec<Bending>,
    /// Off-diagonal damping of the free modes, the largest |Dq_ij| W/|W_i² - W_j²|.
    pub damping_coupling: f64,
}
