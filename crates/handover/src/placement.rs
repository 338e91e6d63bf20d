//! Placements of frames: a rotation and a translation.

use flexsc_core::numerics::attitude::Vector;
use flexsc_core::record::foxglove::{FrameTransform, Pose};
use nalgebra::Quaternion;

/// Name of the body's frame in scenes.
pub const BODY: &str = "body";

/// Pose of a frame in another one: it maps a place p of the frame to `rotation` p + `at` of the other.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Placement {
    /// Rotation.
    pub rotation: Quaternion<f64>,
    /// Origin (m).
    pub at: Vector,
}

impl Placement {
    /// Creates the placement of a frame that coincides with the other.
    pub fn identity() -> Self {
        Self { rotation: Quaternion::new(1.0, 0.0, 0.0, 0.0), at: Vector::zeros() }
    }

    /// Creates the placement of a drawn pose.
    pub fn from_pose(pose: &Pose) -> Self {
        let (at, turned) = (&pose.position, &pose.orientation);
        Self {
            rotation: Quaternion::new(turned.w, turned.x, turned.y, turned.z).normalize(),
            at: Vector::new(at.x, at.y, at.z),
        }
    }

    /// Creates the placement of a frame of a scene in its parent.
    pub fn from_frame(frame: &FrameTransform) -> Self {
        let (at, turned) = (&frame.translation, &frame.rotation);
        Self {
            rotation: Quaternion::new(turned.w, turned.x, turned.y, turned.z).normalize(),
            at: Vector::new(at.x, at.y, at.z),
        }
    }

    /// Returns a direction in the other frame.
    pub fn turn(&self, direction: &Vector) -> Vector {
        let axis = Vector::new(self.rotation.i, self.rotation.j, self.rotation.k);
        let across = 2.0 * axis.cross(direction);
        direction + self.rotation.w * across + axis.cross(&across)
    }

    /// Returns a place in the other frame.
    pub fn apply(&self, place: &Vector) -> Vector {
        self.turn(place) + self.at
    }

    /// Returns the placement of an inner frame, given in this one, in the other frame.
    pub fn then(&self, inner: &Self) -> Self {
        Self { rotation: self.rotation * inner.rotation, at: self.apply(&inner.at) }
    }

    /// Returns the placement of the other frame in this one.
    pub fn inverse(&self) -> Self {
        let back = Self { rotation: self.rotation.conjugate(), at: Vector::zeros() };
        Self { at: -back.turn(&self.at), ..back }
    }
}

/// Returns the placement of a frame of a scene in the body's frame.
pub fn in_body(frames: &[FrameTransform], name: &str) -> Placement {
    let mut placement = Placement::identity();
    let mut name = name;
    while name != BODY {
        let Some(frame) = frames.iter().find(|frame| frame.child_frame_id == name) else { break };
        placement = Placement::from_frame(frame).then(&placement);
        name = &frame.parent_frame_id;
    }
    placement
}
