//! Saving torn logs: what is whole in one, as a new log.

use std::collections::BTreeMap;
use std::fs;
use std::io::Cursor;
use std::path::Path;

use mcap::records::Record as McapRecord;
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{McapError, WriteOptions, Writer};

use super::LogError;
use super::log::LARGEST;
use crate::whole;

/// Copies what is whole in a torn log into a new one, and tells how many messages it saved.
pub fn recover(torn: &Path, path: &Path) -> Result<u64, LogError> {
    let bytes = fs::read(torn).map_err(|source| LogError::Io { path: torn.to_owned(), source })?;
    let damaged = |source| LogError::Damaged { path: torn.to_owned(), source };
    if !bytes.starts_with(mcap::MAGIC) {
        return Err(damaged(McapError::BadMagic));
    }
    // In memory, where the torn log is too: what cannot be recovered leaves no file.
    let options =
        WriteOptions::new().compression_threads(0).library(concat!("flexsc/", env!("CARGO_PKG_VERSION")));
    let mut writer = Writer::with_options(Cursor::new(Vec::new()), options).map_err(damaged)?;
    let saved = copy_records(&bytes, &mut writer).map_err(damaged)?;
    writer.finish().map_err(damaged)?;
    let unwritable = |source| LogError::Unwritable { path: path.to_owned(), source };
    whole::write(path, writer.into_inner().get_ref()).map_err(unwritable)?;
    Ok(saved)
}

fn copy_records(bytes: &[u8], writer: &mut Writer<Cursor<Vec<u8>>>) -> Result<u64, McapError> {
    let mut schemas = BTreeMap::from([(0, 0)]);
    let mut channels = BTreeMap::new();
    let mut pending = BTreeMap::new();
    let mut saved = 0;
    for record in Records::of(bytes) {
        match record {
            McapRecord::Schema { header, data } => {
                let id = writer.add_schema(&header.name, &header.encoding, &data)?;
                schemas.insert(header.id, id);
            }
            // Held back until its first message, so that no chunk is without one.
            McapRecord::Channel(channel) => {
                pending.insert(channel.id, channel);
            }
            McapRecord::Message { mut header, data } => {
                if let Some(c) = pending.remove(&header.channel_id) {
                    let schema = schemas.get(&c.schema_id).copied().unwrap_or(0);
                    let id = writer.add_channel(schema, &c.topic, &c.message_encoding, &c.metadata)?;
                    channels.insert(c.id, id);
                }
                header.channel_id = channels.get(&header.channel_id).copied().unwrap_or(0);
                writer.write_to_known_channel(&header, &data)?;
                saved += 1;
            }
            McapRecord::Attachment { header, data, .. } => writer.attach(&mcap::Attachment {
                log_time: header.log_time,
                create_time: header.create_time,
                name: header.name,
                media_type: header.media_type,
                data,
            })?,
            McapRecord::Metadata(metadata) => writer.write_metadata(&metadata)?,
            McapRecord::DataEnd(_) => break,
            _ => {}
        }
    }
    Ok(saved)
}

/// The records of a log up to the first one that cannot be read, which is where it was torn. Lengths have a bound, so
/// that damage is no demand for more memory than there is.
struct Records<'a> {
    rest: &'a [u8],
    reader: LinearReader,
}

impl<'a> Records<'a> {
    fn of(bytes: &'a [u8]) -> Self {
        let options = LinearReaderOptions::default()
            .with_record_length_limit(LARGEST)
            .with_skip_end_magic(true)
            .with_validate_chunk_crcs(true);
        Self { rest: bytes, reader: LinearReader::new_with_options(options) }
    }
}

impl Iterator for Records<'_> {
    type Item = McapRecord<'static>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let wanted = match self.reader.next_event()?.ok()? {
                LinearReadEvent::ReadRequest(wanted) => wanted,
                LinearReadEvent::Record { data, opcode } => {
                    return Some(mcap::parse_record(opcode, data).ok()?.into_owned());
                }
            };
            let (now, rest) = self.rest.split_at(wanted.min(self.rest.len()));
            self.reader.insert(now.len()).copy_from_slice(now);
            self.reader.notify_read(now.len());
            self.rest = rest;
        }
    }
}
