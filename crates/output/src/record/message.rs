//! Messages: the rows of a run as the bytes that every log of it holds, wherever they go.

use super::foxglove::{Log, LogLevel};
use super::measured::Metrics;
use super::proto::Encoder;
use super::row::{Stamp, TopicRow};
use super::topics::index_of;
use super::{Detail, OutputName, Params, Record, RecordError, Sample, Summary, TakeRow};
use crate::time::{Instant, Span};

/// The provenance of a log.
#[derive(Clone, Debug, PartialEq)]
pub struct Provenance {
    /// Name of the scenario.
    pub scenario: String,
    /// The scenario with all defaults and drawn values, as TOML.
    pub toml: String,
    /// Seed of the scenario.
    pub seed: u64,
    /// Number of the run.
    pub run: u64,
    /// Date of the run's start in nanoseconds since 1970 UTC; 0 if the scenario has none.
    pub epoch_ns: u64,
    /// The observed coordinates, in the order in which they are logged.
    pub outputs: Vec<OutputName>,
    /// The roles of parts that a program brought with it: with some the run does not repeat from its scenario alone.
    pub own_parts: Vec<&'static str>,
    /// What lies in the log beside its messages and its scenario.
    pub attachments: Vec<Attachment>,
}

impl Provenance {
    /// The commands from outside under which it was run, if there were any.
    pub fn commands(&self) -> Option<&[u8]> {
        let commands = self.attachments.iter().find(|attachment| attachment.name == COMMANDS)?;
        Some(&commands.data)
    }
}

/// A file within a log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Attachment {
    /// Its name, such as `layout.json`.
    pub name: &'static str,
    /// Its media type, such as `application/json`.
    pub media_type: &'static str,
    /// What it holds.
    pub data: Vec<u8>,
}

/// How a run ended.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum RunEnd {
    /// It reached its duration.
    Complete,
    /// The user stopped it.
    Interrupted,
    /// It failed.
    Failed,
}

impl RunEnd {
    /// How a run of this duration ended that was left at an instant.
    pub fn at(left: Instant, duration: Span) -> Self {
        if left < Instant::START + duration { Self::Interrupted } else { Self::Complete }
    }

    fn verb(self) -> &'static str {
        match self {
            Self::Complete => "ends",
            Self::Interrupted => "was interrupted",
            Self::Failed => "failed",
        }
    }
}

/// The attachment of a log that holds the commands from outside under which it was run.
pub const COMMANDS: &str = "commands.csv";

/// A message of a log.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct Message<'a> {
    /// Its topic, as an index into [`TOPICS`](super::TOPICS).
    pub topic: usize,
    /// Its time in simulated nanoseconds past the epoch.
    pub time_ns: u64,
    /// The row as protobuf, of the topic's schema.
    pub data: &'a [u8],
}

/// Where messages go: a file, a viewer.
pub trait Messages {
    /// Takes the next message. Times never go back.
    fn take(&mut self, message: Message<'_>) -> Result<(), RecordError>;
}

/// A record that turns a run into messages.
pub struct Encode<M> {
    to: M,
    detail: Detail,
    epoch_ns: u64,
    last: Instant,
    buffer: Vec<u8>,
}

impl<M: Messages> Encode<M> {
    /// The messages of a run, beginning with its parameters.
    pub fn new(to: M, from: &Provenance, detail: Detail) -> Result<Self, RecordError> {
        let mut encode =
            Self { to, detail, epoch_ns: from.epoch_ns, last: Instant::START, buffer: Vec::new() };
        let params = Params {
            scenario: from.scenario.clone(),
            seed: from.seed,
            run: from.run,
            toml: from.toml.clone(),
            outputs: from.outputs.clone(),
        };
        encode.rows().take(Instant::START, &params)?;
        Ok(encode)
    }

    /// Ends the messages with the metrics, if there are any, and how the run ended, if before its time; tells where the
    /// messages went, and the time of the last.
    pub fn finish(mut self, metrics: &Metrics, end: RunEnd) -> Result<(M, Instant), RecordError> {
        if !metrics.0.is_empty() {
            let last = self.last;
            self.rows().take(last, &Summary::of(metrics))?;
            self.rows().take(last, &metrics.to_row())?;
        }
        if end != RunEnd::Complete {
            let timestamp = Stamp(self.epoch_ns + self.last.nanoseconds());
            let message = format!("the run {} at {} s", end.verb(), self.last.seconds());
            let (level, name) = (LogLevel::Warning, "run".to_owned());
            let last = self.last;
            self.rows().take(last, &Log { timestamp, level, message, name })?;
        }
        Ok((self.to, self.last))
    }
}

impl<M: Messages> Encode<M> {
    fn rows(&mut self) -> Rows<'_> {
        Rows { to: &mut self.to, epoch_ns: self.epoch_ns, last: &mut self.last, buffer: &mut self.buffer }
    }
}

/// Takes rows, wherever the messages go.
struct Rows<'a> {
    to: &'a mut dyn Messages,
    epoch_ns: u64,
    last: &'a mut Instant,
    buffer: &'a mut Vec<u8>,
}

impl TakeRow for Rows<'_> {
    fn take<R: TopicRow>(&mut self, now: Instant, row: &R) -> Result<(), RecordError> {
        self.buffer.clear();
        Encoder::encode(row, self.buffer);
        *self.last = now;
        self.to.take(Message {
            topic: const { index_of(R::TOPIC.name) },
            time_ns: self.epoch_ns + now.nanoseconds(),
            data: self.buffer,
        })
    }
}

impl<M: Messages> Record for Encode<M> {
    fn dense(&self) -> bool {
        self.detail >= Detail::Full
    }

    fn scene(&self) -> bool {
        self.detail >= Detail::Scene
    }

    fn record(&mut self, now: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        // Another record may want more.
        if sample.detail() > self.detail { Ok(()) } else { self.rows().take_sample(now, sample) }
    }
}
