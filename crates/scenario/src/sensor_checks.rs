//! Checks of the sensors of a scenario as a set, and of sensors in linear loops.

use flexsc_control::offers::Offers;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::time::Span;

use super::ScenarioSpec;

impl ScenarioSpec {
    /// Checks that the sensors measure the motion that a law reads, each quantity once unless an estimator fuses them.
    pub(super) fn require_sensor_set(&self, offers: &Offers, errors: &mut Vec<ConfigError>) {
        if self.estimator.as_ref().is_some_and(|estimator| estimator.fuses_sensors()) {
            return;
        }
        let is_read = offers.laws.iter().any(|law| law.offers.reads_motion());
        if is_read && self.sensor.iter().all(|sensor| sensor.measures_vector()) {
            let why = "gives neither attitude nor rate, which the law needs: add a `gyro` and an `[estimator.attitude]`";
            errors.push(ConfigError::new(self.sensor_key(0), why));
            return;
        }
        if offers.sensors.motion_sensors == 1 {
            return;
        }
        if let Some(estimator) = self.estimator.as_ref().filter(|estimator| !estimator.estimates_rates_only())
        {
            let why = "takes the samples of one sensor, and there are several";
            errors.push(ConfigError::new(format!("estimator.{}", estimator.kind()), why));
            return;
        }
        let of =
            |measures: &dyn Fn(usize) -> bool| (0..self.sensor.len()).filter(|index| measures(*index)).nth(1);
        let rates = of(&|index| self.sensor[index].rate_noise(0).is_some());
        if let Some(index) = rates.or(of(&|index| self.sensor.provides_attitude(index))) {
            let why = "measures what another sensor measures too, and no estimator combines them";
            errors.push(ConfigError::new(self.sensor_key(index), why));
        }
    }

    /// Returns the error of a sensor that linear loop analysis cannot represent: delayed rates, and mean attitudes.
    pub fn validate_for_loop_analysis(&self) -> Option<ConfigError> {
        let of = |index: usize| {
            let sensor = &self.sensor[index];
            let keys = [("latency", sensor.rate_latency()), ("exposure", sensor.exposure())];
            let (key, _) = keys.into_iter().find(|(_, span)| *span > Span::ZERO)?;
            Some(format!("{}.{key}", self.sensor_key(index)))
        };
        let key = (0..self.sensor.len()).find_map(of)?;
        Some(ConfigError::new(key, "is not supported in linear loops: leave it out"))
    }

    /// Returns the key of a sensor, including its kind.
    pub fn sensor_key(&self, index: usize) -> String {
        self.sensor.sensor_key(index)
    }
}
