//! Example of a main loop around an exported control system: the order of its calls.

use std::fmt::Write as _;

use super::Plan;
use crate::control_system::CallLayout;
use crate::self_test::cycle_milliseconds;

/// Returns the calls in the order of a cycle, apart from those of the ground.
pub fn order<'a>(plan: &Plan<'a>) -> impl Iterator<Item = &'a CallLayout> + use<'a> {
    // A relay is polled; `decide` is for computers that act at events.
    let is_called = |call: &&CallLayout| !matches!(call.name, "enter" | "decide" | "shift");
    plan.calls.iter().filter(is_called)
}

/// Returns the program.
pub fn main_loop(plan: &Plan<'_>) -> String {
    let prefix = plan.prefix;
    let milliseconds = cycle_milliseconds(plan.system);
    let mut text = format!(
        "/* Main loop around {prefix}.c: an example of the order of calls. Replace the functions `read_*` and `write_*`, and the clock. */\n\n\
         #include \"{prefix}.h\"\n\n#include <stdio.h>\n#include <string.h>\n\n"
    );
    if plan.has_time() {
        let _ = writeln!(
            text,
            "/* Time on board at the start: any. */\nstatic const {prefix}_ticks epoch = {{ .whole = 5000, .part = 0 }};\n\n\
             /* Returns the time on board in a cycle, of {milliseconds} ms. */\nstatic {prefix}_ticks time_of(int64_t cycle)\n{{\n    \
             const int64_t past = cycle * {milliseconds};\n    const {prefix}_ticks now = {{ .whole = epoch.whole + past / 1000, .part = past % 1000 * INT64_C(1000000000000) }};\n    \
             return now;\n}}\n"
        );
    }
    for call in order(plan) {
        let name = call.name;
        let _ = writeln!(
            text,
            "/* Reads the inputs of `{prefix}_{name}`; here there are none. */\nstatic void read_{name}({prefix}_{name}_input *input)\n{{\n    memset(input, 0, sizeof *input);{}\n}}\n",
            call.inputs
                .iter()
                .filter(|channel| channel.is_unit && channel.count == 4 && call.is_start)
                .fold(String::new(), |all, channel| all + &format!("\n    input->{}[0] = 1;", channel.name))
        );
        let _ = writeln!(
            text,
            "/* Passes the outputs of `{prefix}_{name}` on. */\nstatic void write_{name}(const {prefix}_{name}_output *output)\n{{\n    (void)output;\n}}\n"
        );
    }
    let init = if plan.inits_at_time() { ", time_of(0)" } else { "" };
    let _ = writeln!(
        text,
        "int main(void)\n{{\n    static {prefix}_state state;\n\n    {prefix}_init(&state{init});"
    );
    for call in order(plan).filter(|call| call.is_start) {
        one(plan, call, "time_of(0)", "    ", &mut text);
    }
    text.push_str("    for (int64_t cycle = 1; cycle <= 100; ++cycle) {\n");
    for call in order(plan).filter(|call| !call.is_start) {
        let cycles = call.period.map_or(1, |period| (period * 1000.0 / milliseconds as f64).round() as u64);
        if cycles > 1 {
            let _ = writeln!(text, "        if (cycle % {cycles} == 0) {{");
            one(plan, call, "time_of(cycle)", "            ", &mut text);
            text.push_str("        }\n");
        } else {
            one(plan, call, "time_of(cycle)", "        ", &mut text);
        }
    }
    text.push_str("    }\n    printf(\"100 cycles\\n\");\n    return 0;\n}\n");
    text
}

/// Writes a call with its inputs and outputs.
fn one(plan: &Plan<'_>, call: &CallLayout, time: &str, indent: &str, text: &mut String) {
    let (prefix, name) = (plan.prefix, call.name);
    let now = if plan.has_time() { format!("{time}, ") } else { String::new() };
    let _ = writeln!(
        text,
        "{indent}{prefix}_{name}_input {name}_input;\n{indent}{prefix}_{name}_output {name}_output;\n{indent}read_{name}(&{name}_input);\n\
         {indent}{prefix}_{name}(&state, {now}&{name}_input, &{name}_output);\n{indent}write_{name}(&{name}_output);"
    );
}
