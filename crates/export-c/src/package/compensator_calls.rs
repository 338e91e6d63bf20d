//! Compensators in an exported control system: their matrices, state and calls.

use std::fmt::Write as _;

use flexsc_core::control::law::Compensator;

use super::initialiser::initialiser;
use super::law_scope::LawCalls;
use super::shim;
use super::signature::about;

/// Writes the matrices, and the sources of the inputs about three axes.
pub fn constants(own: &LawCalls<'_>, laws: &[Compensator], text: &mut String) {
    for (index, law) in laws.iter().enumerate() {
        let (width, name) = (law.state.len() + law.inputs.len(), own.constant(&format!("matrices_{index}")));
        let about = "Matrices of the compensator: the rows of [A B], then those of [C D].";
        *text += &shim::numbers(own.plan, about, &name, &law.matrices, width);
        let (about, name) = ("Inputs of the compensator.", own.constant("sources"));
        *text += &shim::list(own.plan, about, "CompensatorSource", &name, &law.sources);
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
fn advance(own: &LawCalls<'_>, index: usize, law: &Compensator, text: &mut String) {
    let order = law.state.len();
    // Without states a list has no elements, and C has no such array.
    let (buffer, states) = if order > 0 {
        let state = own.state(&format!("compensator_{index}"));
        (format!("double next[{order}]"), format!("{state}, {order}, next, {order}"))
    } else {
        ("double none[1] = { 0.0 }".to_owned(), "none, 0, none, 0".to_owned())
    };
    let _ = writeln!(
        text,
        "        const {} range = {};\n        {buffer};\n        \
         compensator_advance({}, {}, inputs, {}, {states}, &range, {}, {});",
        own.plan.type_name("CompensatorRange"),
        initialiser(&law.range, own.plan.prefix),
        own.constant(&format!("matrices_{index}")),
        law.matrices.len(),
        law.inputs.len(),
        own.state(&format!("command_{index}")),
        law.outputs.len(),
    );
}

/// Writes the statement that sets the command about an axis.
fn command(own: &LawCalls<'_>, law: &Compensator, value: &str, axis: usize, text: &mut String) {
    let about = |name: &str| about(name, axis, own.laws.axis_count());
    let _ = if law.is_acceleration {
        let (output, reference) = (about("acceleration"), about("reference_acceleration"));
        writeln!(text, "        output->{output} = {value} + input->{reference};")
    } else {
        writeln!(text, "        output->{} = {value};", about("torque"))
    };
}

/// Writes the step of a compensator about one axis.
pub fn step_about(own: &LawCalls<'_>, law: &Compensator, axis: usize, text: &mut String) {
    let inputs = law.inputs.len();
    let _ = writeln!(text, "    {{\n        double inputs[{inputs}];");
    for (index, name) in ["angle", "rate"].into_iter().enumerate().take(inputs) {
        let reference = about(&format!("reference_{name}"), axis, own.laws.axis_count());
        let _ =
            writeln!(text, "        inputs[{index}] = input->{reference} - {};", own.estimate(name, axis));
    }
    advance(own, axis, law, text);
    command(own, law, &format!("{}[0]", own.state(&format!("command_{axis}"))), axis, text);
    text.push_str("    }\n");
}

/// Writes the step of a compensator about three axes together.
pub fn step_together(own: &LawCalls<'_>, law: &Compensator, text: &mut String) {
    let error = |name: &str| {
        let axis = |axis| format!("input->reference_{name}[{axis}] - {}", own.estimate(name, axis));
        shim::vector(own.plan, &[0, 1, 2].map(axis))
    };
    let speeds = match own.laws.speed_count() {
        0 => "NULL, 0".to_owned(),
        1 => "&input->wheel_speed, 1".to_owned(),
        count => format!("input->wheel_speed, {count}"),
    };
    let (count, inputs, vector) = (law.sources.len(), law.inputs.len(), own.plan.type_name("Vector3"));
    let _ = writeln!(
        text,
        "\n    /* the three axes together */\n    {{\n        const {vector} angle_error = {};\n        \
         const {vector} rate_error = {};\n        double inputs[{inputs}];\n        \
         compensator_read_sources({}, {count}, &angle_error, &rate_error, {speeds}, inputs, {inputs});",
        error("angle"),
        error("rate"),
        own.constant("sources"),
    );
    advance(own, 0, law, text);
    for axis in 0..3 {
        let output = law.axes.iter().position(|own| *own == axis);
        let command_of = |output| format!("{}[{output}]", own.state("command_0"));
        command(own, law, &output.map_or_else(|| "0.0".to_owned(), command_of), axis, text);
    }
    text.push_str("    }\n");
}
