//! Plant: model, motion and true state of the body, with one axis in closed form where there is one, or with three
//! axes.

mod coupled;
mod external_motion;
mod one_axis;
mod three_axis;

use std::borrow::Cow;

use flexsc_control::estimator::WindowedEnvelope;
use flexsc_control::sensor::{Orientation, Truth};
use flexsc_dynamics::AxisState;
use flexsc_dynamics::guard::Guard;
use flexsc_dynamics::three_axis::RotorObservation;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{Record, RecordError};
use flexsc_spacecraft::body::BodyAxes;
use flexsc_spacecraft::environment::EnvironmentObservation;
use flexsc_spacecraft::wrench::Wrench;

use super::SimulationError;
use crate::scenario::Scenario;

pub use coupled::AccelerometerMount;
pub use one_axis::{AppliedTorque, OneAxisPlant};
pub use three_axis::ThreeAxisPlant;

/// True state before the first evaluation.
const INITIAL_TRUTH: Truth = Truth {
    orientation: Orientation::Angle(0.0),
    elastic: [0.0; 3],
    rate: [0.0; 3],
    rigid: [0.0; 3],
    turned: [0.0; 3],
    sky: EnvironmentObservation { field: None, sun: None },
};

/// Moving body.
#[derive(Clone, Debug)]
pub enum Plant {
    /// One-axis body.
    OneAxis(Box<OneAxisPlant>),
    /// Three-axis body.
    ThreeAxis(Box<ThreeAxisPlant>),
}

impl Plant {
    /// Creates the plant of a scenario at the start, without loads.
    pub fn new(scenario: &Scenario) -> Self {
        match scenario.model.axes() {
            BodyAxes::One(body) => Self::OneAxis(Box::new(OneAxisPlant::new(scenario, body))),
            BodyAxes::Three(body) => {
                let plant = ThreeAxisPlant::new(body, scenario.model.flexible(), &scenario.study);
                Self::ThreeAxis(Box::new(plant.drifting(body, scenario.drift.as_ref())))
            }
        }
    }

    /// Integrates motions without a closed form up to `now`, unless the record fails; returns the earlier instant at
    /// which it stopped because a wheel stuck or let go.
    pub fn advance(&mut self, now: Instant, record: &mut dyn Record) -> Result<Option<Instant>, RecordError> {
        match self {
            Self::OneAxis(plant) => plant.approach(now, record).map(|()| None),
            Self::ThreeAxis(plant) => plant.approach(now, record),
        }
    }

    /// Returns the states of the wheels in bearings at the current instant.
    pub fn wheel_bearings(&self) -> Vec<RotorObservation> {
        if let Self::ThreeAxis(plant) = self { plant.wheel_bearings() } else { Vec::new() }
    }

    /// Advances the body to `now`, evaluates the true state, and returns it.
    #[inline]
    pub fn evaluate(&mut self, now: Instant) -> Result<&Truth, SimulationError> {
        let truth = match self {
            Self::OneAxis(plant) => plant.evaluate(now),
            Self::ThreeAxis(plant) => plant.measurable(),
        };
        truth.ok_or(SimulationError::NonFinite { at: now })
    }

    /// Returns the true state of the last evaluation.
    #[inline]
    pub fn truth(&self) -> &Truth {
        match self {
            Self::OneAxis(plant) => plant.viewed(),
            Self::ThreeAxis(plant) => plant.viewed(),
        }
    }

    /// Returns the true state of the last evaluation at the mounting point of a sensor.
    pub fn truth_at_sensor(&self, sensor: usize) -> Cow<'_, Truth> {
        match self {
            Self::ThreeAxis(plant) if sensor > 0 => Cow::Owned(plant.at_sensor(sensor)),
            _ => Cow::Borrowed(self.truth()),
        }
    }

    /// Returns an upper bound on the frequencies in a three-axis motion at the current instant (rad/s); 0 for one axis.
    pub fn fastest_frequency(&self) -> f64 {
        if let Self::ThreeAxis(plant) = self { plant.fastest() } else { 0.0 }
    }

    /// Begins a motion segment at the current instant, under the loads from now on.
    pub fn begin_segment(&mut self, wrench: &Wrench) {
        match self {
            Self::OneAxis(plant) => plant.depart(wrench),
            Self::ThreeAxis(plant) => plant.depart(wrench),
        }
    }

    /// Returns the instant and index of the first guard crossing within `horizon`; `None` also for motions without a
    /// closed form.
    #[inline]
    pub fn crossing(
        &mut self,
        guards: &[Guard],
        horizon: Span,
        record: &mut dyn Record,
    ) -> Result<Option<(Instant, usize)>, RecordError> {
        match self {
            Self::OneAxis(plant) => plant.trip(guards, horizon, record),
            Self::ThreeAxis(_) => Ok(None),
        }
    }

    /// Records the one-axis motion of the segment that ends at `now`, piece by piece, if the record wants it.
    pub fn record_pieces(
        &self,
        now: Instant,
        exerted: &AppliedTorque,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        let Self::OneAxis(plant) = self else { return Ok(()) };
        plant.record_pieces(now, exerted, record)
    }

    /// Returns the modal state for the monitor of the envelope: that of one axis, or the rotations of the first sensor
    /// by the modes of three axes.
    pub fn modal_state(&self) -> Cow<'_, AxisState> {
        match self {
            Self::OneAxis(plant) => Cow::Borrowed(plant.state()),
            Self::ThreeAxis(plant) => Cow::Owned(plant.swings()),
        }
    }

    /// Updates the monitor of the envelope with what excites the modes from now on: a torque (N m) on those of one
    /// axis, the commanded wrench on those of three axes.
    pub fn update_monitor(
        &self,
        monitor: &mut WindowedEnvelope,
        now: Instant,
        torque: f64,
        commanded: impl FnOnce() -> Wrench,
    ) {
        match self {
            Self::OneAxis(plant) => monitor.command(now, plant.state(), torque),
            Self::ThreeAxis(plant) => monitor.push(now, &plant.swings(), &plant.modal_forces(&commanded())),
        }
    }

    /// Returns the motion about an axis as if that axis were alone; for three axes, with angles counted from `target`.
    pub fn about_axis(&self, axis: usize, target: &Orientation) -> Cow<'_, AxisState> {
        match self {
            Self::OneAxis(plant) => Cow::Borrowed(plant.state()),
            Self::ThreeAxis(plant) => Cow::Owned(plant.about(axis, target)),
        }
    }
}
