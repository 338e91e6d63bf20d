//! Matrix of a scenario: rows of numbers, or the path of a file.

use std::borrow::Cow;
use std::fmt;
use std::path::Path;

use flexsc_numerics::quantity::Finite;
use nalgebra::DMatrix;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

#[cfg(feature = "matrices")]
use super::npz;
#[cfg(not(feature = "matrices"))]
use super::unavailable::npz;
use super::{csv, matrix_market};
use crate::document::ConfigError;
use crate::text_file::locate;

/// Dense matrix, or the path of its file.
#[derive(Clone, Debug, PartialEq)]
pub enum Matrix {
    /// Numbers, row by row.
    Rows(Vec<Vec<Finite>>),
    /// Path of a file: `.csv` (rows of numbers separated by commas, no header), `.mtx` (MatrixMarket) or `.npz`, with
    /// the name of the array after a colon. A relative path begins at the scenario's directory.
    File(String),
}

const EXPECTED: &str = "rows of numbers, or the path of a .csv, .mtx or .npz file";

impl Matrix {
    /// Makes the path of a file absolute, relative to `directory`.
    pub fn locate(&mut self, directory: &Path) {
        if let Self::File(file) = self {
            locate(file, directory);
        }
    }

    /// Returns the numbers, read from the file if there is one. The key of a fault is relative to the matrix.
    pub fn read(&self) -> Result<DMatrix<f64>, ConfigError> {
        match self {
            Self::Rows(rows) => {
                let columns = rows.first().map_or(0, Vec::len);
                for (index, row) in rows.iter().enumerate() {
                    if row.len() != columns {
                        let why = format!("must have {columns} numbers, as the first row, got {}", row.len());
                        return Err(ConfigError::new(format!("[{index}]"), why));
                    }
                }
                Ok(DMatrix::from_fn(rows.len(), columns, |i, j| rows[i][j].get()))
            }
            Self::File(file) => read_file(file).map_err(|why| ConfigError::new("", why)),
        }
    }
}

/// Reads the file of a matrix.
fn read_file(file: &str) -> Result<DMatrix<f64>, String> {
    let extension =
        |path: &str| Path::new(path).extension().map(|extension| extension.to_string_lossy().into_owned());
    let (path, array) = match file.rsplit_once(':') {
        Some((path, array)) if extension(path).as_deref() == Some("npz") => (path, Some(array)),
        _ => (file, None),
    };
    let (kind, path) = (extension(path), Path::new(path));
    let read = match kind.as_deref() {
        Some("csv") => csv::read(path),
        Some("mtx") => matrix_market::read(path),
        Some("npz") => npz::read(path, array),
        _ => return Err(format!("must be {EXPECTED}, got `{file}`")),
    };
    read.map_err(|why| format!("cannot be used: {}: {why}", path.display()))
}

impl Serialize for Matrix {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Rows(rows) => rows.serialize(serializer),
            Self::File(file) => serializer.serialize_str(file),
        }
    }
}

impl<'de> Deserialize<'de> for Matrix {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(RowsOrFile)
    }
}

struct RowsOrFile;

impl<'de> Visitor<'de> for RowsOrFile {
    type Value = Matrix;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(EXPECTED)
    }

    fn visit_str<E: Error>(self, file: &str) -> Result<Matrix, E> {
        Ok(Matrix::File(file.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Matrix, A::Error> {
        let mut rows = Vec::new();
        while let Some(row) = seq.next_element()? {
            rows.push(row);
        }
        Ok(Matrix::Rows(rows))
    }
}

impl JsonSchema for Matrix {
    fn schema_name() -> Cow<'static, str> {
        "Matrix".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "Rows of numbers, or the path of a .csv, .mtx or .npz file",
            "anyOf": [
                {"type": "array", "items": {"type": "array", "items": {"type": "number"}}},
                {"type": "string"}
            ]
        })
    }
}
