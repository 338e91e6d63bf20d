//! Time that a sample of an estimator takes on an ordinary core, for estimates of the cost of a run.

/// Sample of an attitude filter (s).
pub(super) const ATTITUDE_FILTER_S: f64 = 1.2e-6;
/// Sample of a Kalman filter about an axis, without the products of its matrices (s).
pub(super) const KALMAN_S: f64 = 1.5e-6;
/// Sample of adaptive observers, for each mode (s).
pub(super) const ADAPTIVE_S: f64 = 1.5e-7;
/// Number of operations per cube of the order of an attitude filter with modes, at each sample.
pub(super) const ELASTIC_PRODUCTS: f64 = 25.0;

/// Returns the time (s) of the products of two matrices of an order.
pub(super) fn products_s(order: f64) -> f64 {
    order * order * order * 1e-9
}
