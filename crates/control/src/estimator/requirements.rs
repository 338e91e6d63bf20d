//! Requirements of the estimator of a scenario.

use super::{Adaptive, EstimatorKind, EstimatorSpec, Kalman};
use crate::offers::Offers;
use crate::requirement::Requirements;
use crate::state_estimate::EstimateNeeds;

/// Largest number of modes in a filter about each of three axes, because its matrices are full.
const MOST_FILTERED: usize = 24;

impl EstimatorKind {
    /// Adds the requirements of the estimator on the other parts of a scenario.
    pub fn add_requirements(&self, offers: &Offers, needs: &mut Requirements) {
        needs.set_part(format!("estimator.{}", self.kind()));
        if self.envelope().is_none() && !self.require_inputs(offers, needs) {
            // An estimator that has to go requires nothing else.
            return;
        }
        self.requires(offers, needs);
        needs.report(self.validate());
    }

    /// Adds the requirements of samples, and of a law that reads the estimates; returns true if they are met.
    fn require_inputs(&self, offers: &Offers, needs: &mut Requirements) -> bool {
        let is_sampled = offers.sensors.period.or(offers.law_period).is_some();
        needs.require(is_sampled, "", Self::AT_SAMPLES);
        if self.is_assessed_only() {
            let reader = offers.laws.iter().find(|law| law.offers.needs == EstimateNeeds::DominantMode);
            needs.require_with(reader.is_none(), "watch_only", || {
                let law = reader.map_or("", |law| &law.key);
                format!("must be left out where `{law}.extra` reads the filter")
            });
            return is_sampled;
        }
        let is_free = !self.offers().needs_reader;
        let is_used = is_free || offers.laws.iter().any(|law| law.offers.reads_motion());
        needs.require_with(is_used, "", || {
            let instead = if self.filters_measurements() || self.attitude().is_some() {
                "with `watch_only = true` the filter is assessed and changes nothing"
            } else {
                "leave it out"
            };
            format!("is not used, because the law is `{}`: {instead}", offers.law_kind)
        });
        is_sampled && is_used
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
}

/// Adds the requirements of an estimator of modes on the body and its sensors.
pub(super) fn require_modes(spec: &dyn EstimatorSpec, offers: &Offers, needs: &mut Requirements) {
    let body = &offers.body;
    require_window(spec, needs);
    needs.require(body.modes > 0, "", "has no modes to estimate: the body has none");
    if body.modes == 0 {
        return;
    }
    needs.require(
        !body.follows_motion,
        "",
        "observes the modes through the hub's angle, where they do not appear with `drive = \"motion\"`",
    );
    let kinematics = "body.panels.kinematics";
    let why = "must be \"linear\" for an estimator of modes";
    needs.require_elsewhere(!body.is_chain, kinematics, why);
    let own = spec.modes().map_or(body.modes, <[_]>::len);
    needs.require_with(own == body.modes, "modes", || {
        format!("must be as many as the body's, {}, got {own}", body.modes)
    });
    let is_silent = spec.angle_noise().is_none() && offers.sensors.angle_noise == 0.0;
    needs.require(
        !(spec.filters_measurements() && is_silent),
        "angle_noise",
        "must be given where the sensor has neither noise nor a resolution",
    );
    let is_large = spec.filters_measurements() && body.modes > MOST_FILTERED;
    needs.require_with(body.axes == 1 || !is_large, "", || {
        let modes = body.modes;
        format!("estimates at most {MOST_FILTERED} modes about each of three axes, and the body has {modes}")
    });
    needs.require(
        body.axes == 1 || spec.modes().is_none(),
        "modes",
        "apply only to one angle: about three axes a filter uses the body's",
    );
}

/// Adds the requirement of an interval of assessment in order.
pub(super) fn require_window(spec: &dyn EstimatorSpec, needs: &mut Requirements) {
    let [from, to] = spec.assess();
    needs.require_with(from < to, "assess", || {
        format!("must be [from, to] in this order, got [{from}, {to}]")
    });
}
