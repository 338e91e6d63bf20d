//! Deserialisation of parts of a scenario from TOML values, with errors that contain the key.

use serde::de::value::StrDeserializer;
use serde::de::{
    DeserializeOwned, DeserializeSeed, Deserializer, EnumAccess, Error, MapAccess, SeqAccess, Unexpected,
    VariantAccess, Visitor,
};
use toml::{Table, Value};

use super::mismatch::Mismatch;

/// Newtype name by which a type requests a date, as its text.
pub const DATE: &str = "date";

/// Reads a part from a table.
pub fn read<T: DeserializeOwned>(table: &Table) -> Result<T, Mismatch> {
    struct TableReader<'a>(&'a Table);
    impl<'de> Deserializer<'de> for TableReader<'de> {
        type Error = Mismatch;

        fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Mismatch> {
            visitor.visit_map(EntryReader::new(self.0))
        }

        serde::forward_to_deserialize_any! {
            bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit unit_struct
            newtype_struct seq tuple tuple_struct map struct enum identifier ignored_any
        }
    }
    T::deserialize(TableReader(table))
}

/// Reads a part from a value.
pub fn read_value<T: DeserializeOwned>(value: &Value) -> Result<T, Mismatch> {
    T::deserialize(Reader(value))
}

/// Deserialiser of one value. Types that request a certain form get that form or an error, so that serde's code for
/// other forms is not generated.
#[derive(Clone, Copy)]
struct Reader<'a>(&'a Value);

impl<'de> Reader<'de> {
    fn found(self) -> Unexpected<'de> {
        match self.0 {
            Value::String(text) => Unexpected::Str(text),
            Value::Integer(number) => Unexpected::Signed(*number),
            Value::Float(number) => Unexpected::Float(*number),
            Value::Boolean(yes) => Unexpected::Bool(*yes),
            Value::Datetime(_) => Unexpected::Other("a date"),
            Value::Array(_) => Unexpected::Seq,
            Value::Table(_) => Unexpected::Map,
        }
    }

    fn refused<T>(self, visitor: &impl Visitor<'de>) -> Result<T, Mismatch> {
        Err(Mismatch::invalid_type(self.found(), visitor))
    }

    fn text<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Mismatch> {
        match self.0 {
            Value::String(text) => visitor.visit_str(text),
            _ => self.refused(&visitor),
        }
    }

    fn values<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Mismatch> {
        match self.0 {
            Value::Array(values) => {
                let mut elements = ArrayReader { values: values.iter(), index: 0 };
                let made = visitor.visit_seq(&mut elements)?;
                // A part of a fixed length reads no further than that.
                if elements.values.len() == 0 {
                    Ok(made)
                } else {
                    Err(Mismatch::too_many_values(values.len(), elements.index))
                }
            }
            _ => self.refused(&visitor),
        }
    }

    fn table<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Mismatch> {
        match self.0 {
            Value::Table(table) => {
                let mut entries = EntryReader::new(table);
                let made = visitor.visit_map(&mut entries)?;
                // A part that reads a kind from a map uses its first key, and would leave others unread.
                if entries.entries.next().is_some() {
                    Err(Mismatch::several_kinds(table, &[]))
                } else {
                    Ok(made)
                }
            }
            _ => self.refused(&visitor),
        }
    }
}

impl<'de> Deserializer<'de> for Reader<'de> {
    type Error = Mismatch;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Mismatch> {
        match self.0 {
            Value::String(text) => visitor.visit_str(text),
            Value::Integer(number) => visitor.visit_i64(*number),
            Value::Float(number) => visitor.visit_f64(*number),
            Value::Boolean(yes) => visitor.visit_bool(*yes),
            Value::Datetime(_) => self.refused(&visitor),
            Value::Array(_) => self.values(visitor),
            Value::Table(_) => self.table(visitor),
        }
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Mismatch> {
        self.text(visitor)
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Mismatch> {
        self.text(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Mismatch> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        visitor: V,
    ) -> Result<V::Value, Mismatch> {
        match self.0 {
            Value::Datetime(date) if name == DATE => visitor.visit_str(&date.to_string()),
            _ if name == DATE => self.refused(&visitor),
            _ => visitor.visit_newtype_struct(self),
        }
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Mismatch> {
        self.values(visitor)
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Mismatch> {
        self.values(visitor)
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: usize,
        visitor: V,
    ) -> Result<V::Value, Mismatch> {
        self.values(visitor)
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Mismatch> {
        self.table(visitor)
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Mismatch> {
        self.table(visitor)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        known: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Mismatch> {
        match self.0 {
            Value::String(name) => visitor.visit_enum(VariantReader { name, value: None }),
            Value::Table(kinds) => {
                let mut entries = kinds.iter();
                match (entries.next(), entries.next()) {
                    (Some((name, value)), None) => {
                        visitor.visit_enum(VariantReader { name, value: Some(value) })
                    }
                    (None, _) => Err(Mismatch::custom("exactly one kind is needed here, and none is given")),
                    _ => Err(Mismatch::several_kinds(kinds, known)),
                }
            }
            _ => Err(Mismatch::no_kind(self.0)),
        }
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char bytes byte_buf unit unit_struct identifier ignored_any
    }
}

/// Access to the values of an array.
struct ArrayReader<'a> {
    values: std::slice::Iter<'a, Value>,
    index: usize,
}

impl<'de> SeqAccess<'de> for ArrayReader<'de> {
    type Error = Mismatch;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Mismatch> {
        let Some(value) = self.values.next() else { return Ok(None) };
        let index = self.index;
        self.index += 1;
        seed.deserialize(Reader(value)).map(Some).map_err(|wrong| wrong.in_element(index))
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.values.len())
    }
}

/// Access to the entries of a table.
struct EntryReader<'a> {
    entries: toml::map::Iter<'a, String, Value>,
    entry: Option<(&'a str, &'a Value)>,
}

impl<'a> EntryReader<'a> {
    fn new(table: &'a Table) -> Self {
        Self { entries: table.iter(), entry: None }
    }
}

impl<'de> MapAccess<'de> for EntryReader<'de> {
    type Error = Mismatch;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Mismatch> {
        self.entry = self.entries.next().map(|(key, value)| (key.as_str(), value));
        let Some((key, _)) = self.entry else { return Ok(None) };
        seed.deserialize(StrDeserializer::new(key)).map(Some).map_err(|wrong: Mismatch| wrong.at_key(key))
    }

    fn next_value_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<S::Value, Mismatch> {
        let Some((key, value)) = self.entry else { return Err(Mismatch::custom("a value without a key")) };
        seed.deserialize(Reader(value)).map_err(|wrong| wrong.in_key(key))
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.entries.len())
    }
}

/// Access to an enum: the name of the kind, and its table if it has one.
struct VariantReader<'a> {
    name: &'a str,
    value: Option<&'a Value>,
}

impl<'de> EnumAccess<'de> for VariantReader<'de> {
    type Error = Mismatch;
    type Variant = Self;

    fn variant_seed<S: DeserializeSeed<'de>>(self, seed: S) -> Result<(S::Value, Self), Mismatch> {
        let name = StrDeserializer::<Mismatch>::new(self.name);
        let kind = seed.deserialize(name);
        let kind =
            kind.map_err(|wrong| if self.value.is_some() { wrong.at_key(self.name) } else { wrong })?;
        Ok((kind, self))
    }
}

impl<'de> VariantReader<'de> {
    fn reader(&self) -> Result<Reader<'de>, Mismatch> {
        self.value.map(Reader).ok_or_else(Mismatch::only_a_name)
    }
}

impl<'de> VariantAccess<'de> for VariantReader<'de> {
    type Error = Mismatch;

    fn unit_variant(self) -> Result<(), Mismatch> {
        match self.value {
            None => Ok(()),
            Some(Value::Table(keys)) if keys.is_empty() => Ok(()),
            Some(Value::Table(keys)) => {
                let key = keys.keys().next().map_or("", String::as_str);
                Err(Mismatch::unknown_field(key, &[]).at_key(key).in_key(self.name))
            }
            Some(value) => Err(Mismatch::invalid_type(Reader(value).found(), &"a table").in_key(self.name)),
        }
    }

    fn newtype_variant_seed<S: DeserializeSeed<'de>>(self, seed: S) -> Result<S::Value, Mismatch> {
        seed.deserialize(self.reader()?).map_err(|wrong| wrong.in_key(self.name))
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Mismatch> {
        self.reader()?.values(visitor).map_err(|wrong| wrong.in_key(self.name))
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Mismatch> {
        self.reader()?.table(visitor).map_err(|wrong| wrong.in_key(self.name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_know_their_keys() {
        #[derive(Debug, serde::Deserialize)]
        #[serde(deny_unknown_fields, rename_all = "snake_case")]
        #[allow(dead_code)]
        struct Part {
            kind: Kinds,
            list: Option<Vec<[f64; 2]>>,
        }
        #[derive(Debug, serde::Deserialize)]
        #[serde(rename_all = "snake_case")]
        #[allow(dead_code)]
        enum Kinds {
            Simple,
            Full { value: f64 },
        }
        let reported = |text: &str| {
            let wrong = read::<Part>(&text.parse().expect("TOML")).expect_err("wrong");
            (wrong.path(), wrong.key().map(str::to_owned), wrong.to_string())
        };
        let error_at = |path: &str, key: Option<&str>, why: &str| {
            (path.to_owned(), key.map(str::to_owned), why.to_owned())
        };
        assert_eq!(reported("list = []"), error_at("", None, "missing key `kind`"));
        assert_eq!(
            reported("kind.full.value = 'x'"),
            error_at("kind.full.value", None, "found string \"x\", expected a number")
        );
        assert_eq!(reported("kind.full = {}"), error_at("kind.full", None, "missing key `value`"));
        assert_eq!(
            reported("kind.simple.x = 1"),
            error_at("kind.simple", Some("x"), "unknown key `x`, there are no keys here")
        );
        let unknown = "`ful` is not known here, expected `simple` or `full`; did you mean `full`?";
        assert_eq!(reported("kind.ful = 1"), error_at("kind", Some("ful"), unknown));
        assert_eq!(reported("kind = 'ful'"), error_at("kind", None, unknown));
        assert_eq!(
            reported("kind = 'simple'\nlist = [[1, 2], [1]]"),
            error_at("list[1]", None, "found an array of length 1, expected an array of length 2")
        );
        assert_eq!(
            reported("kind = 'simple'\nlist = [[1, 2], [1, 2, 3]]"),
            error_at("list[1]", None, "has 3 values, expected 2")
        );
        assert_eq!(
            reported("knd = 1"),
            error_at("", Some("knd"), "unknown key `knd`, expected `kind` or `list`; did you mean `kind`?")
        );
    }
}
