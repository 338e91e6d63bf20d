//! Robustness of a damped wave beside an undamped one, against critical points in 30 digits and rows of 0.05 s
//! (`tests/golden/requirements_over_time.py`).

use std::sync::Arc;

use flexsc_numerics::polynomial::{Polynomial, TERMS};
use flexsc_numerics::signal::{Curve, PieceValues, SignalPiece};

use super::signal::RobustnessSignal;
use super::{Chunk, RequirementMonitor, RobustnessRange};
use crate::operation::{Expression, ModeCondition, ModeQuantity, RequirementNames, Vocabulary};

/// Length of a piece (s).
const STEP: f64 = 0.5;

fn read(text: &str) -> Expression {
    let known = Vocabulary {
        modes: vec!["safe", "fine"],
        requirement: Some(RequirementNames::default()),
        ..Vocabulary::default()
    };
    ModeCondition::new(text).parse(&known).unwrap_or_else(|fault| panic!("{text}: {}", fault.why))
}

/// Returns e(t) = 3e-3 exp(-t/40) cos(0.35 t + 0.4) + 2e-4 sin(2.13 t) in (rad) from a time on, or its rate (rad/s).
fn wave(from: f64, is_rate: bool) -> SignalPiece {
    let mut terms = [0.0; TERMS];
    let start = libm::exp(-from / 40.0) * 3e-3;
    let angle = 0.35 * from + 0.4;
    let mut damped = [start * libm::cos(angle), start * libm::sin(angle)];
    let mut free = [2e-4 * libm::sin(2.13 * from), -2e-4 * libm::cos(2.13 * from)];
    for (n, term) in terms.iter_mut().enumerate() {
        *term = damped[0] + free[0];
        let next = STEP / (n + 1) as f64;
        damped =
            [(-damped[0] / 40.0 - 0.35 * damped[1]) * next, (-damped[1] / 40.0 + 0.35 * damped[0]) * next];
        free = [-2.13 * free[1] * next, 2.13 * free[0] * next];
    }
    let polynomial = Polynomial::new(terms);
    let polynomial = if is_rate { polynomial.derivative().scaled(1.0 / STEP) } else { polynomial };
    let curve = Arc::new(Curve { begin: from, length: STEP, polynomial });
    let shape = PieceValues::Curve { curve, gain: 1.0, offset: 0.0, ahead: 0.0 };
    SignalPiece { from, to: from + STEP, shape }
}

/// Returns the pieces of a quantity: the size of the wave or of its rate, or whether a mode is active.
fn pieces(quantity: ModeQuantity, from: f64, mode: &dyn Fn(f64) -> usize) -> Vec<SignalPiece> {
    let mut all = Vec::new();
    match quantity {
        ModeQuantity::PointingError => wave(from, false).push_magnitude(&mut all),
        ModeQuantity::TrueRate => wave(from, true).push_magnitude(&mut all),
        ModeQuantity::Mode(index) => {
            let value = f64::from(u8::from(mode(from) == index));
            all.push(SignalPiece::constant(from, from + STEP, value));
        }
        other => panic!("{other:?}"),
    }
    all
}

/// Returns the robustness in a run of a length (s), with a mode at each time.
fn judged(text: &str, end: f64, mode: &dyn Fn(f64) -> usize) -> RobustnessRange {
    let mut monitor = RequirementMonitor::new(&read(text), end);
    let quantities: Vec<ModeQuantity> = monitor.quantities().collect();
    let mut from = 0.0;
    while from < end {
        let all: Vec<Vec<SignalPiece>> = quantities.iter().map(|of| pieces(*of, from, mode)).collect();
        monitor.push(&all.iter().map(Vec::as_slice).collect::<Vec<_>>());
        from += STEP;
    }
    monitor.finish(end)
}

/// Returns the robustness of a requirement that a run of 600 s decides, and the time of its witness (s).
fn decided(text: &str) -> (f64, f64) {
    let RobustnessRange { low, high } = judged(text, 600.0, &|_| 0);
    assert_eq!(low, high, "{text}");
    (low.value, low.at)
}

#[test]
fn robustness_is_that_of_critical_points() {
    for (text, robustness, at) in [
        ("always[100 s, 600 s] pointing_error < 5e-4", 9.448_976_592_769_7e-5 / 5e-4, 106.916_771_534_549),
        (
            "eventually[0, 120] always[0, 60] pointing_error < 4e-4",
            6.705_358_610_909_9e-5 / 4e-4,
            124.625_711_276,
        ),
        (
            "eventually[0, 60] always[0, 30] pointing_error < 1e-3",
            1.594_287_012_653_66e-4 / 1e-3,
            61.231_690_411_8,
        ),
        ("pointing_error < 3e-3 until[0, 100] truth.rate < 5e-4", 0.078_939_005_997_147_1, 0.0),
    ] {
        let (value, witness) = decided(text);
        assert!((value - robustness).abs() < 1e-12, "{text}: {value} is not {robustness}");
        assert!((witness - at).abs() < 1e-8, "{text}: {witness} is not {at}");
    }
}

#[test]
fn rows_are_optimistic() {
    // rtamt 0.4.10 on rows of 0.05 s.
    let (exact, _) = decided("always[100, 600] pointing_error < 5e-4");
    assert!(exact * 5e-4 < 9.462_071e-5 - 1e-7);
}

#[test]
fn signs_change_where_the_wave_crosses() {
    let signs = |limit: &str| {
        let mut of_limit = RobustnessSignal::Sign(Box::new(RobustnessSignal::new(
            &read(limit),
            [0.0, f64::INFINITY],
            false,
            &mut 0,
        )));
        let monitor = RequirementMonitor::new(&read(limit), 600.0);
        let leaf = monitor.leaves[0];
        let mut all = Vec::new();
        for step in 0..1200 {
            let of = pieces(ModeQuantity::PointingError, f64::from(step) * STEP, &|_| 0);
            let scaled: Vec<SignalPiece> =
                of.into_iter().map(|of| of.scaled(leaf.gain, leaf.offset)).collect();
            of_limit.push(Chunk::Known(&[scaled]), &mut all);
        }
        all
    };
    for (limit, from) in
        [("pointing_error < 6e-4", 79.028_202_870_359_95), ("pointing_error < 2.5e-4", 160.129_006_712_400_7)]
    {
        let last = signs(limit).into_iter().rfind(|sign| sign.at(sign.from).value < 0.0).unwrap();
        assert!((last.to - from).abs() < 1e-10, "{limit}: {}", last.to);
    }
    let above = signs("pointing_error > 2.2e-4");
    let long = |sign: &SignalPiece| {
        if sign.at(sign.from).value > 0.0 { sign.to - sign.from.max(100.0) } else { 0.0 }
    };
    let share: f64 = above.iter().filter(|sign| sign.to > 100.0).map(long).sum::<f64>() / 500.0;
    assert!((share - 0.030_747_443_364_812_5).abs() < 1e-12, "{share}");
}

#[test]
fn windows_beyond_the_run_are_undecided_unless_a_part_decides() {
    let RobustnessRange { low, high } = judged("always[100, 601] pointing_error < 5e-4", 600.0, &|_| 0);
    assert!(low.value == f64::NEG_INFINITY && (high.value - 0.188_979_5).abs() < 1e-6);
    let missed = judged("always[0, 601] pointing_error < 5e-4", 600.0, &|_| 0);
    assert!(missed.high.value < 0.0);
    let met = judged("eventually[0, 601] pointing_error < 5e-4", 600.0, &|_| 0);
    assert!(met.low.value > 0.9);
    // The last instant belongs to the run.
    let to_the_end = judged("always pointing_error < 4e-3", 600.0, &|_| 0);
    assert_eq!(to_the_end.low, to_the_end.high);
    let settles = judged("eventually[0, 120] always pointing_error < 6e-4", 600.0, &|_| 0);
    assert!(settles.low == settles.high && settles.low.value > 0.0);
    assert!(judged("eventually[0, 70] always pointing_error < 6e-4", 600.0, &|_| 0).high.value < 0.0);
}

#[test]
fn events_and_modes_are_right_continuous() {
    let mode = |t: f64| usize::from((100.0..150.0).contains(&t) || t >= 590.0);
    let judged = |text: &str| judged(text, 600.0, &mode);
    // The change at 100 s belongs to the mode that begins.
    assert_eq!(judged("always[100, 149] mode(fine)").low.value, 1.0);
    assert_eq!(judged("always[100, 150] mode(fine)").high.value, -1.0);
    assert_eq!(judged("always[50, 100] mode(safe)").high.value, -1.0);
    // The second entry, at 590 s, is too late for 30 s.
    let entries = judged("when mode enters fine: within 60 s, for 30 s: pointing_error < 4e-4");
    assert!(entries.low.value == f64::NEG_INFINITY && entries.high.value > 0.0, "{entries:?}");
    let entries = judged("when mode enters fine: within 60 s, for 30 s: pointing_error < 1e-9");
    assert!(entries.high.value < 0.0, "{entries:?}");
    let inside = judged("when mode enters fine: pointing_error < 4e-4");
    assert_eq!(inside.low, inside.high);
    // An event that never occurs is not exercised.
    let never = judged("when not mode(fine) and not mode(safe): pointing_error < 4e-4");
    assert_eq!(never.low.value, f64::INFINITY);
    let implied = judged("always (mode(fine) implies pointing_error < 6e-4)");
    assert!((implied.low.value - (1.0 - 4.055_102_340_723_03e-4 / 6e-4)).abs() < 1e-12, "{implied:?}");
}
