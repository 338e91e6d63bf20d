//! Finite rotations by a small vector, and the rate that a change of the vector makes.

use nalgebra::Quaternion;

use crate::attitude::Vector;

/// Squares of an angle below which the coefficients come from their series (rad²).
const SMALL: f64 = 0.04;

/// The rotation by a vector th of length t (rad), from hub to mean axes.
#[derive(Copy, Clone, Debug)]
pub struct Bend {
    by: Vector,
    /// sin t/t.
    first: f64,
    /// (1 - cos t)/t².
    second: f64,
    /// (t - sin t)/t³.
    third: f64,
}

impl Bend {
    /// The rotation by a vector (rad).
    pub fn new(by: Vector) -> Self {
        let x = by.norm_squared();
        if x < SMALL {
            // 0.04^6/13! and 0.04^7/14! are below the last bit.
            let series = |from: f64| {
                (0..7).rev().fold(0.0, |sum, k| {
                    let n = from + f64::from(2 * k);
                    1.0 - sum * x / ((n + 1.0) * (n + 2.0))
                })
            };
            return Self { by, first: series(1.0), second: series(2.0) / 2.0, third: series(3.0) / 6.0 };
        }
        let t = libm::sqrt(x);
        let (sin, cos) = libm::sincos(t);
        Self { by, first: sin / t, second: (1.0 - cos) / x, third: (t - sin) / (x * t) }
    }

    /// A vector of the hub in mean axes: exp(\[th\]) v.
    pub fn forward(&self, v: &Vector) -> Vector {
        let once = self.by.cross(v);
        v + once * self.first + self.by.cross(&once) * self.second
    }

    /// A vector of the mean axes in those of the hub: exp(-\[th\]) v.
    pub fn back(&self, v: &Vector) -> Vector {
        let once = self.by.cross(v);
        v - once * self.first + self.by.cross(&once) * self.second
    }

    /// By how much th' = `v` exceeds the rate of the hub against the mean axes, in the hub's axes:
    /// (1 - Gr) v = (1 - cos t)/t² th x v - (t - sin t)/t³ th x (th x v).
    pub fn excess(&self, v: &Vector) -> Vector {
        let once = self.by.cross(v);
        once * self.second - self.by.cross(&once) * self.third
    }
}

/// A vector of the mean axes in inertial ones, by a quaternion that is of length 1 but for the error of a stage.
pub fn inertial(attitude: &Quaternion<f64>, v: &Vector) -> Vector {
    (*attitude * Quaternion::from_imag(*v) * attitude.conjugate()).vector() / attitude.norm_squared()
}

/// Q' = 1/2 Q o (0, w).
pub fn spin(attitude: &Quaternion<f64>, rate: &Vector) -> Quaternion<f64> {
    *attitude * Quaternion::from_imag(rate * 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_and_closed_form_meet_and_rotations_are_undone() {
        let v = Vector::new(0.3, -1.1, 0.7);
        for t in [1e-9, 1e-3, 0.199_999, 0.200_001, 1.0, 3.0] {
            let by = Vector::new(2.0, -1.0, 2.0) * (t / 3.0);
            let bend = Bend::new(by);
            let third = (t - libm::sin(t)) / (t * t * t);
            assert!((bend.first - libm::sin(t) / t).abs() < 1e-15, "{t}");
            assert!((bend.second - 2.0 * libm::pow(libm::sin(0.5 * t) / t, 2.0)).abs() < 2e-15, "{t}");
            assert!(t < 0.1 || (bend.third - third).abs() < 2e-14, "{t}");
            assert!((bend.back(&bend.forward(&v)) - v).norm() < 1e-15, "{t}");
            // The rate against the mean axes, by a difference quotient of exp(th).
            let rate = Vector::new(-0.2, 0.4, 0.1);
            let step = 1e-5;
            let (later, sooner) = (Bend::new(by + rate * step), Bend::new(by - rate * step));
            let change = (bend.back(&later.forward(&v)) - bend.back(&sooner.forward(&v))) / (2.0 * step);
            let turned = (rate - bend.excess(&rate)).cross(&v);
            assert!((change - turned).norm() < 1e-9, "{t}: {change} {turned}");
        }
    }
}
