//! Log file: a run as MCAP, whose bytes depend only on the scenario, the seed and the version.

use std::collections::BTreeMap;
use std::io::{self, BufWriter, Cursor, Seek, Write};
use std::path::Path;

use flexsc_numerics::time::Instant;
use mcap::records::{MessageHeader, Metadata};
use mcap::{McapError, WriteOptions, Writer};

use super::log_file::{OWN_PART_FACTS, OWN_PARTS};
use super::message::{Message, MessageEncoder, MessageSink};
use super::metrics::Metrics;
use super::provenance_check::COMMANDED;
use super::row::TopicRow;
use super::topics::index_of;
use super::{
    Attachment, COMMANDS, Detail, LogTopic, Provenance, Record, RecordError, RunEnd, Sample, Summary, TOPICS,
};
use crate::atomic_file::AtomicFile;

/// Number of messages after which a chunk is closed: the largest number lost with a killed run.
const MESSAGES_PER_FLUSH: u64 = 2000;

/// Topic that is dated at the start of the run, because viewers show the last message before the instant of playback.
const FROM_START: usize = index_of(Summary::TOPIC.name);

/// Log of a run, written while it runs.
struct McapLog<W: Write + Seek> {
    log: MessageEncoder<Channels<W>>,
    /// External commands of the run, which follow the messages: they may be known only at the end.
    commands: Option<Attachment>,
}

impl<W: Write + Seek> McapLog<W> {
    /// Creates a log with its provenance written.
    fn new(writer: W, from: &Provenance, detail: Detail) -> Result<Self, RecordError> {
        let options =
            WriteOptions::new().compression_threads(0).library(concat!("flexsc/", env!("CARGO_PKG_VERSION")));
        let mut writer = Writer::with_options(writer, options).map_err(failure)?;
        attach(&mut writer, "scenario.toml", "application/toml", from.toml.as_bytes())?;
        let (commands, others): (Vec<_>, Vec<_>) =
            from.attachments.iter().partition(|attachment| attachment.name == COMMANDS);
        for Attachment { name, media_type, data } in others {
            attach(&mut writer, name, media_type, data)?;
        }
        let commands = commands.first().copied().cloned();
        let metadata = [
            ("version", env!("CARGO_PKG_VERSION").to_owned()),
            ("scenario", from.scenario.clone()),
            ("seed", from.seed.to_string()),
            ("run", from.run.to_string()),
            ("epoch_ns", from.epoch_ns.to_string()),
            ("time_base", "simulated nanoseconds past epoch_ns".to_owned()),
            ("units", "SI: rad, s, kg m², N m; suffixes of the fields name them".to_owned()),
        ];
        let metadata = metadata.map(|(key, value)| (key.to_owned(), value));
        let own = (!from.own_parts.is_empty()).then(|| (OWN_PARTS.to_owned(), from.own_parts.join(", ")));
        let facts = from.own_part_facts.as_ref().map(|facts| (OWN_PART_FACTS.to_owned(), facts.clone()));
        let commanded = commands.is_some().then(|| (COMMANDED.to_owned(), COMMANDS.to_owned()));
        write_metadata(
            &mut writer,
            "flexsc.run",
            metadata.into_iter().chain(own).chain(facts).chain(commanded).collect(),
        )?;
        let by_topic = vec![None; TOPICS.len()];
        let channels =
            Channels { writer, by_topic, since_flush: 0, start_ns: from.epoch_ns, from_start: Vec::new() };
        Ok(Self { log: MessageEncoder::new(channels, from, detail)?, commands })
    }

    /// Writes the metrics, the end of the run, and the file's summary.
    fn finish(self, metrics: &Metrics, end: RunEnd) -> Result<W, RecordError> {
        let (mut channels, last) = self.log.finish(metrics, end)?;
        channels.write_from_start()?;
        let mut writer = channels.writer;
        if let Some(Attachment { name, media_type, data }) = &self.commands {
            attach(&mut writer, name, media_type, data)?;
        }
        let end = match end {
            RunEnd::Complete => "complete",
            RunEnd::Interrupted => "interrupted",
            RunEnd::Failed => "failed",
        };
        let metadata = [("end", end.to_owned()), ("time_s", last.to_string())];
        let metadata = metadata.map(|(key, value)| (key.to_owned(), value));
        write_metadata(&mut writer, "flexsc.end", metadata.into())?;
        writer.finish().map_err(failure)?;
        Ok(writer.into_inner())
    }
}

/// Channels of a file, created with their first message.
struct Channels<W: Write + Seek> {
    writer: Writer<W>,
    /// Channel and number of messages of each topic that has any, in the order of [`TOPICS`] and then of the custom topics.
    by_topic: Vec<Option<(u16, u32)>>,
    since_flush: u64,
    /// Start of the run (ns past 1970 UTC).
    start_ns: u64,
    /// Messages of the topic [`FROM_START`], kept until the end of the file.
    from_start: Vec<Vec<u8>>,
}

impl<W: Write + Seek> Channels<W> {
    /// Writes the messages that are dated at the start. They have a chunk of their own: in one with the last rows, its
    /// span of time would be the whole run, and viewers would read it first.
    fn write_from_start(&mut self) -> Result<(), RecordError> {
        self.writer.flush().map_err(failure)?;
        for data in std::mem::take(&mut self.from_start) {
            self.write(FROM_START, self.start_ns, &data)?;
        }
        Ok(())
    }

    fn write(&mut self, topic: usize, log_time: u64, data: &[u8]) -> Result<(), RecordError> {
        let (channel_id, sequence) = self.channel(topic)?;
        self.by_topic[topic] = Some((channel_id, sequence.wrapping_add(1)));
        let header = MessageHeader { channel_id, sequence, log_time, publish_time: log_time };
        self.writer.write_to_known_channel(&header, data).map_err(failure)
    }

    fn channel(&mut self, index: usize) -> Result<(u16, u32), RecordError> {
        match self.by_topic[index] {
            Some(channel) => Ok(channel),
            None => self.add_channel(LogTopic::Declared(index)),
        }
    }

    fn add_channel(&mut self, topic: LogTopic<'_>) -> Result<(u16, u32), RecordError> {
        let schema = self.writer.add_schema(topic.message(), "protobuf", &topic.schema());
        let (schema, metadata) = (schema.map_err(failure)?, topic.channel_metadata());
        let id = self.writer.add_channel(schema, topic.name(), "protobuf", &metadata);
        Ok((id.map_err(failure)?, 0))
    }
}

impl<W: Write + Seek> MessageSink for Channels<W> {
    fn declare(&mut self, _: usize, topic: LogTopic<'_>) -> Result<(), RecordError> {
        let channel = self.add_channel(topic)?;
        self.by_topic.push(Some(channel));
        Ok(())
    }

    fn push(&mut self, message: Message<'_>) -> Result<(), RecordError> {
        if message.topic == FROM_START {
            self.from_start.push(message.data.to_owned());
            return Ok(());
        }
        self.write(message.topic, message.time_ns, message.data)?;
        self.since_flush += 1;
        // Flush only after a message: a chunk without one would start at time 0 in a viewer.
        if self.since_flush == MESSAGES_PER_FLUSH {
            self.since_flush = 0;
            self.writer.flush().map_err(failure)?;
        }
        Ok(())
    }
}

/// Log on disk, under a `.partial` name until it is finished. If it is dropped before, it is removed.
pub struct LogFile {
    log: McapLog<BufWriter<AtomicFile>>,
}

impl LogFile {
    /// Creates the file under its `.partial` name.
    pub fn create(path: &Path, from: &Provenance, detail: Detail) -> Result<Self, RecordError> {
        let file = BufWriter::new(AtomicFile::create(path)?);
        Ok(Self { log: McapLog::new(file, from, detail)? })
    }

    /// Replaces the external commands of the run, which its provenance announced.
    pub fn set_commands(&mut self, text: String) {
        if let Some(commands) = &mut self.log.commands {
            commands.data = text.into_bytes();
        }
    }

    /// Finishes the log, gives it its final name, and returns its size in bytes. A log that cannot be finished is
    /// removed.
    pub fn finish(self, metrics: &Metrics, end: RunEnd) -> Result<u64, RecordError> {
        let file = self.log.finish(metrics, end)?;
        let file = file.into_inner().map_err(io::IntoInnerError::into_error)?;
        Ok(file.finish()?)
    }
}

/// Log in memory, with the bytes of the file. `LogBytes` and [`LogFile`] are concrete types, so that their code is
/// compiled once, in this crate.
pub struct LogBytes {
    log: McapLog<Cursor<Vec<u8>>>,
}

impl LogBytes {
    /// Creates a log with its provenance written.
    pub fn new(from: &Provenance, detail: Detail) -> Result<Self, RecordError> {
        Ok(Self { log: McapLog::new(Cursor::new(Vec::new()), from, detail)? })
    }

    /// Finishes the log, and returns its bytes.
    pub fn finish(self, metrics: &Metrics, end: RunEnd) -> Result<Vec<u8>, RecordError> {
        Ok(self.log.finish(metrics, end)?.into_inner())
    }
}

/// Implements `Record` by the record in the field `log`.
macro_rules! records_within {
    ($($log:ty),+) => {
        $(impl Record for $log {
            fn wants_motion(&self) -> bool {
                self.log.wants_motion()
            }

            fn record(&mut self, now: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
                self.log.record(now, sample)
            }
        })+
    };
}

records_within!(McapLog<BufWriter<AtomicFile>>, McapLog<Cursor<Vec<u8>>>, LogFile, LogBytes);

fn attach<W: Write + Seek>(
    writer: &mut Writer<W>,
    name: &str,
    media_type: &str,
    data: &[u8],
) -> Result<(), RecordError> {
    let attachment = mcap::Attachment {
        log_time: 0,
        create_time: 0,
        name: name.to_owned(),
        media_type: media_type.to_owned(),
        data: data.into(),
    };
    writer.attach(&attachment).map_err(failure)
}

fn write_metadata<W: Write + Seek>(
    writer: &mut Writer<W>,
    name: &str,
    metadata: BTreeMap<String, String>,
) -> Result<(), RecordError> {
    writer.write_metadata(&Metadata { name: name.to_owned(), metadata }).map_err(failure)
}

fn failure(error: McapError) -> RecordError {
    match error {
        McapError::Io(error) => RecordError::Io(error),
        other => RecordError::Io(io::Error::other(other)),
    }
}
