//! MCAP files as records that can be changed: lengths, offsets and checksums are made to fit again.

use mcap::MAGIC;

/// Opcodes of the records that matter here.
pub mod op {
    pub const FOOTER: u8 = 0x02;
    pub const SCHEMA: u8 = 0x03;
    pub const CHANNEL: u8 = 0x04;
    pub const MESSAGE: u8 = 0x05;
    pub const CHUNK: u8 = 0x06;
    pub const CHUNK_INDEX: u8 = 0x08;
    pub const ATTACHMENT: u8 = 0x09;
    pub const ATTACHMENT_INDEX: u8 = 0x0a;
    pub const METADATA: u8 = 0x0c;
    pub const METADATA_INDEX: u8 = 0x0d;
    pub const SUMMARY_OFFSET: u8 = 0x0e;
    pub const DATA_END: u8 = 0x0f;
}

/// Length of a chunk's head before its records: two times, size, checksum.
const CHUNK_HEAD: usize = 28;

/// A record.
#[derive(Clone)]
pub struct Record {
    pub op: u8,
    /// Content; for a chunk whose records are read, its head only.
    pub body: Vec<u8>,
    /// Records of a chunk that is not compressed.
    pub within: Vec<Record>,
}

/// Reads the records of a file, up to the first invalid one.
pub fn read(bytes: &[u8]) -> Vec<Record> {
    parse(bytes.strip_prefix(MAGIC).unwrap_or(bytes))
}

fn parse(mut bytes: &[u8]) -> Vec<Record> {
    let mut records = Vec::new();
    while let Some((op, rest)) = bytes.split_first() {
        let Some(body) = number(rest, 0).and_then(|n| rest.get(8..)?.get(..usize::try_from(n).ok()?)) else {
            break;
        };
        bytes = &rest[8 + body.len()..];
        let mut record = Record { op: *op, body: body.to_vec(), within: Vec::new() };
        // An empty name of a compression, then the size of what follows.
        if *op == op::CHUNK
            && body.get(CHUNK_HEAD..CHUNK_HEAD + 4) == Some(&[0; 4])
            && let Some(inner) = body.get(CHUNK_HEAD + 12..)
        {
            record.within = parse(inner);
            record.body.truncate(16);
        }
        records.push(record);
    }
    records
}

/// The whole number at a place.
pub fn number(bytes: &[u8], at: usize) -> Option<u64> {
    Some(u64::from_le_bytes(bytes.get(at..at + 8)?.try_into().ok()?))
}

fn put(bytes: &mut [u8], at: usize, value: u64) {
    if let Some(place) = bytes.get_mut(at..at + 8) {
        place.copy_from_slice(&value.to_le_bytes());
    }
}

/// The string at a place, with its length before it, as a range of bytes.
pub fn string(bytes: &[u8], at: usize) -> Option<std::ops::Range<usize>> {
    let length = u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?) as usize;
    (at + 4 + length <= bytes.len()).then_some(at + 4..at + 4 + length)
}

/// Start of a record, and its length.
type Place = (u64, u64);

/// Writes the file of these records. Offsets are adjusted, and checksums are left out, which the format allows.
pub fn seal(records: &[Record]) -> Vec<u8> {
    let mut out = MAGIC.to_vec();
    let mut places: Vec<(u8, Place)> = Vec::new();
    let mut end_of_data = None;
    for record in records {
        let at = out.len() as u64;
        let body = sealed(record, &places, end_of_data);
        append(record.op, &body, &mut out);
        places.push((record.op, (at, out.len() as u64 - at)));
        if record.op == op::DATA_END {
            end_of_data = Some(out.len() as u64);
        }
    }
    out.extend(MAGIC);
    out
}

fn append(op: u8, body: &[u8], out: &mut Vec<u8>) {
    out.push(op);
    out.extend((body.len() as u64).to_le_bytes());
    out.extend(body);
}

fn sealed(record: &Record, before: &[(u8, Place)], end_of_data: Option<u64>) -> Vec<u8> {
    let mut body = record.body.clone();
    // The index of the n-th chunk is the n-th index.
    let indexed = |op: u8| {
        let n = before.iter().filter(|(o, _)| *o == record.op).count();
        before.iter().filter(|(o, _)| *o == op).nth(n).map(|(_, place)| *place)
    };
    match record.op {
        op::CHUNK if body.len() == 16 => {
            let mut inner = Vec::new();
            for record in &record.within {
                append(record.op, &record.body, &mut inner);
            }
            let size = (inner.len() as u64).to_le_bytes();
            body.extend(size);
            body.extend([0; 8]);
            body.extend(size);
            body.extend(inner);
        }
        op::CHUNK_INDEX => {
            if let (Some((start, length)), Some(was)) = (indexed(op::CHUNK), number(&body, 16)) {
                let moved = (start + length).wrapping_sub(was.wrapping_add(number(&body, 24).unwrap_or(0)));
                put(&mut body, 16, start);
                put(&mut body, 24, length);
                // Of each channel, where the index of its messages is.
                let entries = string(&body, 32).map_or(0, |range| range.len() / 10);
                for at in (0..entries).map(|n| 36 + 10 * n + 2) {
                    let was = number(&body, at).unwrap_or(0);
                    put(&mut body, at, was.wrapping_add(moved));
                }
            }
        }
        op::ATTACHMENT_INDEX | op::METADATA_INDEX => {
            let of = if record.op == op::METADATA_INDEX { op::METADATA } else { op::ATTACHMENT };
            if let Some((start, length)) = indexed(of) {
                put(&mut body, 0, start);
                put(&mut body, 8, length);
            }
        }
        op::ATTACHMENT | op::DATA_END => {
            let end = body.len().saturating_sub(4);
            body[end..].fill(0);
        }
        op::SUMMARY_OFFSET => {
            let group = body.first().copied().unwrap_or(0);
            let after = |at: u64| end_of_data.is_some_and(|end| at >= end);
            let group =
                || before.iter().filter(|(o, (at, _))| *o == group && after(*at)).map(|(_, place)| *place);
            put(&mut body, 1, group().next().map_or(0, |(at, _)| at));
            put(&mut body, 9, group().map(|(_, length)| length).sum());
        }
        op::FOOTER => {
            let offsets = before.iter().find(|(o, _)| *o == op::SUMMARY_OFFSET).map_or(0, |(_, (at, _))| *at);
            let has_summary = before.last().is_some_and(|(o, _)| *o != op::DATA_END);
            put(&mut body, 0, end_of_data.filter(|_| has_summary).unwrap_or(0));
            put(&mut body, 8, offsets);
            let end = body.len().min(16);
            body[end..].fill(0);
        }
        _ => {}
    }
    body
}
