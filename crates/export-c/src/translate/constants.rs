//! Definitions of constants in C.

use super::comments::comment;
use super::error::{Outcome, refuse};
use super::evaluation::ConstantValue;
use super::items::{ItemContent, Program};
use super::literals::{integer_literal, real_literal};
use super::names::{Names, free_name};
use super::types::ValueKind;
use super::writer::push;

/// Greatest length of a line.
const WIDTH: usize = 110;

/// Returns the definition of a constant: an enumerator for a size, else a `static const`.
pub(super) fn define_constant(program: &Program<'_>, names: &Names, index: usize) -> Outcome<String> {
    let item = &program.items[index];
    let value = program.constant_value(index)?;
    let name = names.item(index);
    let mut text = comment(&item.docs, 0);
    if program.is_size(index)? {
        push(&mut text, format_args!("enum {{ {name} = {} }};\n", value.integer().unwrap_or_default()));
        return Ok(text);
    }
    let Some(kind) = program.constant_kind(index)? else { return Ok(text) };
    let storage = if program.exported.contains(&index) { "" } else { "static " };
    let start = format!("{storage}const {} = ", names.declaration(&kind, name));
    let Some(value) = initialiser(program, names, &kind, &value, 0) else {
        return refuse(
            item.span,
            format!("`{}` with an infinity or NaN", item.name),
            "finite numbers; functions may return others",
        )
        .map_err(|error| program.placed(error, item.file));
    };
    push(&mut text, format_args!("{start}{value};\n"));
    Ok(text)
}

/// Returns the declaration of a constant for the header.
pub(super) fn declare_constant(program: &Program<'_>, names: &Names, index: usize) -> Outcome<String> {
    let Some(kind) = program.constant_kind(index)? else { return Ok(String::new()) };
    let declared = names.declaration(&kind, names.item(index));
    Ok(format!("{}extern const {declared};\n", comment(&program.items[index].docs, 0)))
}

/// Returns the initialiser of a value, on one line if it is short.
fn initialiser(
    program: &Program<'_>,
    names: &Names,
    kind: &ValueKind,
    value: &ConstantValue,
    indent: usize,
) -> Option<String> {
    let entries: Vec<String> = match (kind, value) {
        (ValueKind::Array(element, _), ConstantValue::Array(values)) => values
            .iter()
            .map(|value| initialiser(program, names, element, value, indent + 4))
            .collect::<Option<_>>()?,
        (ValueKind::Struct(index), ConstantValue::Struct(fields)) => {
            let mut entries = Vec::new();
            for (name, value) in fields {
                let kind = program.field_kind(*index, name).ok()??;
                let value = initialiser(program, names, &kind, value, indent + 4)?;
                entries.push(format!(".{} = {value}", free_name(name)));
            }
            entries
        }
        _ => return scalar(program, names, value),
    };
    let line = format!("{{{}}}", entries.join(", "));
    if line.len() + indent < WIDTH - 40 && !line.contains('\n') {
        return Some(line);
    }
    let space = " ".repeat(indent + 4);
    let mut text = String::from("{\n");
    let mut row = String::new();
    // Short entries share lines.
    for entry in entries {
        let is_short = entry.len() < 24 && !entry.contains(['\n', '=']);
        if !row.is_empty() && (!is_short || row.len() + entry.len() + 6 + indent > WIDTH) {
            push(&mut text, format_args!("{space}{row}\n"));
            row.clear();
        }
        if !row.is_empty() {
            row.push(' ');
        }
        row += &entry;
        row.push(',');
        if !is_short {
            push(&mut text, format_args!("{space}{row}\n"));
            row.clear();
        }
    }
    if !row.is_empty() {
        push(&mut text, format_args!("{space}{row}\n"));
    }
    Some(format!("{text}{}}}", " ".repeat(indent)))
}

fn scalar(program: &Program<'_>, names: &Names, value: &ConstantValue) -> Option<String> {
    match value {
        ConstantValue::Float(value) => value.is_finite().then(|| real_literal(*value, program.is_single)),
        ConstantValue::Bool(value) => Some(value.to_string()),
        ConstantValue::Integer(value, kind) => {
            let digits = (*value > 0xffff && !kind.is_signed()).then(|| format!("{value:x}"));
            Some(integer_literal(*value, *kind, digits.as_deref()))
        }
        ConstantValue::Variant(index, position) => {
            let ItemContent::Enum { variants } = &program.items[*index].content else { return None };
            Some(names.variant(*index, &variants[*position].0))
        }
        _ => None,
    }
}
