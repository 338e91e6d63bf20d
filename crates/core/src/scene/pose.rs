//! Poses: rotations and places as viewers take them, in single precision, which the eye cannot distinguish from double.

use nalgebra::Quaternion as Rotation;

use crate::attitude::Vector;
use crate::record::foxglove::{Point3, Pose, Quaternion, Vector3};

fn single(value: f64) -> f64 {
    f64::from(value as f32)
}

/// A vector as viewers take it.
pub fn place(of: Vector) -> Vector3 {
    Vector3 { x: single(of.x), y: single(of.y), z: single(of.z) }
}

/// A point as viewers take it.
pub fn point(of: Vector) -> Point3 {
    Point3 { x: single(of.x), y: single(of.y), z: single(of.z) }
}

/// A rotation as viewers take it.
pub fn attitude(of: &Rotation<f64>) -> Quaternion {
    Quaternion { x: single(of.i), y: single(of.j), z: single(of.k), w: single(of.w) }
}

/// The rotation by a vector (rad): about its direction, by its length.
pub fn about(vector: Vector) -> Rotation<f64> {
    let angle = f64::sqrt(vector.norm_squared());
    if angle == 0.0 {
        return Rotation::new(1.0, 0.0, 0.0, 0.0);
    }
    let (sin, cos) = libm::sincos(0.5 * angle);
    Rotation::from_parts(cos, vector * (sin / angle))
}

/// The rotation about z (rad).
pub fn about_z(angle: f64) -> Rotation<f64> {
    about(Vector::z() * angle)
}

/// A rotation as many times as large, about its own axis.
pub fn magnified(of: &Rotation<f64>, factor: f64) -> Rotation<f64> {
    let vector = of.vector() * libm::copysign(1.0, of.w);
    let sine = f64::sqrt(vector.norm_squared());
    if sine == 0.0 || factor == 1.0 {
        return *of;
    }
    about(vector * (factor * 2.0 * libm::atan2(sine, of.w.abs()) / sine))
}

/// The rotation that takes z to a direction of length 1, by the shortest way.
pub fn from_z(direction: Vector) -> Rotation<f64> {
    let axis = Vector::z().cross(&direction);
    let sine = f64::sqrt(axis.norm_squared());
    if sine < 1e-9 {
        return about(if direction.z > 0.0 { Vector::zeros() } else { Vector::x() * std::f64::consts::PI });
    }
    about(axis * (libm::atan2(sine, direction.z) / sine))
}

/// A pose.
pub fn pose(at: Vector, turned: &Rotation<f64>) -> Pose {
    Pose { position: place(at), orientation: attitude(turned) }
}

/// A pose that is not turned.
pub fn upright(at: Vector) -> Pose {
    pose(at, &about(Vector::zeros()))
}

/// A vector no longer than a limit, in the same direction.
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
        // Whichever of its two signs a rotation has.
        for q in [small, -small] {
            let large = magnified(&q, 7.0);
            assert!((large - about(Vector::new(0.07, -0.14, 0.21))).norm() < 1e-15, "{large}");
        }
        assert_eq!(limited(Vector::new(3.0, 4.0, 0.0), 2.5), Vector::new(1.5, 2.0, 0.0));
    }
}
