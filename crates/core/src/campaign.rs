//! Campaigns: many runs of one scenario.

mod crew;

use std::collections::BTreeMap;

use thiserror::Error;
use toml::{Table, Value};

use crate::document::{Document, ScenarioError, key};
use crate::layout::Layout;
use crate::metrics::{Gather, Metrics};
use crate::random::Seed;
use crate::record::{Attachment, Detail, OutputName, Provenance, Record};
use crate::scenario::{Cost, MOST_RUNS, Scenario};
use crate::sim::{Simulation, SimulationError};

/// A run that failed.
#[derive(Debug, Error)]
pub enum RunError {
    /// The keys drawn for it make no valid scenario.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// Its simulation could not go on.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
}

/// Many runs of one scenario.
#[derive(Clone, Debug)]
pub struct Campaign {
    scenario: Scenario,
    table: Table,
    origin: String,
    grids: Vec<Grid>,
}

/// One key that takes these values. Run i of a campaign over one grid has value i; over several, their combinations are
/// counted as numbers are, the last grid's values from run to run.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// The key.
    pub key: String,
    /// Its values.
    pub values: Vec<f64>,
}

impl Grid {
    /// So many values from the first to the last, evenly apart.
    pub fn even(key: String, first: f64, last: f64, count: u32) -> Self {
        let value = |index: u32| {
            let part = if count > 1 { f64::from(index) / f64::from(count - 1) } else { 0.0 };
            first * (1.0 - part) + last * part
        };
        Self { key, values: (0..count).map(value).collect() }
    }
}

/// One run of a campaign: its scenario with the drawn keys set.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// The number of the run.
    pub number: u64,
    /// What is simulated.
    pub scenario: Scenario,
    /// The value of each key that varies.
    pub drawn: Vec<Value>,
}

/// What a run came to.
#[derive(Debug)]
pub struct Outcome {
    /// The number of the run.
    pub number: u64,
    /// The value of each key that varies.
    pub drawn: Vec<Value>,
    /// Its metrics, or why it failed.
    pub metrics: Result<Metrics, RunError>,
}

impl Campaign {
    /// The campaign of a scenario over its `[uncertain]` keys and, with grids, over their keys too.
    pub fn new(
        scenario: Scenario,
        origin: &str,
        grids: impl IntoIterator<Item = Grid>,
    ) -> Result<Self, ScenarioError> {
        let scenario = scenario.with_own_modes();
        let mut table = scenario.to_table();
        // What was drawn is said by the keys themselves.
        table.remove("uncertain");
        // Parts of a program's own have no text: runs take them over.
        table.retain(|_, part| part.get("own").is_none());
        let grids = grids.into_iter().collect();
        let campaign = Self { scenario, table, origin: origin.to_owned(), grids };
        for grid in &campaign.grids {
            // A key that does not exist, or a range that is not accepted, fails all runs: report it at once.
            for value in grid.values.first().into_iter().chain(grid.values.last()) {
                campaign.scenario_with(&[(&grid.key, campaign.like(&grid.key, *value))])?;
            }
        }
        Ok(campaign)
    }

    /// What so many runs ask for, each with a log of this detail: as much as the costliest of the ends of the grids.
    ///
    /// # Errors
    /// More runs than there can be.
    pub fn cost(&self, runs: u64, log: Option<Detail>) -> Result<Cost, String> {
        if runs > MOST_RUNS {
            return Err(format!("must be at most {MOST_RUNS} runs, got {runs}"));
        }
        let mut cost = self.scenario.cost(log, false);
        for grid in &self.grids {
            for value in grid.values.first().into_iter().chain(grid.values.last()) {
                let ends = self.scenario_with(&[(&grid.key, self.like(&grid.key, *value))]);
                cost = cost.max(ends.map_err(|error| error.to_string())?.cost(log, false));
            }
        }
        Ok(cost.times(runs))
    }

    /// The scenario that the runs are drawn from, as TOML: the same campaign can be made from it. It needs no file, unless
    /// the matrices of a structure vary.
    pub fn to_toml(&self) -> String {
        if self.keys().any(|key| key.starts_with("body.matrices")) {
            self.scenario.to_toml()
        } else {
            self.scenario.self_contained().to_toml()
        }
    }

    /// The scenario that the runs are drawn from.
    pub fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    /// The keys that vary from run to run, in the order of [`Run::drawn`].
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        let grids = self.grids.iter().map(|grid| grid.key.as_str());
        grids.chain(self.scenario.uncertain.keys().map(String::as_str))
    }

    /// A run, with its keys drawn. It is the same whichever runs are made beside it.
    pub fn run(&self, number: u64) -> Result<Run, ScenarioError> {
        let drawn = self.draw(number);
        if drawn.is_empty() {
            let scenario = Scenario { uncertain: BTreeMap::new(), ..self.scenario.clone() };
            return Ok(Run { number, scenario, drawn });
        }
        let mut keys: Vec<_> = self.keys().zip(drawn.iter().cloned()).collect();
        if self.plans_first() {
            let model = self.scenario_with(&keys[..self.grids.len()])?.model;
            // A body holds nothing that TOML cannot express.
            let model = Value::try_from(model).unwrap_or_else(|_| Value::Table(Table::new()));
            keys.push(("manoeuvre.model", model));
        }
        // A plan's body is more than numbers.
        let scenario = if self.plans_first() { self.scenario_with(&keys)? } else { self.drawn_with(&keys)? };
        Ok(Run { number, scenario, drawn })
    }

    /// Whether the manoeuvre is planned for the body before its keys are drawn.
    fn plans_first(&self) -> bool {
        let itself = self.scenario.manoeuvre.as_ref().is_some_and(|manoeuvre| manoeuvre.model.is_none());
        itself && self.scenario.uncertain.keys().any(|key| key.starts_with("body."))
    }

    /// Simulates a run and gathers its metrics, beside another record.
    pub fn simulate(run: &Run, record: impl Record) -> Result<Metrics, SimulationError> {
        let mut both = (Gather::new(&run.scenario), record);
        let mut simulation = Simulation::new(&run.scenario, run.number);
        if both.scene() {
            simulation.draw(&run.scenario);
        }
        simulation.run(&mut both)?;
        Ok(both.0.finish(&run.scenario))
    }

    /// What a run comes to; `work` simulates it.
    pub(crate) fn outcome(&self, number: u64, work: impl Fn(&Run) -> Result<Metrics, RunError>) -> Outcome {
        match self.run(number) {
            Ok(run) => Outcome { number, metrics: work(&run), drawn: run.drawn },
            Err(error) => Outcome { number, drawn: self.draw(number), metrics: Err(error.into()) },
        }
    }

    /// The keys that take given values.
    pub fn grids(&self) -> &[Grid] {
        &self.grids
    }

    /// The provenance in the log of a run in this detail, with a layout for viewers.
    pub fn provenance(run: &Run, detail: Detail) -> Provenance {
        let layout = Layout::of(&run.scenario).of_detail(detail).to_json();
        Provenance {
            scenario: run.scenario.name.clone(),
            toml: run.scenario.self_contained().to_toml(),
            seed: run.scenario.seed,
            run: run.number,
            epoch_ns: run.scenario.epoch_ns(),
            outputs: run
                .scenario
                .model
                .outputs
                .iter()
                .map(|output| OutputName { name: output.name.clone(), unit: output.unit.clone() })
                .collect(),
            attachments: vec![Attachment {
                name: "layout.json",
                media_type: "application/json",
                data: layout.into_bytes(),
            }],
        }
    }

    fn draw(&self, number: u64) -> Vec<Value> {
        // How many runs one value of a grid lasts: those of all grids after it.
        let lasts =
            |later: &[Grid]| later.iter().map(|grid| grid.values.len() as u64).product::<u64>().max(1);
        let grids = self.grids.iter().enumerate().map(|(place, grid)| {
            let index = number / lasts(&self.grids[place + 1..]);
            let index = if place == 0 { index } else { index % grid.values.len().max(1) as u64 };
            // A run beyond the first grid has no value: it fails, as any value that is not accepted.
            let value = usize::try_from(index).ok().and_then(|index| grid.values.get(index));
            self.like(&grid.key, value.copied().unwrap_or(f64::NAN))
        });
        let seed = Seed { scenario: self.scenario.seed, run: number };
        let drawn = self.scenario.uncertain.iter().map(|(key, distribution)| {
            let mut stream = seed.stream(&format!("uncertain {key}"));
            // The scenario was checked: every uncertain key holds a number.
            let nominal = key::get(&self.table, key).unwrap_or(&Value::Float(f64::NAN));
            distribution.draw(nominal, &mut stream)
        });
        grids.chain(drawn).collect()
    }

    /// A number as the type that a key has in the scenario.
    fn like(&self, key: &str, value: f64) -> Value {
        match key::get(&self.table, key) {
            Some(Value::Integer(_)) => Value::Integer(libm::round(value) as i64),
            _ => Value::Float(value),
        }
    }

    fn scenario_with(&self, keys: &[(&str, Value)]) -> Result<Scenario, ScenarioError> {
        Scenario::from_document_like(&self.document_with(keys)?, &self.scenario)
    }

    /// The same where the keys hold numbers already.
    fn drawn_with(&self, keys: &[(&str, Value)]) -> Result<Scenario, ScenarioError> {
        Scenario::from_numbers_like(&self.document_with(keys)?, &self.scenario)
    }

    fn document_with(&self, keys: &[(&str, Value)]) -> Result<Document, ScenarioError> {
        let mut document = Document::from_table(&self.origin, self.table.clone());
        for (key, value) in keys {
            document.set(key, value.clone())?;
        }
        Ok(document)
    }
}
