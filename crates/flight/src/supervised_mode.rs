//! Mode of operation under a supervisor, and the change of the target from one mode to the next.

use crate::quaternion::Quaternion;
use crate::ticks::Ticks;
use crate::vector3::Vector3;

/// Mode of operation in the list of modes.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SupervisedMode {
    /// Period at which its conditions are tested.
    pub period: Ticks,
    /// Index of its first end.
    pub first_exit: usize,
    /// Number of its ends, which follow each other.
    pub exit_count: usize,
    /// Number of times that it was entered.
    pub entries: u64,
}

/// Change of the target at a change of the mode: the angle goes on from the target before to that of the next step.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct TargetChange {
    /// True from the change on to the next step.
    pub is_pending: bool,
    /// Angle from the target before, at the change (rad).
    pub angle: Vector3,
    /// Target before.
    pub target: Quaternion,
}

impl TargetChange {
    /// Before the first change.
    pub const NONE: Self = Self { is_pending: false, angle: Vector3::ZERO, target: Quaternion::IDENTITY };

    /// Begins a change from a target and an angle from it (rad).
    pub fn begin(&mut self, target: &Quaternion, angle: &Vector3) {
        self.is_pending = true;
        self.angle = *angle;
        self.target = *target;
    }

    /// Returns the angle (rad) of an attitude from a target, and ends a change to this target: then the angle is that at the change,
    /// and the rotation from one target to the other.
    pub fn angle_from(&mut self, target: &Quaternion, attitude: &Quaternion) -> Vector3 {
        if !self.is_pending {
            return target.rotation_to(attitude);
        }
        self.is_pending = false;
        let rotation: Vector3 = target.rotation_to(&self.target);
        self.angle.plus(&rotation)
    }
}
