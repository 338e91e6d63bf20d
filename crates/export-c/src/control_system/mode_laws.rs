//! Laws of the modes or stages of a control system.

use flexsc_core::control::law::LawKind;
use flexsc_core::{Scenario, ScenarioError};

use super::b_dot::BDotLaws;
use super::{CallLayout, NotExportable, SampledLaws, StoredMomentum};

/// Laws of a mode.
#[derive(Clone, Debug)]
pub struct LawsOfMode {
    /// Name of the mode in C.
    pub name: String,
    /// Laws as they start.
    pub start: ModeLaws,
    /// Laws in the run.
    pub(super) current: ModeLaws,
    /// True if wheels execute their commands.
    pub drives_wheels: bool,
    /// True if jets execute their commands.
    pub fires_jets: bool,
}

/// Laws of a mode by what they read.
#[derive(Clone, Debug)]
pub enum ModeLaws {
    /// Open loop, without commands.
    Open,
    /// B-dot laws, which read the rate of change of the magnetic field.
    BDot(BDotLaws),
    /// Laws that read estimates.
    OnEstimates(Box<SampledLaws>),
}

impl ModeLaws {
    /// Returns the laws that read estimates.
    pub fn on_estimates(&self) -> Option<&SampledLaws> {
        if let Self::OnEstimates(laws) = self { Some(laws) } else { None }
    }

    /// Returns the B-dot laws.
    pub fn b_dot(&self) -> Option<&BDotLaws> {
        if let Self::BDot(laws) = self { Some(laws) } else { None }
    }

    /// Returns the period (s); `None` of an open loop.
    pub(super) fn period(&self) -> Option<f64> {
        match self {
            Self::Open => None,
            Self::BDot(laws) => Some(laws.period),
            Self::OnEstimates(laws) => Some(laws.period),
        }
    }

    /// Returns the function that decides; `None` of an open loop.
    pub(super) fn layout(&self) -> Option<CallLayout> {
        match self {
            Self::Open => None,
            Self::BDot(_) => Some(BDotLaws::layout()),
            Self::OnEstimates(laws) => Some(laws.layout()),
        }
    }
}

/// Returns the laws of a mode or stage.
pub(super) fn laws_of_mode(
    scenario: &Scenario,
    index: usize,
    has_modes: bool,
) -> Result<ModeLaws, NotExportable> {
    let written = if has_modes {
        scenario.mode.get(index).map(|mode| &mode.law)
    } else {
        scenario.law.stages().get(index).map(|stage| &stage.law)
    };
    match written {
        None | Some(LawKind::Open(_)) => return Ok(ModeLaws::Open),
        Some(LawKind::Relay(_)) => {
            let reason = "decides at events, and laws of modes in flight code decide at their period: `--mode NAME` exports it alone";
            return Err(NotExportable::new("law.relay", reason));
        }
        Some(law @ LawKind::BDot(_)) => {
            let laws: Vec<&LawKind> = (0..scenario.study.axes.len()).map(|axis| law.about(axis)).collect();
            return Ok(ModeLaws::BDot(BDotLaws::new(scenario, &laws)?));
        }
        Some(_) => {}
    }
    let alone = alone(scenario, index, has_modes);
    let alone = alone.map_err(|error| NotExportable::new("law", format!("cannot act alone: {error}")))?;
    let laws: Vec<&LawKind> = (0..alone.study.axes.len()).map(|axis| alone.law.about(axis)).collect();
    let mut laws = SampledLaws::new(&alone, &laws)?;
    // One filter and the same actuators serve the laws of all modes.
    laws.read_estimates();
    laws.only_command();
    // Wheels that do not act in the mode store momentum all the same.
    laws.stored = StoredMomentum::new(scenario);
    Ok(ModeLaws::OnEstimates(Box::new(laws)))
}

/// Returns the scenario in which a mode or stage acts throughout, without requirements, which may name other modes.
fn alone(scenario: &Scenario, index: usize, has_modes: bool) -> Result<Scenario, ScenarioError> {
    let whole = scenario.clone().with(|written| written.requirement.clear())?;
    match scenario.mode.get(index).filter(|_| has_modes) {
        Some(mode) => whole.in_mode(&mode.name),
        None => whole.in_stage(index),
    }
}
