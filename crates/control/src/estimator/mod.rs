//! Estimators: they turn what was commanded and measured into beliefs.

pub mod adaptive;
pub mod attitude;
mod consistency;
mod direct;
mod envelope;
mod given;
pub mod kalman;
mod meter;
mod monitor;
mod rigid_rate;
mod sampled;
mod searching;

use std::any::Any;
use std::borrow::Cow;
use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::actuator::Actuate;
use crate::belief::{Belief, Damped, Reads};
use crate::body::{Drift, Mode, Planar};
use crate::motion::State;
use crate::own::{Halt, Own};
use crate::quantity::{NonNegative, Positive};
use crate::random::Seed;
use crate::record;
use crate::sensor::{Orientation, Reading};
use crate::time::{Instant, Span};

pub use adaptive::Adaptive;
pub use attitude::AttitudeFilter;
pub use consistency::chi_square;
pub use envelope::{Envelope, EnvelopeMonitor, Form};
pub use given::GivenRecord;
pub use kalman::{FrequencyTracking, Kalman};
pub use meter::{Beside, Meter, WindowMeans};
pub use monitor::{Monitor, WindowEnd};
pub use rigid_rate::RigidRate;
pub use searching::Searching;

/// The kinds of estimator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Estimator {
    /// The envelope of the elastic modes and its window means.
    Envelope(Envelope),
    /// The true dominant mode, as an ideal observer gives it.
    Truth(Truth),
    /// A Kalman filter of the motion, with constant natural frequencies.
    Kalman(Kalman),
    /// An extended Kalman filter of the motion and the natural frequencies.
    ExtendedKalman(FrequencyTracking),
    /// An unscented Kalman filter of the motion and the natural frequencies.
    UnscentedKalman(FrequencyTracking),
    /// A multiplicative extended Kalman filter of the attitude and gyro bias of a spatial body.
    Attitude(AttitudeFilter),
    /// The rigid rates of a spatial body.
    RigidRate(RigidRate),
    /// Adaptive observers of the rigid rates and elastic modes of a spatial body.
    Adaptive(Box<Adaptive>),
    /// An estimator from another crate; a scenario file cannot name it.
    Own(Own<dyn Observe>),
}

/// What an estimator from outside tells of itself before a run. It acts at samples.
pub trait Observe: Send + Sync {
    /// The estimator at work, in what it is told of a scenario.
    fn start(&self, known: &Known<'_>, seed: Seed) -> Box<dyn Estimate>;

    /// What it is, for the program that brought it.
    fn any(&self) -> Option<&dyn Any> {
        None
    }
}

/// An ideal observer.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Truth {
    /// Angle and rate that the law reads in addition to the dominant mode: `modes` for the measured ones, `hub`, or `rigid`;
    /// default: `modes` for a law that reads the dominant mode, else `hub`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub feeds: Option<Feeds>,
}

/// What an estimator knows of a scenario before a run.
#[derive(Clone, Debug)]
pub struct Known<'a> {
    /// The estimator that the scenario asks for.
    pub estimator: Option<&'a Estimator>,
    /// The body about each of its axes, as if that axis were alone.
    pub axes: &'a [Planar],
    /// Back-EMF of a wheel for each unit of the rate (N m s), and whether it is that of the elastic body.
    pub back_emf: (f64, bool),
    /// How the natural frequencies drift.
    pub drift: Option<&'a Drift>,
    /// The period of the samples, if there are any.
    pub sampling: Option<Span>,
    /// Standard deviation of the measured angle (rad).
    pub angle_noise: f64,
    /// The same of the measured rate (rad/s) about each axis, if it is measured.
    pub rate_noise: Vec<Option<f64>>,
    /// What the law about each axis reads.
    pub reads: Vec<Reads>,
    /// The design of adaptive observers.
    pub adaptive: Option<&'a adaptive::ObserverDesign>,
    /// What the sensors are to an attitude filter.
    pub attitude: Option<&'a attitude::AttitudeSetting>,
}

/// A sample of the sensor, and what is around it.
pub struct Taken<'a> {
    /// When.
    pub now: Instant,
    /// Angle (rad) and rate (rad/s) about each axis; none of a sensor that is silent.
    pub measured: Option<&'a [[f64; 2]]>,
    /// What each sensor measured now, in the order of the scenario; nothing of one that was not due, or silent.
    pub readings: &'a [Option<Reading>],
    /// From where angles count.
    pub origin: &'a Orientation,
    /// The true motion about an axis, for ideal observers.
    pub truth: &'a dyn Fn(usize) -> Cow<'a, State>,
    /// The actuator.
    pub actuator: &'a dyn Actuate,
    /// How far ahead laws want to know elastic rates (s).
    pub ahead: f64,
}

/// An estimator at work: it writes the whole belief.
pub trait Estimate: fmt::Debug + Send + Sync {
    /// Takes over the reduced moments about each axis (rad/s²) that the actuator gives from now on.
    fn given(&mut self, _now: Instant, _moments: [f64; 3]) {}

    /// Takes over what a waveform has added to the rate about the first axis (rad/s).
    fn pushed(&mut self, _impulse: f64) {}

    /// Takes a sample.
    fn take(&mut self, taken: &Taken<'_>, beliefs: &mut [Belief]);

    /// Carries the belief on from the last sample to now, with angles that count from an origin.
    fn carry(&self, _now: Instant, _origin: &Orientation, _beliefs: &mut [Belief]) {}

    /// Takes over that angles count from other targets: by so much more about each axis (rad).
    fn shift(&mut self, _by: [f64; 3]) {}

    /// Whether it has lost the body, about each axis.
    fn lost(&self) -> [bool; 3] {
        [false; 3]
    }

    /// What a filter made of the last sample about an axis, beside the true motion.
    fn estimate(&self, _axis: usize, _now: Instant, _truth: &State) -> Option<record::Estimate> {
        None
    }

    /// What an attitude filter knows, beside the true orientation and the true bias of its gyro (rad/s).
    fn attitude(
        &self,
        _now: Instant,
        _truth: &Orientation,
        _bias: [f64; 3],
    ) -> Option<record::AttitudeEstimate> {
        None
    }

    /// What an attitude filter knows of elastic modes, if it knows any.
    fn elastic(&self) -> Option<record::ElasticEstimates> {
        None
    }

    /// What adaptive observers know, beside the true rates of the body's modes, and what damping makes of it.
    fn tracking(
        &self,
        _modal_rates: &dyn Fn() -> Vec<f64>,
        _damped: &dyn Fn() -> Vec<Damped>,
    ) -> Option<record::Tracking> {
        None
    }

    /// The filter of a body with one angle, and the mean reduced moment (rad/s²) since its last sample, if now is one; none before
    /// the first.
    fn filter(&mut self, _now: Instant) -> Option<(&mut kalman::KalmanFilter, Option<f64>)> {
        None
    }

    /// The true state of that filter's components.
    fn true_state(&self, _now: Instant, _truth: &State) -> Vec<f64> {
        Vec::new()
    }

    /// Why it cannot go on, of one from outside that cannot: the run ends there.
    fn halted(&self) -> Option<Halt> {
        None
    }

    /// A copy in the same state.
    fn copy(&self) -> Box<dyn Estimate>;
}

impl Clone for Box<dyn Estimate> {
    fn clone(&self) -> Self {
        self.copy()
    }
}

/// The estimator of a scenario at work.
pub fn start(known: &Known<'_>, seed: Seed) -> Box<dyn Estimate> {
    if let Some(sampled) = sampled::SampledEstimators::new(known, seed) {
        return Box::new(sampled);
    }
    match (known.estimator, known.adaptive) {
        (Some(Estimator::Own(own)), _) => own.start(known, seed),
        (Some(Estimator::Attitude(spec)), _) if known.attitude.is_some() => {
            let setting = known.attitude.cloned().unwrap_or_default();
            Box::new(attitude::Tracking::new(spec, setting, seed.stream("prior")))
        }
        (Some(Estimator::RigidRate(spec)), _) => Box::new(spec.start(known.axes.len())),
        (Some(Estimator::Adaptive(_)), Some(plan)) => Box::new(adaptive::Observers::new(plan)),
        _ => Box::new(direct::Direct),
    }
}

/// Estimates that the law reads in addition to the dominant mode.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Feeds {
    /// None: angle and rate are as measured.
    Modes,
    /// Angle and rate of the hub, elastic part included.
    Hub,
    /// The rigid angle and rate.
    Rigid,
}

impl Estimator {
    /// Why one that acts at samples needs some.
    pub const AT_SAMPLES: &str = "acts at each sample of a `[sensor.sampled]` or a `[sensor.gyro]`, or of a law with a period, and \
                                  there is none";

    /// The kind, as a scenario names it.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Envelope(_) => "envelope",
            Self::Truth(_) => "truth",
            Self::Kalman(_) => "kalman",
            Self::ExtendedKalman(_) => "extended_kalman",
            Self::UnscentedKalman(_) => "unscented_kalman",
            Self::Attitude(_) => "attitude",
            Self::RigidRate(_) => "rigid_rate",
            Self::Adaptive(_) => "adaptive",
            Self::Own(_) => "own",
        }
    }

    /// The attitude filter, if it is one.
    pub fn attitude(&self) -> Option<&AttitudeFilter> {
        if let Self::Attitude(filter) = self { Some(filter) } else { None }
    }

    /// The envelope's observer, if it is one.
    pub fn envelope(&self) -> Option<&Envelope> {
        if let Self::Envelope(envelope) = self { Some(envelope) } else { None }
    }

    /// Whether it makes one belief of several sensors.
    pub fn combines(&self) -> bool {
        matches!(self, Self::Attitude(_) | Self::Own(_))
    }

    /// Whether it leaves angles as they are measured.
    pub fn reads_rates_alone(&self) -> bool {
        matches!(self, Self::RigidRate(_) | Self::Adaptive(_))
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
            Self::Attitude(filter) => filter.watch_only,
            Self::Envelope(_) | Self::Truth(_) | Self::RigidRate(_) | Self::Adaptive(_) | Self::Own(_) => {
                false
            }
        }
    }

    /// What it writes into the belief, under a law that reads the dominant mode or one that does not.
    pub fn feeds(&self, dominant: bool) -> Feeds {
        let given = match self {
            Self::Kalman(filter) => filter.feeds,
            Self::ExtendedKalman(filter) | Self::UnscentedKalman(filter) => filter.feeds,
            Self::Truth(truth) => truth.feeds,
            Self::Envelope(_) | Self::Attitude(_) | Self::RigidRate(_) | Self::Adaptive(_) | Self::Own(_) => {
                Some(Feeds::Modes)
            }
        };
        if self.watches_only() {
            Feeds::Modes
        } else {
            given.unwrap_or(if dominant { Feeds::Modes } else { Feeds::Hub })
        }
    }

    /// The modes that it knows instead of the body's.
    pub fn modes(&self) -> Option<&[Mode]> {
        match self {
            Self::Envelope(Envelope { modes, .. })
            | Self::Kalman(Kalman { modes, .. })
            | Self::ExtendedKalman(FrequencyTracking { modes, .. })
            | Self::UnscentedKalman(FrequencyTracking { modes, .. }) => modes.as_deref(),
            Self::Truth(_) | Self::Attitude(_) | Self::RigidRate(_) | Self::Adaptive(_) | Self::Own(_) => {
                None
            }
        }
    }

    /// The standard deviation of the measured angle (rad) that it takes instead of the sensor's.
    pub fn angle_noise(&self) -> Option<f64> {
        match self {
            Self::Kalman(Kalman { angle_noise, .. })
            | Self::ExtendedKalman(FrequencyTracking { angle_noise, .. })
            | Self::UnscentedKalman(FrequencyTracking { angle_noise, .. }) => angle_noise.map(Positive::get),
            Self::Envelope(_)
            | Self::Truth(_)
            | Self::Attitude(_)
            | Self::RigidRate(_)
            | Self::Adaptive(_)
            | Self::Own(_) => None,
        }
    }

    /// How many states it estimates of a body with so many modes.
    pub fn states(&self, modes: usize) -> usize {
        match self {
            Self::Attitude(_) => 6,
            Self::Envelope(_) | Self::Truth(_) | Self::RigidRate(_) | Self::Adaptive(_) | Self::Own(_) => 0,
            Self::Kalman(_) => 2 + 2 * modes,
            Self::ExtendedKalman(filter) | Self::UnscentedKalman(filter) => {
                2 + 2 * modes + 2 * filter.ratios.count(modes)
            }
        }
    }

    /// Between these the normalised estimation error squared of a sample, over its number of states, lies with a probability of 95 %
    /// if the filter is consistent.
    pub fn inside(states: usize) -> [f64; 2] {
        chi_square(states).map(|bound| bound / states as f64)
    }

    /// The times (s) between which the metrics judge it.
    pub fn assess(&self) -> [f64; 2] {
        let window = match self {
            Self::Kalman(Kalman { assess, .. })
            | Self::ExtendedKalman(FrequencyTracking { assess, .. })
            | Self::UnscentedKalman(FrequencyTracking { assess, .. })
            | Self::Attitude(AttitudeFilter { assess, .. }) => *assess,
            Self::Envelope(_) | Self::Truth(_) | Self::RigidRate(_) | Self::Adaptive(_) | Self::Own(_) => {
                None
            }
        };
        window.map_or([0.0, f64::INFINITY], |window| window.map(NonNegative::get))
    }
}
