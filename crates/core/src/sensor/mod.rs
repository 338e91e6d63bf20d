//! How the angle is measured: continuously and exactly, or sampled with noise and a resolution; the rates of a spatial body.

mod gyro;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::quantity::{Finite, NonNegative, Positive, Time};
use crate::random::Stream;
use crate::time::{Instant, Span};

pub use gyro::{Gyro, Readout};

/// The kinds of angle measurement.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Sensor {
    /// The true angle at every instant: guards trip at the exact crossing.
    #[default]
    Continuous,
    /// A sample at each period, held until the next: guards are tested at samples.
    Sampled(Sampled),
    /// The rates of a spatial body, in each cycle of its law.
    Gyro(Gyro),
}

/// A sampled angle sensor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sampled {
    /// Period of the samples (s).
    pub period: Span,
    /// Standard deviation of the white noise (rad).
    #[serde(default)]
    pub noise: NonNegative,
    /// Constant error (rad).
    #[serde(default)]
    pub bias: Finite,
    /// Quantum of the output (rad); 0 for none.
    #[serde(default)]
    pub resolution: NonNegative,
    /// Standard deviation of the white noise of a rate gyro (rad/s); left out, there is no gyro, and the rate is the
    /// difference of the last two angles over the period.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_noise: Option<Positive>,
    /// Times at which the sensor fails.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<Fault>,
}

/// A failure of the sensor, gyro included.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Fault {
    /// It repeats the last measurement before the failure.
    Stuck(Outage),
    /// It gives no number.
    Silent(Outage),
}

/// How long a failure lasts.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Outage {
    /// When it begins (s).
    pub from: Time,
    /// When it ends (s); left out, with the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<Time>,
}

impl Fault {
    /// How long it lasts.
    pub fn outage(&self) -> Outage {
        let (Self::Stuck(outage) | Self::Silent(outage)) = self;
        *outage
    }
}

impl Outage {
    fn lasts(self, now: Instant) -> bool {
        let at = |time: Time| Instant::START + Span::from_seconds(time.get());
        at(self.from) <= now && self.to.is_none_or(|to| now < at(to))
    }
}

/// A measurement: the angle (rad) and the rate of a gyro, if there is one (rad/s).
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Measurement {
    /// Angle (rad).
    pub angle: f64,
    /// Rate (rad/s).
    pub rate: Option<f64>,
}

impl Sensor {
    /// The period of the samples, if the sensor is sampled.
    pub fn period(&self) -> Option<Span> {
        match self {
            Self::Continuous | Self::Gyro(_) => None,
            Self::Sampled(sampled) => Some(sampled.period),
        }
    }

    /// Standard deviation of the gyro's rate (rad/s), if there is a gyro.
    pub fn rate_noise(&self) -> Option<f64> {
        match self {
            Self::Continuous | Self::Gyro(_) => None,
            Self::Sampled(sampled) => sampled.rate_noise.map(Positive::get),
        }
    }

    /// Standard deviation of the measured angle (rad), that of its quantisation included.
    pub fn angle_noise(&self) -> f64 {
        let Self::Sampled(Sampled { noise, resolution, .. }) = self else { return 0.0 };
        libm::sqrt(noise.get() * noise.get() + resolution.get() * resolution.get() / 12.0)
    }

    /// The failures of a sampled sensor.
    pub fn faults(&self) -> &[Fault] {
        match self {
            Self::Continuous | Self::Gyro(_) => &[],
            Self::Sampled(sampled) => &sampled.faults,
        }
    }

    /// The measurement of a true angle (rad) and rate (rad/s) after the last one; none from a sensor that is silent.
    pub fn measure(
        &self,
        now: Instant,
        (angle, rate): (f64, f64),
        last: Option<Measurement>,
        noise: &mut Stream,
    ) -> Option<Measurement> {
        let Self::Sampled(sampled) = self else { return Some(Measurement { angle, rate: None }) };
        // Draws are made in a failure too: those after it do not depend on it.
        let angle = sampled.measure(angle, noise);
        let rate = self.rate_noise().map(|sd| rate + sd * noise.normal());
        match sampled.faults.iter().find(|fault| fault.outage().lasts(now)) {
            None => Some(Measurement { angle, rate }),
            Some(Fault::Stuck(_)) => Some(last.unwrap_or(Measurement { angle, rate })),
            Some(Fault::Silent(_)) => None,
        }
    }
}

impl Sampled {
    fn measure(&self, angle: f64, noise: &mut Stream) -> f64 {
        let mut output = angle + self.bias.get();
        if self.noise.get() > 0.0 {
            output += self.noise.get() * noise.normal();
        }
        let quantum = self.resolution.get();
        if quantum > 0.0 { libm::round(output / quantum) * quantum } else { output }
    }
}
