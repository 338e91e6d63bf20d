//! Tuning of keys of a scenario over its plants.

use flexsc_formats::document::{ConfigError, Document, ScenarioError};
use serde_json::{Map, Value as Json, json};
use toml::Value;

use super::goal::{TunedMeasure, TuningGoal, TuningLimit, TuningObjective};
use super::loop_set::{LoopSet, PlantMargin};
use super::scenario_loops::ScenarioLoops;
use super::scenario_measure::ScenarioMeasure;
use super::{TunedLoop, TunedParameter, TuningFault, TuningPoint, tune};
use crate::open_loop::LoopBreak;
use flexsc_scenario::Scenario;

/// Largest number of keys that are tuned together.
pub const MOST_TUNED: usize = 20;

/// Tuning of keys of a scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct ScenarioTuning {
    /// Keys, each with its least and largest value.
    pub keys: Vec<(String, [f64; 2])>,
    /// Point at which the loops are cut open.
    pub opened: LoopBreak,
    /// Quantity that is improved.
    pub objective: TuningObjective,
    /// Quantities that are kept within limits.
    pub limits: Vec<TuningLimit>,
    /// Frequency (rad/s) at which the loop gain of the nominal plant stays 1 or more.
    pub bandwidth: Option<f64>,
    /// True for the nominal plant alone, without the corners of the uncertain keys.
    pub is_nominal: bool,
}

/// Tuned scenario.
#[derive(Clone, Debug)]
pub struct TunedScenario {
    /// Loops of its plants.
    pub loops: ScenarioLoops,
    /// Tuned keys.
    pub parameters: Vec<TunedParameter>,
    /// Goal, with the measures that the plants have besides the margins.
    pub goal: TuningGoal,
    /// Values and margins before and after.
    pub tuned: TunedLoop,
    scenario: Scenario,
    opened: LoopBreak,
}

impl ScenarioTuning {
    /// Tunes a scenario.
    ///
    /// # Errors
    /// Keys that cannot be tuned, a scenario without a linear loop, and a loop that is not stable at the start.
    pub fn run(&self, scenario: &Scenario) -> Result<TunedScenario, TuningFault> {
        let wrong = |key: &str, why: String| TuningFault::Key(ConfigError::new(key, why));
        if self.keys.is_empty() || self.keys.len() > MOST_TUNED {
            return Err(wrong(
                "law",
                format!("1 to {MOST_TUNED} keys are tuned together, got {}", self.keys.len()),
            ));
        }
        for (place, (key, [low, high])) in self.keys.iter().enumerate() {
            if !(low.is_finite() && high.is_finite() && low < high) {
                return Err(wrong(
                    key,
                    format!("needs a range from a lower to a higher number, got {low} to {high}"),
                ));
            }
            if self.keys[..place].iter().any(|(other, _)| other == key) {
                return Err(wrong(key, "is given twice".to_owned()));
            }
        }
        if let Some(frequency) =
            self.bandwidth.filter(|frequency| !(*frequency > 0.0 && frequency.is_finite()))
        {
            return Err(wrong("bandwidth", format!("must be a positive number, got {frequency}")));
        }
        let names: Vec<String> = self.keys.iter().map(|(key, _)| key.clone()).collect();
        let loops =
            ScenarioLoops::new(scenario, self.opened, names, !self.is_nominal).map_err(TuningFault::Key)?;
        let mut parameters = Vec::with_capacity(self.keys.len());
        for (key, [low, high]) in &self.keys {
            let start = loops.value(key).unwrap_or(f64::NAN);
            if !(*low..=*high).contains(&start) {
                let why =
                    format!("the range {low} to {high} does not contain the value of the scenario, {start}");
                return Err(wrong(key, why));
            }
            parameters.push(TunedParameter { key: key.clone(), start, range: [*low, *high] });
        }
        let (goal, measures) = self.goal(scenario).map_err(TuningFault::Key)?;
        let plant_at = |values: &[f64], plant: usize| loops.plant_at(values, plant, &measures);
        let set = LoopSet { plant_at: &plant_at, plants: loops.plants(), goal: goal.clone() };
        let tuned = tune(&set, &parameters).map_err(|fault| match fault {
            TuningFault::Unstable(plant, radius) if plant > 0 => {
                let values = loops.plant(plant).into_iter().map(|(key, value)| format!("{key} = {value}"));
                let values = values.collect::<Vec<_>>().join(", ");
                TuningFault::Loop(format!(
                    "the closed loop with {values} is not stable at the start: its spectral radius is {radius:.7}; a search \
                     for margins starts from a stable loop"
                ))
            }
            fault => fault,
        })?;
        Ok(TunedScenario { loops, parameters, goal, tuned, scenario: scenario.clone(), opened: self.opened })
    }

    /// Returns the goal, and the measures of the scenario's loop that it names.
    fn goal(&self, scenario: &Scenario) -> Result<(TuningGoal, Vec<ScenarioMeasure>), ConfigError> {
        let mut goal = TuningGoal { bandwidth: self.bandwidth, ..TuningGoal::default() };
        let (mut measures, mut limits): (Vec<ScenarioMeasure>, Vec<(Option<f64>, bool)>) = Default::default();
        let mut place = |measure: ScenarioMeasure| {
            measures.iter().position(|own| *own == measure).unwrap_or_else(|| {
                measures.push(measure);
                limits.push((None, false));
                measures.len() - 1
            })
        };
        let objective = match &self.objective {
            TuningObjective::Margin => None,
            TuningObjective::Settling => Some(ScenarioMeasure::Settling),
            TuningObjective::Index(name) => Some(ScenarioMeasure::for_requirement(scenario, name)?),
        };
        goal.minimised = objective.map(&mut place);
        let mut given = Vec::new();
        for limit in &self.limits {
            match limit {
                TuningLimit::Margin(least) => goal.least_margin = Some(*least),
                TuningLimit::Settling(most) => {
                    given.push((place(ScenarioMeasure::Settling), (Some(*most), true)));
                }
                TuningLimit::Index(name) => {
                    given.push((place(ScenarioMeasure::for_requirement(scenario, name)?), (None, true)));
                }
            }
        }
        for (index, limit) in given {
            limits[index] = limit;
        }
        let described = measures.iter().zip(limits);
        goal.measures = described
            .map(|(measure, (limit, is_limited))| measure.describe(scenario, limit, is_limited))
            .collect::<Vec<TunedMeasure>>();
        Ok((goal, measures))
    }
}

impl TunedScenario {
    /// Returns the scenario with the tuned keys.
    ///
    /// # Errors
    /// A value that the scenario does not accept.
    pub fn scenario(&self) -> Result<Scenario, ScenarioError> {
        let table = self.scenario.self_contained().to_table();
        let mut document = Document::from_table(&self.scenario.name, table);
        for (parameter, value) in self.parameters.iter().zip(&self.tuned.after.values) {
            document.set(&parameter.key, Value::Float(*value))?;
        }
        Scenario::from_document(&document)
    }

    /// Returns the point at which the loops are cut open.
    pub fn opened(&self) -> LoopBreak {
        self.opened
    }

    /// Returns the keys with their values, and the plants with their margins, before and after.
    pub fn to_json(&self) -> Json {
        let points = self.tuned.before.values.iter().zip(&self.tuned.after.values);
        let key = |(parameter, (before, after)): (&TunedParameter, (&f64, &f64))| json!({"key": parameter.key, "before": before, "after": after, "range": parameter.range});
        let keys: Vec<Json> = self.parameters.iter().zip(points).map(key).collect();
        let plants: Vec<Json> = (0..self.loops.plants())
            .map(|plant| {
                let values =
                    self.loops.plant(plant).into_iter().map(|(key, value)| (key.to_owned(), json!(value)));
                let margin = |point: &TuningPoint| margin_json(&point.plants[plant]);
                json!({
                    "values": values.collect::<Map<String, Json>>(),
                    "before": margin(&self.tuned.before),
                    "after": margin(&self.tuned.after),
                })
            })
            .collect();
        let measures = self.goal.measures.iter().enumerate().map(|(index, measure)| {
            let (before, after) = (self.tuned.before.measures[index], self.tuned.after.measures[index]);
            json!({
                "name": measure.name,
                "unit": measure.unit,
                "is_objective": self.goal.minimised == Some(index),
                "before": finite(before.0),
                "after": finite(after.0),
                "limit": measure.limit,
                "worst_plant": after.1,
            })
        });
        let measures: Vec<Json> = measures.collect();
        json!({
            "loop": self.opened.name(),
            "measures": measures,
            "margin_limit": self.goal.least_margin,
            "least_margin_before": self.tuned.before.least(),
            "least_margin": self.tuned.after.least(),
            "bandwidth_gain_before": self.tuned.before.bandwidth_gain,
            "bandwidth_gain": self.tuned.after.bandwidth_gain,
            "steps": self.tuned.steps,
            "keys": keys,
            "plants": plants,
        })
    }
}

/// Returns a number as JSON, with null for one that is not finite.
fn finite(value: f64) -> Json {
    if value.is_finite() { json!(value) } else { Json::Null }
}

fn margin_json(margin: &PlantMargin) -> Json {
    json!({
        "margin": margin.margin,
        "frequency_rad_s": margin.frequency_rad_s,
        "spectral_radius": margin.spectral_radius,
    })
}
