//! Actuators: how commands are executed, as they are, through a hold, by a wheel, or by pulses of thrusters.

mod allocated;
mod allocation;
mod assigned;
mod control_moment_gyros;
mod failure;
mod friction;
mod gimbals;
mod hold;
mod ideal;
mod imbalance;
mod impaired;
mod jets;
mod magnetorquers;
mod member;
mod per_wheel;
mod pulse_timing;
mod pulse_width;
mod pulsing;
mod saturation;
mod several;
mod spinning;
mod steering;
mod thrusters;
mod torquers;
mod unloading;
mod valves;
mod wheel;
mod wheels;

use std::any::Any;
use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::attitude::Vector;
use crate::motion::turning::SlippedRotor;
use crate::own::{Halt, Own};
use crate::quantity::{Share, Time};
use crate::record::{self, Steered, WheelMotion};
use crate::time::{Instant, Span};
use crate::wrench::Wrench;

pub use allocated::Allocated;
pub use allocation::{Allocation, Choice};
pub use assigned::Assigned;
pub use control_moment_gyros::{ControlMomentGyros, GimbalArrangement};
pub use failure::{Failure, Lasting};
pub use friction::Friction;
pub use gimbals::Gimbals;
pub use hold::ZeroOrderHold;
pub use ideal::Ideal;
pub use imbalance::{Harmonic, Imbalance};
pub use jets::{Firing, FiringGroup, Groups, Jets, OpenThruster, Pair, Thruster};
pub use magnetorquers::{Magnetorquers, Torquing};
pub use member::{ActuatorMember, ActuatorTask};
pub use per_wheel::PerWheel;
pub use pulse_timing::PulseTiming;
pub use pulse_width::PulseWidth;
pub use pulsing::{Pulse, Pulsing};
pub use saturation::{EndState, Saturation};
pub use several::Several;
pub use spinning::Spinning;
pub use steering::{GyroAxes, NullMotion, Robustness, Steering};
pub use thrusters::Thrusters;
pub use torquers::{AxisActuate, TorquerSetting, Torquers};
pub use unloading::{Unloading, Unloads};
pub use wheel::{Opposes, Rotor, Wheel};
pub use wheels::{Arrangement, Compensation, SpeedBias, Wheels};

/// The kinds of actuator. On a body with three axes, an actuator for one angle acts about each of them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Actuator {
    /// The command itself, at every instant.
    Ideal(Ideal),
    /// A zero-order hold: the mean of the manoeuvre's command over each period, and the feedback at its start.
    Hold(ZeroOrderHold),
    /// One pulse of full torque per period, centred in it, with the same impulse as a zero-order hold.
    Thrusters(Thrusters),
    /// A flywheel on a motor with back-EMF.
    Wheel(Wheel),
    /// Reaction wheels about axes of their own.
    Wheels(Wheels),
    /// Control moment gyros of a spacecraft.
    ControlMomentGyros(ControlMomentGyros),
    /// Thrusters at points of a spatial body.
    Jets(Jets),
    /// Magnetorquers of a spatial body in the field of its planet.
    Magnetorquers(Magnetorquers),
    /// An actuator from another crate; a scenario file cannot name it.
    Own(Own<dyn Effector>),
}

/// What is demanded of an actuator about an axis.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum Demand {
    /// A torque (N m), or reduced moment (rad/s²) on a body without inertia; of a wheel, units of its command.
    Torque(f64),
    /// A change of the rigid rate within the law's period (rad/s): the actuator makes a pulse of it.
    Change(f64),
    /// A magnetic moment along the axis (A m²), of torquers.
    Moment(f64),
}

/// What an actuator from outside tells of itself before a run.
pub trait Effector: Send + Sync {
    /// The actuator at work, in the setting of each axis.
    fn start(&self, settings: &[TorquerSetting]) -> Box<dyn Actuate>;

    /// Its largest torque about an axis (N m); none without a limit.
    fn limit(&self, _axis: usize) -> Option<f64> {
        None
    }

    /// What it is, for the program that brought it.
    fn any(&self) -> Option<&dyn Any> {
        None
    }
}

/// An actuator at work.
pub trait Actuate: fmt::Debug + Send + Sync {
    /// Takes over what is demanded from now on about each axis, of a body that turns at these rigid rates (rad/s).
    fn command(&mut self, now: Instant, demands: &[Demand], rigid: [f64; 3]);

    /// Takes over the magnetic field in the body's axes (T) as it is measured, before what follows from it.
    fn feel(&mut self, _field: Vector) {}

    /// Makes wheels hold against a torque on the body (N m) from the next command on.
    fn hold_against(&mut self, _torque: Vector) {}

    /// The next instant at which what it exerts changes by itself.
    fn due(&self) -> Option<Instant> {
        None
    }

    /// Does what is due now, after the laws have decided.
    fn serve(&mut self, _now: Instant, _rigid: [f64; 3]) {}

    /// Takes over how its rotors in bearings are now, which the motion tells.
    fn turned(&mut self, _now: Instant, _rotors: &[SlippedRotor]) {}

    /// Adds what it exerts from now on.
    fn exert(&self, now: Instant, onto: &mut Wrench);

    /// The torque that is asked for about an axis (N m).
    fn asked(&self, axis: usize) -> f64;

    /// The torque that it holds about an axis (N m), without a waveform and without back-EMF.
    fn torque(&self, axis: usize) -> f64;

    /// The torque that it gives about an axis (N m), of a body that turns at this rate and this rigid rate (rad/s).
    fn applied(&self, _now: Instant, axis: usize, _rates: [f64; 2]) -> f64 {
        self.torque(axis)
    }

    /// The reduced moment about an axis (rad/s²) that it holds, without what a rate takes from it.
    fn moment(&self, axis: usize) -> f64;

    /// What its waveform adds to the rate about the first axis from one time to another (s), in rad/s.
    fn waveform_impulse(&self, _from: f64, _to: f64) -> f64 {
        0.0
    }

    /// Back-EMF for each unit of the rate about the first axis (N m s), and whether it is that of the elastic body.
    fn back_emf(&self) -> (f64, bool) {
        (0.0, false)
    }

    /// The wheel about an axis, if there is one that stores momentum, of a body that turns at this rigid rate (rad/s).
    fn wheel(&self, _axis: usize, _rigid_rate: f64) -> Option<WheelMotion> {
        None
    }

    /// Wheels about axes of their own, of a body that turns at this rate (rad/s).
    fn wheels(&self, _now: Instant, _rate: [f64; 3]) -> Vec<record::Wheel> {
        Vec::new()
    }

    /// Control moment gyros, if it consists of them.
    fn gimbals(&self, _now: Instant) -> Option<record::ControlMomentGyros> {
        None
    }

    /// What control moment gyros did since the start.
    fn steered(&self) -> Option<Steered> {
        None
    }

    /// The magnetic moments that it holds, of torquers.
    fn magnetic(&self) -> Option<record::Magnetorquers> {
        None
    }

    /// Speeds of wheels in bearings as their drives know them (rad/s).
    fn known_speeds(&self) -> Vec<f64> {
        Vec::new()
    }

    /// The angular momentum that its rotors store now, as far as it is known, in the body's axes (N m s).
    fn stored(&self, _now: Instant) -> [f64; 3] {
        [0.0; 3]
    }

    /// Of jets, the cycle of pulses that has begun.
    fn cycle(&self) -> Option<JetCycle> {
        None
    }

    /// Of jets, the pulses of the cycle that has begun.
    fn executed(&self) -> Option<Vec<Pulse>> {
        None
    }

    /// Of jets, what the pulses of this cycle turn the body by, all together (N m s).
    fn impulse(&self) -> Vector {
        Vector::zeros()
    }

    /// Changes of the rigid rates by commands that are not yet executed (rad/s).
    fn queued(&self) -> [f64; 3] {
        [0.0; 3]
    }

    /// The pulses that wait for the cycle that begins.
    fn waiting(&self) -> Vec<Pulse> {
        Vec::new()
    }

    /// Why it cannot go on, of one from outside that cannot: the run ends there.
    fn halted(&self) -> Option<Halt> {
        None
    }

    /// A copy in the same state.
    fn copy(&self) -> Box<dyn Actuate>;
}

impl Clone for Box<dyn Actuate> {
    fn clone(&self) -> Self {
        self.copy()
    }
}

/// What jets do in a cycle.
#[derive(Clone, Debug, PartialEq)]
pub struct JetCycle {
    /// Signed on-times about each axis (s).
    pub on: [f64; 3],
    /// Propellant until their end (kg).
    pub fuel: f64,
    /// The propellant of each group about x, y and z, or of each thruster where they act by themselves or may fail (kg).
    pub fuels: Vec<f64>,
    /// Pulses so far, of all axes together.
    pub pulses: u64,
    /// Of groups, the signs of those that burn now, 0 for none.
    pub burning: [f64; 3],
    /// Of thrusters that act by themselves, the on-time of each (s).
    pub each: Vec<f64>,
    /// Of thrusters that act by themselves or may fail, the part of its thrust that each gives now.
    pub open: Vec<f64>,
}

/// When an actuator with a phase acts first.
fn first(phase: Option<Time>) -> Instant {
    Instant::START + Span::from_seconds(phase.map_or(0.0, Time::get))
}

impl Default for Actuator {
    fn default() -> Self {
        Self::Ideal(Ideal::default())
    }
}

impl Actuator {
    /// The kind, as a scenario names it.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Ideal(_) => "ideal",
            Self::Hold(_) => "hold",
            Self::Thrusters(_) => "thrusters",
            Self::Wheel(_) => "wheel",
            Self::Wheels(_) => "wheels",
            Self::ControlMomentGyros(_) => "control_moment_gyros",
            Self::Jets(_) => "jets",
            Self::Magnetorquers(_) => "magnetorquers",
            Self::Own(_) => "own",
        }
    }

    /// Its failures.
    pub fn failures(&self) -> &[Failure] {
        match self {
            Self::Ideal(ideal) => &ideal.faults,
            Self::Hold(hold) => &hold.faults,
            Self::Thrusters(thrusters) => &thrusters.faults,
            Self::Wheel(wheel) => &wheel.faults,
            Self::Wheels(wheels) => &wheels.faults,
            Self::ControlMomentGyros(gyros) => &gyros.faults,
            Self::Jets(jets) => &jets.faults,
            Self::Magnetorquers(torquers) => &torquers.faults,
            Self::Own(_) => &[],
        }
    }

    /// The period in which the command is executed; none for one that executes it at once.
    pub fn period(&self) -> Option<Span> {
        self.timing().0
    }

    /// When the first period begins (s), if that is given.
    pub fn phase(&self) -> Option<Time> {
        self.timing().1
    }

    fn timing(&self) -> (Option<Span>, Option<Time>) {
        match self {
            Self::Ideal(_)
            | Self::Wheel(_)
            | Self::Wheels(_)
            | Self::ControlMomentGyros(_)
            | Self::Magnetorquers(_)
            | Self::Own(_) => (None, None),
            Self::Hold(hold) => (Some(hold.period), hold.phase),
            Self::Thrusters(thrusters) => (Some(thrusters.period), thrusters.phase),
            Self::Jets(jets) => (jets.period, jets.phase),
        }
    }

    /// The actuator of a single axis at work in a setting. Jets, torquers, wheels of three axes, control moment gyros and one from
    /// outside act about all axes, and are not asked.
    pub fn about_an_axis(&self, setting: &TorquerSetting) -> Box<dyn AxisActuate> {
        match self {
            Self::Ideal(_)
            | Self::Jets(_)
            | Self::Wheels(_)
            | Self::ControlMomentGyros(_)
            | Self::Magnetorquers(_)
            | Self::Own(_) => Box::new(ideal::Executing::new(setting)),
            Self::Hold(hold) => Box::new(hold.start(setting)),
            Self::Thrusters(thrusters) => Box::new(thrusters.start(setting)),
            Self::Wheel(wheel) => Box::new(wheel.start(setting)),
        }
    }
}
