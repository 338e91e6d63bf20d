//! Compensators: their matrices, state and calls.

use std::fmt::Write as _;

use flexsc_core::control::law::Compensator;

use super::Glue;
use super::law_scope::LawScope;
use super::member::Member;
use super::text::{about, block, literal, local, vector};

/// Adds the matrices, and the sources of the inputs about three axes.
pub fn add_constants(glue: &mut Glue<'_>, own: &LawScope<'_>, laws: &[Compensator]) {
    for (index, law) in laws.iter().enumerate() {
        let about = "Matrices of the compensator: the rows of [A B], then those of [C D].";
        glue.list(about, &own.constant(&format!("matrices_{index}")), "f64", &law.matrices);
        let about = "Inputs of the compensator.";
        glue.list(about, &own.constant("sources"), "CompensatorSource", &law.sources);
    }
}

/// Returns the members of the state.
pub fn members(laws: &[Compensator]) -> Vec<Member> {
    let mut members = Vec::new();
    for (index, law) in laws.iter().enumerate() {
        let (order, outputs) = (law.state.len(), law.outputs.len());
        let zeros = |about: &str, name: &str, count: usize| {
            Member::filled(about, &format!("{name}_{index}"), "f64", "0.0", count)
        };
        members.extend((order > 0).then(|| zeros("State of a compensator.", "compensator", order)));
        members.push(zeros("Commands of that compensator at its last sample.", "command", outputs));
    }
    members
}

/// Returns the step of a compensator, for inputs that are set before.
fn advance(own: &LawScope<'_>, index: usize, law: &Compensator) -> String {
    let order = law.state.len();
    let mut text = local("CompensatorRange", "range", &literal(&law.range));
    let mut lists = "&mut [], &mut []".to_owned();
    if order > 0 {
        let _ = writeln!(text, "    let mut next: [f64; {order}] = [0.0; {order}];");
        lists = format!("&mut {}, &mut next", own.state(&format!("compensator_{index}")));
    }
    let (matrices, command) =
        (own.constant(&format!("matrices_{index}")), own.state(&format!("command_{index}")));
    text + &format!("    compensator::advance(&{matrices}, &inputs, {lists}, &range, &mut {command});\n")
}

/// Returns the statement that sets the command about an axis.
fn command(own: &LawScope<'_>, law: &Compensator, value: &str, axis: usize) -> String {
    let about = |name: &str| about(name, axis, own.laws.axis_count());
    if law.is_acceleration {
        let (output, reference) = (about("acceleration"), about("reference_acceleration"));
        format!("    output.{output} = {value} + input.{reference};\n")
    } else {
        format!("    output.{} = {value};\n", about("torque"))
    }
}

/// Returns the step of a compensator about one axis.
pub fn step_about(own: &LawScope<'_>, law: &Compensator, axis: usize) -> String {
    let error = |name: &&str| {
        let reference = about(&format!("reference_{name}"), axis, own.laws.axis_count());
        format!("input.{reference} - {}", own.estimate(name, axis))
    };
    let errors: Vec<String> = ["angle", "rate"].iter().take(law.inputs.len()).map(error).collect();
    let inputs = local(&format!("[f64; {}]", errors.len()), "inputs", &format!("[{}]", errors.join(", ")));
    let value = format!("{}[0]", own.state(&format!("command_{axis}")));
    block(&(inputs + &advance(own, axis, law) + &command(own, law, &value, axis)))
}

/// Returns the step of a compensator about three axes together.
pub fn step_together(glue: &Glue<'_>, own: &LawScope<'_>, law: &Compensator) -> String {
    let error = |name: &str| {
        let axis = |axis| format!("input.reference_{name}[{axis}] - {}", own.estimate(name, axis));
        local("Vector3", &format!("{name}_error"), &vector(&[0, 1, 2].map(axis)))
    };
    let speeds = match own.laws.speed_count() {
        0 => "&[]".to_owned(),
        _ => glue.input_list("step", "wheel_speed"),
    };
    let (inputs, sources) = (law.inputs.len(), own.constant("sources"));
    let mut text = error("angle") + &error("rate");
    let _ = write!(
        text,
        "    let mut inputs: [f64; {inputs}] = [0.0; {inputs}];
    compensator::read_sources(&{sources}, &angle_error, &rate_error, {speeds}, &mut inputs);
"
    );
    text += &advance(own, 0, law);
    for axis in 0..3 {
        let output = law.axes.iter().position(|own| *own == axis);
        let command_of = |output| format!("{}[{output}]", own.state("command_0"));
        text += &command(own, law, &output.map_or_else(|| "0.0".to_owned(), command_of), axis);
    }
    "\n    // the three axes together\n".to_owned() + &block(&text)
}
