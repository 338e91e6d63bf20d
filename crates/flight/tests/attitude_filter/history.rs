//! Recent past of the attitude filter: delayed and early measurements, and storage that is full.

use flexsc_flight::attitude_history::{AttitudeHistory, AttitudeHistoryEntry};
use flexsc_flight::delayed_observation::DelayedObservation;
use flexsc_flight::ticks::Ticks;

use crate::forty_digits::{GATE, NOISE, apart, at, first, fix, readings, replay, vector};

#[test]
fn whatever_is_late_comes_to_the_same() {
    let [soon, later] = [0, 2].map(|late| replay(late, 8).0);
    // Compares instants at which both have received the same attitudes.
    for k in (7..soon.len()).step_by(4) {
        let (a, b) = (&soon[k], &later[k]);
        assert!(apart(&a.attitude, &b.attitude) < 1e-14 && a.bias.minus(&b.bias).norm() < 1e-18, "{k}");
    }
    // More storage changes no bit.
    assert_eq!(replay(2, 8).0, replay(2, 100).0);
}

/// Attitude of the latest entry after five readings and three attitudes in this order, two of them exposed between readings,
/// in storage of this size.
fn arrive(order: [usize; 3], capacity: usize) -> AttitudeHistoryEntry {
    let read = readings();
    let mut entries = vec![AttitudeHistoryEntry::NONE; capacity];
    let mut observations = vec![DelayedObservation::NONE; 3];
    let mut history = AttitudeHistory::start(at(0), first(), NOISE, at(8), GATE, &mut entries);
    for row in &read[1..6] {
        history.add_gyro(at(row[0] as usize), vector(&row[2..5]), &mut entries, &mut observations);
    }
    let early = DelayedObservation { exposed: at(2).plus(Ticks::from_seconds(0.1)), ..fix(&read, 4) };
    let late = DelayedObservation { exposed: at(3).plus(Ticks::from_seconds(0.2)), ..fix(&read, 4) };
    let fixes = [early, late, fix(&read, 4)];
    for index in order {
        assert!(
            history.add_observation(fixes[index], &mut entries, &mut observations).status.has_corrected()
        );
    }
    assert_eq!((history.entries, history.applied), (capacity.min(8), 3));
    entries[history.latest()]
}

#[test]
fn the_order_of_arrival_changes_nothing() {
    let exact = arrive([0, 1, 2], 20);
    // Across the boresight, three attitudes divide the variance of one by three.
    let variance = exact.filter.covariance.rows[1][1];
    assert!((variance / (2.4e-5 * 2.4e-5 / 3.0) - 1.0).abs() < 0.1, "{variance:e}");
    for order in [[0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
        assert_eq!(arrive(order, 20), exact, "{order:?}");
        // The oldest entries, which are dropped, are not needed.
        assert_eq!(arrive(order, 6), exact, "{order:?}");
    }
}

#[test]
fn a_measurement_waits_for_its_reading_and_not_for_ever() {
    let read = readings();
    let mut entries = [AttitudeHistoryEntry::NONE; 8];
    let mut observations = [DelayedObservation::NONE; 4];
    let mut history = AttitudeHistory::start(at(0), first(), NOISE, at(2), GATE, &mut entries);
    // Of two that wait, the later one arrives first.
    for k in [4, 3] {
        let early = DelayedObservation { exposed: at(k), ..fix(&read, 4) };
        assert!(!history.add_observation(early, &mut entries, &mut observations).status.has_corrected());
    }
    for k in 1..12 {
        let reading = vector(&read[k][2..5]);
        let correction = history.add_gyro(at(k), reading, &mut entries, &mut observations);
        assert_eq!(correction.status.has_corrected(), k == 3 || k == 4, "{k}");
    }
    assert_eq!((history.waiting, history.applied), (0, 2));
    let last = DelayedObservation { exposed: at(10), ..fix(&read, 8) };
    assert!(
        !history.add_observation(fix(&read, 8), &mut entries, &mut observations).status.has_corrected(),
        "0.75 s late"
    );
    assert!(history.add_observation(last, &mut entries, &mut observations).status.has_corrected());
    // A reading that is not later is not used.
    assert!(
        !history
            .add_gyro(at(11), vector(&read[11][2..5]), &mut entries, &mut observations)
            .status
            .has_corrected()
    );
    assert_eq!(history.entries, 3);
}

#[test]
fn full_storage_refuses_measurements_and_drops_old_entries() {
    let read = readings();
    let mut entries = [AttitudeHistoryEntry::NONE; 2];
    let mut observations = [DelayedObservation::NONE; 1];
    let mut history = AttitudeHistory::start(at(0), first(), NOISE, at(8), GATE, &mut entries);
    for k in 1..5 {
        let reading = vector(&read[k][2..5]);
        assert!(!history.add_gyro(at(k), reading, &mut entries, &mut observations).status.has_corrected());
        assert_eq!(history.entries, 2.min(k + 1));
    }
    // An exposure between both entries has no room, one at the later entry has.
    let between = DelayedObservation { exposed: at(3).plus(Ticks::from_seconds(0.1)), ..fix(&read, 4) };
    assert!(!history.add_observation(between, &mut entries, &mut observations).status.has_corrected());
    assert!(history.add_observation(fix(&read, 4), &mut entries, &mut observations).status.has_corrected());
    assert!(!history.add_observation(fix(&read, 4), &mut entries, &mut observations).status.has_corrected());
    // Storage that does not hold the history is refused.
    assert!(
        !history.add_observation(fix(&read, 4), &mut entries[..1], &mut observations).status.has_corrected()
    );
    assert!(
        !AttitudeHistory::start(at(0), first(), NOISE, at(8), GATE, &mut [])
            .add_gyro(at(1), vector(&read[1][2..5]), &mut entries, &mut observations)
            .status
            .has_corrected()
    );
}
