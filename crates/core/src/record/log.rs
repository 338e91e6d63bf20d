//! Reading logs back: any topic as columns, by the schema that the file itself carries.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use mcap::sans_io::{LinearReaderOptions, MessageReadEvent, MessageReader};
use mcap::{McapError, Message};
use thiserror::Error;

use super::Columns;
use super::table::Table;

/// No chunk or record of a log is larger (bytes); ours are of 1 MiB.
pub const LARGEST: usize = 256 << 20;

/// A log that cannot be used.
#[derive(Debug, Error)]
pub enum LogError {
    /// The file cannot be read.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The file cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The file ends early: its run was killed.
    #[error(
        "{}: the log is torn (its run was killed, or still runs)\n\nhint: `flexsc log recover {}` saves \
         what was written",
        path.display(), path.display()
    )]
    Torn {
        /// The file.
        path: PathBuf,
    },
    /// The file is no MCAP file, or a damaged one.
    #[error("{}: not a readable MCAP log: {source}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// Why.
        source: McapError,
    },
    /// The log has no such topic.
    #[error("{}: no topic `{topic}` in this log\n\nhint: it has {topics}", path.display())]
    NoTopic {
        /// The file.
        path: PathBuf,
        /// The topic asked for.
        topic: String,
        /// Those that there are.
        topics: String,
    },
    /// A message cannot be decoded.
    #[error("{}: topic `{topic}` cannot be decoded: {why}", path.display())]
    Undecodable {
        /// The file.
        path: PathBuf,
        /// The topic.
        topic: String,
        /// Why.
        why: String,
    },
}

/// A log in memory.
pub struct Log {
    path: PathBuf,
    bytes: Vec<u8>,
    epoch_ns: u64,
    metadata: BTreeMap<String, String>,
    topics: Vec<String>,
    scenario: Option<String>,
}

impl Log {
    /// Reads a log file.
    pub fn open(path: &Path) -> Result<Self, LogError> {
        let io = |source| LogError::Io { path: path.to_owned(), source };
        Self::read(path, fs::read(path).map_err(io)?)
    }

    /// Reads a log that is in memory. `path` is what errors call it.
    pub fn read(path: &Path, bytes: Vec<u8>) -> Result<Self, LogError> {
        let damaged = |source| LogError::Damaged { path: path.to_owned(), source };
        if !bytes.starts_with(mcap::MAGIC) {
            return Err(damaged(McapError::BadMagic));
        }
        if !bytes.ends_with(mcap::MAGIC) {
            return Err(LogError::Torn { path: path.to_owned() });
        }
        let summary = mcap::Summary::read(&bytes).map_err(damaged)?.unwrap_or_default();
        let mut metadata = BTreeMap::new();
        for index in &summary.metadata_indexes {
            metadata.extend(mcap::read::metadata(&bytes, index).map_err(damaged)?.metadata);
        }
        let mut scenario = None;
        for index in summary.attachment_indexes.iter().filter(|i| i.name == "scenario.toml") {
            let attachment = mcap::read::attachment(&bytes, index).map_err(damaged)?;
            scenario = Some(String::from_utf8_lossy(&attachment.data).into_owned());
        }
        let mut topics: Vec<_> = summary.channels.values().map(|c| c.topic.clone()).collect();
        topics.sort();
        let epoch_ns = metadata.get("epoch_ns").and_then(|ns| ns.parse().ok()).unwrap_or(0);
        Ok(Self { path: path.to_owned(), bytes, epoch_ns, metadata, topics, scenario })
    }

    /// The topics that the log has.
    pub fn topics(&self) -> &[String] {
        &self.topics
    }

    /// What the log says about its run: `scenario`, `seed`, `run`, `version`, `end`, ...
    pub fn metadata(&self) -> &BTreeMap<String, String> {
        &self.metadata
    }

    /// The scenario that was run, as TOML.
    pub fn scenario(&self) -> Option<&str> {
        self.scenario.as_deref()
    }

    /// The rows of a topic. The first column is `time_s`: the messages' own, or else their log time.
    pub fn columns(&self, topic: &str) -> Result<Columns, LogError> {
        let columns = self.tables(&[topic])?.pop().flatten();
        columns.ok_or_else(|| LogError::NoTopic {
            path: self.path.clone(),
            topic: topic.to_owned(),
            topics: self.topics.join(", "),
        })
    }

    /// The rows of several topics in one pass through the log; nothing for a topic that it does not have.
    pub fn tables(&self, topics: &[&str]) -> Result<Vec<Option<Columns>>, LogError> {
        let damaged = |source| LogError::Damaged { path: self.path.clone(), source };
        let mut tables: Vec<Option<Table>> = topics.iter().map(|_| None).collect();
        for message in Messages::of(&self.bytes) {
            let message = message.map_err(damaged)?;
            let topic = &message.channel.topic;
            let Some(index) = topics.iter().position(|asked| asked == topic) else { continue };
            let undecodable =
                |why| LogError::Undecodable { path: self.path.clone(), topic: topic.clone(), why };
            let table = match &mut tables[index] {
                Some(table) => table,
                none => none.insert(Table::of(message.channel.schema.as_deref()).map_err(undecodable)?),
            };
            table.times.push(message.log_time.saturating_sub(self.epoch_ns) as f64 / 1e9);
            table.push(&message.data).map_err(undecodable)?;
        }
        Ok(tables.into_iter().map(|table| table.map(Table::into_columns)).collect())
    }
}

/// The messages of a log. Checksums come first and lengths have a bound, so that damage is an error, and neither a
/// wrong number nor a demand for more memory than there is.
struct Messages<'a> {
    rest: &'a [u8],
    reader: MessageReader,
}

impl<'a> Messages<'a> {
    fn of(bytes: &'a [u8]) -> Self {
        let options = LinearReaderOptions::default()
            .with_record_length_limit(LARGEST)
            .with_prevalidate_chunk_crcs(true);
        Self { rest: bytes, reader: MessageReader::new_with_options(options) }
    }
}

impl Iterator for Messages<'_> {
    type Item = Result<Message<'static>, McapError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            match self.reader.next_event()? {
                Ok(MessageReadEvent::ReadRequest(wanted)) => {
                    let (now, rest) = self.rest.split_at(wanted.min(self.rest.len()));
                    self.reader.insert(now.len()).copy_from_slice(now);
                    self.reader.notify_read(now.len());
                    self.rest = rest;
                }
                Ok(MessageReadEvent::Message(message)) => return Some(Ok(message)),
                Err(error) => return Some(Err(error)),
            }
        }
    }
}
