//! Settings of the attitude filter in a scenario, and the filter's setup for the scenario's sensors.

use std::sync::Arc;

use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_flight::attitude_gate::AttitudeGate;
use flexsc_flight_precision::Precision;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::quantity::{NonNegative, Positive};
use flexsc_numerics::random::Seed;
use flexsc_numerics::time::Span;
use flexsc_record::AttitudeEstimate;
use flexsc_spacecraft::environment::OrbitEnvironment;
use nalgebra::{Matrix3, Matrix6x3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{AttitudeFilterRun, ElasticStates, FilterModes, GainMethod, GyroNoise};
use crate::estimator::kalman::Prior;
use crate::estimator::pass_through::PassThrough;
use crate::estimator::requirements::require_window;
use crate::estimator::sample_cost::{ATTITUDE_FILTER_S, ELASTIC_PRODUCTS, products_s};
use crate::estimator::{Estimator, EstimatorContext, EstimatorSpec};
use crate::offers::{EstimatorOffers, Offers};
use crate::requirement::Requirements;
use crate::sensor::{Gyro, ReferenceNoise, SensorKind, SensorSpec};

/// Estimates the attitude and the gyro bias of a body with three axes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AttitudeFilter {
    /// How the gains are computed.
    #[serde(default)]
    pub form: GainMethod,
    /// Angle random walk of the gyro (rad/sqrt(s)), the same about each axis; default: the largest of the gyro's
    /// own, which for one that samples the rate is its noise times the root of the period.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angle_random_walk: Option<Positive>,
    /// Rate random walk of the gyro's bias (rad/s^1.5); default: the largest of the gyro's own, with a
    /// `bias_instability` as the walk that it is over a short time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_random_walk: Option<NonNegative>,
    /// Standard deviation of a measured attitude about each axis of its sensor (rad); default: the sensor's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub attitude_noise: Option<[Positive; 3]>,
    /// Standard deviation of a measured magnetic field along each axis (T); default: the magnetometer's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub field_noise: Option<Positive>,
    /// Degree of the magnetic field that the filter takes as the reference of magnetometers, from 1 to that of the
    /// environment's; default: the environment's field itself, without a model error. The error of a lower degree
    /// is correlated in time: cover it by `field_noise`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub field_degree: Option<u32>,
    /// Standard deviation of a measured direction to the Sun (rad); default: that of the Sun sensor or cells.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sun_noise: Option<Positive>,
    /// Standard deviation of a measured direction to the planet (rad); default: the Earth sensor's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub earth_noise: Option<Positive>,
    /// Limits within which it accepts readings.
    #[serde(default, skip_serializing_if = "ReadingGate::is_default")]
    pub gate: ReadingGate,
    /// Standard deviations of the estimate at the start.
    #[serde(default)]
    pub initial: AttitudeInitialDeviations,
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
#[schemars(rename = "Initial")]
pub struct AttitudeInitialDeviations {
    /// Standard deviation of the attitude (rad).
    pub angle: Positive,
    /// Standard deviation of the bias (rad/s).
    pub bias: Positive,
}

impl Default for AttitudeInitialDeviations {
    /// Returns deviations of 1 mrad, and of 2 degrees per hour.
    fn default() -> Self {
        let positive = |value: f64| Positive::new(value).unwrap_or(Positive::ONE);
        Self { angle: positive(1e-3), bias: positive(1e-5) }
    }
}

/// Limits within which an attitude filter accepts readings. It always refuses those that are not finite, and quaternions and
/// directions whose length differs from 1 by more than 0.001.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(rename = "Gate")]
pub struct ReadingGate {
    /// Largest innovation in standard deviations, the root of its normalised square over the number of components. A measurement
    /// above it is refused; with `elastic` none is.
    pub deviations: Positive,
    /// Number of refusals in a row after which the next measurement is accepted: the covariance grows by the innovation before
    /// the correction.
    pub refusals: u32,
    /// Time without a correction (s) after which a measurement above the limit is accepted at once, in the same way.
    pub gap: Positive,
    /// Largest rate about an axis (rad/s) that it takes from the gyro; default: the gyro's `range`, or 10 rad/s without one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rate: Option<Positive>,
}

/// Largest rate that is taken from a gyro without a range (rad/s).
const LARGEST_RATE: f64 = 10.0;

impl Default for ReadingGate {
    /// Returns a limit of 10 standard deviations, 5 refusals and a gap of 300 s.
    fn default() -> Self {
        let positive = |value: f64| Positive::new(value).unwrap_or(Positive::ONE);
        Self { deviations: positive(10.0), refusals: 5, gap: positive(300.0), rate: None }
    }
}

impl ReadingGate {
    fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// Returns the gate in flight code, for the readings of this gyro.
    fn to_flight(self, gyro: &Gyro) -> AttitudeGate {
        let range = |axis: usize| gyro.range.map_or(LARGEST_RATE, |range| range.about(axis).get());
        let largest = (0..3).map(range).fold(0.0, f64::max);
        let deviations = self.deviations.get();
        AttitudeGate {
            most_nis: (AttitudeEstimate::MEASUREMENTS * deviations * deviations).min(f64::MAX),
            most_refusals: self.refusals,
            gap: Span::from_seconds(self.gap.get()).ticks(),
            most_rate: self.rate.map_or(largest, Positive::get),
        }
    }
}

/// Role of a sensor in the filter.
#[derive(Clone, Debug, PartialEq)]
pub enum SensorRole {
    /// The gyro, whose rates propagate the attitude.
    Gyro {
        /// Latency of a reading.
        latency: Span,
    },
    /// Sensor of the attitude or of a vector, which corrects the attitude.
    Corrects {
        /// Time from exposure to reading.
        latency: Span,
        /// Covariance of the error in body axes (rad², or T² of a magnetic field).
        noise: Matrix3<f64>,
        /// Constant gain, of a filter that has one.
        gain: Option<Box<Matrix6x3<f64>>>,
    },
    /// Sensor that the filter does not read.
    None,
}

/// Setup of a filter for the sensors of a scenario.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FilterSetup {
    /// Role of each sensor, in the order of the scenario.
    pub roles: Vec<SensorRole>,
    /// Noise of the gyro.
    pub noise: GyroNoise,
    /// Bias of the gyro at the start (rad/s).
    pub bias: Vector,
    /// Largest delay of a measurement.
    pub reach: Span,
    /// Limits of the readings.
    pub gate: AttitudeGate,
    /// Elastic modes that the filter estimates, if any.
    pub modes: Option<Arc<FilterModes>>,
    /// Environment with the magnetic field of the filter's model; `None` if the model is the true field.
    pub field_model: Option<OrbitEnvironment>,
    /// Precision of the flight computer.
    pub precision: Precision,
}

/// Body, points at which its sensors are mounted, and true if jets drive it.
pub type SensorMounts<'a> = (&'a ThreeAxisModel, &'a [String], bool);

impl EstimatorSpec for AttitudeFilter {
    fn start(&self, known: &EstimatorContext<'_>, seed: Seed) -> Box<dyn Estimator> {
        let Some(setup) = known.attitude else { return Box::new(PassThrough) };
        Box::new(AttitudeFilterRun::new(self, setup.clone(), seed.stream("prior")))
    }

    fn offers(&self) -> EstimatorOffers {
        EstimatorOffers {
            is_assessed_only: self.watch_only,
            fuses_sensors: true,
            needs_reader: true,
            has_single_precision: self.elastic.is_none(),
            ..EstimatorOffers::default()
        }
    }

    /// Adds the requirements of the filter except those on its sensors.
    fn requires(&self, offers: &Offers, needs: &mut Requirements) {
        needs.require_axes(
            offers.body.axes == 3,
            "",
            "is for three axes: use `[estimator.kalman]` for a body with one angle",
        );
        require_window(self, needs);
    }

    fn states(&self, _: usize) -> usize {
        6
    }

    fn assessment(&self) -> Option<[NonNegative; 2]> {
        self.assess
    }

    fn sample_seconds(&self, _: usize, _: f64) -> f64 {
        self.elastic.as_ref().map_or(ATTITUDE_FILTER_S, |elastic| {
            ELASTIC_PRODUCTS * products_s(6.0 + 3.0 * elastic.modes.len() as f64)
        })
    }
}

impl AttitudeFilter {
    /// Returns the setup for these sensors under a sky, with the law's period `cycle` and the sensors' mounts, if there
    /// are any.
    ///
    /// # Errors
    /// A `ConfigError` with the key and the reason if the sensors do not suit the filter.
    pub fn setup(
        &self,
        sensors: &[SensorKind],
        sky: &OrbitEnvironment,
        cycle: Option<Span>,
        mounted: Option<SensorMounts<'_>>,
    ) -> Result<FilterSetup, ConfigError> {
        let gyro = sensors.iter().enumerate().find_map(|(index, sensor)| Some((index, sensor.gyro()?)));
        let Some((read, gyro)) = gyro else {
            return Err(ConfigError::new(
                "",
                "propagates the attitude with the rates of a `gyro`, and there is none",
            ));
        };
        let Some(period) = gyro.period.or(cycle) else {
            return Err(ConfigError::new("", "needs a gyro with a `period`"));
        };
        let gyro_noise = self.gyro_noise(gyro, period.seconds())?;
        let role = |(index, sensor): (usize, &SensorKind)| match self.measured(sensor) {
            Some((latency, noise)) => {
                let (noise, every) = (noise?, sensor.period(cycle).unwrap_or(period));
                let gain = self.form.gain(&gyro_noise, every.seconds(), &noise);
                Ok(SensorRole::Corrects { latency, noise, gain: gain.map(Box::new) })
            }
            None if index == read => Ok(SensorRole::Gyro { latency: gyro.rate_latency() }),
            None => Ok(SensorRole::None),
        };
        let roles = sensors.iter().enumerate().map(role).collect::<Result<Vec<_>, ConfigError>>()?;
        let late = |role: &SensorRole| {
            if let SensorRole::Corrects { latency, .. } = role { Some(*latency) } else { None }
        };
        let Some(latest) = roles.iter().filter_map(late).max() else {
            let why = "corrects its attitude by that of a `star_tracker` or a `sampled` sensor, or by the vectors of a \
                       `magnetometer`, a `sun_sensor`, `sun_cells` or an `earth_sensor`, and there is none";
            return Err(ConfigError::new("", why));
        };
        let correct = roles.iter().filter(|role| matches!(role, SensorRole::Corrects { .. })).count();
        if self.form == GainMethod::Steady
            && (correct > 1 || sensors.iter().any(|sensor| sensor.measures_vector()))
        {
            let why = "needs one attitude sensor and no vector sensors to have a steady state: use `extended` or `complementary`";
            return Err(ConfigError::new("form", why));
        }
        let bias = Vector::from_fn(|axis, _| gyro.bias.about(axis).get());
        let modes = self.modes(gyro, read, mounted)?.map(Arc::new);
        let field_model = self.field_model(sensors, sky)?;
        let gate = self.gate.to_flight(gyro);
        Ok(FilterSetup {
            roles,
            noise: gyro_noise,
            bias,
            reach: latest + period,
            gate,
            modes,
            field_model,
            precision: Precision::Double,
        })
    }

    /// Returns the environment with the magnetic field of the filter's model, if that is not the true field.
    fn field_model(
        &self,
        sensors: &[SensorKind],
        sky: &OrbitEnvironment,
    ) -> Result<Option<OrbitEnvironment>, ConfigError> {
        let Some(degree) = self.field_degree else { return Ok(None) };
        if !sensors.iter().any(|sensor| sensor.measures_field()) {
            let why = "is that of the field that a `magnetometer` measures, and there is none";
            return Err(ConfigError::new("field_degree", why));
        }
        let highest = sky.field_degree();
        if !(1..=highest).contains(&(degree as usize)) {
            let range = if highest > 1 { format!("from 1 to {highest}") } else { "1".to_owned() };
            let why = format!("must be {range}, the degree of `environment.magnetic_field`, got {degree}");
            return Err(ConfigError::new("field_degree", why));
        }
        Ok(Some(sky.with_field_degree(degree as usize)))
    }

    /// Returns the model of the modes that the filter estimates of a body with sensors at these points.
    fn modes(
        &self,
        gyro: &Gyro,
        read: usize,
        mounted: Option<SensorMounts<'_>>,
    ) -> Result<Option<FilterModes>, ConfigError> {
        let Some(elastic) = &self.elastic else { return Ok(None) };
        let refused = |key: &str, why: &str| Err(ConfigError::new(key, why));
        if self.form != GainMethod::Extended {
            return refused("elastic", "needs `form = \"extended\"`: constant gains cannot estimate modes");
        }
        if !gyro.integrates() {
            let why = "needs a gyro that integrates, one with `angle_random_walk`: the rate at one instant does not show \
                       how far modes have turned its mount";
            return refused("elastic", why);
        }
        let Some((body, mounts, jets)) = mounted else { return Ok(None) };
        if jets {
            let why = "is driven by torques about the axes: jets push modes by their forces too, which the filter does not know";
            return refused("elastic", why);
        }
        elastic.known(body, mounts, read).map(Some).map_err(|fault| fault.within("elastic"))
    }

    /// Returns latency and error covariance of a sensor of the attitude or of a vector; `None` of another sensor.
    fn measured(&self, sensor: &SensorKind) -> Option<(Span, Result<Matrix3<f64>, ConfigError>)> {
        let noise = self.attitude_noise.map(|noise| noise.map(Positive::get));
        let known = |own: [f64; 3]| {
            let noise = noise.unwrap_or(own);
            let why = "must be given where a sensor of the attitude has no noise about an axis";
            if noise.iter().all(|noise| *noise > 0.0) {
                Ok(noise)
            } else {
                Err(ConfigError::new("attitude_noise", why))
            }
        };
        let (latency, reference) = sensor.reference()?;
        let noise = match reference {
            ReferenceNoise::Attitude(own) => known(own).map(|noise| sensor.attitude_covariance(noise)),
            ReferenceNoise::MagneticField(own) => vector(self.field_noise, own, "field_noise"),
            ReferenceNoise::Sun(own) => vector(self.sun_noise, own, "sun_noise"),
            ReferenceNoise::Earth(own) => vector(self.earth_noise, own, "earth_noise"),
        };
        Some((latency, noise))
    }

    /// Returns the gyro's noise; white noise of sampled rates is converted to an angle random walk.
    fn gyro_noise(&self, gyro: &Gyro, period: f64) -> Result<GyroNoise, ConfigError> {
        let largest = |component: &dyn Fn(usize) -> f64| (0..3).map(component).fold(0.0, f64::max);
        let own = if gyro.integrates() {
            largest(&|axis| gyro.angle_random_walk.about(axis).get())
        } else {
            largest(&|axis| gyro.rate_noise(axis).unwrap_or_default()) * f64::sqrt(period)
        };
        let angle_random_walk = self.angle_random_walk.map_or(own, Positive::get);
        if angle_random_walk <= 0.0 {
            let why = "must be given where the gyro has no noise about any axis";
            return Err(ConfigError::new("angle_random_walk", why));
        }
        let walk = largest(&|axis| gyro.bias_random_walk(axis));
        Ok(GyroNoise {
            angle_random_walk,
            rate_random_walk: self.rate_random_walk.map_or(walk, NonNegative::get),
        })
    }
}

/// Returns the covariance of a vector sensor, with the standard deviation `given` along each axis, or its `own`.
fn vector(deviation: Option<Positive>, own: Matrix3<f64>, key: &str) -> Result<Matrix3<f64>, ConfigError> {
    let noise =
        deviation.map_or(own, |deviation| Matrix3::from_diagonal_element(deviation.get() * deviation.get()));
    let why = "must be given where the sensor has no noise along an axis";
    if noise.diagonal().iter().all(|variance| *variance > 0.0) {
        Ok(noise)
    } else {
        Err(ConfigError::new(key, why))
    }
}
