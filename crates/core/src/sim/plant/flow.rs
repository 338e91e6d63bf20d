//! Flow of a body: its motion from one change of its loads to the next, with an implementation for each kind of motion.

use std::any::Any;
use std::borrow::Cow;
use std::fmt;

use flexsc_control::estimator::WindowedEnvelope;
use flexsc_control::sensor::{Orientation, Truth};
use flexsc_dynamics::AxisState;
use flexsc_dynamics::guard::Guard;
use flexsc_dynamics::wrench::Wrench;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{Record, RecordError};

use super::one_axis_body::OneAxisQuantities;
use super::three_axis_body::ThreeAxisQuantities;

/// Exact or integrated motion of a body under constant loads and waveforms.
pub trait Flow: Any + fmt::Debug + Send + Sync {
    /// Begins a motion segment at the current instant, under the loads from now on.
    fn begin_segment(&mut self, wrench: &Wrench);

    /// Integrates a motion without a closed form up to `now`, unless the record fails, so that evaluating it there is
    /// cheap; returns the earlier instant at which it stopped because a wheel stuck or let go.
    fn advance(&mut self, now: Instant, record: &mut dyn Record) -> Result<Option<Instant>, RecordError>;

    /// Advances the body to `now` and writes its true state; returns false if that is no longer finite.
    fn evaluate(&mut self, now: Instant, truth: &mut Truth) -> bool;

    /// Returns the instant and index of the first guard crossing of this segment within `horizon`; `None` also for
    /// motions without a closed form, on which no law with guards acts.
    fn crossing(
        &mut self,
        _guards: &[Guard],
        _horizon: Span,
        _record: &mut dyn Record,
    ) -> Result<Option<(Instant, usize)>, RecordError> {
        Ok(None)
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
