//! Units of finite-element results, which state none: the solver leaves them to its user.

use std::borrow::Cow;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Units of length and mass of a file.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct FileUnits {
    /// Unit of length.
    length: LengthUnit,
    /// Unit of mass.
    mass: MassUnit,
}

/// Unit of length.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
enum LengthUnit {
    /// Metre.
    #[default]
    M,
    /// Centimetre.
    Cm,
    /// Millimetre.
    Mm,
    /// Inch.
    In,
    /// Foot.
    Ft,
}

/// Unit of mass.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
enum MassUnit {
    /// Kilogram.
    #[default]
    Kg,
    /// Gram.
    G,
    /// Tonne.
    T,
    /// Pound.
    Lb,
    /// Pound-force second squared a foot.
    Slug,
    /// Pound-force second squared an inch.
    Slinch,
}

/// Both units, as a scenario has them.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct UnitPair {
    /// Unit of length.
    length: LengthUnit,
    /// Unit of mass.
    mass: MassUnit,
}

/// Words for systems whose units of force follow from newtons or pounds: metres and kilograms, millimetres and tonnes, inches and
/// pound-force seconds squared an inch.
const SYSTEMS: [(&str, LengthUnit, MassUnit); 3] = [
    ("m", LengthUnit::M, MassUnit::Kg),
    ("mm", LengthUnit::Mm, MassUnit::T),
    ("in", LengthUnit::In, MassUnit::Slinch),
];
const INCH: f64 = 0.0254;
const POUND: f64 = 0.453_592_37;
/// Pound-force (N).
const POUND_FORCE: f64 = POUND * 9.806_65;
const EXPECTED: &str = "`m`, `mm`, `in`, or units of length and mass";

impl FileUnits {
    /// Returns the unit of length (m).
    pub const fn length(self) -> f64 {
        match self.length {
            LengthUnit::M => 1.0,
            LengthUnit::Cm => 1e-2,
            LengthUnit::Mm => 1e-3,
            LengthUnit::In => INCH,
            LengthUnit::Ft => 12.0 * INCH,
        }
    }

    /// Returns the unit of mass (kg).
    pub const fn mass(self) -> f64 {
        match self.mass {
            MassUnit::Kg => 1.0,
            MassUnit::G => 1e-3,
            MassUnit::T => 1e3,
            MassUnit::Lb => POUND,
            MassUnit::Slug => POUND_FORCE / (12.0 * INCH),
            MassUnit::Slinch => POUND_FORCE / INCH,
        }
    }
}

impl Serialize for FileUnits {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self { length, mass } = *self;
        match SYSTEMS.iter().find(|(_, own, of_mass)| (*own, *of_mass) == (length, mass)) {
            Some((word, ..)) => serializer.serialize_str(word),
            None => UnitPair { length, mass }.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for FileUnits {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct WordOrPair;
        impl<'de> Visitor<'de> for WordOrPair {
            type Value = FileUnits;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(EXPECTED)
            }

            fn visit_str<E: Error>(self, word: &str) -> Result<FileUnits, E> {
                let found = SYSTEMS.iter().find(|(own, ..)| *own == word);
                let &(_, length, mass) = found.ok_or_else(|| {
                    E::custom(format!(
                        "must be {EXPECTED}, as {{ length = \"mm\", mass = \"kg\" }}, got `{word}`"
                    ))
                })?;
                Ok(FileUnits { length, mass })
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<FileUnits, A::Error> {
                let UnitPair { length, mass } = UnitPair::deserialize(MapAccessDeserializer::new(map))?;
                Ok(FileUnits { length, mass })
            }
        }
        deserializer.deserialize_any(WordOrPair)
    }
}

impl JsonSchema for FileUnits {
    fn schema_name() -> Cow<'static, str> {
        "FileUnits".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let pair = generator.subschema_for::<UnitPair>();
        json_schema!({ "anyOf": [{ "type": "string", "enum": SYSTEMS.map(|(word, ..)| word) }, pair] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_what_they_are_in_si() {
        let read = |text: &str| serde_json::from_str::<FileUnits>(text).map_err(|error| error.to_string());
        for (text, length, mass) in [
            ("\"mm\"", 1e-3, 1e3),
            ("\"in\"", 0.0254, 175.126_835_246),
            ("{\"length\":\"mm\",\"mass\":\"kg\"}", 1e-3, 1.0),
            ("{\"length\":\"ft\",\"mass\":\"slug\"}", 0.3048, 14.593_902_937),
        ] {
            let units = read(text).expect("units");
            assert!((units.length() / length - 1.0).abs() < 1e-12, "{text}");
            assert!((units.mass() / mass - 1.0).abs() < 1e-10, "{text}");
            assert_eq!(serde_json::to_string(&units).expect("a text"), text);
        }
        assert!(read("\"km\"").is_err_and(|why| why.contains("got `km`")));
        assert!(read("{\"length\":\"mm\"}").is_err());
    }
}
