//! Events, efforts and responses of actuators.

use flexsc_dynamics::three_axis::RotorObservation;
use flexsc_numerics::attitude::Vector;
use flexsc_record::WheelMotion;

/// Event of an actuator other than a command.
#[derive(Copy, Clone, Debug)]
pub enum ActuatorEvent<'a> {
    /// Changes that are due, after the laws have decided, of a body with these rigid rates (rad/s).
    Due([f64; 3]),
    /// Measured magnetic field in the body's axes (T), before the commands that depend on it.
    MagneticField(Vector),
    /// Estimated rate about each axis (rad/s), before the changes that are due.
    EstimatedRate([f64; 3]),
    /// Torque on the body (N m) that wheels or gyros counteract from the next command on.
    CounterTorque(Vector),
    /// State of the rotors in bearings, as computed by the motion.
    Rotors(&'a [RotorObservation]),
    /// Index of the mode of operation from now on, before its first commands.
    Mode(usize),
}

/// Effort of an actuator about an axis.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct AxisEffort {
    /// Torque demanded (N m).
    pub demanded: f64,
    /// Torque held (N m), without a waveform and without back-EMF.
    pub held: f64,
    /// Torque of the pulse of thrusters that is on (N m); 0 of other actuators.
    pub firing: f64,
    /// Reduced moment held (rad/s²), without back-EMF and disregarding failures.
    pub reduced_moment: f64,
}

/// Response of an actuator about an axis to the motion of the body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AxisResponse {
    /// Torque applied (N m).
    pub applied: f64,
    /// Flywheel about the axis, if it stores momentum.
    pub rotor: Option<WheelMotion>,
}
