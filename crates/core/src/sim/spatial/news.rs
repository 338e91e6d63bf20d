//! What is new in a cycle of a spatial loop, for the journal: targets, active damping, trust in the observers.

use nalgebra::Quaternion;

use crate::body::spatial::{AXES, angles};
use crate::law::Damped;
use crate::record::foxglove::Level;
use crate::record::row::Stamp;
use crate::record::{Record, RecordError};
use crate::scenario::{Scenario, SpatialLoop};
use crate::sim::journal::{Journal, opening};
use crate::time::Instant;

/// What was known in the cycle before.
#[derive(Clone, Debug)]
pub struct News {
    journal: Journal,
    /// The journal's first line, until it is written.
    opening: Option<String>,
    ended: bool,
    target: Option<Quaternion<f64>>,
    /// Whether the body is on its way to the target.
    travelling: bool,
    dead_zone: f64,
    latched: [bool; 3],
    resting: [bool; 3],
    trusted: [bool; 3],
}

impl News {
    /// Nothing is known.
    pub fn new(scenario: &Scenario, spatial: &SpatialLoop, run: u64) -> Self {
        Self {
            journal: Journal::new(scenario),
            opening: Some(opening(scenario, run)),
            ended: false,
            target: None,
            travelling: false,
            dead_zone: spatial.law.dead_zone.get(),
            latched: [false; 3],
            resting: [false; 3],
            trusted: [true; 3],
        }
    }

    /// An instant as a date.
    pub fn stamp(&self, now: Instant) -> Stamp {
        self.journal.stamp(now)
    }

    /// Tells that the run begins, once.
    pub fn begin(&mut self, now: Instant, record: &mut impl Record) -> Result<(), RecordError> {
        let line = self.opening.take();
        line.map_or(Ok(()), |line| self.journal.tell(now, (Level::Info, "run"), line, record))
    }

    /// Tells that the run ends, once.
    pub fn end(&mut self, now: Instant, record: &mut impl Record) -> Result<(), RecordError> {
        if std::mem::replace(&mut self.ended, true) {
            return Ok(());
        }
        self.journal.tell(now, (Level::Info, "run"), "the end of the run".to_owned(), record)
    }

    /// Tells of a new target, and of the attitude that comes into the dead zone about it.
    pub fn target(
        &mut self,
        now: Instant,
        target: Quaternion<f64>,
        error: [f64; 3],
        record: &mut impl Record,
    ) -> Result<(), RecordError> {
        let manoeuvre = (Level::Info, "manoeuvre");
        if self.target.replace(target) != Some(target) {
            let [roll, pitch, yaw] = angles(&target);
            let line = format!("the target is roll {roll:.5}, pitch {pitch:.5}, yaw {yaw:.5} rad");
            self.journal.tell(now, manoeuvre, line, record)?;
            self.travelling = true;
        }
        if self.travelling && error.iter().all(|error| error.abs() <= self.dead_zone) {
            self.travelling = false;
            let line = "the attitude is within the dead zone about its target".to_owned();
            self.journal.tell(now, manoeuvre, line, record)?;
        }
        Ok(())
    }

    /// Tells what has changed in active damping, and in the trust in what it acts on.
    pub fn damping(
        &mut self,
        now: Instant,
        damped: &[Damped; 3],
        trusted: [bool; 3],
        record: &mut impl Record,
    ) -> Result<(), RecordError> {
        let (debug, info, warning) = (Level::Debug, Level::Info, Level::Warning);
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
