//! Rows as protobuf: the schema that a log carries, and the bytes of a row.

use prost::Message;
use prost::encoding::{WireType, encode_key, encode_varint};
use prost_types::field_descriptor_proto::{Label, Type};
use prost_types::source_code_info::Location;
use prost_types::{
    DescriptorProto, EnumDescriptorProto, EnumValueDescriptorProto, FieldDescriptorProto,
    FileDescriptorProto, FileDescriptorSet, SourceCodeInfo,
};

use super::row::{Field, Kind, Row, Sink, Topic};
use crate::label::Labels;

const PACKAGE: &str = "flexsc.v1";

impl Topic {
    /// The full name of its message.
    pub fn schema_name(&self) -> String {
        format!("{PACKAGE}.{}", self.message)
    }

    /// Its schema: a serialised `FileDescriptorSet` with its imports and comments.
    pub fn schema(&self) -> Vec<u8> {
        let mut files: Vec<FileDescriptorProto> = Vec::new();
        for labels in enumerations(self.fields) {
            if files.iter().all(|file| file.name() != file_name(labels.name)) {
                files.push(enumeration_file(labels));
            }
        }
        files.push(message_file(self, files.iter().map(|f| f.name().to_owned()).collect()));
        FileDescriptorSet { file: files }.encode_to_vec()
    }
}

fn file_name(message: &str) -> String {
    format!("flexsc/v1/{}.proto", message.to_lowercase())
}

fn enumerations(fields: &'static [Field]) -> Vec<&'static Labels> {
    let of = |field: &Field| match field.kind {
        Kind::Label(labels) => vec![labels],
        Kind::Rows(_, inner) => enumerations(inner),
        _ => vec![],
    };
    fields.iter().flat_map(of).collect()
}

fn file(name: &str) -> FileDescriptorProto {
    FileDescriptorProto {
        name: Some(file_name(name)),
        package: Some(PACKAGE.to_owned()),
        syntax: Some("proto3".to_owned()),
        ..FileDescriptorProto::default()
    }
}

fn enumeration_file(labels: &Labels) -> FileDescriptorProto {
    let value = |(number, label): (usize, &&str)| EnumValueDescriptorProto {
        name: Some(Labels::identifier(label)),
        number: Some(number as i32),
        options: None,
    };
    let comment = |(number, doc): (usize, &&str)| comment(&[5, 0, 2, number as i32], &[doc]);
    FileDescriptorProto {
        enum_type: vec![EnumDescriptorProto {
            name: Some(labels.name.to_owned()),
            value: labels.values.iter().enumerate().map(value).collect(),
            ..EnumDescriptorProto::default()
        }],
        source_code_info: Some(SourceCodeInfo {
            location: labels.docs.iter().enumerate().map(comment).collect(),
        }),
        ..file(labels.name)
    }
}

fn message_file(topic: &Topic, dependency: Vec<String>) -> FileDescriptorProto {
    let mut messages = vec![message(topic.message, topic.fields)];
    let mut comments = vec![comment(&[4, 0], topic.doc)];
    comments.extend(field_comments(0, topic.fields));
    for field in topic.fields {
        if let Kind::Rows(name, inner) = field.kind {
            comments.extend(field_comments(messages.len() as i32, inner));
            messages.push(message(name, inner));
        }
    }
    FileDescriptorProto {
        dependency,
        message_type: messages,
        source_code_info: Some(SourceCodeInfo { location: comments }),
        ..file(topic.message)
    }
}

fn message(name: &str, fields: &[Field]) -> DescriptorProto {
    DescriptorProto {
        name: Some(name.to_owned()),
        field: fields.iter().zip(1..).map(|(field, number)| descriptor(field, number)).collect(),
        ..DescriptorProto::default()
    }
}

fn descriptor(field: &Field, number: i32) -> FieldDescriptorProto {
    let (of, type_name) = match field.kind {
        Kind::Number => (Type::Double, None),
        Kind::Count => (Type::Uint64, None),
        Kind::Text => (Type::String, None),
        Kind::Label(labels) => (Type::Enum, Some(labels.name)),
        Kind::Rows(name, _) => (Type::Message, Some(name)),
    };
    let repeated = matches!(field.kind, Kind::Rows(..));
    FieldDescriptorProto {
        name: Some(field.name.to_owned()),
        number: Some(number),
        label: Some(if repeated { Label::Repeated } else { Label::Optional } as i32),
        r#type: Some(of as i32),
        type_name: type_name.map(|name| format!(".{PACKAGE}.{name}")),
        json_name: Some(field.name.to_owned()),
        ..FieldDescriptorProto::default()
    }
}

fn field_comments(message: i32, fields: &'static [Field]) -> impl Iterator<Item = Location> {
    fields.iter().zip(0..).map(move |(field, n)| comment(&[4, message, 2, n], field.doc))
}

fn comment(path: &[i32], doc: &[&str]) -> Location {
    Location {
        path: path.to_vec(),
        // The grammar asks for a span; nothing points into a text here.
        span: vec![0, 0, 0],
        leading_comments: Some(doc.join("\n")),
        ..Location::default()
    }
}

/// Appends the fields of a row to a buffer, every one of them, zeros included.
pub struct Encoder<'a> {
    field: u32,
    buffer: &'a mut Vec<u8>,
}

impl<'a> Encoder<'a> {
    /// Encodes a row.
    #[inline]
    pub fn encode<R: Row>(row: &R, buffer: &'a mut Vec<u8>) {
        row.put(&mut Self { field: 0, buffer });
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
    fn label(&mut self, index: usize, _: &'static Labels) {
        self.count(index as u64);
    }

    fn text(&mut self, text: &str) {
        self.bytes(text.as_bytes());
    }

    fn rows<R: Row>(&mut self, rows: &[R]) {
        // All rows share the field's number, which `key` counts up.
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
