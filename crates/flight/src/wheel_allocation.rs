//! Allocation of a three-axis torque to wheels: the sum of axis times torque over the wheels is the demanded torque.

use crate::vector3::Vector3;

/// Wheel in an allocation.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct AllocatedWheel {
    /// Torque of the wheel per unit of the demanded torque about each axis.
    pub share: Vector3,
    /// Torque of the wheel in a set of torques that cancel each other; 0 if the torques are those of the least squares.
    pub null: f64,
    /// Torque of the wheel on the body (N m).
    pub torque: f64,
}

/// Writes the torques of all wheels that give a demanded torque about the three axes (N m): those with the smallest sum of
/// squares, or with `is_least_largest` those whose largest is smallest.
#[inline]
pub fn allocate(wheels: &mut [AllocatedWheel], demanded: &Vector3, is_least_largest: bool) {
    for index in 0..wheels.len() {
        wheels[index].torque = wheels[index].share.dot(demanded);
    }
    if is_least_largest {
        let part: f64 = least_largest(wheels);
        for index in 0..wheels.len() {
            wheels[index].torque += part * wheels[index].null;
        }
    }
}

/// Returns the largest torque (N m) after `part` times the cancelling torques are added.
#[inline]
fn largest(wheels: &[AllocatedWheel], part: f64) -> f64 {
    let mut most: f64 = 0.0;
    for index in 0..wheels.len() {
        let size: f64 = (wheels[index].torque + part * wheels[index].null).abs();
        if size > most {
            most = size;
        }
    }
    most
}

/// Returns the multiple of the cancelling torques that minimises the largest torque: two of them are equally large there. Of
/// several such multiples it is the smallest.
#[inline]
fn least_largest(wheels: &[AllocatedWheel]) -> f64 {
    let mut best: f64 = 0.0;
    let mut least: f64 = largest(wheels, 0.0);
    for i in 0..wheels.len() {
        for j in 0..i {
            for sign in 0..2 {
                let u: f64 = wheels[i].torque;
                let n: f64 = wheels[i].null;
                let v: f64 = wheels[j].torque;
                let m: f64 = wheels[j].null;
                let part: f64 = if sign == 0 { (v - u) / (n - m) } else { -(u + v) / (n + m) };
                // Parallel lines do not intersect.
                if part.is_finite() {
                    let found: f64 = largest(wheels, part);
                    if found < least || (found == least && part.abs() < best.abs()) {
                        least = found;
                        best = part;
                    }
                }
            }
        }
    }
    best
}

/// Returns true if all torques are finite.
#[inline]
fn are_finite(wheels: &[AllocatedWheel]) -> bool {
    let mut are_finite: bool = true;
    for index in 0..wheels.len() {
        are_finite = are_finite && wheels[index].torque.is_finite();
    }
    are_finite
}

/// Scales the torques of all wheels down, so that none exceeds a limit (N m) and the whole torque keeps its axis. Where one is not
/// finite, all are 0.
#[inline]
pub fn limit_torques(wheels: &mut [AllocatedWheel], limit: f64) {
    if !are_finite(wheels) {
        for index in 0..wheels.len() {
            wheels[index].torque = 0.0;
        }
    }
    let most: f64 = largest(wheels, 0.0);
    if most > limit {
        for index in 0..wheels.len() {
            wheels[index].torque *= limit / most;
        }
    }
}

/// Gives the wheels the torques that sum up to `counter`, which counteracts a torque, without a demanded torque (N m): the wheels turn
/// the body the other way. No wheel exceeds a limit (N m).
pub fn drive(
    wheels: &mut [AllocatedWheel],
    demanded: &Vector3,
    counter: &Vector3,
    is_least_largest: bool,
    limit: f64,
) {
    let sum: Vector3 = counter.minus(demanded);
    allocate(wheels, &sum, is_least_largest);
    limit_torques(wheels, limit);
}
