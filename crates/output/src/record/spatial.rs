//! What is reported of a body with three axes.

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

/// A cycle of a spatial loop, after its law has decided.
#[derive(Clone, Debug, PartialEq)]
pub struct SpatialCycle {
    /// What the jets do in it.
    pub jets: Jets,
    /// Of thrusters that act by themselves, the on-time of each (s).
    pub thrusters: Vec<f64>,
    /// Propellant of the jets about x, y and z, or of each thruster that acts by itself or may fail (kg).
    pub fuels_kg: Vec<f64>,
    /// How many pulses begin.
    pub pulses: u64,
    /// Energy of the elastic modes (J).
    pub elastic_energy_j: f64,
    /// The same of the modes that the gyro sees (J).
    pub visible_energy_j: f64,
    /// Rigid rates (rad/s).
    pub rigid_rate_rad_s: [f64; 3],
    /// Elastic part of the rates at the gyro (rad/s).
    pub elastic_rate_rad_s: [f64; 3],
    /// Angles beyond the target (rad).
    pub error_rad: [f64; 3],
    /// Whether the target moves from one attitude to another.
    pub slewing: bool,
    /// Wheels about axes of their own.
    pub wheels: Vec<Wheel>,
    /// Magnetic moments of torquers (A m²).
    pub moments_am2: Vec<f64>,
    /// Heat of the friction of wheels since the start (J); not a number without bearings.
    pub friction_heat_j: f64,
    /// Momentum of the wheels and control moment gyros, in the body's axes (N m s).
    pub stored_nm_s: [f64; 3],
    /// What control moment gyros did since the start.
    pub steered: Option<Steered>,
}

/// What control moment gyros did since the start, at the instants at which their gimbal rates change.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Steered {
    /// The largest gimbal rate (rad/s).
    pub largest_rate_rad_s: f64,
    /// The smallest singularity measure.
    pub least_measure: f64,
    /// The largest difference between the torque on the body and the demanded one (N m).
    pub largest_error_nm: f64,
}

impl Steered {
    /// Before the first command.
    pub fn unknown() -> Self {
        Self { largest_rate_rad_s: f64::NAN, least_measure: f64::NAN, largest_error_nm: f64::NAN }
    }
}

/// The motion of a spatial body at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct SpatialMotion {
    /// Attitude.
    pub pointing: Pointing,
    /// Rates.
    pub rates: Rates,
    /// Modes.
    pub vibrations: Vibrations,
    /// Energies.
    pub energy: Energy,
    /// Where it is, if jets or forces push it and its mass is known.
    pub position: Option<Position>,
    /// Torques of actuators that are no jets.
    pub torques: Option<Torques>,
    /// Wheels about axes of their own.
    pub wheels: Option<Wheels>,
    /// Control moment gyros.
    pub gimbals: Option<ControlMomentGyros>,
    /// The bearings of wheels.
    pub bearings: Option<Bearings>,
    /// The drives of its appendages.
    pub drives: Option<DrivesMotion>,
    /// The hinges of its appendages.
    pub hinges: Option<Hinges>,
    /// Where the body is on its orbit.
    pub orbit: Option<Orbit>,
    /// Magnetic moments of torquers.
    pub magnetorquers: Option<Magnetorquers>,
    /// Envelope, if the scenario has an observer.
    pub envelope: Option<Envelope>,
}
