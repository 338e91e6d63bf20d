//! Actuators: they execute commands ideally, through a hold, by wheels or gyros, or by pulses of thrusters.

mod actuator_set;
mod actuator_spec;
mod allocation_role;
#[macro_use]
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

use crate::kinds::kinds;
use crate::part::Part;

pub use actuator_set::ActuatorSet;
pub use actuator_spec::ActuatorSpec;
pub use allocation_role::{ActuatorTask, AssignedMember};
pub use assignment::AssignedActuator;
pub use axis_actuators::{
    AxisActuator, AxisActuatorContext, AxisActuators, AxisProperties, AxisTorques, AxisWaves,
};
pub use burns::Burn;
pub use capabilities::{
    Capabilities, JetCycle, MomentumStorage, PulsedActuator, UnloadingCycle, WaveformActuator,
};
pub use control_moment_gyros::{ControlMomentGyros, GimbalArrangement};
pub use control_moment_gyros_state::ControlMomentGyrosState;
pub use effort::{ActuatorEvent, AxisEffort, AxisResponse};
pub use failure::{FailingComponent, Failure, FailureScope};
pub use flywheel::{BackEmfRate, FlywheelRotor, Wheel};
pub use friction::Friction;
pub use ideal::Ideal;
pub use imbalance::{Harmonic, Imbalance, TurningLoad};
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
pub use target_loss::{SATURATION_GAP, TargetLoss, TargetLossMonitor};
pub use thrusters::Thrusters;
pub use unloading::{UnloadingTask, WheelUnloading};
pub use wheel_allocation::{Allocation, AllocationCriterion};
pub use wheels::{Arrangement, CarriedRotor, FrictionCompensation, SpeedBias, Wheels};
pub use wheels_state::WheelsState;
pub use zero_order_hold::ZeroOrderHold;

kinds! {
    /// The kinds of actuator. On a body with three axes, an actuator for one angle acts about each of them.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[schemars(rename = "Actuator")]
    pub enum ActuatorKind: dyn ActuatorSpec {
        /// The command itself, at every instant.
        "ideal" Ideal(Ideal),
        /// A zero-order hold: the mean of the manoeuvre's command over each period, and the feedback at its start.
        "hold" Hold(ZeroOrderHold),
        /// One pulse of full torque per period, centred in it, with the same impulse as a zero-order hold.
        "thrusters" Thrusters(Thrusters),
        /// A flywheel on a motor with back-EMF.
        "wheel" Wheel(Wheel),
        /// Reaction wheels about axes of their own.
        "wheels" Wheels(Wheels),
        /// Control moment gyros of a spacecraft.
        "control_moment_gyros" ControlMomentGyros(ControlMomentGyros),
        /// Thrusters at points of a spatial body.
        "jets" Jets(Jets),
        /// Magnetorquers of a spatial body in the field of its planet.
        "magnetorquers" Magnetorquers(Magnetorquers),
    }
    own "An actuator from another crate; a scenario file cannot name it."
    also entries
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
