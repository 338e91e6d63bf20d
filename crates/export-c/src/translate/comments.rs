//! Comments: documentation and attributes of items, and lines of comments between statements.

use syn::spanned::Spanned;
use syn::{Attribute, Expr, Lit, Meta};

use super::error::{Outcome, refuse};
use super::writer::push;

/// Greatest length of a line of a comment.
const WIDTH: usize = 110;

/// True if an item is translated: not one of tests, nor of the standard library. Other attributes are refused.
pub(super) fn is_kept(attributes: &[Attribute]) -> Outcome<bool> {
    let mut is_kept = true;
    for attribute in attributes {
        let path: Vec<String> =
            attribute.path().segments.iter().map(|segment| segment.ident.to_string()).collect();
        match path.join("::").as_str() {
            "doc" | "derive" | "inline" | "must_use" | "expect" | "rustfmt::skip" => {}
            "cfg" => {
                let Meta::List(list) = &attribute.meta else { continue };
                let condition: String = list.tokens.to_string().split_whitespace().collect();
                match condition.as_str() {
                    "test" | "feature=\"std\"" => is_kept = false,
                    "not(test)" | "not(feature=\"std\")" => {}
                    _ => {
                        let accepted = "`test`, `feature = \"std\"` and their `not(..)`";
                        return refuse(attribute.span(), format!("the condition `{condition}`"), accepted);
                    }
                }
            }
            other => {
                let accepted = "`derive`, `inline`, `must_use`, `expect`, `cfg` and `rustfmt::skip`";
                return refuse(attribute.span(), format!("the attribute `{other}`"), accepted);
            }
        }
    }
    Ok(is_kept)
}

/// Appends the lines of an item's documentation.
pub(super) fn read_docs(attributes: &[Attribute], docs: &mut Vec<String>) {
    for attribute in attributes {
        if let Meta::NameValue(value) = &attribute.meta
            && value.path.is_ident("doc")
            && let Expr::Lit(literal) = &value.value
            && let Lit::Str(text) = &literal.lit
        {
            let text = text.value();
            docs.push(text.strip_prefix(' ').unwrap_or(&text).to_owned());
        }
    }
}

/// Returns the lines of a C comment, indented.
pub(super) fn comment(lines: &[String], indent: usize) -> String {
    let space = " ".repeat(indent);
    let mut wrapped = Vec::new();
    for line in paragraphs(lines) {
        wrap(&line.replace("*/", "* /").replace("/*", "/ *"), WIDTH - 3 - indent, &mut wrapped);
    }
    match wrapped.as_slice() {
        [] => String::new(),
        [line] if line.chars().count() + indent + 6 <= WIDTH => format!("{space}/* {line} */\n"),
        [first, rest @ ..] => {
            let mut text = format!("{space}/* {first}\n");
            for line in rest {
                text += format!("{space} * {line}").trim_end();
                text.push('\n');
            }
            text.truncate(text.len() - 1);
            let last = rest.last().unwrap_or(first);
            if last.chars().count() + indent + 6 > WIDTH {
                push(&mut text, format_args!("\n{space}"));
            }
            text += " */\n";
            text
        }
    }
}

/// Joins the lines of paragraphs; blank lines, lists and tables keep theirs.
fn paragraphs(lines: &[String]) -> Vec<String> {
    let mut joined: Vec<String> = Vec::new();
    let mut is_open = false;
    for line in lines {
        let is_text = line.starts_with(|letter: char| letter.is_alphanumeric() || "`(|[\"".contains(letter))
            && !line.starts_with("| ");
        match joined.last_mut() {
            Some(last) if is_open && is_text => {
                last.push(' ');
                last.push_str(line);
            }
            _ => joined.push(line.clone()),
        }
        is_open = is_text;
    }
    while joined.last().is_some_and(String::is_empty) {
        joined.pop();
    }
    joined
}

/// Breaks a line at spaces, by its characters.
fn wrap(line: &str, width: usize, lines: &mut Vec<String>) {
    let mut current = String::new();
    for word in line.split(' ') {
        if !current.is_empty() && current.chars().count() + 1 + word.chars().count() > width {
            lines.push(std::mem::take(&mut current));
        }
        if !current.is_empty() {
            current.push(' ');
        }
        current += word;
    }
    lines.push(current);
}

/// Returns the lines of `//` comments right above a line (from 1), and whether a blank line is above them.
pub(super) fn comment_above(source: &[&str], line: usize) -> (Vec<String>, bool) {
    let mut top = line.saturating_sub(1);
    let mut lines = Vec::new();
    while top > 0 {
        let text = source[top - 1].trim();
        let Some(text) = text.strip_prefix("//") else { break };
        if text.starts_with('/') || text.starts_with('!') {
            break;
        }
        lines.push(text.strip_prefix(' ').unwrap_or(text).to_owned());
        top -= 1;
    }
    lines.reverse();
    (lines, top > 0 && source[top - 1].trim().is_empty())
}
