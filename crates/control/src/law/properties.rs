//! Properties of the law of a scenario that only some kinds have.

use std::sync::Arc;

use flexsc_numerics::quantity::Finite;
use flexsc_record::CustomTopic;

use super::{ActiveDamping, AttitudeTarget, Authority, LawKind, LawSpec, Pd, Relay, error_band};
use crate::custom::Custom;

impl LawKind {
    /// Returns the parameter that an adaptation tunes by default; NaN if the law has none.
    pub fn tuned(&self) -> f64 {
        self.tunable().first().map_or(f64::NAN, |number| number.value)
    }

    /// Returns the inertia tensor in the law's model of a three-axis body, row by row (kg m²), if the law, or a stage of
    /// it, has its own.
    pub fn inertia(&self) -> Option<&[[Finite; 3]; 3]> {
        match self {
            Self::Attitude(law) => law.inertia.as_ref(),
            Self::Stages(laws) => laws.laws().find_map(Self::inertia),
            _ => None,
        }
    }

    /// Returns the relay law, if the law is one.
    pub fn relay(&self) -> Option<&Relay> {
        if let Self::Relay(law) = self { Some(law) } else { None }
    }

    /// Returns the sampled PD law, if the law is one.
    pub fn pd(&self) -> Option<&Pd> {
        if let Self::Pd(law) = self { Some(law) } else { None }
    }

    /// Returns the half width of the zone without torque (rad); 0 without a zone.
    pub fn dead_zone(&self) -> f64 {
        self.relay().map_or(0.0, |law| law.dead_zone.get())
    }

    /// Returns the torque command per angle error (1/rad); 0 if the law is no spring.
    pub fn stiffness(&self) -> f64 {
        self.pd().map_or(0.0, |law| law.k_p.get())
    }

    /// Returns the half width (rad) of the zone about the target in which the body coasts, of a law that plans pulses.
    pub fn coasting_zone(&self) -> Option<f64> {
        if let Self::PhasePlane(law) = self { Some(law.dead_zone.get()) } else { None }
    }

    /// Returns the half width (rad) of the band about the target that the law keeps with an actuator authority, if it
    /// depends on that.
    pub fn band_with(&self, authority: &Authority) -> Option<f64> {
        if let Self::PhasePlane(law) = self { Some(error_band(law, authority)) } else { None }
    }

    /// Returns the coefficients of the sampled filters of the law's output; empty without filters.
    pub fn filter_coefficients(&self) -> Vec<([f64; 3], [f64; 2])> {
        let Self::Attitude(law) = self else { return Vec::new() };
        let period = law.period.seconds();
        law.filters.iter().filter_map(|filter| Some(filter.sampled(period).ok()?.coefficients())).collect()
    }

    /// Returns the active damping of elastic motion, if the law has it.
    pub fn active_damping(&self) -> Option<&ActiveDamping> {
        if let Self::PhasePlane(law) = self { law.damping.as_ref() } else { None }
    }

    /// Returns true for the laws of modes of operation, which are written in the modes.
    pub fn is_of_modes(&self) -> bool {
        matches!(self, Self::Stages(laws) if laws.are_modes())
    }

    /// Returns the key of the law: `law.pd` and the like, or `mode` for the laws of modes.
    pub fn key(&self) -> String {
        if self.is_of_modes() { "mode".to_owned() } else { format!("law.{}", self.kind()) }
    }

    /// Returns the key of the law about an axis.
    pub fn key_about(&self, axis: usize) -> String {
        match self {
            Self::PerAxis(laws) => {
                format!("law.per_axis.{}.{}", flexsc_numerics::attitude::AXES[axis], laws.about(axis).kind())
            }
            law => law.key(),
        }
    }

    /// Returns the target attitudes within the law; empty if those of the scenario apply.
    pub fn own_targets(&self) -> &[AttitudeTarget] {
        if let Self::PhasePlane(law) = self { &law.targets } else { &[] }
    }

    /// Returns the topics of the rows that the law reports beyond those of the engine.
    pub fn custom_topics(&self) -> Vec<Arc<CustomTopic>> {
        match self {
            Self::StateSpace(law) => law.topics(),
            Self::Own(own) => own.topics().to_vec(),
            _ => Vec::new(),
        }
    }

    /// Returns the law of another crate, if it is one.
    pub fn custom(&self) -> Option<&Custom<dyn LawSpec + Send + Sync>> {
        if let Self::Own(own) = self { Some(own) } else { None }
    }
}

impl From<Custom<dyn LawSpec + Send + Sync>> for LawKind {
    fn from(law: Custom<dyn LawSpec + Send + Sync>) -> Self {
        Self::Own(law)
    }
}
