//! Values of a three-axis body that metrics and figures read, and that no log has.

use super::AttitudeEstimate;

impl AttitudeEstimate {
    /// Number of states: attitude and bias.
    pub const STATES: f64 = 6.0;
    /// Number of measurements of an attitude; the NIS of a direction is scaled to it.
    pub const MEASUREMENTS: f64 = 3.0;
}

/// Start of a mode of operation with a target.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct ModeTargetStart {
    /// Index of the mode.
    pub mode: usize,
    /// Angle of the rotation from the target to the attitude of the body (rad).
    pub distance: f64,
}

/// Stay in a mode of operation with one target.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct TargetVisit {
    /// Index of the mode; 0 without modes.
    pub mode: usize,
    /// Number of changes of the mode before.
    pub changes: u64,
    /// Number of the target in the sequence.
    pub target: usize,
}

/// Motion of a three-axis body at the start of a cycle, after its law has decided.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ThreeAxisCycle {
    /// Mode of operation and target of the cycle.
    pub visit: TargetVisit,
    /// Energy of the elastic modes (J).
    pub elastic_energy_j: f64,
    /// Energy of the elastic modes visible to the gyro (J).
    pub visible_energy_j: f64,
    /// Rigid rates (rad/s).
    pub rigid_rate_rad_s: [f64; 3],
    /// Elastic part of the rates at the gyro (rad/s).
    pub elastic_rate_rad_s: [f64; 3],
    /// Angles relative to the target (rad).
    pub error_rad: [f64; 3],
    /// Whether the target moves from one attitude to another.
    pub slewing: bool,
    /// Heat of the wheels' friction since the start (J); NaN without bearings.
    pub friction_heat_j: f64,
    /// Momentum of the wheels and control moment gyros, in the body's axes (N m s).
    pub stored_momentum_nm_s: [f64; 3],
}

/// Extreme values of control moment gyros since the start, at the instants at which their gimbal rates change.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SteeringRecord {
    /// Largest gimbal rate from the last change on (rad/s).
    pub rate_rad_s: f64,
    /// Largest gimbal rate (rad/s).
    pub largest_rate_rad_s: f64,
    /// Smallest singularity measure.
    pub least_measure: f64,
    /// Largest difference between the torque on the body and the demanded torque (N m).
    pub largest_error_nm: f64,
}

impl SteeringRecord {
    /// Creates the values before the first command, all NaN.
    pub fn unknown() -> Self {
        Self {
            rate_rad_s: f64::NAN,
            largest_rate_rad_s: f64::NAN,
            least_measure: f64::NAN,
            largest_error_nm: f64::NAN,
        }
    }
}
