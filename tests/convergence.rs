//! Convergence of the recurrence observer, and modes that an observer can distinguish.
//!
//! Golden numbers: tests/golden/damping_oracle.py, NumPy and SciPy.

use flexsc_core::analysis::damping::{Convergence, persistence};
use flexsc_core::control::estimator::adaptive::{AdaptiveObserver, Gradient, Pulse, Tracker};
use flexsc_core::numerics::quantity::{Finite, Frequency};
use flexsc_core::numerics::random::Seed;

use crate::study::close;
use crate::util::Dir;

const TURN: f64 = 2.0 * std::f64::consts::PI;
const CYCLE: f64 = 0.2;

fn observer(weights: [f64; 3]) -> Convergence {
    Convergence { frequency: 0.2 * TURN, damping: 0.005, period: CYCLE, weights }
}

#[test]
fn the_frozen_observer_converges_in_a_region() {
    let of = observer([0.05, 0.2, 0.15]);
    let (a, b) = of.recurrence();
    close(a, 1.934_735_096_8, 1e-10);
    close(b, 0.997_489_881_5, 1e-10);
    let [a0, a1, a2] = of.cubic(0.0);
    let real = 0.966_148_01;
    assert!((((real + a2) * real + a1) * real + a0).abs() < 1e-9);
    // The sum of the roots, and of the pair's: their product.
    close(-a2, real + 2.0 * 0.840_820_03, 1e-8);
    close(-a0, real * (0.840_820_03 * 0.840_820_03 + 0.259_522_05 * 0.259_522_05), 1e-7);
    for (w1, kappa, area) in
        [(0.05, 0.0, 3.983), (0.05, 1.5, 1.347), (0.05, 4.0, 0.227), (0.02, 0.0, 3.9963), (0.2, 0.0, 3.9223)]
    {
        close(observer([w1, 0.0, 0.0]).area(kappa), area, 0.01);
    }
    // The observer converges with no kappa beyond 8, and the edges are those of its convergence.
    assert_eq!(of.area(8.1), 0.0);
    for edge in of.region(1.5, &[0.6, 1.2, 1.8]) {
        let (low, high) = edge.next.expect("a region");
        for (w3, inside) in
            [(low - 1e-6, false), (low + 1e-6, true), (high - 1e-6, true), (high + 1e-6, false)]
        {
            let at = observer([0.05, edge.elastic, w3]);
            assert_eq!(at.converges(1.5), inside, "{edge:?} at {w3}");
        }
    }
    assert_eq!(of.region(0.0, &[-0.2, 2.1]).iter().filter(|edge| edge.next.is_some()).count(), 0);
}

#[test]
fn the_turning_regressor_allows_far_less() {
    for (weights, gain, best, radius) in
        [([0.05, 0.2, 0.15], 0.0429, 0.0187, 0.9539), ([0.05, 0.1, 0.05], 0.0255, 0.0046, 0.9684)]
    {
        let margin = observer(weights).margin().expect("a margin");
        // The known gains are steps of 5 % of a search: the limit lies less than one above the last with
        // which it converges, and the best, about which the radius is flat, within one.
        close(margin.gain_max, gain, 0.035);
        close(margin.gain_best, best, 0.06);
        close(margin.spectral_radius, radius, 1e-3);
        assert!(observer(weights).spectral_radius(0.98 * margin.gain_max) < 1.0);
        assert!(observer(weights).spectral_radius(1.02 * margin.gain_max) > 1.0);
    }
    assert_eq!(observer([0.05, -0.5, 0.15]).margin(), None);
    // A period that is no multiple of the cycle: nearly that of the neighbour.
    let near = Convergence { frequency: 0.201 * TURN, ..observer([0.05, 0.2, 0.15]) };
    close(near.spectral_radius(0.01), observer([0.05, 0.2, 0.15]).spectral_radius(0.01), 5e-3);
}

/// Returns the persistence of excitation of two modes (Hz) over random bursts of a time (s).
fn resolution(modes: [f64; 2], time: f64, run: u64) -> f64 {
    let frequency = |hertz: f64| Frequency::new(TURN * hertz).expect("a frequency");
    let tracker = |hertz: f64| Tracker {
        frequency: frequency(hertz),
        influence: vec![Finite::new(3.0).expect("finite")],
        bounds: None,
    };
    let mut observer = Gradient::default().observer(&modes.map(tracker), &[1.0], CYCLE);
    let mut draws = Seed { scenario: 1, run }.stream("bursts");
    let (mut rows, mut left, mut wait, mut sign) = (Vec::new(), 0, 0, 1.0);
    for _ in 0..(time / CYCLE) as usize {
        rows.push(observer.sensitivities());
        // The predicted rate, so that the parameters stay.
        observer.update(observer.rate() + observer.modes().iter().map(|mode| mode.phase[0]).sum::<f64>());
        if left == 0 && wait == 0 {
            (left, wait) = (1 + draws.index(10), draws.index(20));
            sign = if draws.uniform() < 0.5 { -1.0 } else { 1.0 };
        }
        let fires = left > 0;
        (left, wait) = if fires { (left - 1, wait) } else { (0, wait.saturating_sub(1)) };
        let pulse = Pulse { input: 0, acceleration: 2.05e-5 * sign, start: 0.0, duration: CYCLE };
        observer.advance(if fires { std::slice::from_ref(&pulse) } else { &[] });
    }
    persistence(&rows).expect("excited")
}

#[test]
fn near_modes_are_not_resolved() {
    // (modes, after 60 s, after 300 s: between which bounds).
    let cases = [
        ([0.25, 0.6], [0.4, 1.0], [0.7, 1.0]),
        ([0.48, 0.6], [0.4, 0.85], [0.6, 0.95]),
        ([0.55, 0.605], [0.3, 0.7], [0.45, 0.8]),
        ([0.6049, 0.6096], [0.0, 2e-3], [1e-3, 0.05]),
    ];
    for (modes, short, long) in cases {
        for (time, [low, high]) in [(60.0, short), (300.0, long)] {
            let mut found: Vec<f64> = (0..5).map(|run| resolution(modes, time, run)).collect();
            found.sort_by(f64::total_cmp);
            assert!((low..high).contains(&found[2]), "{modes:?} over {time} s: {found:?}");
        }
    }
    // Two parameters that act alike, one that does not act, rows that do not fit.
    assert!(persistence(&[vec![1.0, 2.0], vec![-2.0, -4.0]]).expect("numbers").abs() < 1e-12);
    close(persistence(&[vec![1.0, 0.0], vec![0.0, 3.0]]).expect("numbers"), 1.0, 1e-12);
    assert_eq!(persistence(&[vec![1.0, 0.0]]), None);
    assert_eq!(persistence(&[vec![1.0], vec![1.0, 2.0]]), None);
    assert_eq!(persistence(&[]), None);
}

#[test]
fn the_command_tells_when_the_observer_converges() {
    let dir = Dir::new();
    let reported = dir.run("observer --frequency 1.2566370614 --kappa 0,1.5 --json").exits(0).json();
    close(reported["a"].as_f64().expect("A"), 1.934_735_096_8, 1e-9);
    close(reported["frozen"][1]["area"].as_f64().expect("an area"), 1.347, 0.01);
    assert_eq!([0, 1].map(|i| reported["frozen"][i]["converges"].as_bool()), [Some(true), Some(false)]);
    close(reported["turning"]["gain_max"].as_f64().expect("a gain"), 0.0429, 0.035);
    let said = dir.run("observer --frequency 1.2566 --weights 0.05,-0.5,0.15 --figures drawn --format svg");
    said.exits(0).says(&["converges with no W4", "0.2000 Hz"]);
    let drawn = dir.text("drawn/observer.svg");
    assert!(drawn.contains("W4 |g| = 1.5") && drawn.contains("W3") && drawn.contains("regressor turning"));
    for (bad, why) in [
        ("observer --frequency 16", "--frequency must be above 0 and below the Nyquist frequency of 15.7"),
        ("observer --frequency 1 --weights 0.05,0.1", "--weights must be three numbers, W1,W2,W3, got 2"),
        (
            "observer --frequency 1 --weights 0.05,0.1,inf",
            "must be a number, or a number with a unit, got `inf`",
        ),
        ("observer --frequency 1 --kappa -1", "--kappa must be numbers of 0 or more below 1000, got -1"),
        ("observer --frequency -1", "--frequency must be above 0 and below"),
    ] {
        dir.run(bad).exits(2).says(&[why]);
    }
}
