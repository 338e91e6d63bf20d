//! Checks of sensors, and of estimators and laws with their inputs.

use flexsc_control::estimator::EstimatorKind;
use flexsc_control::law::EstimateNeeds;
use flexsc_control::sensor::SensorKind;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::time::Span;

use super::ScenarioSpec;

impl ScenarioSpec {
    pub(super) fn validate_sensors(&self) -> Option<ConfigError> {
        let at = |index: usize, why: &str| Some(ConfigError::new(self.sensor_key(index), why));
        for (index, sensor) in self.sensor.iter().enumerate() {
            if !sensor.is_continuous()
                && sensor.measures_motion()
                && sensor.period(self.law.period()).is_none()
            {
                return at(index, "must have a `period` with a law that has none of its own");
            }
            if let Some(fault) = sensor.inconsistency() {
                return Some(fault.within(&self.sensor_key(index)));
            }
            if let Some(fault) = self.validate_vector_sensors(sensor) {
                return Some(fault.within(&self.sensor_key(index)));
            }
            if self.sensor.motion_sensors() > 1 && sensor.is_continuous() {
                return at(index, "gives the motion at every instant, so other sensors add nothing");
            }
        }
        if let Some(fault) = self.validate_tachometers().or_else(|| self.validate_accelerometers()) {
            return Some(fault);
        }
        if self.estimator.as_ref().is_some_and(EstimatorKind::fuses_sensors) {
            return None;
        }
        let moves = |axis: usize| {
            !matches!(self.law.about(axis).needs(), EstimateNeeds::Nothing | EstimateNeeds::Field)
        };
        if (0..self.axis_count()).any(moves) && self.sensor.iter().all(SensorKind::measures_vector) {
            let why = "gives neither attitude nor rate, which the law needs: add a `gyro` and an `[estimator.attitude]`";
            return at(0, why);
        }
        if self.sensor.motion_sensors() == 1 {
            return None;
        }
        if let Some(estimator) = self.estimator.as_ref().filter(|estimator| !estimator.estimates_rates_only())
        {
            let why = "takes the samples of one sensor, and there are several";
            return Some(ConfigError::new(format!("estimator.{}", estimator.kind()), why));
        }
        let of =
            |measures: &dyn Fn(usize) -> bool| (0..self.sensor.len()).filter(|index| measures(*index)).nth(1);
        let rates = of(&|index| self.sensor[index].rate_noise(0).is_some());
        if let Some(index) = rates.or(of(&|index| self.sensor.provides_attitude(index))) {
            return at(index, "measures what another sensor measures too, and no estimator combines them");
        }
        None
    }

    /// Checks that a tachometer has wheels, is the only one, and is listed with a sensor of the body.
    fn validate_tachometers(&self) -> Option<ConfigError> {
        let (index, _) = self.sensor.tachometer()?;
        let at = |index: usize, why: &str| Some(ConfigError::new(self.sensor_key(index), why));
        if self.actuator.wheels().is_none() {
            return at(index, "is on the wheels of `[actuator.wheels]`, and there are none");
        }
        if self.sensor.motion_sensors() == 0 {
            let why = "measures only wheels: list a sensor of the body beside it, such as \"continuous\", which gives the exact motion";
            return at(index, why);
        }
        let is_one = |(_, sensor): &(usize, &SensorKind)| matches!(sensor, SensorKind::Tachometer(_));
        let mut tachometers = self.sensor.iter().enumerate().filter(is_one);
        tachometers.nth(1).and_then(|(other, _)| at(other, "is on each wheel already: list only one"))
    }

    /// Checks that accelerometers are on a spacecraft, and are listed with a sensor of the body.
    fn validate_accelerometers(&self) -> Option<ConfigError> {
        let (index, _) = self.sensor.accelerometers().next()?;
        let why = if self.spacecraft.is_none() {
            "measures at a point of a `[spacecraft]`, whose mass and centre of mass are known, and whose modes act back on it"
        } else if self.sensor.motion_sensors() == 0 {
            "is not used by the law: list a sensor of the body beside it, such as \"continuous\", which gives the exact motion"
        } else {
            return None;
        };
        Some(ConfigError::new(self.sensor_key(index), why))
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
        format!("{}.{}", self.sensor.key("sensor", index), self.sensor[index].kind())
    }

    /// Checks that the estimator is used, and that the estimates that laws read are available.
    pub(super) fn validate_estimator_inputs(&self) -> Option<ConfigError> {
        let reads: Vec<EstimateNeeds> =
            (0..self.axis_count()).map(|axis| self.law.about(axis).needs()).collect();
        if let Some(axis) = reads.iter().position(|reads| *reads == EstimateNeeds::DominantMode) {
            let blind = match &self.estimator {
                None
                | Some(
                    EstimatorKind::Envelope(_) | EstimatorKind::RigidRate(_) | EstimatorKind::Attitude(_),
                ) => true,
                Some(estimator) => estimator.is_assessed_only(),
            };
            if blind && !self.estimator.as_ref().is_some_and(EstimatorKind::is_assessed_only) {
                let why = "feeds back the dominant mode, which an `[estimator]` that acts at samples (`truth`, `kalman`, \
                           `extended_kalman`, `unscented_kalman`, `adaptive`) tells, and there is none";
                return Some(ConfigError::new(format!("{}.extra", self.law_key(axis)), why));
            }
        }
        let estimator = self.estimator.as_ref()?;
        let (kind, watching) = (estimator.kind(), estimator.is_assessed_only());
        let at = |key: &str, why: String| Some(ConfigError::new(format!("estimator.{kind}{key}"), why));
        if matches!(estimator, EstimatorKind::Envelope(_)) {
            return None;
        }
        if self.sensor.period(self.law.period()).or(self.law.period()).is_none() {
            return at("", EstimatorKind::AT_SAMPLES.to_owned());
        }
        if watching {
            let reader = reads.iter().position(|reads| *reads == EstimateNeeds::DominantMode)?;
            return at(
                ".watch_only",
                format!("must be left out where `{}.extra` reads the filter", self.law_key(reader)),
            );
        }
        let unread = reads.iter().all(|reads| matches!(reads, EstimateNeeds::Nothing | EstimateNeeds::Field));
        if unread && !matches!(estimator, EstimatorKind::Adaptive(_) | EstimatorKind::Own(_)) {
            let instead =
                if estimator.filters_measurements() || matches!(estimator, EstimatorKind::Attitude(_)) {
                    "with `watch_only = true` the filter is assessed and changes nothing"
                } else {
                    "leave it out"
                };
            let law = self.law.kind();
            return at("", format!("is not used, because the law is `{law}`: {instead}"));
        }
        None
    }
}
