//! Answer of a run: what was asked, whether it is met, by how much and when not, made once from the metrics and from what
//! an observer saw in every control cycle. Numbers are in SI units; beside them stand their texts in the reader's units, so
//! that text, JSON, Python and reports say the same.

mod angle_watch;
mod campaign_answer;
mod campaign_comparison;
mod campaign_mode;
mod campaign_screen;
mod campaign_warning;
mod driving_key;
mod error_statistics;
mod event;
mod fault_answer;
mod key_difference;
mod largest_sample;
mod limit_watch;
mod lines;
mod logged_answer;
mod mode_answer;
mod one_axis_lines;
mod requirement_answer;
mod run_comparison;
mod run_observer;
mod screen;
mod three_axis_lines;
mod verdict;
mod warning;

use flexsc_formats::reader_units::ReaderUnits;
use flexsc_scenario::{RequirementSource, Scenario};
use serde::Serialize;

use crate::metrics::{MetricValue, Metrics};
use crate::requirement_verdict::{self, RequirementVerdict};

pub use campaign_answer::{
    CampaignAnswer, CampaignRequirement, CampaignRequirementText, MarginSpread, MetShare, WorstRun,
};
pub use campaign_comparison::CampaignComparison;
pub use campaign_mode::{CampaignMode, RunSpread};
pub use campaign_warning::CampaignWarning;
pub use driving_key::DrivingKey;
pub use error_statistics::ErrorSummary;
pub use event::{EventKind, RunEvent};
pub use fault_answer::{FaultAnswer, FaultRequirement, LeastRobust};
pub use key_difference::KeyDifference;
pub use lines::Line;
pub use mode_answer::ModeAnswer;
pub use requirement_answer::{LargestValue, RequirementAnswer, RequirementText, requirement_id};
pub use run_comparison::RunComparison;
pub use run_observer::{Observed, RunObserver};
pub use screen::{ScreenOptions, ScreenStyle};
pub use verdict::{GoalAnswer, RunVerdict};
pub use warning::{Warning, WarningKind};

use largest_sample::LargestSample;
use lines::RunData;

/// Name and version of the structure.
const SCHEMA: &str = "flexsc-answer-1";

/// Answer of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Answer {
    /// Name and version of the structure, which changes when a field changes its meaning.
    pub schema: &'static str,
    /// Name of the scenario.
    pub scenario: String,
    /// Simulated time (s).
    pub duration_s: f64,
    /// Period (s) of the rows of a log from which the answer is made; absent where every control cycle was seen.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from_rows_s: Option<f64>,
    /// Verdict.
    pub verdict: RunVerdict,
    /// Verdict in words.
    pub verdict_text: String,
    /// Requirements, missed ones first, then by margin.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub requirements: Vec<RequirementAnswer>,
    /// Goal, if the scenario gives its band.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub goal: Option<GoalAnswer>,
    /// Warnings, the gravest first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<Warning>,
    /// Modes of operation, in the order of the scenario.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub by_mode: Vec<ModeAnswer>,
    /// Events, in the order of their starts.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub events: Vec<RunEvent>,
    /// Lines of text on what else is known.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub lines: Vec<Line>,
}

impl Answer {
    /// Returns the answer of a run that has ended, from its metrics and, if it was observed, from every control cycle.
    pub fn new(
        scenario: &Scenario,
        metrics: &Metrics,
        observed: Option<&Observed>,
        units: ReaderUnits,
    ) -> Self {
        let verdicts = requirement_verdict::run_verdicts(scenario, metrics);
        let run = RunData { scenario, metrics, observed, units };
        let mut requirements: Vec<RequirementAnswer> = run.requirements(&verdicts);
        let warnings = warning::warnings(&run, &requirements);
        let goal = GoalAnswer::new(&run);
        let diverges = warnings.iter().any(|warning| warning.kind == WarningKind::Diverges);
        let (verdict, verdict_text) = if diverges {
            (RunVerdict::Failed, format!("FAILED: the motion diverges within {}", run.duration_text()))
        } else {
            verdict::verdict(&requirements, goal.as_ref(), &warnings)
        };
        // Missed ones first, then by margin.
        requirements
            .sort_by(|a, b| b.decision.fails().cmp(&a.decision.fails()).then(a.margin.total_cmp(&b.margin)));
        let (by_mode, lines) = if diverges { Default::default() } else { (run.by_mode(), run.lines()) };
        let mut events = observed.map_or_else(Vec::new, |observed| observed.events.clone());
        events.extend(run.losses());
        if observed.is_some() {
            events.extend(scenario.orbit_environment().eclipses_seen().into_iter().map(RunEvent::eclipse));
        }
        events.sort_by(|a, b| a.from_s.total_cmp(&b.from_s));
        Self {
            schema: SCHEMA,
            scenario: scenario.name.clone(),
            duration_s: scenario.duration.seconds(),
            from_rows_s: None,
            verdict,
            verdict_text,
            requirements,
            goal,
            warnings,
            by_mode,
            events,
            lines,
        }
    }
}

impl RunData<'_> {
    fn requirements(&self, verdicts: &[RequirementVerdict]) -> Vec<RequirementAnswer> {
        let peaks = self.observed.map_or(&[][..], |observed| &observed.peaks);
        let times = self.metrics.get("requirement_times_s").map_or_else(Vec::new, MetricValue::numbers);
        let answer = |(index, verdict): (usize, &RequirementVerdict)| {
            let time = times.get(index).copied().unwrap_or(f64::NAN);
            // The value of a requirement over time is the one that decides.
            let mode = self.mode_at(time);
            let deciding = LargestSample { value: verdict.value, at: time, mode };
            let is_angle = matches!(
                &verdict.requirement.source,
                RequirementSource::Metric(name, None) if name == angle_watch::PEAK
            );
            let peak = match self.observed {
                Some(observed) if is_angle => observed.largest_angle,
                _ => peaks.get(index).copied().flatten(),
            };
            let peak = peak.or(Some(deciding).filter(|own| own.at.is_finite()));
            RequirementAnswer::new(self, (index, verdict), peak)
        };
        verdicts.iter().enumerate().map(answer).collect()
    }

    /// Returns the index of the mode of operation at a time (s), if the run was observed; that of none otherwise.
    fn mode_at(&self, t: f64) -> usize {
        let events = self.observed.map_or(&[][..], |observed| &observed.events);
        let event =
            events.iter().filter(|event| event.kind == EventKind::Mode).rfind(|event| event.from_s <= t);
        let mode = event.and_then(|event| self.scenario.mode.iter().position(|mode| mode.name == event.part));
        mode.unwrap_or(usize::MAX)
    }

    fn duration_text(&self) -> String {
        flexsc_formats::reader_units::time(self.scenario.duration.seconds())
    }
}
