//! The rows of one topic of a log, by the schema that the log carries.

use std::sync::Arc;

use super::shape::{Shape, begin};
use super::{Column, Columns};

/// How the messages of a log are encoded.
#[derive(Clone, Debug, PartialEq)]
pub struct Schema {
    /// Full name of the message.
    pub name: String,
    /// What the schema is written in.
    pub encoding: String,
    /// A `FileDescriptorSet`, where that is `protobuf`.
    pub data: Vec<u8>,
}

/// The memory that tables of a log may take.
pub struct Budget(usize);

/// Tables may take this much (bytes), however small the log is ...
const LEAST: usize = 256 << 20;
/// ... and so many times its size. Those of a run take up to about ten times.
const TIMES: usize = 64;

impl Budget {
    /// The budget of a log of so many bytes.
    pub fn of_file(bytes: usize) -> Self {
        Self(bytes.saturating_mul(TIMES).saturating_add(LEAST))
    }

    /// Takes some of it.
    pub fn spend(&mut self, bytes: usize) -> Result<(), String> {
        self.0 = self.0.checked_sub(bytes).ok_or_else(|| {
            format!("its rows take more than {TIMES} times the size of the file and {} MiB", LEAST >> 20)
        })?;
        Ok(())
    }
}

/// The rows of one topic as they are read.
pub struct Table {
    schema: Arc<Schema>,
    shape: Shape,
    columns: Columns,
    times: Vec<f64>,
}

impl Table {
    /// An empty table for the messages of a schema.
    pub fn of(schema: Arc<Schema>) -> Result<Self, String> {
        let (shape, columns) = Shape::of(&schema)?;
        Ok(Self { schema, shape, columns, times: Vec::new() })
    }

    /// Whether its messages are of this schema.
    pub fn is_of(&self, schema: &Arc<Schema>) -> bool {
        Arc::ptr_eq(&self.schema, schema) || self.schema == *schema
    }

    /// Takes a message of this log time (s).
    pub fn push(&mut self, time: f64, message: &[u8], budget: &mut Budget) -> Result<(), String> {
        budget.spend(size_of::<f64>())?;
        self.times.push(time);
        begin(&mut self.columns, budget)?;
        self.shape.fill(&mut self.columns, message, budget)
    }

    /// The columns, the first of them with times.
    pub fn into_columns(self) -> Columns {
        let Self { mut columns, times, .. } = self;
        if columns.get("time_s").is_none() {
            columns.columns.insert(0, ("time_s".to_owned(), Column::Numbers(times)));
        }
        columns
    }
}
