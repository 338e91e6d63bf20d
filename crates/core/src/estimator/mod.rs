//! Estimators: they turn what was commanded and measured into beliefs.

pub mod adaptive;
mod envelope;
pub mod kalman;
mod rigid_rate;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::body::Mode;
use crate::quantity::{NonNegative, Positive};

pub use adaptive::Adaptive;
pub use envelope::{Envelope, Form, Observer};
pub use kalman::{Drifting, Kalman};
pub use rigid_rate::{RateFilter, RigidRate};

/// The kinds of estimator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Estimator {
    /// The envelope of the elastic modes and its window means.
    Envelope(Envelope),
    /// The dominant mode as it is: what an ideal observer knows.
    Truth(Truth),
    /// The motion, by a Kalman filter with constant natural frequencies.
    Kalman(Kalman),
    /// The motion and the natural frequencies, by an extended Kalman filter.
    ExtendedKalman(Drifting),
    /// The same by an unscented Kalman filter.
    UnscentedKalman(Drifting),
    /// The rigid rates of a spatial body.
    RigidRate(RigidRate),
    /// The rigid rates and elastic modes of a spatial body, by adaptive observers.
    Adaptive(Box<Adaptive>),
}

/// An ideal observer has nothing to set.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Truth {}

impl Estimator {
    /// The kind, as a scenario names it.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Envelope(_) => "envelope",
            Self::Truth(_) => "truth",
            Self::Kalman(_) => "kalman",
            Self::ExtendedKalman(_) => "extended_kalman",
            Self::UnscentedKalman(_) => "unscented_kalman",
            Self::RigidRate(_) => "rigid_rate",
            Self::Adaptive(_) => "adaptive",
        }
    }

    /// The envelope's observer, if it is one.
    pub fn envelope(&self) -> Option<&Envelope> {
        if let Self::Envelope(envelope) = self { Some(envelope) } else { None }
    }

    /// Whether it filters measurements.
    pub fn filters(&self) -> bool {
        matches!(self, Self::Kalman(_) | Self::ExtendedKalman(_) | Self::UnscentedKalman(_))
    }

    /// Whether it is there to be assessed only.
    pub fn watches_only(&self) -> bool {
        match self {
            Self::Kalman(filter) => filter.watch_only,
            Self::ExtendedKalman(filter) | Self::UnscentedKalman(filter) => filter.watch_only,
            Self::Envelope(_) | Self::Truth(_) | Self::RigidRate(_) | Self::Adaptive(_) => false,
        }
    }

    /// The modes that it knows instead of the body's.
    pub fn modes(&self) -> Option<&[Mode]> {
        match self {
            Self::Envelope(Envelope { modes, .. })
            | Self::Kalman(Kalman { modes, .. })
            | Self::ExtendedKalman(Drifting { modes, .. })
            | Self::UnscentedKalman(Drifting { modes, .. }) => modes.as_deref(),
            Self::Truth(_) | Self::RigidRate(_) | Self::Adaptive(_) => None,
        }
    }

    /// The standard deviation of the measured angle (rad) that it takes instead of the sensor's.
    pub fn angle_noise(&self) -> Option<f64> {
        match self {
            Self::Kalman(Kalman { angle_noise, .. })
            | Self::ExtendedKalman(Drifting { angle_noise, .. })
            | Self::UnscentedKalman(Drifting { angle_noise, .. }) => angle_noise.map(Positive::get),
            Self::Envelope(_) | Self::Truth(_) | Self::RigidRate(_) | Self::Adaptive(_) => None,
        }
    }

    /// How many states it estimates of a body with so many modes.
    pub fn states(&self, modes: usize) -> usize {
        match self {
            Self::Envelope(_) | Self::Truth(_) | Self::RigidRate(_) | Self::Adaptive(_) => 0,
            Self::Kalman(_) => 2 + 2 * modes,
            Self::ExtendedKalman(filter) | Self::UnscentedKalman(filter) => {
                2 + 2 * modes + 2 * filter.ratios.count(modes)
            }
        }
    }

    /// The times (s) between which the metrics judge it.
    pub fn assess(&self) -> [f64; 2] {
        let window = match self {
            Self::Kalman(Kalman { assess, .. })
            | Self::ExtendedKalman(Drifting { assess, .. })
            | Self::UnscentedKalman(Drifting { assess, .. }) => *assess,
            Self::Envelope(_) | Self::Truth(_) | Self::RigidRate(_) | Self::Adaptive(_) => None,
        };
        window.map_or([0.0, f64::INFINITY], |window| window.map(NonNegative::get))
    }
}
