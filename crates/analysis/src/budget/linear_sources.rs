//! Sources of a pointing index by the linear loop of a scenario: the deviation under steady disturbances, the sines under
//! periodic ones, and noise.

use std::f64::consts::FRAC_PI_2;

use flexsc_spacecraft::axes::Axis;
use nalgebra::Complex;

use super::ErrorSources;
use super::linear_noise::{linear_noise, output_names};
use crate::margins::frequency_response::{modulus, unit_circle};
use crate::noise::{LineLoop, NoisyLoop};
use flexsc_scenario::{IndexWindow, SampledError, Scenario, WindowConvention};

/// Returns the sources of the index of one component of an error about the target at rest: the deviation under the steady
/// torques of all disturbances together, the amplitude under each of their sines and under the periodic torque of the body, and the rms of the noise. `None` if the
/// loop has no such output or is not linear. Pulses, forces and the imbalance of wheels are left out.
pub fn linear_sources(scenario: &Scenario, noisy: &NoisyLoop, error: &SampledError) -> Option<ErrorSources> {
    let noise = linear_noise(noisy, error)?;
    let lines = LineLoop::from_scenario(scenario).ok()?;
    let outputs: Vec<usize> = output_names(error).iter().filter_map(|name| noisy.output(name)).collect();
    let &[output] = &outputs[..] else { return None };
    // Deviation, or amplitude, under torques amplitude sin(w t + phase) together.
    let amplitude = |frequency: f64, torques: &[(usize, f64, f64)]| -> Option<f64> {
        let found = lines.lines(frequency, &[lines.torques(torques)], &[output]).ok()?;
        Some(window_factor(error, frequency) * found.first()?.first()?.direct.amplitude)
    };
    let torques = scenario.disturbance.iter().filter(|own| own.force.is_none() && own.pulse.is_none());
    let axis = |about: Option<Axis>| about.map_or(0, Axis::index);
    let own = scenario.model.three_axis().and_then(|body| body.disturbance);
    let mut steady: Vec<(usize, f64, f64)> =
        torques.clone().map(|own| (axis(own.about), own.torque.get(), FRAC_PI_2)).collect();
    steady.extend(own.iter().flat_map(|own| (0..3).map(|axis| (axis, own.constant[axis], FRAC_PI_2))));
    let mut biases = Vec::new();
    if steady.iter().any(|(_, torque, _)| *torque != 0.0) {
        biases.push(amplitude(0.0, &steady)?);
    }
    let mut amplitudes = Vec::new();
    for disturbance in torques {
        for sine in &disturbance.sines {
            let torque = (axis(disturbance.about), sine.amplitude.get(), 0.0);
            amplitudes.push(amplitude(sine.frequency.get(), &[torque])?);
        }
    }
    if let Some(own) = own.filter(|own| own.amplitude.norm() > 0.0) {
        let torques = [0, 1, 2].map(|axis| (axis, own.amplitude[axis], own.phase[axis]));
        amplitudes.push(amplitude(own.frequency(), &torques)?);
    }
    Some(ErrorSources { biases, amplitudes, noise })
}

/// Returns the factor of an index on the amplitude of a sine of a frequency (rad/s); of a uniform relative error, that on its
/// rms.
fn window_factor(error: &SampledError, frequency: f64) -> f64 {
    let length = |samples: u64| samples as f64 * error.period.seconds();
    // Mean of exp(j w t) over a window about its middle.
    let mean = |samples: u64| {
        let half = 0.5 * frequency * length(samples);
        if half.abs() < 1e-8 { 1.0 } else { libm::sin(half) / half }
    };
    match error.index {
        IndexWindow::Absolute => 1.0,
        IndexWindow::Mean { window } => mean(window).abs(),
        IndexWindow::Relative { window, convention } => match convention {
            WindowConvention::Uniform => f64::sqrt((1.0 - mean(window) * mean(window)).max(0.0)),
            WindowConvention::Middle => (1.0 - mean(window)).abs(),
            WindowConvention::End => {
                let late = unit_circle(-0.5 * frequency * length(window)) * mean(window);
                modulus(Complex::new(1.0, 0.0) - late)
            }
        },
        IndexWindow::Difference { window, shift, .. } => {
            let apart = Complex::new(1.0, 0.0) - unit_circle(frequency * length(shift));
            mean(window).abs() * modulus(apart)
        }
    }
}

#[cfg(test)]
mod tests {
    use flexsc_numerics::time::{Instant, Span};

    use super::*;
    use flexsc_scenario::SampledQuantity;

    /// Amplitude 1, w = 2 rad/s, T = 10 s, S = 60 s: rms of MPE, uniform RPE and PDE, by spectrum and by quadrature in time.
    #[test]
    fn a_sine_in_windows() {
        let error = |index: IndexWindow| SampledError {
            quantity: SampledQuantity::PointingError,
            axis: None,
            index,
            period: Span::from_seconds(0.1),
            from: Instant::START,
            to: Instant::START,
            samples: 1,
        };
        let rms = |index: IndexWindow| window_factor(&error(index), 2.0) / std::f64::consts::SQRT_2;
        let relative = |convention| IndexWindow::Relative { window: 100, convention };
        for (found, expected) in [
            (rms(IndexWindow::Absolute), std::f64::consts::FRAC_1_SQRT_2),
            (rms(IndexWindow::Mean { window: 100 }), 0.038_468_101_661_9),
            (rms(relative(WindowConvention::Uniform)), 0.706_059_632_86),
        ] {
            assert!((found / expected - 1.0).abs() < 1e-10, "{found} {expected}");
        }
    }
}
