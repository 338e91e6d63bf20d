//! Estimates of each mode with standard deviations, and the error against the true state.

use nalgebra::{Cholesky, DVector};

use super::{FARTHEST, KalmanFilter};

impl KalmanFilter {
    /// Returns the estimated amplitude of a mode, sqrt(x² + (x'/w)²), and its standard deviation (rad).
    pub fn amplitude(&self, mode: usize) -> (f64, f64) {
        let (x, v) = (2 + 2 * mode, 3 + 2 * mode);
        let w = self.tuning.model.frequency(mode, self.mean.as_slice());
        let quadrature = self.mean[v] / w;
        let amplitude = libm::hypot(self.mean[x], quadrature);
        let (cos, sin) =
            if amplitude > 0.0 { (self.mean[x] / amplitude, quadrature / amplitude) } else { (1.0, 0.0) };
        let mut gradient = [(x, cos), (v, sin / w), (x, 0.0)];
        if let Some(index) = self.tuning.model.ratio_of(mode) {
            gradient[2] = (index, -sin * quadrature / self.mean[index]);
        }
        (amplitude, f64::sqrt(self.variance(&gradient)))
    }

    /// Returns the estimated natural frequency of a mode, and its standard deviation (rad/s).
    pub fn frequency(&self, mode: usize) -> (f64, f64) {
        let model = &self.tuning.model;
        let w = model.frequency(mode, self.mean.as_slice());
        let sd = model
            .ratio_of(mode)
            .map_or(0.0, |index| w / self.mean[index] * f64::sqrt(self.covariance[(index, index)]));
        (w, sd)
    }

    /// Returns the variance of a weighted sum of components.
    fn variance(&self, weights: &[(usize, f64)]) -> f64 {
        let terms =
            weights.iter().flat_map(|a| weights.iter().map(|b| a.1 * b.1 * self.covariance[(a.0, b.0)]));
        terms.sum::<f64>().max(0.0)
    }

    /// Returns the normalised squared error against a true state. Its mean is the state's order if the filter is
    /// consistent. It is at most 10^12, also if the covariance has no inverse.
    pub fn nees(&self, truth: &[f64]) -> f64 {
        let error = DVector::from_row_slice(truth) - &self.mean;
        let root = Cholesky::new(self.covariance.clone());
        let nees = root.map_or(f64::INFINITY, |root| error.dot(&root.solve(&error)));
        if nees <= FARTHEST * FARTHEST { nees } else { FARTHEST * FARTHEST }
    }
}
