//! Ports of the component of F Prime: their parameters, in the model and in C++.

use std::collections::BTreeSet;

use crate::control_system::{CallLayout, Channel, NumberKind};
use crate::package::Plan;

/// Returns the type of a number in the model and in C++.
fn scalar(kind: NumberKind) -> &'static str {
    match kind {
        NumberKind::Real => "F64",
        NumberKind::Flag => "bool",
        NumberKind::Integer(_) => "I64",
    }
}

/// Returns the type of a channel: a scalar, or an array that the model defines.
pub(super) fn type_name(channel: &Channel) -> String {
    let name = match channel.kind {
        _ if channel.count == 1 => return scalar(channel.kind).to_owned(),
        NumberKind::Real => "Real",
        NumberKind::Flag => "Flag",
        NumberKind::Integer(_) => "Integer",
    };
    format!("{name}{}", channel.count)
}

/// Returns the arrays of the model: name, count and type of the elements.
pub(super) fn arrays(plan: &Plan<'_>) -> BTreeSet<(String, usize, &'static str)> {
    let channels = plan.calls.iter().flat_map(|call| call.inputs.iter().chain(&call.outputs));
    channels
        .filter(|channel| channel.count > 1)
        .map(|channel| (type_name(channel), channel.count, scalar(channel.kind)))
        .collect()
}

/// Returns the parameters of a handler or of an output in C++.
pub(super) fn parameters(plan: &Plan<'_>, channels: &[Channel]) -> String {
    let mut list = if plan.has_time() {
        vec!["I64 now_whole".to_owned(), "I64 now_part".to_owned()]
    } else {
        Vec::new()
    };
    list.extend(channels.iter().map(|channel| {
        let reference = if channel.count == 1 { ["", ""] } else { ["const ", "&"] };
        format!("{}{}{} {}", reference[0], type_name(channel), reference[1], channel.name)
    }));
    list.join(", ")
}

/// Returns the parameters of a handler after the number of its port.
pub(super) fn handled(plan: &Plan<'_>, call: &CallLayout) -> String {
    let list = parameters(plan, &call.inputs);
    if list.is_empty() { list } else { format!(", {list}") }
}

/// Returns the arguments with the time, and then these channels.
pub(super) fn arguments(plan: &Plan<'_>, channels: &[Channel]) -> Vec<String> {
    let time = ["now_whole", "now_part"].iter().filter(|_| plan.has_time()).map(|name| (*name).to_owned());
    time.chain(channels.iter().map(|channel| channel.name.clone())).collect()
}
