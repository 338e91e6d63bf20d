//! Samples of a three-axis body.

use super::{
    AttitudeEstimate, Bearings, ControlMomentGyros, DrivesMotion, Energy, Envelope, Hinges, Jets,
    Magnetorquers, Orbit, Pointing, Position, Rates, Torques, Vibrations, Wheel, Wheels,
};

impl AttitudeEstimate {
    /// Number of states: attitude and bias.
    pub const STATES: f64 = 6.0;
    /// Number of measurements of an attitude; the NIS of a direction is scaled to it.
    pub const MEASUREMENTS: f64 = 3.0;
}

/// Cycle of a three-axis loop, after its law has decided.
#[derive(Clone, Debug, PartialEq)]
pub struct ThreeAxisCycle {
    /// Pulses of the jets in the cycle.
    pub jets: Jets,
    /// On-time of each thruster (s), if thrusters are commanded individually.
    pub thrusters: Vec<f64>,
    /// Propellant of the jets about x, y and z, or of each thruster that acts by itself or may fail (kg).
    pub fuels_kg: Vec<f64>,
    /// Number of pulses that begin.
    pub pulses: u64,
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
    /// Wheels about axes of their own.
    pub wheels: Vec<Wheel>,
    /// Magnetic moments of torquers (A m²).
    pub moments_am2: Vec<f64>,
    /// Heat of the wheels' friction since the start (J); NaN without bearings.
    pub friction_heat_j: f64,
    /// Momentum of the wheels and control moment gyros, in the body's axes (N m s).
    pub stored_nm_s: [f64; 3],
    /// Extreme values of control moment gyros since the start.
    pub steered: Option<SteeringRecord>,
}

/// Extreme values of control moment gyros since the start, at the instants at which their gimbal rates change.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SteeringRecord {
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
        Self { largest_rate_rad_s: f64::NAN, least_measure: f64::NAN, largest_error_nm: f64::NAN }
    }
}

/// Motion of a spatial body at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct ThreeAxisMotionSample {
    /// Attitude of the body.
    pub pointing: Pointing,
    /// Rates of the body.
    pub rates: Rates,
    /// Motion of the elastic modes.
    pub vibrations: Vibrations,
    /// Energies of rotation and modes.
    pub energy: Energy,
    /// Position, if jets or forces act on the body and its mass is known.
    pub position: Option<Position>,
    /// Torques of actuators other than jets.
    pub torques: Option<Torques>,
    /// Wheels about axes of their own.
    pub wheels: Option<Wheels>,
    /// Control moment gyros of the spacecraft.
    pub gimbals: Option<ControlMomentGyros>,
    /// Bearings of the wheels.
    pub bearings: Option<Bearings>,
    /// Drives of the appendages.
    pub drives: Option<DrivesMotion>,
    /// Hinges of the appendages.
    pub hinges: Option<Hinges>,
    /// Position of the body on its orbit.
    pub orbit: Option<Orbit>,
    /// Magnetic moments of the torquers.
    pub magnetorquers: Option<Magnetorquers>,
    /// Envelope of the modes, if the scenario has an observer.
    pub envelope: Option<Envelope>,
}
