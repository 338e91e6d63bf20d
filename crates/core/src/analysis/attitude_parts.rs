//! An attitude filter whose gains have settled, as part of a linear loop: its gain, its sensors, and how modes turn their mounts.

use serde::Serialize;

use crate::document::Fault;
use crate::estimator::AttitudeFilter;
use crate::estimator::attitude::{Form, Role};
use crate::scenario::Scenario;
use crate::time::Span;

/// The filter: beyond the angle a that it expects, an attitude z corrects by k (z - a).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AttitudeParts {
    /// The gyro.
    pub gyro: MountedSensor,
    /// The sensor of the attitude.
    pub sensor: MountedSensor,
    /// k: three rows for the attitude (rad/rad), and three for the bias of the gyro (1/s).
    pub gain: Vec<[f64; 3]>,
}

/// A sensor of an attitude filter.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MountedSensor {
    /// Period of its samples (s).
    pub period: f64,
    /// How late it reports them (s).
    pub latency: f64,
    /// Whether it reports the mean rate of its periods.
    pub integrates: bool,
    /// By how much a unit of each mode turns its mount about each axis (rad/(m sqrt(kg))).
    pub turned: Vec<[f64; 3]>,
}

impl AttitudeParts {
    /// The filter of a scenario.
    ///
    /// # Errors
    /// A filter whose gains do not settle to one gain, or that knows modes: the key within the filter, and why.
    pub fn of(scenario: &Scenario, filter: &AttitudeFilter) -> Result<Self, Fault> {
        if filter.elastic.is_some() {
            return Err(Fault::new("elastic", "is not supported in linear loops: leave it out"));
        }
        let study = &scenario.study;
        let (Some(setting), Some(body)) = (&study.attitude, scenario.model.spatial()) else {
            return Err(Fault::new("", "needs a body with three axes"));
        };
        let mounted = |index: usize, latency: f64| {
            let sensor = &scenario.sensor[index];
            let shapes = body.shapes(study.sensed_at.get(index).map_or("", String::as_str));
            MountedSensor {
                period: sensor.period(study.cycle).or(study.sampling).map_or(0.0, Span::seconds),
                latency,
                integrates: sensor.integrates(),
                turned: shapes.iter().map(|(_, rotation)| (*rotation).into()).collect(),
            }
        };
        let mut found = (None, None);
        for (index, role) in setting.roles.iter().enumerate() {
            match role {
                Role::None => {}
                Role::Gyro { .. } => found.0 = Some(mounted(index, 0.0)),
                Role::Corrects { .. } if found.1.is_some() || scenario.sensor[index].is_of_a_vector() => {
                    let why = "has gains that settle only with one sensor of the attitude and none of vectors: a loop has \
                               one `star_tracker` or `sampled` sensor";
                    return Err(Fault::new("", why));
                }
                Role::Corrects { latency, noise, gain } => {
                    let sensor = mounted(index, latency.seconds());
                    let settled = || Form::Steady.gain(&setting.noise, sensor.period, noise);
                    let gain = gain.as_deref().copied().or_else(settled).unwrap_or_default();
                    let rows = gain.row_iter().map(|row| [row[0], row[1], row[2]]).collect();
                    found.1 = Some((sensor, rows));
                }
            }
        }
        // The setting has both.
        let (Some(gyro), Some((sensor, gain))) = found else {
            return Err(Fault::new("", "needs a gyro and a sensor of the attitude"));
        };
        Ok(Self { gyro, sensor, gain })
    }
}
