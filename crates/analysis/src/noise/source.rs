//! Sources of noise in a loop: each key of a scenario that draws random numbers, or rounds.
//!
//! A quantum D is taken as white noise of the variance D²/12, independent from sample to sample. That holds where the
//! signal moves over several quanta between samples; it does not describe a limit cycle within a quantum.

use flexsc_control::actuator::{ActuatorKind, ActuatorTask};
use flexsc_control::estimator::attitude::SensorRole;
use flexsc_control::sensor::SensorKind;
use flexsc_control::sensor::linear_noise::{KeyNoise, SensorNoise, diagonal, rounding};
use flexsc_formats::document::ConfigError;
use flexsc_numerics::time::Span;
use flexsc_spacecraft::axes::Axis;
use nalgebra::DMatrix;

use super::mirror_states::MirrorStates;
use crate::open_loop::LoopParts;
use crate::open_loop::attitude_rows::{seconds, ticks};
use flexsc_scenario::Scenario;

/// Point at which the draws of a source enter the loop. Matrices have a row for each axis and a column for each draw of
/// an instant, in standard deviations.
#[derive(Clone, Debug, PartialEq)]
pub enum NoiseEntry {
    /// Measured angle, or attitude.
    Angle(DMatrix<f64>),
    /// Measured rate.
    Rate(DMatrix<f64>),
    /// Bias of the gyro that walks: its change from reading to reading, and white noise of the reading.
    Walk { change: DMatrix<f64>, white: DMatrix<f64> },
    /// Remainder of a rounded angle of the gyro, which its next reading adds.
    Remainder(DMatrix<f64>),
    /// Exponentially correlated part of the gyro's bias, with its decay between readings.
    Wander { decay: f64, change: DMatrix<f64>, own_share: f64, white: DMatrix<f64> },
    /// Command of the law.
    Command(DMatrix<f64>),
    /// Torque about an axis, held from draw to draw.
    Torque { axis: usize, deviation: f64 },
    /// Mean of the guidance sensor of the fine mirror of a line of sight, about each of two axes.
    Mirror { line: usize, deviation: f64 },
}

/// Source of noise.
#[derive(Clone, Debug, PartialEq)]
pub struct NoiseSource {
    /// Key of the scenario.
    pub key: String,
    /// Point of entry.
    pub entry: NoiseEntry,
    /// Time from draw to draw (fs), and the time of the first.
    pub period: i64,
    pub phase: i64,
}

impl From<SensorNoise> for NoiseEntry {
    fn from(noise: SensorNoise) -> Self {
        match noise {
            SensorNoise::Angle(matrix) => Self::Angle(matrix),
            SensorNoise::Rate(matrix) => Self::Rate(matrix),
            SensorNoise::Walk { change, white } => Self::Walk { change, white },
            SensorNoise::Remainder(matrix) => Self::Remainder(matrix),
            SensorNoise::Wander { decay, change, own_share, white } => {
                Self::Wander { decay, change, own_share, white }
            }
        }
    }
}

impl NoiseEntry {
    /// Returns the number of draws at an instant.
    pub fn draws(&self) -> usize {
        match self {
            Self::Angle(matrix) | Self::Rate(matrix) | Self::Remainder(matrix) | Self::Command(matrix) => {
                matrix.ncols()
            }
            Self::Walk { change, .. } | Self::Wander { change, .. } => change.ncols(),
            Self::Torque { .. } => 1,
            Self::Mirror { .. } => 2,
        }
    }

    /// Returns the number of states that remember earlier draws.
    pub fn memory(&self) -> usize {
        match self {
            Self::Remainder(matrix) => matrix.nrows(),
            Self::Wander { change, .. } => change.nrows(),
            Self::Torque { .. } => 1,
            Self::Angle(_) | Self::Rate(_) | Self::Walk { .. } | Self::Command(_) | Self::Mirror { .. } => 0,
        }
    }
}

/// Returns the sources of noise of a scenario's loop.
///
/// # Errors
/// A sensor whose noise has no linear model in this loop: its key, and the reason.
pub fn sources(parts: &LoopParts<'_>) -> Result<Vec<NoiseSource>, ConfigError> {
    let scenario = parts.scenario;
    let mut list = SourceList { axes: parts.body.inputs.len(), found: Vec::new() };
    if parts.parts.attitude.is_some() {
        list.add_fused_sensors(scenario)?;
    } else {
        list.add_only_sensor(scenario, parts.law.period)?;
    }
    list.add_quanta_of_wheels(scenario, parts.law.period.leading_femtoseconds());
    list.add_disturbances(scenario);
    list.add_mirrors(parts);
    Ok(list.found)
}

/// List of sources.
struct SourceList {
    axes: usize,
    found: Vec<NoiseSource>,
}

impl SourceList {
    /// Adds the only sensor of a loop with one period.
    fn add_only_sensor(&mut self, scenario: &Scenario, period: Span) -> Result<(), ConfigError> {
        let (key, sensor) = (scenario.sensor_key(0), scenario.sensor.first());
        if let Some((within, why)) = sensor.noise_fault(period) {
            return Err(ConfigError::new(format!("{key}.{within}"), why));
        }
        self.add_sensor(&key, sensor, period.leading_femtoseconds());
        Ok(())
    }

    /// Adds the sensors that an attitude filter reads.
    fn add_fused_sensors(&mut self, scenario: &Scenario) -> Result<(), ConfigError> {
        let Some(setting) = &scenario.study.attitude else { return Ok(()) };
        for (index, role) in setting.roles.iter().enumerate() {
            let (key, sensor) = (scenario.sensor_key(index), &scenario.sensor[index]);
            let own = sensor.period(scenario.study.law_period).or(scenario.study.sample_period);
            let period = own.map_or(0, |own| ticks(own.seconds()));
            if !matches!(role, SensorRole::None) && !self.add_sensor(&key, sensor, period) {
                return Err(ConfigError::new(key, "has noise without a linear model in this loop"));
            }
        }
        Ok(())
    }

    /// Adds a sensor with a reading after each `period` (fs); false if its noise has no linear model.
    fn add_sensor(&mut self, key: &str, sensor: &SensorKind, period: i64) -> bool {
        let Some(noise) = sensor.linear_noise(self.axes, seconds(period)) else { return false };
        let source = |(within, noise): KeyNoise| NoiseSource {
            key: format!("{key}.{within}"),
            entry: NoiseEntry::from(noise),
            period,
            phase: 0,
        };
        self.found.extend(noise.into_iter().map(source));
        true
    }

    fn add_quanta_of_wheels(&mut self, scenario: &Scenario, period: i64) {
        for member in scenario.actuator.members() {
            let (ActuatorTask::Executes(_), ActuatorKind::Wheel(wheel)) = (&member.task, &*member.kind)
            else {
                continue;
            };
            let entry = diagonal(self.axes, |_| rounding(wheel.quantum.get())).map(NoiseEntry::Command);
            let key = format!("{}.quantum", member.key);
            self.found.extend(entry.map(|entry| NoiseSource { key, entry, period, phase: 0 }));
        }
    }

    fn add_mirrors(&mut self, parts: &LoopParts<'_>) {
        for MirrorStates { line, mirror, period, .. } in &parts.mirrors {
            if mirror.noise.get() > 0.0 {
                self.found.push(NoiseSource {
                    key: format!("line_of_sight[{line}].mirror.noise"),
                    entry: NoiseEntry::Mirror { line: *line, deviation: mirror.noise.get() },
                    period: *period,
                    phase: 0,
                });
            }
        }
    }

    fn add_disturbances(&mut self, scenario: &Scenario) {
        for (index, disturbance) in scenario.disturbance.iter().enumerate() {
            let (noise, Some(period)) = (disturbance.noise.get(), disturbance.period) else { continue };
            if noise > 0.0 {
                let axis = disturbance.about.map_or(0, Axis::index);
                let deviation = f64::sqrt(noise / period.seconds());
                let period = period.leading_femtoseconds();
                self.found.push(NoiseSource {
                    key: format!("disturbance[{index}].noise"),
                    entry: NoiseEntry::Torque { axis, deviation },
                    period,
                    phase: ticks(disturbance.from.get()) % period,
                });
            }
        }
    }
}
