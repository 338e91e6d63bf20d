//! Rows of reaction wheels and their bearings, and their stored momentum.

use std::mem;

use flexsc_dynamics::three_axis::RotorObservation;
use flexsc_flight::wheel_momentum;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::flight_types::to_vector3;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{BearingMotion, Bearings, Report, Wheel, Wheels};

use super::{WheelState, WheelsState};
use crate::actuator::MomentumStorage;
use crate::actuator::failure::ActiveFailures;
use crate::part::{Occasion, Part, ReportContext};
use crate::sensor::TachometerState;

impl WheelsState {
    /// Returns the row of the bearings, with the speeds that are available to the drives; `None` without bearings.
    fn bearings(&self, rotors: &[RotorObservation]) -> Option<Bearings> {
        let known: Vec<f64> = match &self.tachometer {
            Some(tachometer) => tachometer.speeds().to_vec(),
            None => self.observations.iter().map(|wheel| wheel.speed).collect(),
        };
        let motion = |(wheel, known_rad_s): (&RotorObservation, f64)| BearingMotion {
            sliding: wheel.slip.into(),
            friction_nm: wheel.friction,
            heat_j: wheel.heat,
            known_rad_s,
        };
        let wheels: Vec<_> = rotors.iter().zip(known).map(motion).collect();
        (!wheels.is_empty()).then_some(Bearings { wheels })
    }
}

impl WheelsState {
    /// Iterates over the motions of the wheels on a body with this rate (rad/s).
    fn motions(&self, now: Instant, rate: Vector) -> impl Iterator<Item = Wheel> {
        let seconds = self.elapsed(now);
        let motion = move |(index, (axis, wheel)): (usize, (&Vector, &WheelState))| Wheel {
            speed_rad_s: self
                .observations
                .get(index)
                .map_or(wheel.momentum_at(seconds) / self.inertia - axis.dot(&rate), |turned| turned.speed),
            momentum_nm_s: wheel.momentum_at(seconds),
            torque_nm: wheel.torque,
        };
        self.allocation.axes().iter().zip(&self.wheels).enumerate().map(motion)
    }
}

impl Part for WheelsState {
    fn due(&self) -> Option<Instant> {
        let read = self.tachometer.as_ref().map(TachometerState::due);
        let failing = self.failing.iter().flatten().filter_map(ActiveFailures::due);
        let waiting = self.waiting.front().map(|(due, _)| *due);
        self.wheels.iter().filter_map(|wheel| wheel.full).chain(read).chain(failing).chain(waiting).min()
    }

    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        if at.occasion == Occasion::Sample {
            return;
        }
        let mut wheels = report.reuse(|row: &mut Wheels| mem::take(&mut row.wheels));
        wheels.clear();
        wheels.extend(self.motions(at.now, at.truth.rates()[0].into()));
        if at.occasion == Occasion::Cycle {
            return report.add_value(Wheels { wheels });
        }
        self.bearings(&at.truth.rotors()).into_iter().for_each(|row| report.add(row));
        report.add(Wheels { wheels });
    }
}

impl MomentumStorage for WheelsState {
    fn stored_momentum(&self, now: Instant) -> [f64; 3] {
        let (seconds, wheels) = (self.elapsed(now), self.allocation.axes().iter().zip(&self.wheels));
        wheels.fold(Vector::zeros(), |sum, (axis, wheel)| sum + axis * wheel.momentum_at(seconds)).into()
    }

    fn known_momentum(&self, now: Instant, rate: [f64; 3], estimated: [f64; 3]) -> [f64; 3] {
        let (axes, speeds) = (self.allocation.flight_axes(), self.wheel_speeds(now, rate));
        let stored = wheel_momentum::stored(axes, self.inertia, &speeds, &to_vector3(&estimated.into()));
        [stored.x, stored.y, stored.z]
    }

    fn commanded_torques(&self) -> Vec<f64> {
        if self.delay > Span::ZERO { Vec::new() } else { self.commanded.clone() }
    }

    fn wheel_speeds(&self, now: Instant, rate: [f64; 3]) -> Vec<f64> {
        match &self.tachometer {
            Some(tachometer) => tachometer.speeds().to_vec(),
            None => self.motions(now, rate.into()).map(|wheel| wheel.speed_rad_s).collect(),
        }
    }

    fn wheels(&self, now: Instant, rate: [f64; 3]) -> Vec<Wheel> {
        self.motions(now, rate.into()).collect()
    }
}
