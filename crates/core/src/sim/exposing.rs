//! Exposures of star trackers: behind the run comes a copy of its body, which looks at each motion that ends within one.
//!
//! What acts on the body changes at departures, and no exposure knows of the next before: so the mean over it is taken piece by
//! piece, each over a smooth motion that is over. The body of the run itself is not looked at.

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
    /// A body in the present motion, behind that of the run, if an exposure is open; and until when it has looked.
    behind: Option<Plant>,
    looked: Instant,
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
        Self { shutters, behind: None, looked: Instant::START }
    }

    /// When one opens or closes next.
    pub fn due(&self) -> Option<Instant> {
        self.shutters.iter().map(|shutter| shutter.due).min()
    }

    /// Makes a body stay behind that of the run, which goes on from now, if an exposure is open.
    pub fn stay(&mut self, now: Instant, plant: &Plant) {
        if self.behind.is_none() && self.shutters.iter().any(|shutter| shutter.is_open) {
            (self.behind, self.looked) = (Some(plant.clone()), now);
        }
    }

    /// The present motion ends.
    pub fn part(&mut self) {
        self.behind = None;
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
            self.part();
        }
    }
}

impl Simulation {
    /// Closes and opens the exposures that are due now.
    pub(super) fn expose(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        if self.exposures.due().is_some_and(|due| due <= self.now) {
            self.look_back(record)?;
            self.exposures.serve(self.now, &mut self.sensing);
        }
        Ok(())
    }

    /// Looks at what is new of the present motion until now, where an exposure is open.
    pub(super) fn look_back(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let (Exposures { shutters, behind, looked }, now) = (&mut self.exposures, self.now);
        let Some(plant) = behind.as_mut().filter(|_| now > *looked) else { return Ok(()) };
        let from = std::mem::replace(looked, now);
        let fastest = plant.fastest().max(self.plant.fastest());
        for (t, lasts) in quadrature::nodes(now.since(from).seconds(), fastest) {
            let at = from + Span::from_seconds(t);
            plant.approach(at, record)?;
            let truth = plant.view(at)?;
            for shutter in shutters.iter_mut().filter(|shutter| shutter.is_open) {
                let truth = plant.at_sensor(shutter.sensor, &truth);
                if let Orientation::Attitude(attitude) = truth.orientation.at(truth.seen()) {
                    shutter.exposure.see(attitude, lasts);
                }
            }
        }
        Ok(())
    }
}
