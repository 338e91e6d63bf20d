//! `flexsc budget`: levels of the pointing indices that a scenario's requirements limit, by a campaign, by convolution and by
//! the rule of k sigma.

mod ensemble;
mod figures;

use std::collections::BTreeMap;
use std::io::Write;
use std::sync::{Arc, Mutex, PoisonError};

use flexsc_core::analysis::budget::{
    CampaignBudget, DisturbedLoop, ErrorSources, IndexBudget, IndexRun, PointingBudget, linear_sources,
    noise_cycle, sine_frequencies,
};
use flexsc_core::analysis::noise::RequiredContrast;
use flexsc_core::campaign::{Campaign, Design, RunOutcome};
use flexsc_core::formats::count::counted;
use flexsc_core::formats::document::ConfigError;
use flexsc_core::formats::reader_units::ReaderUnits;
use flexsc_core::metrics::IndexRecord;
use flexsc_core::requirement_verdict::{RequirementRuns, RequirementVerdict};
use flexsc_core::scenario::{AssessedRequirement, RequirementSource, SampledError, Scenario};
use flexsc_figure::Named;
use serde_json::{Value as Json, json};

use self::ensemble::Ensemble;
use crate::answer::style;
use crate::confirm_cost::CostConfirmation;
use crate::error::CliError;
use crate::human::{Units, digits};
use crate::number_table::NumberTable;
use crate::result_files::ResultOutput;
use crate::results::{Results, print_lines, with_scenario_name};
use crate::row_table::{column, print_rows};
use crate::spectrum::contrasts::{self, SpatialUnits};
use crate::spectrum::refused;
use crate::stop::{self, stop_flag};
use crate::{requirements, say, scenario};

/// Largest number of values of all runs, by the memory that they need.
const MOST_VALUES: u64 = 20_000_000;

/// Number of runs from which budgets are computed, unless another is asked for.
pub const DEFAULT_RUNS: u64 = 20;

#[derive(clap::Args)]
pub struct BudgetArgs {
    #[command(flatten)]
    pub scenario: scenario::ScenarioArgs,
    /// Number of runs of the campaign over the [uncertain] keys and the noise
    #[arg(long, default_value_t = DEFAULT_RUNS, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    runs: u64,
    #[command(flatten)]
    runs_with: scenario::RunArgs,
    #[command(flatten)]
    output: ResultOutput,
    #[command(flatten)]
    consent: CostConfirmation,
}

/// Budgets of the requirements of a scenario.
pub struct Budgets {
    name: String,
    runs: u64,
    indices: Vec<CampaignBudget>,
    verdicts: Vec<RequirementVerdict>,
    /// Contrasts of images, which the linear loop has, and the units of their spatial frequencies.
    contrasts: (Vec<RequiredContrast>, SpatialUnits),
    units: Units,
}

pub fn run(args: &BudgetArgs) -> Result<(), CliError> {
    let path = &args.scenario.scenario;
    let target = args.output.target(&[path])?;
    let scenario = scenario::load(path, &args.scenario.set, args.runs_with.seed)?;
    let scenario = args.scenario.in_mode(scenario)?;
    let budgets = results(scenario, args)?;
    if let Some(target) = &target {
        target.save(&budgets)?;
    }
    if args.scenario.json {
        print_lines(&budgets.json())?;
    } else {
        budgets.print()?;
    }
    requirements::validate([(budgets.name.as_str(), &budgets.verdicts[..])])?;
    contrasts::require_met(&budgets.name, &budgets.contrasts.0)
}

/// Computes the budgets of a scenario.
///
/// # Errors
/// A scenario without a requirement on a pointing index, and a run that fails.
pub fn pointing_budget(scenario: Scenario, runs: u64, jobs: u16) -> Result<PointingBudget, String> {
    let name = scenario.name.clone();
    let setup = CampaignSetup { origin: name, runs, jobs, units: Units(ReaderUnits::Si), consent: None };
    let budgets = setup.budgets(scenario, |_, _| ()).map_err(|failure| failure.to_string())?;
    Ok(budgets.report())
}

/// Runs the campaign of a scenario from a file, calls `each` with every outcome, and computes the budgets.
pub fn with_outcomes(
    scenario: Scenario,
    origin: String,
    runs: u64,
    each: impl FnMut(&Campaign, &RunOutcome),
) -> Result<Budgets, CliError> {
    CampaignSetup { origin, runs, jobs: 0, units: Units::default(), consent: None }.budgets(scenario, each)
}

/// Runs the campaign, and computes the budgets.
pub fn results(scenario: Scenario, args: &BudgetArgs) -> Result<Budgets, CliError> {
    let setup = CampaignSetup {
        origin: args.scenario.scenario.display().to_string(),
        runs: args.runs,
        jobs: args.runs_with.threads(),
        units: args.output.choice.units(),
        consent: Some(args.consent),
    };
    setup.budgets(scenario, |_, _| ())
}

/// Campaign from which budgets are computed.
struct CampaignSetup {
    origin: String,
    runs: u64,
    /// Number of threads; 0 for one per core.
    jobs: u16,
    units: Units,
    /// Consent to long work; `None` if it is given.
    consent: Option<CostConfirmation>,
}

/// Pointing index in the linear loop: the rms of its noise, its sources, and the number of values after which the noise repeats.
struct LinearIndex {
    noise: Option<f64>,
    sources: Option<ErrorSources>,
    cycle: usize,
}

impl CampaignSetup {
    /// Runs the campaign, calls `each` with every outcome, and computes the budgets.
    fn budgets(
        &self,
        scenario: Scenario,
        mut each: impl FnMut(&Campaign, &RunOutcome),
    ) -> Result<Budgets, CliError> {
        let name = scenario.name.clone();
        let samples = |source: &RequirementSource| match source {
            RequirementSource::Metric(..) | RequirementSource::Formula(_) => 0,
            RequirementSource::Error(error) => error.index.values(error.samples),
        };
        let values: u64 = scenario.study.requirements.iter().map(|of| samples(&of.source)).sum();
        let contrasts = RequiredContrast::all(&scenario).map_err(|fault| refused(&name, fault))?;
        let contrasts = (contrasts, SpatialUnits::new(&scenario));
        if values == 0 && !contrasts.0.is_empty() {
            let (indices, verdicts) = (Vec::new(), Vec::new());
            return Ok(Budgets { name, runs: 0, indices, verdicts, contrasts, units: self.units });
        }
        if values == 0 {
            let why = "has no [[requirement]] on a pointing index with a value in the run";
            return Err(CliError::Arguments(format!("{name}: {why}")));
        }
        if values.saturating_mul(self.runs) > MOST_VALUES {
            let why = format!(
                "--runs: {} with {values} values each are more than {MOST_VALUES}",
                counted(self.runs, "run")
            );
            return Err(CliError::Arguments(format!(
                "{why}\n\nhint: give fewer runs, or a longer `period` in [[requirement]]"
            )));
        }
        let campaign = Arc::new(Campaign::from_design(scenario, &self.origin, Design::default())?);
        let cost =
            campaign.cost(self.runs, None).map_err(|why| CliError::Arguments(format!("--runs {why}")))?;
        if let Some(consent) = self.consent {
            consent.check(&cost)?;
        }
        let linear =
            self.linear_indices(campaign.scenario()).map_err(|fault| refused(&name, fault.into()))?;
        let kept = Arc::new(Mutex::new(BTreeMap::new()));
        let work = {
            let kept = Arc::clone(&kept);
            move |run: &flexsc_core::campaign::CampaignRun| {
                let mut record = IndexRecord::new(&run.scenario);
                let metrics = Campaign::simulate(run, (&mut record, stop_flag()))?;
                let frequencies = sine_frequencies(&run.scenario);
                let index_run = |values| IndexRun { values, frequencies: frequencies.clone() };
                let runs: Vec<IndexRun> = record.finish().into_iter().map(index_run).collect();
                kept.lock().unwrap_or_else(PoisonError::into_inner).insert(run.number, runs);
                Ok(metrics)
            }
        };
        let mut runs = RequirementRuns::new(campaign.scenario());
        campaign.for_each_run(0..self.runs, usize::from(self.jobs), work, |outcome| {
            let Some(outcome) = outcome else {
                return if stop::stop_requested() {
                    Err(CliError::Interrupted(String::new()))
                } else {
                    Ok(())
                };
            };
            each(&campaign, &outcome);
            let number = outcome.number;
            let metrics = outcome.metrics.map_err(|error| CliError::Runs {
                failed: 1,
                runs: self.runs,
                number,
                why: error.to_string(),
            })?;
            runs.add(number, Some(&metrics));
            Ok(())
        })?;
        let all = std::mem::take(&mut *kept.lock().unwrap_or_else(PoisonError::into_inner));
        let budgets = index_budgets(campaign.scenario(), linear, all.into_values().collect());
        let verdicts = runs.finish();
        Ok(Budgets { name, runs: self.runs, indices: budgets, verdicts, contrasts, units: self.units })
    }

    /// Returns what the linear loop has of each requirement on a pointing index; a loop that is not linear has nothing.
    fn linear_indices(&self, scenario: &Scenario) -> Result<Vec<LinearIndex>, ConfigError> {
        let disturbed = DisturbedLoop::from_scenario(scenario);
        let errors: Vec<_> = sampled_errors(scenario).map(|(_, _, error)| error).collect();
        let ensemble = disturbed.as_ref().zip(Ensemble::from_scenario(scenario, &self.origin, self.runs));
        let sources = ensemble.map(|(disturbed, Ensemble { points, shares_loop })| {
            linear_sources(disturbed, &points, shares_loop, &errors)
        });
        let sources = sources.transpose()?.unwrap_or_else(|| vec![None; errors.len()]);
        let index = |(error, sources): (&SampledError, Option<ErrorSources>)| {
            let noise = disturbed.as_ref().map(|disturbed| disturbed.noise(error)).transpose()?.flatten();
            let cycle = noise_cycle(disturbed.as_ref().map(DisturbedLoop::noisy), error);
            Ok(LinearIndex { noise, sources, cycle })
        };
        errors.into_iter().zip(sources).map(index).collect()
    }
}

/// Returns the requirements of a scenario on pointing indices, each with its place among all.
fn sampled_errors(scenario: &Scenario) -> impl Iterator<Item = (usize, &AssessedRequirement, &SampledError)> {
    scenario.study.requirements.iter().enumerate().filter_map(|(place, requirement)| {
        match &requirement.source {
            RequirementSource::Metric(..) | RequirementSource::Formula(_) => None,
            RequirementSource::Error(error) => Some((place, requirement, error)),
        }
    })
}

/// Returns the budget of each requirement on a pointing index, from the values of all requirements in each run.
fn index_budgets(
    scenario: &Scenario,
    linear: Vec<LinearIndex>,
    mut all: Vec<Vec<IndexRun>>,
) -> Vec<CampaignBudget> {
    let axes = scenario.axis_count();
    let budget = |((place, requirement, error), linear): (_, LinearIndex)| {
        let (requirement, error): (&AssessedRequirement, &SampledError) = (requirement, error);
        let runs: Vec<IndexRun> =
            all.iter_mut().map(|run: &mut Vec<IndexRun>| std::mem::take(&mut run[place])).collect();
        let is_signed = error.is_component(axes);
        let sources = linear.sources.filter(|_| is_signed);
        CampaignBudget {
            linear_noise: linear.noise,
            linear_levels: sources.as_ref().map(ErrorSources::mixed_levels),
            linear_sources: sources,
            ..CampaignBudget::new(requirement.clone(), error, &runs, is_signed, linear.cycle)
        }
    };
    sampled_errors(scenario).zip(linear).map(budget).collect()
}

impl Results for Budgets {
    fn json(&self) -> Vec<Json> {
        vec![with_scenario_name(&self.name, json!(self.report()))]
    }

    fn figures(&self) -> Vec<Named> {
        let indices = self.indices.iter().map(|budget| figures::named(&self.name, budget));
        indices.chain(contrasts::figures(&self.name, &self.contrasts.0, &self.contrasts.1)).collect()
    }

    fn table(&self) -> Option<NumberTable> {
        let rows: Vec<_> = self.indices.iter().map(|budget| IndexBudget::from(budget).levels).collect();
        Some(NumberTable::from_groups("budget", &rows))
    }

    fn print(&self) -> Result<(), CliError> {
        say!("{}   {}", self.name, counted(self.runs, "run"));
        for budget in &self.indices {
            self.print_budget(budget);
        }
        let verdicts = requirements::lines(&self.verdicts, self.units.into()).join("\n  ");
        if !verdicts.is_empty() {
            say!("\n  {}", style().styled(&verdicts));
        }
        contrasts::print(&self.contrasts.0, &self.contrasts.1, self.units);
        Ok(())
    }
}

impl Budgets {
    /// Returns the budgets as `--json` prints them.
    pub fn report(&self) -> PointingBudget {
        PointingBudget {
            runs: self.runs,
            budgets: self.indices.iter().map(IndexBudget::from).collect(),
            contrasts: self.contrasts.0.clone(),
            requirements: self.verdicts.iter().map(RequirementVerdict::to_json).collect(),
        }
    }

    /// Prints the levels of an index in one unit.
    fn print_budget(&self, budget: &CampaignBudget) {
        let requirement = &budget.requirement;
        let largest = budget.magnitudes.last().copied().unwrap_or(f64::NAN);
        let (factor, unit) = self.units.common(&[largest], requirement.unit);
        say!("\n  {}: {} ({unit})", requirement.name, requirement.description());
        if let Some(sources) = &budget.sources {
            say!("  sources by the runs: {}", source_text(sources, factor));
        }
        if let Some(noise) = budget.linear_noise {
            say!("  noise of the linear loop at rest: {} rms", digits(noise * factor));
        }
        if let Some((sources, levels)) = budget.linear_sources.as_ref().zip(budget.linear_levels) {
            let levels = levels.map(|level| digits(factor * level)).join(", ");
            say!("  linear loop under its disturbances: {}: {levels} (mixed)", source_text(sources, factor));
        }
        let level = |field, header| column(field, header).scaled(factor, "");
        let shown = [
            column("level", "level").percent(),
            level("temporal.campaign", "temporal\nruns"),
            level("temporal.convolution", "\nconvolved"),
            level("temporal.rule", "\nk sigma"),
            level("ensemble.campaign", "ensemble\nruns"),
            level("ensemble.convolution", "\nconvolved"),
            level("ensemble.rule", "\nk sigma"),
            level("mixed.campaign", "mixed\nruns"),
            level("mixed.convolution", "\nconvolved"),
            level("mixed.rule", "\nk sigma"),
        ];
        print_rows(&IndexBudget::from(budget).levels, &shown, self.units);
    }
}

/// Returns the text of the sources of an error, whose numbers are multiplied by a factor.
fn source_text(sources: &ErrorSources, factor: f64) -> String {
    let [bias, spread, largest, noise] =
        [sources.bias(), sources.bias_spread(), sources.largest_bias(), sources.noise()]
            .map(|value| digits(value * factor));
    let from_run_to_run = if sources.bias_spread() > 0.0 {
        format!(", {spread} rms from run to run, at most {largest}")
    } else {
        String::new()
    };
    let sines: Vec<String> = sources.amplitudes().iter().map(|value| digits(value * factor)).collect();
    let sines = if sines.is_empty() { "none".to_owned() } else { sines.join(", ") };
    format!("bias {bias}{from_run_to_run}; sines {sines}; random part {noise} rms")
}
