//! Campaigns: many runs of one scenario.

mod at_points;
mod campaign_runs;
#[cfg(feature = "parquet")]
mod checksum;
mod command_log;
#[cfg(feature = "parquet")]
mod contained;
mod design;
mod directory;
mod directory_columns;
mod draws;
mod error;
mod manifest;
mod merge;
mod motion_sampler;
#[cfg_attr(not(feature = "parquet"), path = "campaign/unavailable.rs")]
mod parquet;
mod part;
mod row_maker;
mod rows;
mod sampling;
mod summary;
mod workers;

use std::time::Instant as WallInstant;

use flexsc_formats::document::{Document, ScenarioError, key};
use flexsc_record::{Detail, OutputName, Provenance, Record};
use flexsc_spacecraft::body::Planar;
use thiserror::Error;
use toml::{Table, Value};

use crate::metrics::{self, Metrics, MetricsCollector, Selection};
use flexsc_scenario::{Cost, MOST_RUNS, PATH_HAS_NO_RUN, Scenario};
use flexsc_sim::{Simulation, SimulationError};

pub(crate) use campaign_runs::UncertainValues;
pub use campaign_runs::{CampaignRuns, MAIN_METRICS, MOST_METRICS};
pub use command_log::CommandLog;
pub use design::{Design, DesignBlock, KeyRange, MOST_NUMBERS, MOST_POINTS};
pub use directory::{Directory, MANIFEST, STATISTICS};
pub use error::DirectoryError;
pub use manifest::Manifest;
pub use merge::Merge;
pub use motion_sampler::MotionSampler;
pub use parquet::parquet_is_built_in;
pub use row_maker::RowMaker;
pub use rows::{ColumnCells, ColumnHeading, ColumnKind, ERROR, RUN, RunRows, SECONDS, SEED, WORD_SEPARATOR};
pub use sampling::Sampling;
pub(crate) use sampling::{Dimension, MOST_DIMENSIONS};
pub use summary::CampaignSummary;

/// Error of a run.
#[derive(Debug, Error)]
pub enum RunError {
    /// Drawn values that make no valid scenario.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// Simulation that could not continue.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
}

/// Campaign: many runs of one scenario.
#[derive(Clone, Debug)]
pub struct Campaign {
    scenario: Scenario,
    table: Table,
    origin: String,
    design: Design,
}

/// Key with a list of values. Run i of a campaign over one grid has value i; over several, run i is the i-th point of
/// their product, in which the last grid varies fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Name of the key.
    pub key: String,
    /// Values of the key.
    pub values: Vec<f64>,
}

impl Grid {
    /// Returns the grid of `count` equidistant values from the first to the last.
    pub fn linspace(key: String, first: f64, last: f64, count: u32) -> Self {
        Self { key, values: (0..count).map(|index| design::linspace(first, last, count, index)).collect() }
    }
}

/// Run of a campaign: its scenario with the drawn keys set.
#[derive(Clone, Debug, PartialEq)]
pub struct CampaignRun {
    /// Number of the run.
    pub number: u64,
    /// Number of the run whose noise it has: its own, unless the design gives another.
    pub noise_run: u64,
    /// Scenario of the run.
    pub scenario: Scenario,
    /// Value of each key that varies.
    pub drawn: Vec<Value>,
}

impl CampaignRun {
    /// Returns a run of a scenario as it is, with the noise of this number.
    pub fn new(scenario: Scenario, number: u64) -> Self {
        Self { number, noise_run: number, scenario, drawn: Vec::new() }
    }
}

/// Outcome of a run.
#[derive(Debug)]
pub struct RunOutcome {
    /// Number of the run.
    pub number: u64,
    /// Value of each key that varies.
    pub drawn: Vec<Value>,
    /// Metrics of the run, or the reason why it failed.
    pub metrics: Result<Metrics, RunError>,
    /// Duration of the computation (s).
    pub seconds: f64,
}

impl Campaign {
    /// Returns the campaign of a scenario over its `[uncertain]` keys and, with grids, over their keys too.
    pub fn new(
        scenario: Scenario,
        origin: &str,
        grids: impl IntoIterator<Item = Grid>,
    ) -> Result<Self, ScenarioError> {
        Self::from_design(scenario, origin, Design::from_blocks(grids.into_iter().map(DesignBlock::from)))
    }

    /// Returns the campaign of a scenario over its `[uncertain]` keys and the points of a design.
    pub fn from_design(scenario: Scenario, origin: &str, design: Design) -> Result<Self, ScenarioError> {
        let campaign = Self::from_unchecked_points(scenario, origin, design)?;
        // A key that does not exist, or a range that is not accepted, fails all runs: report it at once.
        for keys in campaign.design.ends() {
            campaign.scenario_with(&campaign.convert_values(keys))?;
        }
        Ok(campaign)
    }

    /// Returns the campaign of a design, any point of which may be one that the scenario does not accept.
    pub fn from_unchecked_points(
        mut scenario: Scenario,
        origin: &str,
        design: Design,
    ) -> Result<Self, ScenarioError> {
        scenario.written.inline_files();
        if let Some(key) = scenario.measured_path() {
            let why = PATH_HAS_NO_RUN.to_owned();
            return Err(ScenarioError::Key { origin: origin.to_owned(), key, why });
        }
        // A key with values is not drawn.
        let varied = design.keys();
        let tied = scenario
            .correlated
            .iter()
            .flat_map(|group| &group.keys)
            .find(|key| varied.contains(&key.as_str()));
        if let Some(key) = tied {
            let why = format!("varies `{key}`, which `correlated` draws together with other keys");
            return Err(ScenarioError::Key { origin: origin.to_owned(), key: "design".to_owned(), why });
        }
        scenario.written.uncertain.retain(|key, _| !varied.contains(&key.as_str()));
        // Custom parts of a program have no text: runs inherit them.
        let mut table = scenario.table_without_custom_parts();
        // The drawn keys replace the `[uncertain]` table.
        table.remove("uncertain");
        table.remove("correlated");
        if let Some(why) = design.validate(scenario.uncertain.len()) {
            return Err(ScenarioError::Key { origin: origin.to_owned(), key: "design".to_owned(), why });
        }
        Ok(Self { scenario, table, origin: origin.to_owned(), design })
    }

    /// A scenario whose `[uncertain]` keys keep their own values.
    pub fn undrawn(mut scenario: Scenario) -> Scenario {
        scenario.written.uncertain.clear();
        scenario.written.correlated.clear();
        scenario
    }

    /// Returns the cost of `runs` runs, each with a log of this detail and the cost of the design's costliest end.
    ///
    /// # Errors
    /// More runs than are supported.
    pub fn cost(&self, runs: u64, log: Option<Detail>) -> Result<Cost, String> {
        if runs > MOST_RUNS {
            return Err(format!("must be at most {MOST_RUNS} runs, got {runs}"));
        }
        let mut cost = self.scenario.cost(log, false);
        for keys in self.design.ends() {
            // Values that are not accepted cost nothing.
            if let Ok(end) = self.scenario_with(&self.convert_values(keys)) {
                cost = cost.max(end.cost(log, false));
            }
        }
        let side_by_side = runs > 1
            && log.is_none()
            && crate::batch::accepts(&self.scenario)
            && !self.scenario.law.is_switching();
        Ok(if side_by_side { cost.in_lanes() } else { cost }.scaled_by(runs))
    }

    /// Returns the scenario from which the runs are drawn as TOML; the same campaign can be created from it. It refers
    /// to no file, unless the matrices of a structure vary.
    pub fn to_toml(&self) -> String {
        if self.keys().any(|key| key.starts_with("body.matrices")) {
            self.scenario.to_toml()
        } else {
            self.scenario.self_contained().to_toml()
        }
    }

    /// Returns the scenario from which the runs are drawn.
    pub fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    /// Returns the keys that vary from run to run, in the order of [`CampaignRun::drawn`].
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        let designed = self.design.keys().into_iter();
        designed.chain(self.scenario.uncertain.keys().map(String::as_str))
    }

    /// Returns a run with its keys drawn. The result does not depend on other runs.
    pub fn run(&self, number: u64) -> Result<CampaignRun, ScenarioError> {
        let drawn = self.draw(number);
        let noise_run = self.design.noise_run(number);
        if drawn.is_empty() {
            let scenario = Self::undrawn(self.scenario.clone());
            return Ok(CampaignRun { number, noise_run, scenario, drawn });
        }
        let mut keys: Vec<_> = self.keys().zip(drawn.iter().cloned()).collect();
        if self.plans_first() {
            let written = self.scenario_with(&keys[..self.design.keys().len()])?;
            keys.push(("manoeuvre.model", Self::planned_model(&written)?));
        }
        let scenario = self.scenario_with(&keys)?;
        Ok(CampaignRun { number, noise_run, scenario, drawn })
    }

    /// Returns a run for the selected metrics, without a monitor of the envelope that only other metrics need.
    fn run_for(&self, number: u64, selection: &Selection) -> Result<CampaignRun, ScenarioError> {
        let mut run = self.run(number)?;
        let monitored =
            run.scenario.estimator.as_ref().is_some_and(|estimator| estimator.envelope().is_some());
        if monitored && run.scenario.adaptation.is_none() && !selection.wants_any(metrics::OF_ENVELOPE) {
            run.scenario.written.estimator = None;
        }
        Ok(run)
    }

    /// Returns true if the manoeuvre is planned for the body before its keys are drawn.
    fn plans_first(&self) -> bool {
        Self::plans_before_drawing(&self.scenario)
    }

    /// Returns true if a scenario's manoeuvre is planned for the body before its uncertain keys are drawn.
    fn plans_before_drawing(scenario: &Scenario) -> bool {
        let itself = scenario.manoeuvre.as_ref().is_some_and(|manoeuvre| manoeuvre.model.is_none());
        itself && scenario.uncertain.keys().any(|key| key.starts_with("body."))
    }

    /// Returns the body of a scenario as the model of its manoeuvre.
    fn planned_model(scenario: &Scenario) -> Result<Value, ScenarioError> {
        // A body contains nothing that TOML cannot express.
        Ok(Value::try_from(Planar::from(scenario.one_angle()?))
            .unwrap_or_else(|_| Value::Table(Table::new())))
    }

    /// Simulates a run with a record, and returns its metrics.
    pub fn simulate(run: &CampaignRun, record: impl Record) -> Result<Metrics, SimulationError> {
        Self::simulate_metrics(run, &Selection::ALL, record)
    }

    /// Simulates a run with a record, and returns the selected metrics.
    pub fn simulate_metrics(
        run: &CampaignRun,
        selection: &Selection,
        mut record: impl Record,
    ) -> Result<Metrics, SimulationError> {
        Self::simulate_recorded(run, selection, &mut record)
    }

    /// Simulates a run as [`Campaign::simulate_metrics`] does. Not generic, so that the code is compiled and optimised
    /// here, and not in each crate that calls it.
    fn simulate_recorded(
        run: &CampaignRun,
        selection: &Selection,
        record: &mut dyn Record,
    ) -> Result<Metrics, SimulationError> {
        let mut both = (MetricsCollector::for_selection(&run.scenario, selection), record);
        let mut simulation = Simulation::new(&run.scenario, run.noise_run);
        simulation.run(&mut both)?;
        Ok(selection.select(both.0.finish(&run.scenario)))
    }

    /// Simulates a run as [`Campaign::simulate_metrics`] does, and records its motion at increasing times (s) in `samples`.
    pub fn simulate_at(
        run: &CampaignRun,
        selection: &Selection,
        times: &[f64],
        mut record: impl Record,
        samples: &mut impl Record,
    ) -> Result<Metrics, SimulationError> {
        let mut both = (MetricsCollector::for_selection(&run.scenario, selection), &mut record);
        let mut simulation = Simulation::new(&run.scenario, run.noise_run);
        for time in times {
            simulation.run_to(*time, &mut both)?;
            simulation.record_now(samples)?;
        }
        simulation.run(&mut both)?;
        Ok(selection.select(both.0.finish(&run.scenario)))
    }

    /// Returns the outcome of a run; `work` simulates it.
    pub(crate) fn run_outcome(
        &self,
        number: u64,
        selection: &Selection,
        work: impl Fn(&CampaignRun) -> Result<Metrics, RunError>,
    ) -> RunOutcome {
        let began = WallInstant::now();
        let (drawn, metrics) = match self.run_for(number, selection) {
            Ok(run) => {
                let metrics = work(&run);
                (run.drawn, metrics)
            }
            Err(error) => (self.draw(number), Err(error.into())),
        };
        RunOutcome { number, drawn, metrics, seconds: began.elapsed().as_secs_f64() }
    }

    /// Returns the points of the campaign.
    pub fn design(&self) -> &Design {
        &self.design
    }

    /// Returns the provenance in the log of a run, without attachments.
    pub fn provenance(run: &CampaignRun) -> Provenance {
        Provenance {
            scenario: run.scenario.name.clone(),
            toml: run.scenario.self_contained().to_toml(),
            seed: run.scenario.seed,
            run: run.noise_run,
            epoch_ns: run.scenario.epoch_ns(),
            outputs: run
                .scenario
                .model
                .outputs()
                .iter()
                .map(|output| OutputName { name: output.name.clone(), unit: output.unit.clone() })
                .collect(),
            own_parts: run.scenario.custom_parts().each(),
            own_part_facts: run.scenario.custom_facts(),
            attachments: Vec::new(),
        }
    }

    /// Returns true if a key has an integer in the scenario.
    fn is_integer(&self, key: &str) -> bool {
        matches!(key::get(&self.table, key), Some(Value::Integer(_)))
    }

    /// Converts a number to the type of a key's value in the scenario; any other value stays.
    fn convert_value(&self, key: &str, value: Value) -> Value {
        match value {
            Value::Float(number) if self.is_integer(key) => Value::Integer(libm::round(number) as i64),
            other => other,
        }
    }

    /// Converts the numbers among values to the types of their keys in the scenario.
    fn convert_values<'a>(&self, keys: Vec<(&'a str, Value)>) -> Vec<(&'a str, Value)> {
        keys.into_iter().map(|(key, value)| (key, self.convert_value(key, value))).collect()
    }

    fn scenario_with(&self, keys: &[(&str, Value)]) -> Result<Scenario, ScenarioError> {
        Scenario::from_document_reusing(&self.document_with(keys)?, &self.scenario)
    }

    fn document_with(&self, keys: &[(&str, Value)]) -> Result<Document, ScenarioError> {
        let mut document = Document::from_table(&self.origin, self.table.clone());
        for (key, value) in keys {
            document.set(key, value.clone())?;
        }
        Ok(document)
    }
}
