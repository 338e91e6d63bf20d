//! Torques or forces over time.

use crate::csv_table::{CsvTable, TableKind};

/// Rows of time and torque or force, by increasing time.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadRows;

/// Torque (N m) or force (N) from times (s) on, or the path of the file that contains them.
pub type LoadTable = CsvTable<LoadRows>;

impl TableKind for LoadRows {
    const NAME: &'static str = "LoadTable";
    const ROWS: &'static str =
        "rows of time (s) and torque (N m), or of time and three components of a force (N)";
    const ROW: &'static str = "a time (s) and a torque (N m), or a time and three components of a force (N)";
    const HEADERS: &'static [&'static [&'static str]] = &[&["time", "torque"], &["time", "x", "y", "z"]];
    const MOST: usize = 1_000_000;
    const LONGEST: u64 = 1 << 26;

    fn check(rows: &[Vec<f64>], place: &dyn Fn(usize) -> String) -> Result<(), String> {
        let mut before = None;
        for (index, row) in rows.iter().enumerate() {
            let time = row[0];
            if !(0.0..1e12).contains(&time) {
                return Err(format!("{}: must have a time from 0 s on, got {time}", place(index)));
            }
            if let Some(value) = row.iter().find(|value| !value.is_finite()) {
                return Err(format!("{}: must have finite numbers, got {value}", place(index)));
            }
            if let Some(before) = before.filter(|before| time <= *before) {
                let why = format!("must have increasing times, got {time} s after {before} s");
                return Err(format!("{}: {why}", place(index)));
            }
            before = Some(time);
        }
        Ok(())
    }
}
