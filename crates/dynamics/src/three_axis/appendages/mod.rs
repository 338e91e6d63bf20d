//! Flexible body with articulated appendages: turned by drives with known angles over time, or swinging on hinges.
//!
//! With drive angles alpha(t) the kinetic energy about the centre of mass is, to first order in the clamped modes
//! eta,
//!
//! ```text
//! E_k = 1/2 w' (J + J1 eta) w + w' (b0 + b1 eta) + e0 + a1 eta + w' delta eta' + k' eta' + 1/2 eta' E eta',
//! ```
//!
//! Here b0 and b1 are of first order in alpha', e0 and a1 of second, and J, J1, delta and E depend on alpha. Momenta
//! are H = dE_k/dw + sum a h and pi = dE_k/d eta'; with the torque T, H' = T - w x H and pi' = -O² eta - D eta' + dE_k/d eta + f. Q, H, eta and
//! pi are continuous even where alpha jumps. Steps carry them in the free modes of one configuration, q = Y0⁻¹ eta
//! and P = Y0' pi, whose oscillation is exact; the difference of q' from P + phi' G as the panels turn on enters at
//! the stages. A panel on a hinge turns by its own coordinate, and all coefficients depend on that too (`hinge.rs`).

mod configuration;
mod hinge;
mod hinge_forces;
mod modal_basis;
mod projection;
mod stage;

use std::fmt::Debug;
use std::sync::Arc;

use flexsc_numerics::attitude::Vector;
use nalgebra::Matrix3;

use super::body::FlexibleBody;

pub use configuration::Configuration;
pub use hinge::HingeGeometry;
pub use modal_basis::ModalBasis;
pub use stage::{StageForces, StageScratch};

/// Drive angles as functions of time.
pub trait DriveAngles: Debug + Send + Sync {
    /// Returns angle (rad) and rate (rad/s) of a drive at `t` (s) since the start; where the rate jumps, the new one.
    fn at(&self, drive: usize, t: f64) -> [f64; 2];

    /// Returns an upper bound of the drive rates (rad/s).
    fn fastest(&self) -> f64;
}

/// Clamped mode of an appendage, in the axes of the appendage.
#[derive(Clone, Debug, PartialEq)]
pub struct PanelMode {
    /// Natural frequency O with the root held (rad/s).
    pub frequency: f64,
    /// Damping ratio with the root held.
    pub damping: f64,
    /// Participation t in translation (sqrt(kg)).
    pub translation: Vector,
    /// First moments N about the root (sqrt(kg) m).
    pub moments: Matrix3<f64>,
}

/// Appendage with a drive or a hinge, or fixed; in its own axes except for its root.
#[derive(Clone, Debug, PartialEq)]
pub struct ArticulatedPanel {
    /// Mass of the appendage (kg).
    pub mass: f64,
    /// Position of its root, in the body's axes (m).
    pub root: Vector,
    /// Rotation from the panel's axes, with its drive at angle 0, to the body's axes.
    pub axes: Matrix3<f64>,
    /// Centre of mass relative to the root (m).
    pub centre: Vector,
    /// Inertia tensor about its own centre of mass (kg m²).
    pub inertia: Matrix3<f64>,
    /// Clamped modes of the appendage.
    pub modes: Vec<PanelMode>,
    /// Unit vector along the drive axis through the root, and index of the drive; `None` without a drive.
    pub drive: Option<(Vector, usize)>,
    /// Hinge at the root; the panel is then rigid, and its only mode is that of the hinge.
    pub hinge: Option<HingeGeometry>,
}

/// Spacecraft with a rigid hub and appendages that drives and hinges turn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ArticulatedBody {
    /// Mass (kg), centre of mass (m) and inertia tensor about it (kg m²) of the hub, without the spin inertia of the
    /// rotors.
    pub hub: (f64, Vector, Matrix3<f64>),
    /// Appendages, in the order of the modes.
    pub panels: Vec<ArticulatedPanel>,
}

impl ArticulatedBody {
    /// Returns true if any appendage has a drive or a hinge.
    pub fn is_articulated(&self) -> bool {
        self.panels.iter().any(|panel| panel.drive.is_some() || panel.hinge.is_some())
    }

    /// Returns the number of drives.
    pub fn drives(&self) -> usize {
        self.panels.iter().filter(|panel| panel.drive.is_some()).count()
    }

    /// Returns the number of hinges.
    pub fn hinges(&self) -> usize {
        self.panels.iter().filter(|panel| panel.hinge.is_some()).count()
    }

    /// Returns the total mass (kg).
    pub fn mass(&self) -> f64 {
        self.hub.0 + self.panels.iter().map(|panel| panel.mass).sum::<f64>()
    }

    /// Returns the clamped modes of all appendages.
    pub fn modes(&self) -> impl Iterator<Item = &PanelMode> {
        self.panels.iter().flat_map(|panel| &panel.modes)
    }

    /// Returns the frequencies of the free modes at the given drive angles in rad (rad/s), increasing.
    pub fn frequencies(&self, angles: &[f64]) -> Vec<f64> {
        let mut configuration = Configuration::default();
        self.update(|drive| [angles[drive], 0.0], &[], &mut configuration);
        configuration.free_modes(self).map(|free| free.frequencies).unwrap_or_default()
    }

    /// Returns true if a drive or a hinge moves the centre of mass.
    pub fn moves_centre(&self) -> bool {
        self.panels.iter().any(|panel| {
            let axis = panel.drive.map(|(axis, _)| axis).or(panel.hinge.map(|hinge| hinge.about));
            let shift = axis.map_or_else(Vector::zeros, |axis| axis.cross(&panel.centre));
            shift.norm() > 1e-9 * (1.0 + panel.centre.norm())
        })
    }
}

/// Run-time state of the articulated appendages: their angles over time, and the modes in which the state is carried.
#[derive(Clone, Debug)]
pub struct ArticulatedMotion {
    pub(super) body: Arc<ArticulatedBody>,
    pub(super) angles: Arc<dyn DriveAngles>,
    pub(super) basis: ModalBasis,
    /// True if any panel swings on a hinge.
    hinged: bool,
    /// Start of the segment, as time since the start of the run (s).
    pub(super) segment_start: f64,
}

impl ArticulatedMotion {
    /// Creates the appendages in the free modes at the start; `None` if the body has no valid free modes.
    pub fn new(body: Arc<ArticulatedBody>, angles: Arc<dyn DriveAngles>) -> Option<Self> {
        let basis = ModalBasis::initial(&body, &*angles)?;
        let hinged = body.hinges() > 0;
        Some(Self { body, angles, basis, hinged, segment_start: 0.0 })
    }

    /// Computes the configuration at a time `t` since the start (s), with hinges at the displacements `eta` of their
    /// modes.
    pub(super) fn configuration(&self, t: f64, eta: &[f64], configuration: &mut Configuration) {
        self.body.update(|drive| self.angles.at(drive, t), eta, configuration);
    }

    /// Returns true if any panel swings on a hinge.
    pub(super) fn has_hinges(&self) -> bool {
        self.hinged
    }

    /// Returns the body in the modes in which the state is carried.
    pub(super) fn flexible(&self) -> FlexibleBody {
        self.basis.flexible()
    }
}
