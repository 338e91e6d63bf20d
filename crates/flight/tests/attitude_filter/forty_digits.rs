//! Attitude filter with delayed measurements against a 40-digit reference.

use flexsc_flight::attitude_filter::{AttitudeBiasFilter, GyroNoise};
use flexsc_flight::attitude_gate::AttitudeGate;
use flexsc_flight::attitude_history::{AttitudeHistory, AttitudeHistoryEntry};
use flexsc_flight::attitude_observation::{AttitudeObservation, Correction};
use flexsc_flight::delayed_observation::DelayedObservation;
use flexsc_flight::matrix3::Matrix3;
use flexsc_flight::quaternion::Quaternion;
use flexsc_flight::ticks::Ticks;
use flexsc_flight::vector3::Vector3;
use nalgebra::{Cholesky, Matrix6, Vector6};

/// Gyro readings, measured attitudes and truth of a made-up run; a filter in forty digits with the covariance of Van Loan,
/// which lives at exposures (k of `tests/golden/attitude-filter-in.csv`, 0.25 s apart): `tests/golden/attitude_filter_oracle.py`.
const READ: &str = include_str!("../../../../tests/golden/attitude-filter-in.csv");
/// Results of the reference filter.
const GIVEN: &str = include_str!("../../../../tests/golden/attitude-filter-out.csv");

/// Limits that only readings which are not finite exceed.
pub const GATE: AttitudeGate = AttitudeGate {
    most_nis: f64::INFINITY,
    most_refusals: 2,
    gap: Ticks { whole: 60, part: 0 },
    most_rate: 1.0,
};
pub const NOISE: GyroNoise = GyroNoise { angle_random_walk: 3e-6, rate_random_walk: 1e-8 };

fn rows(text: &str) -> Vec<Vec<f64>> {
    let row = |line: &str| line.split(',').map(|cell| cell.parse().expect("a number")).collect();
    text.lines().skip_while(|line| !line.starts_with("k,")).skip(1).map(row).collect()
}

pub fn readings() -> Vec<Vec<f64>> {
    rows(READ)
}

fn quaternion(components: &[f64]) -> Quaternion {
    Quaternion { w: components[0], x: components[1], y: components[2], z: components[3] }
}

pub fn vector(components: &[f64]) -> Vector3 {
    Vector3::new(components[0], components[1], components[2])
}

pub fn first() -> AttitudeBiasFilter {
    let attitude = quaternion(&[
        0.799_372_729_975_218_5,
        0.360_841_357_110_226_4,
        -0.480_412_696_190_943,
        0.000_628_418_145_252_526_5,
    ]);
    AttitudeBiasFilter::new(attitude, Vector3::ZERO, 1e-3, 1e-5)
}

/// Returns the covariance of a star tracker with boresight z, rotated to body axes.
fn tracker() -> Matrix3 {
    let axes = Matrix3 { rows: [[0.6, 0.0, 0.8], [0.0, 1.0, 0.0], [-0.8, 0.0, 0.6]] };
    let (across, about_axis) = (2.4e-5 * 2.4e-5, 1.5e-4 * 1.5e-4);
    let diagonal = Matrix3 { rows: [[across, 0.0, 0.0], [0.0, across, 0.0], [0.0, 0.0, about_axis]] };
    axes.times_matrix(&diagonal).times_transposed(&axes)
}

pub fn at(k: usize) -> Ticks {
    Ticks::from_seconds(0.25 * k as f64)
}

pub fn fix(read: &[Vec<f64>], k: usize) -> DelayedObservation {
    let observation = AttitudeObservation {
        attitude: quaternion(&read[k][5..9]),
        noise: tracker(),
        ..AttitudeObservation::NONE
    };
    DelayedObservation { exposed: at(k), observation, ..DelayedObservation::NONE }
}

/// Returns the filter after each reading and the corrections, with attitudes that arrive `late` readings after exposure.
pub fn replay(late: usize, capacity: usize) -> (Vec<AttitudeBiasFilter>, Vec<Correction>) {
    let read = readings();
    let mut entries = vec![AttitudeHistoryEntry::NONE; capacity];
    let mut observations = vec![DelayedObservation::NONE; capacity];
    let mut history = AttitudeHistory::start(at(0), first(), NOISE, at(2), GATE, &mut entries);
    let (mut states, mut corrections) = (vec![first()], Vec::new());
    for k in 1..read.len() {
        history.add_gyro(at(k), vector(&read[k][2..5]), &mut entries, &mut observations);
        if k > late && (k - late).is_multiple_of(4) {
            let correction = history.add_observation(fix(&read, k - late), &mut entries, &mut observations);
            assert!(correction.status.has_corrected());
            corrections.push(correction);
        }
        states.push(entries[history.latest()].filter);
    }
    (states, corrections)
}

/// Returns the largest difference of components.
pub fn apart(a: &Quaternion, b: &Quaternion) -> f64 {
    [a.w - b.w, a.x - b.x, a.y - b.y, a.z - b.z].into_iter().fold(0.0, |most, off| off.abs().max(most))
}

#[test]
fn late_attitudes_give_what_forty_digits_give() {
    let (states, corrections) = replay(2, 8);
    let read = readings();
    for row in rows(GIVEN) {
        let k = row[0] as usize;
        let filter = &states[k];
        let q = quaternion(&row[2..6]);
        // The reference table has 14 digits.
        assert!(apart(&filter.attitude, &q) < 1e-14, "{k} {:e}", apart(&filter.attitude, &q));
        for axis in 0..3 {
            let [angle, rate] = [0, 3].map(|from| filter.covariance.rows[from + axis][from + axis].sqrt());
            assert!((filter.bias.component(axis) - row[6 + axis]).abs() < 1e-16, "{k} {:?}", filter.bias);
            assert!((angle / row[9 + axis] - 1.0).abs() < 5e-14, "{k} {angle:?}");
            assert!((rate / row[12 + axis] - 1.0).abs() < 5e-14, "{k} {rate:?}");
        }
        let angle = filter.attitude.rotation_to(&quaternion(&read[k][9..13]));
        let rate = vector(&read[k][13..16]).minus(&filter.bias);
        let error = Vector6::new(angle.x, angle.y, angle.z, rate.x, rate.y, rate.z);
        let covariance = Matrix6::from_fn(|row, column| filter.covariance.rows[row][column]);
        let nees = error.dot(&Cholesky::new(covariance).expect("definite").solve(&error));
        assert!((nees / row[15] - 1.0).abs() < 1e-10, "{k} {nees}");
    }
    for (correction, nis) in
        corrections.iter().zip([5.333_107_676_038_169, 4.912_012_928_946_308, 7.379_210_099_538_096])
    {
        assert!((correction.nis / nis - 1.0).abs() < 1e-10, "{}", correction.nis);
    }
}
