//! Finite rotations by a small vector, and the angular rate due to a change of the vector.

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::lanes::{LaneFloat, Mask};

use super::vectors::{StoredVectors, Vectors, vector};

/// Squared angle below which the coefficients are computed by their series (rad²).
const SMALL: f64 = 0.04;

/// Squared angle below which three terms of the series suffice (rad²).
const TINY: f64 = 1e-5;

/// Coefficients of sin t/t, (1 - cos t)/t² and (t - sin t)/t³ by powers of t².
const FIRST: [f64; 7] = series(1);
const SECOND: [f64; 7] = series(2);
const THIRD: [f64; 7] = series(3);

/// Returns 1/n! for every second n starting at `from`, with alternating signs.
const fn series(from: usize) -> [f64; 7] {
    let mut of = [0.0; 7];
    let (mut factorial, mut n, mut k, mut sign) = (1.0, 1, 0, 1.0);
    while k < 7 {
        while n <= from + 2 * k {
            factorial *= n as f64;
            n += 1;
        }
        of[k] = sign / factorial;
        sign = -sign;
        k += 1;
    }
    of
}

/// Evaluates such a series at a small x.
#[inline]
fn sum(of: &[f64; 7], x: f64) -> f64 {
    let tail = if x < TINY { of[2] } else { of[2] + x * (of[3] + x * (of[4] + x * (of[5] + x * of[6]))) };
    of[0] + x * (of[1] + x * tail)
}

/// Rotation by a vector th of length t (rad), from the hub's axes to the mean axes.
#[derive(Copy, Clone, Debug)]
pub struct SmallRotation {
    by: Vector,
    /// Coefficient sin t/t.
    first: f64,
    /// Coefficient (1 - cos t)/t².
    second: f64,
    /// Coefficient (t - sin t)/t³.
    third: f64,
}

impl SmallRotation {
    /// Creates the rotation by a vector (rad).
    pub fn new(by: Vector) -> Self {
        let x = by.norm_squared();
        if x < SMALL {
            // 0.04^7/15! and 1e-15/7! are below the last bit.
            return Self { by, first: sum(&FIRST, x), second: sum(&SECOND, x), third: sum(&THIRD, x) };
        }
        let t = f64::sqrt(x);
        let (sin, cos) = libm::sincos(t);
        Self { by, first: sin / t, second: (1.0 - cos) / x, third: (t - sin) / (x * t) }
    }

    /// Transforms a vector from the hub's axes into the mean axes: exp(\[th\]) v.
    pub fn to_mean_axes(self, v: &Vector) -> Vector {
        let once = self.by.cross(v);
        v + once * self.first + self.by.cross(&once) * self.second
    }

    /// Transforms a vector from the mean axes into the hub's axes: exp(-\[th\]) v.
    pub fn to_hub_axes(self, v: &Vector) -> Vector {
        let once = self.by.cross(v);
        v - once * self.first + self.by.cross(&once) * self.second
    }

    /// Returns the excess of th' = `v` over the rate of the hub against the mean axes, in the hub's axes: (1 - Gr) v
    /// = (1 - cos t)/t² th x v - (t - sin t)/t³ th x (th x v).
    pub fn rate_correction(&self, v: &Vector) -> Vector {
        let once = self.by.cross(v);
        once * self.second - self.by.cross(&once) * self.third
    }
}

/// Rotations by a small vector in each of four SIMD lanes, as [`SmallRotation`].
pub(super) struct SmallRotationLanes<R> {
    by: Vectors<R>,
    first: R,
    second: R,
    third: R,
}

/// Evaluates the first three terms of a series, which suffice below [`TINY`].
#[inline(always)]
fn short<R: LaneFloat>(of: &[f64; 7], x: R) -> R {
    (x * of[2] + of[1]) * x + of[0]
}

impl<R: LaneFloat> SmallRotationLanes<R> {
    /// Creates the rotations by vectors (rad).
    #[inline(always)]
    pub fn new(kind: R, by: Vectors<R>) -> Self {
        let x = by.dot(by);
        if x.lt(kind.splat(TINY)).all() {
            return Self { by, first: short(&FIRST, x), second: short(&SECOND, x), third: short(&THIRD, x) };
        }
        let (mut each, mut all) = (StoredVectors::default(), [[0.0; 4]; 3]);
        by.store(&mut each);
        for lane in 0..4 {
            let SmallRotation { first, second, third, .. } = SmallRotation::new(vector(&each, lane));
            (all[0][lane], all[1][lane], all[2][lane]) = (first, second, third);
        }
        Self { by, first: kind.load(&all[0]), second: kind.load(&all[1]), third: kind.load(&all[2]) }
    }

    /// Transforms vectors into the mean axes, as [`SmallRotation::to_mean_axes`].
    #[inline(always)]
    pub fn to_mean_axes(&self, v: Vectors<R>) -> Vectors<R> {
        let once = self.by.cross(v);
        v + once.scaled(self.first) + self.by.cross(once).scaled(self.second)
    }

    /// Transforms vectors into the hub's axes, as [`SmallRotation::to_hub_axes`].
    #[inline(always)]
    pub fn to_hub_axes(&self, v: Vectors<R>) -> Vectors<R> {
        let once = self.by.cross(v);
        v - once.scaled(self.first) + self.by.cross(once).scaled(self.second)
    }

    /// Returns the rate corrections, as [`SmallRotation::rate_correction`].
    #[inline(always)]
    pub fn rate_correction(&self, v: Vectors<R>) -> Vectors<R> {
        let once = self.by.cross(v);
        once.scaled(self.second) - self.by.cross(once).scaled(self.third)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_and_closed_form_meet_and_rotations_are_undone() {
        let v = Vector::new(0.3, -1.1, 0.7);
        for t in [1e-9, 1e-3, 0.199_999, 0.200_001, 1.0, 3.0] {
            let by = Vector::new(2.0, -1.0, 2.0) * (t / 3.0);
            let bend = SmallRotation::new(by);
            let third = (t - libm::sin(t)) / (t * t * t);
            assert!((bend.first - libm::sin(t) / t).abs() < 1e-15, "{t}");
            assert!((bend.second - 2.0 * libm::pow(libm::sin(0.5 * t) / t, 2.0)).abs() < 2e-15, "{t}");
            assert!(t < 0.1 || (bend.third - third).abs() < 2e-14, "{t}");
            assert!((bend.to_hub_axes(&bend.to_mean_axes(&v)) - v).norm() < 1e-15, "{t}");
            // Checks the rate against the mean axes by a difference quotient of exp(th).
            let rate = Vector::new(-0.2, 0.4, 0.1);
            let step = 1e-5;
            let (later, sooner) =
                (SmallRotation::new(by + rate * step), SmallRotation::new(by - rate * step));
            let change = (bend.to_hub_axes(&later.to_mean_axes(&v))
                - bend.to_hub_axes(&sooner.to_mean_axes(&v)))
                / (2.0 * step);
            let turned = (rate - bend.rate_correction(&rate)).cross(&v);
            assert!((change - turned).norm() < 1e-9, "{t}: {change} {turned}");
        }
    }
}
