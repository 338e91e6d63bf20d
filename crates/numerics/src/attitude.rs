//! Vectors and attitudes: unit quaternions, and the small angles between two of them (\[Hughes86\]).

use std::borrow::Cow;

use flexsc_flight::quaternion as flight;
use nalgebra::{Matrix3, Quaternion};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::flight_types::{from_quaternion, from_vector3, to_quaternion, to_vector3};
use crate::quantity::Finite;

/// Vector of three components along the body's axes x, y and z, about which it rolls, pitches and yaws.
pub type Vector = nalgebra::Vector3<f64>;

/// Names of the rotations about the three axes, as in keys.
pub const AXES: [&str; 3] = ["roll", "pitch", "yaw"];

/// Attitude in a scenario: a unit quaternion \[w, x, y, z\].
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Attitude(Quaternion<f64>);

impl Attitude {
    /// Returns the attitude of a quaternion of about length 1.
    pub fn new(quaternion: Quaternion<f64>) -> Self {
        Self(quaternion / quaternion.norm())
    }

    /// Returns the quaternion, of length 1.
    pub const fn get(self) -> Quaternion<f64> {
        self.0
    }

    /// Returns true if the attitude is the identity.
    pub fn is_identity(&self) -> bool {
        *self == Self::default()
    }
}

impl Default for Attitude {
    /// Returns the identity: the body's axes are the inertial ones.
    fn default() -> Self {
        Self(Quaternion::new(1.0, 0.0, 0.0, 0.0))
    }
}

impl Serialize for Attitude {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        [self.0.w, self.0.i, self.0.j, self.0.k].serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Attitude {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let [w, x, y, z] = <[f64; 4]>::deserialize(deserializer)?;
        let quaternion = Quaternion::new(w, x, y, z);
        let length = quaternion.norm();
        // Rounded decimals are accepted; larger deviations are not an attitude.
        if (length - 1.0).abs() <= 1e-6 {
            // A quaternion that was written by this program remains unchanged.
            let near = (length - 1.0).abs() <= 4.0 * f64::EPSILON;
            Ok(Self(if near { quaternion } else { quaternion / length }))
        } else {
            Err(serde::de::Error::custom(format!(
                "must be a unit quaternion [w, x, y, z], got one of length {length}"
            )))
        }
    }
}

impl JsonSchema for Attitude {
    fn schema_name() -> Cow<'static, str> {
        "Attitude".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        <[f64; 4]>::json_schema(generator)
    }
}

/// Returns the attitude after rotations by yaw, then pitch, then roll about the rotated axes (rad; sequence 3-2-1).
pub fn from_yaw_pitch_roll(roll: f64, pitch: f64, yaw: f64) -> Quaternion<f64> {
    let rotation = |axis: usize, angle: f64| {
        let (sin, cos) = libm::sincos(0.5 * angle);
        let mut vector = Vector::zeros();
        vector[axis] = sin;
        Quaternion::from_parts(cos, vector)
    };
    rotation(2, yaw) * rotation(1, pitch) * rotation(0, roll)
}

/// Returns the attitude of a body with the axes x, y and z, right-handed unit vectors in inertial axes.
pub fn from_axes([x, y, z]: &[Vector; 3]) -> Quaternion<f64> {
    // Four times the square of each component; the largest one is the divisor.
    let squares =
        [1.0 + x.x + y.y + z.z, 1.0 + x.x - y.y - z.z, 1.0 - x.x + y.y - z.z, 1.0 - x.x - y.y + z.z];
    let largest = (1..4).fold(0, |best, part| if squares[part] > squares[best] { part } else { best });
    let twice = f64::sqrt(squares[largest]);
    let (a, b, c) = ((y.z - z.y) / twice, (z.x - x.z) / twice, (x.y - y.x) / twice);
    let (d, e, f) = ((x.y + y.x) / twice, (x.z + z.x) / twice, (y.z + z.y) / twice);
    let parts = match largest {
        0 => Quaternion::new(twice, a, b, c),
        1 => Quaternion::new(a, twice, d, e),
        2 => Quaternion::new(b, d, twice, f),
        _ => Quaternion::new(c, e, f, twice),
    };
    parts / parts.norm()
}

/// Returns roll, pitch and yaw of an attitude (rad; sequence 3-2-1).
pub fn angles(q: &Quaternion<f64>) -> [f64; 3] {
    let (w, x, y, z) = (q.w, q.i, q.j, q.k);
    let sine = (2.0 * (w * y - z * x)).clamp(-1.0, 1.0);
    [
        libm::atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)),
        libm::asin(sine),
        libm::atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)),
    ]
}

/// Returns the rotation by a rotation vector (rad).
pub fn rotation(by: &Vector) -> Quaternion<f64> {
    from_quaternion(&flight::Quaternion::rotation(&to_vector3(by)))
}

/// Returns the rotation vector from one attitude to another, in the body's axes and on the shorter way: its length is the angle
/// (rad), from 0 to pi, and [`rotation`] by it makes the one of the other.
#[inline]
pub fn rotation_vector(from: &Quaternion<f64>, to: &Quaternion<f64>) -> Vector {
    from_vector3(&to_quaternion(from).rotation_to(&to_quaternion(to)))
}

/// Converts a scenario's numbers to a vector.
pub fn vector(components: &[Finite; 3]) -> Vector {
    Vector::new(components[0].get(), components[1].get(), components[2].get())
}

/// Converts a scenario's rows to a tensor.
pub fn tensor(rows: &[[Finite; 3]; 3]) -> Matrix3<f64> {
    Matrix3::from_fn(|row, column| rows[row][column].get())
}

/// No principal moment of inertia is more than the sum of the others, but for rounding to this part.
const ROUNDED_MOMENTS: f64 = 1e-3;

/// Why no body has these moments of inertia, if none has: the largest principal moment exceeds the sum of the others.
pub fn impossible_moments(tensor: &Matrix3<f64>) -> Option<String> {
    let mut moments: [f64; 3] = tensor.symmetric_eigenvalues().into();
    moments.sort_by(f64::total_cmp);
    let [least, middle, most] = moments;
    (most > (least + middle) * (1.0 + ROUNDED_MOMENTS)).then(|| {
        format!(
            "must be that of a body: no principal moment exceeds the sum of the other two, but {most:.4} kg m\u{b2} is more \
             than {least:.4} + {middle:.4}"
        )
    })
}

/// Returns an error message if a tensor is not symmetric.
pub fn asymmetry(tensor: &Matrix3<f64>) -> Option<String> {
    let mut below = (0..3).flat_map(|row| (0..row).map(move |column| (row, column)));
    let (row, column) = below.find(|element| tensor[*element] != tensor[(element.1, element.0)])?;
    let (found, other) = (tensor[(row, column)], tensor[(column, row)]);
    Some(format!("must be symmetric, got {found} and {other} across the diagonal"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_make_the_attitude_that_has_them() {
        for by in [[0.1, -0.2, 0.3], [3.0, 0.1, 0.2], [0.2, -3.1, 0.1], [0.1, 0.3, 3.0], [0.0; 3]] {
            let q = rotation(&Vector::from(by));
            let turn = |axis: Vector| -> Vector {
                (q * Quaternion::from_imag(axis) * q.conjugate()).vector().into_owned()
            };
            let found = from_axes(&[turn(Vector::x()), turn(Vector::y()), turn(Vector::z())]);
            assert!(rotation_vector(&q, &found).norm() < 1e-14, "{by:?}");
        }
    }

    #[test]
    fn angles_come_back_and_errors_are_small_rotations() {
        let attitude = from_yaw_pitch_roll(0.3, -0.7, 2.1);
        for (found, exact) in angles(&attitude).into_iter().zip([0.3, -0.7, 2.1]) {
            assert!((found - exact).abs() < 1e-15, "{found} {exact}");
        }
        // Rotates further by a small angle about the body's y axis, with both signs of the quaternion.
        let further = attitude * from_yaw_pitch_roll(0.0, 1e-3, 0.0);
        for q in [further, -further] {
            let error = rotation_vector(&attitude, &q);
            assert!((error - Vector::new(0.0, 1e-3, 0.0)).norm() < 1e-15, "{error}");
        }
        // However long it is: 150 degrees, and nearly half a turn.
        let long = [[0.0, 0.0, 2.617_993_877_991_494], [0.0, -3.1, 0.0], [1.8, 0.0, -2.4]];
        for by in long.into_iter().chain([[1e-9, 0.0, -2e-9], [0.3, -0.1, 0.2], [0.0; 3]]).map(Vector::from) {
            for q in [attitude * rotation(&by), -(attitude * rotation(&by))] {
                assert!((rotation_vector(&attitude, &q) - by).norm() < 1e-15 * by.norm().max(1.0), "{by}");
            }
        }
        // The square of the shortest is 0.
        let least =
            rotation_vector(&Quaternion::new(1.0, 0.0, 0.0, 0.0), &Quaternion::new(1.0, 2e-300, 0.0, 0.0));
        assert_eq!(least, Vector::new(4e-300, 0.0, 0.0));
        // Yaw first: a quarter turn rotates the body's x to the inertial y.
        let quarter = from_yaw_pitch_roll(0.0, 0.0, std::f64::consts::FRAC_PI_2);
        let x = quarter * Quaternion::from_imag(Vector::x()) * quarter.conjugate();
        assert!((x.vector() - Vector::y()).norm() < 1e-15);
    }
}
