//! Allocation of a three-axis torque to wheels: the sum of axis times torque over the wheels is the demanded torque.

use flexsc_flight::vector3::Vector3;
use flexsc_flight::wheel_allocation::AllocatedWheel;
use flexsc_flight_precision::Precision;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::flight_types::to_vector3;
use nalgebra::{Cholesky, Matrix3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the demanded torque is distributed over the wheels.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Choice")]
pub enum AllocationCriterion {
    /// Smallest sum of squared wheel torques, by the pseudo-inverse.
    #[default]
    PseudoInverse,
    /// Smallest largest wheel torque, for at most four wheels: more torque about most axes, but more reversals of
    /// the wheels.
    LeastLargest,
}

/// Allocation of a torque to wheels with given axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Allocation {
    axes: Vec<Vector>,
    /// Unit axes as flight code has them.
    flight_axes: Vec<Vector3>,
    /// Share of each wheel, with the torque of the last allocation, at first 0.
    wheels: Vec<AllocatedWheel>,
    /// Cancelling torques of four wheels: the largest has size 1, the first that is not 0 is positive.
    null: Option<[f64; 4]>,
    choice: AllocationCriterion,
    precision: Precision,
}

impl Allocation {
    /// Creates the allocation to wheels about these unit axes; `None` if they do not span three axes.
    pub fn new(axes: &[Vector], choice: AllocationCriterion) -> Option<Self> {
        let gram = axes.iter().fold(Matrix3::zeros(), |sum, axis| sum + axis * axis.transpose());
        // Wheels in a plane give no torque perpendicular to it.
        if gram.determinant() < 1e-9 * axes.len().pow(3) as f64 {
            return None;
        }
        let solved = Cholesky::new(gram)?.inverse();
        let null = null_vector(axes);
        let wheel = |(index, axis): (usize, &Vector)| AllocatedWheel {
            share: to_vector3(&(solved * axis)),
            null: null.map_or(0.0, |null| null[index]),
            torque: 0.0,
        };
        let wheels = axes.iter().enumerate().map(wheel).collect();
        let flight_axes = axes.iter().map(to_vector3).collect();
        let precision = Precision::Double;
        Some(Self { axes: axes.to_vec(), flight_axes, wheels, null, choice, precision })
    }

    /// Returns the allocation on a flight computer of this precision.
    #[must_use]
    pub fn with_precision(self, precision: Precision) -> Self {
        Self { precision, ..self }
    }

    /// Returns the precision of the flight computer.
    pub fn precision(&self) -> Precision {
        self.precision
    }

    /// Returns the wheels' axes.
    pub fn axes(&self) -> &[Vector] {
        &self.axes
    }

    /// Returns the wheels' axes as flight code has them.
    pub fn flight_axes(&self) -> &[Vector3] {
        &self.flight_axes
    }

    /// Returns torques of four wheels that cancel each other, the largest of size 1.
    pub fn null_vector(&self) -> Option<&[f64; 4]> {
        self.null.as_ref()
    }

    /// Returns the torques of all wheels that give the torque `demanded` about the three axes (N m).
    pub fn torques(&self, demanded: &Vector) -> Vec<f64> {
        let mut allocated = self.clone();
        allocated.allocate(demanded, &Vector::zeros(), f64::INFINITY);
        allocated.wheels.iter().map(|wheel| wheel.torque).collect()
    }

    /// Gives the wheels the torques that sum up to the torque `against` without the torque `demanded` about the three axes (N m), or
    /// less about the same axis if one of them would exceed `limit` (N m).
    pub fn allocate(&mut self, against: &Vector, demanded: &Vector, limit: f64) {
        let (is_least_largest, precision) = (self.is_least_largest(), self.precision);
        let (demanded, counter) = (to_vector3(demanded), to_vector3(against));
        precision.drive(&mut self.wheels, &demanded, &counter, is_least_largest, limit);
    }

    /// Returns the wheels as flight code has them, with the torques of the last allocation, at first 0.
    pub fn flight_wheels(&self) -> &[AllocatedWheel] {
        &self.wheels
    }

    /// Returns the wheels as [`Self::flight_wheels`] does, so that their torques can be changed.
    pub fn flight_wheels_mut(&mut self) -> &mut [AllocatedWheel] {
        &mut self.wheels
    }

    /// Returns true if the largest torque is minimised, which needs four wheels.
    pub fn is_least_largest(&self) -> bool {
        self.choice == AllocationCriterion::LeastLargest && self.null.is_some()
    }

    /// Returns the largest torque about a single axis (N m), with `limit` (N m) for each wheel.
    pub fn largest_torque(&self, axis: usize, limit: f64) -> f64 {
        let mut demanded = Vector::zeros();
        demanded[axis] = 1.0;
        limit / self.torques(&demanded).into_iter().map(f64::abs).fold(0.0, f64::max)
    }
}

/// Returns four torques about four axes that cancel: up to their sign, the volumes that the other three axes span.
fn null_vector(axes: &[Vector]) -> Option<[f64; 4]> {
    let &[a, b, c, d] = axes else { return None };
    let volume = |x: Vector, y: Vector, z: Vector| x.dot(&y.cross(&z));
    let null = [volume(b, c, d), -volume(a, c, d), volume(a, b, d), -volume(a, b, c)];
    let largest = null.into_iter().map(f64::abs).fold(0.0, f64::max);
    let first = null.into_iter().find(|part| part.abs() > 1e-9 * largest)?;
    Some(null.map(|part| part / libm::copysign(largest, first)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pyramid() -> Vec<Vector> {
        let (sin, cos) = libm::sincos(35.0_f64.to_radians());
        [45.0_f64, 135.0, 225.0, 315.0]
            .map(|azimuth| {
                let (s, c) = libm::sincos(azimuth.to_radians());
                Vector::new(cos * c, cos * s, sin)
            })
            .to_vec()
    }

    fn combined_torque(axes: &[Vector], torques: &[f64]) -> Vector {
        axes.iter().zip(torques).fold(Vector::zeros(), |sum, (axis, torque)| sum + axis * *torque)
    }

    #[test]
    fn a_pyramid_of_four_gives_what_is_wanted() {
        let demanded = -Vector::new(0.1, -0.05, 0.2);
        let exact = [-0.108_752_79, -0.022_430_99, -0.065_591_89, -0.151_913_69];
        let [least_squares, least_largest] =
            [AllocationCriterion::PseudoInverse, AllocationCriterion::LeastLargest]
                .map(|choice| Allocation::new(&pyramid(), choice).unwrap());
        let torques = least_squares.torques(&demanded);
        for (found, exact) in torques.iter().zip(exact) {
            assert!((found - exact).abs() < 5e-9, "{found} {exact}");
        }
        for (found, exact) in least_squares.null_vector().unwrap().iter().zip([1.0, -1.0, 1.0, -1.0]) {
            assert!((found - exact).abs() < 1e-15);
        }
        // Result of the linear programme.
        let torques = least_largest.torques(&demanded);
        let largest = torques.iter().map(|torque| torque.abs()).fold(0.0, f64::max);
        assert!((largest - 0.130_333_24).abs() < 5e-9, "{largest}");
        assert!((combined_torque(&pyramid(), &torques) - demanded).norm() < 1e-16);
        // Already equal.
        let upwards = least_largest.torques(&Vector::z());
        assert!((combined_torque(&pyramid(), &upwards) - Vector::z()).norm() < 1e-15, "{upwards:?}");
    }

    #[test]
    fn any_four_axes_have_a_least_largest() {
        let axes = [[1.0, 0.2, 0.1], [-0.3, 1.0, 0.0], [0.1, -0.2, 1.0], [0.5, 0.6, -0.4]]
            .map(|axis| Vector::from(axis).normalize())
            .to_vec();
        let allocation = Allocation::new(&axes, AllocationCriterion::LeastLargest).unwrap();
        let null = allocation.null_vector().unwrap();
        assert!(combined_torque(&axes, null).norm() < 1e-15);
        for demanded in [Vector::new(1.0, 2.0, -0.5), Vector::new(-0.2, 0.1, 3.0), Vector::new(0.0, 1.0, 0.0)]
        {
            let torques = allocation.torques(&demanded);
            assert!((combined_torque(&axes, &torques) - demanded).norm() < 1e-14);
            let largest = |part: f64| {
                let sizes = torques.iter().zip(null).map(|(u, n)| (u + part * n).abs());
                sizes.fold(0.0, f64::max)
            };
            // A step along the null vector never reduces the largest torque.
            for part in [-1.0, -1e-3, -1e-9, 1e-9, 1e-3, 1.0] {
                assert!(largest(part) >= largest(0.0), "{part}");
            }
        }
    }

    #[test]
    fn three_wheels_have_one_way_and_a_plane_none() {
        let three = [Vector::x(), Vector::y(), Vector::z()];
        let allocation = Allocation::new(&three, AllocationCriterion::LeastLargest).unwrap();
        assert_eq!(allocation.torques(&Vector::new(1.0, 2.0, 3.0)), [1.0, 2.0, 3.0]);
        assert_eq!(allocation.largest_torque(2, 0.4), 0.4);
        let plane = [Vector::x(), Vector::y(), (Vector::x() + Vector::y()).normalize()];
        assert!(Allocation::new(&plane, AllocationCriterion::PseudoInverse).is_none());
    }
}
