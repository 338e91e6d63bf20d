//! Settings of an estimator: its model, the estimates that laws read, and its requirements, before a run.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::NonNegative;
use flexsc_numerics::random::Seed;
use flexsc_spacecraft::body::Mode;

use super::{EstimateOutputs, Estimator, EstimatorContext};
use crate::offers::{EstimatorOffers, Offers};
use crate::requirement::Requirements;

/// Settings of an estimator. Apart from the monitor of the envelope, an estimator acts at samples.
pub trait EstimatorSpec: Send + Sync {
    /// Returns the run-time state of the estimator in a scenario.
    fn start(&self, known: &EstimatorContext<'_>, seed: Seed) -> Box<dyn Estimator>;

    /// Returns the offers of the estimator to the other parts of a scenario.
    fn offers(&self) -> EstimatorOffers {
        EstimatorOffers { dominant_mode: true, fuses_sensors: true, ..EstimatorOffers::default() }
    }

    /// Checks the settings against each other; returns a key within the estimator and the reason.
    fn validate(&self) -> Option<ConfigError> {
        None
    }

    /// Adds the requirements of the estimator on the other parts of a scenario, apart from its samples and its reader.
    fn requires(&self, _offers: &Offers, _needs: &mut Requirements) {}

    /// Returns the estimates that the law reads in addition to the dominant mode; `dominant`: the law reads the dominant
    /// mode.
    fn feeds(&self, _dominant: bool) -> EstimateOutputs {
        EstimateOutputs::Modes
    }

    /// Returns the modes of the estimator's model, if they differ from the body's.
    fn modes(&self) -> Option<&[Mode]> {
        None
    }

    /// Returns the standard deviation of the measured angle (rad) that replaces the sensor's own, if given.
    fn angle_noise(&self) -> Option<f64> {
        None
    }

    /// Returns the number of states that are estimated of a body with `modes` modes.
    fn states(&self, _modes: usize) -> usize {
        0
    }

    /// Returns the interval (s) in which the metrics assess the estimator; `None` for the whole run.
    fn assessment(&self) -> Option<[NonNegative; 2]> {
        None
    }

    /// Returns the time of a sample (s) on an ordinary core, for a body with `axes` axes and `modes` modes.
    fn sample_seconds(&self, _axes: usize, _modes: f64) -> f64 {
        0.0
    }
}

impl dyn EstimatorSpec + '_ {
    /// Returns true if the estimator fuses several sensors into one state estimate.
    pub fn fuses_sensors(&self) -> bool {
        self.offers().fuses_sensors
    }

    /// Returns true if the estimator estimates rates only and leaves angles as measured.
    pub fn estimates_rates_only(&self) -> bool {
        self.offers().estimates_rates_only
    }

    /// Returns true if the estimator is a Kalman filter of angle and rate measurements.
    pub fn filters_measurements(&self) -> bool {
        self.offers().filters_measurements
    }

    /// Returns true if the estimator runs for assessment only, so that the law does not read it.
    pub fn is_assessed_only(&self) -> bool {
        self.offers().is_assessed_only
    }

    /// Returns the interval (s) in which the metrics assess the estimator.
    pub fn assess(&self) -> [f64; 2] {
        self.assessment().map_or([0.0, f64::INFINITY], |interval| interval.map(NonNegative::get))
    }
}
