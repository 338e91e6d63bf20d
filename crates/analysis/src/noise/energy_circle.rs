//! Energy of an image within circles: the radii of the motion of a line of sight about both axes across it.
//!
//! Gaussian motion of the covariance C has the part 1 - mean exp(-r²/(2 m)) of its time within a radius r, where m = a cos² p + b sin² p
//! with the eigenvalues a and b of C, and the mean is over p: the polar form of two unequal axes. It is Rayleigh's for a = b alone. Over an
//! exposure C depends on the time, and the part is the mean over it.

use std::f64::consts::PI;

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::scalar_search::root;
use nalgebra::Matrix3;
use schemars::JsonSchema;
use serde::Serialize;

use super::exposed_motion::{ExposedMotion, instants};
use super::lines::LineLoop;
use super::noisy_loop::{NoiseError, NoisyLoop};
use super::output::DIAGONALS;
use super::vibration::Vibration;

/// Angles over a quarter turn of the polar form, by the midpoint rule, which converges faster than any power.
const ANGLES: u32 = 96;
/// Parts of the energy.
const PARTS: [f64; 3] = [0.5, 0.8, 0.95];
/// Radius, relative to the largest rms, within which there is more than any of these parts.
const FARTHEST: f64 = 4.0;

/// Circles about the mean place of a point of an image, which moves with a line of sight under noise and broadband loads: lines are not in
/// them.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(extend("x-dict" = true))]
pub struct EnergyCircle {
    /// Number of the line of sight.
    pub line: usize,
    /// Rms over the exposure along the longer axis of the blur (rad).
    pub major_rms_rad: f64,
    /// Rms along the shorter axis (rad).
    pub minor_rms_rad: f64,
    /// Radius that has half of the energy (rad).
    pub radius_50_rad: f64,
    /// Radius that has 80 % of the energy (rad).
    pub radius_80_rad: f64,
    /// Radius that has 95 % of the energy (rad).
    pub radius_95_rad: f64,
}

/// Names of the outputs of the circles of a line of sight: about each axis, and about the axis between each pair.
fn circle_outputs(line: usize) -> impl Iterator<Item = String> {
    let names = ["x", "y", "z"].into_iter().chain(DIAGONALS.map(|(_, name)| name));
    names.map(move |name| format!("line_of_sight{line}_{name}"))
}

impl EnergyCircle {
    /// Returns the circles of each line of sight of a loop over exposures (s), or over one without end, under its noise and broadband
    /// loads.
    ///
    /// # Errors
    /// See [`NoisyLoop::window_variances`].
    pub fn all(
        noisy: &NoisyLoop,
        lines: &LineLoop<'_>,
        exposure: Option<f64>,
    ) -> Result<Vec<Self>, NoiseError> {
        let sights = &lines.parts.scenario.line_of_sight;
        let outputs: Vec<usize> =
            (0..sights.len()).flat_map(circle_outputs).filter_map(|name| noisy.output(&name)).collect();
        let vibration = Vibration::gaussian(lines, &outputs)?;
        let of_line = |line: usize| -> Result<Self, String> {
            let motion = |name: String| {
                let output = noisy.output(&name);
                output.map(|output| ExposedMotion::new(noisy, &vibration, output, exposure)).transpose()
            };
            let motions = circle_outputs(line).map(motion).collect::<Result<Vec<_>, _>>()?;
            let fastest = motions.iter().flatten().map(ExposedMotion::fastest).fold(0.0, f64::max);
            let variance = |place: usize, time: f64| -> f64 {
                motions[place].as_ref().map_or(0.0, |motion| motion.variances(time).iter().sum())
            };
            let covariance = |time: f64| {
                let mut all = Matrix3::from_diagonal(&Vector::from_fn(|axis, _| variance(axis, time)));
                for (number, ([one, other], _)) in DIAGONALS.iter().enumerate() {
                    if motions[3 + number].is_some() {
                        let sum = 0.5 * (all[(*one, *one)] + all[(*other, *other)]);
                        all[(*one, *other)] = variance(3 + number, time) - sum;
                        all[(*other, *one)] = all[(*one, *other)];
                    }
                }
                all
            };
            let each: Vec<(f64, Matrix3<f64>)> = instants(exposure, fastest)
                .into_iter()
                .map(|(time, part)| (part, covariance(time)))
                .collect();
            Ok(Self::new(line, &each))
        };
        (0..sights.len()).map(of_line).collect::<Result<_, _>>().map_err(NoiseError::Request)
    }

    /// Returns the circles of covariances (rad²), each with its part of the exposure.
    fn new(line: usize, covariances: &[(f64, Matrix3<f64>)]) -> Self {
        let whole: Matrix3<f64> = covariances.iter().map(|(part, covariance)| covariance * *part).sum();
        let [major, minor] = largest_eigenvalues(&whole).map(f64::sqrt);
        let axes: Vec<(f64, [f64; 2])> =
            covariances.iter().map(|(part, covariance)| (*part, largest_eigenvalues(covariance))).collect();
        let [half, four_fifths, most] = PARTS.map(|part| radius(&axes, part));
        Self {
            line,
            major_rms_rad: major,
            minor_rms_rad: minor,
            radius_50_rad: half,
            radius_80_rad: four_fifths,
            radius_95_rad: most,
        }
    }
}

/// Returns the two larger eigenvalues of a covariance: across the line of sight, along which the third is 0.
fn largest_eigenvalues(covariance: &Matrix3<f64>) -> [f64; 2] {
    let mut values: Vec<f64> =
        covariance.symmetric_eigenvalues().iter().map(|value| value.max(0.0)).collect();
    values.sort_by(|a, b| b.total_cmp(a));
    [values[0], values[1]]
}

/// Returns the part of the energy within a radius, of variances along two axes, each pair with its part of the time.
fn energy(axes: &[(f64, [f64; 2])], radius: f64) -> f64 {
    let square = radius * radius;
    let outside = |[major, minor]: [f64; 2]| {
        let at = |step: u32| {
            let angle = 0.5 * PI * (f64::from(step) + 0.5) / f64::from(ANGLES);
            let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
            let variance = major * cosine * cosine + minor * sine * sine;
            if variance > 0.0 { libm::exp(-0.5 * square / variance) } else { 0.0 }
        };
        (0..ANGLES).map(at).sum::<f64>() / f64::from(ANGLES)
    };
    axes.iter().map(|(part, variances)| part * (1.0 - outside(*variances))).sum()
}

/// Returns the radius with a part of the energy.
fn radius(axes: &[(f64, [f64; 2])], part: f64) -> f64 {
    let largest = axes.iter().map(|(_, [major, _])| *major).fold(0.0, f64::max).sqrt();
    if largest > 0.0 { largest * root(|r| energy(axes, largest * r) - part, 0.0, FARTHEST) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(found: f64, exact: f64) {
        assert!((found / exact - 1.0).abs() < 1e-13, "{found:.16e} {exact:.16e}");
    }

    /// Rayleigh's radii of equal axes, r² = -2 ln(1 - p); those of one axis alone, by the normal distribution; and between them.
    /// Source: tests/golden/energy_circle.py.
    #[test]
    fn radii_are_those_of_two_normal_axes() {
        let of = |variances: [f64; 2], part: f64| radius(&[(1.0, variances)], part);
        for part in PARTS {
            close(of([4.0, 4.0], part), 2.0 * f64::sqrt(-2.0 * libm::log(1.0 - part)));
        }
        close(of([1.0, 0.0], 0.5), 0.674_489_750_196_081_7);
        close(of([1.0, 0.0], 0.95), 1.959_963_984_540_054_2);
    }
}
