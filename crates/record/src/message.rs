//! Messages: the rows of a run as bytes, identical for files and viewers.

use flexsc_numerics::time::{Instant, Span};

use super::custom_topic::CustomTopics;
use super::foxglove::{Log, LogLevel};
use super::metrics::Metrics;
use super::report::LogRow;
use super::row::LogDate;
use super::{Detail, LogTopic, OutputName, Params, Record, RecordError, RowTaker, Sample, Summary, TOPICS};

/// Provenance of a log.
#[derive(Clone, Debug, PartialEq)]
pub struct Provenance {
    /// Name of the scenario.
    pub scenario: String,
    /// Scenario with all defaults and drawn values, as TOML.
    pub toml: String,
    /// Seed of the scenario.
    pub seed: u64,
    /// Number of the run.
    pub run: u64,
    /// Date of the run's start in nanoseconds since 1970 UTC; 0 if the scenario has none.
    pub epoch_ns: u64,
    /// Observed coordinates, in the order in which they are logged.
    pub outputs: Vec<OutputName>,
    /// Roles of custom parts supplied by a calling program; with any, the run cannot be repeated from its scenario
    /// alone.
    pub own_parts: Vec<&'static str>,
    /// Facts about custom parts that figures show, as JSON; `None` without such parts.
    pub own_part_facts: Option<String>,
    /// Attached files, besides the scenario.
    pub attachments: Vec<Attachment>,
}

impl Provenance {
    /// Returns true if the run has external commands.
    pub fn is_commanded(&self) -> bool {
        self.attachments.iter().any(|attachment| attachment.name == COMMANDS)
    }
}

/// File within a log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Attachment {
    /// Name, such as `layout.json`.
    pub name: &'static str,
    /// Media type, such as `application/json`.
    pub media_type: &'static str,
    /// Contents of the file.
    pub data: Vec<u8>,
}

/// End of a run.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum RunEnd {
    /// Run that reached its duration.
    Complete,
    /// Run stopped by the user.
    Interrupted,
    /// Run that failed.
    Failed,
}

impl RunEnd {
    /// Returns the end of a run of the given duration that was left at the instant `left`.
    pub fn at(start: Instant, duration: Span) -> Self {
        if start < Instant::START + duration { Self::Interrupted } else { Self::Complete }
    }

    fn verb(self) -> &'static str {
        match self {
            Self::Complete => "ends",
            Self::Interrupted => "was interrupted",
            Self::Failed => "failed",
        }
    }
}

/// Name of the attachment with the external commands of a run.
pub const COMMANDS: &str = "commands.csv";

/// Message of a log.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct Message<'a> {
    /// Topic, as an index into [`TOPICS`]; custom topics follow in the order of [`MessageSink::declare`].
    pub topic: usize,
    /// Time in simulated nanoseconds past the epoch.
    pub time_ns: u64,
    /// Row as protobuf, with the topic's schema.
    pub data: &'a [u8],
}

/// Destination of messages: a file or a viewer.
pub trait MessageSink {
    /// Declares a custom topic before its first message, with its index.
    fn declare(&mut self, _index: usize, _topic: LogTopic<'_>) -> Result<(), RecordError> {
        Ok(())
    }

    /// Writes the next message. Times never decrease.
    fn push(&mut self, message: Message<'_>) -> Result<(), RecordError>;
}

/// Record that turns a run into messages.
pub struct MessageEncoder<M> {
    to: M,
    detail: Detail,
    epoch_ns: u64,
    last: Instant,
    buffer: Vec<u8>,
    custom: CustomTopics,
}

impl<M: MessageSink> MessageEncoder<M> {
    /// Creates the messages of a run, beginning with its parameters.
    pub fn new(to: M, from: &Provenance, detail: Detail) -> Result<Self, RecordError> {
        let mut encode = Self {
            to,
            detail,
            epoch_ns: from.epoch_ns,
            last: Instant::START,
            buffer: Vec::new(),
            custom: CustomTopics::default(),
        };
        let params = Params {
            scenario: from.scenario.clone(),
            seed: from.seed,
            run: from.run,
            toml: from.toml.clone(),
            outputs: from.outputs.clone(),
        };
        encode.rows().take_row(Instant::START, &params)?;
        Ok(encode)
    }

    /// Ends the messages with the metrics, if any, and a log line unless the run is complete; returns the destination,
    /// and the time of the last message.
    pub fn finish(mut self, metrics: &Metrics, end: RunEnd) -> Result<(M, Instant), RecordError> {
        if !metrics.0.is_empty() {
            let last = self.last;
            self.rows().take_row(last, &Summary::from_metrics(metrics))?;
            self.rows().take_row(last, &metrics.to_row())?;
        }
        if end != RunEnd::Complete {
            let timestamp = LogDate(self.epoch_ns + self.last.nanoseconds());
            let message = format!("the run {} at {} s", end.verb(), self.last.seconds());
            let (level, name) = (LogLevel::Warning, "run".to_owned());
            let last = self.last;
            self.rows().take_row(last, &Log { timestamp, level, message, name })?;
        }
        Ok((self.to, self.last))
    }
}

impl<M: MessageSink> MessageEncoder<M> {
    fn rows(&mut self) -> RowSink<'_> {
        let Self { to, epoch_ns, last, buffer, custom, .. } = self;
        RowSink { to, epoch_ns: *epoch_ns, last, buffer, custom }
    }
}

/// Encoder of rows for any destination of messages.
struct RowSink<'a> {
    to: &'a mut dyn MessageSink,
    epoch_ns: u64,
    last: &'a mut Instant,
    buffer: &'a mut Vec<u8>,
    custom: &'a mut CustomTopics,
}

impl RowTaker for RowSink<'_> {
    fn take_row(&mut self, now: Instant, row: &dyn LogRow) -> Result<(), RecordError> {
        let topic = match row.topic() {
            LogTopic::Declared(index) => index,
            LogTopic::Custom(topic) => {
                let (index, is_new) = self.custom.index(topic)?;
                let index = TOPICS.len() + index;
                if is_new {
                    self.to.declare(index, row.topic())?;
                }
                index
            }
        };
        self.buffer.clear();
        row.encode(self.buffer);
        *self.last = now;
        self.to.push(Message { topic, time_ns: self.epoch_ns + now.nanoseconds(), data: self.buffer })
    }
}

impl<M: MessageSink> Record for MessageEncoder<M> {
    fn wants_motion(&self) -> bool {
        self.detail >= Detail::Full
    }

    fn record(&mut self, now: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        let detail = self.detail;
        self.rows().take_sample_rows(now, sample, detail)
    }
}
