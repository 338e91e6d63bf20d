//! Elastic modes in an attitude filter: their settings in a scenario, and the filter's model of them.
//!
//! The filter's attitude is that of the hub. A gyro whose mount is rotated by g relative to the hub reads w + g q' + b,
//! a star tracker measures the attitude of the hub rotated by s q, and q'' + 2 zeta W q' + W² q = phi (T + n) with the
//! commanded torque T and white noise n. The law reads the motion of the hub, or the rigid motion without phi q and phi
//! q'.

use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_formats::count::counted;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::quantity::{NonNegative, Positive};
use nalgebra::Matrix3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::estimator::EstimateOutputs;

/// Elastic modes as states of the filter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ElasticStates {
    /// Indices of the free modes, as `flexsc modes` lists them.
    pub modes: Vec<usize>,
    /// Natural frequencies in the filter's model (rad/s); default: the body's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frequencies: Option<Vec<Positive>>,
    /// Factor on the frequencies: the error of the filter's model.
    #[serde(default = "one")]
    pub factor: Positive,
    /// Relative standard deviation of the frequencies at the start, which the filter then identifies; default: it takes them as
    /// known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frequency_deviation: Option<Positive>,
    /// Random walk of the logarithm of each identified frequency (1/sqrt(s)); default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frequency_walk: Option<NonNegative>,
    /// Random walk of the rate of each mode due to random forces (m sqrt(kg)/s^1.5).
    pub noise: Positive,
    /// Standard deviation of each displacement at the start (m sqrt(kg)), about a mode at rest.
    #[serde(default = "displacement")]
    pub displacement: Positive,
    /// Standard deviation of each rate at the start (m sqrt(kg)/s); default: that of the displacement times the frequency.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate: Option<Positive>,
    /// Estimates that the law reads: the rigid angle and rate, or those of the hub; default: rigid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub feeds: Option<EstimateOutputs>,
}

fn one() -> Positive {
    Positive::ONE
}

fn displacement() -> Positive {
    Positive::new(1e-3).unwrap_or(Positive::ONE)
}

/// Mode in the filter's model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FilterMode {
    /// Natural frequency at the start (rad/s).
    pub frequency: f64,
    /// True natural frequency of the body (rad/s).
    pub true_frequency: f64,
    /// Damping ratio.
    pub damping: f64,
    /// Rotation of the hub per unit of the mode (rad/(m sqrt(kg))).
    pub hub: Vector,
    /// Rotation of the gyro's mount relative to the hub (rad/(m sqrt(kg))).
    pub gyro: Vector,
    /// Rotation of each sensor's mount relative to the hub (rad/(m sqrt(kg))), in the order of the scenario.
    pub mounts: Vec<Vector>,
    /// Standard deviations at the start, of displacement (m sqrt(kg)) and rate over the frequency (m sqrt(kg)).
    pub initial: [f64; 2],
}

/// Parameters of the frequency identification.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct FrequencyIdentification {
    /// Standard deviation of the logarithm of each frequency at the start.
    pub deviation: f64,
    /// Random walk of the logarithm of each frequency (1/sqrt(s)).
    pub walk: f64,
}

/// Modes in the filter's model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FilterModes {
    /// Parameters of each mode.
    pub each: Vec<FilterMode>,
    /// Random walk of each modal rate due to random forces (m sqrt(kg)/s^1.5).
    pub noise: f64,
    /// Parameters of the frequency identification, if the filter identifies frequencies.
    pub identified: Option<FrequencyIdentification>,
    /// Inertia about each axis (kg m²), by which a reduced moment (rad/s²) becomes a torque.
    pub inertia: Vector,
    /// True if the law reads the rigid angle and rate, without the modes.
    pub rigid: bool,
}

impl ElasticStates {
    /// Returns true if the filter identifies the frequencies.
    pub fn identifies(&self) -> bool {
        self.frequency_deviation.is_some()
    }

    /// Returns the filter's model of the modes of a body with sensors at the points `at`, where `gyro` is the gyro's
    /// index in `at`; torques act on the hub, the first point of the body.
    ///
    /// # Errors
    /// A `ConfigError` with the key and the reason.
    pub fn known(
        &self,
        body: &ThreeAxisModel,
        mounts: &[String],
        gyro: usize,
    ) -> Result<FilterModes, ConfigError> {
        if self.modes.is_empty() {
            return Err(ConfigError::new("modes", "must name at least one mode"));
        }
        for (index, mode) in self.modes.iter().enumerate() {
            if *mode >= body.modes.len() {
                let why = format!("must be below {}, the number of modes, got {mode}", body.modes.len());
                return Err(ConfigError::new(format!("modes[{index}]"), why));
            }
            if self.modes[..index].contains(mode) {
                return Err(ConfigError::new(format!("modes[{index}]"), format!("names mode {mode} again")));
            }
        }
        let listed = self.frequencies.as_ref().map_or(self.modes.len(), Vec::len);
        if listed != self.modes.len() {
            let why = format!("must be one for each of {}, got {listed}", counted(self.modes.len(), "mode"));
            return Err(ConfigError::new("frequencies", why));
        }
        if self.frequency_walk.is_some() && self.frequency_deviation.is_none() {
            let why = "is of frequencies that are identified: needs `frequency_deviation`";
            return Err(ConfigError::new("frequency_walk", why));
        }
        if self.feeds == Some(EstimateOutputs::Modes) {
            return Err(ConfigError::new(
                "feeds",
                "must be `rigid` or `hub`: the attitude is never as measured",
            ));
        }
        let hub = body.shapes(body.points.first().map_or("", |point| &point.name));
        let mounts: Vec<_> = mounts.iter().map(|point| body.shapes(point)).collect();
        let known = |(index, mode): (usize, &usize)| {
            let own = &body.modes[*mode];
            let beyond = |mount: &Vec<(Vector, Vector)>| mount[*mode].1 - hub[*mode].1;
            let frequency =
                self.frequencies.as_ref().map_or(own.frequency.get(), |frequencies| frequencies[index].get());
            let frequency = frequency * self.factor.get();
            let displacement = self.displacement.get();
            FilterMode {
                frequency,
                true_frequency: own.frequency.get(),
                damping: own.damping.get(),
                hub: hub[*mode].1,
                gyro: beyond(&mounts[gyro]),
                mounts: mounts.iter().map(beyond).collect(),
                initial: [displacement, self.rate.map_or(displacement, |rate| rate.get() / frequency)],
            }
        };
        let tensor: Matrix3<f64> = body.inertia;
        Ok(FilterModes {
            each: self.modes.iter().enumerate().map(known).collect(),
            noise: self.noise.get(),
            identified: self.frequency_deviation.map(|deviation| FrequencyIdentification {
                deviation: deviation.get(),
                walk: self.frequency_walk.map_or(0.0, NonNegative::get),
            }),
            inertia: tensor.diagonal(),
            rigid: self.feeds != Some(EstimateOutputs::Hub),
        })
    }
}

impl FilterModes {
    /// Returns the rotation, or its rate, of a place whose rotation per unit of a mode is `of`, for these displacements
    /// or rates.
    pub fn rotation_at(
        &self,
        rotation_of: impl Fn(&FilterMode) -> Vector,
        by: impl Iterator<Item = f64>,
    ) -> Vector {
        self.each.iter().zip(by).fold(Vector::zeros(), |sum, (mode, by)| sum + rotation_of(mode) * by)
    }
}
