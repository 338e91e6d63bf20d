//! The modes of a spatial body: a table in the scenario, or the path of a CSV file that holds one.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;
use std::ops::Deref;
use std::path::Path;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Error, IntoDeserializer, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::SpatialMode;
use crate::quantity::{Finite, NonNegative};
use crate::structure::{LARGEST, csv};

/// What a column of a point's shape ends with, after the point's name and a dot: three translations, three rotations.
const COMPONENTS: [&str; 6] = ["tx", "ty", "tz", "rx", "ry", "rz"];

const EXPECTED: &str = "an array of modes, or the path of a .csv file";

/// The modes, which are a slice; those of a file once it is read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SpatialModes {
    file: Option<String>,
    table: Vec<SpatialMode>,
}

/// What a column of the file holds.
enum Column {
    Frequency,
    Damping,
    Displacement,
    Rate,
    /// A component of the shape at a point, by its place in [`COMPONENTS`].
    Shape(String, usize),
}

impl SpatialModes {
    /// Makes the path of the file absolute: a relative one begins at a directory.
    pub fn locate(&mut self, directory: &Path) {
        if let Some(file) = &mut self.file
            && let Ok(path) = std::path::absolute(directory.join(&*file))
        {
            *file = path.to_string_lossy().into_owned();
        }
    }

    /// Reads the file, if that is where the modes are, or takes over what others read from the same file.
    ///
    /// # Errors
    /// What is wrong with the file.
    pub fn read(&mut self, others: Option<&Self>) -> Result<(), String> {
        let Some(file) = &self.file else { return Ok(()) };
        let path = Path::new(file);
        if let Some(others) = others.filter(|others| others.file == self.file) {
            self.table.clone_from(&others.table);
        } else if path.extension().is_none_or(|extension| extension != "csv") {
            return Err(format!("must be {EXPECTED}, got `{file}`"));
        } else {
            self.table =
                read_file(path).map_err(|why| format!("cannot be used: {}: {why}", path.display()))?;
        }
        Ok(())
    }

    /// Keeps the modes, and forgets where they were read.
    pub fn forget_file(&mut self) {
        self.file = None;
    }
}

impl Deref for SpatialModes {
    type Target = [SpatialMode];

    fn deref(&self) -> &[SpatialMode] {
        &self.table
    }
}

/// Reads a table of modes: a header that names the columns, then a mode a line.
fn read_file(path: &Path) -> Result<Vec<SpatialMode>, String> {
    let records = csv::records(path, 1 + LARGEST, "lines")?;
    let Some(((line, header), rows)) = records.split_first() else {
        return Err("must have a header".to_owned());
    };
    let mut columns = Vec::with_capacity(header.len());
    for (index, name) in header.iter().enumerate() {
        if header.iter().take(index).any(|other| other == name) {
            return Err(format!("line {line}: must have each column once, got `{name}` again"));
        }
        columns.push(Column::of(name).map_err(|why| format!("line {line}: {why}"))?);
    }
    let Some(frequency) = columns.iter().position(|column| matches!(column, Column::Frequency)) else {
        return Err(format!("line {line}: must have a column `frequency`"));
    };
    let mut modes = Vec::with_capacity(rows.len());
    for (line, row) in rows {
        if row.len() != columns.len() {
            let (expected, found) = (columns.len(), row.len());
            return Err(format!("line {line}: must have {expected} numbers, as the header, got {found}"));
        }
        let told = |name: &str, why: &str| format!("line {line}: `{name}` {why}");
        let mut mode = SpatialMode {
            frequency: number(&row[frequency]).map_err(|why| told("frequency", &why))?,
            damping: NonNegative::default(),
            displacement: Finite::default(),
            rate: Finite::default(),
            shapes: BTreeMap::new(),
        };
        for ((column, name), field) in columns.iter().zip(header).zip(row) {
            column.set(&mut mode, field).map_err(|why| told(name, &why))?;
        }
        modes.push(mode);
    }
    Ok(modes)
}

impl Column {
    fn of(name: &str) -> Result<Self, String> {
        Ok(match name {
            "frequency" => Self::Frequency,
            "damping" => Self::Damping,
            "displacement" => Self::Displacement,
            "rate" => Self::Rate,
            _ => {
                let shape = name.rsplit_once('.').and_then(|(point, component)| {
                    let index = COMPONENTS.iter().position(|known| *known == component)?;
                    Some(Self::Shape(point.to_owned(), index))
                });
                return shape.ok_or_else(|| {
                    let known = COMPONENTS.map(|component| format!("`POINT.{component}`")).join(", ");
                    format!(
                        "must name columns `frequency`, `damping`, `displacement`, `rate` or, for a point of the \
                         body, {known}, got `{name}`"
                    )
                });
            }
        })
    }

    fn set(&self, mode: &mut SpatialMode, field: &str) -> Result<(), String> {
        match self {
            Self::Frequency => {}
            Self::Damping => mode.damping = number(field)?,
            Self::Displacement => mode.displacement = number(field)?,
            Self::Rate => mode.rate = number(field)?,
            Self::Shape(point, index) => {
                let shape = mode.shapes.entry(point.clone()).or_default();
                if *index < 3 {
                    shape.translation[*index] = number(field)?;
                } else {
                    shape.rotation[*index - 3] = number(field)?;
                }
            }
        }
        Ok(())
    }
}

/// A field as a quantity, or what is accepted.
fn number<T: for<'de> Deserialize<'de>>(field: &str) -> Result<T, String> {
    let number: f64 = field.parse().map_err(|_| format!("must be a number, got `{field}`"))?;
    T::deserialize(number.into_deserializer()).map_err(|error: serde::de::value::Error| error.to_string())
}

impl Serialize for SpatialModes {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match &self.file {
            Some(file) => serializer.serialize_str(file),
            None => self.table.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for SpatialModes {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(TableOrFile)
    }
}

struct TableOrFile;

impl<'de> Visitor<'de> for TableOrFile {
    type Value = SpatialModes;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(EXPECTED)
    }

    fn visit_str<E: Error>(self, file: &str) -> Result<SpatialModes, E> {
        Ok(SpatialModes { file: Some(file.to_owned()), table: Vec::new() })
    }

    fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<SpatialModes, A::Error> {
        let table = Vec::deserialize(SeqAccessDeserializer::new(seq))?;
        Ok(SpatialModes { file: None, table })
    }
}

impl JsonSchema for SpatialModes {
    fn schema_name() -> Cow<'static, str> {
        "SpatialModes".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let mode = generator.subschema_for::<SpatialMode>();
        json_schema!({
            "description": "Modes, or the path of a .csv file of modes",
            "anyOf": [{"type": "array", "items": mode}, {"type": "string"}]
        })
    }
}
