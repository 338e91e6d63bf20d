//! Requirement on an output of a loop: its limit in the unit in which it was written, and its window.

use flexsc_core::Scenario;
use flexsc_core::analysis::noise::{SpectralLine, Window, WindowRms};
use flexsc_core::scenario::{
    AssessedRequirement, IndexWindow, RequirementSource, SampledError, SampledQuantity, WindowConvention,
};

use crate::required_limit::RequiredLimit;

/// Requirement on an output.
pub struct RequiredIndex {
    /// Name of the requirement.
    pub name: String,
    /// Limit.
    pub required: RequiredLimit,
    /// Window within which only deviations from the mean count (s), if there is one.
    pub window_s: Option<f64>,
    convention: WindowConvention,
}

impl RequiredIndex {
    /// Returns the requirement on an output, one with a window before one without.
    pub fn on_output(scenario: &Scenario, output: &str) -> Option<Self> {
        let all = || scenario.study.requirements.iter().filter_map(|one| Self::new(one, output));
        all().find(|one| one.window_s.is_some()).or_else(|| all().next())
    }

    fn new(requirement: &AssessedRequirement, output: &str) -> Option<Self> {
        let RequirementSource::Error(SampledError { quantity, axis, index, period, .. }) =
            &requirement.source
        else {
            return None;
        };
        let is_about = |axes: &[&str; 3], own: &str| {
            let place = axes.iter().position(|axis| *axis == own);
            place.is_some_and(|place| axis.is_none_or(|axis| axis as usize == place))
        };
        let is_own = match quantity {
            SampledQuantity::LineOfSight(sight, _) => {
                let name = format!("line_of_sight{sight}_");
                output.strip_prefix(&name).is_some_and(|own| is_about(&["x", "y", "z"], own))
            }
            SampledQuantity::PointingError => {
                let own = output.strip_suffix("_error").unwrap_or(output);
                own == "angle" || is_about(&["roll", "pitch", "yaw"], own)
            }
            SampledQuantity::RateError => false,
        };
        let (window_s, convention) = match index {
            IndexWindow::Absolute => (None, WindowConvention::Uniform),
            IndexWindow::Relative { window, convention } => {
                (Some(*window as f64 * period.seconds()), *convention)
            }
            IndexWindow::Mean { .. } | IndexWindow::Difference { .. } => return None,
        };
        let (name, required) = (requirement.name.clone(), RequiredLimit::new(requirement));
        is_own.then_some(Self { name, required, window_s, convention })
    }

    /// Returns the rms of the deviations of lines from their mean over windows of a length (s).
    pub fn rms_within<'a>(
        own: Option<&Self>,
        lines: impl Iterator<Item = &'a SpectralLine>,
        window_s: f64,
    ) -> f64 {
        let rms = WindowRms::from_lines(lines.copied(), Window { length: window_s, separation: None });
        match own.map_or(WindowConvention::Uniform, |own| own.convention) {
            WindowConvention::Uniform => rms.rpe_uniform,
            WindowConvention::End => rms.rpe_end,
            WindowConvention::Middle => rms.rpe_middle,
        }
    }
}
