//! Properties of the law of a scenario that only some kinds have.

use std::sync::Arc;

use flexsc_numerics::quantity::Finite;
use flexsc_numerics::time::Span;
use flexsc_record::CustomTopic;

use super::{ActiveDamping, AttitudeTarget, Authority, LawKind, Pd, Relay, Stage, error_band};

/// Law about an axis, with its place in a scenario.
#[derive(Clone, Debug)]
pub struct PlacedLaw<'a> {
    /// Key of the law.
    pub key: String,
    /// Law about the axis.
    pub law: &'a LawKind,
    /// True if the other axes have laws of their own.
    pub is_per_axis: bool,
    /// Stage or mode in which the law acts; `None` for a law that acts throughout.
    pub stage: Option<&'a Stage>,
}

impl PlacedLaw<'_> {
    /// Returns true if actuators of a kind execute the commands of the law.
    pub fn selects(&self, kind: &str) -> bool {
        self.stage.is_none_or(|stage| stage.selects(kind))
    }
}

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

    /// Returns the laws about an axis that act one after another or in modes of operation; one for any other law.
    pub fn laws_about(&self, axis: usize) -> Vec<PlacedLaw<'_>> {
        let Self::Stages(laws) = self else {
            let is_per_axis = matches!(self, Self::PerAxis(_));
            return vec![PlacedLaw {
                key: self.key_about(axis),
                law: self.about(axis),
                is_per_axis,
                stage: None,
            }];
        };
        let stages = laws.as_slice().iter().enumerate();
        let placed = stages.map(|(index, stage)| PlacedLaw {
            key: format!("{}[{index}].{}", self.key(), stage.law.key_about(axis)),
            law: stage.law.about(axis),
            is_per_axis: matches!(stage.law, Self::PerAxis(_)),
            stage: Some(stage),
        });
        placed.collect()
    }

    /// Returns the relay laws that act about an axis, in any stage or mode.
    pub fn relays_about(&self, axis: usize) -> Vec<&Relay> {
        self.laws_about(axis).into_iter().filter_map(|placed| placed.law.relay()).collect()
    }

    /// Returns the period in which an actuator of a kind executes the commands of the law about an axis; in stages or modes,
    /// that of a law that plans pulses, else the shortest.
    pub fn cycle(&self, axis: usize, kind: &str) -> Option<Span> {
        let laws = self.laws_about(axis);
        let driving = || laws.iter().filter(|placed| placed.selects(kind)).map(|placed| placed.law.offers());
        let planned = driving().find(|offers| offers.plans_pulses).and_then(|offers| offers.period);
        planned.or_else(|| driving().filter_map(|offers| offers.period).min())
    }

    /// Returns the target attitudes within the law; empty if those of the scenario apply.
    pub fn own_targets(&self) -> &[AttitudeTarget] {
        if let Self::PhasePlane(law) = self { &law.targets } else { &[] }
    }

    /// Returns the topics of the rows that the law reports beyond those of the engine.
    pub fn custom_topics(&self) -> Vec<Arc<CustomTopic>> {
        match self {
            Self::StateSpace(law) => law.topics(),
            Self::Stages(laws) => laws.laws().flat_map(Self::custom_topics).collect(),
            Self::Own(own) => own.topics().to_vec(),
            _ => Vec::new(),
        }
    }

    /// Returns true if the law, or that of a stage or mode, is of another crate.
    pub fn has_custom(&self) -> bool {
        self.custom().is_some() || self.stages().iter().any(|stage| stage.law.has_custom())
    }
}
