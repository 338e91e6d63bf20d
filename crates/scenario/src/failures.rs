//! Failures of sensors and actuators: checks, and intervals.

use flexsc_control::actuator::{Failure, FailureScope};
use flexsc_control::estimator::EstimatorKind;
use flexsc_control::interval::Interval;
use flexsc_control::sensor::{Outlier, SensorFailure, SensorKind};
use flexsc_dynamics::axis_model::AxisModel;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::AXES;
use flexsc_spacecraft::body::BodyModel;

use super::ScenarioSpec;
use super::consistency::errors_in;

/// Failure of a part with its interval.
#[derive(Clone, Debug, PartialEq)]
pub struct FailureInterval {
    /// Key of the part.
    pub part: String,
    /// Component that fails, such as `wheel 2`; empty if the whole part fails.
    pub of: String,
    /// Kind of failure.
    pub fault: &'static str,
    /// Interval of the failure.
    pub interval: Interval,
}

impl ScenarioSpec {
    /// Returns all failures: of sensors in their order, then of actuators.
    pub fn failures(&self) -> Vec<FailureInterval> {
        let mut all = Vec::new();
        for (index, sensor) in self.sensor.iter().enumerate() {
            all.extend(sensor.faults().iter().map(|fault| FailureInterval {
                part: self.sensor_key(index),
                of: String::new(),
                fault: fault.kind(),
                interval: fault.interval(),
            }));
        }
        for member in self.actuator.members() {
            all.extend(member.kind.failures().iter().map(|failure| {
                let FailureScope { interval, axis: about, wheel, gimbal, thruster } = failure.scope();
                let about = about.map(|about| AXES[about.index()].to_owned());
                let of = about
                    .or(wheel.map(|wheel| format!("wheel {wheel}")))
                    .or(gimbal.map(|gimbal| format!("gimbal {gimbal}")))
                    .or(thruster.map(|thruster| format!("thruster {thruster}")));
                FailureInterval {
                    part: member.key.clone(),
                    of: of.unwrap_or_default(),
                    fault: failure.kind(),
                    interval,
                }
            }));
        }
        all
    }

    /// Returns true if readings of an attitude filter are false within intervals that the scenario declares.
    pub fn has_false_readings(&self) -> bool {
        let has_filter = self.estimator.as_ref().and_then(EstimatorKind::attitude).is_some();
        has_filter
            && self.sensor.iter().any(|sensor| sensor.faults().iter().any(SensorFailure::alters_readings))
    }

    /// Checks that the failures are consistent with their sensors and actuators, and with the motion.
    pub(super) fn validate_failures(&self, model: &BodyModel, errors: &mut Vec<ConfigError>) {
        for (number, sensor) in self.sensor.iter().enumerate() {
            let key = format!("{}.faults", self.sensor_key(number));
            errors.extend(errors_in(&key, sensor.faults(), SensorFailure::validate));
            errors.extend(errors_in(&key, sensor.faults(), |failure| self.outlier_error(number, failure)));
            errors.extend(self.altered_error(sensor).map(|error| error.within(&key)));
        }
        let members = self.actuator.members();
        errors.extend(members.iter().filter_map(|member| member.failure_fault(self.axis_count())));
        errors.extend(self.sines_error(model));
    }

    /// Checks that a sensor's readings can be altered, and that an attitude filter refuses those that are not measurements.
    fn altered_error(&self, sensor: &SensorKind) -> Option<ConfigError> {
        let altered = |failure: &&SensorFailure| failure.alters_readings();
        let failure = sensor.faults().iter().find(altered)?;
        if !sensor.measures_motion() || sensor.is_continuous() {
            return Some(ConfigError::new(
                "",
                format!("has no `{}`: only `stuck` and `silent`", failure.kind()),
            ));
        }
        let senseless = sensor.faults().iter().find(|failure| failure.is_senseless())?;
        let filter = self.estimator.as_ref().and_then(EstimatorKind::attitude);
        let is_refused = filter.is_some_and(|filter| !filter.watch_only);
        (!is_refused).then(|| {
            let why = format!(
                "has `{}`, which an `[estimator.attitude]` refuses, and the laws of this scenario do not read one",
                senseless.kind()
            );
            ConfigError::new("", why)
        })
    }

    /// Checks that the sensor at this index measures the quantities that its outlier alters.
    fn outlier_error(&self, index: usize, failure: &SensorFailure) -> Option<ConfigError> {
        let sensor = &self.sensor[index];
        let SensorFailure::Outlier(Outlier { angle, rate, .. }) = failure else { return None };
        if !sensor.measures_motion() || sensor.is_continuous() {
            return None;
        }
        let has_angle = self.sensor.provides_attitude(index) || sensor.measures_vector();
        if angle.get() != 0.0 && !has_angle {
            let why = "alters a measured angle or vector, and the sensor measures rates: give a `rate`";
            return Some(ConfigError::new("outlier.angle", why));
        }
        let why = "alters measured rates, and the sensor measures none: give an `angle`";
        let is_idle = rate.get() != 0.0 && sensor.rate_noise(0).is_none();
        is_idle.then(|| ConfigError::new("outlier.rate", why))
    }

    /// Checks that the motion under sinusoidal torques has a closed form, or is integrated with steps that resolve
    /// them.
    fn sines_error(&self, model: &BodyModel) -> Option<ConfigError> {
        let disturbed = self.disturbance.iter().position(|of| !of.sines.is_empty());
        let disturbed = disturbed.map(|index| format!("disturbance[{index}].sines"));
        let failed = self.actuator.members().into_iter().find_map(|member| {
            let swings = |failure: &Failure| !failure.sines().is_empty();
            let index = member.kind.failures().iter().position(swings)?;
            Some(format!("{}.faults[{index}].added.sines", member.key))
        });
        if self.axis_count() == 3 {
            let key = failed.or(disturbed).filter(|_| self.spacecraft.is_none())?;
            let why = "are for a `[spacecraft]`: the modes of a `[body.spatial]` are pushed by torques that are constant for a \
                       while, and its own `disturbance` is periodic";
            return Some(ConfigError::new(key, why));
        }
        if let Some(key) = disturbed {
            let why = "are for a `[spacecraft]`: on a body with one angle a failure of the actuator adds them, as \
                       `added = { from = 0.0, sines = [..] }`";
            return Some(ConfigError::new(key, why));
        }
        let key = failed?;
        let why = match &self.law {
            _ if self.actuator.flywheel().is_some() => {
                "have no closed form with a wheel, whose back-EMF couples the modes: use an `[actuator.hold]`"
            }
            _ if self.drift.is_some() => "have no closed form for modes that drift",
            _ if model.one_axis().is_some_and(AxisModel::is_coupled) => {
                "have no closed form for modes that a damping matrix couples"
            }
            law if self.sensor.period(law.period()).is_none()
                && !law.offers().is_open
                && law.pd().is_none() =>
            {
                "leave no closed form for the crossings of the law: use a `[sensor.sampled]`"
            }
            _ if self.estimator.as_ref().is_some_and(|estimator| estimator.envelope().is_some()) => {
                "are not piecewise constant torques, which an `[estimator.envelope]` needs"
            }
            _ => return None,
        };
        Some(ConfigError::new(key, why))
    }
}
