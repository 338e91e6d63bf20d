//! Relays about the axes: a decision at an event, and a poll at a sample.

use std::fmt::Write as _;

use super::Glue;
use super::member::Member;
use super::text::{about, local};
use crate::control_system::Relays;

/// Adds the relays.
pub fn add(glue: &mut Glue<'_>, relays: &Relays) {
    let axes = relays.axes.len();
    glue.members.push(Member::about_axes("Relay about each axis.", "relay", "PolledRelay", &relays.axes));
    let mut body = String::new();
    if axes > 1 {
        let axis =
            format!("if input.axis < {axes} && input.axis >= 0 {{ input.axis as usize }} else {{ 0 }}");
        body += &local("usize", "axis", &axis);
    }
    let relay = if axes == 1 { "relay" } else { "relay[axis]" };
    body += &local("RelayEvent", "event", "RelayEvent::from_number(input.event)");
    let _ = writeln!(body, "    state.{relay}.decide(now, event, input.angle);");
    body += &local("RelayCommand", "command", &format!("state.{relay}.command"));
    body.push_str(
        "    output.torque = command.torque;
    output.has_timeout = command.has_timeout;
    output.until_whole = command.until.whole;
    output.until_part = command.until.part;
    output.guard_count = command.guard_count as i64;
    for guard in 0..2 {
        output.guard_is_lower[guard] = command.guards[guard].side == GuardDirection::AtMost;
        output.guard_level[guard] = command.guards[guard].level;
    }
",
    );
    glue.call("decide", &body);
    let poll = |axis: usize| {
        let [torque, relay, angle] = ["torque", "relay", "angle"].map(|name| about(name, axis, axes));
        let step =
            local("f64", &format!("torque_{axis}"), &format!("state.{relay}.step(now, input.{angle})"));
        step + &format!("    output.{torque} = torque_{axis};\n")
    };
    let body: String = (0..axes).map(poll).collect();
    glue.call("poll", &body);
}
