//! Measured responses over frequency: complex numbers as real and imaginary part, or as magnitude and phase.

use crate::csv_table::{CsvTable, TableKind, check_frequencies};

/// Rows of frequency and a complex number, by increasing frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct ResponseRows;

/// Response over frequency, or the path of the file that contains it.
pub type ResponseTable = CsvTable<ResponseRows>;

/// Header of magnitude and phase.
pub const POLAR: &[&str] = &["frequency", "magnitude", "phase"];

impl TableKind for ResponseRows {
    const NAME: &'static str = "ResponseTable";
    const ROWS: &'static str =
        "rows of frequency (Hz) and response, as real and imaginary part or as magnitude and phase";
    const ROW: &'static str = "a frequency (Hz), and a real and an imaginary part or a magnitude and a phase";
    const HEADERS: &'static [&'static [&'static str]] = &[&["frequency", "real", "imaginary"], POLAR];
    const MOST: usize = 100_000;
    const LONGEST: u64 = 1 << 24;

    fn check(rows: &[Vec<f64>], place: &dyn Fn(usize) -> String) -> Result<(), String> {
        check_frequencies(rows, place)?;
        for (index, row) in rows.iter().enumerate() {
            if let Some(value) = row[1..].iter().find(|value| !value.is_finite()) {
                return Err(format!("{}: must have finite numbers, got {value}", place(index)));
            }
        }
        Ok(())
    }
}
