//! Whether the law alone moves the body of a scenario, which quicker loops and lanes need.

use super::Scenario;
use crate::body::Model;
use crate::sensor::Sensor;

impl Scenario {
    /// Whether the law alone moves a body of one angle, in closed form, and knows its angle at every instant.
    pub fn is_plain(&self) -> bool {
        matches!(self.model, Model::Planar(_))
            && self.linear.is_none()
            && self.drift.is_none()
            && self.plan.is_none()
            && self.disturbance.is_empty()
            && self.environment.is_none()
            && self.study.sampling.is_none()
            && self.actuator.is_ideal()
            && self.sensor.iter().all(|sensor| matches!(sensor, Sensor::Continuous))
    }
}
