//! Inputs with which the estimators of an exported control system start in run 0: a program that closes the loop around the code, with
//! `flexsc serve` or another simulator, starts them alike.

use std::fmt::Write as _;

use serde_json::{Map, Value};

use super::Plan;
use super::initialiser::initialiser;
use crate::control_system::{CallLayout, WordReader};
use crate::vectors::CallVector;

/// Name of the function that starts estimators.
const START: &str = "start";

/// Returns the words of the inputs of the start in the calls of the run.
pub fn find<'a>(calls: &[CallLayout], vectors: &'a [CallVector]) -> Option<&'a [u64]> {
    let start = calls.iter().position(|call| call.name == START)?;
    vectors.iter().find(|vector| vector.call == start).map(|vector| &vector.inputs[..])
}

/// Iterates over the names of the inputs with their numbers.
fn inputs<'a>(plan: &Plan<'a>) -> impl Iterator<Item = (&'a str, Vec<f64>)> + use<'a> {
    let mut words = WordReader::new(plan.run_start.unwrap_or_default());
    let start = plan.calls.iter().filter(|call| call.name == START).flat_map(|call| &call.inputs);
    start.map(move |channel| (channel.name.as_str(), words.list(channel.count)))
}

/// Returns the declaration of the constant for the header; empty without one.
pub fn declaration(plan: &Plan<'_>) -> String {
    if plan.run_start.is_none() {
        return String::new();
    }
    let prefix = plan.prefix;
    format!(
        "/* Inputs with which `{prefix}_{START}` starts run 0 of the scenario, at time 0. */\nextern const {prefix}_{START}_input {prefix}_run_{START};\n\n"
    )
}

/// Writes the constant.
pub fn definition(plan: &Plan<'_>, text: &mut String) {
    if plan.run_start.is_none() {
        return;
    }
    let row = |(name, numbers): (&str, Vec<f64>)| {
        let each: Vec<String> = numbers.iter().map(|number| initialiser(number, plan.prefix)).collect();
        if let [number] = &each[..] {
            format!("    .{name} = {number}")
        } else {
            format!("    .{name} = {{ {} }}", each.join(", "))
        }
    };
    let (prefix, rows) = (plan.prefix, inputs(plan).map(row).collect::<Vec<_>>());
    let _ =
        writeln!(text, "const {prefix}_{START}_input {prefix}_run_{START} = {{\n{}\n}};\n", rows.join(",\n"));
}

/// Returns the inputs of a function in run 0 as JSON; null of all but the start.
pub fn start_inputs(plan: &Plan<'_>, call: &CallLayout) -> Value {
    if call.name != START || plan.run_start.is_none() {
        return Value::Null;
    }
    let members = inputs(plan).map(|(name, numbers)| (name.to_owned(), Value::from(numbers)));
    Value::Object(members.collect::<Map<_, _>>())
}
