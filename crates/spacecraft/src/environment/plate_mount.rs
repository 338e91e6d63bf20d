//! Plates for sunlight and drag, on the hub or on appendages with which they turn.

use flexsc_dynamics::three_axis::PanelPlaces;
use flexsc_numerics::attitude::{Vector, vector};
use flexsc_numerics::quantity::{Finite, Positive};
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

/// Plate with its constants during a run.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MountedPlate {
    /// Appendage with which it turns, if it does.
    mount: Option<PlateMount>,
    /// Unit normal and position (m) in the axes of the appendage that turns, else of the body.
    normal: Vector,
    at: Vector,
    /// Area (m²).
    pub area: f64,
}

impl MountedPlate {
    /// Creates the plate from its normal of any length, its position (m) and its area (m²), on its appendage that `turns` or not.
    pub fn new(
        mount: Option<&PlateMount>,
        [normal, at]: [&[Finite; 3]; 2],
        area: Positive,
        turns: bool,
    ) -> Self {
        let (normal, at, area) = (vector(normal).normalize(), vector(at), area.get());
        match mount {
            Some(mount) if !turns => {
                Self { mount: None, normal: mount.axes * normal, at: mount.root + mount.axes * at, area }
            }
            _ => Self { mount: mount.copied(), normal, at, area },
        }
    }

    /// Returns the unit normal, and the position (m) from the centre of mass, in the body's axes.
    #[inline]
    pub fn place(&self, places: &PanelPlaces<'_>) -> [Vector; 2] {
        let Some(mount) = &self.mount else { return [self.normal, self.at - places.centre] };
        let axes = places.axes.get(mount.panel).unwrap_or(&mount.axes);
        [axes * self.normal, mount.root + axes * self.at - places.centre]
    }

    /// Returns the largest distance (m) of the plate from a point, however its appendage turns.
    pub fn arm(&self, point: &Vector) -> f64 {
        match &self.mount {
            None => (self.at - point).norm(),
            Some(mount) => (mount.root - point).norm() + self.at.norm(),
        }
    }
}
