//! Rows of reaction wheels and their bearings, and their stored momentum.

use flexsc_dynamics::three_axis::RotorObservation;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time::Instant;
use flexsc_record::{self, Report};

use super::{WheelState, WheelsState};
use crate::actuator::MomentumStorage;
use crate::actuator::failure::ActiveFailures;
use crate::part::{Occasion, Part, ReportContext};
use crate::sensor::TachometerState;

impl WheelsState {
    /// Returns the row of the bearings, with the speeds that are available to the drives; `None` without bearings.
    fn bearings(&self, rotors: &[RotorObservation]) -> Option<flexsc_record::Bearings> {
        let known: Vec<f64> = match &self.tachometer {
            Some(tachometer) => tachometer.speeds().to_vec(),
            None => self.observations.iter().map(|wheel| wheel.speed).collect(),
        };
        let motion = |(wheel, known_rad_s): (&RotorObservation, f64)| flexsc_record::BearingMotion {
            sliding: wheel.slip.into(),
            friction_nm: wheel.friction,
            heat_j: wheel.heat,
            known_rad_s,
        };
        let wheels: Vec<_> = rotors.iter().zip(known).map(motion).collect();
        (!wheels.is_empty()).then_some(flexsc_record::Bearings { wheels })
    }
}

impl Part for WheelsState {
    fn due(&self) -> Option<Instant> {
        let read = self.tachometer.as_ref().map(TachometerState::due);
        let failing = self.failing.iter().flatten().filter_map(ActiveFailures::due);
        self.wheels.iter().filter_map(|wheel| wheel.full).chain(read).chain(failing).min()
    }

    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        let wheels = || flexsc_record::Wheels { wheels: self.wheels(at.now, at.truth.rates()[0]) };
        match at.occasion {
            Occasion::Period => {
                self.bearings(&at.truth.rotors()).into_iter().for_each(|row| report.add(row));
                report.add(wheels());
            }
            Occasion::Cycle => report.add_value(wheels()),
            Occasion::Sample => {}
        }
    }
}

impl MomentumStorage for WheelsState {
    fn stored_momentum(&self, now: Instant) -> [f64; 3] {
        if let Some(known) = self.known {
            return known.into();
        }
        let (seconds, wheels) = (self.elapsed(now), self.allocation.axes().iter().zip(&self.wheels));
        wheels.fold(Vector::zeros(), |sum, (axis, wheel)| sum + axis * wheel.momentum_at(seconds)).into()
    }

    fn wheel_speeds(&self, now: Instant, rate: [f64; 3]) -> Vec<f64> {
        match &self.tachometer {
            Some(tachometer) => tachometer.speeds().to_vec(),
            None => self.wheels(now, rate).into_iter().map(|wheel| wheel.speed_rad_s).collect(),
        }
    }

    fn wheels(&self, now: Instant, rate: [f64; 3]) -> Vec<flexsc_record::Wheel> {
        let (seconds, rate) = (self.elapsed(now), Vector::from(rate));
        let motion = |(index, (axis, wheel)): (usize, (&Vector, &WheelState))| flexsc_record::Wheel {
            speed_rad_s: self
                .observations
                .get(index)
                .map_or(wheel.momentum_at(seconds) / self.inertia - axis.dot(&rate), |turned| turned.speed),
            momentum_nm_s: wheel.momentum_at(seconds),
            torque_nm: wheel.torque,
        };
        self.allocation.axes().iter().zip(&self.wheels).enumerate().map(motion).collect()
    }
}
