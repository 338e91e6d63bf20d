//! Coupled modes of a one-axis body: by a wheel, or by a damping matrix.

use std::sync::Arc;

use flexsc_dynamics::axis_model::AxisModel;
use flexsc_dynamics::flow::{CoupledFlow, CoupledMatrices};
use flexsc_dynamics::linear::LinearFlow;
use flexsc_formats::document::ConfigError;
use flexsc_formats::structure::TOO_FAR_APART;

use super::Scenario;

/// Largest number of modes whose coupled motion is decomposed into poles.
const MOST_COUPLED: usize = 100;

impl Scenario {
    /// Returns the motion of a one-axis body whose modes are coupled by a wheel or by damping, or drift; `None` if its
    /// modes are uncoupled.
    pub fn coupling(&self, body: &AxisModel) -> Option<CoupledFlow> {
        let (back_emf, total) = self.back_emf(body);
        if let Some(flow) = &self.linear {
            return Some(CoupledFlow::by_poles(body, flow, back_emf, total));
        }
        (self.actuator.flywheel().is_some() || self.study.drift.is_some())
            .then(|| CoupledFlow::new(body, self.study.drift.as_ref(), back_emf, total))
    }

    /// Returns the damping rate by a wheel's back-EMF (1/s), and whether it acts on the rate of the elastic body.
    pub fn back_emf(&self, body: &AxisModel) -> (f64, bool) {
        let (back_emf, total) = self.study.back_emf;
        (back_emf / body.inertia.get(), total)
    }

    /// Computes the flow by poles of a body with a damping matrix, or with a wheel under a law that switches at
    /// crossings.
    pub(super) fn linear_flow(&self) -> Result<Option<Arc<LinearFlow>>, ConfigError> {
        let Some(body) = self.model.one_axis() else { return Ok(None) };
        let wheel = self.actuator.flywheel().map(|(_, key)| key);
        let switches = self.law.is_switching() || self.law.offers().finds_crossings;
        let crosses = switches && self.study.sample_period.is_none();
        let damped = body.is_coupled();
        if !(damped || wheel.is_some() && crosses) {
            return Ok(None);
        }
        let key = wheel.filter(|_| !damped).unwrap_or_else(|| self.damping_key());
        let modes = body.modes.len();
        if modes > MOST_COUPLED {
            return Err(ConfigError::new(
                key,
                format!("couples at most {MOST_COUPLED} modes, and the body has {modes}"),
            ));
        }
        let (back_emf, total) = self.back_emf(body);
        let coupled = CoupledMatrices::new(body, back_emf, total, &vec![1.0; modes]);
        match coupled.flow() {
            Some(flow) => Ok(Some(Arc::new(flow))),
            None => Err(ConfigError::new(key, format!("with the modes {TOO_FAR_APART}"))),
        }
    }
}
