//! Box of the uncertain keys: the range of each, whatever its distribution within.

use flexsc_formats::document::key;
use toml::{Table, Value};

use super::{Distribution, Normal, like};

/// Number of standard deviations from the mean of a normal distribution to the ends of its range.
const DEVIATIONS: f64 = 3.0;

/// Range of an uncertain key.
#[derive(Clone, Debug, PartialEq)]
pub struct UncertainKey {
    /// Key of the scenario.
    pub key: String,
    distribution: Distribution,
    nominal: Value,
}

/// Ranges of all uncertain keys of a scenario, independent of each other: the limits of uniform distributions, three
/// standard deviations of normal ones, and the values of a choice. Correlations are left out, and keys that hold a text.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct UncertainBox {
    /// Keys, in the order of the scenario.
    pub keys: Vec<UncertainKey>,
}

impl UncertainKey {
    /// Returns the value at a part of the range, from 0 at its lower end to 1 at its upper end; of a choice, the
    /// nearest of its values in their order.
    pub fn value_at(&self, part: f64) -> Value {
        let own = self.nominal_number();
        let between = |low: f64, high: f64| low * (1.0 - part) + high * part;
        let around = |middle: f64, half: f64| between(middle - half.abs(), middle + half.abs());
        let value = match &self.distribution {
            Distribution::Uniform([low, high]) => between(low.get(), high.get()),
            Distribution::LogUniform([low, high]) => {
                let middle = libm::exp(between(libm::log(low.get()), libm::log(high.get())));
                middle.clamp(low.get(), high.get())
            }
            Distribution::Normal(Normal { mean, sd }) => around(mean.get(), DEVIATIONS * sd.get()),
            Distribution::RelativeUniform(half) => around(own, half.get() * own),
            Distribution::RelativeNormal(sd) => around(own, DEVIATIONS * sd.get() * own),
            Distribution::Choice(values) => {
                let mut sorted: Vec<Value> = values.iter().map(|value| value.like(&self.nominal)).collect();
                sorted.sort_by(|a, b| number(a).total_cmp(&number(b)));
                let last = sorted.len().saturating_sub(1);
                return sorted.swap_remove(libm::round(part * last as f64) as usize);
            }
        };
        like(&self.nominal, value)
    }

    /// Returns the number at a part of the range, as [`UncertainKey::value_at`] does.
    pub fn number_at(&self, part: f64) -> f64 {
        number(&self.value_at(part))
    }

    /// Returns the least and the largest value.
    pub fn limits(&self) -> [f64; 2] {
        [self.number_at(0.0), self.number_at(1.0)]
    }

    /// Returns the value of the scenario itself.
    pub fn nominal_number(&self) -> f64 {
        number(&self.nominal)
    }

    /// Returns the part of the range at which the value of the scenario lies; the nearer end if it is outside.
    pub fn nominal_fraction(&self) -> f64 {
        self.fraction(self.nominal_number())
    }

    /// Returns the part of the range at which a value lies; the nearer end if it is outside.
    pub fn fraction(&self, value: f64) -> f64 {
        let [low, high] = self.limits();
        let part = match &self.distribution {
            Distribution::LogUniform(_) => libm::log(value / low) / libm::log(high / low),
            _ => (value - low) / (high - low),
        };
        // A value below a positive range has no logarithm; one of a range without a width has no part.
        if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.0 }
    }
}

impl UncertainBox {
    /// Creates the box of uncertain keys, whose own values are in the table of their scenario.
    pub fn new<'a>(
        uncertain: impl IntoIterator<Item = (&'a String, &'a Distribution)>,
        table: &Table,
    ) -> Self {
        let range = |(name, distribution): (&String, &Distribution)| UncertainKey {
            key: name.clone(),
            distribution: distribution.clone(),
            nominal: key::get(table, name).cloned().unwrap_or(Value::Float(f64::NAN)),
        };
        let keys = uncertain.into_iter().filter(|(_, distribution)| !distribution.has_texts()).map(range);
        Self { keys: keys.collect() }
    }
}

fn number(value: &Value) -> f64 {
    value.as_float().or(value.as_integer().map(|integer| integer as f64)).unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(text: &str, nominal: Value) -> UncertainKey {
        let table: Table = toml::from_str(&format!("x = {text}")).expect("TOML");
        let distribution = table["x"].clone().try_into().expect("a distribution");
        UncertainKey { key: "x".to_owned(), distribution, nominal }
    }

    #[test]
    fn every_distribution_has_a_range() {
        let limits = |text: &str| range(text, Value::Float(-2.0)).limits();
        assert_eq!(limits("{ uniform = [1.0, 3.0] }"), [1.0, 3.0]);
        assert_eq!(limits("{ log_uniform = [1.0, 100.0] }"), [1.0, 100.0]);
        assert_eq!(limits("{ normal = { mean = 1.0, sd = 2.0 } }"), [-5.0, 7.0]);
        // Of a negative value too, the lower end comes first.
        assert_eq!(limits("{ relative_uniform = 0.5 }"), [-3.0, -1.0]);
        assert_eq!(limits("{ relative_normal = 0.5 }"), [-5.0, 1.0]);
        assert_eq!(limits("{ choice = [4.0, 1.0, 2.0] }"), [1.0, 4.0]);
    }

    #[test]
    fn values_between_have_the_type_and_the_place_of_the_key() {
        let decade = range("{ log_uniform = [1.0, 100.0] }", Value::Float(10.0));
        assert!((decade.number_at(0.5) - 10.0).abs() < 1e-14);
        assert!((decade.nominal_fraction() - 0.5).abs() < 1e-15);
        assert_eq!(range("{ choice = [4.0, 1.0, 2.0] }", Value::Float(1.0)).number_at(0.4), 2.0);
        assert_eq!(range("{ uniform = [1, 4] }", Value::Integer(2)).value_at(0.6), Value::Integer(3));
        assert_eq!(range("{ uniform = [1, 4] }", Value::Float(7.0)).nominal_fraction(), 1.0);
    }
}
