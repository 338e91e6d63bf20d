//! Magnetorquers along the axes of the body: moments that give a torque, and the torque that they give.

use crate::maths::max;
use crate::vector3::Vector3;

/// Returns the moment (A m²) whose torque in a field (T) is the part of a demanded torque (N m) perpendicular to the field, scaled
/// down as a whole if it exceeds the largest moment along an axis (A m²); 0 without a field, or with one that is not finite.
pub fn moment_of_torque(torque: &Vector3, field: &Vector3, limits: &Vector3) -> Vector3 {
    let square: f64 = field.norm_squared();
    if !(square > 0.0 && square.is_finite()) {
        return Vector3::ZERO;
    }
    let crossed: Vector3 = field.cross(torque);
    let moment: Vector3 = crossed.divided(square);
    let mut excess: f64 = max(1.0, moment.x.abs() / limits.x);
    excess = max(excess, moment.y.abs() / limits.y);
    excess = max(excess, moment.z.abs() / limits.z);
    moment.divided(excess)
}

/// Returns the torque (N m) of a moment (A m²) in a field (T); 0 in one that is not finite.
pub fn torque_of_moment(moment: &Vector3, field: &Vector3) -> Vector3 {
    if !field.norm_squared().is_finite() {
        return Vector3::ZERO;
    }
    moment.cross(field)
}
