//! All errors in a document, not only the first: an invalid value is replaced by a valid one, and reading is repeated.

use serde::de::DeserializeOwned;
use toml::{Table, Value};

use super::key::{bare_or_quoted, get, set};
use super::mismatch::Mismatch;
use super::reader::read;
use super::suggestions::is_other_word;

/// Largest number of errors reported at once.
const MOST: usize = 20;
/// Largest number of replacements in search of them.
const TRIES: usize = 4 * MOST;
/// Largest length of an array that replaces one.
const LONGEST: usize = 16;
/// Number that most keys accept.
const FITS: f64 = 0.5;

/// Returns all errors of a table that is to be read as a part: the known first one, and the others.
pub fn all<T: DeserializeOwned>(table: &Table, first: Mismatch) -> Vec<Mismatch> {
    let (mut table, mut found) = (table.clone(), Vec::new());
    let mut replaced: Vec<String> = Vec::new();
    let mut refined: Vec<Mismatch> = Vec::new();
    let mut next = Some(first);
    for _ in 0..TRIES {
        let Some(wrong) = next.take() else { break };
        // The document has no such value: what replaced it is refined, and the error is not reported.
        let is_own = replaced.iter().any(|place| is_within(&wrong.path(), place));
        if refined.contains(&wrong) || found.len() == MOST {
            break;
        }
        let place = replace(&mut table, &wrong);
        let list = if is_own { &mut refined } else { &mut found };
        list.push(wrong);
        let Some(place) = place else { break };
        replaced.push(place);
        next = read::<T>(&table).err();
    }
    found
}

/// Returns true if a path is `place` or within it.
fn is_within(path: &str, place: &str) -> bool {
    path.strip_prefix(place).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}

/// Replaces an invalid value by one that may be valid, and returns its path.
fn replace(table: &mut Table, wrong: &Mismatch) -> Option<String> {
    let path = wrong.path();
    let within = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
    if let Some(key) = wrong.key() {
        let mut inner = if path.is_empty() { table.clone() } else { get(table, &path)?.as_table()?.clone() };
        let value = inner.remove(key)?;
        // The value of a synonym may be of another form: that does not help to explain the error.
        let synonym = wrong.meant().filter(|_| is_other_word(key)).map(bare_or_quoted);
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
        return Some(within(synonym.as_deref().unwrap_or("\n")));
    }
    let (place, value) = match (wrong.missing(), wrong.meant()) {
        (Some(key), _) => (within(key), Value::Float(FITS)),
        (None, Some(meant)) => (path, Value::String(meant.to_owned())),
        (None, None) if path.is_empty() => return None,
        (None, None) => (path, fitting(&wrong.to_string())?),
    };
    // A matrix of the wrong shape is one error.
    let is_row = place.ends_with(']') && value.as_array().is_some_and(|values| !values.is_empty());
    set(table, &place, value).ok()?;
    Some(if is_row { outermost_array(&place).to_owned() } else { place })
}

/// Returns the path of the array that contains the element at a path, of nested ones the outermost.
fn outermost_array(mut path: &str) -> &str {
    while let Some((array, _)) = path.rsplit_once('[').filter(|_| path.ends_with(']')) {
        path = array;
    }
    path
}

/// Returns a value of the type that a message asks for.
fn fitting(why: &str) -> Option<Value> {
    let expected = why.rsplit_once("expected ").map_or(why, |(_, expected)| expected);
    let value = match expected {
        "true or false" => Value::Boolean(true),
        "a string" => Value::String("x".to_owned()),
        _ if expected.starts_with("a whole number") => Value::Integer(1),
        "a number" => Value::Float(FITS),
        "an array" => Value::Array(Vec::new()),
        "a table" => Value::Table(Table::new()),
        _ if expected.starts_with("must be") => Value::Float(FITS),
        _ => {
            // Of an array that is too long, the message has only the number of values.
            let length = expected.strip_prefix("an array of length ").unwrap_or(expected);
            Value::Array(vec![Value::Float(FITS); length.parse().ok().filter(|length| *length <= LONGEST)?])
        }
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
    fn matrices_of_the_wrong_shape_hide_no_other_mistake() {
        #[derive(serde::Deserialize)]
        #[allow(dead_code)]
        struct Whole {
            inertia: [[f64; 3]; 3],
            list: Vec<f64>,
            part: Relay,
            weak: Positive,
        }
        let found = |text: &str| {
            let table = text.parse().expect("TOML");
            let first = read::<Whole>(&table).map(|_| ()).expect_err("wrong");
            let found = all::<Whole>(&table, first);
            found.iter().map(|wrong| format!("{}: {wrong}", wrong.path())).collect::<Vec<_>>()
        };
        let rest = "list = 1\npart = 3\nweak = -1";
        let too_long = "[[1, 2, 3], [1, 2, 3], [1, 2, 3], [1, 2, 3]]";
        for inertia in ["[1, 2]", "[[1, 2, 3], [1, 2, 3]]", too_long, "[[1, 2], [1], 3]", "7"] {
            let mistakes = found(&format!("inertia = {inertia}\n{rest}"));
            let places: Vec<_> = mistakes.iter().filter_map(|text| text.split(['[', ':']).next()).collect();
            assert_eq!(places, ["inertia", "list", "part", "weak"], "{inertia}: {mistakes:#?}");
        }
        let unlike = "inertia = [[1, 2, 3], [1, 'a', 3], [1, 2, true]]\nlist = []\npart = {}\nweak = -1";
        let mistakes = found(unlike);
        assert!(
            mistakes.iter().any(|text| text.starts_with("inertia[2][2]: found boolean")),
            "{mistakes:#?}"
        );
        assert!(mistakes.iter().any(|text| text.starts_with("weak: ")), "{mistakes:#?}");
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
