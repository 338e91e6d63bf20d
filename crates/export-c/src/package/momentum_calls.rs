//! Momentum stored in the rotors, in an exported control system.

use super::Plan;
use super::initialiser::initialiser;
use super::shim;
use crate::control_system::StoredMomentum;

/// Returns the axes of the wheels, if the exported `functions` read them.
pub fn constants(plan: &Plan<'_>, stored: &StoredMomentum, functions: &str) -> String {
    match stored {
        StoredMomentum::Wheels { axes, .. } if functions.contains("wheel_axes") => {
            shim::list(plan, "Axes of the wheels.", "Vector3", "wheel_axes", axes)
        }
        _ => String::new(),
    }
}

/// Writes the declaration of `stored`, the momentum by the input and the variable `rate`, the estimated rate.
pub fn declaration(plan: &Plan<'_>, stored: &StoredMomentum, rate: &str, text: &mut String) {
    let value = match stored {
        StoredMomentum::None => shim::vector(plan, &["0.0"; 3]),
        StoredMomentum::Wheels { axes, inertia, .. } => format!(
            "wheel_momentum_stored(wheel_axes, {0}, {1}, input->wheel_speed, {0}, &{rate})",
            axes.len(),
            initialiser(inertia, plan.prefix)
        ),
        StoredMomentum::Input => shim::vector_from(plan, "input->stored_momentum"),
    };
    shim::variable(plan, "Vector3", "stored", &value, text);
}
