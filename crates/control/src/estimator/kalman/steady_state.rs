//! Steady state of a linear Kalman filter, with constant gains.

use flexsc_numerics::inverse::inverse;
use nalgebra::{DMatrix, DVector};
use serde::Serialize;

use super::filter::{KalmanFilter, Prediction};

/// Largest number of samples until the gains settle.
const MOST: usize = 2_000_000;
/// Largest number of doublings of the time that a covariance needs to settle.
const DOUBLINGS: usize = 60;
/// Gains have settled if no sample changes them by more than this fraction of the largest.
const SETTLED: f64 = 1e-13;

/// Steady-state filter as a linear system: x- = F x + g m over a period with the mean reduced moment m (rad/s²); then,
/// for the angle and for the rate if it is measured, x += k (y - h x-), one after the other.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SteadyStateFilter {
    /// Transition matrix F, row by row.
    pub transition: Vec<Vec<f64>>,
    /// Input vector g.
    pub push: Vec<f64>,
    /// Gain k of each measurement.
    pub gains: Vec<Vec<f64>>,
}

impl KalmanFilter {
    /// Returns the filter's steady state, if it is linear and its gains settle.
    pub fn steady_state(&self) -> Option<SteadyStateFilter> {
        let Prediction::Linear(transition, input) = &self.tuning().prediction else { return None };
        let (order, tuning) = (input.len(), self.tuning());
        let noises: Vec<f64> = [Some(tuning.angle_noise), tuning.rate_noise].into_iter().flatten().collect();
        let start = || DMatrix::from_diagonal(&tuning.spread.map(|sd| sd * sd));
        let mut covariance = settled_covariance(transition, self.noise(), &noises).unwrap_or_else(start);
        let mut before: Vec<DVector<f64>> = Vec::new();
        // A gain may pass through a stationary point: it has settled only after being constant for long.
        let mut still = 0;
        for _ in 0..MOST {
            covariance = transition * covariance * transition.transpose() + self.noise();
            let mut gains = Vec::with_capacity(noises.len());
            for (first, noise) in noises.iter().enumerate() {
                let observable = (first..order)
                    .step_by(2)
                    .fold(DVector::zeros(order), |sum, place| sum + covariance.column(place));
                let variance =
                    (first..order).step_by(2).map(|place| observable[place]).sum::<f64>() + noise * noise;
                let gain = &observable / variance;
                covariance -= &gain * observable.transpose();
                gains.push(gain);
            }
            covariance = (&covariance + covariance.transpose()) * 0.5;
            if !gains.iter().all(|gain| gain.iter().all(|part| part.is_finite())) {
                return None;
            }
            let settled =
                before.iter().zip(&gains).all(|(old, new)| (new - old).amax() <= SETTLED * new.amax());
            still = if settled && !before.is_empty() { still + 1 } else { 0 };
            before = gains;
            if still > 100 {
                break;
            }
        }
        // Without noise in the moment, the gains decay towards 0 for ever.
        let moves = before.iter().any(|gain| gain.amax() > 1e-9);
        (still > 100 && moves).then(|| SteadyStateFilter {
            transition: transition.row_iter().map(|row| row.iter().copied().collect()).collect(),
            push: input.iter().copied().collect(),
            gains: before.iter().map(|gain| gain.iter().copied().collect()).collect(),
        })
    }
}

/// Returns the covariance after a measurement that many samples lead to, by doubling their number in each step
/// (\[ChuFanLinWang04\]); `None` without noise of a measurement, or if it does not settle. The samples that follow remove its
/// rounding.
fn settled_covariance(
    transition: &DMatrix<f64>,
    noise: &DMatrix<f64>,
    measured: &[f64],
) -> Option<DMatrix<f64>> {
    let order = transition.nrows();
    if measured.iter().any(|own| *own * *own <= 0.0) {
        return None;
    }
    let information = DMatrix::from_fn(order, order, |row, column| {
        let own = measured.get(row % 2).filter(|_| row % 2 == column % 2);
        own.map_or(0.0, |own| 1.0 / (own * own))
    });
    let one = DMatrix::identity(order, order);
    let (mut a, mut g, mut p) = (transition.transpose(), information.clone(), noise.clone());
    let mut is_settled = false;
    for _ in 0..DOUBLINGS {
        let inverse = inverse(&one + &g * &p)?;
        let step = &a * &inverse;
        let added = a.transpose() * &p * &inverse * &a;
        g += &step * &g * a.transpose();
        p += &added;
        p = (&p + p.transpose()) * 0.5;
        g = (&g + g.transpose()) * 0.5;
        a = &step * &a;
        if !p.iter().all(|entry| entry.is_finite()) {
            return None;
        }
        is_settled = added.amax() <= SETTLED * p.amax();
        if is_settled {
            break;
        }
    }
    if !is_settled {
        return None;
    }
    // From the predicted covariance to that after the measurements.
    let corrected = inverse(one + &p * information)? * p;
    Some((&corrected + corrected.transpose()) * 0.5)
}
