//! Faults of a campaign that varies the active fault: the decision on each requirement in the runs of each.

use flexsc_formats::count::counted;
use flexsc_formats::text_columns::columns;
use flexsc_scenario::Scenario;
use serde::Serialize;

use super::requirement_answer::{margin_text, requirement_id};
use super::screen::{ScreenOptions, indented, wrapped};
use crate::campaign::CampaignRuns;
use crate::requirement_verdict::{Decision, RequirementVerdict};

/// Fault with the requirements in its runs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FaultAnswer {
    /// Name, or `none`.
    pub fault: String,
    /// Number of its runs.
    pub runs: u64,
    /// Requirements, in the order of the scenario.
    pub requirements: Vec<FaultRequirement>,
}

/// Requirement in the runs of a fault.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FaultRequirement {
    /// Identifier: R and the place in the scenario, from 1.
    pub id: String,
    /// Name.
    pub name: String,
    /// Decision over the runs of the fault.
    pub decision: Decision,
    /// Number of runs in which something was to meet it.
    pub runs: u64,
    /// Number of runs that meet it.
    pub runs_met: u64,
    /// Least margin, (limit - value)/limit; absent without a value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub margin: Option<f64>,
    /// Number of the run with the least margin, or without a value.
    pub run: u64,
}

/// Run with the least margin of all requirements under a fault.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LeastRobust {
    /// Name of the fault.
    pub fault: String,
    /// Name of the requirement.
    pub requirement: String,
    /// Margin; absent without a value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub margin: Option<f64>,
    /// Number of the run.
    pub run: u64,
}

impl FaultRequirement {
    fn new(index: usize, verdict: &RequirementVerdict) -> Self {
        let RequirementVerdict { requirement, decision, runs, runs_met, worst: (run, worst), .. } = verdict;
        let limit = requirement.limit;
        let margin = (limit - worst) / if limit == 0.0 { 1.0 } else { limit };
        Self {
            id: requirement_id(index),
            name: requirement.name.clone(),
            decision: *decision,
            runs: *runs,
            runs_met: *runs_met,
            margin: Some(margin).filter(|margin| margin.is_finite()),
            run: *run,
        }
    }

    /// Returns the decision with the least margin, and with the runs that meet it unless it is one.
    pub fn text(&self) -> String {
        let mark = self.decision.mark();
        let text =
            if self.runs > 1 { format!("{mark} {}/{}", self.runs_met, self.runs) } else { mark.to_owned() };
        match self.margin {
            Some(margin) => format!("{text} {}", margin_text(margin, 1.0 - margin)),
            None if self.decision == Decision::Missed => format!("{text} no value"),
            None => text,
        }
    }

    /// Rank of the requirement: those without a value that fail first, then by margin.
    fn rank(&self) -> f64 {
        let without = if self.decision.fails() { f64::NEG_INFINITY } else { f64::INFINITY };
        self.margin.unwrap_or(without)
    }
}

impl CampaignRuns {
    /// Returns the faults in the order of their first runs; none unless the active fault varies.
    pub(super) fn faults(&self, scenario: &Scenario) -> Vec<FaultAnswer> {
        let names = self.faults.as_deref().unwrap_or_default();
        let mut known: Vec<&str> = Vec::new();
        for name in names {
            if !known.contains(&name.as_str()) {
                known.push(name);
            }
        }
        let place = |name: &str| scenario.fault.iter().position(|fault| fault.name == name);
        known.sort_by_key(|name| place(name).map_or(0, |place| place + 1));
        let answer = |fault: &str| {
            let own = self.requirements.in_rows(|row| names[row] == fault);
            let runs = own.numbers().len() as u64;
            let verdicts = own.finish();
            let requirements = verdicts.iter().enumerate();
            FaultAnswer {
                fault: fault.to_owned(),
                runs,
                requirements: requirements.map(|(index, own)| FaultRequirement::new(index, own)).collect(),
            }
        };
        known.into_iter().map(answer).collect()
    }
}

impl LeastRobust {
    /// Returns the run with the least margin; `None` without a requirement.
    pub(super) fn among(faults: &[FaultAnswer]) -> Option<Self> {
        let all =
            faults.iter().flat_map(|own| own.requirements.iter().map(move |requirement| (own, requirement)));
        let (own, least) = all.min_by(|(_, a), (_, b)| a.rank().total_cmp(&b.rank()))?;
        (least.rank() < f64::INFINITY).then(|| Self {
            fault: own.fault.clone(),
            requirement: least.name.clone(),
            margin: least.margin,
            run: least.run,
        })
    }

    /// Returns the fault, the requirement and its margin in words.
    pub fn text(&self) -> String {
        let margin = match self.margin {
            Some(own) if own < -1.0 => margin_text(own, 1.0 - own),
            Some(own) => format!("margin {}", margin_text(own, 1.0 - own)),
            None => "no value".to_owned(),
        };
        format!("{}: {}, {margin}, run {}", self.fault, self.requirement, self.run)
    }
}

/// Returns the heads of the table of faults by requirements, and the lines that explain them: names, or identifiers if names
/// make it wider than a line.
fn heads(faults: &[FaultAnswer], width: usize) -> (Vec<String>, Vec<String>) {
    let requirements = faults.first().map_or(&[][..], |own| &own.requirements);
    let names: Vec<String> = requirements.iter().map(|own| own.name.clone()).collect();
    let first = faults.iter().map(|own| own.fault.chars().count()).max().unwrap_or(0);
    let wide: usize = names.iter().map(|name| name.chars().count().max(8) + 2).sum();
    if first + wide + 6 <= width {
        return (names, Vec::new());
    }
    let all: Vec<String> = requirements.iter().map(|own| format!("{} {}", own.id, own.name)).collect();
    let legend = wrapped(&format!("  {}", all.join(", ")), width, 2);
    (requirements.iter().map(|own| own.id.clone()).collect(), legend)
}

/// Returns the table of faults by requirements as lines.
pub(super) fn fault_table(faults: &[FaultAnswer], options: ScreenOptions) -> Vec<String> {
    if faults.is_empty() {
        return Vec::new();
    }
    let (names, legend) = heads(faults, options.width);
    let mut rows = vec![[vec!["fault".to_owned()], names].concat()];
    rows.extend(faults.iter().map(|own| {
        let cells = own.requirements.iter().map(FaultRequirement::text).collect();
        [vec![own.fault.clone()], cells].concat()
    }));
    let mut lines = indented(columns(&rows, |_| true));
    if faults.iter().any(|own| own.runs > 1) {
        let most = faults.iter().map(|own| own.runs).max().unwrap_or(0);
        lines.push(format!(
            "  runs that meet it, of up to {}, and the least margin",
            counted(most as usize, "run")
        ));
    }
    lines.extend(legend);
    lines
}
