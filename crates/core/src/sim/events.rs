//! What is new in a run, for its journal: its start and end, targets, arrivals, active damping, trust in estimators.

use crate::attitude::{AXES, angles};
use crate::belief::Damped;
use crate::law::Frame;
use crate::record::foxglove::LogLevel;
use crate::record::row::Stamp;
use crate::record::{Adaptation, Arrival, Record, RecordError, Sliding, WheelEvent};
use crate::scenario::Scenario;
use crate::sim::journal::{Journal, adapted, opening};
use crate::time::Instant;
use nalgebra::Quaternion;

/// What was known before.
#[derive(Clone, Debug)]
pub struct Events {
    journal: Journal,
    opening: String,
    target: Option<(Frame, Quaternion<f64>)>,
    /// Whether the body is on its way to the target.
    travelling: bool,
    /// How near to a target it arrives, about each axis (rad).
    zones: [f64; 3],
    latched: [bool; 3],
    resting: [bool; 3],
    trusted: [bool; 3],
    /// Whether filters had lost the body.
    lost: [bool; 3],
}

impl Events {
    /// Nothing is known.
    pub fn new(scenario: &Scenario, run: u64) -> Self {
        Self {
            journal: Journal::new(scenario),
            opening: opening(scenario, run),
            target: None,
            travelling: false,
            zones: scenario.study.zones(scenario),
            latched: [false; 3],
            resting: [false; 3],
            trusted: [true; 3],
            lost: [false; 3],
        }
    }

    /// An instant as a date.
    pub fn stamp(&self, now: Instant) -> Stamp {
        self.journal.stamp(now)
    }

    /// The run begins.
    pub fn begin(&self, now: Instant, record: &mut dyn Record) -> Result<(), RecordError> {
        self.journal.tell(now, (LogLevel::Info, "run"), self.opening.clone(), record)
    }

    /// The run ends.
    pub fn end(&self, now: Instant, record: &mut dyn Record) -> Result<(), RecordError> {
        self.journal.tell(now, (LogLevel::Info, "run"), "the end of the run".to_owned(), record)
    }

    /// The run is left before its end.
    pub fn left(&self, now: Instant, record: &mut dyn Record) -> Result<(), RecordError> {
        self.journal.tell(now, (LogLevel::Info, "run"), "the run is left before its end".to_owned(), record)
    }

    /// The manoeuvre ends.
    pub fn arrived(&self, now: Instant, row: &Arrival, record: &mut dyn Record) -> Result<(), RecordError> {
        let line = format!(
            "the manoeuvre ends {:.3e} rad from its goal, with a vibration of {:.3e} rad",
            row.angle_error_rad, row.angle_residual_rad
        );
        self.journal.tell(now, (LogLevel::Info, "manoeuvre"), line, record)
    }

    /// The adaptation takes a step.
    pub fn adapted(
        &self,
        now: Instant,
        row: &Adaptation,
        before: f64,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        let line = adapted(row.window, row.decision, before, row.gain);
        self.journal.tell(now, (LogLevel::Info, "adaptation"), line, record)
    }

    /// Filters of so many axes lose the body, or follow it again.
    pub fn lost(
        &mut self,
        now: Instant,
        lost: [bool; 3],
        axes: usize,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        let before = std::mem::replace(&mut self.lost, lost);
        for axis in (0..3).filter(|axis| before[*axis] != lost[*axis]) {
            let (level, line) = if lost[axis] {
                (LogLevel::Warning, "the filter has lost the body")
            } else {
                (LogLevel::Info, "the filter follows the body again")
            };
            let line = if axes == 1 { line.to_owned() } else { format!("{}: {line}", AXES[axis]) };
            self.journal.tell(now, (level, "estimator"), line, record)?;
        }
        Ok(())
    }

    /// A new target of three axes, or the attitude comes near to it.
    pub fn target(
        &mut self,
        now: Instant,
        target: (Frame, Quaternion<f64>),
        error: impl FnOnce() -> [f64; 3],
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        let manoeuvre = (LogLevel::Info, "manoeuvre");
        if self.target != Some(target) {
            self.target = Some(target);
            let (frame, attitude) = target;
            let [roll, pitch, yaw] = angles(&attitude);
            let from = frame.words();
            let line = format!("the target is roll {roll:.5}, pitch {pitch:.5}, yaw {yaw:.5} rad{from}");
            self.journal.tell(now, manoeuvre, line, record)?;
            self.travelling = true;
        }
        if self.travelling && error().iter().zip(self.zones).all(|(error, zone)| error.abs() <= zone) {
            self.travelling = false;
            let line = "the attitude is within the dead zone about its target".to_owned();
            self.journal.tell(now, manoeuvre, line, record)?;
        }
        Ok(())
    }

    /// A wheel passes through zero speed, sticks, or slips again.
    pub fn slipped(
        &self,
        now: Instant,
        event: &WheelEvent,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        let what = match (event.before, event.after) {
            (_, Sliding::Stuck) => "sticks",
            (Sliding::Stuck, _) => "slips again",
            _ => "passes through zero speed",
        };
        let line = format!("wheel {} {what}", event.wheel + 1);
        self.journal.tell(now, (LogLevel::Info, "wheels"), line, record)
    }

    /// A failure of a part begins or ends.
    pub fn failed(
        &self,
        now: Instant,
        what: (LogLevel, &str),
        line: String,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        self.journal.tell(now, what, line, record)
    }

    /// What has changed in active damping, and in the trust in what it acts on.
    pub fn damping(
        &mut self,
        now: Instant,
        damped: &[Damped],
        trusted: [bool; 3],
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        let (debug, info, warning) = (LogLevel::Debug, LogLevel::Info, LogLevel::Warning);
        for (axis, name) in AXES.into_iter().enumerate() {
            let changed = |before: &mut bool, now: bool| std::mem::replace(before, now) != now;
            let Damped { latched, resting, .. } = damped[axis];
            let mut lines = Vec::new();
            if changed(&mut self.trusted[axis], trusted[axis]) {
                lines.push(if trusted[axis] {
                    (info, "estimator", "the observer follows again")
                } else {
                    (warning, "estimator", "the observer does not follow: no active damping")
                });
            }
            if changed(&mut self.resting[axis], resting) {
                lines.push(if resting {
                    (warning, "damping", "the pushes do not help: the watchdog lets them rest")
                } else {
                    (info, "damping", "the watchdog lets the pushes go on")
                });
            }
            if changed(&mut self.latched[axis], latched) {
                lines.push(if latched {
                    (debug, "damping", "the elastic rate is beyond its threshold")
                } else {
                    (debug, "damping", "the elastic rate is damped")
                });
            }
            for (level, part, line) in lines {
                self.journal.tell(now, (level, part), format!("{name}: {line}"), record)?;
            }
        }
        Ok(())
    }
}
