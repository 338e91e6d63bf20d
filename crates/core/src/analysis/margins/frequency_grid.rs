//! Frequencies that follow the resonances of a loop.
//!
//! Angles in (0, pi] of a point on the unit circle: 200 in a decade, and about each pole l, at theta = arg l and delta =
//! -ln |l|, the angles theta + delta tan(x) with x uniform, which are equal steps of the phase of that resonance.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::Complex;

use super::frequency_response::modulus;

/// Angles in a decade.
const DECADE: f64 = 200.0;
/// Angles on either side of a pole with much damping, and with little.
const SIDES: [u32; 2] = [20, 200];
/// Damping ratio below which a pole has little damping.
const LIGHT: f64 = 0.1;
/// Smallest half width of a resonance.
const NARROWEST: f64 = 1e-7;
/// Poles below this magnitude are states of one sample, without a frequency.
const SHORT: f64 = 1e-12;
/// Smallest angle, relative to the smallest natural frequency.
const LOWEST: f64 = 0.01;

/// Returns the angles for a loop with these poles, open or closed, in increasing order.
pub fn frequency_grid(poles: &[Complex<f64>]) -> Vec<f64> {
    let lasting: Vec<(f64, f64)> =
        poles.iter().filter(|pole| modulus(**pole) > SHORT).map(|pole| resonance(*pole)).collect();
    let sizes = lasting.iter().map(|(angle, width)| libm::hypot(*angle, *width));
    // Rigid motion has no frequency.
    let smallest = sizes.filter(|size| *size > 1e-6).fold(PI, f64::min);
    let low = LOWEST * smallest;
    let count = libm::ceil(DECADE * libm::log10(PI / low)) as u32;
    let step = libm::log(PI / low) / f64::from(count);
    let mut angles: Vec<f64> = (0..count).map(|k| low * libm::exp(f64::from(k) * step)).collect();
    for (angle, width) in lasting {
        let width = width.max(NARROWEST);
        let sides = SIDES[usize::from(width < LIGHT * angle)];
        for k in 1..=sides {
            let offset = width * libm::tan(FRAC_PI_2 * f64::from(k) / f64::from(sides + 1));
            angles.extend([angle - offset, angle + offset]);
        }
        if angle > 0.0 && width > NARROWEST {
            angles.push(angle);
        }
    }
    angles.retain(|angle| (low..PI).contains(angle));
    angles.push(PI);
    angles.sort_by(f64::total_cmp);
    angles.dedup();
    angles
}

/// Returns the angle and the half width of the resonance of a pole.
fn resonance(pole: Complex<f64>) -> (f64, f64) {
    (libm::atan2(pole.im, pole.re).abs(), libm::log(modulus(pole)).abs())
}

#[cfg(test)]
mod tests {
    use super::super::frequency_response::unit_circle;
    use super::*;

    #[test]
    fn a_resonance_has_equal_steps_of_phase() {
        let width = 1e-4;
        let grid = frequency_grid(&[unit_circle(0.5) * libm::exp(-width)]);
        let phase = |angle: f64| libm::atan((angle - 0.5) / width);
        let near = grid.iter().filter(|angle| (*angle - 0.5).abs() < 20.0 * width);
        let phases: Vec<f64> = near.map(|angle| phase(*angle)).collect();
        let widest = phases.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
        assert!(widest < FRAC_PI_2 / 200.0, "{widest}");
        assert!(grid.windows(2).all(|pair| pair[0] < pair[1] && pair[1] < 1.012 * pair[0]));
        assert!(grid.last() == Some(&PI) && grid[0] < 0.0051);
    }
}
