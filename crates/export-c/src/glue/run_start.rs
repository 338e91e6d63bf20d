//! Inputs with which the estimators of a control system start in run 0: a program that closes the loop around the code, with
//! `flexsc serve` or another simulator, starts them alike.

use serde_json::{Map, Value};

use super::text::{camel, literal};
use super::{Glue, ModulePlan};
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
fn inputs<'a>(plan: &ModulePlan<'a>) -> impl Iterator<Item = (&'a str, Vec<f64>)> + use<'a> {
    let mut words = WordReader::new(plan.run_start.unwrap_or_default());
    let start = plan.calls.iter().filter(|call| call.name == START).flat_map(|call| &call.inputs);
    start.map(move |channel| (channel.name.as_str(), words.list(channel.count)))
}

/// Adds the constant with the inputs.
pub fn add(glue: &mut Glue<'_>) {
    if glue.plan.run_start.is_none() {
        return;
    }
    let member = |(name, numbers): (&str, Vec<f64>)| match &numbers[..] {
        [number] => format!("    {name}: {},\n", literal(number)),
        _ => format!("    {name}: {},\n", literal(&numbers)),
    };
    let members: String = inputs(&glue.plan).map(member).collect();
    let kind = format!("{}Input", camel(START));
    let about = format!("Inputs with which `{START}` starts run 0 of the scenario, at time 0.");
    let constant = format!("/// {about}\npub const RUN_START: {kind} = {kind} {{\n{members}}};\n\n");
    glue.constants.push_str(&constant);
}

/// Returns the inputs of a function in run 0 as JSON; null of all but the start.
pub fn start_inputs(plan: &ModulePlan<'_>, call: &CallLayout) -> Value {
    if call.name != START || plan.run_start.is_none() {
        return Value::Null;
    }
    let members = inputs(plan).map(|(name, numbers)| (name.to_owned(), Value::from(numbers)));
    Value::Object(members.collect::<Map<_, _>>())
}
