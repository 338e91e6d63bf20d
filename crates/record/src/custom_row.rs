//! Rows of custom topics.

use std::sync::Arc;

use super::columns::{Column, Columns};
use super::custom_topic::{CustomTopic, TopicError};
use super::log_topic::LogTopic;
use super::proto::Encoder;
use super::report::LogRow;
use super::row::Sink;

/// Row of a custom topic.
#[derive(Clone, Debug, PartialEq)]
pub struct CustomRow {
    topic: Arc<CustomTopic>,
    values: Vec<f64>,
}

impl CustomRow {
    /// Returns the values, in the order of the topic's fields.
    pub fn values(&self) -> &[f64] {
        &self.values
    }
}

impl LogRow for CustomRow {
    fn topic(&self) -> LogTopic<'_> {
        LogTopic::Custom(&self.topic)
    }

    fn encode(&self, buffer: &mut Vec<u8>) {
        let mut encoder = Encoder::new(buffer);
        self.values.iter().for_each(|value| encoder.number(*value));
    }

    fn fill(&self, columns: &mut Columns) {
        for ((_, column), value) in columns.columns.iter_mut().zip(&self.values) {
            if let Column::Numbers(values) = column {
                values.push(*value);
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
    /// [`TopicError::Values`] for another number of values.
    pub fn row(self: &Arc<Self>, values: impl Into<Vec<f64>>) -> Result<CustomRow, TopicError> {
        let (values, fields) = (values.into(), self.fields().len());
        if values.len() == fields {
            Ok(CustomRow { topic: Arc::clone(self), values })
        } else {
            Err(TopicError::Values { topic: self.name().to_owned(), fields, count: values.len() })
        }
    }
}
