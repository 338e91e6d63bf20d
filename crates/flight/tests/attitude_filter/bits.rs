//! Steps of the attitude filter and its matrices against the matrix library, by bits over random inputs.

use flexsc_flight::attitude_filter::{AttitudeBiasFilter, GyroNoise};
use flexsc_flight::attitude_observation::{AttitudeObservation, Correction, ObservationKind};
use flexsc_flight::matrix3::Matrix3 as FlightMatrix3;
use flexsc_flight::matrix6::{Matrix6 as FlightMatrix6, Matrix6x3 as FlightMatrix6x3};
use flexsc_flight::quaternion::Quaternion as FlightQuaternion;
use flexsc_flight::vector3::Vector3 as FlightVector3;
use nalgebra::{Cholesky, Matrix3, Matrix6x3, Quaternion, SMatrix, Vector3};

use crate::matrix_filter::{
    Corrected, MatrixFilter, Measured, VectorMeasurement, rotation, rotation_vector, to_body,
};

/// Random numbers by a linear congruence.
struct Draws(u64);

impl Draws {
    /// Returns a number from -1 to 1.
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.next())
    }

    fn quaternion(&mut self) -> Quaternion<f64> {
        let q = Quaternion::new(self.next(), self.next(), self.next(), self.next());
        q / q.norm()
    }

    /// Returns a positive definite matrix of about this size.
    fn definite<const D: usize>(&mut self, size: f64) -> SMatrix<f64, D, D> {
        let root = SMatrix::<f64, D, D>::from_fn(|_, _| self.next());
        let square = (root * root.transpose() + SMatrix::identity() * 0.1) * size;
        (square + square.transpose()) * 0.5
    }
}

fn to_vector(v: &Vector3<f64>) -> FlightVector3 {
    FlightVector3 { x: v.x, y: v.y, z: v.z }
}

fn to_quaternion(q: &Quaternion<f64>) -> FlightQuaternion {
    FlightQuaternion { w: q.w, x: q.i, y: q.j, z: q.k }
}

fn to_matrix(m: &Matrix3<f64>) -> FlightMatrix3 {
    FlightMatrix3 { rows: [0, 1, 2].map(|row| [0, 1, 2].map(|column| m[(row, column)])) }
}

fn to_filter(filter: &MatrixFilter) -> AttitudeBiasFilter {
    let p = &filter.covariance;
    let rows = std::array::from_fn(|row| std::array::from_fn(|column| p[(row, column)]));
    AttitudeBiasFilter {
        attitude: to_quaternion(&filter.attitude),
        bias: to_vector(&filter.bias),
        covariance: FlightMatrix6 { rows },
    }
}

fn vector_bits(v: &FlightVector3) -> [u64; 3] {
    [v.x, v.y, v.z].map(f64::to_bits)
}

fn quaternion_bits(q: &FlightQuaternion) -> [u64; 4] {
    [q.w, q.x, q.y, q.z].map(f64::to_bits)
}

/// Checks that a filter has the bits of the matrix library's.
fn check(found: &AttitudeBiasFilter, exact: &MatrixFilter, step: usize) {
    let exact = to_filter(exact);
    assert_eq!(quaternion_bits(&found.attitude), quaternion_bits(&exact.attitude), "{step}");
    assert_eq!(vector_bits(&found.bias), vector_bits(&exact.bias), "{step}");
    let bits = |filter: &AttitudeBiasFilter| filter.covariance.rows.map(|row| row.map(f64::to_bits));
    assert_eq!(bits(found), bits(&exact), "{step}");
}

fn check_correction(found: &Correction, exact: &Corrected, step: usize) {
    assert!(found.status.has_corrected());
    assert_eq!(vector_bits(&found.innovation), vector_bits(&to_vector(&exact.innovation)), "{step}");
    assert_eq!((found.nis.to_bits(), found.components), (exact.nis.to_bits(), exact.components), "{step}");
}

/// Returns a measurement of each kind by turns, near the attitude.
fn measurement(draws: &mut Draws, attitude: &Quaternion<f64>, step: usize) -> Measured {
    let truth = attitude * rotation(&(draws.vector() * 1e-3));
    if step.is_multiple_of(3) {
        return Measured::Attitude(truth);
    }
    let is_direction = step % 3 == 1;
    let inertial = draws.vector();
    let inertial = if is_direction { inertial.normalize() } else { inertial };
    let vector = to_body(&truth, &inertial) + draws.vector() * 1e-4;
    let vector = if is_direction { vector.normalize() } else { vector };
    Measured::Vector(VectorMeasurement { vector, inertial, is_direction })
}

fn observation(measured: &Measured, noise: &Matrix3<f64>) -> AttitudeObservation {
    let none = AttitudeObservation { noise: to_matrix(noise), ..AttitudeObservation::NONE };
    match measured {
        Measured::Attitude(attitude) => AttitudeObservation { attitude: to_quaternion(attitude), ..none },
        Measured::Vector(VectorMeasurement { vector, inertial, is_direction }) => AttitudeObservation {
            kind: if *is_direction { ObservationKind::Direction } else { ObservationKind::Vector },
            vector: to_vector(vector),
            inertial: to_vector(inertial),
            ..none
        },
    }
}

/// Checks filters with the gain of the covariance, or constant gains.
fn run(seed: u64, constant: bool) {
    let mut draws = Draws(seed);
    let mut exact = MatrixFilter {
        attitude: draws.quaternion(),
        bias: draws.vector() * 1e-5,
        covariance: draws.definite::<6>(1e-4),
    };
    let mut filter = to_filter(&exact);
    for step in 0..600 {
        // Slow and fast rotations, and none.
        let size = [0.0, 1e-6, 0.02, 1.0, 8.0][step % 5];
        let (reading, seconds) = (draws.vector() * size, 0.5 + 0.5 * draws.next());
        let noise = GyroNoise { angle_random_walk: 1e-4, rate_random_walk: 1e-5 };
        exact.predict(&reading, seconds, [1e-4 * 1e-4, 1e-5 * 1e-5]);
        filter.predict(&to_vector(&reading), seconds, &noise);
        check(&filter, &exact, step);
        let measured = measurement(&mut draws, &exact.attitude, step);
        let noise = draws.definite::<3>(1e-6);
        let mut observation = observation(&measured, &noise);
        let corrected = if constant {
            let gain = Matrix6x3::from_fn(|row, column| {
                (if row == column { 0.1 } else { 0.0 }) + draws.next() * if row < 3 { 1e-3 } else { 1e-4 }
            });
            observation.has_gain = true;
            observation.gain =
                FlightMatrix6x3 { rows: std::array::from_fn(|row| [0, 1, 2].map(|axis| gain[(row, axis)])) };
            exact.correct_with_gain(&measured, &noise, &gain)
        } else {
            match &measured {
                Measured::Attitude(attitude) => exact.correct(attitude, &noise),
                Measured::Vector(measurement) => exact.correct_vector(measurement, &noise),
            }
        };
        check_correction(&filter.observe(&observation, f64::INFINITY), &corrected.expect("definite"), step);
        check(&filter, &exact, step);
        let after = exact.attitude * rotation(&((reading - exact.bias) * seconds));
        let found = filter.attitude_after(&to_vector(&reading), seconds);
        assert_eq!(quaternion_bits(&found), quaternion_bits(&to_quaternion(&after)));
    }
}

#[test]
fn a_filter_has_the_bits_of_the_matrix_library() {
    for seed in 1..8 {
        run(seed, false);
        run(seed, true);
    }
}

#[test]
fn a_correction_without_a_definite_covariance_changes_nothing() {
    let mut filter = AttitudeBiasFilter::new(FlightQuaternion::IDENTITY, FlightVector3::ZERO, 1e-3, 1e-5);
    let before = filter;
    let noise = Matrix3::from_diagonal_element(-1.0);
    let measured = [
        Measured::Attitude(Quaternion::new(1.0, 0.0, 0.0, 0.0)),
        Measured::Vector(VectorMeasurement {
            vector: Vector3::x(),
            inertial: Vector3::x(),
            is_direction: false,
        }),
        Measured::Vector(VectorMeasurement {
            vector: Vector3::x(),
            inertial: Vector3::x(),
            is_direction: true,
        }),
    ];
    for measured in measured {
        for has_gain in [false, true] {
            let observation = AttitudeObservation { has_gain, ..observation(&measured, &noise) };
            assert_eq!(filter.observe(&observation, f64::INFINITY), Correction::NONE);
            assert_eq!(filter, before);
        }
    }
}

#[test]
fn rotations_have_the_bits_of_the_matrix_library() {
    let mut draws = Draws(3);
    for step in 0..5000 {
        let by = draws.vector() * [0.0, 1e-9, 1e-3, 1.0, 4.0][step % 5];
        let exact = rotation(&by);
        assert_eq!(
            quaternion_bits(&FlightQuaternion::rotation(&to_vector(&by))),
            quaternion_bits(&to_quaternion(&exact))
        );
        let (from, to) = (draws.quaternion(), draws.quaternion() * draws.next());
        let near = from * exact;
        for to in [to, near, -near, from] {
            let found = to_quaternion(&from).rotation_to(&to_quaternion(&to));
            assert_eq!(vector_bits(&found), vector_bits(&to_vector(&rotation_vector(&from, &to))));
        }
        let v = draws.vector();
        for q in [from, to] {
            let found = to_quaternion(&q).to_body(&to_vector(&v));
            assert_eq!(vector_bits(&found), vector_bits(&to_vector(&to_body(&q, &v))));
        }
    }
}

fn check_inverse<const D: usize>(draws: &mut Draws)
where
    nalgebra::Const<D>: nalgebra::ToTypenum + nalgebra::DimSub<nalgebra::Const<1>>,
{
    let definite = draws.definite::<D>(1.0);
    let exact = Cholesky::new(definite).expect("definite").inverse();
    let mut found = FlightMatrix3::ZERO;
    for row in 0..D {
        for column in 0..D {
            found.rows[row][column] = definite[(row, column)];
        }
    }
    assert!(found.invert_definite(D));
    for row in 0..D {
        for column in 0..D {
            assert_eq!(found.rows[row][column].to_bits(), exact[(row, column)].to_bits(), "{D}");
        }
    }
}

#[test]
fn matrices_have_the_bits_of_the_matrix_library() {
    let mut draws = Draws(5);
    for _ in 0..2000 {
        check_inverse::<1>(&mut draws);
        check_inverse::<2>(&mut draws);
        check_inverse::<3>(&mut draws);
        let (a, b) = (draws.definite::<3>(1.0), Matrix3::from_fn(|_, _| draws.next()));
        let v = draws.vector();
        let bits = |matrix: &FlightMatrix3| matrix.rows.map(|row| row.map(f64::to_bits));
        assert_eq!(bits(&to_matrix(&a).times_matrix(&to_matrix(&b))), bits(&to_matrix(&(a * b))));
        assert_eq!(
            bits(&to_matrix(&a).times_transposed(&to_matrix(&b))),
            bits(&to_matrix(&(a * b.transpose())))
        );
        assert_eq!(bits(&to_matrix(&a).divided(-1.7)), bits(&to_matrix(&(a / -1.7))));
        assert_eq!(vector_bits(&to_matrix(&b).times(&to_vector(&v))), vector_bits(&to_vector(&(b * v))));
        let mut factor = to_matrix(&a);
        assert!(factor.factorise(3));
        let exact = Cholesky::new(a).expect("definite").solve(&v);
        assert_eq!(vector_bits(&factor.solve(&to_vector(&v))), vector_bits(&to_vector(&exact)));
    }
}
