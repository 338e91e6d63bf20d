//! Tables of numbers: rows of a scenario, or of a CSV file.

use std::borrow::Cow;
use std::fmt;
use std::io::BufRead;
use std::marker::PhantomData;
use std::path::Path;
use std::sync::Arc;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::foreign_file::read_file;
use crate::number::real;
use crate::text_file::{locate, open_text_up_to};

/// Kind of a table: what its rows are.
pub trait TableKind {
    /// Name in the schema.
    const NAME: &'static str;
    /// Description of the rows, such as `rows of height (m) and density (kg/m³)`.
    const ROWS: &'static str;
    /// Description of a row in messages, such as `a height (m) and a density (kg/m³)`.
    const ROW: &'static str;
    /// Headers that a file may have; each is as wide as its rows.
    const HEADERS: &'static [&'static [&'static str]];
    /// Largest number of rows.
    const MOST: usize;
    /// Largest size of a file (bytes).
    const LONGEST: u64;

    /// Checks rows of one width, which `place` names in messages.
    ///
    /// # Errors
    /// The first row that is not accepted.
    fn check(rows: &[Vec<f64>], place: &dyn Fn(usize) -> String) -> Result<(), String>;
}

/// Checks that the first numbers of rows are increasing positive frequencies (Hz).
pub(crate) fn check_frequencies(rows: &[Vec<f64>], place: &dyn Fn(usize) -> String) -> Result<(), String> {
    let mut before = 0.0;
    for (index, row) in rows.iter().enumerate() {
        let frequency = row[0];
        if !(frequency > before && frequency < 1e9) {
            let why = format!("must have increasing positive frequencies, got {frequency} Hz");
            return Err(format!("{}: {why}", place(index)));
        }
        before = frequency;
    }
    Ok(())
}

/// Rows of numbers, or the path of the file that contains them.
#[derive(Clone, Debug, PartialEq)]
pub struct CsvTable<K> {
    file: Option<String>,
    rows: Arc<Vec<Vec<f64>>>,
    header: Option<&'static [&'static str]>,
    kind: PhantomData<K>,
}

impl<K> CsvTable<K> {
    fn new(file: Option<String>, rows: Vec<Vec<f64>>) -> Self {
        Self { file, rows: Arc::new(rows), header: None, kind: PhantomData }
    }

    /// Keeps the rows inline, and removes the reference to their file.
    pub fn inline(&mut self) {
        self.file = None;
    }

    /// Returns the header of the file, if it has one.
    pub fn header(&self) -> Option<&'static [&'static str]> {
        self.header
    }

    /// Returns the rows.
    pub fn rows(&self) -> &[Vec<f64>] {
        &self.rows
    }
}

impl<K: TableKind> CsvTable<K> {
    /// Reads the file, if the rows are in one, relative to `directory`.
    ///
    /// # Errors
    /// The error in the file, with its line.
    pub fn read(&mut self, directory: &Path) -> Result<(), String> {
        let Some(file) = &mut self.file else { return Ok(()) };
        locate(file, directory);
        let (rows, header) = read_file(Path::new(file), &[], &format!("CSV {}", K::ROWS), |path| {
            read::<K>(open_text_up_to(path, K::LONGEST)?)
        })?;
        (self.rows, self.header) = (Arc::new(rows), header);
        Ok(())
    }

    /// Returns the reason for which rows of a scenario are no table.
    pub fn fault(&self) -> Option<String> {
        check::<K>(&self.rows, &|row| format!("row {}", row + 1)).err()
    }
}

/// Checks the number of rows and their widths, then the rows.
fn check<K: TableKind>(rows: &[Vec<f64>], place: &dyn Fn(usize) -> String) -> Result<(), String> {
    let width = rows.first().map_or(0, Vec::len);
    for (index, row) in rows.iter().enumerate() {
        if row.len() != width || K::HEADERS.iter().all(|header| header.len() != width) {
            return Err(format!("{}: must have {}, got {row:?}", place(index), K::ROW));
        }
    }
    K::check(rows, place)?;
    let most = K::MOST;
    if (2..=most).contains(&rows.len()) {
        Ok(())
    } else {
        Err(format!("must have from 2 to {most} rows, got {}", rows.len()))
    }
}

/// Rows of a CSV file, and its header if it has one.
type RowsAndHeader = (Vec<Vec<f64>>, Option<&'static [&'static str]>);

/// Reads the lines of a CSV file: a header if any, then rows.
fn read<K: TableKind>(file: impl BufRead) -> Result<RowsAndHeader, String> {
    let (mut rows, mut places) = (Vec::new(), Vec::new());
    let (mut is_first, mut header) = (true, None);
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
        let is_header = |header: &&[&str]| {
            fields.iter().map(|field| field.to_ascii_lowercase()).eq(header.iter().copied())
        };
        if std::mem::take(&mut is_first) {
            header = K::HEADERS.iter().copied().find(|header| is_header(header));
            if header.is_some() {
                continue;
            }
        }
        if K::HEADERS.iter().all(|header| header.len() != fields.len()) {
            return Err(format!("line {number}: must have {}, got `{line}`", K::ROW));
        }
        let parsed = |field: &&str| {
            real(field).ok_or_else(|| format!("line {number}: must be a number, got `{field}`"))
        };
        rows.push(fields.iter().map(parsed).collect::<Result<Vec<f64>, String>>()?);
        places.push(number);
        if rows.len() > K::MOST {
            return Err(format!("line {number}: must have at most {} rows", K::MOST));
        }
    }
    check::<K>(&rows, &|row| format!("line {}", places.get(row).copied().unwrap_or_default()))?;
    Ok((rows, header))
}

impl<K> Serialize for CsvTable<K> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match &self.file {
            Some(file) => serializer.serialize_str(file),
            None => self.rows.serialize(serializer),
        }
    }
}

impl<'de, K: TableKind> Deserialize<'de> for CsvTable<K> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct TableOrFile<K>(PhantomData<K>);
        impl<'de, K: TableKind> Visitor<'de> for TableOrFile<K> {
            type Value = CsvTable<K>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "{}, or the path of a .csv file", K::ROWS)
            }

            fn visit_str<E: Error>(self, file: &str) -> Result<CsvTable<K>, E> {
                Ok(CsvTable::new(Some(file.to_owned()), Vec::new()))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<CsvTable<K>, A::Error> {
                Ok(CsvTable::new(None, Vec::deserialize(SeqAccessDeserializer::new(seq))?))
            }
        }
        deserializer.deserialize_any(TableOrFile(PhantomData))
    }
}

impl<K: TableKind> JsonSchema for CsvTable<K> {
    fn schema_name() -> Cow<'static, str> {
        K::NAME.into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let widths = || K::HEADERS.iter().map(|header| header.len());
        let (least, most) = (widths().min().unwrap_or_default(), widths().max().unwrap_or_default());
        let first = K::ROWS.get(..1).unwrap_or_default().to_uppercase();
        let description =
            format!("{first}{}, or the path of a .csv file", K::ROWS.get(1..).unwrap_or_default());
        json_schema!({
            "description": description,
            "anyOf": [
                {
                    "type": "array",
                    "items": { "type": "array", "items": { "type": "number" }, "minItems": least, "maxItems": most }
                },
                { "type": "string" }
            ]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::density_table::Densities;

    #[test]
    fn damaged_tables_are_refused_with_their_lines() {
        let table = |text: &str| read::<Densities>(text.as_bytes());
        assert_eq!(
            table("height,density\n1e5,5e-7\n# c\n\n2e5,3e-10\n"),
            Ok((vec![vec![1e5, 5e-7], vec![2e5, 3e-10]], Some(&["height", "density"][..])))
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
        assert!(
            read::<Densities>(&b"1,2\n\xff\n"[..]).expect_err("damaged").contains("line 2: is not UTF-8")
        );
    }
}
