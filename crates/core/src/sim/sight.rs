//! What moves in a run, as a row of numbers with names and units: the state, what is measured of it, and what is believed.

use super::plant::Plant;
use super::{Simulation, SimulationError};
use crate::flow::SpatialState;
use crate::motion::State;
use crate::record::Hinges;
use crate::scenario::Scenario;
use crate::sensor::Truth;

/// What the numbers of a field are to the control system.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum LookGroup {
    /// What is so.
    State,
    /// What the sensors measured last; not a number before.
    Measured,
    /// What laws are told.
    Believed,
}

/// A quantity in the row of [`Simulation::look`].
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct LookField {
    /// What it is to the control system.
    pub group: LookGroup,
    /// Its name within the group.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// How many numbers it has, if it is more than one by its nature.
    pub count: Option<usize>,
}

impl LookField {
    /// How many numbers it takes in the row.
    pub fn width(&self) -> usize {
        self.count.unwrap_or(1)
    }
}

impl Simulation {
    /// The state of a body with one angle now.
    pub fn state(&self) -> Option<&State> {
        if let Plant::Planar(plant) = &self.plant { Some(plant.state()) } else { None }
    }

    /// The state of a body with three axes now.
    pub fn spatial_state(&self) -> Option<&SpatialState> {
        if let Plant::Spatial(plant) = &self.plant { Some(plant.state()) } else { None }
    }

    /// The mean of the total envelope over the window that was closed last (rad).
    pub fn window_mean(&self) -> Option<f64> {
        self.monitor.as_ref().map(|monitor| monitor.mean)
    }

    /// Tunes a number of the law, such as `k_t`, as an adaptation does.
    pub fn tune(&mut self, key: &str, value: f64) {
        self.laws.tune(key, value);
    }

    /// The fields of a row, in its order, of a run of this scenario.
    pub fn fields(&self, scenario: &Scenario) -> Vec<LookField> {
        let field = |group, name, unit, count| LookField { group, name, unit, count };
        let state = |name, unit, count| field(LookGroup::State, name, unit, count);
        let mut fields = match &self.plant {
            Plant::Planar(plant) => {
                let modes = Some(plant.state().modes.len());
                vec![
                    state("angle", "rad", None),
                    state("rate", "rad/s", None),
                    state("rigid_angle", "rad", None),
                    state("rigid_rate", "rad/s", None),
                    state("modes", "rad", modes),
                    state("mode_rates", "rad/s", modes),
                    state("torque", scenario.model.torque_unit(), None),
                ]
            }
            Plant::Spatial(plant) => {
                let modes = Some(plant.state().modes.len());
                vec![
                    state("attitude", "", Some(4)),
                    state("error", "rad", Some(3)),
                    state("rate", "rad/s", Some(3)),
                    state("rigid_rate", "rad/s", Some(3)),
                    state("modes", "m sqrt(kg)", modes),
                    state("mode_rates", "m sqrt(kg)/s", modes),
                    state("torque", "N m", Some(3)),
                ]
            }
        };
        let actuator = &self.drive.actuator;
        let wheels = match &self.plant {
            Plant::Planar(_) => usize::from(actuator.wheel(0, 0.0).is_some()),
            Plant::Spatial(_) => actuator.wheels(self.now, [0.0; 3]).len(),
        };
        if wheels > 0 {
            let count = (self.beliefs.len() > 1).then_some(wheels);
            fields.push(state(if count.is_some() { "wheel_speeds" } else { "wheel_speed" }, "rad/s", count));
        }
        if let Some(gimbals) = actuator.gimbals(self.now) {
            let count = Some(gimbals.gyros.len());
            fields.push(state("gimbal_angles", "rad", count));
            fields.push(state("gimbal_rates", "rad/s", count));
        }
        if let Some(hinges) = self.hinges() {
            let count = Some(hinges.hinges.len());
            fields.push(state("hinge_angles", "rad", count));
            fields.push(state("hinge_rates", "rad/s", count));
        }
        let count = (self.beliefs.len() > 1).then_some(3);
        let angle = if count.is_some() { "error" } else { "angle" };
        for group in [LookGroup::Measured, LookGroup::Believed] {
            fields.push(field(group, angle, "rad", count));
            fields.push(field(group, "rate", "rad/s", count));
        }
        fields
    }

    /// Puts what moves into a row of [`Simulation::fields`], as it is now. A sensor that measures at every instant, and what is
    /// believed by it, is as it is now too; else both are those of the last sample.
    ///
    /// # Errors
    /// The state is no longer finite.
    ///
    /// # Panics
    /// The row has another width than its fields.
    pub fn look(&mut self, row: &mut [f64]) -> Result<(), SimulationError> {
        let now = self.now;
        self.plant.view(now)?;
        let truth = self.plant.viewed();
        let mut row = Row(row);
        let origin = self.reference.origin(now);
        match &self.plant {
            Plant::Planar(plant) => {
                let state = plant.state();
                row.put(&[truth.seen()[0], truth.rate[0], state.rigid_angle, state.rigid_rate]);
                row.put_all(state.modes.iter().map(|mode| mode.displacement));
                row.put_all(plant.mode_rates());
                row.put(&[self.torque(0, truth)]);
                row.put_all(self.drive.actuator.wheel(0, truth.rigid[0]).map(|wheel| wheel.speed_rad_s));
            }
            Plant::Spatial(plant) => {
                let q = plant.attitude();
                row.put(&[q.w, q.i, q.j, q.k]);
                row.put(&truth.orientation.beyond(&origin));
                row.put(&truth.rate);
                row.put(&truth.rigid);
                row.put_all(plant.state().modes.iter().map(|mode| mode.displacement));
                row.put_all(plant.mode_rates());
                let magnetic = plant.magnetic();
                row.put(&[0, 1, 2].map(|axis| magnetic[axis] + self.torque(axis, truth)));
                let wheels = self.drive.actuator.wheels(now, truth.rate);
                row.put_all(wheels.iter().map(|wheel| wheel.speed_rad_s));
                if let Some(gimbals) = self.drive.actuator.gimbals(now) {
                    row.put_all(gimbals.gyros.iter().map(|gyro| gyro.angle_rad));
                    row.put_all(gimbals.gyros.iter().map(|gyro| gyro.rate_rad_s));
                }
                if let Some(Hinges { hinges }) = plant.hinges() {
                    row.put_all(hinges.iter().map(|hinge| hinge.angle_rad));
                    row.put_all(hinges.iter().map(|hinge| hinge.rate_rad_s));
                }
            }
        }
        let axes = self.beliefs.len();
        if self.sensing.next.is_none() {
            let error = truth.orientation.at(truth.seen()).beyond(&origin);
            for _ in 0..2 {
                row.put(&error[..axes]);
                row.put(&truth.rate[..axes]);
            }
            return Ok(());
        }
        let told = self.sensing.reading.is_some();
        let measured =
            |part: usize| self.sensing.measured.iter().map(move |of| if told { of[part] } else { f64::NAN });
        row.put_all(measured(0));
        row.put_all(measured(1));
        row.put_all(self.beliefs.iter().map(|belief| belief.angle));
        row.put_all(self.beliefs.iter().map(|belief| belief.rate));
        Ok(())
    }

    /// The hinges of appendages; none without hinges.
    fn hinges(&self) -> Option<Hinges> {
        if let Plant::Spatial(plant) = &self.plant { plant.hinges() } else { None }
    }

    /// The torque that the actuator gives about an axis (N m).
    fn torque(&self, axis: usize, truth: &Truth) -> f64 {
        self.drive.actuator.applied(self.now, axis, [truth.rate[axis], truth.rigid[axis]])
    }
}

/// What is left of a row.
struct Row<'a>(&'a mut [f64]);

impl Row<'_> {
    fn put(&mut self, values: &[f64]) {
        let (place, rest) = std::mem::take(&mut self.0).split_at_mut(values.len());
        place.copy_from_slice(values);
        self.0 = rest;
    }

    fn put_all(&mut self, values: impl IntoIterator<Item = f64>) {
        values.into_iter().for_each(|value| self.put(&[value]));
    }
}
