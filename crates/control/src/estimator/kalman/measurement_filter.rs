//! Kalman filters of measured angles and rates as estimators: they act about each axis, with keys that all of them have.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::{NonNegative, Positive};
use flexsc_numerics::random::{Seed, Stream};
use flexsc_spacecraft::body::Mode;

use super::{FilterContext, KalmanFilter, Ratios};
use crate::estimator::requirements::require_modes;
use crate::estimator::sample_cost::{KALMAN_S, products_s};
use crate::estimator::sampled::AxisEstimators;
use crate::estimator::{EstimateOutputs, Estimator, EstimatorContext, EstimatorSpec};
use crate::offers::{EstimatorOffers, Offers};
use crate::requirement::Requirements;

/// Settings of a Kalman filter of measured angles and rates.
pub trait MeasurementFilter: Send + Sync {
    /// Number of passes through the matrices per sample.
    const PASSES: f64 = 2.0;

    /// Creates the filter for a setting; `draws` supplies a drawn prior.
    fn filter(&self, setting: &FilterContext<'_>, draws: &mut Stream) -> KalmanFilter;

    /// Returns the keys that all filters have.
    fn keys(&self) -> FilterKeys<'_>;

    /// Checks the settings against each other; returns a key within the filter and the reason.
    fn validate(&self) -> Option<ConfigError> {
        None
    }
}

/// Keys that all Kalman filters of measured angles and rates have.
#[derive(Copy, Clone, Debug)]
pub struct FilterKeys<'a> {
    /// Modes of the filter's model, if they differ from the body's.
    pub modes: Option<&'a [Mode]>,
    /// Standard deviation of the measured angle (rad) that replaces the sensor's own, if given.
    pub angle_noise: Option<Positive>,
    /// Interval (s) in which the metrics assess the filter; `None` for the whole run.
    pub assess: Option<[NonNegative; 2]>,
    /// Estimates that the law reads in addition to the dominant mode, if given.
    pub feeds: Option<EstimateOutputs>,
    /// True if the filter runs for assessment only.
    pub watch_only: bool,
    /// Ratios of frequencies that the filter estimates, if it does.
    pub ratios: Option<Ratios>,
}

impl<F: MeasurementFilter> EstimatorSpec for F {
    fn start(&self, known: &EstimatorContext<'_>, seed: Seed) -> Box<dyn Estimator> {
        AxisEstimators::start(known, seed, |setting, draws| Some(self.filter(setting, draws)))
    }

    fn offers(&self) -> EstimatorOffers {
        let is_assessed_only = self.keys().watch_only;
        EstimatorOffers {
            is_assessed_only,
            dominant_mode: !is_assessed_only,
            filters_measurements: true,
            needs_reader: true,
            ..EstimatorOffers::default()
        }
    }

    fn validate(&self) -> Option<ConfigError> {
        MeasurementFilter::validate(self)
    }

    fn requires(&self, offers: &Offers, needs: &mut Requirements) {
        if let (Some(_), Some(matrix)) = (self.keys().ratios, &offers.body.damping_matrix) {
            let why = "couples modes, and a filter of their frequencies predicts each mode on its own: use `kalman`";
            needs.require_elsewhere(false, matrix, why);
        }
        require_modes(self, offers, needs);
    }

    fn feeds(&self, dominant: bool) -> EstimateOutputs {
        let keys = self.keys();
        let given = if keys.watch_only { Some(EstimateOutputs::Modes) } else { keys.feeds };
        EstimateOutputs::given_or_default(given, dominant)
    }

    fn modes(&self) -> Option<&[Mode]> {
        self.keys().modes
    }

    fn angle_noise(&self) -> Option<f64> {
        self.keys().angle_noise.map(Positive::get)
    }

    fn states(&self, modes: usize) -> usize {
        2 + 2 * modes + self.keys().ratios.map_or(0, |ratios| 2 * ratios.count(modes))
    }

    fn assessment(&self) -> Option<[NonNegative; 2]> {
        self.keys().assess
    }

    fn sample_seconds(&self, axes: usize, modes: f64) -> f64 {
        axes as f64 * (KALMAN_S + F::PASSES * products_s(4.0 + 2.0 * modes))
    }
}
