//! B-dot laws: samples of the magnetic field, and the moments along the axes.

use super::member::Member;
use super::text::{VECTOR, literal, local, spread, vector, vector_from};
use super::{Glue, parameters};
use crate::control_system::{BDotLaws, BDotSystem, FieldUnit};

/// Adds B-dot laws alone.
pub fn add_system(glue: &mut Glue<'_>, own: &BDotSystem) {
    add_field(glue, &own.field);
    let body = moment(glue, &own.laws, None) + &spread("output.moment", "moment", &VECTOR);
    glue.call("step", &body);
}

/// Adds the rate of change of the field.
pub fn add_field(glue: &mut Glue<'_>, unit: &FieldUnit) {
    let about = "Rate of change of the magnetic field.";
    glue.members.push(Member::new(about, "field", "FieldRate", literal(&unit.field)));
    let field = local("Vector3", "field", &vector_from("input.field"));
    let body = field + "    state.field.take(now, &field);\n";
    glue.call("field", &(body + &spread("output.field_rate", "state.field.rate", &VECTOR)));
}

/// Returns the declaration of `moment`, that of the laws, in a mode or without modes.
pub fn moment(glue: &Glue<'_>, laws: &BDotLaws, mode: Option<&str>) -> String {
    let values = |part: usize, numbers: [f64; 3]| {
        let value = |axis| {
            let name = &parameters::b_dot_names(mode, axis)[part];
            parameters::expression(glue, name, numbers[axis])
        };
        vector(&[0, 1, 2].map(value))
    };
    [
        ("gains", &*values(0, laws.gains)),
        ("limits", &values(1, laws.limits)),
        ("field_rate", "state.field.rate_at(now)"),
        ("moment", "b_dot::moments(&field_rate, &gains, &limits)"),
    ]
    .map(|(name, value)| local("Vector3", name, value))
    .concat()
}
