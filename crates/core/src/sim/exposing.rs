//! Star-tracker exposures: the mean attitude over each is computed from a copy of the plant, one smooth motion segment
//! after another.
//!
//! Loads change at segment starts that are not known in advance, so a segment is averaged when it is over. The plant of
//! the run itself is never moved back.

use super::plant::Plant;
use super::sensing::Sensing;
use super::{Simulation, SimulationError};
use crate::numerics::quadrature;
use crate::record::Record;
use crate::scenario::Scenario;
use crate::sensor::{Exposure, Orientation};
use crate::time::{Instant, Span};

/// Exposures of all star trackers of a run.
#[derive(Clone, Debug)]
pub struct Exposures {
    shutters: Vec<Shutter>,
    /// Copy of the plant in the current segment, while an exposure is open; `averaged` is the instant up to which the
    /// mean is accumulated.
    copy: Option<Plant>,
    averaged: Instant,
}

/// Exposure timing of one star tracker.
#[derive(Clone, Debug)]
struct Shutter {
    /// Index among the sensors.
    sensor: usize,
    period: Span,
    /// Half the exposure time.
    half: Span,
    /// Middle of the exposure that is open or comes next.
    middle: Instant,
    /// Instant at which the exposure closes or opens next.
    due: Instant,
    is_open: bool,
    exposure: Exposure,
}

impl Exposures {
    /// Creates the exposures of a scenario, before its start.
    pub fn new(scenario: &Scenario) -> Self {
        let shutter = |(sensor, [period, half]): (usize, [Span; 2])| Shutter {
            sensor,
            period,
            half,
            middle: Instant::START + period,
            due: (Instant::START + period).before(half),
            is_open: false,
            exposure: Exposure::default(),
        };
        let shutters = scenario.sensor.exposed().map(shutter).collect();
        Self { shutters, copy: None, averaged: Instant::START }
    }

    /// Returns the next instant at which an exposure opens or closes.
    pub fn due(&self) -> Option<Instant> {
        self.shutters.iter().map(|shutter| shutter.due).min()
    }

    /// Copies the plant before it advances from `now`, if an exposure is open and there is no copy of this segment.
    pub fn copy_body(&mut self, now: Instant, plant: &Plant) {
        if self.copy.is_none() && self.shutters.iter().any(|shutter| shutter.is_open) {
            (self.copy, self.averaged) = (Some(plant.clone()), now);
        }
    }

    /// Discards the copy at the end of its segment.
    pub fn drop_copy(&mut self) {
        self.copy = None;
    }

    /// Closes and opens the exposures that are due, and hands the means of closed ones to their sensors.
    fn serve(&mut self, now: Instant, sensing: &mut Sensing) {
        for shutter in self.shutters.iter_mut().filter(|shutter| shutter.due <= now) {
            if shutter.is_open {
                sensing.gather(shutter.sensor, &shutter.exposure);
                shutter.exposure.clear();
                shutter.middle += shutter.period;
                // Two rounded halves may exceed the period by a tick.
                shutter.due = shutter.middle.before(shutter.half).max(now);
                shutter.is_open = false;
            }
            if shutter.due == now {
                shutter.due = shutter.middle + shutter.half;
                shutter.is_open = true;
            }
        }
        if self.shutters.iter().all(|shutter| !shutter.is_open) {
            self.drop_copy();
        }
    }
}

impl Simulation {
    /// Closes and opens the exposures that are due at the current instant.
    pub(super) fn expose(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        if self.exposures.due().is_some_and(|due| due <= self.now) {
            self.average(record)?;
            self.exposures.serve(self.now, &mut self.sensing);
        }
        Ok(())
    }

    /// Accumulates the mean of open exposures from the last averaged instant up to now.
    pub(super) fn average(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let (Exposures { shutters, copy, averaged }, now) = (&mut self.exposures, self.now);
        let Some(plant) = copy.as_mut().filter(|_| now > *averaged) else { return Ok(()) };
        let from = std::mem::replace(averaged, now);
        let fastest = plant.fastest().max(self.plant.fastest());
        for (t, lasts) in quadrature::nodes(now.since(from).seconds(), fastest) {
            let at = from + Span::from_seconds(t);
            plant.approach(at, record)?;
            plant.view(at)?;
            for shutter in shutters.iter_mut().filter(|shutter| shutter.is_open) {
                let truth = plant.at_sensor(shutter.sensor);
                if let Orientation::Attitude(attitude) = truth.orientation.at(truth.seen()) {
                    shutter.exposure.see(attitude, lasts);
                }
            }
        }
        Ok(())
    }
}
