//! Estimate of time, memory and disk space before a computation: infeasible scenarios are rejected, expensive ones need
//! a confirmation.

use flexsc_control::actuator::{ActuatorTask, AssignedMember, UnloadingTask};
use flexsc_control::estimator::EstimatorKind;
use flexsc_control::law::Relay;
use flexsc_dynamics::axis_model::AxisModel;
use flexsc_dynamics::flow::LONGEST_TURN;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::NonNegative;
use flexsc_numerics::time::Span;
use flexsc_record::Detail;
use flexsc_relay_kernel::{SWITCHINGS, shortest_window};

use super::Scenario;
use super::pace::{MACHINE_STEPS, PUSHES, QUIET_STEPS, STEP, SWITCHES, TURNS};

/// Largest number of steps of one kind in a run; more would take days.
pub const MOST_STEPS: f64 = 1e12;
/// Largest number of runs in a campaign, because their results are held in memory.
pub const MOST_RUNS: u64 = 100_000_000;
/// Largest number of modes of a body.
const MOST_MODES: usize = 2000;
/// Largest number of modes that are coupled or estimated by a filter, because their matrices are full.
const MOST_COUPLED: usize = 200;
/// Largest number of commands in the delay line of a wheel.
const MOST_WAITING: f64 = 1e6;

/// Time on one core (s) above which a confirmation is needed.
const LONG_S: f64 = 36_000.0;
/// Time on one core (s) above which the estimate is printed before the work.
const NOTICEABLE_S: f64 = 10.0;
/// Memory (bytes) above which a confirmation is needed.
const MUCH_MEMORY: f64 = 4e9;
/// Disk space for logs (bytes) above which a confirmation is needed.
const MUCH_DISK: f64 = 2e10;

/// Evaluations of the motion within an exposure: constant part, and part per radian of the fastest mode.
const LOOKS: (f64, f64) = (6.0, 1.0);
/// Step (s) below which the torques of the environment are the reason for its length.
const PUSHED_STEP: f64 = 0.01;
/// Number of runs about one axis that take the time of one in SIMD lanes.
const LANES: f64 = 4.5;
/// Memory kept for each run of a campaign (bytes).
const KEPT: f64 = 2e3;
/// Size of a log message (bytes): constant part, and part per mode; compression leaves two thirds of it.
const MESSAGE: (f64, f64) = (200.0, 30.0);

/// Estimated cost of a computation.
#[derive(Clone, Debug, PartialEq)]
pub struct Cost {
    /// Largest contribution: a description, such as a key, and its number of steps.
    pub most: (String, f64),
    /// Number of runs.
    pub runs: f64,
    /// Total time on one core (s).
    pub seconds: f64,
    /// Memory (bytes).
    pub memory: f64,
    /// Disk space for logs (bytes).
    pub disk: f64,
}

impl Cost {
    /// Returns the cost of a computation other than a simulation, of `steps` steps with `step_s` seconds each on one
    /// core.
    pub fn from_work(what: &str, steps: f64, step_s: f64) -> Self {
        Self { most: (what.to_owned(), steps), runs: 1.0, seconds: steps * step_s, memory: 0.0, disk: 0.0 }
    }

    /// Returns the reason why the computation needs a confirmation; `None` if it is within the limits.
    pub fn limit_exceeded(&self) -> Option<String> {
        let Self { seconds, memory, disk, .. } = self;
        let within = *seconds <= LONG_S && *memory <= MUCH_MEMORY && *disk <= MUCH_DISK;
        if within {
            return None;
        }
        let room = if *disk > 0.0 { format!(", {} for logs", bytes(*disk)) } else { String::new() };
        Some(format!(
            "{}, {} of memory{room}, and more than {}, {} or {} must be confirmed",
            self.summary(),
            bytes(*memory),
            time(LONG_S),
            bytes(MUCH_MEMORY),
            bytes(MUCH_DISK)
        ))
    }

    /// Returns a description of the work if it takes noticeably long; `None` otherwise.
    pub fn notice(&self) -> Option<String> {
        (self.seconds > NOTICEABLE_S).then(|| self.summary())
    }

    /// Returns the largest contribution, its steps in each run, and the time of the work.
    fn summary(&self) -> String {
        let Self { most: (what, steps), runs, seconds, .. } = self;
        let each =
            if *runs > 1.0 { format!(" in each of {} runs", count_text(*runs)) } else { String::new() };
        format!("{what} makes {} steps{each}: about {} on one core", count_text(*steps), time(*seconds))
    }

    /// Returns the cost of `runs` such computations, whose results are kept in memory.
    #[must_use]
    pub fn scaled_by(self, runs: u64) -> Self {
        let runs = runs as f64;
        let Self { most, seconds, disk, memory, .. } = self;
        Self { most, runs, seconds: runs * seconds, memory: memory + runs * KEPT, disk: runs * disk }
    }

    /// Returns the cost of the same runs in SIMD lanes.
    #[must_use]
    pub fn in_lanes(self) -> Self {
        Self { seconds: self.seconds / LANES, ..self }
    }

    /// Returns the larger of two costs, relative to the limits.
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        let part =
            |cost: &Self| (cost.seconds / LONG_S).max(cost.memory / MUCH_MEMORY).max(cost.disk / MUCH_DISK);
        if part(&other) > part(&self) { other } else { self }
    }
}

fn count_text(number: f64) -> String {
    if number < 1e6 { format!("{number:.0}") } else { format!("{number:.1e}") }
}

fn time(seconds: f64) -> String {
    match seconds {
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s if s < 172_800.0 => format!("{:.0} h", s / 3600.0),
        s if s < 3.2e7 => format!("{:.0} days", s / 86_400.0),
        s => format!("{} years", count_text(libm::round(s / 3.156e7))),
    }
}

fn bytes(number: f64) -> String {
    match number {
        n if n < 1e9 => format!("{:.0} MB", n / 1e6),
        n if n < 1e12 => format!("{:.0} GB", n / 1e9),
        n => format!("{} TB", count_text(libm::round(n / 1e12))),
    }
}

impl Scenario {
    /// Returns the cost of a run with a log of the given detail, kept in memory or written to a file.
    pub fn cost(&self, log: Option<Detail>, in_memory: bool) -> Cost {
        let modes = self.mode_count() as f64;
        let step = STEP.0 + modes * STEP.1;
        let acts = self.step_counts();
        let mut seconds = self.run_seconds(&acts);
        let mut most = acts.into_iter().max_by(|a, b| a.1.total_cmp(&b.1));
        let mut room = 0.0;
        for (key, messages) in self.messages(log) {
            room += messages * (MESSAGE.0 + modes * MESSAGE.1);
            seconds += messages * 3.0 * step;
            if most.as_ref().is_none_or(|(_, steps)| messages > *steps) {
                most = Some((key, messages));
            }
        }
        let (key, steps) = most.unwrap_or_else(|| ("duration".to_owned(), 1.0));
        let (memory, disk) = if in_memory { (room, 0.0) } else { (0.0, room * 2.0 / 3.0) };
        Cost { most: (format!("`{key}`"), steps), runs: 1.0, seconds, memory, disk }
    }

    /// Returns the error at the first key that is infeasible on any machine.
    pub(super) fn infeasible_key(&self) -> Option<ConfigError> {
        let modes = self.mode_count();
        let filtered = self.estimator.as_ref().is_some_and(|estimator| estimator.filters_measurements());
        let coupled = self.drift.is_some() || self.actuator.flywheel().is_some();
        let why = if filtered { "that a filter estimates" } else { "that a wheel or a drift couples" };
        for (applies, most, why) in
            [(true, MOST_MODES, "of a body"), (coupled || filtered, MOST_COUPLED, why)]
        {
            if applies && modes > most {
                let why = format!("gives {modes} modes, and at most {most} {why} are supported");
                return Some(ConfigError::new(self.body_key(), why));
            }
        }
        let delay = |member: AssignedMember<'_>| Some((member.kind.command_response()?.delay, member.key));
        let longest =
            self.actuator.members().into_iter().filter_map(delay).max_by(|a, b| a.0.total_cmp(&b.0));
        if let (Some((delay, key)), Some(period)) = (longest, self.decided_every()) {
            let waiting = delay.min(self.duration.seconds()) / period.seconds();
            if waiting > MOST_WAITING {
                let why = format!(
                    "keeps {} commands waiting, one every {} s: at most {} are supported",
                    count_text(waiting),
                    period.seconds(),
                    count_text(MOST_WAITING)
                );
                return Some(ConfigError::new(format!("{key}.delay"), why));
            }
        }
        let messages = self.messages(Some(Detail::Scene));
        let (key, steps) =
            self.step_counts().into_iter().chain(messages).find(|(_, steps)| *steps > MOST_STEPS)?;
        let (duration, most) = (self.duration.seconds(), count_text(MOST_STEPS));
        Some(ConfigError::new(
            key,
            format!(
                "makes {} steps in the run's {duration} s: at most {most} are allowed",
                count_text(steps)
            ),
        ))
    }

    /// Returns the period of the commands to a wheel, if they come at fixed times.
    fn decided_every(&self) -> Option<Span> {
        self.study.law_period.or(self.study.sample_period)
    }

    /// Returns the recurring actions of a run: the key of each, and the number of its steps.
    fn step_counts(&self) -> Vec<(String, f64)> {
        let duration = self.duration.seconds();
        let mut steps = Vec::new();
        let mut each = |key: String, span: f64, period: Span| {
            steps.push((key, span.max(0.0) / period.seconds()));
        };
        for (index, sensor) in self.sensor.iter().enumerate() {
            if let Some(period) = sensor.own_period() {
                each(format!("{}.period", self.sensor_key(index)), duration, period);
                let exposure = sensor.exposure().seconds();
                if exposure > 0.0 {
                    let looks = LOOKS.0 + LOOKS.1 * exposure * self.model.frequencies().fold(0.0, f64::max);
                    each(format!("{}.exposure", self.sensor_key(index)), looks * duration, period);
                }
            }
        }
        for (index, line) in self.line_of_sight.iter().enumerate() {
            each(format!("line_of_sight[{index}].period"), duration, line.period);
            if let Some(mirror) = line.mirror {
                each(format!("line_of_sight[{index}].mirror.period"), LOOKS.0 * duration, mirror.period);
            }
        }
        let laws = (0..self.axis_count()).flat_map(|axis| self.law.laws_about(axis));
        for (key, period) in laws.filter_map(|of| Some((of.key, of.law.period()?))) {
            each(format!("{key}.period"), duration, period);
        }
        for member in self.actuator.members() {
            if let Some(period) = member.kind.period() {
                each(format!("{}.period", member.key), duration, period);
            }
            if let ActuatorTask::Unloads(UnloadingTask { period: Some(period), .. }) = &member.task {
                each(format!("{}.period", member.unloading_key()), duration, *period);
            }
        }
        if let Some(envelope) = self.estimator.as_ref().and_then(EstimatorKind::envelope) {
            each("estimator.envelope.window".to_owned(), duration, envelope.window);
        }
        if let Some((adaptation, window)) = self.adaptation.as_ref().and_then(|of| Some((of, of.window()?))) {
            each(format!("adaptation.{}.window", adaptation.kind()), duration, window);
        }
        steps.extend(self.disturbance_steps());
        // Crossings are predicted or searched, and exact panels integrated, by steps that are a part of a vibration.
        let is_coupled = self.drift.is_some() || self.actuator.flywheel().is_some();
        let is_sampled = self.study.sample_period.is_some();
        let axes = self.closed_form_axes();
        let relays: Vec<_> = (0..axes.len()).map(|axis| self.law.relays_about(axis)).collect();
        let searched = relays.iter().flatten().map(|law| law.search_steps(is_coupled));
        let search = if is_sampled { 0.0 } else { searched.fold(0.0, f64::max) };
        let strides = if self.model.chain().is_some() {
            20.0
        } else if search > 0.0 {
            search
        } else if self.actuator.flywheel().is_some() && !is_sampled {
            // The motion with a wheel is a series in the phase of the fastest mode.
            1.0
        } else {
            0.0
        };
        let modes = axes.iter().flat_map(|body| &body.modes);
        let fastest = modes.map(|mode| mode.frequency.get()).fold(0.0, f64::max);
        // Each step of the search computes the angles about all axes.
        let width = axes.len() as f64;
        if strides * fastest > 0.0 {
            steps.push(("duration".to_owned(), width * strides * duration * fastest));
        }
        // The first window of chatter ends the run.
        let switchings = |(laws, body): (&Vec<&Relay>, &AxisModel)| {
            let each = laws.iter().map(|law| law.switching_interval(body.commanded_inertia()));
            let mean = each.reduce(f64::min)?;
            let chatters = mean * SWITCHINGS as f64 <= shortest_window(fastest);
            Some(if chatters { SWITCHINGS as f64 } else { duration / mean })
        };
        let switchings: Vec<f64> = relays.iter().zip(axes).filter_map(switchings).collect();
        if !(is_sampled || switchings.is_empty()) {
            steps.push((SWITCHES.to_owned(), width * switchings.iter().sum::<f64>()));
        }
        if let Some(body) = self.model.three_axis().filter(|body| body.small_angles.is_none()) {
            let rate = self.largest_expected_rate(body);
            let turns = LONGEST_TURN / rate;
            let pushed = libm::sqrt(LONGEST_TURN / self.largest_acceleration(body));
            let turn = turns.min(pushed);
            let step = body.flexible().map_or(turn, |flexible| flexible.step(rate));
            let step = step.min(self.rotor_step(body)).min(pushed);
            if step.is_finite() {
                let count = if self.is_quiet(rate) {
                    // Applied forces shorten steps to those that resolve the modes.
                    let forced = self.forced_time();
                    forced / step + (duration - forced) / turn.min(QUIET_STEPS * step)
                } else {
                    duration / step
                };
                let key = if pushed < PUSHED_STEP { PUSHES } else { TURNS };
                steps.push((key.to_owned(), count));
            }
        }
        steps
    }

    /// Returns the steps of the disturbances: rows of tables, pulses and draws of noise.
    fn disturbance_steps(&self) -> Vec<(String, f64)> {
        let duration = self.duration.seconds();
        let mut steps = Vec::new();
        for (index, disturbance) in self.disturbance.iter().enumerate() {
            let until = disturbance.to.map_or(duration, |to| to.get().min(duration));
            let span = (until - disturbance.from.get()).max(0.0);
            let mut add = |key: &str, count: f64| steps.push((format!("disturbance[{index}].{key}"), count));
            if let Some(density) = &disturbance.density {
                let key = MACHINE_STEPS[usize::from(density.table.is_some())];
                add(key, span / density.step().seconds());
            }
            if let Some(lines) = &disturbance.lines {
                add(MACHINE_STEPS[2], span / lines.step().seconds());
            }
            let rows = disturbance.rows().len();
            if rows > 0 {
                add("table", rows as f64);
            }
            if let Some(pulse) = disturbance.pulse {
                add("pulse.period", span / pulse.period.seconds());
            }
            if let Some(period) = disturbance.period.filter(|_| disturbance.noise > NonNegative::default()) {
                add("period", span / period.seconds());
            }
        }
        steps
    }

    /// Returns the body about each axis about which its motion has a closed form, as if that axis were alone.
    fn closed_form_axes(&self) -> &[AxisModel] {
        let has_closed_form = self.model.three_axis().is_none_or(|body| body.small_angles.is_some());
        if has_closed_form { &self.study.axes } else { &[] }
    }

    /// Returns the periodic messages of a log of the given detail: the key and the number of messages of each.
    fn messages(&self, log: Option<Detail>) -> Vec<(String, f64)> {
        let (duration, period) = (self.duration.seconds(), self.log_period());
        let topics = if self.axis_count() == 3 { 4.0 } else { 5.0 };
        let mut messages = Vec::new();
        if log >= Some(Detail::Full) {
            messages.push(("log.period".to_owned(), topics * duration / period.seconds()));
            // A row for each edge of a pulse.
            for member in self.actuator.members() {
                let offers = member.kind.offers();
                if let Some(period) = offers.period.filter(|_| offers.pulses && !offers.has_jets) {
                    let edges = 2.0 * duration / period.seconds();
                    messages.push((format!("{}.period", member.key), topics * edges));
                }
            }
        }
        if log >= Some(Detail::Scene) {
            let frames = duration / self.log.scene.period(period).seconds();
            messages.push(("log.scene.period".to_owned(), frames));
        }
        messages
    }
}
