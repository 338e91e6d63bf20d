//! Topics that parts outside the engine declare while a program runs: names, units and values of their rows.

use std::sync::Arc;

use thiserror::Error;

use super::columns::{Column, Columns};
use super::topics::TOPICS;

/// Largest number of fields of a custom topic.
pub const MOST_FIELDS: usize = 64;
/// Largest number of custom topics in one run.
pub const MOST_TOPICS: usize = 64;
/// Largest length of a name or a unit, and of a description, in bytes.
const MOST_BYTES: [usize; 2] = [64, 1000];
/// Form of words in rows.
pub(crate) const WORD: &str = "a word of at most 64 bytes without control characters";
/// Names of columns that every table has besides its fields.
const RESERVED: [&str; 1] = ["time_s"];

/// Field of a custom topic: a floating-point number, or a word.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CustomField {
    /// Name in snake case: `integral`.
    pub name: String,
    /// Unit; empty for a dimensionless field.
    pub unit: String,
    /// Description of the field.
    pub doc: String,
    /// True if values are words, such as states.
    pub is_word: bool,
}

impl CustomField {
    /// Creates a field of numbers with its name, unit and description.
    pub fn new(name: impl Into<String>, unit: impl Into<String>, doc: impl Into<String>) -> Self {
        Self { name: name.into(), unit: unit.into(), doc: doc.into(), is_word: false }
    }

    /// Creates a field of words with its name and description.
    pub fn word(name: impl Into<String>, doc: impl Into<String>) -> Self {
        Self { name: name.into(), unit: String::new(), doc: doc.into(), is_word: true }
    }
}

/// Topic of a part outside the engine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CustomTopic {
    name: String,
    message: String,
    doc: String,
    fields: Vec<CustomField>,
}

/// Error of a custom topic or one of its rows.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum TopicError {
    /// Topic name that is not a slash and a name in snake case.
    #[error("topic `{0}`: must be `/` and at most {most} lower-case letters, digits and `_`, with a letter first", most = MOST_BYTES[0])]
    Name(String),
    /// Topic name that the engine uses.
    #[error("topic `{0}`: is a topic of the engine")]
    Taken(String),
    /// Field name that is not in snake case, or reserved.
    #[error("topic `{topic}`, field `{field}`: must be at most {most} lower-case letters, digits and `_`, with a letter first, and not `time_s`", most = MOST_BYTES[0])]
    Field {
        /// Name of the topic.
        topic: String,
        /// Name of the field.
        field: String,
    },
    /// Two fields of the same name.
    #[error("topic `{topic}`, field `{field}`: is given twice")]
    Twice {
        /// Name of the topic.
        topic: String,
        /// Name of the field.
        field: String,
    },
    /// Unit or description that is too long or contains control characters.
    #[error("topic `{topic}`: a unit has at most {} bytes and a description at most {}, without control characters", MOST_BYTES[0], MOST_BYTES[1])]
    Text {
        /// Name of the topic.
        topic: String,
    },
    /// Number of fields out of bounds.
    #[error("topic `{topic}`: must have 1 to {MOST_FIELDS} fields, got {count}")]
    Count {
        /// Name of the topic.
        topic: String,
        /// Number of fields.
        count: usize,
    },
    /// Row with another number of values than the topic has fields.
    #[error("topic `{topic}`: a row has {fields} values, got {count}")]
    Values {
        /// Name of the topic.
        topic: String,
        /// Number of fields.
        fields: usize,
        /// Number of values.
        count: usize,
    },
    /// Row with a word for a number, a number for a word, or a word that is too long or contains control characters.
    #[error("topic `{topic}`, field `{field}`: must be {expected}")]
    Value {
        /// Name of the topic.
        topic: String,
        /// Name of the field.
        field: String,
        /// Form of the field's values.
        expected: &'static str,
    },
    /// Two parts of a run that declare different topics of one name.
    #[error("topic `{0}`: is declared by two parts with different fields")]
    Conflict(String),
    /// More custom topics in a run than a log can have.
    #[error("topic `{0}`: a run has at most {MOST_TOPICS} custom topics")]
    TooMany(String),
}

/// Returns true if a name is in snake case and short enough.
fn is_name(name: &str) -> bool {
    let allowed = |c: u8| c.is_ascii_lowercase() || c.is_ascii_digit() || c == b'_';
    name.len() <= MOST_BYTES[0]
        && name.as_bytes().first().is_some_and(u8::is_ascii_lowercase)
        && name.bytes().all(allowed)
}

/// Returns true if a text has at most `most` bytes and no control characters.
fn fits(text: &str, most: usize) -> bool {
    text.len() <= most && !text.chars().any(char::is_control)
}

/// Returns true if a word can be the value of a field.
pub(crate) fn is_word(text: &str) -> bool {
    fits(text, MOST_BYTES[0])
}

/// Converts a name in snake case to camel case.
fn camel_case(name: &str) -> String {
    let mut start = true;
    name.chars()
        .filter_map(|c| match (c, std::mem::replace(&mut start, c == '_')) {
            ('_', _) => None,
            (c, true) => Some(c.to_ascii_uppercase()),
            (c, false) => Some(c),
        })
        .collect()
}

impl CustomTopic {
    /// Creates a topic; `name` begins with a slash.
    ///
    /// # Errors
    /// [`TopicError`] for a name that is not in snake case or already taken, and for a size out of bounds.
    pub fn new(
        name: impl Into<String>,
        doc: impl Into<String>,
        fields: Vec<CustomField>,
    ) -> Result<Arc<Self>, TopicError> {
        let (name, doc) = (name.into(), doc.into());
        let Some(stem) = name.strip_prefix('/').filter(|stem| is_name(stem)) else {
            return Err(TopicError::Name(name));
        };
        if TOPICS.iter().any(|topic| topic.name == name) {
            return Err(TopicError::Taken(name));
        }
        if fields.is_empty() || fields.len() > MOST_FIELDS {
            return Err(TopicError::Count { topic: name, count: fields.len() });
        }
        let [most, most_of_doc] = MOST_BYTES;
        for (index, field) in fields.iter().enumerate() {
            if !is_name(&field.name) || RESERVED.contains(&field.name.as_str()) {
                return Err(TopicError::Field { topic: name, field: field.name.clone() });
            }
            if fields[..index].iter().any(|other| other.name == field.name) {
                return Err(TopicError::Twice { topic: name, field: field.name.clone() });
            }
            if !fits(&field.unit, most) || !fits(&field.doc, most_of_doc) {
                return Err(TopicError::Text { topic: name });
            }
        }
        if !fits(&doc, most_of_doc) {
            return Err(TopicError::Text { topic: name });
        }
        let message = format!("flexsc.custom.{}", camel_case(stem));
        Ok(Arc::new(Self { name, message, doc, fields }))
    }

    /// Returns the full name of the message.
    pub fn message(&self) -> &str {
        &self.message
    }

    /// Returns the name with its leading slash.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the description of the topic.
    pub fn doc(&self) -> &str {
        &self.doc
    }

    /// Returns the fields, in the order of the values of a row.
    pub fn fields(&self) -> &[CustomField] {
        &self.fields
    }

    /// Returns empty columns for the rows.
    pub(crate) fn columns(&self) -> Columns {
        let column = |field: &CustomField| {
            let empty = if field.is_word { Column::Texts(Vec::new()) } else { Column::Numbers(Vec::new()) };
            (field.name.clone(), empty)
        };
        Columns { columns: self.fields.iter().map(column).collect() }
    }
}

/// Custom topics of a run, numbered after those of the engine in the order of their first rows.
#[derive(Clone, Debug, Default)]
pub struct CustomTopics(Vec<Arc<CustomTopic>>);

impl CustomTopics {
    /// Returns the index of a topic, and true if it is new.
    ///
    /// # Errors
    /// A topic whose name another one has, or one topic too many.
    pub fn index(&mut self, topic: &Arc<CustomTopic>) -> Result<(usize, bool), TopicError> {
        if let Some(index) = self.0.iter().position(|known| known.name == topic.name) {
            let known = &self.0[index];
            return if Arc::ptr_eq(known, topic) || known == topic {
                Ok((index, false))
            } else {
                Err(TopicError::Conflict(topic.name.clone()))
            };
        }
        if self.0.len() == MOST_TOPICS {
            return Err(TopicError::TooMany(topic.name.clone()));
        }
        self.0.push(Arc::clone(topic));
        Ok((self.0.len() - 1, true))
    }

    /// Iterates over the topics in their order.
    pub fn iter(&self) -> impl Iterator<Item = &Arc<CustomTopic>> {
        self.0.iter()
    }
}
