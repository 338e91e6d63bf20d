//! Draws of a run: the values of its point, and those of the `[uncertain]` keys.

use flexsc_formats::document::key;
use flexsc_numerics::normal;
use flexsc_numerics::random::Seed;
use toml::Value;

use super::Campaign;
use super::sampling::{Dimension, Sampling};

impl Campaign {
    /// Returns the value of each key that varies in a run.
    pub(super) fn draw(&self, number: u64) -> Vec<Value> {
        let point = self.design.point(number);
        let keys = self.design.keys();
        let values = self.design.values(point, self.scenario.seed);
        let mut drawn: Vec<Value> =
            keys.into_iter().zip(values).map(|(key, v)| self.convert_value(key, v)).collect();
        let first = drawn.len();
        drawn.extend((0..self.scenario.uncertain.len()).map(|place| self.uncertain(place, point)));
        for group in &self.scenario.correlated {
            let place = |key: &String| self.scenario.uncertain.keys().position(|other| other == key);
            let places: Vec<usize> = group.keys.iter().filter_map(place).collect();
            let independent: Vec<f64> = places.iter().map(|place| self.deviation(*place, point)).collect();
            for (place, z) in places.into_iter().zip(group.correlate(&independent)) {
                if let Some((key, distribution)) = self.scenario.uncertain.iter().nth(place) {
                    drawn[first + place] = distribution.value_at_deviation(&self.nominal(key), z);
                }
            }
        }
        drawn
    }

    /// Returns the value of an uncertain key, drawn independently of others.
    fn uncertain(&self, place: usize, point: u64) -> Value {
        let Some((key, distribution)) = self.scenario.uncertain.iter().nth(place) else {
            return Value::Float(f64::NAN);
        };
        let (nominal, name) = (self.nominal(key), format!("uncertain {key}"));
        let seed = self.scenario.seed;
        match self.design.draws {
            Sampling::Random => {
                distribution.draw(&nominal, &mut Seed { scenario: seed, run: point }.stream(&name))
            }
            draws => {
                let dimension = Dimension { seed, name: &name, place };
                distribution.quantile(&nominal, draws.number(dimension, point, self.design.hypercube))
            }
        }
    }

    /// Returns the standard normal number of an uncertain key that is drawn together with others.
    fn deviation(&self, place: usize, point: u64) -> f64 {
        let Some(key) = self.scenario.uncertain.keys().nth(place) else { return f64::NAN };
        let (seed, name) = (self.scenario.seed, format!("uncertain {key}"));
        match self.design.draws {
            Sampling::Random => Seed { scenario: seed, run: point }.stream(&name).normal(),
            draws => normal::quantile(draws.number(
                Dimension { seed, name: &name, place },
                point,
                self.design.hypercube,
            )),
        }
    }

    /// Returns the value of a key in the scenario.
    pub(crate) fn nominal(&self, key: &str) -> Value {
        // The scenario was checked: every uncertain key holds a number.
        key::get(&self.table, key).cloned().unwrap_or(Value::Float(f64::NAN))
    }
}
