//! Output of flexsc: rows and topics declared once, traces, MCAP logs, columns, and files that are written atomically.
//!
//! A [`Record`] receives everything that a simulation reports.

pub mod atomic_file;
mod columns;
mod composite;
mod custom_row;
pub mod custom_topic;
mod decoder;
pub mod description;
mod descriptor;
pub mod enum_label;
pub mod foxglove;
mod log_file;
mod log_topic;
mod mcap;
mod mcap_reader;
mod memory_budget;
mod message;
pub mod metrics;
mod proto;
mod provenance_check;
mod recover;
mod report;
mod requirement_errors;
pub mod row;
mod row_columns;
mod scene_source;
mod states;
mod stop_flag;
mod summary;
mod three_axis;
mod topic_table;
mod topics;
mod trace;
mod wire;

use std::any::Any;
use std::io;

use flexsc_dynamics::{AxisState, MotionPiece};
use flexsc_numerics::time::Instant;
use thiserror::Error;

pub use columns::{Column, Columns};
pub use custom_row::{CustomRow, CustomValue};
pub use custom_topic::{CustomField, CustomTopic, TopicError};
pub use log_file::{Log, LogError};
pub use log_topic::LogTopic;
pub use mcap::{LogBytes, LogFile};
pub use message::{Attachment, COMMANDS, Message, MessageEncoder, MessageSink, Provenance, RunEnd};
pub use provenance_check::{ExistingLog, difference, existing_log};
pub use recover::recover;
pub use report::{LogRow, LoggedRevisions, Report, ReportValue};
pub use requirement_errors::{
    RequirementError, RequirementErrors, RequirementRobustness, RequirementScope, RequirementScopes,
    RequirementSignals, RobustnessOfRequirements,
};
pub use scene_source::{OneAxisPose, ScenePose, SceneSource, SceneThrust, ThreeAxisPose};
pub use states::{Gate, Latch, Light, Lock, Onset, Phase, ReadingOutcome, Sliding, Trust, Use, Watch};
pub use stop_flag::StopFlag;
pub use three_axis::{ModeTargetStart, SteeringRecord, TargetVisit, ThreeAxisCycle};
pub use topics::*;
pub use trace::Trace;

/// Samples that a simulation reports while it runs.
#[derive(Copy, Clone, Debug)]
pub enum Sample<'a> {
    /// Start of the run, with the law in this state.
    Begin(&'a Law),
    /// Switching of the law, with the body in this state.
    Switching(&'a Command, &'a AxisState),
    /// Row of one topic.
    Row(&'a dyn LogRow),
    /// Rows and values of the parts at one instant.
    Report(&'a Report),
}

impl<'a> Sample<'a> {
    /// Returns the row or value of this type, of a sample that is a row or a report.
    pub fn get<T: Any>(self) -> Option<&'a T> {
        match self {
            Self::Begin(_) | Self::Switching(..) => None,
            Self::Row(row) => row.downcast(),
            Self::Report(report) => report.get(),
        }
    }
}

/// Selection of the pieces of motion that a record needs as a whole.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum PieceDemand {
    /// No piece.
    None,
    /// Pieces on which the angle may be farther from 0 than this (rad).
    Beyond(f64),
    /// All pieces.
    All,
}

impl PieceDemand {
    /// Returns the smallest selection that contains both.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::None, course) | (course, Self::None) => course,
            (Self::Beyond(a), Self::Beyond(b)) => Self::Beyond(a.min(b)),
            _ => Self::All,
        }
    }
}

/// Observer of a simulation.
pub trait Record {
    /// Returns true if the record needs the motion at each period of the scenario's log.
    fn wants_motion(&self) -> bool {
        false
    }

    /// Returns true if the record needs a filter's estimate at the sample of an instant.
    fn wants_estimates(&self, _now: Instant) -> bool {
        self.wants_motion()
    }

    /// Returns true if the record keeps the lines of the run's journal.
    fn wants_journal(&self) -> bool {
        true
    }

    /// Returns true if the record needs switchings.
    fn wants_switchings(&self) -> bool {
        true
    }

    /// Returns true if the record needs the signals that requirements over time read.
    fn wants_requirement_signals(&self) -> bool {
        false
    }

    /// Returns the selection of pieces of a one-axis motion that the record needs as a whole. A piece lasts from one
    /// change of the input to the next, whatever instants other records observe.
    fn piece_demand(&self) -> PieceDemand {
        PieceDemand::None
    }

    /// Observes a piece of motion that ends now.
    fn piece(&mut self, _now: Instant, _stretch: &MotionPiece) -> Result<(), RecordError> {
        Ok(())
    }

    /// Returns the scene that the run records for viewers; `None` if the record supplies none. Called at the start.
    fn scene(&self) -> Option<Box<dyn SceneSource>> {
        None
    }

    /// Records a sample.
    fn record(&mut self, now: Instant, sample: Sample<'_>) -> Result<(), RecordError>;

    /// Checks that the run may continue; called at every event, and at intervals in long searches and integrations.
    ///
    /// # Errors
    /// [`RecordError::Interrupted`] to end the run.
    fn poll(&mut self) -> Result<(), RecordError> {
        Ok(())
    }
}

/// Error of a record.
#[derive(Debug, Error)]
pub enum RecordError {
    /// Log that could not be written.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// Request of the user to stop.
    #[error("interrupted")]
    Interrupted,
    /// Custom topic that the log cannot have.
    #[error(transparent)]
    Topic(#[from] TopicError),
}

/// Detail in which a run is recorded.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Detail {
    /// Switchings, window means, adaptation: all changes.
    #[default]
    Events,
    /// In addition the motion at each period of the scenario's log, and at every switching.
    Full,
    /// In addition the scene: frames and shapes for three-dimensional viewers.
    Scene,
}

/// Destination of rows of any topic: messages, or columns in memory.
trait RowTaker {
    /// Records a row.
    fn take_row(&mut self, now: Instant, row: &dyn LogRow) -> Result<(), RecordError>;

    /// Records the rows of a sample that a record of this detail has.
    fn take_sample_rows(
        &mut self,
        now: Instant,
        sample: Sample<'_>,
        detail: Detail,
    ) -> Result<(), RecordError> {
        match sample {
            Sample::Begin(law) => self.take_row(now, law),
            Sample::Switching(command, _) => self.take_row(now, command),
            Sample::Row(row) if row.topic().detail() <= detail => self.take_row(now, row),
            Sample::Row(_) => Ok(()),
            Sample::Report(report) => {
                let mut rows = report.rows().filter(|row| row.topic().detail() <= detail);
                rows.try_for_each(|row| self.take_row(now, row))
            }
        }
    }
}
