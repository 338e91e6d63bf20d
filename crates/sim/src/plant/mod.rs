//! Plant: the flow of the body and its true state at the last evaluation.

mod external;
mod flow;
mod one_axis;
mod one_axis_body;
mod one_way;
mod small_angles;
mod three_axis_body;
mod three_axis_rows;
mod two_way;
mod two_way_motion;

use std::any::Any;
use std::borrow::Cow;

use flexsc_control::estimator::WindowedEnvelope;
use flexsc_control::sensor::{Orientation, Truth};
use flexsc_dynamics::flow::ExternalMotion;
use flexsc_dynamics::guard::{AxisGuards, GuardCrossing};
use flexsc_dynamics::three_axis::{RotorObservation, SlipDirection};
use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_dynamics::wrench::Wrench;
use flexsc_dynamics::{AxisState, MotionPiece};
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::polynomial::Polynomial;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{Record, RecordError};
use flexsc_spacecraft::body::BodyAxes;
use flexsc_spacecraft::environment::EnvironmentObservation;

use super::SimulationError;
use flexsc_scenario::{ResolvedScenario, Scenario};

use external::ExternalFlow;
use one_way::OneWayFlow;
use small_angles::SmallAnglesFlow;
use two_way::TwoWayFlow;
use two_way_motion::TwoWaySegment;

pub use flow::{Flow, FlowQuantities};
pub use one_axis::{AppliedTorque, OneAxisFlow};
pub use one_axis_body::OneAxisQuantities;
pub use three_axis_body::ThreeAxisQuantities;
pub use two_way_motion::AccelerometerMount;

/// True state before the first evaluation.
const INITIAL_TRUTH: Truth = Truth {
    orientation: Orientation::Angle(0.0),
    elastic: [0.0; 3],
    rate: [0.0; 3],
    rigid_rate: [0.0; 3],
    rate_integral: [0.0; 3],
    environment: EnvironmentObservation {
        field: None,
        sun: None,
        nadir: None,
        position: None,
        velocity: None,
    },
};

/// Moving body.
#[derive(Clone, Debug)]
pub struct Plant {
    flow: Box<dyn Flow>,
    /// True state at the last evaluation.
    truth: Truth,
}

impl Plant {
    /// Creates the plant of a scenario at the start, without loads.
    pub fn new(scenario: &Scenario) -> Self {
        match scenario.model.axes() {
            BodyAxes::One(body) => Self::with_flow(OneAxisFlow::new(scenario, body)),
            BodyAxes::Three(body) => Self::with_three_axes(body, &scenario.study),
        }
    }

    /// Creates the plant of a three-axis body.
    fn with_three_axes(body: &ThreeAxisModel, study: &ResolvedScenario) -> Self {
        let flexible = body.flexible();
        if let Some(limits) = body.small_angles {
            return Self::with_flow(SmallAnglesFlow::new(body, limits, flexible.as_ref(), study));
        }
        match flexible {
            Some(flexible) => Self::with_flow(TwoWayFlow::new(body, &flexible, study)),
            None => Self::with_flow(OneWayFlow::new(body, study).with_drift(body, study.drift.as_ref())),
        }
    }

    fn with_flow(flow: impl Flow) -> Self {
        Self { flow: Box::new(flow), truth: INITIAL_TRUTH }
    }

    /// Advances an integrated motion to `now`; a motion in closed form needs no advance. Returns the earlier instant at
    /// which a wheel stuck or slipped, where the motion stops, if there is one; fails if the record fails.
    #[inline]
    pub fn advance(&mut self, now: Instant, record: &mut dyn Record) -> Result<Option<Instant>, RecordError> {
        self.flow.advance(now, record)
    }

    /// Evaluates the true state at `now`, to which the plant must have been advanced, and returns it.
    #[inline]
    pub fn evaluate(&mut self, now: Instant) -> Result<&Truth, SimulationError> {
        if self.flow.evaluate(now, &mut self.truth) {
            Ok(&self.truth)
        } else {
            Err(self.flow.exceeded_limit().map_or(SimulationError::NonFinite { at: now }, Into::into))
        }
    }

    /// Returns the true state of the last evaluation.
    #[inline]
    pub fn truth(&self) -> &Truth {
        &self.truth
    }

    /// Returns the true state of the last evaluation at the mounting point of a sensor.
    pub fn truth_at_sensor(&self, sensor: usize) -> Cow<'_, Truth> {
        match self.quantities().three_axis() {
            Some(motion) if sensor > 0 => Cow::Owned(motion.body().truth_at_sensor(&self.truth, sensor)),
            _ => Cow::Borrowed(&self.truth),
        }
    }

    /// Returns the angles (rad) of a continuous sensor, counted from `origin`.
    #[inline]
    pub fn sensed_angles(&self, origin: &Orientation) -> [f64; 3] {
        match self.truth.orientation {
            at @ Orientation::Angle(_) => at.rotated_by(self.truth.sensor_angles()).error_from(origin),
            Orientation::Attitude(_) => self.flow.sensed_angles(&self.truth, origin),
        }
    }

    /// Returns an upper bound on the frequencies in a three-axis motion at the current instant (rad/s); 0 for one axis.
    pub fn fastest_frequency(&self) -> f64 {
        self.quantities().three_axis().map_or(0.0, ThreeAxisQuantities::fastest_frequency)
    }

    /// Begins a motion segment at the current instant, under the loads from now on.
    #[inline]
    pub fn begin_segment(&mut self, wrench: &Wrench) {
        self.flow.begin_segment(wrench);
    }

    /// Returns the first guard crossing within `horizon`; `None` also for motions without a closed form.
    #[inline]
    pub fn crossing(
        &mut self,
        guards: AxisGuards<'_>,
        horizon: Span,
        record: &mut dyn Record,
    ) -> Result<Option<GuardCrossing>, RecordError> {
        self.flow.crossing(guards, horizon, record)
    }

    /// Returns the motion about an axis as if that axis were alone; for three axes, with angles counted from `target`.
    pub fn about_axis(&self, axis: usize, target: &Orientation) -> Cow<'_, AxisState> {
        self.flow.about_axis(axis, target)
    }

    /// Returns the modal state for the monitor of the envelope: that of one axis, or the rotations of the first sensor
    /// by the modes of three axes.
    pub fn modal_state(&self) -> Cow<'_, AxisState> {
        self.flow.modal_state()
    }

    /// Updates the monitor of the envelope with what excites the modes from now on: a torque (N m) on those of one
    /// axis, the commanded wrench on those of three axes.
    pub fn update_monitor(
        &self,
        monitor: &mut WindowedEnvelope,
        now: Instant,
        torque: f64,
        commanded: &dyn Fn() -> Wrench,
    ) {
        self.flow.update_monitor(monitor, now, torque, commanded);
    }

    /// Returns the quantities of the motion beyond the true state, from which its rows are made.
    #[inline]
    pub fn quantities(&self) -> FlowQuantities<'_> {
        self.flow.quantities()
    }

    /// Records the one-axis motion of the segment that ends at `now`, piece by piece, if the record wants it.
    #[inline]
    pub fn record_pieces(
        &self,
        now: Instant,
        applied: &AppliedTorque,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        self.quantities().one_axis().map_or(Ok(()), |motion| motion.record_pieces(now, applied, record))
    }

    /// Passes the pieces of the one-axis motion between two instants of this segment, and the rigid angle over each, to
    /// `take`.
    pub fn expand(
        &self,
        span: [Instant; 2],
        applied: &AppliedTorque,
        take: &mut dyn FnMut(&MotionPiece, &Polynomial),
    ) {
        if let Some(motion) = self.quantities().one_axis() {
            motion.expand(span, applied, take);
        }
    }

    /// Returns the states of the wheels in bearings at the current instant; empty without friction, imbalance and
    /// tachometer.
    #[inline]
    pub fn rotor_observations(&self) -> Vec<RotorObservation> {
        self.two_way().map_or_else(Vec::new, |segment| segment.motion.rotor_observations(segment.start))
    }

    /// Returns the slip states of the wheels in bearings.
    pub fn slip_states(&self) -> &[SlipDirection] {
        self.two_way().map_or(&[], |segment| segment.motion.slip_states())
    }

    /// Returns the specific force at an accelerometer of a spacecraft at the current instant (m/s²), under the loads
    /// from then on.
    pub fn specific_force(&self, place: &AccelerometerMount) -> Vector {
        self.two_way()
            .map_or_else(Vector::zeros, |segment| segment.motion.specific_force(place, segment.start))
    }

    /// Returns the motion whose modes act back on the rotation, if the body has it.
    fn two_way(&self) -> Option<TwoWaySegment<'_>> {
        self.quantities().three_axis().and_then(ThreeAxisQuantities::two_way)
    }

    /// Returns the closed-form motion of a one-axis body, for the relay kernel.
    pub fn one_axis(&mut self) -> Option<&mut OneAxisFlow> {
        let flow: &mut dyn Any = &mut *self.flow;
        flow.downcast_mut()
    }

    /// Returns the motion that a batch computes.
    pub fn external(&mut self) -> Option<&mut ExternalFlow> {
        let flow: &mut dyn Any = &mut *self.flow;
        flow.downcast_mut()
    }

    /// Hands the motion to a batch from now on; `None` unless the modes are coupled or drift, between segment starts.
    pub fn take_motion(&mut self) -> Option<ExternalMotion> {
        let (motion, flow) = self.one_axis()?.take_motion()?;
        self.flow = Box::new(flow);
        Some(motion)
    }
}
