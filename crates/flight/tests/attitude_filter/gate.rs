//! Gate of the attitude filter: what it refuses leaves no trace, and what stays improbable is accepted.

use flexsc_flight::attitude_estimator::AttitudeEstimator;
use flexsc_flight::attitude_filter::AttitudeBiasFilter;
use flexsc_flight::attitude_gate::AttitudeGate;
use flexsc_flight::attitude_history::{AttitudeHistory, AttitudeHistoryEntry};
use flexsc_flight::attitude_observation::{AttitudeObservation, ObservationKind};
use flexsc_flight::delayed_observation::DelayedObservation;
use flexsc_flight::matrix3::Matrix3;
use flexsc_flight::quaternion::Quaternion;
use flexsc_flight::reading_status::ReadingStatus;
use flexsc_flight::ticks::Ticks;
use flexsc_flight::vector3::Vector3;

use crate::forty_digits::{self, NOISE, at, first, fix, readings, vector};

const RATE: f64 = 1e-3;
const GATE: AttitudeGate = AttitudeGate { most_nis: 300.0, ..forty_digits::GATE };

/// Body that turns about x at a constant rate, with a perfect gyro at 10 Hz and a perfect star tracker at 2 Hz, 0.2 s late. A
/// coarse Sun sensor may follow each attitude.
struct Flight {
    estimator: AttitudeEstimator,
    entries: [AttitudeHistoryEntry; 40],
    observations: [DelayedObservation; 8],
    /// Number of gyro readings.
    k: u32,
    /// Difference of the clock from the true time (s).
    clock: f64,
    has_sun: bool,
    statuses: Vec<ReadingStatus>,
}

fn attitude_at(seconds: f64) -> Quaternion {
    Quaternion::rotation(&Vector3::new(RATE * seconds, 0.0, 0.0))
}

impl Flight {
    fn start(at: f64) -> Self {
        let mut entries = [AttitudeHistoryEntry::NONE; 40];
        let filter = AttitudeBiasFilter::new(attitude_at(0.0), Vector3::ZERO, 1e-3, 1e-5);
        let (now, reach) = (Ticks::from_seconds(at), Ticks::from_seconds(0.5));
        let estimator = AttitudeEstimator::start(now, filter, NOISE, reach, GATE, &mut entries);
        Self {
            estimator,
            entries,
            observations: [DelayedObservation::NONE; 8],
            k: 0,
            clock: at,
            has_sun: false,
            statuses: Vec::new(),
        }
    }

    fn seconds(&self) -> f64 {
        f64::from(self.k) / 10.0
    }

    /// Returns the time on board.
    fn now(&self) -> Ticks {
        Ticks::from_femtoseconds(i64::from(self.k) * 100_000_000_000_000)
            .plus(Ticks::from_seconds(self.clock))
    }

    /// Takes the next readings, changed by these functions; returns the statuses of gyro and star tracker.
    fn cycle(
        &mut self,
        gyro: impl Fn(&mut Vector3),
        tracker: impl Fn(&mut Quaternion),
    ) -> [ReadingStatus; 2] {
        self.k += 1;
        let (now, late) = (self.now(), Ticks::from_seconds(0.2));
        let Self { estimator, entries, observations, .. } = self;
        let mut rate = Vector3::new(RATE, 0.0, 0.0);
        gyro(&mut rate);
        let first = estimator.take_gyro(now, Ticks::default(), rate, entries, observations);
        let mut second = ReadingStatus::None;
        if self.k.is_multiple_of(5) {
            let mut attitude = attitude_at(f64::from(self.k) / 10.0 - 0.2);
            tracker(&mut attitude);
            let variance = 2.4e-5 * 2.4e-5;
            let noise = Matrix3 { rows: [[variance, 0.0, 0.0], [0.0, variance, 0.0], [0.0, 0.0, variance]] };
            let observation = AttitudeObservation {
                kind: ObservationKind::Attitude,
                attitude,
                noise,
                ..AttitudeObservation::NONE
            };
            second = estimator.take_observation(1, now, late, &observation, entries, observations);
            self.statuses.push(second);
            if self.has_sun {
                // Along the axis of the rotation it stays where it is.
                let sun = AttitudeObservation {
                    kind: ObservationKind::Direction,
                    vector: Vector3::new(1.0, 0.0, 0.0),
                    inertial: Vector3::new(1.0, 0.0, 0.0),
                    noise: Matrix3 { rows: [[4e-4, 0.0, 0.0], [0.0, 4e-4, 0.0], [0.0, 0.0, 4e-4]] },
                    ..AttitudeObservation::NONE
                };
                let third = estimator.take_observation(2, now, Ticks::default(), &sun, entries, observations);
                assert_eq!(third, ReadingStatus::Accepted, "{}", self.k);
            }
        }
        [first, second]
    }

    fn run(&mut self, cycles: u32) {
        for _ in 0..cycles {
            self.cycle(|_| (), |_| ());
        }
    }

    /// Returns the error of the attitude (rad).
    fn error(&self) -> f64 {
        attitude_at(self.seconds()).rotation_to(&self.estimator.attitude(self.now(), &self.entries)).norm()
    }
}

/// Change of a reading of a star tracker.
type Spoiled<'a> = &'a dyn Fn(&mut Quaternion);

#[test]
fn a_false_reading_leaves_no_trace() {
    let wrong = |attitude: &mut Quaternion| {
        *attitude = attitude.times(&Quaternion::rotation(&Vector3::new(2.1, 0.0, 0.0)));
    };
    let trackers: [(Spoiled<'_>, ReadingStatus); 4] = [
        (&wrong, ReadingStatus::Improbable),
        (&|attitude| attitude.y = f64::NAN, ReadingStatus::Unsound),
        (&|attitude| *attitude = Quaternion { w: 0.0, x: 0.0, y: 0.0, z: 0.0 }, ReadingStatus::Unsound),
        (&|attitude| attitude.w *= 1.1, ReadingStatus::Unsound),
    ];
    for (number, (tracker, status)) in trackers.into_iter().enumerate() {
        let mut flight = Flight::start(0.0);
        flight.run(99);
        assert_eq!(flight.cycle(|_| (), tracker), [ReadingStatus::Accepted, status], "{number}");
        assert_eq!(flight.estimator.history.refused[..3], [0, 1, 0], "the counter of the star tracker");
        for _ in 0..300 {
            flight.run(1);
            assert!(flight.error() < 1e-12, "{number}: {:e}", flight.error());
        }
    }
    let gyros: [&dyn Fn(&mut Vector3); 3] =
        [&|rate| rate.y = f64::NAN, &|rate| rate.z = 50.0, &|rate| rate.x = f64::NEG_INFINITY];
    for gyro in gyros {
        let mut flight = Flight::start(0.0);
        flight.run(99);
        assert_eq!(flight.cycle(gyro, |_| ()), [ReadingStatus::Unsound, ReadingStatus::Accepted]);
        flight.run(300);
        assert!(
            flight.error() < 1e-12 && flight.estimator.history.refused[..2] == [1, 0],
            "{:e}",
            flight.error()
        );
    }
}

#[test]
fn a_refused_measurement_does_not_hide_the_correction_before_it() {
    let read = readings();
    let mut entries = [AttitudeHistoryEntry::NONE; 8];
    let mut observations = [DelayedObservation::NONE; 4];
    let mut history = AttitudeHistory::start(at(0), first(), NOISE, at(8), GATE, &mut entries);
    let sound = fix(&read, 4);
    let mut wrong = sound;
    let turn = Quaternion::rotation(&Vector3::new(2.1, 0.0, 0.0));
    wrong.observation.attitude = sound.observation.attitude.times(&turn);
    for waiting in [sound, wrong] {
        let result = history.add_observation(waiting, &mut entries, &mut observations);
        assert_eq!(result.status, ReadingStatus::Waiting);
    }
    let corrections: Vec<ReadingStatus> = (1..5)
        .map(|k| history.add_gyro(at(k), vector(&read[k][2..5]), &mut entries, &mut observations).status)
        .collect();
    assert_eq!((corrections[3], history.applied, history.refusals()), (ReadingStatus::Accepted, 1, 1));
}

#[test]
fn a_vector_of_zeros_is_refused() {
    let zeros = AttitudeObservation {
        kind: ObservationKind::Vector,
        inertial: Vector3::new(2e-5, 0.0, 3e-5),
        ..AttitudeObservation::NONE
    };
    assert!(!zeros.is_sound());
    assert!(AttitudeObservation { vector: Vector3::new(3e-5, 0.0, 2e-5), ..zeros }.is_sound());
}

/// Asserts that a spike of the rate, which turns the estimate by 0.05 rad, has two readings refused and leaves no error.
fn assert_reaccepts_after_spike(flight: &mut Flight) {
    use ReadingStatus::{Accepted, Improbable, Reaccepted};
    flight.cycle(|rate| rate.y = 0.5, |_| ());
    flight.statuses.clear();
    flight.run(30);
    assert_eq!(flight.statuses[..4], [Improbable, Improbable, Reaccepted, Accepted]);
    flight.run(600);
    assert!(flight.error() < 1e-6, "{:e}", flight.error());
}

#[test]
fn an_attitude_that_stays_improbable_is_accepted() {
    use ReadingStatus::{Accepted, Reaccepted};
    let mut flight = Flight::start(0.0);
    flight.run(100);
    // A spike below the largest rate turns the estimate by 0.05 rad.
    assert_reaccepts_after_spike(&mut flight);
    // After a gap the first one is.
    let mut flight = Flight::start(0.0);
    flight.run(100);
    flight.clock += 4000.0;
    flight.statuses.clear();
    flight.run(20);
    assert_eq!(flight.statuses[..2], [Reaccepted, Accepted]);
    assert!(flight.error() < 1e-6, "{:e}", flight.error());
}

#[test]
fn a_coarse_sensor_does_not_keep_a_precise_one_refused() {
    let mut flight = Flight::start(0.0);
    flight.has_sun = true;
    flight.run(100);
    // 0.05 rad are 2.5 standard deviations of the Sun sensor, and 2000 of the star tracker.
    assert_reaccepts_after_spike(&mut flight);
}

#[test]
fn a_clock_that_is_set_back_is_followed() {
    let mut flight = Flight::start(0.0);
    flight.run(1000);
    let before = flight.estimator.history.refusals();
    // One reading with an early time is refused.
    flight.clock -= 30.0;
    assert_eq!(flight.cycle(|_| (), |_| ())[0], ReadingStatus::Untimely);
    flight.clock += 30.0;
    assert_eq!(flight.cycle(|_| (), |_| ())[0], ReadingStatus::Accepted);
    assert!(flight.error() < 1e-12, "{:e}", flight.error());
    flight.clock -= 90.0;
    flight.run(50);
    assert!(flight.error() < 1e-6, "{:e}", flight.error());
    assert!(flight.estimator.history.refusals() - before < 8);
}

#[test]
fn a_start_at_any_time_gives_the_same_bits() {
    let [mut early, mut late] = [0.0, 5000.0].map(Flight::start);
    for k in 1..400 {
        let noise = |rate: &mut Vector3| rate.y = 1e-5 * f64::from(k % 7);
        assert_eq!(early.cycle(noise, |_| ()), late.cycle(noise, |_| ()));
        let [one, other] =
            [&early, &late].map(|flight| flight.estimator.attitude(flight.now(), &flight.entries));
        assert_eq!(one, other, "{k}");
        assert_eq!(early.estimator.deviation(&early.entries), late.estimator.deviation(&late.entries));
        assert_eq!(early.estimator.age(early.now()), late.estimator.age(late.now()));
    }
}
