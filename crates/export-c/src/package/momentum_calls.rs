//! Momentum stored in the rotors, in an exported control system.

use std::fmt::Write as _;

use super::Plan;
use super::initialiser::initialiser;
use crate::control_system::StoredMomentum;

/// Name in C of the function that sums the momenta of wheels.
const FUNCTION: &str = "wheel_momentum_stored";

/// Returns the path of the function of the flight code that the exported `functions` call, if they do.
pub fn root(functions: &str) -> Option<&'static str> {
    functions.contains(FUNCTION).then_some("wheel_momentum::stored")
}

/// Returns the axes of the wheels, if the exported `functions` read them.
pub fn constants(plan: &Plan<'_>, stored: &StoredMomentum, functions: &str) -> String {
    let StoredMomentum::Wheels { axes, .. } = stored else { return String::new() };
    if !functions.contains(FUNCTION) {
        return String::new();
    }
    let rows: Vec<String> =
        axes.iter().map(|axis| format!("    {}", initialiser(axis, plan.prefix))).collect();
    format!(
        "/* Axes of the wheels. */\nstatic const {} wheel_axes[{}] = {{\n{}\n}};\n\n",
        plan.type_name("Vector3"),
        axes.len(),
        rows.join(",\n")
    )
}

/// Writes the declaration of `stored`, the momentum by the input and the variable `rate`, the estimated rate.
pub fn declaration(plan: &Plan<'_>, stored: &StoredMomentum, rate: &str, text: &mut String) {
    let vector = plan.type_name("Vector3");
    let value = match stored {
        StoredMomentum::None => format!("({vector}){{ .x = 0.0, .y = 0.0, .z = 0.0 }}"),
        StoredMomentum::Wheels { axes, inertia } => format!(
            "{FUNCTION}(wheel_axes, {0}, {1}, input->wheel_speed, {0}, &{rate})",
            axes.len(),
            initialiser(inertia, plan.prefix)
        ),
        StoredMomentum::Input => format!(
            "({vector}){{ .x = input->stored_momentum[0], .y = input->stored_momentum[1], .z = input->stored_momentum[2] }}"
        ),
    };
    let _ = writeln!(text, "    const {vector} stored = {value};");
}
