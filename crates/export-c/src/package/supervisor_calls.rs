//! Supervisor of modes in an exported control system: its lists, and the functions that change the mode.

use std::fmt::Write as _;

use flexsc_core::control::flight_quantity::FlightQuantity;
use flexsc_core::control::operation::{ModeFormula, ModeQuantity};

use super::shim::{self, list_argument};
use super::signature::signature;
use super::{Plan, estimator_calls, momentum_calls, parameters};
use crate::control_system::{Channel, ModeSystem, ReadingFormula};

/// Writes the members of the state.
pub fn members(plan: &Plan<'_>, modes: &ModeSystem, text: &mut String) {
    let tables = &modes.tables;
    let mut member = |about: &str, type_name: &str, name: &str| {
        let _ = writeln!(text, "    /* {about} */\n    {} {name};", plan.type_name(type_name));
    };
    member("Supervisor of the modes.", "ModeSupervisor", "supervisor");
    member("Modes.", "SupervisedMode", &format!("modes[{}]", tables.modes.len()));
    if !tables.exits.is_empty() {
        member("Ends of the modes.", "SupervisedExit", &format!("exits[{}]", tables.exits.len()));
    }
    if !parameters::thresholds(modes).is_empty() {
        member(
            "Comparisons of their conditions.",
            "ConditionStep",
            &format!("steps[{}]", tables.steps.len()),
        );
    }
    if modes.moves_angles {
        member("Change of the target at that of the mode.", "TargetChange", "change");
    }
}

/// Writes the lists of modes, ends and comparisons.
pub fn constants(plan: &Plan<'_>, modes: &ModeSystem, text: &mut String) {
    let tables = &modes.tables;
    let about = format!("Modes: {}.", tables.names.join(", "));
    *text += &shim::list(plan, &about, "SupervisedMode", "mode_list", &tables.modes);
    *text += &shim::list(plan, "Ends of the modes.", "SupervisedExit", "exit_list", &tables.exits);
    let about = "Comparisons of their conditions.";
    *text += &shim::list(plan, about, "ConditionStep", "step_list", &tables.steps);
}

/// Writes the statements of `init` that start the supervisor.
pub fn init(plan: &Plan<'_>, modes: &ModeSystem, text: &mut String) {
    text.push_str("    memcpy(state->modes, mode_list, sizeof state->modes);\n");
    if !modes.tables.exits.is_empty() {
        text.push_str("    memcpy(state->exits, exit_list, sizeof state->exits);\n");
    }
    if !parameters::thresholds(modes).is_empty() {
        text.push_str("    memcpy(state->steps, step_list, sizeof state->steps);\n");
        parameters::apply(plan, "steps[", text);
    }
    let _ = writeln!(text, "    state->supervisor = mode_supervisor_start(now, {});", arguments(modes));
}

/// Returns the modes and the ends as arguments.
fn arguments(modes: &ModeSystem) -> String {
    let exits = list_argument("state->exits", modes.tables.exits.len());
    format!("state->modes, {}, {exits}", modes.tables.modes.len())
}

/// Writes the function that enters a mode by command.
pub fn enter(plan: &Plan<'_>, modes: &ModeSystem, text: &mut String) {
    let count = modes.modes.len();
    let _ = writeln!(
        text,
        "{}\n{{\n    const size_t mode = input->mode < {count} && input->mode >= 0 ? (size_t)input->mode : 0;\n    \
         mode_supervisor_enter(&state->supervisor, now, mode, {});\n    start_laws(state);\n{}    output->mode = (int64_t)mode;\n}}\n",
        signature(plan, &plan.calls[modes.call_index("enter")]),
        arguments(modes),
        if modes.moves_angles { "    state->change.is_pending = false;\n" } else { "" },
    );
}

/// Returns an array of the inputs as two arguments; angle and rate are those of the attitude filter if there is one.
fn array_argument(modes: &ModeSystem, quantity: FlightQuantity) -> String {
    let name = quantity.channel();
    let channel = modes.inputs.channels.iter().find(|channel| channel.quantity == Some(quantity));
    match channel {
        Some(Channel { count: 1, .. }) => format!("&input->{name}, 1"),
        Some(Channel { count, .. }) => format!("input->{name}, {count}"),
        None => format!("{name}, {}", modes.inputs.axes),
    }
}

/// Returns the value of a reading.
fn reading(modes: &ModeSystem, formula: &ReadingFormula) -> String {
    let of_filter = |name: &str, rest: &str| format!("attitude_estimator_{name}(&state->estimator{rest})");
    let entries = modes.estimator.as_ref().map_or(0, |unit| unit.entries.len());
    match formula {
        ReadingFormula::Input(name) => format!("input->{name}"),
        ReadingFormula::Flag(name) => format!("input->{name} ? 1.0 : 0.0"),
        ReadingFormula::OfFilter(ModeQuantity::FilterAge) => of_filter("age", ", now"),
        ReadingFormula::OfFilter(ModeQuantity::FilterInnovation) => of_filter("innovation_size", ""),
        ReadingFormula::OfFilter(_) => of_filter("deviation_size", &format!(", state->entries, {entries}")),
        ReadingFormula::Known(formula) => {
            let function = match formula {
                ModeFormula::Single | ModeFormula::Norm(_) => "norm",
                ModeFormula::Distance(..) => "distance",
                ModeFormula::LargestSize(_) => "largest_size",
            };
            let arrays: Vec<String> = formula.vectors().map(|vector| array_argument(modes, vector)).collect();
            format!("mode_readings_{function}({})", arrays.join(", "))
        }
    }
}

/// Writes the arrays that the readings need beside the inputs: those of the attitude filter, and the stored momentum.
fn arrays(plan: &Plan<'_>, modes: &ModeSystem, text: &mut String) {
    let reads = |wanted: FlightQuantity| {
        modes.inputs.formulas.iter().any(|formula| match formula {
            ReadingFormula::Known(formula) => formula.vectors().any(|vector| vector == wanted),
            _ => false,
        })
    };
    let array = |name: &str, vector: &str, text: &mut String| {
        let _ = writeln!(text, "    const double {name}[3] = {{ {vector}.x, {vector}.y, {vector}.z }};");
    };
    let reads_wheels = reads(FlightQuantity::StoredMomentum) && modes.stored.wheel_count() > 0;
    let filter = modes.estimator.as_ref().filter(|_| modes.moves_angles);
    if let Some(unit) = filter {
        estimator_calls::attitudes(plan, unit, text);
        shim::variable(plan, "Vector3", "rotation", "quaternion_rotation_to(&target, &attitude)", text);
        if reads(FlightQuantity::Angle) {
            array("angle", "rotation", text);
        }
    }
    if reads_wheels || (filter.is_some() && reads(FlightQuantity::Rate)) {
        let rate = filter.map_or_else(|| shim::vector_from(plan, "input->rate"), estimator_calls::rate);
        shim::variable(plan, "Vector3", "estimated_rate", &rate, text);
    }
    if filter.is_some() && reads(FlightQuantity::Rate) {
        array("rate", "estimated_rate", text);
    }
    if reads_wheels {
        momentum_calls::declaration(plan, &modes.stored, "estimated_rate", text);
        array("stored_momentum", "stored", text);
    }
}

/// Writes the function that tests the conditions.
pub fn supervise(plan: &Plan<'_>, modes: &ModeSystem, text: &mut String) {
    let formulas = &modes.inputs.formulas;
    let _ = writeln!(text, "{}\n{{", signature(plan, &plan.calls[modes.call_index("supervise")]));
    arrays(plan, modes, text);
    if modes.inputs.channels.is_empty() {
        text.push_str("    (void)input;\n");
    }
    if !formulas.is_empty() {
        let _ = writeln!(text, "    double readings[{}];\n", formulas.len());
    }
    for (index, formula) in formulas.iter().enumerate() {
        let _ = writeln!(text, "    readings[{index}] = {};", reading(modes, formula));
    }
    let prefix = plan.prefix;
    let (readings, arguments) = (list_argument("readings", formulas.len()), arguments(modes));
    let steps = if parameters::thresholds(modes).is_empty() { "step_list" } else { "state->steps" };
    let steps = list_argument(steps, modes.tables.steps.len());
    let moved = if modes.moves_angles {
        "        target_change_begin(&state->change, &target, &rotation);\n"
    } else {
        ""
    };
    let _ = writeln!(
        text,
        "    const {prefix}_mode_test test = mode_supervisor_test(&state->supervisor, now, {readings}, {arguments}, {steps});\n    \
         if (test.has_changed) {{\n        start_laws(state);\n{moved}    }}\n    \
         const {prefix}_mode_due due = mode_supervisor_due(&state->supervisor, {arguments});\n    \
         const {prefix}_ticks period = state->modes[state->supervisor.active].period;\n    \
         output->mode = (int64_t)state->supervisor.active;"
    );
    for (output, value) in [
        ("has_changed", "test.has_changed"),
        ("is_chattering", "test.is_chattering"),
        ("has_next", "due.has_time"),
        ("next_whole", "due.time.whole"),
        ("next_part", "due.time.part"),
        ("period_whole", "period.whole"),
        ("period_part", "period.part"),
    ] {
        let _ = writeln!(text, "    output->{output} = {value};");
    }
    text.push_str("}\n\n");
}
