//! State of a run as a flat vector with names and units: true state, measurements, and estimates.

use flexsc_control::sensor::Truth;
use flexsc_record::{ControlMomentGyros, Hinges};

use super::plant::FlowQuantities;
use super::run_view::RunView;
use flexsc_scenario::Scenario;

/// Origin of the values of a field.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum ObservationGroup {
    /// True state.
    True,
    /// Latest measurement of the sensors; NaN before the first.
    Measured,
    /// State estimate that the laws read.
    Estimated,
}

/// Quantity in the vector of [`super::Simulation::observe`].
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct ObservationField {
    /// Origin of the field's values: true state, measurement or estimate.
    pub group: ObservationGroup,
    /// Name within the group.
    pub name: &'static str,
    /// Unit; empty for a dimensionless field.
    pub unit: &'static str,
    /// Number of values of a vector; `None` for a scalar.
    pub count: Option<usize>,
}

impl ObservationField {
    /// Returns the number of values in the flat vector.
    pub fn width(&self) -> usize {
        self.count.unwrap_or(1)
    }
}

impl RunView<'_> {
    /// Returns the fields of the observation, in its order, for a run of this scenario.
    pub fn observation_fields(&self, scenario: &Scenario) -> Vec<ObservationField> {
        let field = |group, name, unit, count| ObservationField { group, name, unit, count };
        let state = |name, unit, count| field(ObservationGroup::True, name, unit, count);
        let mut fields = match self.plant.quantities() {
            FlowQuantities::OneAxis(motion) => {
                let modes = Some(motion.body().state.modes.len());
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
            FlowQuantities::ThreeAxis(motion) => {
                let modes = Some(motion.body().state.modes.len());
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
        let actuator = &self.loads.actuator;
        let wheels = match self.plant.quantities() {
            FlowQuantities::OneAxis(_) => {
                usize::from(actuator.response(self.now, 0, [0.0; 2]).rotor.is_some())
            }
            FlowQuantities::ThreeAxis(_) => actuator.capabilities().wheels(self.now, [0.0; 3]).len(),
        };
        if wheels > 0 {
            let count = (self.estimation.axis_count() > 1).then_some(wheels);
            fields.push(state(if count.is_some() { "wheel_speeds" } else { "wheel_speed" }, "rad/s", count));
        }
        if let Some(gimbals) = self.gyros() {
            let count = Some(gimbals.gyros.len());
            fields.push(state("gimbal_angles", "rad", count));
            fields.push(state("gimbal_rates", "rad/s", count));
        }
        if let Some(hinges) = self.hinges() {
            let count = Some(hinges.hinges.len());
            fields.push(state("hinge_angles", "rad", count));
            fields.push(state("hinge_rates", "rad/s", count));
        }
        let count = (self.estimation.axis_count() > 1).then_some(3);
        let angle = if count.is_some() { "error" } else { "angle" };
        for group in [ObservationGroup::Measured, ObservationGroup::Estimated] {
            fields.push(field(group, angle, "rad", count));
            fields.push(field(group, "rate", "rad/s", count));
        }
        fields
    }

    /// Writes the state into a vector with the fields of [`RunView::observation_fields`].
    pub fn write_observation(&self, row: &mut [f64]) {
        let now = self.now;
        let truth = self.plant.truth();
        let mut row = RowWriter(row);
        let origin = self.guidance.origin(now);
        match self.plant.quantities() {
            FlowQuantities::OneAxis(motion) => {
                let state = &motion.body().state;
                row.write(&[truth.sensor_angles()[0], truth.rate[0], state.rigid_angle, state.rigid_rate]);
                row.write_all(state.modes.iter().map(|mode| mode.displacement));
                row.write_all(motion.body().mode_rates());
                row.write(&[self.torque(0, truth)]);
                let rates = [truth.rate[0], truth.rigid_rate[0]];
                let rotor = self.loads.actuator.response(now, 0, rates).rotor;
                row.write_all(rotor.map(|wheel| wheel.speed_rad_s));
            }
            FlowQuantities::ThreeAxis(motion) => {
                let q = motion.attitude();
                row.write(&[q.w, q.i, q.j, q.k]);
                row.write(&truth.orientation.error_from(&origin));
                row.write(&truth.rate);
                row.write(&truth.rigid_rate);
                row.write_all(motion.body().state.modes.iter().map(|mode| mode.displacement));
                row.write_all(motion.body().mode_rates());
                let magnetic = motion.magnetic_torque();
                row.write(&[0, 1, 2].map(|axis| magnetic[axis] + self.torque(axis, truth)));
                let wheels = self.loads.actuator.capabilities().wheels(now, truth.rate);
                row.write_all(wheels.iter().map(|wheel| wheel.speed_rad_s));
                if let Some(gimbals) = self.gyros() {
                    row.write_all(gimbals.gyros.iter().map(|gyro| gyro.angle_rad));
                    row.write_all(gimbals.gyros.iter().map(|gyro| gyro.rate_rad_s));
                }
                if let Some(Hinges { hinges }) = motion.hinges() {
                    row.write_all(hinges.iter().map(|hinge| hinge.angle_rad));
                    row.write_all(hinges.iter().map(|hinge| hinge.rate_rad_s));
                }
            }
        }
        let axes = self.estimation.axis_count();
        if self.sensors.is_continuous() {
            let error = self.plant.sensed_angles(&origin);
            for _ in 0..2 {
                row.write(&error[..axes]);
                row.write(&truth.rate[..axes]);
            }
            return;
        }
        let reported = self.sensors.reading.is_some();
        let measured = |part: usize| {
            self.sensors.measured.iter().map(move |of| if reported { of[part] } else { f64::NAN })
        };
        row.write_all(measured(0));
        row.write_all(measured(1));
        row.write_all(self.estimation.estimates.iter().map(|state_estimate| state_estimate.angle));
        row.write_all(self.estimation.estimates.iter().map(|state_estimate| state_estimate.rate));
    }

    /// Returns the motion of the appendages' hinges; `None` without hinges.
    fn hinges(&self) -> Option<Hinges> {
        let motion = self.plant.quantities().three_axis()?;
        motion.hinges()
    }

    /// Returns the row of the control moment gyros; `None` without any.
    fn gyros(&self) -> Option<ControlMomentGyros> {
        self.loads.actuator.capabilities().momentum?.gyros(self.now)
    }

    /// Returns the torque that the actuator applies about an axis (N m).
    fn torque(&self, axis: usize, truth: &Truth) -> f64 {
        self.loads.actuator.response(self.now, axis, [truth.rate[axis], truth.rigid_rate[axis]]).applied
    }
}

/// Cursor into an output row.
struct RowWriter<'a>(&'a mut [f64]);

impl RowWriter<'_> {
    fn write(&mut self, values: &[f64]) {
        let (place, rest) = std::mem::take(&mut self.0).split_at_mut(values.len());
        place.copy_from_slice(values);
        self.0 = rest;
    }

    fn write_all(&mut self, values: impl IntoIterator<Item = f64>) {
        values.into_iter().for_each(|value| self.write(&[value]));
    }
}
