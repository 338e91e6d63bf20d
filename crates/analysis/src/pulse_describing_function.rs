//! Describing function of pulse-width modulation, and the limit cycles that it predicts in a sampled loop.
//!
//! A pulse of the length tau in each period T answers the demand u = A sin phi: tau = T |u|/U, from the start of the period
//! or about its middle, up to the whole period at the torque U. Where a period and the swing have no common multiple, the
//! first harmonic over the demand is N = (2j/(pi A)) times the integral of U f(phi) exp(-j phi) over half a turn, with f =
//! (1 - exp(-j w tau))/(j w T) from the start, and f = exp(-j w T/2) 2 sin(w tau/2)/(w T) about the middle. Impulse that
//! thrusters keep for the next period is left out.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use flexsc_control::actuator::PulseWidth;
use flexsc_formats::document::{ConfigError, Document, key};
use flexsc_numerics::quadrature::integral;
use flexsc_numerics::scalar_search::root;
use nalgebra::Complex;
use serde::Serialize;
use toml::Value;

use super::margins::frequency_response::{modulus, unit_circle};
use super::margins::{PhaseCrossing, StabilityMargins};
use super::open_loop::{LoopBreak, OpenLoop};
use flexsc_scenario::Scenario;

/// Largest number of lengths of a pulse that a quantum makes.
const MOST_STEPS: f64 = 10_000.0;
/// Longest panel of the quadrature (rad).
const PANEL: f64 = 0.5;
/// Number of amplitudes in a decade between which a balance is looked for.
const PER_DECADE: u32 = 60;
/// Decades of amplitude above the torque of a pulse.
const DECADES: u32 = 4;

/// Place of a pulse in its period.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum PulsePlacement {
    /// From the start of the period.
    Start,
    /// About its middle.
    Middle,
}

/// Modulator of pulse widths.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct PulseModulator {
    /// Torque of a pulse (N m).
    pub torque: f64,
    /// Period of the pulses (s).
    pub period: f64,
    /// Shortest pulse, and quantum of the length.
    pub width: PulseWidth,
    /// Place of a pulse.
    pub placement: PulsePlacement,
}

/// Limit cycle that the describing function of pulses predicts.
#[derive(Copy, Clone, Debug, PartialEq, Serialize)]
pub struct PulseCycle {
    /// Amplitude of the demanded torque (N m).
    pub torque_amplitude_nm: f64,
    /// Period (s).
    pub period_s: f64,
    /// True if the amplitude returns after a small deviation.
    pub stable: bool,
}

/// Limit cycles of a loop with pulses, and the loop without them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PulsedLoop {
    /// Frequencies (rad/s) at which the loop with a held torque has a gain margin, with the factor of the margin.
    pub crossings: Vec<PhaseCrossing>,
    /// Cycles that are predicted.
    pub cycles: Vec<PulseCycle>,
}

impl PulseModulator {
    /// Returns N at an amplitude of the demand (N m) and a frequency (rad/s).
    pub fn value(&self, amplitude: f64, frequency: f64) -> Complex<f64> {
        let turn = frequency * self.period;
        let length = |phi: f64| {
            self.width.on_time(self.period * (amplitude / self.torque) * libm::sin(phi), self.period)
        };
        let response = |on: f64| match self.placement {
            PulsePlacement::Start => {
                (Complex::new(1.0, 0.0) - unit_circle(-frequency * on)) / Complex::new(0.0, turn)
            }
            PulsePlacement::Middle => {
                unit_circle(-0.5 * turn) * (2.0 * libm::sin(0.5 * frequency * on) / turn)
            }
        };
        let breaks = self.breaks(amplitude);
        // The length is that of the middle of a piece with steps: nodes lie on one side of each of them.
        let part = |of: fn(Complex<f64>) -> f64| {
            integral(&breaks, PANEL, |_, phi| of(response(length(phi)) * unit_circle(-phi)))
        };
        let sum = Complex::new(part(|value| value.re), part(|value| value.im));
        sum * Complex::new(0.0, 2.0 * self.torque / (PI * amplitude))
    }

    /// Returns the phases from 0 to pi between which the length of a pulse is smooth.
    fn breaks(&self, amplitude: f64) -> Vec<f64> {
        let (minimum, quantum) = (self.width.minimum.get(), self.width.quantum.get());
        let largest = self.period * amplitude / self.torque;
        let mut lengths = vec![self.period, minimum];
        if quantum > 0.0 {
            let steps = libm::ceil(largest.min(self.period) / quantum).min(MOST_STEPS) as u32;
            lengths.extend((0..=steps).map(|step| (f64::from(step) + 0.5) * quantum));
        }
        lengths.retain(|length| *length > 0.0 && *length < largest);
        lengths.sort_by(f64::total_cmp);
        let rising: Vec<f64> = lengths.iter().map(|length| libm::asin(length / largest)).collect();
        let mut all = vec![0.0];
        all.extend(&rising);
        all.push(FRAC_PI_2);
        all.extend(rising.iter().rev().map(|phi| PI - phi));
        all.push(PI);
        all
    }

    /// Returns the magnitude of N relative to that of a torque that is held over the period.
    pub fn relative_gain(&self, amplitude: f64, frequency: f64) -> f64 {
        let half = 0.5 * frequency * self.period;
        modulus(self.value(amplitude, frequency)) * half / libm::sin(half)
    }

    /// Returns the cycles at a frequency (rad/s) at which the loop with a held torque reaches the limit of stability with a
    /// factor on its gain.
    fn cycles_at(&self, crossing: &PhaseCrossing) -> Vec<PulseCycle> {
        let least = self.torque * self.width.shortest().max(1e-3 * self.period) / self.period;
        let excess =
            |amplitude: f64| self.relative_gain(amplitude, crossing.frequency_rad_s) - crossing.factor;
        let decades = f64::from(DECADES) + libm::log10(self.torque / least);
        let count = libm::ceil(decades * f64::from(PER_DECADE)) as u32;
        let amplitude = |step: u32| least * libm::pow(10.0, decades * f64::from(step) / f64::from(count));
        let cycle = |step: u32| {
            let (low, high) = (amplitude(step), amplitude(step + 1));
            let (first, last) = (excess(low), excess(high));
            if first.signum() == last.signum() {
                return None;
            }
            let found = root(excess, low, high);
            // A loop that is stable with a higher gain returns where the gain rises with the amplitude.
            let rises = last > first;
            Some(PulseCycle {
                torque_amplitude_nm: found,
                period_s: TAU / crossing.frequency_rad_s,
                stable: rises == (crossing.factor < 1.0),
            })
        };
        (0..count).filter_map(cycle).collect()
    }
}

impl PulsedLoop {
    /// Predicts the limit cycles of a scenario about one axis with a sampled linear law and `thrusters`.
    ///
    /// # Errors
    /// A scenario without such a loop: the key, and the reason.
    pub fn from_scenario(scenario: &Scenario) -> Result<Self, ConfigError> {
        let Some((thrusters, at)) = scenario.actuator.thrusters() else {
            return Err(ConfigError::new(
                "actuator",
                "has no `thrusters`, whose pulses have a describing function",
            ));
        };
        let period = thrusters.period.seconds();
        let modulator = PulseModulator {
            torque: thrusters.torque.about(0).get(),
            period,
            width: thrusters.width(),
            placement: PulsePlacement::Middle,
        };
        let mut table = scenario.self_contained().to_table();
        key::set(&mut table, "actuator", Value::String("ideal".to_owned()))
            .map_err(|why| ConfigError::new("actuator", why))?;
        let held = Scenario::from_document(&Document::from_table(&scenario.name, table))
            .map_err(|error| ConfigError::new("actuator", error.to_string()))?;
        let opened = OpenLoop::from_scenario(&held, LoopBreak::Command)?;
        if (opened.period / period - 1.0).abs() > 1e-9 {
            let why = format!(
                "must have the period of the law, {} s: the describing function has one period, got {period} s",
                opened.period
            );
            return Err(ConfigError::new(format!("{at}.period"), why));
        }
        let margins =
            StabilityMargins::new(&opened).map_err(|fault| ConfigError::new("law", fault.to_string()))?;
        let crossings = margins.loops.first().map(|own| own.crossings.phase.clone()).unwrap_or_default();
        let cycles = crossings.iter().flat_map(|crossing| modulator.cycles_at(crossing)).collect();
        Ok(Self { crossings, cycles })
    }
}

#[cfg(test)]
mod tests {
    use flexsc_numerics::quantity::NonNegative;

    use super::*;

    fn modulator(minimum: f64, placement: PulsePlacement) -> PulseModulator {
        let width = PulseWidth {
            minimum: NonNegative::new(minimum).expect("not negative"),
            quantum: NonNegative::default(),
        };
        PulseModulator { torque: 2.0, period: 0.5, width, placement }
    }

    /// At w T = 0.5, by integrals of the harmonic in another program.
    #[test]
    fn values_of_pulses() {
        use PulsePlacement::{Middle, Start};
        for (share, minimum, placement, re, im) in [
            (0.5, 0.0, Start, 0.992_207_818_581_8, -0.105_661_987_006_8),
            (1.0, 0.1, Start, 0.968_648_243_887_9, -0.208_686_993_655_5),
            (2.0, 0.0, Start, 0.584_858_736_486_8, -0.145_748_548_313_4),
            (0.5, 0.1, Middle, 0.963_691_355_696_3, -0.246_070_802_227_6),
        ] {
            let found = modulator(0.5 * minimum, placement).value(2.0 * share, 1.0);
            let off = found - Complex::new(re, im);
            assert!(libm::hypot(off.re, off.im) < 1e-12, "{share} {minimum}: {found}");
        }
    }

    /// Without a shortest pulse, small demands are held: 1 relative to the hold but for the moment of the impulse.
    #[test]
    fn small_pulses_have_the_gain_of_their_impulse() {
        let half = 0.25;
        let found = modulator(0.0, PulsePlacement::Middle).relative_gain(1e-4, 1.0);
        assert!((found * libm::sin(half) / half - 1.0).abs() < 1e-8, "{found}");
    }
}
