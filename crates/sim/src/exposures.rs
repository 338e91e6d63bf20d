//! Star-tracker exposures: the mean attitude over each is computed from a copy of the plant, one smooth motion segment
//! after another.

use flexsc_control::sensor::ExposureMean;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::Record;

use super::SimulationError;
use super::plant::Plant;
use super::segment_copy::SegmentCopy;
use super::sensor_schedule::SensorSchedule;
use flexsc_scenario::Scenario;

/// Exposures of all star trackers of a run.
#[derive(Clone, Debug)]
pub struct Exposures {
    shutters: Vec<ExposureTiming>,
    /// Copy of the plant in the current segment, while an exposure is open.
    copy: SegmentCopy,
}

/// Exposure timing of one star tracker.
#[derive(Clone, Debug)]
struct ExposureTiming {
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
    exposure: ExposureMean,
}

impl Exposures {
    /// Creates the exposures of a scenario, before its start.
    pub fn new(scenario: &Scenario) -> Self {
        let shutter = |(sensor, [period, half]): (usize, [Span; 2])| ExposureTiming {
            sensor,
            period,
            half,
            middle: Instant::START + period,
            due: (Instant::START + period).before(half),
            is_open: false,
            exposure: ExposureMean::default(),
        };
        let shutters = scenario.sensor.exposures().map(shutter).collect();
        Self { shutters, copy: SegmentCopy::new() }
    }

    /// Returns the next instant at which an exposure opens or closes.
    #[inline]
    pub fn due(&self) -> Option<Instant> {
        self.shutters.iter().map(|shutter| shutter.due).min()
    }

    /// Copies the plant before it advances from `now`, if an exposure is open and there is no copy of this segment.
    #[inline]
    pub fn copy_plant(&mut self, now: Instant, plant: &Plant) {
        if self.shutters.iter().any(|shutter| shutter.is_open) {
            self.copy.begin(now, plant);
        }
    }

    /// Closes and opens the exposures that are due, and hands the means of closed ones to their sensors.
    fn close_and_open(&mut self, now: Instant, sensors: &mut [SensorSchedule]) {
        for shutter in self.shutters.iter_mut().filter(|shutter| shutter.due <= now) {
            if shutter.is_open {
                sensors[shutter.sensor].close_exposure(&shutter.exposure);
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
            self.copy.end();
        }
    }
}

impl Exposures {
    /// Closes and opens the exposures that are due at `now`, at which the plant is evaluated.
    #[inline]
    pub fn update(
        &mut self,
        now: Instant,
        plant: &Plant,
        sensors: &mut [SensorSchedule],
        record: &mut dyn Record,
    ) -> Result<(), SimulationError> {
        if self.due().is_some_and(|due| due <= now) {
            self.accumulate_mean(now, plant, record)?;
            self.close_and_open(now, sensors);
        }
        Ok(())
    }

    /// Ends the segment of the copy at `now`, before the body of the run begins its next segment.
    #[inline]
    pub fn end_segment(
        &mut self,
        now: Instant,
        plant: &Plant,
        record: &mut dyn Record,
    ) -> Result<(), SimulationError> {
        self.accumulate_mean(now, plant, record)?;
        self.copy.end();
        Ok(())
    }

    /// Accumulates the mean of open exposures from the last averaged instant up to `now`.
    #[inline]
    fn accumulate_mean(
        &mut self,
        now: Instant,
        plant: &Plant,
        record: &mut dyn Record,
    ) -> Result<(), SimulationError> {
        let Self { shutters, copy } = self;
        copy.average(now, plant, record, |copy, _, lasts| {
            for shutter in shutters.iter_mut().filter(|shutter| shutter.is_open) {
                let truth = copy.truth_at_sensor(shutter.sensor);
                if let Some(attitude) = truth.orientation.rotated_by(truth.sensor_angles()).attitude() {
                    shutter.exposure.add(attitude, lasts);
                }
            }
        })
    }
}
