//! Time that a sample of an estimator takes on an ordinary core, for estimates of the cost of a run.

use super::EstimatorKind;

/// Time (s), and the part that each mode adds.
type Pace = (f64, f64);

/// Sample of an attitude filter, of a Kalman filter about an axis, and of an adaptive observer.
const ATTITUDE_FILTER: Pace = (1.2e-6, 0.0);
const KALMAN: Pace = (1.5e-6, 0.0);
const ADAPTIVE: Pace = (0.0, 1.5e-7);
/// Time of an operation with numbers of a matrix (s).
const PRODUCT_S: f64 = 1e-9;
/// Number of such operations per cube of the order of an attitude filter with modes, at each sample.
const ELASTIC_PRODUCTS: f64 = 25.0;

impl EstimatorKind {
    /// Returns the time of a sample (s), for a body with `axes` axes and `modes` modes.
    pub fn sample_seconds(&self, axes: usize, modes: f64) -> f64 {
        let takes = |(base, each): Pace| base + modes * each;
        if let Some(filter) = self.attitude() {
            return filter.elastic.as_ref().map_or(takes(ATTITUDE_FILTER), |elastic| {
                let order = 6.0 + 3.0 * elastic.modes.len() as f64;
                ELASTIC_PRODUCTS * order * order * order * PRODUCT_S
            });
        }
        match self {
            Self::Adaptive(_) => takes(ADAPTIVE),
            filter if filter.filters_measurements() => {
                // Matrices of the order of its state.
                let order = 4.0 + 2.0 * modes;
                let passes = if matches!(filter, Self::UnscentedKalman(_)) { 4.0 } else { 2.0 };
                let axes = axes as f64;
                axes * (takes(KALMAN) + passes * order * order * order * PRODUCT_S)
            }
            _ => 0.0,
        }
    }
}
