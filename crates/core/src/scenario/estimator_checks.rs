//! Checks of an estimator: its own keys, and its modes.

use flexsc_control::estimator::{EnvelopeMethod, EstimatorKind};
use flexsc_dynamics::axis_model::{AxisModel, CommandedQuantity};
use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::Positive;
use flexsc_spacecraft::body::Body;

use super::Scenario;

/// Largest number of modes in a filter about each of three axes, because its matrices are full.
const MOST_FILTERED: usize = 24;

/// Message for an array where a one-axis body needs one number.
const ONE_NUMBER: &str = "must be one number for a body with one angle, got one for each of three axes";

impl Scenario {
    pub(super) fn validate_estimator(&self, body: &AxisModel) -> Option<ConfigError> {
        let envelope = match self.estimator.as_ref()? {
            EstimatorKind::Envelope(envelope) => envelope,
            estimator => return self.validate_filter(estimator),
        };
        if envelope.form == EnvelopeMethod::Truth && envelope.modes.is_some() {
            let why = "must be left out for the form `truth`, which reads the body's".to_owned();
            return Some(ConfigError::new("estimator.envelope.modes", why));
        }
        let own = envelope.modes.as_ref();
        let place = if own.is_some() { "estimator.envelope" } else { "body.planar" };
        let dampings: Vec<f64> = match own {
            Some(modes) => modes.iter().map(|mode| mode.damping.get()).collect(),
            None => body.modes.iter().map(|mode| mode.damping.get()).collect(),
        };
        dampings.into_iter().enumerate().find(|(_, damping)| *damping >= 1.0).map(|(index, damping)| {
            let why = format!("must be below 1 for a mode to have an envelope, got {damping}");
            match (&self.body, own) {
                (Some(Body::Matrices(_) | Body::Panels(_)), None) => {
                    ConfigError::new(format!("{}.damping", self.body_key()), why)
                }
                _ => ConfigError::new(format!("{place}.modes[{index}].damping"), why),
            }
        })
    }

    /// Checks a monitor of the envelope on a three-axis body.
    pub(super) fn validate_envelope(&self) -> Option<ConfigError> {
        let envelope = self.estimator.as_ref().and_then(EstimatorKind::envelope)?;
        let at = |key: &str, why: &str| Some(ConfigError::new(format!("estimator.envelope{key}"), why));
        if envelope.modes.is_some() {
            return at(".modes", "apply only to one angle: about three axes the monitor uses the body's");
        }
        if self.mode_count() == 0 {
            return at("", "has no modes to follow: the body has none");
        }
        if self.study.drives.is_some() {
            let why = "needs constant modes, and an appendage that turns changes them";
            return at("", why);
        }
        if self.actuator.control_moment_gyros().is_some() {
            let why = "needs torques that are constant between commands, and those of control moment gyros change with the gimbal \
                       angles";
            return at("", why);
        }
        let spatial = self.model.spatial()?;
        let damped = spatial.modes.iter().find(|mode| mode.damping.get() >= 1.0)?;
        let why = format!("must be below 1 for a mode to have an envelope, got {}", damped.damping.get());
        Some(ConfigError::new(format!("{}.damping", self.body_key()), why))
    }

    /// Checks an estimator that works on samples.
    pub(super) fn validate_filter(&self, estimator: &EstimatorKind) -> Option<ConfigError> {
        if estimator.envelope().is_some() {
            return None;
        }
        let kind = estimator.kind();
        let at = |key: &str, why: String| Some(ConfigError::new(format!("estimator.{kind}{key}"), why));
        if let EstimatorKind::Own(_) = estimator {
            return None;
        }
        if let EstimatorKind::RigidRate(rates) = estimator {
            let three = self.axis_count() == 1 && rates.rate.is_three();
            return three.then(|| ConfigError::new("estimator.rigid_rate.rate", ONE_NUMBER));
        }
        let [from, to] = estimator.assess();
        if from >= to {
            return at(".assess", format!("must be [from, to] in this order, got [{from}, {to}]"));
        }
        if estimator.attitude().is_some() {
            return None;
        }
        let modes = self.mode_count();
        if modes == 0 {
            return at("", "has no modes to estimate: the body has none".to_owned());
        }
        if self.model.planar().is_some_and(|body| body.drive == CommandedQuantity::Motion) {
            let why = "observes the modes through the hub's angle, where they do not appear with `drive = \"motion\"`";
            return at("", why.to_owned());
        }
        if self.model.chain().is_some() {
            let why = "must be \"linear\" for an estimator of modes";
            return Some(ConfigError::new("body.panels.kinematics", why));
        }
        if let Some(modes) = estimator.modes().filter(|modes| modes.len() != self.mode_count()) {
            let (found, own) = (modes.len(), self.mode_count());
            return at(".modes", format!("must be as many as the body's, {own}, got {found}"));
        }
        let silent = estimator.angle_noise().is_none() && self.sensor.angle_noise() == 0.0;
        if estimator.filters_measurements() && silent {
            let why = "must be given where the sensor has neither noise nor a resolution".to_owned();
            return at(".angle_noise", why);
        }
        if self.axis_count() == 3 && estimator.filters_measurements() && modes > MOST_FILTERED {
            let why = format!(
                "estimates at most {MOST_FILTERED} modes about each of three axes, and the body has {modes}"
            );
            return at("", why);
        }
        if self.axis_count() == 3 && estimator.modes().is_some() {
            return at(
                ".modes",
                "apply only to one angle: about three axes a filter uses the body's".to_owned(),
            );
        }
        let (EstimatorKind::ExtendedKalman(filter) | EstimatorKind::UnscentedKalman(filter)) = estimator
        else {
            return None;
        };
        let [low, high] = filter.bounds.map(Positive::get);
        if low >= high {
            return at(".bounds", format!("must be [low, high] in this order, got [{low}, {high}]"));
        }
        let ratio = filter.ratio.get();
        if !(low..=high).contains(&ratio) {
            return at(".ratio", format!("must lie within the bounds [{low}, {high}], got {ratio}"));
        }
        None
    }
}
