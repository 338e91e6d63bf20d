//! Rows of custom topics.

use std::sync::Arc;

use super::columns::{Column, Columns};
use super::custom_topic::{CustomTopic, TopicError, WORD, is_word};
use super::log_topic::LogTopic;
use super::proto::Encoder;
use super::report::LogRow;
use super::row::Sink;

/// Value of a field of a custom row.
#[derive(Clone, Debug, PartialEq)]
pub enum CustomValue {
    /// Floating-point number; NaN if there is no value.
    Number(f64),
    /// Word, such as a state.
    Word(String),
}

impl From<f64> for CustomValue {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

/// Row of a custom topic.
#[derive(Clone, Debug, PartialEq)]
pub struct CustomRow {
    topic: Arc<CustomTopic>,
    values: Vec<CustomValue>,
}

impl CustomRow {
    /// Returns the values, in the order of the topic's fields.
    pub fn values(&self) -> &[CustomValue] {
        &self.values
    }
}

impl LogRow for CustomRow {
    fn topic(&self) -> LogTopic<'_> {
        LogTopic::Custom(&self.topic)
    }

    fn encode(&self, buffer: &mut Vec<u8>) {
        let mut encoder = Encoder::new(buffer);
        for value in &self.values {
            match value {
                CustomValue::Number(number) => encoder.number(*number),
                CustomValue::Word(word) => encoder.text(word),
            }
        }
    }

    fn fill(&self, columns: &mut Columns) {
        for ((_, column), value) in columns.columns.iter_mut().zip(&self.values) {
            match (column, value) {
                (Column::Numbers(column), CustomValue::Number(number)) => column.push(*number),
                (Column::Texts(column), CustomValue::Word(word)) => column.push(word.clone()),
                // A row has the kinds of values of its topic.
                _ => {}
            }
        }
    }

    fn copy(&self) -> Box<dyn LogRow> {
        Box::new(self.clone())
    }
}

impl CustomTopic {
    /// Creates a row with one value for each field.
    ///
    /// # Errors
    /// [`TopicError::Values`] for another number of values, and [`TopicError::Value`] for a value of the wrong kind.
    pub fn row<V: Into<CustomValue>>(
        self: &Arc<Self>,
        values: impl IntoIterator<Item = V>,
    ) -> Result<CustomRow, TopicError> {
        let values: Vec<CustomValue> = values.into_iter().map(Into::into).collect();
        let fields = self.fields();
        if values.len() != fields.len() {
            let (topic, count) = (self.name().to_owned(), values.len());
            return Err(TopicError::Values { topic, fields: fields.len(), count });
        }
        let is_right = |field_has_words: bool, value: &CustomValue| match value {
            CustomValue::Number(_) => !field_has_words,
            CustomValue::Word(word) => field_has_words && is_word(word),
        };
        match fields.iter().zip(&values).find(|(field, value)| !is_right(field.is_word, value)) {
            Some((field, _)) => Err(TopicError::Value {
                topic: self.name().to_owned(),
                field: field.name.clone(),
                expected: if field.is_word { WORD } else { "a number" },
            }),
            None => Ok(CustomRow { topic: Arc::clone(self), values }),
        }
    }
}
