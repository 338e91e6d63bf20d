//! Flow of a one-axis body whose motion a batch computes.

use std::borrow::Cow;

use flexsc_control::estimator::WindowedEnvelope;
use flexsc_control::sensor::{Orientation, Truth};
use flexsc_dynamics::wrench::Wrench;
use flexsc_dynamics::{AngleObservation, AxisState};
use flexsc_numerics::time::Instant;
use flexsc_record::{Record, RecordError};

use super::flow::{Flow, FlowQuantities};
use super::one_axis_body::{OneAxisBody, OneAxisQuantities};

/// Interface to a motion that a batch computes.
#[derive(Clone, Debug)]
pub struct ExternalFlow {
    body: OneAxisBody,
    /// Acceleration per unit of torque (1/(kg m²)).
    mobility: f64,
    /// Start of the last segment and its reduced moment (rad/s²), until the batch has taken it.
    segment_start: Option<(Instant, f64)>,
}

impl ExternalFlow {
    /// Creates the interface for a body with the given acceleration per unit of torque (1/(kg m²)).
    pub fn new(body: OneAxisBody, mobility: f64) -> Self {
        Self { body, mobility, segment_start: None }
    }

    /// Returns the start of the last segment and its reduced moment (rad/s²), once per segment; `None` if no segment has begun
    /// since the last call.
    pub fn take_segment_start(&mut self) -> Option<(Instant, f64)> {
        self.segment_start.take()
    }

    /// Sets the motion that the batch has computed at `now`: angle and rate of each coordinate.
    pub fn set_motion(&mut self, now: Instant, motion: impl Iterator<Item = [f64; 2]>) {
        let OneAxisBody { state, sensed, evaluated_at, frequencies, .. } = &mut self.body;
        (*evaluated_at, *sensed) = (now, AngleObservation::default());
        for (index, [angle, rate]) in motion.enumerate() {
            if index == 0 {
                (state.rigid_angle, state.rigid_rate) = (angle, rate);
            } else {
                let mode = &mut state.modes[index - 1];
                (mode.displacement, mode.quadrature) = (angle, rate / frequencies[index - 1]);
            }
            sensed.angle += angle;
            sensed.rate += rate;
        }
    }
}

impl Flow for ExternalFlow {
    fn begin_segment(&mut self, wrench: &Wrench) {
        self.segment_start = Some((self.body.evaluated_at, wrench.hub[0] * self.mobility));
    }

    fn advance(&mut self, _now: Instant, record: &mut dyn Record) -> Result<Option<Instant>, RecordError> {
        record.poll().map(|()| None)
    }

    fn evaluate(&mut self, now: Instant, truth: &mut Truth) -> bool {
        // The batch has already set the state at `now`.
        self.body.evaluated_at = now;
        self.body.write_truth(truth)
    }

    fn about_axis(&self, _axis: usize, _target: &Orientation) -> Cow<'_, AxisState> {
        Cow::Borrowed(&self.body.state)
    }

    fn modal_state(&self) -> Cow<'_, AxisState> {
        Cow::Borrowed(&self.body.state)
    }

    fn update_monitor(
        &self,
        monitor: &mut WindowedEnvelope,
        now: Instant,
        torque: f64,
        _commanded: &dyn Fn() -> Wrench,
    ) {
        monitor.command(now, &self.body.state, torque);
    }

    fn quantities(&self) -> FlowQuantities<'_> {
        FlowQuantities::OneAxis(self)
    }

    fn copy(&self) -> Box<dyn Flow> {
        Box::new(self.clone())
    }
}

impl OneAxisQuantities for ExternalFlow {
    fn body(&self) -> &OneAxisBody {
        &self.body
    }
}
