//! Table of points as CSV: a column for each key, a row for each point.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use flexsc_core::campaign::{DesignBlock, MOST_NUMBERS};

use crate::error::CliError;

/// Largest size of a table (bytes).
const LONGEST: u64 = 64 << 20;

/// Reads a table of points.
pub fn read(path: &Path) -> Result<DesignBlock, CliError> {
    let refused = |why: String| CliError::Arguments(format!("{}: {why}", path.display()));
    let wrong = |error: csv::Error| refused(format!("is not a table of points: {error}"));
    // A pipe has no length, and a device may never end.
    let file = File::open(path).map_err(|error| refused(error.to_string()))?.take(LONGEST);
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(file);
    let keys: Vec<String> = reader.headers().map_err(wrong)?.iter().map(str::to_owned).collect();
    if let Some(key) = keys.iter().find(|key| key.is_empty() || key.parse::<f64>().is_ok()) {
        return Err(refused(format!("must begin with the keys of its columns, got `{key}`")));
    }
    let mut points = Vec::new();
    for row in reader.records() {
        let row = row.map_err(wrong)?;
        let line = row.position().map_or(0, csv::Position::line);
        let number = |(key, cell): (&String, &str)| {
            let number = cell.parse::<f64>().ok().filter(|number| number.is_finite());
            number.ok_or_else(|| refused(format!("line {line}: `{key}` must be a number, got `{cell}`")))
        };
        points.push(keys.iter().zip(&row).map(number).collect::<Result<Vec<f64>, _>>()?);
        if points.len() * keys.len() > MOST_NUMBERS {
            return Err(refused(format!("has more than {MOST_NUMBERS} numbers")));
        }
    }
    if reader.get_ref().limit() == 0 {
        return Err(refused(format!("must have at most {LONGEST} bytes")));
    }
    if points.is_empty() {
        return Err(refused("has no point".to_owned()));
    }
    Ok(DesignBlock::Table { keys, points })
}
