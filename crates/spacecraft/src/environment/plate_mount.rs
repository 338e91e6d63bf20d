//! Appendages on which plates are mounted, with which they turn.

use flexsc_numerics::attitude::{Vector, vector};
use flexsc_numerics::quantity::Finite;
use nalgebra::Matrix3;

/// Appendage of a plate.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct PlateMount {
    /// Index of the appendage.
    pub panel: usize,
    /// Position of its root (m), in the body's axes.
    pub root: Vector,
    /// Rotation from its axes, at rest, to the body's.
    pub axes: Matrix3<f64>,
}

/// Appendages of the plates for sunlight and for drag, in their order; `None` of plates on the hub.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlateMounts {
    /// Appendages of the plates for sunlight.
    pub lit: Vec<Option<PlateMount>>,
    /// Appendages of the plates for drag.
    pub braked: Vec<Option<PlateMount>>,
    /// True if appendages turn: plates and the centre of mass then move.
    pub turn: bool,
    /// Largest distance (m) that the centre of mass may move.
    pub centre_shift: f64,
}

/// Mounts of plates with the present rotations of the appendages; those at rest where none turns.
#[derive(Copy, Clone)]
pub(super) struct PlatePlaces<'a> {
    pub mounts: &'a [Option<PlateMount>],
    pub axes: Option<&'a [Matrix3<f64>]>,
}

impl PlatePlaces<'_> {
    /// Returns the unit normal and the position (m) of a plate in the body's axes.
    pub fn place(&self, plate: usize, normal: &[Finite; 3], at: &[Finite; 3]) -> [Vector; 2] {
        let (normal, at) = (vector(normal).normalize(), vector(at));
        let Some(mount) = self.mounts.get(plate).copied().flatten() else { return [normal, at] };
        let axes = self.axes.and_then(|axes| axes.get(mount.panel)).unwrap_or(&mount.axes);
        [axes * normal, mount.root + axes * at]
    }

    /// Returns the largest distance (m) of a plate from a point.
    pub fn arm(&self, plate: usize, at: &[Finite; 3], point: &Vector) -> f64 {
        match self.mounts.get(plate).copied().flatten() {
            None => (vector(at) - point).norm(),
            Some(mount) => (mount.root - point).norm() + vector(at).norm(),
        }
    }
}
