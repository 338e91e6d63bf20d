//! Measures of a scenario's loop that a tuning minimises or limits: settling times and pointing indices.

use flexsc_formats::document::ConfigError;

use super::goal::TunedMeasure;
use crate::budget::{LEVELS, linear_noise, sigmas};
use crate::noise::{NoiseError, NoisyLoop};
use crate::open_loop::LoopParts;
use flexsc_scenario::{RequirementSource, Scenario};

/// Measure of a scenario's loop.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ScenarioMeasure {
    /// Settling times (s) of the angles after a step about each axis.
    Settling,
    /// Rms of the pointing index of the requirement with this index under the noise of the loop.
    Index(usize),
}

impl ScenarioMeasure {
    /// Returns the measure of the requirement with a name.
    ///
    /// # Errors
    /// No requirement with the name, and one on a metric or over time.
    pub fn for_requirement(scenario: &Scenario, name: &str) -> Result<Self, ConfigError> {
        let all = &scenario.study.requirements;
        let Some(index) = all.iter().position(|own| own.name == name) else {
            let known: Vec<String> = all.iter().map(|own| format!("`{}`", own.name)).collect();
            let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
            let why = format!(
                "has no requirement `{name}` (requirements: {known}); `margin` and `settling` need none"
            );
            return Err(ConfigError::new("requirement", why));
        };
        match all[index].source {
            RequirementSource::Error(_) => Ok(Self::Index(index)),
            RequirementSource::Metric(..) | RequirementSource::Formula(_) => {
                let why = "limits no pointing index, which a tuning of the linear loop needs: `quantity` must be `pointing_error`, \
                           `rate_error` or `line_of_sight`";
                Err(ConfigError::new(scenario.requirement_key(name), why))
            }
        }
    }

    /// Returns the name, the unit and, if the measure of a requirement `is_limited`, the limit: that of the requirement,
    /// divided by the number of standard deviations at its level, at most 3.
    pub fn describe(&self, scenario: &Scenario, limit: Option<f64>, is_limited: bool) -> TunedMeasure {
        match self {
            Self::Settling => TunedMeasure { name: "settling".to_owned(), unit: "s", limit },
            Self::Index(index) => {
                let own = &scenario.study.requirements[*index];
                let own_limit = is_limited.then(|| own.limit / sigmas(own.level.min(LEVELS[2])));
                TunedMeasure { name: own.name.clone(), unit: own.unit, limit: own_limit }
            }
        }
    }

    /// Returns the components of the measure of a loop that is cut open at the command; the largest counts.
    ///
    /// # Errors
    /// A loop that does not have the measure.
    pub(super) fn values(&self, parts: &LoopParts<'_>) -> Result<Vec<f64>, String> {
        let (scenario, name) = (parts.scenario, &parts.scenario.name);
        match self {
            Self::Settling => {
                let times = parts
                    .settling_times()
                    .map_err(|fault| format!("{name}: `{}` {}", fault.key, fault.why))?;
                Ok(times.into_iter().map(|settling| settling.time_s).collect())
            }
            Self::Index(index) => {
                let own = &scenario.study.requirements[*index];
                let RequirementSource::Error(error) = &own.source else {
                    return Err(format!("{name}: the requirement `{}` limits no pointing index", own.name));
                };
                let noisy = match NoisyLoop::from_parts(parts) {
                    Ok(noisy) => noisy,
                    Err(NoiseError::Unstable(_) | NoiseError::Unsettled(_)) => {
                        return Ok(vec![f64::INFINITY]);
                    }
                    Err(fault) => return Err(format!("{name}: {fault}")),
                };
                let rms = linear_noise(&noisy, error).ok_or_else(|| {
                    format!("{name}: the linear loop has no index of the requirement `{}`", own.name)
                })?;
                Ok(vec![rms])
            }
        }
    }
}
