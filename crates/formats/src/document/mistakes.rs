//! All errors in a document, not only the first: an invalid value is replaced by a valid one, and reading is repeated.

use serde::de::DeserializeOwned;
use toml::{Table, Value};

use super::key::{bare_or_quoted, get, set};
use super::mismatch::Mismatch;
use super::reader::read;
use super::suggestions::is_other_word;

/// Largest number of errors reported at once.
const MOST: usize = 20;
/// Number that most keys accept.
const FITS: f64 = 0.5;

/// Returns all errors of a table that is to be read as a part: the known first one, and the others.
pub fn all<T: DeserializeOwned>(table: &Table, first: Mismatch) -> Vec<Mismatch> {
    let (mut table, mut found) = (table.clone(), Vec::new());
    let mut replaced: Vec<String> = Vec::new();
    let mut next = Some(first);
    while let Some(wrong) = next.take() {
        // The replacement of a previous error is invalid too: the document has no such value.
        let own = replaced.iter().any(|place| wrong.path().starts_with(place));
        if own || found.len() == MOST {
            break;
        }
        let place = replace(&mut table, &wrong);
        found.push(wrong);
        let Some(place) = place else { break };
        replaced.push(place);
        next = read::<T>(&table).err();
    }
    found
}

/// Replaces an invalid value by one that may be valid, and returns its path.
fn replace(table: &mut Table, wrong: &Mismatch) -> Option<String> {
    let path = wrong.path();
    let within = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
    if let Some(key) = wrong.key() {
        let mut inner = if path.is_empty() { table.clone() } else { get(table, &path)?.as_table()?.clone() };
        let value = inner.remove(key)?;
        // A synonym of a kind may have other keys: they do not help to explain the error.
        let other_kind = wrong.meant().filter(|_| value.is_table() && is_other_word(key)).map(bare_or_quoted);
        match wrong.meant() {
            Some(meant) if !inner.contains_key(meant) => {
                inner.insert(meant.to_owned(), value);
            }
            // An empty table names no kind.
            _ if inner.is_empty() => return None,
            _ => {}
        }
        if path.is_empty() {
            *table = inner;
        } else {
            set(table, &path, Value::Table(inner)).ok()?;
        }
        // The value of the renamed key is still to be read.
        return Some(within(other_kind.as_deref().unwrap_or("\n")));
    }
    let (place, value) = match (wrong.missing(), wrong.meant()) {
        (Some(key), _) => (within(key), Value::Float(FITS)),
        (None, Some(meant)) => (path, Value::String(meant.to_owned())),
        (None, None) if path.is_empty() => return None,
        (None, None) => (path, fitting(&wrong.to_string())?),
    };
    set(table, &place, value).ok()?;
    Some(place)
}

/// Returns a value of the type that a message asks for.
fn fitting(why: &str) -> Option<Value> {
    let expected = why.rsplit_once("expected ").map_or(why, |(_, expected)| expected);
    let value = match expected {
        "true or false" => Value::Boolean(true),
        "a string" => Value::String("x".to_owned()),
        _ if expected.starts_with("a whole number") => Value::Integer(1),
        "a number" => Value::Float(FITS),
        _ if expected.starts_with("must be") => Value::Float(FITS),
        _ => return None,
    };
    Some(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexsc_numerics::quantity::Positive;

    #[derive(serde::Deserialize)]
    #[serde(rename_all = "snake_case")]
    #[allow(dead_code)]
    enum Law {
        Relay(Relay),
        Pd(f64),
    }

    #[derive(serde::Deserialize)]
    #[serde(deny_unknown_fields)]
    #[allow(dead_code)]
    struct Relay {
        dead_zone: Positive,
        hysteresis: Positive,
        strong: Positive,
        weak: Positive,
        k_t: Positive,
    }

    #[test]
    fn all_mistakes_are_found_and_nothing_else() {
        #[derive(serde::Deserialize)]
        #[serde(deny_unknown_fields)]
        #[allow(dead_code)]
        struct Whole {
            duration: f64,
            law: Law,
        }
        let text =
            "durations = 'long'\nwings = 2\nlaw.rely = { deadzone = true, hysteresis = 1e-4, strong = -1 }";
        let table = text.parse().expect("TOML");
        let first = read::<Whole>(&table).map(|_| ()).expect_err("wrong");
        let described: Vec<_> =
            all::<Whole>(&table, first).iter().map(|wrong| format!("{}: {wrong}", wrong.path())).collect();
        let holds =
            |path: &str, words: &str| described.iter().any(|t| t.starts_with(path) && t.contains(words));
        assert!(holds(": ", "did you mean `duration`"), "{described:#?}");
        assert!(holds("duration: ", "found string \"long\""), "{described:#?}");
        assert!(holds(": ", "unknown key `wings`"), "{described:#?}");
        assert!(holds("law: ", "did you mean `relay`"), "{described:#?}");
        assert!(holds("law.relay: ", "did you mean `dead_zone`"), "{described:#?}");
        assert!(holds("law.relay.dead_zone: ", "found boolean"), "{described:#?}");
        assert!(holds("law.relay: ", "missing key `weak`"), "{described:#?}");
        assert!(holds("law.relay: ", "missing key `k_t`"), "{described:#?}");
        assert!(holds("law.relay.strong: ", "must be"), "{described:#?}");
        assert_eq!(described.len(), 9, "{described:#?}");
    }

    #[test]
    fn a_kind_by_another_word_is_one_mistake() {
        #[derive(serde::Deserialize)]
        #[allow(dead_code)]
        struct Whole {
            law: Law,
        }
        let table = "law.bangbang = { bandwidth = 1, q = 2 }".parse().expect("TOML");
        let first = read::<Whole>(&table).map(|_| ()).expect_err("wrong");
        let described: Vec<_> = all::<Whole>(&table, first).iter().map(ToString::to_string).collect();
        assert_eq!(described.len(), 1, "{described:#?}");
        assert!(described[0].contains("did you mean `relay`?"), "{described:#?}");
    }
}
