//! Columns: a topic's rows as one array for each field.

use super::row::{Field, Kind, Row, Sink};
use crate::label::Labels;

/// The rows of one topic, column by column.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Columns {
    /// Name of each column, and the column.
    pub columns: Vec<(String, Column)>,
}

/// One column.
#[derive(Clone, Debug, PartialEq)]
pub enum Column {
    /// Doubles.
    Numbers(Vec<f64>),
    /// Counts.
    Counts(Vec<u64>),
    /// Whole numbers with a sign, which only logs of other programs have.
    Integers(Vec<i64>),
    /// Indices into the labels of an enumeration.
    Labels(Vec<u8>, Vec<String>),
    /// Texts.
    Texts(Vec<String>),
    /// A column for each field of the rows within a row, and the number of them in each row.
    Rows(Vec<u32>, Columns),
}

impl Columns {
    /// Empty columns for these fields.
    pub fn new(fields: &[Field]) -> Self {
        let mut columns = Self::default();
        columns.add("", fields);
        columns
    }

    /// Adds empty columns; those of a row within the row have its name before theirs: `rotation.x`.
    fn add(&mut self, before: &str, fields: &[Field]) {
        for field in fields {
            let name = format!("{before}{}", field.name);
            let column = match field.kind {
                Kind::Number | Kind::Time(_) => Column::Numbers(Vec::new()),
                Kind::Count | Kind::Flag => Column::Counts(Vec::new()),
                Kind::Label(labels) => {
                    let owned = labels.values.iter().map(|&l| l.to_owned()).collect();
                    Column::Labels(Vec::new(), owned)
                }
                Kind::Text => Column::Texts(Vec::new()),
                Kind::Rows(message) => Column::Rows(Vec::new(), Self::new(message.fields)),
                Kind::Row(message) => {
                    self.add(&format!("{name}."), message.fields);
                    continue;
                }
            };
            self.columns.push((name, column));
        }
    }

    /// The column of this name.
    pub fn get(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|(n, _)| n == name).map(|(_, column)| column)
    }

    /// The doubles of the column of this name.
    pub fn numbers(&self, name: &str) -> Option<&[f64]> {
        match self.get(name) {
            Some(Column::Numbers(values)) => Some(values),
            _ => None,
        }
    }

    /// How many rows there are.
    pub fn len(&self) -> usize {
        self.columns.first().map_or(0, |(_, column)| column.len())
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Appends a row of the type that the columns were made for.
    pub fn push<R: Row>(&mut self, row: &R) {
        row.put(&mut Filler { columns: self.columns.iter_mut() });
    }
}

impl Column {
    /// How many values there are.
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

    /// Whether there is no value.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Puts the fields of a row into columns, in their common order.
struct Filler<'a> {
    columns: std::slice::IterMut<'a, (String, Column)>,
}

impl Sink for Filler<'_> {
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
    fn label(&mut self, index: usize, _: &'static Labels) {
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
        row.put(self);
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

/// Nanoseconds in seconds.
pub fn seconds(nanoseconds: u64) -> f64 {
    nanoseconds as f64 / 1e9
}
