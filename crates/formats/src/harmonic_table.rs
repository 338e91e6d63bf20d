//! Gauss coefficients of a planet's magnetic field at years: rows of a scenario, or of a file of coefficients.

mod coefficient_file;
#[cfg(test)]
mod tests;

use std::borrow::Cow;
use std::fmt;
use std::path::Path;
use std::sync::Arc;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::foreign_file::read_file;
use crate::text_file::{locate, open_text_up_to};

/// Largest size of a file (bytes).
const LONGEST: u64 = 4 << 20;
/// Largest number of years.
const MOST_YEARS: usize = 1000;
/// Highest degree in a table.
const MOST_DEGREES: usize = 200;
/// Largest size of a coefficient (nT).
const LARGEST: f64 = 1e9;

/// Gauss coefficients at years, or the path of the file that contains them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HarmonicTable {
    file: Option<String>,
    contents: Arc<HarmonicRows>,
}

/// Gauss coefficients in Schmidt semi-normalisation at years, between which they are linear.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct HarmonicRows {
    /// Years, increasing.
    years: Vec<f64>,
    /// Degree n, order m, and a value for each year (nT): of g, or of h with the order -m.
    rows: Vec<Vec<f64>>,
}

/// Degree and order of a row; negative orders have the sine.
type RowPlace = (usize, i64);

impl HarmonicRows {
    /// Returns the degree and order of a row, checked.
    fn place(row: &[f64]) -> Result<RowPlace, String> {
        let [n, m, ..] = row else { return Err("must have a degree and an order".to_owned()) };
        let is_degree = n.fract() == 0.0 && (1.0..=MOST_DEGREES as f64).contains(n);
        if !is_degree {
            return Err(format!("must have a degree from 1 to {MOST_DEGREES}, got {n}"));
        }
        if m.fract() != 0.0 || m.is_nan() || m.abs() > *n {
            return Err(format!("must have an order from -{n} to {n}, got {m}"));
        }
        Ok((*n as usize, *m as i64))
    }

    /// Returns the number of rows before those of a degree.
    fn rows_before(degree: usize) -> usize {
        degree * degree - 1
    }

    /// Checks the rows, which `place` names in messages, and sorts them by degree, then g and h of each order.
    fn sort(&mut self, place: &dyn Fn(usize) -> String) -> Result<(), String> {
        if self.years.is_empty() || self.years.len() > MOST_YEARS {
            return Err(format!("must have from 1 to {MOST_YEARS} years, got {}", self.years.len()));
        }
        if let Some(year) = self.years.iter().find(|year| year.is_nan() || year.abs() > 1e6) {
            return Err(format!("must have years of up to 1e6, got {year}"));
        }
        let mut pairs = self.years.iter().zip(self.years.iter().skip(1));
        if let Some((before, after)) = pairs.find(|(before, after)| before >= after) {
            return Err(format!("must have increasing years, got {after} after {before}"));
        }
        let mut places = Vec::with_capacity(self.rows.len());
        for (index, row) in self.rows.iter().enumerate() {
            let own = Self::place(row).map_err(|why| format!("{}: {why}", place(index)))?;
            if row.len() != self.years.len() + 2 {
                let [found, expected] = [row.len() - 2, self.years.len()];
                return Err(format!(
                    "{}: must have a value for each of {expected} years, got {found}",
                    place(index)
                ));
            }
            if let Some(value) = row[2..].iter().find(|value| value.is_nan() || value.abs() > LARGEST) {
                return Err(format!(
                    "{}: must have values of up to {LARGEST:e} nT, got {value}",
                    place(index)
                ));
            }
            places.push((own, index));
        }
        places.sort_by_key(|((n, m), index)| (*n, m.abs(), *m < 0, *index));
        let mut pairs = places.iter().zip(places.iter().skip(1));
        if let Some((_, ((n, m), index))) = pairs.find(|(before, after)| before.0 == after.0) {
            return Err(format!("{}: has degree {n} and order {m} a second time", place(*index)));
        }
        let degree = places.last().map_or(0, |((n, _), _)| *n);
        if degree == 0 {
            return Err("must have the coefficients of degree 1, got none".to_owned());
        }
        let expected = (1..=degree).flat_map(|n| {
            let both = move |m: i64| if m == 0 { vec![(n, 0)] } else { vec![(n, m), (n, -m)] };
            (0..=n as i64).flat_map(both)
        });
        if let Some((n, m)) = expected
            .zip(places.iter().map(|(own, _)| *own).chain(std::iter::repeat((0, 0))))
            .find_map(|(expected, found)| (expected != found).then_some(expected))
        {
            return Err(format!(
                "must have a row of degree {n} and order {m}, as of all up to degree {degree}"
            ));
        }
        let mut rows = std::mem::take(&mut self.rows);
        self.rows = places.into_iter().map(|(_, index)| std::mem::take(&mut rows[index])).collect();
        Ok(())
    }
}

impl HarmonicTable {
    /// Makes the path of the file absolute, relative to `directory`.
    pub fn locate(&mut self, directory: &Path) {
        self.file.iter_mut().for_each(|file| locate(file, directory));
    }

    /// Reads the file, if the coefficients are in one, or takes those of `other` if that has read the same file.
    ///
    /// # Errors
    /// The error in the file, with its line.
    pub fn read(&mut self, other: Option<&Self>) -> Result<(), String> {
        let Some(file) = &self.file else { return Ok(()) };
        if let Some(other) = other.filter(|other| other.file == self.file) {
            self.contents = other.contents.clone();
            return Ok(());
        }
        let reads = "coefficients (.shc, .COF, or the columns of the IGRF)";
        let contents = read_file(Path::new(file), &[], reads, |path| {
            coefficient_file::read(open_text_up_to(path, LONGEST)?)
        })?;
        self.contents = Arc::new(contents);
        Ok(())
    }

    /// Keeps the rows up to a degree inline, and removes the reference to their file.
    pub fn inline(&mut self, degree: usize) {
        if self.file.take().is_some() {
            let HarmonicRows { years, rows } = &*self.contents;
            let kept = HarmonicRows::rows_before(degree.min(self.degree()) + 1);
            self.contents = Arc::new(HarmonicRows { years: years.clone(), rows: rows[..kept].to_vec() });
        }
    }

    /// Returns the highest degree.
    pub fn degree(&self) -> usize {
        self.contents.rows.last().map_or(0, |row| row[0] as usize)
    }

    /// Returns the first and the last year; `None` of coefficients that are constant.
    pub fn years(&self) -> Option<[f64; 2]> {
        let years = &self.contents.years;
        (years.len() > 1).then(|| [years[0], years[years.len() - 1]])
    }

    /// Returns the coefficients \[g, h\] (nT) in a year of the table, up to a degree, in the order of degree n from 1 and order m
    /// from 0 to n.
    pub fn coefficients(&self, degree: usize, year: f64) -> Vec<[f64; 2]> {
        let HarmonicRows { years, rows } = &*self.contents;
        let last = years.partition_point(|from| *from <= year).clamp(1, years.len().saturating_sub(1).max(1));
        let at = |row: &Vec<f64>| {
            let Some(to) = years.get(last) else { return row[2] };
            let (from, value) = (years[last - 1], row[last + 1]);
            value + (row[last + 2] - value) / (to - from) * (year - from)
        };
        let (mut found, mut rows) = (Vec::new(), rows.iter());
        for n in 1..=degree.min(self.degree()) {
            for m in 0..=n {
                let g = rows.next().map_or(0.0, at);
                let h = if m == 0 { 0.0 } else { rows.next().map_or(0.0, at) };
                found.push([g, h]);
            }
        }
        found
    }
}

impl Serialize for HarmonicTable {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match &self.file {
            Some(file) => serializer.serialize_str(file),
            None => self.contents.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for HarmonicTable {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct RowsOrFile;
        impl<'de> Visitor<'de> for RowsOrFile {
            type Value = HarmonicTable;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("`years` and `rows`, or the path of a file of coefficients")
            }

            fn visit_str<E: Error>(self, file: &str) -> Result<HarmonicTable, E> {
                Ok(HarmonicTable { file: Some(file.to_owned()), contents: Arc::default() })
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<HarmonicTable, A::Error> {
                let mut rows = HarmonicRows::deserialize(MapAccessDeserializer::new(map))?;
                rows.sort(&|row| format!("row {}", row + 1)).map_err(A::Error::custom)?;
                Ok(HarmonicTable { file: None, contents: Arc::new(rows) })
            }
        }
        deserializer.deserialize_any(RowsOrFile)
    }
}

impl JsonSchema for HarmonicTable {
    fn schema_name() -> Cow<'static, str> {
        "HarmonicTable".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "Gauss coefficients (nT) at years, in rows of degree, order and a value for each year, or the path of a file of coefficients",
            "anyOf": [
                {
                    "type": "object",
                    "properties": {
                        "years": {
                            "type": "array",
                            "items": { "type": "number" },
                            "description": "Years, increasing."
                        },
                        "rows": {
                            "type": "array",
                            "items": { "type": "array", "items": { "type": "number" } },
                            "description": "Rows of degree n, order m and a value for each year, of g, or of h with the order -m."
                        }
                    },
                    "required": ["years", "rows"],
                    "additionalProperties": false
                },
                { "type": "string" }
            ]
        })
    }
}
