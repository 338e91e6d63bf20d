//! Momentum stored in the rotors.

use super::Glue;
use super::text::{literal, local, vector_from};
use crate::control_system::StoredMomentum;

/// Adds the axes of the wheels, if functions read them.
pub fn add_axes(glue: &mut Glue<'_>, stored: &StoredMomentum) {
    if let StoredMomentum::Wheels { axes, .. } = stored
        && glue.functions.contains("WHEEL_AXES")
    {
        glue.list("Axes of the wheels.", "WHEEL_AXES", "Vector3", axes);
    }
}

/// Returns the declaration of `stored`, the momentum by the input of a function and the variable `rate`, the estimated rate.
pub fn stored(glue: &Glue<'_>, call: &str, stored: &StoredMomentum, rate: &str) -> String {
    let value = match stored {
        StoredMomentum::None => "Vector3::ZERO".to_owned(),
        StoredMomentum::Wheels { inertia, .. } => {
            let (inertia, speeds) = (literal(inertia), glue.input_list(call, "wheel_speed"));
            format!("wheel_momentum::stored(&WHEEL_AXES, {inertia}, {speeds}, &{rate})")
        }
        StoredMomentum::Input => vector_from("input.stored_momentum"),
    };
    local("Vector3", "stored", &value)
}
