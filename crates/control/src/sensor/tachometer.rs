//! A tachometer on each wheel: pulses counted over its period, or the speed itself, with noise and failures.

use std::f64::consts::TAU;
use std::num::NonZeroU32;

use flexsc_numerics::quantity::NonNegative;
use flexsc_numerics::random::{Seed, Stream};
use flexsc_numerics::time::{Instant, Span};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{MeasuredQuantity, Reading, Sensor, SensorFailure, SensorSpec, Subject, Truth};
use crate::offers::Offers;
use crate::part::Part;
use crate::requirement::{ROTATION, Requirements};

/// Tachometers, one on each wheel of `[actuator.wheels]`.
///
/// The readings are the only speeds that the drives use: for friction compensation, for the speed bias, and for the momentum
/// that the law and unloading use. Between two readings the last one is kept.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tachometer {
    /// Period of the readings (s).
    pub period: Span,
    /// Pulses per turn: a reading is the count over a period divided by the period, and the remainder carries over to the next
    /// one. By default, the speed at the instant is read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pulses: Option<NonZeroU32>,
    /// Standard deviation of the white noise of each reading (rad/s).
    #[serde(default)]
    pub noise: NonNegative,
    /// Intervals in which the tachometers fail; the drives then keep the last reading.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<SensorFailure>,
}

/// Run-time state of the tachometers.
#[derive(Clone, Debug)]
pub struct TachometerState {
    spec: Tachometer,
    noise: Vec<Stream>,
    /// Pulses counted at the last reading.
    counted: Vec<f64>,
    /// Last readings (rad/s).
    speeds: Vec<f64>,
    next: Instant,
}

impl SensorSpec for Tachometer {
    fn start(&self, _: usize, _: Seed, _: usize) -> Box<dyn Sensor> {
        Box::new(NoMeasurement)
    }

    fn period(&self, _: Option<Span>) -> Option<Span> {
        None
    }

    fn own_period(&self) -> Option<Span> {
        Some(self.period)
    }

    fn subject(&self) -> Subject {
        Subject::Other
    }

    fn faults(&self) -> &[SensorFailure] {
        &self.faults
    }

    fn requires(&self, ordinal: usize, offers: &Offers, needs: &mut Requirements) {
        let has_wheels = offers.lists_actuator(|actuator| actuator.has_reaction_wheels);
        needs.require(has_wheels, "", "is on the wheels of `[actuator.wheels]`, and there are none");
        needs.require(
            offers.sensors.motion_sensors > 0,
            "",
            "measures only wheels: list a sensor of the body beside it, such as \"continuous\", which gives the exact motion",
        );
        needs.require(ordinal == 0, "", "is on each wheel already: list only one");
        needs.require(offers.body.is_two_way, "", ROTATION);
    }

    fn measured_quantities(&self, _: bool, _: usize) -> Vec<MeasuredQuantity> {
        Vec::new()
    }
}

impl TachometerState {
    /// Creates the tachometers of wheels with these initial speeds (rad/s), which are the readings at the start.
    pub fn new(spec: &Tachometer, speeds: Vec<f64>, seed: Seed) -> Self {
        Self {
            noise: (1..=speeds.len()).map(|wheel| seed.stream(&format!("tachometer {wheel}"))).collect(),
            counted: vec![0.0; speeds.len()],
            speeds,
            next: Instant::START + spec.period,
            spec: spec.clone(),
        }
    }

    /// Returns the time of the next reading.
    pub fn due(&self) -> Instant {
        self.next
    }

    /// Reads the wheels, each with its angle (rad) and its speed (rad/s) relative to the body.
    pub fn read(&mut self, now: Instant, wheels: impl Iterator<Item = [f64; 2]>) {
        let Self { spec, noise, counted, speeds, next } = self;
        *next = now + spec.period;
        let fails = spec.faults.iter().any(|fault| fault.interval().contains(now));
        let each = wheels.zip(noise).zip(counted).zip(speeds);
        for ((([angle, speed], noise), counted), known) in each {
            let mut read = speed;
            if let Some(pulses) = spec.pulses {
                let quantum = TAU / f64::from(pulses.get());
                let count = libm::floor(angle / quantum);
                read = (count - *counted) * quantum / spec.period.seconds();
                *counted = count;
            }
            // Random numbers are drawn during a failure too.
            if spec.noise.get() > 0.0 {
                read += spec.noise.get() * noise.normal();
            }
            if !fails {
                *known = read;
            }
        }
    }

    /// Returns the last readings (rad/s).
    pub fn speeds(&self) -> &[f64] {
        &self.speeds
    }
}

/// Placeholder for sensors that do not measure the body's motion.
#[derive(Copy, Clone, Debug)]
pub(super) struct NoMeasurement;

impl Part for NoMeasurement {}

impl Sensor for NoMeasurement {
    fn read(&mut self, _: Instant, _: &Truth, _: Option<&Reading>) -> Option<Reading> {
        None
    }

    fn copy(&self) -> Box<dyn Sensor> {
        Box::new(*self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn start(keys: &str) -> TachometerState {
        let spec: Tachometer = flexsc_formats::document::from_text(&format!("period = 0.1\n{keys}")).unwrap();
        TachometerState::new(&spec, vec![10.0], Seed { scenario: 1, run: 0 })
    }

    fn read(tachometer: &mut TachometerState, k: i32, angle: f64, speed: f64) -> f64 {
        tachometer
            .read(Instant::START + Span::from_seconds(0.1 * f64::from(k)), [[angle, speed]].into_iter());
        tachometer.speeds()[0]
    }

    /// Checks that 24 pulses per turn are 2.618 rad/s per pulse in 0.1 s, and that the remainder counts in the next
    /// reading.
    #[test]
    fn pulses_are_counted_and_none_is_lost() {
        let mut tachometer = start("pulses = 24");
        assert_eq!(tachometer.speeds(), [10.0]);
        let quantum = TAU / 24.0 / 0.1;
        let mut sum = 0.0;
        for k in 1..=1000 {
            let speed = read(&mut tachometer, k, 1.0 * 0.1 * f64::from(k), 1.0);
            assert!(speed == 0.0 || (speed - quantum).abs() < 1e-12);
            sum += speed;
        }
        // 100 rad are 381 pulses and a fraction.
        assert!((sum * 0.1 - 381.0 * TAU / 24.0).abs() < 1e-9, "{sum}");
        // In the negative direction the first pulse comes at once.
        let mut tachometer = start("pulses = 24");
        assert!((read(&mut tachometer, 1, -1e-6, -1e-5) + quantum).abs() < 1e-12);
    }

    #[test]
    fn without_pulses_it_reads_the_speed_and_a_failure_keeps_the_last() {
        let mut tachometer = start("faults = [{ silent = { from = 0.25, to = 0.45 } }]");
        let speeds: Vec<f64> = (1..=6).map(|k| read(&mut tachometer, k, 0.0, f64::from(k))).collect();
        assert_eq!(speeds, [1.0, 2.0, 2.0, 2.0, 5.0, 6.0]);
        let mut noisy = start("noise = 0.5");
        let square: f64 = (1..=4000).map(|k| read(&mut noisy, k, 0.0, 0.0)).map(|speed| speed * speed).sum();
        assert!((f64::sqrt(square / 4000.0) - 0.5).abs() < 0.02);
    }
}
