//! Topic of a row of a log: one of the engine, or a custom one.

use std::collections::BTreeMap;
use std::sync::Arc;

use prost_types::field_descriptor_proto::Type;

use super::custom_topic::CustomTopic;
use super::topics::TOPICS;
use super::{Detail, proto};

/// Topic of a row: one of the engine, or a custom one.
#[derive(Copy, Clone, Debug)]
pub enum LogTopic<'a> {
    /// Topic of the engine, as an index into [`TOPICS`].
    Declared(usize),
    /// Topic of a part outside the engine.
    Custom(&'a Arc<CustomTopic>),
}

impl LogTopic<'_> {
    /// Returns the index into [`TOPICS`] of a topic of the engine.
    pub fn declared_index(&self) -> Option<usize> {
        if let Self::Declared(index) = self { Some(*index) } else { None }
    }

    /// Returns the least detail of a log that has the topic.
    pub fn detail(&self) -> Detail {
        match self {
            Self::Declared(index) => TOPICS[*index].logged.detail(),
            Self::Custom(_) => Detail::Full,
        }
    }

    /// Returns the name with its leading slash.
    pub fn name(&self) -> &str {
        match self {
            Self::Declared(index) => TOPICS[*index].name,
            Self::Custom(topic) => topic.name(),
        }
    }

    /// Returns the full name of the message.
    pub fn message(&self) -> &str {
        match self {
            Self::Declared(index) => TOPICS[*index].message,
            Self::Custom(topic) => topic.message(),
        }
    }

    /// Returns the schema: a serialised `FileDescriptorSet`.
    pub fn schema(&self) -> Vec<u8> {
        match self {
            Self::Declared(index) => TOPICS[*index].schema(),
            Self::Custom(topic) => proto::flat_schema(
                topic.message(),
                topic.doc(),
                topic.fields().iter().map(|field| {
                    let unit =
                        if field.unit.is_empty() { String::new() } else { format!(" ({})", field.unit) };
                    let kind = if field.is_word { Type::String } else { Type::Double };
                    (field.name.as_str(), kind, format!("{}{unit}", field.doc))
                }),
            ),
        }
    }

    /// Returns the metadata of the topic's channel: the unit of each field of a custom topic.
    pub fn channel_metadata(&self) -> BTreeMap<String, String> {
        let Self::Custom(topic) = self else { return BTreeMap::new() };
        topic.fields().iter().map(|field| (format!("{UNIT_KEY}{}", field.name), field.unit.clone())).collect()
    }
}

/// Prefix of the keys of units in a channel's metadata.
pub(crate) const UNIT_KEY: &str = "unit.";
