//! Stationary covariance of a linear system under white noise: the discrete Lyapunov equation, by doubling.

use nalgebra::DMatrix;

/// Largest number of doublings: motions that decay by less than 1e-15 in a period do not settle.
const DOUBLINGS: usize = 55;
/// Change of a covariance, relative to its deviations, below which it has settled.
const SETTLED: f64 = 1e-15;

/// Powers A, A², A⁴, .. of a transition, which sum the series P = Q + A Q A' + A² Q A'² + ..
#[derive(Clone, Debug)]
pub struct DoublingSeries {
    powers: Vec<DMatrix<f64>>,
}

impl DoublingSeries {
    /// Computes the powers of a transition until they vanish.
    pub fn new(a: &DMatrix<f64>) -> Self {
        let mut powers = vec![a.clone()];
        while powers.len() < DOUBLINGS {
            let last = &powers[powers.len() - 1];
            let next = last * last;
            if next.amax() < 1e-200 || next.iter().any(|entry| !entry.is_finite()) {
                break;
            }
            powers.push(next);
        }
        Self { powers }
    }

    /// Solves P = A P A' + Q for a covariance Q; `None` if the series does not converge.
    pub fn solve(&self, q: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        let first = self.sum(q)?;
        // The residual of the equation itself removes the rounding of the powers.
        let residual = &self.powers[0] * &first * self.powers[0].transpose() + q - &first;
        let whole = &first + self.sum(&residual).unwrap_or_else(|| DMatrix::zeros(q.nrows(), q.ncols()));
        Some((&whole + whole.transpose()) * 0.5)
    }

    fn sum(&self, q: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        let mut sum = q.clone();
        for power in &self.powers {
            let more = power * &sum * power.transpose();
            let has_settled = (0..sum.nrows()).all(|row| {
                let (own, change) = (sum[(row, row)].abs(), more[(row, row)].abs());
                change <= SETTLED * own || change < f64::MIN_POSITIVE
            });
            sum += more;
            if has_settled {
                return Some(sum);
            }
        }
        // Powers that vanish end the series.
        let last = &self.powers[self.powers.len() - 1];
        let vanishes = self.powers.len() < DOUBLINGS && last.amax() < 1e-20;
        (vanishes && sum.iter().all(|entry| entry.is_finite())).then_some(sum)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::dmatrix;

    use super::*;

    #[test]
    fn the_equation_holds_for_a_slow_swing_beside_a_delay() {
        let (re, im) = (0.999_999 * libm::cos(0.3), 0.999_999 * libm::sin(0.3));
        let a = dmatrix![re, im, 0.0; -im, re, 0.0; 1.0, 0.0, 0.0];
        let g = dmatrix![0.0; 1e-3; 0.0];
        let q = &g * g.transpose();
        let p = DoublingSeries::new(&a).solve(&q).expect("settles");
        let residual = &a * &p * a.transpose() + &q - &p;
        assert!(residual.amax() < 1e-15 * p.amax(), "{residual}");
        // Sum of the variances of a rotation that decays: 1e-6/(1 - r²).
        let exact = 1e-6 / (1.0 - 0.999_999 * 0.999_999);
        assert!(((p[(0, 0)] + p[(1, 1)]) / exact - 1.0).abs() < 1e-10);
        assert!((p[(2, 2)] / p[(0, 0)] - 1.0).abs() < 1e-10);
    }

    #[test]
    fn a_walk_does_not_settle() {
        assert!(DoublingSeries::new(&dmatrix![1.0]).solve(&dmatrix![1.0]).is_none());
        assert_eq!(DoublingSeries::new(&dmatrix![0.0]).solve(&dmatrix![4.0]), Some(dmatrix![4.0]));
    }
}
