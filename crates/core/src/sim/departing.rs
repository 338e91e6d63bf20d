//! Departures: a motion ends, and the next begins under what acts from now on.

use super::plant::{Exerted, Plant};
use super::{Simulation, SimulationError};
use crate::record::Record;
use crate::time::Instant;

impl Simulation {
    /// Begins a motion under what acts from now on, and finds the next trip.
    pub(super) fn depart(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.now;
        self.plant.tell_course(now, &self.exerted, record)?;
        self.average(record)?;
        self.exposures.drop_copy();
        self.measure_course(now);
        let (actuator, axes) = (&self.drive.actuator, self.beliefs.len());
        if self.estimates {
            let mut moments = [0.0; 3];
            for (axis, moment) in moments.iter_mut().enumerate().take(axes) {
                *moment = actuator.moment(axis);
            }
            self.estimator.given(now, moments);
        }
        let (constant, feedback) = (actuator.torque(0), actuator.asked(0));
        self.exerted = Exerted { constant, feedback, back_emf: actuator.back_emf() };
        if let Some(monitor) = &mut self.monitor {
            let state = self.plant.swings(&self.origin);
            match &self.plant {
                Plant::Planar(_) => monitor.command(now, &state, self.exerted.constant),
                Plant::Spatial(plant) => {
                    monitor.push(now, &state, &plant.modal_forces(&self.drive.commanded(now)));
                }
            }
        }
        self.plant.depart(self.drive.wrench(now));
        self.measure_torque();
        self.trip = None;
        // A sampled sensor trips its guards at samples.
        if self.sensing.next.is_none() && !self.laws.guards().is_empty() {
            let ends = [self.laws.until(), self.drive.due].into_iter().flatten().fold(self.end, Instant::min);
            self.trip = self.plant.trip(self.laws.guards(), ends.since(now), record)?;
        }
        Ok(())
    }
}
