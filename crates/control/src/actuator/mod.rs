//! Actuators: they execute commands ideally, through a hold, by wheels or gyros, or by pulses of thrusters.

mod actuator_set;
mod allocation_role;
mod assignment;
mod axis_actuators;
mod control_moment_gyros;
mod control_moment_gyros_state;
mod failure;
mod faulty;
mod flywheel;
mod friction;
mod ideal;
mod imbalance;
mod jet_allocation;
mod jets;
mod jets_state;
mod magnetorquers;
mod per_wheel;
mod placement;
mod pulse_timing;
mod pulse_width;
mod requirements;
mod saturation;
mod steering;
mod thrusters;
mod unloading;
mod valves;
mod wheel_allocation;
mod wheels;
mod wheels_state;
mod zero_order_hold;

use std::any::Any;
use std::fmt;

use flexsc_dynamics::three_axis::RotorObservation;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::quantity::{Share, Time};
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{self, SteeringRecord, WheelMotion};
use flexsc_spacecraft::wrench::Wrench;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::custom::{Custom, PartError};

pub use actuator_set::ActuatorSet;
pub use allocation_role::{ActuatorTask, AssignedMember};
pub use assignment::AssignedActuator;
pub use axis_actuators::{AxisActuator, AxisActuatorContext, AxisActuators};
pub use control_moment_gyros::{ControlMomentGyros, GimbalArrangement};
pub use control_moment_gyros_state::ControlMomentGyrosState;
pub use failure::{Failure, FailureScope};
pub use flywheel::{BackEmfRate, FlywheelRotor, Wheel};
pub use friction::Friction;
pub use ideal::Ideal;
pub use imbalance::{Harmonic, Imbalance};
pub use jet_allocation::AllocatedJets;
pub use jets::{FiringMethod, GroupEffect, GroupPair, Jets, Thruster, ThrusterEffect, ThrusterGroups};
pub use jets_state::{JetsState, Pulse};
pub use magnetorquers::{Magnetorquers, MagnetorquersState};
pub use per_wheel::PerWheel;
pub use placement::{ActuatorAuthority, ActuatorPlacement, LinearDrive};
pub use pulse_timing::PulseTiming;
pub use pulse_width::PulseWidth;
pub use saturation::{EndState, Saturation};
pub use steering::{GyroAxes, NullMotion, Robustness, Steering};
pub use thrusters::Thrusters;
pub use unloading::{UnloadingTask, WheelUnloading};
pub use wheel_allocation::{Allocation, AllocationCriterion};
pub use wheels::{Arrangement, FrictionCompensation, SpeedBias, Wheels};
pub use wheels_state::WheelsState;
pub use zero_order_hold::ZeroOrderHold;

/// The kinds of actuator. On a body with three axes, an actuator for one angle acts about each of them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Actuator")]
pub enum ActuatorKind {
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
    Own(Custom<dyn ActuatorSpec>),
}

/// Demand on an actuator about an axis.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum Demand {
    /// Torque (N m), or reduced moment (rad/s²) on a body without inertia; for a wheel, units of its command.
    Torque(f64),
    /// Change of the rigid rate within the law's period (rad/s), which the actuator converts to a pulse.
    Change(f64),
    /// Magnetic moment along the axis (A m²), for magnetorquers.
    Moment(f64),
}

/// Settings of an actuator that another crate provides.
pub trait ActuatorSpec: Send + Sync {
    /// Returns the run-time state of the actuator, from the setting of each axis.
    fn start(&self, settings: &[AxisActuatorContext]) -> Box<dyn Actuator>;

    /// Returns the actuator's largest torque about an axis (N m); `None` without a limit.
    fn limit(&self, _axis: usize) -> Option<f64> {
        None
    }

    /// Returns the concrete type behind the trait, so that the providing program can downcast it; `None` by default.
    fn any(&self) -> Option<&dyn Any> {
        None
    }
}

/// Run-time state of an actuator.
pub trait Actuator: fmt::Debug + Send + Sync {
    /// Sets the demands about the axes from `now` on, of a body with these rigid rates (rad/s).
    fn command(&mut self, now: Instant, demands: &[Demand], rigid: [f64; 3]);

    /// Sets the measured magnetic field in the body's axes (T), before the commands that depend on it.
    fn set_magnetic_field(&mut self, _field: Vector) {}

    /// Makes wheels or gyros counteract a torque on the body (N m) from the next command on.
    fn set_counter_torque(&mut self, _torque: Vector) {}

    /// Returns the next time at which the output changes without a command.
    fn due(&self) -> Option<Instant> {
        None
    }

    /// Executes the changes due at `now`, after the laws have decided.
    fn update(&mut self, _now: Instant, _rigid: [f64; 3]) {}

    /// Sets the state of the rotors in bearings, as computed by the motion.
    fn set_rotor_states(&mut self, _now: Instant, _rotors: &[RotorObservation]) {}

    /// Adds the actuator's output from `now` on to `onto`.
    fn apply(&self, now: Instant, onto: &mut Wrench);

    /// Returns the torque demanded about an axis (N m).
    fn demanded_torque(&self, axis: usize) -> f64;

    /// Returns the torque held about an axis (N m), without a waveform and without back-EMF.
    fn held_torque(&self, axis: usize) -> f64;

    /// Returns the torque of the pulse of thrusters that is on about an axis (N m); 0 of other actuators.
    fn firing(&self, _axis: usize) -> f64 {
        0.0
    }

    /// Returns the torque applied about an axis (N m), of a body with this rate and this rigid rate (rad/s).
    fn applied_torque(&self, _now: Instant, axis: usize, _rates: [f64; 2]) -> f64 {
        self.held_torque(axis)
    }

    /// Returns the reduced moment held about an axis (rad/s²), without back-EMF and disregarding failures.
    fn reduced_moment(&self, axis: usize) -> f64;

    /// Returns the change of the rate about the first axis (rad/s) by the waveform between two times (s).
    fn waveform_impulse(&self, _from: f64, _to: f64) -> f64 {
        0.0
    }

    /// Returns the back-EMF torque per unit of the rate about the first axis (N m s), and true if the elastic rate is
    /// included.
    fn back_emf(&self) -> (f64, bool) {
        (0.0, false)
    }

    /// Returns the wheel about an axis, if it stores momentum, of a body with this rigid rate (rad/s).
    fn wheel(&self, _axis: usize, _rigid_rate: f64) -> Option<WheelMotion> {
        None
    }

    /// Returns the log rows of wheels about their own axes, of a body with this rate (rad/s).
    fn wheels(&self, _now: Instant, _rate: [f64; 3]) -> Vec<flexsc_record::Wheel> {
        Vec::new()
    }

    /// Returns the log row of control moment gyros, if the actuator has any.
    fn gimbal_row(&self, _now: Instant) -> Option<flexsc_record::ControlMomentGyros> {
        None
    }

    /// Returns the extreme values of the control moment gyros since the start.
    fn steering_record(&self) -> Option<SteeringRecord> {
        None
    }

    /// Returns the log row of the magnetic moments held by magnetorquers.
    fn magnetorquer_row(&self) -> Option<flexsc_record::Magnetorquers> {
        None
    }

    /// Returns the speeds of wheels in bearings that are available to the drives (rad/s).
    fn measured_wheel_speeds(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Returns the angular momentum stored in the rotors (N m s, body axes), as available to the drives.
    fn stored_momentum(&self, _now: Instant) -> [f64; 3] {
        [0.0; 3]
    }

    /// Returns the current cycle of pulses of jets.
    fn jet_cycle(&self) -> Option<JetCycle> {
        None
    }

    /// Returns the pulses of the current cycle of jets.
    fn executed_pulses(&self) -> Option<Vec<Pulse>> {
        None
    }

    /// Returns the angular impulse of all pulses of the current cycle of jets (N m s, body axes).
    fn cycle_impulse(&self) -> Vector {
        Vector::zeros()
    }

    /// Returns the changes of the rigid rates (rad/s) by commands that are not yet executed.
    fn queued_rate_change(&self) -> [f64; 3] {
        [0.0; 3]
    }

    /// Returns the pulses that will be executed in the cycle that begins now.
    fn pending_pulses(&self) -> Vec<Pulse> {
        Vec::new()
    }

    /// Returns the error that an actuator of another crate failed with; the run ends there.
    fn failure(&self) -> Option<PartError> {
        None
    }

    /// Returns a copy in the same state.
    fn copy(&self) -> Box<dyn Actuator>;
}

impl Clone for Box<dyn Actuator> {
    fn clone(&self) -> Self {
        self.copy()
    }
}

/// Jet activity in a cycle.
#[derive(Clone, Debug, PartialEq)]
pub struct JetCycle {
    /// Signed on-time about each axis (s).
    pub on: [f64; 3],
    /// Propellant used until the end of the pulses (kg).
    pub fuel: f64,
    /// The propellant of each group about x, y and z, or of each thruster where they act by themselves or may fail (kg).
    pub fuels: Vec<f64>,
    /// Number of pulses since the start, of all axes together.
    pub pulses: u64,
    /// Sign of the group that fires now about each axis; 0 for none.
    pub burning: [f64; 3],
    /// On-time of each thruster (s), for jets that are allocated individually.
    pub each: Vec<f64>,
    /// Current fraction of the thrust of each thruster, for jets that are allocated individually or may fail.
    pub open: Vec<f64>,
}

/// Returns the first time at which an actuator with a phase acts.
fn first(phase: Option<Time>) -> Instant {
    Instant::START + Span::from_seconds(phase.map_or(0.0, Time::get))
}

impl Default for ActuatorKind {
    fn default() -> Self {
        Self::Ideal(Ideal::default())
    }
}

impl ActuatorKind {
    /// Returns the name of the kind, as in a scenario.
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

    /// Returns the actuator's failures.
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

    /// Returns the period in which the command is executed; `None` for immediate execution.
    pub fn period(&self) -> Option<Span> {
        self.timing().0
    }

    /// Returns the start of the first period (s), if given.
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

    /// Returns the run-time state of a single-axis actuator. Kinds that act about all axes are not asked for it: jets,
    /// magnetorquers, wheels of three axes, control moment gyros and those of another crate.
    pub fn axis_actuator(&self, setting: &AxisActuatorContext) -> Box<dyn AxisActuator> {
        match self {
            Self::Ideal(_)
            | Self::Jets(_)
            | Self::Wheels(_)
            | Self::ControlMomentGyros(_)
            | Self::Magnetorquers(_)
            | Self::Own(_) => Box::new(ideal::IdealState::new(setting)),
            Self::Hold(hold) => Box::new(hold.start(setting)),
            Self::Thrusters(thrusters) => Box::new(thrusters.start(setting)),
            Self::Wheel(wheel) => Box::new(wheel.start(setting)),
        }
    }
}
