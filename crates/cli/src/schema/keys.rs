//! Keys of one table of a scenario, as the JSON Schema describes them: `flexsc schema sensor.gyro`.

use std::collections::{BTreeMap, VecDeque};
use std::fmt::Write as _;

use flexsc_core::formats::document::nearest;
use serde_json::{Value as Json, json};

/// Number of keys from which on a table stands in one place only, and other tables refer to it.
const LARGE: usize = 9;

/// Number of keys from which on the kinds of a part are tables of their own.
const MANY: usize = 40;

/// Width of the printed text, in characters.
const WIDTH: usize = 100;

/// Symbols that units consist of, between powers, products and quotients.
const SYMBOLS: [&str; 10] = ["m", "kg", "s", "rad", "N", "T", "A", "W", "Hz", "sqrt"];

/// Table of a scenario with its keys and those of the tables within it.
pub struct TableKeys {
    /// Path of the table: `sensor.gyro`.
    path: String,
    /// Meaning of the table.
    meaning: String,
    /// Keys in the order of the schema.
    keys: Vec<Key>,
}

/// Key of a table, with all that the schema states.
struct Key {
    /// Path below the table, with `[i]` for the entries of an array: `points[i].name`.
    name: String,
    /// Unit in which a number without one is read; empty if there is none.
    unit: String,
    /// Default as a scenario writes it, `required`, or empty if the meaning has it.
    default: String,
    /// Meaning, with the meanings of the values of a choice.
    meaning: String,
}

/// Place of a schema: its keys and choices, with references followed.
struct Node<'a> {
    /// Name of the type among the definitions of the schema.
    name: Option<&'a str>,
    /// Places that together are the node: what stands at the place itself, then the type that it refers to.
    parts: Vec<&'a Json>,
}

/// Key below a node.
struct Child<'a> {
    name: &'a str,
    value: &'a Json,
    is_required: bool,
    /// Meaning of the variant that the key selects, if it does.
    variant: Option<&'a str>,
    /// Symbol between the table and the key: of an entry of an array or a map.
    entry: &'static str,
}

/// Schema of scenarios, with the shortest path of each type.
pub struct SchemaKeys {
    schema: Json,
    paths: BTreeMap<String, String>,
}

impl SchemaKeys {
    /// Creates the walk over a schema.
    pub fn new(schema: Json) -> Self {
        let mut keys = Self { schema, paths: BTreeMap::new() };
        let mut paths = BTreeMap::<String, String>::new();
        let mut queue = VecDeque::from([(String::new(), &keys.schema)]);
        while let Some((path, place)) = queue.pop_front() {
            for child in keys.children(place) {
                let path = joined(&path, child.name);
                let name = keys.type_name(child.value);
                let is_new = name.is_none_or(|name| !paths.contains_key(name));
                if let Some(name) = name {
                    paths.entry(name.to_owned()).or_insert_with(|| path.clone());
                }
                if is_new {
                    queue.push_back((path, child.value));
                }
            }
        }
        keys.paths = paths;
        keys
    }

    /// Returns the keys of the table at a path, such as `sensor.gyro`; the empty path is the file itself.
    ///
    /// # Errors
    /// If there is no such table; the error has the keys of the nearest table above.
    pub fn table(&self, path: &str) -> Result<TableKeys, String> {
        let (mut place, mut meaning, mut above) = (&self.schema, "", String::new());
        for name in path.split('.').filter(|name| !name.is_empty()) {
            let children = self.children(place);
            let Some(child) = children.iter().find(|child| child.name == name) else {
                let names: Vec<&str> = children.iter().map(|child| child.name).collect();
                let known: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
                let of = if above.is_empty() { "a scenario".to_owned() } else { format!("`{above}`") };
                let known = if known.is_empty() {
                    "it is no table".to_owned()
                } else {
                    format!("expected {}", known.join(", "))
                };
                let meant = nearest(name, &names).map(|meant| format!("\n\nhint: did you mean `{meant}`?"));
                return Err(format!("{of} has no key `{name}`: {known}{}", meant.unwrap_or_default()));
            };
            place = child.value;
            meaning = child.variant.unwrap_or_else(|| self.described(child.value));
            above = joined(&above, name);
        }
        let own = self.node(place).parts.last().map_or("", |part| description(part));
        let meaning = if own.is_empty() { meaning } else { own };
        let mut keys = Vec::new();
        let is_many = self.count(place, &mut Vec::new()) >= MANY;
        for child in self.children(place) {
            self.collect((&above, ""), &child, is_many && child.variant.is_some(), &mut keys);
        }
        Ok(TableKeys { path: above, meaning: plain(meaning), keys })
    }

    /// Appends the row of a key, and those of the table that it has, unless `alone`.
    fn collect(&self, (table, within): (&str, &str), child: &Child, alone: bool, rows: &mut Vec<Key>) {
        let node = self.node(child.value);
        let name = joined(within, child.name);
        let mut meaning = plain(child.variant.unwrap_or_else(|| self.described(child.value)));
        let unit = take_unit(&mut meaning);
        meaning += &self.choices(&node, &meaning);
        meaning += &self.accepted(&node);
        let inner = self.children(child.value);
        let path =
            self.type_name(child.value).and_then(|name| self.paths.get(name)).map_or("", String::as_str);
        let is_below = path.starts_with(&format!("{table}."));
        let is_large = !alone && !is_below && self.count(child.value, &mut Vec::new()) >= LARGE;
        if is_large {
            let space = if meaning.is_empty() { "" } else { " " };
            write!(meaning, "{space}Keys as in `{path}`.").expect("memory");
        }
        let default = match node.parts.iter().find_map(|part| part.get("default")) {
            _ if child.variant.is_some() => String::new(),
            _ if child.is_required => "required".to_owned(),
            Some(default) => literal(default),
            None if meaning.to_lowercase().contains("default") => String::new(),
            None => self.omitted(&node).to_owned(),
        };
        rows.push(Key { name: name.clone(), unit, default, meaning });
        if !alone && !is_large {
            for child in inner {
                self.collect((table, &format!("{name}{}", child.entry)), &child, false, rows);
            }
        }
    }

    /// Returns the number of keys at a place and below; a type within itself counts once.
    fn count<'a>(&'a self, place: &'a Json, within: &mut Vec<&'a str>) -> usize {
        let name = self.node(place).name;
        if name.is_some_and(|name| within.contains(&name)) {
            return 0;
        }
        within.extend(name);
        let count = self.children(place).iter().map(|child| 1 + self.count(child.value, within)).sum();
        within.truncate(within.len() - usize::from(name.is_some()));
        count
    }

    /// Returns the name of the type at a place, or of the entries of an array there.
    fn type_name<'a>(&'a self, place: &'a Json) -> Option<&'a str> {
        let node = self.node(place);
        let items = node.parts.last().map(|part| &part["items"]).filter(|items| items.is_object());
        node.name.or_else(|| items.and_then(|items| self.type_name(items)))
    }

    /// Follows the reference of a place, which may be `null` beside it.
    fn node<'a>(&'a self, place: &'a Json) -> Node<'a> {
        let (mut parts, mut name, mut place) = (vec![place], None, place);
        loop {
            let mut inner = choices(place, "anyOf").filter(|choice| choice["type"] != "null");
            if let (Some(only), None) = (inner.next(), inner.next()) {
                place = only;
            } else if let Some(reference) = place["$ref"].as_str() {
                let of = reference.rsplit('/').next().unwrap_or_default();
                (name, place) = (Some(of), &self.schema["$defs"][of]);
            } else {
                return Node { name, parts };
            }
            parts.push(place);
        }
    }

    /// Returns the keys below a place: its own, those of its variants, and those of the entries of an array.
    fn children<'a>(&'a self, place: &'a Json) -> Vec<Child<'a>> {
        let mut children: Vec<Child> = Vec::new();
        let mut add = |child: Child<'a>| {
            if child.name != "own" && !children.iter().any(|known| known.name == child.name) {
                children.push(child);
            }
        };
        for part in self.node(place).parts {
            let required =
                |name: &str| part["required"].as_array().is_some_and(|all| all.iter().any(|one| one == name));
            for (name, value) in part["properties"].as_object().into_iter().flatten() {
                add(Child { name, value, is_required: required(name), variant: None, entry: "" });
            }
            let is_choice = choices(part, "anyOf").filter(|choice| choice["type"] != "null").count() > 1;
            let variants = choices(part, "oneOf").chain(choices(part, "anyOf").filter(|_| is_choice));
            for branch in variants {
                let means = Some(description(branch)).filter(|means| !means.is_empty());
                for child in self.children(branch) {
                    let variant =
                        means.filter(|_| branch["properties"].as_object().is_some_and(|all| all.len() == 1));
                    add(Child { variant: child.variant.or(variant), ..child });
                }
            }
            for (entries, entry) in [("items", "[i]"), ("additionalProperties", ".NAME")] {
                if part[entries].is_object() {
                    for child in self.children(&part[entries]) {
                        add(Child { entry, ..child });
                    }
                }
            }
        }
        children
    }

    /// Returns the meaning of a place: its own, else that of its type.
    fn described<'a>(&'a self, place: &'a Json) -> &'a str {
        self.node(place).parts.into_iter().map(description).find(|meaning| !meaning.is_empty()).unwrap_or("")
    }

    /// Returns the value of a key without a default in the schema, if it is left out.
    fn omitted(&self, node: &Node) -> &'static str {
        let last = node.parts.last().map_or(&Json::Null, |part| *part);
        let is_null = |choice: &Json| choice["type"] == "null";
        let may_be_null = node.parts.iter().any(|part| {
            choices(part, "anyOf").any(is_null) || choices(part, "type").any(|kind| kind == "null")
        });
        let is_number = |place: &Json| place["type"] == "number" || place["type"] == "integer";
        // One number for all axes, or one for each.
        let of_each = || choices(last, "anyOf").next().map(|choice| self.node(choice));
        match last["type"].as_str() {
            Some("boolean") => "false",
            _ if may_be_null => "none",
            Some("array" | "object") => "none",
            _ if is_number(last) => "0",
            _ if of_each().is_some_and(|node| node.parts.last().is_some_and(|part| is_number(part))) => "0",
            _ => "",
        }
    }

    /// Returns the range of a number, and whether three numbers may stand for one, as sentences.
    fn accepted(&self, node: &Node) -> String {
        let Some(part) = node.parts.last() else { return String::new() };
        let bound = |keyword: &str| part[keyword].as_f64().filter(|bound| bound.abs() < 1e12);
        let range = match (bound("minimum"), bound("maximum")) {
            (Some(low), Some(high)) => format!(" From {} to {}.", rounded(low), rounded(high)),
            _ => String::new(),
        };
        let is_three = |choice: &&Json| choice["minItems"] == 3 && choice["maxItems"] == 3;
        let is_one =
            |choice: &Json| self.node(choice).parts.last().is_some_and(|part| part["type"] == "number");
        let is_each =
            choices(part, "anyOf").any(|choice| is_three(&choice)) && choices(part, "anyOf").any(is_one);
        range + if is_each { " One number, or three." } else { "" }
    }

    /// Returns the values of a choice between words that the meaning of the key does not name, each with its own meaning, as
    /// sentences after that of the key.
    fn choices(&self, node: &Node, meaning: &str) -> String {
        let Some(part) = node.parts.last() else { return String::new() };
        if part["items"].is_object() {
            return self.choices(&self.node(&part["items"]), meaning);
        }
        let values = choices(part, "oneOf").chain(choices(part, "anyOf"));
        let mut text = String::new();
        for value in values {
            if let Some(word) = value["const"].as_str() {
                let means = plain(description(value));
                if means.is_empty() && meaning.contains(&format!("`\"{word}\"`")) {
                    continue;
                }
                let means =
                    if means.is_empty() { String::new() } else { format!(": {}", uncapitalised(&means)) };
                let means = means.trim_end_matches('.');
                write!(text, "{} `\"{word}\"`{means}", if text.is_empty() { "" } else { ";" })
                    .expect("memory");
            }
        }
        let words = part["enum"].as_array().into_iter().flatten().filter_map(Json::as_str);
        for word in words.filter(|word| !meaning.contains(&format!("`\"{word}\"`"))) {
            write!(text, "{} `\"{word}\"`", if text.is_empty() { "" } else { "," }).expect("memory");
        }
        if text.is_empty() { text } else { text + "." }
    }
}

impl TableKeys {
    /// Returns the keys as text for a terminal.
    pub fn text(&self) -> String {
        let mut text = if self.path.is_empty() { String::new() } else { format!("[{}]\n", self.path) };
        if !self.meaning.is_empty() {
            text += &wrapped(&self.meaning, "");
        }
        for key in &self.keys {
            let unit = if key.unit.is_empty() { String::new() } else { format!(" ({})", key.unit) };
            let default = match key.default.as_str() {
                "" => String::new(),
                "required" => ", required".to_owned(),
                default => format!(" = {default}"),
            };
            write!(text, "\n{}{unit}{default}\n{}", key.name, wrapped(&key.meaning, "    ")).expect("memory");
        }
        text
    }

    /// Returns the keys for programs: a list of objects.
    pub fn json(&self) -> Json {
        let key = |key: &Key| json!({"key": key.name, "unit": key.unit, "default": key.default, "meaning": key.meaning});
        self.keys.iter().map(key).collect()
    }
}

/// Returns the alternatives of a place under a keyword of JSON Schema.
fn choices<'a>(place: &'a Json, keyword: &str) -> impl Iterator<Item = &'a Json> + use<'a> {
    place[keyword].as_array().into_iter().flatten()
}

fn description(place: &Json) -> &str {
    place["description"].as_str().unwrap_or("")
}

fn joined(path: &str, name: &str) -> String {
    if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") }
}

/// Returns a doc comment as one line without the marks of rustdoc.
fn plain(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ").replace("\\[", "[").replace("\\]", "]")
}

/// Returns a sentence that continues another: without its capital, unless it begins with a name or a symbol.
fn uncapitalised(text: &str) -> String {
    let mut letters = text.chars();
    match (letters.next(), letters.clone().next()) {
        (Some(first), Some(second)) if second.is_lowercase() || second == ' ' => {
            first.to_lowercase().chain(letters).collect()
        }
        _ => text.to_owned(),
    }
}

/// Removes the unit from a meaning and returns it: "Period of the samples (s)." has the unit s.
fn take_unit(meaning: &mut String) -> String {
    for (start, _) in meaning.match_indices(" (") {
        let mut depth = 0;
        let end = meaning[start + 1..].find(|c: char| {
            depth += i32::from(c == '(') - i32::from(c == ')');
            depth == 0
        });
        if let Some(end) = end {
            let unit = meaning[start + 2..start + 1 + end].to_owned();
            if is_unit(&unit) {
                meaning.replace_range(start..start + 2 + end, "");
                return unit;
            }
        }
    }
    String::new()
}

fn is_unit(text: &str) -> bool {
    let symbols: Vec<&str> =
        text.split(|c: char| !c.is_ascii_alphabetic()).filter(|symbol| !symbol.is_empty()).collect();
    let is_other = |c: char| c.is_ascii_alphanumeric() || " /^.²³()".contains(c);
    !symbols.is_empty() && text.chars().all(is_other) && symbols.iter().all(|symbol| SYMBOLS.contains(symbol))
}

/// Returns a bound with at most four decimals, or as a power of ten.
fn rounded(bound: f64) -> String {
    let is_plain = bound == 0.0 || (1e-3..1e4).contains(&bound.abs());
    if is_plain { ((bound * 1e4).round() / 1e4).to_string() } else { format!("{bound:e}") }
}

/// Returns a default as a scenario writes it; one that says nothing is left out.
fn literal(value: &Json) -> String {
    match value {
        Json::Number(number) => {
            let text = number.to_string();
            text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
        }
        Json::Array(items) if items.first().is_some_and(|item| !item.is_array()) => {
            format!("[{}]", items.iter().map(literal).collect::<Vec<_>>().join(", "))
        }
        Json::String(_) | Json::Bool(_) => value.to_string(),
        _ => String::new(),
    }
}

/// Returns a text in lines of at most [`WIDTH`] characters, each indented.
fn wrapped(text: &str, indent: &str) -> String {
    let mut lines = String::new();
    let mut line = String::new();
    for word in text.split(' ') {
        if !line.is_empty() && indent.len() + line.chars().count() + 1 + word.chars().count() > WIDTH {
            writeln!(lines, "{indent}{line}").expect("memory");
            line.clear();
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line += word;
    }
    if !line.is_empty() {
        writeln!(lines, "{indent}{line}").expect("memory");
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the keys of a table of scenarios.
    fn table(path: &str) -> TableKeys {
        SchemaKeys::new(flexsc_core::Scenario::schema()).table(path).expect("a table")
    }

    #[test]
    fn a_key_has_its_unit_default_and_meaning() {
        let gyro = table("sensor.gyro");
        let noise = gyro.keys.iter().find(|key| key.name == "noise").expect("a key");
        assert_eq!((noise.unit.as_str(), noise.default.as_str()), ("rad/s", "0"));
        assert!(noise.meaning.starts_with("Standard deviation") && !noise.meaning.contains("(rad/s)"));
        let text = table("sensor.star_tracker").text();
        assert!(text.starts_with("[sensor.star_tracker]\n") && text.contains("\nperiod (s), required\n    "));
        assert!(text.contains("\nexclusion.sun (rad)\n"), "{text}");
    }

    #[test]
    fn words_that_a_meaning_names_are_not_repeated() {
        let craft = table("spacecraft");
        let meaning =
            |name: &str| craft.keys.iter().find(|key| key.name == name).map(|key| key.meaning.as_str());
        assert!(meaning("rate").is_some_and(|text| text.ends_with("rates of the hub.")), "{}", craft.text());
        assert_eq!(meaning("attitude").map(|text| text.matches("target\"").count()), Some(1));
    }

    #[test]
    fn kinds_choices_and_arrays_are_listed() {
        let kinds: Vec<String> = table("sensor").keys.into_iter().map(|key| key.name).collect();
        assert!(
            kinds.contains(&"gyro".to_owned()) && !kinds.iter().any(|name| name.contains('.')),
            "{kinds:?}"
        );
        let wheels = table("actuator.wheels");
        let meaning =
            |name: &str| wheels.keys.iter().find(|key| key.name == name).map(|key| key.meaning.as_str());
        assert!(
            meaning("arrangement").is_some_and(|text| text.contains("`\"pyramid\"`: ")),
            "{}",
            wheels.text()
        );
        // The keys of jets stand once.
        assert!(meaning("unloading.jets").is_some_and(|text| text.ends_with("Keys as in `actuator.jets`.")));
        assert!(
            meaning("unloading.jets.period").is_none() && meaning("imbalance.harmonics[i].order").is_some()
        );
    }

    #[test]
    fn the_file_itself_and_wrong_names() {
        assert!(table("").keys.iter().any(|key| key.name == "duration" && key.default == "required"));
        let keys = SchemaKeys::new(flexsc_core::Scenario::schema());
        let wrong = |path: &str| keys.table(path).err().expect("an error");
        assert!(wrong("sensr").starts_with("a scenario has no key `sensr`: expected `name`, "));
        assert!(
            wrong("sensor.giro").contains("`sensor` has no key `giro`: expected `sampled`"),
            "{}",
            wrong("sensor.giro")
        );
        assert!(wrong("sensr").ends_with("hint: did you mean `sensor`?"), "{}", wrong("sensr"));
        assert_eq!(wrong("duration.x"), "`duration` has no key `x`: it is no table");
    }

    #[test]
    fn units_differ_from_remarks() {
        let of = |text: &str| {
            let mut meaning = text.to_owned();
            let unit = take_unit(&mut meaning);
            (unit, meaning)
        };
        let expected = |unit: &str, meaning: &str| (unit.to_owned(), meaning.to_owned());
        assert_eq!(
            of("Density of white noise ((N m)² s); held."),
            expected("(N m)² s", "Density of white noise; held.")
        );
        assert_eq!(of("Walk (rad/s^1.5)."), expected("rad/s^1.5", "Walk."));
        assert_eq!(
            of("Torque (N m; rad/s² without inertia)."),
            expected("", "Torque (N m; rad/s² without inertia).")
        );
        assert_eq!(of("Random walk (rad/sqrt(s))."), expected("rad/sqrt(s)", "Random walk."));
    }
}
