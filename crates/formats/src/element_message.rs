//! Orbit Mean-Elements Messages (OMM) of SGP4, in keyword-value notation, XML or JSON (\[CCSDS502\]).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::number::real;

/// Mean elements of SGP4 with the keys and units of a message.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE", deny_unknown_fields)]
pub struct ElementMessage {
    /// Date (UTC), as 2026-07-21T04:06:53.604864.
    pub epoch: String,
    /// Mean motion (revolutions a day).
    pub mean_motion: f64,
    /// Eccentricity.
    pub eccentricity: f64,
    /// Inclination (deg).
    pub inclination: f64,
    /// Right ascension of the ascending node (deg).
    pub ra_of_asc_node: f64,
    /// Argument of perigee (deg).
    pub arg_of_pericenter: f64,
    /// Mean anomaly (deg).
    pub mean_anomaly: f64,
    /// Drag coefficient B* (1/radii of the Earth).
    pub bstar: f64,
}

/// Values that a message may only have as here, if it has them.
const FIXED: [(&str, &[&str]); 5] = [
    ("CENTER_NAME", &["EARTH"]),
    ("REF_FRAME", &["TEME"]),
    ("TIME_SYSTEM", &["UTC"]),
    ("MEAN_ELEMENT_THEORY", &["SGP4", "SGP/SGP4", "SDP4"]),
    // 4 is SGP4-XP, whatever the theory is called.
    ("EPHEMERIS_TYPE", &["0", "1", "2", "3"]),
];

/// Returns true if a text is a message, by its beginning.
pub fn is_message(text: &str) -> bool {
    text.trim_start().starts_with(['<', '{', '[']) || text.trim_start().starts_with("CCSDS_OMM_VERS")
}

impl ElementMessage {
    /// Reads a message of one set of elements.
    ///
    /// # Errors
    /// The key that is missing or not accepted.
    pub fn parse(text: &str) -> Result<Self, String> {
        let pairs = match text.trim_start().chars().next() {
            Some('<') => xml_pairs(text),
            Some('{' | '[') => json_pairs(text)?,
            _ => keyword_pairs(text),
        };
        let find = |key: &str| -> Result<Option<&str>, String> {
            let mut found = pairs.iter().filter(|(own, _)| own == key).map(|(_, value)| value.as_str());
            let first = found.next();
            if found.next().is_some() {
                return Err(format!("must have one set of elements, and has `{key}` several times"));
            }
            Ok(first)
        };
        for (key, accepted) in FIXED {
            if let Some(value) = find(key)?
                && !accepted.iter().any(|accepted| value.eq_ignore_ascii_case(accepted))
            {
                return Err(format!("must have `{key} = {}`, got `{value}`", accepted[0]));
            }
        }
        let text = |key: &str| find(key)?.ok_or_else(|| format!("must have `{key}`, as an OMM of SGP4"));
        let number = |key: &str| {
            let value = text(key)?;
            real(value).ok_or_else(|| format!("must have a number as `{key}`, got `{value}`"))
        };
        Ok(Self {
            epoch: text("EPOCH")?.to_owned(),
            mean_motion: number("MEAN_MOTION")?,
            eccentricity: number("ECCENTRICITY")?,
            inclination: number("INCLINATION")?,
            ra_of_asc_node: number("RA_OF_ASC_NODE")?,
            arg_of_pericenter: number("ARG_OF_PERICENTER")?,
            mean_anomaly: number("MEAN_ANOMALY")?,
            bstar: number("BSTAR")?,
        })
    }
}

/// Returns the lines `KEY = value`, without units in square brackets.
fn keyword_pairs(text: &str) -> Vec<(String, String)> {
    let pair = |line: &str| {
        let (key, value) = line.split_once('=')?;
        let value = value.split('[').next().unwrap_or_default();
        Some((key.trim().to_owned(), value.trim().to_owned()))
    };
    text.lines().filter_map(pair).collect()
}

/// Returns the elements that contain text alone, without their namespaces.
fn xml_pairs(text: &str) -> Vec<(String, String)> {
    let pair = |part: &str| {
        let (tag, value) = part.split_once('>')?;
        let name = tag.split_whitespace().next().filter(|name| !name.starts_with(['/', '!', '?']))?;
        let name = name.rsplit(':').next().unwrap_or_default();
        Some((name.to_owned(), value.trim().to_owned())).filter(|(_, value)| !value.is_empty())
    };
    text.split('<').filter_map(pair).collect()
}

/// Returns the members of the one object.
fn json_pairs(text: &str) -> Result<Vec<(String, String)>, String> {
    let mut found: Value = serde_json::from_str(text).map_err(|error| error.to_string())?;
    if let Value::Array(sets) = &mut found {
        let count = sets.len();
        found = sets.pop().filter(|_| count == 1).ok_or_else(|| {
            format!(
                "must have one set of elements, got {count}: put that of the satellite into a file of its own"
            )
        })?;
    }
    let Value::Object(members) = found else {
        return Err("must be an object with the keys of an OMM".to_owned());
    };
    let text = |value: Value| match value {
        Value::String(text) => text,
        other => other.to_string(),
    };
    Ok(members.into_iter().map(|(key, value)| (key, text(value))).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    const KEYWORDS: &str = "CCSDS_OMM_VERS = 2.0\nCOMMENT own\nOBJECT_NAME = OWN\nCENTER_NAME = Earth\nREF_FRAME = TEME\n\
        TIME_SYSTEM = utc\nMEAN_ELEMENT_THEORY = SGP/SGP4\nEPOCH = 2026-11-16T06:00:00.000000\nMEAN_MOTION = 1.00270176 [rev/day]\n\
        ECCENTRICITY = .0000335\nINCLINATION = 0.05 [deg]\nRA_OF_ASC_NODE = 286.9433\nARG_OF_PERICENTER = 13.7918\n\
        MEAN_ANOMALY = 55.6504\nBSTAR = .1E-3\n";

    #[test]
    fn all_notations_give_the_same_elements() {
        let found = ElementMessage::parse(KEYWORDS).expect("a message");
        assert_eq!((found.mean_motion, found.eccentricity, found.bstar), (1.002_701_76, 3.35e-5, 1e-4));
        let pairs = keyword_pairs(KEYWORDS);
        let element = |(key, value): &(String, String)| format!("<{key} units=\"x\">{value}</{key}>\n");
        let body = pairs.iter().skip(2).map(element).collect::<Vec<_>>().concat();
        let xml = format!(
            "<?xml version=\"1.0\"?>\n<ndm><omm id=\"CCSDS_OMM_VERS\"><body>{body}</body></omm></ndm>"
        );
        assert_eq!(ElementMessage::parse(&xml), Ok(found.clone()));
        let members: Vec<String> = pairs
            .iter()
            .map(|(key, value)| match real(value) {
                Some(number) if key != "CCSDS_OMM_VERS" => format!("\"{key}\": {number:e}"),
                _ => format!("\"{key}\": \"{value}\""),
            })
            .collect();
        let json = format!("[{{{}}}]", members.join(", "));
        assert_eq!(ElementMessage::parse(&json), Ok(found));
        assert!([KEYWORDS, &xml, &json].iter().all(|text| is_message(text)));
    }

    #[test]
    fn other_messages_are_refused_by_their_key() {
        let refused = |text: &str, why: &str| {
            let error = ElementMessage::parse(text).expect_err("wrong");
            assert!(error.contains(why), "{error}");
        };
        refused(&KEYWORDS.replace("SGP/SGP4", "SGP4-XP"), "`MEAN_ELEMENT_THEORY = SGP4`, got `SGP4-XP`");
        refused(&format!("{KEYWORDS}EPHEMERIS_TYPE = 4\n"), "`EPHEMERIS_TYPE = 0`, got `4`");
        refused(&KEYWORDS.replace("TEME", "EME2000"), "`REF_FRAME = TEME`");
        refused(&KEYWORDS.replace("BSTAR", "BTERM"), "must have `BSTAR`");
        refused(&KEYWORDS.replace("13.7918", "x"), "number as `ARG_OF_PERICENTER`, got `x`");
        refused(&format!("{KEYWORDS}{KEYWORDS}"), "several times");
        refused("[]", "one set of elements, got 0");
        refused("[1]", "must be an object");
        refused("{", "EOF");
    }
}
