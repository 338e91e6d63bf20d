//! Supervisor of modes: its lists, and the functions that change the mode.

use std::fmt::Write as _;

use flexsc_core::control::flight_quantity::FlightQuantity;
use flexsc_core::control::operation::{ModeFormula, ModeQuantity};

use super::member::Member;
use super::text::{literal, local, vector_from};
use super::{Glue, attitude, momentum, parameters};
use crate::control_system::{ModeSystem, ReadingFormula};

/// Adds the supervisor, which `init` starts.
pub fn add(glue: &mut Glue<'_>, modes: &ModeSystem) {
    let tables = &modes.tables;
    let about = "Supervisor of the modes.";
    let supervisor = Member::new(about, "supervisor", "ModeSupervisor", literal(&modes.supervisor));
    glue.members.push(supervisor.started());
    let about = format!("Modes: {}.", tables.names.join(", "));
    glue.members.push(Member::list(&about, "modes", "SupervisedMode", &tables.modes));
    if !tables.exits.is_empty() {
        glue.members.push(Member::list("Ends of the modes.", "exits", "SupervisedExit", &tables.exits));
    }
    let about = "Comparisons of their conditions.";
    if parameters::thresholds(modes).is_empty() {
        glue.list(about, "STEPS", "ConditionStep", &tables.steps);
    } else {
        glue.members.push(Member::list(about, "steps", "ConditionStep", &tables.steps));
        let tuned = parameters::apply(glue, "steps[");
        glue.init.push_str(&tuned);
    }
    if modes.moves_angles {
        let about = "Change of the target at that of the mode.";
        glue.members.push(Member::new(about, "change", "TargetChange", "TargetChange::NONE".to_owned()));
    }
    let exits = exits(modes);
    let _ = writeln!(
        glue.init,
        "    state.supervisor = ModeSupervisor::start(now, &mut state.modes, &mut {exits});"
    );
}

/// Returns the list of the ends.
fn exits(modes: &ModeSystem) -> &'static str {
    if modes.tables.exits.is_empty() { "[]" } else { "state.exits" }
}

/// Adds the functions that enter a mode by command, and that test the conditions.
pub fn add_functions(glue: &mut Glue<'_>, modes: &ModeSystem) {
    let (count, exits) = (modes.modes.len(), exits(modes));
    let ends_change = if modes.moves_angles { "    state.change.is_pending = false;\n" } else { "" };
    glue.call(
        "enter",
        &format!(
            "    let mode: usize = if input.mode < {count} && input.mode >= 0 {{ input.mode as usize }} else {{ 0 }};
    state.supervisor.enter(now, mode, &mut state.modes, &mut {exits});
    start_laws(state);
{ends_change}    output.mode = mode as i64;
"
        ),
    );
    glue.call("supervise", &supervise(glue, modes));
}

/// Returns an array of the inputs as a slice; angle and rate are those of the attitude filter if there is one.
fn array_argument(glue: &Glue<'_>, modes: &ModeSystem, quantity: FlightQuantity) -> String {
    let name = quantity.channel();
    if modes.inputs.channels.iter().any(|channel| channel.quantity == Some(quantity)) {
        return glue.input_list("supervise", name);
    }
    format!("&{name}")
}

/// Returns the value of a reading.
fn reading(glue: &Glue<'_>, modes: &ModeSystem, formula: &ReadingFormula) -> String {
    match formula {
        ReadingFormula::Input(name) => format!("input.{name}"),
        ReadingFormula::Flag(name) => format!("if input.{name} {{ 1.0 }} else {{ 0.0 }}"),
        ReadingFormula::OfFilter(ModeQuantity::FilterAge) => "state.estimator.age(now)".to_owned(),
        ReadingFormula::OfFilter(ModeQuantity::FilterInnovation) => {
            "state.estimator.innovation_size()".to_owned()
        }
        ReadingFormula::OfFilter(_) => "state.estimator.deviation_size(&state.entries)".to_owned(),
        ReadingFormula::Known(formula) => {
            let function = match formula {
                ModeFormula::Single | ModeFormula::Norm(_) => "norm",
                ModeFormula::Distance(..) => "distance",
                ModeFormula::LargestSize(_) => "largest_size",
            };
            let arrays: Vec<String> =
                formula.vectors().map(|vector| array_argument(glue, modes, vector)).collect();
            format!("mode_readings::{function}({})", arrays.join(", "))
        }
    }
}

/// Returns the arrays that the readings need beside the inputs: those of the attitude filter, and the stored momentum.
fn arrays(glue: &Glue<'_>, modes: &ModeSystem) -> String {
    let reads = |wanted: FlightQuantity| {
        modes.inputs.formulas.iter().any(|formula| match formula {
            ReadingFormula::Known(formula) => formula.vectors().any(|vector| vector == wanted),
            _ => false,
        })
    };
    let array =
        |name: &str, vector: &str| local("[f64; 3]", name, &format!("[{vector}.x, {vector}.y, {vector}.z]"));
    let reads_wheels = reads(FlightQuantity::StoredMomentum) && modes.stored.wheel_count() > 0;
    let has_filter = modes.estimator.is_some() && modes.moves_angles;
    let mut text = String::new();
    if has_filter {
        text += &attitude::attitudes();
        text += &local("Vector3", "rotation", "target.rotation_to(&attitude)");
        if reads(FlightQuantity::Angle) {
            text += &array("angle", "rotation");
        }
    }
    let reads_rate = has_filter && reads(FlightQuantity::Rate);
    if reads_wheels || reads_rate {
        let rate = if has_filter { attitude::RATE.to_owned() } else { vector_from("input.rate") };
        text += &local("Vector3", "estimated_rate", &rate);
    }
    if reads_rate {
        text += &array("rate", "estimated_rate");
    }
    if reads_wheels {
        text += &momentum::stored(glue, "supervise", &modes.stored, "estimated_rate");
        text += &array("stored_momentum", "stored");
    }
    text
}

/// Returns the statements that test the conditions.
fn supervise(glue: &Glue<'_>, modes: &ModeSystem) -> String {
    let formulas = &modes.inputs.formulas;
    let mut text = arrays(glue, modes);
    if !formulas.is_empty() {
        let count = formulas.len();
        let _ = writeln!(text, "    let mut readings: [f64; {count}] = [0.0; {count}];");
    }
    for (index, formula) in formulas.iter().enumerate() {
        let _ = writeln!(text, "    readings[{index}] = {};", reading(glue, modes, formula));
    }
    let readings = if formulas.is_empty() { "&[]" } else { "&readings" };
    let steps = if modes.tables.steps.is_empty() {
        "&[]"
    } else if parameters::thresholds(modes).is_empty() {
        "&STEPS"
    } else {
        "&state.steps"
    };
    let begin = "        state.change.begin(&target, &rotation);\n";
    let moved = if modes.moves_angles { begin } else { "" };
    let exits = exits(modes);
    text + &format!(
        "    let test: ModeTest = state.supervisor.test(now, {readings}, &mut state.modes, &mut {exits}, {steps});
    if test.has_changed {{
        start_laws(state);
{moved}    }}
    let due: ModeDue = state.supervisor.due(&state.modes, &{exits});
    let period: Ticks = state.modes[state.supervisor.active].period;
    output.mode = state.supervisor.active as i64;
    output.has_changed = test.has_changed;
    output.is_chattering = test.is_chattering;
    output.has_next = due.has_time;
    output.next_whole = due.time.whole;
    output.next_part = due.time.part;
    output.period_whole = period.whole;
    output.period_part = period.part;
"
    )
}
