//! Laws about all axes of a body: one about each, or one about three axes together.

use super::{Authority, ControlOutput, Law, LawKind, ThreeAxisLaw, ThreeAxisOutput};

/// Laws about all axes, with their current outputs.
#[derive(Clone, Debug, Default)]
pub(super) struct AxesLaws {
    /// Law about each axis; empty if one law acts about three axes together.
    pub axes: Vec<ControllerState>,
    /// Law about three axes together, with its current output.
    pub three_axis: Option<(Box<dyn ThreeAxisLaw>, ThreeAxisOutput)>,
    /// Longest lead time after a sample for which the laws read predicted elastic rates (s).
    pub lead_time: f64,
}

/// Law with its current output.
#[derive(Clone, Debug)]
pub(super) struct ControllerState {
    /// Law about the axis.
    pub law: Box<dyn Law>,
    /// Current output.
    pub hold: ControlOutput,
    /// Key prefix of the law within a law `per_axis`; else empty.
    place: String,
}

impl AxesLaws {
    /// Creates the laws before a run, about axes with these actuator authorities; `by_stage` has those of each stage
    /// about each axis, or is empty if all stages have the same.
    pub fn new(law: &LawKind, authorities: &[Authority], by_stage: &[Vec<Authority>]) -> Self {
        let axis = |(axis, authority)| {
            let place = if let LawKind::PerAxis(laws) = law { laws.key_prefix(axis) } else { String::new() };
            let law = match (law.about(axis), by_stage.get(axis)) {
                (LawKind::Stages(stages), Some(authorities)) => stages.start_with(authorities),
                (law, _) => law.start(authority),
            };
            ControllerState { law, hold: ControlOutput::NONE, place }
        };
        if let Some(law) = law.start_three_axis(authorities) {
            let lead_time = law.reference_needs().lead_time;
            return Self { axes: Vec::new(), three_axis: Some((law, ThreeAxisOutput::NONE)), lead_time };
        }
        let axes: Vec<ControllerState> = authorities.iter().enumerate().map(axis).collect();
        let lead_times = axes.iter().map(|held| held.law.reference_needs().lead_time);
        let lead_time = lead_times.fold(0.0, f64::max);
        Self { axes, three_axis: None, lead_time }
    }

    /// Sets a parameter of all laws, or of the law about one axis that the key selects.
    pub fn tune(&mut self, key: &str, value: f64) {
        self.three_axis.iter_mut().for_each(|(law, _)| law.tune(key, value));
        for held in &mut self.axes {
            if let Some(key) = key.strip_prefix(held.place.as_str()) {
                held.law.tune(key, value);
            }
        }
    }

    /// Returns the value of the tuned parameter of the law about an axis.
    pub fn tuned(&self, axis: usize) -> f64 {
        match &self.three_axis {
            Some((law, _)) => law.state().tuned,
            None => self.axes.get(axis).map_or(f64::NAN, |held| held.law.state().tuned),
        }
    }
}
