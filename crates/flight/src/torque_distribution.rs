//! Torque of commanded accelerations: J a + w x (J w + h).

use crate::matrix3::Matrix3;
use crate::vector3::Vector3;

/// Returns the torque (N m) that gives the accelerations (rad/s²) to a body with this inertia tensor (kg m²) and estimated rate
/// (rad/s), whose rotors store the momentum `stored` (N m s); all in body axes.
#[inline]
pub fn torque(inertia: &Matrix3, acceleration: &Vector3, rate: &Vector3, stored: &Vector3) -> Vector3 {
    let own: Vector3 = inertia.times(rate);
    let momentum: Vector3 = own.plus(stored);
    let change: Vector3 = inertia.times(acceleration);
    let gyroscopic: Vector3 = rate.cross(&momentum);
    change.plus(&gyroscopic)
}
