//! Provenance of an existing log, read from its beginning, to decide if another log may replace it.

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

use mcap::records::Record as McapRecord;
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use toml::{Table, Value};

use super::mcap_reader::LARGEST;
use super::{COMMANDS, Provenance};

/// Key of the run's metadata that names the attachment with its external commands, if there were any.
pub(super) const COMMANDED: &str = "commands";

/// Existing file in the place of a log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ExistingLog {
    /// No file.
    Nothing,
    /// Log of the same run: of the same scenario, seed, number and version, and without external commands.
    Same,
    /// Another file, with its description.
    Other(String),
}

/// Returns the kind of file in the place of a run's log.
pub fn existing_log(path: &Path, run: &Provenance) -> ExistingLog {
    let Ok(file) = File::open(path) else {
        return if path.exists() {
            ExistingLog::Other("cannot be read".to_owned())
        } else {
            ExistingLog::Nothing
        };
    };
    let Some(origin) = LogOrigin::read(BufReader::new(file)) else {
        return ExistingLog::Other("is not a log of flexsc".to_owned());
    };
    let own = (env!("CARGO_PKG_VERSION"), run.seed.to_string(), run.run.to_string());
    let LogOrigin { toml, version, seed, run: number, is_commanded } = origin;
    if version != own.0 {
        ExistingLog::Other(format!("holds a run of flexsc {version}, and this is {}", own.0))
    } else if number != own.2 {
        ExistingLog::Other(format!("holds run {number}, not run {}", own.2))
    } else if toml != run.toml {
        ExistingLog::Other(format!("holds a run with other settings{}", difference(&toml, &run.toml)))
    } else if seed != own.1 {
        ExistingLog::Other(format!("holds a run with the seed {seed}, not {}", own.1))
    } else if is_commanded || run.is_commanded() {
        ExistingLog::Other(match (is_commanded, run.is_commanded()) {
            (_, false) => "holds a run that was stepped under commands".to_owned(),
            (false, _) => "holds a run without commands".to_owned(),
            _ => "holds a run under commands, which may be others".to_owned(),
        })
    } else {
        ExistingLog::Same
    }
}

/// Returns the first key in which two scenarios differ, with both values if they are short.
pub fn difference(existing: &str, current: &str) -> String {
    let (Ok(existing), Ok(current)) = (existing.parse::<Table>(), current.parse::<Table>()) else {
        return String::new();
    };
    let Some((key, existing, current)) = first_difference("", &existing, &current) else {
        return String::new();
    };
    let short = |value: &Value| {
        let text = value.to_string();
        let is_long = matches!(value, Value::Table(_) | Value::Array(_)) && text.len() > 60;
        (!is_long).then_some(text)
    };
    match (existing, current) {
        (Some(existing), Some(current)) => match (short(existing), short(current)) {
            (Some(existing), Some(current)) => format!(" (`{key}`: {existing} before, {current} now)"),
            _ => format!(" (`{key}`: changed)"),
        },
        (Some(_), None) => format!(" (`{key}`: removed)"),
        (None, Some(_)) => format!(" (`{key}`: added)"),
        (None, None) => String::new(),
    }
}

type Difference<'a> = (String, Option<&'a Value>, Option<&'a Value>);

fn first_difference<'a>(within: &str, existing: &'a Table, current: &'a Table) -> Option<Difference<'a>> {
    let keys = existing.keys().chain(current.keys().filter(|key| !existing.contains_key(*key)));
    keys.filter(|key| existing.get(*key) != current.get(*key)).find_map(|key| {
        let path = if within.is_empty() { key.clone() } else { format!("{within}.{key}") };
        match (existing.get(key), current.get(key)) {
            (Some(Value::Table(existing)), Some(Value::Table(current))) => {
                first_difference(&path, existing, current)
            }
            (existing, current) => Some((path, existing, current)),
        }
    })
}

/// Provenance of a log by its own metadata.
struct LogOrigin {
    toml: String,
    version: String,
    seed: String,
    run: String,
    /// True if the run had external commands.
    is_commanded: bool,
}

impl LogOrigin {
    /// Reads a log up to the metadata of its run, which precedes all messages.
    fn read(mut file: impl Read) -> Option<Self> {
        let options = LinearReaderOptions::default().with_record_length_limit(LARGEST);
        let mut reader = LinearReader::new_with_options(options);
        let (mut toml, mut is_commanded) = (String::new(), false);
        loop {
            match reader.next_event()?.ok()? {
                LinearReadEvent::ReadRequest(wanted) => {
                    let read = file.read(reader.insert(wanted)).ok()?;
                    reader.notify_read(read);
                }
                LinearReadEvent::Record { data, opcode } => match mcap::parse_record(opcode, data).ok()? {
                    McapRecord::Attachment { header, data, .. } if header.name == "scenario.toml" => {
                        toml = String::from_utf8(data.into_owned()).ok()?;
                    }
                    McapRecord::Attachment { header, .. } if header.name == COMMANDS => is_commanded = true,
                    McapRecord::Metadata(mut metadata) if metadata.name == "flexsc.run" => {
                        let mut entry = |key: &str| metadata.metadata.remove(key).unwrap_or_default();
                        let (version, seed, run) = (entry("version"), entry("seed"), entry("run"));
                        is_commanded |= metadata.metadata.contains_key(COMMANDED);
                        return Some(Self { toml, version, seed, run, is_commanded });
                    }
                    McapRecord::Message { .. } | McapRecord::Chunk { .. } | McapRecord::DataEnd(_) => {
                        return None;
                    }
                    _ => {}
                },
            }
        }
    }
}
