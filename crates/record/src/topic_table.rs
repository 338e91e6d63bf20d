//! Rows of one topic of a log, by the schema that the log contains.

use std::sync::Arc;

use super::decoder::{MessageDecoder, Schema, begin};
use super::memory_budget::MemoryBudget;
use super::{Column, Columns};

/// Rows of one topic while they are read.
pub struct TopicTable {
    schema: Arc<Schema>,
    shape: MessageDecoder,
    columns: Columns,
    times: Vec<f64>,
}

impl TopicTable {
    /// Creates an empty table for the messages of a schema.
    pub fn for_schema(schema: Arc<Schema>) -> Result<Self, String> {
        let (shape, columns) = MessageDecoder::from_schema(&schema)?;
        Ok(Self { schema, shape, columns, times: Vec::new() })
    }

    /// Returns true if the messages of the table have this schema.
    pub fn has_schema(&self, schema: &Arc<Schema>) -> bool {
        Arc::ptr_eq(&self.schema, schema) || self.schema == *schema
    }

    /// Appends a message of this log time (s).
    pub fn push(&mut self, time: f64, message: &[u8], budget: &mut MemoryBudget) -> Result<(), String> {
        budget.reserve(size_of::<f64>())?;
        self.times.push(time);
        begin(&mut self.columns, budget)?;
        self.shape.fill(&mut self.columns, message, budget)
    }

    /// Returns the columns, with times as the first.
    pub fn into_columns(self) -> Columns {
        let Self { mut columns, times, .. } = self;
        if columns.get("time_s").is_none() {
            columns.columns.insert(0, ("time_s".to_owned(), Column::Numbers(times)));
        }
        columns
    }
}
