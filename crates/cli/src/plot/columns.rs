//! Topics of a log as columns and rows of numbers and labels.

use flexsc_core::record::{Column, Columns, Log};

use crate::error::CliError;

/// Returns the columns of some topics; empty for a topic that the log does not have.
pub fn topics<const N: usize>(log: &Log, names: [&str; N]) -> Result<[Columns; N], CliError> {
    let mut tables = log.tables(&names)?.into_iter();
    Ok(names.map(|_| tables.next().flatten().unwrap_or_default()))
}

/// Returns the doubles of some columns, row by row.
pub fn rows<'a, const N: usize>(
    columns: &'a Columns,
    names: [&str; N],
) -> impl Iterator<Item = [f64; N]> + 'a {
    let columns = names.map(|name| columns.numbers(name).unwrap_or_default());
    let shortest = columns.iter().map(|column| column.len()).min().unwrap_or(0);
    (0..shortest).map(move |row| columns.map(|column| column[row]))
}

/// Returns the labels of a column, row by row.
pub fn labels(columns: &Columns, name: &str) -> Vec<String> {
    let Some(Column::Labels(values, labels)) = columns.get(name) else { return Vec::new() };
    values.iter().map(|value| labels.get(usize::from(*value)).cloned().unwrap_or_default()).collect()
}
