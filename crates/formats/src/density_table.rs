//! Densities of an atmosphere at heights.

use crate::csv_table::{CsvTable, TableKind};

/// Rows of height and density, by increasing height.
#[derive(Clone, Debug, PartialEq)]
pub struct Densities;

/// Density (kg/m³) at heights (m), or the path of the file that contains them.
pub type DensityTable = CsvTable<Densities>;

impl TableKind for Densities {
    const NAME: &'static str = "DensityTable";
    const ROWS: &'static str = "rows of height (m) and density (kg/m³)";
    const ROW: &'static str = "a height (m) and a density (kg/m³)";
    const HEADERS: &'static [&'static [&'static str]] = &[&["height", "density"]];
    const MOST: usize = 10_000;
    const LONGEST: u64 = 1 << 20;

    fn check(rows: &[Vec<f64>], place: &dyn Fn(usize) -> String) -> Result<(), String> {
        for (index, row) in rows.iter().enumerate() {
            let [height, density] = row[..] else { continue };
            if height.is_nan() || height.abs() > 1e12 {
                return Err(format!("{}: must have a height (m), got {height}", place(index)));
            }
            if density.is_nan() || density <= 0.0 || density > 1e3 {
                let why = format!("must have a positive density (kg/m³), got {density}");
                return Err(format!("{}: {why}", place(index)));
            }
            if index > 0 && height <= rows[index - 1][0] {
                let why =
                    format!("must have increasing heights, got {height} m after {} m", rows[index - 1][0]);
                return Err(format!("{}: {why}", place(index)));
            }
        }
        Ok(())
    }
}
