//! The body on its way: one angle in closed form wherever there is one, or three axes.

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

/// What there is to measure before anything is looked at.
const UNSEEN: Truth = Truth {
    orientation: Orientation::Angle(0.0),
    elastic: [0.0; 3],
    rate: [0.0; 3],
    rigid: [0.0; 3],
    turned: [0.0; 3],
    sky: SkySight { field: None, sun: None },
};

/// A body that moves.
#[derive(Clone, Debug)]
pub enum Plant {
    /// With one angle.
    Planar(Box<PlanarPlant>),
    /// With three axes.
    Spatial(Box<SpatialPlant>),
}

impl Plant {
    /// The body of a scenario at the start, under nothing.
    pub fn new(scenario: &Scenario) -> Self {
        match scenario.model.axes() {
            Axes::One(body) => Self::Planar(Box::new(PlanarPlant::new(scenario, body))),
            Axes::Three(body) => {
                let plant = SpatialPlant::new(body, scenario.model.flexible(), &scenario.study);
                Self::Spatial(Box::new(plant.drifting(body, scenario.drift.as_ref())))
            }
        }
    }

    /// Integrates up to an instant what has no closed form, as long as the record lets it; tells the instant before, at which it
    /// stopped because a wheel came to rest or let go.
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

    /// Wheels in bearings at the instant seen last.
    pub fn borne(&self) -> Vec<SlippedRotor> {
        if let Self::Spatial(plant) = self { plant.borne() } else { Vec::new() }
    }

    /// What there is to measure at an instant, to which the body is brought.
    #[inline]
    pub fn view(&mut self, now: Instant) -> Result<&Truth, SimulationError> {
        let truth = match self {
            Self::Planar(plant) => plant.measurable(now),
            Self::Spatial(plant) => plant.measurable(),
        };
        truth.ok_or(SimulationError::NonFinite { at: now })
    }

    /// What there was to measure at the instant viewed last.
    #[inline]
    pub fn viewed(&self) -> &Truth {
        match self {
            Self::Planar(plant) => plant.viewed(),
            Self::Spatial(plant) => plant.viewed(),
        }
    }

    /// The same at a sensor other than the first, which may be elsewhere.
    pub fn at_sensor(&self, sensor: usize) -> Cow<'_, Truth> {
        match self {
            Self::Spatial(plant) if sensor > 0 => Cow::Owned(plant.at_sensor(sensor)),
            _ => Cow::Borrowed(self.viewed()),
        }
    }

    /// No part of the motion about three axes changes faster at the instant seen last (rad/s).
    pub fn fastest(&self) -> f64 {
        if let Self::Spatial(plant) = self { plant.fastest() } else { 0.0 }
    }

    /// Begins a new motion at the instant seen last, under what acts from now on.
    pub fn depart(&mut self, wrench: &Wrench) {
        match self {
            Self::Planar(plant) => plant.depart(wrench),
            Self::Spatial(plant) => plant.depart(wrench),
        }
    }

    /// The instant and index of the guard that trips first on this motion, within a span; known in closed form alone.
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

    /// Tells the motion that ends now, stretch by stretch, where the record wants it and the body has one angle.
    pub fn tell_course(
        &self,
        now: Instant,
        exerted: &Exerted,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        let Self::Planar(plant) = self else { return Ok(()) };
        plant.tell_course(now, exerted, record)
    }

    /// The modes as the monitor of the envelope takes them: those of one angle, or the rotations that those of three axes give the
    /// first sensor.
    pub fn swings(&self) -> Cow<'_, State> {
        match self {
            Self::Planar(plant) => Cow::Borrowed(plant.state()),
            Self::Spatial(plant) => Cow::Owned(plant.swings()),
        }
    }

    /// Lets the monitor of the envelope know what acts on the modes from now on: a torque (N m) on those of one angle, what is
    /// commanded on those of three axes.
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

    /// The motion about an axis, of three axes beyond a target, as if that axis were alone.
    pub fn about(&self, axis: usize, target: &Orientation) -> Cow<'_, State> {
        match self {
            Self::Planar(plant) => Cow::Borrowed(plant.state()),
            Self::Spatial(plant) => Cow::Owned(plant.about(axis, target)),
        }
    }
}
