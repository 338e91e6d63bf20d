//! Payloads of messages: structs with the inputs or outputs of a function, without holes.

use std::fmt::Write as _;

use crate::control_system::{CallLayout, Channel, NumberKind};
use crate::glue::camel;
use crate::package::Plan;

/// Bytes to which a payload is filled.
const ALIGNMENT: usize = 8;

/// Payload with the inputs or outputs of a function.
pub(super) struct Payload<'a> {
    /// Name of the struct.
    pub name: String,
    /// True if the time of the call comes first.
    pub has_time: bool,
    /// Members, in the order of the vectors.
    pub channels: &'a [Channel],
}

impl<'a> Payload<'a> {
    /// Returns the payload of a message of the app of cFS, for the inputs or the outputs of a function.
    pub fn for_call(plan: &Plan<'a>, call: &'a CallLayout, is_input: bool) -> Self {
        let (side, channels) = if is_input { ("Input", &call.inputs) } else { ("Output", &call.outputs) };
        let name = format!("UPPER_APP_{}_{side}_Payload_t", camel(call.name));
        Self { name, has_time: plan.has_time(), channels }
    }

    /// Returns the definition of the struct: numbers of 8 bytes, then truth values, then what fills it up.
    pub fn definition(&self) -> String {
        let mut text = "typedef struct {\n".to_owned();
        if self.has_time {
            text.push_str(
                "    /* Time since the start of the control system: whole seconds, and femtoseconds past them. */\n    \
                 int64 now_whole;\n    int64 now_part;\n",
            );
        }
        for channel in self.channels.iter().filter(|channel| channel.kind != NumberKind::Flag) {
            let kind = if channel.kind == NumberKind::Real { "double" } else { "int64" };
            member(channel, kind, &mut text);
        }
        for channel in self.flags() {
            member(channel, "uint8", &mut text);
        }
        let flags: usize = self.flags().map(|channel| channel.count).sum();
        if !flags.is_multiple_of(ALIGNMENT) {
            let _ = writeln!(text, "    uint8 spare[{}];", ALIGNMENT - flags % ALIGNMENT);
        }
        let _ = writeln!(text, "}} {};\n", self.name);
        text
    }

    fn flags(&self) -> impl Iterator<Item = &Channel> {
        self.channels.iter().filter(|channel| channel.kind == NumberKind::Flag)
    }
}

fn member(channel: &Channel, kind: &str, text: &mut String) {
    let array = if channel.count == 1 { String::new() } else { format!("[{}]", channel.count) };
    let _ = writeln!(text, "    /* {}. */\n    {kind} {}{array};", channel.about, channel.name);
}
