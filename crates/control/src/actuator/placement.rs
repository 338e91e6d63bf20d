//! Actuators on a body: their authority, and their run-time state, from the data resolved for the body.

use flexsc_numerics::quantity::Positive;
use flexsc_numerics::random::Seed;
use flexsc_numerics::time::Span;

use super::{
    Actuator, ActuatorKind, Allocation, AxisActuatorContext, AxisActuators, BackEmfRate, GroupEffect,
    GyroAxes, Jets, PulseWidth, ThrusterEffect, Wheel,
};
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

impl ActuatorKind {
    /// Returns the authority of the actuator about an axis of this inertia (kg m²), acting alone.
    pub fn authority(&self, axis: usize, inertia: f64, on: &ActuatorPlacement<'_>) -> ActuatorAuthority {
        let constant = |most: f64| ActuatorAuthority {
            accelerations: [most; 2],
            width: PulseWidth::default(),
            delay: 0.0,
        };
        match self {
            Self::Ideal(_) | Self::Hold(_) => constant(f64::INFINITY),
            Self::Own(own) => constant(own.limit(axis).map_or(f64::INFINITY, |limit| limit / inertia)),
            Self::Thrusters(thrusters) => ActuatorAuthority {
                width: thrusters.width(),
                ..constant(thrusters.torque.about(axis).get() / inertia)
            },
            Self::Wheel(wheel) => {
                let most = wheel.limit.map_or(f64::INFINITY, Positive::get) * wheel.gain.get() / inertia;
                ActuatorAuthority { delay: wheel.delay.get(), ..constant(most) }
            }
            Self::Wheels(wheels) => {
                let limit = wheels.torque.map_or(f64::INFINITY, Positive::get);
                let most = on.wheels.map_or(f64::INFINITY, |wheels| wheels.largest_torque(axis, limit));
                constant(most / inertia)
            }
            Self::ControlMomentGyros(gyros) => constant(gyros.largest_torque(on.gimbals, axis) / inertia),
            Self::Magnetorquers(torquers) => constant(torquers.largest_moment() * on.field / inertia),
            Self::Jets(jets) => {
                let groups = on.groups.map(|groups| &groups[axis]);
                let of = |sign: usize| groups.map_or(f64::INFINITY, |groups| groups[sign].acceleration);
                let period = jets.period.unwrap_or(on.period);
                ActuatorAuthority {
                    accelerations: [of(0), of(1)],
                    width: jets.pulse_width(),
                    delay: f64::from(jets.delay) * period.seconds(),
                }
            }
        }
    }

    /// Creates the run-time state of the actuator before it first acts, from the setting of each axis.
    pub fn start(&self, settings: Vec<AxisActuatorContext>, on: &ActuatorPlacement<'_>) -> Box<dyn Actuator> {
        match (self, on.groups, on.wheels) {
            (Self::Jets(jets), Some(groups), _) => jets.start((groups, on.nozzles), on.period),
            (Self::Wheels(wheels), _, Some(allocation)) => {
                Box::new(wheels.start(allocation, &settings).with_tachometer(on.tachometer))
            }
            (Self::ControlMomentGyros(gyros), ..) => Box::new(gyros.start(on.gimbals, &settings)),
            (Self::Magnetorquers(torquers), ..) => Box::new(torquers.start(&settings)),
            (Self::Own(own), ..) => own.start(&settings),
            (kind, ..) => Box::new(AxisActuators::new(kind, settings)),
        }
    }

    /// Returns the linear path of commands through the actuator, if it acts linearly up to its limits.
    pub fn linear_drive(&self) -> Option<LinearDrive<'_>> {
        match self {
            Self::Ideal(_) => Some(LinearDrive {
                gain: 1.0,
                back_emf: 0.0,
                opposes_body_rate: true,
                delay: 0.0,
                wheel: None,
            }),
            Self::Wheel(wheel) => Some(LinearDrive {
                gain: wheel.gain.get(),
                back_emf: wheel.back_emf.get(),
                opposes_body_rate: wheel.opposes == BackEmfRate::BodyRate,
                delay: wheel.delay.get(),
                wheel: Some(wheel),
            }),
            _ => None,
        }
    }

    /// Returns the linear response to commands; `None` for an actuator that is not linear.
    pub fn command_response(&self) -> Option<CommandResponse> {
        if let Self::Wheels(_) = self {
            return Some(CommandResponse { gain: 1.0, delay: 0.0 });
        }
        self.linear_drive().map(|drive| CommandResponse { gain: drive.gain, delay: drive.delay })
    }

    /// Returns the torque per unit of a command (N m), of an actuator whose commands are not torques.
    pub fn command_gain(&self) -> Option<f64> {
        if let Self::Wheel(wheel) = self { Some(wheel.gain.get()) } else { None }
    }

    /// Returns the jets, if the actuator consists of them.
    pub fn jets(&self) -> Option<&Jets> {
        if let Self::Jets(jets) = self { Some(jets) } else { None }
    }
}
