//! Verdict on a run: failed, missed, met with a warning, met, or not asked.

use flexsc_formats::count::counted;
use flexsc_formats::reader_units::time;
use serde::Serialize;

use super::lines::RunData;
use super::requirement_answer::RequirementAnswer;
use super::warning::Warning;
use crate::requirement_verdict::Decision;

/// Verdict on a run.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RunVerdict {
    /// The motion diverges.
    Failed,
    /// A requirement is not met.
    Missed,
    /// All requirements are met, and a warning says that target, filter or loop is lost.
    MetBut,
    /// All requirements are met.
    Met,
    /// There is no requirement, and the goal of the scenario is met.
    GoalMet,
    /// There is no requirement, and the goal of the scenario is missed.
    GoalMissed,
    /// There is neither a requirement nor a goal.
    NotAsked,
}

/// Goal that a scenario gives.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GoalAnswer {
    /// Whether the run ends within the band.
    pub met: bool,
    /// Half width of the band about each axis, or about one (rad).
    pub band_rad: f64,
    /// Time outside the band (s).
    pub outside_s: f64,
    /// Words.
    pub text: String,
}

impl GoalAnswer {
    /// Returns the goal of a run; `None` unless the scenario gives its band.
    pub(super) fn new(run: &RunData<'_>) -> Option<Self> {
        run.scenario.reference.band?;
        let word = run.metrics.word("goal")?;
        let (band, outside) = (run.number("goal_band_rad"), run.number("time_outside_s"));
        if !band.is_finite() {
            return None;
        }
        let met = word == "met";
        let each = if run.scenario.axis_count() == 3 { "each axis " } else { "" };
        let within = format!("{each}within {}", run.units.quantity(band, "rad"));
        let settled = run.number("settling_time_s");
        let text = match (met, outside) {
            (true, 0.0) => format!("{within} all the time"),
            (true, _) if settled.is_finite() => format!("{within} from {} on", time(settled)),
            (true, _) => format!("{within}, after {} outside", time(outside)),
            (false, _) => format!("not {within} in the last tenth; outside for {}", time(outside)),
        };
        Some(Self { met, band_rad: band, outside_s: outside, text })
    }
}

/// Returns the verdict and its words.
pub(super) fn verdict(
    requirements: &[RequirementAnswer],
    goal: Option<&GoalAnswer>,
    warnings: &[Warning],
) -> (RunVerdict, String) {
    let count = |decision| requirements.iter().filter(|own| own.decision == decision).count();
    let (missed, undecided) = (count(Decision::Missed), count(Decision::Undecided));
    let (all, of_all) = (requirements.len(), counted(requirements.len(), "requirement"));
    if missed > 0 {
        return (RunVerdict::Missed, format!("MISSED: {missed} of {of_all}"));
    }
    if undecided > 0 {
        return (RunVerdict::Missed, format!("undecided: {undecided} of {of_all}"));
    }
    let but = warnings.iter().find_map(|warning| warning.kind.reason(warning));
    if all > 0 {
        let idle = count(Decision::NotExercised);
        let not = if idle > 0 { format!(", {idle} not exercised") } else { String::new() };
        let met = format!("{} of {of_all} met{not}", all - idle);
        return match but {
            Some(why) => (RunVerdict::MetBut, format!("{met}, but {why}")),
            None => (RunVerdict::Met, met),
        };
    }
    match goal {
        Some(goal) if goal.met => (RunVerdict::GoalMet, format!("goal met: {}", goal.text)),
        Some(goal) => (RunVerdict::GoalMissed, format!("goal missed: {}", goal.text)),
        None => (RunVerdict::NotAsked, "no requirement".to_owned()),
    }
}
