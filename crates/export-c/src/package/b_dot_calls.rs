//! Functions of exported B-dot laws.

use std::fmt::Write as _;

use super::Plan;
use super::initialiser::initialiser;
use super::signature::signature;
use crate::control_system::BDotLaws;

/// Functions of the flight code that the exported functions call.
pub const ROOTS: [&str; 3] = ["b_dot::FieldRate::take", "b_dot::opposing_moment", "b_dot::limited_moment"];

/// Writes the functions.
pub fn functions(plan: &Plan<'_>, laws: &BDotLaws, text: &mut String) {
    let prefix = plan.prefix;
    let field = initialiser(&laws.field, prefix);
    let _ = writeln!(
        text,
        "void {prefix}_init({prefix}_state *state)\n{{\n    state->field = ({prefix}_field_rate){field};\n}}\n\n{}\n{{\n    \
         const {prefix}_vector3 field = ({prefix}_vector3){{ .x = input->field[0], .y = input->field[1], .z = input->field[2] }};\n    \
         field_rate_take(&state->field, now, &field);\n    output->field_rate[0] = state->field.rate.x;\n    \
         output->field_rate[1] = state->field.rate.y;\n    output->field_rate[2] = state->field.rate.z;\n}}\n",
        signature(plan, &plan.calls[0]),
    );
    let _ = writeln!(text, "{}\n{{\n    (void)state;\n    (void)now;", signature(plan, &plan.calls[1]));
    for axis in 0..3 {
        let [gain, limit] = [laws.gains[axis], laws.limits[axis]].map(|value| initialiser(&value, prefix));
        let _ = writeln!(
            text,
            "    output->moment[{axis}] = b_dot_limited_moment(b_dot_opposing_moment({gain}, input->field_rate[{axis}]), {limit});"
        );
    }
    text.push_str("}\n");
}
