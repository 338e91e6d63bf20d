//! Program that replays the vectors through the messages of the app of cFS.

use std::fmt::Write as _;

use super::payload::Payload;
use crate::control_system::{CallLayout, NumberKind};
use crate::glue::camel;
use crate::package::Plan;

/// Returns the program that replays the vectors through the messages of the app.
pub(super) fn replay(plan: &Plan<'_>) -> String {
    let mut tables = String::new();
    for (is_input, side) in [(true, "input"), (false, "output")] {
        let mut rows = Vec::new();
        for call in plan.calls {
            let (payload, name) = (Payload::for_call(plan, call, is_input), camel(call.name));
            let message = format!("UPPER_APP_{name}_{}_t", camel(side));
            let members: Vec<String> = payload
                .channels
                .iter()
                .map(|channel| {
                    let kind = match channel.kind {
                        NumberKind::Real => 'R',
                        NumberKind::Flag => 'F',
                        NumberKind::Integer(_) => 'I',
                    };
                    format!(
                        "    {{ \"{0}\", '{kind}', offsetof({1}, {0}), {2} }}",
                        channel.name, payload.name, channel.count
                    )
                })
                .collect();
            // C has no empty array.
            let list = if members.is_empty() { "NULL".to_owned() } else { format!("{}_{side}s", call.name) };
            if !members.is_empty() {
                let _ = writeln!(
                    tables,
                    "static const member {list}[{}] = {{\n{}\n}};\n",
                    members.len(),
                    members.join(",\n")
                );
            }
            rows.push(format!(
                "    {{ UPPER_APP_{}_{}_MID, sizeof({message}), offsetof({message}, Payload), {list}, {} }}",
                call.name.to_uppercase(),
                side.to_uppercase(),
                members.len()
            ));
        }
        let _ = writeln!(
            tables,
            "static const message_kind {side}s[{}] = {{\n{}\n}};\n",
            rows.len(),
            rows.join(",\n")
        );
    }
    let most = plan.calls.iter().map(CallLayout::output_words).max().unwrap_or(0).max(1);
    let most_input = plan.calls.iter().map(CallLayout::input_words).max().unwrap_or(0);
    let time = if plan.has_time() { "#define HAS_TIME\n" } else { "" };
    let table = if plan.parameters.is_empty() { "" } else { "#define HAS_PARAMETERS\n" };
    let _ = writeln!(
        tables,
        "{time}{table}enum {{ CALLS = {}, MOST_WORDS = {most}, MOST_BYTES = {} }};\n",
        plan.calls.len(),
        8 * (most.max(most_input) + 8) + 64
    );
    include_str!("../files/cfs/replay.c").replace("TABLES", &tables)
}
