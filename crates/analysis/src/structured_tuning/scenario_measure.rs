//! Measures of a scenario's loop that a tuning minimises or limits: settling times, pointing indices, contrasts of images, and
//! requirements over time, by a run.

use flexsc_formats::document::ConfigError;

use super::goal::TunedMeasure;
use crate::budget::{LEVELS, linear_noise, sigmas};
use crate::noise::{LineLoop, NoiseError, NoisyLoop, RequiredContrast};
use crate::open_loop::LoopParts;
use flexsc_numerics::time::Instant;
use flexsc_record::{Record, RecordError, RequirementRobustness, RobustnessOfRequirements, Sample};
use flexsc_scenario::{RequirementSource, Scenario};
use flexsc_sim::Simulation;

/// Measure of a scenario's loop.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ScenarioMeasure {
    /// Settling times (s) of the angles after a step about each axis.
    Settling,
    /// Rms of the pointing index of the requirement with this index under the noise of the loop.
    Index(usize),
    /// Value of the requirement over time with this index, in a run.
    OverTime(usize),
    /// Loss 1 - MTF of the requirement on the contrast of an image with this index.
    Contrast(usize),
}

/// Robustness of the requirements over time of a run.
#[derive(Default)]
struct RobustnessOfRun(Vec<RequirementRobustness>);

impl Record for RobustnessOfRun {
    fn wants_switchings(&self) -> bool {
        false
    }

    fn wants_journal(&self) -> bool {
        false
    }

    fn record(&mut self, _: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        if let Some(RobustnessOfRequirements(all)) = sample.get() {
            self.0.clone_from(all);
        }
        Ok(())
    }
}

impl ScenarioMeasure {
    /// Returns the measure of the requirement with a name.
    ///
    /// # Errors
    /// No requirement with the name, one on a metric, and one over time whose limit is not above 0.
    pub fn for_requirement(scenario: &Scenario, name: &str) -> Result<Self, ConfigError> {
        let contrasts = &scenario.study.contrasts;
        if let Some(index) = contrasts.iter().position(|own| own.name == name) {
            return Ok(Self::Contrast(index));
        }
        let all = &scenario.study.requirements;
        let Some(index) = all.iter().position(|own| own.name == name) else {
            let known = all.iter().map(|own| &own.name).chain(contrasts.iter().map(|own| &own.name));
            let known: Vec<String> = known.map(|name| format!("`{name}`")).collect();
            let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
            let why = format!(
                "has no requirement `{name}` (requirements: {known}); `margin` and `settling` need none"
            );
            return Err(ConfigError::new("requirement", why));
        };
        match all[index].source {
            RequirementSource::Error(_) => Ok(Self::Index(index)),
            RequirementSource::Formula(_) if all[index].limit > 0.0 => Ok(Self::OverTime(index)),
            RequirementSource::Formula(_) => {
                let why =
                    "has a limit that is not above 0, and a tuning measures values as parts of their limit";
                Err(ConfigError::new(scenario.requirement_key(name), why))
            }
            RequirementSource::Metric(..) => {
                let why = "limits a metric, and a tuning needs a pointing index or `holds`: `quantity` must be `pointing_error`, \
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
            Self::Contrast(index) => {
                let own = &scenario.study.contrasts[*index];
                let limit = is_limited.then_some(1.0 - own.least);
                TunedMeasure { name: own.name.clone(), unit: "", limit }
            }
            Self::OverTime(index) => {
                let own = &scenario.study.requirements[*index];
                TunedMeasure {
                    name: own.name.clone(),
                    unit: own.unit,
                    limit: is_limited.then_some(own.limit),
                }
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
                let refused = |fault: ConfigError| format!("{name}: `{}` {}", fault.key, fault.why);
                let mut machines = scenario.disturbance.iter();
                let lines = machines
                    .any(|own| own.density.is_some() || own.lines.is_some())
                    .then(|| LineLoop::from_parts(parts.clone()));
                let lines = lines.transpose().map_err(refused)?;
                let rms = linear_noise(&noisy, lines.as_ref(), error).map_err(refused)?;
                let missing =
                    || format!("{name}: the linear loop has no index of the requirement `{}`", own.name);
                Ok(vec![rms.ok_or_else(missing)?])
            }
            Self::Contrast(index) => {
                match RequiredContrast::from_parts(parts, &scenario.study.contrasts[*index]) {
                    Ok(found) => Ok(vec![1.0 - found.mtf]),
                    Err(NoiseError::Unstable(_) | NoiseError::Unsettled(_)) => Ok(vec![f64::INFINITY]),
                    Err(fault) => Err(format!("{name}: {fault}")),
                }
            }
            Self::OverTime(index) => {
                let own = &scenario.study.requirements[*index];
                let RequirementSource::Formula(formula) = &own.source else {
                    return Err(format!("{name}: the requirement `{}` is not over time", own.name));
                };
                let mut found = RobustnessOfRun::default();
                let ended = Simulation::new(scenario, 0).run(&mut found);
                let robustness = found.0.iter().find(|found| found.requirement == *index);
                let robustness =
                    robustness.filter(|_| ended.is_ok()).and_then(RequirementRobustness::decided);
                // A run that fails, decides nothing or exercises nothing is beyond every limit.
                let robustness = robustness.filter(|own| own.is_finite());
                Ok(vec![
                    robustness.map_or(f64::INFINITY, |robustness| own.limit - robustness * formula.scale),
                ])
            }
        }
    }
}
