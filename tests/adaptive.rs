//! The adaptive observers over many runs: success rate and speed of the identification of a channel's modes.
//!
//! `flexsc identify` prints the whole table, 100 runs a row.

use std::f64::consts::{PI, TAU};

use flexsc_core::analysis::identification::IdentificationTrial;
use flexsc_core::control::estimator::adaptive::{
    AdaptiveObserver, Gradient, ModeVector, OscillatorModel, Pulse, Recurrence, Tracker, merge,
};
use flexsc_core::numerics::quantity::{Finite, Frequency, NonNegative};
use flexsc_core::numerics::random::{Seed, Stream};

use crate::study::pairs;
use crate::util::Dir;

const CYCLE: f64 = 0.2;
/// Acceleration of the channel's own thrusters (rad/s²).
const ACCELERATION: f64 = 2.05e-5;
/// Standard deviation of the gyro's noise, and its resolution (rad/s).
const NOISE: (f64, f64) = (2e-6, 1e-6);

fn hertz(hertz: f64) -> Frequency {
    Frequency::new(2.0 * PI * hertz).expect("a frequency")
}

fn mode(at: f64, influence: &[f64], bounds: Option<[f64; 2]>) -> Tracker {
    let influence = influence.iter().map(|i| Finite::new(*i).expect("finite")).collect();
    Tracker { frequency: hertz(at), influence, bounds: bounds.map(|bounds| bounds.map(hertz)) }
}

/// Channel of a spacecraft: exactly simulated modes, each of which every input excites.
struct Channel {
    modes: Vec<(OscillatorModel, Vec<f64>)>,
    rigid: Vec<f64>,
    rate: f64,
    phases: Vec<ModeVector>,
}

impl Channel {
    /// Modes by their frequency (Hz) and influences.
    fn new(modes: &[(f64, Vec<f64>)], rigid: &[f64]) -> Self {
        let of = |hertz: f64| OscillatorModel { frequency: 2.0 * PI * hertz, damping: 0.005 };
        Self {
            modes: modes.iter().map(|(hertz, influence)| (of(*hertz), influence.clone())).collect(),
            rigid: rigid.to_vec(),
            rate: 0.0,
            phases: vec![[0.0; 2]; modes.len()],
        }
    }

    fn elastic(&self) -> f64 {
        self.phases.iter().map(|phase| phase[0]).sum()
    }

    fn measured(&self, noise: &mut Stream) -> f64 {
        let y = self.rate + self.elastic() + NOISE.0 * noise.normal();
        (y / NOISE.1).round() * NOISE.1
    }

    fn advance(&mut self, pulses: &[Pulse]) {
        for (phase, (of, influence)) in self.phases.iter_mut().zip(&self.modes) {
            *phase = of.propagate(&of.transition(CYCLE), CYCLE, *phase).0;
            for Pulse { input, acceleration, start, duration } in pulses {
                let push = of.pulse_response(CYCLE - start, CYCLE - start - duration).0;
                *phase = [0, 1].map(|axis| phase[axis] + influence[*input] * acceleration * push[axis]);
            }
        }
        self.rate += pulses.iter().map(|p| self.rigid[p.input] * p.acceleration * p.duration).sum::<f64>();
    }
}

/// Random bursts of one to ten cycles, with a random sign and random pauses.
struct Bursts {
    draws: Stream,
    left: usize,
    wait: usize,
    acceleration: f64,
}

impl Bursts {
    fn new(run: u64, name: &str) -> Self {
        let draws = Seed { scenario: 1, run }.stream(name);
        Self { draws, left: 0, wait: 0, acceleration: 0.0 }
    }

    /// Returns the pulse of the next cycle; `None` within a pause.
    fn next(&mut self, input: usize, acceleration: f64, pause: usize) -> Option<Pulse> {
        if self.left == 0 && self.wait > 0 {
            self.wait -= 1;
        } else if self.left == 0 {
            self.left = 1 + self.draws.index(10);
            self.acceleration = if self.draws.uniform() < 0.5 { -acceleration } else { acceleration };
            self.wait = self.draws.index(pause);
        }
        (self.left > 0).then(|| {
            self.left -= 1;
            Pulse { input, acceleration: self.acceleration, start: 0.0, duration: CYCLE }
        })
    }
}

fn error(found: f64, exact: f64) -> f64 {
    (found / exact - 1.0).abs()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

#[test]
fn modes_are_found_over_random_runs() {
    // Of each set in hertz, the fewest of 12 runs that converge, and limits of the median time, frequency and influence
    // error.
    let sets = [
        (vec![(0.2476, 2.89)], 0.02, 12, [12.0, 14.0, 18.0, 24.0], 4e-4, 0.02),
        (vec![(0.2476, 2.89), (0.6, 3.0)], 0.02, 12, [22.0, 22.0, 30.0, 45.0], 5e-4, 0.03),
        (vec![(0.2, 2.0), (0.5, 3.0), (1.1, 3.0)], 0.02, 11, [30.0, 30.0, 60.0, 130.0], 7e-4, 0.03),
        (vec![(0.48, 2.0), (0.6, 3.0)], 0.02, 11, [50.0, 50.0, 50.0, 60.0], 6e-4, 0.03),
        (vec![(0.55, 3.0), (0.605, 3.0)], 0.01, 10, [60.0, 60.0, 90.0, 120.0], 2e-3, 0.08),
    ];
    for (modes, rate, fewest, times, frequency, influence) in sets {
        for (off, longest) in [0.05, 0.1, 0.2, 0.3].into_iter().zip(times) {
            let mut trial = IdentificationTrial::published(
                modes.iter().map(|(at, mu)| (2.0 * PI * at, *mu)).collect(),
                off,
            );
            trial.observer.rate = NonNegative::new(rate).expect("a rate");
            let row = trial.table(12);
            assert!(
                row.converged >= fewest && row.time_median_s.expect("a time") <= longest,
                "{modes:?} {row:?}"
            );
            assert!(row.frequency_error.expect("an error") <= frequency, "{modes:?} {row:?}");
            assert!(row.influence_error.expect("an error") <= influence, "{modes:?} {row:?}");
        }
    }
}

#[test]
fn the_command_tells_how_often_modes_are_found() {
    let dir = Dir::new();
    let reported = dir.run("identify --modes 1.556:2.89 --off 0.1,0.3 --runs 12 --json").exits(0).json();
    let rows = reported["rows"].as_array().expect("rows");
    assert_eq!(rows.len(), 2);
    let trial = IdentificationTrial::published(vec![(1.556, 2.89)], 0.3);
    // Passed through JSON text, whose numbers are exact to the last place but one.
    let exact = serde_json::json!(trial.table(12)).to_string();
    let exact: serde_json::Value = serde_json::from_str(&exact).expect("JSON");
    assert_eq!(rows[1]["found"], exact);
    dir.run("identify --modes 1.556:2.89 --off 0.1 --runs 12 --figures drawn --format svg")
        .exits(0)
        .says(&["0.2476      10     12       12"]);
    let drawn = dir.text("drawn/identification.svg");
    assert!(drawn.contains("0.2476 Hz, 10 % off") && drawn.contains("found (%)"));
    // Two modes that no run of 300 s distinguishes.
    let near = IdentificationTrial::published(vec![(TAU * 0.6049, 1.5), (TAU * 0.6096, 1.6)], 0.05).table(4);
    let apart = IdentificationTrial::published(vec![(TAU * 0.2476, 2.89), (TAU * 0.6, 3.0)], 0.05).table(4);
    // Of 1, which orthogonal motions would have: 0.02 and 0.90.
    assert!(near.persistence.expect("excited") < 0.05 && apart.persistence.expect("excited") > 0.85);
    for (bad, why) in [
        ("identify --modes 1.2", "must be W:MU,W:MU"),
        ("identify --modes 20:1", "got 20"),
        ("identify --modes 1.2:0", "other than 0"),
        ("identify --off 1.5", "must be off by 0 to 1, got 1.5"),
        ("identify --influence-off -1", "--influence-off: the modes must be off by 0 to 1, got -1"),
        ("identify --runs 0", "0 is not in"),
    ] {
        dir.run(bad).exits(2).says(&[why]);
    }
}

/// Returns bursts of ten cycles in every 65, with alternating signs.
fn regular(cycle: usize) -> Vec<Pulse> {
    let acceleration = if (cycle / 65).is_multiple_of(2) { ACCELERATION } else { -ACCELERATION };
    let pulse = Pulse { input: 0, acceleration, start: 0.0, duration: CYCLE };
    if (5..15).contains(&(cycle % 65)) { vec![pulse] } else { Vec::new() }
}

#[test]
fn basin_of_attraction_of_one_mode() {
    let wide = [0.1, 10.0].map(|bound| NonNegative::new(bound).expect("0 or more"));
    let found = |observer: &mut dyn AdaptiveObserver| {
        let mut channel = Channel::new(&[(0.2, vec![2.0])], &[1.0]);
        for cycle in 0..1500 {
            observer.update(channel.rate + channel.elastic());
            observer.advance(&regular(cycle));
            channel.advance(&regular(cycle));
        }
        observer.modes()[0].frequency / (2.0 * PI)
    };
    for at in [0.06, 0.1, 0.15, 0.3, 0.4, 0.5, 0.6, 0.8] {
        let start = mode(at, &[1.2], Some([0.03, 1.2]));
        let spec = Gradient { influence_bounds: wide, ..Gradient::default() };
        let gradient = found(&mut spec.observer(std::slice::from_ref(&start), &[1.0], CYCLE));
        assert_eq!(error(gradient, 0.2) < 0.002, at < 0.55, "gradient from {at}: {gradient} Hz");
        let recurrence = found(&mut Recurrence::default().observer(&start, CYCLE));
        assert!(error(recurrence, 0.2) < 0.012, "recurrence from {at}: {recurrence} Hz");
    }
}

/// Root mean square of a sequence.
fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt()
}

#[test]
fn one_tracker_follows_a_near_pair() {
    let pair = [(0.6049, vec![1.4]), (0.6096, vec![1.7])];
    let merged = merge(&[mode(0.6049, &[1.4], None), mode(0.6096, &[1.7], None)], 0.08);
    assert_eq!(merged.len(), 1);
    let mut found = Vec::new();
    for run in 0..6 {
        let mut start = [merged[0].tracker.clone()];
        start[0].frequency = Frequency::new(1.1 * start[0].frequency.get()).expect("a frequency");
        let mut observer = Gradient::default().observer(&start, &[1.0], CYCLE);
        let mut channel = Channel::new(&pair, &[1.0]);
        let (mut bursts, mut noise) = (Bursts::new(run, "bursts"), Seed { scenario: 1, run }.stream("noise"));
        let (mut wrong, mut elastic) = (Vec::new(), Vec::new());
        for cycle in 0..1500 {
            observer.update(channel.measured(&mut noise));
            if cycle >= 750 {
                wrong.push(observer.modes()[0].phase[0] - channel.elastic());
                elastic.push(channel.elastic());
            }
            let pulses: Vec<Pulse> = bursts.next(0, ACCELERATION, 20).into_iter().collect();
            observer.advance(&pulses);
            channel.advance(&pulses);
        }
        let mode = observer.modes().remove(0);
        let hertz = mode.frequency / (2.0 * PI);
        assert!((0.600..0.613).contains(&hertz), "{hertz}");
        // Over the six runs the errors are 1 % to 4 %: a pair has no influence of its own.
        assert!(error(mode.influence[0], 3.1) < 0.05, "{:?}", mode.influence);
        found.push(rms(&wrong) / rms(&elastic));
    }
    assert!(median(found.clone()) < 0.025, "{found:?}");
}

/// Returns the observer's relative errors, and the largest error of a frequency, of a roll channel whose modes yaw
/// thrusters excite too, without and with these thrusters as an input.
fn beside_yaw(run: u64) -> [(f64, f64); 2] {
    // The station's modes of 0.605 and 0.773 Hz: influence of the roll and of the yaw thrusters.
    let modes = [(0.605, vec![0.90, 1.08]), (0.7733, vec![7.55, -1.34])];
    let (roll, yaw) = (8.40e-6, 2.05e-5);
    [1, 2].map(|inputs| {
        let start: Vec<Tracker> =
            modes.iter().map(|(at, influence)| mode(0.95 * at, &influence[..inputs], None)).collect();
        let mut observer = Gradient::default().observer(&start, &[1.0, 0.0][..inputs], CYCLE);
        let mut channel = Channel::new(&modes, &[1.0, 0.0]);
        let mut groups = [Bursts::new(run, "roll"), Bursts::new(run, "yaw")];
        let mut noise = Seed { scenario: 1, run }.stream("noise");
        let (mut wrong, mut elastic, mut worst) = (Vec::new(), Vec::new(), 0.0_f64);
        for cycle in 0..3000 {
            observer.update(channel.measured(&mut noise));
            if cycle >= 1500 {
                let found = observer.modes();
                wrong.push(found.iter().map(|mode| mode.phase[0]).sum::<f64>() - channel.elastic());
                elastic.push(channel.elastic());
                for (mode, (at, _)) in pairs(found.iter(), &modes) {
                    worst = worst.max(error(mode.frequency, 2.0 * PI * at));
                }
            }
            let [first, second] = &mut groups;
            let pulses: Vec<Pulse> =
                [first.next(0, roll, 60), second.next(1, yaw, 20)].into_iter().flatten().collect();
            observer.advance(&pulses);
            channel.advance(&pulses);
        }
        (rms(&wrong) / rms(&elastic), worst)
    })
}

#[test]
fn thrusters_of_other_axes_do_not_deceive() {
    for run in 0..6 {
        let [(without, strayed), (with, kept)] = beside_yaw(run);
        assert!(with < 0.1 && kept < 0.01, "run {run}: {with}, {kept}");
        assert!(without > 3.0 * with, "run {run}: {without} without, {with} with");
        assert!(strayed > 2.0 * kept, "run {run}: {strayed} without, {kept} with");
    }
}
