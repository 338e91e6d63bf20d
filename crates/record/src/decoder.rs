//! Decoding of protobuf messages into columns by the schema of a log.
//!
//! A schema comes from an untrusted file. Its fields are counted before columns are created, and messages are decoded
//! straight into columns, so that memory is used only for the result.

use prost_types::field_descriptor_proto::Type;
use prost_types::{DescriptorProto, EnumDescriptorProto, EnumValueDescriptorProto, FieldDescriptorProto};

use super::descriptor::{DescriptorPool, FieldContent, is_group, is_list};
use super::memory_budget::MemoryBudget;
use super::topics::label_of;
use super::wire::{WireMessage, WireValue};
use super::{Column, Columns};

/// Encoding of the messages of a log.
#[derive(Clone, Debug, PartialEq)]
pub struct Schema {
    /// Full name of the message.
    pub name: String,
    /// Encoding of the schema.
    pub encoding: String,
    /// Schema as a `FileDescriptorSet`, if the encoding is `protobuf`.
    pub data: Vec<u8>,
}

/// Largest size of a schema (bytes); that of a scene has 10 kB.
const LONGEST_SCHEMA: usize = 1 << 20;
/// Largest number of fields of a topic, including those of nested messages.
const MOST_FIELDS: usize = 4096;
/// Largest depth of nested messages.
const DEEPEST: usize = 32;
/// Largest number of labels of an enumeration in a column of indices; a value without a label gets this index.
const MOST_LABELS: usize = 255;

/// Decoder of a message: the columns of its fields.
pub struct MessageDecoder {
    /// Targets of the fields, by their numbers.
    fields: Vec<(u32, FieldTarget)>,
}

/// Target of a field.
enum FieldTarget {
    /// Column of this index.
    Value(usize, ScalarKind),
    /// Nested rows in the column of this index, one for each value.
    List(usize, ScalarKind),
    /// Columns of the same row, for the fields of a nested message.
    Inner(MessageDecoder),
    /// Nested rows in the column of this index, one for each message. The entries of a map are messages too.
    Rows(usize, MessageDecoder),
}

/// Type of a field's values.
enum ScalarKind {
    Double,
    Float,
    Int32,
    Int64,
    /// Signed integer with the sign in the last bit.
    Zigzag,
    SignedFixed32,
    SignedFixed64,
    Unsigned,
    Fixed32,
    Fixed64,
    Bool,
    /// Enumeration, with the numbers of its labels.
    Label(Vec<i32>),
    /// Enumeration with too many labels for a column of indices.
    Word(EnumDescriptorProto),
    Text,
    /// Bytes, of which only the length is stored.
    Bytes,
    /// Date or time span, in seconds.
    Time,
}

impl MessageDecoder {
    /// Creates the decoder of a schema, with empty columns.
    pub fn from_schema(schema: &Schema) -> Result<(Self, Columns), String> {
        if schema.encoding != "protobuf" {
            return Err(format!(
                "only schemas in `protobuf` are read, and it has one in `{}`",
                schema.encoding
            ));
        }
        if schema.data.len() > LONGEST_SCHEMA {
            let length = schema.data.len();
            return Err(format!("its schema has {length} bytes, and at most {LONGEST_SCHEMA} are read"));
        }
        let pool = DescriptorPool::decode(&schema.data).map_err(|error| format!("its schema: {error}"))?;
        let message = pool.message(&schema.name);
        let message = message.ok_or_else(|| format!("no message `{}` in its schema", schema.name))?;
        let mut columns = Columns::default();
        let maker = &mut DecoderBuilder { pool: &pool, above: Vec::new(), fields: 0 };
        let shape = maker.add(&mut columns, "", "", message)?;
        Ok((shape, columns))
    }

    /// Decodes a message into the row that was begun.
    pub fn fill(
        &self,
        columns: &mut Columns,
        message: &[u8],
        budget: &mut MemoryBudget,
    ) -> Result<(), String> {
        let mut wire = WireMessage::new(message);
        while let Some((number, raw)) = wire.field()? {
            let Ok(index) = self.fields.binary_search_by_key(&number, |(number, _)| *number) else {
                continue;
            };
            let wrong = || format!("field {number} of a message is not of the type that its schema says");
            match (&self.fields[index].1, raw) {
                (FieldTarget::Inner(shape), WireValue::Block(inner)) => shape.fill(columns, inner, budget)?,
                (FieldTarget::Rows(place, shape), WireValue::Block(inner)) => {
                    let within = another(columns, *place);
                    begin(within, budget)?;
                    shape.fill(within, inner, budget)?;
                }
                (FieldTarget::Inner(_) | FieldTarget::Rows(..), _) => return Err(wrong()),
                (FieldTarget::Value(place, scalar), raw) => {
                    let column = &mut columns.columns[*place].1;
                    scalar.set(column, raw, budget)?.ok_or_else(wrong)?;
                }
                (FieldTarget::List(place, scalar), WireValue::Block(packed)) if scalar.packs() => {
                    let mut packed = WireMessage::new(packed);
                    while !packed.is_empty() {
                        let raw = scalar.next(&mut packed).ok_or_else(wrong)?;
                        let within = another(columns, *place);
                        begin(within, budget)?;
                        scalar.set(&mut within.columns[0].1, raw, budget)?.ok_or_else(wrong)?;
                    }
                }
                (FieldTarget::List(place, scalar), raw) => {
                    let within = another(columns, *place);
                    begin(within, budget)?;
                    scalar.set(&mut within.columns[0].1, raw, budget)?.ok_or_else(wrong)?;
                }
            }
        }
        Ok(())
    }
}

/// Adds one to the number of nested rows of a column, and returns the columns of those rows.
fn another(columns: &mut Columns, place: usize) -> &mut Columns {
    let Column::Rows(counts, inner) = &mut columns.columns[place].1 else {
        unreachable!("a place of rows is made with a column of rows")
    };
    if let Some(last) = counts.last_mut() {
        *last += 1;
    }
    inner
}

/// Begins a row, in which every field has its default value.
pub fn begin(columns: &mut Columns, budget: &mut MemoryBudget) -> Result<(), String> {
    budget.reserve(size_of::<String>() * columns.columns.len())?;
    for (_, column) in &mut columns.columns {
        match column {
            Column::Numbers(values) => values.push(0.0),
            Column::Counts(values) => values.push(0),
            Column::Integers(values) => values.push(0),
            Column::Labels(values, _) => values.push(0),
            Column::Texts(values) => values.push(String::new()),
            Column::Rows(counts, _) => counts.push(0),
        }
    }
    Ok(())
}

/// Builder of the decoder of a schema, within bounds.
struct DecoderBuilder<'a> {
    pool: &'a DescriptorPool,
    /// Messages that contain the current one.
    above: Vec<&'a str>,
    fields: usize,
}

impl<'a> DecoderBuilder<'a> {
    /// Adds a column for each field; the name of a nested message precedes those of its fields: `rotation.x`. `path` is
    /// the message's name in errors.
    fn add(
        &mut self,
        columns: &mut Columns,
        before: &str,
        path: &str,
        (name, message): (&'a str, &'a DescriptorProto),
    ) -> Result<MessageDecoder, String> {
        if self.above.contains(&name) {
            let field = path.trim_end_matches('.');
            return Err(format!("field `{field}` is a `{name}` within itself, which has no columns"));
        }
        if self.above.len() == DEEPEST {
            return Err(format!(
                "field `{}` is more than {DEEPEST} messages deep",
                path.trim_end_matches('.')
            ));
        }
        self.above.push(name);
        let mut fields = Vec::new();
        for field in &message.field {
            self.fields += 1;
            if self.fields > MOST_FIELDS {
                return Err(format!("its schema has more than {MOST_FIELDS} fields"));
            }
            let (name, path) = (format!("{before}{}", field.name()), format!("{path}{}", field.name()));
            if is_group(field) {
                return Err(format!("field `{path}` is a group, which is not read"));
            }
            let kind = self.pool.kind(self.above.last().unwrap_or(&""), field);
            let kind = kind.ok_or_else(|| format!("no type `{}` in its schema", field.type_name()))?;
            let place = self.place(columns, name, &path, (field, kind))?;
            let number =
                u32::try_from(field.number()).map_err(|_| format!("field `{path}` has a negative number"))?;
            fields.push((number, place));
        }
        self.above.pop();
        fields.sort_by_key(|(number, _)| *number);
        Ok(MessageDecoder { fields })
    }

    fn place(
        &mut self,
        columns: &mut Columns,
        name: String,
        path: &str,
        (field, kind): (&FieldDescriptorProto, FieldContent<'a>),
    ) -> Result<FieldTarget, String> {
        let index = columns.columns.len();
        let (scalar, column) = match kind {
            FieldContent::Message(message_type, message) if !is_time(message_type) => {
                let path = format!("{path}.");
                if !is_list(field) {
                    return Ok(FieldTarget::Inner(self.add(
                        columns,
                        &format!("{name}."),
                        &path,
                        (message_type, message),
                    )?));
                }
                let mut inner = Columns::default();
                let shape = self.add(&mut inner, "", &path, (message_type, message))?;
                columns.columns.push((name, Column::Rows(Vec::new(), inner)));
                return Ok(FieldTarget::Rows(index, shape));
            }
            kind => scalar(&kind),
        };
        let name = if matches!(scalar, ScalarKind::Bytes) { format!("{name}.length") } else { name };
        if is_list(field) {
            let inner = Columns { columns: vec![(String::new(), column)] };
            columns.columns.push((name, Column::Rows(Vec::new(), inner)));
            return Ok(FieldTarget::List(index, scalar));
        }
        columns.columns.push((name, column));
        Ok(FieldTarget::Value(index, scalar))
    }
}

/// Returns true if a message type is a date or a time span.
fn is_time(name: &str) -> bool {
    matches!(name, "google.protobuf.Timestamp" | "google.protobuf.Duration")
}

/// Returns the type of a field's values, and its empty column.
fn scalar(kind: &FieldContent<'_>) -> (ScalarKind, Column) {
    let (numbers, counts) = (Column::Numbers(Vec::new()), Column::Counts(Vec::new()));
    let integers = Column::Integers(Vec::new());
    match kind {
        FieldContent::Message(..) => (ScalarKind::Time, numbers),
        FieldContent::Enum(enumeration) if enumeration.value.len() > MOST_LABELS => {
            (ScalarKind::Word((*enumeration).clone()), Column::Texts(Vec::new()))
        }
        FieldContent::Enum(enumeration) => {
            let labels = enumeration.value.iter().map(|value| label_of(value.name())).collect();
            let known = enumeration.value.iter().map(EnumValueDescriptorProto::number).collect();
            (ScalarKind::Label(known), Column::Labels(Vec::new(), labels))
        }
        FieldContent::Scalar(scalar) => match scalar {
            Type::Double => (ScalarKind::Double, numbers),
            Type::Float => (ScalarKind::Float, numbers),
            Type::Int32 => (ScalarKind::Int32, integers),
            Type::Int64 => (ScalarKind::Int64, integers),
            Type::Sint32 | Type::Sint64 => (ScalarKind::Zigzag, integers),
            Type::Sfixed32 => (ScalarKind::SignedFixed32, integers),
            Type::Sfixed64 => (ScalarKind::SignedFixed64, integers),
            Type::Uint32 | Type::Uint64 => (ScalarKind::Unsigned, counts),
            Type::Fixed32 => (ScalarKind::Fixed32, counts),
            Type::Fixed64 => (ScalarKind::Fixed64, counts),
            Type::Bool => (ScalarKind::Bool, counts),
            Type::String => (ScalarKind::Text, Column::Texts(Vec::new())),
            // The other types are named and do not occur here.
            Type::Bytes | Type::Message | Type::Group | Type::Enum => (ScalarKind::Bytes, counts),
        },
    }
}

impl ScalarKind {
    /// Returns true if lists of such values may be packed into one block.
    fn packs(&self) -> bool {
        !matches!(self, Self::Text | Self::Bytes | Self::Time)
    }

    /// Reads the next value of a packed list.
    fn next<'a>(&self, wire: &mut WireMessage<'a>) -> Option<WireValue<'a>> {
        match self {
            Self::Double | Self::SignedFixed64 | Self::Fixed64 => wire.fixed64().map(WireValue::Fixed64),
            Self::Float | Self::SignedFixed32 | Self::Fixed32 => wire.fixed32().map(WireValue::Fixed32),
            _ => wire.varint().map(WireValue::Varint),
        }
    }

    /// Sets the last value of a column; `None` if the wire type differs from the schema.
    fn set(
        &self,
        column: &mut Column,
        raw: WireValue<'_>,
        budget: &mut MemoryBudget,
    ) -> Result<Option<()>, String> {
        Ok(match (column, self, raw) {
            (Column::Numbers(values), Self::Double, WireValue::Fixed64(bits)) => {
                store_value(values, f64::from_bits(bits))
            }
            (Column::Numbers(values), Self::Float, WireValue::Fixed32(bits)) => {
                store_value(values, f64::from(f32::from_bits(bits)))
            }
            (Column::Numbers(values), Self::Time, WireValue::Block(time)) => {
                store_value(values, seconds(time)?)
            }
            (Column::Integers(values), Self::Int32, WireValue::Varint(n)) => {
                store_value(values, i64::from(n as i32))
            }
            (Column::Integers(values), Self::Int64, WireValue::Varint(n))
            | (Column::Integers(values), Self::SignedFixed64, WireValue::Fixed64(n)) => {
                store_value(values, n as i64)
            }
            (Column::Integers(values), Self::Zigzag, WireValue::Varint(n)) => {
                store_value(values, (n >> 1) as i64 ^ -((n & 1) as i64))
            }
            (Column::Integers(values), Self::SignedFixed32, WireValue::Fixed32(n)) => {
                store_value(values, i64::from(n as i32))
            }
            (Column::Counts(values), Self::Unsigned, WireValue::Varint(n))
            | (Column::Counts(values), Self::Fixed64, WireValue::Fixed64(n)) => store_value(values, n),
            (Column::Counts(values), Self::Bool, WireValue::Varint(n)) => {
                store_value(values, u64::from(n != 0))
            }
            (Column::Counts(values), Self::Fixed32, WireValue::Fixed32(n)) => {
                store_value(values, u64::from(n))
            }
            (Column::Counts(values), Self::Bytes, WireValue::Block(bytes)) => {
                store_value(values, bytes.len() as u64)
            }
            (Column::Labels(values, _), Self::Label(known), WireValue::Varint(n)) => {
                let index = known.iter().position(|known| *known == n as i32).unwrap_or(MOST_LABELS);
                store_value(values, index as u8)
            }
            (Column::Texts(values), Self::Word(labels), WireValue::Varint(n)) => {
                let value = labels.value.iter().find(|value| value.number() == n as i32);
                let word = value.map_or_else(|| n.to_string(), |value| value.name().to_owned());
                budget.reserve(word.len())?;
                store_value(values, word)
            }
            (Column::Texts(values), Self::Text, WireValue::Block(bytes)) => {
                budget.reserve(bytes.len())?;
                let text = std::str::from_utf8(bytes).map_err(|_| "a text in it is not UTF-8".to_owned())?;
                store_value(values, text.to_owned())
            }
            _ => None,
        })
    }
}

fn store_value<T>(values: &mut [T], value: T) -> Option<()> {
    values.last_mut().map(|last| *last = value)
}

/// Decodes a date or a time span to seconds.
fn seconds(time: &[u8]) -> Result<f64, String> {
    let (mut whole, mut past) = (0, 0);
    let mut wire = WireMessage::new(time);
    while let Some((number, raw)) = wire.field()? {
        match (number, raw) {
            (1, WireValue::Varint(n)) => whole = n as i64,
            (2, WireValue::Varint(n)) => past = n as i32,
            _ => {}
        }
    }
    // A single rounding, as for the nanoseconds themselves.
    Ok((i128::from(whole) * 1_000_000_000 + i128::from(past)) as f64 / 1e9)
}
