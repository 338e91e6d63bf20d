//! Uncertain keys: the values that a Monte Carlo campaign draws anew for each run.

mod correlation;
mod uncertain_box;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use toml::Value;

pub use correlation::Correlated;
pub use uncertain_box::{UncertainBox, UncertainKey};

use flexsc_numerics::normal;
use flexsc_numerics::quantity::{Finite, Positive};
use flexsc_numerics::random::Stream;

/// The distribution of one key of the scenario.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Distribution {
    /// Uniform between two values.
    Uniform([Finite; 2]),
    /// Log-uniform between two positive values.
    LogUniform([Positive; 2]),
    /// Normal with this mean and standard deviation.
    Normal(Normal),
    /// The scenario's own value times a factor that is uniform between 1 - x and 1 + x, where x is this number.
    RelativeUniform(Positive),
    /// The scenario's own value times a normal factor with mean 1 and this standard deviation.
    RelativeNormal(Positive),
    /// One of these values, with equal probability.
    Choice(Vec<ChoiceValue>),
}

/// A value of a choice.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum ChoiceValue {
    /// Number.
    Number(Finite),
    /// Text, for a key that holds one.
    Text(String),
}

/// A normal distribution.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Normal {
    /// Mean.
    pub mean: Finite,
    /// Standard deviation.
    pub sd: Positive,
}

impl Distribution {
    /// Returns the first inconsistency of the distribution for a key with the value `nominal`.
    pub fn validate(&self, nominal: Option<&Value>) -> Option<String> {
        match self {
            Self::Uniform([low, high]) if low >= high => {
                Some(format!("needs [low, high] in this order, got [{}, {}]", low.get(), high.get()))
            }
            Self::LogUniform([low, high]) if low >= high => {
                Some(format!("needs [low, high] in this order, got [{}, {}]", low.get(), high.get()))
            }
            Self::Choice(values) if values.is_empty() => {
                Some("needs at least one value to choose from".to_owned())
            }
            Self::Choice(values) if self.has_texts() => match nominal {
                Some(Value::String(_)) if values.iter().all(ChoiceValue::is_text) => None,
                Some(other) => {
                    Some(format!("has a text among its values, and that key holds a {}", other.type_str()))
                }
                None => Some("names no key of this scenario".to_owned()),
            },
            _ => match nominal {
                Some(Value::Integer(0) | Value::Float(0.0)) if self.is_relative() => {
                    Some("varies the key's own value by a factor, but that is 0".to_owned())
                }
                Some(Value::Integer(_) | Value::Float(_)) => None,
                Some(other) => Some(format!("varies a number, but that key holds a {}", other.type_str())),
                None => Some("names no key of this scenario".to_owned()),
            },
        }
    }

    /// Returns true for a choice with a text.
    pub fn has_texts(&self) -> bool {
        matches!(self, Self::Choice(values) if values.iter().any(ChoiceValue::is_text))
    }

    fn is_relative(&self) -> bool {
        matches!(self, Self::RelativeUniform(_) | Self::RelativeNormal(_))
    }

    /// Draws a value for a key whose value in the scenario is `nominal`.
    pub fn draw(&self, nominal: &Value, stream: &mut Stream) -> Value {
        let own = nominal.as_float().or(nominal.as_integer().map(|i| i as f64)).unwrap_or(f64::NAN);
        let between = |low: f64, high: f64, stream: &mut Stream| low + (high - low) * stream.uniform();
        let drawn = match self {
            Self::Uniform([low, high]) => between(low.get(), high.get(), stream),
            Self::LogUniform([low, high]) => {
                libm::exp(between(libm::log(low.get()), libm::log(high.get()), stream))
            }
            Self::Normal(Normal { mean, sd }) => mean.get() + sd.get() * stream.normal(),
            Self::RelativeUniform(part) => own * between(1.0 - part.get(), 1.0 + part.get(), stream),
            Self::RelativeNormal(sd) => own * (1.0 + sd.get() * stream.normal()),
            Self::Choice(values) => return values[stream.index(values.len())].like(nominal),
        };
        like(nominal, drawn)
    }

    /// Returns the value below which a draw lies with `probability`, in (0, 1), for a key whose value in the scenario
    /// is `nominal`. The values of a choice divide the probabilities equally.
    pub fn quantile(&self, nominal: &Value, probability: f64) -> Value {
        let own = nominal.as_float().or(nominal.as_integer().map(|i| i as f64)).unwrap_or(f64::NAN);
        let between = |low: f64, high: f64| low + (high - low) * probability;
        let value = match self {
            Self::Uniform([low, high]) => between(low.get(), high.get()),
            Self::LogUniform([low, high]) => libm::exp(between(libm::log(low.get()), libm::log(high.get()))),
            Self::RelativeUniform(part) => own * between(1.0 - part.get(), 1.0 + part.get()),
            Self::Choice(values) => {
                return values[((probability * values.len() as f64) as usize).min(values.len() - 1)]
                    .like(nominal);
            }
            Self::Normal(_) | Self::RelativeNormal(_) => {
                return self.value_at_deviation(nominal, normal::quantile(probability));
            }
        };
        like(nominal, value)
    }

    /// Returns the value with the same cumulative probability as `z` has in a standard normal distribution.
    pub fn value_at_deviation(&self, nominal: &Value, z: f64) -> Value {
        let own = nominal.as_float().or(nominal.as_integer().map(|i| i as f64)).unwrap_or(f64::NAN);
        match self {
            Self::Normal(Normal { mean, sd }) => like(nominal, mean.get() + sd.get() * z),
            Self::RelativeNormal(sd) => like(nominal, own * (1.0 + sd.get() * z)),
            _ => self.quantile(nominal, normal::cumulative(z)),
        }
    }

    /// Returns true if the distribution can be drawn together with others: its values have an order.
    pub fn is_continuous(&self) -> bool {
        !matches!(self, Self::Choice(_))
    }
}

impl ChoiceValue {
    fn is_text(&self) -> bool {
        matches!(self, Self::Text(_))
    }

    /// Returns the value, a number in the type of the key's nominal value.
    fn like(&self, nominal: &Value) -> Value {
        match self {
            Self::Number(number) => like(nominal, number.get()),
            Self::Text(text) => Value::String(text.clone()),
        }
    }
}

/// Converts a number to the type of the key's nominal value.
fn like(nominal: &Value, value: f64) -> Value {
    match nominal {
        Value::Integer(_) => Value::Integer(libm::round(value) as i64),
        _ => Value::Float(value),
    }
}
