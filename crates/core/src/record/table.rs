//! The rows of one topic of a log, by the schema that the log carries.

use prost_reflect::{DescriptorPool, DynamicMessage, Kind, MessageDescriptor, ReflectMessage};

use super::topics::label_of;
use super::{Column, Columns, columns};

/// The rows of one topic as they are read.
pub struct Table {
    descriptor: MessageDescriptor,
    columns: Columns,
    /// Log time of each row (s).
    pub times: Vec<f64>,
}

impl Table {
    /// An empty table for the messages of a schema.
    pub fn of(schema: Option<&mcap::Schema<'_>>) -> Result<Self, String> {
        let schema = schema.ok_or("no schema")?;
        let pool = DescriptorPool::decode(&*schema.data).map_err(|error| error.to_string())?;
        let descriptor = pool.get_message_by_name(&schema.name).ok_or("no message in its schema")?;
        Ok(Self { columns: empty(&descriptor), descriptor, times: Vec::new() })
    }

    /// Takes a message.
    pub fn push(&mut self, message: &[u8]) -> Result<(), String> {
        let row = DynamicMessage::decode(self.descriptor.clone(), message);
        push(&mut self.columns, &row.map_err(|error| error.to_string())?);
        Ok(())
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

/// Whether a field is a date or a span of time.
fn is_time(of: &MessageDescriptor) -> bool {
    matches!(of.full_name(), "google.protobuf.Timestamp" | "google.protobuf.Duration")
}

fn empty(message: &MessageDescriptor) -> Columns {
    let mut columns = Columns::default();
    add(&mut columns, "", message);
    columns
}

/// Adds a column for each field; those of a message within the message have its name before theirs: `rotation.x`.
fn add(columns: &mut Columns, before: &str, message: &MessageDescriptor) {
    for field in message.fields() {
        let name = format!("{before}{}", field.name());
        let column = match field.kind() {
            Kind::Double | Kind::Float => Column::Numbers(Vec::new()),
            Kind::Enum(of) => {
                let labels = of.values().map(|value| label_of(value.name())).collect();
                Column::Labels(Vec::new(), labels)
            }
            Kind::Message(of) if is_time(&of) => Column::Numbers(Vec::new()),
            Kind::Message(of) if field.is_list() => Column::Rows(Vec::new(), empty(&of)),
            Kind::Message(of) => {
                add(columns, &format!("{name}."), &of);
                continue;
            }
            Kind::String => Column::Texts(Vec::new()),
            _ => Column::Counts(Vec::new()),
        };
        columns.columns.push((name, column));
    }
}

fn push(columns: &mut Columns, row: &DynamicMessage) {
    fill(&mut columns.columns.iter_mut(), row);
}

/// Fills the columns of a message, in the order in which they were added.
fn fill(columns: &mut std::slice::IterMut<'_, (String, Column)>, row: &DynamicMessage) {
    for field in row.descriptor().fields() {
        let value = row.get_field(&field);
        if let Some(inner) = value.as_message()
            && !is_time(&inner.descriptor())
        {
            fill(columns, inner);
            continue;
        }
        match columns.next().map(|(_, column)| column) {
            Some(Column::Numbers(values)) => values.push(match value.as_message() {
                Some(time) => seconds(time),
                None => value.as_f64().unwrap_or(f64::NAN),
            }),
            Some(Column::Counts(values)) => {
                let count = value.as_u64().or_else(|| value.as_bool().map(u64::from));
                values.push(count.unwrap_or(0));
            }
            Some(Column::Labels(values, _)) => values.push(value.as_enum_number().unwrap_or(0) as u8),
            Some(Column::Texts(values)) => values.push(value.as_str().unwrap_or_default().to_owned()),
            Some(Column::Rows(counts, inner)) => {
                let rows = value.as_list().unwrap_or_default();
                counts.push(rows.len() as u32);
                rows.iter().filter_map(|row| row.as_message()).for_each(|row| push(inner, row));
            }
            None => {}
        }
    }
}

/// A date or a span of time in seconds.
fn seconds(time: &DynamicMessage) -> f64 {
    let part = |name: &str| time.get_field_by_name(name);
    let whole = part("seconds").and_then(|s| s.as_i64()).unwrap_or(0);
    let past = part("nanos").and_then(|ns| ns.as_i32()).unwrap_or(0);
    // One rounding, as of the nanoseconds themselves.
    columns::seconds(whole.max(0) as u64 * 1_000_000_000 + past.max(0) as u64)
}
