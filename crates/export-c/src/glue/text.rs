//! Text in Rust: values of the flight code, vectors of named inputs, components of named outputs.

use std::collections::BTreeSet;
use std::fmt::Debug;

use crate::flight_sources::flight_sources;

/// Components of a vector.
pub const VECTOR: [&str; 3] = ["x", "y", "z"];
/// Components of a quaternion.
pub const QUATERNION: [&str; 4] = ["w", "x", "y", "z"];

/// Returns the words of a text.
pub fn words(text: &str) -> BTreeSet<&str> {
    text.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_').collect()
}

/// Returns a name in lower case with a capital letter at the start of each word, and without underscores.
pub fn camel(name: &str) -> String {
    let words = name.split('_').map(|word| {
        let (first, rest) = word.split_at(word.len().min(1));
        first.to_uppercase() + rest
    });
    words.collect()
}

/// Returns a member of the inputs, outputs or state about an axis.
pub fn about(name: &str, axis: usize, axes: usize) -> String {
    if axes == 1 { name.to_owned() } else { format!("{name}[{axis}]") }
}

/// Returns a vector of three values.
pub fn vector<T: AsRef<str>>(values: &[T; 3]) -> String {
    let [x, y, z] = values.each_ref().map(AsRef::as_ref);
    format!("Vector3 {{ x: {x}, y: {y}, z: {z} }}")
}

/// Returns the vector of the first three elements of an array.
pub fn vector_from(array: &str) -> String {
    vector(&[0, 1, 2].map(|index| format!("{array}[{index}]")))
}

/// Returns the quaternion of the first four elements of an array.
pub fn quaternion_from(array: &str) -> String {
    format!("Quaternion {{ w: {array}[0], x: {array}[1], y: {array}[2], z: {array}[3] }}")
}

/// Returns the declaration of a local.
pub fn local(kind: &str, name: &str, value: &str) -> String {
    format!("    let {name}: {kind} = {value};\n")
}

/// Returns the statements that set an array to the components of a value.
pub fn spread(array: &str, value: &str, components: &[&str]) -> String {
    let each = components.iter().enumerate();
    let each = each.map(|(index, component)| format!("    {array}[{index}] = {value}.{component};\n"));
    each.collect::<Vec<_>>().concat()
}

/// Returns statements as a block of its own.
pub fn block(statements: &str) -> String {
    let lines: String = statements.lines().flat_map(|line| ["    ", line, "\n"]).collect();
    format!("    {{\n{lines}    }}\n")
}

/// Greatest length of a line.
const WIDTH: usize = 110;

/// Returns a line of code, whose outermost list is on several lines if it is long.
pub fn laid_out(line: &str) -> String {
    let parts = if line.chars().count() > WIDTH && !line.trim_start().starts_with("//") {
        list_of(line)
    } else {
        None
    };
    let Some((head, entries, tail)) = parts else { return format!("{line}\n") };
    let indent = " ".repeat(line.len() - line.trim_start().len());
    let entries: String =
        entries.iter().map(|entry| laid_out(&format!("{indent}    {},", entry.trim()))).collect();
    format!("{}\n{entries}{indent}{}\n", head.trim_end(), tail.trim_start())
}

/// Returns what stands before the first list with several entries, these entries, and the rest.
fn list_of(line: &str) -> Option<(&str, Vec<&str>, &str)> {
    let (mut opened, mut commas) = (Vec::new(), Vec::new());
    for (place, letter) in line.char_indices() {
        match letter {
            '(' | '[' | '{' => opened.push(place),
            ',' => commas.push((opened.len(), place)),
            ')' | ']' | '}' => {
                let start = opened.pop()?;
                let own = commas.iter().filter(|(depth, comma)| *depth == opened.len() + 1 && *comma > start);
                let ends: Vec<usize> = own.map(|(_, comma)| *comma).chain([place]).collect();
                if opened.is_empty() && ends.len() > 1 {
                    let starts = [start].into_iter().chain(ends.iter().copied());
                    let entries = starts.zip(&ends).map(|(from, to)| &line[from + 1..*to]);
                    let entries = entries.filter(|entry| !entry.trim().is_empty());
                    return Some((&line[..=start], entries.collect(), &line[place..]));
                }
            }
            _ => {}
        }
    }
    None
}

/// Returns a value of the flight code, from its debug text, in which every number is exact.
pub fn literal(value: &impl Debug) -> String {
    let text = format!("{value:?}");
    let mut reader = DebugReader { rest: &text, text: String::new() };
    reader.value(None);
    reader.text
}

/// Reader of a debug text, which is Rust but for variants of enums and numbers that are not finite.
struct DebugReader<'a> {
    rest: &'a str,
    text: String,
}

impl<'a> DebugReader<'a> {
    /// Writes the next value; `member` is the struct and the member that it belongs to.
    fn value(&mut self, member: Option<(&'a str, &'a str)>) {
        if self.take("[") {
            while !self.take("]") && !self.rest.is_empty() {
                self.value(None);
                self.take(", ");
            }
            return;
        }
        let word = self.word();
        match word {
            "inf" => self.text += "f64::INFINITY",
            "-inf" => self.text += "f64::NEG_INFINITY",
            "NaN" => self.text += "f64::NAN",
            _ if self.rest.starts_with(" {") => {
                self.text += word;
                self.take(" { ");
                while !self.take(" }") && !self.rest.is_empty() {
                    let name = self.word().trim_end_matches(':');
                    self.text += name;
                    self.text += ": ";
                    self.rest = self.rest.trim_start();
                    self.value(Some((word, name)));
                    self.take(", ");
                }
            }
            _ if word.starts_with(|first: char| first.is_ascii_uppercase()) => {
                let kind = member.and_then(|(name, member)| member_type(name, member)).unwrap_or_default();
                self.text.extend([&*kind, "::", word]);
            }
            _ => self.text += word,
        }
    }

    /// Takes and writes a token.
    fn take(&mut self, token: &str) -> bool {
        let Some(rest) = self.rest.strip_prefix(token) else { return false };
        self.rest = rest;
        self.text += token;
        true
    }

    fn word(&mut self) -> &'a str {
        let end = self.rest.find([' ', ',', ']']).unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest;
        word
    }
}

/// Returns the type of a member of a struct of the flight code.
fn member_type(name: &str, member: &str) -> Option<String> {
    let files = flight_sources();
    let (head, line) = (format!("pub struct {name} {{"), format!("pub {member}: "));
    let body = files.iter().find_map(|file| file.text.split_once(&head)).map(|(_, body)| body)?;
    let body = body.split_once("\n}").map_or(body, |(body, _)| body);
    let (_, rest) = body.split_once(&line)?;
    rest.split_once(',').map(|(found, _)| found.trim().to_owned())
}
