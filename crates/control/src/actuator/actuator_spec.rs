//! Settings of an actuator: its authority, its run-time state, and what it offers to the other parts, before a run.

use flexsc_numerics::quantity::Time;
use flexsc_numerics::time::Span;

use super::failure::FailingComponent;
use super::{
    Actuator, ActuatorAuthority, ActuatorPlacement, AxisActuatorContext, CommandResponse, Failure,
    LinearDrive,
};
use crate::offers::{ActuatorOffers, ActuatorPlace, Offers, TorqueLimit};
use crate::requirement::Requirements;

/// Settings of an actuator.
pub trait ActuatorSpec: Send + Sync {
    /// Returns the run-time state of the actuator before it first acts, from the setting of each axis of the body.
    fn start(&self, settings: &[AxisActuatorContext], on: &ActuatorPlacement<'_>) -> Box<dyn Actuator>;

    /// Returns the actuator's constant largest torque about an axis (N m); `None` without one.
    fn limit(&self, _axis: usize) -> Option<f64> {
        None
    }

    /// Returns the authority of the actuator about an axis of this inertia (kg m²), acting alone.
    fn authority(&self, axis: usize, inertia: f64, _on: &ActuatorPlacement<'_>) -> ActuatorAuthority {
        ActuatorAuthority::constant(self.limit(axis).map_or(f64::INFINITY, |limit| limit / inertia))
    }

    /// Returns the offers of the actuator to the other parts of a scenario, apart from its period.
    fn offers(&self) -> ActuatorOffers {
        let limit = |axis| self.limit(axis).map_or(TorqueLimit::Unlimited, |_| TorqueLimit::Constant);
        ActuatorOffers { limits: [0, 1, 2].map(limit), ..ActuatorOffers::default() }
    }

    /// Adds the requirements of the actuator on the other parts of a scenario.
    fn requires(&self, _place: &ActuatorPlace<'_>, _offers: &Offers, _needs: &mut Requirements) {}

    /// Returns the period in which the command is executed; `None` for immediate execution.
    fn period(&self) -> Option<Span> {
        None
    }

    /// Returns the start of the first period (s), if given.
    fn phase(&self) -> Option<Time> {
        None
    }

    /// Returns the actuator's failures.
    fn failures(&self) -> &[Failure] {
        &[]
    }

    /// Returns the components that failures can name, on a body with `axes` axes.
    fn failing_components(&self, axes: usize) -> FailingComponent {
        FailingComponent::Axes(axes)
    }

    /// Returns the largest torque (N m) for the largest planned torque (N m) and the largest command of the law.
    fn expected_torque(&self, planned: f64, command: f64) -> f64 {
        planned.max(command)
    }

    /// Returns the torque per unit of a command (N m), of an actuator whose commands are not torques.
    fn command_gain(&self) -> Option<f64> {
        None
    }

    /// Returns the linear path of commands through the actuator, if it acts linearly up to its limits.
    fn linear_drive(&self) -> Option<LinearDrive<'_>> {
        None
    }

    /// Returns the linear response to commands; `None` for an actuator that is not linear.
    fn command_response(&self) -> Option<CommandResponse> {
        self.linear_drive().map(|drive| CommandResponse { gain: drive.gain, delay: drive.delay })
    }
}

impl dyn ActuatorSpec {
    /// Returns the torque per unit of a torque command (N m).
    pub fn torque_per_command(&self) -> f64 {
        self.command_gain().unwrap_or(1.0)
    }
}
