//! Actuators: they execute commands ideally, through a hold, by wheels or gyros, or by pulses of thrusters.

mod actuator_set;
mod allocation_role;
mod assignment;
mod axis_actuators;
mod burns;
mod capabilities;
mod control_moment_gyros;
mod control_moment_gyros_state;
mod effort;
mod failure;
mod faulty;
mod flywheel;
mod friction;
mod ideal;
mod imbalance;
mod jet_allocation;
mod jets;
mod jets_state;
mod limits;
mod magnetorquers;
mod per_wheel;
mod placement;
mod pulse_timing;
mod pulse_width;
mod requirements;
mod saturation;
mod steering;
mod target_loss;
mod thrusters;
mod unloading;
mod valves;
mod wheel_allocation;
mod wheels;
mod wheels_state;
mod zero_order_hold;

use flexsc_dynamics::wrench::Wrench;
use flexsc_numerics::quantity::{Share, Time};
use flexsc_numerics::time::{Instant, Span};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::custom::Custom;
use crate::part::Part;

pub use actuator_set::ActuatorSet;
pub use allocation_role::{ActuatorTask, AssignedMember};
pub use assignment::{ActuatorName, AssignedActuator};
pub use axis_actuators::{
    AxisActuator, AxisActuatorContext, AxisActuators, AxisProperties, AxisTorques, AxisWaves,
};
pub use burns::Burn;
pub use capabilities::{Capabilities, JetCycle, MomentumStorage, PulsedActuator, WaveformActuator};
pub use control_moment_gyros::{ControlMomentGyros, GimbalArrangement};
pub use control_moment_gyros_state::ControlMomentGyrosState;
pub use effort::{ActuatorEvent, AxisEffort, AxisResponse};
pub use failure::{Failure, FailureScope};
pub use flywheel::{BackEmfRate, FlywheelRotor, Wheel};
pub use friction::Friction;
pub use ideal::Ideal;
pub use imbalance::{Harmonic, Imbalance};
pub use jet_allocation::AllocatedJets;
pub use jets::{FiringMethod, GroupEffect, GroupPair, Jets, Thruster, ThrusterEffect, ThrusterGroups};
pub use jets_state::{JetsState, Pulse, jet_pair};
pub use limits::{ActuatorLimit, ActuatorLimits, LimitKind};
pub use magnetorquers::{Magnetorquers, MagnetorquersState};
pub use per_wheel::PerWheel;
pub use placement::{ActuatorAuthority, ActuatorPlacement, CommandResponse, LinearDrive};
pub use pulse_timing::PulseTiming;
pub use pulse_width::PulseWidth;
pub use saturation::{EndState, LimitTime, Saturation};
pub use steering::{GyroAxes, NullMotion, Robustness, Steering};
pub use target_loss::{TargetLoss, TargetLossMonitor};
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
}

/// Run-time state of an actuator.
pub trait Actuator: Part {
    /// Sets the demands about the axes from `now` on, of a body with these rigid rates (rad/s).
    fn command(&mut self, now: Instant, demands: &[Demand], rigid: [f64; 3]);

    /// Responds to an event other than a command at `now`.
    fn update(&mut self, _now: Instant, _event: ActuatorEvent<'_>) {}

    /// Adds the actuator's output from `now` on to `onto`.
    fn apply(&self, now: Instant, onto: &mut Wrench);

    /// Returns the demanded and the held effort about an axis.
    fn effort(&self, axis: usize) -> AxisEffort;

    /// Returns the response about an axis of a body with this rate and this rigid rate (rad/s).
    fn response(&self, _now: Instant, axis: usize, _rates: [f64; 2]) -> AxisResponse {
        AxisResponse { applied: self.effort(axis).held, rotor: None }
    }

    /// Returns the actuator's abilities beyond torques about the axes.
    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities::default()
    }

    /// Returns true if the actuator does nothing at `now` for the demand about an axis: by default if it is a magnetic moment.
    fn ignores(&self, _now: Instant, axis: usize, demands: &[Demand]) -> bool {
        matches!(demands.get(axis), Some(Demand::Moment(_)))
    }

    /// Returns a copy in the same state.
    fn copy(&self) -> Box<dyn Actuator>;
}

impl Clone for Box<dyn Actuator> {
    fn clone(&self) -> Self {
        self.copy()
    }
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
    /// Returns the wheels if they are unbalanced.
    pub fn unbalanced_wheels(&self) -> Option<&Wheels> {
        match self {
            Self::Wheels(wheels) if wheels.imbalance.is_some() => Some(wheels),
            _ => None,
        }
    }

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

    /// Returns the torque per unit of a torque command (N m).
    pub fn torque_per_command(&self) -> f64 {
        if let Self::Wheel(wheel) = self { wheel.gain.get() } else { 1.0 }
    }

    /// Returns the largest torque (N m) for the largest planned torque (N m) and the largest command of the law.
    pub fn expected_torque(&self, planned: f64, command: f64) -> f64 {
        match self {
            Self::Wheel(wheel) => planned.max(wheel.gain.get() * wheel.execute_command(command)),
            Self::Thrusters(thrusters) => thrusters.torque.about(0).get(),
            _ => planned.max(command),
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
