//! Compensators in an exported control system: their matrices, state and calls.

use std::fmt::Write as _;

use flexsc_core::control::law::Compensator;

use super::Plan;
use super::initialiser::initialiser;

/// Returns the paths of the functions of the flight code that compensators call.
pub fn roots(laws: &[Compensator]) -> Vec<&'static str> {
    let mut roots = vec!["compensator::advance"];
    if laws.iter().any(|law| !law.sources.is_empty()) {
        roots.push("compensator::read_sources");
    }
    roots
}

/// Writes the matrices, and the sources of the inputs about three axes.
pub fn constants(plan: &Plan<'_>, laws: &[Compensator], text: &mut String) {
    for (index, law) in laws.iter().enumerate() {
        let width = law.state.len() + law.inputs.len();
        let row = |row: &[f64]| {
            let entries: Vec<String> = row.iter().map(|entry| initialiser(entry, plan.prefix)).collect();
            format!("    {}", entries.join(", "))
        };
        let rows: Vec<String> = law.matrices.chunks(width).map(row).collect();
        let _ = writeln!(
            text,
            "/* Matrices of the compensator: the rows of [A B], then those of [C D]. */\nstatic const double matrices_{index}[{}] = {{\n{}\n}};\n",
            law.matrices.len(),
            rows.join(",\n")
        );
        if !law.sources.is_empty() {
            let sources: Vec<String> = law
                .sources
                .iter()
                .map(|source| format!("    {}", initialiser(source, plan.prefix)))
                .collect();
            let _ = writeln!(
                text,
                "/* Inputs of the compensator. */\nstatic const {}_compensator_source sources[{}] = {{\n{}\n}};\n",
                plan.prefix,
                sources.len(),
                sources.join(",\n")
            );
        }
    }
}

/// Writes the members of the state.
pub fn members(laws: &[Compensator], text: &mut String) {
    for (index, law) in laws.iter().enumerate() {
        let (order, outputs) = (law.state.len(), law.outputs.len());
        if order > 0 {
            let _ =
                writeln!(text, "    /* State of a compensator. */\n    double compensator_{index}[{order}];");
        }
        let _ = writeln!(
            text,
            "    /* Commands of that compensator at its last sample. */\n    double command_{index}[{outputs}];"
        );
    }
}

/// Writes the step of a compensator, for inputs that are set before.
fn advance(plan: &Plan<'_>, index: usize, law: &Compensator, text: &mut String) {
    let (prefix, order) = (plan.prefix, law.state.len());
    let range = initialiser(&law.range, prefix);
    // Without states a list has no elements, and C has no such array.
    let (buffer, states) = if order > 0 {
        (format!("double next[{order}]"), format!("state->compensator_{index}, {order}, next, {order}"))
    } else {
        ("double none[1] = { 0.0 }".to_owned(), "none, 0, none, 0".to_owned())
    };
    let _ = writeln!(
        text,
        "        const {prefix}_compensator_range range = {range};\n        {buffer};\n        \
         compensator_advance(matrices_{index}, {}, inputs, {}, {states}, &range, state->command_{index}, {});",
        law.matrices.len(),
        law.inputs.len(),
        law.outputs.len(),
    );
}

/// Returns the statement that sets the command about an axis.
fn command(law: &Compensator, value: &str, axis: usize, axes: usize) -> String {
    let about = |name: &str| super::signature::about(name, axis, axes);
    if law.is_acceleration {
        let reference = about("reference_acceleration");
        format!("output->{} = {value} + input->{reference};", about("acceleration"))
    } else {
        format!("output->{} = {value};", about("torque"))
    }
}

/// Writes the step of a compensator about one axis; `estimate` returns the estimated angle or rate about it.
pub fn step_about(
    plan: &Plan<'_>,
    law: &Compensator,
    (axis, axes): (usize, usize),
    estimate: impl Fn(&str, usize) -> String,
    text: &mut String,
) {
    let about = |name: &str| super::signature::about(name, axis, axes);
    let inputs = law.inputs.len();
    let _ = writeln!(text, "    {{\n        double inputs[{inputs}];");
    for (index, name) in ["angle", "rate"].into_iter().enumerate().take(inputs) {
        let reference = about(&format!("reference_{name}"));
        let _ = writeln!(text, "        inputs[{index}] = input->{reference} - {};", estimate(name, axis));
    }
    advance(plan, axis, law, text);
    let value = format!("state->command_{axis}[0]");
    let _ = writeln!(text, "        {}\n    }}", command(law, &value, axis, axes));
}

/// Writes the step of a compensator about three axes together; `estimate` returns the estimated angle or rate about an axis.
pub fn step_together(
    plan: &Plan<'_>,
    law: &Compensator,
    speeds: usize,
    estimate: impl Fn(&str, usize) -> String,
    text: &mut String,
) {
    let prefix = plan.prefix;
    let error = |name: &str| {
        let [x, y, z] =
            [0, 1, 2].map(|axis| format!("input->reference_{name}[{axis}] - {}", estimate(name, axis)));
        format!("({prefix}_vector3){{ .x = {x}, .y = {y}, .z = {z} }}")
    };
    let speeds = match speeds {
        0 => "NULL, 0".to_owned(),
        1 => "&input->wheel_speed, 1".to_owned(),
        count => format!("input->wheel_speed, {count}"),
    };
    let (sources, inputs) = (law.sources.len(), law.inputs.len());
    let _ = writeln!(
        text,
        "\n    /* the three axes together */\n    {{\n        const {prefix}_vector3 angle_error = {};\n        \
         const {prefix}_vector3 rate_error = {};\n        double inputs[{inputs}];\n        \
         compensator_read_sources(sources, {sources}, &angle_error, &rate_error, {speeds}, inputs, {inputs});",
        error("angle"),
        error("rate"),
    );
    advance(plan, 0, law, text);
    for axis in 0..3 {
        let output = law.axes.iter().position(|own| *own == axis);
        let value = output.map_or_else(|| "0.0".to_owned(), |output| format!("state->command_0[{output}]"));
        let _ = writeln!(text, "        {}", command(law, &value, axis, 3));
    }
    text.push_str("    }\n");
}
