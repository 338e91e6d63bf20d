//! Functions of exported B-dot laws.

use std::fmt::Write as _;

use super::initialiser::initialiser;
use super::signature::signature;
use super::{Plan, parameters};
use crate::control_system::{BDotLaws, BDotSystem};

/// Functions of the flight code that the exported functions call.
pub const ROOTS: [&str; 4] = [
    "b_dot::FieldRate::take",
    "b_dot::FieldRate::rate_at",
    "b_dot::opposing_moment",
    "b_dot::limited_moment",
];

/// Writes the functions of B-dot laws alone.
pub fn functions(plan: &Plan<'_>, own: &BDotSystem, text: &mut String) {
    let prefix = plan.prefix;
    let field = initialiser(&own.field.field, prefix);
    let _ = writeln!(
        text,
        "void {prefix}_init({prefix}_state *state)\n{{\n    state->field = ({prefix}_field_rate){field};"
    );
    parameters::init(plan, false, text);
    text.push_str("}\n\n");
    sample(plan, text);
    let _ = writeln!(
        text,
        "{}\n{{\n    (void)input;\n    const {prefix}_vector3 field_rate = {CURRENT_RATE};",
        signature(plan, &plan.calls[1])
    );
    for axis in 0..3 {
        let _ = writeln!(text, "    output->moment[{axis}] = {};", moment(plan, &own.laws, None, axis));
    }
    text.push_str("}\n");
}

/// Writes the function that takes a sample of the field.
pub fn sample(plan: &Plan<'_>, text: &mut String) {
    let Some(call) = plan.calls.iter().find(|call| call.name == "field") else { return };
    let _ = writeln!(
        text,
        "{}\n{{\n    const {}_vector3 field = {{ .x = input->field[0], .y = input->field[1], .z = input->field[2] }};\n    \
         field_rate_take(&state->field, now, &field);\n    output->field_rate[0] = state->field.rate.x;\n    \
         output->field_rate[1] = state->field.rate.y;\n    output->field_rate[2] = state->field.rate.z;\n}}\n",
        signature(plan, call),
        plan.prefix
    );
}

/// Rate of change of the field at the time of a step, in C.
pub const CURRENT_RATE: &str = "field_rate_rate_at(&state->field, now)";

/// Returns the moment along an axis for the variable `field_rate`, in a mode or without modes.
pub fn moment(plan: &Plan<'_>, laws: &BDotLaws, mode: Option<&str>, axis: usize) -> String {
    let [gain, limit] = parameters::b_dot_names(mode, axis);
    let gain = parameters::expression(plan, &gain, laws.gains[axis]);
    let limit = parameters::expression(plan, &limit, laws.limits[axis]);
    let component = ["x", "y", "z"][axis];
    format!("b_dot_limited_moment(b_dot_opposing_moment({gain}, field_rate.{component}), {limit})")
}
