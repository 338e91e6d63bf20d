//! Tuning of keys of a scenario over its plants.

use std::collections::BTreeMap;

use flexsc_formats::document::{ConfigError, Document, ScenarioError};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Map, Value as Json, json};
use toml::Value;

use super::goal::{TunedMeasure, TuningGoal, TuningLimit, TuningObjective};
use super::loop_set::{LoopSet, PlantMargin};
use super::scenario_loops::ScenarioLoops;
use super::scenario_measure::ScenarioMeasure;
use super::{TunedLoop, TunedParameter, TuningFault, tune};
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

/// Tuned keys, with the margins of the plants before and after.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "TunedScenario")]
pub struct TuningReport {
    /// Point at which the loops are cut open.
    #[serde(rename = "loop")]
    pub opened: LoopBreak,
    /// Quantities besides the margins that were minimised or limited.
    #[schemars(extend("x-key" = "name"))]
    pub measures: Vec<MeasureChange>,
    /// Least modulus margin that every plant was to keep.
    pub margin_limit: Option<f64>,
    /// Least modulus margin of all plants with the keys of the scenario.
    pub least_margin_before: f64,
    /// Least modulus margin of all plants with the tuned keys.
    pub least_margin: f64,
    /// Least loop gain of the nominal plant at the bandwidth, with the keys of the scenario.
    pub bandwidth_gain_before: Option<f64>,
    /// Least loop gain of the nominal plant at the bandwidth, with the tuned keys.
    pub bandwidth_gain: Option<f64>,
    /// Number of steps of the search.
    pub steps: usize,
    /// Value of each tuned key.
    #[schemars(extend("x-key" = "key"))]
    pub keys: Vec<KeyChange>,
    /// Plants: the nominal one, then the corners of the uncertain keys.
    pub plants: Vec<PlantChange>,
}

/// Tuned key.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(extend("x-main" = "after"))]
pub struct KeyChange {
    /// Key of the scenario, such as `law.pd.k_d`.
    pub key: String,
    /// Value in the scenario that was tuned.
    pub before: f64,
    /// Tuned value.
    pub after: f64,
    /// Least and largest value.
    pub range: [f64; 2],
}

/// Quantity besides the margins that a tuning minimised or limited, with its largest value of all plants.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "TunedMeasure")]
pub struct MeasureChange {
    /// Name: `settling`, or that of a requirement.
    pub name: String,
    /// Unit of the values and of the limit.
    pub unit: &'static str,
    /// True if it was minimised.
    pub is_objective: bool,
    /// Largest value with the keys of the scenario; infinite if it has no bound.
    #[schemars(extend("x-null" = "infinite"))]
    pub before: f64,
    /// Largest value with the tuned keys; infinite if it has no bound.
    #[schemars(extend("x-name" = "value", "x-null" = "infinite"))]
    pub after: f64,
    /// Limit that was to be kept.
    pub limit: Option<f64>,
    /// Index of the plant with the largest value.
    pub worst_plant: usize,
}

/// Margins of a plant before and after tuning.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "TunedPlant")]
pub struct PlantChange {
    /// Values of the uncertain keys at its corner; none for the nominal plant.
    #[schemars(with = "BTreeMap<String, f64>")]
    pub values: Map<String, Json>,
    /// With the keys of the scenario.
    #[schemars(extend("x-flat" = "{}_before"))]
    pub before: PlantMargin,
    /// With the tuned keys.
    #[schemars(extend("x-flat" = "{}"))]
    pub after: PlantMargin,
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
            TuningObjective::Requirement(name) => Some(ScenarioMeasure::for_requirement(scenario, name)?),
        };
        goal.minimised = objective.map(&mut place);
        let mut given = Vec::new();
        for limit in &self.limits {
            match limit {
                TuningLimit::Margin(least) => goal.least_margin = Some(*least),
                TuningLimit::Settling(most) => {
                    given.push((place(ScenarioMeasure::Settling), (Some(*most), true)));
                }
                TuningLimit::Requirement(name) => {
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

    /// Returns the longest settling times of the nominal plant (s), with the keys of the scenario and the tuned ones; `None` for a
    /// loop that has none.
    pub fn settling(&self) -> Option<[f64; 2]> {
        let longest = |values: &[f64]| {
            let plant = self.loops.plant_at(values, 0, &[ScenarioMeasure::Settling]).ok()?;
            let times = plant.measures.iter().flatten();
            times.copied().reduce(f64::max).filter(|time| time.is_finite())
        };
        Some([longest(&self.tuned.before.values)?, longest(&self.tuned.after.values)?])
    }

    /// Returns the point at which the loops are cut open.
    pub fn opened(&self) -> LoopBreak {
        self.opened
    }

    /// Returns the keys with their values, and the plants with their margins, before and after.
    pub fn report(&self) -> TuningReport {
        let TunedLoop { before, after, steps } = &self.tuned;
        let keys = self.parameters.iter().zip(before.values.iter().zip(&after.values));
        let measures = self.goal.measures.iter().enumerate().map(|(index, measure)| {
            let ((was, _), (is, worst_plant)) = (before.measures[index], after.measures[index]);
            MeasureChange {
                name: measure.name.clone(),
                unit: measure.unit,
                is_objective: self.goal.minimised == Some(index),
                before: was,
                after: is,
                limit: measure.limit,
                worst_plant,
            }
        });
        let plant = |index: usize| {
            let values = self.loops.plant(index).into_iter();
            PlantChange {
                values: values.map(|(key, value)| (key.to_owned(), json!(value))).collect(),
                before: before.plants[index],
                after: after.plants[index],
            }
        };
        TuningReport {
            opened: self.opened,
            measures: measures.collect(),
            margin_limit: self.goal.least_margin,
            least_margin_before: before.least(),
            least_margin: after.least(),
            bandwidth_gain_before: before.bandwidth_gain,
            bandwidth_gain: after.bandwidth_gain,
            steps: *steps,
            keys: keys
                .map(|(parameter, (before, after))| KeyChange {
                    key: parameter.key.clone(),
                    before: *before,
                    after: *after,
                    range: parameter.range,
                })
                .collect(),
            plants: (0..self.loops.plants()).map(plant).collect(),
        }
    }
}
