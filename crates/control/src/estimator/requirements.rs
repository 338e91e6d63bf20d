//! Requirements and offers of the estimator of a scenario.

use super::{Adaptive, AttitudeFilter, EstimatorKind, EstimatorSpec, FrequencyTracking, Kalman};
use crate::custom::Custom;
use crate::offers::{EstimatorOffers, Offers};
use crate::requirement::{Requirements, Rule};
use crate::state_estimate::EstimateNeeds;

/// Largest number of modes in a filter about each of three axes, because its matrices are full.
const MOST_FILTERED: usize = 24;

impl EstimatorKind {
    /// Returns the offers of the estimator to the other parts of a scenario.
    pub fn offers(&self) -> EstimatorOffers {
        let is_assessed_only = self.is_assessed_only();
        let has_modes = !matches!(self, Self::Envelope(_) | Self::RigidRate(_) | Self::Attitude(_));
        EstimatorOffers {
            is_envelope: self.envelope().is_some(),
            is_assessed_only,
            dominant_mode: has_modes && !is_assessed_only,
            elastic_rates: self.adaptive().is_some(),
        }
    }

    /// Adds the requirements of the estimator on the other parts of a scenario.
    pub fn add_requirements(&self, offers: &Offers, needs: &mut Requirements) {
        needs.set_part(format!("estimator.{}", self.kind()));
        if let Self::Envelope(envelope) = self {
            return envelope.requires(offers, needs);
        }
        self.require_inputs(offers, needs);
        match self {
            Self::Attitude(_) => {
                AttitudeFilter::requires(offers, needs);
                self.require_window(needs);
            }
            Self::RigidRate(rates) => rates.requires(offers, needs),
            Self::Adaptive(_) => {
                Adaptive::requires(offers, needs);
                self.require_modes(offers, needs);
            }
            Self::ExtendedKalman(filter) | Self::UnscentedKalman(filter) => {
                FrequencyTracking::require_separate_modes(offers, needs);
                self.require_modes(offers, needs);
                needs.report(Rule::Filter, filter.inconsistency());
            }
            Self::Kalman(_) | Self::Truth(_) => self.require_modes(offers, needs),
            Self::Envelope(_) | Self::Own(_) => {}
        }
    }

    /// Adds the requirements of samples, and of a law that reads the estimates.
    fn require_inputs(&self, offers: &Offers, needs: &mut Requirements) {
        let rule = Rule::EstimatorInputs;
        let is_sampled = offers.sensors.period.or(offers.law_period).is_some();
        needs.require(rule, is_sampled, "", Self::AT_SAMPLES);
        if self.is_assessed_only() {
            let reader = offers.laws.iter().find(|law| law.offers.needs == EstimateNeeds::DominantMode);
            needs.require_with(rule, reader.is_none(), "watch_only", || {
                let law = reader.map_or("", |law| &law.key);
                format!("must be left out where `{law}.extra` reads the filter")
            });
            return;
        }
        let is_read = offers.laws.iter().any(|law| law.offers.reads_motion());
        let is_free = matches!(self, Self::Adaptive(_) | Self::Own(_));
        needs.require_with(rule, is_read || is_free, "", || {
            let instead = if self.filters_measurements() || self.attitude().is_some() {
                "with `watch_only = true` the filter is assessed and changes nothing"
            } else {
                "leave it out"
            };
            format!("is not used, because the law is `{}`: {instead}", offers.law_kind)
        });
    }

    /// Adds the requirements of an estimator of modes on the body and its sensors.
    fn require_modes(&self, offers: &Offers, needs: &mut Requirements) {
        let (body, rule) = (&offers.body, Rule::Filter);
        self.require_window(needs);
        needs.require(rule, body.modes > 0, "", "has no modes to estimate: the body has none");
        needs.require(
            rule,
            !body.follows_motion,
            "",
            "observes the modes through the hub's angle, where they do not appear with `drive = \"motion\"`",
        );
        let kinematics = "body.panels.kinematics";
        let why = "must be \"linear\" for an estimator of modes";
        needs.require_elsewhere(rule, !body.is_chain, kinematics, why);
        let own = self.modes().map_or(body.modes, <[_]>::len);
        needs.require_with(rule, own == body.modes, "modes", || {
            format!("must be as many as the body's, {}, got {own}", body.modes)
        });
        let is_silent = self.angle_noise().is_none() && offers.sensors.angle_noise == 0.0;
        needs.require(
            rule,
            !(self.filters_measurements() && is_silent),
            "angle_noise",
            "must be given where the sensor has neither noise nor a resolution",
        );
        let is_large = self.filters_measurements() && body.modes > MOST_FILTERED;
        needs.require_with(rule, body.axes == 1 || !is_large, "", || {
            let modes = body.modes;
            format!(
                "estimates at most {MOST_FILTERED} modes about each of three axes, and the body has {modes}"
            )
        });
        needs.require(
            rule,
            body.axes == 1 || self.modes().is_none(),
            "modes",
            "apply only to one angle: about three axes a filter uses the body's",
        );
    }

    /// Adds the requirement of an interval of assessment in order.
    fn require_window(&self, needs: &mut Requirements) {
        let [from, to] = self.assess();
        needs.require_with(Rule::Filter, from < to, "assess", || {
            format!("must be [from, to] in this order, got [{from}, {to}]")
        });
    }

    /// Returns the adaptive observers, if the estimator consists of them.
    pub fn adaptive(&self) -> Option<&Adaptive> {
        if let Self::Adaptive(observers) = self { Some(observers) } else { None }
    }

    /// Returns the linear Kalman filter, if the estimator is one.
    pub fn kalman(&self) -> Option<&Kalman> {
        if let Self::Kalman(filter) = self { Some(filter) } else { None }
    }

    /// Returns true if the estimator of modes is linear with gains that settle: a linear filter, or the true state.
    pub fn has_constant_gains(&self) -> bool {
        matches!(self, Self::Kalman(_) | Self::Truth(_))
    }

    /// Returns the estimator of another crate, if it is one.
    pub fn custom(&self) -> Option<&Custom<dyn EstimatorSpec>> {
        if let Self::Own(own) = self { Some(own) } else { None }
    }
}

impl From<Custom<dyn EstimatorSpec>> for EstimatorKind {
    fn from(estimator: Custom<dyn EstimatorSpec>) -> Self {
        Self::Own(estimator)
    }
}
