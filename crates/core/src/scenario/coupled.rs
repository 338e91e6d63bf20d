//! What couples the modes of a body with one angle: a wheel, or damping.

use std::sync::Arc;

use super::Scenario;
use crate::body::Planar;
use crate::document::Fault;
use crate::flow::{Coupled, Coupling};
use crate::motion::linear::LinearFlow;
use crate::structure::TOO_FAR_APART;

/// More modes than these are not taken apart into the poles of their coupled motion.
const MOST_COUPLED: usize = 100;

impl Scenario {
    /// The motion of a body whose modes a wheel or damping couples, or whose frequencies drift; none if they move on their
    /// own.
    pub fn coupling(&self, body: &Planar) -> Option<Coupling> {
        let (back_emf, total) = self.back_emf(body);
        if let Some(flow) = &self.linear {
            return Some(Coupling::by_poles(body, flow, back_emf, total));
        }
        (self.actuator.wheel().is_some() || self.drift.is_some())
            .then(|| Coupling::new(body, self.drift.as_ref(), back_emf, total))
    }

    /// What a wheel's back-EMF takes from a rate (1/s), and whether from that of the elastic body.
    pub fn back_emf(&self, body: &Planar) -> (f64, bool) {
        let (back_emf, total) = self.study.back_emf;
        (back_emf / body.inertia.get(), total)
    }

    /// The flow by poles of a body that a damping matrix couples, or a wheel under a law that switches at crossings.
    pub(super) fn flow(&self) -> Result<Option<Arc<LinearFlow>>, Fault> {
        let Some(body) = self.model.planar() else { return Ok(None) };
        let wheel = self.actuator.wheel().map(|(_, key)| key);
        let crosses = self.law.switches() && self.study.sampling.is_none();
        let damped = body.is_coupled();
        if !(damped || wheel.is_some() && crosses) {
            return Ok(None);
        }
        let key = wheel.filter(|_| !damped).unwrap_or_else(|| self.damping_key());
        let modes = body.modes.len();
        if modes > MOST_COUPLED {
            return Err(Fault::new(
                key,
                format!("couples at most {MOST_COUPLED} modes, and the body has {modes}"),
            ));
        }
        let (back_emf, total) = self.back_emf(body);
        let coupled = Coupled::new(body, back_emf, total, &vec![1.0; modes]);
        match coupled.flow() {
            Some(flow) => Ok(Some(Arc::new(flow))),
            None => Err(Fault::new(key, format!("with the modes {TOO_FAR_APART}"))),
        }
    }
}
