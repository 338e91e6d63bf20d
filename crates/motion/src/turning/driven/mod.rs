//! A flexible body whose appendages are turned by drives, their angles known as functions of time, or swing on hinges.
//!
//! With alpha(t) the kinetic energy about the centre of mass is, to first order in the clamped modes eta,
//!
//! ```text
//! T = 1/2 w' (J + J1 eta) w + w' (b0 + b1 eta) + e0 + a1 eta + w' delta eta' + k' eta' + 1/2 eta' E eta',
//! ```
//!
//! in which b0 and b1 are of first order in alpha', e0 and a1 of second, and J, J1, delta and E depend on alpha. Momenta
//! are H = dT/dw + sum a h and pi = dT/d eta'; H' = T - w x H, pi' = -O² eta - D eta' + dT/d eta + f. Q, H, eta and pi are
//! continuous whatever alpha does. Steps carry them in the free modes of one angle, q = Y0⁻¹ eta and P = Y0' pi, whose
//! oscillation is exact; by how much q' differs from P + phi' G as the panels turn on is part of what the stages feel.
//! A panel on a hinge turns by its own coordinate, and all coefficients depend on that too (`hinged.rs`).

mod basis;
mod hinged;
mod posed;
mod seen;
mod stage;

use std::fmt::Debug;
use std::sync::Arc;

use nalgebra::Matrix3;

use super::model::Flexible;
use crate::attitude::Vector;

pub(super) use basis::Basis;
pub use hinged::Hinge;
pub(super) use posed::Posed;
pub(super) use stage::{Pulls, Scratch};

/// The angles of drives as functions of time.
pub trait Angles: Debug + Send + Sync {
    /// Angle (rad) and rate (rad/s) of a drive so many seconds after the start. At an instant at which the rate jumps, the new
    /// one.
    fn at(&self, drive: usize, t: f64) -> [f64; 2];

    /// No drive is faster (rad/s).
    fn fastest(&self) -> f64;
}

/// A clamped mode of an appendage, in the axes of the appendage.
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

/// An appendage, in its own axes but for its place.
#[derive(Clone, Debug, PartialEq)]
pub struct DrivenPanel {
    /// Mass (kg).
    pub mass: f64,
    /// Where its root is, in the body's axes (m).
    pub root: Vector,
    /// Turns vectors of its axes, with its drive at 0, into those of the body.
    pub axes: Matrix3<f64>,
    /// Centre of mass from the root (m).
    pub centre: Vector,
    /// Inertia tensor about its centre of mass (kg m²).
    pub inertia: Matrix3<f64>,
    /// Its modes.
    pub modes: Vec<PanelMode>,
    /// Unit vector along the axis of its drive through the root, and which of the drives it is, if it has one.
    pub drive: Option<(Vector, usize)>,
    /// The hinge at its root on which it swings, if it does; it then is rigid, and its only mode is that of the hinge.
    pub hinge: Option<Hinge>,
}

/// A spacecraft as its drives turn it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DrivenSpacecraft {
    /// Mass (kg), centre (m) and inertia tensor about it (kg m²) of the hub, without what rotors have about their axes.
    pub hub: (f64, Vector, Matrix3<f64>),
    /// The appendages, in the order of the modes.
    pub panels: Vec<DrivenPanel>,
}

impl DrivenSpacecraft {
    /// Whether anything turns.
    pub fn turns(&self) -> bool {
        self.panels.iter().any(|panel| panel.drive.is_some() || panel.hinge.is_some())
    }

    /// How many drives there are.
    pub fn drives(&self) -> usize {
        self.panels.iter().filter(|panel| panel.drive.is_some()).count()
    }

    /// How many hinges there are.
    pub fn hinges(&self) -> usize {
        self.panels.iter().filter(|panel| panel.hinge.is_some()).count()
    }

    /// Total mass (kg).
    pub fn mass(&self) -> f64 {
        self.hub.0 + self.panels.iter().map(|panel| panel.mass).sum::<f64>()
    }

    /// The clamped modes of all appendages.
    pub fn modes(&self) -> impl Iterator<Item = &PanelMode> {
        self.panels.iter().flat_map(|panel| &panel.modes)
    }

    /// The frequencies of the free modes with drives at these angles (rad/s), increasing.
    pub fn frequencies(&self, angles: &[f64]) -> Vec<f64> {
        let mut posed = Posed::default();
        self.pose(|drive| [angles[drive], 0.0], &[], &mut posed);
        posed.free(self).map(|free| free.frequencies).unwrap_or_default()
    }

    /// Whether a drive or a hinge moves the centre of mass.
    pub fn moves_centre(&self) -> bool {
        self.panels.iter().any(|panel| {
            let axis = panel.drive.map(|(axis, _)| axis).or(panel.hinge.map(|hinge| hinge.about));
            let moved = axis.map_or_else(Vector::zeros, |axis| axis.cross(&panel.centre));
            moved.norm() > 1e-9 * (1.0 + panel.centre.norm())
        })
    }
}

/// Drives at work: how they turn, and the modes in which the state is carried now.
#[derive(Clone, Debug)]
pub struct Driving {
    pub(super) of: Arc<DrivenSpacecraft>,
    pub(super) angles: Arc<dyn Angles>,
    pub(super) basis: Basis,
    /// Whether any panel swings on a hinge.
    swings: bool,
    /// Seconds from the start to the departure.
    pub(super) began: f64,
}

impl Driving {
    /// Drives of a body that is `flexible` with their angles of the start: the modes in which it is written.
    pub fn new(of: Arc<DrivenSpacecraft>, angles: Arc<dyn Angles>) -> Option<Self> {
        let basis = Basis::first(&of, &*angles)?;
        let swings = of.hinges() > 0;
        Some(Self { of, angles, basis, swings, began: 0.0 })
    }

    /// The body as it is at a time since the start (s), with hinges turned by these displacements of the clamped modes.
    pub(super) fn posed(&self, t: f64, eta: &[f64], posed: &mut Posed) {
        self.of.pose(|drive| self.angles.at(drive, t), eta, posed);
    }

    /// Whether any panel swings on a hinge.
    pub(super) fn swings(&self) -> bool {
        self.swings
    }

    /// The body in the modes in which it is carried.
    pub(super) fn flexible(&self) -> Flexible {
        self.basis.flexible()
    }
}
