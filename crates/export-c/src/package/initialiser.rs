//! C initialisers of values of the flight code, from their debug text, in which every double is exact.

use std::fmt::Debug;

use crate::flight_sources::flight_sources;
use crate::translate::float_literal;

/// Returns the initialiser of a value in C, in braces if it is a struct or an array; `prefix` begins the names of enum variants.
///
/// Infinite numbers are calls of `binary64_infinity`, so that such a value is no constant.
pub fn initialiser(value: &impl Debug, prefix: &str) -> String {
    let text = format!("{value:?}");
    let mut reader = DebugReader { rest: &text, prefix };
    reader.value(None)
}

/// Reader of a debug text.
struct DebugReader<'a> {
    rest: &'a str,
    prefix: &'a str,
}

impl<'a> DebugReader<'a> {
    /// Returns the C text of the next value; `member` is the struct and the member that it belongs to.
    fn value(&mut self, member: Option<(&str, &str)>) -> String {
        self.rest = self.rest.trim_start();
        if self.take("[") {
            return self.list();
        }
        let word = self.word();
        self.rest = self.rest.trim_start();
        if self.take("{") {
            return self.members(word);
        }
        match word {
            "true" | "false" => word.to_owned(),
            "inf" => "binary64_infinity()".to_owned(),
            "-inf" => "-binary64_infinity()".to_owned(),
            _ if word.contains(['.', 'e'])
                && word.starts_with(['-', '0', '1', '2', '3', '4', '5', '6', '7', '8', '9']) =>
            {
                float_literal(word.parse().unwrap_or(f64::NAN))
            }
            _ if word.starts_with(|first: char| first.is_ascii_uppercase()) && word != "NaN" => {
                self.variant(member, word)
            }
            "NaN" => "binary64_nan()".to_owned(),
            _ => word.to_owned(),
        }
    }

    /// Returns the text of the members of a struct, after its opening brace.
    fn members(&mut self, name: &str) -> String {
        let mut members = Vec::new();
        loop {
            self.rest = self.rest.trim_start();
            if self.take("}") || self.rest.is_empty() {
                break;
            }
            let member = self.word().trim_end_matches(':');
            let value = self.value(Some((name, member)));
            members.push(format!(".{member} = {value}"));
            self.rest = self.rest.trim_start();
            self.take(",");
        }
        format!("{{ {} }}", members.join(", "))
    }

    /// Returns the text of a list, after its opening bracket.
    fn list(&mut self) -> String {
        let mut elements = Vec::new();
        loop {
            self.rest = self.rest.trim_start();
            if self.take("]") || self.rest.is_empty() {
                break;
            }
            elements.push(self.value(None));
            self.rest = self.rest.trim_start();
            self.take(",");
        }
        format!("{{ {} }}", elements.join(", "))
    }

    /// Returns the C name of an enum variant, by the type of the member that has it.
    fn variant(&self, member: Option<(&str, &str)>, variant: &str) -> String {
        let name = member.and_then(|(name, member)| member_type(name, member)).unwrap_or_default();
        format!("{}_{}_{}", self.prefix, super::snake(&name), super::snake(variant)).to_uppercase()
    }

    fn take(&mut self, token: &str) -> bool {
        let rest = self.rest.strip_prefix(token);
        rest.inspect(|rest| self.rest = rest).is_some()
    }

    fn word(&mut self) -> &'a str {
        let end = self.rest.find([' ', ',', '}', ']', '{']).unwrap_or(self.rest.len());
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
