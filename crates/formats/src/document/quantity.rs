//! Numbers with units, such as `"2 deg"`, as values of numeric keys: they are converted to SI, the unit of the key.
//!
//! The unit of a key stands in parentheses in its description in the JSON Schema of scenarios, as in `(rad/s)`.

use serde_json::Value as Json;
use toml::{Table, Value};

use super::ConfigError;
use super::key::bare_or_quoted;
use super::suggestions::nearest_name;
use super::units::{KNOWN, Unit, meant};

/// A hundredth, where a number has no unit.
const PERCENT: &str = "%";

/// Largest depth to which references of a schema are followed.
const DEEPEST: usize = 32;

/// Returns true if some text in a table may be a number with a unit.
pub fn any(table: &Table) -> bool {
    fn within(value: &Value) -> bool {
        match value {
            Value::String(text) => split(text).is_some(),
            Value::Array(values) => values.iter().any(within),
            Value::Table(table) => any(table),
            _ => false,
        }
    }
    table.values().any(within)
}

/// Converts numbers with units to SI in place, and returns a fault for each unit that is unknown or does not fit its
/// key. A number of a misspelt key has the unit of the key that was probably meant, and no fault but the name.
pub fn to_si(table: &mut Table, schema: &Json) -> Vec<ConfigError> {
    let mut faults = Vec::new();
    convert_table(table, "", &[Node { schema, unit: None }], schema, &mut faults);
    faults
}

/// The table of distributions by the paths of keys: numbers in a distribution take the units of its key.
const UNCERTAIN: &str = "uncertain";

fn distributions(uncertain: &mut Value, schema: &Json, faults: &mut Vec<ConfigError>) {
    let Value::Table(uncertain) = uncertain else { return };
    for (key, value) in uncertain.iter_mut() {
        let (ends, Value::Table(kinds)) = (ends_at(schema, key), value) else { continue };
        // Of a key that there is not, that is the mistake.
        let mut unreported = Vec::new();
        let is_number = ends.iter().any(|node| has_type(node.schema, "number"));
        if !is_number && ends.iter().any(|node| has_type(node.schema, "string")) {
            continue;
        }
        let faults = if is_number { &mut *faults } else { &mut unreported };
        for (kind, numbers) in kinds.iter_mut() {
            let path = format!("{UNCERTAIN}.{}.{}", bare_or_quoted(key), bare_or_quoted(kind));
            // A relative one has factors.
            let ends = if kind.starts_with("relative") { &[][..] } else { &ends[..] };
            each_in_si(numbers, &path, ends, faults);
        }
    }
}

fn each_in_si(value: &mut Value, path: &str, ends: &[Node<'_>], faults: &mut Vec<ConfigError>) {
    match value {
        Value::Table(table) => {
            for (key, value) in table.iter_mut() {
                each_in_si(value, &format!("{path}.{}", bare_or_quoted(key)), ends, faults);
            }
        }
        Value::Array(values) => {
            for (index, value) in values.iter_mut().enumerate() {
                each_in_si(value, &format!("{path}[{index}]"), ends, faults);
            }
        }
        Value::String(text) => {
            if let Some((number, unit)) = split(text) {
                *value = Value::Float(in_si(number, unit, ends, path, faults));
            }
        }
        _ => {}
    }
}

/// Returns the unit of a key by its path, such as `body.planar.modes[0].frequency`.
pub fn unit_at<'a>(schema: &'a Json, key: &str) -> Option<&'a str> {
    let ends = ends_at(schema, key);
    ends.iter().filter(|node| has_type(node.schema, "number")).find_map(|node| node.unit)
}

/// Returns the schema nodes that a key may have, by its path.
fn ends_at<'a>(schema: &'a Json, key: &str) -> Vec<Node<'a>> {
    let mut nodes = vec![Node { schema, unit: None }];
    for part in key.split('.') {
        let (name, places) =
            part.split_once('[').map_or((part, 0), |(name, rest)| (name, 1 + rest.matches('[').count()));
        nodes = within(schema, &nodes, Some(name));
        for _ in 0..places {
            nodes = within(schema, &nodes, None);
        }
    }
    flat(schema, &nodes)
}

/// Node of the schema, with the unit given by the descriptions on the way to it.
#[derive(Copy, Clone)]
struct Node<'a> {
    schema: &'a Json,
    unit: Option<&'a str>,
}

fn convert(value: &mut Value, path: &str, nodes: &[Node<'_>], schema: &Json, faults: &mut Vec<ConfigError>) {
    match value {
        Value::Table(table) => convert_table(table, &format!("{path}."), nodes, schema, faults),
        Value::Array(values) => {
            let elements = within(schema, nodes, None);
            for (index, value) in values.iter_mut().enumerate() {
                convert(value, &format!("{path}[{index}]"), &elements, schema, faults);
            }
        }
        Value::String(text) => {
            let Some((number, unit)) = split(text) else { return };
            let ends = flat(schema, nodes);
            let is = |name: &str| ends.iter().any(|node| has_type(node.schema, name));
            if !is("string") && is("number") {
                *value = Value::Float(in_si(number, unit, &ends, path, faults));
            }
        }
        _ => {}
    }
}

/// Converts the values of a table; `path` is that of its keys up to their names.
fn convert_table(
    table: &mut Table,
    path: &str,
    nodes: &[Node<'_>],
    schema: &Json,
    faults: &mut Vec<ConfigError>,
) {
    for (key, value) in table.iter_mut() {
        let path = format!("{path}{}", bare_or_quoted(key));
        if path == UNCERTAIN {
            distributions(value, schema, faults);
            continue;
        }
        let known = within(schema, nodes, Some(key));
        if known.is_empty() {
            let meant = within(schema, nodes, Some(meant_key(schema, nodes, key)));
            convert(value, &path, &meant, schema, &mut Vec::new());
        } else {
            convert(value, &path, &known, schema, faults);
        }
    }
}

/// Returns the key of a table that was probably meant by an unknown one; without one, a name that no key has.
fn meant_key<'a>(schema: &'a Json, nodes: &[Node<'a>], key: &str) -> &'a str {
    let tables = flat(schema, nodes);
    let keys = tables.iter().filter_map(|node| node.schema.get("properties")?.as_object());
    let keys: Vec<&str> = keys.flat_map(|keys| keys.keys().map(String::as_str)).collect();
    nearest_name(key, &keys).unwrap_or("")
}

/// Returns a number in the unit of its key, or as it is if its unit is at fault.
fn in_si(number: f64, unit: &str, ends: &[Node<'_>], path: &str, faults: &mut Vec<ConfigError>) -> f64 {
    let wanted: Vec<&str> = ends.iter().filter_map(|node| node.unit).collect();
    converted(number, unit, &wanted).unwrap_or_else(|why| {
        faults.push(ConfigError::new(path, why));
        number
    })
}

/// Returns the number of a text with a unit, such as `2 arcsec`, converted to `wanted`, or as it is without a unit.
///
/// # Errors
/// A text without a number, and a unit that is unknown or measures something else.
pub fn number_in(text: &str, wanted: &str) -> Result<f64, String> {
    let wanted = Some(wanted).filter(|wanted| !wanted.is_empty());
    let plain = text.trim().parse::<f64>().ok().filter(|number| number.is_finite());
    match (plain, split(text)) {
        (Some(number), _) => Ok(number),
        (None, Some((number, unit))) => converted(number, unit, wanted.as_slice()),
        (None, None) => {
            let example = wanted.map_or(String::new(), |unit| format!(" such as \"2 {unit}\""));
            Err(format!("must be a number, or a number with a unit{example}, got `{text}`"))
        }
    }
}

/// Returns the unit of a number with a unit, such as `deg` of `0.1 deg`; `None` for other texts.
pub fn unit_of_text(text: &str) -> Option<&str> {
    split(text).map(|(_, unit)| unit)
}

/// Returns the size of a unit in another one, if both are known and measure the same.
pub fn units_ratio(unit: &str, other: &str) -> Option<f64> {
    Unit::parse(unit)?.per(Unit::parse(other)?)
}

/// Returns the end of a message about an unknown unit: the one that is meant, or all that are known.
pub fn unknown_unit(unit: &str) -> String {
    meant(unit).map_or_else(|| format!("; known are {KNOWN}"), |meant| format!("; did you mean `{meant}`?"))
}

/// Returns true if a text is a finite number, or one with a unit.
pub fn is_number(text: &str) -> bool {
    text.trim().parse::<f64>().is_ok_and(f64::is_finite) || split(text).is_some()
}

/// Converts a number to the first of some units that measures the same; without any, a percentage to a fraction.
fn converted(number: f64, unit: &str, wanted: &[&str]) -> Result<f64, String> {
    let Some(first) = wanted.first() else {
        if unit == PERCENT {
            return Ok(number / 100.0);
        }
        return Err(format!("has the unit `{unit}`, but takes a number without a unit"));
    };
    let Some(found) = Unit::parse(unit) else {
        let hint = unknown_unit(unit);
        return Err(format!(
            "has the unit `{unit}`, which is not known; expected a unit such as `{first}`{hint}"
        ));
    };
    let factor = wanted.iter().find_map(|wanted| found.per(Unit::parse(wanted)?));
    factor
        .map(|factor| number * factor)
        .ok_or_else(|| format!("has the unit `{unit}`, expected a unit such as `{first}`"))
}

/// Splits a text into a number and a unit; `None` if it is not of this form.
fn split(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    if !text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)) {
        return None;
    }
    // The longest number counts: `1e-3 rad`, but `2 e`.
    let ends = text.char_indices().map(|(index, _)| index).filter(|index| *index > 0);
    let longest = ends.rev().find_map(|end| Some((text[..end].parse::<f64>().ok()?, end)))?;
    let unit = text[longest.1..].trim();
    let named =
        unit.starts_with(|c: char| c.is_alphabetic() || "%\u{b0}\u{221a}1(/\"'\u{2032}\u{2033}".contains(c));
    (longest.0.is_finite() && named).then_some((longest.0, unit))
}

/// Returns the schemas of a key, or of the elements if there is no key, within the given nodes.
fn within<'a>(schema: &'a Json, nodes: &[Node<'a>], key: Option<&str>) -> Vec<Node<'a>> {
    let mut inner = Vec::new();
    for node in flat(schema, nodes) {
        let found = match key {
            Some(key) => [
                node.schema.get("properties").and_then(|properties| properties.get(key)),
                node.schema.get("additionalProperties"),
            ],
            None => [node.schema.get("items"), None],
        };
        // A schema that accepts nothing, or all, is no object.
        for schema in found.into_iter().flatten().filter(|schema| schema.is_object()) {
            let unit = if key.is_some() { None } else { node.unit };
            inner.push(Node { schema, unit: unit_of(schema).or(unit) });
        }
        if let (None, Some(elements)) = (key, node.schema.get("prefixItems").and_then(Json::as_array)) {
            inner.extend(elements.iter().map(|schema| Node { schema, unit: unit_of(schema).or(node.unit) }));
        }
    }
    inner
}

/// Returns all schemas that some nodes may stand for, with references and choices resolved.
fn flat<'a>(schema: &'a Json, nodes: &[Node<'a>]) -> Vec<Node<'a>> {
    fn follow<'a>(schema: &'a Json, node: Node<'a>, depth: usize, all: &mut Vec<Node<'a>>) {
        if depth == DEEPEST {
            return;
        }
        let node = Node { unit: node.unit.or_else(|| unit_of(node.schema)), ..node };
        all.push(node);
        let target = node.schema.get("$ref").and_then(Json::as_str);
        let target = target.and_then(|path| schema.pointer(path.strip_prefix('#')?));
        let choices = ["anyOf", "oneOf", "allOf"]
            .into_iter()
            .filter_map(|keyword| node.schema.get(keyword)?.as_array());
        for inner in target.into_iter().chain(choices.flatten()) {
            follow(schema, Node { schema: inner, unit: node.unit }, depth + 1, all);
        }
    }
    let mut all = Vec::new();
    for node in nodes {
        follow(schema, *node, 0, &mut all);
    }
    all
}

/// Returns the unit in a description: `Angle (rad)`, `Torque (N m; rad/s² on a body without inertia)`.
fn unit_of(schema: &Json) -> Option<&str> {
    let text = schema.get("description")?.as_str()?;
    let places = text.match_indices('(').filter_map(|(open, _)| {
        let mut depth = 0;
        let end = text[open..].char_indices().find(|(_, c)| {
            depth += i32::from(*c == '(') - i32::from(*c == ')');
            depth == 0
        });
        let inner = &text[open + 1..open + end?.0];
        inner
            .split([';', ','])
            .map(|part| part.split(" for ").next().unwrap_or(part).trim())
            .find(|part| Unit::parse(part).is_some())
    });
    places.into_iter().next()
}

fn has_type(schema: &Json, name: &str) -> bool {
    match schema.get("type") {
        Some(Json::String(type_name)) => type_name == name,
        Some(Json::Array(types)) => types.iter().any(|types| types == name),
        _ => false,
    }
}
