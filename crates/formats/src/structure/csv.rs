//! CSV files: matrices with one row in each line, numbers separated by commas and no header; and the records of other
//! tables.

use std::path::Path;

use ::csv::StringRecord;
use nalgebra::DMatrix;

use super::LARGEST;
use crate::number::real;
use crate::text_file::open_text;

/// Reads a matrix.
pub fn read(path: &Path) -> Result<DMatrix<f64>, String> {
    let records = records(path, LARGEST, "rows")?;
    let columns = records.first().map_or(0, |(_, record)| record.len());
    let mut numbers: Vec<f64> = Vec::with_capacity(records.len() * columns);
    for (line, record) in &records {
        if record.len() != columns {
            let found = record.len();
            return Err(format!("line {line}: must have {columns} numbers, as the first row, got {found}"));
        }
        for (index, field) in record.iter().enumerate() {
            let number = real(field).ok_or_else(|| {
                let column = index + 1;
                format!(
                    "line {line}: must have numbers separated by commas, got `{field}` in column {column}"
                )
            })?;
            numbers.push(number);
        }
    }
    Ok(DMatrix::from_row_slice(records.len(), columns, &numbers))
}

/// Reads the records of a file, each with its line number: at most `most`, called `called` in messages. Comments begin
/// with `#`.
pub fn records(path: &Path, most: usize, called: &str) -> Result<Vec<(u64, StringRecord)>, String> {
    let reader = ::csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .trim(::csv::Trim::All)
        .comment(Some(b'#'))
        .from_reader(open_text(path)?);
    let mut records = Vec::new();
    for record in reader.into_records() {
        let record = record.map_err(csv_error)?;
        let line = record.position().map_or(0, ::csv::Position::line);
        if records.len() == most {
            return Err(format!("line {line}: must have at most {most} {called}"));
        }
        if record.len() > LARGEST {
            let found = record.len();
            return Err(format!("line {line}: must have at most {LARGEST} columns, got {found}"));
        }
        records.push((line, record));
    }
    Ok(records)
}

fn csv_error(error: ::csv::Error) -> String {
    match error.into_kind() {
        ::csv::ErrorKind::Io(error) => error.to_string(),
        ::csv::ErrorKind::Utf8 { pos, .. } => {
            format!("line {} is not UTF-8 text", pos.map_or(0, |pos| pos.line()))
        }
        _ => "must have a row of numbers in each line".to_owned(),
    }
}
