//! Messages and enumerations of a protobuf schema, by their full names.

use std::collections::BTreeMap;

use prost::Message;
use prost_types::field_descriptor_proto::{Label, Type};
use prost_types::{DescriptorProto, EnumDescriptorProto, FieldDescriptorProto, FileDescriptorSet};

/// Types of a schema, by their full names.
#[derive(Default)]
pub struct DescriptorPool {
    messages: BTreeMap<String, DescriptorProto>,
    enums: BTreeMap<String, EnumDescriptorProto>,
}

/// Type of the contents of a field.
pub enum FieldContent<'a> {
    /// Number, text or bytes.
    Scalar(Type),
    /// Message with its full name.
    Message(&'a str, &'a DescriptorProto),
    /// Enumeration.
    Enum(&'a EnumDescriptorProto),
}

impl DescriptorPool {
    /// Reads a serialised set of file descriptors.
    pub fn decode(data: &[u8]) -> Result<Self, String> {
        let files = FileDescriptorSet::decode(data).map_err(|error| error.to_string())?;
        let mut pool = Self::default();
        for file in files.file {
            let package = file.package.unwrap_or_default();
            pool.add_enums(&package, file.enum_type);
            pool.add(&package, file.message_type);
        }
        Ok(pool)
    }

    fn add(&mut self, scope: &str, messages: Vec<DescriptorProto>) {
        for mut message in messages {
            let name = within(scope, message.name());
            self.add_enums(&name, std::mem::take(&mut message.enum_type));
            self.add(&name, std::mem::take(&mut message.nested_type));
            self.messages.insert(name, message);
        }
    }

    fn add_enums(&mut self, scope: &str, enums: Vec<EnumDescriptorProto>) {
        self.enums
            .extend(enums.into_iter().map(|enumeration| (within(scope, enumeration.name()), enumeration)));
    }

    /// Returns the message of a full name.
    pub fn message(&self, name: &str) -> Option<(&str, &DescriptorProto)> {
        self.messages.get_key_value(name).map(|(name, message)| (name.as_str(), message))
    }

    /// Returns the type of a message's field; `None` if it is not in the schema.
    pub fn kind(&self, message: &str, field: &FieldDescriptorProto) -> Option<FieldContent<'_>> {
        match field.r#type.and_then(|kind| Type::try_from(kind).ok()) {
            None | Some(Type::Message | Type::Group | Type::Enum) => self.named(message, field.type_name()),
            Some(kind) => Some(FieldContent::Scalar(kind)),
        }
    }

    /// Finds the type of a name: a full name begins with a dot, others are searched from the inner to the outer scopes.
    fn named(&self, scope: &str, name: &str) -> Option<FieldContent<'_>> {
        let full = |name: &str| {
            let message = self.message(name).map(|(name, message)| FieldContent::Message(name, message));
            message.or_else(|| self.enums.get(name).map(FieldContent::Enum))
        };
        if let Some(name) = name.strip_prefix('.') {
            return full(name);
        }
        let mut scope = Some(scope);
        while let Some(outer_scope) = scope {
            if let Some(kind) = full(&within(outer_scope, name)) {
                return Some(kind);
            }
            scope = outer_scope
                .rsplit_once('.')
                .map(|(outer, _)| outer)
                .or((!outer_scope.is_empty()).then_some(""));
        }
        None
    }
}

/// Returns true if a field is repeated, as are the entries of a map.
pub fn is_list(field: &FieldDescriptorProto) -> bool {
    field.label() == Label::Repeated
}

/// Returns true if a field is a group.
pub fn is_group(field: &FieldDescriptorProto) -> bool {
    field.r#type == Some(Type::Group as i32)
}

fn within(scope: &str, name: &str) -> String {
    if scope.is_empty() { name.to_owned() } else { format!("{scope}.{name}") }
}
