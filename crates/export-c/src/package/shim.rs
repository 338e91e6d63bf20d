//! Values of the exported functions: vectors of named inputs, components of named outputs, and constant lists.

use std::fmt::{Debug, Write as _};

use super::Plan;
use super::initialiser::initialiser;

/// Components of a vector.
pub const VECTOR: [&str; 3] = ["x", "y", "z"];
/// Components of a quaternion.
pub const QUATERNION: [&str; 4] = ["w", "x", "y", "z"];

/// Returns a vector or a quaternion with these values of its components.
fn compound_literal<T: AsRef<str>>(plan: &Plan<'_>, kind: &str, names: &[&str], values: &[T]) -> String {
    let each = names.iter().zip(values).map(|(name, value)| format!(".{name} = {}", value.as_ref()));
    format!("({}){{ {} }}", plan.type_name(kind), each.collect::<Vec<_>>().join(", "))
}

/// Returns a vector of three values.
pub fn vector<T: AsRef<str>>(plan: &Plan<'_>, values: &[T; 3]) -> String {
    compound_literal(plan, "Vector3", &VECTOR, values)
}

/// Returns a quaternion of four values.
pub fn quaternion<T: AsRef<str>>(plan: &Plan<'_>, values: &[T; 4]) -> String {
    compound_literal(plan, "Quaternion", &QUATERNION, values)
}

/// Returns the vector of the first three elements of an array.
pub fn vector_from(plan: &Plan<'_>, array: &str) -> String {
    vector(plan, &[0, 1, 2].map(|index| format!("{array}[{index}]")))
}

/// Returns the quaternion of the first four elements of an array.
pub fn quaternion_from(plan: &Plan<'_>, array: &str) -> String {
    quaternion(plan, &[0, 1, 2, 3].map(|index| format!("{array}[{index}]")))
}

/// Writes the declaration of a constant variable.
pub fn variable(plan: &Plan<'_>, kind: &str, name: &str, value: &str, text: &mut String) {
    let _ = writeln!(text, "    const {} {name} = {value};", plan.type_name(kind));
}

/// Writes the statements that set an array to the components of a value.
pub fn spread(array: &str, value: &str, components: &[&str], text: &mut String) {
    for (index, component) in components.iter().enumerate() {
        let _ = writeln!(text, "    {array}[{index}] = {value}.{component};");
    }
}

/// Returns a constant list of values of a type, with its comment; empty without values.
pub fn list(plan: &Plan<'_>, about: &str, kind: &str, name: &str, values: &[impl Debug]) -> String {
    let rows: Vec<String> = values.iter().map(|value| initialiser(value, plan.prefix)).collect();
    rows_of(about, &plan.type_name(kind), name, values.len(), &rows)
}

/// Returns a constant list of numbers, `on_line` of them on each line.
pub fn numbers(plan: &Plan<'_>, about: &str, name: &str, values: &[f64], on_line: usize) -> String {
    let row =
        |row: &[f64]| row.iter().map(|value| initialiser(value, plan.prefix)).collect::<Vec<_>>().join(", ");
    let rows: Vec<String> = values.chunks(on_line).map(row).collect();
    rows_of(about, "double", name, values.len(), &rows)
}

fn rows_of(about: &str, kind: &str, name: &str, count: usize, rows: &[String]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    format!("/* {about} */\nstatic const {kind} {name}[{count}] = {{\n    {}\n}};\n\n", rows.join(",\n    "))
}

/// Returns a list as two arguments of a call.
pub fn list_argument(name: &str, count: usize) -> String {
    if count == 0 { "NULL, 0".to_owned() } else { format!("{name}, {count}") }
}
