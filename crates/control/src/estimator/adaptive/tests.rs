//! Tests of the observers on clean data, against tests/golden/observer_oracle.py, and with invalid measurements.

use std::f64::consts::PI;

use flexsc_numerics::quantity::{Finite, Frequency};

use super::*;

const CYCLE: f64 = 0.2;
const ACCELERATION: f64 = 2.05e-5;
/// Frequency (rad/s) and influence of the true mode.
const MODE: (f64, f64) = (0.4 * PI, 2.0);

fn tracker(hertz: f64, influence: f64) -> Tracker {
    let frequency = |hertz: f64| Frequency::new(2.0 * PI * hertz).expect("a frequency");
    let influence = vec![Finite::new(influence).expect("finite")];
    Tracker { frequency: frequency(hertz), influence, bounds: Some([0.05, 0.6].map(frequency)) }
}

fn gradient(hertz: f64, influence: f64) -> GradientObserver {
    let wide =
        [0.1, 10.0].map(|bound| flexsc_numerics::quantity::NonNegative::new(bound).expect("0 or more"));
    let spec = Gradient { influence_bounds: wide, ..Gradient::default() };
    spec.observer(&[tracker(hertz, influence)], &[1.0], CYCLE)
}

fn recurrence(hertz: f64, influence: f64) -> RecurrenceObserver {
    Recurrence::default().observer(&tracker(hertz, influence), CYCLE)
}

/// Returns bursts: ten cycles of every 65 with one sign, then with the other.
fn burst(cycle: usize) -> Vec<Pulse> {
    let sign = if (cycle / 65).is_multiple_of(2) { 1.0 } else { -1.0 };
    if (5..15).contains(&(cycle % 65)) {
        vec![Pulse { input: 0, acceleration: sign * ACCELERATION, start: 0.0, duration: CYCLE }]
    } else {
        Vec::new()
    }
}

/// Returns the measured rate at each sample under the bursts, without noise.
fn measured() -> Vec<f64> {
    let oscillator = OscillatorModel { frequency: MODE.0, damping: 0.005 };
    let (mut rate, mut phase) = (0.0, [0.0; 2]);
    let sample = |cycle| {
        let y = rate + MODE.1 * phase[0];
        phase = oscillator.propagate(&oscillator.transition(CYCLE), CYCLE, phase).0;
        for Pulse { acceleration, duration, .. } in burst(cycle) {
            rate += acceleration * duration;
            let push = oscillator.pulse_response(CYCLE, CYCLE - duration).0;
            phase = [0, 1].map(|axis| phase[axis] + acceleration * push[axis]);
        }
        y
    };
    (0..1300).map(sample).collect()
}

/// Returns the measured rate according to the recurrence itself.
fn recurred() -> Vec<f64> {
    let (w, zeta) = (MODE.0, 0.005);
    let turn = 2.0 * libm::exp(-zeta * w * CYCLE) * libm::cos(w * f64::sqrt(1.0 - zeta * zeta) * CYCLE);
    let decay = libm::exp(-2.0 * zeta * w * CYCLE);
    let (mut rate, mut now, mut before, mut push) = (0.0, 0.0, 0.0, 0.0);
    let sample = |cycle| {
        let y = rate + now;
        let next: f64 = burst(cycle).iter().map(|pulse| pulse.acceleration * pulse.duration).sum();
        (now, before) = (turn * now - decay * before + MODE.1 * (next - 0.5 * turn * push), now);
        (rate, push) = (rate + next, next);
        y
    };
    (0..1300).map(sample).collect()
}

/// Returns frequency (Hz) and influence after some samples.
fn identified(observer: &mut dyn AdaptiveObserver, measured: &[f64], samples: &[usize]) -> Vec<(f64, f64)> {
    let mut found = Vec::new();
    for (cycle, y) in measured.iter().enumerate() {
        observer.update(*y);
        if samples.contains(&cycle) {
            let modes = observer.modes();
            found.push((modes[0].frequency / (2.0 * PI), modes[0].influence[0]));
        }
        observer.advance(&burst(cycle));
    }
    found
}

#[track_caller]
fn close(value: f64, exact: f64, relative: f64) {
    assert!((value / exact - 1.0).abs() <= relative, "{value} is off {exact}");
}

#[test]
fn the_plant_of_these_tests_is_exact() {
    let y = measured();
    for (cycle, exact) in
        [(10, 5.133_576_86e-5), (50, -6.680_945_94e-6), (100, -1.049_244_46e-4), (1299, 4.203_545_77e-5)]
    {
        close(y[cycle], exact, 1e-7);
    }
}

#[test]
fn gradient_identifies_a_mode() {
    let samples = [50, 100, 200, 500, 1000];
    let exact = [
        (
            (0.3, 1.2),
            [0.179_420_97, 0.199_694_05, 0.199_922_02, 0.199_960_65, 0.199_997_56],
            [1.455_24, 1.826_76, 1.932_29, 1.993_44, 1.999_61],
        ),
        (
            (0.22, 2.4),
            [0.200_296_15, 0.199_991_77, 0.200_035_39, 0.200_001_99, 0.200_000_08],
            [2.000_316, 2.051_709, 1.996_173, 2.000_304, 2.000_011],
        ),
        (
            (0.1, 2.8),
            [0.164_676_42, 0.195_129_98, 0.200_127_29, 0.200_031_74, 0.200_001_14],
            [1.277_455, 2.353_621, 2.074_818, 2.004_546, 2.000_155],
        ),
    ];
    for ((hertz, influence), frequencies, influences) in exact {
        let found = identified(&mut gradient(hertz, influence), &measured(), &samples);
        for ((found, frequency), influence) in found.iter().zip(frequencies).zip(influences) {
            close(found.0, frequency, 1e-7);
            close(found.1, influence, 3e-6);
        }
    }
}

#[test]
fn gradient_tells_two_modes_and_two_inputs_apart() {
    let hertz = |hertz: f64| Frequency::new(2.0 * PI * hertz).expect("a frequency");
    let mode = |frequency: f64, influence: [f64; 2], bounds: [f64; 2]| Tracker {
        frequency: hertz(frequency),
        influence: influence.map(|i| Finite::new(i).expect("finite")).to_vec(),
        bounds: Some(bounds.map(hertz)),
    };
    let guesses = [mode(0.28, [2.2, -0.9], [0.15, 0.4]), mode(0.55, [1.5, 1.0], [0.4, 0.9])];
    let truths = [(0.25, [2.9, -0.6]), (0.6, [1.1, 1.5])];
    let rigid = [1.0, 0.02];
    let mut observer = Gradient::default().observer(&guesses, &rigid, CYCLE);
    let (mut rate, mut phases) = (0.0, [[0.0; 2]; 2]);
    let exact = [
        (
            100,
            [0.251_600_919_401, 0.587_595_523_552],
            [2.802_706_212_103, -0.596_773_510_363, 1.183_847_148_863, 1.109_989_239_891],
            [1.492_023_534_346e-8, -2.230_986_565_975e-5, 1.619_702_460_515e-5],
        ),
        (
            1200,
            [0.250_004_382_156, 0.599_397_878_778],
            [2.899_117_240_267, -0.605_155_743_657, 1.101_596_857_878, 1.435_504_963_824],
            [7.454_398_147_227e-8, 5.851_893_955_919e-7, 2.097_559_823_444e-5],
        ),
    ];
    for cycle in 0_usize..1201 {
        let mut pulses = Vec::new();
        let mut add = |input, size: f64, turn: usize, start, duration| {
            let acceleration = if turn.is_multiple_of(2) { size } else { -size };
            pulses.push(Pulse { input, acceleration, start, duration });
        };
        if cycle % 60 < 8 {
            add(0, 2e-5, cycle / 60, 0.0, 0.2);
        }
        if (20..26).contains(&(cycle % 47)) {
            add(1, 4e-5, cycle / 47, 0.05, 0.11);
        }
        observer.update(rate + phases.iter().map(|phase| phase[0]).sum::<f64>());
        for (_, frequencies, influences, state) in exact.iter().filter(|exact| exact.0 == cycle) {
            let modes = observer.modes();
            for (index, mode) in modes.iter().enumerate() {
                close(mode.frequency / (2.0 * PI), frequencies[index], 1e-9);
                close(mode.influence[0], influences[2 * index], 1e-9);
                close(mode.influence[1], influences[2 * index + 1], 1e-9);
            }
            for (estimate, exact) in [observer.rate(), modes[0].phase[0], modes[0].phase[1]].iter().zip(state)
            {
                assert!((estimate - exact).abs() < 1e-13, "{estimate} is off {exact}");
            }
        }
        observer.advance(&pulses);
        for (phase, (hertz, influence)) in phases.iter_mut().zip(truths) {
            let oscillator = OscillatorModel { frequency: 2.0 * PI * hertz, damping: 0.005 };
            *phase = oscillator.propagate(&oscillator.transition(CYCLE), CYCLE, *phase).0;
            for Pulse { input, acceleration, start, duration } in &pulses {
                let push = oscillator.pulse_response(CYCLE - start, CYCLE - start - duration).0;
                *phase = [0, 1].map(|axis| phase[axis] + influence[*input] * acceleration * push[axis]);
            }
        }
        rate += pulses.iter().map(|p| rigid[p.input] * p.acceleration * p.duration).sum::<f64>();
    }
}

#[test]
fn recurrence_identifies_a_mode_with_a_bias() {
    let found = identified(&mut recurrence(0.3, 1.2), &measured(), &[1000]);
    close(found[0].0, 0.201_102, 1e-3);
    close(found[0].1, 2.378_20, 1e-3);
}

#[test]
fn recurrence_is_exact_on_data_of_its_own() {
    let mut observer = recurrence(0.2, 2.0);
    let y = recurred();
    for (cycle, y) in y.iter().enumerate() {
        observer.update(*y);
        observer.advance(&burst(cycle));
    }
    // The frequency is computed without the root of 1 - zeta².
    close(observer.modes()[0].frequency / (2.0 * PI), 0.199_997_5, 1e-7);
    close(observer.modes()[0].influence[0], 2.0, 1e-12);
    assert!(observer.residual().innovation < 1e-36, "{:?}", observer.residual());
    let found = identified(&mut recurrence(0.3, 1.2), &y, &[1299]);
    close(found[0].0, 0.2, 1.5e-3);
    close(found[0].1, 2.0, 5e-3);
}

#[test]
fn predictions_are_what_comes() {
    let y = measured();
    for known in [true, false] {
        let mut observer = gradient(0.2, 2.0);
        let mut short = recurrence(0.2, 2.0);
        for (cycle, y) in y.iter().enumerate().take(72) {
            for observer in [&mut observer as &mut dyn AdaptiveObserver, &mut short] {
                observer.update(*y);
                observer.advance(&burst(cycle));
            }
        }
        // Sample 72 is in the middle of a burst, which continues for five more samples.
        let pulses: Vec<Pulse> = (0..5)
            .flat_map(|cycle| burst(72 + cycle).into_iter().map(move |pulse| (cycle, pulse)))
            .map(|(cycle, pulse)| Pulse { start: CYCLE * cycle as f64, ..pulse })
            .collect();
        let pulses = if known { pulses.as_slice() } else { &[] };
        let truth = {
            let mut ahead = gradient(0.2, 2.0);
            for (cycle, y) in y.iter().enumerate().take(77) {
                ahead.update(*y);
                ahead.advance(&burst(cycle));
            }
            ahead.modes()[0].phase[0]
        };
        let predicted = observer.predict(1.0, pulses)[0];
        let rough = short.predict(1.0, pulses)[0];
        assert_eq!((predicted / truth - 1.0).abs() < 1e-9, known, "{predicted} {truth}");
        assert!((rough / predicted - 1.0).abs() < 0.2, "{rough} {predicted}");
        let now = observer.modes()[0].phase[0];
        assert_eq!(observer.predict(0.0, pulses), [now]);
    }
}

#[test]
fn still_modes_teach_no_frequency() {
    let mut noise = flexsc_numerics::random::Seed { scenario: 5, run: 0 }.stream("sensor");
    let noise: Vec<f64> = (0..1500).map(|_| 2e-6 * noise.normal()).collect();
    let drift = |gate: f64| {
        let spec = Gradient {
            gate: flexsc_numerics::quantity::Positive::new(gate).expect("positive"),
            ..Gradient::default()
        };
        let mut observer = spec.observer(&[tracker(0.25, 2.0)], &[1.0], CYCLE);
        for y in &noise {
            observer.update(*y);
            observer.advance(&[]);
        }
        (observer.modes()[0].frequency / (2.0 * PI) / 0.25 - 1.0).abs()
    };
    assert!(drift(5e-6) < 1e-12);
    assert!(drift(1e-12) > 0.03, "{}", drift(1e-12));
}

/// Reading of a gyro at a sample.
type Measured = fn(usize) -> f64;

#[test]
fn nonsense_is_never_passed_on() {
    let nonsense: [(&str, Measured); 8] = [
        ("NaN", |_| f64::NAN),
        ("infinite", |_| f64::INFINITY),
        ("huge", |_| 1e300),
        ("large", |sample| if sample % 2 == 0 { 4.0 } else { -4.0 }),
        ("stuck", |_| 1e-3),
        ("stuck at nothing", |_| 0.0),
        (
            "now and then",
            |sample| if sample % 7 == 0 { f64::NAN } else { 1e-4 * libm::sin(0.3 * sample as f64) },
        ),
        ("resonant", |sample| libm::sin(0.25 * sample as f64)),
    ];
    for (name, y) in nonsense {
        for observer in [&mut gradient(0.3, 1.2) as &mut dyn AdaptiveObserver, &mut recurrence(0.3, 1.2)] {
            for cycle in 0..3000 {
                observer.update(y(cycle));
                let mut pulses = burst(cycle);
                pulses.push(Pulse { input: 0, acceleration: f64::NAN, start: 0.0, duration: CYCLE });
                pulses.push(Pulse { input: 9, acceleration: 1.0, start: 0.0, duration: CYCLE });
                observer.advance(&pulses);
                let (mode, residual) = (observer.modes().remove(0), observer.residual());
                let [g, s] = mode.phase;
                let numbers = [
                    g,
                    s,
                    mode.frequency,
                    mode.influence[0],
                    observer.rate(),
                    residual.elastic,
                    residual.innovation,
                ];
                assert!(numbers.iter().all(|n| n.is_finite()), "{name} {cycle}: {numbers:?}");
                assert!((0.3..4.0).contains(&mode.frequency), "{name} {cycle}: {mode:?}");
                assert!(observer.predict(0.3, &pulses)[0].is_finite(), "{name} {cycle}");
            }
        }
    }
    // An observer without samples is not trusted; one in lock is.
    let mut observer = gradient(0.3, 1.2);
    for (cycle, y) in measured().into_iter().enumerate() {
        observer.update(if cycle < 1200 { y } else { f64::NAN });
        observer.advance(&burst(cycle));
        let trusted = observer.residual().is_below(0.1, 3e-6);
        assert!(!(100..1200).contains(&cycle) || trusted, "{cycle}: {:?}", observer.residual());
        assert!(cycle < 1210 || !trusted, "{cycle}: {:?}", observer.residual());
    }
}

#[test]
fn amplitudes_near_a_bound_are_compared_by_their_roots() {
    let bound = 5e-6;
    for share in [0.0, 0.5, 1.0 - 1e-15, 1.0, 1.0 + 1e-15, 2.0, 1e150, f64::INFINITY, f64::NAN] {
        for angle in 0..16 {
            let (sin, cos) = libm::sincos(f64::from(angle) * PI / 8.0);
            let phase = [share * bound * cos, share * bound * sin];
            assert_eq!(is_above(&phase, bound), libm::hypot(phase[0], phase[1]) > bound, "{share} {angle}");
        }
    }
    // The square of such a bound vanishes.
    assert!(is_above(&[2e-200, 0.0], 1e-200) && !is_above(&[5e-201, 0.0], 1e-200));
}
