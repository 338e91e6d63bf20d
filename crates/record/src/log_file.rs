//! Reading of logs: any topic as columns, by the schema that the file contains.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io::{Read, Seek, SeekFrom};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use mcap::McapError;
use mcap::records::{Channel, Record};
use mcap::sans_io::LinearReaderOptions;
use thiserror::Error;

use super::custom_topic::{CustomField, CustomTopic};
use super::decoder::Schema;
use super::log_topic::UNIT_KEY;
use super::mcap_reader::{for_each_record, outer_records, parsed};
use super::memory_budget::MemoryBudget;
use super::topic_table::TopicTable;
use super::topics::TOPICS;
use super::{COMMANDS, Column, Columns};

/// Returns a hint for a topic that other logs contain.
fn elsewhere(topic: &str) -> &'static str {
    if TOPICS.iter().any(|known| known.name == topic) {
        "\nhint: its scenario has no such part, or the run was not made with `--log full`, which also keeps the motion"
    } else {
        ""
    }
}

/// Error of a log that cannot be used.
#[derive(Debug, Error)]
pub enum LogError {
    /// Unreadable file.
    #[error("{}: {source}", path.display())]
    Io {
        /// Path of the file.
        path: PathBuf,
        /// Error of the file system.
        source: std::io::Error,
    },
    /// File that ends early because its run was killed.
    #[error(
        "{}: the log is torn (its run was killed, or still runs)\n\nhint: `flexsc log recover {}` saves \
         what was written",
        path.display(), path.display()
    )]
    Torn {
        /// Path of the file.
        path: PathBuf,
    },
    /// Damaged file, or a file that is not MCAP.
    #[error("{}: not a readable MCAP log: {source}", path.display())]
    Damaged {
        /// Path of the file.
        path: PathBuf,
        /// Error of the reader.
        source: McapError,
    },
    /// Scenario in place of a log.
    #[error("{}: a scenario, not a log\n\nhint: `flexsc simulate {}` writes its log", path.display(), path.display())]
    Scenario {
        /// Path of the file.
        path: PathBuf,
    },
    /// Rows of a campaign in place of a log.
    #[error("{}: a table, not a log\n\nhint: a campaign is drawn from its directory: `flexsc simulate SCENARIO --runs N -o DIR`", path.display())]
    Rows {
        /// Path of the file.
        path: PathBuf,
    },
    /// Topic that is not in the log.
    #[error("{}: no topic `{topic}` in this log\n\nhint: it has {topics}{}", path.display(), elsewhere(topic))]
    NoTopic {
        /// Path of the file.
        path: PathBuf,
        /// Requested topic.
        topic: String,
        /// Topics of the log.
        topics: String,
    },
    /// Log of another program.
    #[error("{}: contains no scenario, so it is not a log of flexsc\n\nhint: `flexsc export` reads any MCAP log of protobuf messages", path.display())]
    NoScenario {
        /// Path of the file.
        path: PathBuf,
    },
    /// Message that cannot be decoded.
    #[error("{}: topic `{topic}` cannot be decoded: {why}", path.display())]
    Undecodable {
        /// Path of the file.
        path: PathBuf,
        /// Topic of the message.
        topic: String,
        /// Reason.
        why: String,
    },
}

/// Keys of the run's metadata that name the roles of custom parts, and that hold facts about them as JSON.
pub(super) const OWN_PARTS: &str = "own_parts";
pub(super) const OWN_PART_FACTS: &str = "own_part_facts";

/// Log in memory.
pub struct Log {
    path: PathBuf,
    bytes: Vec<u8>,
    epoch_ns: u64,
    metadata: BTreeMap<String, String>,
    topics: Vec<String>,
    /// Units of the fields of custom topics, by topic and field.
    units: BTreeMap<String, BTreeMap<String, String>>,
    scenario: Option<String>,
    commands: Option<String>,
}

/// Reads the bytes of a file that begins like a log.
pub(super) fn read_file(path: &Path) -> Result<Vec<u8>, LogError> {
    let io = |source| LogError::Io { path: path.to_owned(), source };
    // A pipe or a device may never end.
    if !fs::metadata(path).map_err(io)?.is_file() {
        return Err(io(std::io::Error::other("not a file")));
    }
    let mut file = File::open(path).map_err(io)?;
    let mut magic = [0; 8];
    if file.read_exact(&mut magic).is_err() || magic != *mcap::MAGIC {
        let path = path.to_owned();
        return Err(match path.extension().and_then(|extension| extension.to_str()) {
            Some("toml") => LogError::Scenario { path },
            Some("csv" | "parquet") => LogError::Rows { path },
            _ => LogError::Damaged { path, source: McapError::BadMagic },
        });
    }
    let mut bytes = Vec::new();
    let length = file.seek(SeekFrom::End(0)).map_err(io)?;
    // A file larger than the memory causes an error, and no abort.
    let room = usize::try_from(length).ok().and_then(|length| bytes.try_reserve_exact(length).ok());
    room.ok_or_else(|| io(std::io::ErrorKind::OutOfMemory.into()))?;
    file.seek(SeekFrom::Start(0)).map_err(io)?;
    file.take(length).read_to_end(&mut bytes).map_err(io)?;
    Ok(bytes)
}

impl Log {
    /// Reads a log file.
    pub fn open(path: &Path) -> Result<Self, LogError> {
        Self::read(path, read_file(path)?)
    }

    /// Reads a log that is in memory, and that messages call `path`.
    ///
    /// The index in the summary at the end of a file is not used, because its offsets may be wrong.
    pub fn read(path: &Path, bytes: Vec<u8>) -> Result<Self, LogError> {
        let damaged = |source| LogError::Damaged { path: path.to_owned(), source };
        if !bytes.starts_with(mcap::MAGIC) {
            return Err(damaged(McapError::BadMagic));
        }
        if bytes.len() < 2 * mcap::MAGIC.len() || !bytes.ends_with(mcap::MAGIC) {
            return Err(LogError::Torn { path: path.to_owned() });
        }
        let mut metadata = BTreeMap::new();
        let (mut scenario, mut commands) = (None, None);
        let mut channels = Vec::new();
        for (opcode, body) in outer_records(&bytes).map_err(damaged)? {
            match parsed(opcode, body).map_err(damaged)? {
                Some(Record::Metadata(record)) => metadata.extend(record.metadata),
                Some(Record::Attachment { header, data, .. }) if header.name == "scenario.toml" => {
                    scenario = Some(String::from_utf8_lossy(&data).into_owned());
                }
                Some(Record::Attachment { header, data, .. }) if header.name == COMMANDS => {
                    commands = Some(String::from_utf8_lossy(&data).into_owned());
                }
                Some(Record::Channel(channel)) => channels.push(channel),
                _ => {}
            }
        }
        if channels.is_empty() {
            // The summary of some logs does not repeat the channels, which are then within chunks.
            let reported = for_each_record(&bytes, checked(), |record| {
                if let Record::Channel(channel) = record {
                    channels.push(channel);
                }
                Ok(ControlFlow::Continue(()))
            });
            reported.map_err(damaged)?;
        }
        let epoch_ns = metadata.get("epoch_ns").and_then(|ns| ns.parse().ok()).unwrap_or(0);
        let topics: BTreeSet<String> = channels.iter().map(|channel| channel.topic.clone()).collect();
        let topics = topics.into_iter().collect();
        let units = channels.into_iter().map(|channel| (channel.topic, units_in(channel.metadata))).collect();
        Ok(Self { path: path.to_owned(), bytes, epoch_ns, metadata, topics, units, scenario, commands })
    }

    /// Returns the path of the log, as messages call it.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the bytes of the file.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Returns the topics of the log.
    pub fn topics(&self) -> &[String] {
        &self.topics
    }

    /// Returns the units that the log gives for the fields of a topic; empty for topics of the engine, whose field names
    /// end with their units.
    pub fn units(&self, topic: &str) -> BTreeMap<String, String> {
        self.units.get(topic).cloned().unwrap_or_default()
    }

    /// Returns the metadata of the run: `scenario`, `seed`, `run`, `version`, `end`, ...
    pub fn metadata(&self) -> &BTreeMap<String, String> {
        &self.metadata
    }

    /// Returns the roles of the custom parts of the run, such as `law, sensor`; `None` without any.
    pub fn own_parts(&self) -> Option<&str> {
        self.metadata.get(OWN_PARTS).map(String::as_str)
    }

    /// Returns the facts about the custom parts of the run as JSON, if the log has them.
    pub fn own_part_facts(&self) -> Option<&str> {
        self.metadata.get(OWN_PART_FACTS).map(String::as_str)
    }

    /// Returns the topics of the log that the engine does not declare, with the fields that have columns of numbers or words.
    pub fn custom_topics(&self) -> Result<Vec<Arc<CustomTopic>>, LogError> {
        let is_custom = |name: &&String| TOPICS.iter().all(|known| known.name != name.as_str());
        let names: Vec<&str> = self.topics.iter().filter(is_custom).map(String::as_str).collect();
        let tables = self.tables(&names)?.into_iter().zip(&names);
        let topic = |(table, name): (Option<Columns>, &&str)| {
            let mut units = self.units(name);
            let field = |(field, column): (String, Column)| match column {
                Column::Numbers(_) if field != "time_s" => {
                    let unit = units.remove(&field).unwrap_or_default();
                    Some(CustomField::new(field, unit, ""))
                }
                Column::Texts(_) => Some(CustomField::word(field, "")),
                _ => None,
            };
            CustomTopic::new(*name, "", table?.columns.into_iter().filter_map(field).collect()).ok()
        };
        Ok(tables.filter_map(topic).collect())
    }

    /// Returns the external commands of the run as text, if there were any.
    pub fn commands(&self) -> Option<&str> {
        self.commands.as_deref()
    }

    /// Returns the scenario of the run, as TOML.
    pub fn scenario(&self) -> Option<&str> {
        self.scenario.as_deref()
    }

    /// Returns the scenario of the run, or an error if there is none.
    ///
    /// # Errors
    /// A log without a scenario, which is not one of flexsc.
    pub fn require_scenario(&self) -> Result<&str, LogError> {
        self.scenario().ok_or_else(|| LogError::NoScenario { path: self.path.clone() })
    }

    /// Returns the rows of a topic. The first column is `time_s`: a field of the messages, or else their log time.
    pub fn columns(&self, topic: &str) -> Result<Columns, LogError> {
        let columns = self.tables(&[topic])?.pop().flatten();
        if columns.is_none() && self.topics.iter().any(|own| own == topic) {
            let (path, topic) = (self.path.clone(), topic.to_owned());
            return Err(LogError::Undecodable { path, topic, why: "it has no messages".to_owned() });
        }
        columns.ok_or_else(|| LogError::NoTopic {
            path: self.path.clone(),
            topic: topic.to_owned(),
            topics: self.topics.join(", "),
        })
    }

    /// Returns the rows of several topics in one pass through the log; `None` for a topic that it does not have.
    pub fn tables(&self, topics: &[&str]) -> Result<Vec<Option<Columns>>, LogError> {
        let mut tables: Vec<Option<TopicTable>> = topics.iter().map(|_| None).collect();
        let mut budget = MemoryBudget::for_file(self.bytes.len());
        let mut schemas = BTreeMap::new();
        let mut channels: BTreeMap<u16, Channel> = BTreeMap::new();
        let mut undecodable = None;
        let reported = for_each_record(&self.bytes, checked(), |record| {
            match record {
                Record::Schema { header, data } => {
                    let (name, encoding) = (header.name, header.encoding);
                    let schema = Schema { name, encoding, data: data.into_owned() };
                    schemas.insert(header.id, Arc::new(schema));
                }
                Record::Channel(channel) => {
                    channels.insert(channel.id, channel);
                }
                Record::Message { header, data } => {
                    let Some(channel) = channels.get(&header.channel_id) else {
                        return Err(McapError::UnknownChannel(header.sequence, header.channel_id));
                    };
                    let Some(index) = topics.iter().position(|requested| *requested == channel.topic) else {
                        return Ok(ControlFlow::Continue(()));
                    };
                    let time = header.log_time.saturating_sub(self.epoch_ns) as f64 / 1e9;
                    let schema = schemas.get(&channel.schema_id);
                    if let Err(why) =
                        append_message(&mut tables[index], channel, schema, &data, time, &mut budget)
                    {
                        undecodable = Some((channel.topic.clone(), why));
                        return Ok(ControlFlow::Break(()));
                    }
                }
                _ => {}
            }
            Ok(ControlFlow::Continue(()))
        });
        reported.map_err(|source| LogError::Damaged { path: self.path.clone(), source })?;
        if let Some((topic, why)) = undecodable {
            return Err(LogError::Undecodable { path: self.path.clone(), topic, why });
        }
        Ok(tables.into_iter().map(|table| table.map(TopicTable::into_columns)).collect())
    }
}

/// Returns the units in the metadata of a channel, by field.
fn units_in(metadata: BTreeMap<String, String>) -> BTreeMap<String, String> {
    let unit = |(key, unit): (String, String)| Some((key.strip_prefix(UNIT_KEY)?.to_owned(), unit));
    metadata.into_iter().filter_map(unit).collect()
}

/// Appends a message of a topic to its table.
fn append_message(
    table: &mut Option<TopicTable>,
    channel: &Channel,
    schema: Option<&Arc<Schema>>,
    data: &[u8],
    time: f64,
    budget: &mut MemoryBudget,
) -> Result<(), String> {
    let schema = schema.ok_or("no schema")?;
    let table = match table {
        Some(table) if table.has_schema(schema) => table,
        Some(_) => return Err("its messages have more than one schema".to_owned()),
        none => {
            if channel.message_encoding != "protobuf" {
                let (message, schema) = (&channel.message_encoding, &schema.encoding);
                return Err(format!(
                    "only protobuf messages are read, and these are `{message}` with a schema in `{schema}`"
                ));
            }
            none.insert(TopicTable::for_schema(Arc::clone(schema))?)
        }
    };
    table.push(time, data, budget)
}

/// Returns options by which checksums are verified before data is used.
fn checked() -> LinearReaderOptions {
    LinearReaderOptions::default().with_prevalidate_chunk_crcs(true)
}
