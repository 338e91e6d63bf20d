//! Attitude filter with settled gains, as part of a linear loop: gain, sensors, and rotation of the sensor mounts by
//! the modes.

use flexsc_control::estimator::AttitudeFilter;
use flexsc_control::estimator::attitude::{GainMethod, SensorRole};
use flexsc_formats::document::ConfigError;
use flexsc_numerics::time::Span;
use serde::Serialize;

use flexsc_scenario::Scenario;

/// Settled attitude filter: from the predicted angle a, a measured attitude z corrects the state by k (z - a).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LinearAttitudeFilter {
    /// Gyro of the filter.
    pub gyro: MountedSensor,
    /// Sensor that measures the attitude.
    pub sensor: MountedSensor,
    /// Gain k: three rows for the attitude (rad/rad), and three for the bias of the gyro (1/s).
    pub gain: Vec<[f64; 3]>,
}

/// Sensor of an attitude filter, and its mount on the flexible body.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MountedSensor {
    /// Sampling period (s).
    pub period: f64,
    /// Latency of the samples (s).
    pub latency: f64,
    /// Time over which a sample is the mean (s), about its middle; 0 for the attitude at an instant.
    pub exposure: f64,
    /// True if the sensor reports the mean rate over each sampling period.
    pub integrates: bool,
    /// Rotation of the mount about each axis for a unit displacement of each mode (rad/(m sqrt(kg))).
    pub turned: Vec<[f64; 3]>,
}

impl LinearAttitudeFilter {
    /// Returns the settled form of a scenario's attitude filter.
    ///
    /// # Errors
    /// A filter whose gains do not settle to one gain, or that models modes: the key within the filter, and the reason.
    pub fn from_scenario(scenario: &Scenario, filter: &AttitudeFilter) -> Result<Self, ConfigError> {
        if filter.elastic.is_some() {
            return Err(ConfigError::new("elastic", "is not supported in linear loops: leave it out"));
        }
        let settings = &scenario.study;
        let (Some(setting), Some(body)) = (&settings.attitude, scenario.model.three_axis()) else {
            return Err(ConfigError::new("", "needs a body with three axes"));
        };
        let mounted = |index: usize, latency: f64| {
            let sensor = &scenario.sensor[index];
            let shapes = body.shapes(settings.sensor_points.get(index).map_or("", String::as_str));
            MountedSensor {
                period: sensor
                    .period(settings.law_period)
                    .or(settings.sample_period)
                    .map_or(0.0, Span::seconds),
                latency,
                exposure: sensor.exposure().seconds(),
                integrates: sensor.integrates(),
                turned: shapes.iter().map(|(_, rotation)| (*rotation).into()).collect(),
            }
        };
        let mut found = (None, None);
        for (index, role) in setting.roles.iter().enumerate() {
            match role {
                SensorRole::None => {}
                SensorRole::Gyro { latency } => found.0 = Some(mounted(index, latency.seconds())),
                SensorRole::Corrects { .. } if scenario.sensor[index].measures_vector() => {
                    let why = format!(
                        "reads the directions of `{}`, with which its gains change with the attitude and do not settle, so that there \
                         is no linear loop: linear tools take a filter with a gyro and one `star_tracker` or `sampled` sensor, \
                         which `sensors` of a `[[mode]]` chooses; others are simulated",
                        scenario.sensor_key(index)
                    );
                    return Err(ConfigError::new("", why));
                }
                SensorRole::Corrects { .. } if found.1.is_some() => {
                    let why = format!(
                        "reads `{}` beside another sensor of the attitude, so that its gains change from sample to sample and do not \
                         settle to one: linear tools take a filter with a gyro and one `star_tracker` or `sampled` sensor, \
                         which `sensors` of a `[[mode]]` chooses; others are simulated",
                        scenario.sensor_key(index)
                    );
                    return Err(ConfigError::new("", why));
                }
                SensorRole::Corrects { latency, noise, gain } => {
                    let sensor = mounted(index, latency.seconds());
                    let settled = || GainMethod::Steady.gain(&setting.noise, sensor.period, noise);
                    let gain = gain.as_deref().copied().or_else(settled).unwrap_or_default();
                    let rows = gain.row_iter().map(|row| [row[0], row[1], row[2]]).collect();
                    found.1 = Some((sensor, rows));
                }
            }
        }
        // The setting has a gyro and an attitude sensor.
        let (Some(gyro), Some((sensor, gain))) = found else {
            return Err(ConfigError::new("", "needs a gyro and a sensor of the attitude"));
        };
        Ok(Self { gyro, sensor, gain })
    }
}
