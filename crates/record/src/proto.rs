//! Rows as protobuf: the schema contained in a log, and the bytes of a row.

use prost::Message as _;
use prost::encoding::{WireType, encode_key, encode_varint};
use prost_types::field_descriptor_proto::{Label, Type};
use prost_types::source_code_info::Location;
use prost_types::{
    DescriptorProto, EnumDescriptorProto, EnumValueDescriptorProto, FieldDescriptorProto,
    FileDescriptorProto, FileDescriptorSet, SourceCodeInfo,
};

use super::row::{FieldKind, Row, RowField, RowMessage, Sink, Topic};
use crate::enum_label::LoggedEnum;

const GOOGLE: &str = "google.protobuf";

impl Topic {
    /// Returns the topic's schema: a serialised `FileDescriptorSet` with its imports and comments.
    pub fn schema(&self) -> Vec<u8> {
        let mut files = Vec::new();
        let message = RowMessage { name: self.message, doc: self.doc, fields: self.fields };
        add_message(&message, &mut files);
        FileDescriptorSet { file: files }.encode_to_vec()
    }
}

/// Returns the schema of a message whose fields, given by name, type and description, are neither nested nor repeated.
pub fn flat_schema<'a>(
    message: &str,
    doc: &str,
    fields: impl Iterator<Item = (&'a str, Type, String)>,
) -> Vec<u8> {
    let (package, name) = parts(message);
    let mut comments = vec![comment(&[4, 0], &[doc])];
    let mut descriptors = Vec::new();
    for ((field, of, doc), index) in fields.zip(0..) {
        comments.push(comment(&[4, 0, 2, index], &[&doc]));
        descriptors.push(FieldDescriptorProto {
            name: Some(field.to_owned()),
            number: Some(index + 1),
            label: Some(Label::Optional as i32),
            r#type: Some(of as i32),
            json_name: Some(field.to_owned()),
            ..FieldDescriptorProto::default()
        });
    }
    let descriptor =
        DescriptorProto { name: Some(name.to_owned()), field: descriptors, ..DescriptorProto::default() };
    let file = FileDescriptorProto {
        message_type: vec![descriptor],
        source_code_info: Some(SourceCodeInfo { location: comments }),
        ..file(package, name)
    };
    FileDescriptorSet { file: vec![file] }.encode_to_vec()
}

/// Splits a full name into package and name.
fn parts(full: &str) -> (&str, &str) {
    full.rsplit_once('.').unwrap_or(("", full))
}

/// Returns a file without contents for one message or enumeration.
fn file(package: &str, name: &str) -> FileDescriptorProto {
    // The published files of `foxglove` have the messages' own names.
    let stem = if package == "foxglove" { name.to_owned() } else { name.to_lowercase() };
    FileDescriptorProto {
        name: Some(format!("{}/{stem}.proto", package.replace('.', "/"))),
        package: Some(package.to_owned()),
        syntax: Some("proto3".to_owned()),
        ..FileDescriptorProto::default()
    }
}

/// Adds a message's file after its imports; returns the file's name.
fn add_message(message: &RowMessage, files: &mut Vec<FileDescriptorProto>) -> String {
    let (package, name) = parts(message.name);
    let mut imports = Vec::new();
    let mut nested = Vec::new();
    for field in message.fields {
        let import = match field.kind {
            FieldKind::Row(inner) | FieldKind::Rows(inner) => add_message(inner, files),
            FieldKind::Time(name) => add_time(name, files),
            FieldKind::Label(labels) if labels.name.contains('.') => {
                nested.push(enumeration(labels));
                continue;
            }
            FieldKind::Label(labels) => add_enumeration(package, labels, files),
            FieldKind::Number | FieldKind::Count | FieldKind::Text | FieldKind::Flag => continue,
        };
        if !imports.contains(&import) {
            imports.push(import);
        }
    }
    let fields = || message.fields.iter().zip(0..);
    let mut comments = vec![comment(&[4, 0], message.doc)];
    comments.extend(fields().map(|(field, n)| comment(&[4, 0, 2, n], field.doc)));
    let descriptor = DescriptorProto {
        name: Some(name.to_owned()),
        field: fields().map(|(field, index)| descriptor(package, field, index + 1)).collect(),
        enum_type: nested,
        ..DescriptorProto::default()
    };
    add(
        files,
        FileDescriptorProto {
            dependency: imports,
            message_type: vec![descriptor],
            source_code_info: Some(SourceCodeInfo { location: comments }),
            ..file(package, name)
        },
    )
}

/// Adds a file unless it is present; returns its name.
fn add(files: &mut Vec<FileDescriptorProto>, file: FileDescriptorProto) -> String {
    let name = file.name().to_owned();
    if files.iter().all(|other| other.name() != name) {
        files.push(file);
    }
    name
}

fn enumeration(labels: &LoggedEnum) -> EnumDescriptorProto {
    let value = |(number, label): (usize, &&str)| EnumValueDescriptorProto {
        name: Some(LoggedEnum::identifier(label)),
        number: Some(number as i32),
        options: None,
    };
    EnumDescriptorProto {
        name: Some(parts(labels.name).1.to_owned()),
        value: labels.values.iter().enumerate().map(value).collect(),
        ..EnumDescriptorProto::default()
    }
}

fn add_enumeration(package: &str, labels: &LoggedEnum, files: &mut Vec<FileDescriptorProto>) -> String {
    let comment = |(number, doc): (usize, &&str)| comment(&[5, 0, 2, number as i32], &[doc]);
    let location = labels.docs.iter().enumerate().map(comment).collect();
    add(
        files,
        FileDescriptorProto {
            enum_type: vec![enumeration(labels)],
            source_code_info: Some(SourceCodeInfo { location }),
            ..file(package, labels.name)
        },
    )
}

/// Adds the file of a time message of `google.protobuf`.
fn add_time(name: &str, files: &mut Vec<FileDescriptorProto>) -> String {
    let field = |(name, number, field_type): (&str, i32, Type)| FieldDescriptorProto {
        name: Some(name.to_owned()),
        number: Some(number),
        label: Some(Label::Optional as i32),
        r#type: Some(field_type as i32),
        json_name: Some(name.to_owned()),
        ..FieldDescriptorProto::default()
    };
    let fields = [("seconds", 1, Type::Int64), ("nanos", 2, Type::Int32)];
    let message = DescriptorProto {
        name: Some(name.to_owned()),
        field: fields.into_iter().map(field).collect(),
        ..DescriptorProto::default()
    };
    add(files, FileDescriptorProto { message_type: vec![message], ..file(GOOGLE, name) })
}

fn descriptor(package: &str, field: &RowField, number: i32) -> FieldDescriptorProto {
    let (field_type, type_name) = match field.kind {
        FieldKind::Number => (Type::Double, None),
        FieldKind::Count => (Type::Uint64, None),
        FieldKind::Text => (Type::String, None),
        FieldKind::Flag => (Type::Bool, None),
        FieldKind::Time(name) => (Type::Message, Some(format!(".{GOOGLE}.{name}"))),
        FieldKind::Label(labels) => (Type::Enum, Some(format!(".{package}.{}", labels.name))),
        FieldKind::Row(message) | FieldKind::Rows(message) => {
            (Type::Message, Some(format!(".{}", message.name)))
        }
    };
    let repeated = matches!(field.kind, FieldKind::Rows(_));
    FieldDescriptorProto {
        name: Some(field.name.to_owned()),
        number: Some(number),
        label: Some(if repeated { Label::Repeated } else { Label::Optional } as i32),
        r#type: Some(field_type as i32),
        type_name,
        json_name: Some(field.name.to_owned()),
        ..FieldDescriptorProto::default()
    }
}

fn comment(path: &[i32], doc: &[&str]) -> Location {
    Location {
        path: path.to_vec(),
        // The format requires a span, but there is no source text.
        span: vec![0, 0, 0],
        leading_comments: Some(doc.join("\n")),
        ..Location::default()
    }
}

/// Encoder that appends all fields of a row to a buffer, including zeros.
pub struct Encoder<'a> {
    field: u32,
    buffer: &'a mut Vec<u8>,
}

impl<'a> Encoder<'a> {
    /// Creates an encoder of one row, which it appends to the buffer.
    pub fn new(buffer: &'a mut Vec<u8>) -> Self {
        Self { field: 0, buffer }
    }

    /// Encodes a row.
    #[inline]
    pub fn encode<R: Row>(row: &R, buffer: &'a mut Vec<u8>) {
        row.write_to(&mut Self::new(buffer));
    }

    fn key(&mut self, wire: WireType) {
        self.field += 1;
        encode_key(self.field, wire, self.buffer);
    }

    fn bytes(&mut self, bytes: &[u8]) {
        self.key(WireType::LengthDelimited);
        encode_varint(bytes.len() as u64, self.buffer);
        self.buffer.extend_from_slice(bytes);
    }
}

impl Sink for Encoder<'_> {
    #[inline]
    fn number(&mut self, value: f64) {
        self.key(WireType::SixtyFourBit);
        self.buffer.extend_from_slice(&value.to_le_bytes());
    }

    #[inline]
    fn count(&mut self, value: u64) {
        self.key(WireType::Varint);
        encode_varint(value, self.buffer);
    }

    #[inline]
    fn label(&mut self, index: usize, _: &'static LoggedEnum) {
        self.count(index as u64);
    }

    fn text(&mut self, text: &str) {
        self.bytes(text.as_bytes());
    }

    fn flag(&mut self, value: bool) {
        self.count(u64::from(value));
    }

    fn time(&mut self, nanoseconds: u64) {
        let mut inner = Vec::with_capacity(16);
        let mut parts = Encoder { field: 0, buffer: &mut inner };
        parts.count(nanoseconds / 1_000_000_000);
        parts.count(nanoseconds % 1_000_000_000);
        self.bytes(&inner);
    }

    fn row<R: Row>(&mut self, row: &R) {
        let mut inner = Vec::new();
        Encoder::encode(row, &mut inner);
        self.bytes(&inner);
    }

    fn rows<R: Row>(&mut self, rows: &[R]) {
        // All rows share the field's number, which `key` increments.
        let field = self.field;
        let mut inner = Vec::new();
        for row in rows {
            inner.clear();
            Encoder::encode(row, &mut inner);
            self.field = field;
            self.bytes(&inner);
        }
        self.field = field + 1;
    }
}
