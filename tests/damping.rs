//! Active damping in closed form, against simulations of a mode under a relay and independent computations.
//!
//! Golden numbers beside those of the simulations here: tests/golden/damping_oracle.py, NumPy and SciPy.

use std::f64::consts::PI;

use flexsc_core::analysis::damping::{Decay, PulsedDamping};
use flexsc_core::control::actuator::PulseTiming;
use flexsc_core::control::estimator::adaptive::{ModeVector, OscillatorModel};
use flexsc_core::numerics::delay_margin::delay_margin;

use crate::study::{close, pairs};
use crate::util::{Dir, table};

const TURN: f64 = 2.0 * PI;
const CYCLE: f64 = 0.2;
/// Elastic acceleration of the yaw thrusters on their dominant mode (rad/s²).
const YAW: f64 = 5.908_32e-5;

fn relay(delay: f64, on_time: f64) -> PulseTiming {
    PulseTiming { period: CYCLE, delay, on_time }
}

/// The amplitude of a mode's rate at each sample under a relay with a push over the whole cycle, exact.
fn amplitudes(
    hertz: f64,
    damping: f64,
    acceleration: f64,
    start: ModeVector,
    late: usize,
    count: usize,
) -> Vec<f64> {
    let of = OscillatorModel { frequency: TURN * hertz, damping };
    let (transition, push) = (of.transition(CYCLE), of.pulse_response(CYCLE, 0.0).0);
    let (mut phase, mut queue) = (start, vec![0.0; late]);
    let sample = |_| {
        let amplitude = phase[0].hypot(phase[1]);
        queue.push(if phase[0] > 0.0 { -acceleration } else { acceleration });
        let now = queue.remove(0);
        phase = of.propagate(&transition, CYCLE, phase).0;
        phase = [0, 1].map(|axis| phase[axis] + now * push[axis]);
        amplitude
    };
    (0..count).map(sample).collect()
}

#[test]
fn phase_factor_is_the_mean_fall_of_the_amplitude() {
    // (frequency in Hz, cycles of delay, slope for 1e-6 rad/s², how far a simulation may be off).
    let exact = [
        (0.137, 0, -6.3348e-7, 0.003),
        (0.137, 1, -6.1475e-7, 0.003),
        (0.711, 0, -5.5524e-7, 0.01),
        (0.711, 1, -1.4071e-7, 0.01),
        (1.1, 0, -4.5239e-7, 0.01),
        (1.1, 1, 2.8285e-7, 0.01),
    ];
    for (hertz, late, slope, off) in exact {
        let relay = relay(CYCLE * late as f64, CYCLE);
        let decay = Decay::new(1e-6 * relay.phase_factor(TURN * hertz), 0.0);
        close(-decay.slope, slope, 2e-4);
        // 60 periods from an amplitude that stays large, over eight phases.
        let count = (60.0 / (hertz * CYCLE)).round() as usize;
        let fall = |eighth: f64| {
            let start = [1e-3 * (PI * eighth / 4.0).cos(), 1e-3 * (PI * eighth / 4.0).sin()];
            let all = amplitudes(hertz, 0.0, 1e-6, start, late, count + 1);
            let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
            let half = all.len() / 2;
            (mean(&all[half..2 * half]) - mean(&all[..half])) / (CYCLE * half as f64)
        };
        let mean = (0..8).map(|eighth| fall(f64::from(eighth))).sum::<f64>() / 8.0;
        close(mean, slope, off);
    }
}

#[test]
fn a_relay_damps_up_to_a_limit() {
    // A pure delay; a push over the whole cycle, at once and one cycle late (Hz).
    let pure = PulseTiming { period: 0.0, delay: CYCLE, on_time: 0.0 };
    for (relay, hertz) in
        [(pure, 1.25), (relay(0.0, CYCLE), 2.5), (relay(CYCLE, CYCLE), 5.0 / 6.0), (relay(CYCLE, 0.1), 1.0)]
    {
        let limit = relay.frequency_limit();
        close(limit, TURN * hertz, 1e-14);
        assert!((relay.delay_limit(limit) - relay.delay).abs() < 1e-14);
        assert!(relay.phase_factor(0.99 * limit) > 0.0 && relay.phase_factor(1.01 * limit) < 0.0);
    }
    assert!((PulseTiming { period: 0.0, delay: 0.0, on_time: 0.0 }).frequency_limit().is_infinite());
    close(relay(0.0, 0.1).phase_factor(1e-9), 0.5, 1e-12);
}

#[test]
fn delayed_feedback_is_stable_up_to_a_gain() {
    // (frequency in Hz, delay, damping ratio, gain).
    let exact = [
        (0.2, 0.2, 0.005, 7.661_340_901),
        (0.5, 0.2, 0.005, 6.6249),
        (0.8, 0.2, 0.005, 4.7123),
        (1.0, 0.2, 0.005, 2.999_018_284),
        (1.2, 0.2, 0.005, 1.2075),
        (1.25, 0.2, 0.005, 0.876_52),
        (1.3, 0.2, 0.005, 0.641_42),
        (1.5, 0.2, 0.005, 0.281_885_716),
        (0.8, 1.0, 0.05, 1.498_076_840),
        (2.3, 1.0, 0.05, 1.845_574_130),
        (3.0, 1.5, 0.1, 3.769_911_184),
    ];
    for (hertz, delay, damping, gain) in exact {
        let border = delay_margin(TURN * hertz, delay, damping).expect("a border");
        let digits = if gain.to_string().len() > 8 { 1e-8 } else { 1e-4 };
        close(border.gain, gain, digits);
        // The characteristic equation holds at i y.
        let (w, y, k) = (TURN * hertz, border.frequency, border.gain);
        let real = w * w - y * y + k * y * (y * delay).sin();
        let imaginary = 2.0 * damping * w * y + k * y * (y * delay).cos();
        assert!(real.abs() < 1e-11 * w * w && imaginary.abs() < 1e-11 * w * w, "{hertz}: {real} {imaginary}");
    }
    assert_eq!(delay_margin(1.0, 0.0, 0.01), None);
    // Without damping a delay of more than a quarter of a period makes every gain unstable.
    assert!(delay_margin(TURN, 0.3, 0.0).expect("a border").gain < 1e-12);
    close(delay_margin(TURN, 0.2, 0.0).expect("a border").gain, 2.5 * PI - TURN * TURN / (2.5 * PI), 1e-12);
    // The search ends also for far intervals and long delays.
    assert!(delay_margin(1e3, 1e3, 0.3).expect("a border").gain >= 600.0 * (1.0 - 1e-12));
}

/// The delay equation x'' + 2 zeta w x' + w² x + k x'(t - h) = 0 by steps, the delayed rate held over a thousandth of h
/// and that half step made up for: the amplitude at the end, of one at the start.
fn delayed(frequency: f64, delay: f64, damping: f64, gain: f64, time: f64) -> f64 {
    let steps = 1000_usize;
    let step = delay / steps as f64;
    let of = OscillatorModel { frequency, damping };
    let (transition, push) = (of.transition(step), of.pulse_response(step, 0.0).0);
    let mut past = vec![0.0; steps];
    let (mut phase, mut late) = ([1.0, 0.0], 0.0);
    for index in 0..(time / step) as usize {
        let held = past[index % steps];
        past[index % steps] = phase[0];
        let mean = 1.5 * held - 0.5 * late;
        late = held;
        phase = of.propagate(&transition, step, phase).0;
        phase = [0, 1].map(|axis| phase[axis] - gain * mean * push[axis]);
    }
    phase[0].hypot(phase[1])
}

#[test]
fn beyond_that_gain_the_delay_equation_grows() {
    let limit = delay_margin(TURN, 0.2, 0.005).expect("a border").gain;
    let after = |part: f64| {
        delayed(TURN, 0.2, 0.005, part * limit, 60.0) / delayed(TURN, 0.2, 0.005, part * limit, 20.0)
    };
    // Within 40 s the amplitude falls to 0.53 of itself, or doubles.
    assert!(after(0.97) < 0.55 && after(1.03) > 2.0, "{} {}", after(0.97), after(1.03));
}

#[test]
fn a_relay_brings_a_mode_to_rest() {
    // Continuous, without damping: a = 4.6e-5 rad/s², from 1e-3 rad/s at 0.2 Hz.
    let decay = Decay::new(4.6e-5, 0.0);
    close(decay.threshold_time(1e-3, 0.0).expect("there"), 34.148, 1e-4);
    close(1e-3 - decay.amplitude(1e-3, 5.0), 1.464_23e-4, 1e-5);
    close(decay.threshold_time(1e-3, 1e-4).expect("there"), 33.98, 2e-4);
    close(decay.thrust_time(1e-3, 1e-4).expect("there"), 26.80, 5e-4);
    let halfway = decay.amplitude_above(1e-3, 1e-4, 17.0);
    close(decay.threshold_time(halfway, 1e-4).expect("there"), 33.976_578_5 - 17.0, 1e-7);
    close(Decay::duty(1e-3, 1e-4), 1.0 - (0.1_f64).asin() / (0.5 * PI), 1e-12);
    // With damping and a threshold: an integral.
    let damped = Decay { slope: 2e-5, rate: 0.01 };
    close(damped.threshold_time(5e-4, 1e-4).expect("there"), 20.857_400_073, 1e-9);
    close(
        damped.threshold_time(5e-4, 1e-7).expect("there"),
        damped.threshold_time(5e-4, 0.0).expect("there"),
        1e-3,
    );
    close(damped.thrust_time(5e-4, 1e-4).expect("there"), 13.898_849_477, 1e-9);
    let barely = Decay { slope: 2e-5, rate: 1e-9 };
    let free = Decay { rate: 0.0, ..barely };
    for time in [Decay::threshold_time, Decay::thrust_time] {
        close(time(&barely, 5e-4, 1e-4).expect("there"), time(&free, 5e-4, 1e-4).expect("there"), 1e-7);
    }
    assert_eq!(damped.threshold_time(1e-5, 1e-4), Some(0.0));
    // An amplitude that the relay drives never falls to the threshold.
    let fed = Decay::new(-1e-6, 0.0);
    assert_eq!((fed.threshold_time(1e-4, 1e-5), fed.thrust_time(1e-4, 1e-5)), (None, None));
    close(fed.amplitude(1e-4, 10.0), 1e-4 + 2e-5 / PI, 1e-12);
}

#[test]
fn a_threshold_saves_thrust_as_foreseen() {
    // The relay that reads all the time, 0.2 Hz: steps of 1 ms.
    let of = OscillatorModel { frequency: 0.2 * TURN, damping: 0.0 };
    let step = 1e-3;
    let (transition, push) = (of.transition(step), of.pulse_response(step, 0.0).0);
    let (mut phase, mut thrust, mut time): (ModeVector, f64, f64) = ([1e-3, 0.0], 0.0, 0.0);
    while phase[0].hypot(phase[1]) > 1.001e-4 {
        let fires = phase[0].abs() > 1e-4;
        let now = if fires { -4.6e-5 * phase[0].signum() } else { 0.0 };
        thrust += if fires { step } else { 0.0 };
        time += step;
        phase = of.propagate(&transition, step, phase).0;
        phase = [0, 1].map(|axis| phase[axis] + now * push[axis]);
        assert!(time < 60.0, "no end");
    }
    let decay = Decay::new(4.6e-5, 0.0);
    assert!((time - decay.threshold_time(1e-3, 1e-4).expect("there")).abs() < 2.5, "{time}");
    close(thrust, decay.thrust_time(1e-3, 1e-4).expect("there"), 0.01);
}

#[test]
fn a_sampled_relay_damps_the_yaw_mode() {
    // (cycles of delay, closed form, exact run from q = 0, how far one run may be off).
    let cases = [
        (
            0,
            [4.1884e-4, 2.9943e-4, 1.8278e-4, 1.0651e-4],
            [4.181_334_74e-4, 2.964_553_95e-4, 1.816_1e-4, 1.048_516_58e-4],
        ),
        (
            1,
            [4.2589e-4, 3.1686e-4, 2.1035e-4, 1.4071e-4],
            [4.332_190_19e-4, 3.207_375_46e-4, 2.119_191_07e-4, 1.367_4e-4],
        ),
    ];
    let (w, zeta) = (0.2476 * TURN, 0.005);
    for (late, closed, exact) in cases {
        let decay = Decay::new(YAW * relay(CYCLE * late as f64, CYCLE).phase_factor(w), zeta * w);
        let runs: Vec<Vec<f64>> = (0..8)
            .map(|eighth| PI * f64::from(eighth) / 4.0)
            .map(|angle| amplitudes(0.2476, zeta, YAW, [5e-4 * angle.cos(), 5e-4 * angle.sin()], late, 51))
            .collect();
        for (index, cycle) in [10_usize, 25, 40, 50].into_iter().enumerate() {
            let foreseen = decay.amplitude(5e-4, CYCLE * cycle as f64);
            close(foreseen, closed[index], 2e-4);
            close(runs[0][cycle], exact[index], 1e-6);
            // The closed form is the mean over all phases between swings and cycles: one phase is off by up
            // to 2.8 %, the mean of eight by up to 1.0 %, and a cycle late by up to 3.7 %.
            close(runs[0][cycle], foreseen, 0.03);
            let mean = runs.iter().map(|run| run[cycle]).sum::<f64>() / 8.0;
            close(mean, foreseen, if late == 0 { 0.01 } else { 0.04 });
        }
    }
}

#[test]
fn a_delayed_relay_ends_in_a_limit_cycle() {
    // (frequency in Hz, acceleration; by the describing function, simulated: rate, frequency in Hz).
    let cases =
        [(0.2476, YAW, 9.95e-6, 1.22e-5, 1.252, 1.247), (0.5119, 1.289e-4, 2.50e-5, 3.00e-5, 1.254, 1.250)];
    for (hertz, acceleration, foreseen, rate, swing, seen) in cases {
        let border = delay_margin(TURN * hertz, 0.2, 0.005).expect("a border");
        close(border.limit_cycle(acceleration), foreseen, 2e-3);
        close(border.frequency, TURN * swing, 1e-3);
        // Steps of 1 ms: the relay reads all the time.
        let of = OscillatorModel { frequency: TURN * hertz, damping: 0.005 };
        let (step, count) = (1e-3, 200_000);
        let (transition, push) = (of.transition(step), of.pulse_response(step, 0.0).0);
        let (mut phase, mut past): (ModeVector, Vec<f64>) = ([5e-5, 0.0], vec![0.0; 200]);
        let (mut largest, mut crossings) = (0.0_f64, Vec::new());
        for index in 0..count {
            let now = std::mem::replace(&mut past[index % 200], -acceleration * phase[0].signum());
            let before = phase[0];
            phase = of.propagate(&transition, step, phase).0;
            phase = [0, 1].map(|axis| phase[axis] + now * push[axis]);
            if index > count / 2 {
                largest = largest.max(phase[0].abs());
                if before < 0.0 && phase[0] >= 0.0 {
                    crossings.push(index as f64 * step);
                }
            }
        }
        let periods = crossings.len() - 1;
        let swings = periods as f64 / (crossings[periods] - crossings[0]);
        close(largest, rate, 0.01);
        close(swings, seen, 0.005);
        // The describing function neglects the harmonics of the relay: its amplitudes are 19 % and 17 %
        // smaller.
        close(border.limit_cycle(acceleration), largest, 0.2);
        close(border.frequency, TURN * swings, 0.01);
    }
}

#[test]
fn the_table_is_written_as_csv() {
    let dir = Dir::new();
    let grid = format!("damping --frequency 0.5:8:4 --delay 0.2 --acceleration {YAW}");
    let ran = dir.run(&format!("{grid} --json -o damping.csv")).exits(0).says(&["damping.csv: 4 rows"]);
    let reported = ran.json();
    let header = "frequency_rad_s,phase_factor,slope_rad_s2,delay_limit_s,gain_limit_1_s,limit_cycle_rate_rad_s,\
                  limit_cycle_frequency_rad_s,decay_s,thrust_s\n";
    assert!(dir.text("damping.csv").starts_with(header));
    let rows = table(&dir, "damping.csv");
    assert_eq!(rows.len(), 4);
    for (row, expected) in pairs(&rows, reported["rows"].as_array().expect("rows")) {
        for (name, cell) in row {
            // Absent numbers, here the time of the decay, are empty cells.
            assert_eq!(cell.parse().ok(), expected[name].as_f64(), "{name}");
        }
    }
}

#[test]
fn the_command_tells_what_a_relay_does() {
    let dir = Dir::new();
    let yaw = format!("--acceleration {YAW} --amplitude 5e-4");
    let reported =
        dir.run(&format!("damping --frequency 1.5557167:1.5557167:1 {yaw} --json")).exits(0).json();
    let row = &reported["rows"][0];
    let number = |name: &str| row[name].as_f64().expect("a number");
    close(reported["frequency_limit_rad_s"].as_f64().expect("a number"), 5.0 * PI, 1e-14);
    // ln(1 + r V0/s)/r
    close(number("decay_s"), 12.846_26, 1e-6);
    close(number("phase_factor"), 0.983_95, 1e-5);
    close(number("thrust_s"), number("decay_s"), 1e-15);
    let pure = format!("damping --frequency 0.5:8:4 --period 0 --delay 0.2 {yaw}");
    dir.run(&pure).exits(0).says(&["all the time, 0.2 s late: damps below 1.25 Hz", "none"]);
    dir.run(&format!("{pure} --threshold 2e-5 --json")).exits(0).prints(&["limit_cycle_rate_rad_s"]);
    dir.run(&format!("{pure} --figures figures --format svg")).exits(0);
    let figure = dir.text("figures/damping.svg");
    for words in ["gain limit", "limit cycle", "natural frequency", "beyond this the relay drives the mode"] {
        assert!(figure.contains(words), "{words}");
    }
    dir.run(&format!("damping --frequency 1:2:2 --period 0 {yaw} --json")).exits(0).prints(&["null"]);
    for (arguments, words) in [
        ("--frequency 1:2:2", "--acceleration"),
        ("--frequency 1:2:2 --acceleration 0", "--acceleration must be a positive number, got 0"),
        (
            "--frequency 1:2:2 --acceleration 1 --on-time 0.3",
            "--on-time must be above 0 and at most the period of 0.2 s, got 0.3",
        ),
        ("--frequency 1:2:2 --acceleration 1 --damping 1", "--damping must be 0 or more and below 1, got 1"),
        ("--frequency 1:2:2 --acceleration 1 --threshold 1", "--amplitude"),
        ("--frequency 1:2:2 --acceleration 1 --period=-1", "--period must be a number of 0 or more, got -1"),
    ] {
        dir.run(&format!("damping {arguments}")).exits(2).says(&[words]);
    }
    let pulsed = PulsedDamping {
        timing: relay(0.0, CYCLE),
        damping: 0.005,
        acceleration: YAW,
        amplitude: 5e-4,
        threshold: 0.0,
    };
    assert_eq!(pulsed.table(&[1.0, 2.0]).len(), 2);
}
