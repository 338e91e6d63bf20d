//! The rows of a campaign as one file, CSV or Parquet.

use std::path::Path;

use flexsc_core::campaign::{ColumnCells, RUN, RowMaker, RunRows, SECONDS, SEED};
use serde_json::json;

use super::TableFormat;
use crate::error::CliError;
use crate::files;

/// Writes rows as one file.
pub fn write(path: &Path, kind: TableFormat, work: &RowMaker, rows: &RunRows) -> Result<(), CliError> {
    let bytes = match kind {
        TableFormat::Parquet => work.encode(rows).map_err(CliError::write(path))?,
        TableFormat::Csv => csv(work, rows).map_err(|error| CliError::write(path)(error.into()))?,
    };
    // The target was checked before the runs were made.
    files::write(path, &bytes, true)
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
        ColumnCells::Words(cells) => cells[row].clone(),
        ColumnCells::Lists(cells) => cells[row].as_ref().map(|list| json!(list).to_string()),
    };
    text.unwrap_or_default()
}
