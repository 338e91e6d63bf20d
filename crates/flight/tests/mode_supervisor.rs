//! Supervisor of modes: times for which a condition has to hold, numbers that are not known, and chatter.

use flexsc_flight::mode_condition::{
    CONDITION_MET, CONDITION_UNMET, ConditionRelation, ConditionSource, ConditionStep, condition_holds,
};
use flexsc_flight::mode_readings::{distance, largest_size, norm};
use flexsc_flight::mode_supervisor::{ModeSupervisor, SupervisedExit};
use flexsc_flight::supervised_mode::SupervisedMode;
use flexsc_flight::ticks::Ticks;

fn at(seconds: f64) -> Ticks {
    Ticks::from_seconds(seconds)
}

/// Returns the comparison of reading 0 with a limit.
fn compared(relation: ConditionRelation, limit: f64, met: usize, unmet: usize) -> ConditionStep {
    let source = ConditionSource::Reading;
    ConditionStep { source, index: 0, relation, limit, limit_time: at(limit), met, unmet }
}

fn exit(to: usize, first_step: usize, dwell: f64) -> SupervisedExit {
    SupervisedExit {
        to,
        first_step,
        dwell: at(dwell),
        is_exact: false,
        has_instant: false,
        instant: Ticks::default(),
        is_held: false,
        since: Ticks::default(),
    }
}

/// Two modes with one end each, which is met by a reading below 1 and above 2.
struct Pair {
    modes: [SupervisedMode; 2],
    exits: [SupervisedExit; 2],
    steps: [ConditionStep; 2],
    supervisor: ModeSupervisor,
}

impl Pair {
    fn new(period: f64, dwell: f64) -> Self {
        let mode = |first_exit| SupervisedMode { period: at(period), first_exit, exit_count: 1, entries: 9 };
        let (mut modes, mut exits) = ([mode(0), mode(1)], [exit(1, 0, dwell), exit(0, 1, 0.0)]);
        let steps = [
            compared(ConditionRelation::Below, 1.0, CONDITION_MET, CONDITION_UNMET),
            compared(ConditionRelation::Above, 2.0, CONDITION_MET, CONDITION_UNMET),
        ];
        let supervisor = ModeSupervisor::start(at(0.0), &mut modes, &mut exits);
        Self { modes, exits, steps, supervisor }
    }

    /// Tests a reading when it is due, and returns the time, whether the mode has changed, and whether it chatters.
    fn test(&mut self, reading: f64) -> (f64, bool, bool) {
        let due = self.supervisor.due(&self.modes, &self.exits);
        assert!(due.has_time);
        let test = self.supervisor.test(due.time, &[reading], &mut self.modes, &mut self.exits, &self.steps);
        (due.time.seconds(), test.has_changed, test.is_chattering)
    }
}

#[test]
fn a_dwell_that_is_broken_begins_again() {
    let mut pair = Pair::new(1.0, 3.0);
    let readings = [0.5, 0.5, 0.5, f64::NAN, 0.5, 0.5, 1.0, 0.5, 0.5, 0.5, 0.5];
    let tests: Vec<_> = readings.iter().map(|reading| pair.test(*reading)).collect();
    let changes: Vec<f64> = tests.iter().filter(|test| test.1).map(|test| test.0).collect();
    assert_eq!(changes, [11.0]);
    assert_eq!(pair.modes.map(|mode| mode.entries), [1, 1]);
}

#[test]
fn more_than_32_changes_in_a_second_wait() {
    let mut pair = Pair::new(0.02, 0.0);
    let mut changes = Vec::new();
    for _ in 0..100 {
        let reading = if pair.supervisor.active == 0 { 0.0 } else { 3.0 };
        let (time, has_changed, is_chattering) = pair.test(reading);
        assert!(has_changed != is_chattering);
        if has_changed {
            changes.push(time);
        }
    }
    // Changes at 0.02 to 0.64 s; the next one comes more than a second after the first.
    assert_eq!(changes.len(), 32 + 32);
    assert!((changes[31] - 0.64).abs() < 1e-12 && (changes[32] - 1.04).abs() < 1e-12, "{changes:?}");
    for window in changes.windows(33) {
        assert!(window[32] - window[0] > 1.0);
    }
}

#[test]
fn a_mode_that_is_entered_after_the_clock_was_set_back_begins_then() {
    let mut pair = Pair::new(1.0, 0.0);
    for _ in 0..5 {
        pair.test(1.5);
    }
    pair.supervisor.enter(at(2.0), 1, &mut pair.modes, &mut pair.exits);
    pair.supervisor.test(at(2.5), &[1.5], &mut pair.modes, &mut pair.exits, &pair.steps);
    assert_eq!((pair.supervisor.active, pair.supervisor.entered), (1, at(2.0)));
}

#[test]
fn a_number_that_is_not_known_meets_no_comparison() {
    let (met, unmet) = (CONDITION_MET, CONDITION_UNMET);
    let holds =
        |steps: &[ConditionStep], reading: f64| condition_holds(steps, 0, at(0.0), at(0.0), &[reading], &[]);
    for relation in [
        ConditionRelation::Below,
        ConditionRelation::AtMost,
        ConditionRelation::Above,
        ConditionRelation::AtLeast,
        ConditionRelation::Equal,
    ] {
        assert!(!holds(&[compared(relation, 1.0, met, unmet)], f64::NAN));
        // The negation of a comparison with it is true.
        assert!(holds(&[compared(relation, 1.0, unmet, met)], f64::NAN));
    }
    // Above 1 and below 3, or equal to 7.
    let steps = [
        compared(ConditionRelation::Above, 1.0, 1, 2),
        compared(ConditionRelation::Below, 3.0, met, 2),
        compared(ConditionRelation::Equal, 7.0, met, unmet),
    ];
    let found = [0.0, 1.0, 2.0, 3.0, 7.0, 8.0].map(|reading| holds(&steps, reading));
    assert_eq!(found, [false, false, true, false, true, false]);
}

#[test]
fn times_are_compared_exactly() {
    let step = |relation| ConditionStep {
        source: ConditionSource::RunTime,
        ..compared(relation, 0.3, CONDITION_MET, CONDITION_UNMET)
    };
    let tick = Ticks { whole: 0, part: 1 };
    let times = [at(0.3).since(tick), at(0.3), at(0.3).plus(tick)];
    for (relation, expected) in [
        (ConditionRelation::Below, [true, false, false]),
        (ConditionRelation::AtMost, [true, true, false]),
        (ConditionRelation::Above, [false, false, true]),
        (ConditionRelation::AtLeast, [false, true, true]),
        (ConditionRelation::Equal, [false, true, false]),
    ] {
        let found = times.map(|time| condition_holds(&[step(relation)], 0, at(0.0), time, &[], &[]));
        assert_eq!(found, expected, "{relation:?}");
    }
}

#[test]
fn readings_of_vectors_are_exact_or_not_known() {
    assert_eq!((norm(&[3.0, 4.0]), norm(&[2.0, 3.0, 6.0])), (5.0, 7.0));
    assert_eq!(distance(&[1.0, 5.0], &[-2.0, 1.0]), 5.0);
    assert_eq!(largest_size(&[1.0, -3.0, 2.0]), 3.0);
    assert!(
        [norm(&[1.0, f64::NAN]), largest_size(&[f64::NAN, 9.0]), largest_size(&[9.0, f64::NAN])]
            .iter()
            .all(|value| value.is_nan())
    );
}
