//! State of a run as a flat vector with names and units: true state, measurements, and estimates.

use super::plant::Plant;
use super::{Simulation, SimulationError};
use crate::flow::SpatialState;
use crate::motion::State;
use crate::record::Hinges;
use crate::scenario::Scenario;
use crate::sensor::Truth;

/// Origin of the values of a field.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum LookGroup {
    /// True state.
    State,
    /// Latest measurement of the sensors; NaN before the first.
    Measured,
    /// State estimate that the laws read.
    Believed,
}

/// Quantity in the vector of [`Simulation::look`].
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct LookField {
    /// Origin of the values.
    pub group: LookGroup,
    /// Name within the group.
    pub name: &'static str,
    /// Unit; empty for a dimensionless field.
    pub unit: &'static str,
    /// Number of values of a vector; `None` for a scalar.
    pub count: Option<usize>,
}

impl LookField {
    /// Returns the number of values in the flat vector.
    pub fn width(&self) -> usize {
        self.count.unwrap_or(1)
    }
}

impl Simulation {
    /// Returns the state of a one-axis body at the current instant.
    pub fn state(&self) -> Option<&State> {
        if let Plant::Planar(plant) = &self.plant { Some(plant.state()) } else { None }
    }

    /// Returns the state of a three-axis body at the current instant.
    pub fn spatial_state(&self) -> Option<&SpatialState> {
        if let Plant::Spatial(plant) = &self.plant { Some(plant.state()) } else { None }
    }

    /// Returns the mean of the total envelope over the last closed window (rad).
    pub fn window_mean(&self) -> Option<f64> {
        self.monitor.as_ref().map(|monitor| monitor.mean)
    }

    /// Sets a tunable parameter of the law, such as `k_t`, as an adaptation does.
    pub fn tune(&mut self, key: &str, value: f64) {
        self.laws.tune(key, value);
    }

    /// Returns the fields of the vector of [`Simulation::look`], in its order, for a run of this scenario.
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

    /// Writes the current state into a vector with the fields of [`Simulation::fields`]. With a sensor that measures at
    /// every instant, measurements and estimates are current too; otherwise they are those of the last sample.
    ///
    /// # Errors
    /// Fails if the state is no longer finite.
    ///
    /// # Panics
    /// Panics if the length of `row` differs from the total width of the fields.
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

    /// Returns the motion of the appendages' hinges; `None` without hinges.
    fn hinges(&self) -> Option<Hinges> {
        if let Plant::Spatial(plant) = &self.plant { plant.hinges() } else { None }
    }

    /// Returns the torque that the actuator applies about an axis (N m).
    fn torque(&self, axis: usize, truth: &Truth) -> f64 {
        self.drive.actuator.applied(self.now, axis, [truth.rate[axis], truth.rigid[axis]])
    }
}

/// Cursor into an output row.
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
