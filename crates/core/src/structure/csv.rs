//! Matrices from CSV files: a row a line, numbers parted by commas, no header.

use std::path::Path;

use nalgebra::DMatrix;

use super::LARGEST;

/// Reads a file.
pub fn read(path: &Path) -> Result<DMatrix<f64>, String> {
    let reader = ::csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .trim(::csv::Trim::All)
        .comment(Some(b'#'))
        .from_path(path);
    let mut numbers: Vec<f64> = Vec::new();
    let (mut rows, mut columns) = (0, 0);
    for record in reader.map_err(told)?.into_records() {
        let record = record.map_err(told)?;
        let line = record.position().map_or(0, ::csv::Position::line);
        if rows == 0 {
            columns = record.len();
        }
        if record.len() != columns {
            let found = record.len();
            return Err(format!("line {line}: must have {columns} numbers, as the first row, got {found}"));
        }
        if rows == LARGEST {
            return Err(format!("line {line}: must have at most {LARGEST} rows"));
        }
        rows += 1;
        for (index, field) in record.iter().enumerate() {
            let number = field.parse().map_err(|_| {
                let column = index + 1;
                format!("line {line}: must have numbers parted by commas, got `{field}` in column {column}")
            })?;
            numbers.push(number);
        }
    }
    Ok(DMatrix::from_row_slice(rows, columns, &numbers))
}

fn told(error: ::csv::Error) -> String {
    match error.into_kind() {
        ::csv::ErrorKind::Io(error) => error.to_string(),
        ::csv::ErrorKind::Utf8 { pos, .. } => {
            format!("line {} is not UTF-8 text", pos.map_or(0, |pos| pos.line()))
        }
        _ => "must have a row of numbers in each line".to_owned(),
    }
}
