//! The attitude filter as a scenario describes it, and what it makes of the scenario's sensors.

use std::sync::Arc;

use nalgebra::{Matrix3, Matrix6x3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{ElasticStates, Form, GyroNoise, KnownModes};
use crate::attitude::Vector;
use crate::body::Spatial;
use crate::document::Fault;
use crate::estimator::kalman::Prior;
use crate::quantity::{NonNegative, Positive};
use crate::sensor::{Gyro, Sensor};
use crate::time::Span;

/// Estimates the attitude and the gyro bias of a body with three axes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AttitudeFilter {
    /// How the gains are computed.
    #[serde(default)]
    pub form: Form,
    /// Angle random walk of the gyro (rad/sqrt(s)), the same about each axis; default: the largest of the gyro's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angle_random_walk: Option<Positive>,
    /// Rate random walk of the gyro's bias (rad/s^1.5); default: the largest of the gyro's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_random_walk: Option<NonNegative>,
    /// Standard deviation of a measured attitude about each axis of its sensor (rad); default: the sensor's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub attitude_noise: Option<[Positive; 3]>,
    /// Standard deviation of a measured magnetic field along each axis (T); default: the magnetometer's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub field_noise: Option<Positive>,
    /// Standard deviation of a measured direction to the Sun (rad); default: the Sun sensor's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sun_noise: Option<Positive>,
    /// Standard deviations of the estimate at the start.
    #[serde(default)]
    pub initial: Initial,
    /// Initial estimate of attitude and bias.
    #[serde(default)]
    pub prior: Prior,
    /// Elastic modes as further states; none by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub elastic: Option<ElasticStates>,
    /// Interval over which the metrics assess the filter (s); default: the whole run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub assess: Option<[NonNegative; 2]>,
    /// Whether the filter runs for assessment only: the law does not read it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub watch_only: bool,
}

/// Standard deviations of an attitude filter's estimate at the start, the same about each axis.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Initial {
    /// Standard deviation of the attitude (rad).
    pub angle: Positive,
    /// Standard deviation of the bias (rad/s).
    pub bias: Positive,
}

impl Default for Initial {
    /// A milliradian, and 2 degrees an hour.
    fn default() -> Self {
        let positive = |value: f64| Positive::new(value).unwrap_or(Positive::ONE);
        Self { angle: positive(1e-3), bias: positive(1e-5) }
    }
}

/// What a sensor is to the filter.
#[derive(Clone, Debug, PartialEq)]
pub enum Role {
    /// Its rates carry the attitude on.
    Gyro {
        /// How late it tells them.
        latency: Span,
    },
    /// It measures the attitude or a vector, so late, with errors of this covariance in the body's axes.
    Corrects {
        /// From exposure to when it is told.
        latency: Span,
        /// The covariance (rad², or T² of a magnetic field).
        noise: Matrix3<f64>,
        /// The constant gain of a filter that has one.
        gain: Option<Box<Matrix6x3<f64>>>,
    },
    /// The filter does not read it.
    None,
}

/// What the sensors of a scenario are to a filter.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AttitudeSetting {
    /// Each sensor, in the order of the scenario.
    pub roles: Vec<Role>,
    /// Noise of the gyro.
    pub noise: GyroNoise,
    /// Bias of the gyro at the start (rad/s).
    pub bias: Vector,
    /// How late a measurement may be.
    pub reach: Span,
    /// The modes that it knows.
    pub modes: Option<Arc<KnownModes>>,
}

/// A body, the points at which its sensors are, and whether jets turn it.
pub type Mounted<'a> = (&'a Spatial, &'a [String], bool);

impl AttitudeFilter {
    /// What these sensors are to the filter, under a law with this period or none, on a body at these points.
    ///
    /// # Errors
    /// Why they do not do, and the key.
    pub fn setting(
        &self,
        sensors: &[Sensor],
        cycle: Option<Span>,
        mounted: Option<Mounted<'_>>,
    ) -> Result<AttitudeSetting, Fault> {
        let gyro = sensors.iter().enumerate().find_map(|(index, sensor)| match sensor {
            Sensor::Gyro(gyro) => Some((index, gyro)),
            _ => None,
        });
        let Some((read, gyro)) = gyro else {
            return Err(Fault::new(
                "",
                "propagates the attitude with the rates of a `gyro`, and there is none",
            ));
        };
        let Some(period) = gyro.period.or(cycle) else {
            return Err(Fault::new("", "needs a gyro with a `period`"));
        };
        let gyro_noise = self.gyro_noise(gyro, period.seconds())?;
        let role = |(index, sensor): (usize, &Sensor)| match self.measured(sensor) {
            Some((latency, noise)) => {
                let (noise, every) = (noise?, sensor.period(cycle).unwrap_or(period));
                let gain = self.form.gain(&gyro_noise, every.seconds(), &noise);
                Ok(Role::Corrects { latency, noise, gain: gain.map(Box::new) })
            }
            None if index == read => Ok(Role::Gyro { latency: gyro.latency() }),
            None => Ok(Role::None),
        };
        let roles = sensors.iter().enumerate().map(role).collect::<Result<Vec<_>, Fault>>()?;
        let late =
            |role: &Role| if let Role::Corrects { latency, .. } = role { Some(*latency) } else { None };
        let Some(latest) = roles.iter().filter_map(late).max() else {
            let why = "corrects its attitude by that of a `star_tracker` or a `sampled` sensor, or by the vectors of a \
                       `magnetometer` or a `sun_sensor`, and there is none";
            return Err(Fault::new("", why));
        };
        let correct = roles.iter().filter(|role| matches!(role, Role::Corrects { .. })).count();
        if self.form == Form::Steady && (correct > 1 || sensors.iter().any(Sensor::is_of_a_vector)) {
            let why = "needs one attitude sensor and no vector sensors to have a steady state: use `extended` or `complementary`";
            return Err(Fault::new("form", why));
        }
        let bias = Vector::from_fn(|axis, _| gyro.bias.about(axis).get());
        let modes = self.modes(gyro, read, mounted)?.map(Arc::new);
        Ok(AttitudeSetting { roles, noise: gyro_noise, bias, reach: latest + period, modes })
    }

    /// The modes that it shall know of a body with sensors at these points.
    fn modes(
        &self,
        gyro: &Gyro,
        read: usize,
        mounted: Option<Mounted<'_>>,
    ) -> Result<Option<KnownModes>, Fault> {
        let Some(elastic) = &self.elastic else { return Ok(None) };
        let refused = |key: &str, why: &str| Err(Fault::new(key, why));
        if self.form != Form::Extended {
            return refused("elastic", "needs `form = \"extended\"`: constant gains cannot estimate modes");
        }
        if !gyro.integrates() {
            let why = "needs a gyro that integrates, one with `angle_random_walk`: the rate at one instant does not show \
                       how far modes have turned its mount";
            return refused("elastic", why);
        }
        let Some((body, at, jets)) = mounted else { return Ok(None) };
        if jets {
            let why = "is driven by torques about the axes: jets push modes by their forces too, which the filter does not know";
            return refused("elastic", why);
        }
        elastic.known(body, at, read).map(Some).map_err(|fault| fault.within("elastic"))
    }

    /// How late a sensor measures the attitude or a vector, and the covariance of its errors; nothing of one that does not.
    fn measured(&self, sensor: &Sensor) -> Option<(Span, Result<Matrix3<f64>, Fault>)> {
        let given = self.attitude_noise.map(|noise| noise.map(Positive::get));
        let known = |own: [f64; 3]| {
            let noise = given.unwrap_or(own);
            let why = "must be given where a sensor of the attitude has no noise about an axis";
            if noise.iter().all(|noise| *noise > 0.0) {
                Ok(noise)
            } else {
                Err(Fault::new("attitude_noise", why))
            }
        };
        match sensor {
            Sensor::StarTracker(tracker) => {
                let noise = known(tracker.noise.map(NonNegative::get));
                Some((tracker.latency(), noise.map(|noise| tracker.covariance(noise))))
            }
            Sensor::Sampled(sampled) => {
                let squares = |noise: [f64; 3]| Vector::from(noise.map(|noise| noise * noise));
                let noise = known([sampled.angle_noise(); 3]);
                Some((Span::ZERO, noise.map(|noise| Matrix3::from_diagonal(&squares(noise)))))
            }
            Sensor::Magnetometer(magnetometer) => {
                let noise = vector(self.field_noise, magnetometer.covariance(), "field_noise");
                Some((magnetometer.latency(), noise))
            }
            Sensor::SunSensor(sensor) => {
                Some((sensor.latency(), vector(self.sun_noise, sensor.covariance(), "sun_noise")))
            }
            Sensor::Continuous
            | Sensor::Gyro(_)
            | Sensor::Tachometer(_)
            | Sensor::Accelerometer(_)
            | Sensor::Own(_) => None,
        }
    }

    /// Noise of the gyro: white noise of sampled rates is that of an angle that walks.
    fn gyro_noise(&self, gyro: &Gyro, period: f64) -> Result<GyroNoise, Fault> {
        let largest = |of: &dyn Fn(usize) -> f64| (0..3).map(of).fold(0.0, f64::max);
        let own = if gyro.integrates() {
            largest(&|axis| gyro.angle_random_walk.about(axis).get())
        } else {
            largest(&|axis| gyro.rate_noise(axis)) * f64::sqrt(period)
        };
        let angle_random_walk = self.angle_random_walk.map_or(own, Positive::get);
        if angle_random_walk <= 0.0 {
            let why = "must be given where the gyro has no noise about any axis";
            return Err(Fault::new("angle_random_walk", why));
        }
        let walk = largest(&|axis| gyro.walk(axis));
        Ok(GyroNoise {
            angle_random_walk,
            rate_random_walk: self.rate_random_walk.map_or(walk, NonNegative::get),
        })
    }
}

/// The covariance of a vector, of this deviation along each axis or its sensor's own.
fn vector(given: Option<Positive>, own: Matrix3<f64>, key: &str) -> Result<Matrix3<f64>, Fault> {
    let noise = given.map_or(own, |given| Matrix3::from_diagonal_element(given.get() * given.get()));
    let why = "must be given where the sensor has no noise along an axis";
    if noise.diagonal().iter().all(|variance| *variance > 0.0) {
        Ok(noise)
    } else {
        Err(Fault::new(key, why))
    }
}
