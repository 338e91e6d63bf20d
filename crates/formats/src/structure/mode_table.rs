//! List of modes: a table in the scenario, or the path of a CSV file that contains one.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;
use std::marker::PhantomData;
use std::ops::Deref;
use std::path::Path;

use flexsc_numerics::quantity::{Finite, Frequency, NonNegative};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::SeqAccessDeserializer;
use serde::de::{DeserializeOwned, Error, IntoDeserializer, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::Shape;
use super::{LARGEST, csv};
use crate::foreign_file;
use crate::number::real;
use crate::text_file::locate;

/// Endings of the column names of a point's shape, after the point's name and a dot: three translations, three
/// rotations.
const COMPONENTS: [&str; 6] = ["tx", "ty", "tz", "rx", "ry", "rz"];

/// Largest number of clamped modes that are converted to free ones.
pub const MOST_MODES: usize = 200;

/// Mode as a row of a table.
pub trait ModeRow: Clone + Serialize + DeserializeOwned + JsonSchema {
    /// Name of a list of such modes in the JSON Schema.
    const LIST: &'static str;
    /// Extensions of the files that contain such modes, for messages.
    const FILES: &'static str;
    /// Columns specific to this kind of mode.
    const EXTRA_COLUMNS: &'static [&'static str];

    /// Creates a mode of which only the natural frequency is known.
    fn from_frequency(frequency: Frequency) -> Self;

    /// Returns the values that every kind of mode has.
    fn common(&mut self) -> ModeCommon<'_>;

    /// Sets the value of a column, given by its index in [`Self::EXTRA_COLUMNS`].
    fn set_extra(&mut self, column: usize, value: Finite);
}

/// Values that every kind of mode has besides its frequency.
pub struct ModeCommon<'a> {
    /// Damping ratio.
    pub damping: &'a mut NonNegative,
    /// Modal displacement at the start of a run.
    pub displacement: &'a mut Finite,
    /// Modal rate at the start of a run.
    pub rate: &'a mut Finite,
    /// Shapes at points, by the names of the points.
    pub shapes: &'a mut BTreeMap<String, Shape>,
}

/// List of modes, which dereferences to a slice; that of a file once it is read.
#[derive(Clone, Debug, PartialEq)]
pub struct ModeTable<M> {
    file: Option<String>,
    table: Vec<M>,
}

/// Contents of a column of the file.
enum FileColumn {
    Frequency,
    Damping,
    Displacement,
    Rate,
    /// Column specific to this kind of mode, by its index in [`ModeRow::EXTRA_COLUMNS`].
    Own(usize),
    /// Component of the shape at a point, by its index in [`COMPONENTS`].
    Shape(String, usize),
}

impl<M> Default for ModeTable<M> {
    fn default() -> Self {
        Self { file: None, table: Vec::new() }
    }
}

impl<M> From<Vec<M>> for ModeTable<M> {
    fn from(table: Vec<M>) -> Self {
        Self { file: None, table }
    }
}

impl<M: ModeRow> ModeTable<M> {
    /// Makes the path of the file absolute, relative to `directory`.
    pub fn locate(&mut self, directory: &Path) {
        self.file.iter_mut().for_each(|file| locate(file, directory));
    }

    /// Reads the file, if the modes are in one, or copies the modes from `others` if that has read the same file.
    ///
    /// # Errors
    /// The error in the file.
    pub fn read(&mut self, others: Option<&Self>) -> Result<(), String> {
        let Some(file) = &self.file else { return Ok(()) };
        let path = Path::new(file);
        if let Some(others) = others.filter(|others| others.file == self.file) {
            self.table.clone_from(&others.table);
        } else if path.extension().is_none_or(|extension| extension != "csv") {
            let instead =
                foreign_file::instead(path).map(|instead| format!(": {instead}")).unwrap_or_default();
            return Err(format!(
                "must be an array of modes, or the path of a {} file, got `{file}`{instead}",
                M::FILES
            ));
        } else {
            self.table =
                read_file(path).map_err(|why| format!("cannot be used: {}: {why}", path.display()))?;
        }
        Ok(())
    }

    /// Returns the path of the file, if the modes are in one.
    pub fn file(&self) -> Option<&Path> {
        self.file.as_deref().map(Path::new)
    }

    /// Sets the modes that the file contains.
    pub fn fill(&mut self, table: Vec<M>) {
        self.table = table;
    }

    /// Keeps the modes inline, and removes the reference to their file.
    pub fn inline(&mut self) {
        self.file = None;
    }
}

impl<M> Deref for ModeTable<M> {
    type Target = [M];

    fn deref(&self) -> &[M] {
        &self.table
    }
}

/// Reads a table of modes: a header that names the columns, then one mode in each line.
fn read_file<M: ModeRow>(path: &Path) -> Result<Vec<M>, String> {
    let records = csv::records(path, 1 + LARGEST, "lines")?;
    let Some(((line, header), rows)) = records.split_first() else {
        return Err("must have a header".to_owned());
    };
    let mut columns = Vec::with_capacity(header.len());
    for (index, name) in header.iter().enumerate() {
        if header.iter().take(index).any(|other| other == name) {
            return Err(format!("line {line}: must have each column once, got `{name}` again"));
        }
        columns.push(
            FileColumn::from_name(name, M::EXTRA_COLUMNS).map_err(|why| format!("line {line}: {why}"))?,
        );
    }
    let Some(frequency) = columns.iter().position(|column| matches!(column, FileColumn::Frequency)) else {
        return Err(format!("line {line}: must have a column `frequency`"));
    };
    let mut modes = Vec::with_capacity(rows.len());
    for (line, row) in rows {
        if row.len() != columns.len() {
            let (expected, found) = (columns.len(), row.len());
            return Err(format!("line {line}: must have {expected} numbers, as the header, got {found}"));
        }
        let reported = |name: &str, why: &str| format!("line {line}: `{name}` {why}");
        let mut mode = M::from_frequency(number(&row[frequency]).map_err(|why| reported("frequency", &why))?);
        for ((column, name), field) in columns.iter().zip(header).zip(row) {
            column.set(&mut mode, field).map_err(|why| reported(name, &why))?;
        }
        modes.push(mode);
    }
    Ok(modes)
}

impl FileColumn {
    fn from_name(name: &str, own: &[&str]) -> Result<Self, String> {
        Ok(match name {
            "frequency" => Self::Frequency,
            "damping" => Self::Damping,
            "displacement" => Self::Displacement,
            "rate" => Self::Rate,
            _ => {
                if let Some(column) = own.iter().position(|known| *known == name) {
                    return Ok(Self::Own(column));
                }
                let shape = name.rsplit_once('.').and_then(|(point, component)| {
                    let index = COMPONENTS.iter().position(|known| *known == component)?;
                    Some(Self::Shape(point.to_owned(), index))
                });
                return shape.ok_or_else(|| {
                    let own = own.iter().map(|name| format!(", `{name}`")).collect::<Vec<_>>().concat();
                    let known = COMPONENTS.map(|component| format!("`POINT.{component}`")).join(", ");
                    format!(
                        "must name columns `frequency`, `damping`, `displacement`, `rate`{own} or, for a point of the \
                         body, {known}, got `{name}`"
                    )
                });
            }
        })
    }

    fn set<M: ModeRow>(&self, mode: &mut M, field: &str) -> Result<(), String> {
        match self {
            Self::Frequency => {}
            Self::Damping => *mode.common().damping = number(field)?,
            Self::Displacement => *mode.common().displacement = number(field)?,
            Self::Rate => *mode.common().rate = number(field)?,
            Self::Own(column) => mode.set_extra(*column, number(field)?),
            Self::Shape(point, index) => {
                let shape = mode.common().shapes.entry(point.clone()).or_default();
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

/// Parses a field as a quantity, or returns a message with the accepted values.
fn number<T: for<'de> Deserialize<'de>>(field: &str) -> Result<T, String> {
    let number = real(field).ok_or_else(|| format!("must be a number, got `{field}`"))?;
    T::deserialize(number.into_deserializer()).map_err(|error: serde::de::value::Error| error.to_string())
}

impl<M: Serialize> Serialize for ModeTable<M> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match &self.file {
            Some(file) => serializer.serialize_str(file),
            None => self.table.serialize(serializer),
        }
    }
}

impl<'de, M: ModeRow> Deserialize<'de> for ModeTable<M> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(TableOrFile(PhantomData))
    }
}

struct TableOrFile<M>(PhantomData<M>);

impl<'de, M: ModeRow> Visitor<'de> for TableOrFile<M> {
    type Value = ModeTable<M>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "an array of modes, or the path of a {} file", M::FILES)
    }

    fn visit_str<E: Error>(self, file: &str) -> Result<ModeTable<M>, E> {
        Ok(ModeTable { file: Some(file.to_owned()), table: Vec::new() })
    }

    fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<ModeTable<M>, A::Error> {
        let table = Vec::deserialize(SeqAccessDeserializer::new(seq))?;
        Ok(ModeTable { file: None, table })
    }
}

impl<M: ModeRow> JsonSchema for ModeTable<M> {
    fn schema_name() -> Cow<'static, str> {
        M::LIST.into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let mode = generator.subschema_for::<M>();
        json_schema!({
            "description": format!("Modes, or the path of a {} file of modes", M::FILES),
            "anyOf": [{"type": "array", "items": mode}, {"type": "string"}]
        })
    }
}
