//! Saturation: how often a run has wheels and magnetorquers at their limits, and whether it ends there.

use flexsc_numerics::quantity::Positive;
use flexsc_record::{self, Report};

use super::AssignedActuator;
use crate::one_or_many::OneOrMany;

/// A value is at its limit if it misses it by this part of it.
const AT_LIMIT: f64 = 1e-9;
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

/// Counts of the control cycles of a run in which actuators are at their limits.
#[derive(Clone, Debug)]
pub struct Saturation {
    /// Largest torque (N m), momentum (N m s) and speed (rad/s) of a wheel, and moment (A m²) of each magnetorquer.
    torque: f64,
    momentum: f64,
    speed: f64,
    moments: [f64; 3],
    /// Start and middle of the last tenth of the run (s).
    late: f64,
    middle: f64,
    duration: f64,
    /// Numbers of cycles: all, and those at the limits of torque, momentum and moment.
    cycles: u64,
    limited: [u64; 3],
    /// Largest speed (rad/s) and momentum (N m s) of a wheel.
    peaks: [f64; 2],
    wheels: Vec<LateWheel>,
    /// At the end: cycles, those at any limit, and those of them at that of the moment.
    ending: [u64; 3],
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
    /// Creates counts without cycles for runs of a duration (s) with these actuators.
    pub fn new(actuators: &OneOrMany<AssignedActuator>, duration: f64) -> Self {
        let limit = |bound: Option<Positive>| bound.map_or(f64::INFINITY, Positive::get);
        let wheels = actuators.wheels().map(|(wheels, _)| wheels);
        let torquers = actuators.magnetorquers().map(|(torquers, _)| torquers);
        let late = duration * (1.0 - LATE);
        Self {
            torque: limit(wheels.and_then(|wheels| wheels.torque)),
            momentum: limit(wheels.and_then(|wheels| wheels.momentum)),
            speed: limit(wheels.and_then(|wheels| wheels.speed_limit)),
            moments: [0, 1, 2]
                .map(|axis| torquers.map_or(f64::INFINITY, |torquers| torquers.moment.about(axis).get())),
            late,
            middle: 0.5 * (late + duration),
            duration,
            cycles: 0,
            limited: [0; 3],
            peaks: [0.0; 2],
            wheels: vec![LateWheel::default(); wheels.map_or(0, super::wheels::Wheels::count)],
            ending: [0; 3],
        }
    }

    /// Observes the wheels and magnetorquers in the report of a cycle that begins at a time (s).
    pub fn observe(&mut self, t: f64, report: &Report) {
        if self.wheels.is_empty() && self.moments.iter().all(|limit| limit.is_infinite()) {
            return;
        }
        let wheels = report.get().map_or(&[][..], |row: &flexsc_record::Wheels| &row.wheels);
        let torquers = report.get().map_or(&[][..], |row: &flexsc_record::Magnetorquers| &row.axes);
        let reaches = |value: f64, limit: f64| value.abs() >= limit * (1.0 - AT_LIMIT);
        let is_late = t >= self.late;
        let (mut torque, mut momentum) = (false, false);
        for (own, wheel) in self.wheels.iter_mut().zip(wheels) {
            self.peaks[0] = self.peaks[0].max(wheel.speed_rad_s.abs());
            self.peaks[1] = self.peaks[1].max(wheel.momentum_nm_s.abs());
            let forced = reaches(wheel.torque_nm, self.torque);
            let full = reaches(wheel.momentum_nm_s, self.momentum) || reaches(wheel.speed_rad_s, self.speed);
            torque |= forced;
            momentum |= full;
            if is_late {
                own.record(if forced { wheel.torque_nm } else { 0.0 }, full, t >= self.middle);
            }
        }
        let mut moments = torquers.iter().zip(self.moments);
        let moment = moments.any(|(torquer, limit)| reaches(torquer.moment_am2, limit));
        self.cycles += 1;
        for (count, now) in self.limited.iter_mut().zip([torque, momentum, moment]) {
            *count += u64::from(now);
        }
        if is_late {
            self.ending[0] += 1;
            self.ending[1] += u64::from(torque || momentum || moment);
            self.ending[2] += u64::from(moment);
        }
    }

    /// Returns true if there are wheels.
    pub fn has_wheels(&self) -> bool {
        !self.wheels.is_empty()
    }

    /// Returns the largest speed (rad/s) and the largest momentum (N m s) of a wheel.
    pub fn peaks(&self) -> [f64; 2] {
        self.peaks
    }

    /// Returns the fractions of the cycles with an actuator at its limit of torque, of momentum or speed, and of magnetic
    /// moment; `None` where there is no such limit.
    pub fn shares(&self) -> [Option<f64>; 3] {
        let limits = [self.torque, self.momentum.min(self.speed), self.moments[0]];
        let share = |(limit, count): (f64, u64)| limit.is_finite().then(|| count as f64 / self.cycles as f64);
        let [torque, momentum, moment] = [0, 1, 2].map(|index| share((limits[index], self.limited[index])));
        [torque, momentum, moment]
    }

    /// Returns the fraction of the cycles in the last tenth of the run with an actuator at a limit; NaN without such cycles.
    pub fn late_share(&self) -> f64 {
        self.ending[1] as f64 / self.ending[0] as f64
    }

    /// Returns the state in the last tenth of the run; `None` without any limit.
    pub fn end_state(&self) -> Option<EndState> {
        self.shares().iter().any(Option::is_some).then(|| {
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
    /// Records a cycle: `torque` (N m) if it is at its limit, else 0; `full` if the wheel is at its largest speed; `second`
    /// if the cycle is in the second half of the end.
    fn record(&mut self, torque: f64, full: bool, second: bool) {
        self.full += u64::from(full);
        if torque == 0.0 {
            return;
        }
        let sign = torque.signum();
        self.halves[usize::from(second)] += 1;
        self.ahead += u64::from(sign > 0.0);
        self.back += u64::from(sign < 0.0);
        self.reversals += u64::from(self.last == -sign);
        self.last = sign;
    }
}
