//! Success rate and speed of an adaptive observer's identification of a channel's modes: many runs under random
//! thruster bursts.
//!
//! The channel has an exactly simulated rigid rate and modes (\[Timakov14\], page 46, has such an example); the gyro
//! has noise and a resolution. The initial estimates have relative errors: each natural frequency by `off[0]`, up or
//! down, and each influence by `off[1]`.

use flexsc_control::estimator::adaptive::{
    AdaptiveObserver, Gradient, ModeVector, OscillatorModel, Pulse, Tracker, bounds,
};
use flexsc_numerics::quantity::{Finite, Frequency};
use flexsc_numerics::random::{Seed, Stream};
use rayon::prelude::*;
use serde::Serialize;

use super::damping::Excitation;
use flexsc_scenario::Cost;

/// Cycle of the station's computer (s).
pub const CYCLE: f64 = 0.2;
/// Relative error below which a frequency counts as identified.
const BAND: f64 = 0.02;
/// Lengths of the longest burst, and of the longest pause after it (cycles).
const BURST: usize = 10;
const PAUSE: usize = 20;

/// Identification experiment: a channel, its thrusters, its gyro and its observer.
#[derive(Clone, Debug)]
pub struct IdentificationTrial {
    /// Natural frequency (rad/s) and influence of each mode.
    pub modes: Vec<(f64, f64)>,
    /// Observer, with the damping ratio of the modes.
    pub observer: Gradient,
    /// Relative errors of frequencies and influences at the start.
    pub off: [f64; 2],
    /// Rigid acceleration of the thrusters (rad/s²).
    pub acceleration: f64,
    /// Standard deviation of the gyro's noise, and its resolution (rad/s).
    pub gyro: [f64; 2],
    /// Duration of a cycle (s).
    pub cycle: f64,
    /// Number of cycles of a run.
    pub cycles: u32,
    /// Seed of all runs.
    pub seed: u64,
}

/// Result of one run.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct RunIdentification {
    /// Last time at which a frequency was off by more than 2 % (s); none if this is the last cycle.
    pub time: Option<f64>,
    /// Relative errors at the end: of the frequency that is furthest off, and of the influence that is.
    pub errors: [f64; 2],
    /// Persistence of excitation over the run; none if a parameter was never excited.
    pub persistence: Option<f64>,
}

/// Results of many runs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct IdentificationRow {
    /// Relative error of the frequencies at the start.
    pub off: f64,
    /// Number of runs.
    pub runs: u64,
    /// Number of runs that converged.
    pub converged: u64,
    /// Median of the times in which runs converged (s); none if no run did.
    pub time_median_s: Option<f64>,
    /// Longest of the times in which runs converged (s); none if no run did.
    pub time_longest_s: Option<f64>,
    /// Median relative error of the frequencies at the end.
    pub frequency_error: Option<f64>,
    /// Median relative error of the influences at the end.
    pub influence_error: Option<f64>,
    /// Median persistence of excitation over a run: where it is near 0, the measurements do not distinguish the modes.
    pub persistence: Option<f64>,
    /// Times in which the runs converged (s), in the order of the runs.
    pub times_s: Vec<f64>,
}

impl IdentificationTrial {
    /// Returns the experiment with the channel of the study behind \[Timakov14\]'s scenarios: yaw of the station, 300
    /// s.
    pub fn published(modes: Vec<(f64, f64)>, off: f64) -> Self {
        Self {
            modes,
            observer: Gradient::default(),
            off: [off, 0.4],
            acceleration: 2.05e-5,
            gyro: [2e-6, 1e-6],
            cycle: CYCLE,
            cycles: 1500,
            seed: 1,
        }
    }

    /// Returns the cost of a number of runs of `cycles` cycles; `squared` is the sum of the squares of the numbers of
    /// modes.
    pub fn cost(runs: f64, cycles: u32, squared: f64) -> Cost {
        Cost::from_work("the identification", runs * f64::from(cycles), 1e-7 * (3.0 + squared))
    }

    /// Returns the name of the first number that is out of range, and the reason.
    pub fn inconsistency(&self) -> Option<(&'static str, String)> {
        let highest = std::f64::consts::PI / self.cycle;
        if self.modes.is_empty() {
            return Some(("modes", "must have a mode".to_owned()));
        }
        for (w, mu) in &self.modes {
            if Frequency::new(*w).is_none() || *w >= highest {
                let why = format!(
                    "must have frequencies between 1e-4 rad/s and {highest:.4} rad/s, half of what the cycle samples, got {w}"
                );
                return Some(("modes", why));
            }
            if !mu.is_finite() || *mu == 0.0 {
                return Some(("modes", format!("must have influences other than 0, got {mu}")));
            }
        }
        let mut parts = ["off", "influence_off"].into_iter().zip(self.off);
        let wrong = parts.find(|(_, part)| !(0.0..1.0).contains(part));
        wrong.map(|(name, part)| (name, format!("must be off by 0 to 1, got {part}")))
    }

    /// Simulates the run of a number.
    pub fn run(&self, number: u64) -> RunIdentification {
        let seed = Seed { scenario: self.seed, run: number };
        let mut observer =
            self.observer.observer(&self.start(&mut seed.stream("errors")), &[1.0], self.cycle);
        let mut channel = SimulatedChannel::new(self);
        let (mut bursts, mut noise) = (ThrusterBursts::new(seed), seed.stream("noise"));
        let mut excitation = Excitation::new(observer.sensitivities().len());
        let mut last = 0;
        for cycle in 0..self.cycles {
            excitation.add(&observer.sensitivities());
            observer.update(channel.measured(self.gyro, &mut noise));
            let found = observer.modes();
            if found.iter().zip(&self.modes).any(|(mode, (w, _))| off(mode.frequency, *w) > BAND) {
                last = cycle;
            }
            let pulse = bursts.next(self.acceleration, self.cycle);
            observer.advance(pulse.as_slice());
            channel.advance(pulse, self.cycle);
        }
        let mut errors = [0.0_f64; 2];
        for (mode, (w, mu)) in observer.modes().iter().zip(&self.modes) {
            errors[0] = errors[0].max(off(mode.frequency, *w));
            errors[1] = errors[1].max(off(mode.influence[0], *mu));
        }
        let time = (last + 1 < self.cycles).then_some(f64::from(last) * self.cycle);
        RunIdentification { time, errors, persistence: excitation.persistence() }
    }

    /// Simulates runs on the threads of the current rayon pool, and returns their summary.
    pub fn table(&self, runs: u64) -> IdentificationRow {
        self.row(&(0..runs).into_par_iter().map(|number| self.run(number)).collect::<Vec<_>>())
    }

    /// Returns the summary of the results of runs.
    pub fn row(&self, found: &[RunIdentification]) -> IdentificationRow {
        let converged: Vec<&RunIdentification> = found.iter().filter(|found| found.time.is_some()).collect();
        let mut times_s: Vec<f64> = converged.iter().filter_map(|found| found.time).collect();
        times_s.sort_by(f64::total_cmp);
        let error = |kind: usize| median(converged.iter().map(|found| found.errors[kind]).collect());
        IdentificationRow {
            off: self.off[0],
            runs: found.len() as u64,
            converged: converged.len() as u64,
            time_median_s: median(times_s.clone()),
            time_longest_s: times_s.last().copied(),
            frequency_error: error(0),
            influence_error: error(1),
            persistence: median(found.iter().filter_map(|found| found.persistence).collect()),
            times_s,
        }
    }

    /// Returns the initial estimates: they stay within the intervals of the design, so the spacecraft itself is taken
    /// to be off.
    fn start(&self, draws: &mut Stream) -> Vec<Tracker> {
        let mut sign = |size: f64| if draws.uniform() < 0.5 { 1.0 - size } else { 1.0 + size };
        let valid = |w: f64| Frequency::new(w).expect("a mode's frequency is one, and so are its bounds");
        let tracker = |w: f64, mu: f64, bounds: Option<[Frequency; 2]>| Tracker {
            frequency: valid(w),
            influence: vec![Finite::new(mu).unwrap_or_default()],
            bounds,
        };
        let design: Vec<Tracker> = self.modes.iter().map(|(w, mu)| tracker(*w, *mu, None)).collect();
        let intervals = bounds(&design, self.observer.reach.get(), self.cycle);
        let start = |((w, mu), [low, high]): (&(f64, f64), [f64; 2])| {
            let frequency = (w * sign(self.off[0])).clamp(1.001 * low, 0.999 * high);
            tracker(frequency, mu * sign(self.off[1]), Some([low, high].map(valid)))
        };
        self.modes.iter().zip(intervals).map(start).collect()
    }
}

/// State of the simulated channel.
struct SimulatedChannel {
    modes: Vec<(OscillatorModel, f64)>,
    rate: f64,
    phases: Vec<ModeVector>,
}

impl SimulatedChannel {
    fn new(trial: &IdentificationTrial) -> Self {
        let damping = trial.observer.damping.get();
        let modes = trial.modes.iter().map(|(w, mu)| (OscillatorModel { frequency: *w, damping }, *mu));
        Self { modes: modes.collect(), rate: 0.0, phases: vec![[0.0; 2]; trial.modes.len()] }
    }

    fn measured(&self, [noise, resolution]: [f64; 2], draws: &mut Stream) -> f64 {
        let y = self.rate + self.phases.iter().map(|phase| phase[0]).sum::<f64>() + noise * draws.normal();
        if resolution > 0.0 { libm::round(y / resolution) * resolution } else { y }
    }

    fn advance(&mut self, pulse: Option<Pulse>, cycle: f64) {
        for (phase, (oscillator, influence)) in self.phases.iter_mut().zip(&self.modes) {
            *phase = oscillator.propagate(&oscillator.transition(cycle), cycle, *phase).0;
            if let Some(Pulse { acceleration, start, duration, .. }) = pulse {
                let push = oscillator.pulse_response(cycle - start, cycle - start - duration).0;
                *phase = [0, 1].map(|part| phase[part] + influence * acceleration * push[part]);
            }
        }
        self.rate += pulse.map_or(0.0, |pulse| pulse.acceleration * pulse.duration);
    }
}

/// Random thruster bursts of one to ten cycles, with a random sign and random pauses.
struct ThrusterBursts {
    draws: Stream,
    remaining: usize,
    wait: usize,
    sign: f64,
}

impl ThrusterBursts {
    fn new(seed: Seed) -> Self {
        Self { draws: seed.stream("bursts"), remaining: 0, wait: 0, sign: 1.0 }
    }

    /// Returns the pulse of the next cycle; `None` within a pause.
    fn next(&mut self, acceleration: f64, cycle: f64) -> Option<Pulse> {
        if self.remaining == 0 && self.wait > 0 {
            self.wait -= 1;
        } else if self.remaining == 0 {
            self.remaining = 1 + self.draws.index(BURST);
            self.sign = if self.draws.uniform() < 0.5 { -1.0 } else { 1.0 };
            self.wait = self.draws.index(PAUSE);
        }
        (self.remaining > 0).then(|| {
            self.remaining -= 1;
            Pulse { input: 0, acceleration: self.sign * acceleration, start: 0.0, duration: cycle }
        })
    }
}

/// Returns the relative error of a value.
fn off(found: f64, exact: f64) -> f64 {
    (found / exact - 1.0).abs()
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}
