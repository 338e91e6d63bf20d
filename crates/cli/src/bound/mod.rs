//! `flexsc bound`: guaranteed ranges of outputs of the linear body, and verdicts about their limits.

mod figures;

use std::io::Write;
use std::path::Path;

use flexsc_core::analysis::bound::{OutputBound, Verdict};
use flexsc_core::formats::count::counted;
use flexsc_core::{Scenario, ScenarioError};
use flexsc_figure::Named;
use serde_json::{Value as Json, json};

use crate::error::CliError;
use crate::human::{Units, digits, outward_digits};
use crate::number_table::NumberTable;
use crate::result_files::ResultOutput;
use crate::results::{Results, show, with_scenario_name};
use crate::{files, say, scenario};

/// Significant digits of guaranteed ranges.
const DIGITS: i32 = 6;

#[derive(clap::Args)]
pub struct BoundArgs {
    #[command(flatten)]
    pub scenario: scenario::ScenarioArgs,
    #[command(flatten)]
    output: ResultOutput,
}

/// Ranges of outputs of a scenario's body.
pub struct OutputBounds {
    /// Name of the scenario.
    name: String,
    bounds: Vec<OutputBound>,
    units: Units,
}

/// Computes the ranges of all claims of a scenario, as the command does.
pub fn results(scenario: &Scenario, args: &BoundArgs) -> Result<OutputBounds, CliError> {
    claims(scenario, args.output.choice.units())
}

/// Computes the ranges of all claims of a scenario.
pub fn claims(scenario: &Scenario, units: Units) -> Result<OutputBounds, CliError> {
    let name = scenario.name.clone();
    let bounds = OutputBound::from_scenario(scenario).map_err(|fault| ScenarioError::Key {
        origin: name.clone(),
        key: fault.key,
        why: fault.why,
    })?;
    Ok(OutputBounds { name, bounds, units })
}

pub fn run(args: &BoundArgs) -> Result<(), CliError> {
    let inputs = [args.scenario.scenario.as_path()];
    let witness = args.output.scenario_file(&inputs)?;
    let target = if witness.is_some() { None } else { args.output.target(&inputs)? };
    let scenario = args.scenario.load()?;
    let found = results(&scenario, args)?;
    if let Some(path) = witness {
        found.write_witness(&scenario, &path, args.output.force)?;
    }
    if let Some(target) = target {
        target.save(&found)?;
    }
    show(&found, None, args.scenario.json)?;
    found.require_proved()
}

impl OutputBounds {
    /// Returns the number of claims that are violated or undecided.
    pub fn failed(&self) -> usize {
        self.bounds.iter().filter(|bound| bound.fails()).count()
    }

    /// Returns the texts of each claim: output, guaranteed range, limits, end, and verdict; and whether it fails.
    pub fn texts(&self) -> Vec<([String; 5], bool)> {
        let texts = |bound: &OutputBound| {
            let values: Vec<f64> = bound.range.iter().chain(bound.limits.iter().flatten()).copied().collect();
            let (factor, unit) = self.units.common(&values, &bound.output.unit);
            let ends = |[low, high]: [f64; 2]| {
                format!("{low} to {high} {unit}", low = digits(low * factor), high = digits(high * factor))
            };
            let [low, high] = bound.range.map(|value| value * factor);
            let range = format!(
                "{} to {} {unit}",
                outward_digits(low, DIGITS, false),
                outward_digits(high, DIGITS, true)
            );
            let verdict = match bound.verdict {
                Verdict::Proved => "proved",
                Verdict::Violated => "violated",
                Verdict::Undecided => "undecided",
                Verdict::Unlimited => "no limit",
            };
            let limits = bound.limits.map_or_else(String::new, ends);
            let end = format!("{} s", digits(bound.until_s));
            ([bound.output.name.clone(), range, limits, end, verdict.to_owned()], bound.fails())
        };
        self.bounds.iter().map(texts).collect()
    }

    /// Returns the claims with their ranges as JSON.
    pub fn claims_json(&self) -> Json {
        json!(self.bounds)
    }

    /// Prints the claims with their ranges.
    pub fn print_claims(&self) {
        for bound in &self.bounds {
            self.print_bound(bound);
        }
    }

    /// Fails if a claim is violated or undecided.
    pub fn require_proved(&self) -> Result<(), CliError> {
        let failed = self.failed();
        if failed > 0 {
            return Err(CliError::Claims { failed, claims: self.bounds.len() });
        }
        Ok(())
    }

    /// Writes the scenario of the first witness.
    fn write_witness(&self, scenario: &Scenario, path: &Path, force: bool) -> Result<(), CliError> {
        let refused = |why: &str| CliError::Arguments(format!("-o {}: {why}", path.display()));
        let Some(bound) = self.bounds.iter().find(|bound| bound.witness.is_some()) else {
            return Err(refused("no claim is violated, so that there is no witness"));
        };
        let Some(text) = bound.witness_text(scenario) else {
            return Err(refused(
                "no key of a scenario gives the state or the inputs of the witness; --json prints them",
            ));
        };
        files::write(path, text.as_bytes(), force)?;
        say!("{}: the witness of `{}`", path.display(), bound.output.name);
        Ok(())
    }

    fn print_bound(&self, bound: &OutputBound) {
        let values: Vec<f64> = bound.range.iter().chain(bound.limits.iter().flatten()).copied().collect();
        let (factor, unit) = self.units.common(&values, &bound.output.unit);
        let text = |value: f64| digits(value * factor);
        let limits = bound.limits.map_or_else(String::new, |[low, high]| {
            format!(" within {} to {} {unit}", text(low), text(high))
        });
        let verdict = match bound.verdict {
            Verdict::Proved => ": proved",
            Verdict::Violated => ": violated",
            Verdict::Undecided => ": undecided",
            Verdict::Unlimited => "",
        };
        let elastic = if bound.elastic { ", elastic" } else { "" };
        say!("  {}{elastic}{limits} until {} s{verdict}", bound.output.name, digits(bound.until_s));
        let [low, high] = bound.range.map(|value| value * factor);
        let (low, high) = (outward_digits(low, DIGITS, false), outward_digits(high, DIGITS, true));
        say!("    range        {low} to {high} {unit}, guaranteed");
        let [low, high] = bound.attained;
        let at = bound.attained_at_s.map(digits);
        say!("    attained     {} at {} s, {} at {} s", text(low), at[0], text(high), at[1]);
        if bound.fails() {
            let safe = bound
                .safe_until_s
                .map_or_else(String::new, |t| format!("no limit is passed before {t:.4} s"));
            say!("    safe         {safe}");
        }
        if let Some(gap) = bound.gap {
            say!("    gap          the range exceeds the limits by up to {} {unit}", text(gap));
        }
        if let Some(time) = bound.violated_at_s {
            say!("    violated     from {time:.4} s on");
        }
        if let Some(witness) = &bound.witness {
            let run = witness.simulated.map_or_else(
                || "no run has its state or inputs".to_owned(),
                |value| format!("{} {unit} in its run", text(value)),
            );
            let (value, time) = (text(witness.value), digits(witness.time_s));
            say!("    witness      {value} {unit} at {time} s; {run}");
        }
    }
}

impl Results for OutputBounds {
    fn json(&self) -> Vec<Json> {
        vec![with_scenario_name(&self.name, json!({ "bounds": self.claims_json() }))]
    }

    fn figures(&self) -> Vec<Named> {
        vec![(format!("{}-bound", self.name), figures::figure(&self.name, &self.bounds))]
    }

    fn table(&self) -> Option<NumberTable> {
        let rows: Vec<_> = self.bounds.iter().map(|bound| bound.rows.clone()).collect();
        Some(NumberTable::from_groups("claim", &rows))
    }

    fn print(&self) -> Result<(), CliError> {
        say!("{}   {}", self.name, counted(self.bounds.len(), "claim"));
        self.print_claims();
        Ok(())
    }
}
