//! Structs of the inputs and outputs of functions.

use std::fmt::Write as _;

use super::text::camel;
use crate::control_system::{CallLayout, Channel, NumberKind};

/// Returns the structs of the inputs and outputs of a function.
pub fn definitions(call: &CallLayout) -> String {
    let name = camel(call.name);
    let input = definition(&call.inputs, &format!("Inputs of `{}`.", call.name), &format!("{name}Input"));
    input + &definition(&call.outputs, &format!("Outputs of `{}`.", call.name), &format!("{name}Output"))
}

/// Returns a struct with a member for each channel.
fn definition(channels: &[Channel], about: &str, name: &str) -> String {
    let mut members: Vec<[String; 4]> = channels.iter().map(member).collect();
    if channels.is_empty() {
        let member = ["A struct in C has a member", "unused", "bool", "false"];
        members.push(member.map(str::to_owned));
    }
    let mut text = format!("/// {about}\n#[derive(Clone, Copy, Debug, PartialEq)]\npub struct {name} {{\n");
    let mut zeros = Vec::new();
    for [about, name, kind, zero] in members {
        let _ = writeln!(text, "    /// {about}.\n    pub {name}: {kind},");
        zeros.push(format!("        {name}: {zero},\n"));
    }
    let zeros = zeros.concat();
    let _ = writeln!(
        text,
        "}}\n\nimpl {name} {{\n    /// Zeros.\n    pub const ZERO: Self = Self {{\n{zeros}    }};\n}}\n"
    );
    text
}

/// Returns the meaning, name, type and zero of a channel.
fn member(channel: &Channel) -> [String; 4] {
    let (kind, zero) = match channel.kind {
        NumberKind::Real => ("f64", "0.0"),
        NumberKind::Flag => ("bool", "false"),
        NumberKind::Integer(_) => ("i64", "0"),
    };
    let array = |text: &str| {
        if channel.count == 1 { text.to_owned() } else { format!("[{text}; {}]", channel.count) }
    };
    [channel.about.clone(), channel.name.clone(), array(kind), array(zero)]
}
