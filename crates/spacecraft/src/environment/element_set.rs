//! A set of mean elements, as a scenario gives it: two lines, three with a name, one text, or a file of lines or of an Orbit
//! Mean-Elements Message.

use std::borrow::Cow;
use std::f64::consts::TAU;
use std::fmt;
use std::path::Path;

use flexsc_formats::calendar_date;
use flexsc_formats::document::ConfigError;
use flexsc_formats::element_message::{self, ElementMessage};
use flexsc_formats::foreign_file::read_file;
use flexsc_formats::text_file::{locate, read_text_up_to};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Error, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::two_lines::{self, MeanElements};

/// Largest size of a file (bytes).
const LONGEST: u64 = 1 << 20;
/// Formats of its files.
const FORMATS: [&str; 4] = ["a two-line element set", "an OMM", "an OMM in XML", "an OMM in JSON"];
const EXPECTED: &str = "both lines of a two-line element set, or the path of its file or of an OMM";

/// Set of mean elements.
#[derive(Clone, Debug, PartialEq)]
pub struct ElementSet {
    /// Path of the file, if the set is in one.
    file: Option<String>,
    elements: GivenElements,
}

/// Elements as they are given.
#[derive(Clone, Debug, PartialEq)]
enum GivenElements {
    /// Elements in a file that is not read yet.
    Unread,
    /// Both lines, and the index of the first in the list of the scenario, if they are in one.
    Lines([String; 2], Option<usize>),
    Message(ElementMessage),
}

impl ElementSet {
    /// Makes the path of a file absolute, relative to `directory`.
    pub fn locate(&mut self, directory: &Path) {
        self.file.iter_mut().for_each(|file| locate(file, directory));
    }

    /// Reads the file, if the set is in one.
    ///
    /// # Errors
    /// The error in the file.
    pub fn read(&mut self) -> Result<(), String> {
        let Some(file) = &self.file else { return Ok(()) };
        let reads = "a two-line element set and an OMM of SGP4";
        self.elements = read_file(Path::new(file), &FORMATS, reads, |path| {
            let text = read_text_up_to(path, LONGEST)?;
            let elements = if element_message::is_message(&text) {
                GivenElements::Message(ElementMessage::parse(&text)?)
            } else {
                GivenElements::Lines(both_lines(text.lines())?.1, None)
            };
            let set = Self { file: None, elements };
            set.elements().map_err(|fault| fault.why)?;
            Ok(set.elements)
        })?;
        Ok(())
    }

    /// Keeps the elements inline, and removes the reference to their file.
    pub fn inline(&mut self) {
        self.file = None;
    }

    /// Returns the elements.
    ///
    /// # Errors
    /// A line or a key that is not accepted, with its key in the orbit.
    pub(super) fn elements(&self) -> Result<MeanElements, ConfigError> {
        match &self.elements {
            GivenElements::Unread => Err(ConfigError::new("tle", "must be read from its file first")),
            GivenElements::Lines(lines, first) => {
                two_lines::parse(lines).map_err(|(line, why)| match first {
                    Some(first) => ConfigError::new(format!("tle[{}]", first + line), why),
                    None => ConfigError::new("tle", format!("line {} {why}", line + 1)),
                })
            }
            GivenElements::Message(message) => elements(message).map_err(|why| ConfigError::new("tle", why)),
        }
    }
}

/// Returns the elements of a message.
fn elements(message: &ElementMessage) -> Result<MeanElements, String> {
    let within = |key: &str, value: f64, least: f64, most: f64| {
        let why = || format!("must have a number from {least} to {most} as `{key}`, got {value}");
        (least..=most).contains(&value).then_some(value).ok_or_else(why)
    };
    let angle = |key: &str, value: f64, most: f64| within(key, value, 0.0, most).map(f64::to_radians);
    let [least, most] = two_lines::REVOLUTIONS;
    let epoch_ns = calendar_date::nanoseconds(&message.epoch).ok_or_else(|| {
        format!(
            "must have a date from 1970 to 2500 as `EPOCH`, such as 2026-03-20T14:46:00, got `{}`",
            message.epoch
        )
    })?;
    Ok(MeanElements {
        epoch_ns,
        inclination: angle("INCLINATION", message.inclination, 180.0)?,
        node: angle("RA_OF_ASC_NODE", message.ra_of_asc_node, 360.0)?,
        eccentricity: within("ECCENTRICITY", message.eccentricity, 0.0, 0.999_999_9)?,
        perigee: angle("ARG_OF_PERICENTER", message.arg_of_pericenter, 360.0)?,
        anomaly: angle("MEAN_ANOMALY", message.mean_anomaly, 360.0)?,
        motion: within("MEAN_MOTION", message.mean_motion, least, most)? * TAU / 1440.0,
        drag: within("BSTAR", message.bstar, -10.0, 10.0)?,
    })
}

/// Returns both lines of the one set in some lines, and the index of the first: without blanks at their ends, empty lines and a
/// name before them.
fn both_lines<'a>(lines: impl Iterator<Item = &'a str>) -> Result<(usize, [String; 2]), String> {
    let lines: Vec<(usize, &str)> = lines
        .map(|line| line.trim_start_matches('\u{feff}').trim_end())
        .enumerate()
        .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'))
        .collect();
    match lines[..] {
        [(first, one), (_, two)] | [_, (first, one), (_, two)] => {
            Ok((first, [one.to_owned(), two.to_owned()]))
        }
        _ => {
            let sets = lines.iter().filter(|(_, line)| line.starts_with("1 ")).count();
            Err(match sets {
                0 | 1 => {
                    format!("must be two lines of an element set, or three with a name, got {}", lines.len())
                }
                _ => format!(
                    "must have one element set, got {sets}: put that of the satellite into a file of its own"
                ),
            })
        }
    }
}

impl Serialize for ElementSet {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match (&self.file, &self.elements) {
            (Some(file), _) => serializer.serialize_str(file),
            (None, GivenElements::Lines(lines, _)) => lines.serialize(serializer),
            (None, GivenElements::Message(message)) => message.serialize(serializer),
            (None, GivenElements::Unread) => serializer.serialize_str(""),
        }
    }
}

impl<'de> Deserialize<'de> for ElementSet {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct SetOrFile;
        impl<'de> Visitor<'de> for SetOrFile {
            type Value = ElementSet;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(EXPECTED)
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<ElementSet, E> {
                if !text.trim().contains('\n') {
                    let file = Some(text.trim().to_owned());
                    return Ok(ElementSet { file, elements: GivenElements::Unread });
                }
                let (_, lines) = both_lines(text.lines()).map_err(E::custom)?;
                Ok(ElementSet { file: None, elements: GivenElements::Lines(lines, None) })
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<ElementSet, A::Error> {
                let given = Vec::<String>::deserialize(SeqAccessDeserializer::new(seq))?;
                let (first, lines) =
                    both_lines(given.iter().map(String::as_str)).map_err(A::Error::custom)?;
                Ok(ElementSet { file: None, elements: GivenElements::Lines(lines, Some(first)) })
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<ElementSet, A::Error> {
                let message = ElementMessage::deserialize(MapAccessDeserializer::new(map))?;
                Ok(ElementSet { file: None, elements: GivenElements::Message(message) })
            }
        }
        deserializer.deserialize_any(SetOrFile)
    }
}

impl JsonSchema for ElementSet {
    fn schema_name() -> Cow<'static, str> {
        "ElementSet".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let message = generator.subschema_for::<ElementMessage>();
        json_schema!({
            "description": "Both lines of a two-line element set, three with a name, one text of them, the path of a file of them or of an OMM, or the keys of an OMM",
            "anyOf": [
                { "type": "array", "items": { "type": "string" }, "minItems": 2, "maxItems": 3 },
                { "type": "string" },
                message
            ]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LINES: [&str; 2] = [
        "1 99001U 26001A   26320.25000000 -.00000205  00000-0  10000-3 0   104",
        "2 99001   0.0500 286.9433 0000335  13.7918  55.6504  1.00270176   101",
    ];

    fn given(value: impl Serialize) -> Result<ElementSet, String> {
        serde_json::from_value(serde_json::to_value(value).expect("a value"))
            .map_err(|error| error.to_string())
    }

    #[test]
    fn every_form_gives_the_same_elements() {
        let expected = given(LINES).expect("a set").elements().expect("elements");
        let [one, two] = LINES;
        let blank = format!("{one} \r");
        for lines in
            [vec![one, two], vec!["OWN", one, two], vec!["0 OWN", one, two], vec![blank.as_str(), two]]
        {
            let set = given(&lines).expect("a set");
            assert_eq!(set.elements().expect("elements"), expected);
            assert_eq!(serde_json::to_value(&set).expect("a value"), serde_json::json!([one, two]));
        }
        for text in [format!("{one}\n{two}"), format!("\u{feff}OWN\r\n{one}\r\n{two}\r\n\n")] {
            assert_eq!(given(&text).expect("a set").elements().expect("elements"), expected);
        }
        let message = serde_json::json!({
            "EPOCH": "2026-11-16T06:00:00", "MEAN_MOTION": 1.002_701_76, "ECCENTRICITY": 3.35e-5, "INCLINATION": 0.05,
            "RA_OF_ASC_NODE": 286.9433, "ARG_OF_PERICENTER": 13.7918, "MEAN_ANOMALY": 55.6504, "BSTAR": 1e-4,
        });
        assert_eq!(given(&message).expect("a set").elements().expect("elements"), expected);
        assert_eq!(serde_json::to_value(given(&message).expect("a set")).expect("a value"), message);
        let path = std::env::temp_dir().join(format!("flexsc-tle-{}", std::process::id()));
        for text in [format!("\u{feff}OWN\r\n{one}\r\n{two}\r\n"), message.to_string()] {
            std::fs::write(&path, text).expect("a file");
            let mut set = given(path.to_str()).expect("a path");
            set.read().expect("a set");
            set.inline();
            assert_eq!(set.elements().expect("elements"), expected);
        }
        let refused = |text: &str, words: [&str; 2]| {
            std::fs::write(&path, text).expect("a file");
            let why = given(path.to_str()).expect("a path").read().expect_err("damaged");
            assert!(words.iter().all(|word| why.contains(word)), "{why}");
        };
        refused("CCSDS_OEM_VERS = 2.0\n", ["this is an OEM", "orbit.ephemeris"]);
        refused(&message.to_string().replace("BSTAR", "BTERM"), ["cannot be used", "must have `BSTAR`"]);
        refused(
            "<ndm><omm><EPOCH>2026-11-16</EPOCH></omm></ndm>",
            ["cannot be used", "must have `MEAN_MOTION`"],
        );
        std::fs::remove_file(&path).expect("a file");
    }

    #[test]
    fn faults_are_at_their_line() {
        let [one, two] = LINES;
        let wrong = one.replace("104", "105");
        let fault =
            |set: Result<ElementSet, String>| set.expect("a set").elements().expect_err("wrong").to_string();
        assert!(fault(given([wrong.as_str(), two])).contains("`tle[0]` must end with its checksum, 4"));
        assert!(fault(given(["OWN", &wrong, two])).contains("`tle[1]` must end with its checksum, 4"));
        assert!(fault(given(format!("{wrong}\n{two}"))).contains("`tle` line 1 must end with its checksum"));
        assert!(given([one, two, one, two]).is_err_and(|why| why.contains("one element set, got 2")));
        assert!(given([one]).is_err_and(|why| why.contains("got 1")));
    }
}
