//! Exposures of star trackers: the mean over each is taken in a copy of the body, one smooth piece of the motion after another.
//!
//! What acts on the body changes at departures, which are not known ahead: a piece is averaged when it is over. The body of the run
//! itself is not moved back.

use super::plant::Plant;
use super::sensing::Sensing;
use super::{Simulation, SimulationError};
use crate::numerics::quadrature;
use crate::record::Record;
use crate::scenario::Scenario;
use crate::sensor::{Exposure, Orientation};
use crate::time::{Instant, Span};

/// The exposures of a run.
#[derive(Clone, Debug)]
pub struct Exposures {
    shutters: Vec<Shutter>,
    /// While an exposure is open, a copy of the body that departed as the run's did, and the instant up to which the mean is taken.
    copy: Option<Plant>,
    averaged: Instant,
}

/// What lets light into a tracker.
#[derive(Clone, Debug)]
struct Shutter {
    /// Its place among the sensors.
    sensor: usize,
    period: Span,
    /// Half an exposure.
    half: Span,
    /// The middle of the exposure that is open or comes next.
    middle: Instant,
    /// When it closes or opens.
    due: Instant,
    is_open: bool,
    exposure: Exposure,
}

impl Exposures {
    /// Those of a scenario, before its start.
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

    /// When one opens or closes next.
    pub fn due(&self) -> Option<Instant> {
        self.shutters.iter().map(|shutter| shutter.due).min()
    }

    /// Copies the body before it moves on from now, if an exposure is open and there is no copy of this motion.
    pub fn copy_body(&mut self, now: Instant, plant: &Plant) {
        if self.copy.is_none() && self.shutters.iter().any(|shutter| shutter.is_open) {
            (self.copy, self.averaged) = (Some(plant.clone()), now);
        }
    }

    /// Drops the copy: its motion ends.
    pub fn drop_copy(&mut self) {
        self.copy = None;
    }

    /// Closes and opens what is due now; sensors take what they gathered.
    fn serve(&mut self, now: Instant, sensing: &mut Sensing) {
        for shutter in self.shutters.iter_mut().filter(|shutter| shutter.due <= now) {
            if shutter.is_open {
                sensing.gather(shutter.sensor, &shutter.exposure);
                shutter.exposure.clear();
                shutter.middle += shutter.period;
                // Two halves may be rounded to a tick more than the period.
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
    /// Closes and opens the exposures that are due now.
    pub(super) fn expose(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        if self.exposures.due().is_some_and(|due| due <= self.now) {
            self.average(record)?;
            self.exposures.serve(self.now, &mut self.sensing);
        }
        Ok(())
    }

    /// Averages the motion up to now, of which the mean is not taken yet, where an exposure is open.
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
