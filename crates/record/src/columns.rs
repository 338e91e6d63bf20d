//! Columns: the rows of a topic as one array for each field.

use super::row::{FieldKind, Row, RowField, Sink};
use crate::enum_label::LoggedEnum;

/// Rows of one topic, column by column.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Columns {
    /// Columns with their names.
    pub columns: Vec<(String, Column)>,
}

/// Values of one column.
#[derive(Clone, Debug, PartialEq)]
pub enum Column {
    /// Floating-point numbers.
    Numbers(Vec<f64>),
    /// Unsigned counts, and flags as 0 or 1.
    Counts(Vec<u64>),
    /// Signed integers, which only logs of other programs have.
    Integers(Vec<i64>),
    /// Indices into the labels of an enumeration, and those labels.
    Labels(Vec<u8>, Vec<String>),
    /// Texts of each row.
    Texts(Vec<String>),
    /// Number of nested rows in each row, and the columns of all nested rows.
    Rows(Vec<u32>, Columns),
}

impl Columns {
    /// Creates empty columns for the fields.
    pub fn new(fields: &[RowField]) -> Self {
        let mut columns = Self::default();
        columns.add("", fields);
        columns
    }

    /// Adds empty columns; the name of a nested row precedes those of its fields: `rotation.x`.
    fn add(&mut self, before: &str, fields: &[RowField]) {
        for field in fields {
            let name = format!("{before}{}", field.name);
            let column = match field.kind {
                FieldKind::Number | FieldKind::Time(_) => Column::Numbers(Vec::new()),
                FieldKind::Count | FieldKind::Flag => Column::Counts(Vec::new()),
                FieldKind::Label(labels) => {
                    let owned = labels.values.iter().map(|&l| l.to_owned()).collect();
                    Column::Labels(Vec::new(), owned)
                }
                FieldKind::Text => Column::Texts(Vec::new()),
                FieldKind::Rows(message) => Column::Rows(Vec::new(), Self::new(message.fields)),
                FieldKind::Row(message) => {
                    self.add(&format!("{name}."), message.fields);
                    continue;
                }
            };
            self.columns.push((name, column));
        }
    }

    /// Returns the column of a name.
    pub fn get(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|(n, _)| n == name).map(|(_, column)| column)
    }

    /// Returns the values of the column of a name, if it holds doubles.
    pub fn numbers(&self, name: &str) -> Option<&[f64]> {
        match self.get(name) {
            Some(Column::Numbers(values)) => Some(values),
            _ => None,
        }
    }

    /// Returns the number of rows.
    pub fn len(&self) -> usize {
        self.columns.first().map_or(0, |(_, column)| column.len())
    }

    /// Returns true if there is no row.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Appends a row of the type for which the columns were created.
    pub fn push<R: Row>(&mut self, row: &R) {
        row.write_to(&mut ColumnFiller { columns: self.columns.iter_mut() });
    }
}

impl Column {
    /// Returns the number of values.
    pub fn len(&self) -> usize {
        match self {
            Self::Numbers(values) => values.len(),
            Self::Counts(values) => values.len(),
            Self::Integers(values) => values.len(),
            Self::Labels(values, _) => values.len(),
            Self::Texts(values) => values.len(),
            Self::Rows(values, _) => values.len(),
        }
    }

    /// Returns true if there is no value.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Sink that writes the fields of a row into columns, which are in the same order.
struct ColumnFiller<'a> {
    columns: std::slice::IterMut<'a, (String, Column)>,
}

impl Sink for ColumnFiller<'_> {
    #[inline]
    fn number(&mut self, value: f64) {
        if let Some((_, Column::Numbers(values))) = self.columns.next() {
            values.push(value);
        }
    }

    #[inline]
    fn count(&mut self, value: u64) {
        if let Some((_, Column::Counts(values))) = self.columns.next() {
            values.push(value);
        }
    }

    #[inline]
    fn label(&mut self, index: usize, _: &'static LoggedEnum) {
        if let Some((_, Column::Labels(values, _))) = self.columns.next() {
            values.push(index as u8);
        }
    }

    fn text(&mut self, text: &str) {
        if let Some((_, Column::Texts(values))) = self.columns.next() {
            values.push(text.to_owned());
        }
    }

    fn flag(&mut self, value: bool) {
        self.count(u64::from(value));
    }

    fn time(&mut self, nanoseconds: u64) {
        self.number(seconds(nanoseconds));
    }

    fn row<R: Row>(&mut self, row: &R) {
        row.write_to(self);
    }

    fn rows<R: Row>(&mut self, rows: &[R]) {
        if let Some((_, Column::Rows(counts, columns))) = self.columns.next() {
            counts.push(rows.len() as u32);
            for row in rows {
                columns.push(row);
            }
        }
    }
}

/// Converts nanoseconds to seconds.
pub fn seconds(nanoseconds: u64) -> f64 {
    nanoseconds as f64 / 1e9
}
