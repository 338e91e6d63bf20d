//! Momentum stored in reaction wheels, by their measured speeds.

use crate::vector3::Vector3;

/// Returns the momentum (N m s, body axes) of wheels about these axes, each with this inertia (kg m²), that turn with `speeds`
/// (rad/s) relative to a body with the estimated rate `rate` (rad/s). It is absolute: the rate is part of it. A speed that is not
/// finite counts as 0.
#[inline]
pub fn stored(axes: &[Vector3], inertia: f64, speeds: &[f64], rate: &Vector3) -> Vector3 {
    let mut sum: Vector3 = Vector3::ZERO;
    for index in 0..axes.len() {
        let speed: f64 = if speeds[index].is_finite() { speeds[index] } else { 0.0 };
        let momentum: f64 = inertia * (speed + axes[index].dot(rate));
        let own: Vector3 = axes[index].scaled(momentum);
        sum = sum.plus(&own);
    }
    sum
}
