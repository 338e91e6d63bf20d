//! Bytes of logs that other programs may write: MCAP, protobuf, schemas.

/// Bytes after their length, as MCAP has texts.
pub fn text(text: impl AsRef<[u8]>) -> Vec<u8> {
    let bytes = text.as_ref();
    [&(bytes.len() as u32).to_le_bytes()[..], bytes].concat()
}

/// A record of MCAP.
pub fn record(kind: u8, body: &[&[u8]]) -> Vec<u8> {
    let body = body.concat();
    [&[kind], &(body.len() as u64).to_le_bytes()[..], &body].concat()
}

/// A field of protobuf that holds bytes.
pub fn block(number: u8, bytes: impl AsRef<[u8]>) -> Vec<u8> {
    let bytes = bytes.as_ref();
    let mut field = vec![number << 3 | 2];
    let mut length = bytes.len();
    while length > 0x7f {
        field.push(length as u8 | 0x80);
        length >>= 7;
    }
    field.push(length as u8);
    field.extend(bytes);
    field
}

/// A field of protobuf that holds a number below 128.
pub fn small(number: u8, value: u8) -> Vec<u8> {
    vec![number << 3, value]
}

pub const DOUBLE: u8 = 1;
pub const INT64: u8 = 3;
pub const UINT64: u8 = 4;
pub const STRING: u8 = 9;
pub const MESSAGE: u8 = 11;
pub const BYTES: u8 = 12;
pub const SINT32: u8 = 17;
pub const ENUM: u8 = 14;

/// A field of a message, as a `FieldDescriptorProto`: its number, type, and the message or enumeration that it is of.
pub fn field(name: &str, number: u8, kind: u8, of: &str, repeated: bool) -> Vec<u8> {
    let of = if of.is_empty() { Vec::new() } else { block(6, of) };
    let label = small(4, if repeated { 3 } else { 1 });
    block(2, [block(1, name), small(3, number), label, small(5, kind), of].concat())
}

/// A message, as a `DescriptorProto` within a file.
pub fn message(name: &str, parts: &[Vec<u8>]) -> Vec<u8> {
    block(4, [block(1, name), parts.concat()].concat())
}

/// A `FileDescriptorSet` of one file.
pub fn schema(parts: &[Vec<u8>]) -> Vec<u8> {
    block(1, [block(1, "a.proto"), block(2, "a"), parts.concat(), block(12, "proto3")].concat())
}

/// A log with one channel `/a` of these messages, outside of chunks.
pub fn log(name: &str, schema: &[u8], messages: &[Vec<u8>]) -> Vec<u8> {
    log_in("protobuf", name, schema, messages)
}

pub fn log_in(encoding: &str, name: &str, schema: &[u8], messages: &[Vec<u8>]) -> Vec<u8> {
    let kind = if encoding == "cdr" { "ros2msg" } else { encoding };
    let mut bytes = MAGIC.to_vec();
    bytes.extend(record(1, &[&text(""), &text("by hand")]));
    bytes.extend(record(3, &[&[1, 0], &text(name), &text(kind), &text(schema)]));
    bytes.extend(record(4, &[&[0, 0, 1, 0], &text("/a"), &text(encoding), &text("")]));
    for (index, message) in messages.iter().enumerate() {
        let time = (1_000_000_000 * index as u64).to_le_bytes();
        bytes.extend(record(5, &[&[0, 0], &[0; 4], &time, &time, message]));
    }
    bytes.extend(end(&[0; 20]));
    bytes
}

/// The end of a log, with this footer.
pub fn end(footer: &[u8]) -> Vec<u8> {
    [record(15, &[&[0; 4]]), record(2, &[footer]), MAGIC.to_vec()].concat()
}

pub const MAGIC: [u8; 8] = *b"\x89MCAP0\r\n";
