//! Accelerometers of a run: neither estimators nor laws read them; their samples go to the record.

use flexsc_control::sensor::{Accelerometer, AccelerometerState, MeasuredAcceleration};
use flexsc_numerics::random::Seed;
use flexsc_numerics::time::Instant;
use flexsc_record::{Accelerations, Record, RecordError, Sample};

use crate::plant::AccelerometerMount;
use crate::run_view::RunView;
use flexsc_scenario::Scenario;

/// Run-time state of the accelerometers.
#[derive(Clone, Debug)]
pub struct Accelerometers(Vec<MountedAccelerometer>);

/// Accelerometer at its mount.
#[derive(Clone, Debug)]
struct MountedAccelerometer {
    /// Index among the sensors.
    index: usize,
    mount: AccelerometerMount,
    state: AccelerometerState,
    /// Instant at which the last sample became available, and its measured values (m/s²).
    latest: Option<(Instant, Vec<f64>)>,
}

impl Accelerometers {
    /// Creates the accelerometers of a scenario, before its start.
    pub fn new(scenario: &Scenario, run: u64) -> Self {
        let seed = Seed { scenario: scenario.seed, run };
        let of = |(index, accelerometer): (usize, &Accelerometer)| {
            let point = scenario.study.sensor_points.get(index)?;
            let mount = AccelerometerMount::new(
                scenario.model.three_axis()?,
                scenario.model.spacecraft()?.mass,
                point,
            );
            let state = AccelerometerState::new(accelerometer, seed, scenario.sensor.index_in_kind(index));
            Some(MountedAccelerometer { index, mount, state, latest: None })
        };
        Self(scenario.sensor.accelerometers().filter_map(of).collect())
    }

    /// Returns the next instant at which an accelerometer samples or has a sample ready.
    pub fn due(&self) -> Option<Instant> {
        self.0.iter().map(|mounted| mounted.state.due()).min()
    }

    /// Returns the last sample of a sensor (m/s²) and the instant at which it became available.
    pub fn latest(&self, sensor: usize) -> Option<(Instant, &[f64])> {
        let mounted = self.0.iter().find(|mounted| mounted.index == sensor)?;
        mounted.latest.as_ref().map(|(at, values)| (*at, &values[..]))
    }

    /// Samples the accelerometers that are due, after all loads have changed, and records the samples whose latency has
    /// elapsed.
    pub fn record_due(&mut self, run: &RunView<'_>, record: &mut dyn Record) -> Result<(), RecordError> {
        let now = run.now;
        if self.due().is_none_or(|due| due > now) {
            return Ok(());
        }
        for MountedAccelerometer { index, mount, state, latest } in &mut self.0 {
            if state.samples_now(now) {
                state.sample(now, &run.plant.specific_force(mount));
            }
            while let Some(felt) = state.take_due(now) {
                *latest = Some((now, felt.iter().map(|sample| sample.measured).collect()));
                let axes = felt.iter().map(MeasuredAcceleration::row).collect();
                record.record(now, Sample::Row(&Accelerations { sensor: *index as u64, axes }))?;
            }
        }
        Ok(())
    }
}
