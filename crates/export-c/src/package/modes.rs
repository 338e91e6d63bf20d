//! Types and functions of an exported control system with modes of operation: a supervisor, and the laws of each mode.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use flexsc_core::control::flight_quantity::FlightQuantity;
use flexsc_core::control::operation::{ModeFormula, ModeQuantity};

use super::initialiser::initialiser;
use super::signature::{has_time, init_signature, signature};
use super::{Plan, actuation_calls, b_dot_calls, calls, estimator_calls, header, momentum_calls, parameters};
use crate::control_system::{CallLayout, Channel, ControlSystem, ModeSystem, ReadingFormula, SampledLaws};

/// Laws of one mode as a control system of their own.
struct ModePart {
    /// Index of the mode.
    index: usize,
    /// Name of the mode in C.
    name: String,
    system: ControlSystem,
    layout: CallLayout,
}

/// Returns the laws of all modes that read estimates.
fn mode_parts(modes: &ModeSystem) -> Vec<ModePart> {
    let each = modes.modes.iter().enumerate().filter_map(|(index, mode)| {
        let laws = mode.start.on_estimates()?.clone();
        let (name, layout) = (mode.name.clone(), laws.layout());
        Some(ModePart { index, name, system: ControlSystem::Sampled(Box::new(laws)), layout })
    });
    each.collect()
}

/// Returns the control systems of the laws of all modes that read estimates.
pub fn systems(modes: &ModeSystem) -> Vec<ControlSystem> {
    mode_parts(modes).into_iter().map(|part| part.system).collect()
}

/// Returns the structs of the laws of each mode, and that of the state.
pub fn state(plan: &Plan<'_>, modes: &ModeSystem) -> String {
    let (prefix, mut text) = (plan.prefix, String::new());
    let parts = mode_parts(modes);
    for part in &parts {
        let own = Plan {
            system: &part.system,
            calls: std::slice::from_ref(&part.layout),
            mode: Some(&part.name),
            ..*plan
        };
        let written = header::state(&own);
        let head = "/* State of the control system, which its functions change. */";
        let written = written.replace(head, &format!("/* Laws of the mode `{}`. */", part.name));
        text.push_str(&renamed(&written, prefix, &part.name));
        for (channels, kind) in [(&part.layout.inputs, "input"), (&part.layout.outputs, "output")] {
            let _ = writeln!(text, "/* {kind}s of these laws. */");
            header::members(channels, &format!("{prefix}_law_{}_step_{kind}", part.name), &mut text);
        }
    }
    text.push_str("/* State of the control system, which its functions change. */\ntypedef struct {\n");
    let mut member = |about: &str, type_name: &str, name: &str| {
        let _ = writeln!(text, "    /* {about} */\n    {} {name};", plan.type_name(type_name));
    };
    member("Supervisor of the modes.", "ModeSupervisor", "supervisor");
    member("Modes.", "SupervisedMode", &format!("modes[{}]", modes.tables.modes.len()));
    if !modes.tables.exits.is_empty() {
        member("Ends of the modes.", "SupervisedExit", &format!("exits[{}]", modes.tables.exits.len()));
    }
    if !parameters::thresholds(modes).is_empty() {
        member(
            "Comparisons of their conditions.",
            "ConditionStep",
            &format!("steps[{}]", modes.tables.steps.len()),
        );
    }
    for (about, name, declared) in modes.estimator.iter().flat_map(estimator_calls::members) {
        member(about, name, &declared);
    }
    if modes.field.is_some() {
        member("Rate of change of the magnetic field.", "FieldRate", "field");
        member("Moment of the magnetorquers (A m^2).", "Vector3", "moment");
    }
    if modes.moves_angles {
        member("Angle from the target of the mode before, at a change.", "Vector3", "moved_angle");
        member("Target of the mode before.", "Quaternion", "moved_from");
        text.push_str("    /* True from a change on to the next step. */\n    bool has_moved;\n");
    }
    actuation_calls::members(plan, &modes.actuation, &mut text);
    header::member_of_parameters(plan, &mut text);
    for ModePart { name, .. } in &parts {
        let _ =
            writeln!(text, "    /* Laws of the mode `{name}`. */\n    {prefix}_law_{name}_state law_{name};");
    }
    let _ = writeln!(text, "}} {prefix}_state;\n");
    text
}

/// Returns the lists of the supervisor and the functions.
pub fn functions(plan: &Plan<'_>, modes: &ModeSystem) -> String {
    let (parts, mut text) = (mode_parts(modes), String::new());
    for part in &parts {
        let own = Plan {
            system: &part.system,
            calls: std::slice::from_ref(&part.layout),
            mode: Some(&part.name),
            ..*plan
        };
        let written = calls::functions(&own);
        let static_ones: Vec<String> = written
            .lines()
            .map(|line| if line.starts_with("void ") { format!("static {line}") } else { line.to_owned() })
            .collect();
        let _ = writeln!(text, "/* Laws of the mode `{}`. */\n", part.name);
        text.push_str(&renamed(&static_ones.join("\n"), plan.prefix, &part.name));
        text.push_str("\n\n");
    }
    lists(plan, modes, &mut text);
    actuation_calls::constants(plan, &modes.actuation, &mut text);
    if let Some(unit) = &modes.estimator {
        estimator_calls::start(plan, unit, &mut text);
    }
    init(plan, modes, &parts, &mut text);
    if let Some(unit) = &modes.estimator {
        estimator_calls::functions(plan, unit, &mut text);
    }
    b_dot_calls::sample(plan, &mut text);
    enter(plan, modes, &mut text);
    supervise(plan, modes, &mut text);
    let detumbling = modes.modes.iter().enumerate().filter(|(_, mode)| mode.start.b_dot().is_some());
    let detumbling: Vec<String> =
        detumbling.map(|(mode, _)| format!("state->supervisor.active == {mode}")).collect();
    let held = detumbling.join(" || ");
    let held = Some(held.as_str()).filter(|held| !held.is_empty());
    let entries = modes.estimator.as_ref().map(|unit| unit.entries.len());
    let unloading =
        actuation_calls::UnloadedWheels { actuation: &modes.actuation, stored: &modes.stored, entries };
    actuation_calls::unload(plan, &unloading, held, &mut text);
    step(plan, modes, &parts, &mut text);
    text.insert_str(0, &momentum_calls::constants(plan, &modes.stored, &text));
    text
}

/// Writes the lists of modes, ends and comparisons.
fn lists(plan: &Plan<'_>, modes: &ModeSystem, text: &mut String) {
    let prefix = plan.prefix;
    let tables = &modes.tables;
    let mut list = |about: &str, type_name: &str, name: &str, rows: Vec<String>| {
        if !rows.is_empty() {
            let _ = writeln!(
                text,
                "/* {about} */\nstatic const {} {name}[{}] = {{\n    {}\n}};\n",
                plan.type_name(type_name),
                rows.len(),
                rows.join(",\n    ")
            );
        }
    };
    let rows = tables.modes.iter().map(|mode| initialiser(mode, prefix)).collect();
    list(&format!("Modes: {}.", tables.names.join(", ")), "SupervisedMode", "mode_list", rows);
    let rows = tables.exits.iter().map(|exit| initialiser(exit, prefix)).collect();
    list("Ends of the modes.", "SupervisedExit", "exit_list", rows);
    let rows = tables.steps.iter().map(|step| initialiser(step, prefix)).collect();
    list("Comparisons of their conditions.", "ConditionStep", "step_list", rows);
}

/// Returns a list as two arguments of a call.
fn list_argument(name: &str, count: usize) -> String {
    if count == 0 { "NULL, 0".to_owned() } else { format!("{name}, {count}") }
}

/// Returns the list of comparisons: that of the state if their limits are parameters.
fn step_list(modes: &ModeSystem) -> &'static str {
    if parameters::thresholds(modes).is_empty() { "step_list" } else { "state->steps" }
}

/// Returns the further argument with which the laws of a mode start: their parameters, if they have any.
fn law_argument(part: &ModePart) -> &'static str {
    match &part.system {
        ControlSystem::Sampled(laws) if parameters::has_law_parameters(laws) => ", &state->parameters",
        _ => "",
    }
}

/// Returns the modes and the ends as arguments.
fn mode_arguments(modes: &ModeSystem) -> String {
    let exits = list_argument("state->exits", modes.tables.exits.len());
    format!("state->modes, {}, {exits}", modes.tables.modes.len())
}

/// Writes the function that sets the state, and the one that starts the laws of the present mode.
fn init(plan: &Plan<'_>, modes: &ModeSystem, parts: &[ModePart], text: &mut String) {
    let prefix = plan.prefix;
    let _ = writeln!(text, "{}\n{{\n    memset(state, 0, sizeof *state);", init_signature(plan));
    parameters::init(plan, modes.actuation.unloading.is_some(), text);
    if modes.estimator.is_some() {
        let identity = format!("({prefix}_quaternion){{ .w = 1.0, .x = 0.0, .y = 0.0, .z = 0.0 }}");
        let zero = format!("({prefix}_vector3){{ .x = 0.0, .y = 0.0, .z = 0.0 }}");
        let _ = writeln!(text, "    start_filter(state, now, {identity}, {zero});");
    }
    if let Some(unit) = &modes.field {
        let field = initialiser(&unit.field, prefix);
        let _ = writeln!(text, "    state->field = ({prefix}_field_rate){field};");
    }
    text.push_str("    memcpy(state->modes, mode_list, sizeof state->modes);\n");
    if !modes.tables.exits.is_empty() {
        text.push_str("    memcpy(state->exits, exit_list, sizeof state->exits);\n");
    }
    let thresholds = parameters::thresholds(modes);
    if !thresholds.is_empty() {
        text.push_str("    memcpy(state->steps, step_list, sizeof state->steps);\n");
    }
    for (step, name) in thresholds {
        let _ = writeln!(text, "    state->steps[{step}].limit = state->parameters.{name};");
    }
    let _ = writeln!(text, "    state->supervisor = mode_supervisor_start(now, {});", mode_arguments(modes));
    actuation_calls::init(plan, &modes.actuation, text);
    for part in parts {
        let (name, argument) = (&part.name, law_argument(part));
        let _ = writeln!(text, "    {prefix}_law_{name}_init(&state->law_{name}{argument});");
    }
    text.push_str("}\n\n");
    let _ = writeln!(
        text,
        "/* Starts the laws of the present mode without a past. */\nstatic void start_laws({prefix}_state *state)\n{{\n    \
         switch (state->supervisor.active) {{"
    );
    for part in parts {
        let (index, name, argument) = (part.index, &part.name, law_argument(part));
        let _ = writeln!(
            text,
            "    case {index}:\n        {prefix}_law_{name}_init(&state->law_{name}{argument});\n        break;"
        );
    }
    text.push_str("    default:\n        break;\n    }\n}\n\n");
}

/// Writes the function that enters a mode by command.
fn enter(plan: &Plan<'_>, modes: &ModeSystem, text: &mut String) {
    let count = modes.modes.len();
    let _ = writeln!(
        text,
        "{}\n{{\n    const size_t mode = input->mode < {count} && input->mode >= 0 ? (size_t)input->mode : 0;\n    \
         mode_supervisor_enter(&state->supervisor, now, mode, {});\n    start_laws(state);\n{}    output->mode = (int64_t)mode;\n}}\n",
        signature(plan, &plan.calls[modes.call_index("enter")]),
        mode_arguments(modes),
        if modes.moves_angles { "    state->has_moved = false;\n" } else { "" },
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

/// Writes the function that tests the conditions.
fn supervise(plan: &Plan<'_>, modes: &ModeSystem, text: &mut String) {
    let prefix = plan.prefix;
    let (formulas, entries) =
        (&modes.inputs.formulas, modes.estimator.as_ref().map(|unit| unit.entries.len()));
    let _ = writeln!(text, "{}\n{{", signature(plan, &plan.calls[modes.call_index("supervise")]));
    let reads = |wanted: FlightQuantity| {
        formulas.iter().any(|formula| match formula {
            ReadingFormula::Known(formula) => formula.vectors().any(|vector| vector == wanted),
            _ => false,
        })
    };
    let reads_wheels = reads(FlightQuantity::StoredMomentum) && modes.stored.wheel_count() > 0;
    if let Some(entries) = entries.filter(|_| modes.moves_angles) {
        let _ = writeln!(
            text,
            "    const {prefix}_quaternion target = {{ .w = input->target_attitude[0], .x = input->target_attitude[1], .y = input->target_attitude[2], .z = input->target_attitude[3] }};\n    \
             const {prefix}_quaternion attitude = attitude_estimator_attitude(&state->estimator, now, state->entries, {entries});\n    \
             const {prefix}_vector3 rotation = quaternion_rotation_to(&target, &attitude);"
        );
        if reads(FlightQuantity::Angle) {
            text.push_str("    const double angle[3] = { rotation.x, rotation.y, rotation.z };\n");
        }
        if reads(FlightQuantity::Rate) || reads_wheels {
            let _ = writeln!(
                text,
                "    const {prefix}_vector3 estimated_rate = attitude_estimator_rate(&state->estimator, state->entries, {entries});\n    \
                 const double rate[3] = {{ estimated_rate.x, estimated_rate.y, estimated_rate.z }};"
            );
        }
    }
    if reads_wheels {
        if !modes.moves_angles {
            let _ = writeln!(
                text,
                "    const {prefix}_vector3 estimated_rate = {{ .x = input->rate[0], .y = input->rate[1], .z = input->rate[2] }};"
            );
        }
        momentum_calls::declaration(plan, &modes.stored, "estimated_rate", text);
        text.push_str("    const double stored_momentum[3] = { stored.x, stored.y, stored.z };\n");
    }
    if modes.inputs.channels.is_empty() {
        text.push_str("    (void)input;\n");
    }
    if !formulas.is_empty() {
        let _ = writeln!(text, "    double readings[{}];\n", formulas.len());
    }
    for (index, formula) in formulas.iter().enumerate() {
        let value = match formula {
            ReadingFormula::Input(name) => format!("input->{name}"),
            ReadingFormula::Flag(name) => format!("input->{name} ? 1.0 : 0.0"),
            ReadingFormula::OfFilter(quantity) => {
                let entries = entries.unwrap_or(0);
                match quantity {
                    ModeQuantity::FilterAge => "attitude_estimator_age(&state->estimator, now)".to_owned(),
                    ModeQuantity::FilterInnovation => {
                        "attitude_estimator_innovation_size(&state->estimator)".to_owned()
                    }
                    _ => format!(
                        "attitude_estimator_deviation_size(&state->estimator, state->entries, {entries})"
                    ),
                }
            }
            ReadingFormula::Known(formula) => {
                let function = match formula {
                    ModeFormula::Single | ModeFormula::Norm(_) => "norm",
                    ModeFormula::Distance(..) => "distance",
                    ModeFormula::LargestSize(_) => "largest_size",
                };
                let arrays: Vec<String> =
                    formula.vectors().map(|vector| array_argument(modes, vector)).collect();
                format!("mode_readings_{function}({})", arrays.join(", "))
            }
        };
        let _ = writeln!(text, "    readings[{index}] = {value};");
    }
    let arguments = mode_arguments(modes);
    let moved = if modes.moves_angles {
        "        state->moved_angle = rotation;\n        state->moved_from = target;\n        state->has_moved = true;\n"
    } else {
        ""
    };
    let _ = writeln!(
        text,
        "    const {prefix}_mode_test test = mode_supervisor_test(&state->supervisor, now, {}, {arguments}, {});\n    \
         if (test.has_changed) {{\n        start_laws(state);\n{moved}    }}\n    \
         const {prefix}_mode_due due = mode_supervisor_due(&state->supervisor, {arguments});\n    \
         const {prefix}_ticks period = state->modes[state->supervisor.active].period;\n    \
         output->mode = (int64_t)state->supervisor.active;\n    output->has_changed = test.has_changed;\n    \
         output->is_chattering = test.is_chattering;\n    output->has_next = due.has_time;\n    \
         output->next_whole = due.time.whole;\n    output->next_part = due.time.part;\n    \
         output->period_whole = period.whole;\n    output->period_part = period.part;\n}}\n",
        list_argument("readings", formulas.len()),
        list_argument(step_list(modes), modes.tables.steps.len()),
    );
}

/// Writes the function that decides by the laws of the present mode.
fn step(plan: &Plan<'_>, modes: &ModeSystem, parts: &[ModePart], text: &mut String) {
    let prefix = plan.prefix;
    let _ = writeln!(text, "{}\n{{", signature(plan, &plan.calls[modes.call_index("step")]));
    let filter = modes.estimator.as_ref();
    if let Some(unit) = filter {
        let moved = if modes.moves_angles {
            format!(
                "    if (state->has_moved) {{\n        /* at a change the angles move from one target to the other */\n        \
                 const {prefix}_vector3 shift = quaternion_rotation_to(&target, &state->moved_from);\n        \
                 angle.x = state->moved_angle.x + shift.x;\n        angle.y = state->moved_angle.y + shift.y;\n        \
                 angle.z = state->moved_angle.z + shift.z;\n        state->has_moved = false;\n    }}\n"
            )
        } else {
            String::new()
        };
        let _ = writeln!(
            text,
            "    const {prefix}_quaternion target = {{ .w = input->target_attitude[0], .x = input->target_attitude[1], .y = input->target_attitude[2], .z = input->target_attitude[3] }};\n    \
             const {prefix}_quaternion attitude = attitude_estimator_attitude(&state->estimator, now, state->entries, {entries});\n    \
             {prefix}_vector3 angle = quaternion_rotation_to(&target, &attitude);\n{moved}    \
             const {prefix}_vector3 rate = attitude_estimator_rate(&state->estimator, state->entries, {entries});",
            entries = unit.entries.len()
        );
    }
    let inner_time = |part: &ModePart| has_time(&Plan { system: &part.system, ..*plan });
    if filter.is_none() && modes.field.is_none() && !parts.iter().any(inner_time) {
        text.push_str("    (void)now;\n");
    }
    if parts.is_empty() {
        text.push_str("    (void)input;\n");
    }
    text.push_str("    memset(output, 0, sizeof *output);\n");
    if modes.actuation.wheels.is_some() {
        let _ = writeln!(text, "    {prefix}_vector3 torque = {{ .x = 0.0, .y = 0.0, .z = 0.0 }};");
    }
    if modes.field.is_some() && modes.clears_moment {
        let _ = writeln!(text, "    state->moment = ({prefix}_vector3){{ .x = 0.0, .y = 0.0, .z = 0.0 }};");
    }
    text.push_str("    switch (state->supervisor.active) {\n");
    b_dot_cases(plan, modes, text);
    for part in parts {
        let name = &part.name;
        let _ = writeln!(
            text,
            "    case {}: {{\n        {prefix}_law_{name}_step_input own;\n        {prefix}_law_{name}_step_output decided;",
            part.index
        );
        for channel in &part.layout.inputs {
            match (channel.name.as_str(), channel.count) {
                ("angle" | "rate", _) if filter.is_some() => {
                    for (axis, component) in ["x", "y", "z"].into_iter().enumerate() {
                        let _ = writeln!(text, "        own.{0}[{axis}] = {0}.{component};", channel.name);
                    }
                }
                (input, 1) => {
                    let _ = writeln!(text, "        own.{input} = input->{input};");
                }
                (input, _) => {
                    let _ =
                        writeln!(text, "        memcpy(own.{input}, input->{input}, sizeof own.{input});");
                }
            }
        }
        let now = if inner_time(part) { "now, " } else { "" };
        let _ = writeln!(text, "        {prefix}_law_{name}_step(&state->law_{name}, {now}&own, &decided);");
        for channel in &part.layout.outputs {
            let output = &channel.name;
            let _ = if channel.count == 1 {
                writeln!(text, "        output->{output} = decided.{output};")
            } else {
                writeln!(text, "        memcpy(output->{output}, decided.{output}, sizeof decided.{output});")
            };
        }
        let mode = &modes.modes[part.index];
        let is_change = mode.start.on_estimates().is_some_and(SampledLaws::commands_changes);
        if mode.drives_wheels && modes.actuation.wheels.is_some() {
            for (axis, component) in ["x", "y", "z"].into_iter().enumerate() {
                let _ = writeln!(text, "        torque.{component} = decided.torque[{axis}];");
            }
        }
        if mode.fires_jets {
            actuation_calls::jets(&modes.actuation, is_change, "        ", "decided.", text);
        }
        text.push_str("        break;\n    }\n");
    }
    text.push_str("    default:\n        break;\n    }\n");
    let components = ["torque.x", "torque.y", "torque.z"];
    actuation_calls::wheels(plan, &modes.actuation, |axis| components[axis].to_owned(), text);
    if modes.field.is_some() {
        actuation_calls::moment_output("state->moment", text);
    }
    text.push_str("    output->mode = (int64_t)state->supervisor.active;\n}\n");
}

/// Writes the decisions of B-dot laws, which end the unloading by magnetorquers.
fn b_dot_cases(plan: &Plan<'_>, modes: &ModeSystem, text: &mut String) {
    let prefix = plan.prefix;
    for (index, laws) in
        modes.modes.iter().enumerate().filter_map(|(index, mode)| Some((index, mode.start.b_dot()?)))
    {
        let _ = writeln!(
            text,
            "    case {index}: {{\n        const {prefix}_vector3 field_rate = {};",
            b_dot_calls::CURRENT_RATE
        );
        for (axis, component) in ["x", "y", "z"].into_iter().enumerate() {
            let moment = b_dot_calls::moment(plan, laws, Some(&modes.modes[index].name), axis);
            let _ = writeln!(text, "        state->moment.{component} = {moment};");
        }
        if modes.actuation.unloads_by_magnetorquers() {
            let _ = writeln!(
                text,
                "        state->unloading.is_active = false;\n        state->counter = ({prefix}_vector3){{ .x = 0.0, .y = 0.0, .z = 0.0 }};"
            );
        }
        text.push_str("        break;\n    }\n");
    }
}

/// Returns text in which the names of a control system's own are those of the laws of a mode.
fn renamed(text: &str, prefix: &str, mode: &str) -> String {
    let own = ["state", "init", "step", "step_input", "step_output"];
    let mut names: BTreeMap<String, String> = own
        .into_iter()
        .map(|name| (format!("{prefix}_{name}"), format!("{prefix}_law_{mode}_{name}")))
        .collect();
    for constant in text.lines().filter_map(|line| line.strip_prefix("static const ")) {
        let declared = constant.split(" =").next().unwrap_or_default().split('[').next().unwrap_or_default();
        if let Some(name) = declared.split_whitespace().last() {
            names.insert(name.to_owned(), format!("{name}_{mode}"));
        }
    }
    let is_part = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    let mut result = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(start) = rest.find(is_part) {
        let (before, from_word) = rest.split_at(start);
        let end = from_word.find(|letter| !is_part(letter)).unwrap_or(from_word.len());
        let (word, after) = from_word.split_at(end);
        // A member of a struct is no name of the control system's own.
        let is_member = before.ends_with('.') || before.ends_with("->");
        result.push_str(before);
        result.push_str(names.get(word).filter(|_| !is_member).map_or(word, String::as_str));
        rest = after;
    }
    result.push_str(rest);
    result
}
