//! Campaigns whose runs have given values of the uncertain keys.

use flexsc_formats::document::ScenarioError;
use toml::Value;

use super::{Campaign, Design, DesignBlock};
use flexsc_scenario::Scenario;

impl Campaign {
    /// Returns the campaign of a scenario whose runs have the uncertain keys at given points, in the order of the keys, but
    /// for those that hold a text, all with the noise of run 0. A manoeuvre that a campaign plans for the body as it is written
    /// is planned so here too.
    ///
    /// # Errors
    /// A scenario without a model of its own body for the manoeuvre.
    pub fn at_points(
        scenario: &Scenario,
        origin: &str,
        points: Vec<Vec<f64>>,
    ) -> Result<Self, ScenarioError> {
        let numbers = scenario.uncertain.iter().filter(|(_, distribution)| !distribution.has_texts());
        let mut keys: Vec<String> = numbers.map(|(key, _)| key.clone()).collect();
        let block = if Self::plans_before_drawing(scenario) {
            let model = Self::planned_model(scenario)?;
            keys.push("manoeuvre.model".to_owned());
            let value = |numbers: Vec<f64>| -> Vec<Value> {
                numbers.into_iter().map(Value::Float).chain([model.clone()]).collect()
            };
            DesignBlock::Values { keys, points: points.into_iter().map(value).collect() }
        } else {
            DesignBlock::Table { keys, points }
        };
        let design = Design { noise_run: Some(0), blocks: vec![block], ..Design::default() };
        Self::from_unchecked_points(Self::undrawn(scenario.clone()), origin, design)
    }
}
