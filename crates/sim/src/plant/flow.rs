//! Flow of a body: its motion from one change of its loads to the next, with an implementation for each kind of motion.

use std::any::Any;
use std::borrow::Cow;
use std::fmt;

use flexsc_control::estimator::WindowedEnvelope;
use flexsc_control::sensor::{Orientation, Truth};
use flexsc_dynamics::AxisState;
use flexsc_dynamics::guard::{AxisGuards, GuardCrossing};
use flexsc_dynamics::wrench::Wrench;
use flexsc_numerics::attitude::AXES;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{Record, RecordError};

use super::one_axis_body::OneAxisQuantities;
use super::three_axis_body::ThreeAxisQuantities;
use crate::SimulationError;

/// Exact or integrated motion of a body under constant loads and waveforms.
pub trait Flow: Any + fmt::Debug + Send + Sync {
    /// Begins a motion segment at the current instant, under the loads from now on.
    fn begin_segment(&mut self, wrench: &Wrench);

    /// Advances an integrated motion to `now`; a motion in closed form needs no advance. Returns the earlier instant at
    /// which a wheel stuck or slipped, where the motion stops, if there is one; fails if the record fails.
    fn advance(&mut self, now: Instant, record: &mut dyn Record) -> Result<Option<Instant>, RecordError>;

    /// Writes the true state at `now`; returns false if it is no longer finite. A three-axis motion must have been
    /// advanced to `now`: its state is that of the last advance.
    fn evaluate(&mut self, now: Instant, truth: &mut Truth) -> bool;

    /// Returns the limit of the motion's model that the motion has passed at the current instant; `None` if it is within
    /// all limits.
    fn exceeded_limit(&self) -> Option<ExceededLimit> {
        None
    }

    /// Returns the first guard crossing of this segment within `horizon`; `None` also for motions without a closed form,
    /// on which no law with guards acts.
    fn crossing(
        &mut self,
        _guards: AxisGuards<'_>,
        _horizon: Span,
        _record: &mut dyn Record,
    ) -> Result<Option<GuardCrossing>, RecordError> {
        Ok(None)
    }

    /// Returns the angles (rad) of a continuous sensor, counted from `origin`, at the true state.
    fn sensed_angles(&self, truth: &Truth, origin: &Orientation) -> [f64; 3] {
        truth.orientation.rotated_by(truth.sensor_angles()).error_from(origin)
    }

    /// Returns the motion about an axis as if that axis were alone; for three axes, with angles counted from `target`.
    fn about_axis(&self, axis: usize, target: &Orientation) -> Cow<'_, AxisState>;

    /// Returns the modal state for the monitor of the envelope: that of one axis, or the rotations of the first sensor
    /// by the modes of three axes.
    fn modal_state(&self) -> Cow<'_, AxisState>;

    /// Updates the monitor of the envelope with what excites the modes from now on: a torque (N m) on those of one
    /// axis, the commanded wrench on those of three axes.
    fn update_monitor(
        &self,
        monitor: &mut WindowedEnvelope,
        now: Instant,
        torque: f64,
        commanded: &dyn Fn() -> Wrench,
    );

    /// Returns the quantities of the motion beyond the true state.
    fn quantities(&self) -> FlowQuantities<'_>;

    /// Returns a copy in the same state.
    fn copy(&self) -> Box<dyn Flow>;
}

impl Clone for Box<dyn Flow> {
    fn clone(&self) -> Self {
        self.copy()
    }
}

/// Limit of a motion's model that the motion has passed.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ExceededLimit {
    /// Instant at which the motion reached the limit.
    pub at: Instant,
    /// Axis: 0 to 2 for roll, pitch and yaw.
    pub axis: usize,
    /// True if the rate reached its limit, false if the angle did.
    pub is_rate: bool,
    /// Limit (rad or rad/s).
    pub limit: f64,
}

impl From<ExceededLimit> for SimulationError {
    fn from(exceeded: ExceededLimit) -> Self {
        let ExceededLimit { at, axis, is_rate, limit } = exceeded;
        Self::SmallAngles { at, axis: AXES[axis], key: if is_rate { "rate" } else { "angle" }, limit }
    }
}

/// Quantities of a motion beyond the true state, from which its rows are made.
#[derive(Copy, Clone)]
pub enum FlowQuantities<'a> {
    /// Motion of a one-axis body.
    OneAxis(&'a dyn OneAxisQuantities),
    /// Motion of a three-axis body.
    ThreeAxis(&'a dyn ThreeAxisQuantities),
}

impl<'a> FlowQuantities<'a> {
    /// Returns the quantities of a one-axis body.
    pub fn one_axis(self) -> Option<&'a dyn OneAxisQuantities> {
        if let Self::OneAxis(motion) = self { Some(motion) } else { None }
    }

    /// Returns the quantities of a three-axis body.
    pub fn three_axis(self) -> Option<&'a dyn ThreeAxisQuantities> {
        if let Self::ThreeAxis(motion) = self { Some(motion) } else { None }
    }
}
