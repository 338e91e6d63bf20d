//! Tests of the attitude filter and its recent past, with the storage that the engine gives it.

use flexsc_flight::attitude_gate::AttitudeGate;
use flexsc_flight::reading_status::ReadingStatus;
use flexsc_flight::ticks::Ticks;
use flexsc_numerics::attitude::{Vector, rotation};
use flexsc_numerics::time::{Instant, Span};
use nalgebra::{Matrix3, Quaternion};

use super::{AttitudeFilterState, AttitudeMeasurement, DelayedMeasurement, FilterHistory, GyroNoise};

/// Gyro readings, measured attitudes and truth of a made-up run: `tests/golden/attitude_filter_oracle.py`.
const READ: &str = include_str!("../../../../../tests/golden/attitude-filter-in.csv");

const GATE: AttitudeGate =
    AttitudeGate { most_nis: 300.0, most_refusals: 5, gap: Ticks { whole: 60, part: 0 }, most_rate: 1.0 };
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

/// Returns the filter's history after each reading, with attitudes that arrive `late` readings after exposure.
fn replay(late: usize) -> Vec<FilterHistory> {
    let read = rows(READ);
    let mut history = FilterHistory::new(at(0), first(), None, NOISE, Span::from_seconds(0.5), GATE);
    let mut states = vec![history.clone()];
    for k in 1..read.len() {
        history.add_gyro(at(k), Vector::from_column_slice(&read[k][2..5]));
        if k > late && (k - late).is_multiple_of(4) {
            history.add_measurement(&fix(&read, k - late)).unwrap();
        }
        states.push(history.clone());
    }
    states
}

#[test]
fn whatever_is_late_comes_to_the_same() {
    let [soon, later] = [0, 2].map(replay);
    // Compares instants at which both have received the same attitudes; then an exposure between readings, out of
    // order.
    for k in (7..soon.len()).step_by(4) {
        let (a, b) = (soon[k].latest(), later[k].latest());
        assert!((a.attitude - b.attitude).norm() < 1e-14 && (a.bias - b.bias).norm() < 1e-18, "{k}");
    }
    let read = rows(READ);
    // The attitude between readings is that of another instant, which a gate would refuse.
    let open = AttitudeGate { most_nis: 1e12, ..GATE };
    let build = |order: [usize; 2]| {
        let mut history = FilterHistory::new(at(0), first(), None, NOISE, Span::from_seconds(1.0), open);
        for row in &read[1..6] {
            history.add_gyro(at(row[0] as usize), Vector::from_column_slice(&row[2..5]));
        }
        let between = DelayedMeasurement { exposed: at(2) + Span::from_seconds(0.1), ..fix(&read, 4) };
        let fixes = [between, fix(&read, 4)];
        for index in order {
            assert!(history.add_measurement(&fixes[index]).is_some());
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
    let mut history = FilterHistory::new(at(0), first(), None, NOISE, Span::from_seconds(0.5), GATE);
    assert!(history.add_measurement(&fix(&read, 4)).is_none());
    for k in 1..12 {
        assert_eq!(!history.add_gyro(at(k), reading(k)).is_empty(), k == 4);
    }
    // One that is refused when its reading comes is reported too, with its sensor.
    let mut wrong = DelayedMeasurement { sensor: 3, ..fix(&read, 12) };
    if let AttitudeMeasurement::Attitude(attitude) = &mut wrong.measured {
        *attitude *= rotation(&Vector::new(2.1, 0.0, 0.0));
    }
    assert!(history.add_measurement(&wrong).is_none());
    let results = history.add_gyro(at(12), reading(12));
    let results: Vec<_> = results.iter().map(|(sensor, result)| (*sensor, result.status)).collect();
    assert_eq!(results, [(3, ReadingStatus::Improbable)]);
    let late = history.add_measurement(&fix(&read, 8)).expect("a result");
    assert_eq!(late.status, ReadingStatus::Untimely, "0.75 s late");
}
