//! Recovery of torn logs: the complete part, as a new log.

use std::collections::BTreeMap;
use std::io::Cursor;
use std::ops::ControlFlow;
use std::path::Path;

use mcap::records::Record;
use mcap::sans_io::LinearReaderOptions;
use mcap::{McapError, WriteOptions, Writer};

use super::LogError;
use super::log_file::read_file;
use super::mcap_reader::for_each_record;

/// Returns a log of the complete part of a torn one, and the number of messages saved.
pub fn recover(torn: &Path) -> Result<(Vec<u8>, u64), LogError> {
    let bytes = read_file(torn)?;
    let damaged = |source| LogError::Damaged { path: torn.to_owned(), source };
    // In memory, as the torn log is: if recovery fails, no file remains.
    let options =
        WriteOptions::new().compression_threads(0).library(concat!("flexsc/", env!("CARGO_PKG_VERSION")));
    let mut writer = Writer::with_options(Cursor::new(Vec::new()), options).map_err(damaged)?;
    let saved = copy_records(&bytes, &mut writer).map_err(damaged)?;
    writer.finish().map_err(damaged)?;
    Ok((writer.into_inner().into_inner(), saved))
}

/// Copies records up to the first one that cannot be read, where the log was torn.
fn copy_records(bytes: &[u8], writer: &mut Writer<Cursor<Vec<u8>>>) -> Result<u64, McapError> {
    let options = LinearReaderOptions::default().with_skip_end_magic(true).with_validate_chunk_crcs(true);
    let mut schemas = BTreeMap::from([(0, 0)]);
    let mut channels = BTreeMap::new();
    let mut pending = BTreeMap::new();
    let mut saved = 0;
    let mut copied = |record: Record<'_>| {
        match record {
            Record::Schema { header, data } => {
                let id = writer.add_schema(&header.name, &header.encoding, &data)?;
                schemas.insert(header.id, id);
            }
            // Delayed until its first message, so that no chunk is without one.
            Record::Channel(channel) => {
                pending.insert(channel.id, channel);
            }
            Record::Message { mut header, data } => {
                if let Some(c) = pending.remove(&header.channel_id) {
                    let schema = schemas.get(&c.schema_id).copied().unwrap_or(0);
                    let id = writer.add_channel(schema, &c.topic, &c.message_encoding, &c.metadata)?;
                    channels.insert(c.id, id);
                }
                if let Some(id) = channels.get(&header.channel_id) {
                    header.channel_id = *id;
                    writer.write_to_known_channel(&header, &data)?;
                    saved += 1;
                }
            }
            Record::Attachment { header, data, .. } => writer.attach(&mcap::Attachment {
                log_time: header.log_time,
                create_time: header.create_time,
                name: header.name,
                media_type: header.media_type,
                data,
            })?,
            Record::Metadata(metadata) => writer.write_metadata(&metadata)?,
            Record::DataEnd(_) => return Ok(ControlFlow::Break(())),
            _ => {}
        }
        Ok(ControlFlow::Continue(()))
    };
    // A reading error is expected in a torn log, but a writing error must be returned.
    let mut unwritten = None;
    let _torn = for_each_record(bytes, options, |record| {
        let outcome = copied(record);
        Ok(outcome.unwrap_or_else(|error| {
            unwritten = Some(error);
            ControlFlow::Break(())
        }))
    });
    unwritten.map_or(Ok(saved), Err)
}
