//! Load of a manoeuvre: how its torque is distributed over a one-axis body (\[Rotation\], equations (5) and (14)).
//!
//! A load has a generalised force Q_i for each coordinate q_i, which varies in time with the one command. Its torque about the
//! axis is r' Q for the displacement r of a unit rigid rotation. The command is this torque, so that only the ratios of the
//! Q_i matter.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;

use flexsc_formats::count::counted;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::Finite;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{IntoDeserializer, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

/// Part of the sum of absolute contributions below which a torque about the axis is rounding.
const ROUNDING: f64 = 1e-12;

/// Distribution of the commanded torque over a one-axis body.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Load {
    /// A generalised force on each coordinate of a body given by matrices.
    Each(Vec<Finite>),
    /// Generalised forces by name: of coordinates, of hub and sections, or of rigid angle and modes.
    Named(BTreeMap<String, LoadPart>),
}

/// Generalised force on one coordinate, or on each of several.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum LoadPart {
    /// On one coordinate.
    One(Finite),
    /// On each of several.
    Each(Vec<Finite>),
}

impl Load {
    /// Returns the generalised force on each of the named coordinates.
    ///
    /// # Errors
    /// A wrong number of forces, an unknown name, and a list in place of a number.
    pub fn on_coordinates(&self, names: &[String]) -> Result<Vec<f64>, ConfigError> {
        let parts = match self {
            Self::Each(forces) => return each("load", forces, names.len(), "coordinate"),
            Self::Named(parts) => parts,
        };
        let mut forces = vec![0.0; names.len()];
        for (name, part) in parts {
            let key = format!("load.{name}");
            let index = names.iter().position(|coordinate| coordinate == name).ok_or_else(|| {
                let ends = names.first().zip(names.last());
                let (first, last) = ends.map_or(("", ""), |(first, last)| (first, last));
                ConfigError::new(
                    &key,
                    format!("must name a coordinate (`{first}` to `{last}`), got `{name}`"),
                )
            })?;
            forces[index] = one(&key, part)?;
        }
        Ok(forces)
    }

    /// Returns the number under the key `single`, 0 if it is left out, and the `count` numbers under the key `list`, of
    /// which each belongs to a `noun`; zeros if the list is left out.
    ///
    /// # Errors
    /// Other keys, a wrong number of forces, and a list in place of a number or the other way round.
    pub fn on_parts(
        &self,
        single: &str,
        list: &str,
        count: usize,
        noun: &str,
    ) -> Result<(f64, Vec<f64>), ConfigError> {
        let Self::Named(parts) = self else {
            let why = format!("must be a table with `{single}` and `{list}`, got an array");
            return Err(ConfigError::new("load", why));
        };
        let (mut first, mut others) = (0.0, vec![0.0; count]);
        for (name, part) in parts {
            let key = format!("load.{name}");
            match part {
                _ if name == single => first = one(&key, part)?,
                LoadPart::Each(forces) if name == list => others = each(&key, forces, count, noun)?,
                LoadPart::One(force) if name == list => {
                    let why =
                        format!("must be an array with one number for each {noun}, got {}", force.get());
                    return Err(ConfigError::new(key, why));
                }
                _ => {
                    let why = format!("must be `{single}` or `{list}`, got `{name}`");
                    return Err(ConfigError::new(key, why));
                }
            }
        }
        Ok((first, others))
    }
}

/// Returns the torque about the axis of generalised forces, given their displacements under a unit rigid rotation.
///
/// # Errors
/// A torque that is zero within rounding.
pub fn torque(forces: &[f64], rotation: &[f64]) -> Result<f64, ConfigError> {
    let products = || forces.iter().zip(rotation).map(|(force, r)| force * r);
    let (net, size): (f64, f64) = (products().sum(), products().map(f64::abs).sum());
    if net.is_finite() && net.abs() > ROUNDING * size {
        return Ok(net);
    }
    Err(ConfigError::new("load", "must turn the body, but its torque about the axis is 0"))
}

/// Returns one number for each of `count` coordinates.
fn each(key: &str, forces: &[Finite], count: usize, noun: &str) -> Result<Vec<f64>, ConfigError> {
    let found = forces.len();
    if found == count {
        return Ok(forces.iter().map(|force| force.get()).collect());
    }
    Err(ConfigError::new(
        key,
        format!("must have one number for each of {}, got {found}", counted(count, noun)),
    ))
}

fn one(key: &str, part: &LoadPart) -> Result<f64, ConfigError> {
    match part {
        LoadPart::One(force) => Ok(force.get()),
        LoadPart::Each(_) => Err(ConfigError::new(key, "must be a number, got an array")),
    }
}

impl fmt::Display for Load {
    /// Writes the load on one line, such as `hub 1, sections 0, 0, 0.5`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |forces: &[Finite]| {
            forces.iter().map(|force| force.get().to_string()).collect::<Vec<_>>().join(", ")
        };
        let part = |(name, part): (&String, &LoadPart)| match part {
            LoadPart::One(force) => format!("{name} {}", force.get()),
            LoadPart::Each(forces) => format!("{name} {}", list(forces)),
        };
        match self {
            Self::Each(forces) => f.write_str(&list(forces)),
            Self::Named(parts) => f.write_str(&parts.iter().map(part).collect::<Vec<_>>().join(", ")),
        }
    }
}

impl<'de> Deserialize<'de> for Load {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(LoadVisitor)
    }
}

impl<'de> Deserialize<'de> for LoadPart {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(PartVisitor)
    }
}

struct LoadVisitor;

impl<'de> Visitor<'de> for LoadVisitor {
    type Value = Load;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a table of loads by name, or an array with one for each coordinate")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Load, A::Error> {
        Vec::deserialize(SeqAccessDeserializer::new(seq)).map(Load::Each)
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Load, A::Error> {
        BTreeMap::deserialize(MapAccessDeserializer::new(map)).map(Load::Named)
    }
}

struct PartVisitor;

impl<'de> Visitor<'de> for PartVisitor {
    type Value = LoadPart;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number, or an array of numbers")
    }

    fn visit_f64<E: serde::de::Error>(self, value: f64) -> Result<LoadPart, E> {
        Finite::deserialize(value.into_deserializer()).map(LoadPart::One)
    }

    fn visit_i64<E: serde::de::Error>(self, value: i64) -> Result<LoadPart, E> {
        Finite::deserialize(value.into_deserializer()).map(LoadPart::One)
    }

    fn visit_u64<E: serde::de::Error>(self, value: u64) -> Result<LoadPart, E> {
        Finite::deserialize(value.into_deserializer()).map(LoadPart::One)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<LoadPart, A::Error> {
        Vec::deserialize(SeqAccessDeserializer::new(seq)).map(LoadPart::Each)
    }
}

impl JsonSchema for Load {
    fn schema_name() -> Cow<'static, str> {
        "Load".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let numbers = || json_schema!({"type": "array", "items": {"type": "number"}});
        json_schema!({
            "description": "A generalised force for each coordinate, or generalised forces by name",
            "anyOf": [
                numbers(),
                {"type": "object", "additionalProperties": {"anyOf": [{"type": "number"}, numbers()]}}
            ]
        })
    }
}
