//! Functions of exported B-dot laws.

use std::fmt::Write as _;

use super::initialiser::initialiser;
use super::shim::{self, VECTOR};
use super::signature::signature;
use super::{Plan, parameters};
use crate::control_system::{BDotLaws, BDotSystem, FieldUnit};

/// Writes the functions of B-dot laws alone.
pub fn functions(plan: &Plan<'_>, own: &BDotSystem, text: &mut String) {
    let _ = writeln!(text, "void {0}_init({0}_state *state)\n{{", plan.prefix);
    init(plan, &own.field, text);
    parameters::init(plan, text);
    text.push_str("}\n\n");
    sample(plan, text);
    let _ = writeln!(text, "{}\n{{\n    (void)input;", signature(plan, &plan.calls[1]));
    moment(plan, &own.laws, None, text);
    shim::spread("output->moment", "moment", &VECTOR, text);
    text.push_str("}\n");
}

/// Writes the statement of `init` that sets the rate of change of the field.
pub fn init(plan: &Plan<'_>, unit: &FieldUnit, text: &mut String) {
    let field = initialiser(&unit.field, plan.prefix);
    let _ = writeln!(text, "    state->field = ({}){field};", plan.type_name("FieldRate"));
}

/// Writes the function that takes a sample of the field.
pub fn sample(plan: &Plan<'_>, text: &mut String) {
    let Some(call) = plan.calls.iter().find(|call| call.name == "field") else { return };
    let _ = writeln!(text, "{}\n{{", signature(plan, call));
    shim::variable(plan, "Vector3", "field", &shim::vector_from(plan, "input->field"), text);
    text.push_str("    field_rate_take(&state->field, now, &field);\n");
    shim::spread("output->field_rate", "state->field.rate", &VECTOR, text);
    text.push_str("}\n\n");
}

/// Writes the declaration of `moment`, that of the laws, in a mode or without modes.
pub fn moment(plan: &Plan<'_>, laws: &BDotLaws, mode: Option<&str>, text: &mut String) {
    let values = |part: usize, numbers: [f64; 3]| {
        let value =
            |axis| parameters::expression(plan, &parameters::b_dot_names(mode, axis)[part], numbers[axis]);
        shim::vector(plan, &[0, 1, 2].map(value))
    };
    shim::variable(plan, "Vector3", "gains", &values(0, laws.gains), text);
    shim::variable(plan, "Vector3", "limits", &values(1, laws.limits), text);
    shim::variable(plan, "Vector3", "field_rate", "field_rate_rate_at(&state->field, now)", text);
    shim::variable(plan, "Vector3", "moment", "b_dot_moments(&field_rate, &gains, &limits)", text);
}
