//! Parameters of a control system: numbers that are tuned in flight, with defaults, limits and a check.

use std::fmt::Write as _;

use flexsc_core::control::operation::ModeReading;
use flexsc_core::numerics::attitude::AXES;
use flexsc_flight::mode_condition::{ConditionSource, ConditionStep};
use flexsc_flight_precision::Precision;

use super::Glue;
use super::member::Member;
use super::text::literal;
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
        let running = |member: &str| Some(format!("estimator.history.gate.{member}"));
        let (nis, rate) = (unit.gate.most_nis, unit.gate.most_rate);
        let about = "Largest normalised innovation squared of a measurement";
        all.push(FlightParameter::new("gate_nis", about, nis, running("most_nis")));
        let about = "Largest rate of the gyro (rad/s)";
        all.push(FlightParameter::new("gate_rate", about, rate, running("most_rate")));
    }
    all.retain(|parameter| parameter.value.is_finite());
    all
}

fn add_laws(laws: &SampledLaws, mode: Option<&str>, state: &str, all: &mut Vec<FlightParameter>) {
    let axes = laws.axis_count();
    for axis in 0..axes {
        for (member, about, value) in law_members(&laws.laws, axis) {
            let law = super::text::about("law", axis, axes);
            let mut about = about.to_owned();
            if axes > 1 {
                let _ = write!(about, ", {}", AXES[axis]);
            }
            if let Some(mode) = mode {
                let _ = write!(about, ", in the mode `{mode}`");
            }
            let running = Some(format!("{state}{law}.{member}"));
            let name = law_parameter(mode, axis, axes, member);
            all.push(FlightParameter::new(&name, &about, value, running));
        }
    }
}

fn add_b_dot(laws: &BDotLaws, mode: Option<&str>, all: &mut Vec<FlightParameter>) {
    for axis in 0..3 {
        let [gain, moment] = b_dot_names(mode, axis);
        let about = "Gain of the B-dot law (A m^2 s/T)";
        all.push(FlightParameter::new(&gain, about, laws.gains[axis], None));
        let about = "Largest moment of the B-dot law (A m^2)";
        all.push(FlightParameter::new(&moment, about, laws.limits[axis], None));
    }
}

fn add_actuation(own: &Actuation, all: &mut Vec<FlightParameter>) {
    if let Some(wheels) = &own.wheels {
        let about = "Largest torque of a wheel (N m)";
        all.push(FlightParameter::new("wheel_torque", about, wheels.limit, None));
    }
    let Some(law) = own.unloading.as_ref().map(|unit| &unit.law) else { return };
    let last = if law.is_magnetic {
        ("gain", "Part of the momentum removed in a second (1/s)", law.gain, "gain")
    } else {
        ("torque", "Largest torque of the unloading (N m)", law.most, "most")
    };
    let above = ("above", "Momentum above which unloading begins (N m s)", law.above, "above");
    let below = ("below", "Momentum below which it ends (N m s)", law.below, "below");
    all.extend([above, below, last].map(|(name, about, value, member)| {
        let running = Some(format!("unloading.{member}"));
        FlightParameter::new(&format!("unload_{name}"), about, value, running)
    }));
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
        let running = Some(format!("steps[{step}].limit"));
        all.push(FlightParameter::new(&name, &about, compared.limit, running));
    }
}

/// Adds the parameters, their defaults, their check and their change.
pub fn add(glue: &mut Glue<'_>) {
    let (all, count) = (glue.plan.parameters, glue.plan.parameters.len());
    if count == 0 {
        return;
    }
    glue.types.push_str("/// Numbers that are tuned in flight.\n#[derive(Clone, Copy, Debug, PartialEq)]\npub struct Parameters {\n");
    let mut defaults = "Parameters {\n".to_owned();
    for own in all {
        let _ = writeln!(glue.types, "    /// {}.\n    pub {}: f64,", own.about, own.name);
        let _ = writeln!(defaults, "    {}: {},", own.name, literal(&own.value));
    }
    glue.types.push_str("}\n\n");
    let _ = writeln!(
        glue.constants,
        "/// Parameters of the scenario, which `init` takes.\npub const DEFAULT_PARAMETERS: Parameters = {defaults}}};\n"
    );
    let about = "Numbers that are tuned in flight.";
    glue.members.push(Member::new(about, "parameters", "Parameters", "DEFAULT_PARAMETERS".to_owned()));
    let limits: Vec<[f64; 2]> = all.iter().map(|own| own.limits(glue.plan.precision)).collect();
    let about = format!(
        "Least and greatest value of each parameter: a factor of {FACTOR} from its default, which a team narrows."
    );
    glue.list(&about, "LIMITS", "[f64; 2]", &limits);
    let values =
        all.iter().map(|own| format!("        parameters.{},\n", own.name)).collect::<Vec<_>>().concat();
    let mut check = format!(
        "    let values: [f64; {count}] = [\n{values}    ];
    for index in 0..{count} {{
        // a number that is not finite is in no range
        if !(values[index] >= LIMITS[index][0] && values[index] <= LIMITS[index][1]) {{
            return index as i32 + 1;
        }}
    }}
"
    );
    if let Some(place) = all.iter().position(|own| own.name == "unload_below") {
        let number = place + 1;
        let _ = writeln!(
            check,
            "    if !(parameters.unload_below < parameters.unload_above) {{\n        return {number};\n    }}"
        );
    }
    check.push_str("    0\n");
    let about = "Returns 0 if all parameters are within their limits, else the number of the first that is not, from 1.";
    let head = "pub fn parameters_check() -> i32";
    glue.function(about, head, &["parameters: &Parameters"], &check);
    let change = format!(
        "    let refused: i32 = parameters_check(parameters);
    if refused != 0 {{
        return refused;
    }}
    state.parameters = *parameters;
{}    0
",
        apply(glue, "")
    );
    let about = "Takes other parameters, at any time: laws and filters go on with them, also after `start`. Changes nothing, and returns the number of the first one beyond its limits, if there is one; else 0.";
    let head = "pub fn set_parameters() -> i32";
    glue.function(about, head, &["state: &mut State", "parameters: &Parameters"], &change);
}

impl FlightParameter {
    fn new(name: &str, about: &str, value: f64, running: Option<String>) -> Self {
        Self { name: name.to_owned(), about: about.to_owned(), value, running }
    }

    /// Returns the least and the greatest value, which are finite in the precision of the code.
    fn limits(&self, precision: Precision) -> [f64; 2] {
        let most = if precision.is_double() { f64::MAX } else { f64::from(f32::MAX) };
        let ends = [self.value / FACTOR, (self.value * FACTOR).clamp(-most, most)];
        match self.value {
            0.0 => [-1.0, 1.0],
            value if value < 0.0 => [ends[1], ends[0]],
            _ => ends,
        }
    }
}

/// Returns the statements that set the members of the state in use whose names begin with `start` to their parameters.
pub fn apply(glue: &Glue<'_>, start: &str) -> String {
    let running = glue.plan.parameters.iter().filter_map(|own| Some((own.running.as_ref()?, &own.name)));
    let own = running.filter(|(running, _)| running.starts_with(start));
    let own = own.map(|(running, name)| format!("    state.{running} = state.parameters.{name};\n"));
    own.collect::<Vec<_>>().concat()
}

/// Returns the expression of a parameter in a function with the state, or the literal of a number that is no parameter.
pub fn expression(glue: &Glue<'_>, name: &str, value: f64) -> String {
    if glue.plan.parameters.iter().any(|own| own.name == name) {
        format!("state.parameters.{name}")
    } else {
        literal(&value)
    }
}
