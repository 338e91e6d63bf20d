//! Condition for the relay kernel: the law alone moves the body.

use flexsc_spacecraft::body::BodyModel;

use super::Scenario;

impl Scenario {
    /// Returns true if only the law moves a one-axis body, in closed form, and its angle is measured at every instant.
    pub fn has_fast_path(&self) -> bool {
        matches!(self.model, BodyModel::OneAxis(_))
            && self.linear.is_none()
            && self.drift.is_none()
            && self.plan.is_none()
            && !self.is_disturbed()
            && self.environment.is_none()
            && self.study.sample_period.is_none()
            && self.actuator.is_ideal()
            && self.sensor.iter().all(|sensor| sensor.is_continuous())
    }
}
