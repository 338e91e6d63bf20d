//! Spectral densities of forces and torques over frequency.

use crate::csv_table::{CsvTable, TableKind, check_frequencies};

/// Rows of frequency and densities, by increasing frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadDensityRows;

/// Density of forces and torques over frequency, or the path of the file that contains it.
pub type LoadDensityTable = CsvTable<LoadDensityRows>;

impl TableKind for LoadDensityRows {
    const NAME: &'static str = "LoadDensityTable";
    const ROWS: &'static str = "rows of frequency (Hz) and density of the force along x, y and z (N²/Hz), and of the torque about x, y and z \
                                ((N m)²/Hz)";
    const ROW: &'static str = "a frequency (Hz) and a density (N²/Hz) along all axes, three along x, y and z, or six with those of the torque \
                               about x, y and z ((N m)²/Hz)";
    const HEADERS: &'static [&'static [&'static str]] = &[
        &["frequency", "force"],
        &["frequency", "fx", "fy", "fz"],
        &["frequency", "fx", "fy", "fz", "tx", "ty", "tz"],
    ];
    const MOST: usize = 10_000;
    const LONGEST: u64 = 1 << 22;

    fn check(rows: &[Vec<f64>], place: &dyn Fn(usize) -> String) -> Result<(), String> {
        check_frequencies(rows, place)?;
        for (index, row) in rows.iter().enumerate() {
            if let Some(value) = row[1..].iter().find(|value| !(**value >= 0.0 && value.is_finite())) {
                return Err(format!("{}: must have densities from 0 on, got {value}", place(index)));
            }
        }
        Ok(())
    }
}
