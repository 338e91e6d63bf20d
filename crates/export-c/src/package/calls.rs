//! Functions of an exported control system: their signatures and bodies.

use std::fmt::Write as _;

use flexsc_core::numerics::attitude::AXES;
use flexsc_flight::gain_schedule::SchedulePoint;

use super::initialiser::initialiser;
use super::signature::{about, signature};
use super::{
    Plan, actuation_calls, b_dot_calls, compensator_calls, estimator_calls, kalman_calls, momentum_calls,
    parameters, rate_calls,
};
use crate::control_system::{ControlSystem, LawsOfAxes, Relays, SampledLaws};

/// Returns the constants and the functions.
pub fn functions(plan: &Plan<'_>) -> String {
    let mut text = String::new();
    match plan.system {
        ControlSystem::Relays(relays) => of_relays(plan, relays, &mut text),
        ControlSystem::Sampled(laws) => {
            of_laws(plan, laws, &mut text);
            // Laws of modes have those of the whole control system.
            if plan.mode.is_none() {
                text.insert_str(0, &momentum_calls::constants(plan, &laws.stored, &text));
            }
        }
        ControlSystem::BDot(laws) => b_dot_calls::functions(plan, laws, &mut text),
        // The laws of each mode are a control system of their own.
        ControlSystem::Modes(_) => {}
    }
    text
}

/// Writes the functions of relays.
fn of_relays(plan: &Plan<'_>, relays: &Relays, text: &mut String) {
    let (prefix, axes) = (plan.prefix, relays.axes.len());
    let upper = prefix.to_uppercase();
    let _ = writeln!(text, "void {prefix}_init({prefix}_state *state)\n{{");
    for (axis, relay) in relays.axes.iter().enumerate() {
        let member = about("relay", axis, axes);
        let value = initialiser(relay, prefix);
        let _ = writeln!(text, "    state->{member} = ({prefix}_polled_relay){value};");
    }
    let _ = writeln!(text, "}}\n");
    let pointer = if axes == 1 {
        "&state->relay".to_owned()
    } else {
        format!("&state->relay[input->axis < {axes} && input->axis >= 0 ? input->axis : 0]")
    };
    let _ = writeln!(
        text,
        "{}\n{{\n    {prefix}_polled_relay *relay = {pointer};\n    {prefix}_relay_event event = {upper}_RELAY_EVENT_TIMEOUT;\n    \
         if (input->event == 0) {{\n        event = {upper}_RELAY_EVENT_START;\n    }} else if (input->event == 1) {{\n        \
         event = {upper}_RELAY_EVENT_FIRST_GUARD;\n    }} else if (input->event == 2) {{\n        \
         event = {upper}_RELAY_EVENT_SECOND_GUARD;\n    }}\n    relay->has_started = true;\n    \
         relay->command = relay_law_decide(&relay->law, now, event, input->angle);\n    \
         output->torque = relay->command.torque;\n    output->has_timeout = relay->command.has_timeout;\n    \
         output->until_whole = relay->command.until.whole;\n    output->until_part = relay->command.until.part;\n    \
         output->guard_count = (int64_t)relay->command.guard_count;\n    for (size_t guard = 0; guard < 2; ++guard) {{\n        \
         output->guard_is_lower[guard] = relay->command.guards[guard].side == {upper}_GUARD_DIRECTION_AT_MOST;\n        \
         output->guard_level[guard] = relay->command.guards[guard].level;\n    }}\n}}\n",
        signature(plan, &plan.calls[0])
    );
    let _ = writeln!(text, "{}\n{{", signature(plan, &plan.calls[1]));
    for axis in 0..axes {
        let [torque, relay, angle] = ["torque", "relay", "angle"].map(|name| about(name, axis, axes));
        let _ =
            writeln!(text, "    output->{torque} = polled_relay_step(&state->{relay}, now, input->{angle});");
    }
    text.push_str("}\n");
}

/// Writes the constants and functions of laws that decide at their period.
fn of_laws(plan: &Plan<'_>, laws: &SampledLaws, text: &mut String) {
    let (prefix, axes) = (plan.prefix, laws.axis_count());
    constants(plan, laws, text);
    if let Some(unit) = &laws.estimator {
        estimator_calls::start(plan, unit, text);
    }
    if let Some(unit) = &laws.filter {
        kalman_calls::start(plan, unit, text);
    }
    let has_parameters = parameters::has_law_parameters(laws);
    let given = if has_parameters && plan.mode.is_some() {
        format!(", const {prefix}_parameters *parameters")
    } else {
        String::new()
    };
    let _ = writeln!(text, "void {prefix}_init({prefix}_state *state{given})\n{{");
    let is_zeroed = laws.estimator.is_some() || matches!(laws.laws, LawsOfAxes::StateSpace(_));
    if is_zeroed {
        text.push_str("    memset(state, 0, sizeof *state);\n");
    }
    parameters::init(plan, has_parameters || laws.actuation.unloading.is_some(), text);
    if laws.estimator.is_some() {
        let identity = format!("({prefix}_quaternion){{ .w = 1.0, .x = 0.0, .y = 0.0, .z = 0.0 }}");
        let zero = format!("({prefix}_vector3){{ .x = 0.0, .y = 0.0, .z = 0.0 }}");
        let _ = writeln!(
            text,
            "    start_filter(state, ({prefix}_ticks){{ .whole = 0, .part = 0 }}, {identity}, {zero});"
        );
    }
    if let Some(unit) = &laws.filter {
        kalman_calls::init(unit, text);
    }
    let mut set = |member: String, type_name: &str, value: String| {
        let _ = writeln!(text, "    state->{member} = ({prefix}_{type_name}){value};");
    };
    for axis in 0..axes {
        let member = about("law", axis, axes);
        match &laws.laws {
            LawsOfAxes::StateSpace(_) => {}
            LawsOfAxes::Pd(own) => {
                let value = initialiser(&own[axis].0, prefix);
                set(member, "pd_law", parameters::tuned(plan, laws, axis, value));
            }
            LawsOfAxes::PhasePlane(own, _) => set(member, "phase_plane_law", initialiser(&own[axis], prefix)),
            LawsOfAxes::Attitude(own) => {
                let value = initialiser(&own[axis].0, prefix);
                set(member, "attitude_feedback", parameters::tuned(plan, laws, axis, value));
                for (index, filter) in own[axis].1.iter().enumerate() {
                    set(format!("filters[{axis}][{index}]"), "biquad_filter", initialiser(filter, prefix));
                }
            }
        }
    }
    for (axis, filter) in laws.rate_filter.iter().flat_map(|unit| &unit.axes).enumerate() {
        set(about("rate_filter", axis, axes), "rigid_rate_filter", initialiser(filter, prefix));
    }
    actuation_calls::init(plan, &laws.actuation, text);
    text.push_str("}\n\n");
    if let Some(unit) = &laws.estimator {
        estimator_calls::functions(plan, unit, text);
    }
    if let Some(unit) = &laws.filter {
        kalman_calls::functions(plan, unit, text);
    }
    if let Some(unit) = &laws.rate_filter {
        rate_calls::sample(plan, unit, text);
    }
    unload(plan, laws, text);
    let _ = writeln!(text, "{}\n{{", signature(plan, &plan.calls[laws.step_index()]));
    if let Some(unit) = &laws.estimator {
        let _ = writeln!(
            text,
            "    const {prefix}_quaternion target = {{ .w = input->target_attitude[0], .x = input->target_attitude[1], .y = input->target_attitude[2], .z = input->target_attitude[3] }};\n    \
             const {prefix}_quaternion attitude = attitude_estimator_attitude(&state->estimator, now, state->entries, {entries});\n    \
             const {prefix}_vector3 angle = quaternion_rotation_to(&target, &attitude);\n    \
             const {prefix}_vector3 rate = attitude_estimator_rate(&state->estimator, state->entries, {entries});",
            entries = unit.entries.len()
        );
    }
    if let LawsOfAxes::StateSpace(own) = &laws.laws {
        let estimate = |name: &str, axis: usize| estimate(laws, name, axis);
        if laws.is_together() {
            compensator_calls::step_together(plan, &own[0], laws.speed_count(), estimate, text);
        } else {
            for (axis, law) in own.iter().enumerate() {
                compensator_calls::step_about(plan, law, (axis, axes), estimate, text);
            }
        }
    } else {
        steps(plan, laws, text);
    }
    if laws.is_acceleration() {
        torque(plan, laws, text);
    }
    actuation_calls::wheels(plan, &laws.actuation, |axis| format!("output->torque[{axis}]"), text);
    if laws.actuation.jets.is_some() {
        text.push_str("\n    /* pulses of the jets */\n");
        actuation_calls::jets(&laws.actuation, laws.commands_changes(), "    ", "output->", text);
    }
    text.push_str("}\n");
}

/// Writes the function that unloads the wheels.
fn unload(plan: &Plan<'_>, laws: &SampledLaws, text: &mut String) {
    let unloading = actuation_calls::UnloadedWheels {
        actuation: &laws.actuation,
        stored: &laws.stored,
        entries: laws.estimator.as_ref().map(|unit| unit.entries.len()),
    };
    actuation_calls::unload(plan, &unloading, None, text);
}

/// Writes the steps of the laws about the axes.
fn steps(plan: &Plan<'_>, laws: &SampledLaws, text: &mut String) {
    let (prefix, axes) = (plan.prefix, laws.axis_count());
    if axes == 3 {
        let [roll, pitch, yaw] = [0, 1, 2].map(|axis| estimate(laws, "angle", axis));
        let _ =
            writeln!(text, "    const double total_angle = axis_motion_total_angle({roll}, {pitch}, {yaw});");
    }
    let _ = writeln!(text, "    {prefix}_axis_motion motion;\n    {prefix}_axis_reference reference;");
    if laws.mode_count() > 0 {
        let _ = writeln!(text, "    {prefix}_elastic_rate_estimate modes[{}];", laws.mode_count());
    }
    for axis in 0..axes {
        step_about(plan, laws, axis, text);
    }
}

/// Returns the estimated angle or rate about an axis: a component of the filter's estimate, or an input.
fn estimate(laws: &SampledLaws, name: &str, axis: usize) -> String {
    if laws.estimator.is_some() {
        format!("{name}.{}", ["x", "y", "z"][axis])
    } else if laws.filter.is_some() {
        format!("state->{}.{name}", about("estimate", axis, laws.axis_count()))
    } else if laws.rate_filter.is_some() && name == "rate" {
        format!("state->{}.rate", about("rate_filter", axis, laws.axis_count()))
    } else {
        format!("input->{}", about(name, axis, laws.axis_count()))
    }
}

/// Writes the constants: gain schedules, inertia.
fn constants(plan: &Plan<'_>, laws: &SampledLaws, text: &mut String) {
    let prefix = plan.prefix;
    if let LawsOfAxes::Pd(own) = &laws.laws {
        for (axis, (_, points)) in own.iter().enumerate().filter(|(_, (_, points))| !points.is_empty()) {
            let values: Vec<String> = points
                .iter()
                .map(|point: &SchedulePoint| format!("    {}", initialiser(point, prefix)))
                .collect();
            let _ = writeln!(
                text,
                "/* Gain of the extra loop over the frequency of the mode. */\nstatic const {prefix}_schedule_point schedule_{axis}[{}] = {{\n{}\n}};\n",
                points.len(),
                values.join(",\n")
            );
        }
    }
    actuation_calls::constants(plan, &laws.actuation, text);
    if let LawsOfAxes::StateSpace(own) = &laws.laws {
        compensator_calls::constants(plan, own, text);
    }
    if laws.is_acceleration() {
        let _ = writeln!(
            text,
            "/* Inertia tensor (kg m^2), without that of the rotors about their own axes, whose momentum is absolute. */\nstatic const {prefix}_matrix3 inertia = {};\n",
            initialiser(&laws.inertia, prefix)
        );
    }
}

/// Writes the step of the law about an axis.
fn step_about(plan: &Plan<'_>, laws: &SampledLaws, axis: usize, text: &mut String) {
    let (prefix, axes) = (plan.prefix, laws.axis_count());
    let input = |name: &str| format!("input->{}", about(name, axis, axes));
    let given = |is_read: bool, name: &str| if is_read { input(name) } else { "0.0".to_owned() };
    if axes == 3 {
        let _ = writeln!(text, "\n    /* {} */", AXES[axis]);
    }
    let total = if axes == 3 { "total_angle" } else { "0.0" };
    // A mode is an input, or an estimate of the filter.
    let mode = |name: &str| match &laws.filter {
        _ if !laws.reads_mode() => "0.0".to_owned(),
        Some(unit) if name == "frequency" => initialiser(&unit.axes[axis].frequency, prefix),
        Some(_) => estimate(laws, name, axis),
        None => input(name),
    };
    let is_phase_plane = matches!(laws.laws, LawsOfAxes::PhasePlane(..));
    let _ = writeln!(
        text,
        "    motion = ({prefix}_axis_motion){{ .angle = {}, .total_angle = {total}, .rate = {}, .queued_rate = {},\n        \
         .displacement = {}, .displacement_rate = {}, .frequency = {} }};",
        estimate(laws, "angle", axis),
        estimate(laws, "rate", axis),
        given(is_phase_plane, "queued_rate"),
        mode("displacement"),
        mode("displacement_rate"),
        mode("frequency"),
    );
    let is_attitude = matches!(laws.laws, LawsOfAxes::Attitude(_));
    let _ = writeln!(
        text,
        "    reference = ({prefix}_axis_reference){{ .angle = {}, .rate = {}, .acceleration = {} }};",
        input("reference_angle"),
        input("reference_rate"),
        given(is_attitude, "reference_acceleration"),
    );
    let law = format!("&state->{}", about("law", axis, axes));
    match &laws.laws {
        // They have steps of their own.
        LawsOfAxes::StateSpace(_) => {}
        LawsOfAxes::Pd(own) => {
            let points = own[axis].1.len();
            let schedule = if points == 0 { "NULL".to_owned() } else { format!("schedule_{axis}") };
            let torque = about("torque", axis, axes);
            let _ = writeln!(
                text,
                "    output->{torque} = pd_law_step({law}, &motion, &reference, {schedule}, {points});"
            );
        }
        LawsOfAxes::PhasePlane(_, modes) => {
            for mode in 0..*modes {
                let index = axis * modes + mode;
                let member =
                    |name: &str| if axes * modes == 1 { name.to_owned() } else { format!("{name}[{index}]") };
                let _ = writeln!(
                    text,
                    "    modes[{mode}] = ({prefix}_elastic_rate_estimate){{ .rate = input->{}, .frequency = input->{}, .influence = input->{} }};",
                    member("mode_rate"),
                    member("mode_frequency"),
                    member("mode_influence"),
                );
            }
            let list = if *modes == 0 {
                "NULL, 0, false".to_owned()
            } else {
                format!("modes, {modes}, {}", input("modes_are_trusted"))
            };
            let change = about("rate_change", axis, axes);
            let _ = writeln!(
                text,
                "    output->{change} = phase_plane_law_step({law}, &motion, &reference, {list});"
            );
        }
        LawsOfAxes::Attitude(own) => {
            let count = own[axis].1.len();
            let filters =
                if count == 0 { "NULL, 0".to_owned() } else { format!("state->filters[{axis}], {count}") };
            let acceleration = about("acceleration", axis, axes);
            let _ = writeln!(
                text,
                "    output->{acceleration} = attitude_feedback_step({law}, &motion, &reference, {filters});"
            );
        }
    }
}

/// Writes the conversion of accelerations to a torque.
fn torque(plan: &Plan<'_>, laws: &SampledLaws, text: &mut String) {
    let (prefix, axes) = (plan.prefix, laws.axis_count());
    let vector = |member: &dyn Fn(usize) -> String| {
        let [x, y, z] = [0, 1, 2].map(|axis| if axis < axes { member(axis) } else { "0.0".to_owned() });
        format!("({prefix}_vector3){{ .x = {x}, .y = {y}, .z = {z} }}")
    };
    let rate = if laws.estimator.is_some() {
        String::new()
    } else {
        let rate = vector(&|axis| estimate(laws, "rate", axis));
        format!("    const {prefix}_vector3 rate = {rate};\n")
    };
    let _ = write!(
        text,
        "\n    /* torque of these accelerations */\n    const {prefix}_vector3 acceleration = {};\n{rate}",
        vector(&|axis| format!("output->{}", about("acceleration", axis, axes))),
    );
    momentum_calls::declaration(plan, &laws.stored, "rate", text);
    let _ = writeln!(
        text,
        "    const {prefix}_vector3 torque = torque_distribution_torque(&inertia, &acceleration, &rate, &stored);"
    );
    for (axis, component) in ["x", "y", "z"].into_iter().enumerate().take(axes) {
        let _ = writeln!(text, "    output->{} = torque.{component};", about("torque", axis, axes));
    }
}
