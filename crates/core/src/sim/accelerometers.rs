//! Accelerometers of a run: neither estimators nor laws read them; their samples go to the record.

use flexsc_control::sensor::{Accelerometer, AccelerometerState, MeasuredAcceleration};
use flexsc_numerics::random::Seed;
use flexsc_numerics::time::Instant;
use flexsc_record::{Accelerations, Record, Sample};

use super::plant::{AccelerometerMount, Plant};
use super::{Simulation, SimulationError};
use crate::scenario::Scenario;

/// Run-time state of the accelerometers, each with its index among the sensors and its mount.
#[derive(Clone, Debug)]
pub struct Accelerometers(Vec<(usize, AccelerometerMount, AccelerometerState)>);

impl Accelerometers {
    /// Creates the accelerometers of a scenario, before its start.
    pub fn new(scenario: &Scenario, run: u64) -> Self {
        let seed = Seed { scenario: scenario.seed, run };
        let of = |(index, accelerometer): (usize, &Accelerometer)| {
            let point = scenario.study.sensor_points.get(index)?;
            let mount =
                AccelerometerMount::new(scenario.model.spatial()?, scenario.model.craft()?.mass, point);
            Some((index, mount, accelerometer.start(seed, scenario.sensor.index_in_kind(index))))
        };
        Self(scenario.sensor.accelerometers().filter_map(of).collect())
    }

    /// Returns the next instant at which an accelerometer samples or has a sample ready.
    pub fn due(&self) -> Option<Instant> {
        self.0.iter().map(|(.., sensor)| sensor.due()).min()
    }
}

impl Simulation {
    /// Samples the accelerometers that are due, after all loads have changed, and records the samples whose latency has
    /// elapsed.
    pub(super) fn record_accelerations(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.now;
        if self.recorder.accelerometers.due().is_none_or(|due| due > now) {
            return Ok(());
        }
        self.plant.evaluate(now)?;
        let Plant::ThreeAxis(plant) = &self.plant else { return Ok(()) };
        for (index, mount, sensor) in &mut self.recorder.accelerometers.0 {
            if sensor.samples_now(now) {
                sensor.sample(now, &plant.specific_force(mount));
            }
            while let Some(felt) = sensor.take_due(now) {
                let axes = felt.iter().map(MeasuredAcceleration::row).collect();
                let row = Accelerations { sensor: *index as u64, axes };
                record.record(now, Sample::Row(&row))?;
            }
        }
        Ok(())
    }
}
