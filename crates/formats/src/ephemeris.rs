//! Ephemerides: positions at instants, as rows of a scenario, of a CSV file, or of an Orbit Ephemeris Message of the CCSDS
//! in keyword-value notation (\[CCSDS502\]).

mod message;
#[cfg(test)]
mod tests;

use std::borrow::Cow;
use std::fmt;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::sync::Arc;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Error, SeqAccess, Visitor};
use serde::ser::SerializeSeq;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::celestial_frame::CelestialFrame;
use crate::foreign_file::read_file;
use crate::number::real;
use crate::text_file::{locate, open_text_up_to};

/// Least number of rows, those of one polynomial.
const LEAST: usize = 8;
/// Largest number of rows.
const MOST: usize = 1_000_000;
/// Largest size of a file (bytes).
const LONGEST: u64 = 256 << 20;
/// Largest distance (m) and time (s) of a row.
const FARTHEST: f64 = 1e15;

/// Distance (m) of two positions at one date up to which they are one.
const SAME: f64 = 1.0;
/// Change of the velocity (m/s) at one date from which it is a burn.
const BURN: f64 = 1e-3;

/// Time (s) and position (m) of each row.
type Rows = Vec<[f64; 4]>;

/// Positions at instants, as a file or a scenario has them.
#[derive(Debug, Default, PartialEq)]
struct StateTable {
    rows: Rows,
    /// Velocity (m/s) of each row, if the file has that of all of them.
    velocities: Vec<[f64; 3]>,
    /// Line of each row, of rows in a file.
    lines: Vec<usize>,
    /// Lines at which the velocity jumps.
    burns: Vec<usize>,
    /// Date (ns after 1970, UTC) of the time 0 of the rows, if they have dates.
    epoch_ns: Option<u64>,
    /// Axes of the rows, if the file names them.
    frame: Option<CelestialFrame>,
}

impl StateTable {
    /// Appends a row of a file, unless it repeats the last one, as tools write at the end of a segment and at a burn.
    ///
    /// # Errors
    /// Two positions at one instant, and too many rows.
    fn push(&mut self, row: [f64; 4], velocity: Option<[f64; 3]>, line: usize) -> Result<(), String> {
        if let (Some(last), Some(before)) = (self.rows.last(), self.lines.last())
            && last[0] == row[0]
        {
            let far = distance(&last[1..], &row[1..]);
            if far > SAME {
                return Err(format!(
                    "line {line}: must be at the position of line {before}, which has the same date, and is {far:.1} m away"
                ));
            }
            // After a burn the velocity is the new one.
            if let (Some(new), Some(old)) = (velocity, self.velocities.last_mut()) {
                self.burns.extend((distance(&new, &*old) > BURN).then_some(line));
                *old = new;
            }
            return Ok(());
        }
        if self.rows.len() == MOST {
            return Err(format!("line {line}: must have at most {MOST} rows"));
        }
        // Velocities count where all rows have them.
        if let Some(velocity) = velocity.filter(|_| self.velocities.len() == self.rows.len()) {
            self.velocities.push(velocity);
        } else {
            self.velocities.clear();
        }
        self.rows.push(row);
        self.lines.push(line);
        Ok(())
    }
}

/// Returns the distance of two points.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    f64::sqrt(a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum())
}

/// Positions at instants, or the path of the file that contains them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EphemerisTable {
    file: Option<String>,
    table: Arc<StateTable>,
}

impl EphemerisTable {
    /// Makes the path of the file absolute, relative to `directory`.
    pub fn locate(&mut self, directory: &Path) {
        self.file.iter_mut().for_each(|file| locate(file, directory));
    }

    /// Reads the file, if the positions are in one, or takes the rows of `other` if that has read the same file.
    ///
    /// # Errors
    /// The error in the file, with its line.
    pub fn read(&mut self, other: Option<&Self>) -> Result<(), String> {
        let Some(file) = &self.file else { return Ok(()) };
        if let Some(other) = other.filter(|other| other.file == self.file) {
            self.table = other.table.clone();
            return Ok(());
        }
        let reads = "CSV rows t, x, y, z and an OEM in keyword-value notation";
        let table =
            read_file(Path::new(file), &["an OEM"], reads, |path| read(open_text_up_to(path, LONGEST)?))?;
        self.table = Arc::new(table);
        Ok(())
    }

    /// Replaces the reference to a file by rows: time (s) since the start of a run, and position (m).
    pub fn inline(&mut self, rows: Vec<[f64; 4]>) {
        if self.file.is_some() {
            *self = Self { file: None, table: Arc::new(StateTable { rows, ..StateTable::default() }) };
        }
    }

    /// Returns the date (ns after 1970, UTC) of the first row, if the rows have dates.
    pub fn epoch_ns(&self) -> Option<u64> {
        self.table.epoch_ns
    }

    /// Returns the axes of the rows, if their file names them.
    pub fn frame(&self) -> Option<CelestialFrame> {
        self.table.frame
    }

    /// Returns the rows with times (s) since the start of a run at `epoch_ns` (ns after 1970): time, and position (m);
    /// `None` of rows with dates in a run without one, or of too few rows.
    pub fn rows(&self, epoch_ns: Option<u64>) -> Option<Vec<[f64; 4]>> {
        let StateTable { rows, epoch_ns: own, .. } = &*self.table;
        if rows.len() < LEAST {
            return None;
        }
        let Some(own) = own else { return Some(rows.clone()) };
        let shift = (i128::from(*own) - i128::from(epoch_ns?)) as f64 / 1e9;
        Some(rows.iter().map(|[t, x, y, z]| [t + shift, *x, *y, *z]).collect())
    }

    /// Returns the velocities (m/s) of the rows, if their file has them.
    pub fn velocities(&self) -> Option<&[[f64; 3]]> {
        Some(&self.table.velocities[..]).filter(|velocities| velocities.len() == self.table.rows.len())
    }

    /// Returns the lines of a file at which the velocity jumps while the position stays.
    pub fn burns(&self) -> &[usize] {
        &self.table.burns
    }

    /// Returns the place of a row, for messages: its line in the file, or its number in the scenario.
    pub fn place(&self, row: usize) -> String {
        match (&self.file, self.table.lines.get(row)) {
            (Some(file), Some(line)) => format!("{file}: line {line}"),
            _ => format!("row {}", row + 1),
        }
    }

    /// Returns true if both have the same rows in memory.
    pub fn shares_rows(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.table, &other.table)
    }

    /// Returns the reason for which rows of a scenario are no ephemeris.
    pub fn fault(&self) -> Option<String> {
        let number = |row: usize| format!("row {}", row + 1);
        check(&self.table.rows, &number).err()
    }
}

/// Checks the rows, which `place` names in messages.
fn check(rows: &[[f64; 4]], place: &dyn Fn(usize) -> String) -> Result<(), String> {
    for (index, row) in rows.iter().enumerate() {
        if let Some(bad) = row.iter().find(|part| part.is_nan() || part.abs() > FARTHEST) {
            let why = format!("must have times (s) and positions (m) of up to {FARTHEST:e}, got {bad}");
            return Err(format!("{}: {why}", place(index)));
        }
        if row[1..] == [0.0; 3] {
            return Err(format!("{}: must not be the planet's centre", place(index)));
        }
        if index > 0 && row[0] <= rows[index - 1][0] {
            let why = format!("must have increasing times, got {} s after {} s", row[0], rows[index - 1][0]);
            return Err(format!("{}: {why}", place(index)));
        }
    }
    if rows.len() < LEAST {
        return Err(format!("must have at least {LEAST} rows, got {}", rows.len()));
    }
    if rows.len() > MOST {
        return Err(format!("must have at most {MOST} rows, got {}", rows.len()));
    }
    Ok(())
}

fn read(file: impl Read) -> Result<StateTable, String> {
    let mut lines = BufReader::new(file).lines().enumerate().peekable();
    let is_message = loop {
        match lines.peek() {
            Some((_, Ok(line))) if line.trim().is_empty() => drop(lines.next()),
            Some((_, Ok(line))) => break line.trim_start().starts_with("CCSDS_OEM_VERS"),
            _ => break false,
        }
    };
    let mut lines = lines.map(|(index, line)| (index + 1, line));
    let table = if is_message { message::read(&mut lines)? } else { read_table(&mut lines)? };
    check(&table.rows, &|row| format!("line {}", table.lines.get(row).copied().unwrap_or_default()))?;
    Ok(table)
}

/// Lines of a file with their numbers.
type Lines<'a> = &'a mut dyn Iterator<Item = (usize, std::io::Result<String>)>;

/// Returns a line of a file.
fn line_of((number, line): (usize, std::io::Result<String>)) -> Result<(usize, String), String> {
    line.map(|line| (number, line)).map_err(|error| match error.kind() {
        std::io::ErrorKind::InvalidData => format!("line {number}: is not UTF-8 text"),
        _ => error.to_string(),
    })
}

/// Reads the lines of a CSV file: a header if any, then time (s) and position (m), and columns that are not read.
fn read_table(lines: Lines<'_>) -> Result<StateTable, String> {
    let mut table = StateTable::default();
    let mut columns = 0;
    for line in lines {
        let (number, line) = line_of(line)?;
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let fields: Vec<&str> = line.split(',').map(str::trim).collect();
        if columns == 0 {
            columns = fields.len();
            if fields.first().is_some_and(|first| real(first).is_none()) {
                let names = fields.iter().take(4).map(|name| name.to_ascii_lowercase());
                if !names.eq(["t", "x", "y", "z"]) {
                    return Err(format!(
                        "line {number}: must be a header `t,x,y,z`, or numbers, got `{line}`"
                    ));
                }
                continue;
            }
        }
        if fields.len() < 4 || fields.len() != columns {
            let expected = if columns < 4 { 4 } else { columns };
            return Err(format!("line {number}: must have {expected} numbers, got {}", fields.len()));
        }
        let row = numbers(&fields[..4]).map_err(|why| format!("line {number}: {why}"))?;
        table.push(row, None, number)?;
    }
    Ok(table)
}

/// Returns the first four fields as numbers.
fn numbers(fields: &[&str]) -> Result<[f64; 4], String> {
    let mut found = [0.0; 4];
    for (found, field) in found.iter_mut().zip(fields) {
        *found = real(field).ok_or_else(|| format!("must be a number, got `{field}`"))?;
    }
    Ok(found)
}

impl Serialize for EphemerisTable {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if let Some(file) = &self.file {
            return serializer.serialize_str(file);
        }
        let mut rows = serializer.serialize_seq(Some(self.table.rows.len()))?;
        self.table.rows.iter().try_for_each(|row| rows.serialize_element(row))?;
        rows.end()
    }
}

impl<'de> Deserialize<'de> for EphemerisTable {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct TableOrFile;
        impl<'de> Visitor<'de> for TableOrFile {
            type Value = EphemerisTable;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("rows [t, x, y, z], or the path of a file: CSV, or an Orbit Ephemeris Message")
            }

            fn visit_str<E: Error>(self, file: &str) -> Result<EphemerisTable, E> {
                Ok(EphemerisTable { file: Some(file.to_owned()), ..EphemerisTable::default() })
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<EphemerisTable, A::Error> {
                let rows = Rows::deserialize(SeqAccessDeserializer::new(seq))?;
                let table = StateTable { rows, ..StateTable::default() };
                Ok(EphemerisTable { file: None, table: Arc::new(table) })
            }
        }
        deserializer.deserialize_any(TableOrFile)
    }
}

impl JsonSchema for EphemerisTable {
    fn schema_name() -> Cow<'static, str> {
        "EphemerisTable".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "Rows of time (s) and position (m), or the path of a file",
            "anyOf": [
                {
                    "type": "array",
                    "items": { "type": "array", "items": { "type": "number" }, "minItems": 4, "maxItems": 4 }
                },
                { "type": "string" }
            ]
        })
    }
}
