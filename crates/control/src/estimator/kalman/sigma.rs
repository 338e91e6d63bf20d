//! The unscented transform: mean and covariance propagated by points around the mean instead of a derivative.
//!
//! The scaled form (\[JulierUhlmann04\]) with alpha = 1/2, beta = 2 and kappa = 0.

use nalgebra::{Cholesky, DMatrix, DVector};

const ALPHA: f64 = 0.5;
const BETA: f64 = 2.0;

/// Propagates a normal distribution through a flow; `None` if the covariance is not positive definite.
pub fn transform(
    mean: &mut DVector<f64>,
    covariance: &mut DMatrix<f64>,
    flow: impl Fn(&mut [f64]),
) -> Option<()> {
    let order = mean.len();
    let n = order as f64;
    let scale = ALPHA * ALPHA * n;
    let root = Cholesky::new(covariance.clone())?.unpack() * f64::sqrt(scale);
    let mut points = DMatrix::zeros(order, 2 * order + 1);
    for (index, mut point) in points.column_iter_mut().enumerate() {
        point.copy_from(mean);
        match index {
            0 => {}
            i if i <= order => point += root.column(i - 1),
            i => point -= root.column(i - 1 - order),
        }
    }
    points.as_mut_slice().chunks_exact_mut(order).for_each(flow);
    let weight = 0.5 / scale;
    let centre = 1.0 - n / scale;
    let origin = points.column(0).into_owned();
    // Relative to the central point, whose weight is large and negative, nothing cancels.
    points.column_iter_mut().for_each(|mut point| point -= &origin);
    let shift = points.column_sum() * weight;
    // Weights of a covariance about the mean: sum w d d' = sum w p p' - (2 - sum w) s s', where sum w = 2 - alpha² +
    // beta.
    let total = 2.0 * n * weight + centre + 1.0 - ALPHA * ALPHA + BETA;
    points.mul_to(&points.transpose(), covariance);
    *covariance *= weight;
    covariance.ger(total - 2.0, &shift, &shift, 1.0);
    *mean = origin + shift;
    Some(())
}
