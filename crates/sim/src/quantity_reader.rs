//! Reader of the quantities of a run: what several rows of the table read.

use std::cell::OnceCell;
use std::ops::Deref;

use flexsc_control::law::{ReferenceNeeds, Setpoint};
use flexsc_control::state_estimate::StateEstimate;
use flexsc_record::{ControlMomentGyros, Hinges};

use super::plant::{OneAxisQuantities, ThreeAxisQuantities};
use super::run_view::RunView;

/// Gives values one after another; the result is that of a function that reads a quantity.
#[allow(clippy::unnecessary_wraps, reason = "readers of quantities end with it")]
pub fn give(out: &mut dyn FnMut(f64), values: impl IntoIterator<Item = f64>) -> Option<()> {
    values.into_iter().for_each(out);
    Some(())
}

/// Run at an instant, with what its laws would read then.
pub struct QuantityReader<'a> {
    run: RunView<'a>,
    law_inputs: OnceCell<LawInputs>,
}

/// State estimates predicted to this instant, and setpoints, about each axis.
struct LawInputs {
    estimates: Vec<StateEstimate>,
    setpoints: Vec<Setpoint>,
}

impl<'a> Deref for QuantityReader<'a> {
    type Target = RunView<'a>;

    fn deref(&self) -> &RunView<'a> {
        &self.run
    }
}

impl<'a> QuantityReader<'a> {
    /// Creates the reader of a run at its current instant.
    pub const fn new(run: RunView<'a>) -> Self {
        Self { run, law_inputs: OnceCell::new() }
    }

    /// Returns the number of axes.
    pub fn axes(&self) -> usize {
        self.estimation.axis_count()
    }

    /// Returns the motion of a one-axis body.
    pub fn one_axis(&self) -> Option<&dyn OneAxisQuantities> {
        self.plant.quantities().one_axis()
    }

    /// Returns the motion of a three-axis body.
    pub fn three_axis(&self) -> Option<&dyn ThreeAxisQuantities> {
        self.plant.quantities().three_axis()
    }

    /// Iterates over the values about the axes of the body.
    pub fn about_axes(&self, values: [f64; 3]) -> impl Iterator<Item = f64> + use<> {
        values.into_iter().take(self.axes())
    }

    /// Gives the measured angles (part 0) or rates (part 1); those of a continuous sensor are true.
    pub fn measured(&self, part: usize, out: &mut dyn FnMut(f64)) -> Option<()> {
        if self.sensors.is_continuous() {
            return self.true_motion(part, out);
        }
        let is_reported = self.sensors.reading.is_some();
        give(out, self.sensors.measured.iter().map(|own| if is_reported { own[part] } else { f64::NAN }))
    }

    /// Gives a part of the estimates of the last sample; those of a continuous sensor are true angles (part 0) or rates (part
    /// 1).
    pub fn estimated(
        &self,
        value: fn(&StateEstimate) -> f64,
        part: usize,
        out: &mut dyn FnMut(f64),
    ) -> Option<()> {
        if self.sensors.is_continuous() {
            return self.true_motion(part, out);
        }
        give(out, self.estimation.estimates.iter().map(value))
    }

    fn true_motion(&self, part: usize, out: &mut dyn FnMut(f64)) -> Option<()> {
        if part == 1 {
            return give(out, self.about_axes(self.plant.truth().rate));
        }
        give(out, self.about_axes(self.plant.sensed_angles(&self.guidance.origin(self.now))))
    }

    /// Gives a part of the estimates predicted to this instant.
    pub fn predicted(&self, value: fn(&StateEstimate) -> f64, out: &mut dyn FnMut(f64)) -> Option<()> {
        give(out, self.law_inputs().estimates.iter().map(value))
    }

    /// Gives a part of the setpoints.
    pub fn setpoints(&self, value: impl Fn(&Setpoint) -> f64, out: &mut dyn FnMut(f64)) -> Option<()> {
        give(out, self.law_inputs().setpoints.iter().map(value))
    }

    fn law_inputs(&self) -> &LawInputs {
        self.law_inputs.get_or_init(|| {
            let mut estimates = self.estimation.estimates.clone();
            // A test of the mode has predicted them, and a change has moved them to its target.
            if self.tested.is_none_or(|test| test.at != self.now) {
                self.estimation.predict_into(self.now, self.plant, self.sensors, &mut estimates);
            }
            let square: f64 = estimates.iter().map(|estimate| estimate.angle * estimate.angle).sum();
            for estimate in &mut estimates {
                estimate.total_angle = f64::sqrt(square);
            }
            let led = self.guidance.reference_motion(self.now, &estimates);
            let needs = ReferenceNeeds { tracks_manoeuvre: true, ..ReferenceNeeds::default() };
            let setpoint = |axis: usize| {
                self.guidance.setpoint_for(needs, self.now, led.map(|setpoints| setpoints[axis]))
            };
            let setpoints = (0..estimates.len()).map(setpoint).collect();
            LawInputs { estimates, setpoints }
        })
    }

    /// Returns the speeds of the wheels (rad/s), as available to their drives.
    pub fn wheel_speeds(&self) -> Vec<f64> {
        let truth = self.plant.truth();
        if self.axes() > 1 {
            return self.loads.wheel_speeds(self.now, truth.rigid_rate);
        }
        let response = self.loads.actuator.response(self.now, 0, [truth.rate[0], truth.rigid_rate[0]]);
        response.rotor.iter().map(|wheel| wheel.speed_rad_s).collect()
    }

    /// Returns the motion of the appendages' hinges; `None` without hinges.
    pub fn hinges(&self) -> Option<Hinges> {
        self.three_axis()?.hinges()
    }

    /// Returns the row of the control moment gyros; `None` without any.
    pub fn gyros(&self) -> Option<ControlMomentGyros> {
        self.loads.actuator.capabilities().momentum?.gyros(self.now)
    }

    /// Returns the torque that the actuator applies about an axis (N m).
    pub fn torque(&self, axis: usize) -> f64 {
        let truth = self.plant.truth();
        self.loads.actuator.response(self.now, axis, [truth.rate[axis], truth.rigid_rate[axis]]).applied
    }
}
