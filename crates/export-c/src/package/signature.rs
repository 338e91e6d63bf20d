//! Signatures of the exported functions.

use super::Plan;
use crate::control_system::{CallLayout, ControlSystem};

/// Returns the signature of a function.
pub fn signature(plan: &Plan<'_>, call: &CallLayout) -> String {
    let (prefix, name) = (plan.prefix, call.name);
    let now = if has_time(plan) { format!("{prefix}_ticks now, ") } else { String::new() };
    format!(
        "void {prefix}_{name}({prefix}_state *state, {now}const {prefix}_{name}_input *input,\n    \
         {prefix}_{name}_output *output)"
    )
}

/// Returns the signature of the function that sets the state: modes begin at a time.
pub fn init_signature(plan: &Plan<'_>) -> String {
    let prefix = plan.prefix;
    let now = if inits_at_time(plan) { format!(", {prefix}_ticks now") } else { String::new() };
    format!("void {prefix}_init({prefix}_state *state{now})")
}

/// Returns true if the function that sets the state reads the time.
pub fn inits_at_time(plan: &Plan<'_>) -> bool {
    matches!(plan.system, ControlSystem::Modes(_))
}

/// Returns true if the functions read the time.
pub fn has_time(plan: &Plan<'_>) -> bool {
    match plan.system {
        ControlSystem::Relays(_) | ControlSystem::BDot(_) | ControlSystem::Modes(_) => true,
        ControlSystem::Sampled(laws) => laws.estimator.is_some(),
    }
}

/// Returns a member of the inputs, outputs or state about an axis.
pub fn about(name: &str, axis: usize, axes: usize) -> String {
    if axes == 1 { name.to_owned() } else { format!("{name}[{axis}]") }
}
