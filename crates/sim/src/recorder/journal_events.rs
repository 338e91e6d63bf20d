//! Detection of state changes for the journal: start and end, targets, arrivals, active damping, trust in estimators.

use flexsc_control::law::TargetFrame;
use flexsc_control::state_estimate::DampingStatus;
use flexsc_numerics::attitude::{AXES, angles};
use flexsc_numerics::time::Instant;
use flexsc_record::foxglove::LogLevel;
use flexsc_record::row::LogDate;
use flexsc_record::{Adaptation, Arrival, ModeEvent, Record, RecordError, Sliding, WheelEvent};
use nalgebra::Quaternion;

use super::journal::{Journal, adaptation_line, opening};
use crate::guidance::Guidance;
use flexsc_scenario::Scenario;

/// Stage of the journal: not yet opened, open, or closed.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
enum JournalStage {
    Before,
    Within,
    After,
}

/// Last reported states, to detect changes for the journal.
#[derive(Clone, Debug)]
pub struct JournalEvents {
    journal: Journal,
    stage: JournalStage,
    opening: String,
    target: Option<(TargetFrame, Quaternion<f64>)>,
    /// Number of the target in the profile; `None` before the first cycle.
    target_number: Option<usize>,
    /// True while the body turns towards the target and has not arrived.
    is_slewing: bool,
    /// Error about each axis below which the body has arrived at a target (rad).
    arrival_bands: [f64; 3],
    latched: [bool; 3],
    resting: [bool; 3],
    trusted: [bool; 3],
    /// True for axes whose filter has lost the body.
    lost: [bool; 3],
}

impl JournalEvents {
    /// Creates the state of the journal before the first event.
    pub fn new(scenario: &Scenario, run: u64) -> Self {
        Self {
            journal: Journal::new(scenario),
            stage: JournalStage::Before,
            opening: opening(scenario, run),
            target: None,
            target_number: None,
            is_slewing: false,
            arrival_bands: scenario.study.arrival_bands(scenario),
            latched: [false; 3],
            resting: [false; 3],
            trusted: [true; 3],
            lost: [false; 3],
        }
    }

    /// Returns the date of an instant.
    pub fn stamp(&self, now: Instant) -> LogDate {
        self.journal.date_of(now)
    }

    /// Writes the line of the run's start once; returns true if this call wrote it.
    pub fn open(&mut self, now: Instant, record: &mut dyn Record) -> Result<bool, RecordError> {
        if self.stage != JournalStage::Before {
            return Ok(false);
        }
        self.stage = JournalStage::Within;
        self.journal.write_line(now, (LogLevel::Info, "run"), self.opening.clone(), record)?;
        Ok(true)
    }

    /// Marks the journal as closed; returns true the first time.
    pub fn close(&mut self) -> bool {
        std::mem::replace(&mut self.stage, JournalStage::After) != JournalStage::After
    }

    /// Writes the line of the run's end.
    pub fn end(&self, now: Instant, record: &mut dyn Record) -> Result<(), RecordError> {
        self.journal.write_line(now, (LogLevel::Info, "run"), "the end of the run".to_owned(), record)
    }

    /// Writes a warning about a part of the run.
    pub fn warned(
        &self,
        now: Instant,
        part: &str,
        line: String,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        self.journal.write_line(now, (LogLevel::Warning, part), line, record)
    }

    /// Writes the line of a run that is stopped before its end.
    pub fn interrupted(&self, now: Instant, record: &mut dyn Record) -> Result<(), RecordError> {
        self.journal.write_line(
            now,
            (LogLevel::Info, "run"),
            "the run is left before its end".to_owned(),
            record,
        )
    }

    /// Writes the line of the manoeuvre's end.
    pub fn manoeuvre_ended(
        &self,
        now: Instant,
        row: &Arrival,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        let line = format!(
            "the manoeuvre ends {:.3e} rad from its goal, with a vibration of {:.3e} rad",
            row.angle_error_rad, row.angle_residual_rad
        );
        self.journal.write_line(now, (LogLevel::Info, "manoeuvre"), line, record)
    }

    /// Writes the line of an adaptation step, from the gain `before`.
    pub fn adaptation_step(
        &self,
        now: Instant,
        row: &Adaptation,
        before: f64,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        let line = adaptation_line(row.window, row.decision, before, row.gain);
        self.journal.write_line(now, (LogLevel::Info, "adaptation"), line, record)
    }

    /// Writes which filters have lost lock or have it again; with one axis, without the name of the axis.
    #[inline]
    pub fn lock_changed(
        &mut self,
        now: Instant,
        lost: [bool; 3],
        axes: usize,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        if self.lost == lost {
            return Ok(());
        }
        let before = std::mem::replace(&mut self.lost, lost);
        for axis in (0..3).filter(|axis| before[*axis] != lost[*axis]) {
            let (level, line) = if lost[axis] {
                (LogLevel::Warning, "the filter has lost the body")
            } else {
                (LogLevel::Info, "the filter follows the body again")
            };
            let line = if axes == 1 { line.to_owned() } else { format!("{}: {line}", AXES[axis]) };
            self.journal.write_line(now, (level, "estimator"), line, record)?;
        }
        Ok(())
    }

    /// Writes a new three-axis target, or that the attitude `error` (rad) has come within the arrival band about it.
    pub fn target(
        &mut self,
        now: Instant,
        guidance: &Guidance,
        error: impl FnOnce() -> [f64; 3],
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        let manoeuvre = (LogLevel::Info, "manoeuvre");
        let number = Some(guidance.target_number(now));
        let is_next = std::mem::replace(&mut self.target_number, number) != number;
        let written = if is_next { guidance.target_as_written(now) } else { None };
        if let Some((frame, attitude)) = written.filter(|_| self.target != written) {
            self.target = written;
            let [roll, pitch, yaw] = angles(&attitude);
            let from = frame.name();
            let line = format!("the target is roll {roll:.5}, pitch {pitch:.5}, yaw {yaw:.5} rad{from}");
            self.journal.write_line(now, manoeuvre, line, record)?;
            self.is_slewing = true;
        }
        if self.is_slewing && error().iter().zip(self.arrival_bands).all(|(error, zone)| error.abs() <= zone)
        {
            self.is_slewing = false;
            let line = "the attitude is within the dead zone about its target".to_owned();
            self.journal.write_line(now, manoeuvre, line, record)?;
        }
        Ok(())
    }

    /// Writes that a wheel passes through zero speed, sticks, or slips again.
    pub fn bearing_changed(
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
        self.journal.write_line(now, (LogLevel::Info, "wheels"), line, record)
    }

    /// Writes that a mode of operation begins.
    pub fn mode_entered(
        &self,
        now: Instant,
        event: &ModeEvent,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        let ModeEvent { mode, before, cause, .. } = event;
        let line = if before.is_empty() {
            format!("the mode is `{mode}`")
        } else {
            format!("the mode is `{mode}` after `{before}`: {cause}")
        };
        self.journal.write_line(now, (LogLevel::Info, "mode"), line, record)
    }

    /// Writes that a failure of a part begins or ends.
    pub fn failure_changed(
        &self,
        now: Instant,
        what: (LogLevel, &str),
        line: String,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        self.journal.write_line(now, what, line, record)
    }

    /// Writes the changes of active damping, and of the trust in the estimates on which it acts.
    pub fn damping_changed(
        &mut self,
        now: Instant,
        damped: &[DampingStatus],
        trusted: [bool; 3],
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        let (debug, info, warning) = (LogLevel::Debug, LogLevel::Info, LogLevel::Warning);
        for (axis, name) in AXES.into_iter().enumerate() {
            let changed = |before: &mut bool, now: bool| std::mem::replace(before, now) != now;
            let DampingStatus { latched, resting, .. } = damped[axis];
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
                self.journal.write_line(now, (level, part), format!("{name}: {line}"), record)?;
            }
        }
        Ok(())
    }
}
