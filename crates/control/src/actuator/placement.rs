//! Actuators on a body: the resolved data that they depend on, their authority, and their response to commands.

use flexsc_flight_precision::Precision;
use flexsc_numerics::random::Seed;
use flexsc_numerics::time::Span;

use super::{Allocation, GroupEffect, GyroAxes, PulseWidth, ThrusterEffect, Wheel};
use crate::sensor::Tachometer;

/// Data of a body that an actuator on it depends on.
#[derive(Copy, Clone, Debug)]
pub struct ActuatorPlacement<'a> {
    /// Allocation of a torque to reaction wheels.
    pub wheels: Option<&'a Allocation>,
    /// Axes of control moment gyros with the gimbals at angle 0.
    pub gimbals: &'a [GyroAxes],
    /// Largest magnetic field (T).
    pub field: f64,
    /// Effect of each group of jets: about each axis, plus and minus.
    pub groups: Option<&'a [[GroupEffect; 2]; 3]>,
    /// Effect of each thruster of jets.
    pub nozzles: &'a [ThrusterEffect],
    /// Period of jets without one of their own.
    pub period: Span,
    /// Tachometer of the reaction wheels, with the seed of its noise.
    pub tachometer: Option<(&'a Tachometer, Seed)>,
    /// Precision of the flight computer.
    pub precision: Precision,
}

/// Authority of one actuator about an axis, acting alone.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ActuatorAuthority {
    /// Largest accelerations in the positive and the negative direction (rad/s²); infinite without a limit.
    pub accelerations: [f64; 2],
    /// Quantisation of the pulse lengths.
    pub width: PulseWidth,
    /// Time from a command to its execution (s).
    pub delay: f64,
}

impl ActuatorAuthority {
    /// Creates the authority of an actuator without pulses or delay, with this largest acceleration in both directions (rad/s²).
    pub fn constant(most: f64) -> Self {
        Self { accelerations: [most; 2], width: PulseWidth::default(), delay: 0.0 }
    }
}

/// Path from a command to the torque of an actuator that acts linearly up to its limits.
#[derive(Copy, Clone, Debug)]
pub struct LinearDrive<'a> {
    /// Torque per unit of the command (N m).
    pub gain: f64,
    /// Back-EMF torque per unit of the rate (N m s).
    pub back_emf: f64,
    /// True if the back-EMF opposes the rate of the elastic body, not the rigid one.
    pub opposes_body_rate: bool,
    /// Time from a command to its execution (s).
    pub delay: f64,
    /// Wheel that shapes the commands, if there is one.
    pub wheel: Option<&'a Wheel>,
}

/// Linear response of an actuator to commands, up to its limits, without the motion of the body.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct CommandResponse {
    /// Torque per unit of the command (N m).
    pub gain: f64,
    /// Time from a command to its execution (s).
    pub delay: f64,
}
