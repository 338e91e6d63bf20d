//! Test of the attitude filter against a 40-digit reference.

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time::{Instant, Span};
use nalgebra::{Matrix3, Quaternion};

use super::filter::{AttitudeFilterState, Correction};
use super::history::{DelayedMeasurement, FilterHistory};
use super::measurement::{AttitudeMeasurement, GyroNoise};
use crate::sensor::VectorMeasurement;

/// Gyro readings, measured attitudes and truth of a made-up run; a filter in forty digits with the covariance of Van Loan,
/// which lives at exposures (k of `tests/golden/attitude-filter-in.csv`, 0.25 s apart): `tests/golden/attitude_filter_oracle.py`.
const READ: &str = include_str!("../../../../../tests/golden/attitude-filter-in.csv");
/// Results of the reference filter.
const GIVEN: &str = include_str!("../../../../../tests/golden/attitude-filter-out.csv");

const NOISE: GyroNoise = GyroNoise { angle_random_walk: 3e-6, rate_random_walk: 1e-8 };

fn rows(text: &str) -> Vec<Vec<f64>> {
    let row = |line: &str| line.split(',').map(|cell| cell.parse().unwrap()).collect();
    text.lines().skip_while(|line| !line.starts_with("k,")).skip(1).map(row).collect()
}

fn quaternion(components: &[f64]) -> Quaternion<f64> {
    Quaternion::new(components[0], components[1], components[2], components[3])
}

fn first() -> AttitudeFilterState {
    let attitude = Quaternion::new(
        0.799_372_729_975_218_5,
        0.360_841_357_110_226_4,
        -0.480_412_696_190_943,
        0.000_628_418_145_252_526_5,
    );
    AttitudeFilterState::new(attitude, Vector::zeros(), [1e-3, 1e-5])
}

/// Returns the covariance of a star tracker with boresight z, rotated to body axes.
fn tracker() -> Matrix3<f64> {
    let axes = Matrix3::new(0.6, 0.0, 0.8, 0.0, 1.0, 0.0, -0.8, 0.0, 0.6);
    let (across, about_axis) = (2.4e-5 * 2.4e-5, 1.5e-4 * 1.5e-4);
    axes * Matrix3::from_diagonal(&Vector::new(across, across, about_axis)) * axes.transpose()
}

fn at(k: usize) -> Instant {
    Instant::START + Span::from_seconds(0.25 * k as f64)
}

fn fix(read: &[Vec<f64>], k: usize) -> DelayedMeasurement {
    DelayedMeasurement {
        exposed: at(k),
        measured: AttitudeMeasurement::Attitude(quaternion(&read[k][5..9])),
        noise: tracker(),
        gain: None,
        sensor: 0,
    }
}

/// Returns the filter's history after each reading and the corrections, with attitudes that arrive `late` readings
/// after exposure.
fn replay(late: usize) -> (Vec<FilterHistory>, Vec<Correction>) {
    let read = rows(READ);
    let mut history = FilterHistory::new(at(0), first(), NOISE, Span::from_seconds(0.5));
    let (mut states, mut corrections) = (vec![history.clone()], Vec::new());
    for k in 1..read.len() {
        history.add_gyro(at(k), Vector::from_column_slice(&read[k][2..5]));
        if k > late && (k - late).is_multiple_of(4) {
            corrections.push(history.add_measurement(fix(&read, k - late)).unwrap());
        }
        states.push(history.clone());
    }
    (states, corrections)
}

#[test]
fn late_attitudes_give_what_forty_digits_give() {
    let (states, corrections) = replay(2);
    let read = rows(READ);
    for row in rows(GIVEN) {
        let k = row[0] as usize;
        let filter = states[k].latest();
        let q = quaternion(&row[2..6]);
        // The reference table has 14 digits.
        assert!((filter.attitude - q).norm() < 1e-14, "{k} {:e}", (filter.attitude - q).norm());
        for axis in 0..3 {
            let [angle, rate] = filter.deviations();
            assert!((filter.bias[axis] - row[6 + axis]).abs() < 1e-16, "{k} {}", filter.bias);
            assert!((angle[axis] / row[9 + axis] - 1.0).abs() < 5e-14, "{k} {angle:?}");
            assert!((rate[axis] / row[12 + axis] - 1.0).abs() < 5e-14, "{k} {rate:?}");
        }
        let nees = filter.nees(&quaternion(&read[k][9..13]), &Vector::from_column_slice(&read[k][13..16]));
        assert!((nees / row[15] - 1.0).abs() < 1e-10, "{k} {nees}");
    }
    for (correction, nis) in
        corrections.iter().zip([5.333_107_676_038_169, 4.912_012_928_946_308, 7.379_210_099_538_096])
    {
        assert!((correction.nis / nis - 1.0).abs() < 1e-10, "{}", correction.nis);
    }
}

#[test]
fn whatever_is_late_comes_to_the_same() {
    let [soon, later] = [0, 2].map(|late| replay(late).0);
    // Compares instants at which both have received the same attitudes; then an exposure between readings, out of
    // order.
    for k in (7..soon.len()).step_by(4) {
        let (a, b) = (soon[k].latest(), later[k].latest());
        assert!((a.attitude - b.attitude).norm() < 1e-14 && (a.bias - b.bias).norm() < 1e-18, "{k}");
    }
    let read = rows(READ);
    let build = |order: [usize; 2]| {
        let mut history = FilterHistory::new(at(0), first(), NOISE, Span::from_seconds(1.0));
        for row in &read[1..6] {
            history.add_gyro(at(row[0] as usize), Vector::from_column_slice(&row[2..5]));
        }
        let between = DelayedMeasurement { exposed: at(2) + Span::from_seconds(0.1), ..fix(&read, 4) };
        let fixes = [between, fix(&read, 4)];
        for index in order {
            assert!(history.add_measurement(fixes[index]).is_some());
        }
        history
    };
    let [a, b] = [[0, 1], [1, 0]].map(build);
    assert!((a.latest().attitude - b.latest().attitude).norm() < 1e-15);
    assert!((a.latest().covariance - b.latest().covariance).norm() < 1e-18);
}

#[test]
fn a_measurement_waits_for_its_reading_and_not_for_ever() {
    let read = rows(READ);
    let reading = |k: usize| Vector::from_column_slice(&read[k][2..5]);
    let mut history = FilterHistory::new(at(0), first(), NOISE, Span::from_seconds(0.5));
    assert!(history.add_measurement(fix(&read, 4)).is_none());
    for k in 1..12 {
        assert_eq!(history.add_gyro(at(k), reading(k)).len(), usize::from(k == 4));
    }
    assert!(history.add_measurement(fix(&read, 8)).is_none(), "0.75 s late");
}

/// Checks that a vector measured with small noise corrects like an attitude whose noise about the vector is infinite.
#[test]
fn a_vector_corrects_across_itself_alone() {
    let truth = flexsc_numerics::attitude::rotation(&Vector::new(0.3, -0.7, 1.1));
    let off = Vector::new(2e-6, -3e-6, 1e-6);
    let begins = AttitudeFilterState::new(
        truth * flexsc_numerics::attitude::rotation(&off),
        Vector::zeros(),
        [1e-3, 1e-5],
    );
    let inertial = Vector::new(2.0, -1.0, 0.5) * 1e-5;
    let body = flexsc_spacecraft::environment::to_body(&truth, &inertial);
    let (deviation, along) = (1e-8, body.normalize());
    for is_direction in [false, true] {
        let scale = if is_direction { body.norm() } else { 1.0 };
        let vector_measurement =
            VectorMeasurement { vector: body / scale, inertial: inertial / scale, is_direction };
        let noise = Matrix3::from_diagonal_element(deviation * deviation / (scale * scale));
        let mut filter = begins.clone();
        let correction = filter.correct_vector(&vector_measurement, &noise).unwrap();
        // Remaining attitude error perpendicular to the vector, and its variance; along the vector there is no
        // information.
        let [remaining, _] = filter.error(&truth, &Vector::zeros());
        let variance = deviation * deviation / body.norm_squared();
        let part = variance / (variance + 1e-6);
        let exact = -(along * along.dot(&off) + (off - along * along.dot(&off)) * part);
        assert!((remaining - exact).norm() < 1e-10, "{remaining} {exact}");
        let across = along.cross(&Vector::x()).normalize();
        let variance_along = |axis: &Vector| {
            let covariance = filter.covariance.fixed_view::<3, 3>(0, 0).into_owned();
            axis.dot(&(covariance * axis))
        };
        assert!(
            (variance_along(&along) / 1e-6 - 1.0).abs() < 1e-9
                && (variance_along(&across) / (1e-6 * part) - 1.0).abs() < 1e-9
        );
        assert!((correction.innovation + (off - along * along.dot(&off))).norm() < 1e-10);
        let nis = (off - along * along.dot(&off)).norm_squared() / (variance + 1e-6);
        assert!((correction.nis / (if is_direction { 1.5 * nis } else { nis }) - 1.0).abs() < 1e-4);
    }
}
