//! Table of numbers as CSV: columns with units in their names.

use serde::Serialize;
use serde_json::{Value as Json, json};

/// Table of numbers.
pub struct NumberTable {
    /// Names of the columns, with their units.
    pub columns: Vec<String>,
    /// Cells of each row; `None` for a number that does not exist or is infinite.
    pub rows: Vec<Vec<Option<f64>>>,
}

impl NumberTable {
    /// Returns the table of structs, whose fields are the columns.
    pub fn from_rows<T: Serialize>(rows: &[T]) -> Self {
        let objects: Vec<Json> = rows.iter().map(|row| json!(row)).collect();
        let objects: Vec<_> = objects.iter().filter_map(Json::as_object).collect();
        let columns = objects.first().map_or_else(Vec::new, |first| first.keys().cloned().collect());
        let rows = objects.iter().map(|object| object.values().map(Json::as_f64).collect()).collect();
        Self { columns, rows }
    }

    /// Returns the table of groups of structs, with the number of the group as the first column. The fields of a struct
    /// within a struct have its name before theirs.
    pub fn from_groups<T: Serialize>(group: &str, groups: &[Vec<T>]) -> Self {
        let mut table = Self { columns: Vec::new(), rows: Vec::new() };
        for (number, rows) in groups.iter().enumerate() {
            for row in rows {
                let mut cells = vec![(group.to_owned(), Some(number as f64))];
                flatten("", &json!(row), &mut cells);
                let (columns, row) = cells.into_iter().unzip();
                table.columns = columns;
                table.rows.push(row);
            }
        }
        table
    }

    /// Returns the table as CSV.
    ///
    /// # Errors
    /// Rows of unequal lengths.
    pub fn to_csv(&self) -> Result<Vec<u8>, csv::Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(&self.columns)?;
        // The shortest text that reads back as the same double; the sum makes a negative zero positive.
        let text = |cell: Option<f64>| cell.map_or_else(String::new, |number| format!("{:e}", number + 0.0));
        for row in &self.rows {
            writer.write_record(row.iter().copied().map(text))?;
        }
        Ok(writer.into_inner().map_err(csv::IntoInnerError::into_error)?)
    }
}

/// Appends the names and the numbers of an object's fields.
fn flatten(before: &str, object: &Json, cells: &mut Vec<(String, Option<f64>)>) {
    for (name, value) in object.as_object().into_iter().flatten() {
        match value {
            Json::Object(_) => flatten(&format!("{before}{name}_"), value, cells),
            value => cells.push((format!("{before}{name}"), value.as_f64())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn absent_and_infinite_numbers_are_empty_cells() {
        #[derive(Serialize)]
        struct Row {
            time_s: f64,
            gain_1_s: Option<f64>,
        }
        let rows =
            [Row { time_s: -0.0, gain_1_s: None }, Row { time_s: f64::INFINITY, gain_1_s: Some(-2e-9) }];
        let csv = NumberTable::from_rows(&rows).to_csv().expect("rows of one length");
        assert_eq!(String::from_utf8_lossy(&csv), "time_s,gain_1_s\n0e0,\n,-2e-9\n");
    }
}
