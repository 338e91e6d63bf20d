//! The rows of a campaign as one file, CSV or Parquet.

use std::path::Path;

use flexsc_core::campaign::{ColumnCells, Directory, Merge, RUN, RowMaker, RunRows, SECONDS, SEED};
use serde_json::json;

use super::{TableFormat, part_files};
use crate::error::CliError;
use crate::{files, out};

/// Largest number of cells in a file, by the memory that it needs.
const MOST_CELLS: u64 = 1 << 29;

/// Writes rows as one file.
pub fn write(path: &Path, kind: TableFormat, work: &RowMaker, rows: &RunRows) -> Result<(), CliError> {
    // The target was checked before the runs were made.
    files::write(path, &encode(path, kind, work, rows)?, true)
}

/// Returns the ending of the one file at a path that is to hold the rows of a campaign; `None` for a directory.
///
/// # Errors
/// An ending that no such file has.
pub fn table_ending(path: &Path) -> Result<Option<&'static str>, String> {
    out::accepted_ending(path, &TableFormat::ENDINGS)
}

/// Returns the rows of a directory as the bytes of one file with this ending, `csv` or `parquet`.
///
/// # Errors
/// An incomplete campaign, or one that is too large for a file.
pub fn encode_table(directory: &Directory, ending: &str) -> Result<Vec<u8>, CliError> {
    let kind = TableFormat::for_ending(ending);
    let merge = Merge::new(std::slice::from_ref(directory)).map_err(part_files::failure)?;
    validate_size(directory.path(), &merge)?;
    let rows = merge.rows().map_err(part_files::failure)?;
    encode(directory.path(), kind, merge.work(), &rows)
}

/// Refuses more rows than one file can hold.
pub fn validate_size(path: &Path, merge: &Merge<'_>) -> Result<(), CliError> {
    let runs = merge.manifest().runs();
    if (runs.end - runs.start).saturating_mul(merge.work().fields().len() as u64) > MOST_CELLS {
        let why = "has too many rows for one file\n\nhint: give a directory";
        return Err(CliError::Arguments(format!("{}: {why}", path.display())));
    }
    Ok(())
}

fn encode(path: &Path, kind: TableFormat, work: &RowMaker, rows: &RunRows) -> Result<Vec<u8>, CliError> {
    match kind {
        TableFormat::Parquet => work.encode(rows).map_err(CliError::write(path)),
        TableFormat::Csv => csv(work, rows).map_err(|error| CliError::write(path)(error.into())),
    }
}

fn csv(work: &RowMaker, rows: &RunRows) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    // Run times differ from one repetition to the next: they are left out.
    let columns: Vec<_> =
        rows.fields.iter().zip(&rows.columns).filter(|(field, _)| field.name != SECONDS).collect();
    let keys: Vec<&str> = work.campaign.keys().collect();
    writer.write_record(columns.iter().map(|(field, _)| &field.name))?;
    for row in 0..rows.len() {
        writer.write_record(columns.iter().map(|(field, cells)| {
            let is_label = [RUN, SEED].contains(&field.name.as_str()) || keys.contains(&field.name.as_str());
            cell(cells, row, is_label)
        }))?;
    }
    Ok(writer.into_inner().map_err(csv::IntoInnerError::into_error)?)
}

/// Returns a cell as text: values that describe the run as in a scenario, metrics with all digits.
fn cell(cells: &ColumnCells, row: usize, is_label: bool) -> String {
    let text = match cells {
        ColumnCells::Integers(cells) => cells[row].map(|integer| integer.to_string()),
        ColumnCells::Numbers(cells) if cells[row].is_nan() => None,
        ColumnCells::Numbers(cells) if is_label && cells[row].fract() == 0.0 => {
            Some(format!("{:.1}", cells[row]))
        }
        ColumnCells::Numbers(cells) if is_label => Some(cells[row].to_string()),
        ColumnCells::Numbers(cells) => Some(format!("{:e}", cells[row])),
        ColumnCells::Text(cells) => cells[row].clone(),
        ColumnCells::Lists(cells) => cells[row].as_ref().map(|list| json!(list).to_string()),
    };
    text.unwrap_or_default()
}
