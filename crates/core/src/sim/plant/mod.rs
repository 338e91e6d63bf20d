//! Plant: model, motion and true state of the body, with one axis in closed form where there is one, or with three
//! axes.

mod lent;
mod planar;
mod spatial;
mod two_way;

use std::borrow::Cow;

use super::SimulationError;
use crate::body::Axes;
use crate::environment::SkySight;
use crate::estimator::Monitor;
use crate::guard::Guard;
use crate::motion::State;
use crate::motion::turning::SlippedRotor;
use crate::record::{Record, RecordError};
use crate::scenario::Scenario;
use crate::sensor::{Orientation, Truth};
use crate::time::{Instant, Span};
use crate::wrench::Wrench;

pub use planar::{Exerted, PlanarPlant};
pub use spatial::SpatialPlant;
pub use two_way::Mount;

/// True state before the first evaluation.
const UNSEEN: Truth = Truth {
    orientation: Orientation::Angle(0.0),
    elastic: [0.0; 3],
    rate: [0.0; 3],
    rigid: [0.0; 3],
    turned: [0.0; 3],
    sky: SkySight { field: None, sun: None },
};

/// Moving body.
#[derive(Clone, Debug)]
pub enum Plant {
    /// One-axis body.
    Planar(Box<PlanarPlant>),
    /// Three-axis body.
    Spatial(Box<SpatialPlant>),
}

impl Plant {
    /// Creates the plant of a scenario at the start, without loads.
    pub fn new(scenario: &Scenario) -> Self {
        match scenario.model.axes() {
            Axes::One(body) => Self::Planar(Box::new(PlanarPlant::new(scenario, body))),
            Axes::Three(body) => {
                let plant = SpatialPlant::new(body, scenario.model.flexible(), &scenario.study);
                Self::Spatial(Box::new(plant.drifting(body, scenario.drift.as_ref())))
            }
        }
    }

    /// Integrates motions without a closed form up to `now`, unless the record fails; returns the earlier instant at
    /// which it stopped because a wheel stuck or let go.
    pub fn approach(
        &mut self,
        now: Instant,
        record: &mut dyn Record,
    ) -> Result<Option<Instant>, RecordError> {
        match self {
            Self::Planar(plant) => plant.approach(now, record).map(|()| None),
            Self::Spatial(plant) => plant.approach(now, record),
        }
    }

    /// Returns the states of the wheels in bearings at the current instant.
    pub fn borne(&self) -> Vec<SlippedRotor> {
        if let Self::Spatial(plant) = self { plant.borne() } else { Vec::new() }
    }

    /// Advances the body to `now`, evaluates the true state, and returns it.
    #[inline]
    pub fn view(&mut self, now: Instant) -> Result<&Truth, SimulationError> {
        let truth = match self {
            Self::Planar(plant) => plant.measurable(now),
            Self::Spatial(plant) => plant.measurable(),
        };
        truth.ok_or(SimulationError::NonFinite { at: now })
    }

    /// Returns the true state of the last evaluation.
    #[inline]
    pub fn viewed(&self) -> &Truth {
        match self {
            Self::Planar(plant) => plant.viewed(),
            Self::Spatial(plant) => plant.viewed(),
        }
    }

    /// Returns the true state of the last evaluation at the mounting point of a sensor.
    pub fn at_sensor(&self, sensor: usize) -> Cow<'_, Truth> {
        match self {
            Self::Spatial(plant) if sensor > 0 => Cow::Owned(plant.at_sensor(sensor)),
            _ => Cow::Borrowed(self.viewed()),
        }
    }

    /// Returns an upper bound on the frequencies in a three-axis motion at the current instant (rad/s); 0 for one axis.
    pub fn fastest(&self) -> f64 {
        if let Self::Spatial(plant) = self { plant.fastest() } else { 0.0 }
    }

    /// Begins a motion segment at the current instant, under the loads from now on.
    pub fn depart(&mut self, wrench: &Wrench) {
        match self {
            Self::Planar(plant) => plant.depart(wrench),
            Self::Spatial(plant) => plant.depart(wrench),
        }
    }

    /// Returns the instant and index of the first guard crossing within `horizon`; `None` also for motions without a
    /// closed form.
    #[inline]
    pub fn trip(
        &mut self,
        guards: &[Guard],
        horizon: Span,
        record: &mut dyn Record,
    ) -> Result<Option<(Instant, usize)>, RecordError> {
        match self {
            Self::Planar(plant) => plant.trip(guards, horizon, record),
            Self::Spatial(_) => Ok(None),
        }
    }

    /// Records the one-axis motion of the segment that ends at `now`, piece by piece, if the record wants it.
    pub fn tell_course(
        &self,
        now: Instant,
        exerted: &Exerted,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        let Self::Planar(plant) = self else { return Ok(()) };
        plant.tell_course(now, exerted, record)
    }

    /// Returns the modal state for the monitor of the envelope: that of one axis, or the rotations of the first sensor
    /// by the modes of three axes.
    pub fn swings(&self) -> Cow<'_, State> {
        match self {
            Self::Planar(plant) => Cow::Borrowed(plant.state()),
            Self::Spatial(plant) => Cow::Owned(plant.swings()),
        }
    }

    /// Updates the monitor of the envelope with what excites the modes from now on: a torque (N m) on those of one
    /// axis, the commanded wrench on those of three axes.
    pub fn push_monitor(
        &self,
        monitor: &mut Monitor,
        now: Instant,
        torque: f64,
        commanded: impl FnOnce() -> Wrench,
    ) {
        match self {
            Self::Planar(plant) => monitor.command(now, plant.state(), torque),
            Self::Spatial(plant) => monitor.push(now, &plant.swings(), &plant.modal_forces(&commanded())),
        }
    }

    /// Returns the motion about an axis as if that axis were alone; for three axes, with angles counted from `target`.
    pub fn about(&self, axis: usize, target: &Orientation) -> Cow<'_, State> {
        match self {
            Self::Planar(plant) => Cow::Borrowed(plant.state()),
            Self::Spatial(plant) => Cow::Owned(plant.about(axis, target)),
        }
    }
}
