//! Saturation: when and how long a run has actuators at their limits, whether they lose the target there, and whether the run
//! ends there.

use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{self, Report, ThreeAxisCycle};

use super::limits::{ActuatorLimits, LimitKind};
use super::target_loss::{TargetLoss, TargetLossMonitor};

/// Part of a run that is its end.
const LATE: f64 = 0.1;
/// An actuator is saturated at the end if it is at one limit for more than this part of it.
const STEADY: f64 = 0.5;
/// A wheel cycles if it is at each of its torque limits for more than this part of the end ...
const RARE: f64 = 0.025;
/// ... with at least this number of changes from one to the other, two whole periods, ...
const REVERSALS: u64 = 4;
/// ... and in the second half of the end more than this part as often as in the first.
const DECAY: f64 = 0.5;

/// State of wheels and magnetorquers at the end of a run.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum EndState {
    /// At a limit now and then at most.
    Free,
    /// Steadily at a limit.
    Saturated,
    /// Oscillating between opposite torque limits.
    Cycling,
}

impl EndState {
    /// Returns the state's name among the metrics.
    pub fn word(self) -> &'static str {
        match self {
            Self::Free => "free",
            Self::Saturated => "saturated",
            Self::Cycling => "cycling",
        }
    }

    /// Returns the warning about a state of this name, in which an actuator is at a limit for a share of the last seconds of a
    /// run; `None` if it is free.
    pub fn warning(word: &str, share: f64, seconds: f64) -> Option<String> {
        let share_text = format!("{:.0} % of the last {seconds} s", 100.0 * share);
        match word {
            "saturated" => {
                Some(format!("the run ends in saturation: an actuator is at its limit in {share_text}"))
            }
            "cycling" => Some(format!(
                "the run ends in an oscillation that does not decay: wheels alternate between their torque limits, and are at one \
                 in {share_text}; the loop may be unstable"
            )),
            _ => None,
        }
    }
}

/// Number of kinds of limits.
const KINDS: usize = LimitKind::ALL.len();

/// First time at limits of a kind, and time there, in a mode of operation.
#[derive(Copy, Clone, Debug, Default)]
pub struct LimitTime {
    /// Instant of the first cycle with an actuator at such a limit; `None` without one.
    pub start: Option<Instant>,
    /// Time with an actuator at such a limit, from cycle to cycle.
    pub time: Span,
}

/// Counts of the control cycles of a run in which actuators are at their limits.
#[derive(Clone, Debug)]
pub struct Saturation {
    limits: ActuatorLimits,
    /// Start and middle of the last tenth of the run (s).
    late: f64,
    middle: f64,
    duration: f64,
    /// Numbers of cycles: all, and those at the limits of each kind.
    cycles: u64,
    limited: [u64; KINDS],
    /// For each mode of operation, or once, the time at the limits of each kind.
    times: Vec<[LimitTime; KINDS]>,
    /// Last cycle: its instant, its mode, and the kinds of limits that were reached.
    before: (Instant, usize, [bool; KINDS]),
    /// Largest speed (rad/s) and momentum (N m s) of a wheel.
    peaks: [f64; 2],
    wheels: Vec<LateWheel>,
    /// At the end: cycles, those at any limit, and those of them at that of the moment.
    ending: [u64; 3],
    losses: TargetLossMonitor,
}

/// Counts of a wheel in the last tenth of a run.
#[derive(Copy, Clone, Debug, Default)]
struct LateWheel {
    /// Cycles at the positive and the negative torque limit, and at the largest momentum or speed.
    ahead: u64,
    back: u64,
    full: u64,
    /// Sign of the torque limit that was reached last, and number of its changes.
    last: f64,
    reversals: u64,
    /// Cycles at a torque limit in each half of the end.
    halves: [u64; 2],
}

impl Saturation {
    /// Creates counts without cycles for runs of a duration with these limits, of `wheels` wheels and `modes` modes of operation.
    pub fn new(
        limits: ActuatorLimits,
        losses: TargetLossMonitor,
        duration: Span,
        [wheels, modes]: [usize; 2],
    ) -> Self {
        let duration = duration.seconds();
        let late = duration * (1.0 - LATE);
        Self {
            limits,
            late,
            middle: 0.5 * (late + duration),
            duration,
            cycles: 0,
            limited: [0; KINDS],
            times: vec![Default::default(); modes.max(1)],
            before: (Instant::START, 0, [false; KINDS]),
            peaks: [0.0; 2],
            wheels: vec![LateWheel::default(); wheels],
            ending: [0; 3],
            losses,
        }
    }

    /// Observes the actuators in the report of a cycle that begins now; returns the loss of the target in the visit that ends
    /// here, if any.
    pub fn observe(&mut self, now: Instant, report: &Report) -> Option<TargetLoss> {
        let cycle = report.get::<ThreeAxisCycle>()?;
        let wheels = report.get().map_or(&[][..], |row: &flexsc_record::Wheels| &row.wheels);
        for wheel in wheels {
            self.peaks[0] = self.peaks[0].max(wheel.speed_rad_s.abs());
            self.peaks[1] = self.peaks[1].max(wheel.momentum_nm_s.abs());
        }
        if self.limits.is_empty() {
            return None;
        }
        self.limits.observe(report);
        let mut kinds = [false; KINDS];
        for (_, limit, _) in self.limits.reached() {
            kinds[limit.kind() as usize] = true;
        }
        self.cycles += 1;
        for (count, is_reached) in self.limited.iter_mut().zip(kinds) {
            *count += u64::from(is_reached);
        }
        if now.seconds() >= self.late {
            self.observe_end(now.seconds() >= self.middle, kinds);
        }
        self.add_times(now);
        self.before = (now, cycle.visit.mode, kinds);
        let square: f64 = cycle.error_rad.iter().map(|error| error * error).sum();
        self.losses.observe(now, cycle.visit, &self.limits, square.sqrt())
    }

    /// Observes a cycle in the last tenth of the run, with the kinds of limits that are reached; `second` if it is in its second
    /// half.
    fn observe_end(&mut self, second: bool, kinds: [bool; KINDS]) {
        let mut wheels = vec![(0.0, false); self.wheels.len()];
        for (_, limit, sign) in self.limits.reached() {
            if let Some((torque, is_full)) = limit.wheel().and_then(|wheel| wheels.get_mut(wheel)) {
                match limit.kind() {
                    LimitKind::Torque => *torque = sign,
                    _ => *is_full = true,
                }
            }
        }
        for (own, (torque, is_full)) in self.wheels.iter_mut().zip(wheels) {
            own.record(torque, is_full, second);
        }
        let [torque, momentum, moment] =
            [LimitKind::Torque, LimitKind::Momentum, LimitKind::Moment].map(|kind| kinds[kind as usize]);
        self.ending[0] += 1;
        self.ending[1] += u64::from(torque || momentum || moment);
        self.ending[2] += u64::from(moment);
    }

    /// Adds the time since the last cycle to the limits that were reached there.
    fn add_times(&mut self, now: Instant) {
        let (from, mode, kinds) = self.before;
        let Some(times) = self.times.get_mut(mode) else { return };
        for (time, _) in times.iter_mut().zip(kinds).filter(|(_, is_reached)| *is_reached) {
            time.start.get_or_insert(from);
            time.time = time.time + now.since(from);
        }
        self.before = (now, mode, [false; KINDS]);
    }

    /// Adds the time up to the end of the run; returns the loss of the target in the visit that ends here, if any.
    pub fn close(&mut self, end: Instant) -> Option<TargetLoss> {
        self.add_times(end);
        self.losses.end_visit(end)
    }

    /// Returns the limits of the actuators.
    pub fn limits(&self) -> &ActuatorLimits {
        &self.limits
    }

    /// Returns the first time at the limits of a kind, and the time there, in each mode of operation, or once without modes.
    pub fn times(&self, kind: LimitKind) -> impl Iterator<Item = LimitTime> {
        self.times.iter().map(move |times| times[kind as usize])
    }

    /// Returns true if there are wheels.
    pub fn has_wheels(&self) -> bool {
        !self.wheels.is_empty()
    }

    /// Returns the largest speed (rad/s) and the largest momentum (N m s) of a wheel.
    pub fn peaks(&self) -> [f64; 2] {
        self.peaks
    }

    /// Returns the fraction of the cycles with an actuator at a limit of a kind; `None` without such a limit.
    pub fn share(&self, kind: LimitKind) -> Option<f64> {
        self.limits.has(kind).then(|| self.limited[kind as usize] as f64 / self.cycles as f64)
    }

    /// Returns the fraction of the cycles in the last tenth of the run with an actuator at a limit; NaN without such cycles.
    pub fn late_share(&self) -> f64 {
        self.ending[1] as f64 / self.ending[0] as f64
    }

    /// Returns the state of wheels and magnetorquers in the last tenth of the run; `None` without a limit of theirs.
    pub fn end_state(&self) -> Option<EndState> {
        let kinds = [LimitKind::Torque, LimitKind::Momentum, LimitKind::Moment];
        kinds.into_iter().any(|kind| self.limits.has(kind)).then(|| {
            let [all, _, moment] = self.ending.map(|count| count as f64);
            let steady = |count: u64| count as f64 > STEADY * all;
            let is_steady =
                |wheel: &LateWheel| steady(wheel.ahead) || steady(wheel.back) || steady(wheel.full);
            let alternates = |wheel: &LateWheel| {
                let [before, after] = wheel.halves.map(|count| count as f64);
                wheel.reversals >= REVERSALS
                    && wheel.ahead.min(wheel.back) as f64 > RARE * all
                    && after > DECAY * before
            };
            if self.wheels.iter().any(alternates) {
                EndState::Cycling
            } else if self.wheels.iter().any(is_steady) || moment > STEADY * all {
                EndState::Saturated
            } else {
                EndState::Free
            }
        })
    }

    /// Returns the warning about the end of the run, if any.
    pub fn warning(&self) -> Option<String> {
        EndState::warning(self.end_state()?.word(), self.late_share(), Self::late_seconds(self.duration))
    }

    /// Returns the length of the last tenth of a run of this duration (s), to three digits.
    pub fn late_seconds(duration: f64) -> f64 {
        let exact = LATE * duration;
        let unit = libm::pow(10.0, libm::floor(libm::log10(exact)) - 2.0);
        if exact > 0.0 { (libm::round(exact / unit) * unit * 1e9).round() / 1e9 } else { 0.0 }
    }
}

impl LateWheel {
    /// Records a cycle: the sign of the torque if it is at its limit, else 0; `full` if the wheel is at its largest speed; `second`
    /// if the cycle is in the second half of the end.
    fn record(&mut self, sign: f64, full: bool, second: bool) {
        self.full += u64::from(full);
        if sign == 0.0 {
            return;
        }
        self.halves[usize::from(second)] += 1;
        self.ahead += u64::from(sign > 0.0);
        self.back += u64::from(sign < 0.0);
        self.reversals += u64::from(self.last == -sign);
        self.last = sign;
    }
}
