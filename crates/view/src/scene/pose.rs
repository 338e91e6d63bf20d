//! Poses: rotations and places as viewer messages, rounded to single precision, which the eye cannot distinguish from
//! double.

use flexsc_core::numerics::attitude::Vector;
use flexsc_core::record::foxglove::{Point3, Pose, Quaternion, Vector3};
use nalgebra::Quaternion as Rotation;

fn single(value: f64) -> f64 {
    f64::from(value as f32)
}

/// Returns a vector as a message, in single precision.
pub fn place(of: Vector) -> Vector3 {
    Vector3 { x: single(of.x), y: single(of.y), z: single(of.z) }
}

/// Returns a point as a message, in single precision.
pub fn point(of: Vector) -> Point3 {
    Point3 { x: single(of.x), y: single(of.y), z: single(of.z) }
}

/// Returns a rotation as a message, in single precision.
pub fn attitude(of: &Rotation<f64>) -> Quaternion {
    Quaternion { x: single(of.i), y: single(of.j), z: single(of.k), w: single(of.w) }
}

/// Returns the rotation by a rotation vector (rad).
pub fn about(vector: Vector) -> Rotation<f64> {
    let angle = f64::sqrt(vector.norm_squared());
    if angle == 0.0 {
        return Rotation::new(1.0, 0.0, 0.0, 0.0);
    }
    let (sin, cos) = libm::sincos(0.5 * angle);
    Rotation::from_parts(cos, vector * (sin / angle))
}

/// Returns the rotation about z by an angle (rad).
pub fn about_z(angle: f64) -> Rotation<f64> {
    about(Vector::z() * angle)
}

/// Returns a rotation about the same axis, with its angle multiplied by a factor.
pub fn magnified(of: &Rotation<f64>, factor: f64) -> Rotation<f64> {
    let vector = of.vector() * libm::copysign(1.0, of.w);
    let sine = f64::sqrt(vector.norm_squared());
    if sine == 0.0 || factor == 1.0 {
        return *of;
    }
    about(vector * (factor * 2.0 * libm::atan2(sine, of.w.abs()) / sine))
}

/// Returns the shortest rotation that maps z to a direction of length 1.
pub fn from_z(direction: Vector) -> Rotation<f64> {
    let axis = Vector::z().cross(&direction);
    let sine = f64::sqrt(axis.norm_squared());
    if sine < 1e-9 {
        return about(if direction.z > 0.0 { Vector::zeros() } else { Vector::x() * std::f64::consts::PI });
    }
    about(axis * (libm::atan2(sine, direction.z) / sine))
}

/// Creates a pose from a place and a rotation.
pub fn pose(at: Vector, turned: &Rotation<f64>) -> Pose {
    Pose { position: place(at), orientation: attitude(turned) }
}

/// Creates a pose without a rotation.
pub fn unrotated(at: Vector) -> Pose {
    pose(at, &about(Vector::zeros()))
}

/// Returns the vector, shortened to a limit if it is longer.
pub fn limited(vector: Vector, limit: f64) -> Vector {
    let length = f64::sqrt(vector.norm_squared());
    if length > limit { vector * (limit / length) } else { vector }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turned(by: &Rotation<f64>, vector: Vector) -> Vector {
        (by * Rotation::from_imag(vector) * by.conjugate()).vector().into()
    }

    #[test]
    fn rotations_turn_what_they_say() {
        let y = turned(&about_z(std::f64::consts::FRAC_PI_2), Vector::x());
        assert!((y - Vector::y()).norm() < 1e-15);
        for direction in [
            Vector::new(0.6, 0.0, 0.8),
            Vector::new(-0.48, 0.6, -0.64),
            Vector::x(),
            Vector::z(),
            -Vector::z(),
        ] {
            assert!((turned(&from_z(direction), Vector::z()) - direction).norm() < 1e-15, "{direction}");
        }
        let small = about(Vector::new(0.01, -0.02, 0.03));
        // The quaternion of a rotation has either sign.
        for q in [small, -small] {
            let large = magnified(&q, 7.0);
            assert!((large - about(Vector::new(0.07, -0.14, 0.21))).norm() < 1e-15, "{large}");
        }
        assert_eq!(limited(Vector::new(3.0, 4.0, 0.0), 2.5), Vector::new(1.5, 2.0, 0.0));
    }
}
