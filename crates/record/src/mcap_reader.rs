//! Reading of untrusted MCAP records: every length is checked against the available bytes before it is used.

use std::ops::ControlFlow;

use mcap::McapError;
use mcap::records::{Record, op};
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};

/// Length of a record's head: its kind (1 byte) and its length (8 bytes).
const HEAD: usize = 9;
/// Largest chunk or record (bytes) of any file; those of flexsc have 1 MiB.
pub(super) const LARGEST: usize = 256 << 20;
/// Largest chunk that is accepted in a small file (bytes).
const SMALLEST_LIMIT: usize = 16 << 20;
/// Largest ratio of unpacked to packed size, in addition to [`LARGEST`], which no log of a run approaches.
const UNPACKED: usize = 256;
/// Cost of a record besides its body (bytes), because empty records take time too.
const RECORD: usize = 64;

/// Returns the records outside of chunks, each with its kind, up to the footer.
pub fn outer_records(bytes: &[u8]) -> Result<Vec<(u8, &[u8])>, McapError> {
    let mut rest = Remaining(bytes.get(mcap::MAGIC.len()..).unwrap_or_default());
    let mut records = Vec::new();
    loop {
        let head = rest.read_bytes(HEAD).ok_or(McapError::UnexpectedEof)?;
        let opcode = head[0];
        let length = u64::from_le_bytes(std::array::from_fn(|i| head[1 + i]));
        let body = usize::try_from(length).ok().and_then(|length| rest.read_bytes(length));
        let body = body.ok_or(McapError::RecordTooLarge { opcode, len: length })?;
        if opcode == op::FOOTER {
            return Ok(records);
        }
        records.push((opcode, body));
    }
}

/// Passes every record that a reader needs to the callback, including those in chunks, up to the end or a break; the
/// end of a torn log is an error. Checksums are verified before their data is used, and lengths are bounded, so that
/// damage causes an error and neither a wrong number nor an excessive use of memory.
pub fn for_each_record(
    bytes: &[u8],
    options: LinearReaderOptions,
    mut visit: impl FnMut(Record<'_>) -> Result<ControlFlow<()>, McapError>,
) -> Result<(), McapError> {
    let most = bytes.len().saturating_mul(UNPACKED);
    let options = options.with_record_length_limit(most.clamp(SMALLEST_LIMIT, LARGEST));
    let mut remaining = most.saturating_add(LARGEST);
    let mut reader = LinearReader::new_with_options(options);
    let mut rest = bytes;
    while let Some(event) = reader.next_event() {
        match event? {
            LinearReadEvent::ReadRequest(wanted) => {
                // Never read more than is available, whatever a length claims.
                let (now, later) = rest.split_at(wanted.min(rest.len()));
                reader.insert(now.len()).copy_from_slice(now);
                reader.notify_read(now.len());
                rest = later;
            }
            LinearReadEvent::Record { opcode, data } => {
                remaining = remaining.checked_sub(RECORD + data.len()).ok_or_else(|| {
                    let why = format!("the file unpacks to more than {UNPACKED} times its size");
                    McapError::DecompressionError(why)
                })?;
                if let Some(record) = parsed(opcode, data)?
                    && visit(record)?.is_break()
                {
                    break;
                }
            }
        }
    }
    Ok(())
}

/// Parses a record that a reader needs; `None` for another kind.
pub fn parsed(opcode: u8, body: &[u8]) -> Result<Option<Record<'_>>, McapError> {
    let mut rest = Remaining(body);
    let sound = match opcode {
        op::SCHEMA => rest.read_bytes(2).and_then(|_| rest.blocks(3)),
        op::CHANNEL => rest.read_bytes(4).and_then(|_| rest.blocks(2)).and_then(|()| rest.map()),
        op::MESSAGE => rest.read_bytes(22).map(|_| ()),
        op::METADATA => rest.blocks(1).and_then(|()| rest.map()),
        op::ATTACHMENT => {
            let data = rest.read_bytes(16).and_then(|_| rest.blocks(2)).and_then(|()| rest.number::<8>());
            data.and_then(|length| rest.read_bytes(length)).and_then(|_| rest.read_bytes(4)).map(|_| ())
        }
        op::DATA_END => rest.read_bytes(4).map(|_| ()),
        _ => return Ok(None),
    };
    match sound {
        Some(()) => mcap::parse_record(opcode, body).map(Some),
        None => Err(McapError::RecordTooLarge { opcode, len: body.len() as u64 }),
    }
}

/// Remaining bytes to read.
struct Remaining<'a>(&'a [u8]);

impl<'a> Remaining<'a> {
    fn read_bytes(&mut self, count: usize) -> Option<&'a [u8]> {
        let (now, later) = self.0.split_at_checked(count)?;
        self.0 = later;
        Some(now)
    }

    /// Reads a length of `N` bytes.
    fn number<const N: usize>(&mut self) -> Option<usize> {
        let mut number = [0; 8];
        number[..N].copy_from_slice(self.read_bytes(N)?);
        usize::try_from(u64::from_le_bytes(number)).ok()
    }

    /// Reads bytes preceded by their length.
    fn block(&mut self) -> Option<&'a [u8]> {
        let length = self.number::<4>()?;
        self.read_bytes(length)
    }

    fn blocks(&mut self, count: usize) -> Option<()> {
        (0..count).try_for_each(|_| self.block().map(|_| ()))
    }

    /// Checks pairs of texts preceded by the total length.
    fn map(&mut self) -> Option<()> {
        let mut pairs = Remaining(self.block()?);
        while !pairs.0.is_empty() {
            pairs.blocks(2)?;
        }
        Some(())
    }
}
