//! Parameters of an exported control system: numbers that are tuned in flight, with defaults, limits and a check.

use std::fmt::Write as _;

use flexsc_core::control::operation::ModeReading;
use flexsc_core::numerics::attitude::AXES;
use flexsc_flight::mode_condition::{ConditionSource, ConditionStep};

use super::Plan;
use super::initialiser::initialiser;
use crate::control_system::{Actuation, BDotLaws, ControlSystem, LawsOfAxes, ModeSystem, SampledLaws};

/// Factor by which a parameter may be larger or smaller than its default.
const FACTOR: f64 = 10.0;

/// Number that is tuned in flight.
#[derive(Clone, Debug, PartialEq)]
pub struct FlightParameter {
    /// Name of the member.
    pub name: String,
    /// Meaning with its unit.
    pub about: String,
    /// Default.
    pub value: f64,
    /// Member of the state with the number that is in use; `None` if that is the parameter.
    running: Option<String>,
}

/// Member of a law that is a parameter: name, meaning and number.
type LawMember = (&'static str, &'static str, f64);

/// Returns the members of the law about an axis that are parameters.
fn law_members(laws: &LawsOfAxes, axis: usize) -> Vec<LawMember> {
    let mut members = Vec::new();
    match laws {
        LawsOfAxes::Attitude(own) => {
            let law = &own[axis].0;
            members.push(("bandwidth", "Bandwidth (rad/s)", law.bandwidth));
            members.push(("damping", "Damping ratio", law.damping));
            if law.has_rate_limit {
                members.push((
                    "rate_limit",
                    "Largest rate at which an error is corrected (rad/s)",
                    law.rate_limit,
                ));
            }
            if law.has_integral {
                members.push(("integral_time", "Time constant of the integral (s)", law.integral_time));
                members.push(("integral_limit", "Largest integral of the error (rad s)", law.integral_limit));
            }
        }
        LawsOfAxes::Pd(own) => {
            let law = &own[axis].0;
            members.push(("k_p", "Proportional gain (N m/rad, or units of the command per rad)", law.k_p));
            members.push(("k_d", "Derivative gain (N m s/rad, or units of the command)", law.k_d));
            members.push(("limit", "Largest torque (N m)", law.limit));
        }
        LawsOfAxes::PhasePlane(..) | LawsOfAxes::StateSpace(_) => {}
    }
    // Without a limit there is nothing to tune.
    members.retain(|(_, _, value)| value.is_finite() && *value != 0.0);
    members
}

/// Returns the name of a parameter of the law about an axis, of a mode or of no mode.
fn law_parameter(mode: Option<&str>, axis: usize, axes: usize, member: &str) -> String {
    let mode = mode.map_or_else(String::new, |mode| format!("{mode}_"));
    if axes == 1 { format!("{mode}{member}") } else { format!("{mode}{}_{member}", AXES[axis]) }
}

/// Returns the names of the parameters of B-dot laws along an axis: gain, and largest moment.
pub fn b_dot_names(mode: Option<&str>, axis: usize) -> [String; 2] {
    let mode = mode.map_or_else(String::new, |mode| format!("{mode}_"));
    ["gain", "moment"].map(|name| format!("{mode}{name}_{}", ["x", "y", "z"][axis]))
}

/// Returns the parameters of a control system; none of relays.
pub fn parameters(system: &ControlSystem) -> Vec<FlightParameter> {
    let mut all = Vec::new();
    match system {
        ControlSystem::Relays(_) => {}
        ControlSystem::BDot(own) => add_b_dot(&own.laws, None, &mut all),
        ControlSystem::Sampled(laws) => {
            add_laws(laws, None, "", &mut all);
            add_actuation(&laws.actuation, &mut all);
        }
        ControlSystem::Modes(modes) => add_modes(modes, &mut all),
    }
    if let Some(unit) = system.estimator() {
        let mut add = |name: &str, about: &str, value: f64, member: &str| {
            let running = Some(format!("estimator.history.gate.{member}"));
            all.push(FlightParameter { name: name.to_owned(), about: about.to_owned(), value, running });
        };
        add(
            "gate_nis",
            "Largest normalised innovation squared of a measurement",
            unit.gate.most_nis,
            "most_nis",
        );
        add("gate_rate", "Largest rate of the gyro (rad/s)", unit.gate.most_rate, "most_rate");
    }
    all.retain(|parameter| parameter.value.is_finite());
    all
}

fn add_laws(laws: &SampledLaws, mode: Option<&str>, state: &str, all: &mut Vec<FlightParameter>) {
    let axes = laws.axis_count();
    for axis in 0..axes {
        for (member, about, value) in law_members(&laws.laws, axis) {
            let law = super::signature::about("law", axis, axes);
            let mut about = about.to_owned();
            if axes > 1 {
                let _ = write!(about, ", {}", AXES[axis]);
            }
            if let Some(mode) = mode {
                let _ = write!(about, ", in the mode `{mode}`");
            }
            let running = Some(format!("{state}{law}.{member}"));
            all.push(FlightParameter {
                name: law_parameter(mode, axis, axes, member),
                about,
                value,
                running,
            });
        }
    }
}

fn add_b_dot(laws: &BDotLaws, mode: Option<&str>, all: &mut Vec<FlightParameter>) {
    for axis in 0..3 {
        let [gain, moment] = b_dot_names(mode, axis);
        let mut add = |name: String, about: &str, value: f64| {
            all.push(FlightParameter { name, about: about.to_owned(), value, running: None });
        };
        add(gain, "Gain of the B-dot law (A m^2 s/T)", laws.gains[axis]);
        add(moment, "Largest moment of the B-dot law (A m^2)", laws.limits[axis]);
    }
}

fn add_actuation(own: &Actuation, all: &mut Vec<FlightParameter>) {
    let mut add = |name: &str, about: &str, value: f64, running: Option<&str>| {
        let running = running.map(str::to_owned);
        all.push(FlightParameter { name: name.to_owned(), about: about.to_owned(), value, running });
    };
    if let Some(wheels) = &own.wheels {
        add("wheel_torque", "Largest torque of a wheel (N m)", wheels.limit, None);
    }
    if let Some(unit) = &own.unloading {
        let law = &unit.law;
        add(
            "unload_above",
            "Momentum above which unloading begins (N m s)",
            law.above,
            Some("unloading.above"),
        );
        add("unload_below", "Momentum below which it ends (N m s)", law.below, Some("unloading.below"));
        if law.is_magnetic {
            add(
                "unload_gain",
                "Part of the momentum removed in a second (1/s)",
                law.gain,
                Some("unloading.gain"),
            );
        } else {
            add("unload_torque", "Largest torque of the unloading (N m)", law.most, Some("unloading.most"));
        }
    }
}

/// Returns the indices of the comparisons of numbers in the conditions of modes, with the names of their parameters: the mode,
/// the one that follows, and the place among all comparisons between these two.
pub fn thresholds(modes: &ModeSystem) -> Vec<(usize, String)> {
    let tables = &modes.tables;
    let steps_of = |exit: usize| {
        let next = tables.exits.get(exit + 1).map_or(tables.steps.len(), |next| next.first_step);
        tables.exits[exit].first_step..next
    };
    let has_limit = |step: &ConditionStep| {
        let reading = tables.readings.get(step.index);
        let is_number = matches!(reading, Some(ModeReading::Known(quantity)) if !quantity.is_boolean());
        step.source == ConditionSource::Reading && is_number && step.limit.is_finite()
    };
    let mut found: Vec<(usize, String)> = Vec::new();
    for (mode, own) in tables.modes.iter().enumerate() {
        let exits = own.first_exit..own.first_exit + own.exit_count;
        for exit in exits.clone() {
            let to = tables.exits[exit].to;
            let to_same = exits.clone().filter(|other| tables.exits[*other].to == to && *other < exit);
            let before: usize = to_same.map(|other| steps_of(other).len()).sum();
            let limited = steps_of(exit).enumerate().filter(|(_, step)| has_limit(&tables.steps[*step]));
            for (place, step) in limited {
                let (name, next) = (&modes.modes[mode].name, &modes.modes[to].name);
                let mut name = format!("{name}_to_{next}_{}", before + place);
                // The modes `a` and `b_to_c` have the words of `a_to_b` and `c`.
                while found.iter().any(|(_, known)| *known == name) {
                    name.push('_');
                }
                found.push((step, name));
            }
        }
    }
    found
}

fn add_modes(modes: &ModeSystem, all: &mut Vec<FlightParameter>) {
    for mode in &modes.modes {
        if let Some(laws) = mode.start.on_estimates() {
            add_laws(laws, Some(&mode.name), &format!("law_{}.", mode.name), all);
        }
        if let Some(laws) = mode.start.b_dot() {
            add_b_dot(laws, Some(&mode.name), all);
        }
    }
    add_actuation(&modes.actuation, all);
    for (step, name) in thresholds(modes) {
        let mut about = "Limit of a comparison with which a mode ends".to_owned();
        let compared = &modes.tables.steps[step];
        if let Some(ModeReading::Known(quantity)) = modes.tables.readings.get(compared.index)
            && !quantity.unit().is_empty()
        {
            let _ = write!(about, " ({})", quantity.unit());
        }
        all.push(FlightParameter {
            name,
            about,
            value: compared.limit,
            running: Some(format!("steps[{step}].limit")),
        });
    }
}

/// Returns the C struct `NAME_parameters` for the header; empty without parameters.
pub fn definition(plan: &Plan<'_>) -> String {
    let mut text = String::new();
    if plan.parameters.is_empty() {
        return text;
    }
    text.push_str("/* Numbers that are tuned in flight. */\ntypedef struct {\n");
    for parameter in plan.parameters {
        let _ = writeln!(text, "    /* {}. */\n    double {};", parameter.about, parameter.name);
    }
    let _ = writeln!(text, "}} {}_parameters;\n", plan.prefix);
    text
}

/// Returns the declarations, for the header.
pub fn declarations(plan: &Plan<'_>) -> String {
    if plan.parameters.is_empty() {
        return String::new();
    }
    let prefix = plan.prefix;
    format!(
        "/* Parameters of the scenario, which `{prefix}_init` takes. */\nextern const {prefix}_parameters {prefix}_default_parameters;\n\n\
         /* Returns 0 if all parameters are within their limits, else the number of the first that is not, from 1; in {prefix}_parameters.c. */\n\
         int32_t {prefix}_parameters_check(const {prefix}_parameters *parameters);\n\n\
         /* Takes other parameters, at any time: laws and filters go on with them, also after `{prefix}_start`. Changes nothing, and returns the number of the first one beyond its limits, if there is one; else 0. In {prefix}_parameters.c. */\n\
         int32_t {prefix}_set_parameters({prefix}_state *state, const {prefix}_parameters *parameters);\n\n"
    )
}

/// Writes the constant with the defaults.
pub fn defaults(plan: &Plan<'_>, text: &mut String) {
    if plan.parameters.is_empty() {
        return;
    }
    let rows: Vec<String> = plan
        .parameters
        .iter()
        .map(|own| format!("    .{} = {}", own.name, initialiser(&own.value, plan.prefix)))
        .collect();
    let prefix = plan.prefix;
    let _ = writeln!(
        text,
        "const {prefix}_parameters {prefix}_default_parameters = {{\n{}\n}};\n",
        rows.join(",\n")
    );
}

/// Writes the statement of `init` that takes the defaults.
pub fn init(plan: &Plan<'_>, text: &mut String) {
    if !plan.parameters.is_empty() {
        let _ = writeln!(text, "    state->parameters = {}_default_parameters;", plan.prefix);
    }
}

/// Writes the statements that set the members of the state in use whose names begin with `start` to their parameters.
pub fn apply(plan: &Plan<'_>, start: &str, text: &mut String) {
    for own in plan.parameters {
        if let Some(running) = own.running.as_ref().filter(|running| running.starts_with(start)) {
            let _ = writeln!(text, "    state->{running} = state->parameters.{};", own.name);
        }
    }
}

/// Returns the expression of a parameter in a function with the state, or the literal of a number that is no parameter.
pub fn expression(plan: &Plan<'_>, name: &str, value: f64) -> String {
    if plan.parameters.iter().any(|own| own.name == name) {
        format!("state->parameters.{name}")
    } else {
        initialiser(&value, plan.prefix)
    }
}

/// Returns the file with the check and the change of parameters; `None` without parameters.
pub fn source(plan: &Plan<'_>) -> Option<String> {
    let (prefix, count) = (plan.prefix, plan.parameters.len());
    if count == 0 {
        return None;
    }
    let mut text = format!(
        "/* Parameters of {prefix}.c: their limits, check and change. */\n\n#include \"{prefix}.h\"\n\n\
         /* Least and greatest value of each parameter: a factor of {FACTOR} from its default, which a team narrows. */\n\
         static const double limits[{count}][2] = {{\n"
    );
    let literal = |value: f64| initialiser(&value, prefix);
    let rows: Vec<String> = plan
        .parameters
        .iter()
        .map(|own| {
            let ends = [own.value / FACTOR, own.value * FACTOR];
            let (least, greatest) = match own.value {
                0.0 => (-1.0, 1.0),
                value if value < 0.0 => (ends[1], ends[0]),
                _ => (ends[0], ends[1]),
            };
            format!("    /* {} */ {{ {}, {} }}", own.name, literal(least), literal(greatest))
        })
        .collect();
    let _ = writeln!(text, "{}\n}};\n", rows.join(",\n"));
    let _ = writeln!(
        text,
        "int32_t {prefix}_parameters_check(const {prefix}_parameters *parameters)\n{{\n    const double values[{count}] = {{"
    );
    let values: Vec<String> =
        plan.parameters.iter().map(|own| format!("        parameters->{}", own.name)).collect();
    let _ = writeln!(
        text,
        "{}\n    }};\n\n    for (int32_t index = 0; index < {count}; ++index) {{\n        /* a number that is not finite is in no range */\n        \
         if (!(values[index] >= limits[index][0] && values[index] <= limits[index][1])) {{\n            return index + 1;\n        }}\n    }}",
        values.join(",\n")
    );
    if let Some(place) = plan.parameters.iter().position(|own| own.name == "unload_below") {
        let _ = writeln!(
            text,
            "    if (!(parameters->unload_below < parameters->unload_above)) {{\n        return {};\n    }}",
            place + 1
        );
    }
    let _ = writeln!(
        text,
        "    return 0;\n}}\n\nint32_t {prefix}_set_parameters({prefix}_state *state, const {prefix}_parameters *parameters)\n{{\n    \
         const int32_t refused = {prefix}_parameters_check(parameters);\n    if (refused != 0) {{\n        return refused;\n    }}\n    state->parameters = *parameters;"
    );
    apply(plan, "", &mut text);
    text.push_str("    return 0;\n}\n");
    Some(text)
}
