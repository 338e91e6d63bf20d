//! Frequencies that follow the resonances of a loop.
//!
//! Angles in (0, pi] of a point on the unit circle: 200 in a decade, and about each pole l, at theta = arg l and delta =
//! -ln |l|, the angles theta + delta tan(x) with x uniform, which are equal steps of the phase of that resonance.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::Complex;

use super::frequency_response::modulus;

/// Density of a grid.
struct Density {
    /// Angles in a decade.
    decade: f64,
    /// Angles on either side of a pole with much damping, and with little.
    sides: [u32; 2],
}

/// Grid on which a curve is drawn, and every crossing is seen.
const FINE: Density = Density { decade: 200.0, sides: [20, 90] };
/// Grid on which every local minimum is seen.
const COARSE: Density = Density { decade: 40.0, sides: [6, 16] };
/// Damping ratio below which a pole has little damping.
const LIGHT: f64 = 0.1;
/// Smallest half width of a resonance.
const NARROWEST: f64 = 1e-7;
/// Poles below this magnitude are states of one sample, without a frequency.
const SHORT: f64 = 1e-12;
/// Distance of two poles, relative to their half widths, below which they are one resonance.
const APART: f64 = 1e-3;
/// Poles of a closed loop this near to 1 do not move.
const STILL: f64 = 1e-5;
/// Smallest angle, relative to the smallest natural frequency of the closed loop.
const LOWEST: f64 = 0.01;

/// Returns the angles for a loop with these poles of the closed loop and others, in increasing order.
pub fn frequency_grid(closed: &[Complex<f64>], others: &[Complex<f64>]) -> Vec<f64> {
    FINE.grid(closed, others)
}

/// Returns fewer angles, which separate the local minima and maxima of a smooth function of the closed loop.
pub fn coarse_frequency_grid(closed: &[Complex<f64>], others: &[Complex<f64>]) -> Vec<f64> {
    COARSE.grid(closed, others)
}

impl Density {
    fn grid(&self, closed: &[Complex<f64>], others: &[Complex<f64>]) -> Vec<f64> {
        let sizes = resonances(closed, APART).into_iter().map(|(angle, width)| libm::hypot(angle, width));
        // Several poles of rigid motion, which only an open loop has, are far from 1 by rounding.
        let smallest = sizes.filter(|size| *size > STILL).fold(PI, f64::min);
        let lasting = resonances(&[closed, others].concat(), APART);
        let low = LOWEST * smallest;
        let count = libm::ceil(self.decade * libm::log10(PI / low)) as u32;
        let step = libm::log(PI / low) / f64::from(count);
        let mut angles: Vec<f64> = (0..count).map(|k| low * libm::exp(f64::from(k) * step)).collect();
        for (angle, width) in lasting {
            let width = width.max(NARROWEST);
            let sides = self.sides[usize::from(width < LIGHT * angle)];
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
}

/// Returns the angles and half widths of the resonances of these poles, in increasing order of the angle: one of those that differ by
/// less than `apart` of their half widths.
pub fn resonances(poles: &[Complex<f64>], apart: f64) -> Vec<(f64, f64)> {
    let resonance = |pole: &Complex<f64>| (libm::atan2(pole.im, pole.re), libm::log(modulus(*pole)).abs());
    let mut all: Vec<(f64, f64)> = poles
        .iter()
        .filter(|pole| modulus(**pole) > SHORT)
        .map(resonance)
        // Of a pair, one.
        .filter(|(angle, _)| *angle >= 0.0)
        .collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut known: Vec<(f64, f64)> = Vec::with_capacity(all.len());
    for (angle, width) in all {
        let near = apart * width.max(NARROWEST);
        let mut before = known.iter().rev().take_while(|(own, _)| angle - own <= near);
        if !before.any(|(_, own)| (own - width).abs() <= near) {
            known.push((angle, width));
        }
    }
    known
}

#[cfg(test)]
mod tests {
    use super::super::frequency_response::unit_circle;
    use super::*;

    #[test]
    fn a_resonance_has_equal_steps_of_phase() {
        let width = 1e-4;
        let grid = frequency_grid(&[unit_circle(0.5) * libm::exp(-width)], &[]);
        let phase = |angle: f64| libm::atan((angle - 0.5) / width);
        let near = grid.iter().filter(|angle| (*angle - 0.5).abs() < 20.0 * width);
        let phases: Vec<f64> = near.map(|angle| phase(*angle)).collect();
        let widest = phases.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
        assert!(widest < FRAC_PI_2 / 90.0, "{widest}");
        assert!(grid.windows(2).all(|pair| pair[0] < pair[1] && pair[1] < 1.012 * pair[0]));
        assert!(grid.last() == Some(&PI) && grid[0] < 0.0051);
    }
}
