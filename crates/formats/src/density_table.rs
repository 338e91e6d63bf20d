//! Densities of an atmosphere at heights: rows of a scenario, or of a CSV file.

use std::borrow::Cow;
use std::fmt;
use std::io::BufRead;
use std::path::Path;
use std::sync::Arc;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::foreign_file::read_file;
use crate::number::real;
use crate::text_file::{locate, open_text_up_to};

/// Largest number of rows.
const MOST: usize = 10_000;
/// Largest size of a file (bytes).
const LONGEST: u64 = 1 << 20;

/// Density (kg/m³) at heights (m), or the path of the file that contains them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DensityTable {
    file: Option<String>,
    rows: Arc<Vec<[f64; 2]>>,
}

impl DensityTable {
    /// Makes the path of the file absolute, relative to `directory`.
    pub fn locate(&mut self, directory: &Path) {
        self.file.iter_mut().for_each(|file| locate(file, directory));
    }

    /// Reads the file, if the rows are in one.
    ///
    /// # Errors
    /// The error in the file, with its line.
    pub fn read(&mut self) -> Result<(), String> {
        let Some(file) = &self.file else { return Ok(()) };
        let rows = read_file(Path::new(file), &[], "CSV rows of height and density", |path| {
            read(open_text_up_to(path, LONGEST)?)
        })?;
        self.rows = Arc::new(rows);
        Ok(())
    }

    /// Keeps the rows inline, and removes the reference to their file.
    pub fn inline(&mut self) {
        self.file = None;
    }

    /// Returns the rows: height (m) and density (kg/m³), by increasing height.
    pub fn rows(&self) -> &[[f64; 2]] {
        &self.rows
    }

    /// Returns the reason for which rows of a scenario are no table.
    pub fn fault(&self) -> Option<String> {
        check(&self.rows, &|row| format!("row {}", row + 1)).err()
    }
}

/// Checks the rows, which `place` names in messages.
fn check(rows: &[[f64; 2]], place: &dyn Fn(usize) -> String) -> Result<(), String> {
    for (index, [height, density]) in rows.iter().enumerate() {
        if height.is_nan() || height.abs() > 1e12 {
            return Err(format!("{}: must have a height (m), got {height}", place(index)));
        }
        if density.is_nan() || *density <= 0.0 || *density > 1e3 {
            let why = format!("must have a positive density (kg/m³), got {density}");
            return Err(format!("{}: {why}", place(index)));
        }
        if index > 0 && *height <= rows[index - 1][0] {
            let why = format!("must have increasing heights, got {height} m after {} m", rows[index - 1][0]);
            return Err(format!("{}: {why}", place(index)));
        }
    }
    if (2..=MOST).contains(&rows.len()) {
        Ok(())
    } else {
        Err(format!("must have from 2 to {MOST} rows, got {}", rows.len()))
    }
}

/// Reads the lines of a CSV file: a header if any, then height (m) and density (kg/m³).
fn read(file: impl BufRead) -> Result<Vec<[f64; 2]>, String> {
    let (mut rows, mut places) = (Vec::new(), Vec::new());
    let mut is_first = true;
    for (index, line) in file.lines().enumerate() {
        let number = index + 1;
        let line = line.map_err(|error| match error.kind() {
            std::io::ErrorKind::InvalidData => format!("line {number}: is not UTF-8 text"),
            _ => error.to_string(),
        })?;
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let fields: Vec<&str> = line.split(',').map(str::trim).collect();
        if std::mem::take(&mut is_first)
            && fields.iter().map(|field| field.to_ascii_lowercase()).eq(["height", "density"])
        {
            continue;
        }
        let [height, density] = fields[..] else {
            return Err(format!("line {number}: must have a height (m) and a density (kg/m³), got `{line}`"));
        };
        let parsed = |field: &str| {
            real(field).ok_or_else(|| format!("line {number}: must be a number, got `{field}`"))
        };
        rows.push([parsed(height)?, parsed(density)?]);
        places.push(number);
        if rows.len() > MOST {
            return Err(format!("line {number}: must have at most {MOST} rows"));
        }
    }
    check(&rows, &|row| format!("line {}", places.get(row).copied().unwrap_or_default()))?;
    Ok(rows)
}

impl Serialize for DensityTable {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match &self.file {
            Some(file) => serializer.serialize_str(file),
            None => self.rows.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for DensityTable {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct TableOrFile;
        impl<'de> Visitor<'de> for TableOrFile {
            type Value = DensityTable;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("rows [height, density], or the path of a .csv file")
            }

            fn visit_str<E: Error>(self, file: &str) -> Result<DensityTable, E> {
                Ok(DensityTable { file: Some(file.to_owned()), ..DensityTable::default() })
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<DensityTable, A::Error> {
                let rows = Vec::deserialize(SeqAccessDeserializer::new(seq))?;
                Ok(DensityTable { file: None, rows: Arc::new(rows) })
            }
        }
        deserializer.deserialize_any(TableOrFile)
    }
}

impl JsonSchema for DensityTable {
    fn schema_name() -> Cow<'static, str> {
        "DensityTable".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "Rows of height (m) and density (kg/m³), or the path of a .csv file",
            "anyOf": [
                {
                    "type": "array",
                    "items": { "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2 }
                },
                { "type": "string" }
            ]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn damaged_tables_are_refused_with_their_lines() {
        let table = |text: &str| read(text.as_bytes());
        assert_eq!(
            table("height,density\n1e5,5e-7\n# c\n\n2e5,3e-10\n"),
            Ok(vec![[1e5, 5e-7], [2e5, 3e-10]])
        );
        let refused = |text: &str, words: &str| {
            let error = table(text).expect_err("damaged");
            assert!(error.contains(words), "{error}");
        };
        refused("", "from 2 to 10000 rows, got 0");
        refused("1e5,5e-7\n1e5,3e-10\n", "line 2: must have increasing heights");
        refused("1e5,5e-7\n2e5,0\n", "line 2: must have a positive density");
        refused("1e5,nan\n2e5,1e-9\n", "line 1: must be a number, got `nan`");
        refused("1e300,1e-9\n", "line 1: must have a height");
        refused("1e5\n", "line 1: must have a height (m) and a density");
        refused("1e5,x\n", "line 1: must be a number, got `x`");
        assert!(read(&b"1,2\n\xff\n"[..]).expect_err("damaged").contains("line 2: is not UTF-8"));
    }
}
